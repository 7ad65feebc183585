//! What an interpreted crane says about itself.

use crane_codegen::chain::{self, BodyId, Chain, CoordinateId, CoordinateKind as Kind, SupportKinematics, Value};

use crane_model::{
    BodyInfo, Bound, CoordinateInfo, CoordinateKind, CoordinateRole, Description, DriveInfo, ParameterInfo, Refusal,
    SupportInfo,
};

/// The description of a chain, as the compiler writes it. It stays for the rest of the process, as compiled ones do.
pub fn describe(chain: &Chain) -> &'static Description {
    let defaults = chain.parameter_defaults();
    let at_defaults = |value: &Value| value.at(&defaults);
    let parameters = chain.parameters.iter().map(|p| ParameterInfo {
        name: text(&p.name),
        unit: text(&p.unit),
        about: text(&p.about),
        default: p.default,
        least: p.least.as_ref().map_or(Bound::LEAST, bound),
        greatest: Bound::GREATEST,
    });
    let coordinates = chain.coordinates.iter().enumerate().map(|(index, coordinate)| CoordinateInfo {
        name: text(&coordinate.name),
        kind: match coordinate.kind {
            Kind::Translation => CoordinateKind::Translation,
            Kind::Rotation => CoordinateKind::Rotation,
        },
        role: role(chain, index),
    });
    let bodies = chain.bodies.iter().enumerate().map(|(index, body)| BodyInfo {
        name: text(&body.name),
        link: text(&body.link),
        mass: body.inertia.as_ref().map_or(0.0, |inertia| at_defaults(&inertia.mass)),
        length: at_defaults(&body.length),
        degrees_of_freedom: chain.degrees_of_freedom(BodyId(index)),
    });
    let supports = chain.supports.iter().map(|support| SupportInfo {
        name: text(&support.name),
        position: support.position.each_ref().map(at_defaults),
        linear: support.kinematics == SupportKinematics::Linear,
    });
    let description = Description {
        name: text(&chain.name),
        title: text(&chain.title),
        spec_hash: text(&chain.spec_hash),
        parameters: list(parameters),
        coordinates: list(coordinates),
        bodies: list(bodies),
        supports: list(supports),
        drives: list(chain.drives.iter().map(|drive| DriveInfo { coordinate: drive.coordinate.0 })),
        points: list(chain.points.iter().map(|point| text(&point.name))),
        statics: chain.analyses.statics,
        guess: list(chain.guess.iter().copied()),
        duration: chain.run.duration,
        step: chain.run.step,
        output: chain.run.output,
    };
    Box::leak(Box::new(description))
}

fn bound(bound: &chain::Bound) -> Bound {
    let chain::Refusal { code, title, help } = &bound.refusal;
    Bound {
        value: bound.value,
        allowed: bound.allowed,
        refusal: Refusal { code, title: text(title), help: text(help) },
    }
}

fn role(chain: &Chain, index: usize) -> CoordinateRole {
    if chain.base.iter().flatten().any(|id| id.0 == index) {
        CoordinateRole::Base
    } else if chain.is_prescribed(CoordinateId(index)) {
        CoordinateRole::Prescribed
    } else if chain.drives.iter().any(|drive| drive.coordinate.0 == index) {
        CoordinateRole::Driven
    } else if chain.elements.iter().any(|element| element.coordinate.0 == index) {
        CoordinateRole::Element
    } else {
        CoordinateRole::Passive
    }
}

fn text(text: &str) -> &'static str {
    text.to_owned().leak()
}

fn list<T>(items: impl Iterator<Item = T>) -> &'static [T] {
    items.collect::<Vec<T>>().leak()
}
