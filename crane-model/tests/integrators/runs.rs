//! Error control, statistics, audits and limits of whole runs.

use std::{
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
};

use crane_model::{
    CraneModel, Description, ParameterError,
    dyn_crane::Instance,
    dynamics::{Cause, InitialState, Method, Rk4, Settings, Simulation, rk4::State},
};
use nalgebra::{Matrix4, SMatrix, SVector, Vector1, Vector2};

use crate::common::{self, DoublePendulum, GRAVITY, Lift};
use crate::{implicit, state_after_a_second, stiff_lift, swinging};

/// However a crane and the method are given, a run has the same bits.
#[test]
fn runs_of_one_crane_are_equal() {
    let (lift, _) = swinging(0.1);
    let settings = Settings { method: Method::Rk4, duration: 0.5, ..Settings::from_description(lift.description()) };
    let start = InitialState::at_rest(vec![lift.sag() + 0.1]);
    let end = |run: Simulation<'_>| {
        let mut end = [0.0; 2];
        let run = run.observe(|sample| {
            end = [sample.q[0], sample.v[0]];
            ControlFlow::Continue(())
        });
        (run.expect("a run").statistics.steps, end.map(f64::to_bits))
    };
    let on_slices = Instance::<1, _>(lift);
    let typed = end(Simulation::new(&lift, &start, &settings));
    assert_eq!(end(Simulation::new(&on_slices, &start, &settings)), typed);
    assert_eq!(end(Simulation::with_stepper(&mut Rk4::new(&on_slices, &settings), &lift, &start, &settings)), typed);
}

#[test]
fn unresolved_undamped_modes_do_not_grow_in_adaptive_runs() {
    // 20 rad/s, and a tolerance that steps of half an oscillation meet once the amplitude is small.
    let (lift, _) = swinging(0.0);
    let settings = Settings {
        method: Method::Bdf,
        tolerance: 0.1,
        duration: 600.0,
        ..Settings::from_description(&common::description("", &[], &[]))
    };
    let mut most = 0.0_f64;
    let start = State::at_rest(Vector1::new(lift.sag() + 1e-3));
    let run = Simulation::new(&lift, start, &settings)
        .observe(|sample| {
            most = most.max((sample.q[0] - lift.sag()).abs());
            ControlFlow::Continue(())
        })
        .expect("a run");
    // Growth is detected when it reaches the tolerance of a step.
    assert!(most < 0.1, "{most}");
    assert!((run.step * run.statistics.steps as f64 / 600.0 - 1.0).abs() < 1e-12, "{run:?}");
}

#[test]
fn a_stiff_spring_is_not_forced_by_its_drive() {
    let lift = stiff_lift();
    let start = State { q: Vector1::new(lift.sag()), v: Vector1::new(lift.amplitude * lift.frequency) };
    let exact = (lift.sag() + lift.amplitude * lift.frequency.sin(), 0.7 * lift.frequency.cos());
    let end = state_after_a_second(50, start, implicit(&lift), false);
    // Only the deviation from the drive's motion is integrated. The error of the rate is that of differencing the motion.
    assert!((end.q.x - exact.0).abs() < 1e-9 && (end.v.x - exact.1).abs() < 1e-6, "{end:?} {exact:?}");
}

