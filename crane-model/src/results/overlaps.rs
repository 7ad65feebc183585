//! Beams that slide in beams on pads: how far a stage is in the outer beam.

use super::Table;
use crate::StageInfo;
use crate::dyn_crane::DynCrane;
use crate::dynamics::Phases;
use crate::nalgebra::{Matrix4, Vector3};

/// Part of the shorter beam by which a stage may be pushed in too far: its drive gives way.
const PLAY: f64 = 0.01;

/// Cosine of the angle between a stage and its outer beam from which it stands crosswise: pads and bending allow some hundredths of a radian.
const CROSSWISE: f64 = 0.9;

/// How a stage is in its outer beam.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overlap {
    /// How far it is in the beam, m; negative if it is out of it, −∞ if it stands crosswise.
    pub inside: f64,
    /// How much further it may be pushed in, until the overlap is longer than one of the beams, m.
    left: f64,
    /// By how much it may be pushed in further than that, m.
    play: f64,
}

impl Overlap {
    /// How much further it may be pushed in, with play, m.
    pub fn left(&self) -> f64 {
        self.left + self.play
    }
}

/// Each stage at a pose, in their order.
pub(crate) fn at(crane: &dyn DynCrane, q: &[f64]) -> Vec<Overlap> {
    let stages = crane.stages();
    if stages.is_empty() {
        return Vec::new();
    }
    let (frames, sizes) = (crane.transforms_at(q), crane.body_sizes_at());
    let bodies = &crane.description().bodies;
    let of_stage = |stage: &StageInfo| {
        let own = bodies.iter().zip(&sizes).filter(|(body, _)| body.link == bodies[stage.inner].link);
        let inner: f64 = own.map(|(_, [_, length])| length).sum();
        let [outer, overlap] = overlap(stage, &sizes, &frames);
        // Pads hold a stage along its beam, or not at all.
        let [own, along] =
            [stage.inner, stage.outer[0]].map(|body| -> Vector3<f64> { frames[body].fixed_view::<3, 1>(0, 0).into() });
        let is_crosswise = own.dot(&along) < CROSSWISE;
        let [shorter, inside] = [outer.min(inner), if is_crosswise { f64::NEG_INFINITY } else { overlap }];
        Overlap { inside, left: shorter - overlap, play: PLAY * shorter }
    };
    stages.iter().map(of_stage).collect()
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
    overlaps.flat_map(|(stage, overlap)| cautions(crane, stage, [(overlap, q); 2], ["", ""])).collect()
}

/// The same over a run, with the shortest and the longest overlap of each.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    let description = crane.description();
    if crane.stages().is_empty() {
        return Vec::new();
    }
    let mut phases = Phases::new(crane);
    let mut worst: Vec<[Option<At<'_>>; 2]> = vec![[None; 2]; crane.stages().len()];
    for (sample, q) in table.poses(description).enumerate() {
        for (worst, now) in worst.iter_mut().zip(at(phases.at_row(&table.rows[sample]), q)) {
            let left: [fn(&Overlap) -> f64; 2] = [|overlap| overlap.inside, Overlap::left];
            for (worst, left) in worst.iter_mut().zip(left) {
                if worst.as_ref().is_none_or(|(before, ..)| left(&now) < left(before)) {
                    *worst = Some((now, q, table.time_of(sample)));
                }
            }
        }
    }
    let found = worst.into_iter().enumerate().filter_map(|(stage, [out, pushed])| Some((stage, [out?, pushed?])));
    found
        .flat_map(|(stage, both)| {
            let times = both.map(|(_, _, time)| format!(", at {time:.2} s"));
            cautions(crane, stage, both.map(|(overlap, q, _)| (overlap, q)), times.each_ref().map(String::as_str))
        })
        .collect()
}

/// A stage in a pose of a run, and when, s.
type At<'a> = (Overlap, &'a [f64], f64);

/// What to say of the stage of an index where it is drawn out furthest and where it is pushed in furthest, each with the pose and the time.
fn cautions(
    crane: &dyn DynCrane,
    stage: usize,
    [(drawn, q), (pushed, at_pushed)]: [(Overlap, &[f64]); 2],
    [when, when_pushed]: [&str; 2],
) -> Vec<String> {
    let overlap = drawn.inside;
    let (description, height) = (crane.description(), crane.stage_height(stage));
    let stage = &crane.stages()[stage];
    let [inner, outer] = [stage.inner, stage.outer[0]].map(|body| &description.bodies[body].link);
    let name = &description.coordinates[stage.coordinate].name;
    let [x, x_pushed] = [q, at_pushed].map(|q| q[stage.coordinate]);
    let too_far = (pushed.left() < 0.0).then(|| {
        format!(
            "{inner} is pushed {:.3} m too far into {outer} with {name} at {x_pushed:.3} m{when_pushed}: its overlap is longer than one of the beams",
            -pushed.left
        )
    });
    let in_front = if overlap == f64::NEG_INFINITY {
        Some(format!(
            "{inner} stands crosswise in {outer} with {name} at {x:.3} m{when}: pads do not hold it so, and results mean nothing"
        ))
    } else if overlap <= 0.0 {
        Some(format!(
            "{inner} is out of {outer}: its overlap is {:.3} m with {name} at {x:.3} m{when}; nothing holds it there, and results mean nothing",
            (1e3 * overlap).round() / 1e3 + 0.0
        ))
    } else {
        (overlap < height).then(|| {
            format!(
                "{inner} overlaps {outer} by only {overlap:.3} m with {name} at {x:.3} m{when}, less than the height of its section, {height:.3} m: \
                 real pads are too long, and walls too weak, for such a hold"
            )
        })
    };
    in_front.into_iter().chain(too_far).collect()
}
