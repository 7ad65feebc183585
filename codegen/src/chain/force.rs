//! Forces: laws of strains.

use super::{Axis, BeamAxis, Chain, Coordinate, CoordinateId, Profile, Strain, Value};

/// A force that resists the growth of a strain s: `F(s, ṡ)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Force {
    /// The group to which it belongs.
    pub group: Group,
    /// Name: that of its coordinate, or a unique one of its own.
    pub name: String,
    /// How s is measured.
    pub strain: Strain,
    /// How F depends on s and its rate.
    pub law: Law,
}

/// A group of forces whose sum, energy and columns of results have a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Springs and dampers between the rigid elements of flexible links, Eqs. (14)–(15).
    Elements,
    /// Viscous damping of passive joints.
    JointDampers,
    /// End stops of joints.
    Stops,
    /// Friction of joints.
    Friction,
    /// Elements between two points, and couplings of coordinates.
    Connectors,
}

macro_rules! laws {
    ($($(#[$doc:meta])* $law:ident as $written:ident: $expecting:literal {
        $($(#[doc = $about:literal])* #[key(unit = $unit:literal, limit = $limit:ident)] $key:ident: $number:ty;)*
    })*) => {
        /// How a force depends on its strain s.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Law {
            $($(#[$doc])* $law($law),)*
            /// A rope, which pulls and never pushes.
            Rope(Rope),
            /// A pad with clearance.
            Clearance(Clearance),
            /// An end stop.
            Stop(Stop),
            /// Friction of a joint.
            Friction(Friction),
        }

        $($(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $law {
            $($(#[doc = $about])* #[doc = concat!(" In ", $unit, ".")] pub $key: Value,)*
        })*

        impl Law {
            /// The length at which a law between two points exerts no force; for a rope at the start.
            #[must_use]
            pub fn length(&self, parameters: &[f64]) -> Option<f64> {
                match self {
                    $(Law::$law(law) => Some(law.length.at(parameters)),)*
                    Law::Rope(rope) => Some(rope.length.start(parameters)),
                    Law::Clearance(_) | Law::Stop(_) | Law::Friction(_) => None,
                }
            }
        }
    };
}

point_laws!(laws);

/// A rope, or the ground below a point, with the depth as its strain and no length of its own: `F = k σ max(0, 1 + a σ̇)` with `σ = max(0, s − ℓ₀(t))`.
#[derive(Clone, Debug, PartialEq)]
pub struct Rope {
    /// k.
    pub stiffness: RopeStiffness,
    /// a, s/m.
    pub damping: Value,
    /// ℓ₀(t), m: its length without force; a winch changes it.
    pub length: Profile,
    /// The largest tension at work, N; it has no mechanical effect.
    pub max_tension: Option<f64>,
}

/// A pad on both sides of what it holds, with clearance: `F = k (s − h + h/1000) + d ṡ` with `h = clamp(s, −c, c)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearance {
    /// k, N/m or N m/rad.
    pub stiffness: Value,
    /// d, N s/m or N m s/rad.
    pub damping: Value,
    /// c on each side, m or rad.
    pub clearance: Value,
}

/// The stiffness k of a rope.
#[derive(Clone, Debug, PartialEq)]
pub enum RopeStiffness {
    /// k, N/m: the same for every length.
    Whole(Value),
    /// EA, N, of a rope that a winch winds: `k = EA/ℓ₀(t)`.
    Axial(Value),
}

/// An end stop, which pushes when the coordinate is beyond it and never pulls: with the penetration `δ`,
/// `F = k δ max(0, 1 + a δ̇)`.
///
/// K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440, with a linear spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Its position, rad or m.
    pub at: Value,
    /// Which end of the joint's range it is.
    pub end: End,
    /// k, N m/rad or N/m.
    pub stiffness: Value,
    /// a, s/rad or s/m.
    pub damping: Value,
}

/// An end of a joint's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The minimum of the coordinate.
    Lower,
    /// The maximum.
    Upper,
}

/// Friction of a joint, `F = (F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) + b q̇`: Coulomb friction with a Stribeck decline,
/// smooth where the motion reverses.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// `F_c`, N m or N.
    pub coulomb: Value,
    /// `F_b`, N m or N, and `v_s`, rad/s or m/s, if the breakaway friction is larger.
    pub breakaway: Option<(Value, Value)>,
    /// v₀, rad/s or m/s: at this rate friction reaches three quarters of its full value.
    pub width: Value,
    /// b, N m s/rad or N s/m.
    pub viscous: Value,
    /// Bristles, if the joint sticks.
    pub bristle: Option<Bristle>,
}

/// Bristle friction, with the deflection as a state of the motion; the force element then contains only the viscous friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristle {
    /// `F_c`, N m or N.
    pub coulomb: f64,
    /// `F_b`, N m or N.
    pub breakaway: f64,
    /// `v_s`, rad/s or m/s.
    pub stribeck: f64,
    /// σ₀, N m/rad or N/m.
    pub stiffness: f64,
    /// σ₁, N m s/rad or N s/m.
    pub damping: f64,
}

impl Spring {
    /// A spring without force at 0.
    #[must_use]
    pub fn new(stiffness: Value, damping: Value) -> Self {
        Spring { stiffness, damping, length: Value::ZERO }
    }
}

impl Force {
    /// A force on a coordinate.
    #[must_use]
    pub fn on(chain: &[super::Coordinate], group: Group, id: CoordinateId, law: Law) -> Self {
        Force { group, name: chain[id.0].name.clone(), strain: Strain::Coordinate(id), law }
    }

    /// Whether it acts on one coordinate, and on which.
    #[must_use]
    pub fn coordinate(&self) -> Option<CoordinateId> {
        match self.strain {
            Strain::Coordinate(id) => Some(id),
            Strain::Line(_)
            | Strain::Coupling { .. }
            | Strain::Sliding(_)
            | Strain::Turning(_)
            | Strain::Depth { .. } => None,
        }
    }

    /// Its spring and damper, if it is one.
    #[must_use]
    pub fn spring(&self) -> Option<&Spring> {
        match &self.law {
            Law::Spring(spring) => Some(spring),
            _ => None,
        }
    }

    /// Whether it is a rope.
    #[must_use]
    pub fn is_rope(&self) -> bool {
        matches!(self.law, Law::Rope(_)) && !self.is_contact()
    }

    /// The largest tension that a rope may carry at work, N.
    #[must_use]
    pub fn max_tension(&self) -> Option<f64> {
        match &self.law {
            Law::Rope(rope) => rope.max_tension,
            _ => None,
        }
    }

    /// Whether it is the contact of a point with the ground.
    #[must_use]
    pub fn is_contact(&self) -> bool {
        matches!(self.strain, Strain::Depth { .. })
    }

    /// The motion of its winch.
    #[must_use]
    pub fn winch(&self) -> Option<&Profile> {
        match &self.law {
            Law::Rope(Rope { length, .. }) if !matches!(length, Profile::Hold(_)) => Some(length),
            _ => None,
        }
    }

    /// How a coordinate follows another one, if it is a coupling with a spring.
    #[must_use]
    pub fn follower(&self) -> Option<Follower> {
        let Strain::Coupling { coordinate, leader, ratio } = &self.strain else { return None };
        let Spring { length, .. } = self.spring()?;
        let (coordinate, leader) = (*coordinate, *leader);
        Some(Follower { coordinate, leader, ratio: ratio.clone(), offset: length.clone() })
    }

    /// Number of intervals in which its winch moves smoothly.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.winch().map_or(0, |length| length.pieces().len())
    }
}

