//! Metadata of a live crane.

use crane_codegen::chain::{self, BodyId, Chain, CoordinateId, CoordinateKind as Kind, Profile, SupportKinematics};
use crane_model::{
    AttachmentInfo, BodyInfo, Bound, BristleInfo, ConnectorInfo, CoordinateInfo, CoordinateKind, CoordinateRole,
    CylinderInfo, Description, DriveInfo, EventInfo, InputInfo, JoinsInfo, LoadInfo, LoopEquationInfo, LoopJointInfo,
    ParameterInfo, PumpInfo, Refusal, SectionInfo, Side, StageInfo, SupportInfo, ValveInfo,
};

/// What the bodies of a chain with branches are attached to, as the compiler writes it.
pub fn parents(chain: &Chain) -> Vec<usize> {
    let parents = chain.bodies.iter().filter_map(|body| body.parent).map(|BodyId(parent)| parent);
    if chain.has_branches() { parents.collect() } else { Vec::new() }
}

/// The description of a chain, as the compiler writes it.
pub fn describe(chain: &Chain) -> Description {
    let defaults = chain.parameter_defaults();
    let parameters = chain.parameters.iter().map(|parameter| ParameterInfo {
        name: parameter.name.clone().into(),
        unit: parameter.unit.clone().into(),
        about: parameter.about.clone().into(),
        default: parameter.default,
        lower_bound: parameter.lower_bound.as_ref().map_or(Bound::LOWEST, bound),
        upper_bound: Bound::HIGHEST,
    });
    let coordinates = chain.coordinates.iter().enumerate().map(|(index, coordinate)| CoordinateInfo {
        name: coordinate.name.clone().into(),
        kind: kind_of(coordinate.kind),
        role: role(chain, index),
    });
    let bodies = chain.bodies.iter().enumerate().map(|(index, body)| BodyInfo {
        name: body.name.clone().into(),
        link: body.link.clone().into(),
        degrees_of_freedom: chain.degrees_of_freedom(BodyId(index)),
    });
    let sections = chain.beams.iter().flat_map(|beam| &beam.sections).map(|section| SectionInfo {
        body: section.body.0,
        side: match section.side {
            chain::Side::Before => Side::Before,
            chain::Side::Both => Side::Both,
            chain::Side::After => Side::After,
        },
        at: section.at.clone().into(),
        slides: section.slides.is_some(),
    });
    let supports = chain.supports.iter().map(|support| SupportInfo {
        name: support.name.clone().into(),
        linear: support.kinematics == SupportKinematics::Linear,
        one_sided: support.friction.is_some(),
    });
    let drives = chain.drives.iter().map(|drive| DriveInfo {
        coordinate: drive.coordinate.0,
        start: drive.profile.start(&defaults),
        pieces: drive.pieces().len(),
        max_rate: drive.max_rate(),
        max_power: drive.max_power(),
    });
    let loads = chain.loads.iter().map(|load| LoadInfo { name: load.name.clone().into(), pieces: load.pieces() });
    let connectors = chain.connectors().iter().map(|connector| ConnectorInfo {
        name: connector.name.clone().into(),
        points: points_of(connector).iter().map(attachment_info).collect(),
        falls: connector.strain.line().map_or(1, |line| line.falls as usize),
        kind: kind_of(chain.kind_of(&connector.strain)),
        is_rope: connector.is_rope(),
        is_contact: connector.is_contact(),
        spanned: Chain::range(&chain.spanned(&connector.strain)),
        pieces: connector.pieces(),
    });
    let inputs = chain.inputs.iter().map(|input| InputInfo {
        name: input.name.clone().into(),
        unit: input.unit.clone().into(),
        about: input.about.clone().into(),
        default: input.unless_set.start(&defaults),
        moves: !matches!(input.unless_set, Profile::Hold(_)),
    });
    let cylinders = chain.cylinders.iter().map(|cylinder| cylinder_info(chain, cylinder));
    let pump = chain.pump.as_ref().map(|pump| PumpInfo {
        max_flow: pump.max_flow,
        pressure: pump.pressure,
        volume: pump.volume,
    });
    Description {
        name: chain.name.clone().into(),
        title: chain.title.clone().into(),
        spec_hash: chain.spec_hash.clone().into(),
        parameters: parameters.collect(),
        coordinates: coordinates.collect(),
        bodies: bodies.collect(),
        sections: sections.collect(),
        supports: supports.collect(),
        drives: drives.collect(),
        stops: chain.stopped().into_iter().map(|id| id.0).collect(),
        frictions: chain.frictions().map(|(id, _)| id.0).collect(),
        bristles: chain.bristles().map(bristle_info).collect(),
        loads: loads.collect(),
        connectors: connectors.collect(),
        inputs: inputs.collect(),
        cylinders: cylinders.collect(),
        pump,
        points: chain.points.iter().map(|point| point.name.clone().into()).collect(),
        statics: chain.analyses.statics,
        guess: chain.guess.iter().copied().collect(),
        duration: chain.run.duration,
        step: chain.run.step,
        output: chain.run.output,
        events: chain.events.iter().map(event_info).collect(),
    }
}

