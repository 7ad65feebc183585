//! Linear models about states, row by row, and margins of loops around them.

use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::linear::{About, Forces, Input, LinearModel, Output, linear_model, outputs};
use crane_model::margins::{self, Loop, Margins, Plant, Term};
use crane_model::nalgebra::{DMatrix, DVector};
use crane_model::results::Column;
use numpy::{PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyArithmeticError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::evaluation::StateArguments;
use crate::mistakes::{BadRow, Invalid, describe, warn_of_numbers, warn_of_rows};
use crate::parallel::map_rows;
use crate::types::{Array, ArrayLike, Dict, Given, Numbers};

/// How the states of forces are found that are not given.
fn forces_named(name: &str) -> PyResult<Forces<'static>> {
    match name {
        "shut" => Ok(Forces::Holding),
        "slightly open" => Ok(Forces::SlightlyOpen),
        other => Err(PyValueError::new_err(format!("valves={other:?}: write \"shut\" or \"slightly open\""))),
    }
}

/// Whether nothing grows, 1 or 0, the rates of a drift of `n` coordinates, and its decay, for each state; NaN where there are none.
fn verdicts(found: &[Result<LinearModel, String>], n: usize) -> [Vec<f64>; 3] {
    let mut verdicts: [Vec<f64>; 3] = Default::default();
    for found in found {
        let stable = found.as_ref().ok().and_then(|model| model.growing().ok());
        verdicts[0].push(stable.map_or(f64::NAN, |growing| if growing.is_none() { 1.0 } else { 0.0 }));
        match found.as_ref().map(|model| &model.drift) {
            Ok(Some(drift)) => {
                verdicts[1].extend(&drift.rates);
                verdicts[2].push(drift.decay);
            }
            none => {
                verdicts[1].extend(std::iter::repeat_n(if none.is_ok() { 0.0 } else { f64::NAN }, n));
                verdicts[2].push(f64::NAN);
            }
        }
    }
    verdicts
}

