//! Servos: those that are named as unstable, and their stable gains, against the eigenvalues of the crane whose spec has these gains.

use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::modes::{UnstableServo, unstable_servos, with_servos};
use fastrand::Rng;
use serde_json::json;

use crate::observe::{equilibrium, live};
use crate::tree::{Tree, source};

/// The name of the check.
pub const NAME: &str = "servos and their stable gains";
/// Far below every gain that matters: the crane without its servos.
const NONE: f64 = 1e-9;
/// A gain is stable this much below its limit and not this much above it: the limit is found to some thousandths.
const BESIDE: f64 = 0.02;
/// Growth of an oscillation, 1/s, beyond rounding and drift.
const GROWS: f64 = 1e-2;
/// Slower than this, 1/s, a growing motion sinks or slides.
const OSCILLATES: f64 = 0.1;

/// What is wrong with a crane whose servos have some gains; `None` for a crane without servos, or that does not rest.
pub fn check_servos(tree: &Tree, seed: u64) -> Option<Vec<String>> {
    let mut rng = Rng::with_seed(seed);
    let mut own = tree.clone();
    let servos = gains(&own);
    if servos.is_empty() {
        return None;
    }
    for (cylinder, _) in servos {
        let valve = &mut own["cylinders"][cylinder]["valve"];
        valve["gain"] = json!(10f64.powf(3.0 * rng.f64()));
        // With much leakage the crane sinks by itself, which the servos cannot help.
        valve["leakage"] = json!(1e-13 * 10f64.powf(1.5 * rng.f64()));
    }
    let crane = live(&source(&own)).ok()?;
    let q = equilibrium(&crane).ok()?;
    let named = unstable_servos(&crane, 0.0, &q).ok()?;
    let mut wrong = Vec::new();
    if named.is_empty() {
        let without = scaled(&own, |_| NONE).and_then(|crane| oscillation(&crane, &q));
        // What grows without servos is not theirs.
        if let (Some(grows), true) = (oscillation(&crane, &q), without.is_none()) {
            wrong.push(format!("an oscillation grows by {grows:.3e} 1/s, and no servo is named"));
        }
        return Some(wrong);
    }
    let factor = |beside: f64| {
        let gains = gains(&own);
        let named: Vec<(usize, f64)> = named.iter().map(|servo| (servo.cylinder, servo.gain)).collect();
        move |cylinder: usize| {
            let found = named.iter().find(|(other, _)| *other == cylinder);
            let gain = gains.iter().find(|(other, _)| *other == cylinder).map_or(1.0, |(_, gain)| *gain);
            found.map_or(1.0, |(_, stable)| beside * stable / gain)
        }
    };
    let again =
        |beside: f64| -> Option<Vec<UnstableServo>> { unstable_servos(&scaled(&own, factor(beside))?, 0.0, &q).ok() };
    if let Some(still) = again(1.0 - BESIDE).filter(|still| !still.is_empty()) {
        wrong.push(format!("below their stable gains, {still:?} are named; {named:?}"));
    }
    if again(1.0 + BESIDE).is_some_and(|still| still.is_empty()) {
        wrong.push(format!("above their stable gains, no servo is named; {named:?}"));
    }
    Some(wrong)
}

/// How fast the fastest oscillation grows with valves slightly open, 1/s; `None` if none does.
fn oscillation(crane: &LiveCrane, q: &[f64]) -> Option<f64> {
    let modes = with_servos(crane as &dyn DynCrane, 0.0, q).ok()?.modes().ok()?;
    let growing = modes.iter().map(|mode| mode.eigenvalue).filter(|value| value.im.abs() > OSCILLATES);
    growing.map(|value| value.re).filter(|growth| *growth > GROWS).max_by(f64::total_cmp)
}

/// Cylinders with a servo, by their indices, and its gain.
fn gains(tree: &Tree) -> Vec<(usize, f64)> {
    let cylinders = tree["cylinders"].as_array().into_iter().flatten().enumerate();
    cylinders.filter_map(|(index, cylinder)| Some((index, cylinder["valve"]["gain"].as_f64()?))).collect()
}

/// The crane with its gains times a factor, by the index of the cylinder.
fn scaled(tree: &Tree, factor: impl Fn(usize) -> f64) -> Option<LiveCrane> {
    let mut changed = tree.clone();
    for (cylinder, gain) in gains(tree) {
        changed["cylinders"][cylinder]["valve"]["gain"] = json!(gain * factor(cylinder));
    }
    let crane = live(&source(&changed)).ok()?;
    (crane.size() > 0).then_some(crane)
}
