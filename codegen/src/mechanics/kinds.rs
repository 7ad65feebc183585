//! The table of the kinds of force: their functions, and what a crane lacks without them.

use super::forces::Kind;
use crate::chain::Group;
use crate::program::FunctionId;

/// What belongs to a kind of force.
pub struct KindRow {
    /// Its generalized forces.
    pub forces: FunctionId,
    /// The energy that it stores, if it can.
    pub energy: Option<FunctionId>,
    /// What is left out without it, and why.
    pub absent: (&'static str, &'static str),
}

impl Kind {
    /// Its row of the table.
    pub fn row(self) -> &'static KindRow {
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

const SUPPORTS: KindRow = KindRow {
    forces: FunctionId::SupportForces,
    energy: Some(FunctionId::SupportEnergy),
    absent: ("supports", "the spec has none"),
};

const ELEMENTS: KindRow = KindRow {
    forces: FunctionId::ElementForces,
    energy: Some(FunctionId::ElementEnergy),
    absent: ("springs and dampers of rigid elements", "no link is flexible"),
};

const DRIVES: KindRow = KindRow {
    forces: FunctionId::DriveForces,
    energy: Some(FunctionId::DriveEnergy),
    absent: ("drives", "the spec has none"),
};

const JOINT_DAMPERS: KindRow = KindRow {
    forces: FunctionId::JointDamperForces,
    energy: None,
    absent: ("viscous damping of joints", "the spec has none"),
};

const STOPS: KindRow = KindRow {
    forces: FunctionId::StopForces,
    energy: Some(FunctionId::StopEnergy),
    absent: ("end stops", "the spec has none"),
};

const FRICTION: KindRow =
    KindRow { forces: FunctionId::FrictionForces, energy: None, absent: ("friction of joints", "the spec has none") };

const LOADS: KindRow = KindRow {
    forces: FunctionId::LoadForces,
    energy: None,
    absent: ("loads applied from outside", "the spec has none"),
};

const CONNECTORS: KindRow = KindRow {
    forces: FunctionId::ConnectorForces,
    energy: Some(FunctionId::ConnectorEnergy),
    absent: ("springs and ropes between points, couplings with springs", "the spec has none"),
};
