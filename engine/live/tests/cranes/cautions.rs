//! Cautions of runs: of ensembles, servos that fall behind, drives that are too weak.

use std::ops::ControlFlow;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::Functions;
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::results::{Extremes, Peaks, cautions};
use crane_model::runs::ensemble::{self, Execution};
use crane_model::runs::{Start, record_checked};

fn shipped(name: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    LiveCrane::from_spec(&source).unwrap()
}

fn spec(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn cautions_of_run(crane: &LiveCrane, settings: &Settings) -> Vec<String> {
    let start = Start::new(crane).unwrap_or_else(|failed| panic!("{failed}"));
    let check = (false, cautions::BEND);
    let recorded = record_checked(crane, &start, settings, check, &mut |_| ControlFlow::Continue(()));
    recorded.unwrap_or_else(|failed| panic!("{failed}")).cautions
}

/// Feet that lift, pumps and pressures: a row of an ensemble has the same cautions and extremes as a run of its crane.
#[test]
fn ensembles_have_the_cautions_and_extremes_of_single_runs() {
    for name in ["eight_link_hydraulic", "loader_tipping"] {
        let crane = shipped(name);
        let settings = Settings { duration: 6.5, audit: false, ..Settings::from_description(crane.description()) };
        let single = cautions_of_run(&crane, &settings);
        assert!(!single.is_empty(), "{name}");
        let execution = Execution { threads: 1, done: &|_, _| (), cancelled: &|_| false };
        let rows = ensemble::run_ensemble(&crane, &[crane.parameters().to_vec().into()], &settings, &execution);
        assert_eq!(rows[0].cautions, single, "{name}");

        let start = Start::new(&crane).expect("it rests");
        let table = crane_model::runs::record(&crane, &start, &settings, &mut |_| ControlFlow::Continue(()))
            .expect("a run")
            .table;
        let columns = Peaks::columns(&crane);
        let values: Vec<f64> = rows[0].peaks.as_ref().expect("peaks").values().collect();
        assert_eq!(columns.len(), values.len());
        let mut pressures = 0;
        for (column, value) in columns.iter().zip(values) {
            let Some(of) = column.name.strip_suffix("_max") else { continue };
            let Extremes { maximum, .. } = Extremes::of_column(&table, of);
            assert_eq!(value, maximum, "{name}: {of}");
            pressures += usize::from(of.ends_with("_pressure"));
        }
        assert_eq!(pressures, if name == "eight_link_hydraulic" { 7 } else { 0 });
    }
}

/// An ensemble reports a drive at its limit, too: it records the rates of drives alone.
#[test]
fn ensembles_know_drives_at_their_limits() {
    let crane = spec(
        "format: 1\nname: weak\nlinks: [{name: hook, joint: {prismatic: {axis: z}}, mass: 100, com: [0, 0, 0]}, \
         {name: bob, joint: {revolute: {axis: y}}, mass: 5, com: [0, 0, -1]}]\n\
         drives: [{coordinate: hook_z, stiffness: 1e5, damping: 1e3, max_effort: 1300, motion: {quintic: {from: 0, to: 1, duration: 0.6}}}]\n",
    );
    let settings = Settings { duration: 1.0, audit: false, ..Settings::from_description(crane.description()) };
    let single = cautions_of_run(&crane, &settings);
    assert!(single.iter().any(|caution| caution.contains("1300")), "{single:?}");
    let execution = Execution { threads: 1, done: &|_, _| (), cancelled: &|_| false };
    let rows = ensemble::run_ensemble(&crane, &[crane.parameters().to_vec().into()], &settings, &execution);
    assert_eq!(rows[0].cautions, single);
}

/// A mass that a cylinder lifts, with a nominal valve flow and the keys of its servo.
fn lift(flow: f64, servo: &str) -> LiveCrane {
    spec(&format!(
        "format: 1
name: lift
links:
  - {{name: post, mass: 50, com: [0, 0, 0], joint: {{prismatic: {{axis: x}}}}}}
  - {{name: slide, joint: {{prismatic: {{axis: z}}}}, mass: 400, com: [0, 0, 0]}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: slide_z, stiffness: 1e8, motion: {{quintic: {{from: 0, to: 0.4, duration: 2}}}}}}
cylinders:
  - {{name: ram, coordinate: slide_z, foot: {{link: post, at: [0, 0, -0.8]}}, head: {{link: slide, at: [0, 0, 0]}},
     bore: 0.08, rod: 0.05, retracted: 0.75, stroke: 0.6, back_pressure: 4e5, max_pressure: 2.5e7, bulk_modulus: 1.2e9,
     hose_volumes: [5e-4, 5e-4], valve: {{flow: {flow}, pressure_drop: 1e6, lag: 0.03, {servo}}}}}
pump: {{max_flow: 4e-3, pressure: 2e7}}
run: {{duration: 3, output: 0.01}}
"
    ))
}

