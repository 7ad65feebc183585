//! Cylinders between their pins against hand calculations of geometry, virtual work and hydraulics.

use std::f64::consts::PI;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::Settings;
use crane_model::results::{CylinderState, Duties, cautions, cylinders_at};
use crane_model::runs::{self, Start};
use crane_model::statics;

const GRAVITY: f64 = 9.81;
const BORE: f64 = 0.1;
const ROD: f64 = 0.06;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("cylinders.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// An arm about the world's y axis at the end of a short link, 200 kg at 2 m, whose cylinder has its foot 0.8 m below the joint; angles are
/// positive downwards.
fn arm(cylinder: &str) -> LiveCrane {
    crane(&format!(
        "format: 1
name: arm
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - {{name: arm, joint: {{revolute: {{axis: y}}}}, mass: 200, com: [2, 0, 0]}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: arm_theta, stiffness: 1e7, damping: 1e4, motion: {{quintic: {{from: 0, to: -0.6, duration: 3}}}}}}
cylinders:
  - name: lift
    coordinate: arm_theta
    foot: {{link: post, at: [0, 0, -0.8]}}
    bore: {BORE}
    rod: {ROD}
{cylinder}
"
    ))
}

fn areas() -> [f64; 2] {
    [PI / 4.0 * BORE * BORE, PI / 4.0 * (BORE * BORE - ROD * ROD)]
}

fn at(crane: &dyn DynCrane, q: &[f64], v: &[f64]) -> CylinderState {
    cylinders_at(crane, q, v, &crane.drive_efforts_at(0.0, q, v))[0]
}

const PLAIN: &str = "    head: {link: arm, at: [0.6, 0, 0]}\n    retracted: 0.9\n    stroke: 0.6\n    back_pressure: 2e5\n    max_pressure: 21e6";

/// The law of cosines gives the length, its derivative the lever, and the lever the force that holds the weight.
#[test]
fn a_cylinder_below_an_arm_carries_its_weight() {
    let crane = arm(PLAIN);
    let crane: &dyn DynCrane = &crane;
    for theta in [-1.1, -0.4, 0.0, 0.5] {
        let state = at(crane, &[0.0, theta], &[0.0, -0.3]);
        // The angle between the pins at the joint.
        let between = PI / 2.0 - theta;
        let length = (0.8f64.powi(2) + 0.6f64.powi(2) - 2.0 * 0.8 * 0.6 * between.cos()).sqrt();
        let arm = -0.8 * 0.6 * between.sin() / length;
        assert!((state.length - length).abs() < 1e-14, "{theta}: {}", state.length);
        assert!((state.arm - arm).abs() < 1e-14, "{theta}: {}", state.arm);
        assert!((state.speed + 0.3 * arm).abs() < 1e-14, "{theta}: {}", state.speed);
    }
    let rest = crane.equilibrium(&statics::Settings::default());
    let state = cylinders_at(crane, &rest.q, &[0.0; 2], &crane.drive_efforts_at_rest(&rest.q))[0];
    let [piston, ring] = areas();
    let force = 200.0 * GRAVITY * 2.0 * rest.q[1].cos() / -state.arm;
    assert!((state.force / force - 1.0).abs() < 1e-9, "{} for {force}", state.force);
    assert!((state.pressures[0] - (force + 2e5 * ring) / piston).abs() < 1e-2, "{:?}", state.pressures);
    assert_eq!(state.pressures[1].to_bits(), 2e5f64.to_bits());
}

