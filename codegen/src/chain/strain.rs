//! Strains: lengths and angles that depend on the pose, on which forces act.

use super::{BodyId, Chain, CoordinateId, CoordinateKind, Frame, Value};

/// A length or an angle that depends on the pose.
#[derive(Clone, Debug, PartialEq)]
pub enum Strain {
    /// A coordinate, m or rad.
    Coordinate(CoordinateId),
    /// The distance between two points, m.
    Distance([Attachment; 2]),
    /// `q_j − r q_i`, m or rad: how far a coordinate is from the position given by its leader.
    Coupling {
        /// j
        coordinate: CoordinateId,
        /// i
        leader: CoordinateId,
        /// r
        ratio: Value,
    },
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
    /// The points, if it is the distance between two.
    #[must_use]
    pub fn ends(&self) -> Option<&[Attachment; 2]> {
        match self {
            Strain::Distance(ends) => Some(ends),
            Strain::Coordinate(_) | Strain::Coupling { .. } => None,
        }
    }

    /// Whether it is the distance between points of two bodies.
    #[must_use]
    pub fn joins_bodies(&self) -> bool {
        self.ends().is_some_and(|ends| ends.iter().all(|end| end.body.is_some()))
    }
}

impl Chain {
    /// The coordinates that change a strain, in the order of q: between two points, those that move only one of them.
    #[must_use]
    pub fn spanned(&self, strain: &Strain) -> Vec<CoordinateId> {
        match strain {
            Strain::Coordinate(coordinate) => vec![*coordinate],
            Strain::Distance(ends) => self.between(&ends.each_ref().map(|end| self.reach(end))),
            Strain::Coupling { coordinate: one, leader: other, .. } => vec![*one.min(other), *one.max(other)],
        }
    }

    /// The coordinates in terms of which a strain and its derivatives are expressed: all that move its points.
    #[must_use]
    pub fn read_by(&self, strain: &Strain) -> Vec<CoordinateId> {
        match strain {
            Strain::Distance(ends) => ends.iter().flat_map(|end| self.reach(end)).collect(),
            Strain::Coordinate(_) | Strain::Coupling { .. } => self.spanned(strain),
        }
    }

    /// Whether a strain is a length or an angle.
    #[must_use]
    pub fn kind_of(&self, strain: &Strain) -> CoordinateKind {
        match strain {
            Strain::Distance(_) => CoordinateKind::Translation,
            Strain::Coordinate(coordinate) | Strain::Coupling { coordinate, .. } => self.coordinates[coordinate.0].kind,
        }
    }

    /// The distance between two points at a pose, m.
    #[must_use]
    pub fn distance(&self, ends: &[Attachment; 2], q: &[f64], parameters: &[f64]) -> f64 {
        let frames = self.frames(q, parameters);
        let place = |end: &Attachment| {
            let frame = end.body.map_or(Frame::WORLD, |BodyId(body)| frames[body]);
            frame.transform_point(end.position.each_ref().map(|x| x.at(parameters)))
        };
        let [one, other] = ends.each_ref().map(place);
        (0..3).map(|i| (other[i] - one[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// The coordinates that move a point, in the order of q.
    #[must_use]
    pub fn reach(&self, end: &Attachment) -> Vec<CoordinateId> {
        end.body.map_or_else(Vec::new, |body| self.coordinates_of(body))
    }
}
