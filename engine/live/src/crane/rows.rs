//! Quantities of many states, one state or eight at a time.
//!
//! A row is a state with its parameters. Its results are those of [`DynCrane`] at that state, to the last bit,
//! whatever the other rows contain.

use std::ops::Range;
use std::sync::Arc;

use crane_codegen::program::{Argument, Count, Extent, FunctionId, Shape};
use crane_model::dyn_crane::DynCrane;
use crane_model::rt::derivatives::Columns;
use crane_model::rt::fill_tangent;

use crate::LiveCrane;
use crate::derivatives::Storage;
use crate::expansion::mass_matrix;
use crate::library::Library;
use crate::machine::{Arguments, Batch, Machine, Number};
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

/// Workspace to compute a function of many rows, as many at a time as `T` has lanes. Matrices are written row by row.
pub struct Evaluation<T: Number> {
    library: Arc<Library>,
    function: FunctionId,
    width: usize,
    /// Numbers of coordinates and of live parameters.
    sizes: [usize; 2],
    /// The routines that it needs.
    calls: [Option<Call<T>>; 4],
    /// The states that are evaluated.
    lanes: Lanes<T>,
    /// The coordinates of the drives.
    driven: Vec<usize>,
    /// For derivatives of the dynamics, the factors of A⁻¹ and of the derivatives of the residual, and the derivatives of forces.
    storage: Storage<T::Columns>,
    factors: [Vec<T>; 2],
    forces: Vec<T>,
    /// The crane's inputs.
    inputs: Vec<T>,
    /// The results of the states.
    results: Vec<T>,
    /// The result of a function that the crane does not have: zero if it needs none, NaN if it is too large.
    absent: f64,
}

/// Some states.
#[derive(Debug, Default)]
struct Lanes<T> {
    t: Vec<T>,
    q: Vec<T>,
    v: Vec<T>,
    a: Vec<T>,
    /// Positions of the drives, by coordinate, for functions at rest.
    positions: Vec<T>,
    parameters: Vec<T>,
}

/// A function with a workspace for its calls.
#[derive(Debug)]
struct Call<T> {
    id: FunctionId,
    machine: Machine<T>,
    factors: Vec<T>,
    /// The index of each number of the result in the function's output; `None`: zero.
    places: Option<Vec<Option<usize>>>,
}

impl<T: Number> Evaluation<T> {
    /// Workspace for a function of a crane, with its parameters.
    #[must_use]
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Self {
        use FunctionId as F;
        let ids = match function {
            F::DynamicResidualDerivatives => [Some(F::ForceDerivatives), Some(F::ResidualFactors), None, None],
            F::InverseMassMatrix => [Some(F::MassFactors), None, None, None],
            F::ForwardDynamicsDerivatives => {
                [F::ForwardDynamics, F::ForceDerivatives, F::ResidualFactors, F::MassFactors].map(Some)
            }
            // The drives are where they are at the state's time.
            id if id.arguments().contains(&Argument::DrivePositions) => [Some(id), Some(F::DriveMotions), None, None],
            id => [Some(id), None, None, None],
        };
        let width = crane.shape(function).iter().product();
        let multiplies =
            matches!(function, F::DynamicResidualDerivatives | F::InverseMassMatrix | F::ForwardDynamicsDerivatives);
        let links = if multiplies { crane.links() } else { vec![] };
        Self {
            library: crane.library(),
            function,
            width,
            sizes: [crane.size(), crane.parameters().len()],
            calls: ids.map(|id| Call::new(crane, id?)),
            lanes: Lanes::new(),
            storage: Storage::new(links),
            factors: [vec![], vec![]],
            forces: vec![T::splat(0.0); if function == F::ForwardDynamicsDerivatives { 2 * width / 3 } else { 0 }],
            driven: crane.description().drives.iter().map(|drive| drive.coordinate).collect(),
            inputs: crane.inputs().numbers().map(T::splat).collect(),
            results: vec![T::splat(0.0); width],
            absent: if crane.is_too_large_for(function) { f64::NAN } else { 0.0 },
        }
    }

