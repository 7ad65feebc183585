//! Events of a run.

use super::Check;
use crate::chain::{Chain, EventInfo, JoinsInfo, Point};
use crate::diagnostic::{rule, suggest};
use crate::spec::{self, Crane, Spanned, entries};

impl<'a> Check<'a> {
    pub(super) fn events(&mut self, crane: &'a Crane, points: &[Point]) -> Vec<EventInfo> {
        let mut events: Vec<EventInfo> = Vec::new();
        for event in entries(crane.events.as_ref()) {
            let name = self.name(&event.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_name("events", &name, "an earlier event".into(), event.name.span);
            }
            let time = self.constant(&event.at, &format!("the time of event `{name}`"));
            let set = event.set.value.as_ref().map_or(&[][..], |entries| &entries.0);
            if set.is_empty() && event.set.value.is_some() {
                self.report(rule::nothing_set(event.set.span, &name));
            }
            let mut changes = Vec::new();
            for (wanted, value) in set {
                // A value that is set and read by nothing is not a use.
                let used = self.used.clone();
                let id = self.name(wanted).and_then(|parameter| self.parameter(parameter, wanted.span));
                self.used = used;
                let Some(id) = id else { continue };
                let subject = format!("`{}` from event `{name}` on", self.parameters[id.0].name);
                let unit = Some(self.parameters[id.0].unit.clone()).filter(|unit| !unit.is_empty());
                changes.push((id.0, self.in_own_unit(value, &subject, unit.as_deref())));
            }
            let joins = event.joins.as_ref().and_then(|joins| joins.value.as_ref());
            let joins = joins.map(|joins| self.joins(&name, joins, points));
            events.push(EventInfo { name: name.into(), time, changes: changes.into_iter().collect(), joins });
        }
        events.sort_by(|one, other| one.time.total_cmp(&other.time));
        events
    }

    fn joins(&mut self, event: &str, joins: &spec::Joins, points: &[Point]) -> JoinsInfo {
        let point = joins.point.as_ref().and_then(|given| Some((given, given.value.as_deref()?)));
        let index = point.and_then(|(given, wanted)| {
            let index = points.iter().position(|point| point.name == wanted);
            if index.is_none() {
                let help = suggest(wanted, points.iter().map(|point| point.name.as_str()));
                self.report(rule::unknown_point(given.span, wanted, help));
            }
            index
        });
        let subject = format!("the velocity of what joins at event `{event}`");
        let velocity = joins.velocity.as_ref().and_then(|given| given.value.as_ref());
        let velocity =
            velocity.map_or([0.0; 3], |velocity| velocity.each_ref().map(|number| self.constant(number, &subject)));
        if let (Some(given), None) = (&joins.velocity, &joins.point) {
            self.report(rule::joins_without_point(given.span, event));
        }
        JoinsInfo { velocity, point: index }
    }

    /// What events set obeys the rules of the language, one event after the other.
    pub(super) fn events_allowed(&mut self, chain: &Chain, crane: &Crane) {
        if chain.events.is_empty() {
            return;
        }
        let (parameters, mut values) = (chain.description().parameters, chain.parameter_defaults());
        for event in &chain.events {
            for &(index, value) in &event.changes {
                values[index] = value;
            }
            let below = event.changes.iter().find_map(|&(index, value)| {
                let refusal = parameters[index].check(value).err()?.refusal;
                Some((format!("{} {value}", refusal.title), refusal))
            });
            let broken = below.or_else(|| {
                let refusal = chain.broken_relation(&values)?.refusal.clone();
                Some((refusal.title.to_string(), refusal))
            });
            let Some((title, refusal)) = broken else { continue };
            let is_it = |given: &&Spanned<spec::Event>| {
                given.value.as_ref().and_then(|given| given.name.value.as_deref()) == Some(event.name.as_str())
            };
            let given = crane.events.as_ref().and_then(|events| events.value.as_ref());
            let span = given.and_then(|events| events.iter().find(is_it)?.value.as_ref().map(|event| event.set.span));
            self.report(rule::event_breaks_rule(span.unwrap_or_default(), event.name.as_str(), &title, &refusal.help));
        }
    }
}
