//! Cranes of any size through one pointer: the trait of a generated crane on slices.
//!
//! Statics, integrators, modes and stability are implemented once, in terms of [`DynCrane`]. It is the counterpart of [`CraneModel`](crate::CraneModel), which
//! has the number of coordinates in its type; [`Instance`] adapts one to the other. Solvers take [both](AnyCrane).
//!
//! # Slices
//! `q`, `v`, `r` and results per coordinate have as many numbers as [`Description::coordinates`], in that order; lists of
//! bodies, points, supports and drives as many as the description has. Results overwrite the contents of `out`. Symmetric
//! matrices are written in full. A method may panic if a slice has another length. Repeated calls do not allocate, because each
//! method keeps its workspace.

mod any;
mod arguments;
mod declare;
mod instance;
mod methods;
mod quantities;

pub use any::{AnyCrane, AnySize, CraneRef, OfSize};
pub use arguments::Arguments;
use bytemuck::cast_slice_mut;
use crane_quantities::{Count, FunctionId, quantities};
pub(crate) use instance::Block;
pub use instance::{Instance, boxed};
pub use quantities::Energies;
pub(crate) use quantities::drive_stiffness;

use methods::{slice_method, slice_methods};

use nalgebra::Vector3;

use crate::{
    Description, LoopJointInfo, ParameterError, StageInfo, Tension, entry_type, rt::lanes::f64x8, slice_argument,
};

/// Whether a function is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derived {
    /// The results are those of the function: zeros if the crane lacks such a component.
    Yes,
    /// The crane does not have the function, and the results are NaN: `analyses` of its spec leave out its part, it has too many coordinates, or it is
    /// several cranes.
    No,
}

/// The functions of a crane, or of a fleet of several, at a state: all that a motion is integrated with.
pub trait Functions: Send + Sync {
    /// Computes a function of the table of quantities. `out`: its result in full, as the method of that name writes it, item after item: a vector, a
    /// wrench and a matrix have 3, 6 and 16 numbers, the latter column by column; of [`linearise`](Self::linearise) and
    /// [`forward_dynamics_derivatives`](Self::forward_dynamics_derivatives), three matrices.
    ///
    /// All methods of the table are calls of it.
    fn call(&self, id: FunctionId, arguments: &Arguments<'_>, out: &mut [f64]) -> Derived;

    /// Names, units and settings.
    fn description(&self) -> &Description;

    /// The joints that close loops.
    fn loop_joints(&self) -> &[LoopJointInfo];

    /// Sets the coordinates that rigid drives prescribe, and their rates, at time t.
    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]);

    /// Storage for the factors of a system of this crane; created once per run.
    fn system(&self) -> Box<dyn DynSystem + '_>;

    /// How many of these parts it has.
    fn count(&self, count: Count) -> usize {
        self.description().count(self.loop_joints(), count)
    }

    /// Number of equations of all loop joints.
    fn loop_equations(&self) -> usize {
        self.count(Count::LoopEquations)
    }

    /// Number of coordinates.
    fn size(&self) -> usize {
        self.description().coordinates.len()
    }

    /// How many cranes it is: a [fleet](DynCrane::fleet) is several.
    fn cranes(&self) -> usize {
        1
    }

    /// Positions of the drives' motions at time t, by coordinate.
    fn drive_positions_at(&self, t: f64) -> Vec<f64> {
        let mut motions = vec![[0.0; 2]; self.description().drives.len()];
        self.drive_motions(t, &mut motions);
        let positions: Vec<f64> = motions.iter().map(|[position, _]| *position).collect();
        self.description().by_coordinate(&positions)
    }

    /// Positions of the points of interest, m.
    fn points_at(&self, q: &[f64]) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().points.len()];
        self.points(q, &mut out);
        out
    }

    /// Velocities of the points of interest, m/s.
    fn point_velocities_at(&self, q: &[f64], v: &[f64]) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().points.len()];
        self.point_velocities(q, v, &mut out);
        out
    }

    /// Prescribed positions and rates of the drives.
    fn drive_motions_at(&self, t: f64) -> Vec<[f64; 2]> {
        let mut out = vec![[0.0; 2]; self.description().drives.len()];
        self.drive_motions(t, &mut out);
        out
    }

    /// Moments that the springs and dampers between rigid elements transmit, `k q + d q̇`, one per coordinate of an element in
    /// the order of `q`: positive if they resist a positive deformation. N m.
    fn element_moments_at(&self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.size()];
        self.element_forces(q, v, &mut forces);
        let coordinates = self.description().coordinates.iter().zip(&forces);
        coordinates.filter(|(coordinate, _)| coordinate.role.is_element()).map(|(_, force)| -force).collect()
    }

    /// Torques and forces of the end stops on the coordinates that have them, in order: N m and N.
    fn stop_efforts_at(&self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.size()];
        self.stop_forces(q, v, &mut forces);
        self.description().stops.iter().map(|&coordinate| forces[coordinate]).collect()
    }

    /// Torques and forces of friction on the coordinates that have them, in order: N m and N.
    fn friction_efforts_at(&self, v: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.size()];
        self.friction_forces(v, &mut forces);
        self.description().frictions.iter().map(|&coordinate| forces[coordinate]).collect()
    }

    /// Length (m) of every connector, and its rate (m/s).
    fn connector_lengths_at(&self, q: &[f64], v: &[f64]) -> Vec<[f64; 2]> {
        let mut out = vec![[0.0; 2]; self.description().connectors.len()];
        self.connector_lengths(q, v, &mut out);
        out
    }

    /// Force of every connector and its slopes.
    fn connector_tensions_at(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<Tension> {
        let mut out = vec![Tension::ZERO; self.description().connectors.len()];
        self.connector_tensions(t, q, v, &mut out);
        out
    }

    /// Forces of the supports on the crane, N.
    fn support_reactions_at(&self, q: &[f64], v: &[f64]) -> Vec<Vector3<f64>> {
        let mut out = vec![Vector3::zeros(); self.description().supports.len()];
        self.support_reactions(q, v, &mut out);
        out
    }

    /// Height of each one-sided support above the ground, m: negative where it is pressed in, 0 for all others.
    fn support_gaps_at(&self, q: &[f64]) -> Vec<f64> {
        let mut out = vec![[0.0; 2]; self.description().supports.len()];
        self.support_gaps(q, &vec![0.0; q.len()], &mut out);
        out.into_iter().map(|[gap, _]| gap).collect()
    }

    /// Energies by part.
    fn energies_at(&self, t: f64, q: &[f64], v: &[f64]) -> Energies {
        Energies {
            kinetic: self.kinetic_energy(q, v),
            gravity: self.gravity_energy(q),
            supports: self.support_energy(q),
            elements: self.element_energy(q),
            drives: self.drive_energy(t, q),
            stops: self.stop_energy(q),
            connectors: self.connector_energy(t, q),
        }
    }

    /// Torques and forces of the drives, with open loops, N m and N: 0 for rigid drives.
    fn open_drive_efforts_at(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.size()];
        self.drive_forces(t, q, v, &mut forces);
        self.description().drives.iter().map(|drive| forces[drive.coordinate]).collect()
    }

    /// A, K and D of small motions about a pose at rest, each n × n.
    fn linearise(&self, q: &[f64], out: &mut [f64]) {
        self.call(FunctionId::Linearise, &Arguments { q, ..Arguments::none() }, out);
    }

    /// Rows of ∂q̈/∂q, ∂q̈/∂v and ∂q̈/∂τ = A⁻¹, 3 n rows of n numbers:
    /// [`CraneModel::forward_dynamics_derivatives`](crate::CraneModel::forward_dynamics_derivatives).
    fn forward_dynamics_derivatives(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.call(FunctionId::ForwardDynamicsDerivatives, &Arguments { t, q, v, ..Arguments::none() }, out);
    }

    quantities! { slice_methods }
}

