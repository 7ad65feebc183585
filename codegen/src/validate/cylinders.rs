//! Hydraulic cylinders.

use super::Check;
use super::numbers::Whose;
use crate::chain::{
    BodyId, CoordinateId, CoordinateKind, Cylinder, Drive, Linkage, Pin, Profile, Pump, Transmission, Valve,
};
use crate::diagnostic::{Span, rule};
use crate::spec::{self, Constant, Crane, Side, Spanned};

/// Default volume of the oil between pump and valves, m³.
const VOLUME: f64 = 5e-3;

impl<'a> Check<'a> {
    pub(super) fn cylinders(&mut self, crane: &'a Crane, drives: &[Drive]) -> Vec<Cylinder> {
        let given = crane.cylinders.as_ref().and_then(|cylinders| cylinders.value.as_deref()).unwrap_or_default();
        let mut cylinders: Vec<Cylinder> = Vec::new();
        for given in given.iter().filter_map(|cylinder| cylinder.value.as_ref()) {
            if let Some(cylinder) = self.cylinder(given, drives) {
                if let Some(other) = cylinders.iter().find(|other| other.coordinate == cylinder.coordinate) {
                    let joint = given.coordinate.value.as_deref().unwrap_or_default();
                    self.report(rule::second_cylinder(given.coordinate.span, joint, &other.name));
                }
                cylinders.push(cylinder);
            }
        }
        cylinders
    }

    /// The pump that supplies the cylinders.
    pub(super) fn pump(&mut self, crane: &'a Crane) -> Option<Pump> {
        let given = crane.pump.as_ref()?;
        if crane.cylinders.is_none() {
            self.report(rule::pump_alone(given.span));
        }
        let pump = given.value.as_ref()?;
        let max_flow = self.constant(&pump.max_flow, "the maximum flow of the pump");
        let pressure = pump.pressure.as_ref();
        let pressure = pressure.map(|constant| self.constant(constant, "the pressure of the pump"));
        let volume = pump
            .volume
            .as_ref()
            .map_or(VOLUME, |constant| self.constant(constant, "the volume between pump and valves"));
        Some(Pump { max_flow, pressure, volume })
    }

    /// Changes the transmission of joints with a valve-controlled cylinder to oil.
    pub(super) fn make_drives_hydraulic(
        &mut self,
        crane: &'a Crane,
        cylinders: &[Cylinder],
        pump: Option<&Pump>,
        drives: &mut [Drive],
    ) {
        let given = crane.cylinders.as_ref().and_then(|cylinders| cylinders.value.as_deref()).unwrap_or_default();
        for given in given.iter().filter_map(|cylinder| cylinder.value.as_ref()) {
            let Some(valve) = &given.valve else { continue };
            let span = valve.span;
            let name = given.name.value.as_deref().unwrap_or_default();
            if pump.is_none_or(|pump| pump.pressure.is_none()) {
                self.report(rule::valve_without_pressure(valve.span, name));
            }
            let needed = [
                ("bulk_modulus", given.bulk_modulus.is_some()),
                ("max_pressure", given.max_pressure.is_some()),
                ("hose_volumes", given.hose_volumes.is_some()),
            ];
            let missing: Vec<String> =
                needed.iter().filter(|(_, there)| !there).map(|(key, _)| format!("`{key}`")).collect();
            if !missing.is_empty() {
                self.report(rule::valve_without_oil(valve.span, name, missing.join(", ")));
            }
            let Some(cylinder) = cylinders.iter().find(|cylinder| cylinder.name == name) else { continue };
            if let Some(volumes) = &given.hose_volumes
                && cylinder.hose_volumes.contains(&0.0)
            {
                self.report(rule::no_oil_at_the_end(volumes.span, name));
            }
            let opening = valve.value.as_ref().and_then(|valve| self.opening(valve, span, name));
            let Some(drive) = drives.iter_mut().find(|drive| drive.coordinate == cylinder.coordinate) else { continue };
            if opening.is_some() && !matches!(drive.profile, Profile::Hold(_)) {
                self.report(rule::valve_commanded_twice(valve.span, name, "a drive that moves"));
            }
            match &drive.transmission {
                Transmission::Flexible { stiffness, effort: None, max_effort: None, .. } => {
                    drive.transmission = Transmission::Oil { stiffness: stiffness.clone(), opening };
                }
                Transmission::Flexible { .. } | Transmission::Rigid => {
                    let joint = self.coordinates[cylinder.coordinate.0].name.clone();
                    self.report(rule::valve_of_another_drive(valve.span, name, joint));
                }
                Transmission::Oil { .. } => (),
            }
        }
    }

    /// The command of a valve over time, if it has one.
    fn opening(&mut self, valve: &spec::Valve, span: Span, name: &str) -> Option<Profile> {
        let Some(motion) = &valve.opening else {
            if valve.gain.is_none() {
                self.report(rule::uncommanded_valve(span, name));
            }
            return None;
        };
        for (key, other) in [("`gain`", &valve.gain), ("`feed_forward`", &valve.feed_forward)] {
            if let Some(other) = other {
                self.report(rule::valve_commanded_twice(other.span, name, key));
            }
        }
        self.motion(motion.value.as_ref()?, Whose::Key, motion.span)
    }

