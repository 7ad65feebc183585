//! Metadata of a crane. In the form `{:#?}` it is the Rust expression of the constant that generated code holds.

#[cfg(feature = "std")]
mod columns;
mod count;
mod cut;
mod event;
#[cfg(feature = "std")]
mod fleet;
mod loop_joint;
mod parameter;
mod poses;
mod shared;
mod stage;
#[cfg(feature = "std")]
mod tree;

use core::fmt;

use crate::{ColumnKind, Strain};

#[cfg(feature = "std")]
pub use columns::{PUMP, PartColumn};
pub use cut::Cut;
pub use event::{ConditionInfo, EventInfo, JoinsInfo, Moment};
pub use loop_joint::{LoopEquationInfo, LoopJointInfo};
pub use parameter::{Bound, ParameterError, ParameterInfo, Refusal};
pub use poses::{LARGE_TILT, NEAR_SINGULAR, TIPPED};
pub use shared::{List, Text};
pub use stage::StageInfo;
#[cfg(feature = "std")]
pub use tree::Tree;

/// Names, units and settings of a crane: constants of a generated module, or owned by a crane made at run time.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Name of the crane.
    pub name: Text,
    /// One-line description.
    pub title: Text,
    /// Hash of the YAML text it was compiled from.
    pub spec_hash: Text,
    /// Live parameters.
    pub parameters: List<ParameterInfo>,
    /// Generalized coordinates in the order of `q`.
    pub coordinates: List<CoordinateInfo>,
    /// Bodies, each after the one to which it is attached.
    pub bodies: List<BodyInfo>,
    /// Sections of beams and ropes, from the base to the tip.
    pub sections: List<SectionInfo>,
    /// Supports.
    pub supports: List<SupportInfo>,
    /// Drives.
    pub drives: List<DriveInfo>,
    /// Coordinates with end stops, by their indices in `q`.
    pub stops: List<usize>,
    /// Coordinates with friction, by their indices in `q`.
    pub frictions: List<usize>,
    /// Friction of the joints that stick: the deflections of their bristles are states of the motion.
    pub bristles: List<BristleInfo>,
    /// Applied loads.
    pub loads: List<LoadInfo>,
    /// Springs, gas springs and ropes between two points, and couplings of coordinates.
    pub connectors: List<ConnectorInfo>,
    /// Inputs that are set between steps.
    pub inputs: List<InputInfo>,
    /// Hydraulic cylinders of driven joints.
    pub cylinders: List<CylinderInfo>,
    /// The pump that supplies the cylinders.
    pub pump: Option<PumpInfo>,
    /// Names of the points of interest.
    pub points: List<Text>,
    /// Whether the spec requests statics: a run then starts from the static equilibrium, otherwise from the guess.
    pub statics: bool,
    /// Pose at which the static solution starts, or the run if there is no static solution, m and rad; `None` for what follows from the motions
    /// of drives and from couplings.
    pub guess: List<Option<f64>>,
    /// Simulated time, s.
    pub duration: f64,
    /// Step of the integrator, s.
    pub step: f64,
    /// Interval of recorded results, s.
    pub output: f64,
    /// What happens during a run: at times, in their order, then on conditions.
    pub events: List<EventInfo>,
}

impl Description {
    /// The events on conditions, with their indices.
    pub fn conditions(&self) -> impl Iterator<Item = (usize, &ConditionInfo)> {
        self.events.iter().enumerate().filter_map(|(index, event)| match &event.moment {
            Moment::When(condition) => Some((index, condition)),
            Moment::At(_) => None,
        })
    }

    /// Whether oil moves a joint, through a cylinder with a valve.
    pub fn has_valves(&self) -> bool {
        self.cylinders.iter().any(|cylinder| cylinder.valve.is_some())
    }

    /// Whether forces have states besides pose and rates.
    pub fn has_force_states(&self) -> bool {
        self.has_hidden_forces() || self.has_feet()
    }

    /// Whether oil or bristles exert forces that generated functions do not contain: forces and accelerations need their states, too.
    pub fn has_hidden_forces(&self) -> bool {
        self.has_valves() || !self.bristles.is_empty()
    }

    /// Whether it stands on supports that press, and hold by friction.
    pub fn has_feet(&self) -> bool {
        self.supports.iter().any(|support| support.one_sided)
    }