/// Without feed-forward a servo falls behind by v/(K gain), with K the speed at the fully open valve, here by much more than a twentieth
/// of the motion; with feed-forward it hardly does.
#[test]
fn a_servo_that_stays_behind_gets_a_caution() {
    let behind = |crane: &LiveCrane| {
        let all = cautions_of_run(crane, &Settings::from_description(crane.description()));
        all.into_iter().find(|caution| caution.starts_with("ram falls behind"))
    };
    let text = behind(&lift(1e-3, "gain: 2, feed_forward: 0")).expect("a caution");
    assert!(text.contains("slide_z is up to 0.1") && text.ends_with("its valve is never fully open"), "{text}");
    let text = behind(&lift(1e-5, "gain: 10, feed_forward: 0")).expect("a caution");
    assert!(text.contains("its valve is fully open for"), "{text}");
    assert_eq!(behind(&lift(1e-3, "gain: 10")), None);
}

/// If statics fail because a drive cannot carry its load, the message names the drive and what to change.
#[test]
fn statics_that_fail_name_the_drive_that_is_too_weak() {
    let lift = |limit: f64| {
        spec(&format!(
            "format: 1
name: lift
analyses: [statics, dynamics]
links: [{{name: lift, joint: prismatic, mass: 100, com: [0, 0, 0]}}]
drives: [{{coordinate: lift_z, stiffness: 1e5, max_effort: {limit}, motion: {{hold: 0}}}}]
"
        ))
    };
    let failed = Start::new(&lift(500.0)).expect_err("it falls");
    assert!(failed.to_string().ends_with("; the drive of lift_z is at its limit"), "{failed}");
    assert!(failed.advice().starts_with("raise `max_effort`"), "{}", failed.advice());
    // If it can, but only just, a caution says how close it is to its limit: 981 of 985 N.
    let crane = lift(985.0);
    let start = Start::new(&crane).expect("it rests");
    let cautions = cautions::of_pose(&crane, &start.q, cautions::BEND);
    assert!(cautions[0].starts_with("the drive of lift_z is at its limit, 981.0 of 985.0 N"), "{cautions:?}");
}

/// However light a crane is: the energy of a gram that falls is compared with what it exchanges, with steps that are far too long.
#[test]
fn the_energy_balance_of_a_light_crane_is_looked_at() {
    let pendulum = spec(
        "format: 1\nname: light\nlinks: [{name: arm, joint: revolute, mass: 1 g, com: [0.1, 0, 0], placement: {transform: {rotation: {x: 90 deg}}}}]\n\
         guess: {arm_psi: 0.5}\nrun: {duration: 4, step: 0.2, output: 0.2}\n",
    );
    let settings = Settings { method: Method::Rk4, audit: true, ..Settings::from_description(pendulum.description()) };
    let start = Start::given(InitialState::at_rest(vec![0.5]));
    let recorded =
        record_checked(&pendulum, &start, &settings, (false, cautions::BEND), &mut |_| ControlFlow::Continue(()));
    let cautions = recorded.unwrap_or_else(|failed| panic!("{failed}")).cautions;
    assert!(cautions.iter().any(|caution| caution.contains("energy")), "{cautions:?}");
}