#[test]
fn efforts_are_right_however_stiff_the_drive() {
    for stiffness in [1e6, 1e8, 1e10, 1e12] {
        // In the limit of a rigid drive the effort is m (g + z̈_dr). The start lacks the rate m a Ω³/s of the spring, which
        // therefore rings with ω = √(s/m).
        let lift = Lift { stiffness, damping: 1e-3 * stiffness, ..Lift::default() };
        let Lift { mass, amplitude, frequency, .. } = lift;
        let start = State { q: Vector1::new(lift.sag()), v: Vector1::new(amplitude * frequency) };
        for method in [Method::Rosenbrock, Method::Bdf] {
            let settings =
                Settings { method, duration: 3.0, output: 7e-3, ..Settings::from_description(lift.description) };
            let (mut worst, mut peak) = (0.0_f64, 0.0_f64);
            let run = Simulation::new(&lift, start, &settings)
                .observe(|sample| {
                    let state = (Vector1::new(sample.q[0]), Vector1::new(sample.v[0]));
                    let effort = lift.drive_forces(sample.t, &state.0, &state.1).x;
                    let exact = mass * (GRAVITY - amplitude * frequency.powi(2) * (frequency * sample.t).sin());
                    worst = worst.max((effort - exact).abs());
                    peak = peak.max(exact.abs());
                    ControlFlow::Continue(())
                })
                .expect("a run");
            let ringing = mass * amplitude * frequency.powi(3) * (mass / stiffness).sqrt();
            println!("{method} {stiffness:e}: {:.1e}, {:?}", worst / peak, run.statistics);
            // The tolerance allows a thousandth of the effort per step; rounding of a position of 0.1 m times the stiffness is 2e-5 N.
            assert!(worst < 2e-3 * peak + ringing, "{method} {stiffness:e}: {worst:e} of {peak} N");
            let estimate = &run.efforts[0];
            assert!((estimate.peak / peak - 1.0).abs() < 0.01 && estimate.error < 0.01 * peak, "{estimate:?}, {peak}");
        }
    }
}

#[test]
fn effort_error_includes_rounding_of_positions() {
    // 1e18 N/m times the rounding of a position of 0.1 m are some 10 N: no step is short enough.
    let lift = Lift { stiffness: 1e18, damping: 1e15, ..Lift::default() };
    let start = State { q: Vector1::new(lift.sag()), v: Vector1::new(lift.amplitude * lift.frequency) };
    for method in [Method::Rosenbrock, Method::Bdf] {
        let settings = Settings { method, duration: 1.0, ..Settings::from_description(lift.description) };
        let run = Simulation::new(&lift, start, &settings).run().expect("a run");
        assert!(run.efforts[0].error > 10.0, "{method}: {run:?}");
    }
}

/// Maximum error of a run of the lift at its results, m, and the run's statistics.
fn lift_error(method: Method, tolerance: f64, output: f64) -> (f64, crane_model::dynamics::Run) {
    let lift = Lift::default();
    let settings = Settings {
        method,
        tolerance,
        output,
        duration: 3.0,
        ..Settings::from_description(&common::description("", &[], &[]))
    };
    let mut worst = 0.0_f64;
    let run = Simulation::new(&lift, State::at_rest(Vector1::new(lift.sag())), &settings)
        .observe(|sample| {
            worst = worst.max((sample.q[0] - lift.exact(sample.t)).abs());
            ControlFlow::Continue(())
        })
        .expect("a run");
    (worst, run)
}

#[test]
fn errors_are_within_a_factor_of_ten_of_the_tolerance() {
    for method in [Method::DormandPrince, Method::Rosenbrock, Method::Bdf] {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let (error, run) = lift_error(method, tolerance, 0.5);
            assert!(error < 10.0 * tolerance && error > 0.1 * tolerance, "{method} {tolerance:e}: {error:e}, {run:?}");
        }
    }
}

#[test]
fn dense_output_does_not_shorten_steps() {
    for method in [Method::DormandPrince, Method::Rosenbrock, Method::Bdf] {
        let (coarse, fine) = (lift_error(method, 1e-6, 0.5), lift_error(method, 1e-6, 1e-3));
        // The last step of the run may end beyond the last result.
        assert!(fine.1.statistics.steps.abs_diff(coarse.1.statistics.steps) <= 1, "{coarse:?} {fine:?}");
        assert!(fine.0 < 10.0 * 1e-6, "{fine:?}");
    }
}

