//! Modes and stability about poses at rest, small motions about any motion, and steady motions, row by row.

use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::Method;
use crane_model::modes::{DampedMode, Held, Mode, NoModes, damped, steady, undamped};
use crane_model::runs::limiting_modes;
use crane_model::stability::{cause, limit};
use pyo3::exceptions::{PyArithmeticError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::evaluation::{Moment, StateArguments};
use crate::mistakes::{BadRow, Invalid, describe, warn_of_rows};
use crate::parallel::map_rows;
use crate::types::{Array, ArrayLike, Dict, Given};

/// Modes about a pose.
struct Modes {
    undamped: Vec<Mode>,
    damped: Vec<DampedMode>,
}

impl Modes {
    fn new(crane: &LiveCrane, q: &[f64]) -> Result<Self, NoModes> {
        let motions = (crane as &dyn DynCrane).small_motions_at(q);
        Ok(Self { undamped: undamped(&motions)?, damped: damped(&motions)? })
    }
}

/// The largest stable step of each method about a pose, s, and what limits it; infinite if nothing does.
fn stable_steps(crane: &LiveCrane, q: &[f64]) -> Result<Vec<(f64, String)>, NoModes> {
    let crane: &dyn DynCrane = crane;
    let damped = damped(&crane.small_motions_at(q))?;
    let limiting = limiting_modes(crane, 0.0, q, &damped);
    let step = |method: &Method| match limit(&limiting, &method.stability()) {
        Some(limit) => (limit.step, cause(crane.description(), &limit.mode)),
        None => (f64::INFINITY, "nothing".to_owned()),
    };
    Ok(Method::ALL.iter().map(step).collect())
}

#[pymethods]
impl Crane {
    /// (..., 3, n, n): A, K and D of small motions about motions; `linearise` names them.
    #[pyo3(name = "_small_motions_about", signature = (q, v, a, t=None, *, invalid="raise"))]
    fn small_motions_about<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        v: ArrayLike<'py>,
        a: ArrayLike<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        self.refuse_motions()?;
        let n = self.live.size();
        self.one_by_one(
            py,
            StateArguments { t, q: Some(q), v: Some(v), a: Some(a) },
            (&[3, n, n], 0),
            invalid,
            |crane, at, out| {
                let motions = (crane as &dyn DynCrane).linearise_motion(at.t, [&at.q, &at.v, &at.a]);
                for (out, matrix) in out.chunks_exact_mut(n * n).zip(motions) {
                    // Row by row.
                    out.copy_from_slice(matrix.transpose().as_slice());
                }
            },
        )
    }

    /// (..., 3 n + 3): poses, rates and efforts of steady motions, drift, acceleration, part reached; `steady_motion` names them.
    /// held: coordinates, and whether a position is given; their rates and positions are at the same indices in `rates` and `positions`.
    #[pyo3(name = "_steady_motion", signature = (held, start, rates, positions, t=None, *, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn steady_rows<'py>(
        &self,
        py: Python<'py>,
        held: Vec<(usize, bool)>,
        start: ArrayLike<'py>,
        rates: ArrayLike<'py>,
        positions: ArrayLike<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        self.refuse_motions()?;
        let n = self.live.size();
        if let Some((beyond, _)) = held.iter().find(|(coordinate, _)| *coordinate >= n) {
            return Err(PyValueError::new_err(format!("coordinate {beyond}: the crane has {n}, counted from 0")));
        }
        let find = |crane: &LiveCrane, at: &Moment, out: &mut [f64]| {
            let of = |&(coordinate, positioned): &(usize, bool)| Held {
                coordinate,
                position: positioned.then(|| at.a[coordinate]),
                rate: at.v[coordinate],
            };
            let held: Vec<Held> = held.iter().map(of).collect();
            match steady(crane, at.t, &at.q, &held) {
                Ok(steady) => {
                    let numbers =
                        [steady.q, steady.v, steady.efforts, vec![steady.drift, steady.acceleration, 1.0]].concat();
                    out.copy_from_slice(&numbers);
                }
                Err(refused) => {
                    out.fill(f64::NAN);
                    out[3 * n + 2] = refused.reached;
                }
            }
        };
        let state = StateArguments { t, q: Some(start), v: Some(rates), a: Some(positions) };
        self.one_by_one(py, state, (&[3 * n + 3], 0), invalid, find)
    }

    /// Modes about poses, over parameters and poses: `Crane.modes` names them.
    #[pyo3(name = "_modes", signature = (q, invalid="raise"))]
    fn mode_rows<'py>(&self, py: Python<'py>, q: ArrayLike<'py>, invalid: &str) -> PyResult<Dict<'py>> {
        let (shape, found) = self.about_poses(py, &q, invalid, Modes::new)?;
        let count = |of: fn(&Modes) -> usize| found.iter().flatten().map(of).max().unwrap_or(0);
        let (most, most_damped) = (count(|modes| modes.undamped.len()), count(|modes| modes.damped.len()));
        let n = self.live.size();
        let (mut squares, mut shapes, mut real, mut imaginary) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for found in &found {
            for index in 0..most {
                let mode = found.as_ref().and_then(|modes| modes.undamped.get(index));
                squares.push(mode.map_or(f64::NAN, |mode| mode.omega_squared));
                match mode {
                    Some(mode) => shapes.extend_from_slice(mode.shape.as_slice()),
                    None => shapes.extend(std::iter::repeat_n(f64::NAN, n)),
                }
            }
            for index in 0..most_damped {
                let mode = found.as_ref().and_then(|modes| modes.damped.get(index));
                real.push(mode.map_or(f64::NAN, |mode| mode.eigenvalue.re));
                imaginary.push(mode.map_or(f64::NAN, |mode| mode.eigenvalue.im));
            }
        }
        let description = self.live.description();
        let names = |indices: &[usize]| -> Vec<String> {
            indices.iter().map(|&index| description.coordinates[index].name.to_string()).collect()
        };
        let dominating = |of: &dyn Fn(&Modes) -> Vec<Vec<String>>| -> Vec<Vec<Vec<String>>> {
            found.iter().map(|found| found.as_ref().map_or_else(Vec::new, of)).collect()
        };
        let of_undamped = |modes: &Modes| modes.undamped.iter().map(|mode| names(&mode.dominating)).collect();
        let of_damped = |modes: &Modes| modes.damped.iter().map(|mode| names(&mode.dominating)).collect();
        let all = PyDict::new(py);
        all.set_item("omega_squared", array(py, squares, &shape, &[most])?)?;
        all.set_item("shapes", array(py, shapes, &shape, &[most, n])?)?;
        all.set_item("real", array(py, real, &shape, &[most_damped])?)?;
        all.set_item("imaginary", array(py, imaginary, &shape, &[most_damped])?)?;
        all.set_item("dominating", dominating(&of_undamped))?;
        all.set_item("damped_dominating", dominating(&of_damped))?;
        all.set_item("shape", shape)?;
        Ok(all.into())
    }

    /// The largest stable step of each method about poses, s, and what limits it: `Crane.stability` names them.
    #[pyo3(name = "_stable_steps", signature = (q, invalid="raise"))]
    fn stable_step_rows<'py>(&self, py: Python<'py>, q: ArrayLike<'py>, invalid: &str) -> PyResult<Dict<'py>> {
        let (shape, found) = self.about_poses(py, &q, invalid, stable_steps)?;
        let steps = PyDict::new(py);
        for (index, method) in Method::ALL.iter().enumerate() {
            let row = |found: &Option<Vec<(f64, String)>>| match found {
                Some(steps) => steps[index].clone(),
                None => (f64::NAN, String::new()),
            };
            let (step, why): (Vec<f64>, Vec<String>) = found.iter().map(row).unzip();
            steps.set_item(method.name(), (array(py, step, &shape, &[])?, why))?;
        }
        let all = PyDict::new(py);
        all.set_item("steps", steps)?;
        all.set_item("shape", shape)?;
        Ok(all.into())
    }
}

