//! The columns of results that the parts of a crane have.

use super::{CoordinateInfo, Description, LoopJointInfo};
use crate::ColumnKind;

/// The part whose columns are those of the pump.
pub const PUMP: &str = "pump";

/// A column of results of a part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartColumn<'a> {
    /// What the part is, for messages; empty for the pump.
    pub what: &'static str,
    /// Its name.
    pub part: &'a str,
    /// What the column shows.
    pub kind: ColumnKind,
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
}

/// Columns in order.
struct Columns<'a>(Vec<PartColumn<'a>>);

impl<'a> Columns<'a> {
    fn add(&mut self, what: &'static str, part: &'a str, turns: bool, kind: ColumnKind) {
        for ending in kind.endings(turns) {
            self.add_ending(what, part, turns, kind, ending);
        }
    }

    fn add_ending(&mut self, what: &'static str, part: &'a str, turns: bool, kind: ColumnKind, ending: &str) {
        self.0.push(PartColumn { what, part, kind, name: [part, ending].concat(), unit: kind.unit(turns) });
    }

    /// Columns of coordinates.
    fn add_joints(&mut self, infos: impl Iterator<Item = &'a CoordinateInfo>, kinds: &[ColumnKind]) {
        for info in infos {
            for kind in kinds {
                self.add("coordinate", &info.name, info.kind.turns(), *kind);
            }
        }
    }
}

impl Description {
    /// The columns of the parts of the crane at a state, in the order of their values: after the time and before the energies.
    pub fn columns<'a>(&'a self, loop_joints: &'a [LoopJointInfo]) -> Vec<PartColumn<'a>> {
        let mut columns = Columns(Vec::new());
        let at = |coordinate: usize| &self.coordinates[coordinate];
        columns.add_joints(self.coordinates.iter(), &[ColumnKind::Position]);
        columns.add_joints(self.coordinates.iter(), &[ColumnKind::Rate]);
        let driven = self.drives.iter().map(|drive| at(drive.coordinate));
        columns.add_joints(driven, &[ColumnKind::Prescribed, ColumnKind::DriveEffort]);
        for cylinder in &self.cylinders {
            for kind in ColumnKind::OF_CYLINDER {
                columns.add("cylinder", &cylinder.name, false, kind);
            }
        }
        // In a fleet, the cylinders of all cranes have the same names.
        for _ in self.cylinders.iter().filter(|cylinder| cylinder.name == self.cylinders[0].name) {
            columns.add("", PUMP, false, ColumnKind::Flow);
            columns.add("", PUMP, false, ColumnKind::Power);
        }
        if self.has_valves() {
            columns.add("", PUMP, false, ColumnKind::PumpPressure);
        }
        for cylinder in self.cylinders.iter().filter(|cylinder| cylinder.valve.is_some()) {
            columns.add("cylinder", &cylinder.name, false, ColumnKind::Valve);
        }
        for point in &self.points {
            columns.add("point", point, false, ColumnKind::PointPosition);
            columns.add("point", point, false, ColumnKind::PointVelocity);
        }
        for support in &self.supports {
            columns.add("support", &support.name, false, ColumnKind::LateralReaction);
            columns.add("support", &support.name, false, ColumnKind::VerticalReaction);
        }
        let feet = self.supports.iter().filter(|support| support.one_sided);
        feet.clone().for_each(|foot| columns.add("support", &foot.name, false, ColumnKind::Gap));
        for ending in ColumnKind::Slid.endings(false) {
            let mut add = |foot: &'a str| columns.add_ending("support", foot, false, ColumnKind::Slid, ending);
            feet.clone().for_each(|foot| add(&foot.name));
        }
        let elements = self.coordinates.iter().filter(|info| info.role.is_element());
        columns.add_joints(elements, &[ColumnKind::ElementMoment]);
        columns.add_joints(self.stops.iter().map(|stop| at(*stop)), &[ColumnKind::StopEffort]);
        columns.add_joints(self.frictions.iter().map(|joint| at(*joint)), &[ColumnKind::FrictionEffort]);
        columns.add_joints(self.bristles.iter().map(|joint| at(joint.coordinate)), &[ColumnKind::Bristle]);
        for connector in &self.connectors {
            let strain = connector.strain();
            for kind in [ColumnKind::Strain(strain), ColumnKind::StrainRate(strain), connector.effort()] {
                columns.add("connector", &connector.name, connector.kind.turns(), kind);
            }
        }
        for joint in loop_joints {
            let what = if joint.is_coupling() { "connector" } else { "loop joint" };
            for equation in &joint.equations {
                let kind = equation.effort();
                columns.add_ending(what, &joint.name, false, kind, kind.ending_along(&equation.direction));
            }
        }
        columns.0
    }
}
