//! Statics and small motions.

use super::{Derivation, shaped};
use crate::chain::CoordinateId;
use crate::mechanics::acts::Rest;
use crate::mechanics::columns::columns;
use crate::mechanics::forces::{Kind, rest_at_start};
use crate::mechanics::tangent::Tangent;
use crate::mechanics::vector::SymmetricMatrix;
use crate::mechanics::{cylinders, gravity};
use crate::program::{Function, FunctionId, Shape};
use crate::symbolic::Expr;

impl<'g> Derivation<'g> {
    /// Functions of the pose, the time of loads and winches, and the positions of the drives.
    pub(super) fn statics(&self) -> Vec<Function> {
        let (model, rest) = (&self.model, Rest::given(&self.model));
        let gradient = self.gradient(&rest);
        let (mut residual, mut holding) = (gradient.clone(), self.forces().forces_of_kind(Kind::Drives).at_rest(&rest));
        for CoordinateId(j) in model.chain.rigid_drives().map(|drive| drive.coordinate) {
            // A rigid drive balances the sum of all other forces.
            (residual[j], holding[j]) = (model.zero(), gradient[j]);
        }
        let mut functions = vec![self.function(FunctionId::StaticResidual, residual), self.tangent_stiffness(&rest)];
        if !model.chain.drives.is_empty() {
            functions.push(self.function(FunctionId::DriveForcesAtRest, holding));
        }
        functions
    }

    /// A matrix of small motions. In the rows and columns of prescribed coordinates, which do not move, it is zero except for
    /// `diagonal` on the diagonal.
    fn unknowns(&self, matrix: SymmetricMatrix<'g>, diagonal: f64) -> SymmetricMatrix<'g> {
        let diagonal = self.model.graph.constant(diagonal);
        self.model.chain.rigid_drives().fold(matrix, |matrix, drive| matrix.without(drive.coordinate.0, diagonal))
    }

    /// `∂E_p/∂q`: gravity minus all forces at rest.
    fn gradient(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        let gravity = gravity::gradient(&self.model, &self.kinematics, &self.inertias);
        let forces = self.forces().all_at_rest(rest);
        gravity.into_iter().zip(forces).map(|(g, f)| g - f).collect()
    }

    /// The stiffness including the springs that represent oil at rest.
    fn tangent_stiffness(&self, rest: &Rest<'g>) -> Function {
        let (model, id) = (&self.model, FunctionId::TangentStiffness);
        let hold = |matrix: &mut SymmetricMatrix<'g>| {
            if model.chain.has_valves() {
                cylinders::holding_stiffness(model, &rest.positions, matrix);
            }
        };
        let mut tangent = self.stiffness(rest);
        if model.chain.loops.fill_tangent(model.size()) {
            hold(&mut tangent.matrix);
            let prescribed: Vec<usize> = model.chain.rigid_drives().map(|drive| drive.coordinate.0).collect();
            let (shape, factors) = tangent.into_factors(model, &prescribed);
            return shaped(id, shape, factors);
        }
        let mut matrix = tangent.into_matrix(model);
        hold(&mut matrix);
        self.function(id, self.unknowns(matrix, 1.0).into_upper())
    }

    /// The stiffness without that of hydraulic drives, which follows from their oil volumes.
    fn stiffness(&self, rest: &Rest<'g>) -> Tangent<'_, 'g> {
        let mut tangent = Tangent::new(&self.model, &self.kinematics);
        self.forces().add_stiffness(rest, &mut tangent);
        gravity::add_stiffness(&self.model, &self.kinematics, &self.inertias, &mut tangent);
        tangent
    }

    pub(super) fn linearise(&self) -> Function {
        let (model, rest) = (&self.model, rest_at_start(&self.model));
        let damping = self.forces().damping(&rest);
        let columns = columns(model, &self.factors);
        let mut outputs = self.unknowns(columns.mass_matrix(model), 1.0).into_upper();
        outputs.extend(self.unknowns(self.stiffness(&rest).into_matrix(model), 1.0).into_upper());
        outputs.extend(self.unknowns(damping, 0.0).into_upper());
        let matrix = || Shape::Symmetric(model.size());
        let shape =
            Shape::Record("Linearisation", vec![("mass", matrix()), ("stiffness", matrix()), ("damping", matrix())]);
        shaped(FunctionId::Linearise, shape, outputs)
    }
}
