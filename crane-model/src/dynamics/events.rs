//! Runs during which parameters change.
//!
//! From an [event](crate::EventInfo) on, the crane is one with other parameters. Its pose and the states of its forces go on. So do its rates if something
//! leaves, gives way, or moved with the crane before; what [joins](crate::JoinsInfo) with another velocity u is caught by an impact without rebound,
//!
//! ```text
//! A⁺ v⁺ = A⁻ v⁻ + Jᵀ Δm u
//! ```
//!
//! with the mass matrices after the event and before it, but without what leaves at the same time, the added mass Δm, and J of the point at which it is.
//! Rigid drives keep their rates, and loops stay closed. An event that would move the crane at once is refused.
//! The energy `E⁺ − E⁻` that comes or goes with an event is [`Sample::event_work`].
//!
//! An event [on a condition](crate::ConditionInfo) happens once, as soon as a result passes a value: what held at the start must have ceased before. The
//! run asks at the ends of steps and at its results, and finds the time in between by bisection; [`Sample::event_times`] has it.

use nalgebra::{DVector, Vector3};

use super::{Cause, InitialState, Sample, Settings, Stopped};
use crate::{Description, EventInfo, JoinsInfo, Moment, ParameterError, StateAt, dyn_crane::DynCrane};

/// Gives the results of a crane at a time, s, at a pose with rates, and with the states of forces.
pub type ResultsAt = fn(&dyn DynCrane, &StateAt<'_>) -> Vec<f64>;

/// The results at a state, to which conditions refer.
#[derive(Clone, Copy, Debug)]
pub struct Quantities {
    /// Their names.
    pub names: fn(&dyn DynCrane) -> Vec<String>,
    /// Their values.
    pub at: ResultsAt,
}

/// A crane over a run: from its beginning on, and with the parameters after each of its events.
pub struct Phases<'a> {
    first: &'a dyn DynCrane,
    /// With the events after which they are, in the order in which these happened.
    later: Vec<(Vec<usize>, Box<dyn DynCrane>)>,
}

impl<'a> Phases<'a> {
    /// The phases of a crane with its present parameters.
    pub fn new(crane: &'a dyn DynCrane) -> Self {
        Self { first: crane, later: Vec::new() }
    }

    /// The crane at a time, s, at that of an event after it; `times`: [`Sample::event_times`].
    pub fn at(&mut self, t: f64, times: &[f64]) -> &dyn DynCrane {
        let happened = happened(self.first.description(), t, times);
        if happened.is_empty() {
            return self.first;
        }
        let known = self.later.iter().position(|(events, _)| *events == happened);
        let known = known.or_else(|| {
            let events = &self.first.description().events;
            let after = after(self.first, happened.iter().map(|event| &events[*event])).ok()?;
            self.later.push((happened, after));
            Some(self.later.len() - 1)
        });
        // A run in which events broke rules has no results after them.
        known.map_or(self.first, |index| self.later[index].1.as_ref())
    }

    /// The crane at a result of a run: a row of a recorded table.
    pub fn at_row(&mut self, row: &[f64]) -> &dyn DynCrane {
        let (t, times) = (row.first().copied().unwrap_or_default(), event_times(self.first.description(), row));
        self.at(t, times)
    }
}

/// The times of events on conditions, the last numbers of a row of a recorded table.
pub fn event_times<'r>(description: &Description, row: &'r [f64]) -> &'r [f64] {
    &row[row.len().saturating_sub(description.conditions().count())..]
}

/// The events up to a time, s, by their indices, in the order in which they happened.
fn happened(description: &Description, t: f64, times: &[f64]) -> Vec<usize> {
    let conditions = description.conditions().zip(times).filter(|(_, time)| **time > 0.0);
    let mut all: Vec<(f64, usize)> = conditions.map(|((event, _), time)| (*time, event)).collect();
    all.extend(timed(description).filter(|(time, _)| *time <= t));
    all.sort_by(|(one, first), (other, second)| one.total_cmp(other).then(first.cmp(second)));
    all.into_iter().map(|(_, event)| event).collect()
}

/// The events at times, s, with their indices, in their order.
pub(super) fn timed(description: &Description) -> impl Iterator<Item = (f64, usize)> {
    description.events.iter().enumerate().filter_map(|(index, event)| match event.moment {
        Moment::At(time) => Some((time, index)),
        Moment::When(_) => None,
    })
}

/// A crane after some events.
///
/// # Errors
/// The parameters that they set break a rule of the spec language.
pub fn after<'e>(
    crane: &dyn DynCrane,
    events: impl IntoIterator<Item = &'e EventInfo>,
) -> Result<Box<dyn DynCrane>, ParameterError> {
    let mut values: Vec<f64> = crane.parameter_values();
    for &(index, value) in events.into_iter().flat_map(|event| event.changes.iter()) {
        values[index] = value;
    }
    let mut changed = crane.boxed_clone();
    changed.set_parameters(&values)?;
    Ok(changed)
}

