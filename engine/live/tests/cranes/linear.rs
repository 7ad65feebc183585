//! Linear models of open chains, of loops and of cranes on oil: against modes, differences of the equations of motion, and runs.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::force_states::{self, ForceStates};
use crane_model::linear::{About, Forces, Input, LinearModel, NoModel, Output, linear_model, outputs};
use crane_model::modes::{DampedMode, damped, with_servos};
use crane_model::nalgebra::{Complex, DMatrix, DVector};
use crane_model::results::quantities_at;
use crane_model::{StateAt, statics};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

fn shipped(name: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    LiveCrane::from_spec(&build::open(path.as_ref()).unwrap()).unwrap()
}

/// A four-bar with a drive, a force on its coupler and a torque as inputs.
fn four_bar() -> LiveCrane {
    let bar = |name: &str, placement: &str, length: f64, mass: f64| {
        format!(
            "- {{name: {name}, placement: {{transform: {{{placement}}}}}, joint: revolute, mass: {mass}, com: [{}, 0, 0], inertia: {{gyration: [0.1, {g}, {g}]}}}}\n",
            0.5 * length,
            g = 0.3 * length
        )
    };
    crane(&format!(
        "format: 1\nname: bars\ninputs: {{push: {{unit: N}}, torque: {{unit: N m}}}}\nlinks:\n{}{}{}\
         loop_joints: [{{name: hinge, from: {{at: [1.2, 0, 0]}}, to: {{link: rocker, at: [0.9, 0, 0]}}, joint: {{slide: {{axis: [0, 1, 0]}}}}}}]\n\
         drives:\n- {{coordinate: crank_psi, stiffness: 4e3, damping: 60, effort: {{input: torque}}, motion: {{hold: 1.1}}}}\n\
         loads:\n- {{name: pull, link: coupler, at: [0.5, 0, 0], force: [0, 0, 1], scale: {{input: push}}}}\n\
         points:\n- {{name: middle, link: coupler, at: [0.5, 0, 0]}}\n",
        bar("crank", "rotation: {x: 90 deg}", 0.4, 30.0),
        bar("coupler", "translation: [0.4, 0, 0]", 1.1, 80.0),
        bar("rocker", "translation: [1.1, 0, 0]", 0.9, 60.0),
    ))
}

/// A ram that lifts a mass by a valve; its beam carries the cylinder's foot.
fn lift(leakage: f64) -> LiveCrane {
    lift_with(leakage, "gain: 20", "")
}

/// The same with a valve that an input commands.
fn commanded_lift(leakage: f64) -> LiveCrane {
    lift_with(leakage, "opening: {input: lever}", "inputs: {lever: {unit: \"1\"}}\n")
}

fn lift_with(leakage: f64, command: &str, inputs: &str) -> LiveCrane {
    crane(&format!(
        "format: 1
name: lift
{inputs}links:
  - {{name: post, joint: fixed, mass: 50, com: [0, 0, 0]}}
  - {{name: arm, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: 300, com: [1.2, 0, 0], inertia: {{gyration: [0.1, 0.6, 0.6]}}}}
  - {{name: bob, placement: {{transform: {{translation: [2.2, 0, 0]}}}}, joint: revolute, mass: 80, com: [0, -0.7, 0], inertia: {{gyration: [0.1, 0.1, 0.1]}}}}
drives:
  - {{coordinate: arm_psi, stiffness: 1e7, motion: {{hold: 0.3}}}}
damping: {{bob_psi: 6}}
cylinders:
  - name: ram
    coordinate: arm_psi
    foot: {{link: post, at: [0.2, 0, -0.9]}}
    head: {{link: arm, at: [0.9, -0.05, 0]}}
    bore: 0.08
    rod: 0.045
    retracted: 0.8
    stroke: 0.7
    back_pressure: 3e5
    max_pressure: 2.5e7
    bulk_modulus: 1.3e9
    hose_volumes: [6e-4, 4e-4]
    valve: {{flow: 6e-4, pressure_drop: 1e6, lag: 0.03, {command}, leakage: {leakage:e}}}
pump: {{max_flow: 1e-3, pressure: 2e7, volume: 4e-3}}
points: [{{name: hook, link: bob, at: [0, -0.7, 0]}}]
"
    ))
}

