//! Stumpff's functions `c_k(x) = Σ (−x)^i/(2i + k)!`: entire functions, so that functions of a rotation vector ρ need no square
//! root and no special case for ρ = 0. `c_0(ρ·ρ)` is the cosine of its length, `c_1(ρ·ρ)` the sine over the length.
//!
//! K. Stumpff, *Himmelsmechanik I*, Deutscher Verlag der Wissenschaften, Berlin 1959.

use super::Scalar;

/// Largest argument for which the series is used; beyond it, sines and cosines are more accurate.
const SERIES: f64 = 10.0;
/// Order from which the series is summed directly; for lower orders, its cancellation error becomes negligible in
/// `1/k! − x c_{k+2}`.
const HIGHEST: u8 = 12;
/// Terms of a series at x = 100: the last is below 2⁻¹⁷⁸ for every order.
const TERMS: u32 = 48;

/// `c_k(x)` for x ≥ 0, with the same digits on every platform.
pub(super) fn evaluate(k: u8, x: f64) -> f64 {
    if x > SERIES { by_angles(k, x) } else { downward(k, x) }
}

/// `c_k = 1/k! − x c_{k+2}` from the highest order down.
fn downward(k: u8, x: f64) -> f64 {
    if k >= HIGHEST { series(k, &x) } else { (reciprocal_factorial(k)) - x * downward(k + 2, x) }
}

/// `c_{k+2} = (1/k! − c_k)/x` from cos and sin up.
fn by_angles(k: u8, x: f64) -> f64 {
    let s = x.sqrt();
    match k {
        0 => libm::cos(s),
        1 => libm::sin(s) / s,
        _ => (reciprocal_factorial(k - 2) - by_angles(k - 2, x)) / x,
    }
}

fn reciprocal_factorial(k: u8) -> f64 {
    (1..=k).map(f64::from).product::<f64>().recip()
}

/// `Σ (−x)^i/(2i + k)!`, the smallest terms first.
pub(super) fn series<S: Scalar>(k: u8, x: &S) -> S {
    // 1/k! (1 − x/((k+1)(k+2)) (1 − x/((k+3)(k+4)) (…)))
    let one = || S::from_f64(1.0);
    let number = |n: u32| S::from_f64(f64::from(n));
    let nested = (0..TERMS).rev().fold(one(), |rest, i| {
        let below = u32::from(k) + 2 * i;
        one() - x.clone() * rest / (number(below + 1) * number(below + 2))
    });
    (1..=u32::from(k)).fold(nested, |value, n| value / number(n))
}
