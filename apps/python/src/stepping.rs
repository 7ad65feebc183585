//! Motions that are advanced from outside, one or many: each with its own parameters, state and inputs.

use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

use crane_live::{Hold, SteeredMotion};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{Sample, Settings, Stopped};
use crane_model::force_states::{self, ForceStates};
use crane_model::runs::ensemble::Case;
use crane_model::runs::{Reason, Start};
use crane_model::{StateAt, Text};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Argument, array, fixed};
use crate::crane::Crane;
use crate::mistakes::{BadRow, Invalid, describe};
use crate::motion::{Timing, raised, statistics, unless};
use crate::parallel::map_rows;
use crate::types::{Array, ArrayLike, Dict, Given, Keys, Numbers, hints};

/// A motion of one crane, and why it ended if it did.
struct SteppedCase {
    motion: SteeredMotion,
    failed: Option<Failure>,
}

/// Why a motion ended.
enum Failure {
    Stopped(Stopped),
    Interrupted,
}

impl Failure {
    fn reason(&self) -> String {
        match self {
            Failure::Stopped(stopped) => stopped.to_string(),
            Failure::Interrupted => "interrupted".to_owned(),
        }
    }
}

/// Motions of cranes of one spec; each continues with the history of its method.
#[pyclass(frozen, module = "crane._native")]
pub struct Motions {
    /// The cranes' name, and numbers of their coordinates and of the states of their forces.
    name: Text,
    n: usize,
    states: usize,
    /// Names and units of its inputs.
    inputs: Vec<(Text, Text)>,
    rows: Vec<Mutex<SteppedCase>>,
}

/// New values of inputs: index, and values or `None` for that of the spec, over (steps, rows).
type Changes = Vec<(usize, Option<Vec<f64>>)>;
/// Times, poses, rates, states of forces, and work.
type States<'py> = (Numbers<'py>, Numbers<'py>, Numbers<'py>, Numbers<'py>, Numbers<'py>);

#[pymethods]
impl Crane {
    /// Motions from a time, s, for every row of parameters, starts and inputs; from their equilibria at rest unless q and v are given. `marks`: what events of
    /// earlier motions have done.
    #[pyo3(name = "_motions", signature = (timing, audit, t, q=None, v=None, x=Vec::new(), inputs=None, marks=None))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn motions(
        &self,
        py: Python<'_>,
        timing: Keys<Timing>,
        audit: bool,
        t: f64,
        q: Given<'_>,
        v: Given<'_>,
        x: Vec<f64>,
        inputs: Option<Dict<'_, Option<hints::ArrayLike>>>,
        marks: Option<Vec<f64>>,
    ) -> PyResult<Motions> {
        let settings = self.settings_of_steps(&timing, audit)?;
        if !t.is_finite() {
            return Err(PyValueError::new_err(format!("t is {t}, not a finite number")));
        }
        let (description, states) = (self.live.description(), ForceStates::new(self.live.description()).len());
        if let Some(wrong) = force_states::impossible(description, &x) {
            return Err(PyValueError::new_err(wrong));
        }
        if !x.is_empty() && x.len() != states {
            return Err(PyValueError::new_err(format!(
                "x has {} numbers: the crane has {states} such states",
                x.len()
            )));
        }
        let (shape, cases, _) = self.cases(q, v, inputs, Invalid::Raise)?;
        let begin = |case: &Case| {
            let mut crane = self.live.clone();
            crane.set_parameters(&case.parameters).map_err(|refused| PyValueError::new_err(refused.to_string()))?;
            for (index, input) in case.inputs.iter().enumerate() {
                crane.set_input(index, *input);
            }
            let mut start =
                Start::with(&crane, t, case.q.as_deref(), case.v.as_deref()).map_err(|failed| raised(&failed))?;
            if !x.is_empty() {
                start.x.clone_from(&x);
            }
            SteeredMotion::new(&crane, t, &start.state, &settings, marks.as_deref())
                .map_err(|stopped| failed(stopped, &description.name))
        };
        let begun = map_rows(py, cases.len(), |row, _| begin(&cases[row]))?;
        let with_place = |(row, begun): (usize, PyResult<SteeredMotion>)| {
            begun.map_err(|error| if shape.is_empty() { error } else { in_row(py, &error, row, &shape) })
        };
        let begun = begun.into_iter().enumerate().map(with_place).collect::<PyResult<Vec<_>>>()?;
        Ok(self.stepping(begun))
    }

    /// The motions from which these memories are: they go on with the same numbers, to the last bit.
    #[pyo3(name = "_recalled")]
    fn recalled(
        &self,
        py: Python<'_>,
        timing: Keys<Timing>,
        audit: bool,
        memories: Vec<Vec<f64>>,
    ) -> PyResult<Motions> {
        let settings = self.settings_of_steps(&timing, audit)?;
        let recalled = map_rows(py, memories.len(), |row, _| {
            let crane = self.of_row(row.min(self.parameters.rows().saturating_sub(1)));
            SteeredMotion::recalled(&crane, &settings, &memories[row])
        })?;
        let recalled: Option<Vec<_>> = recalled.into_iter().collect();
        let name = &self.live.description().name;
        let wrong = || PyValueError::new_err(format!("this is not a saved motion of {name}, or of another version"));
        Ok(self.stepping(recalled.ok_or_else(wrong)?))
    }
}