/// A crane of any size: [`CraneModel`](crate::CraneModel) on slices.
///
/// Functions that return owned lists and matrices are methods of [`dyn DynCrane`](trait.DynCrane.html#impl-dyn+DynCrane).
pub trait DynCrane: Functions {
    /// What the bodies of a crane with branches are attached to: for each body after the first, the index of an earlier one. Empty for a
    /// crane without branches.
    fn parents(&self) -> &[usize];

    /// Value of a live parameter, by its index in the description.
    fn parameter(&self, index: usize) -> f64;

    /// Values of all live parameters, in the order of the description.
    fn parameter_values(&self) -> Vec<f64> {
        (0..self.description().parameters.len()).map(|index| self.parameter(index)).collect()
    }

    /// Value to which an input is set, by its index in the description; `None` while it follows its spec.
    fn input(&self, index: usize) -> Option<f64>;

    /// The beams that slide in others on pads.
    fn stages(&self) -> &[StageInfo];

    /// Height of the section of the inner beam of a stage, m; 0 if the spec gives no shape.
    fn stage_height(&self, stage: usize) -> f64;

    /// Writes `Σ λ_i ∂²φ_i/∂q²` of loop joints that transmit λ, n × n; returns whether the crane has a way to compute it that takes less time
    /// than [`loop_states`](Functions::loop_states) for all pairs of coordinates.
    fn loop_stiffness(&self, _q: &[f64], _multipliers: &[f64], _out: &mut [f64]) -> bool {
        false
    }

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

    /// Eight cranes that differ from this one in their parameters: one slice per lane, the values in the order of the
    /// description.
    ///
    /// # Errors
    /// The parameters of a lane break a rule of the spec language.
    fn block(&self, parameters: &[&[f64]]) -> Result<Box<dyn DynBlock + '_>, ParameterError>;

    /// The functions of a fleet: of cranes that differ from this one in their parameters and inputs. Each list has the items of all, the same item of
    /// each crane next to each other: coordinate i of crane k of m is coordinate m i + k. Its description is [`Description::of_fleet`]. Energies are
    /// those of all. A row over the coordinates is that of the same item of all cranes: the number of rows is that of one crane. It has no matrices
    /// and no derivatives.
    ///
    /// `None` if one crane after the other is not slower. The fleet may have more cranes: copies of the last one.
    fn fleet(&self, _cranes: &[&dyn DynCrane]) -> Option<Box<dyn Functions>> {
        None
    }
}

/// Systems `(A(q) + D̂) x = r` of a crane, one after the other.
pub trait DynSystem: Send {
    /// Factorises `A(q) + D̂`, like [`CraneModel::factorise`](crate::CraneModel::factorise); `base` column by column.
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &[f64]);

    /// The solution x of the system that was factorised last; NaN before the first factorisation.
    fn solve(&mut self, r: &[f64], out: &mut [f64]);
}

/// Eight cranes that are evaluated together, one in each lane.
pub trait DynBlock {
    /// Accelerations q̈ of every lane.
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]);
}