fn at_rest(crane: &LiveCrane) -> Vec<f64> {
    let rest = (crane as &dyn DynCrane).equilibrium(&statics::Settings::default());
    assert!(rest.is_stable(), "{}", rest.status);
    rest.q
}

fn about<'a>(q: &'a [f64], v: &'a [f64], x: Forces<'a>) -> About<'a> {
    About { t: 0.0, q, v, x, steady: false }
}

fn all_inputs(crane: &LiveCrane) -> Vec<Input> {
    Input::all(crane.description())
}

fn named(crane: &LiveCrane, names: &[&str]) -> Vec<Output> {
    let all = outputs(crane);
    let of = |name: &&str| {
        all.iter().find(|output| output.column.name == **name).unwrap_or_else(|| panic!("{name}")).clone()
    };
    names.iter().map(of).collect()
}

fn assert_same_modes(what: &str, found: &[DampedMode], expected: &[DampedMode], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for expected in expected {
        let size = expected.eigenvalue.norm();
        let off = found.iter().map(|mode| (mode.eigenvalue - expected.eigenvalue).norm()).fold(f64::INFINITY, f64::min);
        assert!(off < tolerance * (size + 1e-2), "{what}: {} is off by {off:e}", expected.eigenvalue);
    }
}

/// Open chains: K and D of small motions are derived by another function, and eigenvalues of 50 rows amplify rounding.
#[test]
fn eigenvalues_are_those_of_modes() {
    for name in ["knuckle_boom", "eight_link_flexible", "loader_tipping", "eight_link_identified"] {
        let crane = shipped(name);
        let q = at_rest(&crane);
        let v = vec![0.0; q.len()];
        let model = linear_model(&crane, &about(&q, &v, Forces::Holding), &[], &[]).unwrap();
        let expected = damped(&(&crane as &dyn DynCrane).small_motions_at(&q)).unwrap();
        assert_same_modes(name, &model.modes().unwrap(), &expected, 1e-7);
    }
    let bars = four_bar();
    let q = at_rest(&bars);
    let model = linear_model(&bars, &about(&q, &[0.0; 3], Forces::Holding), &[], &[]).unwrap();
    assert_eq!(model.states.len(), 2, "one degree of freedom: {:?}", model.states);
    assert_same_modes(
        "bars",
        &model.modes().unwrap(),
        &damped(&(&bars as &dyn DynCrane).small_motions_at(&q)).unwrap(),
        1e-8,
    );
    // Shut valves: the oil is a spring, and its pressures add eigenvalues of 0 and that of the spool.
    let lift = lift(0.0);
    let q = at_rest(&lift);
    let model = linear_model(&lift, &about(&q, &[0.0; 2], Forces::Holding), &[], &[]).unwrap();
    let found: Vec<DampedMode> = model.modes().unwrap().into_iter().filter(|mode| mode.eigenvalue.im > 0.0).collect();
    assert_same_modes("lift", &found, &damped(&(&lift as &dyn DynCrane).small_motions_at(&q)).unwrap(), 1e-6);
    assert_eq!(model.states.len(), 4 + 4);
}

/// About rest with valves slightly open: those of the analysis of servos.
#[test]
fn slightly_open_valves_are_those_of_servos() {
    // Gains with which no two eigenvalues are about to become a pair.
    let path = format!("{}/../../specs/eight_link_hydraulic.yaml", env!("CARGO_MANIFEST_DIR"));
    let names = ["boom_cylinder", "outer_boom_cylinder", "telescope_cylinder"];
    let gains: String = names.map(|name| format!("  - {{name: {name}, valve: {{gain: 6}}}}\n")).concat();
    let hydraulic = build::open(path.as_ref()).unwrap().changed(&format!("cylinders:\n{gains}"));
    for crane in [lift(2e-13), LiveCrane::from_spec(&hydraulic).unwrap()] {
        let q = at_rest(&crane);
        let v = vec![0.0; q.len()];
        let model =
            linear_model(&crane, &About { steady: true, ..about(&q, &v, Forces::SlightlyOpen) }, &[], &[]).unwrap();
        let expected = with_servos(&crane as &dyn DynCrane, 0.0, &q).unwrap();
        // The directions of cylinders are differences, to 1e-8 of K.
        let off = (&model.a - &expected.matrix).amax();
        let scale = DMatrix::from_fn(model.a.nrows(), model.a.ncols(), |i, j| expected.matrix[(i, j)].abs()).max();
        assert!(off < 1e-6 * scale, "{off:e} of {scale:e}");
        assert_same_modes("servos", &model.modes().unwrap(), &expected.modes().unwrap(), 1e-4);
    }
}

