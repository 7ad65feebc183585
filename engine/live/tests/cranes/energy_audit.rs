//! The energy audit of runs where drives saturate and where everything is prescribed: `E − E(0) − W + D` is zero for the exact motion.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Sample, Settings};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A slide of 100 kg whose motion asks for more than its drive can deliver.
fn limited(limits: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: slide\nlinks: [{{name: slide, joint: {{prismatic: {{axis: x}}}}, mass: 100, com: [0, 0, 0]}}]\n\
         drives: [{{coordinate: slide_x, stiffness: 2e4, damping: 2e3, {limits}, motion: {{quintic: {{from: 0, to: 3, duration: 1.5}}}}}}]\n\
         run: {{duration: 4, output: 0.01}}\n"
    ))
}

/// Four links, all prescribed.
const RIGID: &str = "format: 1\nname: arm\nlinks:\n\
    - {name: column, joint: revolute, mass: 50, com: [0.1, 0, 0.5], inertia: {gyration: [0.3, 0.3, 0.2]}}\n\
    - {name: boom, placement: {transform: {translation: [0, 0, 1], rotation: {x: 90 deg}}}, joint: revolute, mass: 60, com: [1, 0, 0], inertia: {gyration: [0.1, 0.6, 0.6]}}\n\
    - {name: outer, placement: {transform: {translation: [2, 0, 0]}}, joint: revolute, mass: 40, com: [0.7, 0, 0], inertia: {gyration: [0.1, 0.4, 0.4]}}\n\
    - {name: stage, placement: {transform: {translation: [1, 0, 0]}}, joint: {prismatic: {axis: x}}, mass: 20, com: [0.3, 0, 0], inertia: {gyration: [0.1, 0.2, 0.2]}}\n\
    drives:\n\
    - {coordinate: column_psi, rigid: true, motion: {quintic: {from: 0, to: 1.5, duration: 3}}}\n\
    - {coordinate: boom_psi, rigid: true, motion: {quintic: {from: 0, to: 1, duration: 2}}}\n\
    - {coordinate: outer_psi, rigid: true, motion: {cubic: {from: -1, to: 0.3, begin: 0.5, duration: 2}}}\n\
    - {coordinate: stage_x, rigid: true, motion: {quintic: {from: 0.2, to: 1, duration: 3}}}\n\
    run: {duration: 4, output: 0.05}\n";

/// Largest work of the drives, dissipated energy at the end, and largest error of the balance, J.
fn audit(crane: &LiveCrane, method: Method, tolerance: f64) -> [f64; 3] {
    let crane: &dyn DynCrane = crane;
    let settings = Settings { method, tolerance, audit: true, ..Settings::from_description(crane.description()) };
    let start = InitialState::at_rest(crane.guess());
    let (mut first, mut work, mut lost, mut off) = (None, 0.0_f64, 0.0, 0.0_f64);
    let mut observe = |sample: &Sample<'_>| {
        let energy = crane.energies_at(sample.t, sample.q, sample.v).total();
        let begin = *first.get_or_insert(energy);
        work = work.max(sample.work.abs());
        lost = sample.dissipated;
        off = off.max((energy - begin - sample.work - sample.load_work + sample.dissipated).abs());
        ControlFlow::Continue(())
    };
    crane.simulate(&start, &settings, &mut observe).unwrap_or_else(|stopped| panic!("{stopped}"));
    [work, lost, off]
}

#[test]
fn drives_at_their_limits_balance() {
    for limits in ["max_effort: 200", "max_effort: 200, max_power: 150, max_rate: 1.5"] {
        let slide = limited(limits);
        let exact = audit(&slide, Method::DormandPrince, 1e-11);
        // About twice what each method reaches: its steps do not end where a limit begins, except at those of efforts. With a maximum rate, errors of
        // the W-method scatter from 3e-7 to 1.3e-6 among tolerances from 6e-10 to 1.6e-9.
        for (method, allowed) in [
            (Method::Bdf, [2e-4, 1e-6, 5e-8]),
            (Method::Rosenbrock, [1.6e-3, 2e-5, 2.5e-6]),
            (Method::DormandPrince, [4.5e-3, 4e-5, 6e-7]),
        ] {
            let errors = [2e-5, 1e-7, 1e-9].into_iter().zip(allowed).map(|(tolerance, allowed)| {
                let [work, lost, off] = audit(&slide, method, tolerance);
                assert!(off < allowed * work, "{limits}, {method}, {tolerance:e}: off by {off:e} of {work} J");
                // The motion, and with it the work, is that of the most accurate run up to the error of the balance and of the motion.
                let difference = (work - exact[0]).abs().max((lost - exact[1]).abs());
                assert!(difference < 1e-3 * work, "{limits}, {method}, {tolerance:e}: {work}, {lost} for {exact:?}");
                off / work
            });
            let errors: Vec<f64> = errors.collect();
            let falls = errors[2] < 1e-2 * errors[0] + 1e-8;
            assert!(falls || method != Method::Bdf, "{limits}, {method}: {errors:?}");
        }
    }
}

/// The motion has no error, whatever the tolerance: the balance is that of the quadrature.
#[test]
fn prescribed_motions_balance() {
    let arm = crane(RIGID);
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
        for tolerance in [2e-5, 1e-7] {
            let [work, lost, off] = audit(&arm, method, tolerance);
            assert!(work > 1000.0 && lost == 0.0, "{work}, {lost}");
            assert!(off < tolerance * work, "{method}, {tolerance:e}: off by {off:e} of {work} J");
        }
    }
}

/// A post on a rail, moved by a rigid drive, with an arm on a cylinder with a valve: the rigid drive works also against what the oil pushes.
const CARRIED: &str = "format: 1\nname: carried\nlinks:\n\
    - {name: post, joint: {prismatic: {axis: x}}, mass: 50, com: [0, 0, 0]}\n\
    - {name: arm, placement: {transform: {rotation: {x: 90 deg}}}, joint: {revolute: {axis: z}}, mass: 100, com: [2, 0, 0], inertia: {gyration: [0.2, 1, 1]}}\n\
    drives:\n\
    - {coordinate: post_x, rigid: true, motion: {quintic: {from: 0, to: 1.5, duration: 1}}}\n\
    - {coordinate: arm_psi, stiffness: 1e8, motion: {quintic: {from: 0, to: 0.3, duration: 1}}}\n\
    cylinders:\n\
    - {name: lift, coordinate: arm_psi, foot: {link: post, at: [0.1, 0, -1.2]}, head: {link: arm, at: [1.2, -0.1, 0]}, bore: 0.1, rod: 0.06,\n\
    \u{20}  retracted: 1.3, stroke: 1.2, back_pressure: 3e5, max_pressure: 3e7, bulk_modulus: 1.2e9, hose_volumes: [1e-3, 1e-3],\n\
    \u{20}  valve: {flow: 1e-3, pressure_drop: 1e6, lag: 0.03, gain: 20}}\n\
    pump: {max_flow: 2e-3, pressure: 2.5e7}\n\
    run: {duration: 1.5, output: 0.01}\n";

#[test]
fn rigid_drives_beside_oil_balance() {
    let carried = crane(CARRIED);
    for method in [Method::Bdf, Method::Rosenbrock] {
        let errors = [1e-5, 1e-7].map(|tolerance| {
            let [work, _, off] = audit(&carried, method, tolerance);
            assert!(off < 1e-3 * work, "{method}, {tolerance:e}: off by {off:e} of {work} J");
            off / work
        });
        assert!(errors[1] < 0.2 * errors[0] + 1e-9, "{method}: {errors:?}");
    }
}
