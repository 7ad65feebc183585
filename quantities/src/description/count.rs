//! Numbers of the parts of a crane.

use super::{Description, LoopJointInfo};
use crate::Count;

impl Description {
    /// How many of these parts the crane has, with the joints that close its loops.
    pub fn count(&self, loop_joints: &[LoopJointInfo], count: Count) -> usize {
        let degrees = self.bodies.iter().map(|body| body.degrees_of_freedom);
        match count {
            Count::Bodies => self.bodies.len(),
            Count::Points => self.points.len(),
            Count::Supports => self.supports.len(),
            Count::Drives => self.drives.len(),
            Count::Cylinders => self.cylinders.len(),
            Count::Connectors => self.connectors.len(),
            Count::Sections => self.sections.len(),
            Count::Cuts => {
                let follows = |body: usize| body > 0 && self.bodies[body].link == self.bodies[body - 1].link;
                let joints = (0..self.bodies.len()).filter(|body| !follows(*body)).count();
                // The first section of a body is where the body begins.
                let is_inside =
                    |section: usize| section > 0 && self.sections[section].body == self.sections[section - 1].body;
                1 + joints + self.bodies.len() + (0..self.sections.len()).filter(|section| is_inside(*section)).count()
            }
            Count::Coordinates => self.coordinates.len(),
            Count::LoopEquations => loop_joints.iter().map(|joint| joint.equations.len()).sum(),
            Count::LoopRows => Count::loop_rows(self.count(loop_joints, Count::LoopEquations), self.coordinates.len()),
            Count::DrivePieces => self.drives.iter().map(|drive| drive.pieces).sum(),
            Count::LoadPieces => self.loads.iter().map(|load| load.pieces).sum(),
            Count::WinchPieces => self.connectors.iter().map(|connector| connector.pieces).sum(),
            Count::Attachments => {
                self.points_of_connectors() + loop_joints.iter().flat_map(|joint| &joint.ends).flatten().count()
            }
            Count::Derivatives => degrees.sum(),
            Count::SecondDerivatives => degrees.map(|n| n * (n + 1) / 2).sum(),
            Count::Axes => 3,
            Count::PosesAndRates => 2,
            Count::ResidualFactors => Count::RESIDUAL_FACTORS,
            Count::MassFactors => Count::MASS_FACTORS,
            Count::CylinderCuts
            | Count::ConnectorCuts
            | Count::LoopCuts
            | Count::PointAxes
            | Count::SupportAxes
            | Count::ResidualRows => count.factors().iter().map(|factor| self.count(loop_joints, *factor)).product(),
        }
    }

    /// How many points all connectors have: of the `attachments`, those of loop joints come behind them.
    pub fn points_of_connectors(&self) -> usize {
        self.connectors.iter().map(|connector| connector.points.len()).sum()
    }
}
