//! Strains: lengths and angles that depend on the pose, on which forces act.

use std::collections::BTreeSet;

use super::{Axis, BeamAxis, BodyId, Chain, CoordinateId, CoordinateKind, Frame, Value, Vector};

/// A length or an angle that depends on the pose.
#[derive(Clone, Debug, PartialEq)]
pub enum Strain {
    /// A coordinate, m or rad.
    Coordinate(CoordinateId),
    /// The length of a line through points, m.
    Line(StrainLine),
    /// `q_j − r q_i`, m or rad: how far a coordinate is from the position given by its leader.
    Coupling {
        /// j
        coordinate: CoordinateId,
        /// i
        leader: CoordinateId,
        /// r
        ratio: Value,
    },
    /// Where the axis of a beam passes a pad on which it slides, m, or how far it is twisted against it, rad.
    Sliding(Box<Sliding>),
    /// How far a pin has turned, rad.
    Turning(Box<Turning>),
    /// `h − z`: how deep a point is below a height, m.
    Depth {
        /// The point.
        point: Attachment,
        /// h, m.
        height: Value,
    },
}

/// The angle of the second of two bodies against the first about the pin between them, 0 at the guess.
#[derive(Clone, Debug, PartialEq)]
pub struct Turning {
    /// The pin on both bodies.
    pub ends: [Attachment; 2],
    /// Unit vectors u and w of the first body, `u × w` along the pin.
    pub across: [Vector; 2],
    /// A unit vector of the second body, normal to the pin, and along u at the guess.
    pub reference: Vector,
}

/// The axis of a beam as seen from a pad on which the beam slides.
#[derive(Clone, Debug, PartialEq)]
pub struct Sliding {
    /// The pad: a point of a body.
    pub pad: Attachment,
    /// The beam that slides on it.
    pub beam: BeamAxis,
    /// `s₀` in `s = s₀ ± q_j`, the place of the beam at the pad, m from the beginning of the beam.
    pub start: Value,
    /// Whether the sign is positive.
    pub grows: bool,
    /// j
    pub coordinate: CoordinateId,
    /// What is measured.
    pub direction: PadDirection,
    /// Whether the pad does not give way. Of a force, its spring stands for the least that a section beside the pad gives way.
    pub exact: bool,
}

/// A direction in which a pad holds a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PadDirection {
    /// Along an axis of the body that carries the pad.
    Along(Axis),
    /// Against twist: `z · y`, with z of the body that carries the pad and y of the beam, the sine of the angle.
    Twist,
}

/// A line through points, straight between them: from one end to the other, for a rope over the sheaves between.
#[derive(Clone, Debug, PartialEq)]
pub struct StrainLine {
    /// Its points in order; at least two.
    pub points: Vec<Attachment>,
    /// How many times its last part counts: the falls of a block and tackle.
    pub falls: u32,
}

/// A straight part of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePart<'a> {
    /// Both of its points.
    pub ends: [&'a Attachment; 2],
    /// How many times it counts.
    pub falls: u32,
}

/// A point of a body or of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// The body; `None` for the world.
    pub body: Option<BodyId>,
    /// Position in the frame of the body or of the world, m.
    pub position: [Value; 3],
}

impl Strain {
    /// The line, if it is the length of one.
    #[must_use]
    pub fn line(&self) -> Option<&StrainLine> {
        match self {
            Strain::Line(line) => Some(line),
            Strain::Coordinate(_)
            | Strain::Coupling { .. }
            | Strain::Sliding(_)
            | Strain::Turning(_)
            | Strain::Depth { .. } => None,
        }
    }

    /// The points of a line, the point of a pad or on the ground, both ends of a pin, or none.
    #[must_use]
    pub fn points(&self) -> &[Attachment] {
        match self {
            Strain::Line(line) => &line.points,
            Strain::Sliding(sliding) => std::slice::from_ref(&sliding.pad),
            Strain::Turning(turning) => &turning.ends,
            Strain::Depth { point, .. } => std::slice::from_ref(point),
            Strain::Coordinate(_) | Strain::Coupling { .. } => &[],
        }
    }

    /// A beam as seen from a pad, if it is that.
    #[must_use]
    pub fn sliding(&self) -> Option<&Sliding> {
        match self {
            Strain::Sliding(sliding) => Some(sliding),
            Strain::Coordinate(_)
            | Strain::Coupling { .. }
            | Strain::Line(_)
            | Strain::Turning(_)
            | Strain::Depth { .. } => None,
        }
    }

    /// Whether a force acts between bodies: at a pad, in a pin of two bodies, or along a line of which some part is between two bodies.
    #[must_use]
    pub fn joins_bodies(&self) -> bool {
        match self {
            Strain::Line(line) => line.parts().any(LinePart::joins_bodies),
            Strain::Sliding(_) => true,
            Strain::Turning(turning) => turning.ends.iter().all(|end| end.body.is_some()),
            Strain::Coordinate(_) | Strain::Coupling { .. } | Strain::Depth { .. } => false,
        }
    }
}

impl StrainLine {
    /// A straight line between two points.
    #[must_use]
    pub fn between(ends: [Attachment; 2]) -> Self {
        StrainLine { points: ends.into(), falls: 1 }
    }

