//! Wrenches between parts of a crane.

use bytemuck::{Pod, Zeroable};
use nalgebra::Vector3;

/// A force and a moment about a point.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Wrench {
    /// Force, N.
    pub force: Vector3<f64>,
    /// Moment about the point, N m.
    pub moment: Vector3<f64>,
}

impl Wrench {
    /// No force and no moment.
    pub const ZERO: Wrench = Wrench { force: Vector3::new(0.0, 0.0, 0.0), moment: Vector3::new(0.0, 0.0, 0.0) };
}

/// Force with which a connector pulls its two points together, and how it depends on their distance.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Tension {
    /// Force, N; negative where the connector pushes.
    pub force: f64,
    /// Its derivative with respect to the length, N/m.
    pub stiffness: f64,
    /// Its derivative with respect to the rate of the length, N s/m.
    pub damping: f64,
}

impl Tension {
    /// No force.
    pub const ZERO: Tension = Tension { force: 0.0, stiffness: 0.0, damping: 0.0 };

    /// Stiffness and damping for an implicit step, never negative.
    #[cfg(feature = "std")]
    pub(crate) fn stiffness_and_damping(&self) -> [f64; 2] {
        [self.stiffness.max(0.0), self.damping.max(0.0)]
    }
}

/// Adds `force` times some wrenches to others, one by one.
#[cfg(feature = "std")]
pub(crate) fn add(sums: &mut [Wrench], force: f64, wrenches: &[Wrench]) {
    // A cylinder that does not push may have a linkage that does not reach.
    if force == 0.0 {
        return;
    }
    for (sum, wrench) in sums.iter_mut().zip(wrenches) {
        sum.force += force * wrench.force;
        sum.moment += force * wrench.moment;
    }
}