/// A valve that is commanded opens slightly as one with a servo does: A is that with the servo, whose gain is not there, and a loop on the
/// valve moves the arm.
#[test]
fn a_commanded_valve_opens_slightly() {
    let [servo, commanded] = [lift(2e-13), commanded_lift(2e-13)];
    let q = at_rest(&servo);
    let about = About { steady: true, ..about(&q, &[0.0; 2], Forces::SlightlyOpen) };
    let of =
        |crane: &LiveCrane, input: Input| linear_model(crane, &about, &[input], &named(crane, &["arm_psi"])).unwrap();
    let (with, without) = (of(&servo, Input::Valve(0)), of(&commanded, Input::Valve(0)));
    let spool = with.states.iter().position(|state| state.name == "ram_valve").unwrap();
    let mut expected = with.a.clone();
    assert!(expected[(spool, 0)].abs() > 100.0, "gain 20 1/m, 0.8 m/rad, lag 0.03 s");
    // The servo sees the arm alone.
    expected[(spool, 0)] = 0.0;
    let off = (&without.a - &expected).amax();
    assert!(off < 1e-9 * expected.amax(), "{off:e}");
    assert_eq!((&without.b, of(&commanded, Input::Spec(0)).b.amax().round()), (&with.b, with.b.amax().round()));
    // At low frequencies the arm turns by the flow over area and lever, against leakage: some 1 rad/s for a valve that is fully open.
    let states = without.a.nrows();
    let turning = Complex::new(0.0, 0.5);
    let matrix = DMatrix::from_fn(states, states, |i, j| {
        (if i == j { turning } else { Complex::from(0.0) }) - without.a[(i, j)]
    });
    let states = matrix.lu().solve(&without.b.map(Complex::from)).unwrap();
    let response = (without.c.map(Complex::from) * states)[(0, 0)];
    assert!((0.1..10.0).contains(&response.norm()), "{response}");
}

/// Inputs of a spec do what the motion and the effort of the same drive do, from small changes of a stiff crane: its forces change by megapascals
/// with a radian, by nothing with a newton metre. Some coordinates hardly move, and with a step that fits one input the other was wrong by 1e-5.
#[test]
fn inputs_of_the_spec_are_those_of_the_drive() {
    let path = format!("{}/../../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap().changed(
        "name: changed\ninputs: {trim: {value: 0.01, unit: rad}, push: {value: 3000, unit: N m}}\n\
         drives: [{coordinate: outer_boom_psi, offset: trim, effort: {input: push}}]\n",
    );
    let crane = LiveCrane::from_spec(&source).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let drives = &crane.description().drives;
    let name = |drive: usize| &*crane.description().coordinates[drives[drive].coordinate].name;
    let drive = (0..drives.len()).find(|drive| name(*drive) == "outer_boom_psi").unwrap();
    let (q, rest) = (at_rest(&crane), vec![0.0; crane.size()]);
    let inputs = [Input::Spec(0), Input::Motion(drive), Input::Spec(1), Input::Effort(drive)];
    let model = linear_model(&crane, &about(&q, &rest, Forces::Holding), &inputs, &[]).unwrap();
    let gains = model.a.lu().solve(&model.b).unwrap();
    for (own, other) in [(0, 1), (2, 3)] {
        for (state, row) in gains.row_iter().take(crane.size()).enumerate() {
            let allowed = 1e-6 * row[other].abs() + 1e-9 * gains.column(other).amax();
            let off = (row[own] - row[other]).abs();
            assert!(off < allowed, "state {state}: {} against {}", row[own], row[other]);
        }
    }
}

/// Where a servo brings the arm is where its motion prescribes it, up to what the leakage of the load takes; a rate alone moves it little.
#[test]
fn a_servo_follows_its_motion() {
    let crane = lift(2e-13);
    let q = at_rest(&crane);
    let about = About { steady: true, ..about(&q, &[0.0; 2], Forces::SlightlyOpen) };
    let model =
        linear_model(&crane, &about, &[Input::Motion(0), Input::Rate(0)], &named(&crane, &["arm_psi"])).unwrap();
    let gains = -(&model.c * model.a.lu().solve(&model.b).unwrap());
    assert!((gains[(0, 0)] - 1.0).abs() < 1e-3, "{gains}");
    assert!(gains[(0, 1)].abs() < 0.2, "{gains}");
}

