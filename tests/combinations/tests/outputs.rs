//! Every number that commands print is compared by random cranes, or the reason why not stands here.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crane_combinations::check::names;
use crane_combinations::crane::crane;
use crane_combinations::observe::{Extent, observe};
use crane_combinations::tree::source;
use serde_json::Value;

/// Where a number is compared.
enum Taken {
    /// Between two descriptions of a crane: its group, and a part of its name.
    Observed(&'static str, &'static str),
    /// By a check of this name.
    Checked(&'static str),
    /// By nothing, and why.
    LeftOut(&'static str),
}
use Taken::{Checked, LeftOut, Observed};

/// Numbers of outputs, `command.key.column`, by patterns: `*` is any text.
const OUTPUTS: &[(&str, Taken)] = &[
    // Cranes at rest.
    ("*.drives.value", Observed("rest", "_drive_")),
    ("*.cylinders.value", Observed("rest", "_pressure")),
    ("*.reactions.?", Observed("rest", "_reaction_")),
    ("*.ground.value", Observed("cuts", "pressure of its plate")),
    ("*.friction.value", Observed("cuts", "used of its friction")),
    ("*.connectors.value", Observed("rest", "guy_force")),
    ("statics.loop_joints.value", Observed("rest", "end_force")),
    ("*.points.?", Observed("rest", "tip_")),
    ("*.pose.value", Observed("rest", "boom_psi")),
    ("*.cautions", Observed("cautions", "")),
    ("*.stable", Checked("what is stable has converged and does not grow")),
    ("*.cranes.relative_residual", Checked("what is stable has converged and does not grow")),
    ("*.cranes.*_steps", LeftOut("how a solution is found differs between descriptions")),
    ("statics.history.*", LeftOut("how a solution is found differs between descriptions")),
    ("statics.changes_of_positions_with_twice_the_sections", Checked("finer meshes")),
    ("*.with_twice_the_sections", Checked("finer meshes")),
    ("strength.change_of_the_greatest_*", Checked("finer meshes")),
    ("strength.stresses.change", Checked("finer meshes")),
    ("*.deflection.*", LeftOut("differences of positions that are compared")),
    // Modes.
    ("modes.undamped.*", Observed("modes", "omega_squared_0")),
    ("*.damped.stable_step", Observed("steps", "")),
    ("modes.largest_stable_step", Observed("steps", "rk4")),
    ("stability.limits.*", Observed("steps", "dopri5")),
    ("stability.along.*", LeftOut("what `limits` has, at further poses at rest, which are compared")),
    ("*.damped.*", Observed("modes", "damped motions")),
    ("linearise.modes.*", Observed("modes", "damped motions")),
    // Linear models.
    ("linearise.state_space.?", Observed("linear", "")),
    ("linearise.mass", Checked("accelerations solve A a = e + f")),
    ("linearise.stiffness", Checked("tangent is the derivative of the residual")),
    ("linearise.damping", Observed("linear", "")),
    ("linearise.gyroscopic", LeftOut("the skew part of `damping`")),
    ("linearise.circulatory", LeftOut("the skew part of `stiffness`")),
    ("linearise.shapes", LeftOut("eigenvectors in coordinates, which descriptions choose")),
    ("linearise.held.effort", Observed("rest", "_drive_")),
    ("linearise.drift.*", LeftOut("of valves that leak: coordinates, which descriptions choose")),
    ("linearise.motion.*", LeftOut("what is given")),
    ("linearise.time", LeftOut("what is given")),
    ("linearise.signals.index", LeftOut("places in lists, which descriptions choose")),
    ("margins.margins", Observed("margins", "stable")),
    ("margins.margins.damping_ratio", Observed("margins", "damping ratio")),
    ("margins.margins.at", LeftOut("the size of the eigenvalue of `damping_ratio`")),
    ("margins.margins.bandwidth", Observed("margins", "bandwidth")),
    ("margins.margins.crossover", Observed("margins", "frequency of phase")),
    ("margins.margins.distance", Observed("margins", "distance")),
    ("margins.margins.gain_margin", Observed("margins", "gain")),
    ("margins.margins.gain_reduction", Observed("margins", "reduction")),
    ("margins.margins.phase_margin", Observed("margins", "phase")),
    ("margins.loop.*", LeftOut("what is given")),
    ("margins.least_phase_margin", LeftOut("what is given")),
    ("margins.*_loops", LeftOut("how many rows have what they have")),
    // Strength and tipping.
    ("strength.stresses.x", LeftOut("places, whose stresses are compared one by one")),
    ("strength.stresses.utilisation", Observed("cuts", "utilisation")),
    ("strength.stresses.normal", Observed("cuts", ", normal")),
    ("strength.stresses.shear", Observed("cuts", ", shear")),
    ("strength.stresses.torsion", Observed("cuts", ", torsion")),
    ("strength.stresses.equivalent", Observed("cuts", ", equivalent")),
    ("strength.greatest_utilisation", Observed("cuts", "utilisation")),
    ("strength.greatest_equivalent_stress", Observed("cuts", "boom stress")),
    ("strength.tipping.margin", Observed("cuts", "tipping margin")),
    ("strength.tipping.*", Observed("cuts", "moment about the line")),
    ("strength.tipping_margin", Observed("cuts", "tipping margin")),
    ("strength.critical_loads.first_foot.load", Observed("loads", "lifts a foot")),
    ("strength.critical_loads.tipping.load", Observed("loads", "load that tips")),
    ("strength.critical_factor.linearised", Observed("loads", "factor by the stiffness")),
    ("strength.critical_factor.followed.factor", Observed("loads", "crane rests")),
    ("strength.second_order.factor", LeftOut("the ratio of both orders")),
    ("strength.second_order.*", Observed("loads", "by the first order")),
    ("strength.loads.*", Checked("every body is in balance")),
    ("strength.sections.x", LeftOut("places, whose stresses are compared one by one")),
    ("strength.sections.*", Checked("places along beams are those of diagrams, and pads make them jump")),
    ("strength.combinations.*", Checked("combinations and their factors written out")),
    ("strength.worst_cases.*", LeftOut("the least and the greatest of what `combinations` has")),
    ("strength.*_of_the_run", Observed("run", "stress")),
    (
        "strength.extremes_of_loads.*",
        LeftOut("extremes of forces at results, which follow from states that are compared"),
    ),
    (
        "strength.extremes_of_sections.*",
        LeftOut("extremes of forces at results, which follow from states that are compared"),
    ),
    ("strength.time_of_*", LeftOut("times of extremes, which jump between equal ones")),
    // Charts.
    ("envelope.beside_the_given_chart*", LeftOut("what is given beside loads that are compared")),
    ("envelope.limits.*", LeftOut("what is given")),
    ("envelope.parameters", LeftOut("what is given")),
    ("envelope.*.load", Observed("loads", "load of a chart")),
    ("envelope.load_chart.*", Checked("poses of charts are those of statics")),
    ("envelope.loads_by_place.*", Checked("poses of charts are those of statics")),
    ("envelope.governing.poses", LeftOut("how many poses have what they have")),
    ("envelope.governing.*", Observed("loads", "governed by")),
    ("envelope.*.radius", Observed("loads", "radius of a chart")),
    ("envelope.*.height", Observed("loads", "height of a chart")),
    ("*.poses", LeftOut("how many there are")),
    ("poses.poses.*", LeftOut("from positions of points, which are compared")),
    ("poses.stable_poses", LeftOut("how many rows have what they have")),
    ("*.count", LeftOut("how many there are")),
    // Runs.
    ("*.extremes.error", LeftOut("estimates, which tests compare with tighter runs")),
    ("*.extremes.missed", LeftOut("estimates, which tests compare with tighter runs")),
    ("*.extremes.time_of_*", LeftOut("times of extremes, which jump between equal ones")),
    ("*.extremes.m*", Observed("run", "at 0.200 s")),
    ("*.summary.value", Checked("energy balance of a run")),
    ("*.duties.*", Observed("run", "_drive_")),
    ("*.cylinder_duties.*", LeftOut("extremes of forces, pressures and lengths at results, which are compared")),
    ("drives.parts.*", LeftOut("quotients of duties and what a list has")),
    ("factors.tabulated.*", LeftOut("from a table, without a crane")),
    ("fatigue.manoeuvres.repetitions", LeftOut("what is given")),
    ("fatigue.manoeuvres.*", Observed("run", "by cycles of stress")),
    ("*.events.*", Checked("events and runs in two parts")),
    ("factors.factors.*_at_rest", Observed("rest", "at rest as at")),
    ("factors.factors.m*", Observed("run", "at 0.200 s")),
    ("factors.factors.time_of_*", LeftOut("times of extremes, which jump between equal ones")),
    ("factors.factors.factor", LeftOut("the quotient of numbers that are compared")),
    ("factors.greatest_factor", LeftOut("the quotient of numbers that are compared")),
    ("factors.tabulated_factor", LeftOut("from a table, without a crane")),
    ("fatigue.greatest_range", Observed("run", "by cycles of stress")),
    ("fatigue.greatest_damage", Observed("run", "by cycles of stress")),
    ("fatigue.fatigue.category", LeftOut("what is given")),
    ("fatigue.fatigue.x", LeftOut("places, whose stresses are compared one by one")),
    ("fatigue.fatigue.*", Observed("run", "by cycles of stress")),
    ("fatigue.cycles.*", Observed("run", "by cycles of stress")),
    ("fatigue.history_parameter", LeftOut("a sum over cycles, from whose ranges the damage is, too")),
    ("fatigue.life", LeftOut("the inverse of the damage")),
    ("fatigue.change_with_half_of_the_results", LeftOut("an estimate of the interval of results")),
    ("fatigue.time_of_*", LeftOut("times of extremes, which jump between equal ones")),
    ("simulate.steps", LeftOut("how a solution is found differs between descriptions")),
    ("simulate.rejected_steps", LeftOut("how a solution is found differs between descriptions")),
    ("simulate.evaluations", LeftOut("how a solution is found differs between descriptions")),
    ("simulate.factorisations", LeftOut("how a solution is found differs between descriptions")),
    ("*.step", LeftOut("what is given, or found from `stability`, which is compared")),
    ("*.tolerance", LeftOut("what is given")),
    ("ensemble.threads", LeftOut("what is given")),
    ("ensemble.cranes", LeftOut("how many there are")),
    ("ensemble.reached_the_end", Checked("runs of a fleet")),
    ("ensemble.kept_from_before", LeftOut("how many rows a file has")),
    ("ensemble.cranes_per_second", LeftOut("wall time")),
    ("ensemble.real-time_factor", LeftOut("wall time")),
    ("*.wall_time", LeftOut("wall time")),
    // Sensitivity.
    ("sensitivity.changes.derivative", Checked("changes with live numbers")),
    ("sensitivity.changes.error", LeftOut("an estimate, of numbers that cannot be live")),
    ("sensitivity.changes.*", LeftOut("a derivative times a step")),
    ("sensitivity.change", LeftOut("what is given")),
    ("sensitivity.duration", LeftOut("what is given")),
    ("sensitivity.parameters.influence", LeftOut("the largest of its changes")),
    ("sensitivity.parameters.*", LeftOut("what is given")),
    ("sensitivity.outputs.value", Checked("changes with live numbers")),
    ("sensitivity.largest_load.load", Observed("loads", "load of a chart")),
    ("sensitivity.largest_load.*", LeftOut("from positions of points, which are compared")),
    // What a spec says.
    ("info.*", LeftOut("what the spec says: the check of numbers that are set compares descriptions")),
    ("check.*", LeftOut("lines and counts of a text")),
    ("list.*", LeftOut("shipped cranes")),
];

/// Whether a path is one of a pattern.
fn fits(pattern: &str, path: &str) -> bool {
    match (pattern.chars().next(), path.chars().next()) {
        (None, end) => end.is_none(),
        (Some('*'), _) => {
            (0..=path.len()).any(|from| path.is_char_boundary(from) && fits(&pattern[1..], &path[from..]))
        }
        (Some('?'), Some(letter)) => fits(&pattern[1..], &path[letter.len_utf8()..]),
        (Some(own), Some(letter)) => own == letter && fits(&pattern[own.len_utf8()..], &path[letter.len_utf8()..]),
        (Some(_), None) => false,
    }
}

/// Paths of numbers, truth values and cautions of a part of a schema.
fn numbers(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    let kinds = |schema: &Value| match &schema["type"] {
        Value::String(kind) => vec![kind.clone()],
        kinds => kinds.as_array().into_iter().flatten().filter_map(Value::as_str).map(str::to_owned).collect(),
    };
    let is_number = |kind: &String| ["number", "integer", "boolean"].contains(&kind.as_str());
    if kinds(schema).iter().any(is_number) || path.ends_with(".cautions") {
        found.insert(path.to_owned());
    }
    for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
        numbers(inner, &format!("{path}.{key}"), found);
    }
    let within = ["items", "additionalProperties"].iter().filter_map(|key| schema.get(key));
    let forms = ["anyOf", "oneOf"].iter().flat_map(|forms| schema[forms].as_array().into_iter().flatten());
    for inner in within.chain(forms) {
        numbers(inner, path, found);
    }
}

#[test]
fn everything_that_is_printed_is_compared() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../apps/cli/schemas");
    let mut printed = BTreeSet::new();
    for file in fs::read_dir(folder).expect("a folder").map(|file| file.expect("a file").path()) {
        let command = file.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let schema: Value = serde_json::from_str(&fs::read_to_string(&file).expect("a schema")).expect("JSON");
        numbers(&schema, command, &mut printed);
    }
    let of = |path: &str| OUTPUTS.iter().position(|(pattern, _)| fits(pattern, path));
    let (taken, missing): (Vec<_>, Vec<_>) = printed.iter().partition(|path| of(path).is_some());
    assert!(missing.is_empty(), "neither compared nor left out: {missing:#?}");
    let used: BTreeSet<usize> = taken.into_iter().filter_map(|path| of(path)).collect();
    let idle: Vec<&str> = (0..OUTPUTS.len()).filter(|row| !used.contains(row)).map(|row| OUTPUTS[row].0).collect();
    assert!(idle.is_empty(), "nothing is printed as {idle:#?}");
}

/// Cranes that together have what is said to be observed.
const SEEDS: [u64; 6] = [700, 701, 703, 706, 709, 712];

#[test]
fn what_is_said_to_be_compared_is() {
    let extent = Extent { run: true, searches: true };
    let observed: BTreeSet<String> = SEEDS
        .into_iter()
        .filter_map(|seed| observe(&source(&crane(seed).tree), extent).ok())
        .flat_map(BTreeMap::into_keys)
        .collect();
    let checks = names();
    for (pattern, taken) in OUTPUTS {
        match taken {
            Observed(group, part) => {
                let is_it = |name: &String| name.strip_prefix(group).is_some_and(|name| name.contains(part));
                assert!(observed.iter().any(is_it), "{pattern}: no number of {group} has `{part}` in its name");
            }
            Checked(name) => assert!(checks.contains(name), "{pattern}: there is no check `{name}`"),
            LeftOut(why) => assert!(!why.is_empty()),
        }
    }
}
