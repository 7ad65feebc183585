//! Load charts of cranes with cylinders, stops, ropes and limited drives: against hand calculations, and against statics at the chart's loads.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::DriveInfo;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::Settings;
use crane_model::envelope::{
    Axes, Axis, Coverage, Critical, Envelope, Execution, Followed, Limit, Limits, LoadFactor, PartLimit, Rating,
    Varied, critical_load, load_factor, only_mass, range_of_loads,
};
use crane_model::results::{cautions, cylinders_at};
use crane_model::runs::{Start, record};
use crane_model::statics;
use crane_model::tipping::{governing, lines};

const GRAVITY: f64 = 9.81;
const BORE: f64 = 0.1;
const ROD: f64 = 0.06;
/// Distance of the load from the joint, m.
const REACH: f64 = 2.0;
/// Distance of the cylinder's foot, which is below the joint, m.
const FOOT: f64 = 0.8;
/// Distance of its head, on the arm, m.
const HEAD: f64 = 0.6;
/// Pressure on the side that does not carry the load, Pa.
const BACK: f64 = 2e5;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("chart.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A massless arm about the world's y axis that carries a load; angles are positive downwards.
fn arm(drive: &str, more: &str) -> LiveCrane {
    crane(&format!(
        "format: 1
name: arm
parameters: {{payload: {{value: 200, unit: kg}}}}
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - {{name: arm, joint: {{revolute: {{axis: y}}}}, mass: payload, com: [{REACH}, 0, 0], inertia: {{Ixx: 1, Iyy: 1, Izz: 1}}}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: arm_theta, {drive}, motion: {{hold: 0}}}}
{more}
"
    ))
}

fn cylinder(max_pressure: f64, stroke: [f64; 2]) -> String {
    let [retracted, stroke] = stroke;
    format!(
        "cylinders:
  - name: lift
    coordinate: arm_theta
    foot: {{link: post, at: [0, 0, -{FOOT}]}}
    head: {{link: arm, at: [{HEAD}, 0, 0]}}
    bore: {BORE}
    rod: {ROD}
    retracted: {retracted}
    stroke: {stroke}
    back_pressure: {BACK:e}
    max_pressure: {max_pressure:e}
"
    )
}

const WIDE: [f64; 2] = [0.3, 1.0];

/// Length of the cylinder at an angle of the arm, and its lever: the law of cosines and its derivative.
fn geometry(theta: f64) -> [f64; 2] {
    let between = PI / 2.0 - theta;
    let length = (FOOT * FOOT + HEAD * HEAD - 2.0 * FOOT * HEAD * between.cos()).sqrt();
    [length, FOOT * HEAD * between.sin() / length]
}

/// The limits that the parts of the crane have.
fn limits_of(crane: &dyn DynCrane) -> Limits {
    Limits { of_parts: PartLimit::DEFAULT.to_vec(), ..Limits::none(crane.description()) }
}

/// Ratings with the drive of this index at several positions.
fn chart(crane: &LiveCrane, drive: usize, positions: &[f64], limits: Limits, factor: f64) -> Vec<Rating> {
    chart_between([1e-3, 1e6], crane, drive, positions, limits, factor)
}

/// The same with a minimum and a maximum load.
fn chart_between(
    loads: [f64; 2],
    crane: &LiveCrane,
    drive: usize,
    positions: &[f64],
    limits: Limits,
    factor: f64,
) -> Vec<Rating> {
    let axes = Axes(vec![Axis { varied: Varied::Drive(drive), values: positions.to_vec() }]);
    let envelope = Envelope { axes, load: 0, loads, limits, factor };
    let found = std::sync::Mutex::new(Vec::new());
    let done = |_: usize, ratings: &[Rating]| found.lock().unwrap().extend(ratings.to_vec());
    let pieces: Vec<usize> = (0..envelope.pieces()).collect();
    envelope.run(crane, &pieces, &Execution { threads: 1, done: &done, cancelled: &|| false }).unwrap();
    found.into_inner().unwrap()
}

/// The accuracy of charts.
const ACCURACY: f64 = 2e-6;

fn assert_close(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!((value / expected - 1.0).abs() < tolerance, "{what}: {value} instead of {expected}");
}

