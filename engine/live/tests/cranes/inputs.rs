//! Inputs: numbers that are set between steps.

use crane_model::StateAt;
use crane_model::statics::Problem;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::{Hold, LiveCrane, SteeredMotion};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{self, InitialState, Method, Sample, Settings, Watch};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A boom whose drive follows one input, offset by another, with a load scaled by a third.
fn steered(inputs: &str, motion: &str, more: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: steered\n{inputs}links:\n\
         - {{name: boom, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: 200, com: [2, 0, 0], inertia: {{gyration: [0.1, 1, 1]}}}}\n\
         - {{name: load, placement: {{transform: {{translation: [4, 0, 0]}}}}, joint: revolute, mass: 80, com: [0, -1, 0]}}\n\
         drives:\n- {{coordinate: boom_psi, stiffness: 2e5, damping: 2e4, motion: {motion}}}\n{more}"
    ))
}

const RAMP: &str = "{quintic: {from: 0, to: 60 deg, begin: 0.2, duration: 3}}";

/// Drive, offset and load given by inputs, the first of which follows a motion.
fn with_inputs() -> LiveCrane {
    steered(
        &format!(
            "inputs:\n  lever: {{motion: {RAMP}, unit: rad}}\n  trim: {{value: 0.1, unit: rad}}\n  gust: {{unit: N}}\n"
        ),
        "{input: lever}, offset: trim",
        "loads: [{name: wind, link: boom, at: [4, 0, 0], force: [0, 1, 2], scale: {input: gust}}]\n",
    )
}

/// Quantities that depend on inputs, at a time and a state.
fn numbers(crane: &LiveCrane, t: f64) -> Vec<f64> {
    let crane: &dyn DynCrane = crane;
    let (q, v) = ([0.3, -0.5], [0.2, 0.4]);
    let mut all = crane.accelerations_at(t, &q, &v).as_slice().to_vec();
    all.extend(crane.drive_efforts_at(t, &q, &v));
    all.extend(crane.drive_motions_at(t).concat());
    all.extend([crane.energies_at(t, &q, &v).total(), crane.drive_power(t, &q, &v), crane.load_power(t, &q, &v)]);
    all.extend(crane.internal_forces_at(t, &q, &v, &v).iter().flat_map(|wrench| wrench.force.data.0[0]));
    all.extend(Problem::new(crane).at_time(t).from(&q).solve().q);
    all
}

fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (value, expected) in found.iter().zip(expected) {
        // Sums are in another order; the equilibrium is accurate to 1e-10 of the forces.
        assert!((value - expected).abs() <= 1e-11 * expected.abs().max(1.0), "{value} instead of {expected}");
    }
}

/// Until it is set, an input is what the spec says.
#[test]
fn an_input_that_is_not_set_follows_its_spec() {
    let crane = with_inputs();
    let written = steered("inputs: {trim: {value: 0.1}}\n", &format!("{RAMP}, offset: trim"), "");
    for t in [0.0, 1.1, 5.0] {
        assert_close(&numbers(&crane, t), &numbers(&written, t));
    }
    let described: Vec<_> =
        crane.description().inputs.iter().map(|input| (input.name.as_str(), input.default)).collect();
    assert_eq!(described, [("lever", None), ("trim", Some(0.1)), ("gust", Some(0.0))]);
}

/// An input that is set behaves like a spec with that constant value; released again, it is as before.
#[test]
fn an_input_that_is_set_is_a_number() {
    let mut crane = with_inputs();
    let before = numbers(&crane, 1.1);
    let held = steered("", "{hold: 0.52}", "loads: [{name: wind, link: boom, at: [4, 0, 0], force: [0, 300, 600]}]\n");
    let all: &mut dyn DynCrane = &mut crane;
    for (index, value) in [0.5, 0.02, 300.0].into_iter().enumerate() {
        assert_eq!(all.input(index), None);
        all.set_input(index, Some(value));
        assert_eq!(all.input(index), Some(value));
    }
    all.set_input(7, Some(1.0));
    assert_eq!(all.input(7), None);
    assert_close(&numbers(&crane, 1.1), &numbers(&held, 1.1));
    // A clone has them, too; a sibling has its own.
    assert_eq!(crane.clone().input(2), Some(300.0));
    let sibling = crane.with_inputs(&[None, None, None]);
    assert_eq!(numbers(&sibling, 1.1), before);
    assert_close(&numbers(&crane, 1.1), &numbers(&held, 1.1));
    for index in 0..3 {
        DynCrane::set_input(&mut crane, index, None);
    }
    assert_eq!(numbers(&crane, 1.1), before);
}

