//! Events of a run.

use super::Check;
use crate::chain::{Chain, ConditionInfo, EventInfo, JoinsInfo, Moment, Point};
use crate::diagnostic::{rule, suggest};
use crate::spec::{self, Condition, Crane, Spanned, entries};

impl<'a> Check<'a> {
    pub(super) fn events(&mut self, crane: &'a Crane, points: &[Point]) -> Vec<EventInfo> {
        let mut events: Vec<EventInfo> = Vec::new();
        for event in entries(crane.events.as_ref()) {
            let name = self.name(&event.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_name("events", &name, "an earlier event".into(), event.name.span);
            }
            let moment = self.moment(&name, event);
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
            events.push(EventInfo { name: name.into(), moment, changes: changes.into_iter().collect(), joins });
        }
        let time = |event: &EventInfo| if let Moment::At(time) = event.moment { time } else { f64::INFINITY };
        events.sort_by(|one, other| time(one).total_cmp(&time(other)));
        events
    }

    /// When an event happens; what it asks of a result is checked once all results are known.
    fn moment(&mut self, name: &str, given: &spec::Event) -> Moment {
        let unread = Moment::At(f64::NAN);
        match (&given.at, &given.when) {
            (Some(at), None) => Moment::At(self.constant(at, &format!("the time of event `{name}`"))),
            (None, Some(when)) => {
                let Some(Condition { result, above, below }) = &when.value else { return unread };
                if above.is_some() == below.is_some() {
                    self.report(rule::above_or_below(when.span, name));
                }
                let [result, unit] = [result.value.clone().unwrap_or_default(), String::new()].map(Into::into);
                Moment::When(ConditionInfo { result, unit, above: above.is_some(), value: f64::NAN })
            }
            _ => {
                self.report(rule::at_or_when(given.name.span, name));
                unread
            }
        }
    }

    /// The results and values of conditions.
    pub(super) fn conditions(&mut self, chain: &mut Chain, crane: &Crane) {
        let (description, loop_joints) = (chain.description(), chain.loop_joint_infos());
        let columns = description.columns(&loop_joints);
        for event in entries(crane.events.as_ref()) {
            let name = event.name.value.as_deref().unwrap_or_default();
            let Some(given) = event.when.as_ref().and_then(|when| when.value.as_ref()) else { continue };
            let wanted = given.result.value.as_deref().unwrap_or_default();
            let Some(column) = columns.iter().find(|column| column.name == wanted) else {
                let help = suggest(wanted, columns.iter().map(|column| column.name.as_str()));
                self.report(rule::unknown_result(given.result.span, wanted, help));
                continue;
            };
            let Some(bound) = given.above.as_ref().or(given.below.as_ref()) else { continue };
            let value = self.in_own_unit(bound, &format!("`{wanted}` of event `{name}`"), Some(column.unit));
            let found = chain.events.iter_mut().find(|known| known.name.as_str() == name);
            if let Some(Moment::When(condition)) = found.map(|event| &mut event.moment) {
                (condition.unit, condition.value) = (column.unit.to_owned().into(), value);
            }
        }
    }

    fn joins(&mut self, event: &str, joins: &spec::Joins, points: &[Point]) -> JoinsInfo {
        let point = joins.point.as_ref().and_then(|text| Some((text, text.value.as_deref()?)));
        let index = point.and_then(|(text, wanted)| {
            let index = points.iter().position(|point| point.name == wanted);
            if index.is_none() {
                let help = suggest(wanted, points.iter().map(|point| point.name.as_str()));
                self.report(rule::unknown_point(text.span, wanted, help));
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
        let defaults = values.clone();
        for event in &chain.events {
            // What has happened before a condition holds is not known: a run looks at it again.
            if let Moment::When(_) = event.moment {
                values.clone_from(&defaults);
            }
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