/// The force of a cylinder at its pressure has the moment of the load: `(p A − p₀ A′) · lever = m g R cos θ`.
#[test]
fn a_relief_valve_limits_the_load() {
    let areas = [PI / 4.0 * BORE * BORE, PI / 4.0 * (BORE * BORE - ROD * ROD)];
    let angles = [-0.7, -0.2, 0.0, 0.4];
    let mut loads = Vec::new();
    for pressure in [100e5, 320e5] {
        let crane = arm("rigid: true", &cylinder(pressure, WIDE));
        let ratings = chart(&crane, 1, &angles, limits_of(&crane), 1.0);
        for (theta, rating) in angles.iter().zip(&ratings) {
            let [_, lever] = geometry(*theta);
            let expected = (pressure * areas[0] - BACK * areas[1]) * lever / (GRAVITY * REACH * theta.cos());
            assert_close(&format!("{pressure:e} Pa, {theta}"), rating.load.unwrap(), expected, ACCURACY);
            assert_eq!(rating.governing, Some(Limit::Pressure { cylinder: 0, rod: false }));
        }
        loads.push(ratings[2].load.unwrap());
        // A dynamic factor divides the load.
        let divided = chart(&crane, 1, &angles, limits_of(&crane), 1.25);
        for (whole, divided) in ratings.iter().zip(&divided) {
            assert_close("a factor", 1.25 * divided.load.unwrap(), whole.load.unwrap(), 2.0 * ACCURACY);
        }
    }
    assert!(loads[1] > 3.0 * loads[0], "{loads:?}");
    // With its foot above the joint the cylinder pulls: the side of the rod carries the load. ℓ² = F² + H² + 2 F H sin θ
    let theta = 0.2f64;
    let above = cylinder(100e5, WIDE).replace(&format!("-{FOOT}"), &FOOT.to_string());
    let crane = arm("rigid: true", &above);
    let rating = &chart(&crane, 1, &[theta], limits_of(&crane), 1.0)[0];
    assert_eq!(rating.governing, Some(Limit::Pressure { cylinder: 0, rod: true }));
    let lever = FOOT * HEAD * theta.cos() / (FOOT * FOOT + HEAD * HEAD + 2.0 * FOOT * HEAD * theta.sin()).sqrt();
    let expected = (100e5 * areas[1] - BACK * areas[0]) * lever / (GRAVITY * REACH * theta.cos());
    assert_close("the side of the rod", rating.load.unwrap(), expected, ACCURACY);
}

/// A flexible boom that a cylinder with a valve lifts, at a position of its drive.
fn boom(position: f64, max_pressure: f64, pump: f64) -> LiveCrane {
    crane(&format!(
        "format: 1
name: boom
parameters: {{payload: {{value: 500, unit: kg}}}}
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - name: boom
    placement: {{transform: {{rotation: {{x: 90 deg}}}}}}
    joint: {{revolute: {{axis: z}}}}
    beam:
      length: 4
      sections: 4
      material: {{E: 2.1e11, G: 8.1e10, density: 7850}}
      section: {{box: {{height: 0.2, width: 0.15, thickness: 0.008}}}}
  - {{name: tip, joint: fixed, mass: payload, com: [0, 0, 0], inertia: {{Ixx: 20, Iyy: 20, Izz: 20}}}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: boom_psi, stiffness: 1e8, motion: {{hold: {position}}}}}
cylinders:
  - name: lift
    coordinate: boom_psi
    foot: {{link: post, at: [0.1, 0, -1.2]}}
    head: {{link: boom, at: [1.7, -0.1, 0]}}
    bore: 0.1
    rod: 0.06
    retracted: 1.3
    stroke: 1.2
    back_pressure: 3e5
    max_pressure: {max_pressure:e}
    bulk_modulus: 1.2e9
    hose_volumes: [1e-3, 1e-3]
    valve: {{flow: 1e-3, pressure_drop: 1e6, lag: 0.03, gain: 0, feed_forward: 0}}
pump: {{max_flow: 2e-3, pressure: {pump:e}}}
"
    ))
}

