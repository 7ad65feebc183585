//! A run from event to event.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use super::{
    EffortAccuracy, InitialState, Integration, Method, Quantities, Run, Sample, Settings, Statistics, Stepper, Stopped,
    Watch,
    events::{after, jump, rates_after, refused, stopped, timed},
    integration::{Advanced, Happens},
    settings::divided,
};
use crate::memory::{Visit, visit_count, visit_numbers};
use crate::{ConditionInfo, StateAt, dyn_crane::DynCrane};

/// The conditions of events that have not happened.
#[derive(Clone)]
struct Conditions {
    quantities: Quantities,
    /// Event, column of results, and condition of each.
    all: Vec<(usize, usize, ConditionInfo)>,
    /// Whether each holds, at the last time at which no event was due.
    held: Vec<bool>,
    /// Whether each holds, at the last time at which one was.
    holds: Vec<bool>,
    /// When the events happened, s; 0 for those that have not.
    times: Vec<f64>,
}

impl Conditions {
    /// Those of a crane, before the start of a run.
    fn new(crane: &dyn DynCrane, quantities: Quantities) -> Self {
        let description = crane.description();
        let none = description.conditions().next().is_none();
        let names = if none { Vec::new() } else { (quantities.names)(crane) };
        let all = description.conditions().filter_map(|(event, condition)| {
            let column = names.iter().position(|name| name == condition.result.as_str())?;
            Some((event, column, condition.clone()))
        });
        let all: Vec<_> = all.collect();
        // At the start none is due: what holds there has to cease first.
        Self { quantities, held: vec![true; all.len()], holds: Vec::new(), times: vec![0.0; all.len()], all }
    }

    /// Whether each holds at a state.
    fn evaluate(&self, crane: &dyn DynCrane, moment: &StateAt<'_>) -> Vec<bool> {
        if self.all.is_empty() {
            return Vec::new();
        }
        let row = (self.quantities.at)(crane, moment);
        self.all.iter().map(|(_, column, condition)| condition.is_met(row[*column])).collect()
    }

    /// Notes a later state; returns whether an event is due there.
    fn note(&mut self, crane: &dyn DynCrane, moment: &StateAt<'_>) -> bool {
        let now = self.evaluate(crane, moment);
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

/// What earlier phases of a run did.
#[derive(Clone, Default)]
struct Done {
    /// Work of drives, dissipated energy, work of loads and of events, J.
    energies: [f64; 4],
    statistics: Statistics,
    efforts: Vec<EffortAccuracy>,
}

impl Done {
    /// All so far, with the run of the present phase.
    fn with(&self, run: &Run, method: Method) -> Run {
        let (mut statistics, mut efforts) = (self.statistics, self.efforts.clone());
        let Statistics { steps, rejections, evaluations, factorisations } = &mut statistics;
        *steps += run.statistics.steps;
        *rejections += run.statistics.rejections;
        *evaluations += run.statistics.evaluations;
        *factorisations += run.statistics.factorisations;
        for effort in &run.efforts {
            match efforts.iter_mut().find(|known| known.coordinate == effort.coordinate) {
                Some(known) => {
                    known.peak = known.peak.max(effort.peak);
                    known.error = known.error.max(effort.error);
                }
                None => efforts.push(*effort),
            }
        }
        let step = if method.is_adaptive() { run.time / (statistics.steps.max(1)) as f64 } else { run.step };
        Run { statistics, step, efforts, ..run.clone() }
    }
}

/// Why an event happens when it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trigger {
    /// At its time.
    Time,
    /// A result passes its value: a column, and which of the conditions this is.
    Condition(usize, usize),
    /// The event before it made its condition hold; which of the conditions this is.
    Event(usize),
}

impl Trigger {
    /// Which of the conditions holds now.
    pub fn condition(self) -> Option<usize> {
        match self {
            Self::Time => None,
            Self::Condition(_, condition) | Self::Event(condition) => Some(condition),
        }
    }
}

/// Most states of forces of a crane, against memory that was damaged.
const MOST_STATES: usize = 1 << 16;

/// An event that happens.
#[derive(Clone, Copy, Debug)]
pub struct Happening {
    /// Its index.
    pub event: usize,
    /// When, s.
    pub time: f64,
    pub(super) trigger: Trigger,
}

/// How far a course has been followed.
#[derive(Clone, Copy, Debug)]
pub enum Progress {
    /// To the result.
    Reached,
    /// To an event.
    Event(Happening),
    /// It was stopped on the way.
    Stopped,
}

/// A run whose crane is another one after each of its events: what has happened, and what is still to come. Its integration is a new one in every phase.
#[derive(Clone)]
pub struct Course {
    settings: Settings,
    /// Beginning and end of the run, s.
    from: f64,
    end: f64,
    done: Done,
    /// The beginning of the present phase, s, and the state there.
    begin: f64,
    state: InitialState,
    conditions: Conditions,
    /// Conditions whose events are due.
    due: VecDeque<usize>,
    /// The events at times still to come.
    timed: VecDeque<(f64, usize)>,
    /// The events that have happened, with their times, s, in this order.
    happened: Vec<(usize, f64)>,
    /// The last event, if it ended a phase of this course, and the energy before it, J.
    last: Option<(usize, f64)>,
    /// The next result.
    next: usize,
}

impl Course {
    /// From a state at a time, s. Events before this time do not happen any more.
    #[must_use]
    pub fn new(
        crane: &dyn DynCrane,
        begin: f64,
        start: &InitialState,
        settings: &Settings,
        quantities: &Quantities,
    ) -> Self {
        let end = begin + settings.duration;
        let timed = in_order(timed(crane.description()).filter(|(time, _)| *time > begin && *time <= end));
        Self {
            settings: *settings,
            from: begin,
            end,
            done: Done::default(),
            begin,
            state: start.clone(),
            conditions: Conditions::new(crane, *quantities),
            due: VecDeque::new(),
            timed,
            happened: Vec::new(),
            last: None,
            next: 0,
        }
    }

