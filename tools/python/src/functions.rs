//! Functions of a state: arrays in, arrays out.

use crane_live::FunctionId;
use crane_live::rows::{Evaluation, Quantity, Rows};
use crane_model::dyn_crane::{DynCrane, DynDerivatives, DynModel, DynStatics};
use crane_model::rt::lanes::f64x8;
use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Argument, Joined, array, zeros};
use crate::crane::Crane;
use crate::mistakes::{BadRow, Invalid, describe, warn_of_rows};
use crate::parallel::{for_rows, map_rows};

type Array<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;
/// An argument that may be left out.
pub type Given<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// Rows that a thread takes at a time: some tens of microseconds of work.
const PIECE: usize = 64;

/// A state as it was given.
#[derive(Clone, Copy, Default)]
pub struct State<'a, 'py> {
    /// Time.
    pub t: Given<'a, 'py>,
    /// Coordinates.
    pub q: Given<'a, 'py>,
    /// Rates.
    pub v: Given<'a, 'py>,
    /// Accelerations.
    pub a: Given<'a, 'py>,
}

/// The state of a row; what was not given is empty, and the time 0.
pub struct Moment {
    /// Time, s.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Rates.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
}

#[pymethods]
impl Crane {
    /// (..., bodies, 4, 4): transforms of the bodies into the world frame, m.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn transforms<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().bodies.len(), 4, 4];
        self.compute(py, Quantity::Of(FunctionId::Transforms), State { q: Some(q), ..State::default() }, &own, invalid)
    }

    /// (..., bodies, n, 4, 4): `∂T/∂q_j`; zero for coordinates that do not move a body.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn transform_derivatives<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().bodies.len(), self.live.size(), 4, 4];
        self.compute(
            py,
            Quantity::Of(FunctionId::TransformDerivatives),
            State { q: Some(q), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., bodies, n, n, 4, 4): `∂²T/∂q_m∂q_n`.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn transform_second_derivatives<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let (bodies, n) = (self.live.description().bodies.len(), self.live.size());
        let state = State { q: Some(q), ..State::default() };
        self.one_by_one(py, state, &[bodies, n, n, 4, 4], invalid, |crane, Moment { q, .. }, out| {
            let crane: &dyn DynDerivatives = crane;
            let mut matrices = crane.transform_second_derivatives_at(q).into_iter();
            for (body, of_body) in crane.description().bodies.iter().zip(out.chunks_mut(16 * n * n)) {
                for m in 0..body.degrees_of_freedom {
                    for k in m..body.degrees_of_freedom {
                        let rows = matrices.next().unwrap_or_default().transpose();
                        for place in [m * n + k, k * n + m] {
                            of_body[16 * place..16 * (place + 1)].copy_from_slice(rows.as_slice());
                        }
                    }
                }
            }
        })
    }

    /// (..., points, 3): positions of the points of interest, world frame, m.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn points<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().points.len(), 3];
        self.compute(py, Quantity::Of(FunctionId::Points), State { q: Some(q), ..State::default() }, &own, invalid)
    }

    /// (..., points, 3): their velocities, m/s.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn point_velocities<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.description().points.len(), 3];
        self.compute(
            py,
            Quantity::Of(FunctionId::PointVelocities),
            State { q: Some(q), v: Some(v), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., points, 3, n): derivatives of their positions with respect to q, m/m and m/rad.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn point_jacobians<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().points.len(), 3, self.live.size()];
        self.compute(py, Quantity::PointJacobians, State { q: Some(q), ..State::default() }, &own, invalid)
    }

    /// (..., n, n): the mass matrix A, symmetric positive definite; kg, kg m, kg m².
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn mass_matrix<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size(), self.live.size()];
        self.compute(py, Quantity::Of(FunctionId::MassMatrix), State { q: Some(q), ..State::default() }, &own, invalid)
    }

    /// (..., n): velocity and gravity forces e of `A q̈ = e + f`, N and N m: the negative of Pinocchio's `nle` and of
    /// MuJoCo's `qfrc_bias`, which are on the left-hand side.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn bias<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, v: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(
            py,
            Quantity::Of(FunctionId::Bias),
            State { q: Some(q), v: Some(v), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., n): generalized forces f of supports, elements, drives and joint dampers, N and N m. t: s, 0 unless given.
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn forces<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(py, Quantity::Of(FunctionId::Forces), State { t, q: Some(q), v: Some(v), a: None }, &own, invalid)
    }

    /// (..., n): generalized forces of the springs and dampers between rigid elements, N m.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn element_forces<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(
            py,
            Quantity::Of(FunctionId::ElementForces),
            State { q: Some(q), v: Some(v), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., n): generalized forces of the drives, N and N m.
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn drive_forces<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(
            py,
            Quantity::Of(FunctionId::DriveForces),
            State { t, q: Some(q), v: Some(v), a: None },
            &own,
            invalid,
        )
    }

    /// (..., n): generalized forces of the end stops, N and N m.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn stop_forces<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        let state = State { q: Some(q), v: Some(v), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::StopForces), state, &own, invalid)
    }

    /// (..., n): generalized forces of friction in joints, N and N m.
    #[pyo3(signature = (v, *, invalid="raise"))]
    fn friction_forces<'py>(&self, py: Python<'py>, v: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(
            py,
            Quantity::Of(FunctionId::FrictionForces),
            State { v: Some(v), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., n): generalized forces of the loads applied from outside, N and N m. t: s, 0 unless given.
    #[pyo3(signature = (q, t=None, *, invalid="raise"))]
    fn load_forces<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, t: Given<'_, 'py>, invalid: &str) -> Array<'py> {
        let own = [self.live.size()];
        let state = State { t, q: Some(q), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::LoadForces), state, &own, invalid)
    }

    /// (..., n): generalized forces of the connectors, N and N m. t: s, 0 unless given.
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn connector_forces<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        let state = State { t, q: Some(q), v: Some(v), a: None };
        self.compute(py, Quantity::Of(FunctionId::ConnectorForces), state, &own, invalid)
    }

    /// (..., connectors, 2): lengths of the connectors, m, and their rates, m/s.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn connector_lengths<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.description().connectors.len(), 2];
        let state = State { q: Some(q), v: Some(v), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::ConnectorLengths), state, &own, invalid)
    }

    /// (..., connectors, 3): forces of the connectors, N, positive in tension, and their derivatives with respect to length, N/m, and
    /// rate, N s/m.
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn connector_tensions<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.description().connectors.len(), 3];
        let state = State { t, q: Some(q), v: Some(v), a: None };
        self.compute(py, Quantity::Of(FunctionId::ConnectorTensions), state, &own, invalid)
    }

    /// (..., n): generalized forces of the drives, including rigid ones, that hold the crane at rest at t = 0, N and N m.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn drive_forces_at_rest<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let state = State { q: Some(q), ..State::default() };
        self.one_by_one(py, state, &[self.live.size()], invalid, |crane, Moment { q, .. }, out| {
            crane.drive_forces_at_rest(q, out);
        })
    }

    /// (..., supports, 3): forces of the supports on the crane, world frame, N.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn support_reactions<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.description().supports.len(), 3];
        self.compute(
            py,
            Quantity::Of(FunctionId::SupportReactions),
            State { q: Some(q), v: Some(v), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., supports, 2): how far one-sided supports are above the ground, m, negative where pressed in, and its rate, m/s; 0 for others.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn support_gaps<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.description().supports.len(), 2];
        let state = State { q: Some(q), v: Some(v), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::SupportGaps), state, &own, invalid)
    }

    /// (..., cylinders, 3): length of each cylinder, m, its rate, m/s, and its derivative with respect to the joint's coordinate,
    /// m/rad or m/m.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn cylinder_states<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.description().cylinders.len(), 3];
        let state = State { q: Some(q), v: Some(v), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::CylinderStates), state, &own, invalid)
    }

    /// (..., drives, 2): maximum effort of each drive, N or N m, 0 if it has no limit, and its stiffness at the state, N/m or N m/rad.
    /// Zeros for a crane without limits.
    #[pyo3(signature = (t, q, v, *, invalid="raise"))]
    fn drive_limits<'py>(
        &self,
        py: Python<'py>,
        t: &Bound<'py, PyAny>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.description().drives.len(), 2];
        let state = State { t: Some(t), q: Some(q), v: Some(v), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::DriveLimits), state, &own, invalid)
    }

    /// (..., drives, 2): prescribed positions and rates of the drives at times t, m and rad, m/s and rad/s.
    #[pyo3(signature = (t, *, invalid="raise"))]
    fn drive_motions<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().drives.len(), 2];
        self.compute(
            py,
            Quantity::Of(FunctionId::DriveMotions),
            State { t: Some(t), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., drives, 2): commands over time of the drives' valves at times t, −1 to 1, and their rates, 1/s; zeros without one.
    #[pyo3(signature = (t, *, invalid="raise"))]
    fn valve_openings<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().drives.len(), 2];
        let state = State { t: Some(t), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::ValveOpenings), state, &own, invalid)
    }

    /// (..., n): accelerations q̈ of `A q̈ = e + f`, m/s² and rad/s².
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(
            py,
            Quantity::Of(FunctionId::ForwardDynamics),
            State { t, q: Some(q), v: Some(v), a: None },
            &own,
            invalid,
        )
    }

    /// (..., n): generalized forces that a motion requires in total, `A a − e`, N and N m.
    #[pyo3(signature = (q, v, a, *, invalid="raise"))]
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        a: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(
            py,
            Quantity::InverseDynamics,
            State { t: None, q: Some(q), v: Some(v), a: Some(a) },
            &own,
            invalid,
        )
    }

    /// (..., n): `∂E_p/∂q` at t = 0, zero in equilibrium, N and N m.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn static_residual<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size()];
        self.compute(
            py,
            Quantity::Of(FunctionId::StaticResidual),
            State { q: Some(q), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., n, n): `∂²E_p/∂q²` at t = 0, N/m, N and N m.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn tangent_stiffness<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size(), self.live.size()];
        self.compute(
            py,
            Quantity::Of(FunctionId::TangentStiffness),
            State { q: Some(q), ..State::default() },
            &own,
            invalid,
        )
    }

    /// (..., 3, n, n): A, K and D of small motions about poses at rest; `linearise` names them.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn small_motions<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [3, self.live.size(), self.live.size()];
        self.compute(py, Quantity::Of(FunctionId::Linearise), State { q: Some(q), ..State::default() }, &own, invalid)
    }

    /// (...): kinetic energy, J.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn kinetic_energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        self.compute(
            py,
            Quantity::Of(FunctionId::KineticEnergy),
            State { q: Some(q), v: Some(v), ..State::default() },
            &[],
            invalid,
        )
    }

    /// (...): potential energy of gravity, zero at the world's origin, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn gravity_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.compute(
            py,
            Quantity::Of(FunctionId::GravityEnergy),
            State { q: Some(q), ..State::default() },
            &[],
            invalid,
        )
    }

    /// (...): energy of the supports' springs, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn support_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.compute(
            py,
            Quantity::Of(FunctionId::SupportEnergy),
            State { q: Some(q), ..State::default() },
            &[],
            invalid,
        )
    }

    /// (...): energy of the springs between rigid elements, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn element_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.compute(
            py,
            Quantity::Of(FunctionId::ElementEnergy),
            State { q: Some(q), ..State::default() },
            &[],
            invalid,
        )
    }

    /// (...): energy of the drives' springs, J.
    #[pyo3(signature = (q, t=None, *, invalid="raise"))]
    fn drive_energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        self.compute(
            py,
            Quantity::Of(FunctionId::DriveEnergy),
            State { t, q: Some(q), ..State::default() },
            &[],
            invalid,
        )
    }

    /// (...): energy of the end stops, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn stop_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.compute(py, Quantity::Of(FunctionId::StopEnergy), State { q: Some(q), ..State::default() }, &[], invalid)
    }

    /// (...): energy of the connectors, J.
    #[pyo3(signature = (q, t=None, *, invalid="raise"))]
    fn connector_energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let state = State { t, q: Some(q), ..State::default() };
        self.compute(py, Quantity::Of(FunctionId::ConnectorEnergy), state, &[], invalid)
    }

    /// (...): power that the drives' motions put in, W.
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn drive_power<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        self.compute(
            py,
            Quantity::Of(FunctionId::DrivePower),
            State { t, q: Some(q), v: Some(v), a: None },
            &[],
            invalid,
        )
    }

    /// (...): power that all dampers dissipate, W.
    #[pyo3(signature = (q, v, t=None, *, invalid="raise"))]
    fn dissipation<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        self.compute(
            py,
            Quantity::Of(FunctionId::Dissipation),
            State { t, q: Some(q), v: Some(v), a: None },
            &[],
            invalid,
        )
    }
}

