//! Drives and their motions, and the damping of passive joints.

use super::numbers::Whose;
use super::plausibility::rounded;
use super::{Check, Owner};
use crate::chain::{
    self, CoordinateId, CoordinateKind, Drive, Force, Group, Law, Profile, Rotor, Segment, Spring, Transmission, Value,
};
use crate::diagnostic::{Span, rule};
use crate::expand::curve;
use crate::spec::{self, Angle, Crane, Curve, Halt, Motion, Number, Scalar, Spanned, Table};

impl<'a> Check<'a> {
    /// The drives and their rotors.
    pub(super) fn drives(&mut self, crane: &'a Crane) -> (Vec<Drive>, Vec<Rotor>) {
        let mut drives: Vec<Drive> = Vec::new();
        let mut rotors = Vec::new();
        let given = match &crane.drives {
            Some(Spanned { value: Some(drives), .. }) => drives.as_slice(),
            drives => {
                self.unknown_drives = drives.is_some();
                &[]
            }
        };
        for given in given {
            let Some(drive) = &given.value else {
                self.unknown_drives = true;
                continue;
            };
            let coordinate = self.joint_coordinate(&drive.coordinate);
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let name = drive.coordinate.value.as_deref().unwrap_or_default();
            let transmission = self.transmission(drive, given.span, name, kind);
            let subject = format!("the armature of drive `{name}`");
            let armature = drive.armature.as_ref();
            let armature = armature.map_or(Value::ZERO, |given| self.number_of(given, Whose::Joint(kind), &subject));
            let motion_span = drive.motion.as_ref().map_or(given.span, |motion| motion.span);
            let profile = match &drive.motion {
                Some(motion) => {
                    motion.value.as_ref().and_then(|motion| self.motion(motion, Whose::Joint(kind), motion_span))
                }
                None => Some(Profile::Hold(Value::ZERO)),
            };
            let profile = profile.map(|profile| self.halted(profile, drive.halt.as_ref(), name));
            self.motion_moves(drive, given.span, name);
            let offset = drive.offset.as_ref().map(|offset| self.input(offset));
            let Some(id) = coordinate else {
                self.unknown_drives = true;
                continue;
            };
            if let Some(owner) = self.not_a_joint(id) {
                self.report(rule::cannot_drive(drive.coordinate.span, name, owner));
            } else if drives.iter().any(|before| before.coordinate == id) {
                self.report(rule::driven_twice(drive.coordinate.span, name));
            }
            let unknown = || Profile::Hold(f64::NAN.into());
            let motion = profile.unwrap_or_else(unknown);
            let profile = match offset {
                Some(offset) => Profile::Sum(Box::new([motion, offset.unwrap_or_else(unknown)])),
                None => motion,
            };
            if transmission == Transmission::Rigid && profile.has_input() {
                self.report(rule::rigid_input(motion_span, name));
            }
            if transmission == Transmission::Rigid
                && let Some(begin) = jump(&profile)
            {
                self.report(rule::jumps(motion_span, name, begin));
            }
            drives.push(Drive { coordinate: id, transmission, profile });
            if !armature.is_zero() {
                rotors.push(Rotor { coordinate: id, armature });
            }
        }
        (drives, rotors)
    }

    /// A motion moves a spring, a damper or the joint itself; a spring and a rigid drive need one.
    fn motion_moves(&mut self, drive: &spec::Drive, span: Span, name: &str) {
        let rigid = drive.rigid.as_ref().is_some_and(|rigid| rigid.value != Some(false));
        match &drive.motion {
            None if rigid || drive.stiffness.is_some() => {
                self.report(rule::drive_without_motion(span, name));
            }
            Some(motion)
                if drive.effort.is_some() && drive.stiffness.is_none() && drive.damping.is_none() && !rigid =>
            {
                self.report(rule::motion_without_spring(motion.span, name));
            }
            _ => {}
        }
    }

