//! What a crane does, as named numbers that do not depend on how its spec describes it.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::{LiveCrane, Reach};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::envelope::{
    Axes, Condition, Critical, Envelope, Execution, Limits, LoadFactor, Rating, SecondOrder, critical_load,
    load_factor, only_mass, second_order,
};
use crane_model::fatigue::{self, Detail, Manoeuvre};
use crane_model::linear::{About, Forces, Input, Output, linear_model, outputs};
use crane_model::margins::{Acting, Loop, Margins, margins, plant};
use crane_model::modes::{self, DampedMode};
use crane_model::nalgebra::{Complex, DMatrix};
use crane_model::results::{DriveDuty, Duties, Instant, Table, cautions, instants};
use crane_model::runs::{QuasiStatic, Start, limiting_modes, record};
use crane_model::stability::limit;
use crane_model::{ColumnKind, Cut, DriveInfo, statics};

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

/// Cautions, each a number 1.
pub const CAUTIONS: &str = "cautions";
/// Columns of a run at rest, and those that are at rest along its motion.
pub const REST: &str = "rest";
/// Columns of a run at each of its results.
pub const RUN: &str = "run";
/// What commands print of a crane, in groups, and how far two descriptions may differ, relative to the largest number of a unit in the group.
const GROUPS: [(&str, f64); 9] = [
    // Rounding, and Newton's tolerance times the condition of the tangent stiffness.
    (REST, 1e-7),
    // Ten thousand times the tolerance of the run, since its steps differ.
    (RUN, 2e-5),
    // ω² of the lowest modes are differences of large numbers, and so are eigenvalues of damped ones.
    (MODES, 1e-6),
    // Forces that joints and sections transmit, stresses, moments about tipping lines.
    (CUTS, 1e-7),
    // Responses of linear models, of which C is a matrix of differences.
    (LINEAR, 1e-5),
    // Margins of a loop around such a model: where its response crosses lines.
    (MARGINS, 1e-4),
    // Critical loads and factors: ten times the accuracy of their searches.
    (LOADS, 1e-5),
    (STEPS, 1e-5),
    (CAUTIONS, 0.0),
];
/// Vibrations.
pub const MODES: &str = "modes";
const CUTS: &str = "cuts";
/// Responses of linear models.
pub const LINEAR: &str = "linear";
/// Margins of a loop.
pub const MARGINS: &str = "margins";
/// Loads at which something happens.
pub const LOADS: &str = "loads";
/// Largest stable steps.
pub const STEPS: &str = "steps";

/// How far the numbers of a group may differ.
#[must_use]
pub fn tolerance(group: &str) -> f64 {
    GROUPS.into_iter().find(|(name, _)| *name == group).map_or(0.0, |(_, tolerance)| tolerance)
}

/// What is observed besides a crane at rest.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extent {
    /// The run of the spec.
    pub run: bool,
    /// Searches for loads, linear models and margins.
    pub searches: bool,
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
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    if equilibrium.is_stable() { Ok(equilibrium.q) } else { Err(equilibrium.to_string()) }
}

/// What commands print of a crane.
///
/// # Errors
/// The crane has mistakes, does not stand, or does not run.
pub fn observe(source: &SourceFile, extent: Extent) -> Result<Numbers, String> {
    observe_with(source, &[], extent)
}

/// The live crane of a source with some parameters and inputs set.
///
/// # Errors
/// The spec has mistakes, or a parameter is refused.
pub fn live_with(source: &SourceFile, set: &[(String, f64)]) -> Result<LiveCrane, String> {
    let mut crane = live(source)?;
    let mut values = crane.parameters().to_vec();
    for (name, value) in set {
        let index = crane.chain().parameters.iter().position(|own| own.name == *name);
        let input = crane.description().inputs.iter().position(|own| own.name == name.as_str());
        match (index, input) {
            (Some(index), _) => values[index] = *value,
            (None, Some(input)) => DynCrane::set_input(&mut crane, input, Some(*value)),
            (None, None) => return Err(format!("{name} is neither a parameter nor an input")),
        }
    }
    DynCrane::set_parameters(&mut crane, &values).map_err(|refused| refused.to_string())?;
    Ok(crane)
}

/// The same with some parameters set.
///
/// # Errors
/// As of [`observe`].
pub fn observe_with(source: &SourceFile, set: &[(String, f64)], extent: Extent) -> Result<Numbers, String> {
    observe_live(&live_with(source, set)?, extent)
}

