//! Products of vectors with the derivatives of functions, over rows of states.

use std::ops::Range;

use crane_codegen::diagnostic::similar;
use crane_live::FunctionId;
use crane_live::assemble::TooLarge;
use crane_live::products::{self, PullBack, PushForward};
use crane_model::dyn_crane::DynModel;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::evaluation::{Array, Given, STATE, State, forget};
use crate::mistakes::{BadRow, Invalid, describe, warn_of_rows};
use crate::parallel::for_rows;

/// Rows that a thread takes at a time.
const PIECE: usize = 32;

/// A state of a row.
type Row<'a> = (products::State<'a>, &'a [f64], &'a [f64]);

#[pymethods]
impl Crane {
    /// Names of all numbers that functions depend on, and how many each has.
    fn _product_numbers(&self) -> Vec<(String, usize)> {
        products::numbers(&self.live)
    }

    /// Axes of the results of a function that has products.
    fn _product_shape(&self, function: &str) -> PyResult<Vec<usize>> {
        Ok(self.live.shape(self.with_products(function)?).clone())
    }

    /// (..., numbers): weights of the results of a function, times its derivatives; `Crane.vjp` names them.
    #[pyo3(name = "_vjp", signature = (function, weights, q=None, v=None, a=None, t=None, *, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn pull_back<'py>(
        &self,
        py: Python<'py>,
        function: &str,
        weights: &Bound<'py, PyAny>,
        q: Given<'_, 'py>,
        v: Given<'_, 'py>,
        a: Given<'_, 'py>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let id = self.with_products(function)?;
        let results: usize = self.live.shape(id).iter().product();
        let state = State { t, q, v, a };
        check_arguments(id, &state)?;
        let weights = Argument::of_width("weights", weights, results, "one for each result")?;
        let numbers = self.product_numbers();
        let too_large = |TooLarge { registers }| {
            let name = &self.live.description().name;
            PyValueError::new_err(format!(
                "{function} of {name} is too large for vjp, with {registers} numbers at once: use jvp"
            ))
        };
        PullBack::new(&self.live, id).map_err(too_large)?;
        let make = || PullBack::new(&self.live, id).unwrap_or_default();
        let single = self.is_single();
        self.products(py, state, (&weights, "weights"), (numbers, &[numbers]), invalid, make, |pull, row, out| {
            let (state, parameters, weights) = row;
            match pull {
                Some(pull) => {
                    if !single {
                        pull.set_parameters(parameters);
                    }
                    pull.at(&state, weights).write(out);
                }
                None => out.fill(0.0),
            }
        })
    }

    /// (..., results): derivatives of a function, times changes of all numbers.
    #[pyo3(name = "_jvp", signature = (function, changes, q=None, v=None, a=None, t=None, *, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn push_forward<'py>(
        &self,
        py: Python<'py>,
        function: &str,
        changes: &Bound<'py, PyAny>,
        q: Given<'_, 'py>,
        v: Given<'_, 'py>,
        a: Given<'_, 'py>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let id = self.with_products(function)?;
        let of_row = self.live.shape(id).clone();
        let state = State { t, q, v, a };
        check_arguments(id, &state)?;
        let changes = Argument::of_width("changes", changes, self.product_numbers(), "one for each number")?;
        let make = || PushForward::new(&self.live, id);
        let width = of_row.iter().product();
        self.products(py, state, (&changes, "changes"), (width, &of_row), invalid, make, |push, row, out| {
            let (state, parameters, changes) = row;
            push.at(&state, parameters, changes, out);
        })
    }
}

impl Crane {
    /// The number of all numbers that functions depend on.
    fn product_numbers(&self) -> usize {
        products::numbers(&self.live).iter().map(|(_, count)| count).sum()
    }

