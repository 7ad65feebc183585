//! A generated crane behind [`Rig`].

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector, Matrix4, SVector, Vector3};

use super::{Energies, Member, Rig};
use crate::{
    CoordinateRole, Description, Ensemble, Implicit, Linearise, ParameterError, Statics, TransformDerivatives,
    dynamics,
    dynamics::{Run, Sample, Stopped, rk4},
    modes::SmallMotions,
    statics,
    statics::Equilibrium,
};

/// A crane compiled with every analysis.
pub trait Crane<const N: usize>:
    Implicit<N> + Ensemble<N> + Statics<N> + Linearise<N> + TransformDerivatives<N> + Clone
{
}

impl<const N: usize, C> Crane<N> for C where
    C: Implicit<N> + Ensemble<N> + Statics<N> + Linearise<N> + TransformDerivatives<N> + Clone
{
}

/// A crane of `N` coordinates behind [`Rig`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Instance<const N: usize, C>(pub C);

/// A crane with the parameters of its spec behind a pointer.
pub fn boxed<const N: usize, C: Crane<N> + Default + Send + Sync + 'static>() -> Box<dyn Rig> {
    Box::new(Instance::<N, C>(C::default()))
}

fn vector<const N: usize>(slice: &[f64]) -> SVector<f64, N> {
    SVector::from_column_slice(slice)
}

impl<const N: usize, C: Crane<N> + Send + Sync + 'static> Rig for Instance<N, C> {
    fn description(&self) -> &'static Description {
        self.0.description()
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

    fn transforms(&self, q: &[f64]) -> Vec<Matrix4<f64>> {
        let mut out = vec![Matrix4::identity(); self.description().bodies.len()];
        self.0.transforms(&vector(q), &mut out);
        out
    }

    fn transform_derivatives(&self, q: &[f64]) -> Vec<Matrix4<f64>> {
        let count = self.description().bodies.iter().map(|body| body.degrees_of_freedom).sum();
        let mut out = vec![Matrix4::zeros(); count];
        self.0.transform_derivatives(&vector(q), &mut out);
        out
    }

    fn transform_second_derivatives(&self, q: &[f64]) -> Vec<Matrix4<f64>> {
        let pairs = |n: usize| n * (n + 1) / 2;
        let count = self.description().bodies.iter().map(|body| pairs(body.degrees_of_freedom)).sum();
        let mut out = vec![Matrix4::zeros(); count];
        self.0.transform_second_derivatives(&vector(q), &mut out);
        out
    }

    fn points(&self, q: &[f64]) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().points.len()];
        self.0.points(&vector(q), &mut out);
        out
    }

    fn point_velocities(&self, q: &[f64], v: &[f64]) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().points.len()];
        self.0.point_velocities(&vector(q), &vector(v), &mut out);
        out
    }

    fn mass_matrix(&self, q: &[f64]) -> DMatrix<f64> {
        DMatrix::from_column_slice(N, N, self.0.mass_matrix(&vector(q)).as_slice())
    }

    fn bias(&self, q: &[f64], v: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(self.0.bias(&vector(q), &vector(v)).as_slice())
    }

    fn accelerations(&self, t: f64, q: &[f64], v: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(self.0.forward_dynamics(t, &vector(q), &vector(v)).as_slice())
    }

    fn drive_efforts(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        let forces = self.0.drive_forces(t, &vector(q), &vector(v));
        self.description().drives.iter().map(|drive| forces[drive.coordinate]).collect()
    }

    fn drive_motions(&self, t: f64) -> Vec<[f64; 2]> {
        let mut out = vec![[0.0; 2]; self.description().drives.len()];
        self.0.drive_motions(t, &mut out);
        out
    }

    fn element_moments(&self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let forces = self.0.element_forces(&vector(q), &vector(v));
        let coordinates = self.description().coordinates.iter().zip(&forces);
        coordinates
            .filter(|(coordinate, _)| coordinate.role == CoordinateRole::Element)
            .map(|(_, force)| -force)
            .collect()
    }

    fn support_reactions(&self, q: &[f64], v: &[f64]) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().supports.len()];
        self.0.support_reactions(&vector(q), &vector(v), &mut out);
        out
    }

    fn energies(&self, t: f64, q: &[f64], v: &[f64]) -> Energies {
        let (q, v) = (vector(q), vector(v));
        Energies {
            kinetic: self.0.kinetic_energy(&q, &v),
            gravity: self.0.gravity_energy(&q),
            supports: self.0.support_energy(&q),
            elements: self.0.element_energy(&q),
            drives: self.0.drive_energy(t, &q),
        }
    }

    fn guess(&self) -> Vec<f64> {
        statics::guess(&self.0).as_slice().to_vec()
    }

    fn equilibrium(&self, settings: &statics::Settings) -> Equilibrium {
        statics::solve(&self.0, settings)
    }

    fn equilibrium_at(&self, t: f64, q: &[f64], settings: &statics::Settings) -> Equilibrium {
        statics::solve_at(&self.0, t, vector(q), settings)
    }

    fn small_motions(&self, q: &[f64]) -> SmallMotions {
        (&self.0.linearise(&vector(q))).into()
    }

    fn simulate(
        &self,
        q: &[f64],
        settings: &dynamics::Settings,
        observe: &mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>,
    ) -> Result<Run, Stopped> {
        dynamics::simulate(&self.0, rk4::State::at_rest(vector(q)), settings, observe)
    }

    fn simulate_ensemble(
        &self,
        members: &[Member],
        settings: &dynamics::Settings,
        observe: &mut dyn FnMut(usize, &Sample<'_>),
    ) -> Result<Vec<Result<Run, Stopped>>, ParameterError> {
        let member = |member: &Member| {
            let mut crane = self.0.clone();
            crane.set_parameters(&member.parameters)?;
            Ok((crane, rk4::State::at_rest(vector(&member.start))))
        };
        let cranes: Vec<_> = members.iter().map(member).collect::<Result<_, _>>()?;
        Ok(dynamics::ensemble::simulate(&cranes, settings, observe))
    }

    fn boxed_clone(&self) -> Box<dyn Rig> {
        Box::new(Self(self.0.clone()))
    }
}
