//! Motion of cranes written by hand.

use std::ops::ControlFlow;

use crate::common::{self, DoublePendulum, Lift};
use crane_model::{
    CraneModel, Description,
    dynamics::{Cause, Method, Settings, Simulation, rk4},
};
use nalgebra::{SVector, Vector1, Vector2};

/// A run of a crane by the classical Runge–Kutta method.
fn classical(description: &Description) -> Settings {
    Settings { method: Method::Rk4, ..Settings::from_description(description) }
}

/// First coordinate every 0.1 s for 1 s, in steps of `step`, s.
fn motion<const N: usize, C: CraneModel<N>>(crane: &C, start: SVector<f64, N>, step: f64) -> Vec<(f64, f64)> {
    let mut motion = Vec::new();
    let settings = Settings { duration: 1.0, step, output: 0.1, ..classical(crane.description()) };
    Simulation::new(crane, rk4::State::at_rest(start), &settings)
        .observe(|sample| {
            motion.push((sample.t, sample.q[0]));
            ControlFlow::Continue(())
        })
        .expect("a stable run");
    motion
}

#[test]
fn order_of_rk4_on_a_known_motion() {
    let lift = Lift::default();
    // The greatest error over the run: at a single time, errors of two orders may cancel.
    let error = |step: f64| {
        let motion = motion(&lift, Vector1::new(lift.sag()), step);
        motion.iter().map(|&(t, z)| (z - lift.exact(t)).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(1e-3), error(5e-4));
    let order = (coarse / fine).log2();
    assert!((order - 4.0).abs() < 0.1, "order {order}, errors {coarse:e}, {fine:e}");
}

#[test]
fn order_of_rk4_on_a_double_pendulum() {
    // The exact motion is not known: differences between runs with three step sizes fall by a factor of 2⁴.
    let pendulum = DoublePendulum::hanging();
    let [coarse, middle, fine] = [2e-3, 1e-3, 5e-4].map(|step| motion(&pendulum, Vector2::new(1.2, -0.5), step));
    let difference =
        |a: &[(f64, f64)], b: &[(f64, f64)]| a.iter().zip(b).map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
    let order = (difference(&coarse, &middle) / difference(&middle, &fine)).log2();
    assert!((order - 4.0).abs() < 0.1, "order {order}");
}

/// Maximum absolute value of `E(t) − E(0) − W + D` over a run, J.
fn energy_error<const N: usize, C: CraneModel<N>>(crane: &C, start: SVector<f64, N>, step: f64) -> f64 {
    let settings = Settings { duration: 4.0, step, output: 0.1, audit: true, ..classical(crane.description()) };
    let mut first = None;
    let mut worst = 0.0_f64;
    Simulation::new(crane, rk4::State::at_rest(start), &settings)
        .observe(|sample| {
            let (q, v) = (SVector::from_column_slice(sample.q), SVector::from_column_slice(sample.v));
            let energy = crane.kinetic_energy(&q, &v) + crane.potential_energy(sample.t, &q);
            let start = *first.get_or_insert(energy);
            worst = worst.max((energy - start - sample.work + sample.dissipated).abs());
            ControlFlow::Continue(())
        })
        .expect("a stable run");
    worst
}

#[test]
fn energy_of_an_undamped_motion_drifts_as_h4_at_least() {
    let pendulum = DoublePendulum::hanging();
    let [coarse, fine] = [4e-3, 2e-3].map(|step| energy_error(&pendulum, Vector2::new(1.2, -0.5), step));
    let order = (coarse / fine).log2();
    assert!(order > 3.8, "order {order}, {coarse:e} J, {fine:e} J");
}

#[test]
fn work_of_the_drive_is_energy_and_dissipation() {
    let lift = Lift::default();
    let [coarse, fine] = [4e-3, 2e-3].map(|step| energy_error(&lift, Vector1::new(lift.sag()), step));
    let order = (coarse / fine).log2();
    assert!(order > 3.8, "order {order}, {coarse:e} J, {fine:e} J");
}

#[test]
fn results_come_at_their_own_interval() {
    // 0.03 s is not a multiple of 7 ms, nor 0.1 s of 0.03 s: steps shrink to fit, and the run ends exactly at 0.1 s.
    let lift = Lift::default();
    let settings =
        Settings { duration: 0.1, step: 7e-3, output: 0.03, ..classical(&common::description("", &[], &[])) };
    let mut times = Vec::new();
    let run = Simulation::new(&lift, rk4::State::at_rest(Vector1::zeros()), &settings)
        .observe(|sample| {
            times.push(sample.t);
            ControlFlow::Continue(())
        })
        .expect("a stable run");
    let expected = [0.0, 0.03, 0.06, 0.09, 0.1];
    assert_eq!(times.len(), expected.len());
    assert!(times.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{times:?}");
    // 30 ms in 5 steps of 6 ms, three times, and 10 ms in 2.
    assert_eq!(run.statistics.steps, 17);
    assert!((run.step - 6e-3).abs() < 1e-15);
}

#[test]
fn an_observer_breaks_off_a_run() {
    let lift = Lift::default();
    let settings = classical(&common::description("", &[], &[]));
    let run = Simulation::new(&lift, rk4::State::at_rest(Vector1::zeros()), &settings)
        .observe(|sample| if sample.t < 0.5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) })
        .expect("a stable run");
    assert!((run.time - 0.5).abs() < 1e-12);
}

