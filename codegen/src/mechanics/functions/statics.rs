//! Statics and small motions.

use super::{Derivation, function};
use crate::mechanics::columns::columns;
use crate::mechanics::model::Model;
use crate::mechanics::vector::SymmetricMatrix;
use crate::mechanics::{connectors, cylinders, gravity};
use crate::program::Argument::{DrivePositions, Position, Time};
use crate::program::{Function, FunctionId, Shape};
use crate::symbolic::Expr;

impl<'g> Derivation<'g> {
    pub(super) fn statics(&self) -> Vec<Function> {
        let mut functions = vec![
            function(
                FunctionId::StaticResidual,
                "Gradient of the potential energy at t = 0, zero in equilibrium; N and N m.",
                "∂E_p/∂q [Urbaś 2016, Eqs. (7), (15), (18), (20)]",
                &[Position],
                Shape::Vector(self.model.size()),
                self.static_residual(),
            ),
            function(
                FunctionId::TangentStiffness,
                "Tangent stiffness K: second derivatives of the potential energy; N/m, N and N m.",
                "∂²E_p/∂q∂q",
                &[Position],
                Shape::Symmetric(self.model.size()),
                self.unknowns(self.tangent_stiffness(), 1.0).into_upper(),
            ),
        ];
        let by_oil = self.model.chain.has_valves();
        if self.rigid || by_oil {
            functions.push(function(
                FunctionId::DriveForcesAtRest,
                "Generalized forces of the drives that hold the crane at rest at t = 0, N and N m.",
                "s (q_dr − q) [Urbaś 2016, Eq. (20)]; of rigid drives ∂E_p/∂q_j; of cylinders with a valve k (ℓ₀ − ℓ) ∂ℓ/∂q",
                &[Position],
                Shape::Vector(self.model.size()),
                self.drive_forces_at_rest(),
            ));
        }
        if by_oil {
            functions.extend(self.holding());
        }
        if !self.model.chain.connectors.is_empty() {
            let mut stiffness = SymmetricMatrix::zero(self.model.graph, self.model.size());
            connectors::stiffness(&self.model, &self.kinematics, self.model.t, &mut stiffness);
            functions.push(function(
                FunctionId::ConnectorStiffness,
                "Contribution of connectors to the tangent stiffness, with winches at time t; N/m, N and N m.",
                "∂²E/∂q∂q",
                &[Time, Position],
                Shape::Symmetric(self.model.size()),
                self.unknowns(stiffness, 0.0).into_upper(),
            ));
        }
        functions
    }

    /// Cylinders with a valve that hold the crane at rest at any positions of their drives.
    fn holding(&self) -> [Function; 2] {
        let Model { chain, graph, drive_positions, .. } = &self.model;
        let mut stiffness = SymmetricMatrix::zero(graph, chain.coordinates.len());
        cylinders::holding_stiffness(&self.model, drive_positions, &mut stiffness);
        [
            function(
                FunctionId::HoldingForces,
                "Generalized forces of cylinders with a valve that hold the crane at rest with the drives at given positions, N and N m.",
                "k (ℓ₀ − ℓ) ∂ℓ/∂q, k = s/(∂ℓ/∂q_j)₀²",
                &[Position, DrivePositions],
                Shape::Vector(self.model.size()),
                cylinders::holding_forces(&self.model, drive_positions),
            ),
            function(
                FunctionId::HoldingStiffness,
                "Contribution of these cylinders to the tangent stiffness; N/m, N and N m.",
                "k (∂ℓ/∂q)ᵀ ∂ℓ/∂q − k (ℓ₀ − ℓ) ∂²ℓ/∂q∂q",
                &[Position, DrivePositions],
                Shape::Symmetric(self.model.size()),
                self.unknowns(stiffness, 0.0).into_upper(),
            ),
        ]
    }

    /// `∂E_p/∂q`, 0 where a coordinate is prescribed.
    fn static_residual(&self) -> Vec<Expr<'g>> {
        let mut residual = self.gradient();
        for drive in self.model.chain.rigid_drives() {
            residual[drive.coordinate.0] = self.model.zero();
        }
        residual
    }

    /// Forces of all drives at rest; rigid drives balance the sum of all other forces.
    fn drive_forces_at_rest(&self) -> Vec<Expr<'g>> {
        let model = &self.model;
        let mut forces = self.forces().drives_at_rest();
        let gradient = self.gradient();
        for drive in model.chain.rigid_drives() {
            forces[drive.coordinate.0] = gradient[drive.coordinate.0];
        }
        forces
    }

    /// A matrix of small motions. In the rows and columns of prescribed coordinates, which do not move, it is zero except for
    /// `diagonal` on the diagonal.
    fn unknowns(&self, matrix: SymmetricMatrix<'g>, diagonal: f64) -> SymmetricMatrix<'g> {
        let diagonal = self.model.graph.constant(diagonal);
        self.model.chain.rigid_drives().fold(matrix, |matrix, drive| matrix.without(drive.coordinate.0, diagonal))
    }

    /// `∂E_p/∂q`: gravity minus all forces at rest and t = 0.
    fn gradient(&self) -> Vec<Expr<'g>> {
        let gravity = gravity::gradient(&self.model, &self.kinematics, &self.inertias);
        let forces = self.forces().all_at_rest();
        gravity.into_iter().zip(forces).map(|(g, f)| g - f).collect()
    }

    /// The stiffness including the springs that represent oil at rest.
    fn tangent_stiffness(&self) -> SymmetricMatrix<'g> {
        let mut matrix = self.stiffness();
        if self.model.chain.has_valves() {
            cylinders::holding_stiffness(&self.model, &cylinders::positions_at_start(&self.model), &mut matrix);
        }
        matrix
    }

    /// The stiffness without that of hydraulic drives, which follows from their oil volumes.
    fn stiffness(&self) -> SymmetricMatrix<'g> {
        let mut matrix = self.forces().stiffness();
        gravity::stiffness(&self.model, &self.kinematics, &self.inertias, &mut matrix);
        matrix
    }

    pub(super) fn linearise(&self) -> Function {
        let model = &self.model;
        let damping = self.forces().damping();
        let columns = columns(model, &self.factors);
        let mut outputs = self.unknowns(columns.mass_matrix(model), 1.0).into_upper();
        outputs.extend(self.unknowns(self.stiffness(), 1.0).into_upper());
        outputs.extend(self.unknowns(damping, 0.0).into_upper());
        let matrix = || Shape::Symmetric(model.size());
        let shape =
            Shape::Record("Linearisation", vec![("mass", matrix()), ("stiffness", matrix()), ("damping", matrix())]);
        function(
            FunctionId::Linearise,
            "Mass matrix A, tangent stiffness K and damping matrix D of small motions about a pose at rest.",
            "A δq̈ + D δq̇ + K δq = 0",
            &[Position],
            shape,
            outputs,
        )
    }
}
