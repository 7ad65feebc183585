//! Products of vectors with the derivatives of functions, over rows of states.

use std::ops::Range;

use crane_codegen::diagnostic::similar;
use crane_live::FunctionId;
use crane_live::assemble::TooLarge;
use crane_live::machine::Batch;
use crane_live::products::{self, PullBack, PushForward, PushForwardOfLarge};
use crane_model::dyn_crane::{Arguments, Functions};
use crane_model::rt::lanes::f64x8;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Argument, Joined, array};
use crate::crane::Crane;
use crate::evaluation::{StateArguments, settle};
use crate::mistakes::Invalid;
use crate::parallel::for_rows;
use crate::types::{Array, ArrayLike, Given, Numbers};

/// Rows that a thread takes at a time.
const PIECE: usize = 32;

/// Products of a function at one state or at eight; nothing for a function that the crane does not need.
trait Multiply<T> {
    /// Other live parameters, all of them.
    fn set_parameters(&mut self, parameters: &[T]);
    /// The product with a vector, number by number.
    fn multiply(&mut self, state: &Arguments<'_, T>, vector: &[T], take: &mut dyn FnMut(usize, T));
}

impl<T: Batch> Multiply<T> for Option<PullBack<T>> {
    fn set_parameters(&mut self, parameters: &[T]) {
        if let Some(own) = self {
            own.set_parameters(parameters);
        }
    }
    fn multiply(&mut self, state: &Arguments<'_, T>, weights: &[T], take: &mut dyn FnMut(usize, T)) {
        let pulled = self.as_mut().map(|own| own.at(state, weights));
        pulled.iter().flat_map(products::Pulled::all).enumerate().for_each(|(index, number)| take(index, number));
    }
}

impl<T: Batch> Multiply<T> for Option<PushForward<T>> {
    fn set_parameters(&mut self, parameters: &[T]) {
        if let Some(own) = self {
            own.set_parameters(parameters);
        }
    }
    fn multiply(&mut self, state: &Arguments<'_, T>, changes: &[T], take: &mut dyn FnMut(usize, T)) {
        let pushed = self.as_mut().map(|own| own.at(state, changes));
        pushed.into_iter().flatten().enumerate().for_each(|(index, number)| take(index, *number));
    }
}

/// A large function, with its parameters.
struct Large {
    push: PushForwardOfLarge,
    parameters: Vec<f64>,
    results: Vec<f64>,
}

impl Multiply<f64> for Large {
    fn set_parameters(&mut self, parameters: &[f64]) {
        self.parameters = parameters.to_vec();
    }
    fn multiply(&mut self, state: &Arguments<'_>, changes: &[f64], take: &mut dyn FnMut(usize, f64)) {
        self.push.at(state, &self.parameters, changes, &mut self.results);
        self.results.iter().enumerate().for_each(|(index, number)| take(index, *number));
    }
}

/// From so many rows on, eight are computed together.
const TOGETHER: usize = 4;

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
        weights: ArrayLike<'py>,
        q: Given<'py>,
        v: Given<'py>,
        a: Given<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        let id = self.with_products(function)?;
        let results: usize = self.live.shape(id).iter().product();
        let state = StateArguments { t, q, v, a };
        check_arguments(id, &state)?;
        let weights = Argument::of_width("weights", &weights, results, "one for each result")?;
        let numbers = self.product_numbers();
        let too_large = |TooLarge { registers }| {
            let name = &self.live.description().name;
            PyValueError::new_err(format!(
                "{function} of {name} is too large for vjp, with {registers} numbers at once: use jvp"
            ))
        };
        PullBack::<f64>::new(&self.live, id).map_err(too_large)?;
        let one = || PullBack::<f64>::new(&self.live, id).unwrap_or_default();
        let eight = || Some(PullBack::<f64x8>::new(&self.live, id).unwrap_or_default());
        self.products(py, state, (&weights, "weights"), (numbers, &[numbers]), invalid, (one, eight))
    }

    /// (..., results): derivatives of a function, times changes of all numbers.
    #[pyo3(name = "_jvp", signature = (function, changes, q=None, v=None, a=None, t=None, *, invalid="raise"))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn push_forward<'py>(
        &self,
        py: Python<'py>,
        function: &str,
        changes: ArrayLike<'py>,
        q: Given<'py>,
        v: Given<'py>,
        a: Given<'py>,
        t: Given<'py>,
        invalid: &str,
    ) -> Array<'py> {
        let id = self.with_products(function)?;
        let of_row = self.live.shape(id).clone();
        let state = StateArguments { t, q, v, a };
        check_arguments(id, &state)?;
        let changes = Argument::of_width("changes", &changes, self.product_numbers(), "one for each number")?;
        let width = of_row.iter().product();
        let (vectors, of_row) = ((&changes, "changes"), (width, of_row.as_slice()));
        if PushForward::<f64>::new(&self.live, id).is_err() {
            let large = || {
                let (push, parameters) = (PushForwardOfLarge::new(&self.live, id), self.live.parameters().to_vec());
                Large { push, parameters, results: vec![0.0; width] }
            };
            return self.products(py, state, vectors, of_row, invalid, (large, || None::<Option<PushForward<f64x8>>>));
        }
        let one = || PushForward::<f64>::new(&self.live, id).unwrap_or_default();
        let eight = || Some(PushForward::<f64x8>::new(&self.live, id).unwrap_or_default());
        self.products(py, state, vectors, of_row, invalid, (one, eight))
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
        let joint = self.live.loop_joints().first().filter(|_| name == FunctionId::ForwardDynamics.name());
        let words = if let Some(joint) = joint {
            format!(
                "{name} of {} depends on {}: use the products of dynamic_residual, loop_states and loop_jacobians{}",
                description.name,
                joint.closes(),
                joint.remedy()
            )
        } else {
            let known: Vec<&str> = known().map(|id| id.name()).collect();
            let guess = similar(name, known.iter().copied());
            let guess = guess.map_or_else(String::new, |guess| format!("did you mean {guess}? "));
            format!("there are no products of {name:?}: {guess}write one of {}", known.join(", "))
        };
        Err(PyValueError::new_err(words))
    }

    /// Products at all rows, each with a vector; `make`: products of one state, and of eight if there are any.
    fn products<'py, R: Multiply<f64>, S: Multiply<f64x8>>(
        &self,
        py: Python<'py>,
        state: StateArguments<'py>,
        (vectors, name): (&Argument, &str),
        (width, of_row): (usize, &[usize]),
        invalid: &str,
        (one, eight): (impl Fn() -> R + Sync, impl Fn() -> Option<S> + Sync),
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
        let mut bad = self.bad_rows(&joined, invalid)?;
        let n = self.live.size();
        let mut out = vec![0.0; joined.rows() * width];
        let widths = [1, n, n, n, self.parameters.width, vectors.width];
        let numbers = |index: usize, row: usize| joined.row(index, widths[index], row);
        let parameters = (!self.is_single()).then_some(4);
        let make = || (None, None);
        let work = |(of_one, of_eight): &mut (Option<R>, Option<Option<S>>), rows: Range<usize>, out: &mut [f64]| {
            let mut row = rows.start;
            while row < rows.end {
                let count = (rows.end - row).min(<f64x8 as Batch>::LANES);
                let own = &mut out[(row - rows.start) * width..];
                let together = if count < TOGETHER { None } else { of_eight.get_or_insert_with(&eight).as_mut() };
                row += if let Some(products) = together {
                    at_rows::<f64x8, _>(products, &numbers, parameters, row, count, (own, width))
                } else {
                    at_rows::<f64, _>(of_one.get_or_insert_with(&one), &numbers, parameters, row, 1, (own, width))
                };
            }
        };
        for_rows(py, (PIECE, width), &mut out, make, work)?;
        settle(py, &mut out, &mut bad, (width, 0), &joined.shape, invalid)?;
        array(py, out, &joined.shape, of_row).map(Numbers::from)
    }
}

