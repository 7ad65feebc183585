//! Supports of the base.

use super::Check;
use crate::chain::{Step, Support, SupportKinematics, Value};
use crate::diagnostic::rule;
use crate::spec::{self, Crane, Kinematics};

/// Default coefficient of friction of a one-sided support: steel, wood or rubber on dry concrete or firm ground.
const FRICTION: f64 = 0.6;
/// That of a support that sticks: far above any lateral force over a pressing force.
const STICKS: f64 = 1e3;

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
            let stiffness = self.vector(&support.stiffness, &subject("stiffness"));
            let friction = self.ground_friction(support, &name, &stiffness[2]);
            sound.push(Support {
                position: self.vector(&support.at, &subject("position")),
                stiffness,
                damping: self.vector_or_zero(support.damping.as_ref(), &subject("damping")),
                free_play: self.vector_or_zero(support.free_play.as_ref(), &subject("free play")),
                friction,
                kinematics,
                plate: self.plate(support, &name),
                name,
            });
        }
        sound
    }

    /// The area of the plate under a support, and the pressure that the ground bears.
    fn plate(&mut self, support: &spec::Support, name: &str) -> Option<(f64, Option<f64>)> {
        let plate = support.plate.as_ref()?.value.as_ref()?;
        let subject = |what: &str| format!("the {what} of support `{name}`");
        let area = self.constant(&plate.area, &subject("plate area"));
        let most = plate.max_pressure.as_ref();
        Some((area, most.map(|most| self.constant(most, &subject("largest pressure")))))
    }

    /// The coefficient of friction of a one-sided support.
    fn ground_friction(&mut self, support: &spec::Support, name: &str, stiffness: &Value) -> Option<Value> {
        let spec::Support { friction_coefficient, sticks, .. } = support;
        let subject = format!("the friction coefficient of support `{name}`");
        let is_stuck = sticks.as_ref().is_some_and(|sticks| sticks.value == Some(true));
        let unless_given = if is_stuck { STICKS } else { FRICTION };
        let coefficient = self.number_or(friction_coefficient.as_ref(), unless_given, &subject);
        let one_sided = support.one_sided.as_ref().filter(|given| given.value != Some(false));
        let spans = [friction_coefficient.as_ref().map(|given| given.span), sticks.as_ref().map(|given| given.span)];
        let Some(given) = one_sided else {
            for (key, span) in ["friction_coefficient", "sticks"].into_iter().zip(spans) {
                if let Some(span) = span {
                    self.report(rule::friction_of_two_sided(span, key, name));
                }
            }
            return None;
        };
        if let ([Some(_), Some(span)], true) = (spans, is_stuck) {
            self.report(rule::friction_of_stuck(span, name));
        }
        let broken = rule::nothing_to_press(given.span, name);
        if self.now(stiffness) == 0.0 {
            self.report(broken.clone());
        }
        self.keep_positive(stiffness.clone(), &broken);
        (given.value == Some(true)).then_some(coefficient)
    }
}
