//! Adapts cranes with the number of coordinates in their type to the traits on slices.

use std::ops::{Deref, DerefMut};

use crane_quantities::quantities;
use nalgebra::{Matrix6, SMatrix, SVector};

use super::methods::{instance_method, instance_methods, sized};
use super::{
    DynBlock, DynCrane, DynDerivatives, DynDynamics, DynEnsemble, DynImplicit, DynInternalForces, DynLinearise,
    DynModel, DynMotionDerivatives, DynStatics, DynSystem,
};
use crate::{
    CraneModel, Description, Dynamics, Ensemble, Implicit, InternalForces, LaneDynamics, Linearisation, Linearise,
    LoopJointInfo, MotionDerivatives, ParameterError, StageInfo, Statics, TransformDerivatives, entry_type,
    rt::lanes::f64x8, slice_argument,
};

/// A crane compiled with every analysis except derivatives.
pub trait Crane<const N: usize>:
    Implicit<N> + Ensemble<N> + Statics<N> + Linearise<N> + InternalForces<N> + Clone
{
}

impl<const N: usize, C> Crane<N> for C where
    C: Implicit<N> + Ensemble<N> + Statics<N> + Linearise<N> + InternalForces<N> + Clone
{
}

/// Adapts a crane of `N` coordinates, in a reference or a box, to slices: `Instance(&crane)`, `Instance(Box::new(crane))`.
///
/// It implements each trait of this module whose counterpart the crane implements.
#[derive(Clone, Copy, Debug)]
pub struct Instance<const N: usize, H>(pub H);

/// A boxed crane with the parameters of its spec.
pub fn boxed<const N: usize, C: Crane<N> + Default + Send + Sync + 'static>() -> Box<dyn DynCrane> {
    Box::new(Instance::<N, _>(Box::new(C::default())))
}

#[inline]
fn vector<T: nalgebra::Scalar + Copy, const N: usize>(slice: &[T]) -> SVector<T, N> {
    SVector::from(<[T; N]>::try_from(slice).expect("as many numbers as coordinates"))
}

impl<const N: usize, H: Deref<Target: CraneModel<N>> + Send + Sync> DynModel for Instance<N, H> {
    fn description(&self) -> &Description {
        self.0.description()
    }

    fn parents(&self) -> &[usize] {
        self.0.parents()
    }

    fn parameter(&self, index: usize) -> f64 {
        self.0.parameter(index)
    }

    fn input(&self, index: usize) -> Option<f64> {
        self.0.input(index)
    }

    fn loop_joints(&self) -> &[LoopJointInfo] {
        self.0.loop_joints()
    }

    fn stages(&self) -> &[StageInfo] {
        self.0.stages()
    }

    fn stage_height(&self, stage: usize) -> f64 {
        self.0.stage_height(stage)
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

    quantities! { instance_methods of CraneModel }
}

impl<const N: usize, H: Deref<Target: Statics<N>> + Send + Sync> DynStatics for Instance<N, H> {
    quantities! { instance_methods of Statics }
}

impl<const N: usize, H: Deref<Target: Dynamics<N>> + Send + Sync> DynDynamics for Instance<N, H> {
    quantities! { instance_methods of Dynamics }
}

impl<const N: usize, H: Deref<Target: Implicit<N> + Sized> + Send + Sync> DynImplicit for Instance<N, H> {
    fn system(&self) -> Box<dyn DynSystem + '_> {
        Box::new(System::<N, H::Target> { crane: &self.0, factors: None })
    }

    quantities! { instance_methods of Implicit }
}

/// A linear system and its factors.
struct System<'a, const N: usize, C: Implicit<N>> {
    crane: &'a C,
    factors: Option<C::Factors>,
}

impl<const N: usize, C: Implicit<N>> DynSystem for System<'_, N, C> {
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

impl<const N: usize, H: Deref<Target: Linearise<N>> + Send + Sync> DynLinearise for Instance<N, H> {
    fn linearise(&self, q: &[f64], mass: &mut [f64], stiffness: &mut [f64], damping: &mut [f64]) {
        let Linearisation { mass: a, stiffness: k, damping: d } = self.0.linearise(&vector(q));
        let write = |out: &mut [f64], matrix: &SMatrix<f64, N, N>| out.copy_from_slice(matrix.as_slice());
        write(mass, &a);
        write(stiffness, &k);
        write(damping, &d);
    }
}

impl<const N: usize, H: Deref<Target: Ensemble<N> + Clone> + Send + Sync> DynEnsemble for Instance<N, H> {
    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError> {
        let mut cranes: [H::Target; 8] = std::array::from_fn(|_| self.0.deref().clone());
        for (crane, parameters) in cranes.iter_mut().zip(parameters) {
            crane.set_parameters(parameters)?;
        }
        Ok(Box::new(Block::<N, _>(H::Target::lanes(cranes.each_ref()))))
    }
}

/// A block of eight cranes.
pub(crate) struct Block<const N: usize, L>(pub L);

impl<const N: usize, L: LaneDynamics<N>> DynBlock for Block<N, L> {
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]) {
        out.copy_from_slice(self.0.forward_dynamics(f64x8::splat(t), &vector(q), &vector(v)).as_slice());
    }
}

impl<const N: usize, H: Deref<Target: InternalForces<N>> + Send + Sync> DynInternalForces for Instance<N, H> {
    quantities! { instance_methods of InternalForces }
}

impl<const N: usize, H: Deref<Target: TransformDerivatives<N>> + Send + Sync> DynDerivatives for Instance<N, H> {
    quantities! { instance_methods of TransformDerivatives }
}

impl<const N: usize, H: Deref<Target: MotionDerivatives<N>> + Send + Sync> DynMotionDerivatives for Instance<N, H> {
    fn forward_dynamics_derivatives(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.0.forward_dynamics_derivatives(t, &vector(q), &vector(v), out.as_chunks_mut().0);
    }

    quantities! { instance_methods of MotionDerivatives }
}

impl<const N: usize, H> DynCrane for Instance<N, H>
where
    H: DerefMut<Target: Crane<N>> + Clone + Send + Sync + 'static,
{
    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        self.0.set_parameter(index, value)
    }

    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError> {
        self.0.set_parameters(values)
    }

    fn set_input(&mut self, index: usize, value: Option<f64>) {
        self.0.set_input(index, value);
    }

    fn boxed_clone(&self) -> Box<dyn DynCrane> {
        Box::new(self.clone())
    }
}
