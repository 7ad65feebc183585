//! Supports of the base.

use super::Check;
use super::limits::Limit;
use crate::chain::{Step, Support, SupportKinematics, Value};
use crate::diagnostic::rule;
use crate::spec::{self, Crane, Kinematics};

/// Default pressing force from which a one-sided support has its full lateral stiffness and damping, N: a hundredth of what a
/// foot of a timber crane carries.
const FULL_HOLD: f64 = 1e3;

impl<'a> Check<'a> {
    pub(super) fn supports(&mut self, crane: &'a Crane) -> Vec<Support> {
        let Some(given) = &crane.supports else { return Vec::new() };
        let Some(supports) = &given.value else { return Vec::new() };
        // After a mistake in the base, the first body is that of another link.
        let base = crane.links.value.as_ref().and_then(|links| links.first()?.value.as_ref()?.name.value.clone());
        let base = base.unwrap_or_default();
        if self.base.iter().all(Option::is_none) && !supports.is_empty() && !self.unknown.links {
            self.report(rule::base_fixed(given.span, &base));
        } else if self.links.get(base.as_str()).is_some_and(|subject| subject.starts.len() > 1) && !supports.is_empty()
        {
            self.report(rule::supports_on_beam(given.span, &base));
        }
        let path = self.bodies.first().filter(|body| body.link == base).map_or(Vec::new(), |body| body.path.clone());
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
                self.register_name("supports", &name, "an earlier support".into(), support.name.span);
            }
            let kinematics = match support.kinematics.as_ref().and_then(|kinematics| kinematics.value) {
                Some(Kinematics::Exact) => SupportKinematics::Exact,
                Some(Kinematics::Linear) | None => SupportKinematics::Linear,
            };
            if let (SupportKinematics::Linear, Some(how)) = (kinematics, misplaced) {
                let span = support.kinematics.as_ref().map_or(support.name.span, |kinematics| kinematics.span);
                self.report(rule::linear_placed(span, &name, how));
            }
            let subject = |what: &str| format!("the {what} of support `{name}`");
            let stiffness = self.vector(&support.stiffness, &subject("stiffness"), "N/m", Limit::NotNegative);
            let full_hold = self.full_hold(support, &name, &stiffness[2]);
            sound.push(Support {
                position: self.vector(&support.at, &subject("position"), "m", Limit::Any),
                stiffness,
                damping: self.vector_or_zero(
                    support.damping.as_ref(),
                    &subject("damping"),
                    "N s/m",
                    Limit::NotNegative,
                ),
                free_play: self.vector_or_zero(support.free_play.as_ref(), &subject("free play"), "m", Limit::Any),
                full_hold,
                kinematics,
                name,
            });
        }
        sound
    }

    /// The pressing force from which a one-sided support has its full lateral stiffness and damping.
    fn full_hold(&mut self, support: &spec::Support, name: &str, stiffness: &Value) -> Option<Value> {
        let subject = format!("the full hold of support `{name}`");
        let full_hold = self.number_or(support.full_hold.as_ref(), FULL_HOLD, &subject, "N", Limit::Positive);
        let one_sided = support.one_sided.as_ref().filter(|given| given.value != Some(false));
        let Some(given) = one_sided else {
            if let Some(full_hold) = &support.full_hold {
                self.report(rule::hold_of_two_sided(full_hold.span, name));
            }
            return None;
        };
        let broken = rule::nothing_to_press(given.span, name);
        if self.now(stiffness) == 0.0 {
            self.report(broken.clone());
        }
        self.keep_positive(stiffness.clone(), &broken);
        (given.value == Some(true)).then_some(full_hold)
    }
}
