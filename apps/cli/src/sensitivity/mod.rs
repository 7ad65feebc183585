//! `crane sensitivity`: what moves the quantities of a crane at rest or of its run, and by how much.

mod chart;
mod page;
mod run;
mod tables;

pub use page::moves_of_page;

use std::{io::Write, path::Path};

use crane_codegen::{Checked, check};
use crane_live::LiveCrane;
use crane_live::sensitivity::{
    self, Differences, FixedNumber, Group, LargestLoad, NoLargestLoad, Output, Refused, cautions, label,
    sensitivity as derivatives, with_live_numbers,
};
use crane_model::{
    Description,
    dyn_crane::Functions,
    envelope::{Axes, Envelope},
};
use crane_page::tables::{Cell, Report};

use serde_json::json;

use crate::{
    arguments::{Format, Sensitivity},
    envelope, files,
    problem::{Outcome, Problem, nearest},
    screen::Console,
    selection::{Registry, find_parameter, set_parameters, take_numbers},
    variants,
};

/// Makes the numbers of the spec that are asked for by their places live parameters; the options then have their names.
///
/// # Errors
/// There is no number at a place, or it determines the structure of the crane.
pub fn make_live(options: &mut Sensitivity, registry: &mut Registry) -> Outcome<()> {
    let name = options.analysis.crane.name.clone();
    let Ok(checked) = registry.checked(&name) else { return Ok(()) };
    // A place that is given twice counts once.
    let mut numbers: Vec<String> = Vec::new();
    for number in options.numbers.drain(..) {
        if !numbers.contains(&number) {
            numbers.push(number);
        }
    }
    options.numbers = numbers;
    if let Some(changed) = with_live_numbers(checked, &mut options.numbers)? {
        registry.add_variant(&name, changed)?;
    }
    Ok(())
}

impl From<Refused> for Problem {
    fn from(refused: Refused) -> Self {
        let [title, help] = refused.words();
        Problem::usage(title, help)
    }
}

/// A number that changes.
struct Number {
    /// Its name, or its place in the spec.
    label: String,
    value: f64,
    unit: String,
    step: f64,
    /// Errors of the derivatives of the outputs, where these are differences.
    errors: Option<Vec<f64>>,
    /// Whether it cannot be a live parameter.
    is_fixed: bool,
}

impl Number {
    /// A live parameter, by its index.
    fn live(crane: &LiveCrane, index: usize) -> Self {
        let info = &crane.description().parameters[index];
        let (label, unit) = (label(info).to_owned(), info.unit.to_string());
        Self { label, value: crane.parameters()[index], unit, step: 0.0, errors: None, is_fixed: false }
    }
}

/// Changes of the outputs of a crane with its numbers.
struct Changes {
    /// Name of the crane.
    crane: String,
    found: sensitivity::Sensitivity,
    /// The numbers, one per list of derivatives.
    numbers: Vec<Number>,
    /// Those of them that cannot be live parameters, which are the last.
    fixed: Vec<FixedNumber>,
    /// Numbers, the most influential first, by their indices in these lists.
    order: Vec<usize>,
    /// Outputs that are asked for, by their indices.
    shown: Vec<usize>,
}

impl Changes {
    /// Change of an output for the step of a number.
    fn change(&self, index: usize, output: usize) -> f64 {
        self.found.derivatives[index][output] * self.numbers[index].step
    }

    /// Whether the outputs are those of a run.
    fn is_of_run(&self) -> bool {
        self.found.outputs.iter().all(|output| output.group == Group::Run)
    }

    /// The same relative to the value of the output; `None` where zero has no meaning, or for a value of rounding.
    fn relative(&self, index: usize, output: usize) -> Option<f64> {
        /// A value below this fraction of the largest of its kind is zero up to rounding, or close to it.
        const SMALL: f64 = 1e-6;
        /// A rate below this, m/s or rad/s, is that of a crane that stays at rest, up to rounding.
        const AT_REST: f64 = 1e-9;
        let Output { group, unit, .. } = &self.found.outputs[output];
        let is_still = || self.found.values[output].abs() < AT_REST;
        match (*group, *unit) {
            (Group::Run, "m" | "rad") => return None,
            (Group::Run, "m/s" | "rad/s") if is_still() => return None,
            _ => {}
        }
        if *group == Group::Points || (*group == Group::Supports && *unit == "m") {
            return None;
        }
        // Forces and moments of all kinds are alike: torques of pads may all be zero up to rounding.
        let is_force = |unit: &str| unit == "N" || unit == "N m";
        let is_alike =
            |other: &Output| (other.group == *group && other.unit == *unit) || (is_force(other.unit) && is_force(unit));
        let all = self.found.outputs.iter().zip(&self.found.values);
        let alike = all.filter(|(other, _)| is_alike(other));
        let greatest = alike.fold(0.0, |size: f64, (_, value)| size.max(value.abs()));
        let value = self.found.values[output];
        (value.abs() > SMALL * greatest).then(|| self.change(index, output) / value.abs())
    }

