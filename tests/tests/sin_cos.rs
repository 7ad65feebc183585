//! Sines and cosines of generated code against 192-bit results.

use crane_codegen::symbolic::Scalar;
use crane_model::rt::{lanes, sin_cos};
use crane_tests::precise::Precise;
use fastrand::Rng;

/// Units in the last place of the exact result.
const LIMIT: f64 = 0.8;

/// How far a result is off, in units in the last place.
fn ulps(value: f64, exact: &Precise) -> f64 {
    let size = exact.round().abs();
    let unit = f64::from_bits(size.to_bits() + 1) - size;
    (Precise::from_f64(value) - exact.clone()).round().abs() / unit
}

/// Angles of all sizes, some of them as near to a multiple of π/2 as a number can be, also beyond 2²⁰ quarter turns.
fn angles(rng: &mut Rng) -> [f64; 13] {
    std::array::from_fn(|i| {
        let scale = [1e-3, 0.5, 4.0, 1e2, 1e4, 1.6e6, 1e8][i % 7];
        let x = scale * (2.0 * rng.f64() - 1.0);
        if i % 3 == 0 { (x / std::f64::consts::FRAC_PI_2).round() * std::f64::consts::FRAC_PI_2 } else { x }
    })
}

#[test]
fn are_right_to_the_last_place() {
    let mut rng = Rng::with_seed(1);
    for _ in 0..300 {
        let angles = angles(&mut rng);
        let (sines, cosines) = sin_cos(angles);
        let (lane_sines, _) = lanes::sin_cos(angles.map(lanes::splat));
        for (((angle, sin), cos), lane) in angles.into_iter().zip(sines).zip(cosines).zip(lane_sines) {
            let (exact_sin, exact_cos) = Precise::from_f64(angle).sin_cos();
            assert_eq!(sin, lane.to_array()[3], "{angle}: one lane, another number");
            if angle != 0.0 {
                assert!(ulps(sin, &exact_sin) < LIMIT, "sin {angle:?}: {} ulp", ulps(sin, &exact_sin));
            }
            assert!(ulps(cos, &exact_cos) < LIMIT, "cos {angle:?}: {} ulp", ulps(cos, &exact_cos));
        }
    }
}

#[test]
fn results_of_nan_are_nan() {
    for angle in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let ([sin, beside], [cos, _]) = sin_cos([angle, 0.5]);
        assert!(sin.is_nan() && cos.is_nan());
        assert!(ulps(beside, &Precise::from_f64(0.5).sin_cos().0) < LIMIT);
    }
}
