//! Hydraulic cylinders between their pins.

use super::{Constant, Motion, Number, Spanned, Vector};
use crate::node::FromNode;

/// The hydraulic cylinder of a driven joint, by its pins: its length, its force and its pressures follow from the drive.
#[derive(Clone, Debug, FromNode)]
pub struct Cylinder {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// The driven coordinate that it moves, such as `boom_psi`.
    pub coordinate: Spanned<String>,
    /// The pin of its barrel.
    pub foot: Spanned<Pin>,
    /// The pin of its rod, on the other side of the joint; with a linkage, the pin there of the linkage's link.
    pub head: Spanned<Pin>,
    /// Rocker and link between its rod and `head`. Default: none.
    pub linkage: Option<Spanned<Linkage>>,
    /// Diameter of the piston.
    #[key(unit = "m", limit = Positive, usual = 2e-3..2.0)]
    pub bore: Spanned<Constant>,
    /// Diameter of the rod.
    #[key(unit = "m", limit = Positive, usual = 2e-3..2.0)]
    pub rod: Spanned<Constant>,
    /// Distance between its pins when it is retracted.
    #[key(unit = "m", limit = Positive, usual = 1e-3..50.0)]
    pub retracted: Spanned<Constant>,
    /// Stroke.
    #[key(unit = "m", limit = Positive, usual = 1e-3..50.0)]
    pub stroke: Spanned<Constant>,
    /// Maximum pressure, at which its relief valves open. Default: none.
    #[key(unit = "Pa", limit = Positive, usual = 1e4..2e8)]
    pub max_pressure: Option<Spanned<Constant>>,
    /// Pressure on the side that does not carry the load. Default 0.
    #[key(unit = "Pa", limit = NotNegative, usual = 1e3..1e7)]
    pub back_pressure: Option<Spanned<Constant>>,
    /// Bulk modulus of the oil with its hoses, for the stiffness of the trapped oil. Default: none.
    #[key(unit = "Pa", limit = Positive, usual = 5e7..5e9)]
    pub bulk_modulus: Option<Spanned<Constant>>,
    /// Oil in hoses and valves on the piston's side and on the rod's. Default `[0, 0]`.
    #[key(unit = "m³", limit = NotNegative, usual = 0.0..0.1)]
    pub hose_volumes: Option<Spanned<HoseVolumes>>,
    /// The valve that moves it: the cylinder's pressures and the valve's opening become states of the motion. Default: none, and
    /// the drive moves the joint.
    pub valve: Option<Spanned<Valve>>,
}

/// A proportional directional valve, and what commands it: a servo that makes the cylinder follow the drive's motion, or an opening over time.
#[derive(Clone, Debug, FromNode)]
pub struct Valve {
    /// Flow through one metering edge of the fully open valve at `pressure_drop`; 60 l/min are 1e-3.
    #[key(unit = "m³/s", limit = Positive, usual = 1e-8..0.1)]
    pub flow: Spanned<Constant>,
    /// Pressure drop over that edge.
    #[key(unit = "Pa", limit = Positive, usual = 1e4..2e8)]
    pub pressure_drop: Spanned<Constant>,
    /// Overlap as a fraction of the spool's travel from its centre: within it no oil flows. Default 0.
    #[key(unit = "1", limit = NotNegative)]
    pub overlap: Option<Spanned<Constant>>,
    /// Time constant of the spool.
    #[key(unit = "s", limit = Positive, usual = 1e-5..2.0)]
    pub lag: Spanned<Constant>,
    /// Opening that the servo commands per error of the cylinder's length; an opening of 1 is fully open.
    #[key(unit = "1/m", limit = NotNegative, usual = 0.05..1e3)]
    pub gain: Option<Spanned<Constant>>,
    /// The spool's command over time instead of a servo, from −1 (fully open, retracts) to 1 (fully open, extends): a motion, a table
    /// or an input. The drive's motion must then `hold` the position of the crane before the run.
    #[key(unit = "1")]
    pub opening: Option<Spanned<Motion>>,
    /// Fraction of the opening required for the speed of the motion at the measured pressures that the servo adds as a
    /// feed-forward. Default 1.
    #[key(unit = "1", limit = NotNegative, usual = 0.01..2.0)]
    pub feed_forward: Option<Spanned<Constant>>,
    /// Leakage past the piston. Default 0.
    #[key(unit = "m³/(s Pa)", limit = NotNegative, usual = 0.0..1e-10)]
    pub leakage: Option<Spanned<Constant>>,
}

/// Volumes on the two sides of a piston.
pub type HoseVolumes = [Spanned<Constant>; 2];

/// A pin: a point of a link.
#[derive(Clone, Debug, FromNode)]
pub struct Pin {
    /// The link that carries it.
    pub link: Spanned<String>,
    /// Its position in the frame of the link (for a beam: undeformed).
    #[key(unit = "m")]
    pub at: Spanned<Vector>,
}

/// Rocker and link: the rocker turns about `pivot` on the link that carries the cylinder's foot, the link ends at the cylinder's `head`, and
/// the rod is pinned to the joint between the two.
#[derive(Clone, Debug, FromNode)]
pub struct Linkage {
    /// The rocker's pivot in the frame of the link that carries the cylinder's foot; on a beam, on the element at its own place.
    #[key(unit = "m")]
    pub pivot: Spanned<Vector>,
    /// Length of the rocker.
    #[key(unit = "m", limit = Positive)]
    pub rocker: Spanned<Number>,
    /// Length of the link.
    #[key(unit = "m", limit = Positive)]
    pub link: Spanned<Number>,
    /// The side of the line from `pivot` to `head` on which the rod's pin is, with the joint's axis towards the viewer.
    pub side: Spanned<Side>,
}

/// A side of a directed line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum Side {
    /// To the left.
    Left,
    /// To the right.
    Right,
}

/// The pump that supplies the cylinders.
#[derive(Clone, Debug, FromNode)]
pub struct Pump {
    /// Maximum flow to all cylinders together; 60 l/min are 1e-3.
    #[key(unit = "m³/s", limit = Positive, usual = 1e-8..0.1)]
    pub max_flow: Spanned<Constant>,
    /// Pressure at which it delivers nothing; at 5 % less it delivers its maximum flow, and in between in proportion. Cylinders with a valve need
    /// it. Default: none.
    #[key(unit = "Pa", limit = Positive, usual = 1e4..2e8)]
    pub pressure: Option<Spanned<Constant>>,
    /// Oil between the pump and the valves. Default 0.005.
    #[key(unit = "m³", limit = Positive, usual = 0.0..0.1)]
    pub volume: Option<Spanned<Constant>>,
}