    /// A function that has products, by its name.
    fn with_products(&self, name: &str) -> PyResult<FunctionId> {
        let offered = |id: &&FunctionId| id.python().is_some() && products::has_products(&self.live, **id);
        let known = || FunctionId::ALL.iter().filter(offered);
        if let Some(id) = known().find(|id| id.name() == name) {
            self.refuse(*id)?;
            return Ok(*id);
        }
        let description = self.live.description();
        let is_closed = name == FunctionId::ForwardDynamics.name() && !self.live.loop_joints().is_empty();
        let words = if is_closed {
            format!(
                "{name} of {} depends on its closed loops: use the products of dynamic_residual, loop_states and loop_jacobians",
                description.name
            )
        } else {
            let known: Vec<&str> = known().map(|id| id.name()).collect();
            let guess = similar(name, known.iter().copied());
            let guess = guess.map_or_else(String::new, |guess| format!("did you mean {guess}? "));
            format!("there are no products of {name:?}: {guess}write one of {}", known.join(", "))
        };
        Err(PyValueError::new_err(words))
    }

    /// Products at all rows, each with a vector.
    #[expect(clippy::too_many_arguments, reason = "two kinds of products share all of them")]
    fn products<'py, R>(
        &self,
        py: Python<'py>,
        state: State<'_, 'py>,
        (vectors, name): (&Argument, &str),
        (width, of_row): (usize, &[usize]),
        invalid: &str,
        make: impl Fn() -> R + Sync,
        write: impl Fn(&mut R, Row<'_>, &mut [f64]) + Sync,
    ) -> Array<'py> {
        let arguments = self.read(state)?;
        let [t, q, v, a] = &arguments;
        let joined = Joined::new(&[
            ("t", t),
            ("q", q),
            ("v", v),
            ("a", a),
            ("the parameters", &self.parameters),
            (name, vectors),
        ])?;
        let invalid = Invalid::named(invalid)?;
        let mut bad = self.bad_rows(&joined, STATE, invalid)?;
        for row in 0..joined.rows() {
            let vector = joined.row(5, vectors.width, row);
            let Some(index) = vector.iter().position(|x| !x.is_finite()) else { continue };
            let reason = format!("{name} contains {}, not a finite number", vector[index]);
            if invalid == Invalid::Raise {
                return Err(PyValueError::new_err(describe(&BadRow { row, reason }, &joined.shape)));
            }
            bad.push(BadRow { row, reason });
        }
        let n = self.live.size();
        let mut out = vec![0.0; joined.rows() * width];
        let work = |workspace: &mut R, rows: Range<usize>, out: &mut [f64]| {
            for (row, out) in rows.zip(out.chunks_mut(width.max(1))) {
                let [t, q, v, a, parameters, vector] =
                    [(0, 1), (1, n), (2, n), (3, n), (4, self.parameters.width), (5, vectors.width)]
                        .map(|(index, size)| joined.row(index, size, row));
                let parameters = if self.is_single() { self.live.parameters() } else { parameters };
                let state = products::State { t: t.first().copied().unwrap_or(0.0), q, v, a };
                write(workspace, (state, parameters, vector), out);
            }
        };
        for_rows(py, (PIECE, width), &mut out, make, work)?;
        forget(&mut out, &bad, width);
        warn_of_rows(py, &bad, &joined.shape)?;
        array(py, out, &joined.shape, of_row)
    }
}

/// Refuses arguments that a function does not have, and a lack of those that it needs.
fn check_arguments(function: FunctionId, state: &State<'_, '_>) -> PyResult<()> {
    let Some(own) = function.python() else { return Ok(()) };
    let given = [("q", state.q), ("v", state.v), ("a", state.a), ("t", state.t)];
    let takes: Vec<&str> = own.names().collect();
    let name = function.name();
    let listed = takes.join(", ");
    for (argument, _) in given.iter().filter(|(_, value)| value.is_some()) {
        if !takes.contains(argument) {
            let instead = if *argument == "a" && takes.contains(&"t") { "; times are t=..." } else { "" };
            return Err(PyValueError::new_err(format!("{name} has no {argument}: it depends on {listed}{instead}")));
        }
    }
    let missing = own.required.iter().find(|needed| given.iter().any(|(own, value)| own == *needed && value.is_none()));
    match missing {
        Some(missing) => Err(PyValueError::new_err(format!("{name} needs {missing}: it depends on {listed}"))),
        None => Ok(()),
    }
}
