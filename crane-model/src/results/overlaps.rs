//! Beams that slide in beams on pads: how far a stage is in the outer beam.

use super::Table;
use crate::StageInfo;
use crate::dyn_crane::DynCrane;
use crate::dynamics::Phases;
use crate::nalgebra::{Matrix4, Vector3};

/// The overlap of each stage with its outer beam at a pose, in the order of the stages, m; negative if it is out of the beam.
pub(crate) fn at(crane: &dyn DynCrane, q: &[f64]) -> Vec<f64> {
    let stages = crane.stages();
    if stages.is_empty() {
        return Vec::new();
    }
    let (frames, sizes) = (crane.transforms_at(q), crane.body_sizes_at());
    stages.iter().map(|stage| overlap(stage, &sizes, &frames)).collect()
}

/// The length of the outer beam less the distance along it at which the inner one begins.
fn overlap(stage: &StageInfo, sizes: &[[f64; 2]], frames: &[Matrix4<f64>]) -> f64 {
    let origin = |body: usize| -> Vector3<f64> { frames[body].fixed_view::<3, 1>(0, 3).into() };
    let [first, end] = stage.outer;
    let length: f64 = sizes[first..end].iter().map(|[_, length]| length).sum();
    let axis: Vector3<f64> = frames[first].fixed_view::<3, 1>(0, 0).into();
    length - axis.dot(&(origin(stage.inner) - origin(first)))
}

/// Stages with an overlap that holds them poorly or not at all, at a pose.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    let overlaps = at(crane, q).into_iter().enumerate();
    overlaps.filter_map(|(stage, overlap)| caution(crane, stage, (overlap, q), "")).collect()
}

/// The same over a run, with the shortest overlap of each.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    let description = crane.description();
    let stages = crane.stages();
    if stages.is_empty() {
        return Vec::new();
    }
    let (phases, mut shortest) = (Phases::of(crane), Vec::<(f64, Vec<f64>, f64)>::new());
    for (sample, q) in table.poses(description).enumerate() {
        let overlaps = at(phases.at(table.rows[sample][0]), q);
        shortest.resize(overlaps.len(), (f64::INFINITY, Vec::new(), 0.0));
        for (least, overlap) in shortest.iter_mut().zip(overlaps) {
            if overlap < least.0 {
                *least = (overlap, q.to_vec(), table.time_of(sample));
            }
        }
    }
    let found = shortest.iter().enumerate();
    found
        .filter_map(|(stage, (overlap, q, time))| caution(crane, stage, (*overlap, q), &format!(", at {time:.2} s")))
        .collect()
}

/// What to say of the stage of an index.
fn caution(crane: &dyn DynCrane, stage: usize, (overlap, q): (f64, &[f64]), when: &str) -> Option<String> {
    let (description, height) = (crane.description(), crane.stage_height(stage));
    let stage = &crane.stages()[stage];
    let [inner, outer] = [stage.inner, stage.outer[0]].map(|body| &description.bodies[body].link);
    let name = &description.coordinates[stage.coordinate].name;
    let x = q[stage.coordinate];
    if overlap <= 0.0 {
        return Some(format!(
            "{inner} is out of {outer}: its overlap is {overlap:.3} m with {name} at {x:.3} m{when}; nothing holds it there, and results mean nothing"
        ));
    }
    (overlap < height).then(|| {
        format!(
            "{inner} overlaps {outer} by only {overlap:.3} m with {name} at {x:.3} m{when}, less than the height of its section, {height:.3} m: real pads \
             are too long, and walls too weak, for such a hold"
        )
    })
}
