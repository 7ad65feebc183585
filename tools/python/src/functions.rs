//! Functions of a state: arrays in, arrays out.

use crane_live::FunctionId;
use crane_live::rows::Quantity;
use crane_model::dyn_crane::{DynCrane, DynDerivatives, DynModel};
use pyo3::prelude::*;

use crate::crane::Crane;
use crate::evaluation::{Array, Given, Moment, State};

#[pymethods]
impl Crane {
    /// (..., bodies, 4, 4): transforms of the bodies into the world frame, m.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn transforms<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().bodies.len(), 4, 4];
        self.function(py, FunctionId::Transforms, State::pose(q), &own, invalid)
    }

    /// (..., bodies, n, 4, 4): `∂T/∂q_j`; zero for coordinates that do not move a body.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn transform_derivatives<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().bodies.len(), self.live.size(), 4, 4];
        self.function(py, FunctionId::TransformDerivatives, State::pose(q), &own, invalid)
    }

    /// (..., bodies, n, n, 4, 4): `∂²T/∂q_m∂q_n`.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn transform_second_derivatives<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let (bodies, n) = (self.live.description().bodies.len(), self.live.size());
        let state = State::pose(q);
        self.one_by_one(py, state, &[bodies, n, n, 4, 4], invalid, |crane, Moment { q, .. }, out| {
            let crane: &dyn DynDerivatives = crane;
            let mut matrices = crane.transform_second_derivatives_at(q).into_iter();
            let tree = (crane as &dyn DynModel).tree();
            for (body, of_body) in out.chunks_mut(16 * n * n).enumerate() {
                let moving = tree.coordinates(body);
                for (place, &m) in moving.iter().enumerate() {
                    for &k in &moving[place..] {
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
        self.function(py, FunctionId::Points, State::pose(q), &own, invalid)
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
        self.function(py, FunctionId::PointVelocities, State::moving(q, v), &own, invalid)
    }

    /// (..., points, 3, n): derivatives of their positions with respect to q, m/m and m/rad.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn point_jacobians<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().points.len(), 3, self.live.size()];
        self.compute(py, Quantity::PointJacobians, State::pose(q), &own, invalid)
    }

    /// (..., n, n): the mass matrix A, symmetric positive definite; kg, kg m, kg m².
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn mass_matrix<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size(), self.live.size()];
        self.function(py, FunctionId::MassMatrix, State::pose(q), &own, invalid)
    }

    /// (..., n): velocity and gravity forces e of `A q̈ = e + f`, N and N m: the negative of Pinocchio's `nle` and of
    /// MuJoCo's `qfrc_bias`, which are on the left-hand side.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn bias<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, v: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size()];
        self.function(py, FunctionId::Bias, State::moving(q, v), &own, invalid)
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
        self.function(py, FunctionId::Forces, State::moving(q, v).at(t), &own, invalid)
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
        self.function(py, FunctionId::ElementForces, State::moving(q, v), &own, invalid)
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
        self.function(py, FunctionId::DriveForces, State::moving(q, v).at(t), &own, invalid)
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
        self.function(py, FunctionId::StopForces, State::moving(q, v), &own, invalid)
    }

    /// (..., n): generalized forces of friction in joints, N and N m.
    #[pyo3(signature = (v, *, invalid="raise"))]
    fn friction_forces<'py>(&self, py: Python<'py>, v: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.size()];
        self.function(py, FunctionId::FrictionForces, State { v: Some(v), ..State::default() }, &own, invalid)
    }

    /// (..., n): generalized forces of the loads applied from outside, N and N m. t: s, 0 unless given.
    #[pyo3(signature = (q, t=None, *, invalid="raise"))]
    fn load_forces<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, t: Given<'_, 'py>, invalid: &str) -> Array<'py> {
        let own = [self.live.size()];
        self.function(py, FunctionId::LoadForces, State::pose(q).at(t), &own, invalid)
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
        self.function(py, FunctionId::ConnectorForces, State::moving(q, v).at(t), &own, invalid)
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
        self.function(py, FunctionId::ConnectorLengths, State::moving(q, v), &own, invalid)
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
        self.function(py, FunctionId::ConnectorTensions, State::moving(q, v).at(t), &own, invalid)
    }

    /// (..., n): generalized forces of the drives, including rigid ones, that hold the crane at rest where they are at times t, N and N m.
    #[pyo3(signature = (q, t=None, *, invalid="raise"))]
    fn drive_forces_at_rest<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        self.function(py, FunctionId::DriveForcesAtRest, State::pose(q).at(t), &own, invalid)
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
        self.function(py, FunctionId::SupportReactions, State::moving(q, v), &own, invalid)
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
        self.function(py, FunctionId::SupportGaps, State::moving(q, v), &own, invalid)
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
        self.function(py, FunctionId::CylinderStates, State::moving(q, v), &own, invalid)
    }

    /// (..., cylinders, n): derivatives of the length of each cylinder with respect to the coordinates, m/rad or m/m. A cylinder with a valve
    /// that pushes with F exerts the generalized forces F times its row. Zeros for a crane without valves.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn cylinder_jacobians<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().cylinders.len(), self.live.size()];
        self.function(py, FunctionId::CylinderJacobians, State::pose(q), &own, invalid)
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
        self.function(py, FunctionId::DriveLimits, State::moving(q, v).at(Some(t)), &own, invalid)
    }

    /// (..., drives, 2): prescribed positions and rates of the drives at times t, m and rad, m/s and rad/s.
    #[pyo3(signature = (t, *, invalid="raise"))]
    fn drive_motions<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().drives.len(), 2];
        self.function(py, FunctionId::DriveMotions, State::default().at(Some(t)), &own, invalid)
    }

    /// (..., drives, 2): commands over time of the drives' valves at times t, −1 to 1, and their rates, 1/s; zeros without one.
    #[pyo3(signature = (t, *, invalid="raise"))]
    fn valve_openings<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.description().drives.len(), 2];
        self.function(py, FunctionId::ValveOpenings, State::default().at(Some(t)), &own, invalid)
    }

    /// (..., equations, 3): gaps of the equations of loop joints, m and 1, their rates, and the part of their second rates that does not
    /// depend on accelerations.
    #[pyo3(signature = (q, v, *, invalid="raise"))]
    fn loop_states<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.loop_equations(), 3];
        self.function(py, FunctionId::LoopStates, State::moving(q, v), &own, invalid)
    }

    /// (..., equations, n): derivatives of the gaps of loop joints with respect to q.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn loop_jacobians<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [self.live.loop_equations(), self.live.size()];
        self.function(py, FunctionId::LoopJacobians, State::pose(q), &own, invalid)
    }

    /// (..., n): accelerations q̈ of `A q̈ = e + f`, with closed loops, m/s² and rad/s².
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
        if !self.live.loop_joints().is_empty() && !self.live.description().has_force_states() {
            return self.one_by_one(py, State::moving(q, v).at(t), &own, invalid, |crane, at, out| {
                let crane: &dyn DynCrane = crane;
                out.copy_from_slice(crane.accelerations_at(at.t, &at.q, &at.v).as_slice());
            });
        }
        self.function(py, FunctionId::ForwardDynamics, State::moving(q, v).at(t), &own, invalid)
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
        self.compute(py, Quantity::InverseDynamics, State { a: Some(a), ..State::moving(q, v) }, &own, invalid)
    }

    /// (..., n): `∂E_p/∂q` with the drives where they are at times t, zero in equilibrium, N and N m.
    #[pyo3(signature = (q, t=None, *, invalid="raise"))]
    fn static_residual<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size()];
        self.function(py, FunctionId::StaticResidual, State::pose(q).at(t), &own, invalid)
    }

    /// (..., n, n): `∂²E_p/∂q²` with the drives where they are at times t, N/m, N and N m.
    #[pyo3(signature = (q, t=None, *, invalid="raise"))]
    fn tangent_stiffness<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        t: Given<'_, 'py>,
        invalid: &str,
    ) -> Array<'py> {
        let own = [self.live.size(), self.live.size()];
        self.function(py, FunctionId::TangentStiffness, State::pose(q).at(t), &own, invalid)
    }

    /// (..., 3, n, n): A, K and D of small motions about poses at rest; `linearise` names them.
    #[pyo3(name = "_small_motions", signature = (q, *, invalid="raise"))]
    fn small_motions<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        let own = [3, self.live.size(), self.live.size()];
        self.function(py, FunctionId::Linearise, State::pose(q), &own, invalid)
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
        self.function(py, FunctionId::KineticEnergy, State::moving(q, v), &[], invalid)
    }

    /// (...): potential energy of gravity, zero at the world's origin, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn gravity_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.function(py, FunctionId::GravityEnergy, State::pose(q), &[], invalid)
    }

    /// (...): energy of the supports' springs, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn support_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.function(py, FunctionId::SupportEnergy, State::pose(q), &[], invalid)
    }

    /// (...): energy of the springs between rigid elements, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn element_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.function(py, FunctionId::ElementEnergy, State::pose(q), &[], invalid)
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
        self.function(py, FunctionId::DriveEnergy, State::pose(q).at(t), &[], invalid)
    }

    /// (...): energy of the end stops, J.
    #[pyo3(signature = (q, *, invalid="raise"))]
    fn stop_energy<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, invalid: &str) -> Array<'py> {
        self.function(py, FunctionId::StopEnergy, State::pose(q), &[], invalid)
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
        self.function(py, FunctionId::ConnectorEnergy, State::pose(q).at(t), &[], invalid)
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
        self.function(py, FunctionId::DrivePower, State::moving(q, v).at(t), &[], invalid)
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
        self.function(py, FunctionId::Dissipation, State::moving(q, v).at(t), &[], invalid)
    }
}
