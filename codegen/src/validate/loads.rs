//! Applied loads.

use super::Check;
use super::numbers::Whose;
use crate::chain::{Load, LoadAxes, Value, normalised};
use crate::diagnostic::rule;
use crate::spec::{Axes, Crane, Spanned, Wind};

/// Density of air in the formulas for wind, kg/m³: a pressure of v²/1.6.
const DENSITY_OF_AIR: f64 = 1.25;

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
            let at = self.vector_or_zero(load.at.as_ref(), &subject("position"));
            let force = match load.wind.as_ref() {
                Some(wind) => self.wind(wind, &name),
                None => self.vector_or_zero(load.force.as_ref(), &subject("force")),
            };
            if let Some(force) = load.force.as_ref().filter(|_| load.wind.is_some()) {
                self.report(rule::wind_and_force(force.span, &name));
            }
            let moment = self.vector_or_zero(load.moment.as_ref(), &subject("moment"));
            if load.force.is_none() && load.moment.is_none() && load.wind.is_none() {
                self.report(rule::no_load(load.name.span, &name));
            }
            let axes = match load.axes.as_ref().and_then(|axes| axes.value) {
                Some(Axes::Link) => LoadAxes::Link,
                Some(Axes::World) | None => LoadAxes::World,
            };
            let scale =
                load.scale.as_ref().and_then(|scale| self.motion(scale.value.as_ref()?, Whose::Key, scale.span));
            if let Some((body, position)) = self.attach(&load.link, at) {
                loads.push(Load { name, body, position, force, moment, axes, scale });
            }
        }
        loads
    }
    /// The force of wind, N.
    fn wind(&mut self, given: &'a Spanned<Wind>, load: &str) -> [Value; 3] {
        let Some(Wind { pressure, speed, area, shape_factor, direction }) = given.value.as_ref() else {
            return [Value::ZERO; 3];
        };
        let subject = |what: &str| format!("the {what} of the wind of load `{load}`");
        let pressure = match (pressure, speed) {
            (Some(pressure), None) => self.number(pressure, &subject("pressure")),
            (None, Some(speed)) => {
                let speed = self.number(speed, &subject("speed"));
                0.5 * DENSITY_OF_AIR * (speed.clone() * speed)
            }
            _ => {
                self.report(rule::pressure_or_speed(given.span, load));
                Value::ZERO
            }
        };
        let area = self.number(area, &subject("area"));
        let shape_factor = self.number(shape_factor, &subject("shape factor"));
        let force = pressure * area * shape_factor;
        let direction = self.direction(direction, &format!("the wind of load `{load}`"));
        direction.map_or([Value::ZERO; 3], |direction| normalised(direction).map(|share| share * force.clone()))
    }
}
