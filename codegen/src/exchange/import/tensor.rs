//! A mass in one frame and in another.

use crate::chain::{Frame, Vector};

/// Mass, centre of mass and tensor about it in the axes of a frame.
#[derive(Clone, Debug)]
pub(super) struct Lump {
    /// kg.
    pub(super) mass: f64,
    /// m.
    pub(super) com: Vector,
    /// `[Ixx, Iyy, Izz, Ixy, Ixz, Iyz]`, kg m².
    pub(super) tensor: [f64; 6],
}

impl Lump {
    /// The same in the frame in which this one's frame is given: `c' = p + R c`, `I' = R I Rᵀ`.
    pub(super) fn seen_through(&self, frame: &Frame) -> Lump {
        let [xx, yy, zz, xy, xz, yz] = self.tensor;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        // Row i of R: what the axes of the frame have along i.
        let along = |i: usize| frame.axes.map(|axis| axis[i]);
        let entry = |i: usize, j: usize| -> f64 {
            let (left, right) = (along(i), along(j));
            (0..3).map(|k| left[k] * (0..3).map(|l| rows[k][l] * right[l]).sum::<f64>()).sum()
        };
        let size = xx.abs() + yy.abs() + zz.abs();
        let tensor = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| without_rounding(entry(i, j), size));
        Lump { mass: self.mass, com: clean(frame.place(self.com)), tensor }
    }
}

/// Zero where a number is what rounding has left of numbers of a size: some ten roundings.
pub(super) fn without_rounding(number: f64, size: f64) -> f64 {
    if number.abs() <= 1e-15 * size { 0.0 } else { number }
}

/// A vector without what rounding has left in some of its components.
pub(super) fn clean(vector: Vector) -> Vector {
    let size = vector.iter().map(|component| component.abs()).sum();
    vector.map(|component| without_rounding(component, size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::Axis;

    #[test]
    fn a_quarter_turn_swaps_moments_and_signs_of_products() {
        let lump = Lump { mass: 2.0, com: [1.0, 2.0, 3.0], tensor: [10.0, 20.0, 25.0, 1.0, 2.0, 3.0] };
        let turned = lump.seen_through(&Frame { origin: [0.0, 0.0, 5.0], ..Frame::WORLD }.turned(Axis::Z, 1.0, 0.0));
        // x' = −y, y' = x, z' = z: products with one factor x' change their sign.
        assert_eq!(turned.com, [-2.0, 1.0, 8.0]);
        assert_eq!(turned.tensor, [20.0, 10.0, 25.0, -1.0, -3.0, 2.0]);
    }
}