/// The same of a crane.
///
/// # Errors
/// It does not stand, or does not run.
pub fn observe_live(crane: &LiveCrane, extent: Extent) -> Result<Numbers, String> {
    let q = equilibrium(crane)?;
    let mut found = Found(Numbers::new());
    found.vibrations(crane, &q)?;
    found.strength(crane, &q);
    if extent.searches {
        found.linear(crane, &q);
        found.loads(crane);
    }
    found.results(crane, &q, extent.run)?;
    Ok(found.0)
}

/// Separates parts of a name, each of which has its own counterpart in another description.
const AND: &str = " | ";
/// Separates units.
const PER: &str = " per ";
/// Where responses are compared, 1/s: between swinging and vibrations of the structure, off the axis near which both are.
const OFF_AXIS: Complex<f64> = Complex::new(2.0, 15.0);

/// Numbers that are found one after the other.
struct Found(Numbers);

impl Found {
    fn add(&mut self, group: &'static str, name: impl AsRef<str>, unit: &str, value: f64) {
        self.0.insert(format!("{group} {}", name.as_ref()), Number { group, unit: unit.to_owned(), value });
    }

    fn cautions(&mut self, cautions: impl IntoIterator<Item = String>) {
        for caution in cautions {
            let words: String = caution.chars().filter(|letter| !letter.is_ascii_digit()).collect();
            self.add(CAUTIONS, words, "", 1.0);
        }
    }

    /// Undamped and damped modes, and the largest stable step of every method.
    fn vibrations(&mut self, crane: &LiveCrane, q: &[f64]) -> Result<(), String> {
        let motions = (crane as &dyn DynCrane).small_motions_at(q);
        let undamped = modes::undamped(&motions).map_err(|error| error.to_string())?;
        for (k, mode) in undamped.iter().take(FREQUENCIES).enumerate() {
            // ω² is what the eigenproblem has to rounding.
            self.add(MODES, format!("omega_squared_{k}"), "1/s²", mode.omega_squared);
        }
        let damped = modes::damped(&motions).map_err(|error| error.to_string())?;
        // Eigenvalues that nearly coincide are in any order, and known to the root of rounding: what is compared are sums over all of them,
        // of which the first is the trace of the state matrix, and the second counts slow motions.
        let all = damped.iter().flat_map(|DampedMode { eigenvalue, .. }| {
            [Some(*eigenvalue), Some(eigenvalue.conj()).filter(|_| eigenvalue.im > 0.0)]
        });
        let [mut trace, mut slow] = [0.0; 2];
        for eigenvalue in all.flatten() {
            trace += eigenvalue.re;
            slow += (eigenvalue - OFF_AXIS).inv().re;
        }
        self.add(MODES, "sum of damped eigenvalues", "1/s", trace);
        self.add(MODES, "slow damped motions", "s", slow);
        let limiting = limiting_modes(crane, 0.0, q, &damped);
        for method in Method::ALL {
            if let Some(limit) = limit(&limiting, &method.stability()) {
                self.add(STEPS, format!("largest stable step of {method}"), "s", limit.step);
            }
        }
        self.cautions(cautions::of_servos(crane, 0.0, q));
        Ok(())
    }

    /// What joints, sections and the ground carry.
    fn strength(&mut self, crane: &LiveCrane, q: &[f64]) {
        let crane: &dyn DynCrane = crane;
        let description = crane.description();
        let positions: Vec<f64> = crane.drive_motions_at(0.0).iter().map(|[position, _]| *position).collect();
        let condition = Condition::at(crane, q.to_vec(), &positions);
        let rest = vec![0.0; q.len()];
        let wrenches = crane.internal_forces_at(0.0, q, &rest, &rest);
        for (cut, wrench) in description.cuts().iter().zip(wrenches) {
            if let Cut::Body { body, .. } = cut {
                let body = description.bodies[*body].name.as_str();
                self.add(CUTS, format!("{body} force"), "N", wrench.force.norm());
                self.add(CUTS, format!("{body} moment"), "N m", wrench.moment.norm());
            }
        }
        self.stresses(crane, &condition);
        let foot = |foot: usize| description.supports[foot].name.as_str();
        // The margin itself depends on which bodies are a link.
        for line in &condition.lines {
            let mut feet = line.feet.map(foot);
            feet.sort_unstable();
            self.add(CUTS, format!("{} moment about the line to {}", feet[0], feet[1]), "N m", line.balance());
        }
        if let Some(margin) = condition.margin() {
            self.add(CUTS, TIPPING_MARGIN, "1", margin);
        }
        for (index, used) in &condition.utilisations_of_friction {
            self.add(CUTS, format!("{} used of its friction", foot(*index)), "", *used);
        }
        for (body, [inside, left]) in &condition.overlaps {
            let stage = description.bodies[*body].link.as_str();
            self.add(CUTS, format!("{stage} inside"), "m", *inside);
            self.add(CUTS, format!("{stage} may be pushed in"), "m", *left);
        }
        for (support, [force, _]) in description.supports.iter().zip(&condition.feet) {
            if let Some(plate) = support.max_force() {
                self.add(
                    CUTS,
                    format!("{} pressure of its plate over what the ground bears", support.name),
                    "1",
                    force / plate,
                );
            }
        }
        self.cautions(cautions::of_pose(crane, q, cautions::BEND));
        self.cautions(cautions::of_strength(crane));
    }

