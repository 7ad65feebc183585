//! What a crane is called and has, for live cranes and for generated code.

use std::iter;

use crane_quantities::{
    AttachmentInfo, BodyInfo, Bound, BristleInfo, ConnectorInfo, CoordinateInfo, CoordinateRole, CylinderInfo,
    Description, DriveInfo, InputInfo, LoadInfo, LoopEquationInfo, LoopJointInfo, ParameterInfo, PumpInfo, SectionInfo,
    StageInfo, SupportInfo, ValveInfo,
};

use super::{
    Attachment, BodyId, Bristle, Chain, CoordinateId, Cylinder, LoopEquation, LoopJoint, Profile, RigidCoupling, Stage,
    SupportKinematics,
};

impl Chain {
    /// Its names, units and settings.
    #[must_use]
    pub fn description(&self) -> Description {
        let defaults = self.parameter_defaults();
        let parameters = self.parameters.iter().map(|parameter| ParameterInfo {
            name: parameter.name.clone().into(),
            unit: parameter.unit.clone().into(),
            about: parameter.about.clone().into(),
            default: parameter.default,
            lower_bound: parameter.lower_bound.clone().unwrap_or(Bound::LOWEST),
            upper_bound: Bound::HIGHEST,
        });
        let coordinates = self.coordinates.iter().enumerate().map(|(index, coordinate)| CoordinateInfo {
            name: coordinate.name.clone().into(),
            kind: coordinate.kind,
            role: self.role(CoordinateId(index)),
        });
        let bodies = self.bodies.iter().enumerate().map(|(index, body)| BodyInfo {
            name: body.name.clone().into(),
            link: body.link.clone().into(),
            degrees_of_freedom: self.degrees_of_freedom(BodyId(index)),
        });
        let sections = self.beams.iter().flat_map(|beam| &beam.sections).map(|section| SectionInfo {
            body: section.body.0,
            side: section.side,
            at: section.at.clone().into(),
            slides: section.slides.is_some(),
        });
        let supports = self.supports.iter().map(|support| SupportInfo {
            name: support.name.clone().into(),
            linear: support.kinematics == SupportKinematics::Linear,
            one_sided: support.friction.is_some(),
            plate_area: support.plate.map(|(area, _)| area),
            max_pressure: support.plate.and_then(|(_, pressure)| pressure),
        });
        let drives = self.drives.iter().map(|drive| DriveInfo {
            coordinate: drive.coordinate.0,
            pieces: drive.pieces().len(),
            max_rate: drive.max_rate(),
            max_power: drive.max_power(),
        });
        let loads = self.loads.iter().map(|load| LoadInfo { name: load.name.clone().into(), pieces: load.pieces() });
        let connectors = self.connectors().iter().map(|connector| ConnectorInfo {
            name: connector.name.clone().into(),
            points: connector.strain.points().iter().map(attachment_info).collect(),
            falls: connector.strain.line().map_or(1, |line| line.falls as usize),
            kind: self.kind_of(&connector.strain),
            is_rope: connector.is_rope(),
            max_tension: connector.max_tension(),
            is_contact: connector.is_contact(),
            spanned: Chain::range(&self.spanned(&connector.strain)),
            pieces: connector.pieces(),
        });
        let inputs = self.inputs.iter().map(|input| InputInfo {
            name: input.name.clone().into(),
            unit: input.unit.clone().into(),
            about: input.about.clone().into(),
            default: match &input.unless_set {
                Profile::Hold(value) => value.as_constant(),
                _ => None,
            },
        });
        let known = self.known_guess(&defaults);
        let guess = self.written_guess.iter().zip(known).map(|(written, known)| match known {
            Some(_) => *written,
            None => Some(0.0),
        });
        let pump = self.pump.as_ref().map(|pump| PumpInfo {
            max_flow: pump.max_flow,
            pressure: pump.pressure,
            volume: pump.volume,
        });
        Description {
            name: self.name.clone().into(),
            title: self.title.clone().into(),
            spec_hash: self.spec_hash.clone().into(),
            parameters: parameters.collect(),
            coordinates: coordinates.collect(),
            bodies: bodies.collect(),
            sections: sections.collect(),
            supports: supports.collect(),
            drives: drives.collect(),
            stops: self.stopped().into_iter().map(|id| id.0).collect(),
            frictions: self.frictions().map(|(id, _)| id.0).collect(),
            bristles: self.bristles().map(bristle_info).collect(),
            loads: loads.collect(),
            connectors: connectors.collect(),
            inputs: inputs.collect(),
            cylinders: self.cylinders.iter().map(|cylinder| self.cylinder_info(cylinder)).collect(),
            pump,
            points: self.points.iter().map(|point| point.name.clone().into()).collect(),
            statics: self.analyses.statics,
            guess: guess.collect(),
            duration: self.run.duration,
            step: self.run.step,
            output: self.run.output,
            events: self.events.iter().cloned().collect(),
        }
    }

