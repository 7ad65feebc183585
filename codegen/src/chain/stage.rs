//! Stages of telescopes: beams that slide in beams.

use super::{Axis, Beam, BeamAxis, BodyId, Chain, CoordinateId, LoopJointKind, PadDirection, Sliding, Value};

/// A beam that slides in another one on pads.
#[derive(Clone, Debug)]
pub struct Stage<'a> {
    /// The axis of the outer beam.
    pub outer: &'a BeamAxis,
    /// The first element of the inner one.
    pub inner: BodyId,
    /// The coordinate along which it slides: the overlap becomes shorter as it grows.
    pub coordinate: CoordinateId,
    /// Where the inner beam begins, m from the beginning of the outer one, with its coordinate at 0.
    pub behind: &'a Value,
}

impl Stage<'_> {
    /// The overlap with the coordinate at `x`, m.
    #[must_use]
    pub fn overlap(&self, x: f64, parameters: &[f64]) -> f64 {
        self.outer.length.at(parameters) - self.behind.at(parameters) - x
    }
}

impl Chain {
    /// The stages of telescopes, in the order of the links.
    #[must_use]
    pub fn stages(&self) -> Vec<Stage<'_>> {
        let mut stages: Vec<Stage<'_>> = self.pads().filter_map(stage).collect();
        stages.sort_by_key(|stage| stage.inner);
        stages
    }

    /// All directions in which pads hold beams, with springs or exactly.
    pub fn pads(&self) -> impl Iterator<Item = &Sliding> {
        let exact = self.loop_joints.iter().flat_map(|joint| match &joint.kind {
            LoopJointKind::Pad { held } => held.as_slice(),
            _ => &[],
        });
        self.connectors().iter().filter_map(|connector| connector.strain.sliding()).chain(exact)
    }

    /// The coordinates that pads hold: those of stages besides the one along which each slides.
    #[must_use]
    pub fn held_by_pads(&self) -> Vec<CoordinateId> {
        let stages = self.stages();
        let holds = |id: &CoordinateId| {
            let body = self.coordinates[id.0].body;
            stages.iter().any(|stage| stage.inner == body && stage.coordinate != *id)
        };
        (0..self.coordinates.len()).map(CoordinateId).filter(holds).collect()
    }

    /// The height of the section of the beam to which a body belongs, m; `None` if the spec gives no shape.
    #[must_use]
    pub fn height_of(&self, BodyId(body): BodyId) -> Option<&Value> {
        let link = &self.bodies[body].link;
        let Beam { outlines, .. } = self.beams.iter().find(|beam| beam.link == *link)?;
        let [height, _] = &outlines.first()?.1.size;
        Some(height)
    }
}

/// The stage of a rear pad, at the beginning of the inner beam, along y: each stage has one.
fn stage(sliding: &Sliding) -> Option<Stage<'_>> {
    let Sliding { pad, beam, start, grows: true, coordinate, direction: PadDirection::Along(Axis::Y), .. } = sliding
    else {
        return None;
    };
    Some(Stage { outer: beam, inner: pad.body?, coordinate: *coordinate, behind: start })
}
