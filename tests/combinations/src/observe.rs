//! What a crane does, as named numbers that do not depend on how its spec describes it.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::Settings;
use crane_model::envelope::{Axes, Envelope, Execution, Limits, PartLimit, Rating, only_mass};
use crane_model::fatigue::{self, Detail, Manoeuvre};
use crane_model::results::{DriveDuty, Duties, Instant, Table, cautions, instants};
use crane_model::runs::{Start, record};
use crane_model::sections::stressed_sections;
use crane_model::tipping::lines;
use crane_model::{Cut, Wrench, modes, statics};

/// A number with its unit, and how far it may be off, relative to the largest number of this unit in the same group.
#[derive(Clone, Debug)]
pub struct Number {
    /// Its group: at rest, at the end of a run, …
    pub group: &'static str,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
}

/// Named numbers.
pub type Numbers = BTreeMap<String, Number>;

/// At rest: rounding, and Newton's tolerance times the condition of the tangent stiffness.
const REST: (&str, f64) = ("rest", 1e-7);
/// At the end of a run: ten thousand times its tolerance, since its steps differ.
const RUN: (&str, f64) = ("run", 2e-5);
/// Frequencies: those of the lowest modes are differences of large numbers.
const MODES: (&str, f64) = ("modes", 1e-6);
/// Cautions about the pose, each a number 1.
pub const CAUTIONS: &str = "cautions";
/// Forces that joints transmit.
const CUTS: (&str, f64) = ("cuts", 1e-7);

/// How far the numbers of a group may differ.
#[must_use]
pub fn tolerance(group: &str) -> f64 {
    [REST, RUN, MODES, CUTS].into_iter().find(|(name, _)| *name == group).map_or(0.0, |(_, tolerance)| tolerance)
}

/// Tolerance of runs, m and rad.
const STEP: f64 = 1e-8;
/// Steps of a run of half a second: with more it is not worth the time.
const MOST_STEPS: usize = 60_000;
/// How many of the lowest frequencies are compared.
const FREQUENCIES: usize = 8;

/// The live crane of a source; the message of its mistakes.
///
/// # Errors
/// The spec has mistakes.
pub fn live(source: &SourceFile) -> Result<LiveCrane, String> {
    LiveCrane::from_spec(source).map_err(|mistakes| mistakes.to_string())
}

/// The stable equilibrium of a crane.
///
/// # Errors
/// There is none: its status in words.
pub fn equilibrium(crane: &dyn DynCrane) -> Result<Vec<f64>, String> {
    let found = crane.equilibrium(&statics::Settings::default());
    if found.is_stable() { Ok(found.q) } else { Err(found.to_string()) }
}

/// Everything at rest, and with `run` at the end of the spec's run.
///
/// # Errors
/// The crane has mistakes, does not stand, or does not run.
pub fn observe(source: &SourceFile, run: bool) -> Result<Numbers, String> {
    observe_with(source, &[], run)
}

/// The live crane of a source with some parameters set.
///
/// # Errors
/// The spec has mistakes, or a parameter is refused.
pub fn live_with(source: &SourceFile, set: &[(String, f64)]) -> Result<LiveCrane, String> {
    let mut crane = live(source)?;
    let mut values = crane.parameters().to_vec();
    for (name, value) in set {
        let index = crane.chain().parameters.iter().position(|own| own.name == *name);
        values[index.ok_or_else(|| format!("{name} is not a parameter"))?] = *value;
    }
    DynCrane::set_parameters(&mut crane, &values).map_err(|refused| refused.to_string())?;
    Ok(crane)
}

/// The same with some parameters set.
///
/// # Errors
/// As of [`observe`].
pub fn observe_with(source: &SourceFile, set: &[(String, f64)], run: bool) -> Result<Numbers, String> {
    observe_live(&live_with(source, set)?, run)
}

