//! `crane linearise`: small motions about a pose, a steady motion, or a moment of a run.

use crane_model::StateAt;
use std::{io::Write, path::Path};

use crane_live::LiveCrane;
use crane_model::{
    Description, LoopJointInfo,
    dyn_crane::{DynCrane, Functions},
    dynamics, force_states,
    linear::{About, Drift, Forces, LinearModel},
    modes::{ComplexShape, DampedMode, Held, SmallMotions, damped_with_shapes, steady},
    statics,
};
use crane_page::tables::{Cell, Grid, Report, damped_mode, names};
use nalgebra::{Complex, DMatrix};
use serde_json::{Value, json};

use crate::{
    arguments::Linearise,
    files,
    npz::{Array, npz},
    poses::held_number,
    problem::{Outcome, Problem},
    screen::Console,
    selection::Registry,
    start::{Variable, row},
    state_space,
};

/// Number of lowest modes that are printed by default.
const LOWEST: usize = 10;
/// A pose that changes more slowly than this stays, m/s or rad/s.
const STILL: f64 = 1e-5;
/// Accelerations up to this, m/s² and rad/s², are those of a steady motion.
const STEADY: f64 = 1e-3;
/// The pose may change by this fraction of the rates before a motion no longer counts as steady.
const DRIFT: f64 = 1e-3;

/// The motion about which the crane is linearised.
struct MotionAbout {
    /// What it is, in words.
    about: &'static str,
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// States of forces; none: those that hold the pose.
    x: Vec<f64>,
    /// Whether the accelerations are those of a motion at constant rates, whatever holds it.
    steady: bool,
    /// Effort that holds each coordinate, N and N m; `None` where it is not held.
    efforts: Vec<Option<f64>>,
    cautions: Vec<String>,
}

/// A mode and its shape.
type Mode = (DampedMode, ComplexShape);

/// Prints the motion, its modes and, for programs, the matrices; writes an archive if asked to.
pub fn linearise(options: &Linearise, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = registry.live(options.analysis.crane.open(registry)?.as_ref())?;
    let description = crane.description();
    let is_closed = description.has_hidden_forces() || !crane.loop_joints().is_empty();
    if is_closed && !options.held.is_empty() {
        let or = crane.loop_joints().first().map_or("", LoopJointInfo::remedy);
        return Err(Problem::usage(
            format!(
                "{} has loops, rigid couplings, valves or joints that stick: nothing else can hold its coordinates",
                description.name
            ),
            format!(
                "let its drives hold them, `motion: {{hold: 30 deg}}` in the spec, or give a moment of a run with `--from`{or}"
            ),
        ));
    }
    let latest = dynamics::Settings::TIMES.1;
    if let Some(t) = options.time.filter(|t| t.abs() > latest) {
        return Err(Problem::usage(
            format!("`--time {t:e}` is out of range"),
            format!("write a number of seconds up to {latest:e}"),
        ));
    }
    let motion = match &options.from {
        Some(file) => of_results(&registry.console, &crane, file, options.time)?,
        None if is_closed => of_rest(&crane, options.time.unwrap_or(0.0))?,
        None => of_steady(&crane, options)?,
    };
    let about = About {
        t: motion.t,
        q: &motion.q,
        v: &motion.v,
        x: if motion.x.is_empty() { Forces::Holding } else { Forces::Given(&motion.x) },
        steady: motion.steady,
    };
    let model = state_space::model(&crane, &about, options)?;
    let small = (!is_closed).then(|| model.small_motions());
    let found: Vec<Mode> = match small {
        Some(small) => damped_with_shapes(small)?,
        None => model.modes()?.into_iter().map(|mode| (mode, ComplexShape::zeros(0))).collect(),
    };
    if let Some(file) = &options.file {
        write_archive(&registry.console, file, &arrays(&motion, small, &model, &found))?;
    }
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.fact("about", motion.about, "");
    report.fact("time", motion.t, "s");
    let valves = description.has_valves();
    if valves {
        report.fact("valves", if motion.x.is_empty() { "shut" } else { "as in the results" }, "");
    }
    report.value("drift", model.drift.as_ref().map_or(Value::Null, |drift| drift_value(description, &model, drift)));
    report.caution(model.drift.as_ref().map(|drift| drift_words(description, &model, drift)));
    let growing = model.growing()?;
    report.value("stable", growing.is_none());
    report.caution(growing.map(|growing| unstable_words(description, &found, growing)));
    for caution in &motion.cautions {
        report.caution(Some(caution.as_str()));
    }
    report.caution(description.near_singular(&motion.q));
    if let Some(small) = small {
        for (key, value) in values(description, small, &found) {
            report.value(key, value);
        }
    }
    report.value("state_space", state_space::value(&model));
    report.grid(held(description, &motion));
    report.excerpt(modes_of(description, &found), LOWEST);
    report.excerpt(states(description, &motion), 0);
    report.excerpt(state_space::signals(&model), 0);
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, &registry.console, out)
}