#[test]
fn a_motion_after_a_rest_is_not_stepped_over() {
    // A drive that rests, moves by 0.1 m and back within 4 ms, and rests again: shorter than any step at rest.
    let lift = Lift::bumped(5.0133, 4e-3);
    let settings = |method| Settings {
        method,
        tolerance: 1e-7,
        output: 5.1,
        duration: 5.1,
        ..Settings::from_description(lift.description)
    };
    let end = |settings: &Settings| {
        let mut end = 0.0;
        let rest = State::at_rest(Vector1::new(lift.sag()));
        let run = Simulation::new(&lift, rest, settings).observe(|sample| {
            end = sample.q[0] - lift.sag();
            ControlFlow::Continue(())
        });
        run.expect("a run");
        end
    };
    let exact = end(&Settings { step: 1e-5, ..settings(Method::Rk4) });
    assert!(exact.abs() > 1e-3, "the mass is hit: {exact}");
    for method in [Method::DormandPrince, Method::Rosenbrock, Method::Bdf] {
        let error = end(&settings(method)) - exact;
        assert!(error.abs() < 1e-2 * exact.abs(), "{method}: {error:e} of {exact:e} m");
    }
}

/// A crane that counts how often it is asked for its accelerations or for what a motion requires, and for factors.
#[derive(Clone)]
struct Counted<C> {
    crane: C,
    evaluations: Arc<AtomicUsize>,
    factorisations: Arc<AtomicUsize>,
}

impl_model_as_in_crane! {
    Counted
    fn mass_matrix(&self, q: &SVector<f64, N>, out: &mut SMatrix<f64, N, N>) {
        self.crane.mass_matrix(q, out);
    }
    fn bias(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.crane.bias(q, v)
    }
    fn forward_dynamics(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        self.crane.forward_dynamics(t, q, v)
    }
    fn kinetic_energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.crane.kinetic_energy(q, v)
    }
    type Factors = C::Factors;
    fn factorise(&self, q: &SVector<f64, N>, added_inertia: &SVector<f64, N>, base: &SMatrix<f64, 6, 6>) -> C::Factors {
        self.factorisations.fetch_add(1, Ordering::Relaxed);
        self.crane.factorise(q, added_inertia, base)
    }
    fn solve(&self, factors: &C::Factors, r: &SVector<f64, N>) -> SVector<f64, N> {
        self.crane.solve(factors, r)
    }
    fn dynamic_residual(
        &self,
        t: f64,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        a: &SVector<f64, N>,
    ) -> SVector<f64, N> {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        self.crane.dynamic_residual(t, q, v, a)
    }
    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        self.crane.joint_stiffness_and_damping(out);
    }
    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]) {
        self.crane.drive_motions(t, out);
    }
}

#[test]
fn statistics_equal_the_counted_evaluations() {
    for method in Method::ALL {
        // In the first seconds of the double pendulum, steps are rejected now and then.
        let crane =
            Counted { crane: DoublePendulum::hanging(), evaluations: Arc::default(), factorisations: Arc::default() };
        let settings =
            Settings { method, tolerance: 1e-6, duration: 3.0, ..Settings::from_description(crane.crane.description) };
        let start = State::at_rest(Vector2::new(2.2, -0.5));
        let run = Simulation::new(&crane, start, &settings).run().expect("a run");
        assert_eq!(run.statistics.evaluations, crane.evaluations.load(Ordering::Relaxed), "{method}");
        assert_eq!(run.statistics.factorisations, crane.factorisations.load(Ordering::Relaxed), "{method}");
        let tried = run.statistics.steps + run.statistics.rejections;
        assert!(run.statistics.steps > 10 && run.statistics.evaluations >= tried, "{method}: {run:?}");
    }
}

#[test]
fn a_run_ends_at_its_limit_of_steps() {
    let lift = Lift::default();
    for method in Method::ALL {
        let settings = Settings { method, most_steps: 20, ..Settings::from_description(lift.description) };
        let rest = State::at_rest(Vector1::new(lift.sag()));
        let stopped = Simulation::new(&lift, rest, &settings).run().expect_err("too many steps");
        assert_eq!((stopped.cause, stopped.method), (Cause::Steps, method));
        assert!(stopped.time > 0.0 && stopped.time < 10.0, "{stopped:?}");
        let (message, advice) = (stopped.to_string(), stopped.advice());
        assert!(
            message.contains("more than its maximum number of steps") && advice.contains("most_steps"),
            "{message}; {advice}"
        );
        assert_eq!(advice.contains("tolerance"), method.is_adaptive(), "{advice}");
    }
}

