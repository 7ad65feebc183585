//! Positions, efforts and reactions at rest.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::Functions;
use crane_model::results::{column_name, connector_force, drive_effort, friction_utilisation, support_gap};
use crane_model::{ColumnKind, CylinderInfo, Description};

use super::rest::Rest;
use super::source::Source;
use super::{Group, Output, Valued};
use crate::dual::Dual8;
use crate::machine::Number;

/// An output without a place.
pub(super) fn named(name: impl Into<String>, unit: &'static str, group: Group) -> Output {
    Output { name: name.into(), unit, group, place: String::new() }
}

/// All of them, with the names of the columns of a run.
pub(super) fn outputs(source: &mut Source<'_>, rest: &Rest, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Valued> {
    let description = source.crane.description();
    let mut all = Vec::new();
    let places = source.at(FunctionId::Points, q);
    for (point, place) in description.points.iter().zip(places.chunks_exact(3)) {
        all.extend(vector(point, place, "m", Group::Points));
    }
    let efforts = efforts(source, rest, q, multipliers);
    for (drive, effort) in description.drives.iter().zip(&efforts) {
        let coordinate = &description.coordinates[drive.coordinate];
        let name = drive_effort(&coordinate.name, coordinate.kind);
        all.push((named(name, coordinate.kind.force_unit(), Group::Drives), *effort));
    }
    let states = source.at(FunctionId::CylinderStates, q);
    for (cylinder, state) in description.cylinders.iter().zip(states.chunks_exact(3)) {
        all.extend(of_cylinder(cylinder, state, efforts[cylinder.drive]));
    }
    let lengths = source.at(FunctionId::ConnectorLengths, q);
    let tensions = source.at(FunctionId::ConnectorTensions, q);
    let both = lengths.chunks_exact(2).zip(tensions.chunks_exact(3));
    for (connector, (length, tension)) in description.connectors.iter().zip(both) {
        let strain = column_name(ColumnKind::Strain(connector.strain()), &connector.name, connector.kind.turns());
        all.push((named(strain, connector.kind.unit(), Group::Connectors), length[0]));
        let force = named(connector_force(connector), connector.kind.force_unit(), Group::Connectors);
        all.push((force, tension[0]));
    }
    let joints = source.crane.loop_joints().iter();
    let equations = joints.flat_map(|joint| joint.equations.iter().map(move |equation| (joint, equation)));
    for ((joint, equation), multiplier) in equations.zip(multipliers) {
        all.push((named(equation.column(&joint.name), equation.force_unit(), Group::Loops), *multiplier));
    }
    all.extend(of_supports(source, description, q));
    all
}

/// The components of a vector.
fn vector<'a>(
    name: &'a str,
    components: &'a [Dual8],
    unit: &'static str,
    group: Group,
) -> impl Iterator<Item = Valued> + 'a {
    let axes = ["x", "y", "z"].into_iter().zip(components);
    axes.map(move |(axis, component)| (named(format!("{name}_{axis}"), unit, group), *component))
}

/// Torques and forces of the drives; rigid ones also balance the loops, `Jᵀ λ`.
pub(super) fn efforts(source: &mut Source<'_>, rest: &Rest, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Dual8> {
    let mut forces = source.at(FunctionId::DriveForcesAtRest, q);
    let resisted = source.generalized(q, multipliers);
    for &(coordinate, _) in &rest.prescribed {
        forces[coordinate] = forces[coordinate] + resisted[coordinate];
    }
    source.crane.description().drives.iter().map(|drive| forces[drive.coordinate]).collect()
}

/// Length, force and pressures of a cylinder; the side that does not carry the load is at back pressure.
fn of_cylinder(info: &CylinderInfo, state: &[Dual8], effort: Dual8) -> [Valued; 4] {
    let force = effort / state[2];
    let ([piston, ring], back) = (info.areas, info.back_pressure);
    let constant = Dual8::splat;
    let pressures = if force.value() + back * (ring - piston) > 0.0 {
        [(force + constant(back * ring)) * piston.recip(), constant(back)]
    } else {
        [constant(back), (constant(back * piston) - force) * ring.recip()]
    };
    let named = |what: &str, unit| named(format!("{}_{what}", info.name), unit, Group::Cylinders);
    [
        (named("length", "m"), state[0]),
        (named("force", "N"), force),
        (named("piston_pressure", "Pa"), pressures[0]),
        (named("rod_pressure", "Pa"), pressures[1]),
    ]
}

/// Reactions of the supports, and gaps under those that lift.
fn of_supports(source: &mut Source<'_>, description: &Description, q: &[Dual8]) -> Vec<Valued> {
    let mut all = Vec::new();
    let reactions = source.at(FunctionId::SupportReactions, q);
    for (support, reaction) in description.supports.iter().zip(reactions.chunks_exact(3)) {
        let name = format!("{}_reaction", support.name);
        all.extend(vector(&name, reaction, "N", Group::Supports));
    }
    let (gaps, grips) = (source.at(FunctionId::SupportGaps, q), source.at(FunctionId::SupportGrips, q));
    let both = gaps.chunks_exact(2).zip(grips.chunks_exact(3));
    for (support, (gap, grip)) in description.supports.iter().zip(both).filter(|(support, _)| support.one_sided) {
        all.push((named(support_gap(&support.name), "m", Group::Supports), gap[0]));
        // A foot in the air holds nothing.
        let used = if grip[0].value() > 0.0 { grip[2] / grip[1] } else { Dual8::splat(0.0) };
        all.push((named(friction_utilisation(&support.name), "", Group::Supports), used));
    }
    all
}
