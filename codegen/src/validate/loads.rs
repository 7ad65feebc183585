//! Applied loads.

use super::Check;
use super::limits::Limit;
use crate::chain::{Load, LoadAxes};
use crate::diagnostic::rule;
use crate::spec::{Axes, Crane};

impl<'a> Check<'a> {
    pub(super) fn loads(&mut self, crane: &'a Crane) -> Vec<Load> {
        let given = crane.loads.as_ref().and_then(|loads| loads.value.as_deref()).unwrap_or_default();
        let mut loads = Vec::new();
        for load in given.iter().filter_map(|load| load.value.as_ref()) {
            let name = self.name(&load.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_name("loads", &name, "an earlier load".into(), load.name.span);
            }
            let subject = |what: &str| format!("the {what} of load `{name}`");
            let at = self.vector_or_zero(load.at.as_ref(), &subject("position"), "m", Limit::Any);
            let force = self.vector_or_zero(load.force.as_ref(), &subject("force"), "N", Limit::Any);
            let moment = self.vector_or_zero(load.moment.as_ref(), &subject("moment"), "N m", Limit::Any);
            if load.force.is_none() && load.moment.is_none() {
                self.report(rule::no_load(load.name.span, &name));
            }
            let axes = match load.axes.as_ref().and_then(|axes| axes.value) {
                Some(Axes::Link) => LoadAxes::Link,
                Some(Axes::World) | None => LoadAxes::World,
            };
            let scale = load.scale.as_ref().and_then(|scale| self.motion(scale.value.as_ref()?, Some(""), scale.span));
            if let Some((body, position)) = self.attach(&load.link, at) {
                loads.push(Load { name, body, position, force, moment, axes, scale });
            }
        }
        loads
    }
}
