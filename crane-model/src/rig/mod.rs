//! Any generated crane through one pointer, on slices.
//!
//! The command, and whoever picks a crane at run time, handles all cranes with one code path; only what is behind
//! [`Rig`] is compiled for each.

mod declare;
mod instance;

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector, Matrix4, Vector3};

pub use instance::{Crane, Instance, boxed};

use crate::{
    CoordinateKind, CoordinateRole, Description, ParameterError, dynamics,
    dynamics::{Run, Sample, Stopped},
    modes::SmallMotions,
    statics,
    statics::Equilibrium,
};

/// Energies of a crane, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Kinetic energy, Eq. (4).
    pub kinetic: f64,
    /// Potential energy of gravity, Eq. (6).
    pub gravity: f64,
    /// Springs of the supports, Eq. (17).
    pub supports: f64,
    /// Springs between rigid elements, Eq. (14).
    pub elements: f64,
    /// Springs of the drives, Eq. (19).
    pub drives: f64,
}

impl Energies {
    /// Kinetic and potential energy together.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravity + self.supports + self.elements + self.drives
    }
}

/// A crane of an ensemble.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Values of its live parameters, in the order of the description.
    pub parameters: Vec<f64>,
    /// Pose from which it starts, at rest, m and rad.
    pub start: Vec<f64>,
}

/// A crane of any number of coordinates: the traits of a generated crane, on slices.
///
/// # Panics
/// Every method that takes `q` or `v` or a start panics where its length is not the number of coordinates.
pub trait Rig: Send + Sync {
    /// Names, units and settings.
    fn description(&self) -> &'static Description;

    /// Value of a live parameter, by its place in the description.
    fn parameter(&self, index: usize) -> f64;

    /// Sets a live parameter.
    ///
    /// # Errors
    /// The value breaks a rule of the spec language.
    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError>;

    /// Sets the first live parameters together: [`CraneModel::set_parameters`](crate::CraneModel::set_parameters).
    ///
    /// # Errors
    /// A value breaks a rule of the spec language.
    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError>;

    /// Transforms of all bodies into the world frame.
    fn transforms(&self, q: &[f64]) -> Vec<Matrix4<f64>>;

    /// `∂T/∂q_j`, body by body, for the coordinates j that move it.
    fn transform_derivatives(&self, q: &[f64]) -> Vec<Matrix4<f64>>;

    /// `∂²T/∂q_m∂q_n`, body by body, for the pairs m ≤ n of the coordinates that move it.
    fn transform_second_derivatives(&self, q: &[f64]) -> Vec<Matrix4<f64>>;

    /// Positions of the points of interest, m.
    fn points(&self, q: &[f64]) -> Vec<Vector3<f64>>;

    /// Velocities of the points of interest, m/s.
    fn point_velocities(&self, q: &[f64], v: &[f64]) -> Vec<Vector3<f64>>;

    /// Mass matrix A.
    fn mass_matrix(&self, q: &[f64]) -> DMatrix<f64>;

    /// Velocity and gravity forces e.
    fn bias(&self, q: &[f64], v: &[f64]) -> DVector<f64>;

    /// Accelerations q̈, m/s² and rad/s².
    fn accelerations(&self, t: f64, q: &[f64], v: &[f64]) -> DVector<f64>;

    /// Torques and forces of the drives, in their order: N m and N.
    fn drive_efforts(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64>;

    /// Prescribed positions and rates of the drives.
    fn drive_motions(&self, t: f64) -> Vec<[f64; 2]>;

    /// Moments that the springs and dampers between rigid elements transmit, `k q + d q̇`, one a coordinate of an element in
    /// the order of `q`: positive where they resist a positive deformation. N m.
    fn element_moments(&self, q: &[f64], v: &[f64]) -> Vec<f64>;

    /// Forces of the supports on the crane, N.
    fn support_reactions(&self, q: &[f64], v: &[f64]) -> Vec<Vector3<f64>>;

    /// Weight of the crane with its load, world frame, N; unknown along an axis that the base cannot move along.
    ///
    /// A translation of the base moves everything alike: its generalized force of gravity, the bias at rest, is the part
    /// of the weight along it.
    fn weight(&self, q: &[f64]) -> [Option<f64>; 3] {
        /// A base moves along an axis where its directions hold all of it but for rounding.
        const ROUNDING: f64 = 1e-9;
        let (bias, derivatives) = (self.bias(q, &vec![0.0; q.len()]), self.transform_derivatives(q));
        let (mut weight, mut held) = (Vector3::zeros(), Vector3::zeros());
        // The derivatives of the base come first, one a coordinate.
        for ((coordinate, derivative), force) in self.description().coordinates.iter().zip(&derivatives).zip(&bias) {
            if (coordinate.role, coordinate.kind) == (CoordinateRole::Base, CoordinateKind::Translation) {
                let direction = derivative.fixed_view::<3, 1>(0, 3);
                weight += direction * *force;
                held += direction.component_mul(&direction);
            }
        }
        [0, 1, 2].map(|axis| (held[axis] > 1.0 - ROUNDING).then_some(weight[axis]))
    }

    /// Energies by part.
    fn energies(&self, t: f64, q: &[f64], v: &[f64]) -> Energies;

    /// The guess for the present parameters: [`statics::guess`].
    fn guess(&self) -> Vec<f64>;

    /// Static equilibrium from the guess: [`statics::solve`].
    fn equilibrium(&self, settings: &statics::Settings) -> Equilibrium;

    /// Equilibrium with the drives as at time `t`, from pose `q`: [`statics::solve_at`].
    fn equilibrium_at(&self, t: f64, q: &[f64], settings: &statics::Settings) -> Equilibrium;

    /// Coefficients of small motions about a pose at rest.
    fn small_motions(&self, q: &[f64]) -> SmallMotions;

    /// A run from pose `q` at rest: [`dynamics::simulate`].
    ///
    /// # Errors
    /// The run grew without bound.
    fn simulate(
        &self,
        q: &[f64],
        settings: &dynamics::Settings,
        observe: &mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>,
    ) -> Result<Run, Stopped>;

    /// Runs of cranes that differ in their parameters, eight at a time: [`dynamics::ensemble::simulate`].
    ///
    /// # Errors
    /// The parameters of a member break a rule of the spec language.
    fn simulate_ensemble(
        &self,
        members: &[Member],
        settings: &dynamics::Settings,
        observe: &mut dyn FnMut(usize, &Sample<'_>),
    ) -> Result<Vec<Result<Run, Stopped>>, ParameterError>;

    /// A crane of its own with the same parameters.
    fn boxed_clone(&self) -> Box<dyn Rig>;
}
