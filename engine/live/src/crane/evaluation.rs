//! A function of a live crane on numbers of any width: those of one state, of eight states, or of one with slopes.

use std::sync::Arc;

use crane_codegen::program::{Argument, FunctionId, Shape};
use crane_model::dyn_crane::{Arguments, Derived, Functions};
use crane_model::rt::derivatives::Columns;
use crane_model::rt::fill_tangent;

use super::LiveCrane;
use crate::derivatives::Storage;
use crate::expansion::{mass_matrix, second_derivatives};
use crate::library::Library;
use crate::machine::{Environment, Machine, Number};
use crate::routine::Routine;

/// A function of a crane with the workspace of its calls. A second call allocates nothing.
pub struct Evaluation<T: Number> {
    library: Arc<Library>,
    function: FunctionId,
    /// The routines that it needs.
    calls: [Option<Call<T>>; 4],
    /// For functions of drives at rest: where they are at a time, their coordinates, and the positions by coordinate.
    motions: Option<Call<T>>,
    driven: Vec<usize>,
    positions: Vec<T>,
    /// For derivatives of the dynamics: accelerations, the factors of A⁻¹ and of the derivatives of the residual, and the derivatives of forces.
    storage: Storage<T::Columns>,
    accelerations: Vec<T>,
    factors: [Vec<T>; 2],
    forces: Vec<T>,
    /// The crane's inputs.
    inputs: Vec<T>,
    /// The results of [`results_at`](Self::results_at).
    results: Vec<T>,
    /// The number of results.
    width: usize,
    /// Whether the crane is too large for it.
    is_too_large: bool,
}

impl<T: Number> Evaluation<T> {
    /// A function of a crane, with its parameters and inputs.
    #[must_use]
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Self {
        use FunctionId as F;
        let ids = match function {
            F::DynamicResidualDerivatives => [Some(F::ForceDerivatives), Some(F::ResidualFactors), None, None],
            F::InverseMassMatrix => [Some(F::MassFactors), None, None, None],
            F::ForwardDynamicsDerivatives => {
                [F::ForwardDynamics, F::ForceDerivatives, F::ResidualFactors, F::MassFactors].map(Some)
            }
            id => [Some(id), None, None, None],
        };
        let calls = ids.map(|id| Call::new(crane, id?));
        let multiplies = is_product(function);
        let width = match &calls[0] {
            Some(call) if !multiplies => call.width,
            _ => crane.shape(function).iter().product(),
        };
        let takes_positions = function.arguments().contains(&Argument::DrivePositions);
        Self {
            library: crane.library(),
            function,
            calls,
            motions: takes_positions.then(|| Call::new(crane, F::DriveMotions)).flatten(),
            driven: crane.description().drives.iter().map(|drive| drive.coordinate).collect(),
            positions: vec![T::splat(0.0); if takes_positions { crane.size() } else { 0 }],
            storage: Storage::new(if multiplies { crane.links() } else { vec![] }),
            accelerations: vec![],
            factors: [vec![], vec![]],
            forces: vec![T::splat(0.0); if function == F::ForwardDynamicsDerivatives { 2 * width / 3 } else { 0 }],
            inputs: crane.inputs().numbers().map(T::splat).collect(),
            results: vec![],
            width,
            is_too_large: crane.is_too_large_for(function),
        }
    }

    /// The number of results.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Other live parameters, all of them.
    pub fn set_parameters(&mut self, parameters: &[T]) {
        for call in self.calls.iter_mut().chain([&mut self.motions]).flatten() {
            call.set_parameters(&self.library, parameters);
        }
    }

    /// Other inputs, three numbers each.
    pub fn set_inputs(&mut self, inputs: impl IntoIterator<Item = T>) {
        self.inputs.clear();
        self.inputs.extend(inputs);
    }

    /// Computes products with A⁻¹, of states one after the other, if the function is of these.
    pub(crate) fn multiply(
        &mut self,
        at: &Arguments<'_, T>,
        out: &mut [<T::Columns as Columns>::Lane],
    ) -> Option<Derived> {
        let Self { calls, accelerations, inputs, library, storage, factors: [of_mass, of_residual], forces, .. } = self;
        match (self.function, calls) {
            (FunctionId::InverseMassMatrix, [Some(mass), ..]) => {
                mass.write_factors(library, at, inputs, of_mass);
                storage.inverse_mass_matrix(of_mass, out);
            }
            (FunctionId::ForwardDynamicsDerivatives, [Some(motion), Some(slopes), Some(residual), Some(mass)]) => {
                motion.write_factors(library, at, inputs, accelerations);
                slopes.run(library, at, inputs, forces);
                residual.write_factors(library, &Arguments { a: accelerations, ..*at }, inputs, of_residual);
                mass.write_factors(library, at, inputs, of_mass);
                let places = library.routine(FunctionId::ForceDerivatives).map_or(&[][..], Routine::places);
                storage.forward_dynamics_derivatives([of_residual, of_mass], (forces, places), out);
            }
            _ => return None,
        }
        Some(Derived::Yes)
    }