    /// The beginning of the present phase, s, its state, and the settings of its integration.
    #[must_use]
    pub fn phase(&self) -> (f64, &InitialState, Settings) {
        let until = self.timed.front().map_or(self.end, |(time, _)| *time);
        (self.begin, &self.state, Settings { duration: until - self.begin, ..self.settings })
    }

    /// Begins a phase, with its crane and its integration.
    ///
    /// # Errors
    /// The last event would move the crane at once.
    pub fn enter<S: Stepper + ?Sized>(
        &mut self,
        present: &dyn DynCrane,
        integration: &Integration<'_, S>,
    ) -> Result<(), Stopped> {
        let sample = integration.sample();
        let description = present.description();
        if let Some((event, before)) = self.last.take() {
            if let Some(what) = jump(description, &self.state, &sample) {
                return Err(stopped(&description.events[event], self.begin, &self.settings, &what));
            }
            self.done.energies[3] += present.energies_of(&sample).total() - before;
        }
        // What an event changes at once makes others due.
        if self.conditions.note(present, &sample) {
            self.due.extend(self.conditions.take());
        }
        Ok(())
    }

    /// Advances to a result, s, or to the next event, if that comes first; one at the time of a result does.
    ///
    /// # Errors
    /// As [`Integration::advance`].
    pub fn advance<S: Stepper + ?Sized>(
        &mut self,
        present: &dyn DynCrane,
        integration: &mut Integration<'_, S>,
        result: f64,
        step: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Progress, Stopped> {
        let Self { conditions, due, timed, happened, .. } = self;
        let at_once = !due.is_empty();
        let planned = timed.front().copied().filter(|(time, _)| !at_once && *time <= result);
        if !at_once {
            let n = present.size();
            let is_awaited = conditions.times.contains(&0.0);
            let happens = &mut |t: f64, motion: &[f64]| conditions.note(present, &StateAt::from_motion(t, n, motion));
            let asked = is_awaited.then_some(happens as Happens<'_>);
            if planned.is_some() {
                integration.end_step_at_result();
            }
            let until = planned.map_or(result, |(time, _)| time.max(integration.sample().t));
            match integration.advance_until(until, step, asked)? {
                Advanced::Stopped => return Ok(Progress::Stopped),
                // An event at the same time comes first; then the condition is looked at again.
                Advanced::Happened if planned.is_none_or(|(planned, _)| integration.sample().t < planned) => {
                    due.extend(conditions.take());
                }
                Advanced::Happened | Advanced::Reached => {}
            }
        }
        if let Some(condition) = due.pop_front() {
            let (event, column, _) = conditions.all[condition];
            // Later than the events before it: rows tell their order by it.
            let after = happened.last().map_or(0.0, |(_, time)| time.next_up());
            let time = integration.sample().t.max(after);
            conditions.times[condition] = time;
            happened.push((event, time));
            let trigger = if at_once { Trigger::Event(condition) } else { Trigger::Condition(column, condition) };
            return Ok(Progress::Event(Happening { event, time, trigger }));
        }
        Ok(planned.map_or(Progress::Reached, |(time, event)| {
            timed.pop_front();
            happened.push((event, time));
            Progress::Event(Happening { event, time, trigger: Trigger::Time })
        }))
    }

    /// Lets an event happen: `cranes` are those before and after it. The next phase begins where the present one ended.
    ///
    /// # Errors
    /// What joins cannot.
    pub fn pass<S: Stepper + ?Sized>(
        &mut self,
        [present, after]: [&dyn DynCrane; 2],
        integration: &Integration<'_, S>,
        happening: Happening,
    ) -> Result<(), Stopped> {
        let info = &present.description().events[happening.event];
        let sample = self.sample(integration);
        if let Some(why) = refused(info, after, present) {
            return Err(self.refuse(present, happening, &why));
        }
        let v = rates_after([present, after], info, sample.q, sample.v);
        let energies = [sample.work, sample.dissipated, sample.load_work, sample.event_work];
        let (begin, state) = (sample.t, InitialState { q: sample.q.to_vec(), v, x: sample.x.to_vec() });
        self.last = Some((happening.event, present.energies_of(&sample).total()));
        let Run { statistics, efforts, .. } = self.run(integration);
        self.done = Done { energies, statistics, efforts };
        (self.begin, self.state) = (begin, state);
        Ok(())
    }

    /// The crane after an event.
    ///
    /// # Errors
    /// The parameters break a rule of the spec language.
    pub fn after(&self, present: &dyn DynCrane, happening: Happening) -> Result<Box<dyn DynCrane>, Stopped> {
        let info = &present.description().events[happening.event];
        after(present, [info]).map_err(|error| self.refuse(present, happening, &format!("cannot happen: {error}")))
    }

    /// The results to which conditions refer, and the value at which that of an event is; NaN for one at a time.
    pub(super) fn quantities_and_value(&self, happening: Happening) -> (Quantities, f64) {
        let condition = happening.trigger.condition();
        (self.conditions.quantities, condition.map_or(f64::NAN, |condition| self.conditions.all[condition].2.value))
    }

    /// An event that is refused, and why.
    pub(super) fn refuse(&self, present: &dyn DynCrane, happening: Happening, why: &str) -> Stopped {
        stopped(&present.description().events[happening.event], happening.time, &self.settings, why)
    }

    /// What has happened so far, from which another course goes on: for each event its time, s; 0 if it is still to come, NaN if its condition has to cease
    /// before, −1 if it does not happen because its time was before the beginning.
    #[must_use]
    pub fn marks(&self, crane: &dyn DynCrane) -> Vec<f64> {
        let mut marks = vec![-1.0; crane.description().events.len()];
        self.timed.iter().for_each(|(_, event)| marks[*event] = 0.0);
        for ((event, ..), held) in self.conditions.all.iter().zip(&self.conditions.held) {
            marks[*event] = if *held { f64::NAN } else { 0.0 };
        }
        self.happened.iter().for_each(|(event, time)| marks[*event] = *time);
        marks
    }

    /// Goes on from [marks](Self::marks) of the crane; the present one is that after the events that happened. What is overdue happens at once.
    pub fn resume(&mut self, crane: &dyn DynCrane, marks: &[f64]) {
        let mark = |event: usize| marks.get(event).copied().unwrap_or_default();
        let Self { conditions, end, .. } = self;
        self.happened = (0..crane.description().events.len()).map(|event| (event, mark(event))).collect();
        self.happened.retain(|(_, mark)| *mark > 0.0);
        self.happened.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        self.timed = in_order(timed(crane.description()).filter(|(time, event)| mark(*event) == 0.0 && time <= end));
        let each = conditions.all.iter().zip(&mut conditions.held).zip(&mut conditions.times);
        for (((event, ..), held), time) in each {
            (*held, *time) = (mark(*event).is_nan(), mark(*event).max(0.0));
        }
    }

    /// Visits all numbers on which the further course depends, besides the crane and the settings. Returns whether they can be those of a course of the
    /// same crane.
    pub fn visit(&mut self, crane: &dyn DynCrane, visit: Visit<'_>) -> bool {
        let mut marks = self.marks(crane);
        visit_numbers(&mut marks, visit);
        self.resume(crane, &marks);
        visit(&mut self.begin);
        let InitialState { q, v, x } = &mut self.state;
        let mut states = x.len();
        visit_count(&mut states, visit);
        let is_possible = states <= MOST_STATES;
        x.resize(states.min(MOST_STATES), 0.0);
        for numbers in [q, v, x] {
            visit_numbers(numbers, visit);
        }
        visit_numbers(&mut self.done.energies, visit);
        let Statistics { steps, rejections, evaluations, factorisations } = &mut self.done.statistics;
        for count in [steps, rejections, evaluations, factorisations] {
            visit_count(count, visit);
        }
        is_possible
    }

    /// The events that have happened, in this order.
    pub fn happened(&self) -> impl Iterator<Item = usize> + '_ {
        self.happened.iter().map(|(event, _)| *event)
    }

    /// The last result, since the beginning of the run.
    #[must_use]
    pub fn sample<'s, S: Stepper + ?Sized>(&'s self, integration: &'s Integration<'_, S>) -> Sample<'s> {
        let [work, dissipated, load_work, event_work] = self.done.energies;
        let sample = integration.sample();
        Sample {
            work: work + sample.work,
            dissipated: dissipated + sample.dissipated,
            load_work: load_work + sample.load_work,
            event_work: event_work + sample.event_work,
            event_times: &self.conditions.times,
            ..sample
        }
    }

