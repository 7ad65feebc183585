//! Modes and stability about poses at rest, small motions about any motion, and steady motions, row by row.

use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, DynLineariseMotion, DynModel};
use crane_model::dynamics::Method;
use crane_model::modes::{DampedMode, Held, Mode, NoModes, damped, steady, undamped};
use crane_model::runs::limiting_modes;
use crane_model::stability::{cause, limit};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::exceptions::{PyArithmeticError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::evaluation::{Given, Moment, State};
use crate::mistakes::{BadRow, Invalid, describe, warn_of_rows};
use crate::parallel::map_rows;

/// Modes of a row.
struct Modes {
    undamped: Vec<Mode>,
    damped: Vec<DampedMode>,
    /// Those that may limit a step.
    limiting: Vec<DampedMode>,
}

impl Modes {
    fn of(crane: &LiveCrane, q: &[f64]) -> Result<Self, NoModes> {
        if !q.iter().all(|x| x.is_finite()) {
            return Err(NoModes::MassMatrix);
        }
        let crane: &dyn DynCrane = crane;
        let motions = crane.small_motions_at(q);
        let damped = damped(&motions)?;
        let limiting = limiting_modes(crane, 0.0, q, &damped);
        Ok(Self { undamped: undamped(&motions)?, damped, limiting })
    }
}

#[pymethods]
impl Crane {
    /// (..., 3, n, n): A, K and D of small motions about motions; `linearise` names them.
    #[pyo3(signature = (q, v, a, t=None, *, invalid="raise"))]
    fn small_motions_about<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        a: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.refuse_force_states()?;
        let n = self.live.size();
        self.one_by_one(py, State { t, q: Some(q), v: Some(v), a: Some(a) }, &[3, n, n], invalid, |crane, at, out| {
            let (mass, rest) = out.split_at_mut(n * n);
            let (stiffness, damping) = rest.split_at_mut(n * n);
            crane.linearise_motion(at.t, [&at.q, &at.v, &at.a], mass, stiffness, damping);
            // Row by row.
            for matrix in [mass, stiffness, damping] {
                for i in 0..n {
                    for j in 0..i {
                        matrix.swap(i * n + j, j * n + i);
                    }
                }
            }
        })
    }

    /// (..., 3 n + 3): poses, rates and efforts of steady motions, drift, acceleration, part reached; `steady_motion` names them.
    /// held: coordinates, and whether a position is given; their rates and positions are at the same indices in `rates` and `positions`.
    #[pyo3(signature = (held, start, rates, positions, t=None, *, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn steady_rows<'py>(
        &self,
        py: Python<'py>,
        held: Vec<(usize, bool)>,
        start: &Bound<'py, PyAny>,
        rates: &Bound<'py, PyAny>,
        positions: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.refuse_force_states()?;
        let n = self.live.size();
        let find = |crane: &LiveCrane, at: &Moment, out: &mut [f64]| {
            let of = |&(coordinate, positioned): &(usize, bool)| Held {
                coordinate,
                position: positioned.then(|| at.a[coordinate]),
                rate: at.v[coordinate],
            };
            let held: Vec<Held> = held.iter().map(of).collect();
            match steady(crane, at.t, &at.q, &held) {
                Ok(found) => {
                    let numbers =
                        [found.q, found.v, found.efforts, vec![found.drift, found.acceleration, 1.0]].concat();
                    out.copy_from_slice(&numbers);
                }
                Err(refused) => {
                    out.fill(f64::NAN);
                    out[3 * n + 2] = refused.reached;
                }
            }
        };
        let state = State { t, q: Some(start), v: Some(rates), a: Some(positions) };
        self.one_by_one(py, state, &[3 * n + 3], invalid, find)
    }

    /// Modes about poses, over parameters and poses, and the largest stable step of each method.
    #[pyo3(signature = (q, invalid="raise"))]
    fn vibrations<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> PyResult<Bound<'py, PyDict>> {
        let invalid = Invalid::named(invalid)?;
        let description = self.live.description();
        let none = Argument { shape: Vec::new(), numbers: Vec::new(), width: 0 };
        let q = Argument::coordinates("q", q, description)?;
        let joined =
            Joined::new(&[("t", &none), ("q", &q), ("v", &none), ("a", &none), ("the parameters", &self.parameters)])?;
        let n = self.live.size();
        let found = map_rows(py, joined.rows(), |row, _| {
            let poses = &joined.arguments[1];
            let first = if poses.len() <= n { 0 } else { row * n };
            Modes::of(&self.of_joined_row(&joined, row), &poses[first..first + n])
        })?;
        let reason = |(row, found): (usize, &Result<Modes, NoModes>)| {
            Some(BadRow { row, reason: found.as_ref().err()?.to_string() })
        };
        let bad: Vec<BadRow> = found.iter().enumerate().filter_map(reason).collect();
        if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
            return Err(PyArithmeticError::new_err(describe(first, &joined.shape)));
        }
        warn_of_rows(py, &bad, &joined.shape)?;
        let undamped = |found: &Result<Modes, NoModes>| found.as_ref().map_or(0, |modes| modes.undamped.len());
        let damped = |found: &Result<Modes, NoModes>| found.as_ref().map_or(0, |modes| modes.damped.len());
        let (most, most_damped) =
            (found.iter().map(undamped).max().unwrap_or(0), found.iter().map(damped).max().unwrap_or(0));

        let (mut squares, mut shapes, mut real, mut imaginary) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for found in &found {
            for index in 0..most {
                let mode = found.as_ref().ok().and_then(|modes| modes.undamped.get(index));
                squares.push(mode.map_or(f64::NAN, |mode| mode.omega_squared));
                match mode {
                    Some(mode) => shapes.extend_from_slice(mode.shape.as_slice()),
                    None => shapes.extend(std::iter::repeat_n(f64::NAN, n)),
                }
            }
            for index in 0..most_damped {
                let eigenvalue =
                    found.as_ref().ok().and_then(|modes| modes.damped.get(index)).map(|mode| mode.eigenvalue);
                real.push(eigenvalue.map_or(f64::NAN, |eigenvalue| eigenvalue.re));
                imaginary.push(eigenvalue.map_or(f64::NAN, |eigenvalue| eigenvalue.im));
            }
        }
        let limits = |method: &Method| -> (Vec<f64>, Vec<String>) {
            let limits = found.iter().map(|found| {
                let limit = limit(&found.as_ref().ok()?.limiting, &method.stability())?;
                Some((limit.step, cause(description, &limit.mode)))
            });
            limits.map(|limit| limit.unwrap_or((f64::INFINITY, "nothing".to_owned()))).unzip()
        };
        let all = PyDict::new(py);
        all.set_item("omega_squared", array(py, squares, &joined.shape, &[most])?)?;
        all.set_item("shapes", array(py, shapes, &joined.shape, &[most, n])?)?;
        all.set_item("real", array(py, real, &joined.shape, &[most_damped])?)?;
        all.set_item("imaginary", array(py, imaginary, &joined.shape, &[most_damped])?)?;
        let names = |indices: &[usize]| -> Vec<String> {
            indices.iter().map(|&index| description.coordinates[index].name.to_string()).collect()
        };
        let of_undamped = |modes: &Modes| modes.undamped.iter().map(|mode| names(&mode.dominating)).collect::<Vec<_>>();
        let of_damped = |modes: &Modes| modes.damped.iter().map(|mode| names(&mode.dominating)).collect::<Vec<_>>();
        let dominating: Vec<_> =
            found.iter().map(|found| found.as_ref().map_or_else(|_| Vec::new(), of_undamped)).collect();
        let damped_dominating: Vec<_> =
            found.iter().map(|found| found.as_ref().map_or_else(|_| Vec::new(), of_damped)).collect();
        all.set_item("dominating", dominating)?;
        all.set_item("damped_dominating", damped_dominating)?;
        let steps = PyDict::new(py);
        for method in &Method::ALL {
            let (step, why) = limits(method);
            steps.set_item(method.name(), (PyArray1::from_vec(py, step), why))?;
        }
        all.set_item("stable_steps", steps)?;
        all.set_item("shape", joined.shape.clone())?;
        Ok(all)
    }
}

impl Crane {
    /// Refuses cranes whose forces have their own states: these do not follow from pose and rates alone.
    fn refuse_force_states(&self) -> PyResult<()> {
        if self.live.description().has_force_states() {
            let message =
                "forces of this crane follow from pressures or bristles, which are states of a run: use modes";
            return Err(PyValueError::new_err(message));
        }
        Ok(())
    }
}
