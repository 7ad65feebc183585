//! A valid crane: bodies on an open chain, with every reference resolved and every number checked.
//!
//! // AFTER THIS POINT: no stage knows about links, D-H rows, cross-sections or YAML, and a failure is a bug.

mod connector;
mod cut;
mod cylinder;
mod force;
mod frame;
mod input;
mod load;
mod loops;
mod parameter;
mod profile;
mod start;
mod value;

pub use connector::{Attachment, Connector, ConnectorLaw, Strain};
pub use cut::Cut;
pub use cylinder::{Cylinder, Linkage, Pin, Pump, Valve};
pub use force::{Bristle, End, ForceElement, Friction, Law, Stop};
pub use frame::{Frame, Vector};
pub use input::{Input, InputId};
pub use load::{Load, LoadAxes};
pub use loops::Loops;
pub use parameter::{Bound, Parameter, Refusal, Relation};
pub use profile::{Profile, Ramp, Segment};
pub use value::{ParameterId, Value};

/// Index of a coordinate in [`Chain::coordinates`], the order of `q`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CoordinateId(pub usize);

/// Index of a body in [`Chain::bodies`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(pub usize);

/// An open chain of bodies, the compiler's view of a crane.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Name of the crane, a valid Rust identifier.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// Hash of the YAML text (FNV-1a, 64 bit, hexadecimal), so that results can be traced to their input.
    pub spec_hash: String,
    /// Acceleration of gravity in the world frame, m/s².
    pub gravity: [Value; 3],
    /// Values that stay live at run time.
    pub parameters: Vec<Parameter>,
    /// Rules about several numbers of which some are live.
    pub relations: Vec<Relation>,
    /// Generalized coordinates `q`, Eq. (1).
    pub coordinates: Vec<Coordinate>,
    /// Bodies from the base to the tip; body `p` is attached to body `p − 1`, the first to the world.
    pub bodies: Vec<Body>,
    /// The base's coordinates in the order x, y, z, ψ, θ, φ; those that it has.
    pub base: [Option<CoordinateId>; 6],
    /// Supports of the base, Eqs. (16)–(18).
    pub supports: Vec<Support>,
    /// Data for the stresses of beams, beam by beam from the base to the tip.
    pub beams: Vec<Beam>,
    /// Springs and dampers between the rigid elements of flexible links, Eqs. (14)–(15).
    pub beam_springs: Vec<BeamSpring>,
    /// Drives, Eqs. (19)–(21).
    pub drives: Vec<Drive>,
    /// Viscous damping of passive joints.
    pub joint_dampers: Vec<JointDamper>,
    /// End stops and friction of joints.
    pub forces: Vec<ForceElement>,
    /// Forces and moments applied from outside.
    pub loads: Vec<Load>,
    /// Hydraulic cylinders of driven joints.
    pub cylinders: Vec<Cylinder>,
    /// What supplies the cylinders.
    pub pump: Option<Pump>,
    /// Elements between two points, and couplings of coordinates.
    pub connectors: Vec<Connector>,
    /// Inputs that are set between steps.
    pub inputs: Vec<Input>,
    /// Rotors that joints drive through gears.
    pub rotors: Vec<Rotor>,
    /// Points of interest.
    pub points: Vec<Point>,
    /// Start of the static solution; one number per coordinate, m or rad.
    pub guess: Vec<f64>,
    /// Settings of a run.
    pub run: Run,
    /// What the user wants to compute; the rest is left out.
    pub analyses: Analyses,
    /// When repeated work is a loop.
    pub loops: Loops,
}

/// A generalized coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Unique name, a valid Rust identifier, such as `boom_psi` or `boom_2_theta`.
    pub name: String,
    /// Translation (m) or rotation (rad).
    pub kind: CoordinateKind,
    /// The axis of its frame along which it translates or about which it rotates.
    pub axis: Axis,
    /// The first body that it moves.
    pub body: BodyId,
}

/// Kind of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateKind {
    /// Along the axis, m.
    Translation,
    /// About the axis, rad.
    Rotation,
}

/// Axis of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}

impl Axis {
    /// 0, 1, 2.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }
}