#[pymethods]
impl Crane {
    /// Linear models about states: `Crane.state_space` makes a `StateSpace` of them.
    #[pyo3(name = "_state_space", signature = (q, v=None, t=None, x=None, *, valves="shut", steady=false, inputs=None, outputs=None, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn state_space_rows<'py>(
        &self,
        py: Python<'py>,
        q: ArrayLike<'py>,
        v: Given<'py>,
        t: Given<'py>,
        x: Given<'py>,
        valves: &str,
        steady: bool,
        inputs: Option<Vec<String>>,
        outputs: Option<Vec<String>>,
        invalid: &str,
    ) -> PyResult<Dict<'py>> {
        let (invalid, forces) = (Invalid::named(invalid)?, forces_named(valves)?);
        let [t, q, v, _] = self.read(StateArguments { t, q: Some(q), v, a: None })?;
        let x = self.read_states(x)?;
        let none = Argument::none();
        let joined = Joined::new(&[
            ("t", &t),
            ("q", &q),
            ("v", &v),
            ("a", &none),
            ("the parameters", &self.parameters),
            ("x", &x),
        ])?;
        let mut bad = self.bad_rows(&joined, invalid)?;
        let (inputs, outputs) = (self.inputs_named(inputs)?, self.outputs_named(outputs)?);
        let n = self.live.size();
        let rest = vec![0.0; n];
        let found =
            map_rows(py, joined.rows(), |row, _| {
                if let Some(wrong) = bad.iter().find(|wrong| wrong.row == row) {
                    return Err(wrong.reason.clone());
                }
                let [t, q, v] = [(0, 1), (1, n), (2, n)].map(|(index, size)| joined.row(index, size, row));
                let x = joined.row(5, x.width, row);
                let about = About {
                    t: t.first().copied().unwrap_or(0.0),
                    q,
                    v: if v.is_empty() { &rest } else { v },
                    x: if x.is_empty() { forces } else { Forces::Given(x) },
                    steady,
                };
                let model = linear_model(&self.of_joined_row(&joined, row), &about, &inputs, &outputs);
                match model.map_err(|none| none.to_string())? {
                    model if model.a.iter().all(|number| number.is_finite()) => Ok(model),
                    _ => Err("A is not finite: rates are too large, or a linkage cannot be assembled in this pose"
                        .to_owned()),
                }
            })?;
        bad.clear();
        let refused = |(row, found): (usize, &Result<LinearModel, String>)| {
            found.as_ref().err().map(|reason| BadRow { row, reason: reason.clone() })
        };
        bad.extend(found.iter().enumerate().filter_map(refused));
        if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
            return Err(PyValueError::new_err(describe(first, &joined.shape)));
        }
        warn_of_rows(py, &bad, &joined.shape)?;
        let Some(model) = found.iter().flatten().next() else {
            let why = bad.first().map_or("there are no states", |bad| bad.reason.as_str());
            return Err(PyValueError::new_err(format!("there is no linear model: {why}")));
        };
        if found.iter().flatten().any(|other| other.states != model.states) {
            return Err(PyValueError::new_err(
                "the loops of the crane have other independent coordinates at some of these states: ask about one at a time",
            ));
        }
        let all = PyDict::new(py);
        for (name, of) in [
            ("A", (|model| &model.a) as fn(&LinearModel) -> &DMatrix<f64>),
            ("B", |model| &model.b),
            ("C", |model| &model.c),
            ("D", |model| &model.d),
        ] {
            let (rows, columns) = of(model).shape();
            let mut numbers = Vec::with_capacity(found.len() * rows * columns);
            for found in &found {
                match found {
                    Ok(model) => numbers.extend(of(model).transpose().iter()),
                    Err(_) => numbers.extend(std::iter::repeat_n(f64::NAN, rows * columns)),
                }
            }
            all.set_item(name, array(py, numbers, &joined.shape, &[rows, columns])?)?;
        }
        let n = model.coordinates().len();
        let [stable, drift, decay] = verdicts(&found, n);
        all.set_item("stable", array(py, stable, &joined.shape, &[])?)?;
        all.set_item("drift", array(py, drift, &joined.shape, &[n])?)?;
        all.set_item("decay", array(py, decay, &joined.shape, &[])?)?;
        for (name, columns) in [("states", &model.states), ("inputs", &model.inputs), ("outputs", &model.outputs)] {
            let (names, units): (Vec<&str>, Vec<&str>) =
                columns.iter().map(|Column { name, unit, .. }| (name.as_str(), unit.as_str())).unzip();
            all.set_item(name, names)?;
            all.set_item(format!("{}_units", &name[..name.len() - 1]), units)?;
        }
        Ok(all.into())
    }

    /// The inputs that a loop on something moves, and the powers of s by which each follows; then the coordinate of its drive.
    #[pyo3(name = "_acting")]
    fn acting(&self, on: &str) -> PyResult<(Vec<String>, Vec<i32>, Option<String>)> {
        let description = self.live.description();
        let acting = margins::Acting::named(on, description).ok_or_else(|| {
            let known = margins::Acting::names(description).join(", ");
            PyValueError::new_err(format!("there is nothing `{on}` on which a loop could act; there are {known}"))
        })?;
        let inputs = acting.inputs();
        let names = inputs.iter().map(|(input, _)| input.column(description).name).collect();
        let powers = inputs.iter().map(|(_, power)| *power).collect();
        Ok((names, powers, acting.coordinate(description).map(str::to_owned)))
    }
}

impl Crane {
    /// Inputs by name, all of the spec unless given.
    fn inputs_named(&self, names: Option<Vec<String>>) -> PyResult<Vec<Input>> {
        let description = self.live.description();
        let Some(names) = names else { return Ok((0..description.inputs.len()).map(Input::Spec).collect()) };
        let known = || Input::all(description).into_iter().map(|input| input.column(description).name);
        let named = |name: &String| {
            Input::named(name, description).ok_or_else(|| {
                let known: Vec<String> = known().collect();
                let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
                PyValueError::new_err(format!("there is no input '{name}': write one of {known}"))
            })
        };
        names.iter().map(named).collect()
    }

