//! Orders, stability and error control of the methods, on cranes written by hand.

mod common;

use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicUsize, Ordering},
};

use common::{
    DoublePendulum, GRAVITY, Lift,
    implicit::{Factors, factorise, solve},
};
use crane_model::{
    CraneModel, Description, Dynamics, Implicit, ParameterError,
    dynamics::{Cause, Method, Settings, bdf, dormand_prince, rk4::State, rosenbrock, simulate},
};
use nalgebra::{Complex, Matrix4, SMatrix, SVector, Vector1, Vector2};

/// A crane that gives the integrator a different Jacobian: stiffness and damping of every coordinate.
#[derive(Clone)]
struct Misled<C> {
    crane: C,
    stiffness_and_damping: [f64; 2],
}

impl<const N: usize, C: CraneModel<N>> CraneModel<N> for Misled<C> {
    fn description(&self) -> &Description {
        self.crane.description()
    }
    fn parameter(&self, index: usize) -> f64 {
        self.crane.parameter(index)
    }
    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        self.crane.set_parameter(index, value)
    }
    fn transforms(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]) {
        self.crane.transforms(q, out);
    }
    fn forces(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.crane.forces(t, q, v)
    }
    fn gravity_energy(&self, q: &SVector<f64, N>) -> f64 {
        self.crane.gravity_energy(q)
    }
}

impl<const N: usize, C: Dynamics<N>> Dynamics<N> for Misled<C> {
    fn mass_matrix(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        self.crane.mass_matrix(q)
    }
    fn bias(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.crane.bias(q, v)
    }
    fn kinetic_energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.crane.kinetic_energy(q, v)
    }
}

impl<const N: usize, C: Dynamics<N>> Implicit<N> for Misled<C> {
    type Factors = Factors<N>;
    fn factorise(&self, q: &SVector<f64, N>, added_inertia: &SVector<f64, N>, _: &SMatrix<f64, 6, 6>) -> Factors<N> {
        factorise(&self.crane, q, added_inertia)
    }
    fn solve(&self, factors: &Factors<N>, r: &SVector<f64, N>) -> SVector<f64, N> {
        solve(factors, r)
    }
    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        out.fill(self.stiffness_and_damping);
    }
}

/// End of a second from `start` in equal steps of a method, and of its embedded formula, which starts every step afresh.
fn run<const N: usize>(
    steps: i32,
    start: State<N>,
    step: impl Fn(f64, f64, &State<N>) -> (State<N>, State<N>),
    embedded: bool,
) -> State<N> {
    let h = f64::from(steps).recip();
    (0..steps).fold(start, |state, k| {
        let (end, error) = step(h * f64::from(k), h, &state);
        if embedded { State { q: end.q - error.q, v: end.v - error.v } } else { end }
    })
}

/// Order from the differences between three halved steps, over several starts: in a single one, terms of two orders may cancel.
fn order<const N: usize>(coarse: i32, starts: &[State<N>], run: impl Fn(i32, State<N>) -> State<N>) -> f64 {
    let ends = [1, 2, 4].map(|factor| starts.iter().map(|start| run(coarse * factor, *start)).collect::<Vec<_>>());
    let distance = |a: &[State<N>], b: &[State<N>]| {
        a.iter().zip(b).map(|(a, b)| (a.q - b.q).norm() + (a.v - b.v).norm()).sum::<f64>()
    };
    (distance(&ends[0], &ends[1]) / distance(&ends[1], &ends[2])).log2()
}

/// Starts of a double pendulum that swings without turning over.
fn starts() -> Vec<State<2>> {
    let start = |k: f64| State { q: Vector2::new(1.2 - 0.3 * k, 0.4 * k - 0.5), v: Vector2::new(0.3, 1.0 - 0.2 * k) };
    (1..5).map(|k| start(f64::from(k))).collect()
}

fn implicit<const N: usize, C: Implicit<N>>(crane: &C) -> impl Fn(f64, f64, &State<N>) -> (State<N>, State<N>) {
    move |t, h, state| rosenbrock::step(crane, t, h, state).expect("inertia")
}

fn explicit<const N: usize, C: Dynamics<N>>(crane: &C) -> impl Fn(f64, f64, &State<N>) -> (State<N>, State<N>) {
    move |t, h, state| dormand_prince::step(crane, t, h, state).expect("inertia")
}