    /// The largest error of a change, relative to the output, of a number whose derivatives are differences.
    fn uncertainty(&self, index: usize) -> Option<f64> {
        let errors = self.numbers[index].errors.as_ref()?;
        let error = |&output: &usize| {
            self.relative(index, output)?;
            Some(errors.get(output)? * self.numbers[index].step.abs() / self.found.values[output].abs())
        };
        Some(self.shown.iter().filter_map(error).fold(0.0, f64::max))
    }

    /// The largest relative change of an output that is shown and not small among its kind.
    fn influence(&self, index: usize) -> f64 {
        let shares = self.shown.iter().filter_map(|&output| self.relative(index, output));
        shares.fold(0.0, |size: f64, share| size.max(share.abs()))
    }
}

/// What is asked for.
struct Request<'a> {
    /// Numbers and outputs, as in the options.
    numbers: &'a [String],
    outputs: &'a [String],
    /// Change of each number, relative to its value.
    change: f64,
    /// Whether all outputs are shown unless some are named.
    all: bool,
    settings: sensitivity::Settings,
}

/// The largest load and what was asked for.
type Loaded = (LargestLoad, Envelope);

/// Prints what moves the quantities of a crane at rest.
pub fn sensitivity(options: &Sensitivity, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let crane = registry.live(crane.as_ref())?;
    let description = crane.description();
    let request = Request {
        numbers: &options.numbers,
        outputs: &options.outputs,
        change: options.change,
        all: options.analysis.all || options.analysis.format == Format::Json,
        settings: sensitivity::Settings { frequencies: options.modes },
    };
    if options.run {
        return run::sensitivity(&registry.console, options, &request, &crane, out);
    }
    let loaded = if options.largest_load { Some(loaded(options, &crane)?) } else { None };
    let changes = changes(&request, registry.checked(&description.name)?, &crane, loaded.as_ref())?;
    let steps: Vec<f64> = changes.numbers.iter().map(|number| number.step).collect();
    let cautions = match &loaded {
        Some((largest, envelope)) => largest.cautions(&changes.found, &crane, envelope, &changes.fixed, &steps),
        None => cautions(&crane, &changes.found, &steps, &request.settings),
    };
    let mut report = begin(options, description);
    report.value("stable", true);
    if let Some(loaded) = &loaded {
        facts_of_load(&mut report, loaded, &crane, options)?;
    }
    remarks(&mut report, &changes);
    for caution in cautions {
        report.caution(Some(caution));
    }
    print(&registry.console, options, report, &changes, out)
}

/// A report with what was asked for.
fn begin(options: &Sensitivity, description: &Description) -> Report {
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.line("change of each number", format!("{:+}", 100.0 * options.change), "%");
    report.value("change", options.change);
    report
}

/// Prints the changes, and writes them into a file if one is named.
fn print(
    console: &Console,
    options: &Sensitivity,
    mut report: Report,
    changes: &Changes,
    out: &mut dyn Write,
) -> Outcome<()> {
    report.grid(tables::parameters(changes));
    report.excerpt(tables::outputs(changes), 0);
    report.shown(tables::matrix(changes, options.analysis.all));
    report.shown(tables::bars(changes, options.analysis.all));
    report.data(tables::changes(changes));
    report.show_all(options.analysis.all);
    if let Some(file) = &options.file {
        write(console, file, changes, options.change)?;
    }
    options.analysis.format.print(&report, console, out)
}

/// Writes the changes as a table or as a chart.
fn write(console: &Console, file: &Path, changes: &Changes, change: f64) -> Outcome<()> {
    if files::ending(file, &["csv", "svg"])? == "svg" {
        return console.write_text(file, &chart::chart(changes, change)?);
    }
    let (header, rows) = tables::rows(changes);
    console.write_fields(file, header.into_iter(), rows.into_iter())
}

/// The largest load of the pose.
fn loaded(options: &Sensitivity, crane: &LiveCrane) -> Outcome<Loaded> {
    let mut limits = options.limits.clone();
    if limits.load.is_none() {
        // Masses that became parameters to be changed are not the load.
        let own = crane.description().parameters.iter().filter(|info| label(info) == info.name.as_str());
        let mut masses = own.filter(|info| info.unit == "kg").map(|info| info.name.to_string());
        limits.load = masses.next().filter(|_| masses.next().is_none());
    }
    let asked = envelope::within(&limits, Axes::default(), crane)?;
    let largest = LargestLoad::new(crane, &asked).map_err(|none| no_load(&none, crane, &asked))?;
    Ok((largest, asked))
}

