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

use methods::{slice_method, slice_methods};

use crate::{Description, LoopJointInfo, ParameterError, StageInfo, entry_type, rt::lanes::f64x8, slice_argument};

/// Whether a function is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derived {
    /// The results are those of the function: zeros if the crane lacks such a component.
    Yes,
    /// The crane does not have the function, and the results are NaN: `analyses` of its spec leave out its part, it has too many coordinates, or it is
    /// several cranes.
    No,
}

/// Everything that is computed of a crane: [`CraneModel`](crate::CraneModel) on slices.
///
/// Functions that return owned lists and matrices are methods of [`dyn DynCrane`](trait.DynCrane.html#impl-dyn+DynCrane).
pub trait DynCrane: Send + Sync {
    /// Computes a function of the table of quantities. `out`: its result in full, as the method of that name writes it, item after item: a vector, a
    /// wrench and a matrix have 3, 6 and 16 numbers, the latter column by column; of [`linearise`](Self::linearise) and
    /// [`forward_dynamics_derivatives`](Self::forward_dynamics_derivatives), three matrices.
    ///
    /// All methods of the table are calls of it.
    fn call(&self, id: FunctionId, arguments: &Arguments<'_>, out: &mut [f64]) -> Derived;

    /// Names, units and settings.
    fn description(&self) -> &Description;

    /// What the bodies of a crane with branches are attached to: for each body after the first, the index of an earlier one. Empty for a
    /// crane without branches.
    fn parents(&self) -> &[usize];

    /// Value of a live parameter, by its index in the description.
    fn parameter(&self, index: usize) -> f64;

    /// Value to which an input is set, by its index in the description; `None` while it follows its spec.
    fn input(&self, index: usize) -> Option<f64>;

    /// The joints that close loops.
    fn loop_joints(&self) -> &[LoopJointInfo];

    /// The beams that slide in others on pads.
    fn stages(&self) -> &[StageInfo];

    /// Height of the section of the inner beam of a stage, m; 0 if the spec gives no shape.
    fn stage_height(&self, stage: usize) -> f64;

    /// Sets the coordinates that rigid drives prescribe, and their rates, at time t.
    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]);

    /// Writes `Σ λ_i ∂²φ_i/∂q²` of loop joints that transmit λ, n × n; returns whether the crane has a way to compute it that takes less time
    /// than [`loop_states`](Self::loop_states) for all pairs of coordinates.
    fn loop_stiffness(&self, _q: &[f64], _multipliers: &[f64], _out: &mut [f64]) -> bool {
        false
    }

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

    /// How many cranes it is: a [fleet](Self::fleet) is several.
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

    /// Storage for the factors of a system of this crane; created once per run.
    fn system(&self) -> Box<dyn DynSystem + '_>;

    /// A, K and D of small motions about a pose at rest, each n × n.
    fn linearise(&self, q: &[f64], out: &mut [f64]) {
        self.call(FunctionId::Linearise, &Arguments { q, ..Arguments::none() }, out);
    }

    /// Rows of ∂q̈/∂q, ∂q̈/∂v and ∂q̈/∂τ = A⁻¹, 3 n rows of n numbers:
    /// [`CraneModel::forward_dynamics_derivatives`](crate::CraneModel::forward_dynamics_derivatives).
    fn forward_dynamics_derivatives(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.call(FunctionId::ForwardDynamicsDerivatives, &Arguments { t, q, v, ..Arguments::none() }, out);
    }

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

    /// A fleet: cranes that differ from this one in their parameters and inputs, as one crane. Each of its lists has the items of all, the same item of
    /// each crane next to each other: coordinate i of crane k of m is coordinate m i + k. Its description is [`Description::of_fleet`]. Energies are
    /// those of all. A row over the coordinates is that of the same item of all cranes: the number of rows is that of one crane. Matrices are NaN, and its
    /// parents are those of one crane: a fleet has no tree, no cuts and no derivatives.
    ///
    /// `None` if one crane after the other is not slower. The fleet may have more cranes: copies of the last one.
    fn fleet(&self, _cranes: &[&dyn DynCrane]) -> Option<Box<dyn DynCrane>> {
        None
    }

    quantities! { slice_methods }
}

/// Systems `(A(q) + D̂) x = r` of a crane, one after the other.
pub trait DynSystem: Send {
    /// Factorises `A(q) + D̂`, like [`CraneModel::factorise`](crate::CraneModel::factorise); `base` column by column.
    fn factorise(&mut self, q: &[f64], added_inertia: &[f64], base: &[f64]);

    /// The solution x of the system that was factorised last; NaN before the first factorisation.
    fn solve(&mut self, r: &[f64], out: &mut [f64]);
}

/// Several cranes that are evaluated together.
///
/// With w = lanes/8 vectors per number, lane l of coordinate i is element `l % 8` of vector `i w + l / 8`.
pub trait DynBlock {
    /// Accelerations q̈ of every lane.
    fn forward_dynamics(&mut self, t: f64, q: &[f64x8], v: &[f64x8], out: &mut [f64x8]);
}
