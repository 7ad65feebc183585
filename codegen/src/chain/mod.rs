//! A valid crane: bodies that form a tree, with every reference resolved and every number checked.
//!
//! // AFTER THIS POINT: no stage knows about links, D-H rows, cross-sections or YAML, and a failure is a bug.

mod beam;
mod beam_axis;
mod body;
mod count;
mod cut;
mod cylinder;
mod description;
mod drive;
mod force;
mod frame;
mod input;
mod load;
mod loop_joint;
mod loops;
mod name;
mod parameter;
mod profile;
mod result_names;
mod run;
mod shape;
mod stage;
mod start;
mod strain;
mod support;
mod tree;
mod value;

pub use beam::{Beam, Inside, Moduli, Outline, Section};
pub use beam_axis::{BeamAxis, Division, Stretch};
pub use body::{Axis, Body, Coordinate, Inertia, LinkPart, Step};
pub use crane_quantities::{Bound, ConditionInfo, CoordinateKind, EventInfo, JoinsInfo, Moment, Refusal, Side};
pub use cut::Cut;
pub use cylinder::{Cylinder, Linkage, Pin, Pump, Valve};
pub use drive::{Drive, Rotor, Transmission};
pub use force::*;
pub use frame::{Frame, Vector, cross};
pub use input::{Input, InputId};
pub use load::{Combination, Load, LoadAxes};
pub use loop_joint::{Across, LoopEquation, LoopJoint, LoopJointKind, RigidCoupling, normalised};
pub use loops::Loops;
pub(crate) use name::{CRATES, LONGEST_NAME};
pub use parameter::{Parameter, Relation};
pub use profile::{Derivative, Profile, Ramp, Segment, first_jump, jumps};
pub use result_names::ResultNames;
pub use run::{Analyses, Run};
pub use shape::{Form, Shape, Surface};
pub use stage::Stage;
pub use strain::{Attachment, LinePart, PadDirection, Sliding, Strain, StrainLine, Turning};
pub use support::{Support, SupportKinematics};
pub use value::{ParameterId, Value};

/// Index of a coordinate in [`Chain::coordinates`], the order of `q`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CoordinateId(pub usize);

/// Index of a body in [`Chain::bodies`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(pub usize);

/// A chain of bodies, the compiler's view of a crane: open, and with branches where several bodies are attached to one.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Name of the crane, a valid Rust identifier.
    pub name: String,
    /// One-line title for the reader.
    pub title: String,
    /// Hash of the YAML text (FNV-1a, 64 bit, hexadecimal), so that results can be traced to their input.
    pub spec_hash: String,
    /// Acceleration of gravity in the world frame, m/s².
    pub gravity: [Value; 3],
    /// Values that stay live at run time.
    pub parameters: Vec<Parameter>,
    /// Rules about several numbers, some of which are live.
    pub relations: Vec<Relation>,
    /// Generalized coordinates `q`, Eq. (1).
    pub coordinates: Vec<Coordinate>,
    /// Bodies, each after the one to which it is attached; the first is attached to the world.
    pub bodies: Vec<Body>,
    /// The base's coordinates in the order x, y, z, ψ, θ, φ; `None` for those that it lacks.
    pub base: [Option<CoordinateId>; 6],
    /// Supports of the base, Eqs. (16)–(18).
    pub supports: Vec<Support>,
    /// Data for the stresses of beams, beam by beam from the base to the tip.
    pub beams: Vec<Beam>,
    /// Drives, Eqs. (19)–(21).
    pub drives: Vec<Drive>,
    /// Laws of strains, in the order of their groups.
    pub forces: Vec<Force>,
    /// External forces and moments.
    pub loads: Vec<Load>,
    /// Combinations of weights and loads.
    pub combinations: Vec<Combination>,
    /// The one with which it is computed: gravity, loads and masses have its factors.
    pub combination: Option<String>,
    /// Hydraulic cylinders of driven joints.
    pub cylinders: Vec<Cylinder>,
    /// The pump that supplies the cylinders.
    pub pump: Option<Pump>,
    /// Joints that close loops.
    pub loop_joints: Vec<LoopJoint>,
    /// Couplings that hold exactly.
    pub rigid_couplings: Vec<RigidCoupling>,
    /// Inputs that are set between steps.
    pub inputs: Vec<Input>,
    /// Rotors that joints drive through gears.
    pub rotors: Vec<Rotor>,
    /// Frames with names of their own.
    pub frames: Vec<NamedFrame>,
    /// Joints with names of their own.
    pub joints: Vec<NamedJoint>,
    /// Points of interest.
    pub points: Vec<Point>,
    /// What links look like, as far as the spec says so.
    pub shapes: Vec<Shape>,
    /// Where statics begins, or the run if there is no static solution, as far as the spec says so, rad and m.
    pub written_guess: Vec<Option<f64>>,
    /// The whole pose with default parameters, [`guess_at`](Self::guess_at).
    pub guess: Vec<f64>,
    /// Settings of a run.
    pub run: Run,
    /// What happens during a run, in the order of time.
    pub events: Vec<EventInfo>,
    /// What the user wants to compute; the rest is left out.
    pub analyses: Analyses,
    /// When repeated work becomes a loop.
    pub loops: Loops,
}

