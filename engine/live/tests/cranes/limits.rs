//! Drives with a limit of effort against exact laws.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Sample, Settings};
use crane_model::results::cautions;
use crane_model::statics;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("limits.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A drive that would need more than its limit pushes with the limit: `x = ½ (M/m) t²`. The energy balances.
#[test]
fn a_drive_at_its_limit_accelerates_evenly() {
    let (mass, limit) = (20.0, 50.0);
    let slide = crane(&format!(
        "format: 1\nname: slide\ngravity: [0, 0, 0]\nlinks: [{{name: slide, joint: {{prismatic: {{axis: x}}}}, mass: {mass}, com: [0, 0, 0]}}]\n\
         drives: [{{coordinate: slide_x, stiffness: 1e4, damping: 10, max_effort: {limit}, motion: {{hold: 8}}}}]\n"
    ));
    let slide: &dyn DynCrane = &slide;
    let start = InitialState { q: vec![0.0], v: vec![0.0], ..InitialState::default() };
    let begin = slide.energies_at(0.0, &start.q, &start.v).total();
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
        let defaults = Settings::from_description(slide.description());
        let settings =
            Settings { method, tolerance: 1e-9, duration: 2.0, output: 0.01, step: 1e-4, audit: true, ..defaults };
        let run = slide.simulate(&start, &settings, &mut |sample: &Sample<'_>| {
            let expected = 0.5 * limit / mass * sample.t * sample.t;
            assert!((sample.q[0] - expected).abs() < 1e-7, "{method:?} at {}: {}", sample.t, sample.q[0]);
            let energy = slide.energies_at(sample.t, sample.q, sample.v).total();
            // Of some 400 J stored in the spring at the start.
            let balance = energy + sample.dissipated - sample.work - begin;
            assert!(balance.abs() < 1e-5, "{method:?} at {}: {balance} J", sample.t);
            ControlFlow::Continue(())
        });
        run.unwrap_or_else(|stopped| panic!("{method:?}: {stopped}"));
    }
}

/// A drive at its maximum power accelerates as `v² = v₀² + 2 P t/m`; one at its maximum rate does not exceed it, and brakes at full effort.
/// The energy balances.
#[test]
fn power_and_rate_of_a_drive_are_limited() {
    let (mass, limit, power, begin) = (20.0, 50.0, 100.0, 4.0);
    let slide = |more: &str, motion: &str| {
        crane(&format!(
            "format: 1\nname: slide\ngravity: [0, 0, 0]\nlinks: [{{name: slide, joint: {{prismatic: {{axis: x}}}}, mass: {mass}, com: [0, 0, 0]}}]\n\
             drives: [{{coordinate: slide_x, stiffness: 1e4, damping: 10, max_effort: {limit}, {more}, motion: {motion}}}]\n"
        ))
    };
    let follow = |slide: &LiveCrane, v: f64, check: &mut dyn FnMut(&Sample<'_>, f64)| {
        let slide: &dyn DynCrane = slide;
        let start = InitialState { q: vec![0.0], v: vec![v], ..InitialState::default() };
        let stored = slide.energies_at(0.0, &start.q, &start.v).total();
        for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince, Method::Rk4] {
            let defaults = Settings::from_description(slide.description());
            let settings =
                Settings { method, tolerance: 1e-9, duration: 2.0, output: 0.01, step: 1e-4, audit: true, ..defaults };
            let run = slide.simulate(&start, &settings, &mut |sample: &Sample<'_>| {
                check(sample, slide.drive_efforts_at(sample.t, sample.q, sample.v)[0]);
                let energy = slide.energies_at(sample.t, sample.q, sample.v).total();
                let balance = energy + sample.dissipated - sample.work - stored;
                // Of some kJ stored in the spring.
                assert!(balance.abs() < 1e-4, "{method:?} at {}: {balance} J", sample.t);
                ControlFlow::Continue(())
            });
            run.unwrap_or_else(|stopped| panic!("{method:?}: {stopped}"));
        }
    };
    follow(&slide(&format!("max_power: {power}"), "{hold: 30}"), begin, &mut |sample, effort| {
        let expected = (begin * begin + 2.0 * power * sample.t / mass).sqrt();
        assert!((sample.v[0] - expected).abs() < 1e-7, "at {}: {}", sample.t, sample.v[0]);
        assert!((effort * sample.v[0] / power - 1.0).abs() < 1e-12);
    });
    let fast = 3.0;
    follow(&slide(&format!("max_rate: {fast}"), "{hold: 30}"), 0.0, &mut |sample, _| {
        assert!(sample.v[0] < fast && (sample.t < 1.5 || sample.v[0] > 0.9 * fast), "at {}: {}", sample.t, sample.v[0]);
    });
    // Beyond its maximum rate it brakes at full effort.
    follow(&slide(&format!("max_rate: {fast}, max_power: 1"), "{hold: -30}"), 20.0, &mut |sample, effort| {
        assert!((effort + limit).abs() < 1e-12, "at {}: {effort}", sample.t);
    });
}