/// At the chart's load, statics of a crane whose drive is there finds the pressure that limits it, with a bent boom, too.
#[test]
fn at_the_loads_of_a_chart_statics_finds_the_pressure() {
    let angles = [0.0, 0.3, 0.6];
    for (max_pressure, pump) in [(100e5, 250e5), (320e5, 250e5), (320e5, 90e5)] {
        let greatest = f64::min(max_pressure, pump);
        let crane = boom(0.2, max_pressure, pump);
        for (angle, rating) in angles.iter().zip(chart(&crane, 1, &angles, limits_of(&crane), 1.0)) {
            let there = &mut boom(*angle, max_pressure, pump);
            let there: &mut dyn DynCrane = there;
            there.set_parameter(0, rating.load.unwrap()).unwrap();
            let equilibrium = there.equilibrium(&statics::Settings::default());
            assert!(equilibrium.is_stable(), "{equilibrium}");
            let efforts = there.drive_efforts_at_rest(&equilibrium.q);
            let state = cylinders_at(there, &equilibrium.q, &vec![0.0; equilibrium.q.len()], &efforts)[0];
            assert_close(&format!("{greatest:e} Pa at {angle}"), state.pressures[0], greatest, ACCURACY);
            let expected = if pump < max_pressure {
                Limit::Pump { cylinder: 0, rod: false }
            } else {
                Limit::Pressure { cylinder: 0, rod: false }
            };
            assert_eq!(rating.governing, Some(expected));
        }
    }
}

#[test]
fn a_stroke_ends_a_chart() {
    let [shortest, stroke] = [0.85, 0.25];
    let crane = arm("rigid: true", &cylinder(320e5, [shortest, stroke]));
    let angles: Vec<f64> = (0..15).map(|step| -0.9 + 0.1 * f64::from(step)).collect();
    let ratings = chart(&crane, 1, &angles, limits_of(&crane), 1.0);
    let mut inside = 0;
    for (theta, rating) in angles.iter().zip(&ratings) {
        let [length, _] = geometry(*theta);
        let reaches = (shortest..=shortest + stroke).contains(&length);
        assert_eq!(rating.load.is_some(), reaches, "{theta}: {length} m");
        let extended = length > shortest;
        assert!(reaches || rating.governing == Some(Limit::Stroke { cylinder: 0, extended }));
        inside += usize::from(reaches);
    }
    assert!(inside > 2 && inside < 13, "{inside}");
    // A soft drive gives way until the piston meets its end: k · (0 − θ) = m g R cos θ, up to the angle of the shortest cylinder.
    let crane = arm("stiffness: 2e4", &cylinder(320e5, [shortest, stroke]));
    let rating = &chart(&crane, 1, &[0.0], limits_of(&crane), 1.0)[0];
    // From the law of cosines: sin θ = (FOOT² + HEAD² − ℓ²)/(2 FOOT HEAD).
    let theta = ((FOOT * FOOT + HEAD * HEAD - shortest * shortest) / (2.0 * FOOT * HEAD)).asin();
    let expected = 2e4 * theta / (GRAVITY * REACH * theta.cos());
    assert_close("the end of the stroke", rating.load.unwrap(), expected, 1e-5);
    assert_eq!(rating.governing, Some(Limit::Stroke { cylinder: 0, extended: false }));
}

/// `max_effort` of the spec: the moment of the load is at most that of the drive.
#[test]
fn a_drive_of_the_spec_limits_the_load() {
    let crane = arm("stiffness: 1e7, max_effort: 8e3", "");
    let ratings = chart(&crane, 1, &[-0.5, 0.0], limits_of(&crane), 1.0);
    for (theta, rating) in [-0.5f64, 0.0].iter().zip(&ratings) {
        // The drive yields by a milliradian, which changes the lever by some 5e-4 of it, and gives way within a thousandth of its limit.
        let expected = 8e3 / (GRAVITY * REACH * theta.cos());
        assert_close("max_effort", rating.load.unwrap(), expected, 3e-3);
        assert_eq!(rating.governing, Some(Limit::Effort { drive: 1 }));
    }
    let mut limits = limits_of(&crane);
    limits.of_parts.clear();
    let free = &chart(&crane, 1, &[0.0], limits.clone(), 1.0)[0];
    // The arm sinks until its lever is as short as its drive is weak.
    assert!(free.load > ratings[1].load.map(|load| 2.0 * load), "{:?}", free.load);
    // What is left out is said.
    let words = "the effort of arm_theta at most 8000 N m";
    assert!(Coverage::new(&crane, &limits, crane.gravity()).not_considered.iter().any(|entry| entry == words));
    assert!(Coverage::new(&crane, &limits_of(&crane), crane.gravity()).considered.iter().any(|entry| entry == words));
}