/// The same of a crane.
///
/// # Errors
/// It does not stand, or does not run.
pub fn observe_live(crane: &LiveCrane, run: bool) -> Result<Numbers, String> {
    let crane: &dyn DynCrane = crane;
    let q = equilibrium(crane)?;
    let mut numbers = Numbers::new();
    let mut add = |group: &'static str, name: String, unit: &str, value: f64| {
        numbers.insert(format!("{group} {name}"), Number { group, unit: unit.to_owned(), value });
    };
    let motions = crane.small_motions_at(&q);
    let modes = modes::undamped(&motions).map_err(|error| error.to_string())?;
    for (k, mode) in modes.iter().take(FREQUENCIES).enumerate() {
        // ω² is what the eigenproblem has to rounding.
        add(MODES.0, format!("omega_squared_{k}"), "1/s²", mode.omega_squared);
    }
    let rest = vec![0.0; q.len()];
    let description = crane.description();
    let wrenches = crane.internal_forces_at(0.0, &q, &rest, &rest);
    for (name, unit, value) in stresses(crane, &q, &wrenches) {
        add(CUTS.0, name, unit, value);
    }
    for (cut, wrench) in description.cuts().iter().zip(wrenches) {
        if let Cut::Body { body, .. } = cut {
            let body = description.bodies[*body].name.as_str();
            add(CUTS.0, format!("{body} force"), "N", wrench.force.norm());
            add(CUTS.0, format!("{body} moment"), "N m", wrench.moment.norm());
        }
    }
    // The margin itself depends on which bodies are a link.
    let balances = lines(crane, 0.0, &q, &rest, &rest).into_iter().map(|line| line.balance());
    if let Some(least) = balances.min_by(f64::total_cmp) {
        add(CUTS.0, "least moment about a tipping line".to_owned(), "N m", least);
    }
    for caution in cautions::of_pose(crane, &q, cautions::BEND) {
        let words: String = caution.chars().filter(|letter| !letter.is_ascii_digit()).collect();
        add(CAUTIONS, words, "", 1.0);
    }
    let start = Start { v: rest, q, x: Vec::new(), what: String::new(), rests: true };
    let base = Settings { tolerance: STEP, most_steps: MOST_STEPS, audit: false, ..Settings::of(description) };
    // The first result of a run is the crane at rest, with the states of its oil and bristles.
    let settings = if run { base } else { Settings { duration: 1e-6, output: 1e-6, ..base } };
    let recorded = record(crane, &start, &settings, &mut |_| ControlFlow::Continue(()));
    let table = recorded.map_err(|failed| failed.to_string())?.table;
    if run {
        for (beam, range) in ranges(crane, &table) {
            add(RUN.0, format!("{beam} stress by cycles of stress"), "Pa", range);
        }
        for DriveDuty { name, kind, rms, work, .. } in Duties::of(description, &table).drives {
            add(RUN.0, format!("{name} mean effort"), kind.force_unit(), rms);
            add(RUN.0, format!("{name} work given"), "J", work);
        }
    }
    let ends = [(REST.0, table.rows.first()), (RUN.0, table.rows.last().filter(|_| run))];
    for (group, row) in ends {
        for (column, value) in table.columns.iter().zip(row.into_iter().flatten()) {
            // The angle of a pin counts from the guess, which two descriptions need not share.
            if !AUDIT.contains(&column.name.as_str()) && !column.name.ends_with("_angle") {
                add(group, column.name.clone(), &column.unit, *value);
            }
        }
    }
    Ok(numbers)
}

