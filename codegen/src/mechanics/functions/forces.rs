//! Forces and energies by part, and the functions of drives.

use super::{Derivation, function, sum};
use crate::mechanics::{connectors, drives, gravity, joints, loads, springs, supports};
use crate::program::Argument::{Position, Time, Velocity};
use crate::program::{Argument, Function, FunctionId, Shape, Struct};
use crate::symbolic::{Expr, SweepTrace};

/// A part of the forces: which, documentation, equation and arguments of its function, and its expressions.
type Part<'g> = (FunctionId, &'static str, &'static str, &'static [Argument], Vec<Expr<'g>>);

impl<'g> Derivation<'g> {
    /// How far one-sided supports are above the ground, if there are any.
    fn support_gaps(&self) -> Option<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        chain.has_one_sided_supports().then(|| {
            function(
                FunctionId::SupportGaps,
                "How far one-sided supports are above the ground, m, negative where they are pressed in, and its rate, m/s; 0 of others.",
                "e_z, ė_z [Urbaś 2016, Eq. (16)]",
                &[Position, Velocity],
                Shape::Pairs(chain.supports.len()),
                supports::gaps(model, &self.kinematics),
            )
        })
    }

    pub(super) fn forces(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let vector = || Shape::Vector(model.size());
        let mut functions = Vec::new();
        let mut parts = vec![model.zeros()];
        if !chain.supports.is_empty() {
            let forces = supports::forces(model, &self.kinematics, &model.v);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::SupportForces,
                "Generalized forces of the supports, N and N m.",
                "−Jᵀ (s e + d ė) [Urbaś 2016, Eq. (18)]",
                &[Position, Velocity],
                vector(),
                forces,
            ));
            functions.push(function(
                FunctionId::SupportReactions,
                "Forces of the supports on the crane in the world frame, N.",
                "−s e − d ė [Urbaś 2016, Eq. (16)]",
                &[Position, Velocity],
                Shape::Vectors(chain.supports.len()),
                supports::reactions(model, &self.kinematics),
            ));
        }
        functions.extend(self.support_gaps());
        if !chain.beam_springs.is_empty() {
            let forces = springs::element_forces(model, &model.q, &model.v);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::ElementForces,
                "Generalized forces of the springs and dampers between rigid elements, N m.",
                "−S q̃ − D q̃̇ [Urbaś 2016, Eq. (15)]",
                &[Position, Velocity],
                vector(),
                forces,
            ));
        }
        if !chain.drives.is_empty() {
            let (forces, trace) = self.recorded_if_rigid(|| self.drive_forces());
            parts.push(forces.clone());
            functions.extend(self.drives(forces, trace));
        }
        if !chain.joint_dampers.is_empty() {
            let forces = springs::joint_damper_forces(model, &model.v);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::JointDamperForces,
                "Generalized forces of viscous damping in passive joints, N and N m.",
                "−d q̇",
                &[Velocity],
                vector(),
                forces,
            ));
        }
        for (id, doc, equation, arguments, forces) in self.joint_forces() {
            parts.push(forces.clone());
            functions.push(function(id, doc, equation, arguments, vector(), forces));
        }
        if !chain.loads.is_empty() {
            let forces = loads::forces(model, &self.kinematics, model.t);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::LoadForces,
                "Generalized forces of the loads applied from outside, N and N m.",
                "F · Ω_j x + M · ω_j",
                &[Time, Position],
                vector(),
                forces,
            ));
            let pieces = loads::pieces(model);
            if !pieces.is_empty() {
                functions.push(function(
                    FunctionId::LoadPieces,
                    "Begin and end of the pieces in which the scales of loads are smooth, load by load, s.",
                    "t_begin, t_end",
                    &[],
                    Shape::Pairs(pieces.len() / 2),
                    pieces,
                ));
            }
        }
        if !chain.connectors.is_empty() {
            parts.push(connectors::forces(model, &self.kinematics, model.t, Some(&model.v)));
            functions.extend(self.connectors());
        }
        if parts.len() > 1 {
            functions.push(
                function(
                    FunctionId::Forces,
                    "Generalized forces of everything except inertia and gravity, N and N m.",
                    "f_s + f_l + t_dr and viscous joints [Urbaś 2016, Eq. (23)]",
                    &[Time, Position, Velocity],
                    vector(),
                    sum(&parts),
                )
                .by(self.recorded_if_rigid(|| self.drive_forces()).1),
            );
        }
        functions
    }

    /// Forces in joints besides drives and viscous damping, if the crane has any.
    fn joint_forces(&self) -> Vec<Part<'g>> {
        let model = &self.model;
        let mut parts: Vec<Part<'g>> = Vec::new();
        if model.chain.stops().next().is_some() {
            parts.push((
                FunctionId::StopForces,
                "Generalized forces of the end stops, N and N m.",
                "−k δ max(0, 1 + a δ̇)",
                &[Position, Velocity],
                joints::stop_forces(model, &model.v),
            ));
        }
        if model.chain.frictions().next().is_some() {
            parts.push((
                FunctionId::FrictionForces,
                "Generalized forces of joint friction, N and N m.",
                "−(F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) − b q̇",
                &[Velocity],
                joints::friction_forces(model, &model.v),
            ));
        }
        parts
    }

    /// Forces, lengths and tangents of connectors.
    fn connectors(&self) -> Vec<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let count = model.chain.connectors.len();
        let mut functions = vec![
            function(
                FunctionId::ConnectorForces,
                "Generalized forces of connectors, N and N m.",
                "−Jᵀ F",
                &[Time, Position, Velocity],
                Shape::Vector(model.size()),
                connectors::forces(model, kinematics, model.t, Some(&model.v)),
            ),
            function(
                FunctionId::ConnectorForcesAtRest,
                "Generalized forces of connectors while nothing moves, not even a winch, N and N m.",
                "−Jᵀ F(ℓ, 0)",
                &[Time, Position],
                Shape::Vector(model.size()),
                connectors::forces(model, kinematics, model.t, None),
            ),
            function(
                FunctionId::ConnectorLengths,
                "Length ℓ (m) of every connector, and its rate ℓ̇ (m/s).",
                "|p₂ − p₁|, J q̇",
                &[Position, Velocity],
                Shape::Pairs(count),
                connectors::lengths(model, kinematics),
            ),
            function(
                FunctionId::ConnectorTensions,
                "Force F of every connector (N), positive where it pulls, and its slopes ∂F/∂ℓ (N/m) and ∂F/∂ℓ̇ (N s/m).",
                "k (ℓ − ℓ₀) + d ℓ̇ − P; k σ max(0, 1 + a σ̇)",
                &[Time, Position, Velocity],
                Shape::Structs(Struct::Tension, count),
                connectors::tensions(model, kinematics),
            ),
            function(
                FunctionId::ConnectorJacobians,
                "How the length of every connector changes with the coordinates, one row per connector, m/rad and 1.",
                "J = ∂ℓ/∂q",
                &[Position],
                Shape::Rows { count, n: model.size() },
                connectors::jacobians(model, kinematics),
            ),
        ];
        let pieces = connectors::pieces(model);
        if !pieces.is_empty() {
            functions.push(function(
                FunctionId::WinchPieces,
                "Begin and end of the intervals in which winches move smoothly, connector by connector, s.",
                "t_begin, t_end",
                &[],
                Shape::Pairs(pieces.len() / 2),
                pieces,
            ));
        }
        functions
    }

    /// Efforts, powers and motions of drives, from their generalized forces.
    fn drives(&self, forces: Vec<Expr<'g>>, trace: SweepTrace) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let equation = if self.rigid {
            "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]; of rigid drives (A q̈ − e)_j"
        } else {
            "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]"
        };
        let mut functions = vec![
            function(
                FunctionId::DriveForces,
                "Generalized forces of the drives, N and N m.",
                equation,
                &[Time, Position, Velocity],
                Shape::Vector(model.size()),
                forces,
            )
            .by(trace),
            function(
                FunctionId::DriveMotions,
                "Prescribed position q_dr (m, rad) and rate q̇_dr (m/s, rad/s) of every drive.",
                "q_dr(t), q̇_dr(t)",
                &[Time],
                Shape::Pairs(chain.drives.len()),
                drives::motions(model, chain.drives.iter()),
            ),
        ];
        if chain.has_limited_drives() {
            functions.push(function(
                FunctionId::DriveLimits,
                "Greatest effort of every drive, N m or N, 0 without a limit, and its stiffness at the state, N m/rad or N/m.",
                "M, −∂t_dr/∂q",
                &[Time, Position, Velocity],
                Shape::Pairs(chain.drives.len()),
                drives::limits(model),
            ));
        }
        if chain.drives.iter().any(|drive| drive.opening().is_some()) {
            functions.push(function(
                FunctionId::ValveOpenings,
                "Command of the valve of every drive over time, −1 to 1, and its rate, 1/s; zeros without one.",
                "u*(t), u̇*(t)",
                &[Time],
                Shape::Pairs(chain.drives.len()),
                drives::openings(model),
            ));
        }
        let pieces = drives::pieces(model);
        if !pieces.is_empty() {
            functions.push(function(
                FunctionId::DrivePieces,
                "Begin and end of the intervals in which the motions and valves' commands of drives are smooth, drive by drive, s.",
                "t_begin, t_end",
                &[],
                Shape::Pairs(pieces.len() / 2),
                pieces,
            ));
        }
        if self.rigid {
            functions.push(function(
                FunctionId::PrescribedMotions,
                "Position q_dr (m, rad) and rate q̇_dr (m/s, rad/s) of every coordinate that a rigid drive prescribes.",
                "q_dr(t), q̇_dr(t)",
                &[Time],
                Shape::Pairs(chain.rigid_drives().count()),
                drives::motions(model, chain.rigid_drives()),
            ));
        }
        functions
    }

    /// Generalized forces of all drives: those of the springs, and those that the prescribed motions require.
    fn drive_forces(&self) -> Vec<Expr<'g>> {
        let model = &self.model;
        let flexible = drives::forces(model, model.t, &model.v);
        if self.rigid { sum(&[flexible, self.rigid_efforts()]) } else { flexible }
    }

    /// Efforts of rigid drives: the forces that the prescribed motions require, minus the other forces on their joints.
    fn rigid_efforts(&self) -> Vec<Expr<'g>> {
        let model = &self.model;
        let given = self.given_forces(model.t, &model.v);
        let mut efforts = self.motion().efforts;
        for drive in model.chain.rigid_drives() {
            let j = drive.coordinate.0;
            if !given[j].is_zero() {
                efforts[j] = efforts[j] - given[j];
            }
        }
        efforts
    }

    /// Operations for efforts of rigid drives are in the order of the recursion that computes them.
    fn recorded_if_rigid<T>(&self, derive: impl FnOnce() -> T) -> (T, SweepTrace) {
        if self.rigid { self.model.graph.recorded(derive) } else { (derive(), SweepTrace::default()) }
    }

    /// Generalized forces of everything except inertia, gravity and rigid drives.
    pub(super) fn given_forces(&self, t: Expr<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let model = &self.model;
        let mut parts = vec![
            supports::forces(model, &self.kinematics, v),
            springs::element_forces(model, &model.q, v),
            drives::forces(model, t, v),
            springs::joint_damper_forces(model, v),
        ];
        if !model.chain.forces.is_empty() {
            parts.extend([joints::stop_forces(model, v), joints::friction_forces(model, v)]);
        }
        if !model.chain.loads.is_empty() {
            parts.push(loads::forces(model, &self.kinematics, t));
        }
        if !model.chain.connectors.is_empty() {
            parts.push(connectors::forces(model, &self.kinematics, t, Some(v)));
        }
        sum(&parts)
    }

    /// Energy of connectors and power of winches, if there are any.
    fn connector_energies(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let mut functions = Vec::new();
        if !chain.connectors.is_empty() {
            functions.push(function(
                FunctionId::ConnectorEnergy,
                "Energy of connectors, J.",
                "½ Σ k (ℓ − ℓ₀)² − P (ℓ − ℓ₀)",
                &[Time, Position],
                Shape::Scalar,
                vec![connectors::energy(model, &self.kinematics)],
            ));
        }
        if chain.connectors.iter().any(|connector| connector.winch().is_some()) {
            functions.push(function(
                FunctionId::WinchPower,
                "Power that winches put in, W.",
                "−Σ F ℓ̇₀",
                &[Time, Position, Velocity],
                Shape::Scalar,
                vec![connectors::winch_power(model, &self.kinematics)],
            ));
        }
        functions
    }

    pub(super) fn energies(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let scalar =
            |id, doc, equation, arguments, expr| function(id, doc, equation, arguments, Shape::Scalar, vec![expr]);
        let mut functions = vec![scalar(
            FunctionId::GravityEnergy,
            "Potential energy of gravity, zero at the world's origin, J.",
            "E_g = −Σ γ · ∫ x dm [Urbaś 2016, Eq. (6)]",
            &[Position],
            gravity::energy(model, &self.inertias),
        )];
        if !chain.supports.is_empty() {
            functions.push(scalar(
                FunctionId::SupportEnergy,
                "Energy of the supports' springs, J.",
                "½ Σ s e² [Urbaś 2016, Eqs. (16)–(17)]",
                &[Position],
                supports::energy(model, &self.kinematics),
            ));
        }
        if !chain.beam_springs.is_empty() {
            functions.push(scalar(
                FunctionId::ElementEnergy,
                "Energy of the springs between rigid elements, J.",
                "½ q̃ᵀ S q̃ [Urbaś 2016, Eq. (14)]",
                &[Position],
                springs::element_energy(model),
            ));
        }
        if !chain.drives.is_empty() {
            if chain.drives.iter().any(|drive| drive.spring().is_some()) {
                functions.push(scalar(
                    FunctionId::DriveEnergy,
                    "Energy of the drives' springs, J.",
                    "½ Σ s (q_dr − q)² [Urbaś 2016, Eq. (19)]",
                    &[Time, Position],
                    drives::energy(model),
                ));
            }
            let (power, trace) = self.recorded_if_rigid(|| {
                let efforts = if self.rigid { self.rigid_efforts() } else { vec![] };
                drives::power(model, &efforts)
            });
            functions.push(
                scalar(
                    FunctionId::DrivePower,
                    "Power of the prescribed motions, W.",
                    "Σ t_dr q̇_dr",
                    &[Time, Position, Velocity],
                    power,
                )
                .by(trace),
            );
        }
        if !chain.loads.is_empty() {
            functions.push(scalar(
                FunctionId::LoadPower,
                "Power that the loads applied from outside put in, W.",
                "Σ F · ẋ + M · ω",
                &[Time, Position, Velocity],
                loads::power(model, &self.kinematics, &self.twists),
            ));
        }
        functions.extend(self.connector_energies());
        if chain.stops().next().is_some() {
            functions.push(scalar(
                FunctionId::StopEnergy,
                "Energy of the end stops, J.",
                "½ Σ k δ²",
                &[Position],
                joints::stop_energy(model),
            ));
        }
        let linear =
            supports::dissipation(model, &self.kinematics) + springs::dissipation(model) + drives::dissipation(model);
        let joints = if chain.forces.is_empty() { linear } else { linear + joints::dissipation(model) };
        let between_points = (!chain.connectors.is_empty()).then(|| connectors::dissipation(model, &self.kinematics));
        let dissipation = between_points.map_or(joints, |connectors| joints + connectors);
        if !dissipation.is_zero() {
            functions.push(scalar(
                FunctionId::Dissipation,
                "Power that all dampers dissipate, W.",
                "2R [Urbaś 2016, Eqs. (14), (17), (19)]",
                &[Time, Position, Velocity],
                dissipation,
            ));
        }
        functions
    }
}
