//! An instance of a crane inside another program's simulation.

mod derivatives;
mod fault;
mod state;

use std::ops::ControlFlow;
use std::path::Path;

use crane_live::{LiveCrane, Motion};
use crane_model::Moment as EventMoment;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{Contacts, InitialState, Settings, next_stop};
use crane_model::force_states::{self, ForceStates};
use crane_model::results;
use crane_model::runs::Start;
use crane_model::statics;

use crate::Make;
use crate::resources::{self, Opened};
use crate::variables::{self, Source, Variable};
use derivatives::Jacobian;
pub use fault::Fault;
use state::Moment;
pub use state::SavedState;

/// How far an importer has come with a unit.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Phase {
    Created,
    Initialising,
    /// Until here, a parameter changes the start.
    Begun,
    Ended,
}

/// A crane whose motion is integrated by the importer or by the crane's own method.
///
/// A crane begins where its runs begin: in the static equilibrium if the spec asks for statics, otherwise at the guess.
pub struct Instance {
    crane: Box<dyn DynCrane>,
    /// The live crane of the same spec, for exact derivatives.
    live: LiveCrane,
    /// What identifies the crane and its variables.
    token: String,
    variables: Vec<Variable>,
    /// Parameters at the start, and as last set.
    first: Vec<f64>,
    parameters: Vec<f64>,
    /// Inputs as last set.
    inputs: Vec<Option<f64>>,
    /// Whether the crane has the parameters and inputs that were set last.
    is_current: bool,
    settings: Settings,
    begin: f64,
    phase: Phase,
    moment: Option<Moment>,
    contacts: Contacts,
    /// Event and column of results of each event on a condition.
    conditions: Vec<(usize, usize)>,
    /// What events have done so far, as a [`Motion`] says it; none before the first step.
    marks: Option<Vec<f64>>,
    /// The run in progress by the crane's own method.
    motion: Option<Motion>,
    quantities: Option<Vec<f64>>,
    /// Accelerations, and the rates of the forces' states.
    accelerations: Option<(Vec<f64>, Vec<f64>)>,
    jacobian: Jacobian,
    /// Messages to report, and cautions that have been reported once.
    messages: Vec<String>,
    cautions: Vec<&'static str>,
}

/// An importer finds the zero of an indicator to rounding, on either side: this far beyond the value, relative to it, a condition holds, or has ceased.
const BEYOND: f64 = 1e-9;

impl Instance {
    /// The crane of an unpacked unit. `token` is that of its description.
    ///
    /// # Errors
    /// A message, if the spec cannot be read or the description belongs to another version of the library.
    pub fn new(folder: &Path, token: &str, make: Make) -> Result<Self, String> {
        let Opened { crane, live, parameters, warnings } = resources::open(folder, make)?;
        let variables = variables::list(crane.description(), crane.loop_joints());
        let expected = variables::token(crane.description(), &variables);
        if token != expected {
            return Err(format!(
                "the model description ({token}) is not that of this library and spec ({expected}): export the unit again"
            ));
        }
        let inputs = vec![None; crane.description().inputs.len()];
        let columns = results::quantities(crane.description(), crane.loop_joints());
        let column = |name: &str| columns.iter().position(|column| column.name == name);
        let conditions = crane.description().conditions();
        let conditions =
            conditions.filter_map(|(event, condition)| Some((event, column(&condition.result)?))).collect();
        Ok(Self {
            token: expected,
            contacts: Contacts::new(crane.as_ref()),
            conditions,
            marks: None,
            inputs,
            settings: Settings {
                duration: f64::INFINITY,
                most_steps: usize::MAX,
                ..Settings::from_description(crane.description())
            },
            crane,
            live,
            variables,
            first: parameters.clone(),
            parameters,
            is_current: false,
            begin: 0.0,
            phase: Phase::Created,
            moment: None,
            motion: None,
            quantities: None,
            accelerations: None,
            jacobian: Jacobian::Unknown,
            messages: Some(warnings).into_iter().filter(|words| !words.is_empty()).collect(),
            cautions: Vec::new(),
        })
    }