/// Oil that leaks past a piston with a shut valve lets the arm sink as fast as the force stays in balance: with the stiffness of the oil
/// `K = β (A²/V + A′²/V′)` and that of the load F′,
///
/// ```text
/// ẏ = −β λ (p − p′) (A/V + A′/V′)/(K + F′)
/// ```
///
/// worked out here from areas, volumes and moments. The state is not an equilibrium, and not unstable, although A has an eigenvalue that grows.
#[test]
fn a_leak_is_a_drift_and_no_instability() {
    let leakage = 2e-11;
    let crane = lift(leakage);
    let q = at_rest(&crane);
    let model = linear_model(&crane, &about(&q, &[0.0; 2], Forces::Holding), &[], &[]).unwrap();
    let [area, ring] = [0.25 * PI * 0.08 * 0.08, 0.25 * PI * (0.08 * 0.08 - 0.045 * 0.045)];
    let (bulk, [of_piston, of_rod]) = (1.3e9, [6e-4, 4e-4]);
    // The head, turned by the arm about the foot: length and lever.
    let length = |psi: f64| {
        let (x, z) = (0.9 * psi.cos() + 0.05 * psi.sin(), 0.9 * psi.sin() - 0.05 * psi.cos());
        (x - 0.2).hypot(z + 0.9)
    };
    let lever = |psi: f64| (length(psi + 1e-6) - length(psi - 1e-6)) / 2e-6;
    let force = |psi: f64| 9.81 * (300.0 * 1.2 + 80.0 * 2.2) * psi.cos() / lever(psi);
    let rate = |psi: f64, [p, other]: [f64; 2]| {
        let y = length(psi) - 0.8;
        let [v, w] = [of_piston + area * y, of_rod + ring * (0.7 - y)];
        let oil = bulk * (area * area / v + ring * ring / w);
        let load = (force(psi + 1e-4) - force(psi - 1e-4)) / 2e-4 / lever(psi);
        let speed = -bulk * leakage * (p - other) * (area / v + ring / w) / (oil + load);
        let leak = leakage * (p - other);
        (speed, [bulk / v * (-area * speed - leak), bulk / w * (ring * speed + leak)])
    };
    let start = (q[0], [(force(q[0]) + 3e5 * ring) / area, 3e5]);
    let (speed, _) = rate(start.0, start.1);
    let drift = model.drift.as_ref().expect("no equilibrium");
    let expected = speed / lever(q[0]);
    // Differences of the test, 1e-6 of the load's stiffness, which is 1 % of the oil's; the bob hangs within its own rounding.
    assert!((drift.rates[0] / expected - 1.0).abs() < 1e-6, "{} for {expected}", drift.rates[0]);
    assert_eq!(drift.fastest, 0);
    // After a second of its own motion, by the midpoint rule in steps of 0.1 s.
    let (mut psi, mut p) = start;
    for _ in 0..10 {
        let step = 0.1;
        let (speed, slopes) = rate(psi, p);
        let middle = [0, 1].map(|side| p[side] + 0.5 * step * slopes[side]);
        let half = psi + 0.5 * step * speed / lever(psi);
        let (speed, slopes) = rate(half, middle);
        psi += step * speed / lever(half);
        p = [0, 1].map(|side| p[side] + step * slopes[side]);
    }
    let decay = -(rate(psi, p).0 / lever(psi) / expected).ln();
    // Of the second, in which the lever changes too.
    assert!((drift.decay / decay - 1.0).abs() < 0.1 && decay > 0.0, "{} for {decay}", drift.decay);
    assert!(model.modes().unwrap().iter().any(|mode| mode.eigenvalue.re > 1e-4), "the drift changes with the pose");
    assert_eq!(model.growing().unwrap(), None);
    // Without leakage there is neither.
    let sealed = linear_model(&lift(0.0), &about(&q, &[0.0; 2], Forces::Holding), &[], &[]).unwrap();
    assert!(sealed.drift.is_none() && sealed.growing().unwrap().is_none());
    // A valve that feeds the leak holds the pose.
    let fed = About { steady: true, ..about(&q, &[0.0; 2], Forces::SlightlyOpen) };
    let held = linear_model(&crane, &fed, &[], &[]).unwrap();
    assert!(held.drift.is_none(), "{:?}", held.drift);
}