/// Keeps the end of a run.
struct Last(InitialState);

impl Watch for Last {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.0 = InitialState { q: sample.q.to_vec(), v: sample.v.to_vec(), ..InitialState::default() };
        ControlFlow::Continue(())
    }
}

/// A mass on a spring whose far end jumps from step to step: between two jumps it swings about where the spring rests, whatever the
/// method, since every run starts from the state alone.
#[test]
fn a_controller_sets_inputs_between_steps() {
    let mut slide = crane(
        "format: 1\nname: slide\ngravity: [0, 0, 0]\ninputs: {lever: {unit: m}}\n\
         links: [{name: slide, joint: {prismatic: {axis: x}}, mass: 4, com: [0, 0, 0]}]\n\
         drives: [{coordinate: slide_x, stiffness: 100, motion: {input: lever}}]\n",
    );
    let omega = 5.0_f64;
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince] {
        let of_spec = Settings::from_description(slide.description());
        let settings = Settings { method, tolerance: 1e-9, duration: 0.3, output: 0.3, ..of_spec };
        let mut state = InitialState { q: vec![0.0], v: vec![0.0], ..InitialState::default() };
        let (mut x, mut v) = (0.0, 0.0);
        for (step, lever) in [0.5, -0.2, 0.9, 0.1, 0.4].into_iter().enumerate() {
            DynCrane::set_input(&mut slide, 0, Some(lever));
            let mut last = Last(state.clone());
            dynamics::Simulation::new(&slide, &state, &settings)
                .at_time(0.3 * step as f64)
                .watch(&mut last)
                .expect("it runs");
            state = last.0;
            let (sin, cos) = (omega * 0.3).sin_cos();
            (x, v) = (lever + (x - lever) * cos + v / omega * sin, v * cos - (x - lever) * omega * sin);
        }
        let off = (state.q[0] - x).abs().max((state.v[0] - v).abs());
        // A few hundred steps with errors of 1e-9.
        assert!(off < 2e-6, "{method}: off by {off:.1e}");
    }
}

/// A motion that is made again from its memory goes on with the same bits, also with another crane of the same spec; one of another size, or
/// cut short, is refused.
#[test]
fn a_motion_goes_on_from_its_memory() {
    let crane = with_inputs();
    let start = InitialState { q: vec![0.1, -0.1], v: vec![0.0, 0.2], x: Vec::new() };
    let settings = Settings { method: Method::Bdf, ..Settings::from_description(crane.description()) };
    let mut motion = SteeredMotion::new(&crane, 0.0, &start, &settings, None).expect("it begins");
    let on = |motion: &mut SteeredMotion, pull: f64| -> Vec<f64> {
        let changes = [(1, Some(0.2)), (2, Some(pull))];
        let _ = motion.advance(0.25, changes, Hold::Linear, &mut |_| ControlFlow::Continue(())).expect("it goes on");
        let StateAt { q, v, .. } = motion.sample().state;
        [q, v].concat()
    };
    on(&mut motion, 300.0);
    let memory = motion.memory();
    let mut again = SteeredMotion::recalled(&with_inputs(), &settings, &memory).expect("it is of this crane");
    assert_eq!(on(&mut again, -100.0), on(&mut motion, -100.0));
    assert!(SteeredMotion::recalled(&crane, &settings, &memory[..memory.len() - 1]).is_none());
    let mut other = memory.clone();
    other[1] = 0.5;
    assert!(SteeredMotion::recalled(&crane, &settings, &other).is_none(), "half a state");
}