#[test]
fn a_step_beyond_the_limit_stops_with_time_coordinate_and_advice() {
    // ω = 20 rad/s undamped: stable below 2.83/20 = 0.1414 s.
    let lift = Lift { damping: 0.0, ..Lift::default() };
    let run = |step| {
        let settings =
            Settings { duration: 400.0, step, output: step, ..classical(&common::description("", &[], &[])) };
        Simulation::new(&lift, rk4::State::at_rest(Vector1::new(lift.sag())), &settings).run()
    };
    assert!(run(0.141).is_ok());
    let stopped = run(0.143).expect_err("a run beyond the stability limit");
    assert_eq!((stopped.cause, stopped.coordinate.as_str(), stopped.unit), (Cause::Step, "lift_z", "m"));
    // Detected before the motion of 0.1 m has grown a hundredfold.
    assert!(stopped.value.abs() < 10.0 && stopped.time > 0.0 && stopped.time < 400.0, "{stopped:?}");
    let message = stopped.to_string();
    assert!(message.contains("unstable") && message.contains("lift_z"), "{message}");
    assert!(stopped.advice().contains("smaller step than 1.43e-1 s"), "{}", stopped.advice());
}

#[test]
fn a_massless_crane_is_refused() {
    let lift = Lift { mass: 0.0, ..Lift::default() };
    let settings = classical(&common::description("", &[], &[]));
    let stopped =
        Simulation::new(&lift, rk4::State::at_rest(Vector1::zeros()), &settings).run().expect_err("no mass, no motion");
    assert_eq!((stopped.cause, stopped.coordinate.as_str()), (Cause::MassMatrix, "lift_z"));
}

#[test]
fn a_joint_without_inertia_is_named() {
    let pendulum = DoublePendulum { mass: [2.0, 0.0], ..DoublePendulum::hanging() };
    let settings = classical(pendulum.description);
    let stopped = Simulation::new(&pendulum, rk4::State::at_rest(Vector2::zeros()), &settings)
        .run()
        .expect_err("no mass, no motion");
    assert_eq!((stopped.cause, stopped.coordinate.as_str()), (Cause::MassMatrix, "lower"));
    let (message, advice) = (stopped.to_string(), stopped.advice());
    assert!(message.contains("not positive definite") && message.contains("lower"), "{message}");
    assert!(advice.contains("lower") && advice.contains("`mass`") && !advice.contains("step"), "{advice}");
}

#[test]
fn a_step_out_of_all_bounds_is_no_want_of_inertia() {
    // The first stage already overflows: the mass matrix there is NaN, that at the start is valid.
    let pendulum = DoublePendulum { gravity: 1e300, ..DoublePendulum::hanging() };
    let settings = Settings { step: 1e10, output: 1e10, duration: 1e10, ..classical(pendulum.description) };
    let stopped = Simulation::new(&pendulum, rk4::State::at_rest(Vector2::new(0.4, -0.3)), &settings)
        .run()
        .expect_err("no number");
    assert_eq!(stopped.cause, Cause::Growth);
    assert!(stopped.advice().contains("smaller step"), "{}", stopped.advice());
}
