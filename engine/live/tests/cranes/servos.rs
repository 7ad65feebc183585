//! Servos whose loops with the crane are unstable, against Routh's criterion and against runs.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::modes::{UnstableServo, unstable_servos};
use crane_model::results::cautions;
use crane_model::runs::{Start, record_checked};

const MASS: f64 = 800.0;
const DAMPING: f64 = 2e3;
const BORE: f64 = 0.08;
const ROD: f64 = 0.045;
const BULK: f64 = 1.3e9;
const HOSES: [f64; 2] = [6e-4, 4e-4];
const TANK: f64 = 3e5;
const FLOW: f64 = 6e-4;
const DROP: f64 = 1e6;
const LAG: f64 = 0.03;
const PUMP: f64 = 2e7;
/// Extension at rest, and the stroke, m.
const EXTENSION: f64 = 0.3;
const STROKE: f64 = 0.6;

/// A mass with a viscous guide, held on a cylinder along its path by a servo.
fn lift(gain: f64) -> LiveCrane {
    lift_moving(gain, "{hold: 0.1}")
}

fn lift_moving(gain: f64, motion: &str) -> LiveCrane {
    let text = format!(
        "format: 1
name: lift
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - {{name: slide, joint: {{prismatic: {{axis: z}}}}, mass: {MASS}, com: [0, 0, 0]}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: slide_z, stiffness: 1e8, motion: {motion}}}
friction:
  slide_z: {{coulomb: 0, viscous: {DAMPING}}}
cylinders:
  - name: ram
    coordinate: slide_z
    foot: {{link: post, at: [0, 0, -1]}}
    head: {{link: slide, at: [0, 0, 0]}}
    bore: {BORE}
    rod: {ROD}
    retracted: 0.8
    stroke: {STROKE}
    back_pressure: {TANK}
    max_pressure: 2.5e7
    bulk_modulus: {BULK}
    hose_volumes: [{}, {}]
    valve: {{flow: {FLOW}, pressure_drop: {DROP}, lag: {LAG}, gain: {gain}}}
pump: {{max_flow: 1e-3, pressure: {PUMP}, volume: 4e-3}}
analyses: [statics, dynamics, modes]
",
        HOSES[0], HOSES[1]
    );
    LiveCrane::from_spec(&SourceFile::new("lift.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// The largest stable gain, 1/m, and the frequency there, Hz.
///
/// With the spool u, `T u̇ = −g y − u`, and flows `±c u` into both sides, the motion y follows `(M s² + D s + k) s y = h u`, so
/// `T M s⁴ + (M + T D) s³ + (D + T k) s² + k s + h g = 0`.
fn routh() -> [f64; 2] {
    let root = |difference: f64| difference / (difference * difference + 1e10).powf(0.25);
    let (area, ring) = (PI / 4.0 * BORE * BORE, PI / 4.0 * (BORE * BORE - ROD * ROD));
    let volumes = [HOSES[0] + area * EXTENSION, HOSES[1] + ring * (STROKE - EXTENSION)];
    let k = BULK * (area * area / volumes[0] + ring * ring / volumes[1]);
    // Neither side fills: the same drop from the pump to one side as from the other to the tank.
    let pressure = (MASS * 9.81 + ring * (PUMP + TANK)) / (area + ring);
    let slope = FLOW / root(DROP) * 0.5 * (root(PUMP - pressure) + root(pressure - TANK));
    let h = BULK * (area / volumes[0] + ring / volumes[1]) * slope;
    let cubic = MASS + LAG * DAMPING;
    let gain = ((DAMPING + LAG * k) - LAG * MASS * k / cubic) * k / (cubic * h);
    [gain, (k / cubic).sqrt() / TAU]
}

fn unstable(gain: f64) -> Vec<UnstableServo> {
    let crane = lift(gain);
    let crane: &dyn DynCrane = &crane;
    let rest = crane.equilibrium(&crane_model::statics::Settings::default());
    unstable_servos(crane, 0.0, &rest.q).expect("modes")
}

/// The gain is found to 1e-3 by bisection, and the oil under the weight yields by 1e-5 of the extension.
#[test]
fn the_largest_stable_gain_is_that_of_routh() {
    let [limit, frequency] = routh();
    assert_eq!(unstable(0.99 * limit), []);
    for gain in [1.02 * limit, 2.0 * limit, 20.0 * limit] {
        let found = unstable(gain);
        let [servo] = found.as_slice() else { panic!("{gain}: {found:?}") };
        assert!((servo.gain / limit - 1.0).abs() < 3e-3, "{gain}: {} for {limit}", servo.gain);
    }
    let at_the_limit = unstable(1.005 * limit)[0].mode.eigenvalue.im / TAU;
    assert!((at_the_limit / frequency - 1.0).abs() < 3e-3, "{at_the_limit} for {frequency}");
}

/// Peaks of the speed over 4 s from 0.1 mm beside the pose at rest: growth, 1/s, and frequency, Hz, over the third second.
fn measured(gain: f64) -> [f64; 2] {
    let crane = lift(gain);
    let crane: &dyn DynCrane = &crane;
    let mut q = crane.equilibrium(&crane_model::statics::Settings::default()).q;
    q[1] += 1e-4;
    let settings = Settings {
        method: Method::RECOMMENDED,
        duration: 2.5,
        output: 1e-3,
        tolerance: 1e-8,
        ..Settings::from_description(crane.description())
    };
    let mut speeds = Vec::new();
    crane
        .simulate(&InitialState { v: vec![0.0; q.len()], q, x: Vec::new() }, &settings, &mut |sample| {
            speeds.push((sample.t, sample.v[1]));
            ControlFlow::Continue(())
        })
        .expect("a run");
    let peaks: Vec<(f64, f64)> = speeds
        .windows(3)
        .filter(|three| three[1].1 > three[0].1 && three[1].1 >= three[2].1 && three[1].1 > 0.0 && three[1].0 > 1.0)
        .map(|three| three[1])
        .collect();
    let (first, last) = (peaks[0], peaks[peaks.len() - 1]);
    let time = last.0 - first.0;
    [(last.1 / first.1).ln() / time, (peaks.len() - 1) as f64 / time]
}

/// The frequency is that of the run to 2 %. The rate of growth differs by up to a half: the pressures only approach those of a valve that opens
/// now and then, and a valve whose slopes differ in both directions has no exact mean.
#[test]
fn a_run_grows_above_the_largest_stable_gain_and_decays_below_it() {
    let [limit, _] = routh();
    let [decay, _] = measured(0.8 * limit);
    assert!(decay < -0.2, "{decay}");
    let gain = 2.0 * limit;
    let eigenvalue = unstable(gain)[0].mode.eigenvalue;
    let [growth, frequency] = measured(gain);
    assert!((0.5..1.5).contains(&(growth / eigenvalue.re)), "{growth} for {}", eigenvalue.re);
    assert!((frequency / (eigenvalue.im / TAU) - 1.0).abs() < 0.02, "{frequency} for {}", eigenvalue.im / TAU);
}

#[test]
fn the_caution_names_the_servo_and_a_gain_that_is_stable() {
    let crane = lift(300.0);
    let crane: &dyn DynCrane = &crane;
    let rest = crane.equilibrium(&crane_model::statics::Settings::default());
    let caution = cautions::of_servos(crane, 0.0, &rest.q).join("; ");
    assert!(caution.starts_with("servo of ram is unstable with slide at 26.5"), "{caution}");
    assert!(caution.contains("use a `gain` below 140 instead of 300 1/m"), "{caution}");
}

/// A run is as unstable as it ends: the oil is stiffest near an end of the stroke, where it begins.
#[test]
fn the_end_of_a_run_is_looked_at() {
    let moved = lift_moving(160.0, "{table: {times: [0, 1], values: [-0.19, 0.1]}}");
    let crane: &dyn DynCrane = &moved;
    let settings = Settings { duration: 1.0, ..Settings::from_description(crane.description()) };
    let start = Start::new(crane).expect("a start");
    let at_start = crane.equilibrium(&crane_model::statics::Settings::default());
    assert_eq!(unstable_servos(crane, 0.0, &at_start.q).expect("modes"), []);
    let recorded =
        record_checked(crane, &start, &settings, (true, 5.0), &mut |_| ControlFlow::Continue(())).expect("a run");
    let caution = recorded.cautions.join("; ");
    assert!(caution.contains("servo of ram is unstable"), "{caution}");
}

/// Oil leaks past the pistons of a crane with three servos: without them it sinks. This does not hide that two of them make it swing, with gains that are
/// too high; a run with them ends with the crane on two feet.
#[test]
fn a_crane_that_sinks_without_its_servos_may_swing_by_them() {
    let path = format!("{}/../../specs/eight_link_hydraulic.yaml", env!("CARGO_MANIFEST_DIR"));
    let shipped = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    let names = ["boom_cylinder", "outer_boom_cylinder", "telescope_cylinder"];
    let found = |gain: f64| {
        let cylinders: String = names.map(|name| format!("  - {{name: {name}, valve: {{gain: {gain}}}}}\n")).concat();
        let crane = LiveCrane::from_spec(&shipped.changed(&format!("cylinders:\n{cylinders}"))).expect("a crane");
        let crane: &dyn DynCrane = &crane;
        let rest = crane.equilibrium(&crane_model::statics::Settings::default());
        let found = unstable_servos(crane, 0.0, &rest.q).expect("modes");
        found.into_iter().map(|servo| (servo.cylinder, servo.gain)).collect::<Vec<_>>()
    };
    assert_eq!(found(2.0), []);
    let swinging = found(25.0);
    assert_eq!(swinging.iter().map(|(cylinder, _)| *cylinder).collect::<Vec<_>>(), [0, 1]);
    assert!(swinging.iter().all(|(_, gain)| (3.0..25.0).contains(gain)), "{swinging:?}");
}
