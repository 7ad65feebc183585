//! Runs: of one crane with all its results, and of many with their extremes and final states.

use std::ops::ControlFlow;
use std::str::FromStr;

use crane_live::LiveCrane;
use crane_live::sensitivity::runs::{self, Along, run_with_adjoint, run_with_gradients};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Settings, Statistics};
use crane_model::results::{Column, Peaks, Recording, cautions, quantities};
use crane_model::runs::ensemble::{self, Case, Execution};
use crane_model::runs::{
    Bound as StepBound, Failed, Measure, Reason, Recorded, SAFE, Start, check, large_effort, record_checked, step_limit,
};
use crane_model::stability::cause;
use crane_model::{ColumnKind, Description};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Argument, Joined, array};
use crate::crane::{Crane, input_index};
use crate::evaluation::StateArguments;
use crate::mistakes::{BadRow, Invalid, NoEquilibrium, describe, warn_of_rows};
use crate::parallel::{Watch, threads};
use crate::types::{Dict, Given, Keys, Progress, hints};

/// Options of a run, as given.
#[derive(Clone, FromPyObject)]
pub struct Timing {
    #[pyo3(item)]
    method: Option<String>,
    #[pyo3(item)]
    duration: Option<f64>,
    #[pyo3(item)]
    output: Option<f64>,
    #[pyo3(item)]
    tolerance: Option<f64>,
    #[pyo3(item)]
    step: Option<f64>,
    /// The largest safe step.
    #[pyo3(item)]
    safe_step: bool,
    #[pyo3(item)]
    force: bool,
}

impl Timing {
    /// Settings of a run: the spec's unless given here.
    pub fn settings(&self, description: &Description) -> PyResult<Settings> {
        let constant = self.step.is_some() || self.safe_step;
        let method = match &self.method {
            Some(name) => Method::from_str(name).map_err(|unknown| PyValueError::new_err(unknown.to_string()))?,
            None if constant => Method::Rk4,
            None => Method::default(),
        };
        if constant && method.is_adaptive() {
            return Err(PyValueError::new_err(format!(
                "`step` has no effect with {method}: give `tolerance`, or method=\"rk4\""
            )));
        }
        if self.tolerance.is_some() && !method.is_adaptive() {
            return Err(PyValueError::new_err(format!(
                "`tolerance` has no effect with {method}: give `step`, or method=\"bdf\""
            )));
        }
        let defaults = Settings::from_description(description);
        let settings = Settings {
            method,
            duration: self.duration.unwrap_or(defaults.duration),
            output: self.output.unwrap_or_else(|| defaults.output.min(self.duration.unwrap_or(defaults.output))),
            tolerance: self.tolerance.unwrap_or(defaults.tolerance),
            step: self.step.unwrap_or(defaults.step),
            audit: true,
            ..defaults
        };
        for (name, value, (least, greatest), unit) in [
            ("duration", settings.duration, Settings::TIMES, "s"),
            ("output", settings.output, Settings::TIMES, "s"),
            ("tolerance", settings.tolerance, Settings::TOLERANCES, "m and rad"),
            ("step", settings.step, (f64::MIN_POSITIVE, f64::MAX), "s"),
        ] {
            if !(least..=greatest).contains(&value) {
                let range =
                    if greatest < f64::MAX { format!("from {least:e} to {greatest:e}") } else { "above 0".to_owned() };
                return Err(PyValueError::new_err(format!("{name}={value}: write a number {range}, in {unit}")));
            }
        }
        if settings.output > settings.duration {
            let Settings { output, duration, .. } = settings;
            return Err(PyValueError::new_err(format!("output={output} is longer than the run of {duration} s")));
        }
        if settings.duration / settings.output > Settings::MOST_RESULTS {
            return Err(PyValueError::new_err("more than a million results: write a longer `output`, in s"));
        }
        if !method.is_adaptive() && settings.duration / settings.step > Settings::MOST_STEPS {
            return Err(PyValueError::new_err("more than ten billion steps: write a longer `step`, in s"));
        }
        Ok(settings)
    }