impl Crane {
    fn stepping(&self, motions: Vec<SteeredMotion>) -> Motions {
        let description = self.live.description();
        Motions {
            name: description.name.clone(),
            n: self.live.size(),
            states: ForceStates::new(description).len(),
            inputs: description.inputs.iter().map(|info| (info.name.clone(), info.unit.clone())).collect(),
            rows: motions.into_iter().map(|motion| Mutex::new(SteppedCase { motion, failed: None })).collect(),
        }
    }

    fn settings_of_steps(&self, timing: &Timing, audit: bool) -> PyResult<Settings> {
        let settings = timing.settings(self.live.description())?;
        Ok(Settings { duration: f64::INFINITY, most_steps: usize::MAX, audit, ..settings })
    }
}

/// An exception with the row that it concerns.
fn in_row(py: Python<'_>, error: &PyErr, row: usize, shape: &[usize]) -> PyErr {
    let reason = error.value(py).to_string();
    PyErr::from_type(error.get_type(py), describe(&BadRow { row, reason }, shape))
}

#[pymethods]
impl Motions {
    fn __len__(&self) -> usize {
        self.rows.len()
    }

    /// Advances all by `dt`, s, several times, with new values of inputs by name: numbers, arrays (rows) or (steps, rows), or None for that of
    /// the spec. Returns times (steps, rows), and poses and rates (steps, rows, n); rows that fail stay at their last state.
    #[pyo3(signature = (dt, steps, inputs, linear))]
    fn advance<'py>(
        &self,
        py: Python<'py>,
        dt: f64,
        steps: usize,
        inputs: Dict<'py>,
        linear: bool,
    ) -> PyResult<(Numbers<'py>, Numbers<'py>, Numbers<'py>)> {
        let (changes, count) = (self.changes(&inputs, steps)?, self.rows.len());
        let paths = self.paths(py, dt, steps, &changes, linear)?;
        let (mut t, mut q, mut v) = (Vec::new(), Vec::new(), Vec::new());
        let width = 2 * self.n + 1;
        for step in 0..steps {
            for path in &paths {
                let [now, state @ ..] = &path[step * width..(step + 1) * width] else { continue };
                let (pose, rates) = state.split_at(self.n);
                t.push(*now);
                q.extend_from_slice(pose);
                v.extend_from_slice(rates);
            }
        }
        let shape = [steps, count];
        let numbers = |numbers, of_row: &[usize]| array(py, numbers, &shape, of_row).map(fixed);
        Ok((numbers(t, &[])?, numbers(q, &[self.n])?, numbers(v, &[self.n])?))
    }

    /// Advances all by `dt`, s, with new values, (rows, inputs), of inputs by their places in the spec. Returns times, poses and rates, (rows, 1 + 2 n): as
    /// `advance` does, for callers to whom its arrays would take longer than the step.
    fn steer<'py>(
        &self,
        py: Python<'py>,
        dt: f64,
        places: Vec<usize>,
        values: ArrayLike<'py>,
        linear: bool,
    ) -> Array<'py> {
        let count = self.rows.len();
        let argument = Argument::of_width("values", &values, places.len(), "one for each input")?;
        if argument.shape != [count] || argument.numbers.iter().any(|number| !number.is_finite()) {
            return Err(PyValueError::new_err(format!("values: give {count} rows of finite numbers")));
        }
        if let Some(unknown) = places.iter().find(|index| **index >= self.inputs.len()) {
            return Err(PyIndexError::new_err(format!("input {unknown}: there are {}", self.inputs.len())));
        }
        let column = |j: usize| argument.numbers.iter().skip(j).step_by(places.len()).copied().collect();
        let changes: Changes = places.iter().enumerate().map(|(j, index)| (*index, Some(column(j)))).collect();
        let rows = self.paths(py, dt, 1, &changes, linear)?;
        array(py, rows.concat(), &[count], &[1 + 2 * self.n]).map(fixed)
    }

    /// States reached: times (rows), poses and rates (rows, n), states of forces (rows, states), and work of the drives, dissipated energy and
    /// work of the loads since the start, J, (rows, 3).
    fn states<'py>(&self, py: Python<'py>) -> PyResult<States<'py>> {
        let mut all: [Vec<f64>; 5] = Default::default();
        for row in 0..self.rows.len() {
            let now = self.row(row);
            let Sample { state: StateAt { t, q, v, x }, work, dissipated, load_work, .. } = now.motion.sample();
            for (all, own) in all.iter_mut().zip([&[t], q, v, x, &[work, dissipated, load_work]]) {
                all.extend_from_slice(own);
            }
        }
        let of_rows = |numbers, width: &[usize]| array(py, numbers, &[self.rows.len()], width).map(fixed);
        let [t, q, v, x, work] = all;
        let (t, q, v) = (of_rows(t, &[])?, of_rows(q, &[self.n])?, of_rows(v, &[self.n])?);
        Ok((t, q, v, of_rows(x, &[self.states])?, of_rows(work, &[3])?))
    }

    /// The live parameters, (rows, parameters), which events may have set.
    fn parameters<'py>(&self, py: Python<'py>) -> Array<'py> {
        let of_row = |row: usize| {
            let now = self.row(row);
            let crane = now.motion.crane();
            crane.parameter_values()
        };
        let rows: Vec<Vec<f64>> = (0..self.rows.len()).map(of_row).collect();
        let width = rows.first().map_or(0, Vec::len);
        array(py, rows.concat(), &[self.rows.len()], &[width]).map(Numbers::from)
    }

    /// What events of a row have done, by name: the time of each, s; 0 if it is still to come, NaN if its condition has to cease before, −1 if its time was
    /// before the start.
    fn marks<'py>(&self, py: Python<'py>, row: usize) -> PyResult<Dict<'py, hints::Float>> {
        self.check_row(row)?;
        let (now, all) = (self.row(row), PyDict::new(py));
        let events = &now.motion.crane().description().events;
        events.iter().zip(now.motion.marks()).try_for_each(|(event, mark)| all.set_item(&*event.name, mark))?;
        Ok(all.into())
    }

    /// Why each row ended; None for those that go on.
    fn failures(&self) -> Vec<Option<String>> {
        (0..self.rows.len()).map(|row| self.row(row).failed.as_ref().map(Failure::reason)).collect()
    }

    /// Raises why the first row that ended has ended.
    fn check(&self) -> PyResult<()> {
        for row in 0..self.rows.len() {
            match &self.row(row).failed {
                Some(Failure::Stopped(stopped)) => return Err(failed(stopped.clone(), &self.name)),
                Some(Failure::Interrupted) => {
                    return Err(PyValueError::new_err(format!("row [{row}] was interrupted: reset it")));
                }
                None => {}
            }
        }
        Ok(())
    }

    /// Whether an input can be set, and released, while the motions go on: it does not follow a motion of the spec.
    fn can_set(&self, name: &str) -> bool {
        let index = self.inputs.iter().position(|(known, _)| **known == *name);
        index.is_some_and(|index| (0..self.rows.len()).all(|row| self.row(row).motion.can_set(index)))
    }

    /// Steps, rejections, evaluations and factorisations so far, of a row.
    fn statistics<'py>(&self, py: Python<'py>, row: usize) -> PyResult<Dict<'py, hints::Int>> {
        self.check_row(row)?;
        statistics(py, &self.row(row).motion.run().statistics)
    }

    /// All numbers from which the motion of a row can be made again.
    fn memory<'py>(&self, py: Python<'py>, row: usize) -> Array<'py> {
        self.check_row(row)?;
        let memory = self.row(row).motion.memory();
        let length = memory.len();
        array(py, memory, &[], &[length]).map(fixed)
    }

    /// Exchanges rows for those of other motions of the same cranes, one after the other.
    fn put(&self, rows: Vec<usize>, others: &Motions) -> PyResult<()> {
        rows.iter().try_for_each(|row| self.check_row(*row))?;
        if std::ptr::eq(self, others)
            || rows.len() != others.rows.len()
            || (self.n, self.states) != (others.n, others.states)
        {
            return Err(PyValueError::new_err("other motions have other cranes, or another number of rows"));
        }
        for (row, other) in rows.into_iter().zip(0..) {
            std::mem::swap(&mut *self.row(row), &mut *others.row(other));
        }
        Ok(())
    }
}

