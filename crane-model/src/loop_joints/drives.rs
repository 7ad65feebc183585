//! Whether the drives of a crane determine the motion of its loops.

use nalgebra::DMatrix;

use super::{
    Loops, dot,
    required::{Balance, without_pushes},
};
use crate::{CoordinateRole, dyn_crane::DynModel};

/// Angle to a dead centre, or its sine, below which there is a caution: 2°.
pub const DEAD_CENTRE: f64 = 0.035;

/// The angle by which drives miss a dead centre, rad, if it is below [`DEAD_CENTRE`]: that between the directions in which the other coordinates
/// move the points of the loops. With two of them, as in a four-bar, it is the transmission angle. `None` also if drives hold more than the loops leave
/// free, or if beams bend in a loop.
pub(super) fn dead_centre_of_drives(crane: &(impl DynModel + ?Sized), loops: &Loops) -> Option<f64> {
    /// Directions that depend on each other at every pose.
    const ALWAYS: f64 = 1e-7;
    let coordinates = &crane.description().coordinates;
    let (kept, n) = (loops.independent(), coordinates.len());
    let all: Vec<usize> = (0..n).filter(|j| loops.is_moved_by(*j)).collect();
    let role = |j: &usize| coordinates[*j].role;
    if !all.iter().any(|j| role(j) == CoordinateRole::Driven) || all.iter().any(|j| role(j).is_element()) {
        return None;
    }
    let passive: Vec<usize> = all.into_iter().filter(|j| role(j) == CoordinateRole::Passive).collect();
    if kept.is_empty() || passive.len() < kept.len() {
        return None;
    }
    let moments: Vec<bool> =
        crane.loop_joints().iter().flat_map(|joint| &*joint.equations).map(|equation| equation.is_moment).collect();
    let size = |is_moment: bool| {
        let rows = kept.iter().filter(|row| moments[**row] == is_moment);
        rows.map(|row| dot(&loops.jacobian()[row * n..][..n], &loops.jacobian()[row * n..][..n]).sqrt())
            .fold(f64::MIN_POSITIVE, f64::max)
    };
    let sizes = [false, true].map(size);
    let mut directions = DMatrix::from_fn(kept.len(), passive.len(), |i, k| {
        loops.jacobian()[kept[i] * n + passive[k]] / sizes[usize::from(moments[kept[i]])]
    });
    for mut direction in directions.column_iter_mut() {
        let length = direction.norm();
        direction /= if length > ALWAYS { length } else { 1.0 };
    }
    // The smallest singular value, as an eigenvalue's root: known to 1e-8.
    let squares = &directions * directions.transpose();
    let least = squares.symmetric_eigenvalues().min().max(0.0).sqrt();
    let angle = 2.0 * (least * std::f64::consts::FRAC_1_SQRT_2).min(1.0).asin();
    (least > ALWAYS && angle < DEAD_CENTRE).then_some(angle)
}

/// Coordinates in loops that rigid drives prescribe although the loops determine them: not all of them can be prescribed. Empty if the drives
/// leave the loops enough freedom.
pub(crate) fn prescribed_too_much(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Vec<String> {
    let mut loops = Loops::new(crane);
    if loops.is_empty() {
        return Vec::new();
    }
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    let prescribed = loops.prescribed.clone();
    let [(with, _), (without, _)] = [&[], prescribed.as_slice()].map(|held| loops.independent_without(held));
    let in_loops = prescribed.iter().filter(|j| loops.is_moved_by(**j));
    let names = in_loops.map(|j| crane.description().coordinates[*j].name.to_string());
    if without < with { names.collect() } else { Vec::new() }
}

/// Cylinders with a valve whose pushes the loads of the loops do not determine.
pub(super) fn fighting_valves(crane: &(impl DynModel + ?Sized), q: &[f64], loops: &Loops) -> Option<Vec<String>> {
    let description = crane.description();
    if !description.has_valves() {
        return None;
    }
    let mut jacobian = loops.jacobian().to_vec();
    without_pushes(crane, q, &mut jacobian, &mut vec![0.0; q.len()]);
    let free: Vec<usize> = (0..q.len()).filter(|j| !loops.prescribed.contains(j)).collect();
    let unique = Balance::of(loops, &jacobian, &free)?.is_unique();
    let with_valves = description.cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
    let in_loops = with_valves.filter(|cylinder| loops.is_moved_by(description.drives[cylinder.drive].coordinate));
    (!unique).then(|| in_loops.map(|cylinder| cylinder.name.to_string()).collect())
}
