//! Feet that stand on the push of their own lateral springs.
//!
//! A one-sided support that is pressed in by δ pushes with `s_z δ + ½ w' L`, where `L = s_x e_x² + s_y e_y²` and w is the fraction to which its
//! lateral springs act; from `s_z δ = N₀` on w is 1. The second term returns the energy of lateral springs that let go. Far off their places,
//! a crane could rest on it alone: feet that hardly touch the ground would carry the whole of it.

use nalgebra::Vector3;

use crate::{HoldInfo, SupportInfo, dyn_crane::DynModel};

/// A support that carries more than N₀, although it is pressed in with less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slip {
    /// Index of the support.
    pub foot: usize,
    /// How far it is beside its place, m.
    pub distance: f64,
}

/// The supports of a pose at rest that slip.
pub(super) fn slips(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Vec<Slip> {
    let supports = &crane.description().supports;
    if !supports.iter().any(SupportInfo::is_one_sided) {
        return Vec::new();
    }
    let rest = vec![0.0; q.len()];
    let mut reactions = vec![Vector3::zeros(); supports.len()];
    let mut gaps = vec![[0.0; 2]; supports.len()];
    crane.support_reactions(q, &rest, &mut reactions);
    crane.support_gaps(q, &rest, &mut gaps);
    let of = |foot: usize| {
        let (HoldInfo { stiffness: [x, y, z], full }, force) = (supports[foot].hold?, reactions[foot]);
        let share = -z * gaps[foot][0] / full;
        let holds = share * share * (3.0 - 2.0 * share);
        let distance = (force.x / x).hypot(force.y / y) / holds;
        (share < 1.0 && force.z > full).then_some(Slip { foot, distance })
    };
    (0..supports.len()).filter_map(of).collect()
}
