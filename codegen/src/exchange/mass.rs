//! Mass properties as other programs describe them: mass, centre of mass, and the tensor about it.

use crate::chain::{Frame, Inertia, Vector};
use crate::expand::inertia::principal_axes;

/// `MuJoCo` refuses moving bodies without mass or inertia, so files give massless frames tiny ones: up to this, kg or kg m², they are
/// nothing.
const NOTHING: f64 = 1e-12;
/// Second moments below zero by this fraction of their sum are rounding of a file.
const WRITTEN: f64 = 1e-6;

/// A mass in a frame. It has ten numbers, and is something if one of them is: moments without mass are rotors whose mass is elsewhere.
#[derive(Clone, Debug, PartialEq)]
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
    pub(super) fn from_inertia(inertia: &Inertia, parameters: &[f64]) -> Self {
        let mass = inertia.mass.at(parameters);
        let com = inertia.first.each_ref().map(|first| if mass == 0.0 { 0.0 } else { first.at(parameters) / mass });
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

    /// Whether it has neither mass nor moments.
    pub(super) fn is_nothing(&self) -> bool {
        self.tensor.iter().chain([&self.mass]).all(|number| number.abs() <= NOTHING)
    }

    /// Lumps that move together, combined into one; `None` if they are nothing.
    pub(super) fn sum(lumps: &[Lump]) -> Option<Lump> {
        if lumps.iter().all(Lump::is_nothing) {
            return None;
        }
        let mass: f64 = lumps.iter().map(|lump| lump.mass).sum();
        let weighted = |i: usize| lumps.iter().map(|lump| lump.mass * lump.com[i]).sum::<f64>();
        let com = [0, 1, 2].map(|i| if mass == 0.0 { 0.0 } else { weighted(i) / mass });
        let mut tensor = [0.0; 6];
        for lump in lumps {
            let [x, y, z] = [0, 1, 2].map(|i| lump.com[i] - com[i]);
            let shifted = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z];
            for (sum, (about_com, shift)) in tensor.iter_mut().zip(lump.tensor.iter().zip(shifted)) {
                *sum += about_com + lump.mass * shift;
            }
        }
        Some(Lump { mass, com, tensor })
    }

    /// Neither mass nor moments.
    pub(super) fn nothing() -> Lump {
        Lump { mass: 0.0, com: [0.0; 3], tensor: [0.0; 6] }
    }

    /// The nearest lump that is possible, if this one is not: with `S = ∫ r rᵀ dm = ½ tr(I) 1 − I` about the centre of mass, principal
    /// second moments below zero become zero. Then no principal moment exceeds the sum of the other two.
    pub(super) fn repaired(&self) -> Option<Lump> {
        let mut repaired = self.clone();
        let changed = repaired.change_moments(|moments| {
            let half = 0.5 * moments.iter().sum::<f64>();
            let second = moments.map(|moment| half - moment);
            let size: f64 = second.iter().map(|moment| moment.abs()).sum();
            if second.iter().all(|moment| *moment >= -WRITTEN * size) {
                return moments;
            }
            let [a, b, c] = second.map(|moment| moment.max(0.0));
            [b + c, a + c, a + b]
        });
        changed.then_some(repaired)
    }

    /// Changes the principal moments of inertia; returns whether they are others.
    pub(super) fn change_moments(&mut self, change: impl FnOnce(Vector) -> Vector) -> bool {
        let principal = principal_axes(self.tensor);
        let moments = principal.map(|(moment, _)| moment);
        let changed = change(moments);
        if changed == moments {
            return false;
        }
        let entry = |i: usize, j: usize| -> f64 {
            principal.iter().zip(changed).map(|((_, axis), moment)| moment * axis[i] * axis[j]).sum()
        };
        let size = changed.iter().map(|moment| moment.abs()).sum();
        let tensor = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| entry(i, j));
        self.tensor = tensor.map(|entry| without_rounding(entry, size));
        true
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
        let back = Lump::from_inertia(&about_com(mass.into(), &com.map(Into::into), &tensor.map(Into::into)), &[]);
        assert_eq!((back.mass, back.com, back.tensor), (mass, com, tensor));
        // A point mass has no inertia, not even from rounding.
        assert_eq!(Lump::from_inertia(&point(0.3.into(), &[0.1.into(), 0.7.into(), 1.3.into()]), &[]).tensor, [0.0; 6]);
    }

    #[test]
    fn moments_without_mass_count_in_a_sum() {
        let [arm, rotor] = [
            Lump { mass: 2.0, com: [0.5, 0.0, 0.0], tensor: [0.1, 0.2, 0.3, 0.0, 0.0, 0.0] },
            Lump { mass: 0.0, com: [9.0, 9.0, 9.0], tensor: [0.5, 0.6, 0.7, 0.0, 0.0, 0.01] },
        ];
        let sum = Lump::sum(&[arm.clone(), rotor.clone()]).expect("something");
        assert_eq!((sum.mass, sum.com), (2.0, [0.5, 0.0, 0.0]));
        // Sums of two numbers of order one.
        let apart =
            |expected: [f64; 6]| sum.tensor.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart([0.6, 0.8, 1.0, 0.0, 0.0, 0.01]) < 1e-15, "{sum:?}");
        assert_eq!(Lump::sum(std::slice::from_ref(&rotor)).expect("something").tensor, rotor.tensor);
        assert_eq!(Lump::sum(&[Lump { tensor: [0.0; 6], ..rotor }]), None);
        assert_eq!(arm.repaired(), None);
    }

    /// Moments 1, 2, 4: second moments 2.5, 1.5 and −0.5 kg m², of which the last becomes zero. Turned by 30° about z, the same turned.
    #[test]
    fn an_impossible_inertia_becomes_the_nearest_possible() {
        let lump = Lump { mass: 3.0, com: [0.1, 0.2, 0.3], tensor: [1.0, 2.0, 4.0, 0.0, 0.0, 0.0] };
        let turned = Frame::WORLD.rotated(Axis::Z, 0.5, 0.75_f64.sqrt());
        let right = Lump { tensor: [1.5, 2.5, 4.0, 0.0, 0.0, 0.0], ..lump.clone() };
        for frame in [Frame::WORLD, turned] {
            let found = lump.seen_through(&frame).repaired().expect("a change").tensor;
            let expected = right.seen_through(&frame).tensor;
            // Jacobi's rotations of numbers of order one.
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?} {expected:?}");
        }
        assert_eq!(right.repaired(), None);
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
