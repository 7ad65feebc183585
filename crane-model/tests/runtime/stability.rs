//! The largest stable step: predicted from eigenvalues, observed by bisection over runs.

use crate::live::Live;
use crane_codegen::SourceFile;
use crane_model::{
    CoordinateKind, CoordinateRole, CraneModel,
    dynamics::{Method, rk4},
    modes::{SmallMotions, damped},
    stability::{StabilityFunction, cause, grouped, limit},
    statics,
};
use crane_shipped as cranes;
use nalgebra::{Complex, SVector};

/// Maximum relative difference between predicted and observed limits.
const AGREEMENT: f64 = 0.03;
/// Steps of a run that shows growth: 1 % beyond its limit RK4 multiplies the limiting mode by 1.03 or more per step.
const STEPS: usize = 400;
/// Rates of all coordinates at the start, m/s and rad/s: all modes take part, and motions stay small.
const RATE: f64 = 1e-7;
/// Growth of kinetic energy that a damped or oscillating motion does not reach.
const GROWTH: f64 = 1e4;

/// Largest stable step of RK4 according to its stability function, s.
fn predicted<const N: usize, C: CraneModel<N>>(crane: &C, q: &SVector<f64, N>) -> f64 {
    let modes = damped(&SmallMotions::from(&crane.linearise(q))).expect("modes");
    limit(&modes, &Method::Rk4.stability()).expect("a limit").step
}

/// Whether small motions about `q`, the equilibrium with the drives as at time `t`, stay small.
fn stays<const N: usize, C: CraneModel<N>>(crane: &C, t: f64, q: &SVector<f64, N>, step: f64) -> bool {
    let mut state = rk4::State { q: *q, v: SVector::repeat(RATE) };
    let start = crane.kinetic_energy(&state.q, &state.v);
    for _ in 0..STEPS {
        let stopped = rk4::step(crane, t, step, &mut state).is_err();
        let energy = crane.kinetic_energy(&state.q, &state.v);
        if stopped || energy.is_nan() || energy > GROWTH * start {
            return false;
        }
    }
    true
}

/// Largest step with which small motions stay small, by bisection, s.
fn observed<const N: usize, C: CraneModel<N>>(crane: &C, t: f64, q: &SVector<f64, N>, near: f64) -> f64 {
    let (mut stable, mut unstable) = (0.9 * near, 1.1 * near);
    assert!(stays(crane, t, q, stable) && !stays(crane, t, q, unstable), "the limit is not within 10 % of {near:e} s");
    while unstable - stable > 0.004 * near {
        let middle = 0.5 * (stable + unstable);
        *(if stays(crane, t, q, middle) { &mut stable } else { &mut unstable }) = middle;
    }
    0.5 * (stable + unstable)
}

fn agree<const N: usize, C: CraneModel<N>>(name: &str, crane: &C, t: f64, q: &SVector<f64, N>) {
    let predicted = predicted(crane, q);
    let observed = observed(crane, t, q, predicted);
    let error = observed / predicted - 1.0;
    println!("{name}: predicted {predicted:.4e} s, observed {observed:.4e} s, {:+.2} %", 100.0 * error);
    assert!(error.abs() < AGREEMENT, "{name}: predicted {predicted:e} s, observed {observed:e} s");
}

#[test]
fn predicted_limits_of_all_shipped_cranes_are_observed() {
    let mut seen = 0;
    macro_rules! check {
        ($($name:ident),*) => {$({
            let crane = cranes::$name::Crane::default();
            let vector = |q: &[f64]| SVector::<f64, { cranes::$name::N }>::from_column_slice(q);
            let start = statics::Problem::new(&crane).solve().q;
            // At the end the drives stand still; at t = 0 some already move.
            let t = cranes::$name::DESCRIPTION.duration;
            let end = statics::Problem::new(&crane).at_time(t).from(&start).solve();
            assert!(end.is_stable(), "{}", end.status);
            agree(stringify!($name), &crane, t, &vector(&end.q));
            seen += 1;
        })*};
    }
    check!(
        cantilever,
        double_pendulum,
        eight_link_flexible,
        eight_link_identified,
        eight_link_rigid,
        eight_link_two_flexible,
        knuckle_boom,
        loader_tipping,
        two_arms
    );
    // Single steps do not support the states of valves.
    let with_valves = cranes::all().iter().filter(|crane| crane.description().has_valves()).count();
    assert_eq!(seen + with_valves, cranes::all().len(), "a crane is missing above");
}

