//! The interface between generated cranes and everything that is computed with them.
//!
//! Generated code implements these traits; statics, integrators and reports are generic over them. Parts that a crane does not
//! have (supports, flexible links, drives, damping) keep the default: zero, at no cost.
//!
//! Throughout: `N` coordinates, `q` in m and rad, `v = q̇` in m/s and rad/s, `t` in s, world frame with z up.

use crane_quantities::quantities;
use nalgebra::{Cholesky, Const, DefaultAllocator, Dim, OMatrix, SMatrix, SVector, allocator::Allocator};

use crate::{
    description::{CoordinateRole, Description, LoopJointInfo, ParameterError, StageInfo},
    methods::{Entry, sized_argument, sized_entry, sized_method, sized_methods, sized_result},
    rt::lanes::f64x8,
};

/// Poses, forces and potential energy of a crane.
pub trait CraneModel<const N: usize>: Send + Sync {
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
    /// A run reads the inputs when it begins; [`simulate_from`](crate::dynamics::simulate_from) continues it with changed ones.
    fn set_input(&mut self, _index: usize, _value: Option<f64>) {}

    /// The joints that close loops. Forces, accelerations and equilibria of the traits here are those of the open chain; what takes a crane
    /// on slices closes the loops.
    fn loop_joints(&self) -> &[LoopJointInfo] {
        &[]
    }

    /// The beams that slide in others on pads.
    fn stages(&self) -> &[StageInfo] {
        &[]
    }

    /// Sets the coordinates that rigid drives prescribe, and their rates, at time t. A crane without rigid drives has none.
    fn prescribe(&self, _t: f64, _q: &mut SVector<f64, N>, _v: &mut SVector<f64, N>) {}

    /// Potential energy of everything. J.
    fn potential_energy(&self, t: f64, q: &SVector<f64, N>) -> f64 {
        let linear = self.gravity_energy(q) + self.support_energy(q) + self.element_energy(q) + self.drive_energy(t, q);
        linear + self.stop_energy(q) + self.connector_energy(t, q)
    }

    quantities! { sized_methods of CraneModel }
}

/// Equations of motion `A(q) q̈ = e(q, q̇) + f(t, q, q̇)`, Eq. (23).
pub trait Dynamics<const N: usize>: CraneModel<N> {
    /// A and e together. Only the lower triangle of `mass` is written, which Cholesky's factorisation reads.
    fn mass_matrix_and_bias(
        &self,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        mass: &mut SMatrix<f64, N, N>,
    ) -> SVector<f64, N> {
        *mass = self.mass_matrix(q);
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
        Cholesky::new(self.mass_matrix(q)).map_or(SVector::repeat(f64::NAN), |factors| factors.solve(r))
    }

    quantities! { sized_methods of Dynamics }
}

/// Cranes that can be simulated eight at a time, each with its own state and parameters.
pub trait Ensemble<const N: usize>: Dynamics<N> + Sized {
    /// Eight cranes.
    type Lanes: LaneDynamics<N>;

    /// The lanes of these eight cranes, with their parameters.
    fn lanes(cranes: [&Self; 8]) -> Self::Lanes;
}

/// Equations of motion of eight cranes, one per lane.
pub trait LaneDynamics<const N: usize> {
    /// Accelerations q̈ like [`Dynamics::forward_dynamics`], lane by lane.
    fn forward_dynamics(&self, t: f64x8, q: &SVector<f64x8, N>, v: &SVector<f64x8, N>) -> SVector<f64x8, N>;
}

/// Eight cranes, evaluated one after the other: for a crane whose spec does not request `ensemble`.
#[derive(Clone, Copy, Debug)]
pub struct OneByOne<C>(pub [C; 8]);

impl<const N: usize, C: Dynamics<N>> LaneDynamics<N> for OneByOne<C> {
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

/// Functions for an implicit step: structured stiffness and damping, and systems with them at the cost of those with A.
///
/// All springs and dampers except connectors act on single coordinates, or in the block of the base's coordinates, which are the first of
/// q. The coefficients of linear springs and dampers on single coordinates are constants; those of other laws are evaluated at each step.
pub trait Implicit<const N: usize>: Dynamics<N> {
    /// The factors that [`Implicit::factorise`] computes for [`Implicit::solve`].
    type Factors: Send;

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

    quantities! { sized_methods of Implicit }
}

/// The crane at rest, with loads and winches as at time t and the drives at given positions, each at the index of its coordinate.
pub trait Statics<const N: usize>: CraneModel<N> {
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

