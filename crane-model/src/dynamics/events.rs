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

use std::collections::VecDeque;

use nalgebra::{DVector, Vector3};

use super::{
    Cause, EffortAccuracy, InitialState, Integration, Method, Run, Sample, Settings, Statistics, Stopped, Watch,
    integration::{Advanced, Happens},
    settings::divided,
    simulation::simulate_watched,
};
use crate::{ConditionInfo, Description, EventInfo, JoinsInfo, Moment, ParameterError, dyn_crane::DynCrane};

/// Gives the results of a crane at a time, s, at a pose with rates, and with the states of forces.
pub type ResultsAt = fn(&dyn DynCrane, f64, (&[f64], &[f64]), &[f64]) -> Vec<f64>;

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
    pub fn of(crane: &'a dyn DynCrane) -> Self {
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
            let after = after(self.first, &happened).ok()?;
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
fn timed(description: &Description) -> impl Iterator<Item = (f64, usize)> {
    description.events.iter().enumerate().filter_map(|(index, event)| match event.moment {
        Moment::At(time) => Some((time, index)),
        Moment::When(_) => None,
    })
}

/// A crane after some events.
fn after(crane: &dyn DynCrane, events: &[usize]) -> Result<Box<dyn DynCrane>, ParameterError> {
    let description = crane.description();
    let mut values: Vec<f64> = (0..description.parameters.len()).map(|index| crane.parameter(index)).collect();
    for &(index, value) in events.iter().flat_map(|event| description.events[*event].changes.iter()) {
        values[index] = value;
    }
    let mut changed = crane.boxed_clone();
    changed.set_parameters(&values)?;
    Ok(changed)
}

/// The conditions of events that have not happened.
struct Conditions<'d> {
    quantities: Quantities,
    /// Event, column of results, and condition of each.
    all: Vec<(usize, usize, &'d ConditionInfo)>,
    /// Whether each holds, at the last time at which no event was due.
    held: Vec<bool>,
    /// Whether each holds, at the last time at which one was.
    holds: Vec<bool>,
    /// When the events happened, s; 0 for those that have not.
    times: Vec<f64>,
}

impl<'d> Conditions<'d> {
    /// Those of a crane at the start of a run.
    fn new(crane: &'d dyn DynCrane, quantities: Quantities, start: &Sample<'_>) -> Self {
        let description = crane.description();
        let none = description.conditions().next().is_none();
        let names = if none { Vec::new() } else { (quantities.names)(crane) };
        let all = description.conditions().filter_map(|(event, condition)| {
            let column = names.iter().position(|name| name == condition.result.as_str())?;
            Some((event, column, condition))
        });
        let all: Vec<_> = all.collect();
        let mut conditions = Self { quantities, held: Vec::new(), holds: Vec::new(), times: vec![0.0; all.len()], all };
        conditions.held = conditions.evaluate(crane, start.t, [start.q, start.v, start.x]);
        conditions
    }

    /// Whether each holds at a state.
    fn evaluate(&self, crane: &dyn DynCrane, t: f64, state: [&[f64]; 3]) -> Vec<bool> {
        if self.all.is_empty() {
            return Vec::new();
        }
        let [q, v, x] = state;
        let row = (self.quantities.at)(crane, t, (q, v), x);
        self.all.iter().map(|(_, column, condition)| condition.is_met(row[*column])).collect()
    }

    /// Notes a later state; returns whether an event is due there.
    fn note(&mut self, crane: &dyn DynCrane, t: f64, state: [&[f64]; 3]) -> bool {
        let now = self.evaluate(crane, t, state);
        let is_due = self.due(&now).next().is_some();
        *(if is_due { &mut self.holds } else { &mut self.held }) = now;
        is_due
    }

    /// Those whose events are due: they hold now and did not before.
    fn due<'s>(&'s self, now: &'s [bool]) -> impl Iterator<Item = usize> + 's {
        (0..self.all.len()).filter(|index| self.times[*index] == 0.0 && now[*index] && !self.held[*index])
    }

    /// Takes those whose events are due.
    fn take(&mut self) -> Vec<usize> {
        let due = self.due(&self.holds).collect();
        self.held.clone_from(&self.holds);
        due
    }
}

/// A run that stops at a time, s, because an event cannot happen.
fn stopped(event: &EventInfo, time: f64, settings: &Settings, why: &str) -> Stopped {
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
fn refused(event: &EventInfo, after: &dyn DynCrane, before: &dyn DynCrane) -> Option<String> {
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
fn rates_after([before, after]: [&dyn DynCrane; 2], event: &EventInfo, q: &[f64], v: &[f64]) -> Vec<f64> {
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
fn jump(description: &Description, before: &InitialState, after: &Sample<'_>) -> Option<String> {
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

/// What earlier phases of a run did.
#[derive(Default)]
struct Done {
    /// Work of drives, dissipated energy, work of loads and of events, J.
    energies: [f64; 4],
    statistics: Statistics,
    efforts: Vec<EffortAccuracy>,
}

impl Done {
    /// A sample of the present phase, since the beginning of the run.
    fn add_to<'s>(&self, sample: Sample<'s>, event_times: &'s [f64]) -> Sample<'s> {
        let [work, dissipated, load_work, event_work] = self.energies;
        Sample {
            work: work + sample.work,
            dissipated: dissipated + sample.dissipated,
            load_work: load_work + sample.load_work,
            event_work: event_work + sample.event_work,
            event_times,
            ..sample
        }
    }

    /// Adds the run of a phase; returns all so far.
    fn add(&mut self, run: &Run, method: Method) -> Run {
        let Statistics { steps, rejections, evaluations, factorisations } = &mut self.statistics;
        *steps += run.statistics.steps;
        *rejections += run.statistics.rejections;
        *evaluations += run.statistics.evaluations;
        *factorisations += run.statistics.factorisations;
        for effort in &run.efforts {
            match self.efforts.iter_mut().find(|known| known.coordinate == effort.coordinate) {
                Some(known) => {
                    known.peak = known.peak.max(effort.peak);
                    known.error = known.error.max(effort.error);
                }
                None => self.efforts.push(*effort),
            }
        }
        let step = if method.is_adaptive() { run.time / (self.statistics.steps.max(1)) as f64 } else { run.step };
        Run { statistics: self.statistics, step, efforts: self.efforts.clone(), ..run.clone() }
    }
}

/// Like [`simulate_watched`], with the events of the crane; `quantities`: the results to which conditions refer. A result at the time of an event is that after it.
///
/// # Errors
/// As [`simulate`](super::simulate); the parameters that an event sets break a rule of the spec language.
///
/// # Panics
/// If the start does not have as many numbers as the crane has coordinates.
pub fn simulate_events(
    crane: &dyn DynCrane,
    start: &InitialState,
    settings: &Settings,
    watch: &mut dyn Watch,
    quantities: &Quantities,
) -> Result<Run, Stopped> {
    let description = crane.description();
    if description.events.is_empty() {
        return simulate_watched(crane, start, settings, watch);
    }
    let end = settings.duration;
    let intervals = divided(end, settings.output).0;
    let (mut done, mut state, mut next, mut begin) = (Done::default(), start.clone(), 0, 0.0);
    let energy = |crane: &dyn DynCrane, sample: &Sample<'_>| crane.energies_of(sample).total();
    let mut at_times = timed(description).filter(|(time, _)| *time <= end).peekable();
    let (mut conditions, mut due) = (None, VecDeque::new());
    // The events so far, the crane after them, and the last one with its time and the energy before it.
    let (mut order, mut changed, mut last) = (Vec::new(), None::<Box<dyn DynCrane>>, None);
    loop {
        let present = changed.as_deref().unwrap_or(crane);
        let planned = at_times.peek().copied();
        let until = planned.map_or(end, |(time, _)| time);
        let settings = Settings { duration: until - begin, ..*settings };
        let mut integration = Integration::new(present, begin, &state, &settings)?;
        let sample = integration.sample();
        if let Some((event, _, before)) = last {
            if let Some(what) = jump(description, &state, &sample) {
                return Err(stopped(&description.events[event], begin, &settings, &what));
            }
            done.energies[3] += energy(present, &sample) - before;
        }
        let conditions = conditions.get_or_insert_with(|| Conditions::new(crane, *quantities, &sample));
        // What an event changes at once makes others due.
        if conditions.note(present, begin, [sample.q, sample.v, sample.x]) {
            due.extend(conditions.take());
        }
        while due.is_empty() {
            let result = (settings.output * next as f64).min(end);
            let is_result = next <= intervals && result <= until && (planned.is_none() || result < until);
            if !is_result {
                if planned.is_none() {
                    return Ok(done.add(&integration.run(), settings.method));
                }
                integration.end_step_at_result();
            }
            let is_awaited = conditions.times.contains(&0.0);
            let happens = &mut |t: f64, motion: &[f64]| {
                let (q, rest) = motion.split_at(start.q.len());
                let (v, x) = rest.split_at(start.q.len());
                conditions.note(present, t, [q, v, x])
            };
            let asked = is_awaited.then_some(happens as Happens<'_>);
            let advanced =
                integration.advance_until(if is_result { result } else { until }, &mut |t| watch.step(t), asked)?;
            let time = integration.sample().t;
            match advanced {
                Advanced::Stopped => return Ok(done.add(&integration.run(), settings.method)),
                // An event at the same time comes first; then the condition is looked at again.
                Advanced::Happened if planned.is_none_or(|(planned, _)| time < planned) => {
                    due.extend(conditions.take());
                }
                Advanced::Happened | Advanced::Reached => {}
            }
            if !due.is_empty() || !is_result {
                break;
            }
            if watch.sample(&done.add_to(integration.sample(), &conditions.times)).is_break() {
                return Ok(done.add(&integration.run(), settings.method));
            }
            next += 1;
        }
        let sample = integration.sample();
        let event = due.pop_front().map(|condition| {
            // Later than the events before it: rows tell their order by it.
            let after = last.map_or(0.0, |(_, time, _): (usize, f64, f64)| time.next_up());
            conditions.times[condition] = sample.t.max(after);
            (conditions.times[condition], conditions.all[condition].0)
        });
        let Some((time, event)) = event.or_else(|| at_times.next()) else { continue };
        order.push(event);
        let info = &description.events[event];
        let refuse = |why: &str| stopped(info, sample.t, &settings, why);
        let after = after(crane, &order).map_err(|error| refuse(&format!("cannot happen: {error}")))?;
        if let Some(why) = refused(info, after.as_ref(), present) {
            return Err(refuse(&why));
        }
        let sample = done.add_to(sample, &conditions.times);
        let v = rates_after([present, after.as_ref()], info, sample.q, sample.v);
        last = Some((event, time, energy(present, &sample)));
        let energies = [sample.work, sample.dissipated, sample.load_work, sample.event_work];
        (state, begin) = (InitialState { q: sample.q.to_vec(), v, x: sample.x.to_vec() }, sample.t);
        done.add(&integration.run(), settings.method);
        done.energies = energies;
        drop(integration);
        changed = Some(after);
    }
}