#[test]
fn predicted_limits_are_observed_for_1_to_16_sections() {
    let reference =
        SourceFile::new("eight_link_flexible.yaml", crane_specs::spec("eight_link_flexible").expect("shipped"));
    macro_rules! check {
        ($($sections:literal),*) => {$({
            let changes = concat!("links: [{name: boom, beam: {sections: ", $sections, "}}]");
            let crane = Live::<{ 13 + 3 * $sections }>::new(&reference.changed(changes));
            agree(concat!($sections, " sections"), &crane, 0.0, &crane.equilibrium());
        })*};
    }
    check!(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
}

#[test]
fn limits_of_rk4_on_both_axes() {
    let function = Method::Rk4.stability();
    // Bisection to the last bits; |R| may exceed 1 by 1e-12, which moves the crossing by less than 1e-11.
    let limit = |re, im| function.largest_step(Complex::new(re, im)).expect("a limit");
    let relative = |a: f64, b: f64| ((a - b) / b).abs();
    assert!(relative(limit(0.0, 20.0), rk4::IMAGINARY_LIMIT / 20.0) < 1e-11);
    assert!(relative(limit(-500.0, 0.0), rk4::REAL_LIMIT / 500.0) < 1e-11);
    assert_eq!(function.largest_step(Complex::new(0.0, 0.0)), None);
    // Growth belongs to the motion itself; a rounding error of zero damping must not forbid every step.
    assert!(relative(limit(1e-9, 20.0), rk4::IMAGINARY_LIMIT / 20.0) < 1e-11);
}

#[test]
fn an_a_stable_function_limits_nothing() {
    // Trapezoidal rule, and backward Euler method.
    for denominator in [&[1.0, -0.5][..], &[1.0, -1.0]] {
        let numerator: &[f64] = if denominator[1] == -0.5 { &[1.0, 0.5] } else { &[1.0] };
        let function = StabilityFunction::Rational { numerator, denominator };
        for eigenvalue in [Complex::new(-1e4, 0.0), Complex::new(-1e-3, 300.0), Complex::new(0.0, 5.0)] {
            assert_eq!(function.largest_step(eigenvalue), None, "{eigenvalue}");
        }
    }
}

#[test]
fn the_boundary_is_where_the_size_is_one() {
    let function = Method::Rk4.stability();
    let boundary = function.boundary();
    // Newton's steps reach the last bits of R.
    assert!(boundary.iter().all(|z| (function.value(*z).norm() - 1.0).abs() < 1e-12));
    let closes = boundary.last().expect("points");
    assert!(closes.norm() < 1e-6, "{closes}");
    let left = boundary.iter().map(|z| z.re).fold(0.0, f64::min);
    // Within a degree of R from its end on the real axis, the curve hardly changes its real part.
    assert!((left + rk4::REAL_LIMIT).abs() < 1e-3, "{left}");
}

#[test]
fn the_derivative_is_that_of_the_function() {
    let function = StabilityFunction::Rational { numerator: &[1.0, 0.3, 0.2], denominator: &[1.0, -0.7, 0.1] };
    let (z, d) = (Complex::new(-0.4, 1.1), 1e-5);
    let difference = (function.value(z + d) - function.value(z - d)) / (2.0 * d);
    // Central difference: d² of numbers of size 1.
    assert!((function.derivative(z) - difference).norm() < 1e-9);
}

#[test]
fn the_limit_of_the_reference_crane_in_plain_words() {
    use crane_shipped::eight_link_flexible::{Crane, DESCRIPTION, N};
    let crane = Crane::default();
    let q = statics::Problem::new(&crane).solve().q;
    let q = SVector::<f64, N>::from_column_slice(&q);
    let modes = damped(&SmallMotions::from(&crane.linearise(&q))).expect("modes");
    let limit = limit(&modes, &Method::Rk4.stability()).expect("a limit");
    assert_eq!(cause(&DESCRIPTION, &limit.mode), "torsion of boom elements 3, 2; 22,900 rad/s");
    // Modes of all kinds of coordinates are distinguished.
    let words: Vec<String> = modes.iter().map(|mode| cause(&DESCRIPTION, mode)).collect();
    for part in ["base (truck_x)", "drive of telescope_z", "joint upper_hinge_psi", "bending in x-y of boom"] {
        assert!(words.iter().any(|words| words.contains(part)), "{part}: {words:?}");
    }
    assert!(
        DESCRIPTION.coordinates.iter().any(|c| c.role == CoordinateRole::Base && c.kind == CoordinateKind::Rotation)
    );
}

#[test]
fn numbers_have_three_digits_and_groups() {
    let cases = [
        (22_921.1, "22,900"),
        (9_930.0, "9,930"),
        (999.96, "1,000"),
        (474.45, "474"),
        (2.185_05, "2.19"),
        (38.25, "38.2"),
        (1_234_567.0, "1,230,000"),
        (0.018_2, "0.018"),
    ];
    for (number, text) in cases {
        assert_eq!(grouped(number), text);
    }
}
