//! Angles that look like degrees, and positions of joints.

use std::f64::consts::TAU;

use super::lengths::is_far;
use super::{Plausibility, rounded};
use crate::chain::{Coordinate, CoordinateKind};
use crate::diagnostic::{Span, rule};
use crate::spec::{Angle, Input, Link, Motion, Placement, Scalar, Spanned, Turn, entries};

/// Bare angles beyond a full turn look like degrees; with four ulp of tolerance, because `6.283185307179586` is 2π.
const FULL_TURN: f64 = TAU * (1.0 + 4.0 * f64::EPSILON);

impl<'a> Plausibility<'a> {
    pub(super) fn angles(&mut self) {
        let crane = self.crane;
        for link in entries(Some(&crane.links)) {
            self.rotations(link);
        }
        for drive in entries(crane.drives.as_ref()) {
            let name = drive.coordinate.value.as_deref().unwrap_or_default();
            if let Some(motion) = drive.motion.as_ref().and_then(|motion| motion.value.as_ref()) {
                self.motion(motion, name);
            }
        }
        for (name, stops) in crane.stops.iter().filter_map(|stops| stops.value.as_ref()).flat_map(|stops| &stops.0) {
            let (name, stops) = (name.value.as_deref().unwrap_or_default(), stops.value.as_ref());
            for (scalar, at) in stops.into_iter().flat_map(|stops| [&stops.min, &stops.max]).flatten().map(written) {
                self.position(scalar, at, name, &format!("a stop of `{name}`"));
            }
        }
        for coupling in entries(crane.couplings.as_ref()) {
            let name = coupling.coordinate.value.as_deref().unwrap_or_default();
            for (scalar, at) in coupling.offset.iter().map(written) {
                self.position(scalar, at, name, &format!("the offset of `{name}`"));
            }
        }
        let guess = crane.guess.as_ref().and_then(|guess| guess.value.as_ref());
        for (name, position) in guess.into_iter().flat_map(|guess| &guess.0) {
            let name = name.value.as_deref().unwrap_or_default();
            let scalar = position.value.as_ref().map(|position| &position.0);
            self.position(scalar, position.span, name, &format!("the guess of `{name}`"));
        }
    }

    fn rotations(&mut self, link: &Link) {
        let name = link.name.value.as_deref().unwrap_or_default();
        let angles: Vec<&Spanned<Angle>> = match link.placement.as_ref().and_then(|placement| placement.value.as_ref())
        {
            Some(Placement::ModifiedDh(row)) => [&row.alpha, &row.theta].into_iter().flatten().collect(),
            Some(Placement::ClassicDh(row)) => [&row.alpha, &row.theta].into_iter().flatten().collect(),
            Some(Placement::Transform(transform)) => {
                let turns = transform.rotation.as_ref().and_then(|rotation| rotation.value.as_ref());
                let turns = turns.into_iter().flat_map(|turns| &turns.0).filter_map(|turn| turn.value.as_ref());
                turns.map(|(Turn::X(angle) | Turn::Y(angle) | Turn::Z(angle))| angle).collect()
            }
            None => vec![],
        };
        for (scalar, at) in angles.into_iter().map(written) {
            self.angle(scalar, at, &format!("a rotation of link `{name}`"));
        }
        let bend = link.beam.as_ref().and_then(|beam| beam.value.as_ref()?.bend.as_ref()?.value.as_ref());
        for (scalar, at) in bend.into_iter().flat_map(|bend| [&bend.psi, &bend.theta]).flatten().map(written) {
            self.angle(scalar, at, &format!("the `bend` of beam `{name}`"));
        }
    }

    fn motion(&mut self, motion: &Motion, coordinate: &str) {
        let what = format!("a position of `{coordinate}`");
        if let Motion::Input(name) = motion {
            return self.input(name, coordinate);
        }
        // Only the first implausible number of a motion is reported.
        let before = self.warnings.len();
        if let Motion::Speed(speed) = motion {
            self.speed(&speed.rate, coordinate);
        }
        if let Motion::Table(table) = motion
            && table.file.is_some()
            && self.is_angle(coordinate)
        {
            return self.angles_of_file(motion, &what);
        }
        for (scalar, at) in positions(motion) {
            self.position(scalar, at, coordinate, &what);
            if self.warnings.len() > before {
                return;
            }
        }
    }

    /// Angles from a file, where only radians can be written.
    fn angles_of_file(&mut self, table: &Motion, what: &str) {
        let mut angles = positions(table).into_iter().filter_map(|(scalar, at)| Some((self.bare(scalar)?, at)));
        if let Some((angle, at)) = angles.find(|(angle, _)| angle.abs() > FULL_TURN) {
            let help = format!("write angles in files in rad: 90 deg = {:.6}", std::f64::consts::FRAC_PI_2);
            self.warn(rule::degrees(at, what, angle, "rad", format!("{} turns", rounded(angle / TAU)), help));
        }
    }