/// A and B about a moving state with an open valve, against central differences of accelerations and rates of the states of forces.
#[test]
fn a_moving_crane_on_oil_has_the_derivatives_of_its_equations() {
    let crane = lift(2e-13);
    let (q, v) = ([0.35, -0.2], [0.4, -0.9]);
    let x = [9e6, 4e6, 0.4, 1.8e7];
    let model = linear_model(
        &crane,
        &about(&q, &v, Forces::Given(&x)),
        &all_inputs(&crane),
        &named(&crane, &["ram_force", "hook_x", "hook_vz"]),
    )
    .unwrap();
    let slopes = |state: &[f64]| {
        let (accelerations, rates) = force_states::accelerations(&crane, &StateAt::from_motion(0.0, 2, state));
        [&state[2..4], &accelerations, &rates].concat()
    };
    let values = |state: &[f64]| {
        let all = quantities_at(&crane, &StateAt::from_motion(0.0, 2, state));
        named(&crane, &["ram_force", "hook_x", "hook_vz"]).iter().map(|output| all[output.index]).collect::<Vec<f64>>()
    };
    let here = [&q[..], &v, &x].concat();
    let scales = [1.0, 1.0, 1.0, 1.0, 2e7, 2e7, 1.0, 2e7];
    for column in 0..8 {
        // Errors of 1e-10 of the size of a row: curvature and rounding.
        let step = 1e-5 * scales[column];
        let moved = |sign: f64| {
            let mut state = here.clone();
            state[column] += sign * step;
            state
        };
        for (matrix, [after, before]) in [
            (&model.a, [slopes(&moved(1.0)), slopes(&moved(-1.0))]),
            (&model.c, [values(&moved(1.0)), values(&moved(-1.0))]),
        ] {
            for row in 0..matrix.nrows() {
                let difference = (after[row] - before[row]) / (2.0 * step);
                let size = (0..8).map(|j| (matrix[(row, j)] * scales[j]).abs()).fold(0.0, f64::max) / scales[column];
                let off = (matrix[(row, column)] - difference).abs();
                assert!(
                    off <= 1e-6 * size + 1e-12,
                    "row {row}, column {column}: {} for {difference}",
                    matrix[(row, column)]
                );
            }
        }
    }
    // The servo follows its motion with the gain, and its valve lags.
    let place = |name: &str| model.inputs.iter().position(|column| column.name == name).unwrap();
    assert!((model.b[(6, place("ram_valve"))] - 1.0 / 0.03).abs() < 1e-9);
    assert!(model.b[(6, place("arm_psi_prescribed"))].abs() > 1.0);
}

/// A and C of a loop that moves, and B, against differences of a run's equations on the loop: q(θ) and v(θ, θ̇) by assembling and projecting.
#[test]
fn a_moving_loop_has_the_derivatives_of_its_equations() {
    let bars = four_bar();
    let n = 3;
    let onto = |crank: f64, rate: f64| {
        // A run of no duration closes the loop and projects the rates, in the metric of A; scaled back to the crank's angle and rate.
        let angles = |theta: f64| {
            let way = [1.2 - 0.4 * theta.cos(), -0.4 * theta.sin()];
            let distance = way[0].hypot(way[1]);
            let at_crank = ((distance * distance + 1.1 * 1.1 - 0.9 * 0.9) / (2.0 * distance * 1.1)).acos();
            let at_coupler = ((1.1 * 1.1 + 0.9 * 0.9 - distance * distance) / (2.0 * 1.1 * 0.9_f64)).acos();
            let coupler = way[1].atan2(way[0]) + at_crank;
            [theta, coupler - theta, at_coupler - std::f64::consts::PI]
        };
        let step = 1e-5;
        let [after, before] = [1.0, -1.0].map(|sign| angles(crank + sign * step));
        let v: Vec<f64> = (0..n).map(|i| rate * (after[i] - before[i]) / (2.0 * step)).collect();
        (angles(crank).to_vec(), v)
    };
    let (crank, rate) = (1.3, 2.0);
    let (q, v) = onto(crank, rate);
    let found = linear_model(
        &bars,
        &about(&q, &v, Forces::Holding),
        &all_inputs(&bars)[..2],
        &named(&bars, &["middle_z", "rocker_psi_rate", "crank_psi_drive_torque"]),
    )
    .unwrap();
    assert_eq!(found.states[0].name, "crank_psi");
    let acceleration = |crank: f64, rate: f64| {
        let (q, v) = onto(crank, rate);
        let (a, _) = force_states::accelerations(&bars, &StateAt { t: 0.0, q: &q, v: &v, x: &[] });
        let all = quantities_at(&bars, &StateAt { t: 0.0, q: &q, v: &v, x: &[] });
        let values = named(&bars, &["middle_z", "rocker_psi_rate", "crank_psi_drive_torque"]);
        [vec![a[0]], values.iter().map(|output| all[output.index]).collect()].concat()
    };
    let h = 1e-3;
    for (column, [dq, dv]) in [[h, 0.0], [0.0, h]].into_iter().enumerate() {
        let [after, before] = [1.0, -1.0].map(|sign| acceleration(crank + sign * dq, rate + sign * dv));
        for row in 0..4 {
            // Curvature, h².
            let difference = (after[row] - before[row]) / (2.0 * h);
            let entry = if row == 0 { found.a[(1, column)] } else { found.c[(row - 1, column)] };
            assert!(
                (entry - difference).abs() < 2e-5 * (1.0 + difference.abs()),
                "row {row}, column {column}: {entry} for {difference}"
            );
        }
    }
}