/// A slope is considered, and said to be, with and without loads; without one it is not.
#[test]
fn a_slope_of_the_spec_is_considered() {
    let loads = "loads: [{name: gust, link: arm, at: [0, 0, 0], force: [0, 5, 0]}]\n";
    for more in ["", loads] {
        let of = |slope: &str| {
            let crane = arm("rigid: true", &format!("{more}{slope}"));
            Coverage::new(&crane, &limits_of(&crane), crane.gravity())
        };
        assert!(of("slope: {angle: 4 deg}").considered.contains(&"a slope of the ground of 4.00°".to_owned()));
        assert!(of("").not_considered.contains(&"a slope of the ground".to_owned()));
    }
}

/// A joint that gives way until it meets its stop at 0.02 rad: k · 0.02 = m g R cos 0.02.
#[test]
fn a_stop_of_a_driven_joint_ends_a_chart() {
    let crane = arm("stiffness: 2e5", "stops: {arm_theta: {max: 0.02, stiffness: 1e7}}");
    let rating = &chart(&crane, 1, &[0.0], limits_of(&crane), 1.0)[0];
    assert_close("the stop", rating.load.unwrap(), 2e5 * 0.02 / (GRAVITY * REACH * 0.02f64.cos()), ACCURACY);
    assert_eq!(rating.governing, Some(Limit::Stop { coordinate: 1 }));
}

/// With a factor, the minimum load is one with which the crane rests that many times as heavy: a drive that holds 110 kg holds 88 kg with a
/// factor of 1.25, although the minimum load is 100 kg.
#[test]
fn a_factor_divides_the_minimum_load_too() {
    let crane = arm("rigid: true", "");
    let mut limits = Limits::none(crane.description());
    limits.efforts[1] = 110.0 * GRAVITY * REACH;
    for factor in [1.0, 1.25] {
        let rating = &chart_between([100.0, 1e6], &crane, 1, &[0.0], limits.clone(), factor)[0];
        assert_close(&format!("factor {factor}"), rating.load.unwrap(), 110.0 / factor, ACCURACY);
        assert_eq!(rating.governing, Some(Limit::Effort { drive: 1 }));
    }
}

/// A hook on two falls: each carries half of the load, up to the largest tension of the rope. At rest and in a run, more is told.
#[test]
fn a_rope_carries_its_largest_tension() {
    let crane = crane(
        "format: 1
name: hoist
parameters: {payload: {value: 800, unit: kg}}
links:
  - {name: post, joint: {prismatic: {axis: x}}, mass: 50, com: [0, 0, 0]}
  - {name: hook, joint: {prismatic: {axis: z}}, mass: payload, com: [0, 0, 0]}
drives: [{coordinate: post_x, rigid: true, motion: {hold: 0}}]
connectors:
  - {name: hoist, from: {at: [0, 0, 5]}, to: {link: hook, at: [0, 0, 0]}, falls: 2,
     law: {rope: {stiffness: 1e6, length: 9, damping: 0.1, max_tension: 4 kN}}}
",
    );
    let rating = &chart(&crane, 0, &[0.0], limits_of(&crane), 1.0)[0];
    assert_close("the rope", rating.load.unwrap(), 2.0 * 4e3 / GRAVITY, ACCURACY);
    assert_eq!(rating.governing, Some(Limit::Tension { rope: 0 }));
    let words = "a tension of hoist of at most 4000 N";
    assert!(Coverage::new(&crane, &limits_of(&crane), crane.gravity()).considered.iter().any(|entry| entry == words));
    let mut heavy = crane;
    heavy.set_parameter(0, 900.0).unwrap();
    let rest = (&heavy as &dyn DynCrane).equilibrium(&statics::Settings::default());
    let said = cautions::of_pose(&heavy, &rest.q, cautions::BEND);
    // 900 kg · 9.81 m/s² / 2.
    assert_eq!(said, ["rope hoist pulls with 4414.5 N, more than its max_tension of 4000 N"]);
    let start = Start::new(&heavy).unwrap();
    let settings = Settings { duration: 0.2, output: 0.1, ..Settings::from_description(heavy.description()) };
    let run = record(&heavy, &start, &settings, &mut |_| ControlFlow::Continue(())).unwrap();
    let said = cautions::of_run(&heavy, &run.table, cautions::BEND);
    assert!(said.iter().any(|caution| caution.contains("max_tension of 4000 N, at ")), "{said:?}");
}

