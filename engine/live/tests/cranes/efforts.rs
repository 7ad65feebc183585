//! Efforts of drives besides spring and damper, given by inputs and over time.

use crane_model::statics::Problem;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Sample, Settings};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("efforts.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A boom that bends, with an arm on its tip that an effort of 4 kN m turns, and what is written besides.
fn boom(of_arm: &str, more: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: boom\nmaterials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850}}}}\ninputs: {{push: {{value: 4e3, unit: N m}}}}\nlinks:\n\
         - {{name: boom, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, beam: {{length: 4, sections: 2, material: steel,\n\
         \x20  section: {{box: {{height: 0.2, width: 0.15, thickness: 0.006}}}}, damping: {{beta: 1e-3}}}}}}\n\
         - {{name: arm, joint: revolute, mass: 120, com: [1.1, 0.02, 0.03], inertia: {{gyration: [0.1, 1, 1]}}}}\n\
         drives:\n- {{coordinate: boom_psi, stiffness: 2e6, damping: 2e4, motion: {{hold: 30 deg}}}}\n\
         - {{coordinate: arm_psi, stiffness: 1e5, damping: 1e3, motion: {{hold: -20 deg}}{of_arm}}}\n{more}"
    ))
}

/// An effort is a moment on the link and its opposite on the other one: accelerations, rest, cuts and run.
#[test]
fn an_effort_is_a_pair_of_moments() {
    let pair = "loads:\n- {name: on_arm, link: arm, at: [0, 0, 0], axes: link, moment: [0, 0, 1], scale: {input: push}}\n\
                - {name: on_boom, link: boom, at: [4, 0, 0], axes: link, moment: [0, 0, -1], scale: {input: push}}\n";
    let (with_effort, with_loads) = (boom(", effort: {input: push}", ""), boom("", pair));
    let n = with_effort.size();
    let numbers = |crane: &LiveCrane, value: Option<f64>| {
        let mut crane = crane.clone();
        DynCrane::set_input(&mut crane, 0, value);
        let crane: &dyn DynCrane = &crane;
        let q: Vec<f64> = (0..n).map(|i| 0.3 * (1.3 * i as f64).sin()).collect();
        let v: Vec<f64> = (0..n).map(|i| 0.2 * (0.7 * i as f64).cos()).collect();
        let rest = Problem::new(crane).from(&crane.guess()).solve();
        assert!(rest.is_stable());
        let mut all = crane.accelerations_at(0.0, &q, &v).as_slice().to_vec();
        all.extend(rest.q.clone());
        let mut tangent = vec![f64::NAN; n * n];
        crane.tangent_stiffness(0.0, &rest.q, &crane.drive_positions_at(0.0), &mut tangent);
        all.extend(tangent);
        all.push(crane.energies_at(0.0, &q, &v).total());
        // All power comes from the input: the drives hold.
        all.push(crane.drive_power(0.0, &q, &v) + crane.load_power(0.0, &q, &v));
        all
    };
    let mut before = Vec::new();
    for value in [None, Some(-2.5e3)] {
        let (effort, loads) = (numbers(&with_effort, value), numbers(&with_loads, value));
        for (i, (effort, loads)) in effort.iter().zip(&loads).enumerate() {
            // Sums in another order, and equilibria that are accurate to 1e-10 of the forces.
            assert!((effort - loads).abs() <= 1e-9 * loads.abs().max(1.0), "{i}: {effort} and {loads}");
        }
        assert!(effort != before, "the input acts");
        before = effort;
    }
}

