//! The spec language as written: one type per mapping, whose doc comments are its documentation and its JSON Schema.
//!
//! The type of a key defines its allowed values; [`Given`] holds its location. An optional key is an `Option`.

mod beam;
mod connector;
mod cylinder;
mod drive;
mod given;
mod inertia;
mod input;
mod joint;
mod link;
mod load;
mod placement;
mod scalar;
mod schema;
mod support;

pub use beam::{
    Beam, BeamDamping, BeamPart, Bend, Directions, Element, Material, Moduli, Section, SectionJoint, Sections, Spring,
};
pub use connector::{Attachment, Connector, ConnectorLaw, Coupling, GasSpring, PointSpring, Rope};
pub use cylinder::{Cylinder, HoseVolumes, Linkage, Pin, Pump, Side, Valve};
pub use drive::{Drive, Motion, Ramp, Speed, Table, Trapezoid};
pub(crate) use given::{EITHER, GIVEN, MANY};
pub use given::{Either, Entries, Given, Many};
pub use inertia::{About, Inertia};
pub use input::Input;
pub use joint::{Bristle, Friction, Stops};
pub use link::{BaseCoordinate, Body, Joint, JointAxis, Link};
pub use load::{Axes, Load};
pub use placement::{AxisName, ClassicDh, ModifiedDh, Placement, Transform, Turn};
pub use scalar::{Angle, Constant, FixedAngle, Number, Scalar, Vector, parse_angle};
pub use schema::json_schema;
pub use support::{Kinematics, Point, Support};

use schemars::JsonSchema;
use serde::Deserialize;

use crate::diagnostic::Mistake;

/// A crane as written, with the mistakes found while reading it; [`validate`](crate::validate()) reports them together with
/// its own.
#[derive(Clone, Debug)]
pub struct CraneSpec {
    /// The contents of the file.
    pub crane: Crane,
    /// Mistakes of keys and shapes.
    pub(crate) mistakes: Vec<Mistake>,
}

/// A crane: an open chain of links from the base to the tip. Every number is in SI units; the name of an entry of
/// `parameters` can replace a number, which keeps it live at run time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of keys to values")]
pub struct Crane {
    /// Another spec to start from: a file, relative to this one, or a shipped crane. This file then says only what differs: mappings
    /// are merged key by key, lists of links, supports, drives and points entry by entry, by `name` or `coordinate`; everything
    /// else is replaced. A key without a value removes what it names, and so does `remove: true` in an entry of a list.
    pub extends: Option<Given<String>>,
    /// Version of the spec language: 1.
    pub format: Given<Constant>,
    /// Name of the crane, a `snake_case` identifier; names the generated module.
    pub name: Given<String>,
    /// One line for people. Default: the name.
    pub title: Option<Given<String>>,
    /// Acceleration of gravity in the world frame, m/s². Default `[0, 0, -9.81]`.
    pub gravity: Option<Given<Vector>>,
    /// Quantities to compute; the rest is left out of the generated code. Default `[statics, dynamics, modes]`.
    pub analyses: Option<Given<Vec<Given<Analysis>>>>,
    /// Whether generated code loops over equal elements or is written out. Default `auto`.
    pub loops: Option<Given<Loops>>,
    /// Values that stay live at run time, by name.
    pub parameters: Option<Given<Entries<Parameter>>>,
    /// Numbers that are set between steps, by name.
    pub inputs: Option<Given<Entries<Input>>>,
    /// Materials of beams, by name.
    pub materials: Option<Given<Entries<Material>>>,
    /// The links in order from the base to the tip; each is attached to the previous one.
    pub links: Given<Vec<Given<Link>>>,
    /// Springs and dampers between a free base and the ground.
    pub supports: Option<Given<Vec<Given<Support>>>>,
    /// Drives of joints.
    pub drives: Option<Given<Vec<Given<Drive>>>>,
    /// Viscous damping of passive joints by coordinate, N m s/rad or N s/m.
    pub damping: Option<Given<Entries<Number>>>,
    /// Rotor inertia of joints without a drive by coordinate, reflected by the square of the gear ratio, kg m² or kg.
    pub armature: Option<Given<Entries<Number>>>,
    /// End stops of joints by coordinate.
    pub stops: Option<Given<Entries<Stops>>>,
    /// Friction of joints by coordinate.
    pub friction: Option<Given<Entries<Friction>>>,
    /// Forces and moments applied from outside.
    pub loads: Option<Given<Vec<Given<Load>>>>,
    /// Springs, gas springs and ropes between two points.
    pub connectors: Option<Given<Vec<Given<Connector>>>>,
    /// Coordinates that follow others: stages of telescopes, gears.
    pub couplings: Option<Given<Vec<Given<Coupling>>>>,
    /// Hydraulic cylinders of driven joints, by their pins.
    pub cylinders: Option<Given<Vec<Given<Cylinder>>>>,
    /// What supplies the cylinders.
    pub pump: Option<Given<Pump>>,
    /// Points of interest, whose motion is reported.
    pub points: Option<Given<Vec<Given<Point>>>>,
    /// Start of the static solution, by coordinate, rad or m. Default: a driven coordinate at its drive's position at
    /// t = 0, all others at 0.
    pub guess: Option<Given<Entries<FixedAngle>>>,
    /// Settings of a run.
    pub run: Option<Given<Run>>,
}

/// A kind of computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Analysis {
    /// Static residual and tangent stiffness.
    Statics,
    /// Mass matrix, bias, energies: motion.
    Dynamics,
    /// Linearisation at a pose: frequencies and damping.
    Modes,
    /// Forces and moments that joints, beam sections and the ground transmit.
    InternalForces,
    /// First and second derivatives of every body's transformation.
    Derivatives,
    /// Accelerations of eight cranes per call, for simulations of many with different parameters; includes `dynamics`.
    Ensemble,
}

impl Analysis {
    /// The word for it in a spec.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Analysis::Statics => "statics",
            Analysis::Dynamics => "dynamics",
            Analysis::Modes => "modes",
            Analysis::InternalForces => "internal_forces",
            Analysis::Derivatives => "derivatives",
            Analysis::Ensemble => "ensemble",
        }
    }
}

/// When repeated work is a loop in generated code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Loops {
    /// Where measurements showed it to be faster.
    Auto,
    /// Wherever possible.
    Always,
    /// Never.
    Never,
}

/// A value that stays live at run time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `value`, `unit` and `about`")]
pub struct Parameter {
    /// Default value, in SI units.
    pub value: Given<FixedAngle>,
    /// Unit shown in tables, such as `kg`. Default: none.
    pub unit: Option<Given<String>>,
    /// Description. Default: empty.
    pub about: Option<Given<String>>,
}

/// Settings of a run.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `duration`, `step` and `output`")]
pub struct Run {
    /// Simulated time, s. Default 10.
    pub duration: Option<Given<Constant>>,
    /// Step of the integrator, s. Default 1e-4.
    pub step: Option<Given<Constant>>,
    /// Interval of the recorded results, s. Default 0.01.
    pub output: Option<Given<Constant>>,
}