/// Throughout a run the power of the cylinder equals that of its drive, and the oil that it takes in is its change of volume.
#[test]
fn a_run_has_the_power_of_its_drive_and_the_oil_of_its_volume() {
    let crane = arm(PLAIN);
    let settings = Settings { duration: 3.5, output: 1e-3, ..Settings::from_description(crane.description()) };
    let start = Start::new(&crane).expect("it stands");
    let table =
        runs::record(&crane, &start, &settings, &mut |_| std::ops::ControlFlow::Continue(())).expect("runs").table;
    let column = |name: &str| table.values(name).unwrap_or_else(|| panic!("no {name}")).collect::<Vec<f64>>();
    let [force, speed, length, flow] = ["force", "speed", "length", "flow"].map(|what| column(&format!("lift_{what}")));
    let (torque, rate) = (column("arm_theta_drive_torque"), column("arm_theta_rate"));
    let most = torque.iter().zip(&rate).map(|(torque, rate)| (torque * rate).abs()).fold(0.0, f64::max);
    for k in 0..force.len() {
        assert!((force[k] * speed[k] - torque[k] * rate[k]).abs() < 1e-12 * most, "row {k}");
    }
    // The trapezoidal rule over a smooth motion at 1 ms; the arm rises all the time except for its vibration.
    let taken: f64 = flow.windows(2).map(|pair| 0.5e-3 * (pair[0] + pair[1])).sum();
    let volume = areas()[0] * (length[length.len() - 1] - length[0]);
    assert!(volume > 1e-3 && (taken / volume - 1.0).abs() < 1e-3, "{taken} m³ for {volume} m³");
    // The pump delivers what the prescribed motion takes: the same volume, and the work on the mass and against the back pressure. The drive's
    // spring yields 1e-4 rad of 0.6 rad and stores 1 J of 2 kJ.
    let [delivered, work] = ["pump_flow", "pump_power"]
        .map(|name| column(name).windows(2).map(|pair| 0.5e-3 * (pair[0] + pair[1])).sum::<f64>());
    assert!((delivered / volume - 1.0).abs() < 2e-3, "{delivered} m³ for {volume} m³");
    let lifted = 200.0 * GRAVITY * 2.0 * 0.6_f64.sin() + 2e5 * areas()[1] * (length[length.len() - 1] - length[0]);
    assert!((work / lifted - 1.0).abs() < 5e-3, "{work} J for {lifted} J");
}

/// With gravity upwards the cylinder pulls: a run's duty has the largest pull, and no push.
#[test]
fn a_cylinder_that_only_pulls_has_no_push() {
    let crane = arm(&format!("{PLAIN}\ngravity: [0, 0, 9.81]"));
    let settings = Settings { duration: 3.5, output: 0.01, ..Settings::from_description(crane.description()) };
    let start = Start::new(&crane).expect("it stands");
    let table =
        runs::record(&crane, &start, &settings, &mut |_| std::ops::ControlFlow::Continue(())).expect("runs").table;
    let least = table.values("lift_force").expect("a column").fold(0.0, f64::min);
    let duty = &Duties::new(crane.description(), &table).cylinders[0];
    assert_eq!([duty.push, duty.pull], [0.0, -least]);
    // At the end, where the lever is shortest; stopping there adds some per cent.
    let lever = at(&crane, &[0.0, -0.6], &[0.0; 2]).arm.abs();
    let weight = 200.0 * GRAVITY * 2.0 * 0.6_f64.cos() / lever;
    assert!((duty.pull / weight - 1.0).abs() < 0.15, "{}, {weight}", duty.pull);
}

/// A rocker as long as the arm's lever, and a link as long as the distance of its pivot from the joint form a parallelogram: the rocker
/// turns with the arm. On the other branch it does not, and the derivative is still that of the length.
#[test]
fn a_parallelogram_turns_its_rocker_with_the_arm() {
    let linkage = |side: &str| {
        arm(&format!(
            "    head: {{link: arm, at: [0.25, 0, 0]}}\n    linkage: {{pivot: [0, 0, -0.3], rocker: 0.25, link: 0.3, side: {side}}}\n    \
             retracted: 0.5\n    stroke: 0.4"
        ))
    };
    let right = linkage("right");
    let left = linkage("left");
    let mut differ = 0;
    for theta in [-0.9f64, -0.3, 0.2, 0.7] {
        // The rocker's pin in the x-z plane, from the foot 0.5 m below the pivot.
        let length = (0.25 * theta.cos()).hypot(0.5 - 0.25 * theta.sin());
        let lengths = [&right, &left].map(|crane| at(crane, &[0.0, theta], &[0.0; 2]).length);
        let found = lengths.iter().filter(|lengths| (*lengths - length).abs() < 1e-13).count();
        assert!(found >= 1, "{theta}: {lengths:?} for {length}");
        differ += usize::from((lengths[0] - lengths[1]).abs() > 1e-3);
        for crane in [&right, &left] {
            let [less, more] = [-1e-5, 1e-5].map(|by| at(crane, &[0.0, theta + by], &[0.0; 2]).length);
            let arm = at(crane, &[0.0, theta], &[0.0; 2]).arm;
            // Central differences: the third derivative times 1e-10, and rounding over 1e-5.
            assert!((arm - (more - less) / 2e-5).abs() < 1e-8, "{theta}: {arm}");
        }
    }
    assert_eq!(differ, 4);
}