/// Without a spring, the efforts alone are those of inverse dynamics: the computed torque gives the accelerations that it was computed for.
#[test]
fn computed_torques_give_their_accelerations() {
    let mut arm = crane(
        "format: 1\nname: arm\ninputs: {first: {}, second: {}}\nlinks:\n\
         - {name: upper, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 20, com: [0.5, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}\n\
         - {name: lower, placement: {transform: {translation: [1, 0, 0]}}, joint: revolute, mass: 10, com: [0.4, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}\n\
         drives:\n- {coordinate: upper_psi, effort: {input: first}}\n- {coordinate: lower_psi, effort: {input: second}, damping: 3}\n",
    );
    let (q, v, wanted) = ([0.4, -0.9], [0.7, -0.3], [1.5_f64, -2.0]);
    let mut torques = [0.0; 2];
    arm.dynamic_residual(0.0, &q, &v, &wanted, &mut torques);
    for (index, torque) in torques.into_iter().enumerate() {
        DynCrane::set_input(&mut arm, index, Some(torque));
    }
    let mut found = [0.0_f64; 2];
    arm.forward_dynamics(0.0, &q, &v, &mut found);
    for (value, wanted) in found.iter().zip(wanted) {
        // Rounding.
        assert!((value - wanted).abs() < 1e-12, "{value} instead of {wanted}");
    }
    // The damper of the second drive brakes; its effort is the input less that.
    let efforts = (&arm as &dyn DynCrane).drive_efforts_at(0.0, &q, &v);
    assert!((efforts[0] - torques[0]).abs() < 1e-12 && (efforts[1] - (torques[1] + 0.9)).abs() < 1e-12, "{efforts:?}");
}

/// A force that rises as `2t` N moves 4 kg by `x = t³/12` m, and no more than its limit of 3 N; the energy balances.
#[test]
fn a_limited_effort_moves_a_mass_and_the_energy_balances() {
    let slide = |drive: &str| {
        crane(&format!(
            "format: 1\nname: slide\ngravity: [0, 0, 0]\nlinks: [{{name: slide, joint: {{prismatic: {{axis: x}}}}, mass: 4, com: [0, 0, 0]}}]\n\
             drives: [{{coordinate: slide_x, effort: {{speed: {{rate: 2}}}}, {drive}}}]\n"
        ))
    };
    // 3 N are reached at 1.5 s; the rounding of the corner is 5 %.
    for (drive, until) in [
        ("max_effort: 3", 1.4),
        ("max_effort: 3, damping: 0.5", 3.0),
        ("stiffness: 2, damping: 0.1, motion: {speed: {rate: 0.3}}, max_effort: 3", 3.0),
    ] {
        let slide = slide(drive);
        let slide: &dyn DynCrane = &slide;
        let start = InitialState { q: vec![0.0], v: vec![0.0], ..InitialState::default() };
        let begin = slide.energies_at(0.0, &start.q, &start.v).total();
        for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
            let defaults = Settings::from_description(slide.description());
            let settings =
                Settings { method, tolerance: 1e-9, duration: 3.0, output: 0.01, step: 1e-3, audit: true, ..defaults };
            let run = slide.simulate(&start, &settings, &mut |sample: &Sample<'_>| {
                if sample.t < until && !drive.contains("damping") {
                    let expected = sample.t.powi(3) / 12.0;
                    // Methods to a tolerance of 1e-9, some hundred steps.
                    assert!(
                        (sample.q[0] - expected).abs() < 1e-6,
                        "{drive}, {method:?} at {}: {}",
                        sample.t,
                        sample.q[0]
                    );
                }
                let effort = slide.drive_efforts_at(sample.t, sample.q, sample.v)[0];
                assert!(effort.abs() <= 3.0 + 1e-12, "{drive}, {method:?} at {}: {effort} N", sample.t);
                let energy = slide.energies_at(sample.t, sample.q, sample.v).total();
                let balance = energy + sample.dissipated - sample.work - begin;
                // Of some 10 J.
                assert!(balance.abs() < 1e-5, "{drive}, {method:?} at {}: {balance} J", sample.t);
                ControlFlow::Continue(())
            });
            run.unwrap_or_else(|stopped| panic!("{drive}, {method:?}: {stopped}"));
        }
    }
}
