//! Stumpff functions of generated code and of the interpreter against 192-bit results.

use crane_codegen::symbolic::Scalar;
use crane_model::rt::{lanes, stumpff};
use crane_tests::precise::Precise;
use fastrand::Rng;

/// Units in the last place of the exact result, for x ≤ 10: a section bent by 180° has x = π².
const LIMIT: f64 = 3.2;
/// c₀ and c₁ have zeros, c₂ beyond 10: there the error is measured by 1/k!, the value at x = 0.
const OF_LARGEST: f64 = 1.2e-15;

/// How far a result is off.
fn off(value: f64, exact: &Precise) -> f64 {
    (Precise::from_f64(value) - exact.clone()).round().abs()
}

fn reciprocal_factorial(k: u8) -> f64 {
    (1..=k).map(f64::from).product::<f64>().recip()
}

/// Arguments of all sizes up to 100; one is 0 and one is where the polynomials end.
fn arguments(rng: &mut Rng) -> [f64; 13] {
    std::array::from_fn(|i| match i {
        0 => 0.0,
        1 => 10.0,
        _ => [1e-9, 1e-2, 1.0, 10.0, 10.0, 100.0][i % 6] * rng.f64(),
    })
}

#[test]
fn are_right_to_the_last_place() {
    let mut rng = Rng::with_seed(3);
    let mut worst = [0.0_f64; 6];
    for _ in 0..400 {
        let arguments = arguments(&mut rng);
        let values = stumpff(arguments);
        let in_lanes = lanes::stumpff(arguments.map(lanes::splat));
        for (i, &x) in arguments.iter().enumerate() {
            for (k, (row, in_lane)) in (0..).zip(values.iter().zip(&in_lanes)) {
                let exact = Precise::from_f64(x).stumpff(k);
                assert_eq!(row[i], in_lane[i].to_array()[5], "c_{k}({x:?}): one lane, another number");
                // The interpreter computes it in another way.
                let interpreted = off(x.stumpff(k), &exact);
                assert!(
                    interpreted < 4e-15 * reciprocal_factorial(k),
                    "c_{k}({x:?}): interpreter off by {interpreted:e}"
                );
                if k < 2 || x > 10.0 {
                    assert!(
                        off(row[i], &exact) < OF_LARGEST * reciprocal_factorial(k),
                        "c_{k}({x:?}) off by {:e}",
                        off(row[i], &exact)
                    );
                    continue;
                }
                let size = exact.round();
                let ulps = off(row[i], &exact) / (f64::from_bits(size.to_bits() + 1) - size);
                worst[usize::from(k)] = worst[usize::from(k)].max(ulps);
            }
        }
    }
    println!("{worst:.2?}");
    assert!(worst.iter().all(|ulps| *ulps < LIMIT), "units in the last place: {worst:.2?}");
}

#[test]
fn of_zero_are_reciprocal_factorials() {
    assert_eq!(stumpff([0.0]).map(|[value]| value), [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0]);
}

#[test]
fn results_of_nan_are_nan() {
    for row in stumpff([f64::NAN, 0.5]) {
        assert!(row[0].is_nan() && row[1].is_finite());
    }
}