/// A body: a rigid link, a rigid finite element, or a massless frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Unique name, a valid Rust identifier: the link's, or `boom_0`, `boom_1` … for elements.
    pub name: String,
    /// Name of the link it belongs to.
    pub link: String,
    /// The transformation from the previous body's frame to this one's, T̃, as elementary steps in order.
    pub path: Vec<Step>,
    /// Mass properties about the origin of the body's frame; `None` for a massless frame.
    pub inertia: Option<Inertia>,
    /// The named parts combined into it, for tables.
    pub parts: Vec<Part>,
    /// Length along x for a rigid element, 0 otherwise, m; for pictures and moments along the beam.
    pub length: Value,
}

/// One factor of a homogeneous transformation T̃, Eq. (3).
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Constant translation, m.
    Translate([Value; 3]),
    /// Constant rotation about an axis, by its sine and cosine.
    Rotate {
        /// Axis of rotation.
        axis: Axis,
        /// Sine of the angle.
        sin: Value,
        /// Cosine of the angle.
        cos: Value,
    },
    /// Translation by a coordinate along its axis, or rotation by it about its axis.
    Move(CoordinateId),
    /// Rotation by the vector ρ whose components are three coordinates, one along each axis: `exp([ρ]×)`. They are
    /// consecutive in q.
    RotationVector([CoordinateId; 3]),
}

impl Step {
    /// The coordinates on which it depends.
    #[must_use]
    pub fn coordinates(&self) -> &[CoordinateId] {
        match self {
            Step::Translate(_) | Step::Rotate { .. } => &[],
            Step::Move(id) => std::slice::from_ref(id),
            Step::RotationVector(ids) => ids,
        }
    }
}

/// Pseudo-inertia `H = ∫ r rᵀ dm`, `r = [x y z 1]ᵀ`, about the origin of the body's frame, Eq. (4).
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    /// Mass, kg.
    pub mass: Value,
    /// Static moments `∫ r dm`, kg m.
    pub first: [Value; 3],
    /// `∫ x² dm, ∫ y² dm, ∫ z² dm, ∫ xy dm, ∫ xz dm, ∫ yz dm`, kg m².
    pub second: [Value; 6],
}

/// A named part of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name as written by the user.
    pub name: String,
    /// Mass, kg.
    pub mass: Value,
    /// Centre of mass in the body's frame, m.
    pub com: [Value; 3],
}

/// A support of the base: three springs and dampers along the world's axes, Eqs. (16)–(18).
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// Name.
    pub name: String,
    /// Attachment point in the frame of the first body, m.
    pub position: [Value; 3],
    /// Stiffness along x, y, z, N/m.
    pub stiffness: [Value; 3],
    /// Damping along x, y, z, N s/m.
    pub damping: [Value; 3],
    /// Free play δ along x, y, z, m.
    pub free_play: [Value; 3],
    /// Of a one-sided support, which presses and never pulls: the pressing force from which it holds sideways and damps in
    /// full, N. `None` where it pulls as well.
    pub full_hold: Option<Value>,
    /// How its elongation depends on the base's coordinates.
    pub kinematics: SupportKinematics,
}

/// How the elongation of a support depends on the base's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupportKinematics {
    /// `e = U q̃(1) − δ`, Eq. (16): small rotations.
    Linear,
    /// `e = T(1) r_E − r_E0 − δ`, `r_E0` its position at q̃(1) = 0: any rotation.
    Exact,
}

/// Spring and damper of a rigid element on one coordinate, Eqs. (14)–(15).
#[derive(Clone, Debug, PartialEq)]
pub struct BeamSpring {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// Stiffness, N m/rad.
    pub stiffness: Value,
    /// Damping, N m s/rad.
    pub damping: Value,
}

/// Data of a beam for pictures and for its stresses.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Name of the link.
    pub link: String,
    /// Outlines of its cross-section along it: between two places they change linearly, at a step two places coincide; one
    /// place if the section is the same everywhere, none if the spec does not give a shape.
    pub outlines: Vec<(Value, Outline)>,
    /// Moduli of the section where each of its elements begins; `None` if the spec does not give them.
    pub moduli: Vec<Option<Moduli>>,
    /// Yield stress over the safety factor, Pa; `None` without a yield stress.
    pub allowable_stress: Option<Value>,
}

/// Outline of a cross-section. Pictures need it; mechanics needs only areas and moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Height and width, along the link's y and z, m.
    pub size: [Value; 2],
    /// Whether it is an ellipse in that box instead of the box.
    pub round: bool,
}