    /// Computes any other function. Without positions, drives are where they are at the time.
    pub(crate) fn evaluate(&mut self, at: &Arguments<'_, T>, out: &mut [T]) -> Derived {
        let Self { calls, motions, driven, positions, storage, inputs, library, factors: [_, of_residual], .. } = self;
        match (self.function, calls) {
            (FunctionId::DynamicResidualDerivatives, [Some(slopes), Some(residual), ..]) => {
                slopes.run(library, at, inputs, out);
                residual.write_factors(library, at, inputs, of_residual);
                storage.residual_derivatives(of_residual, out);
            }
            (function, [Some(call), ..]) if !is_product(function) => match motions {
                Some(motions) if at.positions.is_empty() => {
                    let pairs = motions.results(library, at, inputs);
                    driven.iter().zip(pairs.chunks_exact(2)).for_each(|(j, pair)| positions[*j] = pair[0]);
                    call.run(library, &Arguments { positions, ..*at }, inputs, out);
                }
                _ => call.run(library, at, inputs, out),
            },
            _ if self.is_too_large => {
                out.fill(T::splat(f64::NAN));
                return Derived::No;
            }
            _ => out.fill(T::splat(0.0)),
        }
        Derived::Yes
    }
}

impl<T: Number<Columns: Columns<Lane = T>>> Evaluation<T> {
    /// Computes the function as [`Functions::call`](crane_model::dyn_crane::Functions::call) does.
    pub fn call(&mut self, at: &Arguments<'_, T>, out: &mut [T]) -> Derived {
        match self.multiply(at, out) {
            Some(derived) => derived,
            None => self.evaluate(at, out),
        }
    }

    /// Its results at a state.
    pub fn results_at(&mut self, at: &Arguments<'_, T>) -> &[T] {
        let mut results = std::mem::take(&mut self.results);
        results.resize(self.width, T::splat(0.0));
        self.call(at, &mut results);
        self.results = results;
        &self.results
    }
}

impl<T: Number> std::fmt::Debug for Evaluation<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Evaluation").field("function", &self.function).finish_non_exhaustive()
    }
}

/// Whether a function is computed by loops over factors.
fn is_product(function: FunctionId) -> bool {
    use FunctionId as F;
    matches!(function, F::DynamicResidualDerivatives | F::InverseMassMatrix | F::ForwardDynamicsDerivatives)
}

/// A routine with a workspace for its calls.
#[derive(Debug)]
struct Call<T> {
    id: FunctionId,
    machine: Machine<T>,
    factors: Vec<T>,
    /// The number of its results in full.
    width: usize,
}

impl<T: Number> Call<T> {
    /// `None` if the crane does not need the function.
    fn new(crane: &LiveCrane, id: FunctionId) -> Option<Self> {
        let library = crane.library();
        let routine = library.routine(id)?;
        let parameters: Vec<T> = crane.parameters().iter().copied().map(T::splat).collect();
        let width = match routine.shape() {
            Shape::Columns { n, bias, .. } => n * n + if *bias { *n } else { 0 },
            Shape::Tangent { n, .. } => n * n,
            shape @ Shape::TransformFactors { .. } => 16 * shape.matrices(),
            _ => routine.results(),
        };
        let factors = vec![T::splat(0.0); routine.results()];
        Some(Self { id, machine: routine.machine(&parameters), factors, width })
    }

    fn set_parameters(&mut self, library: &Library, parameters: &[T]) {
        if let Some(routine) = library.routine(self.id) {
            routine.set_parameters(&mut self.machine, parameters);
        }
    }

    /// Writes all numbers of a result that is left as factors.
    fn write_factors(&mut self, library: &Library, at: &Arguments<'_, T>, inputs: &[T], factors: &mut Vec<T>) {
        factors.resize(self.factors.len(), T::splat(0.0));
        self.run(library, at, inputs, factors);
    }

    /// The numbers that the routine returns.
    fn results(&mut self, library: &Library, at: &Arguments<'_, T>, inputs: &[T]) -> &[T] {
        if let Some(routine) = library.routine(self.id) {
            let environment = Environment { inputs, ..(*at).into() };
            routine.run(&mut self.machine, &environment, &mut self.factors);
        }
        &self.factors
    }

    /// Writes the result in full.
    fn run(&mut self, library: &Library, at: &Arguments<'_, T>, inputs: &[T], out: &mut [T]) {
        let Some(routine) = library.routine(self.id) else { return };
        let (environment, zero) = (Environment { inputs, ..(*at).into() }, T::splat(0.0));
        let Self { machine, factors, .. } = self;
        match routine.shape() {
            Shape::Columns { n, points, .. } => {
                routine.run(machine, &environment, factors);
                let (columns, bias) = factors.split_at_mut(12 * n);
                mass_matrix(points, columns, out);
                out[n * n..].iter_mut().zip(bias).for_each(|(out, number)| *out = *number);
            }
            Shape::Tangent { segments, entries, .. } => {
                routine.run(machine, &environment, factors);
                fill_tangent(segments, entries, (factors, zero), out);
            }
            Shape::TransformFactors { degrees, rotations, vectors } => {
                routine.run(machine, &environment, factors);
                second_derivatives(degrees, rotations.len(), vectors, (factors, zero), out);
            }
            _ if out.len() >= factors.len() => routine.run(machine, &environment, out),
            _ => {
                routine.run(machine, &environment, factors);
                out.iter_mut().zip(factors).for_each(|(out, number)| *out = *number);
            }
        }
    }
}