    /// The same with a step that is stable from a start.
    fn stable(&self, crane: &dyn DynCrane, start: &Start) -> PyResult<Settings> {
        let settings = self.settings(crane.description())?;
        if settings.method.is_adaptive() {
            return Ok(settings);
        }
        let settings = match step_limit(crane, start) {
            Some(StepBound { limit, .. }) if self.safe_step => Settings { step: SAFE * limit.step, ..settings },
            Some(StepBound { t, limit }) if settings.step.min(settings.output) > limit.step && !self.force => {
                let (name, step) = (&crane.description().name, settings.step);
                let cause = cause(crane.description(), &limit.mode);
                return Err(PyValueError::new_err(format!(
                    "{name}: a step of {step:e} s is unstable; rk4 takes at most {:.3e} s, limited at t = {t} s by {cause}; \
                     step=\"auto\" uses {:.2e} s, method=\"bdf\" can use longer steps, force=True runs anyway",
                    limit.step,
                    SAFE * limit.step
                )));
            }
            _ => settings,
        };
        match large_effort(crane, start, &settings).filter(|_| !self.force) {
            Some(effort) => Err(PyValueError::new_err(format!(
                "{}: a run of {} s takes {effort}; method=\"bdf\" takes longer steps, force=True runs anyway",
                crane.description().name,
                settings.duration
            ))),
            None => Ok(settings),
        }
    }
}

/// A failure as an exception.
pub fn raised(failed: &Failed) -> PyErr {
    // The command's option has a function here.
    let words = format!("{failed}; {}", failed.advice().replace("`--start`", "`coordinates_of`"));
    match *failed.reason {
        Reason::Equilibrium { .. } => NoEquilibrium::new_err(words),
        _ => PyRuntimeError::new_err(words),
    }
}

/// Names and units of columns.
fn columns_with_units(columns: &[Column]) -> Vec<(&str, &str)> {
    columns.iter().map(|column| (column.name.as_str(), column.unit.as_str())).collect()
}

pub fn statistics<'py>(py: Python<'py>, statistics: &Statistics) -> PyResult<Dict<'py, hints::Int>> {
    let all = PyDict::new(py);
    let Statistics { steps, rejections, evaluations, factorisations } = *statistics;
    all.set_item("steps", steps)?;
    all.set_item("rejections", rejections)?;
    all.set_item("evaluations", evaluations)?;
    all.set_item("factorisations", factorisations)?;
    Ok(all.into())
}

