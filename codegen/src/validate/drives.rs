//! Drives and their motions, and the damping of passive joints.

use super::limits::Limit;
use super::{Check, Owner};
use crate::chain::{self, CoordinateId, CoordinateKind, Drive, Hinge, Profile, Value};
use crate::diagnostic::{Span, rule};
use crate::expand::spline;
use crate::spec::{Angle, Crane, Given, Motion, Number, Table};

/// Unit of a drive's stiffness and damping.
fn units(kind: Option<CoordinateKind>) -> (&'static str, &'static str) {
    match kind {
        Some(CoordinateKind::Translation) => ("N/m", "N s/m"),
        _ => ("N m/rad", "N m s/rad"),
    }
}

impl<'a> Check<'a> {
    pub(super) fn drives(&mut self, crane: &'a Crane) -> Vec<Drive> {
        let mut drives: Vec<Drive> = Vec::new();
        let given = crane.drives.as_ref().and_then(|drives| drives.value.as_deref()).unwrap_or_default();
        for drive in given.iter().filter_map(|drive| drive.value.as_ref()) {
            let coordinate = self.coordinate(&drive.coordinate);
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let name = drive.coordinate.value.as_deref().unwrap_or_default();
            let (stiffness_unit, damping_unit) = units(kind);
            let place = |what: &str| format!("the {what} of drive `{name}`");
            let stiffness = self.number(&drive.stiffness, &place("stiffness"), stiffness_unit, Limit::NotNegative);
            let damping = drive.damping.as_ref();
            let damping = self.number_or(damping, 0.0, &place("damping"), damping_unit, Limit::NotNegative);
            let profile = drive.motion.value.as_ref().and_then(|motion| self.motion(motion, kind, drive.motion.span));
            let Some(id) = coordinate else { continue };
            if let Some(owner) = self.not_a_joint(id) {
                self.report(rule::cannot_drive(drive.coordinate.span, name, owner));
            } else if drives.iter().any(|before| before.coordinate == id) {
                self.report(rule::driven_twice(drive.coordinate.span, name));
            }
            let profile = profile.unwrap_or(Profile::Hold(f64::NAN.into()));
            drives.push(Drive { coordinate: id, stiffness, damping, profile });
        }
        drives
    }

    pub(super) fn hinges(&mut self, crane: &'a Crane, drives: &[Drive]) -> Vec<Hinge> {
        let mut hinges = Vec::new();
        let Some(entries) = crane.damping.as_ref().and_then(|damping| damping.value.as_ref()) else { return hinges };
        for (name, damping) in &entries.0 {
            let coordinate = self.coordinate(name);
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let place = format!("the damping of `{}`", name.value.as_deref().unwrap_or_default());
            let damping = self.number(damping, &place, units(kind).1, Limit::NotNegative);
            let Some(id) = coordinate else { continue };
            let owner = match &self.owners[id.0] {
                Owner::Beam(link) => Some(format!("the springs of beam `{link}`")),
                _ if drives.iter().any(|drive| drive.coordinate == id) => Some("a drive".into()),
                _ => None,
            };
            if let Some(owner) = owner {
                self.report(rule::not_passive(name.span, &self.coordinates[id.0].name, owner));
            }
            hinges.push(Hinge { coordinate: id, damping });
        }
        hinges
    }

    /// What a coordinate belongs to, if that is not a joint.
    fn not_a_joint(&self, CoordinateId(index): CoordinateId) -> Option<String> {
        match &self.owners[index] {
            Owner::Joint => None,
            Owner::Base => Some("the free base".into()),
            Owner::Beam(link) => Some(format!("the springs of beam `{link}`")),
        }
    }

    fn motion(&mut self, motion: &Motion, kind: Option<CoordinateKind>, span: Span) -> Option<Profile> {
        Some(match motion {
            Motion::Hold(position) => Profile::Hold(self.position(position, kind, "`hold`")),
            Motion::Quintic(r) => Profile::Quintic(self.ramp(kind, &r.from, &r.to, r.begin.as_ref(), &r.duration)),
            Motion::Cubic(r) => Profile::Cubic(self.ramp(kind, &r.from, &r.to, r.begin.as_ref(), &r.duration)),
            Motion::Cycloid(r) => Profile::Cycloid(self.ramp(kind, &r.from, &r.to, r.begin.as_ref(), &r.duration)),
            Motion::Trapezoid(r) => {
                let ramp = self.ramp(kind, &r.from, &r.to, r.begin.as_ref(), &r.duration);
                let blend = r.blend.as_ref().map_or(0.25, |blend| {
                    let share = self.constant(blend, "`blend`", "", Limit::Any);
                    if share <= 0.0 || share > 0.5 {
                        self.report(rule::blend(blend.span, share));
                    }
                    share
                });
                Profile::Trapezoid { ramp, blend }
            }
            Motion::Table(table) => self.table(table, kind, span)?,
        })
    }

    fn ramp(
        &mut self,
        kind: Option<CoordinateKind>,
        from: &Given<Angle>,
        to: &Given<Angle>,
        begin: Option<&Given<Number>>,
        duration: &Given<Number>,
    ) -> chain::Ramp {
        chain::Ramp {
            from: self.position(from, kind, "`from`"),
            to: self.position(to, kind, "`to`"),
            begin: begin.map_or(Value::ZERO, |begin| self.number(begin, "`begin`", "s", Limit::Any)),
            duration: self.number(duration, "the duration of a motion", "s", Limit::Positive),
        }
    }

    fn table(&mut self, table: &Table, kind: Option<CoordinateKind>, span: Span) -> Option<Profile> {
        let (given, values) = (table.times.value.as_ref()?, table.values.value.as_ref()?);
        let values: Vec<f64> = values.iter().map(|value| self.fixed(value, "`values`", kind)).collect();
        let times: Vec<f64> = given.iter().map(|time| self.constant(time, "`times`", "s", Limit::Any)).collect();
        let mut ordered = true;
        for (pair, later) in times.windows(2).zip(given.iter().skip(1)) {
            if pair[0] >= pair[1] {
                self.report(rule::table_order(later.span, pair[0], pair[1]));
                ordered = false;
            }
        }
        if times.len() != values.len() || times.len() < 2 {
            self.report(rule::table_length(span, times.len(), values.len()));
            return None;
        }
        if !ordered {
            return None;
        }
        Some(Profile::Table { from: values[0], segments: spline::clamped(&times, &values) })
    }
}
