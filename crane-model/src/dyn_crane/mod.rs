//! Cranes of any size through one pointer: the traits of a generated crane on slices.
//!
//! Statics, integrators, modes and stability are implemented once, in terms of these traits. A trait here is the counterpart of
//! a trait with the number of coordinates in its type; [`Instance`] adapts one to the other.
//!
//! | here | counterpart | used by |
//! |---|---|---|
//! | [`DynModel`] | [`CraneModel`](crate::CraneModel) | everything |
//! | [`DynStatics`] | [`Statics`](crate::Statics) | the crane at rest |
//! | [`DynDynamics`] | [`Dynamics`](crate::Dynamics) | explicit methods |
//! | [`DynImplicit`] | [`Implicit`](crate::Implicit) | implicit methods |
//! | [`DynLinearise`] | [`Linearise`](crate::Linearise) | modes, stability |
//! | [`DynLineariseMotion`] | none: only cranes that are not compiled have it | modes about a motion |
//! | [`DynInternalForces`] | [`InternalForces`](crate::InternalForces) | bearing loads, stresses |
//! | [`DynEnsemble`] | [`Ensemble`](crate::Ensemble) | runs of many cranes |
//! | [`DynDerivatives`] | [`TransformDerivatives`](crate::TransformDerivatives) | tables of derivatives |
//! | [`DynCrane`] | all of them except derivatives | the command |
//!
//! # Slices
//! `q`, `v`, `r` and results per coordinate have as many numbers as [`Description::coordinates`], in that order; lists of
//! bodies, points, supports and drives as many as the description has. Results overwrite the contents of `out`. Symmetric
//! matrices are written in full. A method may panic if a slice has another length. Repeated calls do not allocate, because each
//! method keeps its workspace.

mod declare;
mod instance;
mod quantities;

use nalgebra::{Matrix4, Matrix6, Vector3};

pub(crate) use instance::Block;
pub use instance::{Crane, Instance, boxed};
pub use quantities::Energies;

use crate::{Description, LoopJointInfo, ParameterError, SectionModuli, Tension, Wrench, rt::lanes::f64x8};

/// Poses, forces and potential energy of a crane: [`CraneModel`](crate::CraneModel) on slices.
pub trait DynModel: Send + Sync {
    /// Names, units and settings.
    fn description(&self) -> &Description;

    /// What the bodies of a crane with branches are attached to: for each body after the first, the index of an earlier one. Empty for a
    /// crane without branches.
    fn parents(&self) -> &[usize];

    /// Value of a live parameter, by its index in the description.
    fn parameter(&self, index: usize) -> f64;

    /// Value to which an input is set, by its index in the description; `None` while it follows its spec.
    fn input(&self, index: usize) -> Option<f64>;

    /// Transforms T of all bodies into the world frame.
    fn transforms(&self, q: &[f64], out: &mut [Matrix4<f64>]);

    /// Positions of the points of interest, m.
    fn points(&self, q: &[f64], out: &mut [Vector3<f64>]);

