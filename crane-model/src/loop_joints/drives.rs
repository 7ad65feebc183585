//! Whether the drives of a crane determine the motion of its loops.

use super::{
    Loops,
    required::{Balance, without_pushes},
};
use crate::dyn_crane::Functions;

/// Coordinates in loops that rigid drives prescribe although the loops determine them: not all of them can be prescribed. Empty if the drives
/// leave the loops enough freedom.
pub(crate) fn prescribed_too_much(crane: &dyn Functions, q: &[f64]) -> Vec<String> {
    let mut loops = Loops::new(crane);
    if loops.is_empty() {
        return Vec::new();
    }
    loops.evaluate(crane, q, &vec![0.0; q.len()]);
    let prescribed = loops.prescribed.clone();
    let [with, without] = [&[], prescribed.as_slice()].map(|held| loops.independent_without(held));
    let in_loops = prescribed.iter().filter(|j| loops.is_moved_by(**j));
    let names = in_loops.map(|j| crane.description().coordinates[*j].name.to_string());
    if without < with { names.collect() } else { Vec::new() }
}

/// Cylinders with a valve whose pushes the loads of the loops do not determine.
pub(super) fn fighting_valves(crane: &dyn Functions, q: &[f64], loops: &Loops) -> Option<Vec<String>> {
    let description = crane.description();
    if !description.has_valves() {
        return None;
    }
    let mut jacobian = loops.jacobian().to_vec();
    without_pushes(crane, q, &mut jacobian, &mut vec![0.0; q.len()]);
    let free: Vec<usize> = (0..q.len()).filter(|j| !loops.prescribed.contains(j)).collect();
    let unique = Balance::new(loops, &jacobian, &free)?.is_unique();
    let with_valves = description.cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
    let in_loops = with_valves.filter(|cylinder| loops.is_moved_by(description.drives[cylinder.drive].coordinate));
    (!unique).then(|| in_loops.map(|cylinder| cylinder.name.to_string()).collect())
}
