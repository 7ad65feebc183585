//! What an interpreted crane says about itself.

use crane_codegen::chain::{
    self, BodyId, Chain, CoordinateId, CoordinateKind as Kind, Drive, SupportKinematics, Value,
};

use crane_model::{
    BodyInfo, Bound, CoordinateInfo, CoordinateKind, CoordinateRole, Description, DriveInfo, List, ParameterInfo,
    Refusal, SupportInfo, Text,
};

/// The description of a chain, as the compiler writes it.
pub fn describe(chain: &Chain) -> Description {
    let defaults = chain.parameter_defaults();
    let at_defaults = |value: &Value| value.at(&defaults);
    let parameters = chain.parameters.iter().map(|p| ParameterInfo {
        name: Text::from(p.name.clone()),
        unit: Text::from(p.unit.clone()),
        about: Text::from(p.about.clone()),
        default: p.default,
        least: p.least.as_ref().map_or(Bound::LEAST, bound),
        greatest: Bound::GREATEST,
    });
    let coordinates = chain.coordinates.iter().enumerate().map(|(index, coordinate)| CoordinateInfo {
        name: Text::from(coordinate.name.clone()),
        kind: match coordinate.kind {
            Kind::Translation => CoordinateKind::Translation,
            Kind::Rotation => CoordinateKind::Rotation,
        },
        role: role(chain, index),
    });
    let bodies = chain.bodies.iter().enumerate().map(|(index, body)| BodyInfo {
        name: Text::from(body.name.clone()),
        link: Text::from(body.link.clone()),
        mass: body.inertia.as_ref().map_or(0.0, |inertia| at_defaults(&inertia.mass)),
        length: at_defaults(&body.length),
        degrees_of_freedom: chain.degrees_of_freedom(BodyId(index)),
    });
    let supports = chain.supports.iter().map(|support| SupportInfo {
        name: Text::from(support.name.clone()),
        position: support.position.each_ref().map(at_defaults),
        linear: support.kinematics == SupportKinematics::Linear,
    });
    let drive = |drive: &Drive| DriveInfo {
        coordinate: drive.coordinate.0,
        start: drive.profile.start(&defaults),
        pieces: drive.profile.pieces().len(),
    };
    Description {
        name: Text::from(chain.name.clone()),
        title: Text::from(chain.title.clone()),
        spec_hash: Text::from(chain.spec_hash.clone()),
        parameters: List::from_iter(parameters),
        coordinates: List::from_iter(coordinates),
        bodies: List::from_iter(bodies),
        supports: List::from_iter(supports),
        drives: List::from_iter(chain.drives.iter().map(drive)),
        points: List::from_iter(chain.points.iter().map(|point| Text::from(point.name.clone()))),
        statics: chain.analyses.statics,
        guess: List::from_iter(chain.guess.iter().copied()),
        duration: chain.run.duration,
        step: chain.run.step,
        output: chain.run.output,
    }
}

fn bound(bound: &chain::Bound) -> Bound {
    let chain::Refusal { code, title, help } = &bound.refusal;
    Bound {
        value: bound.value,
        allowed: bound.allowed,
        refusal: Refusal { code: Text::Static(code), title: title.clone().into(), help: help.clone().into() },
    }
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
    } else if chain.elements.iter().any(|element| element.coordinate.0 == index) {
        CoordinateRole::Element
    } else {
        CoordinateRole::Passive
    }
}
