//! Mass properties as other programs describe them: mass, centre of mass, and the tensor about it.

use crate::chain::{Frame, Inertia, Vector};

/// A mass in a frame.
#[derive(Clone, Debug)]
pub(super) struct Lump {
    /// Mass, kg.
    pub(super) mass: f64,
    /// Centre of mass in the frame, m.
    pub(super) com: Vector,
    /// `[Ixx, Iyy, Izz, Ixy, Ixz, Iyz]` about the centre of mass in its axes, `Ixy = −∫ x y dm`, kg m².
    pub(super) tensor: [f64; 6],
}

impl Lump {
    /// From a pseudo-inertia: with `S = ∫ r rᵀ dm − m c cᵀ`, the tensor is `tr(S) 1 − S`.
    pub(super) fn of(inertia: &Inertia, parameters: &[f64]) -> Self {
        let mass = inertia.mass.at(parameters);
        let com = inertia.first.each_ref().map(|first| first.at(parameters) / mass);
        let second = inertia.second.each_ref().map(|second| second.at(parameters));
        let size = second[..3].iter().sum::<f64>();
        let central = |k: usize, i: usize, j: usize| second[k] - mass * com[i] * com[j];
        let [xx, yy, zz, xy, xz, yz] = [
            central(0, 0, 0),
            central(1, 1, 1),
            central(2, 2, 2),
            central(3, 0, 1),
            central(4, 0, 2),
            central(5, 1, 2),
        ];
        let tensor = [yy + zz, xx + zz, xx + yy, -xy, -xz, -yz];
        Lump { mass, com, tensor: tensor.map(|entry| without_rounding(entry, size)) }
    }

    /// The same expressed in the outer frame: `c' = p + R c`, `I' = R I Rᵀ`.
    pub(super) fn seen_through(&self, frame: &Frame) -> Lump {
        let [xx, yy, zz, xy, xz, yz] = self.tensor;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        // Row i of R: component i of each axis of the frame.
        let along = |i: usize| frame.axes.map(|axis| axis[i]);
        let entry = |i: usize, j: usize| -> f64 {
            let (left, right) = (along(i), along(j));
            (0..3).map(|k| left[k] * (0..3).map(|l| rows[k][l] * right[l]).sum::<f64>()).sum()
        };
        let size = xx.abs() + yy.abs() + zz.abs();
        let tensor = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| without_rounding(entry(i, j), size));
        Lump { mass: self.mass, com: clean(frame.transform_point(self.com)), tensor }
    }
}

/// Zero if a number is only a rounding residue of larger numbers: about twenty rounding errors of 1.1e-16.
pub(super) fn without_rounding(number: f64, size: f64) -> f64 {
    if number.abs() <= 2e-15 * size { 0.0 } else { number }
}

/// A vector without rounding residues in its components.
pub(super) fn clean(vector: Vector) -> Vector {
    let size = vector.iter().map(|component| component.abs()).sum();
    vector.map(|component| without_rounding(component, size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::Axis;
    use crate::expand::inertia::{about_com, point};

    #[test]
    fn parallel_axes_there_and_back() {
        let (mass, com, tensor) = (12.0, [1.0, -2.0, 3.0], [52.0, 40.0, 20.0, -1.0, 2.0, -3.0]);
        let back = Lump::of(&about_com(mass.into(), &com.map(Into::into), &tensor.map(Into::into)), &[]);
        assert_eq!((back.mass, back.com, back.tensor), (mass, com, tensor));
        // A point mass has no inertia, not even from rounding.
        assert_eq!(Lump::of(&point(0.3.into(), &[0.1.into(), 0.7.into(), 1.3.into()]), &[]).tensor, [0.0; 6]);
    }

    #[test]
    fn a_quarter_turn_swaps_moments_and_signs_of_products() {
        let lump = Lump { mass: 2.0, com: [1.0, 2.0, 3.0], tensor: [10.0, 20.0, 25.0, 1.0, 2.0, 3.0] };
        let rotated = lump.seen_through(&Frame { origin: [0.0, 0.0, 5.0], ..Frame::WORLD }.rotated(Axis::Z, 1.0, 0.0));
        // x' = −y, y' = x, z' = z: products with one factor x' change their sign.
        assert_eq!(rotated.com, [-2.0, 1.0, 8.0]);
        assert_eq!(rotated.tensor, [20.0, 10.0, 25.0, -1.0, -3.0, 2.0]);
    }
}
