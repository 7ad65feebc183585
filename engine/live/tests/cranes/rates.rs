//! Derivatives of the rates of a motion at one moment, against differences, and forward against back.

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_live::sensitivity::runs::{Change, pull_rates, push_rates};
use crane_model::StateAt;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::force_states::{self, ForceStates};

fn shipped(name: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    LiveCrane::from_spec(&build::open(path.as_ref()).unwrap()).unwrap()
}

/// A four-bar whose drive follows an input; another is a torque, a third scales the force on its coupler.
const BARS: &str = "format: 1
name: bars
inputs: {push: {value: 30, unit: N}, torque: {unit: N m}, lever: {value: 1.1, unit: rad}}
links:
  - {name: crank, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 30, com: [0.2, 0, 0], inertia: {gyration: [0.1, 0.1, 0.1]}}
  - {name: coupler, placement: {transform: {translation: [0.4, 0, 0]}}, joint: revolute, mass: 80, com: [0.5, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}
  - {name: rocker, placement: {transform: {translation: [1.1, 0, 0]}}, joint: revolute, mass: 60, com: [0.4, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}
LOOP
drives:
  - {coordinate: crank_psi, stiffness: 4e3, damping: 60, effort: {input: torque}, motion: {input: lever}}
loads: [{name: pull, link: coupler, at: [0.5, 0, 0], force: [0, 0, 1], scale: {input: push}}]
";

fn bars(joint: &str) -> LiveCrane {
    let text = BARS.replace("LOOP", joint);
    LiveCrane::from_spec(&SourceFile::new("bars.yaml", &text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

const CLOSED: &str = "loop_joints: [{name: hinge, from: {at: [1.2, 0, 0]}, to: {link: rocker, at: [0.9, 0, 0]}, joint: {slide: {axis: [0, 1, 0]}}}]";

/// Numbers between −1 and 1, the same on every run.
fn numbers(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|index| (12.9898 * index as f64 + 78.233 * seed).sin()).collect()
}

/// The rates `[q̇, q̈, ẋ]`.
fn rates(crane: &LiveCrane, t: f64, motion: &[f64]) -> Vec<f64> {
    let n = crane.size();
    let ([q, v], x) = ([&motion[..n], &motion[n..2 * n]], &motion[2 * n..]);
    let (accelerations, of_states) = force_states::accelerations(crane, &StateAt { t, q, v, x });
    [v, &accelerations, &of_states].concat()
}

#[test]
fn derivatives_of_rates_are_those_of_differences_forward_and_back() {
    let mut all: Vec<(String, LiveCrane)> =
        ["knuckle_boom", "loader_tipping", "eight_link_rigid", "eight_link_hydraulic", "two_arms"]
            .map(|name| (name.to_owned(), shipped(name)))
            .into();
    all.extend([("open bars".to_owned(), bars("")), ("closed bars".to_owned(), bars(CLOSED))]);
    for (name, crane) in all {
        let (n, t, inputs) = (crane.size(), 0.7, crane.description().inputs.len());
        let mut states = ForceStates::new(crane.description());
        let mut q: Vec<f64> =
            (&crane as &dyn DynCrane).guess().iter().zip(numbers(n, 1.0)).map(|(q, x)| q + 0.02 * x).collect();
        let mut v: Vec<f64> = numbers(n, 2.0).iter().map(|v| 0.1 * v).collect();
        (&crane as &dyn DynCrane).prescribe(t, &mut q, &mut v);
        let mut x = states.holding(&crane, t, &q);
        let scales = states.scales();
        x.iter_mut().zip(&scales).zip(numbers(scales.len(), 3.0)).for_each(|((x, scale), by)| *x += 0.05 * scale * by);
        let motion = [q, v, x].concat();
        let mut along = numbers(motion.len(), 4.0);
        along[2 * n..].iter_mut().zip(&scales).for_each(|(along, scale)| *along *= scale);
        let of_inputs = numbers(inputs, 5.0);
        // Among others, which do not matter.
        let change = |by: f64| Change {
            motion: along.iter().map(|x| by * x).collect(),
            inputs: of_inputs.iter().map(|x| by * x).collect(),
        };
        let mut all =
            push_rates(&crane, (t, &motion), &(0..10).map(|k| change(f64::from(k - 8))).collect::<Vec<_>>()).unwrap();
        let found = all.swap_remove(9);

        let beside = |step: f64| {
            let mut crane = crane.clone();
            for (index, change) in of_inputs.iter().enumerate() {
                let value = crane.input(index).unwrap_or(crane.input_start(index));
                crane.set_input(index, Some(value + step * change));
            }
            let moved: Vec<f64> = motion.iter().zip(&along).map(|(x, along)| x + step * along).collect();
            rates(&crane, t, &moved)
        };
        let difference = |h: f64| -> Vec<f64> {
            beside(h).iter().zip(beside(-h)).map(|(more, less)| (more - less) / (2.0 * h)).collect()
        };
        // Without the error of second order; rounding leaves 1e-9.
        let expected = difference(1e-5).into_iter().zip(difference(2e-5)).map(|(near, far)| (4.0 * near - far) / 3.0);
        let sizes = |place: usize| match place.checked_sub(2 * n) {
            None => found[..2 * n].iter().fold(0.0, |size: f64, x| size.max(x.abs())),
            Some(state) => {
                found[2 * n..].iter().zip(&scales).fold(0.0, |size: f64, (x, scale)| size.max((x / scale).abs()))
                    * scales[state]
            }
        };
        for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
            let off = (found - expected).abs() / sizes(place);
            assert!(off < 1e-7, "{name}, {place}: {found} for {expected}, off by {off:e}");
        }

        let weights: Vec<f64> =
            numbers(motion.len(), 6.0).iter().enumerate().map(|(place, w)| w / sizes(place)).collect();
        let Change { motion: by_motion, inputs: by_inputs } =
            pull_rates(&crane, (t, &motion), &weights).unwrap().unwrap();
        let times = |one: &[f64], other: &[f64]| -> Vec<f64> { one.iter().zip(other).map(|(a, b)| a * b).collect() };
        let back = [times(&by_motion, &along), times(&by_inputs, &of_inputs)].concat();
        let (forward, back) = (times(&weights, &found).iter().sum::<f64>(), back);
        let size = back.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let off = (forward - back.iter().sum::<f64>()).abs() / size;
        assert!(off < 1e-12, "{name}: {forward} forward, {} back, off by {off:e}", back.iter().sum::<f64>());
    }
}
