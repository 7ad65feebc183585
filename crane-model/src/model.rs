//! The interface between generated cranes and everything that is computed with them.
//!
//! Throughout: `N` coordinates, `q` in m and rad, `v = q̇` in m/s and rad/s, `t` in s, world frame with z up.

use bytemuck::cast_slice_mut;
use crane_quantities::{Count, Part, quantities};
use nalgebra::{Cholesky, SMatrix, SVector};

use crate::{
    Description, LoopJointInfo, ParameterError, StageInfo, fill_links,
    methods::{absent, sized_argument, sized_entry, sized_method, sized_methods, sized_result},
    rt::derivatives::{self, Changes, Columns, EightColumns, Joint, Link, States, Workspace, units},
    rt::lanes::f64x8,
};

/// A crane with `N` coordinates: what generated code implements, and models written by hand.
///
/// Equations of motion `A(q) q̈ = e(q, q̇) + f(t, q, q̇)`, Eq. (23). A spec's `analyses` choose the [parts](Self::PARTS) that a crane has. Functions of parts that it
/// does not have are NaN; solvers of them do not compile. Functions of components that it lacks, such as supports, are zero.
///
/// All springs and dampers except connectors act on single coordinates, or in the block of the base's coordinates, which are the first of
/// q. The coefficients of linear springs and dampers on single coordinates are constants; those of other laws are evaluated at each step.
///
/// Each body has derivatives of its transform with respect to the coordinates that move it, the first
/// [`degrees_of_freedom`](crate::BodyInfo::degrees_of_freedom) of `q`; all others are zero and not stored.
pub trait CraneModel<const N: usize>: Clone + Send + Sync + 'static {
    /// The parts of the table of quantities that it has.
    const PARTS: &'static [Part];

    /// The factors that [`factorise`](Self::factorise) computes for [`solve`](Self::solve).
    type Factors: Send;

    /// Eight cranes.
    type Lanes: LaneDynamics<N>;

    /// Names, units and settings.
    fn description(&self) -> &Description;

    /// What the bodies of a crane with branches are attached to: for each body after the first, the index of an earlier one. Empty for a
    /// crane without branches, whose bodies are attached to the previous one.
    fn parents(&self) -> &[usize] {
        &[]
    }

    /// Value of a live parameter, by its index in [`Description::parameters`].
    fn parameter(&self, index: usize) -> f64;

    /// Sets a live parameter. An index out of range changes nothing.
    ///
    /// # Errors
    /// The value breaks a rule of the spec language; the crane stays unchanged.
    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError>;

    /// Sets as many of the first live parameters together as there are values: rules about several parameters are checked for
    /// all of them at once.
    ///
    /// # Errors
    /// A value breaks a rule of the spec language; a generated crane then stays unchanged.
    fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError> {
        values.iter().enumerate().try_for_each(|(index, &value)| self.set_parameter(index, value))
    }

    /// Value that an input is set to, by its index in [`Description::inputs`]; `None` while it follows its spec.
    fn input(&self, _index: usize) -> Option<f64> {
        None
    }

    /// Sets an input from now on, or lets it follow its spec again. An index out of range changes nothing.
    ///
    /// A run reads the inputs when it begins; [`Simulation::at_time`](crate::dynamics::Simulation::at_time) continues it with changed ones.
    fn set_input(&mut self, _index: usize, _value: Option<f64>) {}

    /// The joints that close loops. Forces, accelerations and equilibria here are those of the open chain; what takes a crane
    /// on slices closes the loops.
    fn loop_joints(&self) -> &[LoopJointInfo] {
        &[]
    }

    /// The beams that slide in others on pads.
    fn stages(&self) -> &[StageInfo] {
        &[]
    }

    /// Height of the section of the inner beam of a stage, m; 0 if the spec gives no shape.
    fn stage_height(&self, _stage: usize) -> f64 {
        0.0
    }

    /// Sets the coordinates that rigid drives prescribe, and their rates, at time t. A crane without rigid drives has none.
    fn prescribe(&self, _t: f64, _q: &mut SVector<f64, N>, _v: &mut SVector<f64, N>) {}

    /// Potential energy of everything. J.
    fn potential_energy(&self, t: f64, q: &SVector<f64, N>) -> f64 {
        let linear = self.gravity_energy(q) + self.support_energy(q) + self.element_energy(q) + self.drive_energy(t, q);
        linear + self.stop_energy(q) + self.connector_energy(t, q)
    }

    /// A and e together. Only the lower triangle of `mass` is written, which Cholesky's factorisation reads.
    fn mass_matrix_and_bias(
        &self,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        mass: &mut SMatrix<f64, N, N>,
    ) -> SVector<f64, N> {
        self.mass_matrix(q, mass);
        self.bias(q, v)
    }

    /// Accelerations q̈ of `A q̈ = e + f`, Eq. (23), in O(n) by articulated bodies: A is never formed. m/s² and rad/s². The forces of
    /// cylinders with a valve are not included, see [`forces`](CraneModel::forces).
    fn forward_dynamics(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.solve_mass(q, &(self.bias(q, v) + self.forces(t, q, v)))
    }

    /// x of `A(q) x = r`, in O(n). `r` in N and N m, x in m/s² and rad/s².
    ///
    /// The default for models written by hand uses Cholesky's factors of A; the result is NaN unless A is positive definite.
    fn solve_mass(&self, q: &SVector<f64, N>, r: &SVector<f64, N>) -> SVector<f64, N> {
        let mut mass = SMatrix::zeros();
        self.mass_matrix(q, &mut mass);
        Cholesky::new(mass).map_or(SVector::repeat(f64::NAN), |factors| factors.solve(r))
    }

    /// The lanes of these eight cranes, with their parameters.
    fn lanes(cranes: [&Self; 8]) -> Self::Lanes;

    /// Factors of `A(q) + D̂`, in O(n). D̂ is block-diagonal: `base` in the rows and columns of the base's coordinates that
    /// the crane has, and `added_inertia` on the diagonal of all others. Positive semidefinite; kg and kg m².
    fn factorise(
        &self,
        q: &SVector<f64, N>,
        added_inertia: &SVector<f64, N>,
        base: &SMatrix<f64, 6, 6>,
    ) -> Self::Factors;

    /// x of `(A + D̂) x = r`.
    fn solve(&self, f: &Self::Factors, r: &SVector<f64, N>) -> SVector<f64, N>;

    /// Generalized forces r that a motion requires beyond those that act, N and N m: `r = A a − e − f`.
    fn dynamic_residual(
        &self,
        t: f64,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        a: &SVector<f64, N>,
    ) -> SVector<f64, N> {
        let mut mass = SMatrix::zeros();
        self.mass_matrix(q, &mut mass);
        mass * a - self.bias(q, v) - self.forces(t, q, v)
    }

    /// Positions of the drives' motions at time t, each at the index of its coordinate; 0 at all others.
    fn drive_positions(&self, t: f64) -> SVector<f64, N> {
        let (mut motions, mut positions) = ([[0.0; 2]; N], SVector::<f64, N>::zeros());
        self.drive_motions(t, &mut motions);
        for (drive, [position, _]) in self.description().drives.iter().zip(motions) {
            if let Some(number) = positions.get_mut(drive.coordinate) {
                *number = position;
            }
        }
        positions
    }

    /// A, D and K of small motions about a pose at rest: `A δq̈ + D δq̇ + K δq = 0`.
    fn linearise(&self, _q: &SVector<f64, N>) -> Linearisation<N> {
        let [mass, stiffness, damping] = [SMatrix::repeat(f64::NAN); 3];
        Linearisation { mass, stiffness, damping }
    }

    /// Derivatives ∂r/∂q (N/m, N, N m) and ∂r/∂v (N s/m, N s, N m s) of the residual r = A a − e − f of
    /// [`dynamic_residual`](CraneModel::dynamic_residual), row by row. `out`: 2 N rows.
    ///
    /// `Ω_i · (Ω̈_j W + 2 Ω̇_j G + Ω_j × F) − ∂f_i/∂q_j, 2 Ω_i · (Ω̇_j W + Ω_j G) − ∂f_i/∂q̇_j`
    fn dynamic_residual_derivatives(
        &self,
        t: f64,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        a: &SVector<f64, N>,
        out: &mut [[f64; N]],
    ) {
        let mut factors = [[0.0; N]; Count::RESIDUAL_FACTORS];
        self.residual_factors(q, v, a, &mut factors);
        self.force_derivatives(t, q, v, out);
        with_workspace(self, |links, workspace| {
            derivatives::residual_derivatives(links, workspace, factors.as_flattened(), out.as_flattened_mut());
        });
    }

    /// Inverse A⁻¹ of the mass matrix, accelerations per generalized force; 1/kg, 1/(kg m) and 1/(kg m²). Zero in rows and columns of coordinates
    /// that rigid drives prescribe. Of the open chain.
    ///
    /// `A⁻¹ = Lᵀ D⁻¹ L`, by articulated bodies
    ///
    /// `out`: the whole matrix, whatever it was before.
    fn inverse_mass_matrix(&self, q: &SVector<f64, N>, out: &mut SMatrix<f64, N, N>) {
        let mut factors = [[0.0; N]; Count::MASS_FACTORS];
        self.mass_factors(q, &mut factors);
        // A⁻¹ is symmetric: its rows are its columns.
        let rows = out.data.0.as_flattened_mut();
        with_workspace(self, |links, workspace| {
            derivatives::inverse_mass_matrix(links, workspace, factors.as_flattened(), rows);
        });
    }

    /// Derivatives of the accelerations q̈ of [`forward_dynamics`](CraneModel::forward_dynamics) of the open chain: rows of ∂q̈/∂q, then of ∂q̈/∂v,
    /// then of ∂q̈/∂τ = A⁻¹ with generalized forces τ. `out`: 3 N rows. For coordinates that rigid drives prescribe the rows are zero, and so are
    /// their columns of A⁻¹.
    ///
    /// `−A⁻¹ ∂r/∂q, −A⁻¹ ∂r/∂v, A⁻¹`, at a = q̈, A⁻¹ by articulated bodies
    fn forward_dynamics_derivatives(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>, out: &mut [[f64; N]]) {
        let a = self.forward_dynamics(t, q, v);
        let mut of_residual = [[0.0; N]; Count::RESIDUAL_FACTORS];
        let mut of_mass = [[0.0; N]; Count::MASS_FACTORS];
        self.residual_factors(q, v, &a, &mut of_residual);
        self.mass_factors(q, &mut of_mass);
        let mut of_forces = [[[0.0; N]; N]; 2];
        let forces = of_forces.as_flattened_mut();
        self.force_derivatives(t, q, v, forces);
        let factors = [of_residual.as_flattened(), of_mass.as_flattened()];
        with_workspace(self, |links, workspace| {
            let forces = (forces.as_flattened(), derivatives::Places::new(forces.as_flattened()));
            derivatives::forward_dynamics_derivatives(links, workspace, factors, forces, out.as_flattened_mut());
        });
    }

    quantities! { sized_methods }
}

