//! The spec language as written: one type per mapping, whose doc comments are its documentation and its JSON Schema;
//! `FromNode` is derived for each.
//!
//! The type of a key defines its allowed values, and `#[key(unit = …, limit = …)]` what its number measures; [`Spanned`] holds its location. An optional key is an `Option`.

mod acting;
mod beam;
mod combination;
mod connector;
mod cylinder;
mod drive;
mod event;
mod inertia;
mod input;
mod joint;
mod link;
mod load;
mod loop_joint;
mod on;
mod placement;
mod scalar;
mod schema;
mod shape;
mod slides_in;
mod spanned;
mod support;

pub use acting::{Acting, acting};
pub use beam::{
    Beam, BeamDamping, BeamPart, Bend, Directions, Element, Material, Moduli, Section, SectionJoint, Sections, Spring,
};
pub use combination::{Combination, Hoisting, HoistingClass, Preset};
pub use connector::*;
pub use cylinder::{Cylinder, HoseVolumes, Linkage, Pin, Pump, Side, Valve};
pub use drive::{Curve, Drive, Halt, Motion, Ramp, Speed, Table, Trapezoid};
pub use event::{Condition, Event, Joins};
pub use inertia::{About, Inertia};
pub use input::Input;
pub use joint::{Bristle, Friction, Stops};
pub use link::{BaseCoordinate, Body, HangingRope, Joint, JointAxis, Link};
pub use load::{Axes, Load, Wind};
pub use loop_joint::{Direction, LoopJoint, LoopJointKind, LoopRod, PinAxis, SlideAxis};
pub use on::{On, Place};
pub use placement::{AxisName, ClassicDh, ModifiedDh, Placement, Transform, Turn};
pub(crate) use scalar::Written;
pub use scalar::{Angle, Constant, FixedAngle, Number, Scalar, Vector};
pub use schema::json_schema;
pub use shape::{BoxShape, MeshShape, RoundShape, Shape};
pub use slides_in::{ExactDirection, Pad, Pads, SlidesIn};
pub use spanned::{Either, Entries, Many, Spanned, entries};
pub use support::{Kinematics, NamedFrame, NamedJoint, Point, Support};

use crate::diagnostic::{Mistake, SourceFile, Span};
use crate::node::{FromNode, Node};

/// A crane as written, with the mistakes found while reading it; [`validate`](crate::validate()) reports them together with
/// its own.
#[derive(Clone, Debug)]
pub struct CraneSpec {
    /// The contents of the file.
    pub crane: Crane,
    /// Mistakes in keys and shapes.
    pub(crate) mistakes: Vec<Mistake>,
    /// What was noticed before there were types: some of these mistakes, and entries that were perhaps meant to change others.
    pub(crate) noticed: Noticed,
    /// The file, to which its locations belong.
    pub(crate) source: SourceFile,
    /// The file as which it is saved, with its changes.
    pub(crate) saved: SourceFile,
    /// Its tree, for changes.
    pub(crate) tree: Node,
}

impl CraneSpec {
    /// The file, to which locations in messages belong.
    #[must_use]
    pub fn source(&self) -> &SourceFile {
        &self.source
    }

    /// Whether reading it found no mistakes.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.mistakes.is_empty()
    }

    /// The file as which it is saved: with the [changes](Self::changed) that were laid over it, each as a part that extends the others.
    #[must_use]
    pub fn saved(&self) -> &SourceFile {
        &self.saved
    }
}

/// What is noticed while specs are laid over each other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Noticed {
    pub mistakes: Vec<Mistake>,
    pub lookalikes: Vec<Lookalike>,
}

/// A new entry of a list whose name resembles that of an entry of the extended spec.
#[derive(Clone, Debug)]
pub(crate) struct Lookalike {
    /// Its name.
    pub name: String,
    /// Where the name is.
    pub at: Span,
    /// All of the entry.
    pub span: Span,
    /// The name that it resembles.
    pub known: String,
}

/// An inclined ground.
#[derive(Clone, Debug, FromNode)]
#[key(unit = "rad")]
pub struct Slope {
    /// Inclination.
    pub angle: Spanned<Angle>,
    /// The direction in which it falls, about z from x. Default 0.
    pub towards: Option<Spanned<Angle>>,
}