    /// A spring and a damper, an effort, or a rigid transmission.
    fn transmission(
        &mut self,
        drive: &spec::Drive,
        span: Span,
        name: &str,
        kind: Option<CoordinateKind>,
    ) -> Transmission {
        let of = Whose::Joint(kind);
        let subject = |what| format!("the {what} of drive `{name}`");
        let [stiffness, damping] = [(&drive.stiffness, "stiffness"), (&drive.damping, "damping")]
            .map(|(given, what)| given.as_ref().map(|given| self.number_of(given, of, &subject(what))));
        if drive.rigid.as_ref().is_some_and(|rigid| rigid.value == Some(true)) {
            for (key, span) in [
                ("stiffness", drive.stiffness.as_ref().map(|given| given.span)),
                ("damping", drive.damping.as_ref().map(|given| given.span)),
                ("effort", drive.effort.as_ref().map(|given| given.span)),
                ("max_effort", drive.max_effort.as_ref().map(|given| given.span)),
                ("max_rate", drive.max_rate.as_ref().map(|constant| constant.span)),
                ("max_power", drive.max_power.as_ref().map(|constant| constant.span)),
            ] {
                if let Some(span) = span {
                    let subject = format!("drive `{name}`");
                    self.report(rule::rigid_spring(span, subject, key, "effort follows from its motion"));
                }
            }
            return Transmission::Rigid;
        }
        // An invalid value of `rigid` has been reported already.
        let unread = drive.rigid.as_ref().is_some_and(|rigid| rigid.value.is_none());
        if stiffness.is_none() && drive.effort.is_none() && !unread {
            self.report(rule::no_transmission(
                span,
                format!("drive `{name}`"),
                "none of `stiffness`, `rigid: true` and `effort`",
                "`rigid: true` if the coordinate follows the motion exactly, or `effort:`, its torque or force",
            ));
        }
        let max_effort = drive.max_effort.as_ref();
        let max_effort = max_effort.map(|given| self.number_of(given, of, &subject("maximum effort")));
        let effort = drive.effort.as_ref().map(|given| {
            let motion = given.value.as_ref();
            let profile = motion.and_then(|motion| self.motion(motion, of, given.span));
            profile.unwrap_or(Profile::Hold(f64::NAN.into()))
        });
        let stiffness = stiffness.unwrap_or(if effort.is_some() { Value::ZERO } else { f64::NAN.into() });
        // The energy of a drive with an effort limit is the integral of its spring force: it needs a spring.
        if let (Some(given), Some(_)) = (&drive.stiffness, &max_effort) {
            let broken = rule::limited_without_spring(given.span, name);
            if self.now(&stiffness) == 0.0 {
                self.report(broken.clone());
            }
            self.keep_positive(stiffness.clone(), &broken);
        }
        let [max_rate, max_power] = [(&drive.max_rate, "rate"), (&drive.max_power, "power")].map(|(given, what)| {
            let constant = given.as_ref()?;
            if max_effort.is_none() {
                self.report(rule::limit_without_effort(constant.span, name, format!("max_{what}")));
            }
            self.number_of(constant, of, &format!("the maximum {what} of drive `{name}`")).as_constant()
        });
        Transmission::Flexible {
            stiffness,
            damping: damping.unwrap_or(Value::ZERO),
            effort,
            max_effort,
            max_rate,
            max_power,
        }
    }

    pub(super) fn joint_dampers(&mut self, crane: &'a Crane, drives: &[Drive]) -> Vec<Force> {
        let mut dampers: Vec<(CoordinateId, Value)> = Vec::new();
        let entries = crane.damping.as_ref().and_then(|damping| damping.value.as_ref());
        for (name, damping) in entries.into_iter().flat_map(|entries| &entries.0) {
            let coordinate = self.joint_coordinate(name);
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let subject = format!("the damping of `{}`", name.value.as_deref().unwrap_or_default());
            let damping = self.number_of(damping, Whose::Joint(kind), &subject);
            let Some(id) = coordinate else { continue };
            let owner = match &self.owners[id.0] {
                Owner::Beam(link) => Some(format!("the springs of beam `{link}`")),
                Owner::Pads(link) => Some(format!("the pads of beam `{link}`")),
                _ if drives.iter().any(|drive| drive.coordinate == id) => Some("a drive".into()),
                _ => None,
            };
            if let Some(owner) = owner {
                self.report(rule::not_passive(name.span, &self.coordinates[id.0].name, owner));
            }
            dampers.push((id, damping));
        }
        // Damping given for a single joint replaces the damping that its rope gives to all joints.
        let given: Vec<CoordinateId> = dampers.iter().map(|(id, _)| *id).collect();
        let of_ropes = std::mem::take(&mut self.rope_damping).into_iter();
        dampers.extend(of_ropes.filter(|(id, _)| !given.contains(id)));
        let force = |(id, damping)| {
            let law = Law::Spring(Spring::new(Value::ZERO, damping));
            Force::on(&self.coordinates, Group::JointDampers, id, law)
        };
        dampers.into_iter().map(force).collect()
    }

