//! Stumpff's functions `c_k(x) = Σ (−x)^i/(2i + k)!` of all arguments of a state in one pass, eight at a time.
//!
//! Functions of a rotation vector ρ are expressed by them at x = ρ·ρ: `c_0` is the cosine of its length, `c_1` the sine divided
//! by the length. They are entire functions, so they need no branch near zero. Up to x = 10, where a rotation has gone beyond 180°, c₇ and c₈
//! are polynomials, interpolated at Chebyshev's nodes to 3e-18 and 2e-16 of their size, and the others follow downward by
//! `c_k = 1/k! − x c_{k+2}`, each step of which adds half a unit in the last place and reduces earlier errors. The error
//! is below 3.2 units in the last place for c₂ to c₅, and below 1e-15 for c₀ and c₁, which have zeros. Larger arguments are computed one by
//! one from sines and cosines.

use nalgebra::ComplexField;
use wide::f64x8;

use super::fused::fma;

/// Up to this argument the polynomials are valid.
const LARGEST: f64 = 10.0;

/// Coefficients of c₇ by powers of x.
const SEVENTH: [f64; 9] = [
    1.984_126_984_126_984e-4,
    -2.755_731_922_398_581_6e-6,
    2.505_210_838_542_178e-8,
    -1.605_904_383_477_265_3e-10,
    7.647_163_626_297_648e-13,
    -2.811_454_199_274_153_3e-15,
    8.220_114_995_418_031e-18,
    -1.952_117_481_922_161_3e-20,
    3.588_642_229_836_847e-23,
];
/// Coefficients of c₈ by powers of x.
const EIGHTH: [f64; 8] = [
    2.480_158_730_158_729_8e-5,
    -2.755_731_922_397_997e-7,
    2.087_675_698_662_391e-9,
    -1.147_074_549_807_511_4e-11,
    4.779_473_409_508_908e-14,
    -1.561_836_730_189_013_7e-16,
    4.100_336_027_472_356_7e-19,
    -8.275_088_831_687_298e-22,
];
/// 1/k!
const RECIPROCAL_FACTORIALS: [f64; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0];

/// c₀ to c₅ of all arguments, x ≥ 0.
#[inline]
pub fn stumpff<const K: usize>(arguments: [f64; K]) -> [[f64; K]; 6] {
    let mut values = [[0.0; K]; 6];
    let mut small = true;
    let mut eight = |arguments: &[f64; 8]| {
        let x = f64x8::new(*arguments);
        small &= is_small(x);
        of_small(x).map(f64x8::to_array)
    };
    for (block, arguments) in arguments.as_chunks::<8>().0.iter().enumerate() {
        for (row, of_eight) in values.iter_mut().zip(eight(arguments)) {
            if let Some(entry) = row.as_chunks_mut().0.get_mut(block) {
                *entry = of_eight;
            }
        }
    }
    if !K.is_multiple_of(8) {
        if let Some(last) = arguments.last_chunk() {
            // The last eight, some of them a second time, which is cheaper than handling fewer.
            for (row, of_eight) in values.iter_mut().zip(eight(last)) {
                if let Some(entry) = row.last_chunk_mut() {
                    *entry = of_eight;
                }
            }
        } else {
            let mut padded = [0.0; 8];
            padded.iter_mut().zip(arguments).for_each(|(entry, x)| *entry = x);
            for (row, of_eight) in values.iter_mut().zip(eight(&padded)) {
                row.iter_mut().zip(of_eight).for_each(|(entry, value)| *entry = value);
            }
        }
    }
    if !small {
        let [r0, r1, r2, r3, r4, r5] = &mut values;
        replace_large(&arguments, [r0, r1, r2, r3, r4, r5]);
    }
    values
}

/// c₀ to c₅ of every argument in every lane, x ≥ 0.
#[inline]
pub fn stumpff_lanes<const K: usize>(arguments: [f64x8; K]) -> [[f64x8; K]; 6] {
    let mut small = true;
    let columns = arguments.map(|x| {
        small &= is_small(x);
        of_small(x)
    });
    let columns = if small { columns } else { with_large(&arguments, columns) };
    let mut values = [[f64x8::splat(0.0); K]; 6];
    for (i, column) in columns.into_iter().enumerate() {
        for (row, value) in values.iter_mut().zip(column) {
            if let Some(entry) = row.get_mut(i) {
                *entry = value;
            }
        }
    }
    values
}

