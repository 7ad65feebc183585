//! Whole changes of parameters, for what their derivatives do not show: feet that lift, other places that govern, curves.

use crane_model::dyn_crane::{DynCrane, Functions};

use super::{Group, Sensitivity, Settings, label, sensitivity};
use crate::LiveCrane;

/// A change differs from that of its derivative if it is so by this fraction of the larger one,
pub(super) const CURVED: f64 = 0.25;
/// and it matters if it is this fraction of the value.
const MATTERS: f64 = 0.02;
/// Outputs that a caution names.
const MOST: usize = 3;

/// What happens when each parameter changes by its whole step, one after the other, that its derivatives do not say.
#[must_use]
pub fn cautions(crane: &LiveCrane, found: &Sensitivity, steps: &[f64], settings: &Settings) -> Vec<String> {
    let mut words = Vec::new();
    for ((place, &parameter), step) in found.parameters.iter().enumerate().zip(steps) {
        let info = &crane.description().parameters[parameter];
        let value = crane.parameters()[parameter] + step;
        let with = format!("with {} at {}", label(info), format!("{} {}", short(value), info.unit).trim_end());
        let mut other = crane.clone();
        if other.set_parameter(parameter, value).is_err() {
            words.push(format!(
                "{with} it breaks a rule of the spec: its changes are those of a smaller step, in proportion"
            ));
            continue;
        }
        match sensitivity(&other, &[], settings) {
            Ok(after) => words.extend(
                differences(found, &after, &found.derivatives[place], *step).map(|what| format!("{with}, {what}")),
            ),
            Err(failed) => words.push(format!("{with}: {failed}")),
        }
    }
    words
}

/// What differs between a change and that of the derivatives, in words.
fn differences<'a>(
    before: &'a Sensitivity,
    after: &'a Sensitivity,
    derivatives: &'a [f64],
    step: f64,
) -> impl Iterator<Item = String> + 'a {
    let outputs = || before.outputs.iter().enumerate().zip(&after.outputs);
    let feet = outputs().filter(|((_, output), _)| output.group == Group::Supports && output.unit == "m");
    let feet = feet.filter_map(|((index, output), _)| {
        let [gap, then] = [before.values[index], after.values[index]];
        let name = output.name.trim_end_matches("_gap");
        match (gap > 0.0, then > 0.0) {
            (false, true) => Some(format!("{name} lifts")),
            (true, false) => Some(format!("{name} comes down")),
            _ => None,
        }
    });
    let governs =
        outputs().filter(|((_, output), then)| output.group != Group::Frequencies && output.place != then.place);
    let governs = governs.map(|((_, output), then)| format!("{} is that of {}", output.name, then.place));
    let curved = outputs().filter_map(move |((index, output), _)| {
        let (value, straight) = (before.values[index], derivatives[index] * step);
        let whole = after.values[index] - value;
        let is_curved = (whole - straight).abs() > CURVED * whole.abs().max(straight.abs());
        let matters = (whole - straight).abs() > MATTERS * value.abs() && output.group >= Group::Stresses;
        (is_curved && matters).then(|| {
            let [whole, straight] = [whole, straight].map(|change| in_unit(change, output.unit));
            format!("{} changes by {whole} instead of {straight}", output.name)
        })
    });
    feet.chain(governs).chain(curved.take(MOST))
}

/// A number with its unit, stresses in `MPa`.
pub(super) fn in_unit(number: f64, unit: &str) -> String {
    let (number, unit) = if unit == "Pa" { (1e-6 * number, "MPa") } else { (number, unit) };
    format!("{} {unit}", short(number)).trim_end().to_owned()
}

/// A number with four digits.
pub(super) fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) { rounded.to_string() } else { format!("{number:.3e}") }
}
