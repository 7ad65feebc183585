//! Couplings that hold exactly, against closed forms.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Sample, Settings};
use crane_model::nalgebra::DVector;
use crane_model::results::{Recording, Table};
use crane_model::{Cut, loop_joints, modes, statics};

use super::loops::one_second;

const GRAVITY: f64 = 9.81;
/// Masses, kg, distances of their centres from the joints, m, and inertias about the joints, kg m².
const MASSES: [f64; 2] = [3.0, 5.0];
const CENTRES: [f64; 2] = [0.6, 0.4];
const INERTIAS: [f64; 2] = [1.3, 1.1];
const OFFSET: f64 = 0.3;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// Two pendulums on the ground that swing in the x-z plane, 0 is downwards; the second follows the first by a ratio that is live.
fn pendulums(ratio: f64, more: &str) -> LiveCrane {
    let link = |index: usize| {
        format!(
            "- {{name: {}, on: ground, placement: {{transform: {{translation: [{index}, 0, 0]}}}}, joint: {{revolute: {{axis: y}}}}, mass: {}, \
             com: [0, 0, {}], inertia: {{about: origin, Ixx: {inertia}, Iyy: {inertia}, Izz: 0.1}}}}\n",
            ["one", "two"][index],
            MASSES[index],
            -CENTRES[index],
            inertia = INERTIAS[index],
        )
    };
    crane(&format!(
        "format: 1\nname: pendulums\nanalyses: [statics, dynamics, modes, internal_forces]\nparameters: {{r: {{value: {ratio}}}}}\n\
         links:\n- {{name: ground}}\n{}{}couplings: [{{name: gear, coordinate: two_theta, follows: one_theta, ratio: r, offset: {OFFSET}, rigid: true}}]\n{more}",
        link(0),
        link(1)
    ))
}

/// Of the pendulums at an angle of the first: its acceleration and the torque F of the coupling.
///
/// ```text
/// (I₁ + r² I₂) θ̈ = −m₁ g l₁ sin θ − r m₂ g l₂ sin(r θ + c)        F = −m₂ g l₂ sin(r θ + c) − I₂ r θ̈
/// ```
fn by_hand(ratio: f64, theta: f64) -> [f64; 2] {
    let weight = [theta, ratio * theta + OFFSET];
    let weight = [0, 1].map(|i| -MASSES[i] * GRAVITY * CENTRES[i] * weight[i].sin());
    let acceleration = (weight[0] + ratio * weight[1]) / (INERTIAS[0] + ratio * ratio * INERTIAS[1]);
    [acceleration, weight[1] - INERTIAS[1] * ratio * acceleration]
}

/// A run, audited.
fn run(crane: &dyn DynCrane, settings: Settings, state: &InitialState) -> Table {
    let mut recording = Recording::new(crane);
    let settings = Settings { audit: true, ..settings };
    let run = crane.simulate(state, &settings, &mut |sample: &Sample<'_>| {
        recording.push(sample);
        ControlFlow::Continue(())
    });
    run.unwrap_or_else(|stopped| panic!("{stopped}"));
    recording.into_table()
}