/// Products at some rows, the last of which fills the other places; returns how many rows. `numbers`: those of t, q, v, a, live parameters and vectors in
/// a row; `parameters`: which of them changes from row to row.
fn at_rows<'r, T: Batch, M: Multiply<T>>(
    products: &mut M,
    numbers: &impl Fn(usize, usize) -> &'r [f64],
    parameters: Option<usize>,
    first: usize,
    count: usize,
    (out, width): (&mut [f64], usize),
) -> usize {
    let lanes = |index: usize| -> Vec<T> {
        let row = |lane: usize| numbers(index, first + lane.min(count - 1));
        (0..row(0).len()).map(|place| T::from_lanes(|lane| row(lane)[place])).collect()
    };
    let [t, q, v, a, vector] = [0, 1, 2, 3, 5].map(lanes);
    if let Some(index) = parameters {
        products.set_parameters(&lanes(index));
    }
    let t = t.first().copied().unwrap_or(T::splat(0.0));
    products.multiply(&Arguments { t, q: &q, v: &v, a: &a, ..Arguments::none() }, &vector, &mut |place, number| {
        for lane in 0..count {
            out[lane * width + place] = number.lane(lane);
        }
    });
    count
}

/// Refuses arguments that a function does not have, and a lack of those that it needs.
fn check_arguments(function: FunctionId, state: &StateArguments<'_>) -> PyResult<()> {
    let Some(own) = function.python() else { return Ok(()) };
    let given = [("q", &state.q), ("v", &state.v), ("a", &state.a), ("t", &state.t)];
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