impl Crane {
    /// What `work` finds about poses at rest, row by row on all threads, with the leading axes; `None` for rows that are not allowed or
    /// have no modes.
    fn about_poses<T: Send>(
        &self,
        py: Python<'_>,
        q: &Bound<'_, PyAny>,
        invalid: &str,
        work: impl Fn(&LiveCrane, &[f64]) -> Result<T, NoModes> + Sync,
    ) -> PyResult<(Vec<usize>, Vec<Option<T>>)> {
        let invalid = Invalid::named(invalid)?;
        let none = Argument::none();
        let q = Argument::coordinates("q", q, self.live.description())?;
        let joined =
            Joined::new(&[("t", &none), ("q", &q), ("v", &none), ("a", &none), ("the parameters", &self.parameters)])?;
        let wrong = self.bad_rows(&joined, invalid)?;
        let n = self.live.size();
        let found = map_rows(py, joined.rows(), |row, _| {
            if let Some(wrong) = wrong.iter().find(|wrong| wrong.row == row) {
                return Err(wrong.reason.clone());
            }
            let found = work(&self.of_joined_row(&joined, row), joined.row(1, n, row));
            found.map_err(|refused| refused.to_string())
        })?;
        let reason =
            |(row, found): (usize, &Result<T, String>)| Some(BadRow { row, reason: found.as_ref().err()?.clone() });
        let bad: Vec<BadRow> = found.iter().enumerate().filter_map(reason).collect();
        if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
            return Err(PyArithmeticError::new_err(describe(first, &joined.shape)));
        }
        warn_of_rows(py, &bad, &joined.shape)?;
        Ok((joined.shape.clone(), found.into_iter().map(Result::ok).collect()))
    }

    /// Refuses cranes whose forces have states of their own: small motions about a motion depend on them.
    fn refuse_motions(&self) -> PyResult<()> {
        if self.live.description().has_hidden_forces() {
            let (name, states) = (&self.live.description().name, self.force_states());
            return Err(PyValueError::new_err(format!(
                "forces of {name} follow from {states}, which are states of a run: use modes(q), about poses at rest, or state_space"
            )));
        }
        if let Some(joint) = self.live.loop_joints().first() {
            return Err(PyValueError::new_err(format!(
                "{} has {}: use modes(q), about poses at rest, or state_space{}",
                self.live.description().name,
                joint.closes(),
                joint.remedy()
            )));
        }
        Ok(())
    }
}
