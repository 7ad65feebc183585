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

use nalgebra::{DVector, Vector3};

use super::{
    Cause, EffortAccuracy, InitialState, Integration, Method, Run, Sample, Settings, Statistics, Stopped, Watch,
    settings::divided, simulation::simulate_watched,
};
use crate::{Description, EventInfo, JoinsInfo, ParameterError, dyn_crane::DynCrane};

/// A crane from the beginning of a run on, and with the parameters after each of its events.
pub struct Phases<'a> {
    first: &'a dyn DynCrane,
    /// Each with the time from which it holds, s.
    later: Vec<(f64, Box<dyn DynCrane>)>,
    /// The first event whose parameters break a rule, and the rule: it and all later ones are not among the phases.
    refused: Option<(EventInfo, ParameterError)>,
}

impl<'a> Phases<'a> {
    /// The phases of a crane with its present parameters.
    pub fn of(crane: &'a dyn DynCrane) -> Self {
        let (mut later, mut refused) = (Vec::<(f64, Box<dyn DynCrane>)>::new(), None);
        let mut values: Vec<f64> =
            (0..crane.description().parameters.len()).map(|index| crane.parameter(index)).collect();
        for event in &crane.description().events {
            for &(index, value) in &event.changes {
                values[index] = value;
            }
            let mut changed = crane.boxed_clone();
            if let Err(error) = changed.set_parameters(&values) {
                refused = Some((event.clone(), error));
                break;
            }
            later.push((event.time, changed));
        }
        Self { first: crane, later, refused }
    }

    /// The crane at a time, s; at that of an event, after it.
    pub fn at(&self, t: f64) -> &dyn DynCrane {
        self.later.iter().rfind(|(begin, _)| *begin <= t).map_or(self.first, |(_, crane)| crane.as_ref())
    }
}

/// A run that stops because an event cannot happen.
fn stopped(EventInfo { name, time, .. }: &EventInfo, settings: &Settings, why: &str) -> Stopped {
    let coordinate = format!("`{name}` {why}").into();
    let &Settings { method, step, .. } = settings;
    Stopped { cause: Cause::Event, method, time: *time, coordinate, value: f64::NAN, unit: "", step }
}

/// Refuses the first event of a run that has none, such as one with derivatives; `what`: what that run is.
///
/// # Errors
/// The crane has an event within the run.
pub fn without_events(description: &Description, settings: &Settings, what: &str) -> Result<(), Stopped> {
    let event = description.events.iter().find(|event| event.time <= settings.duration);
    event.map_or(Ok(()), |event| Err(stopped(event, settings, &format!("does not happen in {what}"))))
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
    fn add_to<'s>(&self, sample: Sample<'s>) -> Sample<'s> {
        let [work, dissipated, load_work, event_work] = self.energies;
        Sample {
            work: work + sample.work,
            dissipated: dissipated + sample.dissipated,
            load_work: load_work + sample.load_work,
            event_work: event_work + sample.event_work,
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

/// Like [`simulate_watched`], with the events of the crane. A result at the time of an event is that after it.
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
) -> Result<Run, Stopped> {
    let description = crane.description();
    if description.events.is_empty() {
        return simulate_watched(crane, start, settings, watch);
    }
    let phases = Phases::of(crane);
    let end = settings.duration;
    if let Some((event, error)) = phases.refused.as_ref().filter(|(event, _)| event.time <= end) {
        return Err(stopped(event, settings, &format!("cannot happen: {error}")));
    }
    let intervals = divided(end, settings.output).0;
    let (mut done, mut state, mut next, mut begin) = (Done::default(), start.clone(), 0, 0.0);
    let energy = |crane: &dyn DynCrane, sample: &Sample<'_>| crane.energies_of(sample).total();
    let mut happened = None;
    let mut events = description.events.iter().zip(&phases.later).filter(|(event, _)| event.time <= end);
    let mut present = crane;
    loop {
        let event = events.next();
        let until = event.map_or(end, |(event, _)| event.time);
        let settings = Settings { duration: until - begin, ..*settings };
        let mut integration = Integration::new(present, begin, &state, &settings)?;
        if let Some((event, before)) = happened {
            if let Some(what) = jump(description, &state, &integration.sample()) {
                return Err(stopped(event, &settings, &what));
            }
            done.energies[3] += energy(present, &integration.sample()) - before;
        }
        while next <= intervals {
            let result = (settings.output * next as f64).min(end);
            if result > until || (event.is_some() && result >= until) {
                break;
            }
            let goes_on = integration.advance(result, &mut |t| watch.step(t))?.is_continue();
            if !goes_on || watch.sample(&done.add_to(integration.sample())).is_break() {
                return Ok(done.add(&integration.run(), settings.method));
            }
            next += 1;
        }
        let Some((event, (_, after))) = event else {
            return Ok(done.add(&integration.run(), settings.method));
        };
        integration.end_step_at_result();
        let goes_on = integration.advance(until, &mut |t| watch.step(t))?.is_continue();
        let run = done.add(&integration.run(), settings.method);
        if !goes_on {
            return Ok(run);
        }
        let sample = done.add_to(integration.sample());
        if let Some(why) = refused(event, after.as_ref(), present) {
            return Err(stopped(event, &settings, &why));
        }
        let v = rates_after([present, after.as_ref()], event, sample.q, sample.v);
        happened = Some((event, energy(present, &sample)));
        done.energies = [sample.work, sample.dissipated, sample.load_work, sample.event_work];
        state = InitialState { q: sample.q.to_vec(), v, x: sample.x.to_vec() };
        (present, begin) = (after.as_ref(), until);
    }
}