/// How far a measured order may be from the true one: the next term of the error is h as large.
const ORDER: f64 = 0.25;

#[test]
fn orders_on_swinging_double_pendulums() {
    let pendulum = DoublePendulum::hanging();
    for (name, expected, measured) in [
        ("dopri5", 5.0, order(160, &starts(), |n, start| run(n, start, explicit(&pendulum), false))),
        ("dopri5, embedded", 4.0, order(160, &starts(), |n, start| run(n, start, explicit(&pendulum), true))),
        ("rosw4", 4.0, order(320, &starts(), |n, start| run(n, start, implicit(&pendulum), false))),
        ("rosw4, embedded", 3.0, order(320, &starts(), |n, start| run(n, start, implicit(&pendulum), true))),
    ] {
        println!("{name}: {measured:.3}");
        assert!((measured - expected).abs() < ORDER, "{name}: order {measured}");
    }
}

#[test]
fn the_implicit_method_keeps_its_orders_with_any_jacobian() {
    // None at all, and others that have nothing to do with the crane's; the lift's is [4000, 40].
    for stiffness_and_damping in [[0.0, 0.0], [20.0, 0.0], [3.0, 7.0]] {
        let pendulum = Misled { crane: DoublePendulum::hanging(), stiffness_and_damping };
        let measured = order(320, &starts(), |n, start| run(n, start, implicit(&pendulum), false));
        assert!((measured - 4.0).abs() < ORDER, "{stiffness_and_damping:?}: order {measured}");
        let measured = order(320, &starts(), |n, start| run(n, start, implicit(&pendulum), true));
        assert!((measured - 3.0).abs() < ORDER, "{stiffness_and_damping:?}, embedded: order {measured}");
        // A drive depends on time besides.
        let lift = Misled { crane: Lift::default(), stiffness_and_damping };
        let rest = [State::at_rest(Vector1::new(lift.crane.sag()))];
        let measured = order(160, &rest, |n, start| run(n, start, implicit(&lift), false));
        assert!((measured - 4.0).abs() < ORDER, "{stiffness_and_damping:?}, driven: order {measured}");
    }
}

#[test]
fn the_implicit_method_meets_its_stability_function() {
    // z̈ + 2ζω ż + ω² z = 0 about the equilibrium: an eigenvector of λ is multiplied by R(hλ) in one step.
    let lift = Lift { amplitude: 0.0, ..Lift::default() };
    let decay = lift.damping / (2.0 * lift.mass);
    let lambda = Complex::new(-decay, (lift.stiffness / lift.mass - decay * decay).sqrt());
    for h in [1e-3, 0.03, 0.2, 1.0, 50.0] {
        let real = |part: fn(&Complex<f64>) -> f64| {
            let start =
                State { q: Vector1::new(lift.sag() + part(&Complex::new(1.0, 0.0))), v: Vector1::new(part(&lambda)) };
            let (end, _) = rosenbrock::step(&lift, 0.0, h, &start).expect("mass");
            Complex::new(end.q.x - lift.sag(), end.v.x)
        };
        let (re, im) = (real(|z| z.re), real(|z| z.im));
        let factor = Method::Rosenbrock.stability().value(lambda * h);
        let (q, v) = (Complex::new(re.re, im.re), Complex::new(re.im, im.im));
        // Coefficients have 15 digits, and (hω)² = 1e6 amplifies them for the longest step.
        assert!((q - factor).norm() < 1e-9 && (v / lambda - factor).norm() < 1e-9, "h {h}: {q} {v} {factor}");
    }
}

#[test]
fn the_implicit_method_is_stable_up_to_a_sector() {
    let function = Method::Rosenbrock.stability();
    let most = |ratio: f64| {
        let direction = Complex::new(-ratio, (1.0 - ratio * ratio).sqrt());
        (0..200_000).map(|k| function.value(direction * (f64::from(k) * 1e-2)).norm()).fold(0.0, f64::max)
    };
    // Undamped modes grow by 0.644 % a step at most, at hω = 3.5; a damping ratio of 0.0035 suffices: sin(90° − 89.8°).
    assert!((most(0.0) - 1.006_44).abs() < 1e-5, "{}", most(0.0));
    for ratio in [0.0035, 0.01, 0.1, 0.5, 1.0] {
        assert!(most(ratio) <= 1.0 + 1e-12, "{ratio}: {}", most(ratio));
    }
    assert!(function.value(Complex::new(-1e9, 0.0)).norm() < 1e-7);
    // R agrees with the exponential up to order 4.
    let z = Complex::new(0.01, 0.02);
    assert!((function.value(z) - z.exp()).norm() < 1e-2 * z.norm().powi(5));
}

