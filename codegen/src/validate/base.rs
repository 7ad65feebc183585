//! Supports of the base.

use super::Check;
use super::limits::Limit;
use crate::chain::{Step, Support, SupportKinematics};
use crate::diagnostic::rule;
use crate::spec::{Crane, Kinematics};

impl<'a> Check<'a> {
    pub(super) fn supports(&mut self, crane: &'a Crane) -> Vec<Support> {
        let Some(given) = &crane.supports else { return Vec::new() };
        let Some(supports) = &given.value else { return Vec::new() };
        let base = self.bodies.first().map(|body| body.link.clone()).unwrap_or_default();
        if self.base.iter().all(Option::is_none) && !supports.is_empty() && !self.unknown.links {
            self.report(rule::base_fixed(given.span, &base));
        } else if self.links.get(base.as_str()).is_some_and(|place| place.starts.len() > 1) && !supports.is_empty() {
            self.report(rule::supports_on_beam(given.span, &base));
        }
        let path = self.bodies.first().map(|body| body.path.clone()).unwrap_or_default();
        let misplaced = if path.iter().any(|step| matches!(step, Step::Rotate { .. })) {
            Some("with a rotation")
        } else if path.windows(2).any(|pair| matches!(pair, [Step::Move(_), Step::Translate(_)])) {
            Some("off its centre of rotation")
        } else {
            None
        };
        let mut sound = Vec::new();
        for support in supports.iter().filter_map(|support| support.value.as_ref()) {
            let name = self.name(&support.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.take_name("supports", &name, "an earlier support".into(), support.name.span);
            }
            let kinematics = match support.kinematics.as_ref().and_then(|kinematics| kinematics.value) {
                Some(Kinematics::Exact) => SupportKinematics::Exact,
                Some(Kinematics::Linear) | None => SupportKinematics::Linear,
            };
            if let (SupportKinematics::Linear, Some(how)) = (kinematics, misplaced) {
                let span = support.kinematics.as_ref().map_or(support.name.span, |kinematics| kinematics.span);
                self.report(rule::linear_placed(span, &name, how));
            }
            let place = |what: &str| format!("the {what} of support `{name}`");
            sound.push(Support {
                position: self.vector(&support.at, &place("position"), "m", Limit::Any),
                stiffness: self.vector(&support.stiffness, &place("stiffness"), "N/m", Limit::NotNegative),
                damping: self.vector_or_zero(support.damping.as_ref(), &place("damping"), "N s/m", Limit::NotNegative),
                free_play: self.vector_or_zero(support.free_play.as_ref(), &place("free play"), "m", Limit::Any),
                kinematics,
                name,
            });
        }
        sound
    }
}
