//! `crane sensitivity`: what moves the quantities of a crane at rest, and by how much.

mod chart;
mod tables;

use std::io::Write;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_live::sensitivity::{
    self, Group, Output, Refused, cautions, label, sensitivity as derivatives, with_live_numbers,
};
use crane_model::{
    Description, ParameterInfo,
    dyn_crane::{DynCrane, DynModel},
};
use crane_page::tables::Report;

use crate::{
    arguments::{Format, Sensitivity},
    files,
    problem::{Outcome, Problem, nearest},
    selection::{Registry, find_parameter},
    variants,
};

/// Makes the numbers of the spec that are asked for by their places live parameters; the options then have their names.
///
/// # Errors
/// There is no number at a place, or it determines the structure of the crane.
pub fn make_live(options: &mut Sensitivity, registry: &mut Registry) -> Outcome<()> {
    let name = options.analysis.crane.name.clone();
    let Some(text) = registry.spec(&name) else { return Ok(()) };
    let source = SourceFile::new(format!("{name}.yaml"), text);
    let changed = with_live_numbers(&source, &mut options.numbers).map_err(|refused| match refused {
        Refused::Place(wrong) => Problem::usage(wrong.title, wrong.help),
        Refused::Mistakes { place, mistakes } => {
            let title = format!("`{place}` cannot change: {}", mistakes.headline());
            Problem::usage(title, "only numbers that could be live parameters can: docs/SPEC.md marks those as fixed that cannot, and some formulas need constants")
        }
    })?;
    if let Some(changed) = changed {
        registry.add(&name, changed.text);
    }
    Ok(())
}

/// Changes of the outputs of a crane with its numbers.
struct Changes<'a> {
    description: &'a Description,
    found: sensitivity::Sensitivity,
    /// Values of the parameters, one per list of derivatives, and their steps.
    values: Vec<f64>,
    steps: Vec<f64>,
    /// Parameters, the most influential first, by their indices in these lists.
    order: Vec<usize>,
    /// Outputs that are asked for, by their indices.
    shown: Vec<usize>,
}

impl Changes<'_> {
    fn info(&self, place: usize) -> &ParameterInfo {
        &self.description.parameters[self.found.parameters[place]]
    }

    /// Change of an output for the step of a parameter.
    fn change(&self, place: usize, output: usize) -> f64 {
        self.found.derivatives[place][output] * self.steps[place]
    }

    /// The same relative to the value of the output; `None` where zero has no meaning, or for a value of rounding.
    fn relative(&self, place: usize, output: usize) -> Option<f64> {
        /// A value below this fraction of the largest of its kind is zero up to rounding, or close to it.
        const SMALL: f64 = 1e-6;
        let Output { group, unit, .. } = &self.found.outputs[output];
        if *group == Group::Points || (*group == Group::Supports && *unit == "m") {
            return None;
        }
        let alike = self
            .found
            .outputs
            .iter()
            .zip(&self.found.values)
            .filter(|(other, _)| other.group == *group && other.unit == *unit);
        let greatest = alike.fold(0.0, |size: f64, (_, value)| size.max(value.abs()));
        let value = self.found.values[output];
        (value.abs() > SMALL * greatest).then(|| self.change(place, output) / value.abs())
    }

    /// The largest relative change of an output that is shown and not small among its kind.
    fn influence(&self, place: usize) -> f64 {
        let shares = self.shown.iter().filter_map(|&output| self.relative(place, output));
        shares.fold(0.0, |size: f64, share| size.max(share.abs()))
    }
}

/// Prints what moves the quantities of a crane at rest.
pub fn sensitivity(options: &Sensitivity, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let crane = registry.live(crane.as_ref())?;
    let description = crane.description();
    let parameters = parameters(options, description)?;
    let settings = sensitivity::Settings { frequencies: options.modes };
    let mut found = derivatives(&crane, &parameters, &settings)?;
    if let Some(rigid) = rigid(&crane, &parameters, registry) {
        found.add_deflections(&rigid);
    }
    let all = options.analysis.all || options.analysis.format == Format::Json;
    let shown = shown(&options.outputs, &found.outputs, all)?;
    let values: Vec<f64> = parameters.iter().map(|&index| crane.parameters()[index]).collect();
    let steps = values.iter().map(|value| if *value == 0.0 { 1.0 } else { options.change * value }).collect();
    let mut changes = Changes { description, found, values, steps, order: (0..parameters.len()).collect(), shown };
    let influence: Vec<f64> = changes.order.iter().map(|&place| changes.influence(place)).collect();
    changes.order.sort_by(|&a, &b| influence[b].total_cmp(&influence[a]));
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.line("change of each number", format!("{:+}", 100.0 * options.change), "%");
    report.value("change", options.change);
    report.value("stable", true);
    for note in &changes.found.notes {
        report.caution(Some(note.as_str()));
    }
    for (place, value) in changes.values.iter().enumerate().filter(|(_, value)| **value == 0.0) {
        let info = changes.info(place);
        report.caution(Some(format!("{} is {value}: its changes are those per {}", label(info), per(info))));
    }
    for caution in cautions(&crane, &changes.found, &changes.steps, &settings) {
        report.caution(Some(caution));
    }
    report.grid(tables::parameters(&changes));
    report.excerpt(tables::outputs(&changes), 0);
    report.shown(tables::matrix(&changes));
    report.shown(tables::bars(&changes, options.analysis.all));
    report.data(tables::changes(&changes));
    report.show_all(options.analysis.all);
    if let Some(file) = &options.file {
        match file.extension().and_then(|extension| extension.to_str()) {
            Some("svg") => files::write_text(file, &chart::chart(&changes, options.change)?)?,
            Some("csv") => {
                let (header, rows) = tables::rows(&changes);
                files::write_fields(file, header.into_iter(), rows.into_iter())?;
            }
            _ => {
                let title = format!("cannot write {}", file.display());
                return Err(Problem::usage(title, "name a file that ends in `.csv` or `.svg`"));
            }
        }
    }
    options.analysis.format.print(&report, out)
}