    /// The first body that a coordinate moves: the coordinate is named after it, or after its link.
    #[cfg(feature = "std")]
    pub fn first_moved(&self, coordinate: usize) -> Option<&BodyInfo> {
        let (stem, _) = self.coordinates[coordinate].name.rsplit_once('_')?;
        let named = |of: fn(&BodyInfo) -> &Text| self.bodies.iter().find(|body| of(body).as_str() == stem);
        named(|body| &body.name).or_else(|| named(|body| &body.link))
    }

    /// Numbers of the drives, each at the index of the drive's coordinate; 0 at all others.
    #[cfg(feature = "std")]
    pub fn by_coordinate(&self, of_drives: &[f64]) -> Vec<f64> {
        let mut by_coordinate = vec![0.0; self.coordinates.len()];
        for (drive, number) in self.drives.iter().zip(of_drives) {
            by_coordinate[drive.coordinate] = *number;
        }
        by_coordinate
    }
}

/// A generalized coordinate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoordinateInfo {
    /// Name.
    pub name: Text,
    /// Motion along or about an axis.
    pub kind: CoordinateKind,
    /// Its role.
    pub role: CoordinateRole,
}

/// Kind of motion of a coordinate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum CoordinateKind {
    /// Along an axis: in m, driven by a force in N.
    Translation,
    /// About an axis: in rad, driven by a moment in N m.
    Rotation,
}

impl CoordinateKind {
    /// Whether it is an angle.
    pub const fn turns(self) -> bool {
        matches!(self, CoordinateKind::Rotation)
    }

    /// Unit of the coordinate.
    pub const fn unit(self) -> &'static str {
        match self {
            CoordinateKind::Translation => "m",
            CoordinateKind::Rotation => "rad",
        }
    }

    /// The word for the generalized force.
    pub const fn force_name(self) -> &'static str {
        match self {
            CoordinateKind::Translation => "force",
            CoordinateKind::Rotation => "torque",
        }
    }

    /// Unit of the generalized force.
    pub const fn force_unit(self) -> &'static str {
        match self {
            CoordinateKind::Translation => "N",
            CoordinateKind::Rotation => "N m",
        }
    }
}

/// Role of a coordinate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum CoordinateRole {
    /// Motion of the base.
    Base,
    /// A joint with a flexible drive.
    Driven,
    /// A joint with a rigid drive: its motion is prescribed, not unknown.
    Prescribed,
    /// A joint without a drive.
    Passive,
    /// Deformation of a flexible link, an angle about one axis.
    Element,
    /// Deformation of a flexible link, a component of the rotation vector of a section: with its two neighbours, in
    /// the order z, y, x, it rotates everything beyond by `exp([ρ]×)`.
    ElementVector,
}

impl CoordinateRole {
    /// The role in one word.
    pub const fn name(self) -> &'static str {
        match self {
            CoordinateRole::Base => "base",
            CoordinateRole::Driven => "driven",
            CoordinateRole::Prescribed => "prescribed",
            CoordinateRole::Passive => "passive",
            CoordinateRole::Element | CoordinateRole::ElementVector => "element",
        }
    }

    /// Whether it is a deformation of a flexible link.
    pub const fn is_element(self) -> bool {
        matches!(self, CoordinateRole::Element | CoordinateRole::ElementVector)
    }
}

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyInfo {
    /// Name.
    pub name: Text,
    /// Link it belongs to.
    pub link: Text,
    /// Number of coordinates that move it, Eq. (2): the first of `q`, unless the crane has branches
    /// (`CraneModel::parents`).
    pub degrees_of_freedom: usize,
}

/// A section of a beam at which forces, moments and stresses are known, or the beginning of a link of a rope.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionInfo {
    /// Index of its body, a rigid element.
    pub body: usize,
    /// On which side of what is there.
    pub side: Side,
    /// What is there, such as `head of lift` or `end`; empty where only an element begins.
    pub at: Text,
    /// Whether it is at a pad on which the beam slides, so that it moves along the beam.
    pub slides: bool,
}

/// The side of a section at which forces and stresses are those given: where a force acts or the shape has a step, they jump.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Just before.
    Before,
    /// They do not jump.
    Both,
    /// Just after.
    After,
}