    /// Stresses at every place, the largest of each beam, and the largest utilisation of all.
    fn stresses(&mut self, crane: &dyn DynCrane, condition: &Condition) {
        let description = crane.description();
        let (mut places, mut greatest): (BTreeMap<&str, usize>, BTreeMap<&str, f64>) = Default::default();
        let mut most: Option<f64> = None;
        for section in &condition.sections {
            let beam = section.beam(description);
            let index = places.entry(beam).or_insert(0);
            let stress = section.stress;
            for (what, value) in [
                ("normal", stress.normal),
                ("shear", stress.shear),
                ("torsion", stress.torsion),
                ("equivalent", stress.equivalent),
            ] {
                self.add(CUTS, format!("{beam} stress at place {index}, {what}"), "Pa", value);
            }
            *index += 1;
            let greatest = greatest.entry(beam).or_insert(0.0);
            *greatest = greatest.max(stress.equivalent);
            most = section.utilisation.into_iter().chain(most).reduce(f64::max);
        }
        for (beam, stress) in greatest {
            self.add(CUTS, format!("{beam} stress"), "Pa", stress);
        }
        if let Some(used) = most {
            self.add(CUTS, "utilisation with stress", "", used);
        }
    }

    /// The linear model, as responses of all its outputs to all its inputs, and the margins of a loop that moves the boom.
    fn linear(&mut self, crane: &LiveCrane, q: &[f64]) {
        let (description, rest) = (crane.description(), vec![0.0; q.len()]);
        let about = About { t: 0.0, q, v: &rest, x: Forces::SlightlyOpen, steady: true };
        let inputs = Input::all(description);
        // What closes loops and holds rigid drives follows from accelerations, at once with inputs.
        let rigid = |output: &Output| {
            let names = description.prescribed().into_iter().map(|j| &description.coordinates[j].name);
            output.column.kind == ColumnKind::DriveEffort
                && names.into_iter().any(|name| output.column.name.starts_with(&format!("{name}_drive")))
        };
        let follows = |output: &Output| {
            matches!(output.column.kind, ColumnKind::LoopForce | ColumnKind::LoopMoment) || rigid(output)
        };
        let outputs: Vec<Output> = outputs(crane).into_iter().filter(|output| !follows(output)).collect();
        let Ok(model) = linear_model(crane, &about, &inputs, &outputs) else {
            return self.add(LINEAR, "no model", "", 1.0);
        };
        let size = model.a.nrows();
        let states = DMatrix::from_diagonal_element(size, size, OFF_AXIS) - model.a.map(Complex::from);
        if let Some(moved) = states.lu().solve(&model.b.map(Complex::from)) {
            let response = model.c.map(Complex::from) * moved + model.d.map(Complex::from);
            for (output, row) in model.outputs.iter().zip(response.row_iter()) {
                for (input, value) in model.inputs.iter().zip(row.iter()) {
                    let unit = format!("{}{PER}{}", output.unit, input.unit);
                    // Along a direction in the complex plane: with its phase.
                    self.add(
                        LINEAR,
                        format!("{}{AND}{}", output.name, input.name),
                        &unit,
                        0.6 * value.re + 0.8 * value.im,
                    );
                }
            }
        }
        let of_boom = |drive: &DriveInfo| description.coordinates[drive.coordinate].name.contains("boom_");
        let Some(drive) = description.drives.iter().position(of_boom) else { return };
        let acting = Acting::Motion(drive);
        let of: Vec<Input> = acting.inputs().into_iter().map(|(input, _)| input).collect();
        let measured = &description.coordinates[description.drives[drive].coordinate].name;
        let Some(measured) = outputs.iter().find(|output| output.column.name == measured.as_str()) else { return };
        let plant = linear_model(crane, &about, &of, std::slice::from_ref(measured))
            .ok()
            .and_then(|model| plant(&model, acting, 0).ok());
        let Some(plant) = plant else { return };
        for p in GAINS {
            let of = Loop { p, i: 0.5, d: 0.0, filter: 0.0, lead: [0.0; 2], delay: 0.02, lag: 0.05 };
            if let Ok(margins) = margins(&plant, &of) {
                self.margins(&format!("with {p}"), &margins);
            }
        }
    }

