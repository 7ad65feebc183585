//! The rigid crane to compare a flexible one with.

use crane_model::dyn_crane::DynCrane;

use crate::selection::{Registry, take_numbers};

/// The crane of the registry that equals `crane` except for its elements, with the same parameters.
pub fn rigid(crane: &dyn DynCrane, registry: &Registry) -> Option<Box<dyn DynCrane>> {
    registry.all().flatten().find_map(|mut other| {
        take_numbers(crane, other.as_mut()).ok()?;
        is_rigid(crane, other.as_ref()).then_some(other)
    })
}

/// Whether `other` has the joints, drives, supports and points of `crane`, in the same places and with the same laws, and no
/// elements: compared at a pose away from the drives' positions.
fn is_rigid(crane: &dyn DynCrane, other: &dyn DynCrane) -> bool {
    /// Displacement from the guess, m and rad.
    const OFF: f64 = 0.1;
    let (flexible, rigid) = (crane.description(), other.description());
    let joints: Vec<usize> =
        (0..flexible.coordinates.len()).filter(|&index| !flexible.coordinates[index].role.is_element()).collect();
    let same_joints = joints.iter().map(|&index| &flexible.coordinates[index]).eq(&rigid.coordinates);
    let same_supports = flexible.supports.iter().map(|s| &s.name).eq(rigid.supports.iter().map(|s| &s.name));
    if joints.len() == flexible.coordinates.len() || !same_joints || !same_supports || flexible.points != rigid.points {
        return false;
    }
    let pose: Vec<f64> = other.guess().iter().map(|guess| guess + OFF).collect();
    let mut straight = vec![0.0; flexible.coordinates.len()];
    for (&index, &value) in joints.iter().zip(&pose) {
        straight[index] = value;
    }
    let numbers = |crane: &dyn DynCrane, q: &[f64]| -> Vec<f64> {
        let rest = vec![0.0; q.len()];
        let places = crane.points_at(q).into_iter().chain(crane.support_reactions_at(q, &rest));
        places.flat_map(<[f64; 3]>::from).chain(crane.drive_efforts_at(0.0, q, &rest)).collect()
    };
    alike(&numbers(crane, &straight), &numbers(other, &pose))
}

/// Equal up to rounding.
fn alike(left: &[f64], right: &[f64]) -> bool {
    /// Relative to the numbers, and to 1.
    const ROUNDING: f64 = 1e-9;
    left.len() == right.len() && left.iter().zip(right).all(|(a, b)| (a - b).abs() <= ROUNDING * (1.0 + a.abs()))
}