    /// Rotors of joints without a drive.
    pub(super) fn rotors(&mut self, crane: &'a Crane, drives: &[Drive]) -> Vec<Rotor> {
        let mut rotors = Vec::new();
        let Some(entries) = crane.armature.as_ref().and_then(|armature| armature.value.as_ref()) else { return rotors };
        for (name, armature) in &entries.0 {
            let coordinate = self.joint_coordinate(name);
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let subject = format!("the armature of `{}`", name.value.as_deref().unwrap_or_default());
            let armature = self.number_of(armature, Whose::Joint(kind), &subject);
            let Some(id) = coordinate else { continue };
            let name_of = &self.coordinates[id.0].name;
            if let Some(owner) = self.not_a_joint(id) {
                self.report(rule::no_rotor(name.span, name_of, owner, "remove it: only joints have rotors"));
            } else if drives.iter().any(|drive| drive.coordinate == id) {
                self.report(rule::no_rotor(name.span, name_of, "a drive", "write `armature:` in the drive"));
            } else if !armature.is_zero() {
                rotors.push(Rotor { coordinate: id, armature });
            }
        }
        rotors
    }

    /// The owner of a coordinate, if it is not a joint.
    pub(super) fn not_a_joint(&self, CoordinateId(index): CoordinateId) -> Option<String> {
        match &self.owners[index] {
            Owner::Joint => None,
            Owner::Base => Some("the free base".into()),
            Owner::Beam(link) => Some(format!("the springs of beam `{link}`")),
            Owner::Pads(link) => Some(format!("the pads of beam `{link}`")),
        }
    }

    /// A motion, whose unit may depend on what it moves.
    pub(super) fn motion(&mut self, motion: &Motion, of: Whose<'_>, span: Span) -> Option<Profile> {
        Some(match motion {
            Motion::Hold(position) => Profile::Hold(self.number_of(position, of, "`hold`")),
            Motion::Quintic(r) => Profile::Quintic(self.ramp(of, &r.from, &r.to, r.begin.as_ref(), &r.duration)),
            Motion::Cubic(r) => Profile::Cubic(self.ramp(of, &r.from, &r.to, r.begin.as_ref(), &r.duration)),
            Motion::Cycloid(r) => Profile::Cycloid(self.ramp(of, &r.from, &r.to, r.begin.as_ref(), &r.duration)),
            Motion::Trapezoid(r) => {
                let ramp = self.ramp(of, &r.from, &r.to, r.begin.as_ref(), &r.duration);
                let blend = r.blend.as_ref().map_or(0.25, |blend| {
                    let share = self.constant(blend, "`blend`");
                    if share <= 0.0 || share > 0.5 {
                        self.report(rule::blend(blend.span, share));
                    }
                    share
                });
                Profile::Trapezoid { ramp, blend }
            }
            Motion::Speed(speed) => {
                let from = speed.from.as_ref();
                let (begin, ramp) = (speed.begin.as_ref(), speed.ramp.as_ref());
                Profile::Speed {
                    from: from.map_or(Value::ZERO, |from| self.number_of(from, of, "`from`")),
                    rate: self.rate(&speed.rate, of),
                    begin: begin.map_or(Value::ZERO, |begin| self.number(begin, "`begin`")),
                    ramp: ramp.map(|ramp| self.number(ramp, "the ramp of a motion")),
                }
            }
            Motion::Table(table) => self.table(table, of, span)?,
            Motion::Input(name) => self.input(name)?,
        })
    }

    /// The motion of a part with its emergency stop.
    pub(super) fn halted(&mut self, motion: Profile, halt: Option<&Spanned<Halt>>, name: &str) -> Profile {
        let Some((given, halt)) = halt.and_then(|given| Some((given, given.value.as_ref()?))) else { return motion };
        let at = self.number(&halt.at, "`at` of `halt`");
        let within = self.number(&halt.within, "`within` of `halt`");
        match motion {
            // A drive that is held for an analysis keeps its halt.
            Profile::Hold(_) => motion,
            Profile::Input(..) => {
                self.report(rule::halted_input(given.span, name));
                motion
            }
            _ => Profile::Halted { motion: Box::new(motion), at, within },
        }
    }

    /// The rate of a motion; `90 deg` is 90° per second.
    fn rate(&mut self, given: &Spanned<Angle>, of: Whose<'_>) -> Value {
        let unit = given.value.as_ref().and_then(|Angle(_, measure)| of.unit(measure));
        if unit == Some("rad") && given.value.as_ref().is_some_and(|Angle(scalar, _)| self.is_angle(scalar)) {
            self.units.push((given.span, "rad/s".to_owned()));
            return self.number_of(given, of, "`rate`");
        }
        let rate = unit.map(|unit| if unit.is_empty() { "1/s".to_owned() } else { format!("{unit}/s") });
        self.number_of(given, Whose::Own(rate.as_deref()), "`rate`")
    }