/// A coordinate that follows another one: `q_j = r q_i + c`.
#[derive(Clone, Debug, PartialEq)]
pub struct Follower {
    /// The coordinate, j.
    pub coordinate: CoordinateId,
    /// That which it follows, i.
    pub leader: CoordinateId,
    /// r
    pub ratio: Value,
    /// c, m or rad.
    pub offset: Value,
}

impl Follower {
    /// Where it is if the other one is at `leading`, m or rad.
    #[must_use]
    pub fn place(&self, leading: f64, parameters: &[f64]) -> f64 {
        self.offset.at(parameters) + self.ratio.at(parameters) * leading
    }

    /// Both coordinates, in the order of q.
    #[must_use]
    pub fn coordinates(&self) -> Vec<CoordinateId> {
        let Self { coordinate: one, leader: other, .. } = self;
        vec![*one.min(other), *one.max(other)]
    }
}

/// Of springs between elements, those against twist of a beam, section by section.
pub fn twist_springs<'a>(
    springs: &'a [Force],
    coordinates: &'a [Coordinate],
    beam: &BeamAxis,
) -> impl Iterator<Item = &'a Spring> + use<'a> {
    let (first, last) = (beam.first, beam.last());
    let twists = move |CoordinateId(id): CoordinateId| {
        let Coordinate { axis, body, .. } = coordinates[id];
        axis == Axis::X && (first < body && body <= last)
    };
    springs.iter().filter(move |force| force.coordinate().is_some_and(twists)).filter_map(Force::spring)
}

impl Chain {
    /// The forces of a group.
    #[must_use]
    pub fn forces_of_group(&self, group: Group) -> &[Force] {
        let first = self.forces.partition_point(|force| force.group < group);
        let end = self.forces.partition_point(|force| force.group <= group);
        &self.forces[first..end]
    }

    /// Elements between two points, and couplings of coordinates.
    #[must_use]
    pub fn connectors(&self) -> &[Force] {
        self.forces_of_group(Group::Connectors)
    }

    /// Coordinates that follow others, through springs or exactly.
    pub fn followers(&self) -> impl Iterator<Item = Follower> + '_ {
        let exact = self.rigid_couplings.iter().map(|coupling| coupling.follower.clone());
        self.connectors().iter().filter_map(Force::follower).chain(exact)
    }

    /// Springs and dampers between the elements of flexible links.
    pub fn element_springs(&self) -> impl Iterator<Item = &Spring> {
        self.forces_of_group(Group::Elements).iter().filter_map(Force::spring)
    }

    /// Whether a coordinate is one of an element of a flexible link.
    #[must_use]
    pub fn is_of_element(&self, id: CoordinateId) -> bool {
        self.forces_of_group(Group::Elements).iter().any(|spring| spring.coordinate() == Some(id))
    }

    /// Joints with friction.
    pub fn frictions(&self) -> impl Iterator<Item = (CoordinateId, &Friction)> {
        self.forces_of_group(Group::Friction).iter().filter_map(|force| match &force.law {
            Law::Friction(friction) => Some((force.coordinate()?, friction)),
            _ => None,
        })
    }

    /// Joints that stick.
    pub fn bristles(&self) -> impl Iterator<Item = (CoordinateId, Bristle)> {
        self.frictions().filter_map(|(coordinate, friction)| Some((coordinate, friction.bristle?)))
    }

    /// Coordinates with end stops, each once.
    #[must_use]
    pub fn stopped(&self) -> Vec<CoordinateId> {
        let mut stopped: Vec<CoordinateId> =
            self.forces_of_group(Group::Stops).iter().filter_map(Force::coordinate).collect();
        stopped.dedup();
        stopped
    }
}