    fn valve(&mut self, given: &spec::Valve, name: &str) -> Valve {
        let subject = |what: &str| format!("the {what} of the valve of cylinder `{name}`");
        let flow = self.constant(&given.flow, &subject("flow"));
        let drop = self.constant(&given.pressure_drop, &subject("pressure drop"));
        let mut optional = |given: Option<&Spanned<Constant>>, what: &str, default| {
            given.map_or(default, |constant| self.constant(constant, &subject(what)))
        };
        let overlap = optional(given.overlap.as_ref(), "overlap", 0.0);
        let valve = Valve {
            flow,
            pressure_drop: drop,
            overlap,
            lag: optional(Some(&given.lag), "lag", 0.0),
            gain: optional(given.gain.as_ref(), "gain", 0.0),
            feed_forward: optional(given.feed_forward.as_ref(), "feed-forward", 1.0),
            leakage: optional(given.leakage.as_ref(), "leakage", 0.0),
        };
        if let Some(constant) = given.overlap.as_ref().filter(|_| overlap >= 1.0) {
            self.report(rule::covered_valve(constant.span, name, overlap));
        }
        valve
    }

    fn cylinder(&mut self, given: &spec::Cylinder, drives: &[Drive]) -> Option<Cylinder> {
        let name = self.name(&given.name).unwrap_or_default().to_owned();
        if !name.is_empty() {
            self.register_name("cylinders", &name, "an earlier cylinder".into(), given.name.span);
        }
        let subject = |what: &str| format!("the {what} of cylinder `{name}`");
        let bore = self.constant(&given.bore, &subject("bore"));
        let rod = self.constant(&given.rod, &subject("rod"));
        if rod >= bore {
            self.report(rule::thick_rod(given.rod.span, &name, rod, bore));
        }
        let retracted = self.constant(&given.retracted, &subject("retracted length"));
        let stroke = self.constant(&given.stroke, &subject("stroke"));
        let mut pressure = |given: Option<&Spanned<Constant>>, what: &str| {
            given.map(|constant| self.constant(constant, &subject(what)))
        };
        let max_pressure = pressure(given.max_pressure.as_ref(), "maximum pressure");
        let back_pressure = pressure(given.back_pressure.as_ref(), "back pressure").unwrap_or(0.0);
        let bulk_modulus = pressure(given.bulk_modulus.as_ref(), "bulk modulus");
        let hose_volumes = match given.hose_volumes.as_ref().map(|volumes| &volumes.value) {
            Some(Some(volumes)) => volumes.each_ref().map(|volume| self.constant(volume, &subject("hose volume"))),
            Some(None) => [f64::NAN; 2],
            None => [0.0; 2],
        };
        let valve = given.valve.as_ref().and_then(|valve| valve.value.as_ref()).map(|valve| self.valve(valve, &name));
        let foot = self.pin(given.foot.value.as_ref(), &subject("foot"));
        let head = self.pin(given.head.value.as_ref(), &subject("head"));
        let joint = given.coordinate.value.as_deref().unwrap_or_default();
        let coordinate = self.joint_coordinate(&given.coordinate)?;
        if !self.unknown_drives && !drives.iter().any(|drive| drive.coordinate == coordinate) {
            self.report(rule::undriven(given.coordinate.span, &name, joint));
        }
        let kind = self.coordinates[coordinate.0].kind;
        let linkage = given.linkage.as_ref().map(|linkage| {
            if kind == CoordinateKind::Translation {
                self.report(rule::straight_linkage(linkage.span, &name, joint));
            }
            // Otherwise its link is unknown, which has been reported.
            foot.as_ref()?;
            self.linkage(linkage.value.as_ref()?, &given.foot.value.as_ref()?.link, &name)
        });
        let (foot, head) = (foot?, head?);
        self.spans(given, &name, coordinate, [foot.body, head.body]);
        Some(Cylinder {
            coordinate,
            foot,
            head,
            linkage: linkage.flatten(),
            bore,
            rod,
            retracted,
            stroke,
            max_pressure,
            back_pressure,
            bulk_modulus,
            hose_volumes,
            valve,
            name,
        })
    }

    fn pin(&mut self, given: Option<&spec::Pin>, subject: &str) -> Option<Pin> {
        let given = given?;
        let at = self.vector(&given.at, subject);
        let (body, position) = self.attach(&given.link, at)?;
        Some(Pin { body, position })
    }

    /// A linkage, whose pivot is on the link of the foot.
    fn linkage(&mut self, given: &spec::Linkage, link: &Spanned<String>, name: &str) -> Option<Linkage> {
        let subject = |what: &str| format!("the {what} of the linkage of cylinder `{name}`");
        let at = self.vector(&given.pivot, &subject("pivot"));
        let (body, position) = self.attach(link, at)?;
        Some(Linkage {
            pivot: Pin { body, position },
            rocker: self.number(&given.rocker, &subject("rocker")),
            link: self.number(&given.link, &subject("link")),
            left: given.side.value == Some(Side::Left),
        })
    }

    /// Reports a cylinder whose joint is not between its pins, or that has another joint between them.
    fn spans(&mut self, cylinder: &spec::Cylinder, name: &str, joint: CoordinateId, [foot, head]: [BodyId; 2]) {
        // The bodies of a link with a mistake are missing between the pins.
        if self.unknown.links {
            return;
        }
        let [of_foot, of_head] = [foot, head].map(|body| self.coordinates_of(Some(body)));
        let of_both = |id: &CoordinateId| of_foot.contains(id) == of_head.contains(id);
        let mut between: Vec<CoordinateId> =
            of_foot.iter().chain(&of_head).copied().filter(|id| !of_both(id)).collect();
        between.sort_unstable();
        let called = &self.coordinates[joint.0].name;
        if !between.contains(&joint) {
            self.report(rule::spans_not(cylinder.coordinate.span, name, called));
        } else if let Some(other) = between.iter().find(|id| **id != joint && self.not_a_joint(**id).is_none()) {
            self.report(rule::spans_more(cylinder.coordinate.span, name, called, &self.coordinates[other.0].name));
        }
    }
}