/// The response to a step of an effort is that of the model up to the square of the step: halved, the rest is a quarter.
#[test]
fn a_step_differs_from_its_model_by_its_square() {
    for (crane, coordinate, push) in [(four_bar(), 0, 60.0), (boom(), 1, 2000.0)] {
        let q = at_rest(&crane);
        let v = vec![0.0; q.len()];
        let index = crane.description().inputs.iter().position(|input| input.name == "torque").unwrap();
        let model = linear_model(&crane, &about(&q, &v, Forces::Holding), &[Input::Spec(index)], &[]).unwrap();
        let time = 0.25;
        let expected = held(&model, time);
        let rest = |push: f64| {
            let mut changed = crane.clone();
            DynCrane::set_input(&mut changed, index, Some(push));
            let end = run(&changed, &q, time);
            end[coordinate] - q[coordinate] - push * expected[coordinate]
        };
        let (whole, half) = (rest(push), rest(0.5 * push));
        // The third order of the step.
        assert!(whole.abs() > 1e-5 && (whole / half - 4.0).abs() < 0.2, "{whole:e} and {half:e}");
    }
}

/// A boom with an arm that hangs on it, whose weight turns as it swings.
fn boom() -> LiveCrane {
    crane(
        "format: 1\nname: boom\ninputs: {torque: {unit: N m}}\nlinks:\n\
         - {name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 200, com: [1.5, 0, 0], inertia: {gyration: [0.1, 0.8, 0.8]}}\n\
         - {name: bob, placement: {transform: {translation: [3, 0, 0]}}, joint: revolute, mass: 150, com: [0, -1, 0], inertia: {gyration: [0.1, 0.2, 0.2]}}\n\
         drives:\n- {coordinate: boom_psi, stiffness: 2e5, damping: 4e3, effort: {input: torque}, motion: {hold: 40 deg}}\n",
    )
}

/// x(T) of `ẋ = A x + b` from 0, by the Taylor series.
fn held(model: &LinearModel, time: f64) -> DVector<f64> {
    let n = model.a.nrows();
    let mut matrix = DMatrix::zeros(n + 1, n + 1);
    matrix.view_mut((0, 0), (n, n)).copy_from(&model.a);
    matrix.view_mut((0, n), (n, 1)).copy_from(&model.b);
    let exponential = (matrix * time).exp();
    exponential.view((0, n), (n, 1)).column(0).into_owned()
}

fn run(crane: &LiveCrane, q: &[f64], time: f64) -> Vec<f64> {
    let settings = Settings {
        method: Method::DormandPrince,
        duration: time,
        output: time,
        tolerance: 1e-11,
        ..Settings::from_description(crane.description())
    };
    let mut end = Vec::new();
    (crane as &dyn DynCrane)
        .simulate(&InitialState::at_rest(q.to_vec()), &settings, &mut |sample| {
            end = sample.q.to_vec();
            ControlFlow::Continue(())
        })
        .unwrap();
    end
}