impl Side {
    /// The side as a preposition.
    pub const fn name(self) -> &'static str {
        match self {
            Side::Before => "before",
            Side::Both => "at",
            Side::After => "after",
        }
    }
}

#[cfg(feature = "std")]
impl SectionInfo {
    /// The side and what is there, such as `before the head of lift`; empty where only an element begins.
    pub fn location(&self) -> String {
        if self.at.is_empty() { String::new() } else { format!("{} the {}", self.side.name(), self.at.as_str()) }
    }
}

/// A support.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportInfo {
    /// Name.
    pub name: Text,
    /// Whether its elongation is linear in the base's coordinates, `kinematics: linear`.
    pub linear: bool,
    /// Whether it only presses, and lifts off instead of pulling.
    pub one_sided: bool,
    /// The area of the plate under it, m²; `None`: the spec gives none.
    pub plate_area: Option<f64>,
    /// The largest pressure that the ground bears under it, Pa; `None`: the spec gives none.
    pub max_pressure: Option<f64>,
}

impl SupportInfo {
    /// The pressure of its plate on the ground, Pa, with the vertical force of the support on the crane, N.
    pub fn pressure(&self, force: f64) -> Option<f64> {
        self.plate_area.map(|area| force.max(0.0) / area)
    }

    /// The vertical force with which it presses as hard as the ground bears, N.
    pub fn max_force(&self) -> Option<f64> {
        self.plate_area.zip(self.max_pressure).map(|(area, pressure)| area * pressure)
    }
}

/// A drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveInfo {
    /// Index of the driven coordinate in `q`.
    pub coordinate: usize,
    /// The number of intervals in which its motion is smooth.
    pub pieces: usize,
    /// Maximum rate, rad/s or m/s, if it is limited.
    pub max_rate: Option<f64>,
    /// Maximum power, W, if it is limited.
    pub max_power: Option<f64>,
}

/// The hydraulic cylinder of a driven joint.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderInfo {
    /// Name.
    pub name: Text,
    /// Index of the drive whose effort is that of the cylinder.
    pub drive: usize,
    /// Areas on which the oil acts: of the piston, and of the annulus around the rod, m².
    pub areas: [f64; 2],
    /// Distance between the pins when it is retracted, m.
    pub retracted: f64,
    /// Stroke, m.
    pub stroke: f64,
    /// Maximum pressure, Pa.
    pub max_pressure: Option<f64>,
    /// Pressure on the side that does not carry the load, Pa.
    pub back_pressure: f64,
    /// Bulk modulus of the oil, Pa.
    pub bulk_modulus: Option<f64>,
    /// Volumes of the oil in hoses and valves on the piston's side and on the rod's, m³.
    pub hose_volumes: [f64; 2],
    /// A range of coordinates that contains those that change its length: the first, and the one after the last. Its joint's, and those of beams between its pins.
    pub spanned: [usize; 2],
    /// The valve that moves it; its pressures and the valve's opening are then states of the motion.
    pub valve: Option<ValveInfo>,
}

/// A proportional directional valve; a servo makes its cylinder follow the drive's motion, unless it is commanded over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValveInfo {
    /// Flow through a fully open edge at the nominal pressure drop, m³/s.
    pub flow: f64,
    /// Nominal pressure drop, Pa.
    pub pressure_drop: f64,
    /// Share of the spool's travel from the middle over which the edges stay closed.
    pub overlap: f64,
    /// Time constant of the spool, s.
    pub lag: f64,
    /// Whether it is commanded over time, without a servo.
    pub commanded: bool,
    /// Gain of the servo: opening per error of the cylinder's length, 1/m.
    pub gain: f64,
    /// Feed-forward of the servo: share of the opening required by the speed of the motion that is applied without any error.
    pub feed_forward: f64,
    /// Leakage past the piston, m³/(s Pa).
    pub leakage: f64,
}

/// Friction of a joint that sticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BristleInfo {
    /// Its coordinate, by its index in `q`.
    pub coordinate: usize,
    /// Coulomb friction, N m or N.
    pub coulomb: f64,
    /// Breakaway friction, N m or N.
    pub breakaway: f64,
    /// Rate of the decline between the two, rad/s or m/s.
    pub stribeck: f64,
    /// Stiffness of the bristles, N m/rad or N/m.
    pub stiffness: f64,
    /// Their damping, N m s/rad or N s/m.
    pub damping: f64,
}