impl Motions {
    fn row(&self, row: usize) -> std::sync::MutexGuard<'_, SteppedCase> {
        self.rows[row].lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Time, pose and rates of every row after each of several steps of `dt`, s; rows that fail stay at their last state.
    fn paths(&self, py: Python<'_>, dt: f64, steps: usize, changes: &Changes, linear: bool) -> PyResult<Vec<Vec<f64>>> {
        let (least, greatest) = Settings::TIMES;
        if !(least..=greatest).contains(&dt) {
            return Err(PyValueError::new_err(format!("dt={dt}: write a number from {least:e} to {greatest:e}, in s")));
        }
        let (count, hold) = (self.rows.len(), if linear { Hold::Linear } else { Hold::Constant });
        map_rows(py, count, |row, off| {
            let mut now = self.row(row);
            let SteppedCase { motion, failed } = &mut *now;
            let mut path = Vec::with_capacity(steps * (2 * self.n + 1));
            for step in 0..steps {
                if failed.is_none() {
                    let value = |(index, values): &(usize, Option<Vec<f64>>)| {
                        (*index, values.as_ref().map(|values| values[step * count + row]))
                    };
                    *failed = match motion.advance(dt, changes.iter().map(value), hold, &mut |_| unless(off())) {
                        Ok(ControlFlow::Continue(())) => None,
                        Ok(ControlFlow::Break(())) => Some(Failure::Interrupted),
                        Err(stopped) => Some(Failure::Stopped(stopped)),
                    };
                }
                let StateAt { t, q, v, .. } = motion.sample().state;
                path.push(t);
                path.extend_from_slice(q);
                path.extend_from_slice(v);
            }
            path
        })
    }