/// The same with the functions of large arguments.
#[cold]
#[inline(never)]
fn with_large<const K: usize>(arguments: &[f64x8; K], mut columns: [[f64x8; 6]; K]) -> [[f64x8; 6]; K] {
    for (x, column) in arguments.iter().zip(&mut columns) {
        let mut lanes = column.map(f64x8::to_array);
        let [r0, r1, r2, r3, r4, r5] = &mut lanes;
        replace_large(&x.to_array(), [r0, r1, r2, r3, r4, r5]);
        *column = lanes.map(f64x8::new);
    }
    columns
}

/// c₆ and c₇ of an argument x ≥ 0, on which the derivatives of c₄ and c₅ depend.
#[inline]
pub fn next_stumpff(x: f64) -> [f64; 2] {
    if x <= LARGEST {
        let horner = |coefficients: &[f64]| coefficients.iter().rev().fold(0.0, |sum, term| sum * x + term);
        [RECIPROCAL_FACTORIALS[6] - x * horner(&EIGHTH), horner(&SEVENTH)]
    } else {
        let [.., fourth, fifth] = of_large(x);
        [(RECIPROCAL_FACTORIALS[4] - fourth) / x, (RECIPROCAL_FACTORIALS[5] - fifth) / x]
    }
}

/// Also false for NaN.
#[inline]
fn is_small(x: f64x8) -> bool {
    x.simd_le(f64x8::splat(LARGEST)).all()
}

/// The functions of large arguments and NaN by sines and cosines, so that a result does not depend on neighbouring
/// arguments.
#[cold]
#[inline(never)]
fn replace_large(arguments: &[f64], rows: [&mut [f64]; 6]) {
    let mut rows = rows.map(|row| row.iter_mut());
    for &x in arguments {
        let small = x <= LARGEST;
        let values = of_large(x);
        for (row, value) in rows.iter_mut().zip(values) {
            if let Some(entry) = row.next().filter(|_| !small) {
                *entry = value;
            }
        }
    }
}

/// c₀ to c₅ upward by `c_{k+2} = (1/k! − c_k)/x`.
fn of_large(x: f64) -> [f64; 6] {
    let s = ComplexField::sqrt(x);
    let (sin, cos) = ComplexField::sin_cos(s);
    let up = |k: usize, c: f64| (RECIPROCAL_FACTORIALS[k] - c) / x;
    let (c0, c1) = (cos, sin / s);
    let (c2, c3) = (up(0, c0), up(1, c1));
    [c0, c1, c2, c3, up(2, c2), up(3, c3)]
}

/// c₀ to c₅ of eight arguments up to [`LARGEST`].
#[inline]
fn of_small(x: f64x8) -> [f64x8; 6] {
    let down = |k: usize, c: f64x8| fma(-x, c, f64x8::splat(RECIPROCAL_FACTORIALS[k]));
    let [a0, a1, a2, a3, a4, a5, a6, a7, a8] = SEVENTH.map(f64x8::splat);
    let [b0, b1, b2, b3, b4, b5, b6, b7] = EIGHTH.map(f64x8::splat);
    let square = x * x;
    // Even and odd powers separately: half the chain of dependent operations.
    let even = |[e0, e1, e2, e3]: [f64x8; 4]| fma(square, fma(square, fma(square, e3, e2), e1), e0);
    let c7 = fma(x, even([a1, a3, a5, a7]), even([a0, a2, a4, fma(square, a8, a6)]));
    let c8 = fma(x, even([b1, b3, b5, b7]), even([b0, b2, b4, b6]));
    let (c5, c6) = (down(5, c7), down(6, c8));
    let (c3, c4) = (down(3, c5), down(4, c6));
    let (c1, c2) = (down(1, c3), down(2, c4));
    [down(0, c2), c1, c2, c3, c4, c5]
}
