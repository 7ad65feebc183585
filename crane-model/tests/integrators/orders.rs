//! Orders and stability functions of the methods, at constant steps.

use crane_model::{
    CraneModel, Description, ParameterError,
    dynamics::{Method, bdf, dormand_prince, rk4::State, rosenbrock},
};
use nalgebra::{Complex, Matrix4, SMatrix, SVector, Vector1, Vector2};

use crate::common::{
    DoublePendulum, Lift,
    implicit::{Factors, factorise, solve},
};
use crate::{implicit, state_after_a_second, stiff_lift, swinging};

/// A crane that gives the integrator a different Jacobian: stiffness and damping of every coordinate.
#[derive(Clone)]
struct Misled<C> {
    crane: C,
    stiffness_and_damping: [f64; 2],
}

// It does not report the motions of its drives.
impl_model_as_in_crane! {
    Misled
    fn mass_matrix(&self, q: &SVector<f64, N>, out: &mut SMatrix<f64, N, N>) {
        self.crane.mass_matrix(q, out);
    }
    fn bias(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.crane.bias(q, v)
    }
    fn kinetic_energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.crane.kinetic_energy(q, v)
    }
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

/// Order from the differences between runs with three successively halved steps, over several starts: in a single run, terms of two orders
/// may cancel.
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

fn explicit<const N: usize, C: CraneModel<N>>(crane: &C) -> impl Fn(f64, f64, &State<N>) -> (State<N>, State<N>) {
    move |t, h, state| dormand_prince::step(crane, t, h, state).expect("inertia")
}

/// How far a measured order may be from the true one: the next term of the error is smaller by a factor of h.
const ORDER: f64 = 0.25;

#[test]
fn orders_on_swinging_double_pendulums() {
    let pendulum = DoublePendulum::hanging();
    for (name, expected, measured) in [
        ("dopri5", 5.0, order(160, &starts(), |n, start| state_after_a_second(n, start, explicit(&pendulum), false))),
        (
            "dopri5, embedded",
            4.0,
            order(160, &starts(), |n, start| state_after_a_second(n, start, explicit(&pendulum), true)),
        ),
        ("rosw4", 4.0, order(320, &starts(), |n, start| state_after_a_second(n, start, implicit(&pendulum), false))),
        (
            "rosw4, embedded",
            3.0,
            order(320, &starts(), |n, start| state_after_a_second(n, start, implicit(&pendulum), true)),
        ),
    ] {
        println!("{name}: {measured:.3}");
        assert!((measured - expected).abs() < ORDER, "{name}: order {measured}");
    }
}

#[test]
fn the_implicit_method_keeps_its_orders_with_any_jacobian() {
    // No Jacobian at all, and others unrelated to the crane's; the lift's is [4000, 40].
    for stiffness_and_damping in [[0.0, 0.0], [20.0, 0.0], [3.0, 7.0]] {
        let pendulum = Misled { crane: DoublePendulum::hanging(), stiffness_and_damping };
        let measured = order(320, &starts(), |n, start| state_after_a_second(n, start, implicit(&pendulum), false));
        assert!((measured - 4.0).abs() < ORDER, "{stiffness_and_damping:?}: order {measured}");
        let measured = order(320, &starts(), |n, start| state_after_a_second(n, start, implicit(&pendulum), true));
        assert!((measured - 3.0).abs() < ORDER, "{stiffness_and_damping:?}, embedded: order {measured}");
        // A drive depends on time, too.
        let lift = Misled { crane: Lift::default(), stiffness_and_damping };
        let rest = [State::at_rest(Vector1::new(lift.crane.sag()))];
        let measured = order(160, &rest, |n, start| state_after_a_second(n, start, implicit(&lift), false));
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
    // Undamped modes grow by 0.644 % per step at most, at hω = 3.5; a damping ratio of 0.0035 suffices: sin(90° − 89.8°).
    assert!((most(0.0) - 1.006_44).abs() < 1e-5, "{}", most(0.0));
    for ratio in [0.0035, 0.01, 0.1, 0.5, 1.0] {
        assert!(most(ratio) <= 1.0 + 1e-12, "{ratio}: {}", most(ratio));
    }
    assert!(function.value(Complex::new(-1e9, 0.0)).norm() < 1e-7);
    // R agrees with the exponential up to order 4.
    let z = Complex::new(0.01, 0.02);
    assert!((function.value(z) - z.exp()).norm() < 1e-2 * z.norm().powi(5));
}

/// Steps of backward differences over a second, from as many states as the order, computed almost exactly by fine steps of the explicit
/// pair.
fn differences<const N: usize, C: CraneModel<N>>(crane: &C, order: usize, steps: i32, start: State<N>) -> State<N> {
    /// Steps of the explicit pair per step.
    const FINE: i32 = 8;
    let h = f64::from(steps).recip();
    let fine = |from: i32, state: State<N>| {
        (0..FINE).fold(state, |state, k| {
            let part = h / f64::from(FINE);
            explicit(crane)(h * f64::from(from) + part * f64::from(k), part, &state).0
        })
    };
    // Most recent first.
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
    // The iteration converges to the same state with both, so that a poor Jacobian only slows it down.
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

#[test]
fn backward_differences_meet_their_stability_function() {
    // If past states are on an eigenvector of λ and multiplied by R per step, so is the next one.
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
            // For the longest step, (hω)² = 1e6 amplifies the rounding errors of past states as large as 1/R.
            assert!((q - factor).norm() < 1e-9 * scale, "{ratio}, h {h}: {q} {factor}");
            assert!((v / lambda - factor).norm() < 1e-9 * scale, "{ratio}, h {h}: {v} {factor}");
        }
    }
}

#[test]
fn backward_differences_are_stable_up_to_a_sector() {
    /// Steps of a run: growth by 2 % per step amounts to more than a factor of a thousand.
    const STEPS: usize = 400;
    /// Maximum growth over step sizes from 0.01/|λ| to 100/|λ|.
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
    // Stiff motions decay within one step.
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
fn backward_differences_keep_their_orders_where_a_stiff_spring_is_forced() {
    // For a crane that does not report the motion of its drive; rates are differences of positions that follow it, and keep their order.
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
            // Most recent first.
            let mut past: Vec<_> = (0..order).rev().map(|k| forced(h * k as f64)).collect();
            for k in past.len()..=usize::try_from(n).expect("steps") {
                past.insert(0, bdf::step(&blind, h * (k - 1) as f64, h, &past[..order]).expect("mass"));
            }
            [(past[0].q.x - forced(1.0).q.x).abs(), (past[0].v.x - forced(1.0).v.x).abs()]
        });
        let measured = (errors[0][1] / errors[2][1]).log2() / 2.0;
        println!("order {order}: {measured:.3} of rates, {errors:?}");
        assert!((measured - order as f64).abs() < ORDER, "order {order}: {measured}, {errors:?}");
        // The error of positions is that of rates times d/s, apart from the deflection of the spring.
        assert!(errors[0][0] < 1e-5 * errors[0][1] + 1e-9, "order {order}: {errors:?}");
    }
}