    /// Its straight parts, in order.
    pub fn parts(&self) -> impl Iterator<Item = LinePart<'_>> {
        let pairs = self.points.iter().zip(self.points.iter().skip(1)).enumerate();
        pairs.map(|(index, (one, other))| LinePart {
            ends: [one, other],
            falls: if index + 2 == self.points.len() { self.falls } else { 1 },
        })
    }
}

impl LinePart<'_> {
    /// Whether both of its points are on bodies.
    #[must_use]
    pub fn joins_bodies(self) -> bool {
        self.ends.iter().all(|end| end.body.is_some())
    }
}

impl Chain {
    /// The coordinates that change a strain, in the order of q: of a line, those that move only one point of some part.
    #[must_use]
    pub fn spanned(&self, strain: &Strain) -> Vec<CoordinateId> {
        match strain {
            Strain::Coordinate(coordinate) => vec![*coordinate],
            Strain::Line(line) => {
                let of_parts: BTreeSet<CoordinateId> = line.parts().flat_map(|part| self.changing(part)).collect();
                of_parts.into_iter().collect()
            }
            Strain::Coupling { coordinate: one, leader: other, .. } => vec![*one.min(other), *one.max(other)],
            Strain::Sliding(sliding) => self.changing_at(sliding),
            Strain::Turning(turning) => self.turned_by(turning),
            Strain::Depth { point, .. } => self.reach(point),
        }
    }

    /// The coordinates in terms of which a strain and its derivatives are expressed: all that move its points.
    #[must_use]
    pub fn read_by(&self, strain: &Strain) -> Vec<CoordinateId> {
        match strain {
            Strain::Line(line) => line.points.iter().flat_map(|point| self.reach(point)).collect(),
            Strain::Coordinate(_) | Strain::Coupling { .. } | Strain::Depth { .. } => self.spanned(strain),
            Strain::Turning(turning) => turning.ends.iter().flat_map(|end| self.reach(end)).collect(),
            // All that move the pad, the beam or both.
            Strain::Sliding(sliding) => [self.reach(&sliding.pad), self.coordinates_of(sliding.beam.last())].concat(),
        }
    }

    /// Whether a strain is a length or an angle.
    #[must_use]
    pub fn kind_of(&self, strain: &Strain) -> CoordinateKind {
        match strain {
            Strain::Line(_) | Strain::Depth { .. } => CoordinateKind::Translation,
            Strain::Turning(_) => CoordinateKind::Rotation,
            Strain::Sliding(sliding) => match sliding.direction {
                PadDirection::Along(_) => CoordinateKind::Translation,
                PadDirection::Twist => CoordinateKind::Rotation,
            },
            Strain::Coordinate(coordinate) | Strain::Coupling { coordinate, .. } => self.coordinates[coordinate.0].kind,
        }
    }

    /// The coordinates that change the length of a part of a line, in the order of q: those that move only one of its points.
    #[must_use]
    pub fn changing(&self, part: LinePart<'_>) -> Vec<CoordinateId> {
        self.between(&part.ends.map(|end| self.reach(end)))
    }

    /// The coordinates that turn a pin, in the order of q: those that move only one of its bodies.
    #[must_use]
    pub fn turned_by(&self, turning: &Turning) -> Vec<CoordinateId> {
        self.between(&turning.ends.each_ref().map(|end| self.reach(end)))
    }

    /// The coordinates that change what a pad measures, in the order of q: those that move the pad and the whole beam as one body do not.
    #[must_use]
    pub fn changing_at(&self, sliding: &Sliding) -> Vec<CoordinateId> {
        let [first, last] = [sliding.beam.first, sliding.beam.last()].map(|body| self.coordinates_of(body));
        let mut changing: BTreeSet<CoordinateId> =
            self.between(&[self.reach(&sliding.pad), last.clone()]).into_iter().collect();
        changing.extend(self.between(&[first, last]));
        changing.insert(sliding.coordinate);
        changing.into_iter().collect()
    }

    /// The distance between two points at a pose, m.
    #[must_use]
    pub fn distance(&self, ends: [&Attachment; 2], q: &[f64], parameters: &[f64]) -> f64 {
        let frames = self.frames(q, parameters);
        let place = |end: &Attachment| {
            let frame = end.body.map_or(Frame::WORLD, |BodyId(body)| frames[body]);
            frame.transform_point(end.position.each_ref().map(|x| x.at(parameters)))
        };
        let [one, other] = ends.map(place);
        (0..3).map(|i| (other[i] - one[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// The lengths of the straight parts of a line at a pose, m.
    #[must_use]
    pub fn distances(&self, line: &StrainLine, q: &[f64], parameters: &[f64]) -> Vec<f64> {
        line.parts().map(|part| self.distance(part.ends, q, parameters)).collect()
    }

    /// The length of a line at a pose, m.
    #[must_use]
    pub fn length(&self, line: &StrainLine, q: &[f64], parameters: &[f64]) -> f64 {
        let distances = self.distances(line, q, parameters);
        line.parts().zip(distances).map(|(part, distance)| f64::from(part.falls) * distance).sum()
    }

    /// The coordinates that move a point, in the order of q.
    #[must_use]
    pub fn reach(&self, end: &Attachment) -> Vec<CoordinateId> {
        end.body.map_or_else(Vec::new, |body| self.coordinates_of(body))
    }
}