/// Equations of motion of eight cranes, one per lane.
pub trait LaneDynamics<const N: usize> {
    /// Accelerations q̈ like [`CraneModel::forward_dynamics`], lane by lane.
    fn forward_dynamics(&self, t: f64x8, q: &SVector<f64x8, N>, v: &SVector<f64x8, N>) -> SVector<f64x8, N>;
}

/// Eight cranes, evaluated one after the other: for a crane whose spec does not request `ensemble`.
#[derive(Clone, Copy, Debug)]
pub struct OneByOne<C>(pub [C; 8]);

impl<const N: usize, C: CraneModel<N>> LaneDynamics<N> for OneByOne<C> {
    fn forward_dynamics(&self, t: f64x8, q: &SVector<f64x8, N>, v: &SVector<f64x8, N>) -> SVector<f64x8, N> {
        let mut lanes = [[0.0; 8]; N];
        for (lane, (crane, t)) in self.0.iter().zip(t.to_array()).enumerate() {
            let of = |x: &SVector<f64x8, N>| x.map(|x| x.to_array()[lane]);
            for (lanes, x) in lanes.iter_mut().zip(&crane.forward_dynamics(t, &of(q), &of(v))) {
                lanes[lane] = *x;
            }
        }
        SVector::from(lanes.map(f64x8::new))
    }
}