/// An arm whose weight exceeds the drive's limit sinks to where `m g l cos θ` equals the limit, and statics report it.
#[test]
fn statics_name_a_drive_that_cannot_hold() {
    let arm = |limit: f64| {
        crane(&format!(
            "format: 1\nname: arm\nlinks: [{{name: arm, joint: {{revolute: {{axis: y}}}}, mass: 10, com: [1, 0, 0]}}]\n\
             drives: [{{coordinate: arm_theta, stiffness: 1e5, max_effort: {limit}, motion: {{hold: 0}}}}]\n"
        ))
    };
    for limit in [30.0, 60.0, 90.0] {
        let arm = arm(limit);
        let arm: &dyn DynCrane = &arm;
        let equilibrium = arm.equilibrium(&statics::Settings::default());
        assert!(equilibrium.is_stable(), "{limit}: {equilibrium}");
        let expected = (limit / 98.1_f64).acos();
        assert!((equilibrium.q[0] - expected).abs() < 1e-10, "{limit}: {} for {expected}", equilibrium.q[0]);
        let cautions = cautions::of_pose(arm, &equilibrium.q, 20.0);
        assert!(cautions.len() == 1 && cautions[0].contains("is at its limit"), "{cautions:?}");
    }
    // Below 95 % of its limit the drive behaves like one without a limit.
    let (arm, weight) = (arm(110.0), 98.1);
    let arm: &dyn DynCrane = &arm;
    let equilibrium = arm.equilibrium(&statics::Settings::default());
    assert!((equilibrium.q[0] - weight * equilibrium.q[0].cos() / 1e5).abs() < 1e-14, "{}", equilibrium.q[0]);
    assert_eq!(cautions::of_pose(arm, &equilibrium.q, 20.0), [] as [String; 0]);
}

/// Poses in which a drive holds a position other than its start; its spring, measured from the start, would be at its limit.
#[test]
fn drives_hold_other_positions_within_their_limit() {
    let (stiffness, limit) = (1e5, 110.0);
    let arm = crane(&format!(
        "format: 1\nname: arm\nlinks: [{{name: arm, joint: {{revolute: {{axis: y}}}}, mass: 10, com: [1, 0, 0]}}]\n\
         drives: [{{coordinate: arm_theta, stiffness: {stiffness}, max_effort: {limit}, motion: {{hold: 0}}}}]\n"
    ));
    for position in [-0.9, 0.6, 1.2] {
        let equilibrium = statics::Problem::new(&arm).holding(&[position]).from(&[position]).solve();
        assert!(equilibrium.is_stable(), "{position}: {equilibrium}");
        let expected = position + 98.1 * equilibrium.q[0].cos() / stiffness;
        assert!((equilibrium.q[0] - expected).abs() < 1e-14, "{position}: {} for {expected}", equilibrium.q[0]);
        // Newton's method with the exact tangent converges quadratically from 1e-3 rad away.
        assert!(equilibrium.history.len() <= 5, "{equilibrium}");
    }
}

/// The effort as a function of the stretch: exactly the spring's below the limit, the limit above, without a corner in between;
/// its integral is the energy.
#[test]
fn efforts_are_rounded_off_at_the_limit() {
    let (stiffness, limit) = (1e3, 100.0);
    let slide = crane(&format!(
        "format: 1\nname: slide\nlinks: [{{name: slide, joint: {{prismatic: {{axis: x}}}}, mass: 1, com: [0, 0, 0]}}]\n\
         drives: [{{coordinate: slide_x, stiffness: {stiffness}, max_effort: {limit}, motion: {{hold: 0}}}}]\n"
    ));
    let slide: &dyn DynCrane = &slide;
    let effort = |stretch: f64| slide.drive_efforts_at(0.0, &[-stretch], &[0.0])[0];
    assert_eq!(effort(0.095), 95.0);
    for stretch in [0.105, 0.2, 3.0] {
        assert!((effort(stretch) - limit).abs() < 1e-9 && (effort(-stretch) + limit).abs() < 1e-9);
    }
    // Simpson's rule is exact for the parabola and the straight pieces.
    let (mut energy, step) = (0.0, 0.0025);
    for k in 0..80 {
        let from = f64::from(k) * step;
        energy += step / 6.0 * (effort(from) + 4.0 * effort(from + 0.5 * step) + effort(from + step));
        let derived = slide.energies_at(0.0, &[-from - step], &[0.0]).drives;
        assert!((derived - energy).abs() < 1e-12 * limit, "{}: {derived} for {energy}", from + step);
    }
    assert_eq!(slide.drive_limits_at(), [Some(limit)]);
}
