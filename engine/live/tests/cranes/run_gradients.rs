//! Derivatives of runs, against closed forms and against differences of tight runs.

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_live::sensitivity::runs::{Along, run_with_adjoint, run_with_gradients};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{Method, Settings};
use crane_model::results::Table;
use crane_model::runs::{Gradients, Measure, Start, record};
use std::ops::ControlFlow;

fn spec(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// A shipped crane, whose numbers become live parameters as `changes` writes them.
fn shipped(name: &str, changes: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap();
    let source = if changes.is_empty() { source } else { source.changed(&format!("name: changed\n{changes}")) };
    LiveCrane::from_spec(&source).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn settings(crane: &LiveCrane, duration: f64, output: f64, tolerance: f64) -> Settings {
    let own = Settings::from_description(crane.description());
    Settings { duration, output, tolerance, audit: false, method: Method::Rosenbrock, ..own }
}

/// A pose and rates to start from instead of equilibrium.
type State = Option<(Vec<f64>, Vec<f64>)>;

fn start(crane: &LiveCrane, from: &State) -> Start {
    match from {
        Some((q, v)) => Start::with(crane, 0.0, Some(q), Some(v)),
        None => Start::new(crane),
    }
    .unwrap_or_else(|failed| panic!("{failed}"))
}

fn gradients(crane: &LiveCrane, names: &[&str], from: &State, settings: &Settings) -> (Table, Gradients) {
    let along: Vec<Along> =
        names.iter().map(|name| Along::named(crane, name).unwrap_or_else(|not| panic!("{not}"))).collect();
    let found = run_with_gradients(crane, &start(crane, from), settings, &along, &mut |_| ControlFlow::Continue(()));
    let (recorded, gradients) = found.unwrap_or_else(|failed| panic!("{failed}"));
    (recorded.table, gradients)
}

/// The run of a crane with a number changed by a step.
fn changed(crane: &LiveCrane, along: Along, step: f64, from: &State, settings: &Settings) -> Table {
    let mut crane = crane.clone();
    let mut start = start(&crane, from);
    match along {
        Along::Parameter(index) => {
            crane.set_parameter(index, crane.parameters()[index] + step).unwrap();
            start = self::start(&crane, from);
        }
        Along::Input(index) => {
            crane.set_input(index, Some(crane.input(index).unwrap() + step));
            start = self::start(&crane, from);
        }
        Along::Position(coordinate) => start.q[coordinate] += step,
        Along::Rate(coordinate) => start.v[coordinate] += step,
    }
    record(&crane, &start, settings, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|failed| panic!("{failed}"))
        .table
}

/// Compares the derivatives of all columns with central differences of runs of step h and h/2, extrapolated, to a fraction of the largest
/// derivative of the column.
fn assert_differences(
    what: &str,
    crane: &LiveCrane,
    (names, steps): (&[&str], &[f64]),
    from: &State,
    run: &Settings,
    tolerance: f64,
) {
    let (table, found) = gradients(crane, names, from, run);
    // Runs pass the kinks of valves and bristles with larger errors than their derivatives do, whose steps end there.
    let tight = if crane.description().has_force_states() { 1e-12 } else { 1e-11 };
    let tight = Settings { tolerance: tight, ..*run };
    let (mut compared, mut wrong) = (0, Vec::new());
    for ((name, step), found) in names.iter().zip(steps).zip(&found) {
        let along = Along::named(crane, name).unwrap();
        let [far, near] = [*step, 0.5 * step].map(|step| {
            let [less, more] = [-step, step].map(|step| changed(crane, along, step, from, &tight));
            move |row: usize, column: usize| (more.rows[row][column] - less.rows[row][column]) / (2.0 * step)
        });
        for (column, info) in table.columns.iter().enumerate().skip(1) {
            let expected: Vec<f64> =
                (0..table.rows.len()).map(|row| (4.0 * near(row, column) - far(row, column)) / 3.0).collect();
            let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, |size: f64, x| size.max(x.abs()));
            let size = largest(&mut expected.iter().copied());
            // What a number does not change is rounding, and the steps follow the errors of the motion: what the whole number would change by less
            // than 1e-3 of the column, or of 1 m or rad, is compared with that.
            let values = largest(&mut table.rows.iter().map(|row| row[column]));
            let kinematic = info.unit.starts_with("rad") || info.unit == "m" || info.unit == "m/s";
            let size = size.max(1e-3 * if kinematic { values.max(1.0) } else { values } / (50.0 * step));
            if found[0][column].is_nan() || size == 0.0 || size * step < 1e-6 * values {
                continue;
            }
            for (row, expected) in expected.iter().enumerate() {
                let (t, own) = (table.rows[row][0], found[row][column]);
                let off = (own - expected).abs() / size;
                compared += 1;
                if off.is_nan() || off > tolerance {
                    let column = &info.name;
                    wrong.push((
                        off,
                        format!("d {column}/d {name} at {t} s is {own:e}, not {expected:e}, of {size:e}: {off:.1e}"),
                    ));
                }
            }
        }
    }
    wrong.sort_by(|one, other| other.0.total_cmp(&one.0));
    let words: Vec<&str> = wrong.iter().take(12).map(|(_, words)| words.as_str()).collect();
    assert!(wrong.is_empty(), "{what}: {} of {compared}\n{}", wrong.len(), words.join("\n"));
    assert!(compared > 20, "{what}: {compared}");
}

const OSCILLATOR: &str = "
format: 1
name: oscillator
parameters: {k: {value: 400}, m: {value: 4}}
analyses: [dynamics]
links:
  - {name: mass, joint: {prismatic: {axis: x}}, mass: m, com: [0, 0, 0]}
drives: [{coordinate: mass_x, stiffness: k, motion: {hold: 0}}]
";

/// x = x₀ cos ωt + v₀/ω sin ωt with ω = √(k/m), differentiated by hand.
#[test]
fn a_mass_on_a_spring_has_the_derivatives_of_its_formula() {
    let crane = spec(OSCILLATOR);
    let [x, v]: [f64; 2] = [0.3, -0.5];
    let run = settings(&crane, 2.0, 0.1, 1e-9);
    let names = ["k", "m", "q0.mass_x", "v0.mass_x"];
    let (table, found) = gradients(&crane, &names, &Some((vec![x], vec![v])), &run);
    let omega = 10.0_f64;
    for (row, values) in table.rows.iter().enumerate() {
        let t = values[0];
        let (sin, cos) = (omega * t).sin_cos();
        let by_omega = -x * t * sin + v * (t * cos / omega - sin / (omega * omega));
        // dω/dk = ω/2k, dω/dm = −ω/2m.
        let expected = [by_omega * omega / 800.0, -by_omega * omega / 8.0, cos, sin / omega];
        for ((name, expected), found) in names.iter().zip(expected).zip(&found) {
            // Sixty periods' worth of steps at 1e-9: errors of some 1e-7.
            let off = (found[row][1] - expected).abs() / (1.0 + expected.abs());
            assert!(off < 1e-6, "dx/d{name} at {t} s: {} for {expected}, off by {off:e}", found[row][1]);
        }
    }
}

/// A damper of zero cannot be smaller: the force of the drive, `F = −k x − c v`, changes by the step to the other side alone. About c = 0,
/// `∂x/∂c = x₀ (sin ωt/(2 m ω) − t cos ωt/(2 m))`.
#[test]
fn a_number_at_its_bound_changes_to_the_other_side() {
    let damped = OSCILLATOR
        .replace("parameters: {", "parameters: {c: {value: 0}, ")
        .replace("stiffness: k,", "stiffness: k, damping: c,");
    let crane = spec(&damped);
    assert!(crane.clone().set_parameter(0, -1e-6).is_err(), "zero is the bound");
    let x = 0.3;
    let run = settings(&crane, 1.0, 0.05, 1e-9);
    let (table, found) = gradients(&crane, &["c"], &Some((vec![x], vec![0.0])), &run);
    let column = table.columns.iter().position(|column| column.name == "mass_x_drive_force").expect("a column");
    let (k, m) = (400.0, 4.0);
    let omega = f64::sqrt(k / m);
    for (row, values) in table.rows.iter().enumerate() {
        let t = values[0];
        let (sin, cos) = (omega * t).sin_cos();
        assert!((values[column] + k * x * cos).abs() < 1e-5 * k * x, "the force at {t} s");
        let expected = -k * x * (sin / (2.0 * m * omega) - t * cos / (2.0 * m)) + x * omega * sin;
        // Errors of the run, and of a difference to one side, grow with what the column changes: some 15 N s/m.
        let off = (found[0][row][column] - expected).abs();
        assert!(off < 1e-4 * 15.0, "∂F/∂c at {t} s: {} for {expected}", found[0][row][column]);
    }
}

/// A mass that falls on a foot without a damper.
///
/// Until `t₁ = √(2h/g)` it falls freely; then `z = e^(−δτ) (A cos ντ + B sin ντ) − mg/k` with τ = t − t₁.
#[test]
fn a_mass_that_falls_on_a_foot_has_the_derivatives_of_its_formula() {
    let text = "
format: 1
name: falling
parameters: {k: {value: 2e4}, g: {value: -9.81}}
gravity: [0, 0, g]
analyses: [dynamics]
links: [{name: body, joint: free, mass: 20, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}]
supports: [{name: foot, one_sided: true, at: [0, 0, 0], stiffness: [1e3, 1e3, k], damping: [0, 0, 0]}]
";
    let crane = spec(text);
    let place = crane.description().coordinates.iter().position(|info| info.name == "body_z").unwrap();
    let height = 0.05;
    let mut q = vec![0.0; crane.size()];
    q[place] = height;
    let run = settings(&crane, 0.16, 0.004, 1e-9);
    let names = ["k", "g", "q0.body_z", "v0.body_z"];
    let z = |[k, g, h, v0]: [f64; 4], t: f64| {
        let (m, d, g) = (20.0, 0.0, -g);
        let contact = (v0 + (v0 * v0 + 2.0 * g * h).sqrt()) / g;
        if t < contact {
            return h + v0 * t - 0.5 * g * t * t;
        }
        let (tau, delta, sag) = (t - contact, 0.5 * d / m, m * g / k);
        let nu = (k / m - delta * delta).sqrt();
        let (a, speed) = (sag, v0 - g * contact);
        let b = (speed + delta * a) / nu;
        (-delta * tau).exp() * (a * (nu * tau).cos() + b * (nu * tau).sin()) - sag
    };
    let numbers = [2e4, -9.81, height, 0.0];
    let zeros = vec![0.0; q.len()];
    let (table, found) = gradients(&crane, &names, &Some((q, zeros)), &run);
    let mut touched = 0;
    for (row, values) in table.rows.iter().enumerate() {
        let t = values[0];
        let own = z(numbers, t);
        assert!((values[1 + place] - own).abs() < 1e-7, "z at {t}: {} for {own}", values[1 + place]);
        touched += usize::from(own < 0.0);
        for (index, name) in names.iter().enumerate() {
            let step = 1e-5 * if numbers[index] == 0.0 { 1.0 } else { numbers[index].abs() };
            let with = |step: f64| {
                let mut other = numbers;
                other[index] += step;
                z(other, t)
            };
            // Of order 4: 1e-11 of rounding.
            let expected = (8.0 * (with(step) - with(-step)) - (with(2.0 * step) - with(-2.0 * step))) / (12.0 * step);
            let scale = [1e-6, 0.01, 1.0, 0.1][index];
            let off = (found[index][row][1 + place] - expected).abs() / scale;
            assert!(off < 1e-4, "dz/d{name} at {t} s: {} for {expected}, off by {off:e}", found[index][row][1 + place]);
        }
    }
    assert!(touched > 5, "{touched} results on the foot");
}

/// The path of a mass that meets an end stop by Hunt and Crossley's law, rebounds, and meets it again.
#[test]
fn a_mass_that_bounces_on_a_stop_changes_as_its_runs_do() {
    let text = "
format: 1
name: bouncing
parameters: {m: {value: 4}, k: {value: 1e4}, a: {value: 0.3}, floor: {value: -0.1}}
analyses: [dynamics]
links: [{name: ball, joint: {prismatic: {axis: z}}, mass: m, com: [0, 0, 0]}]
stops: {ball_z: {min: floor, stiffness: k, damping: a}}
";
    let crane = spec(text);
    let run = settings(&crane, 1.0, 0.05, 1e-10);
    let numbers = (&["m", "k", "a", "floor", "q0.ball_z", "v0.ball_z"][..], &[0.01, 10.0, 1e-3, 1e-4, 1e-4, 1e-3][..]);
    assert_differences("bouncing", &crane, numbers, &Some((vec![0.1], vec![0.2])), &run, 3e-5);
}

/// A drive whose prescribed acceleration jumps at times that depend on a parameter.
#[test]
fn motions_that_begin_and_end_later_move_the_run() {
    let crane = spec(
        "
format: 1
name: swinging
parameters: {far: {value: 0.8}, begin: {value: 0.3}, span: {value: 0.9}}
analyses: [statics, dynamics]
links:
  - {name: arm, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 20, com: [0.5, 0, 0], inertia: {Ixx: 1, Iyy: 2, Izz: 2}}
  - {name: load, placement: {transform: {translation: [1, 0, 0]}}, joint: revolute, mass: 10, com: [0, -0.5, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
drives: [{coordinate: arm_psi, stiffness: 2e4, damping: 300, motion: {trapezoid: {from: 0.2, to: far, begin: begin, duration: span}}}]
",
    );
    // A jump changes derivatives by all of their size within a step, and is right to 1e-4 of it. No result is at the begin or the end of the
    // motion, on whose two sides derivatives differ.
    let run = settings(&crane, 1.96, 0.07, 1e-10);
    let numbers = (&["far", "begin", "span"][..], &[0.01, 1e-3, 3e-3][..]);
    assert_differences("trapezoid", &crane, numbers, &None, &run, 3e-4);
}

#[test]
fn inputs_move_the_run() {
    let text = "
format: 1
name: steered_arm
inputs:
  lever: {motion: {quintic: {from: 0, to: 60 deg, duration: 3}}, unit: rad}
  gust: {value: 0, unit: N}
links:
  - {name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 200, com: [2, 0, 0], inertia: {gyration: [0.1, 1.2, 1.2]}}
drives:
  - {coordinate: boom_psi, stiffness: 2e5, damping: 2e4, motion: {input: lever}}
loads:
  - {name: wind, link: boom, at: [4, 0, 0], force: [0, 1, 0], scale: {input: gust}}
";
    let mut crane = spec(text);
    crane.set_input(1, Some(500.0));
    let run = settings(&crane, 1.0, 0.05, 1e-10);
    assert_differences("gust", &crane, (&["inputs.gust", "v0.boom_psi"], &[50.0, 0.05]), &None, &run, 1e-5);
    let refused = Along::named(&crane, "inputs.lever").unwrap_err().to_string();
    assert!(refused.contains("is not set"), "{refused}");
    crane.set_input(0, Some(0.4));
    assert_differences("lever", &crane, (&["inputs.lever"], &[0.02]), &Some((vec![0.1], vec![0.0])), &run, 1e-5);
}

#[test]
fn what_a_run_does_not_depend_on_is_refused() {
    let crane = shipped("knuckle_boom", "");
    for (name, words) in
        [("mass", "a live parameter (payload)"), ("q0.nothing", "q0."), ("inputs.r", "differentiate a run by")]
    {
        let refused = Along::named(&crane, name).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn a_stiff_flexible_crane_changes_as_its_runs_do() {
    let crane = shipped("eight_link_flexible", "");
    let run = settings(&crane, 1.0, 0.1, 1e-10);
    // Steps of 1e-10 leave some 5e-5 in what stiff drives and a load that hardly swings magnify.
    assert_differences("flexible", &crane, (&["load_mass", "q0.boom_psi"], &[25.0, 1e-3]), &None, &run, 1e-4);
}

/// Beams, their sections, a rigid drive and feet that lift.
#[test]
fn stiffness_sections_drives_and_feet_count() {
    let changes = "parameters:\n  young: {value: 2.1e11, unit: Pa}\n  height: {value: 0.34, unit: m}\n  slew: {value: 2.6, unit: rad}\n  \
                   lift: {value: 0.9, unit: rad}\n  spring: {value: 2e7, unit: N m/rad}\nlinks:\n  - {name: boom, beam: \
                   {material: {E: young, G: 8.1e10, density: 7850, yield_stress: 700e6}, section: {box: {height: height, width: 0.24, thickness: 0.008}}}}\n\
                   drives:\n  - {coordinate: column_psi, motion: {quintic: {from: 180 deg, to: slew, duration: 2}}}\n  \
                   - {coordinate: boom_psi, rigid: true, stiffness: ~, damping: ~, motion: {quintic: {from: 55 deg, to: lift, duration: 2}}}\n  \
                   - {coordinate: jib_psi, stiffness: spring}\n";
    let crane = shipped("loader_tipping", changes);
    let run = settings(&crane, 1.0, 0.1, 1e-10);
    let numbers =
        (&["load", "young", "height", "slew", "lift", "spring"][..], &[11.0, 1e9, 1e-3, 0.01, 0.005, 1e5][..]);
    assert_differences("loader", &crane, numbers, &None, &run, 1e-4);
}

#[test]
fn loops_with_rigid_drives_change_as_their_runs_do() {
    let changes = "parameters:\n  lift: {value: 1.1, unit: rad}\n  pin: {value: 2.19, unit: m}\nloop_joints: \
                   [{name: parallel_pin, from: {link: column, at: [-0.23, 0, pin]}}]\n\
                   drives:\n  - {coordinate: boom_psi, rigid: true, stiffness: ~, damping: ~, motion: {quintic: {from: 60 deg, to: lift, duration: 1}}}\n";
    let crane = shipped("examples/parallel_harvester", changes);
    let run = settings(&crane, 0.6, 0.1, 1e-10);
    assert_differences("harvester", &crane, (&["head_mass", "lift", "pin"], &[12.0, 0.01, 1e-3]), &None, &run, 3e-5);
}

/// A pendulum that drives another one through gears with a live ratio and play.
#[test]
fn rigid_couplings_change_as_their_runs_do() {
    let crane = spec(
        "format: 1\nname: geared\nparameters: {ratio: {value: 1.6}, play: {value: 0.2, unit: rad}, mass: {value: 3, unit: kg}}\nlinks:\n\
         - {name: one, joint: {revolute: {axis: y}}, mass: 5, com: [0.5, 0, 0.1], inertia: {gyration: [0.2, 0.2, 0.2]}}\n\
         - {name: two, placement: {transform: {translation: [1, 0, 0]}}, joint: {revolute: {axis: y}}, mass: mass, com: [0.4, 0, 0], inertia: {gyration: [0.2, 0.2, 0.2]}}\n\
         couplings: [{name: gear, coordinate: two_theta, follows: one_theta, ratio: ratio, offset: play, rigid: true}]\n\
         drives: [{coordinate: one_theta, stiffness: 300, damping: 8, motion: {quintic: {from: 0.3, to: -0.4, duration: 0.5}}}]\n\
         points: [{name: tip, link: two, at: [1, 0, 0]}]\n",
    );
    let run = settings(&crane, 0.8, 0.1, 1e-11);
    assert_differences("geared", &crane, (&["ratio", "play", "mass"], &[1e-2, 1e-2, 0.05]), &None, &run, 3e-5);
}

/// Ropes with falls, a telescope on pads, feet.
#[test]
fn a_crane_with_a_telescope_and_a_rope_changes_as_its_runs_do() {
    let crane = shipped("examples/telescopic_loader", "");
    let run = settings(&crane, 0.2, 0.1, 1e-10);
    // The payload hardly changes the lateral forces of the feet, a few mN per kg of kN: this is their accuracy; all others agree to 3e-5.
    assert_differences("telescope", &crane, (&["payload"], &[4.0]), &None, &run, 4e-3);
}

/// A load on a cylinder that a valve fills.
fn lift(parameters: &str, inputs: &str, motion: &str, valve: &str) -> LiveCrane {
    spec(&format!(
        "
format: 1
name: lift
parameters: {{mass: {{value: 800, unit: kg}}, pin: {{value: -1, unit: m}}{parameters}}}
{inputs}
analyses: [statics, dynamics]
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - {{name: arm, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: mass, com: [2, 0, 0], inertia: {{gyration: [0.1, 1, 1]}}}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: arm_psi, stiffness: 1e8, motion: {{{motion}}}}}
cylinders:
  - name: ram
    coordinate: arm_psi
    foot: {{link: post, at: [0.3, 0, pin]}}
    head: {{link: arm, at: [0.9, -0.1, 0]}}
    bore: 0.1
    rod: 0.06
    retracted: 0.8
    stroke: 0.7
    back_pressure: 3e5
    max_pressure: 2.5e7
    bulk_modulus: 1.3e9
    hose_volumes: [6e-4, 4e-4]
    valve: {{flow: 6e-4, pressure_drop: 1e6, lag: 0.03, {valve}}}
pump: {{max_flow: 1e-3, pressure: 2e7, volume: 4e-3}}
"
    ))
}

#[test]
fn a_servo_with_a_valve_changes_as_its_runs_do() {
    let crane =
        lift(", far: {value: 0.25}", "", "quintic: {from: 0.1, to: far, duration: 1}", "gain: 6, leakage: 2e-13");
    let run = settings(&crane, 0.9, 0.05, 1e-11);
    let numbers = (&["mass", "pin", "far"][..], &[0.1, 1e-4, 1e-3][..]);
    assert_differences("servo", &crane, numbers, &None, &run, 3e-4);
    // At rest the rod's side is at the pressure at which its suction valve opens: derivatives by the start differ on both sides.
    let numbers = (&["mass", "pin", "q0.arm_psi", "v0.arm_psi"][..], &[1.0, 1e-4, 1e-4, 1e-3][..]);
    assert_differences("servo", &crane, numbers, &Some((vec![0.0, 0.15], vec![0.0, 0.05])), &run, 3e-4);
}

/// The valve is shut by its overlap, opens within hundredths of a second, or shuts.
#[test]
fn a_valve_that_opens_in_a_step_changes_as_its_runs_do() {
    for (name, [from, to]) in [("opens", ["0", "open"]), ("shuts", ["open", "0"])] {
        let opening =
            format!("overlap: 0.05, opening: {{quintic: {{from: {from}, to: {to}, begin: begin, duration: 0.03}}}}");
        let crane = lift(", begin: {value: 0.2}, open: {value: -0.4}", "", "hold: 0.1", &opening);
        let run = settings(&crane, 0.7, 0.07, 1e-10);
        let numbers = (
            &["mass", "pin", "begin", "open", "q0.arm_psi", "v0.arm_psi"][..],
            &[1.0, 1e-4, 1e-4, 1e-3, 1e-4, 1e-3][..],
        );
        assert_differences(name, &crane, numbers, &Some((vec![0.0, 0.1], vec![0.0, 0.02])), &run, 3e-4);
    }
}

#[test]
fn a_valve_with_a_lever_changes_as_its_runs_do() {
    let mut crane = lift("", "inputs: {lever: {value: 0}}", "hold: 0.1", "overlap: 0.05, opening: {input: lever}");
    crane.set_input(0, Some(0.4));
    let run = settings(&crane, 0.6, 0.05, 1e-10);
    let numbers = (&["inputs.lever", "mass", "pin"][..], &[1e-3, 1.0, 1e-4][..]);
    assert_differences("lever", &crane, numbers, &None, &run, 1e-4);
}

#[test]
fn a_hydraulic_crane_changes_as_its_runs_do() {
    let changes = "parameters: {pin: {value: 1.1}, rocker: {value: 0.45}}\ncylinders:\n  - {name: boom_cylinder, foot: {link: column, at: [0.3, 0, pin]}, valve: {gain: 6}}\n  - {name: outer_boom_cylinder, linkage: {pivot: [3.2, 0.15, 0], rocker: rocker, link: 0.45, side: left}, valve: {gain: 6}}\n  - {name: telescope_cylinder, valve: {gain: 6}}\n";
    let crane = shipped("eight_link_hydraulic", changes);
    // A foot lifts at 0.1 s, since the gains are high.
    let run = settings(&crane, 0.36, 0.09, 1e-10);
    assert_differences("hydraulic", &crane, (&["load_mass", "pin", "rocker"], &[2.0, 1e-4, 1e-4]), &None, &run, 2e-3);
}

const SLIDE: &str = "
format: 1
name: slide
parameters: {m: {value: 40}, k: {value: 2000}, push: {value: 200}}
gravity: [0, 0, 0]
analyses: [dynamics]
links: [{name: slide, joint: {prismatic: {axis: x}}, mass: m, com: [0, 0, 0]}]
drives: [{coordinate: slide_x, stiffness: k, motion: {hold: 0}}]
loads: [{name: push, link: slide, at: [0, 0, 0], force: [push, 0, 0]}]
friction:
  slide_x: {coulomb: 100, breakaway: 150, stribeck: 0.02, viscous: 30, bristle: {stiffness: 2e5, damping: 900}}
";

#[test]
fn bristles_that_stick_and_slip_change_as_their_runs_do() {
    let crane = spec(SLIDE);
    let run = settings(&crane, 1.0, 0.05, 1e-10);
    let numbers = (&["m", "k", "push", "q0.slide_x", "v0.slide_x"][..], &[0.01, 0.5, 0.05, 1e-5, 1e-4][..]);
    // It slips, turns back, and sticks.
    assert_differences("slip", &crane, numbers, &Some((vec![0.2], vec![0.3])), &run, 3e-4);
    // It sticks all the time.
    assert_differences("stick", &crane, numbers, &Some((vec![0.01], vec![0.0])), &run, 1e-4);
}

const PUSHED: &str = "
format: 1
name: block
parameters: {m: {value: 100}, mu: {value: 0.3}, k: {value: 1e5}, d: {value: 1e3}, push: {value: 330}}
gravity: [0.5, 0, -9.8]
links:
  - {name: block, joint: free, mass: m, com: [0, 0, 0.3], inertia: {Ixx: 20, Iyy: 20, Izz: 30}}
supports:
  - {name: a, at: [1, 1, 0], one_sided: true, friction_coefficient: mu, stiffness: [k, k, 3e5], damping: [d, d, 2e3]}
  - {name: b, at: [1, -1, 0], one_sided: true, friction_coefficient: mu, stiffness: [k, k, 3e5], damping: [d, d, 2e3]}
  - {name: c, at: [-1, 1, 0], one_sided: true, friction_coefficient: mu, stiffness: [k, 2e5, 3e5], damping: [50, d, 2e3]}
  - {name: d, at: [-1, -1, 0], one_sided: true, friction_coefficient: mu, stiffness: [k, k, 3e5], damping: [d, d, 2e3]}
loads:
  - {name: push, link: block, at: [0.2, 0.3, 0.3], force: [push, 150, 0], scale: {table: {times: [0, 0.1, 0.3, 0.4, 0.5, 0.6, 0.7, 9], values: [0, 1, 1, 0, 0, 0, 0, 0]}}}
";

/// It stands, is pushed until it slides and turns, and sticks elsewhere.
#[test]
fn feet_that_slide_and_stick_change_as_their_runs_do() {
    let crane = spec(PUSHED);
    // Errors of derivatives are not those of the motion where feet begin and cease to slide.
    let run = settings(&crane, 0.8, 0.05, 1e-12);
    let numbers = (&["m", "mu", "k", "d", "push"][..], &[1e-3, 1e-5, 2.0, 0.1, 0.01][..]);
    assert_differences("push", &crane, numbers, &None, &run, 3e-3);
}

/// A load that is lowered on its spring and comes off as its hook passes −0.5 m.
const DROP: &str = "
format: 1
name: drop
parameters: {load: {value: 590, unit: kg}, k: {value: 5e4, unit: N/m}, v: {value: -0.4, unit: m/s}}
analyses: [statics, dynamics]
links: [{name: hook, joint: {prismatic: {axis: z}}, mass: load, com: [0, 0, 0]}]
drives: [{coordinate: hook_z, stiffness: k, motion: {speed: {rate: v}}}]
events: [{name: drop, when: {result: hook_z, below: -0.5}, set: {load: 90}}]
";

/// When a load m on a spring k that is lowered at v passes −0.5 m, s, and where what is left of it then is at 1.2 s, by hand: the roots of
/// `z = −m g/k + v t − (v/ω) sin ωt`, and a spring that swings on.
fn dropped([m, k, v]: [f64; 3]) -> [f64; 2] {
    let omega = (k / m).sqrt();
    let before = |t: f64| -m * 9.81 / k + v * t - v / omega * (omega * t).sin();
    let rate = |t: f64| v - v * (omega * t).cos();
    let (mut early, mut late) = (0.5, 1.5);
    for _ in 0..60 {
        let middle = 0.5 * (early + late);
        if before(middle) < -0.5 { late = middle } else { early = middle }
    }
    let own = (k / 90.0).sqrt();
    let offset = before(late) + 90.0 * 9.81 / k - v * late;
    let (sin, cos) = (own * (1.2 - late)).sin_cos();
    [late, -90.0 * 9.81 / k + v * 1.2 + offset * cos + (rate(late) - v) / own * sin]
}

#[test]
fn an_event_on_a_condition_moves_with_what_it_depends_on() {
    let crane = spec(DROP);
    let numbers = [590.0, 5e4, -0.4];
    let settings = settings(&crane, 1.2, 0.1, 1e-10);
    let (table, found) = gradients(&crane, &["load", "k", "v"], &None, &settings);
    let along: Vec<Along> = (0..3).map(Along::Parameter).collect();
    let column = |name: &str| table.columns.iter().position(|column| column.name == name).unwrap();
    let asked = ["drop_time", "hook_z"].map(|name| (column(name), Measure::Final));
    let proceed = &mut |_: f64| ControlFlow::Continue(());
    let (_, backward) = run_with_adjoint(&crane, &start(&crane, &None), &settings, &along, &asked, proceed).unwrap();
    for (number, value) in numbers.iter().enumerate() {
        let at = |share: f64| {
            let mut numbers = numbers;
            numbers[number] += share * value;
            dropped(numbers)
        };
        let step = 1e-5;
        let ends = [at(-step), at(step)];
        for (index, (asked, _)) in asked.iter().enumerate() {
            let expected = (ends[1][index] - ends[0][index]) / (2.0 * step * value);
            // Differences of closed forms are exact to 1e-10 of numbers over 1e-5; the run's tolerance is 1e-10 m in each of a thousand steps.
            let size = expected.abs().max(1e-2 / value.abs());
            for own in [found[number].last().unwrap()[*asked], backward[index][number]] {
                assert!((own - expected).abs() < 1e-6 * size, "{index} by {number}: {own:e}, not {expected:e}");
            }
        }
    }
}

/// A pendulum on a trolley catches what flies, is braked because it moves fast then, and loses it later: an event on a condition, one that this makes due at
/// once, and one at a time.
const CATCHES: &str = "
format: 1
name: catches
parameters: {caught: {value: 2, unit: kg}, rod: {value: 10, unit: kg}, drag: {value: 5, unit: N m s/rad}, k: {value: 900, unit: N/m}}
analyses: [statics, dynamics]
links:
- {name: trolley, joint: {prismatic: {axis: x}}, mass: 100, com: [0, 0, 0]}
- {name: rod, joint: {revolute: {axis: y}}, mass: rod, com: [0, 0, -1], inertia: {Ixx: 10, Iyy: 10, Izz: 0.1}}
- {name: basket, placement: {transform: {translation: [0, 0, -2]}}, joint: fixed, mass: caught, com: [0, 0, 0]}
drives: [{coordinate: trolley_x, stiffness: k, damping: 40, motion: {quintic: {from: 0, to: 0.4, duration: 1}}}]
damping: {rod_theta: drag}
points: [{name: basket, link: basket}]
events:
- {name: catch, when: {result: basket_x, above: 0.3}, set: {caught: 7}, joins: {velocity: [3.5, 0, 1], point: basket}}
- {name: brake, when: {result: basket_vx, above: 1.8}, set: {drag: 20}}
- {name: lose, at: 1.13, set: {caught: 1}}
";

#[test]
fn derivatives_pass_events() {
    let crane = spec(CATCHES);
    let from = Some((vec![0.0, 0.25], vec![0.3, 0.1]));
    let run = settings(&crane, 1.6, 0.1, 1e-9);
    let (table, _) = gradients(&crane, &["rod"], &from, &run);
    let [Some(lose), Some(catch), Some(brake)] = table.times_of_events(crane.description())[..] else {
        panic!("an event does not happen")
    };
    assert!(catch < lose && brake == catch.next_up(), "{catch} {brake} {lose}");
    // Motions at events are interpolated, with errors of some 1e-8 that differ from run to run: over steps of 1e-3 these leave 1e-5 of large changes, and
    // 1e-4 of those by the drag, which are small.
    let numbers = ["caught", "rod", "drag", "k", "q0.rod_theta", "v0.trolley_x"];
    let steps = [2e-2, 1e-1, 5e-2, 5.0, 2e-3, 2e-3];
    assert_differences("catches", &crane, (&numbers, &steps), &from, &run, 2e-4);
}

/// The force of a rigid drive jumps over the value when its motion begins: when it would is not the derivative of anything.
#[test]
fn an_event_whose_result_jumps_has_no_derivatives() {
    let crane = spec(
        "
format: 1
name: jumps
parameters: {load: {value: 10, unit: kg}}
gravity: [0, 0, 0]
analyses: [dynamics]
links: [{name: car, joint: {prismatic: {axis: x}}, mass: load, com: [0, 0, 0]}]
drives: [{coordinate: car_x, rigid: true, motion: {trapezoid: {from: 0, to: 1, begin: 0.33, duration: 1}}}]
events: [{name: late, when: {result: car_x_drive_force, above: 5}, set: {load: 5}}]
",
    );
    let settings = settings(&crane, 1.0, 0.1, 1e-8);
    let proceed = &mut |_: f64| ControlFlow::Continue(());
    let told = run_with_gradients(&crane, &start(&crane, &None), &settings, &[Along::Parameter(0)], proceed);
    let told = told.expect_err("it jumps").to_string();
    assert!(
        told.contains("event `late` has no derivatives: its result jumps over the value, or only touches it"),
        "{told}"
    );
}
