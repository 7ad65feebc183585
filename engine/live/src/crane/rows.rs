//! Quantities of many states, one state or eight at a time.
//!
//! A row is a state with its parameters. Its results are those of [`DynCrane`] at that state, to the last bit,
//! whatever the other rows contain.

use std::ops::Range;

use crane_codegen::program::{Count, Extent, FunctionId};
use crane_model::dyn_crane::{Arguments, DynCrane, Functions};

use super::evaluation::Evaluation;
use crate::LiveCrane;
use crate::machine::{Batch, Number};
use crate::routine::Routine;

/// States and parameters, row after row. A list of one row applies to all rows; missing parameters are those of the crane.
#[derive(Clone, Copy, Debug, Default)]
pub struct ParameterRows<'a> {
    /// Times, s.
    pub t: &'a [f64],
    /// Coordinates, m and rad.
    pub q: &'a [f64],
    /// Their rates, m/s and rad/s.
    pub v: &'a [f64],
    /// Accelerations, m/s² and rad/s².
    pub a: &'a [f64],
    /// Live parameters, all of them.
    pub parameters: &'a [f64],
}

/// Workspace to compute a function of many rows, as many at a time as `T` has lanes. Matrices are written row by row; functions of drives at rest have
/// them where they are at the state's time.
#[derive(Debug)]
pub struct BatchEvaluation<T: Number> {
    evaluation: Evaluation<T>,
    width: usize,
    /// Numbers of coordinates and of live parameters.
    sizes: [usize; 2],
    /// The states that are evaluated.
    lanes: Lanes<T>,
    /// The results of the states, and the same in the order of rows, where it is another one.
    results: Vec<T>,
    placed: Vec<T>,
    /// The index of each number of a row in the results; `None`: zero.
    places: Option<Vec<Option<usize>>>,
}

/// Some states.
#[derive(Debug)]
struct Lanes<T> {
    t: Vec<T>,
    q: Vec<T>,
    v: Vec<T>,
    a: Vec<T>,
    parameters: Vec<T>,
}

impl<T: Batch> BatchEvaluation<T> {
    /// Workspace for a function of a crane, with its parameters.
    #[must_use]
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Self {
        let evaluation = Evaluation::new(crane, function);
        let places = places(crane, crane.size(), function);
        Self {
            width: places.as_ref().map_or(evaluation.width(), Vec::len),
            sizes: [crane.size(), crane.parameters().len()],
            lanes: Lanes { t: vec![], q: vec![], v: vec![], a: vec![], parameters: vec![] },
            results: vec![T::splat(0.0); evaluation.width()],
            placed: vec![],
            places,
            evaluation,
        }
    }

    /// The number of results per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Computes some rows into `out`, row after row.
    pub fn run(&mut self, rows: &ParameterRows<'_>, range: Range<usize>, out: &mut [f64]) {
        let mut first = range.start;
        for several in out.chunks_mut((T::LANES * self.width).max(1)) {
            let Self { evaluation, lanes, results, placed, places, .. } = self;
            let count = (range.end - first).min(T::LANES);
            lanes.take(self.sizes, rows, first, count);
            let given = rows.parameters.len();
            if given > 0 && (first == range.start || given > self.sizes[1]) {
                evaluation.set_parameters(&lanes.parameters);
            }
            let Lanes { t, q, v, a, .. } = lanes;
            let t = t.first().copied().unwrap_or(T::splat(0.0));
            let at = Arguments { t, q, v, a, ..Arguments::none() };
            if evaluation.multiply(&at, several).is_none() {
                evaluation.evaluate(&at, results);
                match places {
                    Some(places) => {
                        placed.clear();
                        placed.extend(places.iter().map(|place| place.map_or(T::splat(0.0), |index| results[index])));
                        spread(placed, self.width, several);
                    }
                    None => spread(results, self.width, several),
                }
            }
            first += count;
        }
    }
}

/// Writes the numbers of each state one after the other, those of states `width` apart.
fn spread<T: Batch>(numbers: &[T], width: usize, out: &mut [f64]) {
    let (eights, rest) = numbers.as_chunks::<8>();
    for (first, eight) in (0..).step_by(8).zip(eights) {
        for (lane, row) in out.chunks_mut(width.max(1)).enumerate() {
            if let Some(own) = row[first..].first_chunk_mut::<8>() {
                for k in 0..8 {
                    own[k] = eight[k].lane(lane);
                }
            }
        }
    }
    for (index, number) in (8 * eights.len()..).zip(rest) {
        out.chunks_mut(width.max(1)).enumerate().for_each(|(lane, row)| row[index] = number.lane(lane));
    }
}

impl<T: Batch> Lanes<T> {
    /// Takes rows of a crane with `n` coordinates and with `parameters` parameters; the last row fills the remaining lanes.
    fn take(&mut self, [n, parameters]: [usize; 2], rows: &ParameterRows<'_>, first: usize, count: usize) {
        let states =
            [(&mut self.t, rows.t, 1), (&mut self.q, rows.q, n), (&mut self.v, rows.v, n), (&mut self.a, rows.a, n)];
        for (lanes, list, width) in states.into_iter().chain([(&mut self.parameters, rows.parameters, parameters)]) {
            let row = |lane: usize| if list.len() <= width { 0 } else { (first + lane.min(count - 1)) * width };
            let given = if list.is_empty() { 0 } else { width };
            lanes.clear();
            lanes.extend((0..given).map(|i| T::from_lanes(|lane| list[row(lane) + i])));
        }
    }
}

impl LiveCrane {
    /// Extent of each index of a function's result for one state.
    #[must_use]
    pub fn shape(&self, function: FunctionId) -> Vec<usize> {
        let (n, count) = (self.size(), |count: Count| Functions::count(self, count));
        match function {
            FunctionId::ForwardDynamicsDerivatives | FunctionId::Linearise => vec![3, n, n],
            // Also those of coordinates that do not move a body.
            FunctionId::TransformDerivatives => vec![count(Count::Bodies), n, 4, 4],
            id => match id.extent() {
                Extent::List(_, Count::SecondDerivatives) => {
                    vec![self.library().routine(id).map_or(0, |routine| routine.shape().matrices()), 4, 4]
                }
                Extent::Other => vec![self.library().routine(id).map_or(0, Routine::results)],
                extent => extent.shape(n, count).collect(),
            },
        }
    }
}

/// Where a function's result contains the numbers of transforms or their derivatives, whose matrices it writes column by column.
fn places(crane: &LiveCrane, n: usize, id: FunctionId) -> Option<Vec<Option<usize>>> {
    let bodies = &crane.description().bodies;
    let row_by_row = |matrix: usize| (0..16).map(move |index| 16 * matrix + 4 * (index % 4) + index / 4);
    match id {
        FunctionId::Transforms => Some((0..bodies.len()).flat_map(row_by_row).map(Some).collect()),
        FunctionId::TransformSecondDerivatives => {
            Some((0..crane.shape(id)[0]).flat_map(row_by_row).map(Some).collect())
        }
        FunctionId::TransformDerivatives => {
            let tree = (crane as &dyn DynCrane).tree();
            let (mut places, mut matrices) = (Vec::new(), 0..);
            for body in 0..bodies.len() {
                let moving = tree.coordinates(body);
                for coordinate in 0..n {
                    match moving.binary_search(&coordinate).ok().and_then(|_| matrices.next()) {
                        Some(matrix) => places.extend(row_by_row(matrix).map(Some)),
                        None => places.extend([None; 16]),
                    }
                }
            }
            Some(places)
        }
        _ => None,
    }
}