/// Continues unless the call has been cancelled.
pub fn unless(off: bool) -> ControlFlow<()> {
    if off { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Pose and rates that were given, of one state.
fn read_coordinates(name: &str, object: &Bound<'_, PyAny>, description: &Description) -> PyResult<Vec<f64>> {
    let argument = Argument::coordinates(name, object, description)?;
    if !argument.shape.is_empty() {
        return Err(PyValueError::new_err(format!("{name} has {} axes: give one state", argument.shape.len() + 1)));
    }
    check_finite(name, &argument, description)?;
    Ok(argument.numbers)
}

/// Refuses states with numbers that are not finite.
fn check_finite(name: &str, argument: &Argument, description: &Description) -> PyResult<()> {
    let Some(index) = argument.numbers.iter().position(|x| !x.is_finite()) else { return Ok(()) };
    let (row, coordinate) = (index / argument.width, index % argument.width);
    let (value, of) = (argument.numbers[index], &description.coordinates[coordinate].name);
    let reason = format!("{name}[{coordinate}] ({of}) is {value}, not a finite number");
    Err(PyValueError::new_err(describe(&BadRow { row, reason }, &argument.shape)))
}

/// Columns, by their indices, and their measures of names as `boom_psi_drive_torque.peak`.
fn asked_of(crane: &LiveCrane, names: &[String]) -> PyResult<Vec<(usize, Measure)>> {
    let columns = Recording::new(crane).into_table().columns;
    let of_states = quantities(crane.description(), crane.loop_joints()).len();
    let has_derivatives = |column: usize| column < of_states || columns[column].kind == ColumnKind::EventTime;
    let asked = |name: &String| runs::asked(&columns, name, &has_derivatives);
    names.iter().map(|name| asked(name).map_err(|not| PyValueError::new_err(not.to_string()))).collect()
}

#[pymethods]
impl Crane {
    /// A run with all its results: `Crane.simulate` makes a `Run` of it.
    #[pyo3(name = "_record", signature = (timing, q=None, v=None, verify=true, bend=cautions::BEND, gradients=None, adjoint=None))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn record<'py>(
        &self,
        py: Python<'py>,
        timing: Keys<Timing>,
        q: Given<'py>,
        v: Given<'py>,
        verify: bool,
        bend: f64,
        gradients: Option<Vec<String>>,
        adjoint: Option<Vec<String>>,
    ) -> PyResult<Dict<'py>> {
        let crane: &dyn DynCrane = &self.live;
        let description = crane.description();
        if !self.is_single() {
            return Err(PyValueError::new_err("the parameters are arrays: use `simulate_ensemble`"));
        }
        timing.settings(description)?;
        if bend.is_nan() || bend <= 0.0 {
            return Err(PyValueError::new_err(format!("bend_limit={bend}: write an angle above 0, in degrees")));
        }
        let [q, v] = [("q", q), ("v", v)]
            .map(|(name, state)| state.map(|state| read_coordinates(name, &state, description)).transpose());
        let (q, v) = (q?, v?);
        let named =
            |name: &String| Along::named(&self.live, name).map_err(|not| PyValueError::new_err(not.to_string()));
        let along =
            gradients.as_ref().map(|names| names.iter().map(named).collect::<PyResult<Vec<_>>>()).transpose()?;
        let asked = adjoint.as_ref().map(|names| asked_of(&self.live, names)).transpose()?;
        let all = match (&gradients, &along) {
            (Some(names), Some(along)) if asked.is_some() => names.iter().cloned().zip(along.iter().copied()).collect(),
            _ if asked.is_some() => Along::all(&self.live),
            _ => Vec::new(),
        };
        let watch = Watch::new();
        let result = py.detach(|| {
            let start = Start::with(crane, 0.0, q.as_deref(), v.as_deref()).map_err(|failed| raised(&failed))?;
            let settings = timing.stable(crane, &start)?;
            let proceed = &mut |_: f64| unless(watch.look());
            let checked = |recorded, proceed: &mut dyn FnMut(f64) -> ControlFlow<()>| {
                check(recorded, crane, &start, &settings, (verify, bend), proceed)
            };
            let recorded = match (&along, &asked) {
                (Some(along), None) => run_with_gradients(&self.live, &start, &settings, along, proceed)
                    .map(|(recorded, found)| (checked(recorded, proceed), found, Vec::new())),
                (_, Some(asked)) => {
                    let along: Vec<Along> = all.iter().map(|(_, along)| *along).collect();
                    run_with_adjoint(&self.live, &start, &settings, &along, asked, proceed)
                        .map(|(recorded, found)| (checked(recorded, proceed), Vec::new(), found))
                }
                (None, None) => record_checked(crane, &start, &settings, (verify, bend), proceed)
                    .map(|recorded| (recorded, Vec::new(), Vec::new())),
            };
            Ok::<_, PyErr>((settings, recorded.map_err(|failed| raised(&failed))?))
        });
        watch.finish(py)?;
        let (settings, (recorded, found, of_asked)) = result?;
        let Recorded { start, run, table, wall, verification, cautions } = recorded;
        let names: Vec<String> = all.into_iter().map(|(name, _)| name).collect();
        let all = PyDict::new(py);
        all.set_item("columns", columns_with_units(&table.columns))?;
        let rows = table.rows.len();
        all.set_item("table", array(py, table.rows.concat(), &[rows], &[table.columns.len()])?)?;
        all.set_item("start", start)?;
        all.set_item("method", settings.method.name())?;
        all.set_item("tolerance", settings.method.is_adaptive().then_some(settings.tolerance))?;
        all.set_item("step", run.step)?;
        all.set_item("statistics", statistics(py, &run.statistics)?)?;
        all.set_item("errors", verification.as_ref().map(|found| found.errors.clone()))?;
        all.set_item("missed", verification.as_ref().map(|found| found.missed.clone()))?;
        all.set_item("divergence", verification.as_ref().and_then(|found| found.divergence))?;
        all.set_item("cautions", cautions)?;
        all.set_item("wall_time", wall.unwrap_or_default().as_secs_f64())?;
        if let (Some(names), None) = (gradients, &asked) {
            let of_names = PyDict::new(py);
            for (name, rows) in names.iter().zip(found) {
                of_names.set_item(name, array(py, rows.concat(), &[rows.len()], &[table.columns.len()])?)?;
            }
            all.set_item("gradients", of_names)?;
        }
        if asked.is_some() {
            let of_measures = PyDict::new(py);
            for (number, found) in adjoint.into_iter().flatten().zip(of_asked) {
                let by_names = PyDict::new(py);
                names.iter().zip(found).try_for_each(|(name, by)| by_names.set_item(name, by))?;
                of_measures.set_item(number, by_names)?;
            }
            all.set_item("adjoint", of_measures)?;
        }
        Ok(all.into())
    }

    /// Runs with every row of parameters, starts and inputs, with the extremes and final state of each: `Crane.simulate_ensemble` makes an
    /// `Ensemble` of them.
    #[pyo3(name = "_run_ensemble", signature = (timing, invalid="raise", progress=None, q=None, v=None, inputs=None))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn run_ensemble<'py>(
        &self,
        py: Python<'py>,
        timing: Keys<Timing>,
        invalid: &str,
        progress: Option<Progress>,
        q: Given<'py>,
        v: Given<'py>,
        inputs: Option<Dict<'py, Option<hints::ArrayLike>>>,
    ) -> PyResult<Dict<'py>> {
        let invalid = Invalid::named(invalid)?;
        let crane: &dyn DynCrane = &self.live;
        let description = crane.description();
        let (shape, mut rows, wrong) = self.cases(q, v, inputs, invalid)?;
        let (shape, count) = (&shape, rows.len());
        let mut is_sound = (0..count).map(|row| wrong.binary_search_by_key(&row, |wrong| wrong.row).is_err());
        rows.retain(|_| is_sound.next().unwrap_or(true));
        let settings = Settings { audit: false, ..timing.settings(description)? };
        // A step that was asked for is judged; otherwise a safe one is found.
        let safe_timing = Timing { safe_step: timing.step.is_none(), ..timing.clone() };
        let watch = Watch::reporting(progress, rows.len());
        let outcomes = py.detach(|| {
            let mut settings = settings;
            if !settings.method.is_adaptive() {
                // A step that is stable for the first and the last row, if these have a start.
                let mut safe = f64::INFINITY;
                for row in [rows.first(), rows.last()].into_iter().flatten() {
                    if let Ok((case, start)) = ensemble::ready(crane, row) {
                        safe = safe.min(safe_timing.stable(case.as_ref(), &start)?.step);
                    }
                }
                settings.step = match timing.step {
                    Some(step) => step,
                    None if safe.is_finite() => {
                        ensemble::constant_step((!timing.safe_step).then_some(settings.step), safe)
                    }
                    // None has a start: each says why.
                    None => settings.step,
                };
            }
            let cancelled = |caller: bool| if caller { watch.look() } else { watch.is_off() };
            let execution = Execution { threads: threads(), done: &|_, _| watch.count(), cancelled: &cancelled };
            Ok::<_, PyErr>(ensemble::run_ensemble(crane, &rows, &settings, &execution))
        });
        watch.finish(py)?;
        let mut outcomes = outcomes?.into_iter();
        let outcome = |row: usize| match wrong.binary_search_by_key(&row, |wrong| wrong.row) {
            Ok(place) => Err(wrong[place].reason.clone()),
            Err(_) => outcomes.next().ok_or_else(String::new),
        };
        let outcomes: Vec<Result<ensemble::Outcome, String>> = (0..count).map(outcome).collect();
        let failure = |outcome: &Result<ensemble::Outcome, String>| match outcome {
            Ok(outcome) => outcome.run.as_ref().err().map(ToString::to_string),
            Err(reason) => Some(reason.clone()),
        };
        let bad = outcomes.iter().enumerate().filter_map(|(row, of)| Some(BadRow { row, reason: failure(of)? }));
        let bad: Vec<BadRow> = bad.collect();
        if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
            return Err(PyRuntimeError::new_err(describe(first, shape)));
        }
        warn_of_rows(py, &bad, shape)?;
        let columns = Peaks::columns(crane);
        let run = |outcome: &ensemble::Outcome| outcome.peaks.as_ref().map(|peaks| peaks.values().collect());
        let values = outcomes
            .iter()
            .flat_map(|outcome| outcome.as_ref().ok().and_then(run).unwrap_or_else(|| vec![f64::NAN; columns.len()]));
        let n = crane.size();
        let all = PyDict::new(py);
        all.set_item("columns", columns_with_units(&columns))?;
        all.set_item("table", array(py, values.collect(), shape, &[columns.len()])?)?;
        let times = outcomes.iter().map(|outcome| outcome.as_ref().map_or(0.0, ensemble::Outcome::time));
        all.set_item("time", array(py, times.collect(), shape, &[])?)?;
        let ends = |of: fn(&InitialState) -> &Vec<f64>| {
            let reached = |outcome: &Result<ensemble::Outcome, String>| {
                let state = outcome.as_ref().ok().map(|outcome| of(&outcome.end).clone());
                state.filter(|state| state.len() == n).unwrap_or_else(|| vec![f64::NAN; n])
            };
            outcomes.iter().flat_map(reached).collect()
        };
        all.set_item("q", array(py, ends(|end| &end.q), shape, &[n])?)?;
        all.set_item("v", array(py, ends(|end| &end.v), shape, &[n])?)?;
        let status = |outcome| failure(outcome).unwrap_or_else(|| "done".to_owned());
        all.set_item("status", outcomes.iter().map(status).collect::<Vec<_>>())?;
        let cautions =
            outcomes.iter().map(|outcome| outcome.as_ref().map_or_else(|_| String::new(), |of| of.cautions.join("; ")));
        all.set_item("cautions", cautions.collect::<Vec<_>>())?;
        let taken = |outcome: &Result<ensemble::Outcome, String>| {
            outcome.as_ref().ok()?.run.as_ref().ok().map(|run| run.statistics.steps as f64)
        };
        let steps = outcomes.iter().map(|outcome| taken(outcome).unwrap_or(f64::NAN));
        all.set_item("steps", array(py, steps.collect(), shape, &[])?)?;
        all.set_item("shape", shape.clone())?;
        Ok(all.into())
    }
}