/// The pump that supplies the cylinders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PumpInfo {
    /// Maximum total flow to all cylinders, m³/s.
    pub max_flow: f64,
    /// Pressure that it maintains until its flow is at its limit, Pa.
    pub pressure: Option<f64>,
    /// Volume of the oil between the pump and the valves, m³.
    pub volume: f64,
}

/// An applied load.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadInfo {
    /// Name.
    pub name: Text,
    /// The number of intervals in which its scale is smooth.
    pub pieces: usize,
}

/// An input: a number that is set between steps.
#[derive(Clone, Debug, PartialEq)]
pub struct InputInfo {
    /// Name.
    pub name: Text,
    /// Unit.
    pub unit: Text,
    /// Description.
    pub about: Text,
    /// Its value if it is not set; `None`: it follows a motion of the spec.
    pub default: Option<f64>,
}

/// An element between two points, a rope over sheaves, a coupling of two coordinates, or friction in a pin that closes a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct ConnectorInfo {
    /// Name.
    pub name: Text,
    /// Its points: both ends, and between them the sheaves over which a rope runs; the place of a pad on which a beam slides; the place
    /// of a pin on both bodies; none for a coupling.
    pub points: List<AttachmentInfo>,
    /// How many parallel parts of a rope run between its last two points.
    pub falls: usize,
    /// Whether its length is a length or an angle.
    pub kind: CoordinateKind,
    /// Whether it is a rope, which pulls and never pushes.
    pub is_rope: bool,
    /// The largest tension that a rope may carry, N; `None`: the spec gives none.
    pub max_tension: Option<f64>,
    /// Whether it is the contact of a point with the ground, which carries it and never holds it.
    pub is_contact: bool,
    /// A range of coordinates that contains those that change its length: the first, and the one after the last.
    pub spanned: [usize; 2],
    /// The number of intervals in which its winch moves smoothly.
    pub pieces: usize,
}

impl ConnectorInfo {
    /// Whether it is a pad on which a beam slides.
    pub fn is_pad(&self) -> bool {
        self.points.len() == 1 && !self.is_contact
    }

    /// The indicator of one that acts at times only: a rope that is taut, a point that touches the ground.
    pub fn indicator(&self) -> Option<ColumnKind> {
        match (self.is_rope, self.is_contact) {
            (true, _) => Some(ColumnKind::RopeIndicator),
            (_, true) => Some(ColumnKind::FootIndicator),
            _ => None,
        }
    }

    /// Whether it is the friction in a pin: nothing else turns about points.
    pub fn is_pin(&self) -> bool {
        self.points.len() == 2 && self.kind == CoordinateKind::Rotation
    }

    /// What its length is: that of the line through its points, where the axis of a beam passes a pad, the slip of a coupling, the angle of a pin, or how deep
    /// a point is below the ground.
    pub fn strain(&self) -> Strain {
        match self.points.len() {
            _ if self.is_pin() => Strain::Angle,
            _ if self.is_contact => Strain::Depth,
            0 => Strain::Slip,
            1 => Strain::Offset,
            _ => Strain::Length,
        }
    }

    /// What the column with its force or torque shows.
    pub fn effort(&self) -> ColumnKind {
        if self.is_pin() { ColumnKind::PinFriction } else { ColumnKind::ConnectorEffort }
    }

    /// Whether one of its points is pulled towards the world.
    pub fn holds_to_world(&self) -> bool {
        self.is_contact || !self.is_pin() && self.points.iter().any(|point| point.body.is_none())
    }
}

/// A point of a body or of the world; `attachments` are their places.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachmentInfo {
    /// Index of the body; `None` for the world.
    pub body: Option<usize>,
}

/// Variants with their type, as Rust expressions.
macro_rules! debug_as_expression {
    ($($of:ident: $($variant:ident)*;)*) => {$(
        impl fmt::Debug for $of {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Self::$variant => concat!(stringify!($of), "::", stringify!($variant)),)* })
            }
        }
    )*};
}

debug_as_expression! {
    CoordinateKind: Translation Rotation;
    CoordinateRole: Base Driven Prescribed Passive Element ElementVector;
    Side: Before Both After;
}
