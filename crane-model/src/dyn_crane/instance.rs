//! Adapts cranes with the number of coordinates in their type to the traits on slices.

use std::ops::{Deref, DerefMut};

use nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector3};

use super::{
    DynBlock, DynCrane, DynDerivatives, DynDynamics, DynEnsemble, DynImplicit, DynInternalForces, DynLinearise,
    DynModel, DynStatics, DynSystem,
};
use crate::{
    CraneModel, Description, Dynamics, Ensemble, Implicit, InternalForces, LaneDynamics, Linearisation, Linearise,
    LoopJointInfo, ParameterError, SectionModuli, Statics, Tension, TransformDerivatives, Wrench, rt::lanes::f64x8,
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

    fn transforms(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.0.transforms(&vector(q), out);
    }

    fn points(&self, q: &[f64], out: &mut [Vector3<f64>]) {
        self.0.points(&vector(q), out);
    }

    fn point_velocities(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.0.point_velocities(&vector(q), &vector(v), out);
    }

    fn forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.forces(t, &vector(q), &vector(v)).as_slice());
    }

    fn element_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.element_forces(&vector(q), &vector(v)).as_slice());
    }

    fn drive_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.drive_forces(t, &vector(q), &vector(v)).as_slice());
    }

    fn stop_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.stop_forces(&vector(q), &vector(v)).as_slice());
    }

    fn friction_forces(&self, v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.friction_forces(&vector(v)).as_slice());
    }

    fn load_forces(&self, t: f64, q: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.load_forces(t, &vector(q)).as_slice());
    }

    fn connector_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.connector_forces(t, &vector(q), &vector(v)).as_slice());
    }

    fn connector_lengths(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.0.connector_lengths(&vector(q), &vector(v), out);
    }

    fn connector_tensions(&self, t: f64, q: &[f64], v: &[f64], out: &mut [Tension]) {
        self.0.connector_tensions(t, &vector(q), &vector(v), out);
    }

    fn connector_jacobians(&self, q: &[f64], out: &mut [f64]) {
        self.0.connector_jacobians(&vector(q), out.as_chunks_mut().0);
    }

    fn loop_joints(&self) -> &[LoopJointInfo] {
        self.0.loop_joints()
    }

    fn loop_states(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.0.loop_states(&vector(q), &vector(v), out);
    }

    fn loop_jacobians(&self, q: &[f64], out: &mut [f64]) {
        self.0.loop_jacobians(&vector(q), out.as_chunks_mut().0);
    }

    fn winch_pieces(&self, out: &mut [[f64; 2]]) {
        self.0.winch_pieces(out);
    }

    fn load_pieces(&self, out: &mut [[f64; 2]]) {
        self.0.load_pieces(out);
    }

    fn support_reactions(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.0.support_reactions(&vector(q), &vector(v), out);
    }

    fn support_gaps(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.0.support_gaps(&vector(q), &vector(v), out);
    }

    fn cylinder_states(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.0.cylinder_states(&vector(q), &vector(v), out);
    }

    fn cylinder_jacobians(&self, q: &[f64], out: &mut [f64]) {
        self.0.cylinder_jacobians(&vector(q), out.as_chunks_mut().0);
    }

    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]) {
        self.0.drive_motions(t, out);
    }

    fn drive_limits(&self, t: f64, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.0.drive_limits(t, &vector(q), &vector(v), out);
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        let (mut pose, mut rates) = (vector(q), vector(v));
        self.0.prescribe(t, &mut pose, &mut rates);
        q.copy_from_slice(pose.as_slice());
        v.copy_from_slice(rates.as_slice());
    }

    fn valve_openings(&self, t: f64, out: &mut [[f64; 2]]) {
        self.0.valve_openings(t, out);
    }

    fn drive_pieces(&self, out: &mut [[f64; 2]]) {
        self.0.drive_pieces(out);
    }

    fn gravity_energy(&self, q: &[f64]) -> f64 {
        self.0.gravity_energy(&vector(q))
    }

    fn support_energy(&self, q: &[f64]) -> f64 {
        self.0.support_energy(&vector(q))
    }

    fn element_energy(&self, q: &[f64]) -> f64 {
        self.0.element_energy(&vector(q))
    }

    fn drive_energy(&self, t: f64, q: &[f64]) -> f64 {
        self.0.drive_energy(t, &vector(q))
    }

    fn stop_energy(&self, q: &[f64]) -> f64 {
        self.0.stop_energy(&vector(q))
    }

    fn drive_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.0.drive_power(t, &vector(q), &vector(v))
    }

    fn connector_energy(&self, t: f64, q: &[f64]) -> f64 {
        self.0.connector_energy(t, &vector(q))
    }

    fn winch_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.0.winch_power(t, &vector(q), &vector(v))
    }

    fn load_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.0.load_power(t, &vector(q), &vector(v))
    }

    fn dissipation(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.0.dissipation(t, &vector(q), &vector(v))
    }

    fn size(&self) -> usize {
        N
    }
}