fn event_info(event: &chain::Event) -> EventInfo {
    EventInfo {
        name: event.name.clone().into(),
        time: event.time,
        changes: event.changes.iter().map(|(id, value)| (id.0, *value)).collect(),
        joins: event.joins.map(|chain::Joins { velocity, point }| JoinsInfo { velocity, point }),
    }
}

/// The points of a connector.
fn points_of(connector: &chain::Force) -> &[chain::Attachment] {
    connector.strain.points()
}

/// The joints of a chain that close loops, and its exact couplings.
pub fn describe_loop_joints(chain: &Chain) -> Vec<LoopJointInfo> {
    let joint = |joint: &chain::LoopJoint| LoopJointInfo {
        name: joint.name.clone().into(),
        kind: joint.kind.name().into(),
        ends: Some(joint.ends.each_ref().map(attachment_info)),
        spanned: Chain::range(&chain.closed_by(joint)),
        equations: joint.kind.equations().into_iter().map(equation_info).collect(),
    };
    let coupling = |coupling: &chain::RigidCoupling| LoopJointInfo {
        name: coupling.name.clone().into(),
        kind: chain::RigidCoupling::KIND.into(),
        ends: None,
        spanned: Chain::range(&coupling.follower.coordinates()),
        equations: std::iter::once(equation_info(coupling.equation())).collect(),
    };
    chain.loop_joints.iter().map(joint).chain(chain.rigid_couplings.iter().map(coupling)).collect()
}

/// The stages of its telescopes.
pub fn describe_stages(chain: &Chain) -> Vec<StageInfo> {
    let stage = |stage: &chain::Stage<'_>| StageInfo {
        outer: [stage.outer.first.0, stage.outer.last().0 + 1],
        inner: stage.inner.0,
        coordinate: stage.coordinate.0,
    };
    chain.stages().iter().map(stage).collect()
}

fn equation_info(chain::LoopEquation { direction, is_moment }: chain::LoopEquation) -> LoopEquationInfo {
    LoopEquationInfo { direction: direction.into(), is_moment }
}

fn attachment_info(end: &chain::Attachment) -> AttachmentInfo {
    AttachmentInfo { body: end.body.map(|BodyId(body)| body) }
}

fn bound(bound: &chain::Bound) -> Bound {
    Bound { value: bound.value, allowed: bound.allowed, refusal: refusal(&bound.refusal) }
}

/// The compiler's message about parameters that break a rule.
pub fn refusal(refusal: &chain::Refusal) -> Refusal {
    let chain::Refusal { code, title, help } = refusal;
    Refusal { code: (*code).into(), title: title.clone().into(), help: help.clone().into() }
}

fn role(chain: &Chain, index: usize) -> CoordinateRole {
    if chain.base.iter().flatten().any(|id| id.0 == index) {
        CoordinateRole::Base
    } else if chain.is_prescribed(CoordinateId(index)) {
        CoordinateRole::Prescribed
    } else if chain.drives.iter().any(|drive| drive.coordinate.0 == index) {
        CoordinateRole::Driven
    } else if chain.turns_by_vector(CoordinateId(index)) {
        CoordinateRole::ElementVector
    } else if chain.is_of_element(CoordinateId(index)) {
        CoordinateRole::Element
    } else {
        CoordinateRole::Passive
    }
}

fn kind_of(kind: Kind) -> CoordinateKind {
    match kind {
        Kind::Translation => CoordinateKind::Translation,
        Kind::Rotation => CoordinateKind::Rotation,
    }
}

fn bristle_info((id, bristle): (chain::CoordinateId, chain::Bristle)) -> BristleInfo {
    let chain::Bristle { coulomb, breakaway, stribeck, stiffness, damping } = bristle;
    BristleInfo { coordinate: id.0, coulomb, breakaway, stribeck, stiffness, damping }
}

fn cylinder_info(chain: &Chain, cylinder: &chain::Cylinder) -> CylinderInfo {
    CylinderInfo {
        name: cylinder.name.clone().into(),
        drive: chain.drive_of(cylinder),
        areas: cylinder.areas(),
        spanned: Chain::range(&chain.spanned_by(cylinder)),
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
            commanded: chain.drives[chain.drive_of(cylinder)].opening().is_some(),
            gain: valve.gain,
            feed_forward: valve.feed_forward,
            leakage: valve.leakage,
        }),
    }
}