/// Properties that relate forces and moments of a section to its largest stresses.
#[derive(Clone, Debug, PartialEq)]
pub struct Moduli {
    /// Area, m²: `σ = N/A`.
    pub area: Value,
    /// Moduli of bending about y and about z, m³: `σ = M/W`.
    pub bending: [Value; 2],
    /// Modulus of torsion, m³: the largest `τ = Mx/W`.
    pub torsion: Value,
    /// Shear areas along y and along z, m²: the largest `τ = Q/A`.
    pub shear: [Value; 2],
    /// Whether the stresses of both bendings add up in a corner; on a round section they are at right angles.
    pub has_corners: bool,
}

/// A drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The coordinate it drives.
    pub coordinate: CoordinateId,
    /// The transmission between its motion and the coordinate.
    pub transmission: Transmission,
    /// Prescribed motion of the transmission's far end.
    pub profile: Profile,
}

/// The transmission between a prescribed motion and the coordinate.
#[derive(Clone, Debug, PartialEq)]
pub enum Transmission {
    /// A spring and a damper, Eqs. (19)–(21).
    Flexible {
        /// Stiffness, N m/rad or N/m.
        stiffness: Value,
        /// Damping, N m s/rad or N s/m.
        damping: Value,
        /// The greatest effort of both together, N m or N.
        max_effort: Option<Value>,
        /// The greatest rate at which it drives, rad/s or m/s.
        max_rate: Option<f64>,
        /// The greatest power with which it drives, W.
        max_power: Option<f64>,
    },
    /// A rigid connection: the coordinate is prescribed.
    Rigid,
    /// The oil of a cylinder with a valve: at rest a spring, in motion the pressures are states.
    Oil {
        /// Stiffness at rest, N m/rad or N/m.
        stiffness: Value,
        /// The command of the valve over time, unless a servo follows the motion.
        opening: Option<Profile>,
    },
}

impl Drive {
    /// Stiffness and damping, if it is flexible.
    #[must_use]
    pub fn spring(&self) -> Option<(&Value, &Value)> {
        match &self.transmission {
            Transmission::Flexible { stiffness, damping, .. } => Some((stiffness, damping)),
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }

    /// Stiffness at rest, if oil moves it.
    #[must_use]
    pub fn oil(&self) -> Option<&Value> {
        match &self.transmission {
            Transmission::Oil { stiffness, .. } => Some(stiffness),
            Transmission::Flexible { .. } | Transmission::Rigid => None,
        }
    }

    /// The command of its valve over time, if it has one.
    #[must_use]
    pub fn opening(&self) -> Option<&Profile> {
        match &self.transmission {
            Transmission::Oil { opening, .. } => opening.as_ref(),
            Transmission::Flexible { .. } | Transmission::Rigid => None,
        }
    }

    /// Begin and end, s, of the intervals in which its motion and its valve's command are smooth.
    #[must_use]
    pub fn pieces(&self) -> Vec<[Value; 2]> {
        [Some(&self.profile), self.opening()].into_iter().flatten().flat_map(Profile::pieces).collect()
    }

    /// The greatest rate at which it drives, if it is limited.
    #[must_use]
    pub fn max_rate(&self) -> Option<f64> {
        match self.transmission {
            Transmission::Flexible { max_rate, .. } => max_rate,
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }

    /// The greatest power with which it drives, if it is limited.
    #[must_use]
    pub fn max_power(&self) -> Option<f64> {
        match self.transmission {
            Transmission::Flexible { max_power, .. } => max_power,
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }

    /// The greatest effort, if it is limited.
    #[must_use]
    pub fn max_effort(&self) -> Option<&Value> {
        match &self.transmission {
            Transmission::Flexible { max_effort, .. } => max_effort.as_ref(),
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }
}

/// Viscous damping of a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct JointDamper {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// Damping, N m s/rad or N s/m.
    pub damping: Value,
}

/// A rotor that a joint drives through a gear, given by its inertia reflected to the joint: `i² J`, i the gear ratio.
///
/// It only resists the joint's acceleration: its weight and its gyroscopic moments are neglected.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotor {
    /// The coordinate of the joint.
    pub coordinate: CoordinateId,
    /// Reflected inertia, kg m² or kg.
    pub armature: Value,
}

/// A point of interest fixed to a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Unique name, a valid Rust identifier.
    pub name: String,
    /// The body that carries it.
    pub body: BodyId,
    /// Position in the body's frame, m.
    pub position: [Value; 3],
}

/// Settings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Simulated time, s.
    pub duration: f64,
    /// Step of the integrator, s.
    pub step: f64,
    /// Interval of the recorded results, s.
    pub output: f64,
}