    fn margins(&mut self, of: &str, margins: &Margins) {
        let mut add = |name: &str, unit: &str, value: f64| self.add(MARGINS, format!("{name} {of}"), unit, value);
        add("stable", "", f64::from(u8::from(margins.stable)));
        add("unstable motions", "", margins.unstable as f64);
        let pairs = [
            ("phase", margins.phase),
            ("gain", margins.gain),
            ("reduction", margins.reduction),
            ("distance", margins.distance),
        ];
        for (name, (value, frequency)) in pairs.into_iter().filter_map(|(name, pair)| Some((name, pair?))) {
            add(name, name, value);
            add(&format!("frequency of {name}"), "rad/s", frequency);
        }
        if let Some(bandwidth) = margins.bandwidth {
            add("bandwidth", "rad/s", bandwidth);
        }
        if let Some(damping) = margins.damping() {
            add("damping ratio", "1", damping);
        }
    }

    /// Loads that a chart gives, that lift a foot and that tip the crane, and factors of all loads.
    fn loads(&mut self, crane: &LiveCrane) {
        if let Some(index) = only_mass(crane.description()) {
            let rating = rated(crane);
            if let Some(limit) = rating.as_ref().and_then(|rating| rating.governing) {
                self.add(LOADS, format!("governed by {}", limit.kind()), "", 1.0);
            }
            if let Some(Rating { load: Some(load), loaded: Some(loaded), .. }) = rating {
                self.add(LOADS, "load of a chart", "kg", load);
                let reach = Reach::new(crane.chain(), crane.parameters(), Some(index), None);
                let place = reach.radius_and_height(&loaded.q, crane.parameters());
                for (name, number) in ["radius of a chart", "height of a chart"].into_iter().zip(place) {
                    self.add(LOADS, name, "m", number);
                }
            }
            for (name, critical) in
                [("load that lifts a foot", Critical::FirstFoot), ("load that tips", Critical::Tipping)]
            {
                if let Ok(critical_load) = critical_load(&mut crane.clone(), index, critical) {
                    self.add(LOADS, name, "kg", critical_load.load);
                }
            }
        }
        let (mut crane, factor) = crane.with_load_factor();
        if let Some(SecondOrder { points, beams }) = second_order(&mut crane.clone(), factor) {
            for (order, what) in ["first", "second"].iter().enumerate() {
                let moved: f64 = points.iter().map(|orders| orders[order].norm()).sum();
                let bent = beams.iter().map(|(_, moments)| moments[order]).fold(0.0, f64::max);
                self.add(LOADS, format!("displacements by the {what} order"), "m", moved);
                self.add(LOADS, format!("bending by the {what} order"), "N m", bent);
            }
        }
        let Some(LoadFactor { linearised, followed }) = load_factor(&mut crane, factor) else { return };
        if let Some(factor) = linearised {
            self.add(LOADS, "factor by the stiffness", "1", factor);
        }
        if let Some(followed) = followed {
            self.add(LOADS, "factor to which the crane rests", "1", followed.factor);
        }
    }