fn no_load(none: &NoLargestLoad, crane: &LiveCrane, envelope: &Envelope) -> Problem {
    let unit = crane.description().parameters[envelope.load].unit.as_str();
    let title = format!("{} has no largest load in this pose: {}", crane.description().name, none.words(crane, unit));
    Problem::failed(title, "choose another pose with `--hold`, or other limits")
}

/// The load, its limit and its place.
fn facts_of_load(
    report: &mut Report,
    (largest, asked): &Loaded,
    crane: &LiveCrane,
    options: &Sensitivity,
) -> Outcome<()> {
    let description = crane.description();
    let info = &description.parameters[asked.load];
    let reach = envelope::reach(options.point.as_deref(), Some(asked.load), crane)?;
    let [radius, height] = reach.radius_and_height(&largest.condition.q, crane.parameters());
    report.line(format!("largest {}", info.name), largest.load, info.unit.as_str());
    report.line("limited by", largest.words(crane), "");
    report.line("at a radius of", format!("{radius:.2}"), "m");
    report.line("and a height of", format!("{height:.2}"), "m");
    envelope::reach_line(report, &reach);
    let of = largest.limit.location(crane);
    report.value(
        "largest_load",
        json!({
            "parameter": info.name.as_str(), "load": largest.load, "unit": info.unit.as_str(), "limit": largest.limit.kind(),
            "of": (!of.is_empty()).then_some(of), "radius": radius, "height": height, "point": reach.point(), "radius_from": reach.axis(), "load_factor": asked.factor,
        }),
    );
    Ok(())
}

/// The changes that are asked for.
fn changes(request: &Request<'_>, checked: &Checked, crane: &LiveCrane, loaded: Option<&Loaded>) -> Outcome<Changes> {
    let settings = &request.settings;
    let own = crane;
    let description = crane.description();
    let (parameters, places) = numbers(request.numbers, description, loaded.map(|(_, envelope)| envelope.load))?;
    let mut crane = crane.clone();
    let mut found = match loaded {
        Some((largest, envelope)) => {
            set_parameters(&mut crane, &[(envelope.load, envelope.factor * largest.load)])?;
            let all: Vec<usize> = parameters.iter().copied().chain([envelope.load]).collect();
            sensitivity::sensitivity_near(&crane, &all, settings, &largest.condition.q)?
        }
        None => derivatives(&crane, &parameters, settings)?,
    };
    let mut numbers: Vec<Number> = parameters.iter().map(|&index| Number::live(&crane, index)).collect();
    let fixed: Vec<FixedNumber> =
        places.iter().map(|place| FixedNumber::new(checked, place)).collect::<Result<_, _>>()?;
    for number in &fixed {
        let Differences { derivatives, errors, .. } = number.differentiate(&crane, &found, settings)?;
        found.derivatives.push(derivatives);
        numbers.push(Number {
            label: number.place.clone(),
            value: number.value,
            unit: number.unit.clone(),
            step: 0.0,
            errors: Some(errors),
            is_fixed: true,
        });
    }
    if let Some((largest, envelope)) = loaded
        && largest.add_to(&mut found, &crane, envelope, parameters.len(), &fixed).is_none()
    {
        let errors =
            largest.add_differences(&mut found, own, envelope, &fixed).map_err(|none| no_load(&none, own, envelope))?;
        for (number, error) in numbers.iter_mut().zip(errors) {
            number.errors = Some(vec![0.0; found.outputs.len() - 1].into_iter().chain([error]).collect());
        }
    }
    if let Some(rigid) = rigid(&crane, &parameters, &places, checked) {
        found.add_deflections(&rigid);
    }
    let shown = shown(request.outputs, &found.outputs, request.all)?;
    Ok(Changes { fixed, ..ordered(request, description, found, numbers, shown) })
}

/// The changes with their steps, the most influential number first.
fn ordered(
    request: &Request<'_>,
    description: &Description,
    found: sensitivity::Sensitivity,
    mut numbers: Vec<Number>,
    shown: Vec<usize>,
) -> Changes {
    for number in &mut numbers {
        number.step = if number.value == 0.0 { 1.0 } else { request.change * number.value };
    }
    let name = description.name.to_string();
    let mut changes =
        Changes { crane: name, found, order: (0..numbers.len()).collect(), numbers, fixed: Vec::new(), shown };
    let influence: Vec<f64> = changes.order.iter().map(|&index| changes.influence(index)).collect();
    changes.order.sort_by(|&a, &b| influence[b].total_cmp(&influence[a]));
    changes
}

/// Errors below this percentage are not told apart.
const LEAST_PERCENT: f64 = 0.001;

