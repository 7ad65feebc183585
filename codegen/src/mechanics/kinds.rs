//! The table of the kinds of force: their functions, and what a crane lacks without them.

use super::forces::Kind;
use crate::chain::Group;
use crate::program::Argument::{self, Position, Time, Velocity};
use crate::program::FunctionId;

/// A function: identifier, documentation, equation, arguments.
pub type Signature = (FunctionId, &'static str, &'static str, &'static [Argument]);

/// What belongs to a kind of force.
pub struct Row {
    /// Its generalized forces.
    pub forces: Signature,
    /// The energy that it stores, if it can.
    pub energy: Option<Signature>,
    /// What is left out without it, and why.
    pub absent: (&'static str, &'static str),
}

impl Kind {
    /// Its row of the table.
    pub fn row(self) -> &'static Row {
        match self {
            Kind::Supports => &SUPPORTS,
            Kind::Of(Group::Elements) => &ELEMENTS,
            Kind::Drives => &DRIVES,
            Kind::Of(Group::JointDampers) => &JOINT_DAMPERS,
            Kind::Of(Group::Stops) => &STOPS,
            Kind::Of(Group::Friction) => &FRICTION,
            Kind::Loads => &LOADS,
            Kind::Of(Group::Connectors) => &CONNECTORS,
        }
    }
}

const SUPPORTS: Row = Row {
    forces: (
        FunctionId::SupportForces,
        "Generalized forces of the supports, N and N m.",
        "−Jᵀ (s e + d ė) [Urbaś 2016, Eq. (18)]",
        &[Position, Velocity],
    ),
    energy: Some((
        FunctionId::SupportEnergy,
        "Energy of the supports' springs, J.",
        "½ Σ s e² [Urbaś 2016, Eqs. (16)–(17)]",
        &[Position],
    )),
    absent: ("supports", "the spec has none"),
};

const ELEMENTS: Row = Row {
    forces: (
        FunctionId::ElementForces,
        "Generalized forces of the springs and dampers between rigid elements, N m.",
        "−S q̃ − D q̃̇ [Urbaś 2016, Eq. (15)]",
        &[Position, Velocity],
    ),
    energy: Some((
        FunctionId::ElementEnergy,
        "Energy of the springs between rigid elements, J.",
        "½ q̃ᵀ S q̃ [Urbaś 2016, Eq. (14)]",
        &[Position],
    )),
    absent: ("springs and dampers of rigid elements", "no link is flexible"),
};

const DRIVES: Row = Row {
    forces: (
        FunctionId::DriveForces,
        "Generalized forces of the drives, N and N m.",
        "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]",
        &[Time, Position, Velocity],
    ),
    energy: Some((
        FunctionId::DriveEnergy,
        "Energy of the drives' springs, J.",
        "½ Σ s (q_dr − q)² [Urbaś 2016, Eq. (19)]",
        &[Time, Position],
    )),
    absent: ("drives", "the spec has none"),
};

const JOINT_DAMPERS: Row = Row {
    forces: (
        FunctionId::JointDamperForces,
        "Generalized forces of viscous damping in passive joints, N and N m.",
        "−d q̇",
        &[Velocity],
    ),
    energy: None,
    absent: ("viscous damping of joints", "the spec has none"),
};

const STOPS: Row = Row {
    forces: (
        FunctionId::StopForces,
        "Generalized forces of the end stops, N and N m.",
        "−k δ max(0, 1 + a δ̇)",
        &[Position, Velocity],
    ),
    energy: Some((FunctionId::StopEnergy, "Energy of the end stops, J.", "½ Σ k δ²", &[Position])),
    absent: ("end stops", "the spec has none"),
};

const FRICTION: Row = Row {
    forces: (
        FunctionId::FrictionForces,
        "Generalized forces of joint friction, N and N m.",
        "−(F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) − b q̇",
        &[Velocity],
    ),
    energy: None,
    absent: ("friction of joints", "the spec has none"),
};

const LOADS: Row = Row {
    forces: (
        FunctionId::LoadForces,
        "Generalized forces of the loads applied from outside, N and N m.",
        "F · Ω_j x + M · ω_j",
        &[Time, Position],
    ),
    energy: None,
    absent: ("loads applied from outside", "the spec has none"),
};

const CONNECTORS: Row = Row {
    forces: (
        FunctionId::ConnectorForces,
        "Generalized forces of connectors, N and N m.",
        "−Jᵀ F",
        &[Time, Position, Velocity],
    ),
    energy: Some((
        FunctionId::ConnectorEnergy,
        "Energy of connectors, J.",
        "½ Σ k (ℓ − ℓ₀)² − P (ℓ − ℓ₀)",
        &[Time, Position],
    )),
    absent: ("springs and ropes between points, couplings of coordinates", "the spec has none"),
};
