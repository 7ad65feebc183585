//! Drives that are far too slow for their motions.

use super::{Plausibility, rounded};
use crate::chain::{CoordinateKind, Profile, Value};
use crate::diagnostic::rule;
use crate::spec::entries;

/// Least share of the speed of its motion that a drive reaches.
const SLOW: f64 = 0.01;

impl Plausibility<'_> {
    /// Efforts that a drive cannot deliver at some time.
    pub(super) fn efforts(&mut self) {
        let chain = self.chain;
        for given in entries(self.crane.drives.as_ref()) {
            let Some(span) = given.effort.as_ref().map(|motion| motion.span) else { continue };
            let named = |name: &str| given.coordinate.value.as_deref() == Some(name);
            let Some(drive) = chain.drives.iter().find(|drive| named(&chain.coordinates[drive.coordinate.0].name))
            else {
                continue;
            };
            let Some((effort, limit)) = drive.effort().zip(drive.max_effort()) else { continue };
            let limit = limit.at(&self.values);
            let greatest = effort.stations().iter().map(|value| value.at(&self.values).abs()).fold(0.0, f64::max);
            if greatest > limit {
                let coordinate = &chain.coordinates[drive.coordinate.0];
                let unit = if coordinate.kind == CoordinateKind::Translation { "N" } else { "N m" };
                self.warn(rule::effort_beyond_limit(span, &coordinate.name, rounded(greatest), rounded(limit), unit));
            }
        }
    }

    /// A drive that stays behind its whole motion: where its force falls to nothing, it acts as a damper so stiff that steps become tiny.
    pub(super) fn slow_drives(&mut self) {
        for given in entries(self.crane.drives.as_ref()) {
            let Some(span) = given.max_rate.as_ref().map(|constant| constant.span) else { continue };
            let named = |name: &str| given.coordinate.value.as_deref() == Some(name);
            let chain = self.chain;
            let driven = chain.drives.iter().find(|drive| named(&chain.coordinates[drive.coordinate.0].name));
            let Some((drive, limit)) = driven.and_then(|drive| Some((drive, drive.max_rate()?))) else { continue };
            let speed = self.mean_speed(&drive.profile);
            if limit < SLOW * speed {
                let coordinate = &chain.coordinates[drive.coordinate.0];
                let unit = if coordinate.kind == CoordinateKind::Translation { "m/s" } else { "rad/s" };
                self.warn(rule::slow_drive(span, &coordinate.name, limit, rounded(speed), unit));
            }
        }
    }

    /// The mean speed of a motion while it moves, the greatest of its parts.
    fn mean_speed(&self, profile: &Profile) -> f64 {
        let at = |value: &Value| value.at(&self.values);
        match profile {
            Profile::Hold(_) => 0.0,
            Profile::Quintic(ramp)
            | Profile::Cubic(ramp)
            | Profile::Cycloid(ramp)
            | Profile::Trapezoid { ramp, .. } => ((at(&ramp.to) - at(&ramp.from)) / at(&ramp.duration)).abs(),
            Profile::Speed { rate, .. } => at(rate).abs(),
            Profile::Input(_, unless_set) => self.mean_speed(unless_set),
            Profile::Halted { motion, .. } => self.mean_speed(motion),
            Profile::Sum(parts) => parts.iter().map(|part| self.mean_speed(part)).fold(0.0, f64::max),
            Profile::Table { segments, .. } => {
                let speeds = segments.iter().map(|piece| (piece.rise(piece.duration) / piece.duration).abs());
                speeds.fold(0.0, f64::max)
            }
        }
    }
}