    /// The run so far.
    #[must_use]
    pub fn run<S: Stepper + ?Sized>(&self, integration: &Integration<'_, S>) -> Run {
        self.done.with(&integration.run(), self.settings.method)
    }

    /// Follows the present phase from result to result, to the event that ends it; `None` if the run ends.
    pub(super) fn follow<S: Stepper + ?Sized>(
        &mut self,
        present: &dyn DynCrane,
        integration: &mut Integration<'_, S>,
        observe: &mut dyn Observe<S>,
    ) -> Result<Option<Happening>, Stopped> {
        self.enter(present, integration)?;
        let intervals = divided(self.settings.duration, self.settings.output).0;
        while self.next <= intervals {
            let result = (self.from + self.settings.output * self.next as f64).min(self.end);
            match self.advance(present, integration, result, &mut |t| observe.step(t))? {
                Progress::Event(happening) => return Ok(Some(happening)),
                Progress::Stopped => break,
                Progress::Reached if observe.sample(present, integration, self).is_break() => break,
                Progress::Reached => self.next += 1,
            }
        }
        Ok(None)
    }
}

/// Events at times, s, in the order in which they happen.
fn in_order(events: impl Iterator<Item = (f64, usize)>) -> VecDeque<(f64, usize)> {
    let mut all: Vec<_> = events.collect();
    all.sort_by(|(one, first), (other, second)| one.total_cmp(other).then(first.cmp(second)));
    all.into()
}

