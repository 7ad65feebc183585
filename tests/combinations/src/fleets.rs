//! Runs of eight cranes as one against those of each crane alone.

use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::Settings;
use crane_model::runs::ensemble::{Case, Execution, Outcome, run_ensemble};
use fastrand::Rng;

use crate::descriptions::numbers_as_parameters;
use crate::observe::{equilibrium, live};
use crate::tree::Tree;

/// The name of the check.
pub const NAME: &str = "runs of a fleet";
const CRANES: usize = 8;
/// Length of the run, its interval of results, and initial rates, s, m/s and rad/s.
const RUN: [f64; 3] = [0.3, 0.05, 0.05];
/// How much parameters change from crane to crane.
const CHANGE: f64 = 2e-3;
/// Tolerance of runs, m and rad, and how far poses and rates may differ: their steps do.
const TOLERANCE: f64 = 1e-8;
const ALLOWED: f64 = 1e4 * TOLERANCE;
/// With more steps it is not worth the time.
const MOST_STEPS: usize = 20_000;

/// What is different; `None` for a crane without fleets, or which does not stand, or whose runs end early.
pub fn check_fleets(tree: &Tree, seed: u64) -> Option<Vec<String>> {
    let mut rng = Rng::with_seed(seed);
    let tree = without_valves(tree);
    let crane = live(&numbers_as_parameters(&tree, &mut rng)?.source).ok()?;
    crane.fleet(&[&crane])?;
    let q = equilibrium(&crane).ok()?;
    let mut row = || {
        let mut changed = crane.clone();
        for (index, value) in crane.parameters().iter().enumerate() {
            // Those that may not change stay as they are.
            let _ = changed.set_parameter(index, value * (1.0 + CHANGE * (2.0 * rng.f64() - 1.0)));
        }
        let v = q.iter().map(|_| RUN[2] * (2.0 * rng.f64() - 1.0)).collect();
        let q = Some(q.iter().map(|q| q + 1e-3 * (2.0 * rng.f64() - 1.0)).collect());
        Case { q, v: Some(v), ..Case::from(changed.parameters().to_vec()) }
    };
    let rows: Vec<Case> = (0..CRANES).map(|_| row()).collect();
    let settings = Settings {
        duration: RUN[0],
        output: RUN[1],
        audit: false,
        most_steps: MOST_STEPS,
        tolerance: TOLERANCE,
        ..Settings::from_description(crane.description())
    };
    let execution = Execution { threads: 1, done: &|_, _| {}, cancelled: &|_| false };
    let run = |rows: &[Case]| run_ensemble(&crane, rows, &settings, &execution);
    let alone: Vec<Outcome> = rows.chunks(1).flat_map(run).collect();
    if alone.iter().any(|outcome| outcome.run.is_err()) {
        return None;
    }
    let mut wrong = Vec::new();
    for (lane, (together, alone)) in run(&rows).iter().zip(&alone).enumerate() {
        if let Err(reason) = &together.run {
            wrong.push(format!("crane {lane} of the fleet: {reason}"));
        }
        let coordinates = &crane.description().coordinates;
        for (part, [together, alone]) in
            [("", [&together.end.q, &alone.end.q]), ("rate of ", [&together.end.v, &alone.end.v])]
        {
            for ((info, together), alone) in coordinates.iter().zip(together).zip(alone) {
                let off = (together - alone).abs() / (1.0 + alone.abs());
                if off > ALLOWED || off.is_nan() {
                    wrong.push(format!(
                        "crane {lane}, {part}{}: {together:.9e} in a fleet, {alone:.9e} alone",
                        info.name
                    ));
                }
            }
        }
    }
    Some(wrong)
}

/// A crane without what fleets do not have.
fn without_valves(tree: &Tree) -> Tree {
    let mut tree = tree.clone();
    let cylinders = tree.get_mut("cylinders").and_then(Tree::as_array_mut).into_iter().flatten();
    cylinders.filter_map(Tree::as_object_mut).for_each(|cylinder| drop(cylinder.remove("valve")));
    tree
}
