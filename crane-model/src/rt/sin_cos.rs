//! Sines and cosines of all angles of a state in one pass, eight at a time.
//!
//! Reduction to `x = n π/2 + y`, |y| ≤ π/4, by the four parts of π/2 of W. J. Cody and W. Waite, *Software Manual for the
//! Elementary Functions*, Prentice-Hall 1980, with the rounding error of y carried along; then the polynomials of K. C. Ng
//! (`fdlibm`, Sun Microsystems 1993). The error is below 0.8 units in the last place for every angle. Angles of 2²⁰ quarter
//! turns or more, and NaN, are computed one by one with the standard library's functions.

use wide::{bytemuck::cast, f64x8, i64x8};

use super::fused::fma;

/// Parts of π/2: three of 33 bits, whose products with n are exact, and the rest.
pub const HALF_PI: [f64; 4] =
    [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_711_166_5e-21, 8.478_427_660_368_9e-32];
/// Up to this angle n has 20 bits.
pub const LARGEST: f64 = 1_048_576.0 * core::f64::consts::FRAC_PI_2;
/// Added to a number below 2⁵¹ it rounds it to an integer, which is then in the lowest bits.
pub const ROUND: f64 = 6_755_399_441_055_744.0;

/// Coefficients of `sin y = y + y³ (S₁ + S₂ y² + …)`.
pub const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
/// Coefficients of `cos y = 1 − y²/2 + y⁴ (C₁ + C₂ y² + …)`.
pub const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sines and cosines of all angles, rad.
#[inline]
pub fn sin_cos<const K: usize>(angles: [f64; K]) -> ([f64; K], [f64; K]) {
    let (mut sines, mut cosines) = ([0.0; K], [0.0; K]);
    let mut small = true;
    let mut eight = |angles: &[f64; 8], sines: &mut [f64; 8], cosines: &mut [f64; 8]| {
        let x = f64x8::new(*angles);
        let (sin, cos) = sin_cos_of_small(x);
        *sines = sin.to_array();
        *cosines = cos.to_array();
        small &= is_small(x);
    };
    let eights = angles.as_chunks::<8>().0.iter().zip(sines.as_chunks_mut().0).zip(cosines.as_chunks_mut().0);
    for ((angles, sines), cosines) in eights {
        eight(angles, sines, cosines);
    }
    if !K.is_multiple_of(8) {
        if let (Some(angles), Some(sines), Some(cosines)) =
            (angles.last_chunk(), sines.last_chunk_mut(), cosines.last_chunk_mut())
        {
            // The last eight, some of them a second time, which is cheaper than handling fewer.
            eight(angles, sines, cosines);
        } else {
            let (mut padded, mut sin, mut cos) = ([0.0; 8], [0.0; 8], [0.0; 8]);
            padded.iter_mut().zip(angles).for_each(|(entry, angle)| *entry = angle);
            eight(&padded, &mut sin, &mut cos);
            sines.iter_mut().zip(sin).for_each(|(entry, sin)| *entry = sin);
            cosines.iter_mut().zip(cos).for_each(|(entry, cos)| *entry = cos);
        }
    }
    if !small {
        replace_large(&angles, &mut sines, &mut cosines);
    }
    (sines, cosines)
}

/// Sines and cosines of every angle in every lane, rad.
#[inline]
pub fn sin_cos_lanes<const K: usize>(angles: [f64x8; K]) -> ([f64x8; K], [f64x8; K]) {
    let (mut sines, mut cosines) = ([f64x8::splat(0.0); K], [f64x8::splat(0.0); K]);
    let mut small = true;
    for ((angle, sin), cos) in angles.iter().zip(&mut sines).zip(&mut cosines) {
        (*sin, *cos) = sin_cos_of_small(*angle);
        small &= is_small(*angle);
    }
    if !small {
        for ((angle, sin), cos) in angles.iter().zip(&mut sines).zip(&mut cosines) {
            let (mut sines, mut cosines) = (sin.to_array(), cos.to_array());
            replace_large(&angle.to_array(), &mut sines, &mut cosines);
            (*sin, *cos) = (f64x8::new(sines), f64x8::new(cosines));
        }
    }
    (sines, cosines)
}

/// Also false for NaN.
#[inline]
fn is_small(x: f64x8) -> bool {
    x.abs().simd_lt(f64x8::splat(LARGEST)).all()
}

/// Large angles and NaN by the standard library, so that a result does not depend on neighbouring angles.
#[cold]
#[inline(never)]
fn replace_large(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    for (angle, (sin, cos)) in angles.iter().zip(sines.iter_mut().zip(cosines)) {
        let small = angle.abs() < LARGEST;
        if !small {
            (*sin, *cos) = nalgebra::ComplexField::sin_cos(*angle);
        }
    }
}

/// `(sin x, cos x)` of eight angles below [`LARGEST`], rad.
#[inline]
fn sin_cos_of_small(x: f64x8) -> (f64x8, f64x8) {
    let shifted = fma(x, f64x8::splat(core::f64::consts::FRAC_2_PI), f64x8::splat(ROUND));
    let (y, tail) = reduced(x, shifted - ROUND);
    let (sin, cos) = (sine(y, tail), cosine(y, tail));
    let quarter: i64x8 = cast(shifted);
    let one = i64x8::splat(1);
    // All bits of a lane where n is odd.
    let odd: f64x8 = cast(i64x8::splat(0) - (quarter & one));
    let minus_sin: f64x8 = cast((quarter & i64x8::splat(2)) << 62);
    let minus_cos: f64x8 = cast(((quarter + one) & i64x8::splat(2)) << 62);
    (odd.bitselect(cos, sin) ^ minus_sin, odd.bitselect(sin, cos) ^ minus_cos)
}

/// `x − n π/2` and what its rounding lost. Products with the first three parts are exact, fused or not.
#[inline]
fn reduced(x: f64x8, n: f64x8) -> (f64x8, f64x8) {
    let [first, second, third, rest] = HALF_PI.map(|part| f64x8::splat(-part));
    let y = fma(n, first, x);
    let (before, y) = (y, fma(n, second, y));
    let lost = fma(n, second, before - y);
    let (before, y) = (y, fma(n, third, y));
    let lost = fma(n, rest, lost + fma(n, third, before - y));
    let sum = y + lost;
    (sum, (y - sum) + lost)
}

/// sin(y + tail)
#[inline]
fn sine(y: f64x8, tail: f64x8) -> f64x8 {
    let z = y * y;
    let cubed = z * y;
    let higher = polynomial(z, [SINE[1], SINE[2], SINE[3], SINE[4], SINE[5]]);
    let correction = fma(z, fma(tail, f64x8::splat(0.5), -(cubed * higher)), -tail);
    y - fma(cubed, f64x8::splat(-SINE[0]), correction)
}

/// cos(y + tail)
#[inline]
fn cosine(y: f64x8, tail: f64x8) -> f64x8 {
    let z = y * y;
    let half = z * 0.5;
    let leading = f64x8::splat(1.0) - half;
    let higher = z * polynomial(z, COSINE);
    leading + (((f64x8::splat(1.0) - leading) - half) + fma(z, higher, -(y * tail)))
}

/// `c₀ + c₁ z + …` by Horner's rule.
#[inline]
fn polynomial<const K: usize>(z: f64x8, coefficients: [f64; K]) -> f64x8 {
    let mut coefficients = coefficients.iter().rev().map(|c| f64x8::splat(*c));
    let highest = coefficients.next().unwrap_or_default();
    coefficients.fold(highest, |sum, c| fma(sum, z, c))
}