/// An observer of a run from event to event.
pub(super) trait Observe<S: Stepper + ?Sized> {
    /// Looks at the result that was reached, and may end the run.
    fn sample(
        &mut self,
        present: &dyn DynCrane,
        integration: &mut Integration<'_, S>,
        course: &Course,
    ) -> ControlFlow<()>;

    /// Receives the time after every step, s, and may end the run.
    fn step(&mut self, t: f64) -> ControlFlow<()>;
}

/// Passes samples on.
struct Samples<'w>(&'w mut dyn Watch);

impl<S: Stepper + ?Sized> Observe<S> for Samples<'_> {
    fn sample(&mut self, _: &dyn DynCrane, integration: &mut Integration<'_, S>, course: &Course) -> ControlFlow<()> {
        self.0.sample(&course.sample(integration))
    }

    fn step(&mut self, t: f64) -> ControlFlow<()> {
        self.0.step(t)
    }
}

/// Runs a crane from event to event.
pub(super) fn follow_events(
    crane: &dyn DynCrane,
    begin: f64,
    start: &InitialState,
    settings: &Settings,
    watch: &mut dyn Watch,
    quantities: &Quantities,
) -> Result<Run, Stopped> {
    let mut course = Course::new(crane, begin, start, settings, quantities);
    let mut changed = None::<Box<dyn DynCrane>>;
    loop {
        let present = changed.as_deref().unwrap_or(crane);
        let (begin, state, settings) = course.phase();
        let mut integration = Integration::new(present, begin, state, &settings)?;
        let Some(happening) = course.follow(present, &mut integration, &mut Samples(watch))? else {
            return Ok(course.run(&integration));
        };
        let after = course.after(present, happening)?;
        course.pass([present, after.as_ref()], &integration, happening)?;
        drop(integration);
        changed = Some(after);
    }
}
