//! Forces and moments that joints, sections and the ground transmit, and the section moduli from which the stresses of beams follow.

use super::{Derivation, function};
use crate::chain::{Beam, Force, Moduli};
use crate::mechanics::model::Model;
use crate::mechanics::{connectors, cylinders, newton_euler, supports};
use crate::program::Argument::{Acceleration, Position, Time, Velocity};
use crate::program::{Function, FunctionId, Shape, Struct};
use crate::symbolic::Expr;

impl Derivation<'_> {
    pub(super) fn internal_forces(&self) -> Vec<Function> {
        let model = &self.model;
        let (wrenches, trace) =
            model.graph.recorded(|| newton_euler::internal_forces(model, &self.kinematics, &self.factors));
        let mut functions = vec![
            function(
                FunctionId::InternalForces,
                if model.chain.has_valves() {
                    "Force (N) and moment (N m) that the part beyond a cut exerts on the part before it, cut by cut. Cylinders with a valve are \
                     not included: add `cylinder_wrenches` times their forces."
                } else {
                    "Force (N) and moment (N m) that the part beyond a cut exerts on the part before it, cut by cut."
                },
                "Σ F − Σ ∫ (ẍ − γ) dm, Σ (M + r × F) − Σ ∫ r × (ẍ − γ) dm over everything beyond, by Newton and Euler",
                &[Time, Position, Velocity, Acceleration],
                Shape::Structs(Struct::Wrench, model.chain.cuts().len()),
                wrenches,
            )
            .by(trace),
        ];
        if model.chain.has_valves() {
            functions.push(self.cylinder_wrenches());
        }
        if model.chain.connectors().iter().any(|connector| connector.strain.joins_bodies()) {
            functions.push(self.connector_wrenches());
        }
        if !model.chain.loop_joints.is_empty() {
            functions.push(self.loop_wrenches());
        }
        if !model.chain.supports.is_empty() {
            functions.push(function(
                FunctionId::SupportPositions,
                "Positions of the supports' attachment points in the world frame, m.",
                "T(1) r_E",
                &[Position],
                Shape::Vectors(model.chain.supports.len()),
                supports::positions(model, &self.kinematics),
            ));
        }
        let sections: usize = model.chain.beams.iter().map(|beam| beam.sections.len()).sum();
        if sections > 0 {
            functions.push(function(
                FunctionId::SectionModuli,
                "Section properties for the stresses of beams: areas (m²), moduli (m³), allowable stress (Pa); 0 where unknown.",
                "A, W_y, W_z, W_t, A_y, A_z; yield stress over safety factor",
                &[],
                Shape::Structs(Struct::SectionModuli, sections),
                model.chain.beams.iter().flat_map(|beam| section_moduli(model, beam)).collect(),
            ));
        }
        functions
    }

    /// What cylinders add to the internal forces, each pushing with 1 N.
    fn cylinder_wrenches(&self) -> Function {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let of_cylinder = |cylinder| {
            newton_euler::transmitted(model, kinematics, &self.factors, cylinders::pushes(model, kinematics, cylinder))
        };
        let wrenches = model.chain.cylinders.iter().flat_map(of_cylinder).collect();
        function(
            FunctionId::CylinderWrenches,
            "Force (1) and moment (m) at every cut, cut by cut, due to each cylinder while it pushes with 1 N.",
            "Σ g, Σ r × g over everything beyond",
            &[Position],
            Shape::Structs(Struct::Wrench, model.chain.cylinders.len() * model.chain.cuts().len()),
            wrenches,
        )
    }

    /// What connectors between bodies contribute to the internal forces, each pulling with 1 N.
    fn connector_wrenches(&self) -> Function {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let of_connector = |connector: &Force| {
            let pulls = connectors::between_bodies(model, kinematics, &connector.strain);
            let on_bodies = pulls.into_iter().map(|(place, point, pull)| (place, [pull, point.cross(pull)]));
            newton_euler::transmitted(model, kinematics, &self.factors, on_bodies.collect())
        };
        let wrenches = model.chain.connectors().iter().flat_map(of_connector).collect();
        function(
            FunctionId::ConnectorWrenches,
            "Force (1) and moment (m) at every cut, cut by cut, due to each connector between two bodies while it pulls with 1 N.",
            "Σ e, Σ r × e over everything beyond",
            &[Position],
            Shape::Structs(Struct::Wrench, model.chain.connectors().len() * model.chain.cuts().len()),
            wrenches,
        )
    }
}

/// The slots of [`Struct::SectionModuli`] of all sections of a beam.
fn section_moduli<'g>(model: &Model<'g>, beam: &Beam) -> Vec<Expr<'g>> {
    let zero = model.zero();
    let allowable = beam.allowable_stress.as_ref().map_or(zero, |stress| model.number(stress));
    let of_section = |moduli: &Option<Moduli>| {
        let Some(Moduli { area, bending, torsion, shear, has_corners }) = moduli else { return [zero; 8] };
        let [wy, wz] = bending.each_ref().map(|modulus| model.number(modulus));
        let [ay, az] = shear.each_ref().map(|area| model.number(area));
        let corners = model.graph.constant(if *has_corners { 1.0 } else { 0.0 });
        [model.number(area), wy, wz, model.number(torsion), ay, az, corners, allowable]
    };
    beam.sections.iter().flat_map(|section| of_section(&section.moduli)).collect()
}