    /// Whether a number is written as an angle, or is a parameter that is one.
    fn is_angle(&self, scalar: &Scalar) -> bool {
        let known = |name: &String| self.parameters.iter().position(|parameter| parameter.name == *name);
        let quantity = match scalar {
            Scalar::Quantity(quantity) => Some(&**quantity),
            Scalar::Name(name) => known(name).and_then(|index| self.written[index].as_ref()),
            Scalar::Number(_) => None,
        };
        quantity.is_some_and(|quantity| quantity.wrong_for("rad").is_none())
    }

    fn ramp(
        &mut self,
        of: Whose<'_>,
        from: &Spanned<Angle>,
        to: &Spanned<Angle>,
        begin: Option<&Spanned<Number>>,
        duration: &Spanned<Number>,
    ) -> chain::Ramp {
        chain::Ramp {
            from: self.number_of(from, of, "`from`"),
            to: self.number_of(to, of, "`to`"),
            begin: begin.map_or(Value::ZERO, |begin| self.number(begin, "`begin`")),
            duration: self.number(duration, "the duration of a motion"),
        }
    }

    fn table(&mut self, table: &Table, of: Whose<'_>, span: Span) -> Option<Profile> {
        let (Some(given), Some(values)) = (&table.times, &table.values) else {
            // A file that cannot be read is reported where it is read.
            if table.file.is_none() {
                self.report(rule::table_incomplete(span));
            }
            return None;
        };
        if let Some(column) = table.column.as_ref().filter(|_| table.file.is_none()) {
            self.report(rule::column_without_file(column.span));
        }
        let (given, written) = (given.value.as_ref()?, values.value.as_ref()?);
        let values: Vec<f64> = written.iter().map(|value| self.fixed(value, of, "`values`")).collect();
        let times: Vec<f64> = given.iter().map(|time| self.constant(time, "`times`")).collect();
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
        let shape = table.shape.as_ref().and_then(|shape| shape.value);
        let shape = shape.unwrap_or(if table.file.is_some() { Curve::Spline } else { Curve::Monotone });
        let segments = match shape {
            Curve::Monotone => curve::monotone(&times, &values),
            Curve::Spline => curve::spline(&times, &values),
            Curve::Linear => curve::linear(&times, &values),
        };
        if let Some(Overshoot { between: [from, to], reached }) = overshoot(&values, &segments) {
            let unit = written.first().and_then(|value| of.unit(value.value.as_ref()?.1)).unwrap_or_default();
            let reached = format!("{} {unit}", rounded(reached));
            self.warnings.push(rule::overshoot(span, from, to, reached.trim_end()));
        }
        Some(Profile::Table { from: values[0], segments })
    }
}

/// Where a curve leaves the range of two neighbouring points.
struct Overshoot {
    between: [f64; 2],
    reached: f64,
}

/// Where a curve leaves the range of two neighbouring points furthest, if by more than a share of the range of all.
fn overshoot(values: &[f64], segments: &[Segment]) -> Option<Overshoot> {
    /// Share of the range of the table.
    const SEEN: f64 = 0.05;
    let range = values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min);
    let beyond = |(pair, segment): (&[f64], &Segment)| {
        let [start, end] = [pair[0], pair[1]];
        let reached = segment.extremes().into_iter().map(|rise| start + rise);
        let by = |reached: f64| (reached - start.max(end)).max(start.min(end) - reached);
        let reached = reached.max_by(|a, b| by(*a).total_cmp(&by(*b)))?;
        Some((by(reached), Overshoot { between: [start, end], reached }))
    };
    let furthest = values.windows(2).zip(segments).filter_map(beyond).max_by(|(a, _), (b, _)| a.total_cmp(b));
    furthest.filter(|(by, _)| *by > SEEN * range).map(|(_, found)| found)
}

/// The time at which a motion jumps to its speed, as text, if it does so during a run.
fn jump(profile: &Profile) -> Option<String> {
    match profile {
        Profile::Speed { begin: Value::Constant(begin), ramp: None, .. } => {
            (*begin > 0.0).then(|| format!("t = {begin} s"))
        }
        Profile::Speed { ramp: None, .. } => Some("the live `begin`".into()),
        Profile::Table { segments, .. } => chain::first_jump(segments).map(|time| format!("t = {time} s")),
        _ => None,
    }
}