/// A block on four plates: each carries a quarter of it, up to what the ground bears. At rest and in a run, more is told.
#[test]
fn the_ground_bears_a_pressure() {
    let foot = |name: &str, x: f64, y: f64| {
        format!(
            "  - {{name: {name}, at: [{x}, {y}, 0], one_sided: true, stiffness: [1e6, 1e6, 1e6], damping: [1e4, 1e4, 1e4], \
             plate: {{area: 400 cm^2, max_pressure: 2 bar}}}}\n"
        )
    };
    let feet = [foot("a", 1.0, 1.0), foot("b", 1.0, -1.0), foot("c", -1.0, 1.0), foot("d", -1.0, -1.0)].concat();
    let crane = crane(&format!(
        "format: 1\nname: block\nparameters: {{payload: {{value: 1000, unit: kg}}}}\nlinks:\n\
         - {{name: block, joint: free, mass: payload, com: [0, 0, 0.2], inertia: {{Ixx: 20, Iyy: 20, Izz: 30}}}}\n\
         - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 1e-3, com: [0, 0, 0]}}\n\
         supports:\n{feet}drives: [{{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}]\n"
    ));
    let rating = &chart(&crane, 0, &[0.0], limits_of(&crane), 1.0)[0];
    // 2e5 Pa · 0.04 m² on each of four.
    assert_close("the ground", rating.load.unwrap(), 4.0 * 8e3 / GRAVITY, ACCURACY);
    assert!(matches!(rating.governing, Some(Limit::Ground { .. })), "{:?}", rating.governing);
    let mut heavy = crane;
    heavy.set_parameter(0, 4000.0).unwrap();
    let rest = (&heavy as &dyn DynCrane).equilibrium(&statics::Settings::default());
    let said = cautions::of_pose(&heavy, &rest.q, cautions::BEND);
    // 4000 kg · 9.81 m/s² / 4 / 0.04 m².
    assert_eq!(said.len(), 4, "{said:?}");
    assert_eq!(said[0], "a presses on the ground with 2.45 bar, which bears 2 bar");
    let start = Start::new(&heavy).unwrap();
    let settings = Settings { duration: 0.2, output: 0.1, ..Settings::from_description(heavy.description()) };
    let run = record(&heavy, &start, &settings, &mut |_| ControlFlow::Continue(())).unwrap();
    let said = cautions::of_run(&heavy, &run.table, cautions::BEND);
    assert!(
        said.iter().any(|caution| caution.starts_with("a presses on the ground with 2.45 bar, which bears 2 bar, at ")),
        "{said:?}"
    );
}

/// A rope holds an arm down, and is slack where the arm sinks to its length ℓ: at `ℓ² = 3 − 2 cos θ − 2 sin θ`, with only the drive carrying
/// the load, `k θ = m g R cos θ`. The rope is named, although a spring is listed before it.
#[test]
fn a_rope_that_goes_slack_is_a_limit_when_asked_for() {
    let (stiffness, length) = (2e5, 0.99);
    let crane = arm(
        &format!("stiffness: {stiffness:e}"),
        &format!(
            "connectors:
  - {{name: buffer, from: {{at: [0, 0, 1]}}, to: {{link: post, at: [0, 0, 0]}}, law: {{spring: {{stiffness: 1e3, length: 1}}}}}}
  - {{name: stay, from: {{at: [1, 0, -1]}}, to: {{link: arm, at: [1, 0, 0]}}, law: {{rope: {{stiffness: 1e5, length: {length}}}}}}}"
        ),
    );
    let limits = Limits { of_parts: vec![PartLimit::SlackRopes], ..Limits::none(crane.description()) };
    let rating = &chart(&crane, 1, &[0.0], limits, 1.0)[0];
    let theta = ((3.0 - length * length) / 8.0f64.sqrt()).asin() - PI / 4.0;
    assert_close("slack", rating.load.unwrap(), stiffness * theta / (GRAVITY * REACH * theta.cos()), ACCURACY);
    assert_eq!(rating.governing, Some(Limit::Slack { rope: 1 }));
    assert_eq!(rating.governing.unwrap().location(&crane), "stay");
}

