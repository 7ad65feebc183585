//! What a generated crane says about itself.

/// Names, units and settings of a crane; constants of the generated module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Description {
    /// Name of the crane.
    pub name: &'static str,
    /// One line for people.
    pub title: &'static str,
    /// Hash of the YAML text it was compiled from.
    pub spec_hash: &'static str,
    /// Live parameters.
    pub parameters: &'static [ParameterInfo],
    /// Generalized coordinates in the order of `q`.
    pub coordinates: &'static [CoordinateInfo],
    /// Bodies from base to tip.
    pub bodies: &'static [BodyInfo],
    /// Supports.
    pub supports: &'static [SupportInfo],
    /// Drives.
    pub drives: &'static [DriveInfo],
    /// Names of the points of interest.
    pub points: &'static [&'static str],
    /// Whether the spec asks for statics: a run then starts from the static equilibrium, otherwise from the guess.
    pub statics: bool,
    /// Where the static solution starts, or the run without statics, with default parameters, m and rad.
    pub guess: &'static [f64],
    /// Simulated time, s.
    pub duration: f64,
    /// Step of the integrator, s.
    pub step: f64,
    /// Interval of recorded results, s.
    pub output: f64,
}

/// A live parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What it is.
    pub about: &'static str,
    /// Value unless set.
    pub default: f64,
}

/// A generalized coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoordinateInfo {
    /// Name.
    pub name: &'static str,
    /// Motion along or about an axis.
    pub kind: CoordinateKind,
    /// Who owns it.
    pub role: CoordinateRole,
}

/// Kind of motion of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateKind {
    /// Along an axis: m, driven by N.
    Translation,
    /// About an axis: rad, driven by N m.
    Rotation,
}

impl CoordinateKind {
    /// Unit of the coordinate.
    pub const fn unit(self) -> &'static str {
        match self {
            CoordinateKind::Translation => "m",
            CoordinateKind::Rotation => "rad",
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

/// What a coordinate describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateRole {
    /// Motion of the base.
    Base,
    /// A joint with a drive.
    Driven,
    /// A joint without a drive.
    Passive,
    /// Deformation of a flexible link.
    Element,
}

impl CoordinateRole {
    /// The role in a word.
    pub const fn name(self) -> &'static str {
        match self {
            CoordinateRole::Base => "base",
            CoordinateRole::Driven => "driven",
            CoordinateRole::Passive => "passive",
            CoordinateRole::Element => "element",
        }
    }
}

/// A body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInfo {
    /// Name.
    pub name: &'static str,
    /// Link it belongs to.
    pub link: &'static str,
    /// Mass with default parameters, kg; 0 for a massless frame.
    pub mass: f64,
    /// Length along x of a rigid finite element, m; 0 otherwise.
    pub length: f64,
    /// Coordinates that move it: the first `degrees_of_freedom` of `q`, Eq. (2).
    pub degrees_of_freedom: usize,
}

/// A support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportInfo {
    /// Name.
    pub name: &'static str,
    /// Attachment point in the base's frame with default parameters, m.
    pub position: [f64; 3],
}

/// A drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DriveInfo {
    /// Index of the driven coordinate in `q`.
    pub coordinate: usize,
}
