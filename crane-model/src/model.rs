//! The interface between generated cranes and everything that is computed with them.
//!
//! Generated code implements these traits; statics, integrators and reports are generic over them. Parts that a crane does not
//! have (supports, flexible links, drives, damping) keep the default: zero, at no cost.
//!
//! Throughout: `N` coordinates, `q` in m and rad, `v = q̇` in m/s and rad/s, `t` in s, world frame with z up.

use nalgebra::{
    Cholesky, Const, DefaultAllocator, Dim, Matrix4, OMatrix, SMatrix, SVector, Vector3, allocator::Allocator,
};

use crate::{
    description::{Description, LoopJointInfo, ParameterError},
    rt::lanes::f64x8,
    stress::SectionModuli,
    wrench::{Tension, Wrench},
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

    /// Transforms T of all bodies into the world frame, Eq. (3). `out`: one per body.
    fn transforms(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]);

    /// Positions of the points of interest in the world frame, m. `out`: one per point.
    fn points(&self, _q: &SVector<f64, N>, _out: &mut [Vector3<f64>]) {}

    /// Velocities of the points of interest in the world frame, m/s. `out`: one per point.
    fn point_velocities(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>, _out: &mut [Vector3<f64>]) {}

    /// Generalized forces of everything except inertia and gravity: supports, elements, drives, joint dampers. N and N m. The forces of
    /// cylinders with a valve depend on their pressures and are not included.
    fn forces(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of the supports, Eq. (18).
    fn support_forces(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of the springs and dampers between rigid elements, Eq. (15).
    fn element_forces(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of the drives, Eq. (21).
    fn drive_forces(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of viscous damping in passive joints.
    fn joint_damper_forces(&self, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of the end stops.
    fn stop_forces(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of joint friction.
    fn friction_forces(&self, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of the external loads.
    fn load_forces(&self, _t: f64, _q: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Generalized forces of connectors.
    fn connector_forces(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }

    /// Length (m) of every connector, and its rate (m/s). `out`: one pair per connector.
    fn connector_lengths(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>, _out: &mut [[f64; 2]]) {}

    /// Force of every connector and its derivatives. `out`: one per connector.
    fn connector_tensions(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>, _out: &mut [Tension]) {}

    /// `∂ℓ/∂q` of every connector, ℓ its length. `out`: one row per connector.
    fn connector_jacobians(&self, _q: &SVector<f64, N>, _out: &mut [[f64; N]]) {}

    /// The joints that close loops. Forces, accelerations and equilibria of the traits here are those of the open chain; what takes a crane
    /// on slices closes the loops.
    fn loop_joints(&self) -> &[LoopJointInfo] {
        &[]
    }

    /// Every equation of the loop joints: its gap φ, m or 1, its rate `J q̇`, and `J̇ q̇`, the part of its second rate that does not depend on
    /// accelerations. `out`: one vector per equation.
    fn loop_states(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>, _out: &mut [Vector3<f64>]) {}

    /// `J = ∂φ/∂q` of the loop joints. `out`: one row per equation.
    fn loop_jacobians(&self, _q: &SVector<f64, N>, _out: &mut [[f64; N]]) {}

    /// Start and end of the intervals in which winches move smoothly, s. `out`: one pair per interval, connector by connector;
    /// [`ConnectorInfo::pieces`](crate::ConnectorInfo::pieces) is their number.
    fn winch_pieces(&self, _out: &mut [[f64; 2]]) {}

    /// Start and end of the intervals in which the scales of loads are smooth, s. `out`: one pair per interval, load by load;
    /// [`LoadInfo::pieces`](crate::LoadInfo::pieces) is their number.
    fn load_pieces(&self, _out: &mut [[f64; 2]]) {}

    /// Forces of the supports on the crane, world frame, N. `out`: one per support.
    fn support_reactions(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>, _out: &mut [Vector3<f64>]) {}

    /// How far each one-sided support is above the ground, m, negative where it is pressed in, and the rate of that, m/s; 0 for all
    /// others. `out`: one pair per support.
    fn support_gaps(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>, out: &mut [[f64; 2]]) {
        out.fill([0.0; 2]);
    }

    /// Length of each cylinder, m, its rate, m/s, and its derivative with respect to the joint's coordinate, m/rad or m/m. `out`: one
    /// vector per cylinder; NaN where its linkage cannot be assembled.
    fn cylinder_states(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>, _out: &mut [Vector3<f64>]) {}

    /// Derivatives of the length of each cylinder with respect to the coordinates, m/m and m/rad: a cylinder with a valve that pushes with F
    /// exerts the generalized forces `F ∂ℓ/∂q`. `out`: one row per cylinder. A crane without valves writes nothing.
    fn cylinder_jacobians(&self, _q: &SVector<f64, N>, _out: &mut [[f64; N]]) {}

    /// Prescribed position `q_dr` (m or rad) and rate `q̇_dr` of the drives. `out`: one pair per drive.
    fn drive_motions(&self, _t: f64, _out: &mut [[f64; 2]]) {}

    /// Maximum effort of each drive, N m or N, 0 if it has no limit, and its stiffness `−∂t_dr/∂q` at the state, N m/rad or N/m.
    /// `out`: one pair per drive. A crane without limits writes zeros.
    fn drive_limits(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>, out: &mut [[f64; 2]]) {
        out.fill([0.0; 2]);
    }

    /// Sets the coordinates that rigid drives prescribe, and their rates, at time t. A crane without rigid drives has none.
    fn prescribe(&self, _t: f64, _q: &mut SVector<f64, N>, _v: &mut SVector<f64, N>) {}

    /// Command of the valve of every drive over time, −1 to 1, and its rate, 1/s; zeros without one. `out`: one pair per drive.
    fn valve_openings(&self, _t: f64, out: &mut [[f64; 2]]) {
        out.fill([0.0; 2]);
    }

    /// Start and end of the intervals in which the drives' motions and valves' commands are smooth, s. `out`: one pair per interval, drive
    /// by drive; [`DriveInfo::pieces`](crate::DriveInfo::pieces) is their number.
    fn drive_pieces(&self, _out: &mut [[f64; 2]]) {}

    /// Potential energy of gravity, zero at the world's origin, Eq. (6). J.
    fn gravity_energy(&self, q: &SVector<f64, N>) -> f64;

    /// Energy of the supports' springs, Eq. (17). J.
    fn support_energy(&self, _q: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Energy of the elements' springs, Eq. (14). J.
    fn element_energy(&self, _q: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Energy of the drives' springs, Eq. (19). J.
    fn drive_energy(&self, _t: f64, _q: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Energy of the end stops. J.
    fn stop_energy(&self, _q: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Power of the drives' prescribed motions, `Σ t_dr q̇_dr`. W.
    fn drive_power(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Energy of connectors. J.
    fn connector_energy(&self, _t: f64, _q: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Power that winches put in. W.
    fn winch_power(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Power that the external loads put in. W.
    fn load_power(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Power that all dampers dissipate, 2R ≥ 0. W.
    fn dissipation(&self, _t: f64, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> f64 {
        0.0
    }

    /// Potential energy of everything. J.
    fn potential_energy(&self, t: f64, q: &SVector<f64, N>) -> f64 {
        let linear = self.gravity_energy(q) + self.support_energy(q) + self.element_energy(q) + self.drive_energy(t, q);
        linear + self.stop_energy(q) + self.connector_energy(t, q)
    }
}

/// Equations of motion `A(q) q̈ = e(q, q̇) + f(t, q, q̇)`, Eq. (23).
pub trait Dynamics<const N: usize>: CraneModel<N> {
    /// Mass matrix A(q), Eq. (5), symmetric positive definite.
    fn mass_matrix(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N>;

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

    /// Bias `e = −(h + g)`, Eq. (9): velocity and gravity forces on the right-hand side of `A q̈ = e + f`. It is the negative of the bias
    /// force C of Featherstone and of other libraries, which have it on the left.
    fn bias(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N>;

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

    /// Kinetic energy, Eq. (4). J.
    fn kinetic_energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64;
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

    /// Stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad) of elements, drives and joints on single coordinates; zero for
    /// the base's. `out`: one pair per coordinate.
    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]);

    /// Stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad) of end stops and friction on single coordinates at a state.
    /// `out`: one pair per coordinate.
    fn nonlinear_stiffness_and_damping(
        &self,
        _t: f64,
        _q: &SVector<f64, N>,
        _v: &SVector<f64, N>,
        out: &mut [[f64; 2]],
    ) {
        out.fill([0.0; 2]);
    }

    /// Stiffness over the base's coordinates: supports, the one-sided ones at this state, and drives. N/m, N and N m.
    fn base_stiffness(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SMatrix<f64, 6, 6> {
        SMatrix::zeros()
    }

    /// Damping over the base's coordinates: supports, the one-sided ones at this state, drives, joints. N s/m, N s and N m s.
    fn base_damping(&self, _q: &SVector<f64, N>, _v: &SVector<f64, N>) -> SMatrix<f64, 6, 6> {
        SMatrix::zeros()
    }
}

/// The crane at rest, with loads and winches as at time t and the drives at given positions, each at the index of its coordinate.
pub trait Statics<const N: usize>: CraneModel<N> {
    /// `∂E_p/∂q`; zero in equilibrium. N and N m.
    fn static_residual(&self, t: f64, q: &SVector<f64, N>, positions: &SVector<f64, N>) -> SVector<f64, N>;

    /// `∂²E_p/∂q²`, symmetric; positive definite if the equilibrium is stable. A prescribed coordinate, whose residual is 0,
    /// has 1 on the diagonal and zeros elsewhere in its row and column.
    fn tangent_stiffness(&self, t: f64, q: &SVector<f64, N>, positions: &SVector<f64, N>) -> SMatrix<f64, N, N>;

    /// Generalized forces of the drives that hold the crane: those of their springs, for rigid drives the forces needed for equilibrium, and
    /// those of springs along cylinders with a valve, `k (ℓ₀ − ℓ) ∂ℓ/∂q`. ℓ₀ is the length with the joint at the position of its drive and
    /// straight beams, and k the stiffness of the drive over the squared lever arm there. N and N m.
    fn drive_forces_at_rest(&self, _t: f64, _q: &SVector<f64, N>, _positions: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
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
}

/// Small motions about a pose at rest: `A δq̈ + D δq̇ + K δq = 0`.
pub trait Linearise<const N: usize>: CraneModel<N> {
    /// A, D and K at a pose.
    fn linearise(&self, q: &SVector<f64, N>) -> Linearisation<N>;
}

/// Forces and moments between the parts of a crane.
pub trait InternalForces<const N: usize>: CraneModel<N> {
    /// At every cut, the wrench that the part beyond it exerts on the part before it, in the cut's frame about its origin, at time t,
    /// pose q, rates v and accelerations a. `out`: one per cut, as [`Description::cuts`] lists them.
    ///
    /// It is the sum of the inertia forces and weights of everything beyond, the loads applied to it, and the forces of the connectors
    /// attached to it: a joint or a section transmits what no connector carries past it, and supports act only on the base. The forces of
    /// cylinders with a valve are not included, see [`cylinder_wrenches`](Self::cylinder_wrenches). At the ground
    /// it is the load on the foundation or on the supports. In a section of a beam it is `N, Qy, Qz` and `Mx, My, Mz`: a positive N is
    /// tension; Mx, My and Mz have the signs of the deformations that they cause, φ, θ and ψ.
    fn internal_forces(
        &self,
        t: f64,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        a: &SVector<f64, N>,
        out: &mut [Wrench],
    );

    /// What each cylinder that pushes with 1 N adds to the wrench at each cut; the moments are in m. `out`: one per cut, cylinder by
    /// cylinder. A crane without valves writes nothing.
    fn cylinder_wrenches(&self, _q: &SVector<f64, N>, _out: &mut [Wrench]) {}

    /// What each connector between two bodies contributes to the wrench at each cut while it pulls with 1 N, zero for others; the moments
    /// are in m. `out`: one per cut, connector by connector. A crane without such connectors writes nothing.
    fn connector_wrenches(&self, _q: &SVector<f64, N>, _out: &mut [Wrench]) {}

    /// What each equation of the loop joints contributes to the wrench at each cut while it transmits 1 N or 1 N m. `out`: one per cut,
    /// equation by equation. A crane without loops writes nothing.
    fn loop_wrenches(&self, _q: &SVector<f64, N>, _out: &mut [Wrench]) {}

    /// Positions of the supports' attachment points in the world frame, m. `out`: one per support.
    fn support_positions(&self, _q: &SVector<f64, N>, _out: &mut [Vector3<f64>]) {}

    /// Section moduli for stresses of beams. `out`: one per section where an element begins, from the base to the tip.
    fn section_moduli(&self, _out: &mut [SectionModuli]) {}
}

/// Derivatives of the transforms. Each body has derivatives with respect to the coordinates that move it, the first
/// [`degrees_of_freedom`](crate::BodyInfo::degrees_of_freedom) of `q`; all others are zero and not stored.
pub trait TransformDerivatives<const N: usize>: CraneModel<N> {
    /// `∂T/∂q_j`, body by body, j = 0 …: in all `Σ n_dof(p)` matrices.
    fn transform_derivatives(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]);

    /// `∂²T/∂q_m∂q_n`, body by body, m = 0 …, n = m …: in all `Σ n_dof(p) (n_dof(p) + 1)/2` matrices.
    fn transform_second_derivatives(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]);
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