/// Feet and tipping lines: a chart with the limit that no foot lifts has the critical load.
#[test]
fn the_first_lift_off_is_a_limit_when_asked_for() {
    let text = "format: 1
name: truck
parameters: {payload: {value: 100, unit: kg}}
links:
  - {name: truck, joint: free, mass: 4000, com: [0, 0, 0.5], inertia: {Ixx: 3000, Iyy: 3000, Izz: 3000}}
  - {name: column, placement: {transform: {translation: [0, 0, 1]}}, joint: revolute, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
  - {name: load, placement: {transform: {translation: [4, 0, 0]}}, mass: payload, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
supports:
  - {name: front_left, one_sided: true, at: [1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: front_right, one_sided: true, at: [1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_left, one_sided: true, at: [-1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_right, one_sided: true, at: [-1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
drives:
  - {coordinate: column_psi, rigid: true, motion: {hold: 50 deg}}
";
    let mut crane = crane(text);
    let lift = Limits { of_parts: vec![PartLimit::LiftOff], ..Limits::none(crane.description()) };
    let tipping = Limits { tipping: Some(0.0), ..Limits::none(crane.description()) };
    let angle = 50.0f64.to_radians();
    for (limits, critical) in [(lift, Critical::FirstFoot), (tipping, Critical::Tipping)] {
        let critical_load = critical_load(&mut crane, 0, critical).unwrap();
        let rating = &chart(&crane, 0, &[angle], limits, 1.0)[0];
        assert_close("the critical load", rating.load.unwrap(), critical_load.load, ACCURACY);
        let expected = match critical {
            // On equal springs: (4001 + m)/4 − m x · 1.5/(4 · 1.5²) − m y · 1/(4 · 1²) = 0.
            Critical::FirstFoot => 4001.0 / (4.0 * angle.cos() / 1.5 + 4.0 * angle.sin() - 1.0),
            Critical::Tipping => 4001.0 / (4.0 * angle.sin() - 1.0),
        };
        // The feet yield by micrometres.
        assert_close("moments", critical_load.load, expected, 1e-5);
    }
}

/// Neighbours make a chart faster and decide nothing: forwards, backwards and alone, poses have one load, or none. A cylinder whose linkage has a second branch, a pose
/// beyond a stroke, and a stage that a short rope turns crosswise once spoilt the poses after them.
#[test]
fn the_order_of_poses_changes_no_load() {
    let held =
        |coordinate: &str, value: &str| format!("drives: [{{coordinate: {coordinate}, motion: {{hold: {value}}}}}]\n");
    for (crane, changes, varied, values) in [
        ("eight_link_hydraulic", held("boom_psi", "4 deg"), "outer_boom", [92f64.to_radians(), 118f64.to_radians()]),
        (
            "examples/loader_crane",
            held("inner_psi", "38.571429 deg"),
            "outer",
            [(-120f64).to_radians(), (-60f64).to_radians()],
        ),
        ("examples/telescopic_loader", held("boom_psi", "60 deg"), "first_stage", [2.7, 2.0]),
    ] {
        let path = format!("{}/../../specs/{crane}.yaml", env!("CARGO_MANIFEST_DIR"));
        let live = LiveCrane::from_spec(&build::open(path.as_ref()).unwrap().changed(&changes)).unwrap();
        let description = live.description();
        let load = only_mass(description).unwrap();
        let loads = |values: &[f64]| -> Vec<Option<f64>> {
            let varied = Varied::named(varied, description).unwrap();
            let axes = Axes(vec![Axis { varied, values: values.to_vec() }]);
            let limits = Limits::usual(description);
            let envelope = Envelope { axes, load, loads: range_of_loads(&live, load, None), limits, factor: 1.0 };
            let found = std::sync::Mutex::new(Vec::new());
            let done = |_: usize, ratings: &[Rating]| found.lock().unwrap().extend(ratings.to_vec());
            envelope.run(&live, &[0], &Execution { threads: 1, done: &done, cancelled: &|| false }).unwrap();
            found.into_inner().unwrap().into_iter().map(|rating| rating.load).collect()
        };
        let [first, last] = values;
        let alone = [loads(&[first])[0], loads(&[last])[0]];
        let backwards: Vec<_> = loads(&[last, first]).into_iter().rev().collect();
        assert!(alone[1].is_some(), "{crane}");
        for others in [loads(&values), backwards] {
            for (alone, other) in alone.iter().zip(&others) {
                // Loads are exact to 1e-6 from below.
                let same =
                    alone.zip(*other).map_or(alone.is_none() && other.is_none(), |(a, b)| (a / b - 1.0).abs() < 2e-6);
                assert!(same, "{crane}: {alone:?} alone, {other:?} beside another");
            }
        }
    }
}

/// Where a chart has no load, statics finds no rest either: at poses far from the spec's own, whose ropes, stages that follow, and hook move with
/// the drives that hold.
#[test]
fn a_chart_is_empty_only_where_statics_finds_no_rest() {
    let path = format!("{}/../../specs/examples/telescopic_loader.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap();
    let held = |boom: f64, stage: f64| {
        let changes = format!(
            "name: held\ndrives:\n- {{coordinate: boom_psi, motion: {{hold: {boom:?}}}}}\n\
             - {{coordinate: first_stage_x, motion: {{hold: {stage:?}}}}}\nconnectors: [{{name: hoist, law: {{rope: {{motion: {{hold: 11.2}}}}}}}}]\n"
        );
        LiveCrane::from_spec(&source.changed(&changes)).unwrap()
    };
    let crane = held(0.4, 1.6);
    let description = crane.description();
    let drive = |name: &str| {
        let is_named = |drive: &DriveInfo| description.coordinates[drive.coordinate].name == name;
        Varied::Drive(description.drives.iter().position(is_named).unwrap())
    };
    let [booms, stages] = [vec![0.0, PI / 9.0], vec![0.0, 0.4, 1.6]];
    let axes = Axes(vec![
        Axis { varied: drive("boom_psi"), values: booms.clone() },
        Axis { varied: drive("first_stage_x"), values: stages.clone() },
    ]);
    let load = description.parameters.iter().position(|info| info.name == "payload").unwrap();
    let limits = Limits { tipping: Some(0.0), ..Limits::none(description) };
    let envelope = Envelope { axes, load, loads: range_of_loads(&crane, load, None), limits, factor: 1.0 };
    let found = std::sync::Mutex::new(Vec::new());
    let done = |piece: usize, ratings: &[Rating]| found.lock().unwrap().push((piece, ratings.to_vec()));
    let pieces: Vec<usize> = (0..envelope.pieces()).collect();
    envelope.run(&crane, &pieces, &Execution { threads: 1, done: &done, cancelled: &|| false }).unwrap();
    let mut found = found.into_inner().unwrap();
    found.sort_by_key(|(piece, _)| *piece);
    let ratings: Vec<Rating> = found.into_iter().flat_map(|(_, ratings)| ratings).collect();
    assert_eq!(ratings.len(), booms.len() * stages.len());
    for (index, rating) in ratings.iter().enumerate() {
        let (boom, stage) = (booms[index / stages.len()], stages[index % stages.len()]);
        let mut own = held(boom, stage);
        let rated = rating.load.unwrap_or_else(|| panic!("boom {boom}, stage {stage}: {:?}", rating.governing));
        // Tipping governs: statics stands up to this load, and the margin there is zero.
        for share in [0.0, 0.5, 1.0] {
            own.set_parameter(load, share * rated).unwrap();
            let rest = (&own as &dyn DynCrane).equilibrium(&statics::Settings::default());
            assert!(rest.is_stable(), "boom {boom}, stage {stage}, {share} of {rated}: {rest}");
            let still = vec![0.0; rest.q.len()];
            let margin = governing(&lines(&own, 0.0, &rest.q, &still, &still)).unwrap().margin();
            assert!(margin >= 0.0 && (share < 1.0 || margin < 1e-5), "boom {boom}, stage {stage}: {margin} at {rated}");
        }
    }
}

/// A boom that its drive turns by half a turn: what hangs straight down at the beginning would stand on its head there, and rests only if it is followed on the way.
#[test]
fn what_stands_on_its_head_is_followed_from_the_beginning() {
    let text = "format: 1\nname: turned\ngravity: [0, -9.81, 0]\nlinks: [{name: boom, joint: revolute, mass: 100, com: [1, 0, 0]}, {name: hook, joint: revolute, \
                placement: {transform: {translation: [2, 0, 0]}}, mass: 50, com: [1, 0, 0]}]\ndrives: [{coordinate: boom_psi, rigid: true, motion: {hold: 0}}]\n\
                guess: {hook_psi: -90 deg}\n";
    let crane = LiveCrane::from_spec(&SourceFile::new("turned.yaml", text)).expect("a crane");
    let search = statics::RestSearch { crane: &crane, positions: &[PI] };
    assert!(!search.find_from_guess().is_stable());
    let equilibrium = search.find(None);
    assert!(
        equilibrium.is_stable() && ((equilibrium.q[0] + equilibrium.q[1]).sin() + 1.0).abs() < 1e-12,
        "{:?}",
        equilibrium.q
    );
}

/// A load on two slanting springs of height h, which snaps through where `P = 2 k (ℓ₀ − ℓ) z/ℓ + c (h − z)` is greatest: it rests below with any load beyond, but its path
/// ends there. A third spring c pulls up, so that without a load there is no rest below, and the way back leads to the path; a heavy base gives way
/// far more than the load snaps. Weight and loads together end at the same load.
#[test]
fn a_load_that_snaps_through_does_not_count() {
    /// Part of the softest stiffness that the third spring takes away, payload, and mass and stiffness of the base.
    type Toggle = ([f64; 3], f64, [f64; 2]);
    let cases: [Toggle; 6] = [
        ([0.2, 1e5, 0.0], 1.0, [1e3, 1e6]),
        ([0.2, 1e5, 0.0], 10.0, [1e3, 1e6]),
        ([0.2, 1e5, 0.5], 10.0, [1e3, 1e6]),
        // Only the determinant tells: a snap of centimetres on the way.
        ([0.07, 4e4, 0.9], 1.0, [30.0, 2e4]),
        ([0.06, 3e4, 0.85], 0.01, [400.0, 3e4]),
        // Only the way back tells.
        ([0.038, 2.7e4, 0.8], 0.1, [4e3, 3e6]),
    ];
    for ([height, stiffness, part], payload, [mass, base]) in cases {
        let length = 1.0_f64.hypot(height);
        let lift = part * 2.0 * stiffness * (length - 1.0);
        let spring = |name: &str, [x, z]: [f64; 2], stiffness: f64, length: f64| {
            format!(
                "- {{name: {name}, from: {{link: base, at: [{x}, 0, {z}]}}, to: {{link: plate, at: [0, 0, 0]}}, law: {{spring: {{stiffness: {stiffness}, length: {length}}}}}}}\n"
            )
        };
        let crane = crane(&format!(
            "format: 1\nname: toggle\nparameters: {{payload: {{value: {payload}, unit: kg}}}}\nlinks:\n\
             - {{name: cart, joint: {{prismatic: {{axis: x}}}}, mass: 5, com: [0, 0, 0]}}\n\
             - {{name: base, joint: {{prismatic: {{axis: z}}}}, mass: {mass}, com: [0, 0, 0]}}\n\
             - {{name: plate, joint: {{prismatic: {{axis: z}}}}, mass: payload, com: [0, 0, 0]}}\n\
             drives: [{{coordinate: cart_x, rigid: true, motion: {{hold: 0}}}}, {{coordinate: base_z, stiffness: {base}, motion: {{hold: 0}}}}]\n\
             guess: {{plate_z: {height}}}\nconnectors:\n{}{}{}",
            spring("left", [-1.0, 0.0], stiffness, length),
            spring("right", [1.0, 0.0], stiffness, length),
            if lift > 0.0 { spring("lift", [0.0, 50.0], lift, 50.0 - height) } else { String::new() }
        ));
        let carried =
            |z: f64| 2.0 * stiffness * (length - 1.0_f64.hypot(z)) * z / 1.0_f64.hypot(z) + lift * (height - z);
        // The first greatest one on the way down.
        let way: Vec<f64> = (0..=20_000).map(|k| carried(height * (1.0 - f64::from(k) / 20_000.0))).collect();
        let end = (1..way.len()).find(|&k| way[k] < way[k - 1]).expect("an end");
        let expected = way[end - 1] / GRAVITY;
        for greatest in [2.0 * expected, 5.0 * expected, 100.0 * expected, range_of_loads(&crane, 0, None)[1]] {
            let of_both = [0.0, 0.1];
            let limits = Limits::none(crane.description());
            for rating in chart_between([1e-3 * expected, greatest], &crane, 0, &of_both, limits, 1.0) {
                assert_eq!(rating.governing, Some(Limit::Equilibrium), "{height} m, up to {greatest} kg");
                // A heavy base leaves 1e-9 of its mass.
                let tolerance = ACCURACY + 2e-9 * mass / expected;
                assert_close("the load that snaps through", rating.load.expect("it rests"), expected, tolerance);
            }
        }
        let (mut crane, parameter) = crane.with_load_factor();
        if let Some(Followed { factor, .. }) = load_factor(&mut crane, parameter).expect("it rests").followed {
            assert_close("the factor", factor * payload, expected, 2.0 * ACCURACY);
        } else {
            assert!(expected > LoadFactor::MOST_FOLLOWED * payload, "{height} m");
        }
    }
}
