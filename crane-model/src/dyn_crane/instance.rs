//! Adapts cranes with the number of coordinates in their type to the trait on slices.

use bytemuck::{cast_slice_mut, try_cast_slice_mut};
use crane_quantities::{FunctionId, Part, quantities};
use nalgebra::{Matrix6, SMatrix, SVector};

use super::methods::{call_sized, call_sized_row, sized};
use super::{Arguments, Derived, DynBlock, DynCrane, DynSystem, Functions};
use crate::{
    CraneModel, Description, LaneDynamics, Linearisation, LoopJointInfo, ParameterError, StageInfo, rt::lanes::f64x8,
};

/// Adapts a crane of `N` coordinates to slices.
#[derive(Clone, Copy, Debug)]
pub struct Instance<const N: usize, C>(pub C);

/// A boxed crane with the parameters of its spec; it has every analysis but derivatives, which few need.
pub fn boxed<const N: usize, C: CraneModel<N> + Default>() -> Box<dyn DynCrane> {
    const {
        Part::Statics.require(C::PARTS);
        Part::Dynamics.require(C::PARTS);
        Part::Modes.require(C::PARTS);
        Part::InternalForces.require(C::PARTS);
    }
    Box::new(Instance::<N, _>(C::default()))
}

#[inline]
fn vector<T: nalgebra::Scalar + Copy, const N: usize>(slice: &[T]) -> SVector<T, N> {
    SVector::from(<[T; N]>::try_from(slice).expect("as many numbers as coordinates"))
}

/// No results.
fn absent(out: &mut [f64]) -> Derived {
    out.fill(f64::NAN);
    Derived::No
}

impl<const N: usize, C: CraneModel<N>> Instance<N, C> {
    /// Functions whose methods are written by hand.
    fn call_other(&self, id: FunctionId, at: &Arguments<'_>, out: &mut [f64]) -> Derived {
        match id {
            FunctionId::Linearise => {
                let Linearisation { mass, stiffness, damping } = self.0.linearise(&vector(at.q));
                let numbers =
                    [mass, stiffness, damping].into_iter().flat_map(|matrix| matrix.data.0.into_iter().flatten());
                out.iter_mut().zip(numbers).for_each(|(out, number)| *out = number);
            }
            FunctionId::ForwardDynamicsDerivatives => {
                self.0.forward_dynamics_derivatives(at.t, &vector(at.q), &vector(at.v), out.as_chunks_mut().0);
            }
            // They fill types of their own, see `prescribe` and `system`.
            _ => return absent(out),
        }
        Derived::Yes
    }
}

impl<const N: usize, C: CraneModel<N>> Functions for Instance<N, C> {
    fn call(&self, id: FunctionId, at: &Arguments<'_>, out: &mut [f64]) -> Derived {
        quantities! { @(call_sized) [id { return absent(out) } (self.0, at, out, return self.call_other(id, at, out))] }
        Derived::Yes
    }

    fn description(&self) -> &Description {
        self.0.description()
    }

    fn loop_joints(&self) -> &[LoopJointInfo] {
        self.0.loop_joints()
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        let (mut pose, mut rates) = (vector(q), vector(v));
        self.0.prescribe(t, &mut pose, &mut rates);
        q.copy_from_slice(pose.as_slice());
        v.copy_from_slice(rates.as_slice());
    }

    fn size(&self) -> usize {
        N
    }

    fn system(&self) -> Box<dyn DynSystem + '_> {
        Box::new(InstanceSystem { crane: &self.0, factors: None })
    }
}

impl<const N: usize, C: CraneModel<N>> DynCrane for Instance<N, C> {
    fn parents(&self) -> &[usize] {
        self.0.parents()
    }

    fn parameter(&self, index: usize) -> f64 {
        self.0.parameter(index)
    }

    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        self.0.set_parameter(index, value)
    }

    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError> {
        self.0.set_parameters(values)
    }

    fn input(&self, index: usize) -> Option<f64> {
        self.0.input(index)
    }

    fn set_input(&mut self, index: usize, value: Option<f64>) {
        self.0.set_input(index, value);
    }

    fn boxed_clone(&self) -> Box<dyn DynCrane> {
        Box::new(self.clone())
    }

    fn stages(&self) -> &[StageInfo] {
        self.0.stages()
    }

    fn stage_height(&self, stage: usize) -> f64 {
        self.0.stage_height(stage)
    }

    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError> {
        let mut cranes: [C; 8] = std::array::from_fn(|_| self.0.clone());
        for (crane, parameters) in cranes.iter_mut().zip(parameters) {
            crane.set_parameters(parameters)?;
        }
        Ok(Box::new(Block::<N, _>(C::lanes(cranes.each_ref()))))
    }
}

/// A linear system and its factors.
struct InstanceSystem<'a, const N: usize, C: CraneModel<N>> {
    crane: &'a C,
    factors: Option<C::Factors>,
}

impl<const N: usize, C: CraneModel<N>> DynSystem for InstanceSystem<'_, N, C> {
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &[f64]) {
        let base = Matrix6::from_column_slice(base);
        self.factors = Some(self.crane.factorise(&vector(q), &vector(added_inertia), &base));
    }

    fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        match &self.factors {
            Some(factors) => out.copy_from_slice(self.crane.solve(factors, &vector(r)).as_slice()),
            None => out.fill(f64::NAN),
        }
    }
}

/// A block of eight cranes.
pub(crate) struct Block<const N: usize, L>(pub L);

impl<const N: usize, L: LaneDynamics<N>> DynBlock for Block<N, L> {
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]) {
        out.copy_from_slice(self.0.forward_dynamics(f64x8::splat(t), &vector(q), &vector(v)).as_slice());
    }
}