    fn check_row(&self, row: usize) -> PyResult<()> {
        let count = self.rows.len();
        if row < count { Ok(()) } else { Err(PyIndexError::new_err(format!("row {row}: there are {count}"))) }
    }

    /// Values over (steps, rows) of inputs by name.
    fn changes(&self, inputs: &Bound<'_, PyDict>, steps: usize) -> PyResult<Changes> {
        let (count, mut changes) = (self.rows.len(), Changes::new());
        for (name, value) in inputs {
            let name: String = name.extract()?;
            let index = self.inputs.iter().position(|(known, _)| **known == *name);
            let index = index.ok_or_else(|| PyValueError::new_err(format!("{} has no input `{name}`", self.name)))?;
            if value.is_none() {
                changes.push((index, None));
                continue;
            }
            let label = format!("inputs['{name}']");
            let argument = Argument::scalars_in(&self.inputs[index].1, &label, &value)?;
            if let Some(wrong) = argument.numbers.iter().find(|number| !number.is_finite()) {
                return Err(PyValueError::new_err(format!("{label} is {wrong}, not a finite number")));
            }
            let numbers = match argument.shape.as_slice() {
                [] | [1] => vec![argument.numbers[0]; steps * count],
                [rows] if *rows == count => argument.numbers.repeat(steps),
                [many, rows] if (*many, *rows) == (steps, count) => argument.numbers,
                shape => {
                    return Err(PyValueError::new_err(format!(
                        "{label} has shape {shape:?}: give one number, {count} of them, or ({steps}, {count})"
                    )));
                }
            };
            changes.push((index, Some(numbers)));
        }
        Ok(changes)
    }
}

/// The failure of a motion, as an exception.
fn failed(stopped: Stopped, name: &Text) -> PyErr {
    raised(&Reason::Stopped { stopped, near_singular: None, limit: None }.for_crane(name))
}