    /// Velocities of the points of interest, m/s.
    fn point_velocities(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]);

    /// Generalized forces of everything except inertia and gravity.
    fn forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]);

    /// Generalized forces of the springs and dampers between rigid elements.
    fn element_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]);

    /// Generalized forces of the drives.
    fn drive_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]);

    /// Generalized forces of the end stops.
    fn stop_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]);

    /// Generalized forces of joint friction.
    fn friction_forces(&self, v: &[f64], out: &mut [f64]);

    /// Generalized forces of the applied loads.
    fn load_forces(&self, t: f64, q: &[f64], out: &mut [f64]);

    /// Generalized forces of connectors.
    fn connector_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]);

    /// Length of every connector, m, and its rate, m/s.
    fn connector_lengths(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]);

    /// Force of every connector and its slopes.
    fn connector_tensions(&self, t: f64, q: &[f64], v: &[f64], out: &mut [Tension]);

    /// `∂ℓ/∂q` of every connector, row by row.
    fn connector_jacobians(&self, q: &[f64], out: &mut [f64]);

    /// The joints that close loops.
    fn loop_joints(&self) -> &[LoopJointInfo];

    /// φ, J q̇ and J̇ q̇ of every equation of the loop joints.
    fn loop_states(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]);

    /// `J = ∂φ/∂q` of the loop joints, row by row.
    fn loop_jacobians(&self, q: &[f64], out: &mut [f64]);

    /// Beginning and end of the intervals in which winches move smoothly, s; one pair per interval, connector by connector.
    fn winch_pieces(&self, out: &mut [[f64; 2]]);

    /// Beginning and end of the intervals in which the scales of loads are smooth, s; one pair per interval, load by load.
    fn load_pieces(&self, out: &mut [[f64; 2]]);

    /// Forces of the supports on the crane, world frame, N.
    fn support_reactions(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]);

    /// Height of each one-sided support above the ground, m, and its rate, m/s; 0 for all others.
    fn support_gaps(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]);

    /// Length of every cylinder, its rate, and its derivative with respect to the joint's coordinate.
    fn cylinder_states(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]);

    /// `∂ℓ/∂q` of every cylinder, row by row; nothing is written for a crane without valves.
    fn cylinder_jacobians(&self, q: &[f64], out: &mut [f64]);

    /// Prescribed position and rate of every drive.
    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]);

    /// Maximum effort of every drive, 0 if it has no limit, and its stiffness at the state.
    fn drive_limits(&self, t: f64, q: &[f64], v: &[f64], out: &mut [[f64; 2]]);

    /// Sets the coordinates that rigid drives prescribe, and their rates, at time t.
    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]);

    /// Command of the valve of every drive over time, −1 to 1, and its rate, 1/s; zeros without one.
    fn valve_openings(&self, t: f64, out: &mut [[f64; 2]]);

    /// Beginning and end of the intervals in which drives' motions and valves' commands are smooth, s; one pair per interval, drive by drive.
    fn drive_pieces(&self, out: &mut [[f64; 2]]);

    /// Potential energy of gravity, J.
    fn gravity_energy(&self, q: &[f64]) -> f64;

    /// Energy of the supports' springs, J.
    fn support_energy(&self, q: &[f64]) -> f64;

    /// Energy of the elements' springs, J.
    fn element_energy(&self, q: &[f64]) -> f64;

    /// Energy of the drives' springs, J.
    fn drive_energy(&self, t: f64, q: &[f64]) -> f64;

    /// Energy of the end stops, J.
    fn stop_energy(&self, q: &[f64]) -> f64;

    /// Power of the drives' motions, W.
    fn drive_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// Energy of connectors, J.
    fn connector_energy(&self, t: f64, q: &[f64]) -> f64;

    /// Power supplied by the winches, W.
    fn winch_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// Power supplied by the applied loads, W.
    fn load_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// Power that all dampers dissipate, W.
    fn dissipation(&self, t: f64, q: &[f64], v: &[f64]) -> f64;

    /// Number of equations of all loop joints.
    fn loop_equations(&self) -> usize {
        self.loop_joints().iter().map(|joint| joint.equations.len()).sum()
    }

    /// Number of coordinates.
    fn size(&self) -> usize {
        self.description().coordinates.len()
    }

    /// Positions of the drives' motions at time t, by coordinate.
    fn drive_positions_at(&self, t: f64) -> Vec<f64> {
        let mut motions = vec![[0.0; 2]; self.description().drives.len()];
        self.drive_motions(t, &mut motions);
        let positions: Vec<f64> = motions.iter().map(|[position, _]| *position).collect();
        self.description().by_coordinate(&positions)
    }
}

/// The crane at rest, with loads and winches as at time t and the drives at given positions, by coordinate: [`Statics`](crate::Statics) on
/// slices.
pub trait DynStatics: DynModel {
    /// `∂E_p/∂q`
    fn static_residual(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]);

    /// `∂²E_p/∂q²`, n × n.
    fn tangent_stiffness(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]);

    /// Generalized forces of the drives that hold the crane, including rigid drives and cylinders with a valve.
    fn drive_forces_at_rest(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]);
}

/// Equations of motion: [`Dynamics`](crate::Dynamics) on slices.
pub trait DynDynamics: DynModel {
    /// Mass matrix A, n × n.
    fn mass_matrix(&self, q: &[f64], out: &mut [f64]);

    /// Bias e: velocity and gravity forces on the right-hand side, the negative of Featherstone's C.
    fn bias(&self, q: &[f64], v: &[f64], out: &mut [f64]);

    /// Accelerations q̈.
    fn forward_dynamics(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]);

    /// The solution x of `A(q) x = r`.
    fn solve_mass(&self, q: &[f64], r: &[f64], out: &mut [f64]);

    /// Kinetic energy, J.
    fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64;
}

/// Functions for an implicit step: [`Implicit`](crate::Implicit) on slices.
pub trait DynImplicit: DynDynamics {
    /// Storage for the factors of a system of this crane; created once per run.
    fn system(&self) -> Box<dyn DynSystem + '_>;

    /// Stiffness and damping of elements, drives and joints on single coordinates; zero for the base's. `out`: one pair per
    /// coordinate.
    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]);

    /// Stiffness and damping of end stops and friction on single coordinates at a state. `out`: one pair per coordinate.
    fn nonlinear_stiffness_and_damping(&self, t: f64, q: &[f64], v: &[f64], out: &mut [[f64; 2]]);

    /// Stiffness over the base's coordinates at a state.
    fn base_stiffness(&self, q: &[f64], v: &[f64]) -> Matrix6<f64>;

    /// Damping over the base's coordinates at a state.
    fn base_damping(&self, q: &[f64], v: &[f64]) -> Matrix6<f64>;
}

