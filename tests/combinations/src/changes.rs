//! Derivatives at rest by live numbers, against differences of equilibria.

use crane_live::LiveCrane;
use crane_live::sensitivity::{Group, Output, Sensitivity, Settings, sensitivity};
use crane_model::dyn_crane::{DynCrane, Functions};
use fastrand::Rng;

use crate::descriptions::numbers_as_parameters;
use crate::observe::live;
use crate::tree::Tree;

/// The name of the check.
pub const NAME: &str = "changes with live numbers";
/// Numbers that are changed, chosen at random.
const CHANGED: usize = 4;
/// Steps relative to the number: with the longer ones differences have an error of their square, with the shorter one that of rounding. A foot
/// or a rope may let go within the longer ones.
const STEPS: [f64; 3] = [1e-3, 1e-4, 1e-5];
/// Largest error, relative to the derivative and to a tenth of what changes an output as much as the number: that of the steps.
const TOLERANCE: f64 = 1e-4;
/// The same relative to the largest change of its kind: rounding of the pose multiplied by what is stiffest.
const OF_LARGEST: f64 = 1e-6;

const SETTINGS: Settings = Settings { frequencies: 4 };

/// What does not change as its derivative says; `None` for a crane that does not stand.
pub fn check_changes(tree: &Tree, seed: u64) -> Option<Vec<String>> {
    let mut rng = Rng::with_seed(seed);
    let crane = live(&numbers_as_parameters(tree, &mut rng)?.source).ok()?;
    let mut all: Vec<usize> = (0..crane.parameters().len()).collect();
    rng.shuffle(&mut all);
    all.truncate(CHANGED);
    let sensitivity = sensitivity(&crane, &all, &SETTINGS).ok()?;
    let mut wrong = Vec::new();
    for (index, &parameter) in sensitivity.parameters.iter().enumerate() {
        let mut fewest: Option<Vec<String>> = None;
        for step in STEPS {
            let value = crane.parameters()[parameter];
            let step = step * if value == 0.0 { 1.0 } else { value.abs() };
            let Some(both) = around(&crane, parameter, step) else { continue };
            let off = differences(&crane, &sensitivity, index, &both, step);
            if fewest.as_ref().is_none_or(|known| off.len() < known.len()) {
                fewest = Some(off);
            }
        }
        wrong.extend(fewest.into_iter().flatten());
    }
    Some(wrong)
}

/// Outputs with a smaller and with a larger number.
fn around(crane: &LiveCrane, parameter: usize, step: f64) -> Option<[Sensitivity; 2]> {
    let at = |step: f64| {
        let mut other = crane.clone();
        other.set_parameter(parameter, crane.parameters()[parameter] + step).ok()?;
        sensitivity(&other, &[], &SETTINGS).ok()
    };
    Some([at(-step)?, at(step)?])
}

/// Outputs whose derivative is not their difference.
fn differences(
    crane: &LiveCrane,
    sensitivity: &Sensitivity,
    place: usize,
    [before, after]: &[Sensitivity; 2],
    step: f64,
) -> Vec<String> {
    let value = crane.parameters()[sensitivity.parameters[place]];
    let per = if value == 0.0 { 1.0 } else { value.abs() };
    // Frequencies that coincide part, and what governs may change.
    let coincide = sensitivity.notes.iter().any(|note| note.contains("coincide"));
    let counts = |index: usize| {
        let output = &sensitivity.outputs[index];
        let [one, other] = [before, after]
            .map(|sensitivity| sensitivity.index_of(&output.name).map(|index| &sensitivity.outputs[index].place));
        let is_same = one.is_some() && one == other && one == Some(&output.place);
        if output.group == Group::Frequencies { !coincide } else { is_same }
    };
    let slope = |index: usize| {
        let name = &sensitivity.outputs[index].name;
        let [one, other] = [before, after]
            .map(|sensitivity| sensitivity.index_of(name).map_or(f64::NAN, |index| sensitivity.values[index]));
        (other - one) / (2.0 * step)
    };
    // Where nothing twists a telescope, rotations and torques of its pads are rounding beside their ways and forces.
    let kind = |group: Group, unit: &'static str| match (group, unit) {
        (Group::Connectors, "rad") => "m",
        (Group::Connectors | Group::Loops, "N m") => "N",
        _ => unit,
    };
    // Of a pad, some directions may be exact, and others springs.
    let joined = |group: Group| if group == Group::Loops { Group::Connectors } else { group };
    let largest = |group: Group, unit: &'static str| {
        let is_alike =
            |output: &Output| joined(output.group) == joined(group) && kind(group, output.unit) == kind(group, unit);
        let alike = sensitivity.outputs.iter().enumerate().filter(|(_, output)| is_alike(output));
        alike.fold(0.0, |size: f64, (index, _)| {
            size.max(sensitivity.derivatives[place][index].abs()).max(sensitivity.values[index].abs() / per)
        })
    };
    let wrong = |index: usize| {
        let (own, expected, output) =
            (sensitivity.derivatives[place][index], slope(index), &sensitivity.outputs[index]);
        let size = expected.abs() + 0.1 * sensitivity.values[index].abs() / per;
        let off = (own - expected).abs();
        let allowed = TOLERANCE * size + OF_LARGEST * largest(output.group, output.unit);
        let name = &crane.description().parameters[sensitivity.parameters[place]].name;
        (off > allowed || off.is_nan()).then(|| {
            format!("{} by {name}: {own:.9e} against {expected:.9e}, of {:.6e}", output.name, sensitivity.values[index])
        })
    };
    (0..sensitivity.outputs.len()).filter(|&index| counts(index)).filter_map(wrong).collect()
}