impl Crane {
    /// A quantity of all rows, `own`: the axes of one of them.
    pub fn compute<'py>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        state: State<'_, 'py>,
        own: &[usize],
        invalid: &str,
    ) -> Array<'py> {
        let by_forces = matches!(
            quantity,
            Quantity::Of(
                FunctionId::ForwardDynamics
                    | FunctionId::Forces
                    | FunctionId::DriveForces
                    | FunctionId::DrivePower
                    | FunctionId::Linearise
            )
        );
        if by_forces && self.live.description().has_force_states() {
            return Err(PyValueError::new_err(
                "forces of this crane follow from pressures or bristles, which are states of a run: use simulate, simulation or modes",
            ));
        }
        let arguments = self.read(state)?;
        let joined = self.joined(&arguments)?;
        let bad = self.bad_rows(&joined, Invalid::named(invalid)?)?;
        let [t, q, v, a, parameters] = [0, 1, 2, 3, 4].map(|index| &*joined.arguments[index]);
        let parameters = if self.is_single() { &[][..] } else { parameters };
        let rows = Rows { t, q, v, a, parameters };
        let (count, width) = (joined.rows(), own.iter().product::<usize>());
        if joined.shape.is_empty() && bad.is_empty() {
            let out = zeros(py, &[], own);
            self.in_room(quantity, |room| room.run(&rows, 0..1, out.readwrite().as_slice_mut().unwrap_or_default()));
            return Ok(out);
        }
        let mut out = vec![0.0; count * width];
        let make = || Evaluation::<f64x8>::new(&self.live, quantity);
        for_rows(py, (PIECE, width), &mut out, make, |room, range, out| room.run(&rows, range, out))?;
        forget(&mut out, &bad, width);
        warn_of_rows(py, &bad, &joined.shape)?;
        array(py, out, &joined.shape, own)
    }

    /// The same by a function of one crane.
    pub fn one_by_one<'py>(
        &self,
        py: Python<'py>,
        state: State<'_, 'py>,
        own: &[usize],
        invalid: &str,
        write: impl Fn(&crane_live::LiveCrane, &Moment, &mut [f64]) + Sync,
    ) -> Array<'py> {
        let arguments = self.read(state)?;
        let joined = self.joined(&arguments)?;
        let bad = self.bad_rows(&joined, Invalid::named(invalid)?)?;
        let (n, width) = (self.live.size(), own.iter().product::<usize>());
        let of = |list: &[f64], size: usize, row: usize| -> Vec<f64> {
            let row = if list.len() <= size { 0 } else { row };
            list.get(row * size..(row + 1) * size).unwrap_or_default().to_vec()
        };
        let rows = map_rows(py, joined.rows(), |row, _| {
            let mut out = vec![0.0; width];
            if bad.iter().all(|bad| bad.row != row) {
                let [t, q, v, a] =
                    [(0, 1), (1, n), (2, n), (3, n)].map(|(index, size)| of(&joined.arguments[index], size, row));
                let moment = Moment { t: t.first().copied().unwrap_or(0.0), q, v, a };
                write(&self.of_joined_row(&joined, row), &moment, &mut out);
            }
            out
        })?;
        let mut out = rows.concat();
        forget(&mut out, &bad, width);
        warn_of_rows(py, &bad, &joined.shape)?;
        array(py, out, &joined.shape, own)
    }

    /// The crane with the parameters of a row of all arguments.
    pub fn of_joined_row(&self, joined: &Joined<'_>, row: usize) -> crane_live::LiveCrane {
        let mut crane = self.live.clone();
        let (width, parameters) = (self.parameters.width, &joined.arguments[4]);
        if !self.is_single() && width > 0 {
            let row = if parameters.len() <= width { 0 } else { row };
            // Checked when they were given.
            let _ = crane.set_parameters(&parameters[row * width..(row + 1) * width]);
        }
        crane
    }

    /// t, q, v, a; empty if not given, which means t = 0 for the time.
    fn read(&self, state: State<'_, '_>) -> PyResult<[Argument; 4]> {
        let description = self.live.description();
        let none = || Argument { shape: Vec::new(), numbers: Vec::new(), width: 0 };
        let coordinates = |name: &str, given: Given<'_, '_>| {
            given.map_or_else(|| Ok(none()), |given| Argument::coordinates(name, given, description))
        };
        Ok([
            state.t.map_or_else(|| Ok(none()), |t| Argument::scalars("t", t))?,
            coordinates("q", state.q)?,
            coordinates("v", state.v)?,
            coordinates("a", state.a)?,
        ])
    }

    /// t, q, v, a and the parameters over common leading axes.
    fn joined<'a>(&'a self, [t, q, v, a]: &'a [Argument; 4]) -> PyResult<Joined<'a>> {
        Joined::new(&[("t", t), ("q", q), ("v", v), ("a", a), ("the parameters", &self.parameters)])
    }

    /// Rows with numbers that are not finite, or with parameters that break a rule.
    fn bad_rows(&self, joined: &Joined<'_>, invalid: Invalid) -> PyResult<Vec<BadRow>> {
        let n = self.live.size();
        let coordinates = &self.live.description().coordinates;
        let mut bad: Vec<BadRow> = Vec::new();
        for (name, list, size) in [("t", 0, 1), ("q", 1, n), ("v", 2, n), ("a", 3, n)]
            .map(|(name, i, size)| (name, &joined.arguments[i], size))
        {
            if list.iter().all(|x| x.is_finite()) {
                continue;
            }
            for row in 0..joined.rows() {
                let first = if list.len() <= size { 0 } else { row * size };
                let Some(place) = list[first..first + size].iter().position(|x| !x.is_finite()) else { continue };
                let value = list[first + place];
                let of = coordinates
                    .get(place)
                    .filter(|_| name != "t")
                    .map_or(String::new(), |info| format!("[{place}] ({})", info.name));
                bad.push(BadRow { row, reason: format!("{name}{of} is {value}, not a finite number") });
            }
        }
        if !self.bad.is_empty() {
            let width = self.parameters.width;
            let parameters = &joined.arguments[4];
            let refused = |row: &usize| {
                let row = if parameters.len() <= width { 0 } else { *row };
                self.live.check(&parameters[row * width..(row + 1) * width]).err()
            };
            bad.extend((0..joined.rows()).filter_map(|row| Some(BadRow { row, reason: refused(&row)?.to_string() })));
        }
        bad.sort_by_key(|bad| bad.row);
        bad.dedup_by_key(|bad| bad.row);
        match (bad.first(), invalid) {
            (Some(first), Invalid::Raise) => {
                let hint =
                    if joined.shape.is_empty() { "" } else { "; invalid=\"nan\" makes the results of such rows NaN" };
                Err(PyValueError::new_err(format!("{}{hint}", describe(first, &joined.shape))))
            }
            _ => Ok(bad),
        }
    }
}

/// Makes the numbers of bad rows NaN.
fn forget(out: &mut [f64], bad: &[BadRow], width: usize) {
    for bad in bad {
        out[bad.row * width..(bad.row + 1) * width].fill(f64::NAN);
    }
}