/// A run that stops at a time, s, because an event cannot happen.
pub(super) fn stopped(event: &EventInfo, time: f64, settings: &Settings, why: &str) -> Stopped {
    let coordinate = format!("`{}` {why}", event.name.as_str()).into();
    let &Settings { method, step, .. } = settings;
    Stopped { cause: Cause::Event, method, time, coordinate, value: f64::NAN, unit: "", step }
}

/// Refuses the first event of a run that has none, such as one with derivatives; `what`: what that run is.
///
/// # Errors
/// The crane has an event within the run, or one on a condition.
pub fn without_events(description: &Description, settings: &Settings, what: &str) -> Result<(), Stopped> {
    let mut all = description.events.iter().map(|event| match event.moment {
        Moment::At(time) => (event, time),
        Moment::When(_) => (event, 0.0),
    });
    let within = all.find(|(_, time)| *time <= settings.duration);
    let why = format!("does not happen in {what}");
    within.map_or(Ok(()), |(event, time)| Err(stopped(event, time, settings, &why)))
}

/// The crane before an event, without the masses that leave with it.
fn without_leaving(before: &dyn DynCrane, event: &EventInfo) -> Box<dyn DynCrane> {
    let mut rest = before.boxed_clone();
    for &(index, value) in &event.changes {
        let (mass, own) = (rest.mass(), rest.parameter(index));
        let changed = rest.set_parameter(index, value).is_ok();
        if changed && rest.mass() >= mass {
            // It was allowed before.
            let _ = rest.set_parameter(index, own);
        }
    }
    rest
}

/// Why what joins at an event cannot: its velocity is that of one body.
pub(super) fn refused(event: &EventInfo, after: &dyn DynCrane, before: &dyn DynCrane) -> Option<String> {
    event.joins?.point?;
    let sizes = after.body_sizes_at().into_iter().zip(before.body_sizes_at());
    let growing = sizes.zip(&*after.description().bodies).filter(|(([now, _], [mass, _]), _)| now > mass);
    let names: Vec<&str> = growing.map(|(_, body)| body.name.as_str()).collect();
    match names[..] {
        [_] => None,
        [] => Some("has a velocity of what joins, and adds no mass".to_owned()),
        [..] => Some(format!("adds masses to {}, and their velocity is that of one point", names.join(", "))),
    }
}

/// The rates after an event at a state; they go on if nothing joins.
pub(super) fn rates_after([before, after]: [&dyn DynCrane; 2], event: &EventInfo, q: &[f64], v: &[f64]) -> Vec<f64> {
    let Some(JoinsInfo { velocity, point }) = &event.joins else { return v.to_vec() };
    let rest = without_leaving(before, event);
    let rates = DVector::from_column_slice(v);
    let mut momentum = rest.mass_matrix_at(q) * &rates;
    if let Some(point) = *point {
        let joining = (after.mass() - rest.mass()) * Vector3::from(*velocity);
        let mut unit = vec![0.0; v.len()];
        for (index, momentum) in momentum.iter_mut().enumerate() {
            unit[index] = 1.0;
            *momentum += joining.dot(&after.point_velocities_at(q, &unit)[point]);
            unit[index] = 0.0;
        }
    }
    let prescribed = after.description().prescribed();
    let free: Vec<usize> = (0..v.len()).filter(|index| !prescribed.contains(index)).collect();
    let mass = after.mass_matrix_at(q);
    let kept = DVector::from_fn(v.len(), |index, _| if prescribed.contains(&index) { v[index] } else { 0.0 });
    let left = momentum - &mass * kept;
    let solved = mass.select_rows(&free).select_columns(&free).cholesky();
    // Without one, the run ends here with its own message.
    let Some(solved) = solved.map(|mass| mass.solve(&left.select_rows(&free))) else { return v.to_vec() };
    let mut rates = v.to_vec();
    free.iter().zip(&solved).for_each(|(index, rate)| rates[*index] = *rate);
    rates
}

/// How an event would move the crane, or what follows from rigid drives, at once: from a state to that in which a run would go on.
pub(super) fn jump(description: &Description, before: &InitialState, after: &Sample<'_>) -> Option<String> {
    let far = |one: f64, other: f64| (one - other).abs() > NO_JUMP * (1.0 + one.abs());
    let prescribed = description.prescribed();
    (0..before.q.len()).find_map(|index| {
        let name = description.coordinates[index].name.as_str();
        let moves =
            |what: &str, from: f64, to: f64| format!("would move {name} from {what}{from:.6} to {what}{to:.6} at once");
        if far(before.q[index], after.q[index]) {
            return Some(moves("", before.q[index], after.q[index]));
        }
        let jumps = prescribed.contains(&index) && far(before.v[index], after.v[index]);
        jumps.then(|| moves("a rate of ", before.v[index], after.v[index]))
    })
}

/// Positions and rates that differ by less than this, m and rad, or of their size, are the same.
const NO_JUMP: f64 = 1e-6;