    /// The joints that close its loops, and its exact couplings.
    #[must_use]
    pub fn loop_joint_infos(&self) -> Vec<LoopJointInfo> {
        let joint = |joint: &LoopJoint| LoopJointInfo {
            name: joint.name.clone().into(),
            kind: joint.kind.name().into(),
            ends: Some(joint.ends.each_ref().map(attachment_info)),
            spanned: Chain::range(&self.closed_by(joint)),
            equations: joint.kind.equations().into_iter().map(equation_info).collect(),
        };
        let coupling = |coupling: &RigidCoupling| LoopJointInfo {
            name: coupling.name.clone().into(),
            kind: RigidCoupling::KIND.into(),
            ends: None,
            spanned: Chain::range(&coupling.follower.coordinates()),
            equations: iter::once(equation_info(coupling.equation())).collect(),
        };
        self.loop_joints.iter().map(joint).chain(self.rigid_couplings.iter().map(coupling)).collect()
    }

    /// The stages of its telescopes.
    #[must_use]
    pub fn stage_infos(&self) -> Vec<StageInfo> {
        let stage = |stage: &Stage<'_>| StageInfo {
            outer: [stage.outer.first.0, stage.outer.last().0 + 1],
            inner: stage.inner.0,
            coordinate: stage.coordinate.0,
        };
        self.stages().iter().map(stage).collect()
    }

    /// What the bodies after the first are attached to; nothing unless it has branches.
    #[must_use]
    pub fn parents(&self) -> Vec<usize> {
        let parents = self.bodies.iter().filter_map(|body| body.parent).map(|BodyId(parent)| parent);
        if self.has_branches() { parents.collect() } else { Vec::new() }
    }

    fn role(&self, id: CoordinateId) -> CoordinateRole {
        if self.base.contains(&Some(id)) {
            CoordinateRole::Base
        } else if self.is_prescribed(id) {
            CoordinateRole::Prescribed
        } else if self.drives.iter().any(|drive| drive.coordinate == id) {
            CoordinateRole::Driven
        } else if self.turns_by_vector(id) {
            CoordinateRole::ElementVector
        } else if self.is_of_element(id) {
            CoordinateRole::Element
        } else {
            CoordinateRole::Passive
        }
    }

    fn cylinder_info(&self, cylinder: &Cylinder) -> CylinderInfo {
        let drive = self.drive_of(cylinder);
        CylinderInfo {
            name: cylinder.name.clone().into(),
            drive,
            areas: cylinder.areas(),
            spanned: Chain::range(&self.spanned_by(cylinder)),
            retracted: cylinder.retracted,
            stroke: cylinder.stroke,
            max_pressure: cylinder.max_pressure,
            back_pressure: cylinder.back_pressure,
            bulk_modulus: cylinder.bulk_modulus,
            hose_volumes: cylinder.hose_volumes,
            valve: cylinder.valve.as_ref().map(|valve| ValveInfo {
                flow: valve.flow,
                pressure_drop: valve.pressure_drop,
                overlap: valve.overlap,
                lag: valve.lag,
                commanded: self.drives[drive].opening().is_some(),
                gain: valve.gain,
                feed_forward: valve.feed_forward,
                leakage: valve.leakage,
            }),
        }
    }
}

fn equation_info(LoopEquation { direction, is_moment }: LoopEquation) -> LoopEquationInfo {
    LoopEquationInfo { direction: direction.into(), is_moment }
}

fn attachment_info(end: &Attachment) -> AttachmentInfo {
    AttachmentInfo { body: end.body.map(|BodyId(body)| body) }
}

fn bristle_info((id, bristle): (CoordinateId, Bristle)) -> BristleInfo {
    let Bristle { coulomb, breakaway, stribeck, stiffness, damping } = bristle;
    BristleInfo { coordinate: id.0, coulomb, breakaway, stribeck, stiffness, damping }
}