/// Where a boom bends between the pins of a linkage and its joint, in both planes and in torsion, the rate of the length is that along the
/// motion: the axis of the joint turns, too, as seen from the rocker's pivot.
#[test]
fn the_rate_over_a_bending_boom_is_that_along_the_motion() {
    let crane = crane(
        "format: 1
name: bending
materials:
  steel: {E: 2.1e11, G: 8.1e10, density: 7850}
links:
  - {name: column, joint: {revolute: {axis: z}}, mass: 50, com: [0, 0, 0.5], inertia: {Ixx: 5, Iyy: 5, Izz: 5}}
  - name: boom
    placement: {transform: {translation: [0, 0, 1], rotation: {x: 90 deg}}}
    joint: {revolute: {axis: z}}
    beam: {length: 3, sections: 3, material: steel, section: {box: {height: 0.2, width: 0.2, thickness: 0.008}}}
  - {name: jib, joint: {revolute: {axis: z}}, mass: 90, com: [0, -1, 0], inertia: {Ixx: 30, Iyy: 3, Izz: 30}}
drives:
  - {coordinate: column_psi, stiffness: 1e6, motion: {hold: 0}}
  - {coordinate: boom_psi, stiffness: 1e6, motion: {hold: 0}}
  - {coordinate: jib_psi, stiffness: 1e6, motion: {hold: 1}}
cylinders:
  - name: jib_cylinder
    coordinate: jib_psi
    foot: {link: boom, at: [1.2, 0.3, 0.02]}
    head: {link: jib, at: [0.3, 0.2, 0.01]}
    linkage: {pivot: [1.3, 0.15, 0], rocker: 1.7, link: 0.45, side: left}
    bore: 0.1
    rod: 0.06
    retracted: 0.9
    stroke: 0.9
",
    );
    let n = crane.description().coordinates.len();
    let numbers =
        |scale: f64, seed: f64| -> Vec<f64> { (0..n).map(|j| scale * (seed + 2.3 * j as f64).sin()).collect() };
    for seed in [0.3, 1.7, 4.1] {
        let mut q = numbers(0.02, seed);
        q[n - 1] = 0.8;
        let v = numbers(1.0, 3.0 * seed);
        let state = at(&crane, &q, &v);
        let along = |step: f64| {
            let moved: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + step * v).collect();
            at(&crane, &moved, &v).length
        };
        let by_joint = |step: f64| {
            let mut moved = q.clone();
            moved[n - 1] += step;
            at(&crane, &moved, &v).length
        };
        // Central differences: the third derivative times 1e-10, and rounding over 1e-5.
        for (value, of) in [(state.speed, &along as &dyn Fn(f64) -> f64), (state.arm, &by_joint)] {
            let slope = (of(1e-5) - of(-1e-5)) / 2e-5;
            assert!((value - slope).abs() < 1e-8, "{seed}: {value} for {slope}");
        }
    }
}

/// If rocker and link do not reach each other, a run ends with a message that names the cylinder, and a pose has a caution.
#[test]
fn a_linkage_that_does_not_reach_is_named() {
    // The pivot is 0.4 m from the joint, the link ends 0.25 m from it: 0.47 m apart at first, 0.57 m at the end of the motion upwards.
    let crane = arm(
        "    head: {link: arm, at: [0.25, 0, 0]}\n    linkage: {pivot: [0, 0, -0.4], rocker: 0.25, link: 0.3, side: left}\n    retracted: 0.2\n    \
         stroke: 1",
    );
    let start = Start::new(&crane).expect("it stands");
    let settings = Settings { duration: 3.0, ..Settings::from_description(crane.description()) };
    let failed = runs::record(&crane, &start, &settings, &mut |_| std::ops::ControlFlow::Continue(()))
        .expect_err("it does not reach");
    let message = failed.to_string();
    assert!(message.contains("the linkage of lift cannot be assembled at 1."), "{message}");
    let message = cautions::of_pose(&crane, &[0.0, -0.6], 20.0);
    assert!(message.iter().any(|message| message.contains("lift cannot be assembled")), "{message:?}");
}