    /// Messages since the last call: warnings about the spec, and conditions for which the model is not valid.
    pub fn take_warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.messages)
    }

    /// Sets the tolerance of the crane's own integrator and the start time, s.
    ///
    /// # Errors
    /// The tolerance is out of range, or the time is not finite; or the initialisation has begun.
    pub fn set_up(&mut self, tolerance: Option<f64>, begin: f64) -> Result<(), Fault> {
        self.keep_before_initialisation()?;
        let (least, greatest) = Settings::TOLERANCES;
        if let Some(tolerance) = tolerance {
            if !(least..=greatest).contains(&tolerance) {
                let title = format!("a tolerance of {tolerance:e}");
                return Err(Fault::Error(format!("{title}: choose one from {least:e} to {greatest:e}, m and rad")));
            }
            self.settings.tolerance = tolerance;
        }
        if !begin.is_finite() {
            return Err(Fault::Error(format!("a start at t = {begin} s: choose a finite time")));
        }
        self.begin = begin;
        Ok(())
    }

    /// Begins the initialisation.
    ///
    /// # Errors
    /// It has begun before.
    pub fn initialise(&mut self) -> Result<(), Fault> {
        self.keep_before_initialisation()?;
        self.phase = Phase::Initialising;
        Ok(())
    }

    /// An error once the initialisation has begun.
    fn keep_before_initialisation(&self) -> Result<(), Fault> {
        if self.phase != Phase::Created {
            return Err(Fault::Error("the initialisation has begun before: reset the unit first".to_owned()));
        }
        Ok(())
    }

    /// Ends the initialisation: from now on parameters change the crane but not its state.
    ///
    /// # Errors
    /// As [`Instance::get`]; the initialisation has not begun.
    pub fn start(&mut self) -> Result<(), Fault> {
        if self.phase != Phase::Initialising {
            return Err(Fault::Error(
                "the end of an initialisation that has not begun: enter the initialisation mode first".to_owned(),
            ));
        }
        self.settle()?;
        self.phase = Phase::Begun;
        Ok(())
    }

    /// Ends the simulation: no step follows, unless it is reset.
    pub fn end(&mut self) {
        self.phase = Phase::Ended;
    }

    /// Returns to the state in which it was created.
    pub fn reset(&mut self) {
        self.parameters.clone_from(&self.first);
        self.inputs.fill(None);
        self.settings.tolerance = Settings::from_description(self.crane.description()).tolerance;
        (self.begin, self.is_current) = (0.0, false);
        self.phase = Phase::Created;
        (self.moment, self.motion, self.marks) = (None, None, None);
        self.cautions.clear();
        self.forget();
    }

    /// Number of event indicators: contacts, which begin and end, and conditions of events.
    pub fn indicators(&self) -> usize {
        self.contacts.len() + self.conditions.len()
    }

    /// Number of events of the spec.
    fn events(&self) -> usize {
        self.crane.description().events.len()
    }

    /// When an event happened, s; 0 if it has not.
    fn event_time(&self, event: usize) -> f64 {
        self.marks.as_ref().map_or(0.0, |marks| marks[event].max(0.0))
    }

    /// Number of continuous states: coordinates, rates and states of forces.
    pub fn states(&self) -> usize {
        2 * self.crane.size() + force_states::columns(self.crane.description()).len()
    }

    /// The time, s.
    pub fn time(&self) -> f64 {
        self.moment.as_ref().map_or(self.begin, |moment| moment.t)
    }

    fn forget(&mut self) {
        (self.quantities, self.accelerations, self.jacobian) = (None, None, Jacobian::Unknown);
    }

    /// Applies the parameters and inputs last set to the crane, and computes its initial state if it has none yet.
    fn settle(&mut self) -> Result<(), Fault> {
        if !self.is_current {
            self.crane.set_parameters(&self.parameters).map_err(Fault::error)?;
            give_inputs(self.crane.as_mut(), &self.inputs);
            self.live.set_parameters(&self.parameters).map_err(Fault::error)?;
            give_inputs(&mut self.live, &self.inputs);
            self.is_current = true;
            self.motion = None;
            self.forget();
        }
        if self.moment.is_none() {
            let crane = self.crane.as_ref();
            let Start { state: InitialState { mut q, mut v, .. }, rests, .. } =
                Start::new(crane).map_err(|failed| Fault::Error(format!("{failed}; {}", failed.advice())))?;
            if rests && self.begin != 0.0 {
                let equilibrium = statics::Problem::new(crane).at_time(self.begin).from(&q).solve();
                q = Start::at(crane, &equilibrium).map_err(Fault::error)?.state.q;
            }
            crane.prescribe(self.begin, &mut q, &mut v);
            let x = ForceStates::new(crane.description()).holding(crane, self.begin, &q);
            self.moment = Some(Moment { t: self.begin, q, v, x });
            self.forget();
        }
        Ok(())
    }

    /// Time, pose and rates, and the states of forces.
    fn moment(&mut self) -> Result<&Moment, Fault> {
        self.settle()?;
        self.moment.as_ref().ok_or_else(Fault::nowhere)
    }

    /// Changes time, pose or rates, and applies the motions of rigid drives.
    fn change(&mut self, change: impl FnOnce(&mut Moment)) -> Result<(), Fault> {
        self.settle()?;
        if let Some(moment) = &mut self.moment {
            change(moment);
            self.crane.prescribe(moment.t, &mut moment.q, &mut moment.v);
        }
        self.motion = None;
        self.forget();
        Ok(())
    }

    fn variable(&self, reference: u32) -> Result<&Variable, Fault> {
        let index = usize::try_from(reference).unwrap_or(usize::MAX);
        self.variables.get(index).ok_or_else(|| Fault::Error(format!("there is no variable {reference}")))
    }

    /// Values of variables by their references.
    ///
    /// # Errors
    /// There is no such variable; the parameters break a rule of the spec language; there is no equilibrium to start from.
    pub fn get(&mut self, references: &[u32], out: &mut [f64]) -> Result<(), Fault> {
        for (&reference, slot) in references.iter().zip(out) {
            *slot = match self.variable(reference)?.source {
                Source::Parameter(index) => self.parameters[index],
                Source::Input(index) => self.input(index),
                Source::Time => self.time(),
                Source::Position(index) => self.moment()?.q[index],
                Source::Rate(index) => self.moment()?.v[index],
                Source::Acceleration(index) => self.accelerations()?.0[index],
                Source::Own(index) => self.moment()?.x[index],
                Source::OwnRate(index) => self.accelerations()?.1[index],
                Source::Quantity(index) => self.quantities()?[index],
                Source::Indicator(index) => {
                    let mut all = vec![0.0; self.indicators()];
                    self.event_indicators(&mut all)?;
                    all[index]
                }
                Source::EventTime(event) => self.event_time(event),
            };
        }
        Ok(())
    }

    /// Event indicators: each changes its sign where a contact begins or ends, or where a result passes the value for which an event waits. That of an event
    /// that has happened is 1.
    ///
    /// # Errors
    /// As [`Instance::get`]; the length of `out` is not their number.
    pub fn event_indicators(&mut self, out: &mut [f64]) -> Result<(), Fault> {
        let count = self.indicators();
        if out.len() != count {
            return Err(Fault::Error(format!("{} numbers for {count} event indicators", out.len())));
        }
        self.settle()?;
        let Self { crane, moment: Some(moment), contacts, .. } = self else {
            return Err(Fault::nowhere());
        };
        let mut places = out.iter_mut();
        contacts.indicators(crane.as_ref(), &moment.state(), |indicator| {
            places.next().into_iter().for_each(|slot| *slot = indicator);
        });
        if self.conditions.is_empty() {
            return Ok(());
        }
        let row = self.quantities()?.to_vec();
        let infos = self.crane.description().conditions();
        let own = out[count - self.conditions.len()..].iter_mut();
        for ((slot, (event, column)), (_, condition)) in own.zip(&self.conditions).zip(infos) {
            let beyond = if condition.above { 1.0 } else { -1.0 } * (row[*column] - condition.value);
            let mark = self.marks.as_ref().map_or(0.0, |marks| marks[*event]);
            let held = if mark.is_nan() { 1.0 } else { -1.0 };
            *slot = if mark > 0.0 { 1.0 } else { beyond + held * BEYOND * (1.0 + condition.value.abs()) };
        }
        Ok(())
    }

    /// Value of an input; until it is set, the start value of the spec.
    fn input(&self, index: usize) -> f64 {
        let start = || self.live.chain().inputs[index].unless_set.start(&self.parameters);
        self.inputs[index].unwrap_or_else(start)
    }

    fn quantities(&mut self) -> Result<&[f64], Fault> {
        self.settle()?;
        let Self { crane, moment: Some(moment), quantities, .. } = self else {
            return Err(Fault::nowhere());
        };
        Ok(quantities.get_or_insert_with(|| results::quantities_at(crane.as_ref(), &moment.state())))
    }

    fn accelerations(&mut self) -> Result<&(Vec<f64>, Vec<f64>), Fault> {
        self.settle()?;
        let Self { crane, moment: Some(moment), accelerations, .. } = self else {
            return Err(Fault::nowhere());
        };
        Ok(accelerations.get_or_insert_with(|| force_states::accelerations(crane.as_ref(), &moment.state())))
    }

    /// Sets variables by their references; only parameters and inputs can be set. Rules that involve several parameters are
    /// checked when the crane next needs them. Setting an input to its current value changes nothing.
    ///
    /// # Errors
    /// A variable is neither a parameter nor an input, or a value is not allowed; the variables before it have been set.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Fault> {
        for (&reference, &value) in references.iter().zip(values) {
            let Variable { name, source, .. } = self.variable(reference)?;
            match *source {
                Source::Parameter(index) => {
                    self.crane.description().parameters[index].check(value).map_err(Fault::error)?;
                    self.parameters[index] = value;
                }
                Source::Input(_) if !value.is_finite() => {
                    return Err(Fault::Error(format!("{name} = {value}: choose a finite number")));
                }
                Source::Input(index) if self.inputs[index] == Some(value) => continue,
                Source::Input(index) => self.inputs[index] = Some(value),
                _ => return Err(Fault::Error(format!("{name} cannot be set: it follows from the motion"))),
            }
            self.is_current = false;
            if self.phase < Phase::Begun {
                self.moment = None;
            }
        }
        Ok(())
    }

    /// Sets the time, s.
    ///
    /// # Errors
    /// As [`Instance::get`]; the time is not finite.
    pub fn set_time(&mut self, t: f64) -> Result<(), Fault> {
        if !t.is_finite() {
            return Err(Fault::Error(format!("t = {t} s: choose a finite time")));
        }
        self.change(|moment| moment.t = t)
    }

    /// Sets coordinates, rates and states of forces.
    ///
    /// # Errors
    /// As [`Instance::get`]; the crane has closed loops; the number of values is not the number of states, or one is not finite: a solver
    /// may try smaller steps then.
    pub fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), Fault> {
        if let Some(joint) = self.crane.loop_joints().first() {
            return Err(Fault::Error(format!(
                "{} ties coordinates to each other, and what an importer integrates would drift apart: use the unit for co-simulation{}",
                joint.words(),
                joint.remedy()
            )));
        }
        self.check_states(states.len())?;
        if let Some(index) = states.iter().position(|state| !state.is_finite()) {
            return Err(Fault::Discard(format!("state {index} is {}: choose finite states", states[index])));
        }
        let (q, rest) = states.split_at(self.crane.size());
        let (v, x) = rest.split_at(q.len());
        self.change(|moment| {
            moment.q.copy_from_slice(q);
            moment.v.copy_from_slice(v);
            moment.x.copy_from_slice(x);
        })
    }

    fn check_states(&self, count: usize) -> Result<(), Fault> {
        let states = self.states();
        if count == states { Ok(()) } else { Err(Fault::Error(format!("{count} numbers for {states} states"))) }
    }

    /// Coordinates, rates and states of forces.
    ///
    /// # Errors
    /// As [`Instance::get`]; the length of `out` is not the number of states.
    pub fn continuous_states(&mut self, out: &mut [f64]) -> Result<(), Fault> {
        self.check_states(out.len())?;
        let Moment { q, v, x, .. } = self.moment()?;
        out.iter_mut().zip(q.iter().chain(v).chain(x)).for_each(|(entry, value)| *entry = *value);
        Ok(())
    }

    /// The next time at which the motion of a drive or a winch or the scale of a load is not smooth, or of an event, s.
    ///
    /// # Errors
    /// As [`Instance::get`].
    pub fn next_event(&mut self) -> Result<Option<f64>, Fault> {
        self.settle()?;
        let now = self.time();
        let times = self.crane.description().events.iter().filter_map(|event| match event.moment {
            EventMoment::At(time) => Some(time),
            EventMoment::When(_) => None,
        });
        let all = times.filter(|time| *time > now).chain(next_stop(self.crane.as_ref(), now));
        Ok(all.min_by(f64::total_cmp))
    }

    /// Lets the events happen that are due at the present time and states; returns whether they changed states.
    ///
    /// # Errors
    /// As [`Instance::get`]; an event cannot happen.
    pub fn update(&mut self) -> Result<bool, Fault> {
        let before = self.moment()?.clone();
        if self.events() == 0 {
            return Ok(false);
        }
        let Moment { t, q, v, x } = before.clone();
        let mut motion = self.motion_from(t, &InitialState { q, v, x })?;
        let _ = motion.advance(t, &mut |_| ControlFlow::Continue(()))?;
        self.reach(&motion)?;
        Ok(self.moment.as_ref() != Some(&before))
    }

    /// A motion by the crane's own method that goes on with what events have done.
    fn motion_from(&self, t: f64, state: &InitialState) -> Result<Motion, Fault> {
        Ok(Motion::new(self.crane.boxed_clone(), t, state, &self.settings, self.marks.as_deref())?)
    }

    /// Takes over where a motion is, and what its events have done.
    fn reach(&mut self, motion: &Motion) -> Result<(), Fault> {
        let sample = motion.sample();
        self.moment = Some(Moment { t: sample.t, q: sample.q.to_vec(), v: sample.v.to_vec(), x: sample.x.to_vec() });
        if self.events() > 0 {
            self.marks = Some(motion.marks());
            let values = motion.crane().parameter_values();
            if values != self.parameters {
                self.crane.set_parameters(&values).map_err(Fault::error)?;
                self.live.set_parameters(&values).map_err(Fault::error)?;
                self.parameters = values;
            }
        }
        self.forget();
        Ok(())
    }

    /// A step of the crane's own integrator, s. Its history continues from step to step; a change of a parameter or an input starts
    /// a new one.
    ///
    /// # Errors
    /// As [`Instance::get`]; the simulation has not begun or has ended; the step does not begin at the crane's current time, or its length
    /// is out of range; the integration fails.
    pub fn step(&mut self, from: f64, length: f64) -> Result<(), Fault> {
        /// Accepted rounding error of a time that is a sum of steps, as a fraction of a step.
        const ROUNDING: f64 = 1e-6;
        if self.phase < Phase::Begun {
            return Err(Fault::Error(
                "a step before the end of the initialisation: exit the initialisation mode first".to_owned(),
            ));
        }
        if self.phase == Phase::Ended {
            return Err(Fault::Error("a step after the end of the simulation: reset the unit first".to_owned()));
        }
        let Moment { t, q, v, x } = self.moment()?.clone();
        let (least, greatest) = Settings::TIMES;
        if !(least..=greatest).contains(&length) {
            return Err(Fault::Error(format!(
                "a step of {length} s: choose one above 0, from {least:e} to {greatest:e}"
            )));
        }
        // The comparison is false for NaN.
        let begins_here = (from - t).abs() <= ROUNDING * length;
        if !begins_here {
            return Err(Fault::Error(format!("a step from t = {from} s, but the crane is at t = {t} s")));
        }
        let mut motion = match self.motion.take() {
            Some(motion) => motion,
            None => self.motion_from(t, &InitialState { q, v, x })?,
        };
        let _ = motion.advance(from + length, &mut |_| ControlFlow::Continue(()))?;
        self.reach(&motion)?;
        self.motion = Some(motion);
        self.caution();
        Ok(())
    }

    /// Notes conditions for which the model is not valid, each kind once.
    fn caution(&mut self) {
        let Some(Moment { t, q, .. }) = &self.moment else { return };
        let description = self.crane.description();
        let found = [("singular", description.near_singular(q)), ("tilt", description.large_tilt(q))];
        for (kind, words) in found.into_iter().filter_map(|(kind, words)| Some((kind, words?))) {
            if !self.cautions.contains(&kind) {
                self.cautions.push(kind);
                self.messages.push(format!("t = {t:.3} s: {words}"));
            }
        }
    }
}

/// Sets the inputs of a crane; those without a value are as its spec says.
fn give_inputs(crane: &mut dyn DynCrane, values: &[Option<f64>]) {
    for (index, value) in values.iter().enumerate() {
        crane.set_input(index, *value);
    }
}
