//! What moves what on a page: the numbers of `crane sensitivity` with live parameters and the sizes of beams.

use crane_codegen::{Checked, CraneSpec};
use crane_live::LiveCrane;
use crane_live::sensitivity::{Group, Settings, with_live_numbers};
use crane_model::{
    dyn_crane::{DynCrane, Functions},
    results::KeyFigure,
};
use crane_page::tables::Cell;
use serde_json::{Value, json};

use super::chart::{NOTHING, change_text};
use super::{Changes, Request, changes, tables::readable};

/// Change of each number, relative to its value.
const CHANGE: f64 = 0.1;
/// Sizes of beams that are changed besides live parameters,
const SIZES: usize = 8;
/// outputs,
const OUTPUTS: usize = 12;
/// and bars of an output.
const BARS: usize = 5;
/// Kinds of outputs, the most important first.
const GROUPS: [Group; 5] = [Group::Stresses, Group::Tipping, Group::Deflections, Group::Drives, Group::Frequencies];
/// Sizes of a beam, below it.
const OF_BEAM: [&str; 9] = [
    "length",
    "section.box.height",
    "section.box.thickness",
    "section.welded_box.height",
    "section.welded_box.flange",
    "section.tube.diameter",
    "section.tube.thickness",
    "section.circle.diameter",
    "material.E",
];

/// What moves the most important quantities of a crane at rest; null if it does not stand or nothing moves them.
pub fn moves_of_page(crane: &LiveCrane, checked: &Checked) -> Value {
    moves(crane, checked).unwrap_or_default()
}

fn moves(crane: &LiveCrane, checked: &Checked) -> Option<Value> {
    let description = crane.description();
    let own = description.parameters.iter().map(|info| info.name.to_string());
    let written: Vec<String> = own.chain(sizes(&checked.spec, crane)).collect();
    let mut names = written.clone();
    let changed = with_live_numbers(checked, &mut names).ok()?;
    let live = match &changed {
        Some(changed) => with_values_of(crane, LiveCrane::new(changed.chain.clone()))?,
        None => crane.clone(),
    };
    let request = Request { numbers: &names, outputs: &[], change: CHANGE, all: false, settings: Settings::default() };
    let found = changes(&request, changed.as_ref().unwrap_or(checked), &live, None).ok()?;
    // A utilisation is the stress in parts of the yield stress.
    let of = |index: usize| &found.found.outputs[index];
    let has_use = found.found.outputs.iter().any(|output| output.name == KeyFigure::UTILISATION.greatest());
    let is_new = |index: &usize| !(has_use && of(*index).name == KeyFigure::EQUIVALENT_STRESS.greatest());
    let mut shown: Vec<usize> = found.shown.iter().copied().filter(is_new).collect();
    shown.retain(|&index| GROUPS.contains(&of(index).group));
    shown.sort_by_key(|&index| GROUPS.iter().position(|group| *group == of(index).group));
    let outputs: Vec<Value> = shown.into_iter().filter_map(|index| output(&found, index)).take(OUTPUTS).collect();
    let command =
        format!("crane sensitivity {} --with {} --change {}%", description.name, written.join(","), 100.0 * CHANGE);
    (!outputs.is_empty()).then(|| json!({"change": CHANGE, "command": command, "outputs": outputs}))
}

/// A crane that has further parameters, with the values of those of another one and its inputs.
fn with_values_of(crane: &LiveCrane, mut live: LiveCrane) -> Option<LiveCrane> {
    let description = crane.description();
    let place = |name: &str| live.description().parameters.iter().position(|parameter| parameter.name == name);
    let places: Vec<usize> = description.parameters.iter().map(|info| place(&info.name)).collect::<Option<_>>()?;
    for (place, value) in places.into_iter().zip(crane.parameters()) {
        live.set_parameter(place, *value).ok()?;
    }
    let inputs: Vec<Option<f64>> = (0..description.inputs.len()).map(|index| crane.input(index)).collect();
    Some(live.with_inputs(&inputs))
}

/// Places of sizes of beams, of every beam in turn the most important first.
fn sizes(spec: &CraneSpec, crane: &LiveCrane) -> Vec<String> {
    let mut links: Vec<&str> = crane.description().bodies.iter().map(|body| body.link.as_str()).collect();
    links.dedup();
    let is_there = |place: &String| spec.number_at(place).is_ok();
    let places = OF_BEAM.iter().flat_map(|size| links.iter().map(move |link| format!("links.{link}.beam.{size}")));
    places.filter(is_there).take(SIZES).collect()
}

/// An output with its bars; `None` if nothing moves it.
fn output(changes: &Changes, index: usize) -> Option<Value> {
    let output = &changes.found.outputs[index];
    let (scale, unit) = readable(output.unit, output.group);
    let share = |&place: &usize| {
        let share = changes.relative(place, index).filter(|share| share.abs() >= NOTHING)?;
        Some((changes.numbers[place].label.as_str(), share))
    };
    let mut bars: Vec<(&str, f64)> = changes.order.iter().filter_map(share).collect();
    bars.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    bars.truncate(BARS);
    let value = Cell::from(scale * changes.found.values[index]).short();
    let bars: Vec<Value> = bars
        .into_iter()
        .map(|(number, share)| json!({"number": number, "relative": share, "text": change_text(share)}))
        .collect();
    let value = format!("{value} {unit}");
    (!bars.is_empty())
        .then(|| json!({"output": output.name, "value": value.trim_end(), "place": output.place, "bars": bars}))
}