/// What grows, and how fast.
fn unstable_words(description: &Description, found: &[Mode], growing: Complex<f64>) -> String {
    let far = |mode: &DampedMode| (mode.eigenvalue - growing).norm();
    let nearest = found.iter().map(|(mode, _)| mode).min_by(|a, b| far(a).total_cmp(&far(b)));
    let names = nearest
        .into_iter()
        .flat_map(|mode| &mode.dominating)
        .map(|index| description.coordinates[*index].name.as_str());
    let names: Vec<&str> = names.collect();
    format!("unstable: a disturbance of {} grows, at most by {:.3} 1/s", names.join(", "), growing.re)
}

/// The fastest coordinate of a drift: its index, its rate, and the rate's unit.
fn fastest(description: &Description, model: &LinearModel, drift: &Drift) -> (usize, f64, String) {
    let coordinate = model.coordinates()[drift.fastest];
    (coordinate, drift.rates[drift.fastest], format!("{}/s", description.coordinates[coordinate].kind.unit()))
}

fn drift_words(description: &Description, model: &LinearModel, drift: &Drift) -> String {
    let (coordinate, rate, unit) = fastest(description, model, drift);
    let (changes, decay) = if drift.decay < 0.0 { ("speeds up", -drift.decay) } else { ("decays", drift.decay) };
    format!(
        "no equilibrium: with shut valves oil leaks past pistons, and {} drifts by {rate:.2e} {unit} at first, which {changes} at {decay:.2e} 1/s; \
         motions as slow as this are the drift's, and whether others grow is judged without the leakage",
        description.coordinates[coordinate].name
    )
}

fn drift_value(description: &Description, model: &LinearModel, drift: &Drift) -> Value {
    let (coordinate, rate, unit) = fastest(description, model, drift);
    json!({"coordinate": description.coordinates[coordinate].name.as_str(), "rate": rate, "unit": unit, "decay": drift.decay})
}

/// The motion in a row of results, with the accelerations that follow from it.
fn of_results(console: &Console, crane: &dyn DynCrane, file: &Path, at: Option<f64>) -> Outcome<MotionAbout> {
    let found = row(console, file, crane.description(), at)?;
    let (mut q, mut v) = (crane.guess(), vec![0.0; crane.size()]);
    let states = force_states::columns(crane.description());
    let mut x = vec![f64::NAN; states.len()];
    let mut missing: Vec<&str> = crane.description().coordinates.iter().map(|info| info.name.as_str()).collect();
    for (variable, value) in found.values {
        match variable {
            Variable::Position(index) => {
                q[index] = value;
                missing.retain(|name| **name != *crane.description().coordinates[index].name);
            }
            Variable::Rate(index) => v[index] = value,
            Variable::ForceState(index) => x[index] = value,
        }
    }
    missing.extend(states.iter().zip(&x).filter(|(_, x)| x.is_nan()).map(|(name, _)| name.as_str()));
    if !missing.is_empty() {
        return Err(Problem::usage(
            format!("{} lacks coordinates of {}: {}", file.display(), crane.description().name, missing.join(", ")),
            "give results of the same crane",
        ));
    }
    let t = at.or(found.time).unwrap_or(0.0);
    let (a, _) = force_states::accelerations(crane, &StateAt { t, q: &q, v: &v, x: &x });
    let greatest = a.iter().fold(0.0, |greatest: f64, a| greatest.max(a.abs()));
    let cautions = (greatest > STEADY)
        .then(|| format!("not steady: accelerations reach {greatest:.2e} m/s² or rad/s², so matrices and modes are valid only at this moment"));
    let efforts = vec![None; q.len()];
    let cautions = cautions.into_iter().collect();
    Ok(MotionAbout { about: "a moment of a run", t, q, v, a, x, steady: false, efforts, cautions })
}

/// The pose at rest of a crane with loops, valves or joints that stick.
fn of_rest(crane: &dyn DynCrane, t: f64) -> Outcome<MotionAbout> {
    let settings = statics::Settings::default();
    let rest =
        statics::Problem::new(crane).at_time(t).from(&crane.equilibrium(&settings).q).settings(&settings).solve();
    if !rest.rests() {
        let title = format!("{}: {}", crane.description().name, rest.status);
        return Err(Problem::failed(title, "`crane statics` says more, and what to change"));
    }
    let n = rest.q.len();
    let cautions = crane.description().has_valves().then(|| {
        "valves are shut, as at rest: what a servo does about it is a matter of `crane margins` and `crane statics`"
            .to_owned()
    });
    Ok(MotionAbout {
        about: "a pose at rest",
        t,
        q: rest.q,
        v: vec![0.0; n],
        a: vec![0.0; n],
        x: Vec::new(),
        steady: true,
        efforts: vec![None; n],
        cautions: cautions.into_iter().collect(),
    })
}