/// Cautions name strokes, pressures and flows beyond their limits, and drives stiffer than their oil.
#[test]
fn limits_of_cylinders_are_cautions() {
    let short = arm(&PLAIN.replace("stroke: 0.6", "stroke: 0.05").replace("21e6", "8e5"));
    let rest = (&short as &dyn DynCrane).equilibrium(&statics::Settings::default());
    let caution = cautions::of_pose(&short, &rest.q, 20.0).join("; ");
    // Its pins are 0.8 m and 0.6 m from the joint, at right angles except for the sag.
    assert!(caution.contains("lift is 1.000 m long: its stroke is from 0.900 to 0.950 m"), "{caution}");
    assert!(caution.contains("on the side of its piston: its relief valve opens at 8 bar"), "{caution}");
    let oily = arm(&format!("{PLAIN}\n    bulk_modulus: 2e8\n    hose_volumes: [1e-3, 2e-3]"));
    let info = &oily.description().cylinders[0];
    let state = at(&oily, &[0.0, 0.0], &[0.0; 2]);
    let ([piston, ring], y) = (areas(), state.length - 0.9);
    let stiffness = 2e8 * (piston * piston / (1e-3 + piston * y) + ring * ring / (2e-3 + ring * (0.6 - y)));
    let value = state.oil_stiffness(info).expect("there is oil");
    assert!((value / (stiffness * state.arm * state.arm) - 1.0).abs() < 1e-14, "{value}");
    let caution = cautions::of_pose(&oily, &[0.0, 0.0], 20.0).join("; ");
    let ratio = format!("the drive of arm_theta is {:.1} times as stiff as the oil in lift", 1e7 / value);
    assert!(caution.contains(&ratio), "{caution}");
    assert!(at(&short, &[0.0, 0.0], &[0.0; 2]).oil_stiffness(&short.description().cylinders[0]).is_none());
}

/// The lift cylinder lowers the boom while the parallel cylinder is held and vibrates: the pump fills the ring around the sinking rod, where there is no
/// pressure. With the pressure of the held cylinder, which carries the head, it would deliver 16 kJ.
#[test]
fn a_held_cylinder_takes_nothing_of_the_pump() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../specs/examples/parallel_harvester.yaml");
    let crane = LiveCrane::from_spec(&build::open(path.as_ref()).expect("a spec")).expect("valid");
    let settings = Settings { duration: 8.0, output: 0.02, ..Settings::from_description(crane.description()) };
    let start = Start::new(&crane).expect("it stands");
    let table =
        runs::record(&crane, &start, &settings, &mut |_| std::ops::ControlFlow::Continue(())).expect("runs").table;
    let column = |name: &str| table.values(name).unwrap_or_else(|| panic!("no {name}")).collect::<Vec<f64>>();
    let [power, flow, length] = ["pump_power", "pump_flow", "lift_length"].map(column);
    let integral = |numbers: &[f64]| numbers.windows(2).map(|pair| 0.01 * (pair[0] + pair[1])).sum::<f64>();
    // The ring around the rod, over the way of the lift cylinder; the spring of its drive yields some millimetres.
    let volume = 0.25 * PI * (0.14 * 0.14 - 0.09 * 0.09) * (length[0] - length[length.len() - 1]);
    assert!(volume > 1e-3 && (integral(&flow) / volume - 1.0).abs() < 1e-2, "{} m³ for {volume} m³", integral(&flow));
    let (peak, work) = (power.iter().copied().fold(0.0, f64::max), integral(&power));
    assert!(peak < 150.0 && work < 77.0, "{peak} W, {work} J");
}