/// The largest stress of each beam, Pa, and the largest utilisation of all.
fn stresses(crane: &dyn DynCrane, q: &[f64], wrenches: &[Wrench]) -> Vec<(String, &'static str, f64)> {
    let description = crane.description();
    let mut greatest: BTreeMap<String, (&'static str, f64)> = BTreeMap::new();
    for section in stressed_sections(description, &crane.section_moduli_at(), &crane.section_places_at(q), wrenches) {
        let beam = section.beam(description);
        let used = section.utilisation.map(|used| ("utilisation with stress".to_owned(), "", used));
        for (name, unit, value) in used.into_iter().chain([(format!("{beam} stress"), "Pa", section.stress.equivalent)])
        {
            let (_, most) = greatest.entry(name).or_insert((unit, 0.0));
            *most = most.max(value);
        }
    }
    greatest.into_iter().map(|(name, (unit, value))| (name, unit, value)).collect()
}

/// The range of which one cycle does the damage of a run, where it is greatest on each beam, Pa.
fn ranges(crane: &dyn DynCrane, table: &Table) -> BTreeMap<String, f64> {
    let history = instants(crane, table.rows.iter());
    let states = history.iter().map(Instant::state).collect();
    let moduli = crane.section_moduli_at();
    let manoeuvre = Manoeuvre { moduli: &moduli, states, repetitions: 1.0 };
    let detail = Detail { category: 71e6, slope: SLOPE };
    let mut greatest = BTreeMap::new();
    for of in fatigue::of_manoeuvres(crane.description(), &[manoeuvre], |_| detail) {
        let range = greatest.entry(of.place.beam(crane.description()).to_owned()).or_insert(0.0);
        *range = f64::max(*range, fatigue::equivalent_range(&of.parts[0].cycles, SLOPE));
    }
    greatest
}

/// Slope of a curve of strength, of welds.
const SLOPE: f64 = 3.0;

/// The group of the loads of charts.
pub const CHART: &str = "chart";

/// Between which loads a chart searches, kg.
pub const LOADS: [f64; 2] = [1.0, 2e4];

/// The load that a chart gives for the pose of the spec, kg: within stress, tipping, pressure, strokes, stops and efforts. `None` for a crane
/// without a mass as a live parameter, and where the chart begins beyond a limit.
#[must_use]
pub fn rated_load(crane: &LiveCrane) -> Option<f64> {
    let whole: &dyn DynCrane = crane;
    let load = only_mass(whole.description())?;
    let none = Limits::none(whole.description());
    let limits = Limits { tipping: Some(0.05), utilisation: Some(1.0), of_parts: PartLimit::DEFAULT.to_vec(), ..none };
    let asked = Envelope { axes: Axes::default(), load, loads: LOADS, limits, factor: 1.0 };
    let found = std::sync::Mutex::new(Vec::new());
    let done = |_: usize, ratings: &[Rating]| {
        if let Ok(mut found) = found.lock() {
            found.extend(ratings.to_vec());
        }
    };
    asked.run(crane, &[0], &Execution { threads: 1, done: &done, cancelled: &|| false }).ok()?;
    found.into_inner().ok()?.first()?.load
}

/// Columns of an audit, which is off.
const AUDIT: [&str; 5] = ["t", "drive_work", "dissipated_energy", "load_work", "energy_balance"];

/// What differs between two cranes: a line for each number of the first whose counterpart, named by `name`, is missing or another one.
/// `factor` is that of the second crane's numbers by unit.
pub fn differences(
    [first, second]: [&Numbers; 2],
    name: &dyn Fn(&str) -> Option<String>,
    factor: &dyn Fn(&str) -> f64,
) -> Vec<String> {
    let mut scales: BTreeMap<(&str, &str), f64> = BTreeMap::new();
    for number in first.values() {
        let scale = scales.entry((number.group, &number.unit)).or_insert(0.0);
        *scale = scale.max(number.value.abs());
    }
    let mut lines = Vec::new();
    for (key, a) in first {
        let (group, column) = key.split_once(' ').unwrap_or(("", key));
        let Some(wanted) = name(column) else { continue };
        let Some(b) = second.get(&format!("{group} {wanted}")) else {
            lines.push(format!("{key} has no counterpart {wanted}"));
            continue;
        };
        let (value, scale) = (b.value / factor(&a.unit), scales[&(a.group, a.unit.as_str())]);
        let off = (a.value - value).abs();
        if off.is_nan() || off > tolerance(a.group) * scale.max(floor(a.group, &a.unit)) {
            lines.push(format!("{key}: {:.9e} {} against {value:.9e}", a.value, a.unit));
        }
    }
    lines
}

/// Where all numbers of a unit are smaller than this, they are rounding. At the end of a run, the error of rates is that of the pose, 1e-8,
/// times the fastest frequency that its steps follow, some 10 1/s. A power is a flow times a pressure, some 1e7 Pa. Stresses that stay as they are have
/// ranges of 1e-12 of 1e8 Pa.
fn floor(group: &str, unit: &str) -> f64 {
    match unit {
        "W" => 10.0,
        "Pa" if group == RUN.0 => 1e3,
        _ if group == RUN.0 => 1e-2,
        _ => 1e-3,
    }
}
