//! Flexible links that slide in one another without pads: a stage is held where it begins, not at the end of the link in which it slides.

use super::Table;
use crate::dyn_crane::DynCrane;
use crate::dynamics::Phases;
use crate::{BodyInfo, CoordinateInfo, CoordinateKind, Description, Text};

/// Overlaps below this length, m, are those of a stage that is drawn out.
const NONE: f64 = 1e-6;
/// Cosine of an angle between two links up to which one slides along the other.
const ALONG: f64 = 0.99;

/// A stage, and the element of the outer link in front of it: indices of bodies.
struct Stage {
    first: usize,
    outer: usize,
}

/// Stages that overlap the link in which they slide, at a pose.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    let description = crane.description();
    let stages = stages(crane);
    cautions(description, &stages, &overlaps(crane, &stages, q), "")
}

/// The same over a run, with the greatest overlap of each.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    let description = crane.description();
    let stages = stages(crane);
    if stages.is_empty() {
        return Vec::new();
    }
    let (mut phases, mut greatest) = (Phases::new(crane), Vec::new());
    for (row, q) in table.rows.iter().zip(table.poses(description)) {
        let overlaps = overlaps(phases.at_row(row), &stages, q);
        greatest.resize(overlaps.len(), 0.0);
        for (greatest, overlap) in greatest.iter_mut().zip(overlaps) {
            *greatest = overlap.max(*greatest);
        }
    }
    cautions(description, &stages, &greatest, "up to ")
}

fn cautions(description: &Description, stages: &[Stage], overlaps: &[f64], up_to: &str) -> Vec<String> {
    let overlapping = stages.iter().zip(overlaps).filter(|(_, overlap)| **overlap > NONE);
    let caution = |(stage, overlap): (&Stage, &f64)| {
        let [stage, outer] = [stage.first, stage.outer].map(|body| &description.bodies[body].link);
        format!(
            "{stage} is in {outer} over {up_to}{overlap:.2} m, but the model holds it only where it begins: its stress and the deflection are too large, \
             and frequencies too low"
        )
    };
    overlapping.map(caution).collect()
}

/// Flexible links that slide on the flexible link that carries them. A stage on pads has further coordinates, which the pads hold.
fn stages(crane: &dyn DynCrane) -> Vec<Stage> {
    let (description, tree) = (crane.description(), crane.tree());
    let bodies = &description.bodies;
    let has = |body: usize, what: fn(&CoordinateInfo) -> bool| description.coordinates[tree.own(body)].iter().any(what);
    let bends = |link: &Text| {
        let deforms = |(body, info): (usize, &BodyInfo)| {
            info.link == *link && has(body, |coordinate| coordinate.role.is_element())
        };
        bodies.iter().enumerate().any(deforms)
    };
    let slides = |stage: &Stage| {
        let own = &description.coordinates[tree.own(stage.first)];
        matches!(own, [only] if only.kind == CoordinateKind::Translation)
    };
    let carried = (0..bodies.len()).filter_map(|first| Some(Stage { first, outer: tree.parent(first)? }));
    let of_two_links = carried.filter(|stage| bodies[stage.outer].link != bodies[stage.first].link);
    let flexible = |stage: &Stage| [stage.outer, stage.first].iter().all(|body| bends(&bodies[*body].link));
    of_two_links.filter(|stage| slides(stage) && flexible(stage)).collect()
}

/// Over which length each stage is in the link that carries it, m; 0 for one that does not point along it.
fn overlaps(crane: &dyn DynCrane, stages: &[Stage], q: &[f64]) -> Vec<f64> {
    if stages.is_empty() {
        return Vec::new();
    }
    let (transforms, sizes) = (crane.transforms_at(q), crane.body_sizes_at());
    let overlap = |stage: &Stage| {
        let [outer, inner] = [stage.outer, stage.first].map(|body| &transforms[body]);
        let axes = [outer, inner].map(|frame| frame.fixed_view::<3, 1>(0, 0));
        let offset = inner.fixed_view::<3, 1>(0, 3) - outer.fixed_view::<3, 1>(0, 3);
        let along = axes[0].dot(&axes[1]) > ALONG;
        if along { (sizes[stage.outer][1] - axes[0].dot(&offset)).max(0.0) } else { 0.0 }
    };
    stages.iter().map(overlap).collect()
}