    /// The number of results per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Other live parameters, all of them.
    pub(crate) fn set_parameters(&mut self, parameters: &[T]) {
        for call in self.calls.iter_mut().flatten() {
            call.set_parameters(&self.library, parameters);
        }
    }

    /// Other inputs, three numbers each.
    pub(crate) fn set_inputs(&mut self, inputs: &[T]) {
        self.inputs.clear();
        self.inputs.extend_from_slice(inputs);
    }

    /// Computes products with A⁻¹ of the states taken, one state after the other, if the function is of these.
    fn multiply(&mut self, out: &mut [<T::Columns as Columns>::Lane]) -> bool {
        let Self { calls, lanes, inputs, library, storage, factors: [of_mass, of_residual], forces, .. } = self;
        match (self.function, calls) {
            (FunctionId::InverseMassMatrix, [Some(mass), ..]) => {
                mass.write_factors(library, lanes, inputs, of_mass);
                storage.inverse_mass_matrix(of_mass, out);
            }
            (
                FunctionId::ForwardDynamicsDerivatives,
                [Some(accelerations), Some(slopes), Some(residual), Some(mass)],
            ) => {
                let mut a = std::mem::take(&mut lanes.a);
                accelerations.write_factors(library, lanes, inputs, &mut a);
                lanes.a = a;
                slopes.run(library, lanes, inputs, forces);
                residual.write_factors(library, lanes, inputs, of_residual);
                mass.write_factors(library, lanes, inputs, of_mass);
                let places = library.routine(FunctionId::ForceDerivatives).map_or(&[][..], Routine::places);
                storage.forward_dynamics_derivatives([of_residual, of_mass], (forces, places), out);
            }
            _ => return false,
        }
        true
    }

    /// Computes the results of the states taken.
    fn evaluate(&mut self) {
        let Self { calls, lanes, driven, storage, inputs, results, library, absent, factors: [_, of_residual], .. } =
            self;
        let n = lanes.q.len();
        match (self.function, calls) {
            (FunctionId::DynamicResidualDerivatives, [Some(slopes), Some(residual), ..]) => {
                slopes.run(library, lanes, inputs, results);
                residual.write_factors(library, lanes, inputs, of_residual);
                storage.residual_derivatives(of_residual, results);
            }
            (
                FunctionId::DynamicResidualDerivatives
                | FunctionId::InverseMassMatrix
                | FunctionId::ForwardDynamicsDerivatives,
                _,
            ) => results.fill(T::splat(*absent)),
            (_, [Some(call), motions, ..]) => {
                lanes.positions.clear();
                lanes.positions.resize(n, T::splat(0.0));
                if let Some(motions) = motions {
                    let mut pairs = vec![T::splat(0.0); 2 * driven.len()];
                    motions.run(library, lanes, inputs, &mut pairs);
                    driven.iter().zip(pairs.chunks_exact(2)).for_each(|(j, pair)| lanes.positions[*j] = pair[0]);
                }
                call.run(library, lanes, inputs, results);
            }
            _ => results.fill(T::splat(*absent)),
        }
    }
}

impl<T: Number<Columns: Columns<Lane = T>>> Evaluation<T> {
    /// The results at one state, with the crane's parameters.
    pub(crate) fn at(&mut self, t: T, q: &[T], v: &[T], a: &[T]) -> &[T] {
        let Lanes { t: times, q: poses, v: rates, a: accelerations, .. } = &mut self.lanes;
        for (lanes, given) in [(times, [t].as_slice()), (poses, q), (rates, v), (accelerations, a)] {
            lanes.clear();
            lanes.extend_from_slice(given);
        }
        let mut results = std::mem::take(&mut self.results);
        let multiplied = self.multiply(&mut results);
        self.results = results;
        if !multiplied {
            self.evaluate();
        }
        &self.results
    }
}