/// Steps of backward differences over a second, from as many exact states as the order: a step of the pair hardly errs.
fn differences<const N: usize, C: Implicit<N>>(crane: &C, order: usize, steps: i32, start: State<N>) -> State<N> {
    /// Steps of the pair in a step.
    const FINE: i32 = 8;
    let h = f64::from(steps).recip();
    let fine = |from: i32, state: State<N>| {
        (0..FINE).fold(state, |state, k| {
            let part = h / f64::from(FINE);
            explicit(crane)(h * f64::from(from) + part * f64::from(k), part, &state).0
        })
    };
    // The last first.
    let mut past = vec![start];
    for k in 0..steps {
        let next = if past.len() < order {
            fine(k, past[0])
        } else {
            bdf::step(crane, h * f64::from(k), h, &past[..order]).expect("inertia")
        };
        past.insert(0, next);
    }
    past[0]
}

#[test]
fn backward_differences_have_their_orders_with_any_jacobian() {
    // Both converge to the same state, so a Jacobian that slows the iteration down does not count.
    for stiffness_and_damping in [[0.0, 0.0], [3.0, 7.0]] {
        let pendulum = Misled { crane: DoublePendulum::hanging(), stiffness_and_damping };
        for expected in 1..=bdf::ORDER {
            let measured = order(320, &starts(), |n, start| differences(&pendulum, expected, n, start));
            println!("{stiffness_and_damping:?} bdf{expected}: {measured:.3}");
            assert!(
                (measured - expected as f64).abs() < ORDER,
                "{stiffness_and_damping:?}, order {expected}: {measured}"
            );
        }
    }
}

/// A lift without drive, swinging freely with the circular frequency 20 rad/s and a damping ratio.
fn swinging(ratio: f64) -> (Lift, Complex<f64>) {
    let lift = Lift { amplitude: 0.0, ..Lift::default() };
    let omega = (lift.stiffness / lift.mass).sqrt();
    let lift = Lift { damping: 2.0 * ratio * omega * lift.mass, ..lift };
    (lift, Complex::new(-ratio, (1.0 - ratio * ratio).sqrt()) * omega)
}

#[test]
fn backward_differences_meet_their_stability_function() {
    // Past states on an eigenvector of λ that is multiplied by R a step: so is the next.
    for ratio in [0.0, 0.1, 0.9] {
        let (lift, lambda) = swinging(ratio);
        for h in [1e-3, 0.03, 0.2, 1.0, 50.0] {
            let factor = Method::Bdf.stability().value(lambda * h);
            let part = |part: fn(&Complex<f64>) -> f64| {
                let past = [Complex::new(1.0, 0.0), factor.inv()]
                    .map(|z| State { q: Vector1::new(lift.sag() + part(&z)), v: Vector1::new(part(&(lambda * z))) });
                let end = bdf::step(&lift, 0.0, h, &past).expect("mass");
                (end.q.x - lift.sag(), end.v.x)
            };
            let (re, im) = (part(|z| z.re), part(|z| z.im));
            let (q, v) = (Complex::new(re.0, im.0), Complex::new(re.1, im.1));
            let scale = factor.inv().norm();
            // Of the past states as large as 1/R, (hω)² = 1e6 amplifies rounding for the longest step.
            assert!((q - factor).norm() < 1e-9 * scale, "{ratio}, h {h}: {q} {factor}");
            assert!((v / lambda - factor).norm() < 1e-9 * scale, "{ratio}, h {h}: {v} {factor}");
        }
    }
}