/// The steady motion with the drives as at a given time and some coordinates held.
fn of_steady(live: &LiveCrane, options: &Linearise) -> Outcome<MotionAbout> {
    let crane: &dyn DynCrane = live;
    let t = options.time.unwrap_or(0.0);
    let held = read_held(&options.held, crane.description())?;
    let settings = statics::Settings::default();
    let mut rest = crane.equilibrium(&settings);
    if t != 0.0 {
        rest = statics::Problem::new(crane).at_time(t).from(&rest.q).settings(&settings).solve();
    }
    let start = if rest.status == statics::Status::NotConverged { crane.guess() } else { rest.q };
    let found = steady(live, t, &start, &held).map_err(|refused| {
        let Description { name, coordinates, .. } = crane.description();
        match refused.loose.map(|loose| &coordinates[loose].name) {
            Some(loose) => Problem::failed(
                format!("{name}: no steady motion: no force keeps {loose} in its place"),
                format!("hold its position or its rate: `--hold {loose}=0` or `--hold {loose}_rate=0`"),
            ),
            None => Problem::failed(
                format!("{name}: {refused}"),
                "hold rates that are smaller, or positions nearer to those at rest; angles without `deg` are in rad",
            ),
        }
    })?;
    let greatest = found.v.iter().fold(0.0, |greatest: f64, v| greatest.max(v.abs()));
    let mut cautions = Vec::new();
    if found.drift > DRIFT * greatest && found.drift > STILL {
        cautions.push(format!(
            "not steady: the pose changes by up to {:.2e} rad/s or m/s as the motion goes on, so matrices and modes are valid \
             only at this moment",
            found.drift
        ));
    }
    if found.acceleration > STEADY {
        cautions.push(format!(
            "not steady: drives speed up or slow down at t = {t} s, by up to {:.2e} rad/s² or m/s²; their rates are held here",
            found.acceleration
        ));
    }
    let mut efforts = vec![None; start.len()];
    for held in &held {
        efforts[held.coordinate] = Some(found.efforts[held.coordinate]);
    }
    let about = if greatest > 0.0 { "a steady motion" } else { "a pose at rest" };
    let a = vec![0.0; start.len()];
    Ok(MotionAbout { about, t, a, q: found.q, v: found.v, x: Vec::new(), steady: true, efforts, cautions })
}

/// What `--hold` asks for.
fn read_held(given: &[String], description: &Description) -> Outcome<Vec<Held>> {
    let mut held: Vec<Held> = Vec::new();
    for text in given {
        let (name, _) = text.split_once('=').ok_or_else(|| {
            let help =
                "write `--hold coordinate=value`, such as `--hold boom_psi=30deg` or `--hold column_psi_rate=0.2`";
            Problem::usage(format!("`--hold {text}` has no value"), help)
        })?;
        let variable = Variable::named(name.trim(), description)?;
        let (coordinate, position, rate) = match variable {
            Variable::Position(index) => {
                (index, Some(held_number(text, description.coordinates[index].kind, false)?), None)
            }
            Variable::Rate(index) => (index, None, Some(held_number(text, description.coordinates[index].kind, true)?)),
            // Nothing but drives holds cranes with states of forces.
            Variable::ForceState(_) => continue,
        };
        match held.iter_mut().find(|held| held.coordinate == coordinate) {
            Some(held) => {
                held.position = position.or(held.position);
                held.rate = rate.unwrap_or(held.rate);
            }
            None => held.push(Held { coordinate, position, rate: rate.unwrap_or(0.0) }),
        }
    }
    Ok(held)
}

/// The efforts that hold the held coordinates.
fn held(description: &Description, motion: &MotionAbout) -> Grid {
    let mut grid = Grid::new(
        "held",
        "Torques and forces that hold coordinates, in addition to drives",
        &["coordinate", "effort", "unit"],
    );
    for (info, effort) in description.coordinates.iter().zip(&motion.efforts) {
        if let Some(effort) = effort {
            grid.row([info.name.as_str().into(), Cell::from(*effort), info.kind.force_unit().into()]);
        }
    }
    grid
}