impl<T: Number> std::fmt::Debug for Evaluation<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Evaluation").field("function", &self.function).finish_non_exhaustive()
    }
}

impl<T: Batch> Evaluation<T> {
    /// Computes some rows into `out`, row after row.
    pub fn run(&mut self, rows: &ParameterRows<'_>, range: Range<usize>, out: &mut [f64]) {
        let mut first = range.start;
        for several in out.chunks_mut((T::LANES * self.width).max(1)) {
            let count = (range.end - first).min(T::LANES);
            self.lanes.take(self.sizes, rows, first, count);
            let given = rows.parameters.len();
            if given > 0 && (first == range.start || given > self.sizes[1]) {
                for call in self.calls.iter_mut().flatten() {
                    call.set_parameters(&self.library, &self.lanes.parameters);
                }
            }
            if !self.multiply(several) {
                self.evaluate();
                spread(&self.results, self.width, several);
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

impl<T> Lanes<T> {
    fn new() -> Self {
        Self { t: vec![], q: vec![], v: vec![], a: vec![], positions: vec![], parameters: vec![] }
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

impl<T: Number> Call<T> {
    fn new(crane: &LiveCrane, id: FunctionId) -> Option<Self> {
        let library = crane.library();
        let routine = library.routine(id)?;
        let parameters: Vec<T> = crane.parameters().iter().copied().map(T::splat).collect();
        Some(Self {
            id,
            machine: routine.machine(&parameters),
            factors: vec![T::splat(0.0); routine.results()],
            places: places(crane, crane.size(), id),
        })
    }

    fn set_parameters(&mut self, library: &Library, parameters: &[T]) {
        if let Some(routine) = library.routine(self.id) {
            routine.set_parameters(&mut self.machine, parameters);
        }
    }

    /// Writes all numbers of a result in the function's order.
    fn write_factors(&mut self, library: &Library, lanes: &Lanes<T>, inputs: &[T], factors: &mut Vec<T>) {
        factors.resize(self.factors.len(), T::splat(0.0));
        self.run(library, lanes, inputs, factors);
    }

    fn run(&mut self, library: &Library, lanes: &Lanes<T>, inputs: &[T], out: &mut [T]) {
        let Some(routine) = library.routine(self.id) else { return };
        let t = lanes.t.first().copied().unwrap_or(T::splat(0.0));
        let Lanes { q, v, a, positions, .. } = lanes;
        let arguments = Arguments { t, q, v, a, positions, inputs, ..Arguments::none() };
        match (routine.shape(), &self.places) {
            (Shape::Columns { points, .. }, _) => {
                routine.run(&mut self.machine, &arguments, &mut self.factors);
                mass_matrix(points, &mut self.factors, out);
            }
            (Shape::Tangent { segments, entries, .. }, _) => {
                routine.run(&mut self.machine, &arguments, &mut self.factors);
                fill_tangent(segments, entries, (&self.factors, T::splat(0.0)), out);
            }
            (_, Some(places)) => {
                routine.run(&mut self.machine, &arguments, &mut self.factors);
                for (out, place) in out.iter_mut().zip(places) {
                    *out = place.map_or(T::splat(0.0), |index| self.factors[index]);
                }
            }
            (_, None) => routine.run(&mut self.machine, &arguments, out),
        }
    }
}

impl LiveCrane {
    /// Extent of each index of a function's result for one state; of functions that leave factors, their number.
    #[must_use]
    pub fn shape(&self, function: FunctionId) -> Vec<usize> {
        let (n, count) = (self.size(), |count: Count| DynCrane::count(self, count));
        match function {
            FunctionId::ForwardDynamicsDerivatives | FunctionId::Linearise => vec![3, n, n],
            // Also those of coordinates that do not move a body.
            FunctionId::TransformDerivatives => vec![count(Count::Bodies), n, 4, 4],
            id => match id.extent() {
                Extent::List(_, Count::SecondDerivatives) | Extent::Other => {
                    vec![self.library().routine(id).map_or(0, Routine::results)]
                }
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