    quantities! { sized_methods of Statics }
}

/// Small motions about a pose at rest: `A δq̈ + D δq̇ + K δq = 0`.
pub trait Linearise<const N: usize>: CraneModel<N> {
    /// A, D and K at a pose.
    fn linearise(&self, q: &SVector<f64, N>) -> Linearisation<N>;
}

/// Forces and moments between the parts of a crane.
pub trait InternalForces<const N: usize>: CraneModel<N> {
    quantities! { sized_methods of InternalForces }
}

/// Derivatives of the transforms. Each body has derivatives with respect to the coordinates that move it, the first
/// [`degrees_of_freedom`](crate::BodyInfo::degrees_of_freedom) of `q`; all others are zero and not stored.
pub trait TransformDerivatives<const N: usize>: CraneModel<N> {
    quantities! { sized_methods of TransformDerivatives }
}

/// Derivatives of the dynamics, for controllers, optimization and identification.
pub trait MotionDerivatives<const N: usize>: Dynamics<N> {
    /// Derivatives of the accelerations q̈ of [`forward_dynamics`](Dynamics::forward_dynamics) of the open chain: rows of ∂q̈/∂q, then of ∂q̈/∂v,
    /// then of ∂q̈/∂τ = A⁻¹ with generalized forces τ. `out`: 3 N rows. For coordinates that rigid drives prescribe the rows are zero, and so are
    /// their columns of A⁻¹. NaN unless A is positive definite.
    ///
    /// `−A⁻¹ ∂r/∂q, −A⁻¹ ∂r/∂v, A⁻¹`, at a = q̈, by Cholesky's factors of A
    fn forward_dynamics_derivatives(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>, out: &mut [[f64; N]]) {
        let a = self.forward_dynamics(t, q, v);
        let (rows, rest) = out.split_at_mut(out.len().min(2 * N));
        self.dynamic_residual_derivatives(t, q, v, &a, rows);
        let mut mass = self.mass_matrix(q);
        let prescribed = |j: usize| {
            self.description().coordinates.get(j).is_some_and(|info| info.role == CoordinateRole::Prescribed)
        };
        separate(&mut mass, prescribed);
        let Some(factors) = Cholesky::new(mass) else {
            rows.iter_mut().chain(rest).for_each(|row| row.fill(f64::NAN));
            return;
        };
        for block in rows.chunks_mut(N.max(1)) {
            let of_block = |i: usize, j: usize| block.get(i).and_then(|row| row.get(j)).copied().unwrap_or(0.0);
            let right = SMatrix::<f64, N, N>::from_fn(|i, j| if prescribed(i) { 0.0 } else { -of_block(i, j) });
            write_rows(&factors.solve(&right), block);
        }
        let unit = |i: usize, j: usize| if i == j && !prescribed(i) { 1.0 } else { 0.0 };
        write_rows(&factors.solve(&SMatrix::<f64, N, N>::from_fn(unit)), rest);
    }

    quantities! { sized_methods of MotionDerivatives }
}

/// Writes a matrix row by row.
fn write_rows<const N: usize>(matrix: &SMatrix<f64, N, N>, rows: &mut [[f64; N]]) {
    for (out, row) in rows.iter_mut().zip(matrix.row_iter()) {
        out.iter_mut().zip(row.iter()).for_each(|(out, entry)| *out = *entry);
    }
}

/// Makes the rows and columns of some coordinates those of the unit matrix.
fn separate<const N: usize>(matrix: &mut SMatrix<f64, N, N>, is_separate: impl Fn(usize) -> bool) {
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let entry = |i: usize, j: usize, entry: f64| if is_separate(i) || is_separate(j) { unit(i, j) } else { entry };
    *matrix = matrix.map_with_location(entry);
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
        state_blocks::<Const<N>>(self.mass, &self.stiffness, &self.damping).map(Into::into)
    }
}

/// `(−A⁻¹K, −A⁻¹D)` of matrices of any size, by Cholesky's factors of A.
pub(crate) fn state_blocks<D: Dim>(
    mass: OMatrix<f64, D, D>,
    stiffness: &OMatrix<f64, D, D>,
    damping: &OMatrix<f64, D, D>,
) -> Option<[OMatrix<f64, D, D>; 2]>
where
    DefaultAllocator: Allocator<D, D>,
{
    let mass = mass.cholesky()?;
    Some([-mass.solve(stiffness), -mass.solve(damping)])
}