/// A crane: links attached to each other, from the base to the tips. Every number is in SI units; the name of an entry of
/// `parameters` can replace a number, which keeps it live at run time.
#[derive(Clone, Debug, FromNode)]
pub struct Crane {
    /// Another spec to start from: a file, relative to this one, or a shipped crane. This file then contains only the differences:
    /// mappings are merged key by key, lists whose entries have a `name` or a `coordinate`, such as links, supports and drives, entry by entry; everything
    /// else is replaced. A key without a value removes what it names, and so does `remove: true` in an entry of a list. A new entry comes
    /// last, or behind the one that `after` names.
    pub extends: Option<Spanned<String>>,
    /// Version of the spec language: 1.
    #[key(unit = "1")]
    pub format: Spanned<Constant>,
    /// Name of the crane, a `snake_case` identifier; names the generated module.
    pub name: Spanned<String>,
    /// Title for human readers, one line. Default: the name.
    pub title: Option<Spanned<String>>,
    /// Acceleration of gravity in the world frame. Default `[0, 0, -9.81]`.
    #[key(unit = "m/s²", usual = 0.0..30.0)]
    pub gravity: Option<Spanned<Vector>>,
    /// The ground is a slope: `gravity`, which is then along z, is turned. Default: none.
    pub slope: Option<Spanned<Slope>>,
    /// Quantities to compute; the rest is left out of the generated code. Default `[statics, dynamics, modes]`.
    pub analyses: Option<Spanned<Vec<Spanned<Analysis>>>>,
    /// Whether generated code loops over equal elements or is written out. Default `auto`.
    pub loops: Option<Spanned<Loops>>,
    /// Values that stay live at run time, by name.
    pub parameters: Option<Spanned<Entries<Parameter>>>,
    /// Numbers that can be set between steps, by name.
    pub inputs: Option<Spanned<Entries<Input>>>,
    /// Materials of beams, by name.
    pub materials: Option<Spanned<Entries<Material>>>,
    /// The links, from the base to the tips; each is attached to the previous one, or to the one that `on` names.
    pub links: Spanned<Vec<Spanned<Link>>>,
    /// Springs and dampers between a free base and the ground.
    pub supports: Option<Spanned<Vec<Spanned<Support>>>>,
    /// Drives of joints.
    pub drives: Option<Spanned<Vec<Spanned<Drive>>>>,
    /// Viscous damping of passive joints by coordinate.
    #[key(unit = "N m s/rad or N s/m", limit = NotNegative)]
    pub damping: Option<Spanned<Entries<Number>>>,
    /// Rotor inertia of joints without a drive by coordinate, reflected by the square of the gear ratio.
    #[key(unit = "kg m² or kg", limit = NotNegative)]
    pub armature: Option<Spanned<Entries<Number>>>,
    /// End stops of joints by coordinate.
    pub stops: Option<Spanned<Entries<Stops>>>,
    /// Friction of joints by coordinate.
    pub friction: Option<Spanned<Entries<Friction>>>,
    /// External forces and moments.
    pub loads: Option<Spanned<Vec<Spanned<Load>>>>,
    /// Combinations of weights and loads with partial factors.
    pub combinations: Option<Spanned<Vec<Spanned<Combination>>>>,
    /// The one of `combinations` with which everything is computed. Default: none, weights and loads as written.
    pub combination: Option<Spanned<String>>,
    /// Springs, gas springs and ropes between two points.
    pub connectors: Option<Spanned<Vec<Spanned<Connector>>>>,
    /// Points that the ground carries while they touch it: loads that lie there, legs of a head.
    pub contacts: Option<Spanned<Vec<Spanned<Contact>>>>,
    /// Coordinates that follow others: stages of telescopes, gears.
    pub couplings: Option<Spanned<Vec<Spanned<Coupling>>>>,
    /// Joints that close loops of links.
    pub loop_joints: Option<Spanned<Vec<Spanned<LoopJoint>>>>,
    /// Hydraulic cylinders of driven joints, by their pins.
    pub cylinders: Option<Spanned<Vec<Spanned<Cylinder>>>>,
    /// The pump that supplies the cylinders.
    pub pump: Option<Spanned<Pump>>,
    /// Frames on links, by which points and calls of Python may refer to places.
    pub frames: Option<Spanned<Vec<Spanned<NamedFrame>>>>,
    /// Joints under the names and in the order of a robot's file, for calls of Python. Default: coordinates under theirs.
    pub joints: Option<Spanned<Vec<Spanned<NamedJoint>>>>,
    /// Points of interest, whose motion is reported.
    pub points: Option<Spanned<Vec<Spanned<Point>>>>,
    /// Starting point of the static solution, by coordinate. Default: a driven coordinate at its drive's position at
    /// t = 0, one that follows another where its coupling puts it, all others at 0.
    #[key(unit = "rad or m")]
    pub guess: Option<Spanned<Entries<FixedAngle>>>,
    /// Settings of a run.
    pub run: Option<Spanned<Run>>,
    /// What happens during a run: loads are dropped or gripped, ropes break.
    pub events: Option<Spanned<Vec<Spanned<Event>>>>,
}

/// A kind of computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
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
    /// Derivatives of accelerations, of the forces that a motion requires, and of points of interest; includes `dynamics`.
    MotionDerivatives,
    /// Accelerations of eight cranes per call, for simulations of many cranes with different parameters; includes `dynamics`.
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
            Analysis::MotionDerivatives => "motion_derivatives",
            Analysis::Ensemble => "ensemble",
        }
    }
}

/// When repeated work is a loop in generated code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum Loops {
    /// Where measurements showed it to be faster.
    Auto,
    /// Wherever possible.
    Always,
    /// Never.
    Never,
}

/// A value that stays live at run time.
#[derive(Clone, Debug, FromNode)]
pub struct Parameter {
    /// Default value, in SI units.
    #[key(unit = "its own")]
    pub value: Spanned<FixedAngle>,
    /// Unit shown in tables, such as `kg`. Default: the SI unit of the value, if it has a unit.
    pub unit: Option<Spanned<String>>,
    /// Description. Default: empty.
    pub about: Option<Spanned<String>>,
}

/// Settings of a run.
#[derive(Clone, Debug, Default, FromNode)]
#[key(unit = "s", limit = Positive)]
pub struct Run {
    /// Simulated time. Default 10.
    pub duration: Option<Spanned<Constant>>,
    /// Step size of the integrator. Default 1e-4.
    pub step: Option<Spanned<Constant>>,
    /// Interval of the recorded results. Default 0.01.
    pub output: Option<Spanned<Constant>>,
}
