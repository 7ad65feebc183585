//! Computations that keep numbers between calls: linear systems of implicit steps, and eight cranes at a time.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{DynBlock, DynCrane, DynEnsemble, DynImplicit, DynModel, DynSystem};
use crane_model::rt::lanes::f64x8;
use crane_model::{ParameterError, entry_type, slice_argument};
use crane_quantities::quantities;

use super::fleet::Fleet;
use super::methods::{method, methods};
use super::{LiveCrane, at};
use crate::machine::{Arguments, Machine};
use crate::native::is_slower_in_lanes;
use crate::routine::Routine;

impl DynImplicit for LiveCrane {
    fn system(&self) -> Box<dyn DynSystem + '_> {
        let ready = |id: FunctionId| {
            let routine = self.library.routine(id)?;
            Some((routine, routine.machine(&self.parameters)))
        };
        let factors = self.library.routine(FunctionId::Factorise).map_or(0, Routine::results);
        Box::new(System {
            factorise: ready(FunctionId::Factorise),
            solve: ready(FunctionId::Solve),
            factors: vec![f64::NAN; factors],
            version: 1,
        })
    }

    quantities! { methods of Implicit }
}

/// A function and the machine for its calls.
type Ready<'a, T> = Option<(&'a Routine, Machine<T>)>;

/// Linear systems, with the factors of the last one.
struct System<'a> {
    factorise: Ready<'a, f64>,
    solve: Ready<'a, f64>,
    factors: Vec<f64>,
    /// Their number.
    version: u64,
}

impl DynSystem for System<'_> {
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &[f64]) {
        if let Some((routine, machine)) = &mut self.factorise {
            let arguments = Arguments { added_inertia, base, ..at(q) };
            routine.run(machine, &arguments, &mut self.factors);
            self.version += 1;
        }
    }

    fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        if let Some((routine, machine)) = &mut self.solve {
            let Self { factors, version, .. } = self;
            routine.run(machine, &Arguments { factors, version: *version, r, ..Arguments::none() }, out);
        }
    }
}

impl DynEnsemble for LiveCrane {
    fn fleet(&self, cranes: &[&dyn DynModel]) -> Option<Box<dyn DynCrane>> {
        let has_fleets = self.description.has_fleets(&self.loop_joints) && !cranes.is_empty() && !is_slower_in_lanes();
        has_fleets.then(|| -> Box<dyn DynCrane> { Box::new(Fleet::new(self, cranes)) })
    }

    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError> {
        let lanes = parameters.iter().map(|values| self.with_first(values)).collect::<Result<Vec<_>, _>>()?;
        // Unused lanes are copies of this crane.
        let of = |lane: usize| lanes.get(lane).unwrap_or(&self.parameters);
        let eight = |index: usize| f64x8::new(std::array::from_fn(|lane| of(lane)[index]));
        let parameters: Vec<f64x8> = (0..self.parameters.len()).map(eight).collect();
        let routine = self.library.routine(FunctionId::ForwardDynamics);
        Ok(Box::new(Block {
            ready: routine.map(|routine| (routine, routine.machine(&parameters))),
            inputs: self.inputs.numbers().map(f64x8::splat).collect(),
        }))
    }
}

/// Eight cranes.
struct Block<'a> {
    ready: Ready<'a, f64x8>,
    inputs: Vec<f64x8>,
}

impl DynBlock for Block<'_> {
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]) {
        if let Some((routine, machine)) = &mut self.ready {
            let arguments = Arguments { t: f64x8::splat(t), q, v, inputs: &self.inputs, ..Arguments::none() };
            routine.run(machine, &arguments, out);
        }
    }
}