/// A joint with a name of its own, at `q_j + at`, or, without a coordinate, at `at`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedJoint {
    /// Unique name, any text.
    pub name: String,
    /// Its coordinate, j; `None` if it does not move.
    pub coordinate: Option<CoordinateId>,
    /// m or rad.
    pub at: f64,
}

/// A frame with a name of its own, fixed to a body or to the world.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFrame {
    /// Unique name, any text.
    pub name: String,
    /// The body that carries it; `None` for the world.
    pub body: Option<BodyId>,
    /// The way to it from the frame of the body: translations and rotations.
    pub path: Vec<Step>,
}

impl NamedFrame {
    /// Its pose in the frame of the body, or in the world.
    ///
    /// # Panics
    /// If `parameters` is shorter than the chain's list of parameters.
    #[must_use]
    pub fn pose(&self, chain: &Chain, parameters: &[f64]) -> Frame {
        self.path.iter().fold(Frame::WORLD, |frame, step| frame.after(step, chain, &[], parameters))
    }

    /// A point given in it, in the frame of the body, m.
    #[must_use]
    pub fn transform_point(&self, local: [Value; 3]) -> [Value; 3] {
        self.path.iter().rfold(local, |[x, y, z], step| match step {
            Step::Translate([a, b, c]) => [x + a.clone(), y + b.clone(), z + c.clone()],
            Step::Rotate { axis, sin, cos } => {
                let turned = |u: Value, w: Value| {
                    (cos.clone() * u.clone() - sin.clone() * w.clone(), sin.clone() * u + cos.clone() * w)
                };
                match axis {
                    Axis::X => {
                        let (y, z) = turned(y, z);
                        [x, y, z]
                    }
                    Axis::Y => {
                        let (z, x) = turned(z, x);
                        [x, y, z]
                    }
                    Axis::Z => {
                        let (x, y) = turned(x, y);
                        [x, y, z]
                    }
                }
            }
            Step::Move(_) | Step::RotationVector(_) => [x, y, z],
        })
    }
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

impl Chain {
    /// Maximum number of coordinates: far more than make sense, and few enough for the registers of live cranes.
    pub const MOST_COORDINATES: usize = 3000;
    /// Maximum number of coordinates for which derivatives of the residual are derived: two million operations in straight-line code.
    pub const MOST_COORDINATES_OF_DERIVATIVES: usize = 250;

    /// Whether a coordinate is a component of a rotation vector.
    #[must_use]
    pub fn turns_by_vector(&self, id: CoordinateId) -> bool {
        let mut steps = self.bodies.iter().flat_map(|body| &body.path);
        steps.any(|step| matches!(step, Step::RotationVector(ids) if ids.contains(&id)))
    }

    /// Whether forces have states in addition to pose and rates: oil, and bristles of joints that stick.
    #[must_use]
    pub fn has_force_states(&self) -> bool {
        self.has_valves() || self.bristles().next().is_some()
    }

    /// Whether any support is one-sided: it presses and never pulls.
    #[must_use]
    pub fn has_one_sided_supports(&self) -> bool {
        self.supports.iter().any(|support| support.friction.is_some())
    }

    /// Whether any drive has a maximum effort.
    #[must_use]
    pub fn has_limited_drives(&self) -> bool {
        self.drives.iter().any(|drive| drive.max_effort().is_some())
    }

    /// Whether any joint is moved by a cylinder with a valve.
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