impl<const N: usize, H: Deref<Target: Statics<N>> + Send + Sync> DynStatics for Instance<N, H> {
    fn static_residual(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.static_residual(t, &vector(q), &vector(positions)).as_slice());
    }

    fn tangent_stiffness(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.tangent_stiffness(t, &vector(q), &vector(positions)).as_slice());
    }

    fn drive_forces_at_rest(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.drive_forces_at_rest(t, &vector(q), &vector(positions)).as_slice());
    }
}

impl<const N: usize, H: Deref<Target: Dynamics<N>> + Send + Sync> DynDynamics for Instance<N, H> {
    fn mass_matrix(&self, q: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.mass_matrix(&vector(q)).as_slice());
    }

    fn bias(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.bias(&vector(q), &vector(v)).as_slice());
    }

    fn forward_dynamics(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.forward_dynamics(t, &vector(q), &vector(v)).as_slice());
    }

    fn solve_mass(&self, q: &[f64], r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.0.solve_mass(&vector(q), &vector(r)).as_slice());
    }

    fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.0.kinetic_energy(&vector(q), &vector(v))
    }
}

impl<const N: usize, H: Deref<Target: Implicit<N> + Sized> + Send + Sync> DynImplicit for Instance<N, H> {
    fn system(&self) -> Box<dyn DynSystem + '_> {
        Box::new(System::<N, H::Target> { crane: &self.0, factors: None })
    }

    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        self.0.joint_stiffness_and_damping(out);
    }

    fn nonlinear_stiffness_and_damping(&self, t: f64, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.0.nonlinear_stiffness_and_damping(t, &vector(q), &vector(v), out);
    }

    fn base_stiffness(&self, q: &[f64], v: &[f64]) -> Matrix6<f64> {
        self.0.base_stiffness(&vector(q), &vector(v))
    }

    fn base_damping(&self, q: &[f64], v: &[f64]) -> Matrix6<f64> {
        self.0.base_damping(&vector(q), &vector(v))
    }
}

/// A linear system and its factors.
struct System<'a, const N: usize, C: Implicit<N>> {
    crane: &'a C,
    factors: Option<C::Factors>,
}

impl<const N: usize, C: Implicit<N>> DynSystem for System<'_, N, C> {
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &Matrix6<f64>) {
        self.factors = Some(self.crane.factorise(&vector(q), &vector(added_inertia), base));
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
    fn internal_forces(&self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [Wrench]) {
        self.0.internal_forces(t, &vector(q), &vector(v), &vector(a), out);
    }

    fn cylinder_wrenches(&self, q: &[f64], out: &mut [Wrench]) {
        self.0.cylinder_wrenches(&vector(q), out);
    }

    fn connector_wrenches(&self, q: &[f64], out: &mut [Wrench]) {
        self.0.connector_wrenches(&vector(q), out);
    }

    fn loop_wrenches(&self, q: &[f64], out: &mut [Wrench]) {
        self.0.loop_wrenches(&vector(q), out);
    }

    fn support_positions(&self, q: &[f64], out: &mut [Vector3<f64>]) {
        self.0.support_positions(&vector(q), out);
    }

    fn section_moduli(&self, out: &mut [SectionModuli]) {
        self.0.section_moduli(out);
    }
}

impl<const N: usize, H: Deref<Target: TransformDerivatives<N>> + Send + Sync> DynDerivatives for Instance<N, H> {
    fn transform_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.0.transform_derivatives(&vector(q), out);
    }

    fn transform_second_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.0.transform_second_derivatives(&vector(q), out);
    }
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