/// What to compute: a set of independent choices.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Analyses {
    /// Static residual and tangent stiffness.
    pub statics: bool,
    /// Mass matrix, bias, kinetic energy and power.
    pub dynamics: bool,
    /// Linearisation: A, K and D at a pose.
    pub modes: bool,
    /// Forces and moments that joints, beam sections and the ground transmit.
    pub internal_forces: bool,
    /// ∂T/∂q and ∂²T/∂q∂q of every body.
    pub derivatives: bool,
    /// Eight cranes per call, for simulations of many; needs dynamics.
    pub ensemble: bool,
}

impl Analyses {
    /// The analyses that the command needs.
    pub const COMMAND: Analyses = Analyses { derivatives: false, ..Analyses::ALL };
    /// All analyses of one crane, for checks.
    pub const ALL: Analyses = Analyses {
        statics: true,
        dynamics: true,
        modes: true,
        internal_forces: true,
        derivatives: true,
        ensemble: false,
    };
}

impl Chain {
    /// Number of coordinates of the chain up to and including a body: `n_dof(p)`, Eq. (2).
    #[must_use]
    pub fn degrees_of_freedom(&self, body: BodyId) -> usize {
        self.bodies[..=body.0].iter().flat_map(|b| &b.path).map(|step| step.coordinates().len()).sum()
    }

    /// Whether a coordinate is a component of a rotation vector.
    #[must_use]
    pub fn turns_by_vector(&self, id: CoordinateId) -> bool {
        let mut steps = self.bodies.iter().flat_map(|body| &body.path);
        steps.any(|step| matches!(step, Step::RotationVector(ids) if ids.contains(&id)))
    }

    /// The end stops.
    pub fn stops(&self) -> impl Iterator<Item = (CoordinateId, &Stop)> {
        self.forces.iter().filter_map(|element| match &element.law {
            Law::Stop(stop) => Some((element.coordinate, stop)),
            Law::Friction(_) => None,
        })
    }

    /// Joints with friction.
    pub fn frictions(&self) -> impl Iterator<Item = (CoordinateId, &Friction)> {
        self.forces.iter().filter_map(|element| match &element.law {
            Law::Friction(friction) => Some((element.coordinate, friction)),
            Law::Stop(_) => None,
        })
    }

    /// Joints that stick.
    pub fn bristles(&self) -> impl Iterator<Item = (CoordinateId, Bristle)> {
        self.frictions().filter_map(|(coordinate, friction)| Some((coordinate, friction.bristle?)))
    }

    /// Whether forces have states besides pose and rates: oil, and bristles of joints that stick.
    #[must_use]
    pub fn has_own_states(&self) -> bool {
        self.has_valves() || self.bristles().next().is_some()
    }

    /// Coordinates with end stops, each once.
    #[must_use]
    pub fn stopped(&self) -> Vec<CoordinateId> {
        let mut stopped: Vec<CoordinateId> = self.stops().map(|(coordinate, _)| coordinate).collect();
        stopped.dedup();
        stopped
    }

    /// Whether some support presses and never pulls.
    #[must_use]
    pub fn has_one_sided_supports(&self) -> bool {
        self.supports.iter().any(|support| support.full_hold.is_some())
    }

    /// Whether some drive has a greatest effort.
    #[must_use]
    pub fn has_limited_drives(&self) -> bool {
        self.drives.iter().any(|drive| drive.max_effort().is_some())
    }

    /// Whether oil moves a joint, through a cylinder with a valve.
    #[must_use]
    pub fn has_valves(&self) -> bool {
        self.cylinders.iter().any(|cylinder| cylinder.valve.is_some())
    }

    /// Rigid drives: their coordinates are prescribed, not unknown.
    pub fn rigid_drives(&self) -> impl Iterator<Item = &Drive> {
        self.drives.iter().filter(|drive| drive.transmission == Transmission::Rigid)
    }

    /// Whether a coordinate is prescribed.
    #[must_use]
    pub fn is_prescribed(&self, id: CoordinateId) -> bool {
        self.rigid_drives().any(|drive| drive.coordinate == id)
    }

    /// Parameter values unless set at run time.
    #[must_use]
    pub fn parameter_defaults(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.default).collect()
    }
}