fn column<'a>(table: &'a Table, name: &'a str) -> impl Iterator<Item = f64> + 'a {
    table.values(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// On the coupling, with the first pendulum at an angle and a rate.
fn state(ratio: f64, theta: f64, rate: f64) -> InitialState {
    InitialState { q: vec![theta, ratio * theta + OFFSET], v: vec![rate, ratio * rate], ..InitialState::default() }
}

#[test]
fn geared_pendulums_accelerate_as_one() {
    let (theta, rate) = (0.7, -1.4);
    for ratio in [2.0, -0.5] {
        // As written, and as set.
        let written = pendulums(ratio, "");
        let mut set = pendulums(0.1, "");
        set.set_parameters(&[ratio]).unwrap_or_else(|broken| panic!("{broken}"));
        for crane in [&written, &set] {
            let crane: &dyn DynCrane = crane;
            let start = state(ratio, theta, rate);
            let (q, v) = (&start.q, &start.v);
            let accelerations = crane.accelerations_at(0.0, q, v);
            let [acceleration, force] = by_hand(ratio, theta);
            // A few rounding errors of numbers of size 10.
            assert!(
                (accelerations[0] - acceleration).abs() < 1e-13
                    && (accelerations[1] - ratio * acceleration).abs() < 1e-13,
                "{accelerations}"
            );
            let table =
                run(crane, Settings { duration: 0.01, ..Settings::from_description(crane.description()) }, &start);
            let first = column(&table, "gear_torque").next();
            assert!(first.is_some_and(|first| (first - force).abs() < 1e-12), "{first:?} N m instead of {force}");
            // About its axis, a joint transmits what the coupling does: each pendulum exerts −Q on the ground.
            let wrenches = crane.internal_forces_at(0.0, q, v, accelerations.as_slice());
            let cuts = crane.description().cuts();
            // The ground is body 0.
            let about = |joint: usize| {
                let at = cuts.iter().position(|cut| *cut == Cut::Joint { body: joint + 1 });
                at.map(|at| wrenches[at].moment.y)
            };
            for (joint, expected) in [(0, -ratio * force), (1, force)] {
                assert!(
                    about(joint).is_some_and(|found| (found - expected).abs() < 1e-12),
                    "{:?} {expected}",
                    about(joint)
                );
            }
        }
    }
}

/// `½ (I₁ + r² I₂) θ̇² − m₁ g l₁ cos θ − m₂ g l₂ cos(r θ + c)` stays, and the coupling holds, with every method.
#[test]
fn runs_stay_on_the_coupling_and_keep_energy() {
    let ratio = 2.0;
    let crane = pendulums(ratio, "");
    let crane: &dyn DynCrane = &crane;
    let [first, second] = [0, 1].map(|i| MASSES[i] * GRAVITY * CENTRES[i]);
    let energy = |theta: f64, rate: f64| {
        0.5 * (INERTIAS[0] + ratio * ratio * INERTIAS[1]) * rate * rate
            - first * theta.cos()
            - second * (ratio * theta + OFFSET).cos()
    };
    // Rosenbrock's method damps; the others keep what their tolerance or step leaves of 60 J.
    for (method, accuracy) in
        [(Method::Rk4, 1e-8), (Method::DormandPrince, 1e-6), (Method::Rosenbrock, 1e-6), (Method::Bdf, 1e-4)]
    {
        let table = run(crane, one_second(crane, method), &state(ratio, 0.7, -1.4));
        let [q, v] = ["", "_rate"].map(|of| {
            let both = ["one", "two"].map(|name| column(&table, &format!("{name}_theta{of}")).collect::<Vec<f64>>());
            both[0].iter().copied().zip(both[1].clone()).collect::<Vec<_>>()
        });
        for ((theta, other), (rate, other_rate)) in q.into_iter().zip(v) {
            // Rounding of angles and rates of some units.
            let off = [other - ratio * theta - OFFSET, other_rate - ratio * rate];
            assert!(off[0].abs() < 1e-14 && off[1].abs() < 1e-13, "{method}: {off:?}");
            let change = energy(theta, rate) - energy(0.7, -1.4);
            assert!(change.abs() < accuracy, "{method}: {change:.1e} J");
        }
    }
}

/// With a drive of stiffness k at the first pendulum: `k (θ_dr − θ) = V'(θ)`, `ω² = (k + V'')/(I₁ + r² I₂)`.
#[test]
fn rest_and_vibration_are_those_of_one_coordinate() {
    let (ratio, aim, stiffness) = (2.0, 0.5, 300.0);
    let drive = format!("drives: [{{coordinate: one_theta, stiffness: {stiffness}, motion: {{hold: {aim}}}}}]\n");
    let crane = pendulums(ratio, &drive);
    let crane: &dyn DynCrane = &crane;
    assert_eq!(crane.guess(), [aim, ratio * aim + OFFSET], "the guess follows the coupling");
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    let [theta, other] = [equilibrium.q[0], equilibrium.q[1]];
    let [first, second] = [0, 1].map(|i| MASSES[i] * GRAVITY * CENTRES[i]);
    let slope = first * theta.sin() + ratio * second * other.sin();
    assert!((other - ratio * theta - OFFSET).abs() < 1e-15 && (stiffness * (aim - theta) - slope).abs() < 1e-9);
    let force = crane.loop_forces_at_rest(&equilibrium.q);
    assert!((force[0] + second * other.sin()).abs() < 1e-9, "{force:?}");
    let bend = stiffness + first * theta.cos() + ratio * ratio * second * other.cos();
    let omega = bend / (INERTIAS[0] + ratio * ratio * INERTIAS[1]);
    let modes = modes::undamped(&crane.small_motions_at(&equilibrium.q)).expect("modes");
    assert!(modes.len() == 1 && (modes[0].omega_squared / omega - 1.0).abs() < 1e-12, "{modes:?} {omega}");
}

/// Of a chain, the effective inertia has the product of both motions: `A_ii + 2 r A_ij + r² A_jj`.
#[test]
fn a_geared_chain_has_the_inertia_of_both_motions() {
    let ratio = -1.7;
    let chain = crane(&format!(
        "format: 1\nname: chain\nlinks:\n\
         - {{name: one, joint: {{revolute: {{axis: y}}}}, mass: 3, com: [0.5, 0, 0.1], inertia: {{Ixx: 0.1, Iyy: 0.4, Izz: 0.4}}}}\n\
         - {{name: two, placement: {{transform: {{translation: [1, 0, 0]}}}}, joint: {{prismatic: {{axis: x}}}}, mass: 2, com: [0.4, 0, 0], inertia: {{Ixx: 0.1, Iyy: 0.2, Izz: 0.2}}}}\n\
         - {{name: three, placement: {{transform: {{translation: [1, 0, 0]}}}}, joint: {{revolute: {{axis: y}}}}, mass: 2, com: [0.4, 0, 0.1], inertia: {{Ixx: 0.1, Iyy: 0.2, Izz: 0.2}}}}\n\
         couplings: [{{name: belt, coordinate: three_theta, follows: one_theta, ratio: {ratio}, rigid: true}}]\n"
    ));
    let chain: &dyn DynCrane = &chain;
    let (q, v) = ([0.4, 0.2, ratio * 0.4], [1.1, -0.3, ratio * 1.1]);
    let accelerations = chain.accelerations_at(0.0, &q, &v);
    let (inertia, bias) = (chain.mass_matrix_at(&q), chain.bias_at(&q, &v));
    let both = |i: usize, j: usize| inertia[(i, j)] + ratio * inertia[(2, j)];
    // Of the motions that leave the coupling closed.
    let row = |i: usize| {
        if i == 0 {
            [both(0, 0) + ratio * both(0, 2), both(0, 1)]
        } else {
            [inertia[(1, 0)] + ratio * inertia[(1, 2)], inertia[(1, 1)]]
        }
    };
    let [[a, b], [c, d]] = [row(0), row(1)];
    let right = [bias[0] + ratio * bias[2], bias[1]];
    let expected =
        DVector::from_vec(vec![(d * right[0] - b * right[1]), (a * right[1] - c * right[0])]) / (a * d - b * c);
    // A few rounding errors of numbers of size 10.
    assert!(
        (accelerations[0] - expected[0]).abs() < 1e-13 && (accelerations[1] - expected[1]).abs() < 1e-13,
        "{accelerations} {expected}"
    );
    assert!((accelerations[2] - ratio * expected[0]).abs() < 1e-13);
}

/// The chain of a telescope: by virtual work the drive carries the second stage's weight twice, and the chain carries it once.
#[test]
fn a_second_stage_follows_the_first_exactly() {
    let [first, second] = [30.0, 20.0];
    let telescope = |law: &str| {
        crane(&format!(
            "format: 1\nname: telescope\nlinks:\n- {{name: one, joint: {{prismatic: {{axis: z}}}}, mass: {first}, com: [0, 0, 0]}}\n\
             - {{name: two, joint: {{prismatic: {{axis: z}}}}, mass: {second}, com: [0, 0, 0]}}\n\
             drives: [{{coordinate: one_z, {law}}}]\n\
             couplings: [{{name: chain, coordinate: two_z, follows: one_z, ratio: 1, offset: 0.3, rigid: true}}]\n"
        ))
    };
    let motion = "motion: {quintic: {from: 0.2, to: 1.4, duration: 2}}";
    let effort = (first + 2.0 * second) * GRAVITY;
    for law in ["stiffness: 1e7, damping: 1e4", "rigid: true"] {
        let crane = telescope(&format!("{law}, {motion}"));
        let crane: &dyn DynCrane = &crane;
        let equilibrium = crane.equilibrium(&statics::Settings::default());
        assert!(equilibrium.is_stable(), "{equilibrium}");
        let q = equilibrium.q.clone();
        assert!((q[1] - q[0] - 0.3).abs() < 1e-15, "{q:?}");
        assert!((crane.drive_efforts_at_rest(&q)[0] / effort - 1.0).abs() < 1e-12, "{law}");
        assert!((crane.loop_forces_at_rest(&q)[0] / (-second * GRAVITY) - 1.0).abs() < 1e-12);
        // With the drive held elsewhere, the second stage is where the chain has it.
        let moved = statics::RestSearch { crane, positions: &[0.9] }.find_from_guess();
        assert!((moved.q[0] - 0.9).abs() < 1e-4 && (moved.q[1] - moved.q[0] - 0.3).abs() < 1e-15, "{:?}", moved.q);
        let settings =
            Settings { tolerance: 1e-7, duration: 4.0, output: 0.1, ..Settings::from_description(crane.description()) };
        let table = run(crane, settings, &InitialState { q, v: vec![0.0; 2], ..InitialState::default() });
        let last = |name: &str| column(&table, name).last().unwrap_or(f64::NAN);
        // The work of the drive is the potential energy gained by both, up to the tolerance.
        let work = (first + 2.0 * second) * GRAVITY * 1.2;
        assert!((last("drive_work") / work - 1.0).abs() < 1e-4, "{law}: {} J instead of {work} J", last("drive_work"));
        assert!((last("chain_force") + second * GRAVITY).abs() < 1e-2, "{law}: {} N", last("chain_force"));
    }
}

/// A parallelogram turns its rocker as far as its crank: a coupling of both says it a second time. A coupling that says something else leaves
/// it no pose.
#[test]
fn a_coupling_that_a_loop_says_already_is_named() {
    let bar = |name: &str, on: &str, at: [f64; 2], length: f64| {
        format!(
            "- {{name: {name}, on: {on}, placement: {{transform: {{translation: [{}, 0, {}]}}}}, joint: {{revolute: {{axis: y}}}}, mass: 2, \
             com: [{}, 0, {}], inertia: {{Ixx: 0.1, Iyy: 0.1, Izz: 0.1}}}}\n",
            at[0],
            at[1],
            if length > 0.0 { 0.5 * length } else { 0.0 },
            if length > 0.0 { 0.0 } else { 0.5 * length },
        )
    };
    let linkage = |ratio: f64| {
        crane(&format!(
            "format: 1\nname: bars\nlinks:\n- {{name: ground}}\n{}{}{}\
             loop_joints: [{{name: pin, from: {{link: rod, at: [1, 0, 0]}}, to: {{link: rocker, at: [0, 0, -0.5]}}, joint: {{slide: {{axis: [0, 1, 0]}}}}}}]\n\
             couplings: [{{name: gear, coordinate: rocker_theta, follows: crank_theta, ratio: {ratio}, rigid: true}}]\n\
             guess: {{crank_theta: 0.3, rod_theta: -0.3, rocker_theta: 0.3}}\n",
            bar("crank", "ground", [0.0, 0.0], -0.5),
            bar("rod", "crank", [0.0, -0.5], 1.0),
            bar("rocker", "ground", [1.0, 0.0], -0.5),
        ))
    };
    let same = linkage(1.0);
    let same: &dyn DynCrane = &same;
    let q = [0.3, -0.3, 0.3];
    assert_eq!(loop_joints::gap_at(same, &q), None);
    assert_eq!(loop_joints::undetermined(same, &q).len(), 1, "{:?}", loop_joints::undetermined(same, &q));
    let accelerations = same.accelerations_at(0.0, &q, &[0.5, -0.5, 0.5]);
    assert!((accelerations[0] - accelerations[2]).abs() < 1e-12, "{accelerations}");
    let other = linkage(1.5);
    let gap = loop_joints::gap_at(&other as &dyn DynCrane, &q).map(|gap| gap.to_string());
    assert_eq!(gap.as_deref(), Some("coupling gear is off by 8.594°"));
}

/// A four-bar whose rocker a drive moves is at a dead centre of it where the crank is in line with the pins on the ground. So it is if the drive
/// moves a lever that is geared to the rocker, and not if it moves the crank.
#[test]
fn a_coordinate_that_is_tied_to_a_driven_one_is_held() {
    let bars = |drive: &str| {
        crane(&format!(
            "format: 1\nname: bars\ngravity: [0, 0, 0]\nlinks:\n- {{name: ground}}\n\
             - {{name: crank, on: ground, joint: {{revolute: {{axis: y}}}}, mass: 3, com: [0.2, 0, 0], inertia: {{gyration: [0.1, 0.2, 0.2]}}}}\n\
             - {{name: coupler, placement: {{transform: {{translation: [0.4, 0, 0]}}}}, joint: {{revolute: {{axis: y}}}}, mass: 3, com: [0.5, 0, 0], inertia: {{gyration: [0.1, 0.2, 0.2]}}}}\n\
             - {{name: rocker, placement: {{transform: {{translation: [1.1, 0, 0]}}}}, joint: {{revolute: {{axis: y}}}}, mass: 3, com: [0.5, 0, 0], inertia: {{gyration: [0.1, 0.2, 0.2]}}}}\n\
             - {{name: lever, on: ground, joint: {{revolute: {{axis: y}}}}, mass: 3, com: [0.5, 0, 0], inertia: {{gyration: [0.1, 0.2, 0.2]}}}}\n\
             loop_joints: [{{name: hinge, from: {{at: [1.2, 0, 0]}}, to: {{link: rocker, at: [0.9, 0, 0]}}, joint: {{slide: {{axis: [0, 1, 0]}}}}}}]\n\
             couplings: [{{name: gear, coordinate: lever_theta, follows: rocker_theta, ratio: 2, rigid: true}}]\n\
             drives: [{{coordinate: {drive}, stiffness: 4e3, motion: {{hold: 0}}}}]\n"
        ))
    };
    // The triangle of the crank's end and both ends of the rocker, with the crank at 0.01 rad.
    let way = [1.2 - 0.4 * 0.01_f64.cos(), -0.4 * 0.01_f64.sin()];
    let distance = way[0].hypot(way[1]);
    let corner = |a: f64, b: f64, c: f64| ((a * a + b * b - c * c) / (2.0 * a * b)).acos();
    let coupler = way[1].atan2(way[0]) + corner(distance, 1.1, 0.9);
    let rocker = corner(1.1, 0.9, distance) - std::f64::consts::PI;
    // Rotations about y turn x downwards.
    let q = [-0.01, 0.01 - coupler, -rocker, -2.0 * rocker];
    let cautions = |drive: &str| loop_joints::cautions(&bars(drive) as &dyn DynCrane, &q);
    for drive in ["rocker_theta", "lever_theta"] {
        let cautions_of_drive = cautions(drive);
        assert!(
            cautions_of_drive.len() == 1 && cautions_of_drive[0].contains("dead centre of its drives"),
            "{drive}: {cautions_of_drive:?}"
        );
    }
    assert!(cautions("crank_theta").is_empty(), "{:?}", cautions("crank_theta"));
}
