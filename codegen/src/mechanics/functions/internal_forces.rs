//! Forces and moments that joints, sections and the ground transmit, and the section moduli from which the stresses of beams follow.

use super::Derivation;
use crate::chain::{Beam, Moduli};
use crate::mechanics::model::Model;
use crate::mechanics::place::{Place, Pull};
use crate::mechanics::{connectors, cylinders, newton_euler, supports};
use crate::program::{Function, FunctionId};
use crate::symbolic::Expr;

/// The documentation of the internal forces of a crane with valves.
const WITHOUT_VALVES: &str = "Force (N) and moment (N m) that the part beyond a cut exerts on the part before it, cut by cut. Cylinders with a \
                              valve are not included: add `cylinder_wrenches` times their forces.";

impl<'g> Derivation<'g> {
    pub(super) fn internal_forces(&self) -> Vec<Function> {
        let model = &self.model;
        let (wrenches, trace) = model.graph.recorded(|| newton_euler::internal_forces(self.posed(), &self.factors));
        let mut functions = vec![self.function(FunctionId::InternalForces, wrenches).by(trace)];
        if model.chain.has_valves() {
            functions[0].doc = WITHOUT_VALVES;
            functions.push(self.cylinder_wrenches());
        }
        if model.chain.connectors().iter().any(|connector| connector.strain.joins_bodies()) {
            functions.push(self.connector_wrenches());
        }
        if model.chain.has_loops() {
            functions.push(self.loop_wrenches());
        }
        if !model.chain.supports.is_empty() {
            functions.push(self.function(FunctionId::SupportPositions, supports::positions(model, &self.kinematics)));
        }
        let moduli: Vec<_> = model.chain.beams.iter().flat_map(|beam| section_moduli(model, beam)).collect();
        if !moduli.is_empty() {
            functions.push(self.function(FunctionId::SectionModuli, moduli));
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
        self.function(FunctionId::CylinderWrenches, wrenches)
    }

    /// What connectors between bodies contribute to the internal forces, each pulling with 1 N.
    fn connector_wrenches(&self) -> Function {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let of_connector = |pulls: Vec<(Place<'g>, Pull<'g>)>| {
            let on_bodies = pulls.into_iter().map(|(place, pull)| (place, pull.about_origin()));
            newton_euler::transmitted(model, kinematics, &self.factors, on_bodies.collect())
        };
        let wrenches = connectors::between_bodies(self.posed()).into_iter().flat_map(of_connector).collect();
        self.function(FunctionId::ConnectorWrenches, wrenches)
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