    /// Outputs by name: coordinates, rates and positions of points unless given.
    fn outputs_named(&self, names: Option<Vec<String>>) -> PyResult<Vec<Output>> {
        let (all, n) = (outputs(&self.live as &dyn DynCrane), self.live.size());
        let Some(names) = names else {
            let points = &self.live.description().points;
            let is_point = |name: &str| {
                name.rsplit_once('_').is_some_and(|(point, axis)| {
                    matches!(axis, "x" | "y" | "z") && points.iter().any(|known| known.as_str() == point)
                })
            };
            let shown = |(index, output): &(usize, Output)| *index < 2 * n || is_point(&output.column.name);
            return Ok(all.into_iter().enumerate().filter(shown).map(|(_, output)| output).collect());
        };
        let named = |name: &String| {
            all.iter().find(|output| output.column.name == *name).cloned().ok_or_else(|| {
                let known: Vec<&str> = all.iter().map(|output| output.column.name.as_str()).collect();
                PyValueError::new_err(format!("there is no output '{name}': write one of {}", known.join(", ")))
            })
        };
        names.iter().map(named).collect()
    }
}

/// (rows, 11): margins of a loop around plants, row by row: `Crane.margins` names them; NaN where there are none.
///
/// a: (rows, n, n), b: (rows, n, k), c: (rows, n), d: (rows, k): state matrices, what follows the input with these powers of s, the output.
/// numbers: p, i, d, filter, both times of a lead, delay, lag.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
pub fn loop_margins<'py>(
    py: Python<'py>,
    a: Numbers<'py>,
    b: Numbers<'py>,
    c: Numbers<'py>,
    d: Numbers<'py>,
    powers: Vec<i32>,
    numbers: [f64; 8],
    invalid: &str,
) -> Array<'py> {
    const WIDTH: usize = 11;
    let invalid = Invalid::named(invalid)?;
    let (rows, n, k) = (a.shape()[0], a.shape()[1], powers.len());
    let [a, b, c, d] = [a.to_vec()?, b.to_vec()?, c.to_vec()?, d.to_vec()?];
    let [p, i, derivative, filter, above, below, delay, lag] = numbers;
    let of = Loop { p, i, d: derivative, filter, lead: [above, below], delay, lag };
    if let Some((name, value, needed)) = of.mistake() {
        return Err(PyValueError::new_err(format!("{name}={value:e}: write {needed}")));
    }
    let found = map_rows(py, rows, |row, _| {
        let a = DMatrix::from_row_slice(n, n, &a[row * n * n..][..n * n]);
        let b = DMatrix::from_row_slice(n, k, &b[row * n * k..][..n * k]);
        let c = DVector::from_column_slice(&c[row * n..][..n]);
        let terms = powers.iter().enumerate().map(|(column, &power)| Term {
            power,
            b: b.column(column).into_owned(),
            d: d[row * k + column],
        });
        let plant = Plant::new(&a, terms.collect(), &c).map_err(|none| none.to_string())?;
        margins::margins(&plant, &of).map_err(|none| none.to_string())
    })?;
    let refused = |(row, found): (usize, &Result<Margins, String>)| {
        found.as_ref().err().map(|reason| BadRow { row, reason: reason.clone() })
    };
    let bad: Vec<BadRow> = found.iter().enumerate().filter_map(refused).collect();
    if let (Some(first), Invalid::Raise) = (bad.first(), invalid) {
        return Err(PyArithmeticError::new_err(describe(first, &[rows])));
    }
    warn_of_rows(py, &bad, &[rows])?;
    let unknown = |(row, found): (usize, &Result<Margins, String>)| {
        let why = found.as_ref().ok()?.closed.err()?;
        Some(BadRow { row, reason: why.to_string() })
    };
    let unknown: Vec<BadRow> = found.iter().enumerate().filter_map(unknown).collect();
    warn_of_numbers(py, "closed and damping", &unknown, &[rows])?;
    let none = (f64::NAN, f64::NAN);
    let row = |found: &Result<Margins, String>| match found {
        Err(_) => [f64::NAN; WIDTH],
        Ok(found) => {
            let (phase, crossover) = found.phase.unwrap_or(none);
            let ((gain, gain_at), (reduction, _)) = (found.gain.unwrap_or(none), found.reduction.unwrap_or(none));
            let (distance, distance_at) = found.distance.unwrap_or(none);
            let closed = found.closed.ok().flatten().map_or(none, |root| (root.re, root.im));
            [
                if found.stable { 1.0 } else { 0.0 },
                phase,
                crossover,
                gain,
                gain_at,
                reduction,
                distance,
                distance_at,
                found.bandwidth.unwrap_or(f64::NAN),
                closed.0,
                closed.1,
            ]
        }
    };
    array(py, found.iter().flat_map(row).collect(), &[rows], &[WIDTH]).map(Numbers::from)
}