/// The same of the crane with rigid beams, if there is one with the same parameters.
fn rigid(crane: &LiveCrane, parameters: &[usize], registry: &Registry) -> Option<sensitivity::Sensitivity> {
    let name = &crane.description().name;
    let (twin, text) = variants::rigid(name, registry.spec(name)?).ok()??;
    let mut rigid = LiveCrane::from_spec(&SourceFile::new(twin, text)).ok()?;
    rigid.set_parameters(crane.parameters()).ok()?;
    let inputs: Vec<Option<f64>> = (0..crane.description().inputs.len()).map(|index| crane.input(index)).collect();
    let is_same = rigid.parameters().len() == crane.parameters().len();
    is_same
        .then(|| derivatives(&rigid.with_inputs(&inputs), parameters, &sensitivity::Settings { frequencies: 0 }).ok())?
}

/// `unit of the parameter`, in words for one without a unit.
fn per(info: &ParameterInfo) -> String {
    if info.unit.is_empty() { "1".to_owned() } else { format!("1 {}", info.unit) }
}

/// The parameters that are asked for.
fn parameters(options: &Sensitivity, description: &Description) -> Outcome<Vec<usize>> {
    if description.parameters.is_empty() {
        return Err(Problem::usage(
            format!("{} has no live parameters", description.name),
            "name numbers by their places, as in `--with links.boom.beam.section.box.height`, or define parameters in the spec, as in \
             `parameters: {payload: {value: 500, unit: kg}}`, and write their names in place of numbers",
        ));
    }
    if options.numbers.is_empty() {
        return Ok((0..description.parameters.len()).collect());
    }
    let named = |name: &String| find_parameter(name, description).map_err(|(title, help)| Problem::usage(title, help));
    options.numbers.iter().map(named).collect()
}

/// The outputs that are asked for, by names or groups; the most important ones if none are.
fn shown(asked: &[String], outputs: &[Output], all: bool) -> Outcome<Vec<usize>> {
    if asked.is_empty() {
        let is_main = |output: &Output| match output.group {
            Group::Points | Group::Deflections | Group::Drives | Group::Tipping | Group::Frequencies => true,
            Group::Cylinders | Group::Connectors => output.unit == "N" || output.unit == "N m",
            Group::Supports => output.name.ends_with("_reaction_z"),
            Group::Stresses => output.name.starts_with("greatest"),
            Group::Loops => false,
        };
        return Ok((0..outputs.len()).filter(|&index| all || is_main(&outputs[index])).collect());
    }
    let mut found = Vec::new();
    for name in asked {
        let own = |output: &Output| output.name == *name || output.group.name() == name;
        let matching: Vec<usize> = (0..outputs.len()).filter(|&index| own(&outputs[index])).collect();
        if matching.is_empty() && Group::ALL.iter().any(|group| group.name() == name) {
            let title = format!("the crane has no outputs of the group `{name}`");
            let groups: Vec<&str> = Group::ALL
                .iter()
                .map(|group| group.name())
                .filter(|name| outputs.iter().any(|output| output.group.name() == *name))
                .collect();
            return Err(Problem::usage(title, format!("it has {}", groups.join(", "))));
        }
        if matching.is_empty() {
            let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
            let groups = Group::ALL.map(Group::name);
            let guess = nearest(name, names.iter().copied().chain(groups));
            let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
            let help = format!("{guess}groups: {}; outputs: {}", groups.join(", "), names.join(", "));
            return Err(Problem::usage(format!("there is no output `{name}`"), help));
        }
        found.extend(matching.into_iter().filter(|index| !found.contains(index)).collect::<Vec<_>>());
    }
    Ok(found)
}