#[test]
fn backward_differences_are_stable_up_to_a_sector() {
    /// Steps of a run: what grows by 2 % a step is a thousand times as large in the end.
    const STEPS: usize = 400;
    /// Greatest growth, over steps from a hundredth of what a mode asks for to a hundred times that.
    fn growth(order: usize, ratio: f64) -> f64 {
        let (lift, lambda) = swinging(ratio);
        let run = |z: f64| {
            let mut past = vec![State { q: Vector1::new(lift.sag() + 1.0), v: Vector1::new(0.0) }; order];
            for _ in 0..STEPS {
                let next = bdf::step(&lift, 0.0, z / lambda.norm(), &past).expect("mass");
                past.insert(0, next);
                past.truncate(order);
            }
            (past[0].q.x - lift.sag()).hypot(past[0].v.x / lambda.norm())
        };
        (-40..=40).map(|power| run(10_f64.powf(f64::from(power) / 20.0))).fold(0.0, f64::max)
    }
    // Orders 1 and 2 are stable for every damped mode, orders 3 and 4 from the damping ratios sin(90° − 86.0°) = 0.07 and
    // sin(90° − 73.4°) = 0.29 on.
    for (order, ratio) in [(1, 0.0), (2, 0.0), (3, 0.075), (4, 0.3)] {
        assert!(growth(order, ratio) < 2.0, "order {order}, {ratio}: {:e}", growth(order, ratio));
    }
    for (order, ratio) in [(3, 0.03), (4, 0.2)] {
        assert!(growth(order, ratio) > 10.0, "order {order}, {ratio}: {:e}", growth(order, ratio));
    }
    // Stiff motions die out at once.
    let (lift, lambda) = swinging(0.5);
    for order in 1..=bdf::ORDER {
        let past = vec![State { q: Vector1::new(lift.sag()), v: Vector1::new(0.0) }; order];
        let away = State { q: Vector1::new(lift.sag() + 1.0), v: Vector1::new(0.0) };
        let past: Vec<_> = std::iter::once(away).chain(past).take(order).collect();
        let end = bdf::step(&lift, 0.0, 1e4 / lambda.norm(), &past).expect("mass");
        assert!((end.q.x - lift.sag()).abs() < 1e-3, "order {order}: {end:?}");
    }
}

#[test]
fn unresolved_undamped_modes_do_not_grow_in_adaptive_runs() {
    // 20 rad/s, and a tolerance that steps of half a swing meet once the swinging is small.
    let (lift, _) = swinging(0.0);
    let settings = Settings {
        method: Method::Bdf,
        tolerance: 0.1,
        duration: 600.0,
        ..Settings::of(&common::description("", &[], &[]))
    };
    let mut most = 0.0_f64;
    let start = State::at_rest(Vector1::new(lift.sag() + 1e-3));
    simulate(&lift, start, &settings, |sample| {
        most = most.max((sample.q[0] - lift.sag()).abs());
        ControlFlow::Continue(())
    })
    .expect("a run");
    // What grows is noticed at the tolerance of a step.
    assert!(most < 0.1, "{most}");
}

/// A lift on a spring of 2e5 rad/s, far beyond what steps resolve: the mass follows its drive, z ≈ sag + 0.1 m sin 7t, but for
/// m a Ω²/s = 1e-10 m.
fn stiff_lift() -> Lift {
    Lift { stiffness: 4e11, damping: 4e5, ..Lift::default() }
}

#[test]
fn a_stiff_spring_is_not_forced_by_its_drive() {
    let lift = stiff_lift();
    let start = State { q: Vector1::new(lift.sag()), v: Vector1::new(lift.amplitude * lift.frequency) };
    let exact = (lift.sag() + lift.amplitude * lift.frequency.sin(), 0.7 * lift.frequency.cos());
    let end = run(50, start, implicit(&lift), false);
    // The deviation from the drive's motion is all that is integrated. Of the rate, what differencing of the motion leaves.
    assert!((end.q.x - exact.0).abs() < 1e-9 && (end.v.x - exact.1).abs() < 1e-6, "{end:?} {exact:?}");
}

