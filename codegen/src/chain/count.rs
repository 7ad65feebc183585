//! Numbers of the parts of a chain.

use crane_quantities::Count;

use super::{Attachment, BodyId, Chain, Force, Load};

impl Chain {
    /// The points of all connectors, then both ends of all joints that close loops.
    pub fn attachments(&self) -> impl Iterator<Item = &Attachment> {
        let of_connectors = self.connectors().iter().flat_map(|connector| connector.strain.points());
        of_connectors.chain(self.loop_joints.iter().flat_map(|joint| &joint.ends))
    }

    /// How many of these parts it has.
    #[must_use]
    pub fn count(&self, count: Count) -> usize {
        let degrees = (0..self.bodies.len()).map(|body| self.degrees_of_freedom(BodyId(body)));
        match count {
            Count::Bodies => self.bodies.len(),
            Count::Points => self.points.len(),
            Count::Supports => self.supports.len(),
            Count::Drives => self.drives.len(),
            Count::Cylinders => self.cylinders.len(),
            Count::Connectors => self.connectors().len(),
            Count::Sections => self.beams.iter().map(|beam| beam.sections.len()).sum(),
            Count::Cuts => self.cuts().len(),
            Count::Coordinates => self.coordinates.len(),
            Count::LoopEquations => self.loop_equations().count(),
            Count::LoopRows => Count::loop_rows(self.loop_equations().count(), self.coordinates.len()),
            Count::DrivePieces => self.drives.iter().map(|drive| drive.pieces().len()).sum(),
            Count::LoadPieces => self.loads.iter().map(Load::pieces).sum(),
            Count::WinchPieces => self.connectors().iter().map(Force::pieces).sum(),
            Count::Attachments => self.attachments().count(),
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
            | Count::ResidualRows => count.factors().iter().map(|factor| self.count(*factor)).product(),
        }
    }
}