/// Explicit steps at 1e8 rad/s, as after a mistake in a unit: ten seconds would take more than 1e8 of them, and the run says so after 2e4.
#[test]
fn a_run_that_would_take_too_many_steps_ends_early() {
    let lift = Lift { stiffness: 1e16 * Lift::default().mass, ..Lift::default() };
    let settings =
        Settings { method: Method::DormandPrince, duration: 10.0, ..Settings::from_description(lift.description) };
    let start = State { q: Vector1::new(lift.sag()), v: Vector1::new(1.0) };
    let stopped = Simulation::new(&lift, start, &settings).run().expect_err("too many steps");
    assert_eq!(stopped.cause, Cause::Steps);
    // 2e4 steps of less than 1e-7 s.
    assert!(stopped.time < 2e-3 && stopped.step < 1e-7, "{stopped:?}");
    assert!(stopped.advice().contains("wrong unit"), "{}", stopped.advice());
}

#[test]
fn energy_is_audited_by_every_method() {
    for method in [Method::DormandPrince, Method::Rosenbrock, Method::Bdf] {
        let error = |tolerance: f64| {
            let lift = Lift::default();
            let settings = Settings {
                method,
                tolerance,
                audit: true,
                output: 0.1,
                ..Settings::from_description(&common::description("", &[], &[]))
            };
            let (mut first, mut worst) = (None, 0.0_f64);
            Simulation::new(&lift, State::at_rest(Vector1::new(lift.sag())), &settings)
                .observe(|sample| {
                    let (q, v) = (Vector1::new(sample.q[0]), Vector1::new(sample.v[0]));
                    let energy = lift.kinetic_energy(&q, &v) + lift.potential_energy(sample.t, &q);
                    let start = *first.get_or_insert(energy);
                    worst = worst.max((energy - start - sample.work + sample.dissipated).abs());
                    ControlFlow::Continue(())
                })
                .expect("a run");
            worst
        };
        // A rate error of 4 1/s times the tolerance, in forces of 400 N over a run of 10 s.
        assert!(error(1e-6) < 1e4 * 1e-6, "{method}: {:e} J", error(1e-6));
        assert!(error(1e-9) < 1e-2 * error(1e-6), "{method}");
    }
}

#[test]
fn an_adaptive_run_without_inertia_or_bounds_stops() {
    for method in [Method::DormandPrince, Method::Rosenbrock, Method::Bdf] {
        let settings = Settings { method, ..Settings::from_description(&common::description("", &[], &[])) };
        let massless = Lift { mass: 0.0, ..Lift::default() };
        let start = State::at_rest(Vector1::zeros());
        let stopped = Simulation::new(&massless, start, &settings).run().expect_err("no mass");
        assert_eq!((stopped.cause, stopped.coordinate.as_str()), (Cause::MassMatrix, "lift_z"), "{method}");
        let pendulum = DoublePendulum { gravity: 1e300, ..DoublePendulum::hanging() };
        let start = State::at_rest(Vector2::new(0.4, -0.3));
        let stopped = Simulation::new(&pendulum, start, &settings).run().expect_err("no number");
        assert_ne!(stopped.cause, Cause::MassMatrix, "{method}: {stopped:?}");
        assert!(!stopped.advice().is_empty());
    }
}

#[test]
fn methods_have_names() {
    for method in Method::ALL {
        assert_eq!(method.name().parse(), Ok(method));
    }
    let message = "rk5".parse::<Method>().expect_err("no such method").to_string();
    assert!(message.contains("`rk5`") && message.contains("rk4, dopri5, rosw4, bdf"), "{message}");
}
