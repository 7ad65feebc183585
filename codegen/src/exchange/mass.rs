//! Mass properties as other programs take them: mass, centre of mass, tensor about it.

use crate::chain::{Inertia, Vector};

/// Mass properties in numbers.
pub(super) struct Mass {
    /// Mass, kg.
    pub(super) mass: f64,
    /// Centre of mass in the body's frame, m.
    pub(super) com: Vector,
    /// `[Ixx, Iyy, Izz, Ixy, Ixz, Iyz]` about the centre of mass in the body's axes, `Ixy = −∫ x y dm`, kg m².
    pub(super) tensor: [f64; 6],
}

/// A moment about the centre of mass below this share of that about the origin is what rounding has left of parallel axes:
/// some ten roundings of 1.1e-16.
const ROUNDING: f64 = 2e-15;

impl Mass {
    /// Of a pseudo-inertia: with `S = ∫ r rᵀ dm − m c cᵀ`, the tensor is `tr(S) 1 − S`.
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
        Mass { mass, com, tensor: tensor.map(|entry| if entry.abs() <= ROUNDING * size { 0.0 } else { entry }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expand::inertia::{about_com, point};

    #[test]
    fn parallel_axes_there_and_back() {
        let (mass, com, tensor) = (12.0, [1.0, -2.0, 3.0], [52.0, 40.0, 20.0, -1.0, 2.0, -3.0]);
        let back = Mass::of(&about_com(mass.into(), &com.map(Into::into), &tensor.map(Into::into)), &[]);
        assert_eq!((back.mass, back.com, back.tensor), (mass, com, tensor));
        // A point has no inertia of its own, not even by rounding.
        assert_eq!(Mass::of(&point(0.3.into(), &[0.1.into(), 0.7.into(), 1.3.into()]), &[]).tensor, [0.0; 6]);
    }
}