/// Systems `(A(q) + D̂) x = r` of a crane, one after the other.
pub trait DynSystem: Send {
    /// Factorises `A(q) + D̂`, like [`Implicit::factorise`](crate::Implicit::factorise).
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &Matrix6<f64>);

    /// The solution x of the system that was factorised last; NaN before the first factorisation.
    fn solve(&mut self, r: &[f64], out: &mut [f64]);
}

/// Small motions about a pose at rest: [`Linearise`](crate::Linearise) on slices.
pub trait DynLinearise: DynModel {
    /// A, K and D at a pose, each n × n.
    fn linearise(&self, q: &[f64], mass: &mut [f64], stiffness: &mut [f64], damping: &mut [f64]);
}

/// Small motions about any motion.
pub trait DynLineariseMotion: DynDynamics {
    /// `A`, `K = ∂(A a − e − f)/∂q` and `D = −∂(e + f)/∂v` at time t, pose q, rates v and accelerations a, each n × n, column by
    /// column: `A δq̈ + D δq̇ + K δq = 0`. K and D contain centrifugal and gyroscopic terms and need not be symmetric. Coordinates that
    /// rigid drives prescribe oscillate separately at 1 rad/s.
    fn linearise_motion(
        &self,
        t: f64,
        motion: [&[f64]; 3],
        mass: &mut [f64],
        stiffness: &mut [f64],
        damping: &mut [f64],
    );
}

/// Forces and moments between the parts of a crane: [`InternalForces`](crate::InternalForces) on slices.
pub trait DynInternalForces: DynModel {
    /// The wrench that the part beyond each cut exerts on the part before it, without cylinders with a valve. `out`: one per cut, as
    /// [`Description::cuts`] lists them. The methods `internal_forces_at` and `internal_forces_of` of [`DynCrane`] include these cylinders.
    fn internal_forces(&self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [Wrench]);

    /// What each cylinder that pushes with 1 N adds at each cut, cylinder by cylinder; nothing is written for a crane without valves.
    fn cylinder_wrenches(&self, q: &[f64], out: &mut [Wrench]);

    /// What each connector between two bodies contributes at each cut while it pulls with 1 N, connector by connector; nothing is written
    /// for a crane without such connectors.
    fn connector_wrenches(&self, q: &[f64], out: &mut [Wrench]);

    /// What each equation of the loop joints adds to the wrench at each cut while it transmits 1 N or 1 N m, equation by equation.
    fn loop_wrenches(&self, q: &[f64], out: &mut [Wrench]);

    /// Positions of the supports' attachment points, m.
    fn support_positions(&self, q: &[f64], out: &mut [Vector3<f64>]);

    /// Section moduli for stresses of beams; one per section, as [`Description::sections`] lists them.
    fn section_moduli(&self, out: &mut [SectionModuli]);
}

/// Evaluation of several cranes at a time, each with its own state and parameters: [`Ensemble`](crate::Ensemble) on slices.
pub trait DynEnsemble: DynDynamics {
    /// The number of cranes in a block: a multiple of eight.
    fn lanes(&self) -> usize {
        8
    }

    /// A block of cranes that differ from this one in their parameters: one slice per lane, the values in the order of the
    /// description.
    ///
    /// # Errors
    /// The parameters of a lane break a rule of the spec language.
    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError>;
}

/// Several cranes that are evaluated together.
///
/// With w = lanes/8 vectors per number, lane l of coordinate i is element `l % 8` of vector `i w + l / 8`.
pub trait DynBlock {
    /// Accelerations q̈ of every lane.
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]);
}

/// Derivatives of the transforms: [`TransformDerivatives`](crate::TransformDerivatives) on slices.
pub trait DynDerivatives: DynModel {
    /// `∂T/∂q_j`, body by body, for the coordinates j that move it.
    fn transform_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]);

    /// `∂²T/∂q_m∂q_n`, body by body, for the pairs m ≤ n of the coordinates that move it.
    fn transform_second_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]);
}

/// A crane with every analysis except two that are rarely needed: derivatives of transforms, [`DynDerivatives`], and small motions about a
/// motion, [`DynLineariseMotion`].
///
/// Functions that return owned lists and matrices are methods of [`dyn DynCrane`](trait.DynCrane.html#impl-dyn+DynCrane).
pub trait DynCrane: DynStatics + DynImplicit + DynLinearise + DynInternalForces + DynEnsemble + Send + Sync {
    /// Sets a live parameter. An index out of range changes nothing.
    ///
    /// # Errors
    /// The value breaks a rule of the spec language; the crane stays unchanged.
    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError>;

    /// Sets the first live parameters together: [`CraneModel::set_parameters`](crate::CraneModel::set_parameters).
    ///
    /// # Errors
    /// A value breaks a rule of the spec language; the crane stays unchanged.
    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError>;

    /// Sets an input, or with `None` returns it to its spec: [`CraneModel::set_input`](crate::CraneModel::set_input). No
    /// constants are recomputed.
    fn set_input(&mut self, index: usize, value: Option<f64>);

    /// A separate crane with the same parameters and inputs.
    fn boxed_clone(&self) -> Box<dyn DynCrane>;
}