    /// Columns of a run at rest, and with `run` at all its results.
    fn results(&mut self, crane: &LiveCrane, q: &[f64], run: bool) -> Result<(), String> {
        let rest = vec![0.0; q.len()];
        let start = Start { rests: true, ..Start::given(InitialState { q: q.to_vec(), v: rest, x: Vec::new() }) };
        let base = Settings {
            tolerance: STEP,
            most_steps: MOST_STEPS,
            audit: false,
            ..Settings::from_description(crane.description())
        };
        // The first result of a run is the crane at rest, with the states of its oil and bristles.
        let settings = if run { base } else { Settings { duration: 1e-6, output: 1e-6, ..base } };
        let recorded = record(crane, &start, &settings, &mut |_| ControlFlow::Continue(()));
        let table = recorded.map_err(|failed| failed.to_string())?.table;
        if let Some(row) = table.rows.first() {
            self.row(REST, &table, row, "");
        }
        if !run {
            return Ok(());
        }
        for row in &table.rows {
            self.row(RUN, &table, row, &format!("{AND}at {:.3} s", row[0]));
        }
        for (beam, range) in ranges(crane, &table) {
            self.add(RUN, format!("{beam} stress by cycles of stress"), "Pa", range);
        }
        for DriveDuty { name, kind, rms, work, .. } in Duties::new(crane.description(), &table).drives {
            self.add(RUN, format!("{name} mean effort"), kind.force_unit(), rms);
            self.add(RUN, format!("{name} work given"), "J", work);
        }
        let slowly = QuasiStatic::along(crane, &start, &table, SLOWLY, &mut |_| ControlFlow::Continue(()));
        for row in &slowly.table.rows {
            self.row(REST, &slowly.table, row, &format!("{AND}at rest as at {:.3} s", row[0]));
        }
        self.cautions(cautions::of_run(crane, &table, cautions::BEND));
        self.cautions(cautions::of_loads(crane, &table).into_iter().flatten());
        Ok(())
    }

    fn row(&mut self, group: &'static str, table: &Table, row: &[f64], when: &str) {
        for (column, value) in table.columns.iter().zip(row) {
            // The angle of a pin counts from the guess, which two descriptions need not share.
            if !AUDIT.contains(&column.name.as_str()) && !column.name.ends_with("_angle") {
                self.add(group, format!("{}{when}", column.name), &column.unit, *value);
            }
        }
    }
}

/// Poses at rest along a run.
const SLOWLY: usize = 2;

/// Gains of loops around the boom's drive: one that most of them are stable with, and one that is too large.
const GAINS: [f64; 2] = [0.4, 8.0];

/// The name of the least tipping margin, which depends on which bodies are a link.
pub const TIPPING_MARGIN: &str = "tipping margin";

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

/// Between which loads a chart searches, kg.
pub const BETWEEN: [f64; 2] = [1.0, 2e4];

/// What a chart finds for the pose of the spec, within stress, tipping, pressure, strokes, stops and efforts. `None` for a crane without a mass as a
/// live parameter.
#[must_use]
pub fn rated(crane: &LiveCrane) -> Option<Rating> {
    let load = only_mass(crane.description())?;
    let usual = Limits::usual(crane.description());
    let limits = Limits { tipping: Some(0.05), ..usual };
    rate(crane, &Envelope { axes: Axes::default(), load, loads: BETWEEN, limits, factor: 1.0 })
}

/// The last pose of a chart.
pub fn rate(crane: &LiveCrane, envelope: &Envelope) -> Option<Rating> {
    let found = std::sync::Mutex::new(Vec::new());
    let done = |_: usize, ratings: &[Rating]| {
        if let Ok(mut found) = found.lock() {
            found.extend(ratings.to_vec());
        }
    };
    envelope.run(crane, &[0], &Execution { threads: 1, done: &done, cancelled: &|| false }).ok()?;
    found.into_inner().ok()?.pop()
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
        let wanted: Option<Vec<String>> = column.split(AND).map(name).collect();
        let Some(wanted) = wanted.map(|parts| parts.join(AND)) else { continue };
        let Some(b) = second.get(&format!("{group} {wanted}")) else {
            lines.push(format!("{key} has no counterpart {wanted}"));
            continue;
        };
        let by = a.unit.split_once(PER).map_or_else(|| factor(&a.unit), |(unit, per)| factor(unit) / factor(per));
        let (value, scale) = (b.value / by, scales[&(a.group, a.unit.as_str())]);
        let off = (a.value - value).abs();
        if off.is_nan() || off > tolerance(a.group) * scale.max(floor(a.group, &a.unit)) {
            lines.push(format!("{key}: {:.9e} {} against {value:.9e}", a.value, a.unit));
        }
    }
    lines
}

/// Where all numbers of a unit are smaller than this, they are rounding. In a run, the error of rates is that of the pose, 1e-8,
/// times the fastest frequency that its steps follow, some 10 1/s. A power is a flow times a pressure, some 1e7 Pa. Stresses that stay as they are have
/// ranges of 1e-12 of 1e8 Pa.
fn floor(group: &str, unit: &str) -> f64 {
    match unit {
        // Responses have units of their own: a motion that nothing excites is 1e-9 m per m.
        _ if group == LINEAR => 1e-9,
        "s" => 0.0,
        "W" => 10.0,
        "Pa" if group == RUN => 1e3,
        _ if group == RUN => 1e-2,
        _ => 1e-3,
    }
}
