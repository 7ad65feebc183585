//! Connectors: elements between two points, or between two coordinates.

use super::{BodyId, Chain, CoordinateId, CoordinateKind, Frame, Profile, Value};

/// An element whose force F(ℓ, ℓ̇) resists the growth of its length ℓ.
#[derive(Clone, Debug, PartialEq)]
pub struct Connector {
    /// Unique name.
    pub name: String,
    /// How ℓ is measured.
    pub strain: Strain,
    /// How F depends on ℓ.
    pub law: ConnectorLaw,
}

/// The length of a connector.
#[derive(Clone, Debug, PartialEq)]
pub enum Strain {
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

/// How the force of a connector depends on its length.
#[derive(Clone, Debug, PartialEq)]
pub enum ConnectorLaw {
    /// `F = k (ℓ − ℓ₀) + d ℓ̇ − P`: a spring and a damper; a gas spring pushes with P at ℓ₀, and with more when it is shorter.
    Linear {
        /// k, N/m.
        stiffness: Value,
        /// d, N s/m.
        damping: Value,
        /// ℓ₀, m.
        length: Value,
        /// P, N.
        push: Value,
    },
    /// `F = k σ max(0, 1 + a σ̇)` with `σ = max(0, ℓ − ℓ₀(t))`: a rope, which pulls and never pushes.
    Rope {
        /// k, N/m.
        stiffness: Value,
        /// a, s/m.
        damping: Value,
        /// ℓ₀(t), m: its length without force; a winch changes it.
        length: Profile,
    },
}

impl Connector {
    /// Number of intervals in which its winch moves smoothly.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.winch().map_or(0, |length| length.pieces().len())
    }

    /// Whether it pulls two bodies together.
    #[must_use]
    pub fn joins_bodies(&self) -> bool {
        matches!(&self.strain, Strain::Distance(ends) if ends.iter().all(|end| end.body.is_some()))
    }

    /// The motion of its winch.
    #[must_use]
    pub fn winch(&self) -> Option<&Profile> {
        match &self.law {
            ConnectorLaw::Rope { length: Profile::Hold(_), .. } | ConnectorLaw::Linear { .. } => None,
            ConnectorLaw::Rope { length, .. } => Some(length),
        }
    }
}

impl Chain {
    /// The range of coordinates that change the length of a connector, the first and one past the last: between two points, those that
    /// move only one of them.
    #[must_use]
    pub fn spanned(&self, connector: &Connector) -> [usize; 2] {
        match &connector.strain {
            Strain::Distance(ends) => {
                let [one, other] = ends.each_ref().map(|end| self.reach(end));
                [one.min(other), one.max(other)]
            }
            Strain::Coupling { coordinate: CoordinateId(one), leader: CoordinateId(other), .. } => {
                [*one.min(other), *one.max(other) + 1]
            }
        }
    }

    /// Whether the length of a connector is a length or an angle.
    #[must_use]
    pub fn kind_of(&self, connector: &Connector) -> CoordinateKind {
        match &connector.strain {
            Strain::Distance(_) => CoordinateKind::Translation,
            Strain::Coupling { coordinate, .. } => self.coordinates[coordinate.0].kind,
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

    /// Number of coordinates that move a point: they are the first ones of the chain.
    #[must_use]
    pub fn reach(&self, end: &Attachment) -> usize {
        end.body.map_or(0, |body| self.degrees_of_freedom(body))
    }
}
