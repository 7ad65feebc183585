//! Computations that keep numbers between calls: linear systems of implicit steps, and eight cranes at a time.

use crane_codegen::program::FunctionId;
use crane_model::ParameterError;
use crane_model::dyn_crane::{Arguments, DynBlock, DynSystem};
use crane_model::rt::lanes::f64x8;

use super::LiveCrane;
use crate::library::Library;
use crate::machine::{Environment, Machine, Number};
use crate::routine::Routine;

/// A function and the machine for its calls.
type Ready<'a, T> = Option<(&'a Routine, Machine<T>)>;

/// Linear systems of one crane, or of eight, with the factors of the last one.
pub(super) struct LiveSystem<'a, T> {
    factorise: Ready<'a, T>,
    solve: Ready<'a, T>,
    factors: Vec<T>,
    /// Their number.
    version: u64,
}

impl<'a, T: Number> LiveSystem<'a, T> {
    /// With these live parameters.
    pub fn new(library: &'a Library, parameters: &[T]) -> Self {
        let ready = |id: FunctionId| {
            let routine = library.routine(id)?;
            Some((routine, routine.machine(parameters)))
        };
        let factors = library.routine(FunctionId::Factorise).map_or(0, Routine::results);
        Self {
            factorise: ready(FunctionId::Factorise),
            solve: ready(FunctionId::Solve),
            factors: vec![T::splat(f64::NAN); factors],
            version: 1,
        }
    }

    /// As [`DynSystem::factorise`].
    pub fn factorise(&mut self, q: &[T], added_inertia: &[T], base: &[T]) {
        if let Some((routine, machine)) = &mut self.factorise {
            let at = Arguments { q, ..Arguments::none() };
            routine.run(machine, &Environment { added_inertia, base, ..at.into() }, &mut self.factors);
            self.version += 1;
        }
    }

    /// As [`DynSystem::solve`].
    pub fn solve(&mut self, r: &[T], out: &mut [T]) {
        if let Some((routine, machine)) = &mut self.solve {
            let Self { factors, version, .. } = self;
            let at = Arguments { r, ..Arguments::none() };
            routine.run(machine, &Environment { factors, version: *version, ..at.into() }, out);
        }
    }
}

impl DynSystem for LiveSystem<'_, f64> {
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &[f64]) {
        LiveSystem::factorise(self, q, added_inertia, base);
    }

    fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        LiveSystem::solve(self, r, out);
    }
}

/// Eight cranes.
pub(super) struct Block<'a> {
    ready: Ready<'a, f64x8>,
    inputs: Vec<f64x8>,
}

impl<'a> Block<'a> {
    /// Cranes that differ from one in their parameters.
    ///
    /// # Errors
    /// The parameters of a lane break a rule of the spec language.
    pub fn new(crane: &'a LiveCrane, parameters: &[&[f64]]) -> Result<Self, ParameterError> {
        let lanes = parameters.iter().map(|values| crane.with_first(values)).collect::<Result<Vec<_>, _>>()?;
        // Unused lanes are copies of this crane.
        let of = |lane: usize| lanes.get(lane).unwrap_or(&crane.parameters);
        let eight = |index: usize| f64x8::new(std::array::from_fn(|lane| of(lane)[index]));
        let parameters: Vec<f64x8> = (0..crane.parameters.len()).map(eight).collect();
        let routine = crane.library.routine(FunctionId::ForwardDynamics);
        Ok(Self {
            ready: routine.map(|routine| (routine, routine.machine(&parameters))),
            inputs: crane.inputs.numbers().map(f64x8::splat).collect(),
        })
    }
}

impl DynBlock for Block<'_> {
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]) {
        if let Some((routine, machine)) = &mut self.ready {
            let at = Arguments { t: f64x8::splat(t), q, v, ..Arguments::none() };
            routine.run(machine, &Environment { inputs: &self.inputs, ..at.into() }, out);
        }
    }
}