    /// An input that is the motion of a coordinate.
    fn input(&mut self, name: &Spanned<String>, coordinate: &str) {
        let Some(input) = self.named_input(name) else { return };
        if let Some(value) = &input.value {
            let what = format!("input `{}`", name.value.as_deref().unwrap_or_default());
            self.position(value.value.as_ref().map(|value| &value.0), value.span, coordinate, &what);
        }
        if let Some(motion) = input.motion.as_ref().and_then(|motion| motion.value.as_ref()) {
            self.motion(motion, coordinate);
        }
    }

    /// The input with this name.
    pub(super) fn named_input(&self, name: &Spanned<String>) -> Option<&'a Input> {
        let entries = &self.crane.inputs.as_ref()?.value.as_ref()?.0;
        entries.iter().find(|(known, _)| known.value == name.value)?.1.value.as_ref()
    }

    /// Whether a coordinate is an angle.
    fn is_angle(&self, coordinate: &str) -> bool {
        let turns = |known: &Coordinate| known.name == coordinate && known.kind == CoordinateKind::Rotation;
        self.chain.coordinates.iter().any(turns)
    }

    /// A speed of rotation.
    fn speed(&mut self, rate: &Spanned<Angle>, coordinate: &str) {
        let (scalar, at) = written(rate);
        if let Some(rate) = self.bare(scalar).filter(|_| self.is_angle(coordinate))
            && rate.abs() > FULL_TURN
        {
            self.warn(rule::degrees(
                at,
                format!("the speed of `{coordinate}`"),
                rate,
                "rad/s",
                format!("{} turns per second", rounded(rate / TAU)),
                in_degrees(rate),
            ));
        }
    }

    /// A position of a coordinate: an angle, or a displacement.
    fn position(&mut self, scalar: Option<&Scalar>, at: Span, coordinate: &str, what: &str) {
        let known = self.chain.coordinates.iter().find(|known| known.name == coordinate);
        match known.map(|known| known.kind) {
            Some(CoordinateKind::Rotation) => self.angle(scalar, at, what),
            Some(CoordinateKind::Translation) => {
                let number = scalar.map_or(0.0, |scalar| self.scalar(scalar));
                if is_far(number) {
                    self.far(number, at, what);
                }
            }
            None => {}
        }
    }

    /// An angle that is written without `deg` or `pi`.
    fn angle(&mut self, scalar: Option<&Scalar>, at: Span, what: &str) {
        if let Some(angle) = self.bare(scalar)
            && angle.abs() > FULL_TURN
        {
            self.warn(rule::degrees(
                at,
                what,
                angle,
                "rad",
                format!("{} turns", rounded(angle / TAU)),
                in_degrees(angle),
            ));
        }
    }

    /// A number without a unit, given directly or as the value of the parameter that it names.
    fn bare(&self, scalar: Option<&Scalar>) -> Option<f64> {
        match scalar? {
            Scalar::Number(number) => Some(*number),
            Scalar::Quantity(_) => None,
            // A parameter whose value was set is a number in radians.
            Scalar::Name(name) => match (self.parameter(name)?, self.set(name)) {
                (Scalar::Quantity(_), false) => None,
                _ => self.value(name),
            },
        }
    }
}

/// What to write instead of a number that looks like degrees.
fn in_degrees(angle: f64) -> String {
    format!("did you mean `{angle} deg`? Write several turns as a multiple of `pi`")
}

/// The positions in a motion, and their locations in the text; an input has none.
pub(super) fn positions(motion: &Motion) -> Vec<(Option<&Scalar>, Span)> {
    match motion {
        Motion::Hold(at) => vec![written(at)],
        Motion::Quintic(ramp) | Motion::Cubic(ramp) | Motion::Cycloid(ramp) => {
            vec![written(&ramp.from), written(&ramp.to)]
        }
        Motion::Trapezoid(trapezoid) => vec![written(&trapezoid.from), written(&trapezoid.to)],
        Motion::Speed(speed) => speed.from.iter().map(written).collect(),
        Motion::Table(table) => {
            let values = table.values.iter().flat_map(|values| &values.value).flatten();
            values.map(|value| (value.value.as_ref().map(|value| &value.0), value.span)).collect()
        }
        Motion::Input(_) => Vec::new(),
    }
}

/// The text of an angle, and its location.
fn written(angle: &Spanned<Angle>) -> (Option<&Scalar>, Span) {
    (angle.value.as_ref().map(|angle| &angle.0), angle.span)
}