/// Calls `compute` with the coordinates of a crane and a workspace for derivatives.
fn with_workspace<const N: usize>(
    crane: &impl CraneModel<N>,
    compute: impl FnOnce(&[Link; N], Workspace<'_, EightColumns>),
) {
    const UNITS: usize = units::<EightColumns>(usize::MAX);
    let mut links = [Link::default(); N];
    fill_links(crane.description(), crane.parents(), &mut links);
    let zero = EightColumns::zero();
    // One by one: out of a tuple they would be copied.
    let mut joints = [Joint::zero(); N];
    let mut changes = [Changes::zero(); N];
    let mut rows = [[0.0; 16]; N];
    let mut swept = [[[zero; 3]; UNITS]; N];
    let mut now = [[zero; 9]; UNITS];
    let work = |reached: &mut [_], paths: &mut [_]| {
        let (joints, rows, changes, swept) = (&mut joints, &mut rows, &mut changes, swept.as_flattened_mut());
        let states = States { now: &mut now, reached };
        compute(&links, Workspace { joints, rows, changes, swept, states, paths });
    };
    if crane.parents().is_empty() {
        work(&mut [], &mut []);
    } else {
        work([[[zero; 9]; UNITS]; N].as_flattened_mut(), [[0.0; N]; N].as_flattened_mut());
    }
}

/// Coefficients of small motions about a pose at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearisation<const N: usize> {
    /// Mass matrix A.
    pub mass: SMatrix<f64, N, N>,
    /// Tangent stiffness K.
    pub stiffness: SMatrix<f64, N, N>,
    /// Damping matrix D.
    pub damping: SMatrix<f64, N, N>,
}

impl<const N: usize> Linearisation<N> {
    /// Blocks `(−A⁻¹K, −A⁻¹D)` of the state matrix
    ///
    /// ```text
    /// d/dt [δq; δq̇] = [[0, I], [−A⁻¹K, −A⁻¹D]] [δq; δq̇]
    /// ```
    ///
    /// `None` unless A is positive definite. This needs neither `std` nor a heap.
    pub fn state_blocks(&self) -> Option<(SMatrix<f64, N, N>, SMatrix<f64, N, N>)> {
        let mass = self.mass.cholesky()?;
        Some((-mass.solve(&self.stiffness), -mass.solve(&self.damping)))
    }
}
