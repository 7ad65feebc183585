//! Beams that slide in beams on pads: how far a stage is in the outer beam.

use super::Table;
use crate::StageInfo;
use crate::dyn_crane::DynCrane;
use crate::dynamics::Phases;
use crate::nalgebra::{Matrix4, Vector3};

/// Part of the shorter beam by which a stage may be pushed in too far: its drive gives way.
const PLAY: f64 = 0.01;

/// How far each stage is in its outer beam at a pose, in the order of the stages, m: its overlap, negative if it is out of the beam, and how
/// much further it may be pushed in, until the overlap is longer than one of the beams.
pub(crate) fn at(crane: &dyn DynCrane, q: &[f64]) -> Vec<[f64; 2]> {
    let stages = crane.stages();
    if stages.is_empty() {
        return Vec::new();
    }
    let (frames, sizes) = (crane.transforms_at(q), crane.body_sizes_at());
    let bodies = &crane.description().bodies;
    let both = |stage: &StageInfo| {
        let own = bodies.iter().zip(&sizes).filter(|(body, _)| body.link == bodies[stage.inner].link);
        let inner: f64 = own.map(|(_, [_, length])| length).sum();
        let [outer, overlap] = overlap(stage, &sizes, &frames);
        [overlap, (1.0 + PLAY) * outer.min(inner) - overlap]
    };
    stages.iter().map(both).collect()
}

/// The length of the outer beam, and that less the distance along it at which the inner one begins.
fn overlap(stage: &StageInfo, sizes: &[[f64; 2]], frames: &[Matrix4<f64>]) -> [f64; 2] {
    let origin = |body: usize| -> Vector3<f64> { frames[body].fixed_view::<3, 1>(0, 3).into() };
    let [first, end] = stage.outer;
    let length: f64 = sizes[first..end].iter().map(|[_, length]| length).sum();
    let axis: Vector3<f64> = frames[first].fixed_view::<3, 1>(0, 0).into();
    [length, length - axis.dot(&(origin(stage.inner) - origin(first)))]
}

/// Stages with an overlap that holds them poorly or not at all, at a pose.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    let overlaps = at(crane, q).into_iter().enumerate();
    overlaps.flat_map(|(stage, both)| cautions(crane, stage, both.map(|left| (left, q.to_vec())), ["", ""])).collect()
}

/// The same over a run, with the shortest and the longest overlap of each.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    let description = crane.description();
    if crane.stages().is_empty() {
        return Vec::new();
    }
    let phases = Phases::of(crane);
    let mut least = vec![[(); 2].map(|()| (f64::INFINITY, Vec::new(), 0.0)); crane.stages().len()];
    for (sample, q) in table.poses(description).enumerate() {
        for (least, now) in least.iter_mut().zip(at(phases.at(table.rows[sample][0]), q)) {
            for (least, now) in least.iter_mut().zip(now).filter(|(least, now)| *now < least.0) {
                *least = (now, q.to_vec(), table.time_of(sample));
            }
        }
    }
    let found = least.into_iter().enumerate().filter(|(_, [(overlap, ..), _])| overlap.is_finite());
    found
        .flat_map(|(stage, both)| {
            let times = both.each_ref().map(|(_, _, time)| format!(", at {time:.2} s"));
            cautions(crane, stage, both.map(|(left, q, _)| (left, q)), times.each_ref().map(String::as_str))
        })
        .collect()
}

/// What to say of the stage of an index: of its overlap, and of how much further it may be pushed in, each with the pose and the time.
fn cautions(
    crane: &dyn DynCrane,
    stage: usize,
    [(overlap, q), (left, at_pushed)]: [(f64, Vec<f64>); 2],
    [when, when_pushed]: [&str; 2],
) -> Vec<String> {
    let (description, height) = (crane.description(), crane.stage_height(stage));
    let stage = &crane.stages()[stage];
    let [inner, outer] = [stage.inner, stage.outer[0]].map(|body| &description.bodies[body].link);
    let name = &description.coordinates[stage.coordinate].name;
    let [x, x_pushed] = [q, at_pushed].map(|q| q[stage.coordinate]);
    let pushed = (left < 0.0).then(|| {
        format!(
            "{inner} is pushed {:.3} m too far into {outer} with {name} at {x_pushed:.3} m{when_pushed}: its overlap is longer than one of the beams",
            -left
        )
    });
    let in_front = if overlap <= 0.0 {
        Some(format!(
            "{inner} is out of {outer}: its overlap is {overlap:.3} m with {name} at {x:.3} m{when}; nothing holds it there, and results mean nothing"
        ))
    } else {
        (overlap < height).then(|| {
            format!(
                "{inner} overlaps {outer} by only {overlap:.3} m with {name} at {x:.3} m{when}, less than the height of its section, {height:.3} m: \
                 real pads are too long, and walls too weak, for such a hold"
            )
        })
    };
    in_front.into_iter().chain(pushed).collect()
}