#[test]
fn efforts_are_right_however_stiff_the_drive() {
    for stiffness in [1e6, 1e8, 1e10, 1e12] {
        // In the limit of a rigid drive the effort is m (g + z̈_dr). The start misses the rate m a Ω³/s of the spring, which rings
        // with ω = √(s/m).
        let lift = Lift { stiffness, damping: 1e-3 * stiffness, ..Lift::default() };
        let Lift { mass, amplitude, frequency, .. } = lift;
        let start = State { q: Vector1::new(lift.sag()), v: Vector1::new(amplitude * frequency) };
        for method in [Method::Rosenbrock, Method::Bdf] {
            let settings = Settings { method, duration: 3.0, output: 7e-3, ..Settings::of(lift.description) };
            let (mut worst, mut peak) = (0.0_f64, 0.0_f64);
            let run = simulate(&lift, start, &settings, |sample| {
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
            // The tolerance asks for a thousandth of a step; rounding of a position of 0.1 m times the stiffness is 2e-5 N.
            assert!(worst < 2e-3 * peak + ringing, "{method} {stiffness:e}: {worst:e} of {peak} N");
            let said = &run.efforts[0];
            assert!((said.peak / peak - 1.0).abs() < 0.01 && said.error < 0.01 * peak, "{said:?}, {peak}");
        }
    }
}

#[test]
fn what_rounding_leaves_of_an_effort_is_said() {
    // 1e18 N/m times the rounding of a position of 0.1 m are some 10 N: no step is short enough.
    let lift = Lift { stiffness: 1e18, damping: 1e15, ..Lift::default() };
    let start = State { q: Vector1::new(lift.sag()), v: Vector1::new(lift.amplitude * lift.frequency) };
    for method in [Method::Rosenbrock, Method::Bdf] {
        let settings = Settings { method, duration: 1.0, ..Settings::of(lift.description) };
        let run = simulate(&lift, start, &settings, |_| ControlFlow::Continue(())).expect("a run");
        assert!(run.efforts[0].error > 10.0, "{method}: {run:?}");
    }
}

#[test]
fn backward_differences_keep_their_orders_where_a_stiff_spring_is_forced() {
    // Of a crane that does not say what its drive prescribes; rates are differences of positions that follow it, and lose nothing.
    let lift = stiff_lift();
    let blind = Misled { crane: lift, stiffness_and_damping: [lift.stiffness, lift.damping] };
    let forced = |t: f64| {
        let (sin, cos) = (lift.frequency * t).sin_cos();
        let rate = lift.amplitude * lift.frequency * cos;
        State { q: Vector1::new(lift.sag() + lift.amplitude * sin), v: Vector1::new(rate) }
    };
    for order in 1..=bdf::ORDER {
        let errors = [50, 100, 200].map(|n: i32| {
            let h = f64::from(n).recip();
            // The last first.
            let mut past: Vec<_> = (0..order).rev().map(|k| forced(h * k as f64)).collect();
            for k in past.len()..=usize::try_from(n).expect("steps") {
                past.insert(0, bdf::step(&blind, h * (k - 1) as f64, h, &past[..order]).expect("mass"));
            }
            [(past[0].q.x - forced(1.0).q.x).abs(), (past[0].v.x - forced(1.0).v.x).abs()]
        });
        let measured = (errors[0][1] / errors[2][1]).log2() / 2.0;
        println!("order {order}: {measured:.3} of rates, {errors:?}");
        assert!((measured - order as f64).abs() < ORDER, "order {order}: {measured}, {errors:?}");
        // Positions are off by the rates' error times d/s, except for the spring's own deflection.
        assert!(errors[0][0] < 1e-5 * errors[0][1] + 1e-9, "order {order}: {errors:?}");
    }
}

/// Greatest error of a run of the lift at its results, m, and the run's statistics.
fn lift_error(method: Method, tolerance: f64, output: f64) -> (f64, crane_model::dynamics::Run) {
    let lift = Lift::default();
    let settings =
        Settings { method, tolerance, output, duration: 3.0, ..Settings::of(&common::description("", &[], &[])) };
    let mut worst = 0.0_f64;
    let run = simulate(&lift, State::at_rest(Vector1::new(lift.sag())), &settings, |sample| {
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
    let settings =
        |method| Settings { method, tolerance: 1e-7, output: 5.1, duration: 5.1, ..Settings::of(lift.description) };
    let end = |settings: &Settings| {
        let mut end = 0.0;
        let rest = State::at_rest(Vector1::new(lift.sag()));
        let run = simulate(&lift, rest, settings, |sample| {
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

/// A crane that counts how often it is asked for its accelerations and for factors.
struct Counted<C> {
    crane: C,
    evaluations: AtomicUsize,
    factorisations: AtomicUsize,
}

impl<const N: usize, C: CraneModel<N>> CraneModel<N> for Counted<C> {
    fn description(&self) -> &Description {
        self.crane.description()
    }
    fn parameter(&self, index: usize) -> f64 {
        self.crane.parameter(index)
    }
    fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
        self.crane.set_parameter(index, value)
    }
    fn transforms(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]) {
        self.crane.transforms(q, out);
    }
    fn forces(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.crane.forces(t, q, v)
    }
    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]) {
        self.crane.drive_motions(t, out);
    }
    fn gravity_energy(&self, q: &SVector<f64, N>) -> f64 {
        self.crane.gravity_energy(q)
    }
}

impl<const N: usize, C: Dynamics<N>> Dynamics<N> for Counted<C> {
    fn mass_matrix(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        self.crane.mass_matrix(q)
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
}

impl<const N: usize, C: Implicit<N>> Implicit<N> for Counted<C> {
    type Factors = C::Factors;
    fn factorise(&self, q: &SVector<f64, N>, added_inertia: &SVector<f64, N>, base: &SMatrix<f64, 6, 6>) -> C::Factors {
        self.factorisations.fetch_add(1, Ordering::Relaxed);
        self.crane.factorise(q, added_inertia, base)
    }
    fn solve(&self, factors: &C::Factors, r: &SVector<f64, N>) -> SVector<f64, N> {
        self.crane.solve(factors, r)
    }
    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        self.crane.joint_stiffness_and_damping(out);
    }
}

#[test]
fn statistics_count_what_was_done() {
    for method in Method::ALL {
        // Steps of DoublePendulum's first seconds are rejected now and then.
        let none = AtomicUsize::new(0);
        let crane =
            Counted { crane: DoublePendulum::hanging(), evaluations: none, factorisations: AtomicUsize::new(0) };
        let settings = Settings { method, tolerance: 1e-6, duration: 3.0, ..Settings::of(crane.crane.description) };
        let start = State::at_rest(Vector2::new(2.2, -0.5));
        let run = simulate(&crane, start, &settings, |_| ControlFlow::Continue(())).expect("a run");
        assert_eq!(run.statistics.evaluations, crane.evaluations.into_inner(), "{method}");
        assert_eq!(run.statistics.factorisations, crane.factorisations.into_inner(), "{method}");
        let tried = run.statistics.steps + run.statistics.rejections;
        assert!(run.statistics.steps > 10 && run.statistics.evaluations >= tried, "{method}: {run:?}");
    }
}

#[test]
fn a_run_ends_at_its_limit_of_steps() {
    let lift = Lift::default();
    for method in Method::ALL {
        let settings = Settings { method, most_steps: 20, ..Settings::of(lift.description) };
        let rest = State::at_rest(Vector1::new(lift.sag()));
        let stopped = simulate(&lift, rest, &settings, |_| ControlFlow::Continue(())).expect_err("too many steps");
        assert_eq!((stopped.cause, stopped.method), (Cause::Steps, method));
        assert!(stopped.time > 0.0 && stopped.time < 10.0, "{stopped:?}");
        let (message, advice) = (stopped.to_string(), stopped.advice());
        assert!(
            message.contains("used up its number of steps") && advice.contains("most_steps"),
            "{message}; {advice}"
        );
        assert_eq!(advice.contains("tolerance"), method.is_adaptive(), "{advice}");
    }
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
                ..Settings::of(&common::description("", &[], &[]))
            };
            let (mut first, mut worst) = (None, 0.0_f64);
            simulate(&lift, State::at_rest(Vector1::new(lift.sag())), &settings, |sample| {
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
        let settings = Settings { method, ..Settings::of(&common::description("", &[], &[])) };
        let massless = Lift { mass: 0.0, ..Lift::default() };
        let start = State::at_rest(Vector1::zeros());
        let stopped = simulate(&massless, start, &settings, |_| ControlFlow::Continue(())).expect_err("no mass");
        assert_eq!((stopped.cause, stopped.coordinate.as_str()), (Cause::MassMatrix, "lift_z"), "{method}");
        let pendulum = DoublePendulum { gravity: 1e300, ..DoublePendulum::hanging() };
        let start = State::at_rest(Vector2::new(0.4, -0.3));
        let stopped = simulate(&pendulum, start, &settings, |_| ControlFlow::Continue(())).expect_err("no number");
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