/// Eigenvalues as a table.
fn modes_of(description: &Description, found: &[Mode]) -> Grid {
    let mut grid = Grid::new(
        "modes",
        "Modes (frequency |λ|/2π; ratio 1: returns without oscillating)",
        &["mode", "frequency [Hz]", "damping ratio", "re [1/s]", "im [1/s]", "dominated by"],
    );
    for (index, (mode, _)) in found.iter().enumerate() {
        let mut row = damped_mode(index, mode);
        row.push(names(description, &mode.dominating));
        grid.row(row);
    }
    grid
}

/// Pose, rates and accelerations.
fn states(description: &Description, motion: &MotionAbout) -> Grid {
    let headings = ["coordinate", "position", "unit", "rate", "acceleration", "unit of rates"];
    let mut grid = Grid::new("motion", "Motion: pose, rates and accelerations", &headings);
    for (index, info) in description.coordinates.iter().enumerate() {
        let is_angle = info.kind.unit() == "rad";
        let cell = |value: f64| if is_angle { Cell::of_unit(value, "rad") } else { Cell::Number(value) };
        let [unit, of_rates] =
            if is_angle { [Cell::unit_of("rad"), "rad/s, rad/s²".into()] } else { ["m".into(), "m/s, m/s²".into()] };
        let (rate, acceleration) = (motion.v[index].into(), motion.a[index].into());
        grid.row([info.name.as_str().into(), cell(motion.q[index]), unit, rate, acceleration, of_rates]);
    }
    grid
}

/// The matrices by their keys.
fn matrices(small: &SmallMotions) -> [(&'static str, DMatrix<f64>); 5] {
    [
        ("mass", small.mass.clone()),
        ("damping", small.damping.clone()),
        ("stiffness", small.stiffness.clone()),
        ("gyroscopic", small.gyroscopic()),
        ("circulatory", small.circulatory()),
    ]
}

/// What programs get besides tables: names and units of the rows, matrices, and shapes as pairs of real and imaginary parts.
fn values(description: &Description, small: &SmallMotions, found: &[Mode]) -> Vec<(&'static str, Value)> {
    let info = |index: &usize| &description.coordinates[*index];
    let names: Value = small.unknowns.iter().map(|index| info(index).name.as_str()).collect();
    let units: Value = small.unknowns.iter().map(|index| info(index).kind.unit()).collect();
    let shape = |shape: &ComplexShape| -> Value { shape.iter().map(|x| Value::from(vec![x.re, x.im])).collect() };
    let mut values = vec![("coordinates", names), ("coordinate_units", units)];
    values.extend(matrices(small).map(|(name, matrix)| (name, Array::of_matrix(name, &matrix).json())));
    values.push(("shapes", found.iter().map(|(_, of_mode)| shape(of_mode)).collect()));
    values
}

/// The same as arrays; pose, rates and accelerations of all coordinates.
fn arrays(motion: &MotionAbout, small: Option<&SmallMotions>, model: &LinearModel, found: &[Mode]) -> Vec<Array> {
    let list = |name: &'static str, data: Vec<f64>| Array { name: name.into(), shape: vec![data.len()], data };
    let shapes = |name: &'static str, part: fn(&Complex<f64>) -> f64| {
        let shape = vec![found.len(), model.coordinates().len()];
        Array { name: name.into(), shape, data: found.iter().flat_map(|(_, shape)| shape.iter().map(part)).collect() }
    };
    let eigenvalues = |part: fn(&Complex<f64>) -> f64| found.iter().map(|(mode, _)| part(&mode.eigenvalue)).collect();
    let mut arrays = vec![
        list("time", vec![motion.t]),
        list("pose", motion.q.clone()),
        list("rates", motion.v.clone()),
        list("accelerations", motion.a.clone()),
        list("efforts", motion.efforts.iter().map(|effort| effort.unwrap_or(0.0)).collect()),
        list("rows", model.coordinates().iter().map(|index| *index as f64).collect()),
    ];
    for (name, matrix) in [("A", &model.a), ("B", &model.b), ("C", &model.c), ("D", &model.d)] {
        arrays.push(Array::of_matrix(name, matrix));
    }
    arrays.extend(small.into_iter().flat_map(matrices).map(|(name, matrix)| Array::of_matrix(name, &matrix)));
    arrays.extend([
        list("eigenvalues_real", eigenvalues(|x| x.re)),
        list("eigenvalues_imaginary", eigenvalues(|x| x.im)),
    ]);
    if small.is_some() {
        arrays.extend([shapes("shapes_real", |x| x.re), shapes("shapes_imaginary", |x| x.im)]);
    }
    arrays
}

/// Writes an archive.
fn write_archive(console: &Console, file: &Path, arrays: &[Array]) -> Outcome<()> {
    files::ending(file, &["npz"])?;
    let bytes = npz(arrays).map_err(|error| Problem::failed(format!("cannot make an archive: {error}"), ""))?;
    console.write_file(file, |out| out.write_all(&bytes))
}