/// What to know about the numbers.
fn remarks(report: &mut Report, changes: &Changes) {
    for note in &changes.found.notes {
        report.caution(Some(note.as_str()));
    }
    for number in changes.numbers.iter().filter(|number| number.value == 0.0) {
        report.caution(Some(format!("{} is 0: its changes are those per {}", number.label, per(number))));
    }
    for (index, number) in changes.numbers.iter().enumerate() {
        let why = if number.is_fixed {
            "cannot be a live parameter: its changes are differences of whole cranes"
        } else {
            "moves a load whose limit is not at the bound of an output: its changes are differences"
        };
        let words = |error: f64| {
            let percent = 100.0 * error;
            let errors = if percent < LEAST_PERCENT {
                format!("below {LEAST_PERCENT} %")
            } else {
                format!("up to {} %", Cell::from(percent).short())
            };
            format!("{} {why}, with errors {errors} of the outputs", number.label)
        };
        report.caution(changes.uncertainty(index).map(words));
    }
}

/// The same of the crane with rigid beams, if there is one with the same parameters and the same numbers at places.
fn rigid(
    crane: &LiveCrane,
    parameters: &[usize],
    places: &[String],
    checked: &Checked,
) -> Option<sensitivity::Sensitivity> {
    let change = variants::rigid(&crane.description().name, &checked.spec.crane).ok()??;
    let checked = checked.spec.changed(&change).and_then(check).ok()?;
    let mut rigid = LiveCrane::new(checked.chain.clone());
    take_numbers(crane, &mut rigid).ok()?;
    if rigid.parameters().len() != crane.parameters().len() {
        return None;
    }
    let settings = sensitivity::Settings { frequencies: 0 };
    let mut found = derivatives(&rigid, parameters, &settings).ok()?;
    for place in places {
        let differences = FixedNumber::new(&checked, place).ok()?.differentiate(&rigid, &found, &settings).ok()?;
        found.derivatives.push(differences.derivatives);
    }
    Some(found)
}

/// The unit of a number, in words for one without.
fn per(number: &Number) -> String {
    if number.unit.is_empty() { "1".to_owned() } else { format!("1 {}", number.unit) }
}

/// The parameters that are asked for, and the places of numbers that cannot be parameters; each once, and without the load that is searched.
fn numbers(asked: &[String], description: &Description, load: Option<usize>) -> Outcome<(Vec<usize>, Vec<String>)> {
    if asked.is_empty() && description.parameters.is_empty() {
        return Err(Problem::usage(
            format!("{} has no live parameters", description.name),
            "name numbers by their places, as in `--with links.boom.beam.section.box.height`, or define parameters in the spec, as in \
             `parameters: {payload: {value: 500, unit: kg}}`, and write their names in place of numbers",
        ));
    }
    if asked.is_empty() && description.parameters.len() == load.iter().len() {
        return Err(Problem::usage(
            format!("{} has no live parameters besides the load", description.name),
            "name numbers by their places, as in `--with links.boom.beam.section.box.height`",
        ));
    }
    if asked.is_empty() {
        return Ok(((0..description.parameters.len()).filter(|&index| load != Some(index)).collect(), Vec::new()));
    }
    let (mut parameters, mut places) = (Vec::new(), Vec::new());
    for name in asked {
        if name.contains('.') {
            if !places.contains(name) {
                places.push(name.clone());
            }
            continue;
        }
        let found = find_parameter(name, description).map_err(|(title, help)| {
            let place = "numbers of the spec are named by their places, as in `links.boom.beam.length`";
            Problem::usage(title, format!("{help}; {place}"))
        })?;
        if load == Some(found) {
            let title = format!("`{name}` is the load, which is found");
            return Err(Problem::usage(title, "leave it out of `--with`, or name another load with `--load`"));
        }
        if !parameters.contains(&found) {
            parameters.push(found);
        }
    }
    Ok((parameters, places))
}

/// The outputs that are asked for, by names or groups; the most important ones if none are.
fn shown(asked: &[String], outputs: &[Output], all: bool) -> Outcome<Vec<usize>> {
    if asked.is_empty() {
        let is_main = |output: &Output| match output.group {
            Group::Points | Group::Deflections | Group::Drives | Group::Tipping | Group::Frequencies | Group::Load => {
                true
            }
            Group::Cylinders | Group::Connectors => output.unit == "N" || output.unit == "N m",
            Group::Supports => output.name.ends_with("_reaction_z"),
            Group::Stresses => output.name.starts_with("greatest"),
            Group::Loops | Group::Run => false,
        };
        // With a largest load, this is what was asked for.
        let has_load = outputs.iter().any(|output| output.group == Group::Load);
        let is_main = |output: &Output| if has_load { output.group == Group::Load } else { is_main(output) };
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