impl Crane {
    /// Cases over the common axes of parameters, starts and inputs, and those that cannot be computed.
    pub fn cases(
        &self,
        q: Given<'_>,
        v: Given<'_>,
        inputs: Option<Dict<'_, Option<hints::ArrayLike>>>,
        invalid: Invalid,
    ) -> PyResult<(Vec<usize>, Vec<Case>, Vec<BadRow>)> {
        let description = self.live.description();
        let [t, q, v, a] = self.read(StateArguments { q, v, ..StateArguments::default() })?;
        let mut changed: Vec<(usize, String, Option<Argument>)> = Vec::new();
        for (name, value) in inputs.iter().flat_map(|inputs| inputs.iter()) {
            let name: String = name.extract()?;
            let index = input_index(description, &name)?;
            let (label, unit) = (format!("inputs['{name}']"), &description.inputs[index].unit);
            let values = if value.is_none() { None } else { Some(Argument::scalars_in(unit, &label, &value)?) };
            changed.push((index, label, values));
        }
        let mut all = vec![("t", &t), ("q", &q), ("v", &v), ("a", &a), ("the parameters", &self.parameters)];
        let first_input = all.len();
        all.extend(changed.iter().filter_map(|(_, name, values)| Some((name.as_str(), values.as_ref()?))));
        let joined = Joined::new(&all)?;
        let bad = self.bad_rows(&joined, invalid)?;
        let n = self.live.size();
        let case = |row: usize| {
            let mut inputs: Vec<Option<f64>> = Vec::new();
            if !changed.is_empty() {
                inputs.extend((0..description.inputs.len()).map(|index| self.live.input(index)));
            }
            let mut values = first_input..;
            for (index, _, given) in &changed {
                inputs[*index] = given.as_ref().zip(values.next()).map(|(_, index)| joined.row(index, 1, row)[0]);
            }
            let state = |given: bool, index: usize| given.then(|| joined.row(index, n, row).to_vec());
            Case {
                parameters: joined.row(4, self.parameters.width, row).to_vec(),
                inputs,
                q: state(q.width > 0, 1),
                v: state(v.width > 0, 2),
            }
        };
        Ok((joined.shape.clone(), (0..joined.rows()).map(case).collect(), bad))
    }
}