/// Motions, efforts and their outputs: `s (q_dr − q) + d (q̇_dr − q̇) + τ`.
#[test]
fn drives_act_with_their_springs() {
    let crane = boom();
    let q = at_rest(&crane);
    let model = linear_model(
        &crane,
        &about(&q, &[0.0; 2], Forces::Holding),
        &all_inputs(&crane),
        &named(&crane, &["boom_psi_drive_torque", "boom_psi_prescribed"]),
    )
    .unwrap();
    let names: Vec<&str> = model.inputs.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["torque", "boom_psi_prescribed", "boom_psi_prescribed_rate", "boom_psi_drive_torque"]);
    let column = |index: usize| model.b.column(index).into_owned();
    for (index, factor) in [(0, 1.0), (1, 2e5), (2, 4e3)] {
        let off = (column(index) - column(3) * factor).amax();
        assert!(off < 1e-9 * factor * column(3).amax(), "{}: {off:e}", names[index]);
    }
    let expected = [[1.0, 2e5, 4e3, 1.0], [0.0, 1.0, 0.0, 0.0]];
    for (row, expected) in expected.iter().enumerate() {
        for (index, expected) in expected.iter().enumerate() {
            let value = model.d[(row, index)];
            assert!((value - expected).abs() < 1e-6 * expected.abs().max(1.0), "{row} {index}: {value} for {expected}");
        }
    }
    // The spring answers the boom.
    assert!((model.c[(0, 0)] + 2e5).abs() < 1.0 && (model.c[(0, 2)] + 4e3).abs() < 1e-2);
}

/// D of a joint that rests on either stop has the drive's damping, the viscous part of its friction, and `a` times the force of the stop; its dry
/// friction, of which a joint that swings feels little, is left out.
#[test]
fn a_joint_with_friction_keeps_the_damping_of_its_stop() {
    for (end, sign) in [("max", 1.0), ("min", -1.0)] {
        let crane = crane(&format!(
            "format: 1\nname: arm\nlinks: [{{name: arm, joint: revolute, mass: 100, com: [1, 0, 0]}}]\n\
             drives: [{{coordinate: arm_psi, damping: 3000, stiffness: 3e6, motion: {{hold: {}}}}}]\n\
             stops: {{arm_psi: {{{end}: 0, damping: 0.3, stiffness: 1e6}}}}\n\
             friction: {{arm_psi: {{coulomb: 300, breakaway: 400, viscous: 50, width: 0.005}}}}\n",
            sign * 4e-3
        ));
        let q = at_rest(&crane);
        // Two springs in a row: 3e6 (4 mrad − q) = 1e6 q.
        assert!((q[0] - sign * 3e-3).abs() < 1e-12, "{q:?}");
        let model = linear_model(&crane, &about(&q, &[0.0], Forces::Holding), &[], &[]).unwrap();
        let damping = model.small_motions().damping[(0, 0)];
        // To rounding of the slope of dry friction, 8e4.
        let expected = 3000.0 + 50.0 + 0.3 * 1e6 * 3e-3;
        assert!((damping - expected).abs() < 1e-8, "{end}: {damping} for {expected}");
    }
}

#[test]
fn what_cannot_be_linearised_is_named() {
    let rigid = crane(
        "format: 1\nname: rigid\nlinks:\n- {name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 200, com: [1.5, 0, 0], inertia: {gyration: [0.1, 0.8, 0.8]}}\n\
         - {name: bob, placement: {transform: {translation: [3, 0, 0]}}, joint: revolute, mass: 150, com: [0, -1, 0], inertia: {gyration: [0.1, 0.2, 0.2]}}\n\
         drives:\n- {coordinate: boom_psi, rigid: true, motion: {hold: 40 deg}}\n",
    );
    let q = at_rest(&rigid);
    let none = linear_model(&rigid, &about(&q, &[0.0; 2], Forces::Holding), &[Input::Motion(0)], &[]).unwrap_err();
    assert_eq!(
        none.to_string(),
        "the input `boom_psi_prescribed` belongs to a rigid drive: give the drive a `stiffness`"
    );
    let model = linear_model(&rigid, &about(&q, &[0.0; 2], Forces::Holding), &[], &[]).unwrap();
    assert_eq!(model.coordinates(), [1]);
    let wrong = linear_model(&rigid, &about(&q, &[0.0; 2], Forces::Given(&[1.0])), &[], &[]).unwrap_err();
    assert_eq!(wrong, NoModel::States(1, 0));
    assert!(ForceStates::new(rigid.description()).is_empty());
}
