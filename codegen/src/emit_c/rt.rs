//! Helpers that functions in C need in addition to arithmetic, written only where used. From the C library, functions use only sine,
//! cosine, square root and exponential.

use std::fmt::Write;

use super::Precision;
use crate::symbolic::Op;

/// Up to here Stumpff's functions are polynomials; larger arguments go through sine and cosine.
const LARGEST: f64 = 10.0;
/// Terms of a polynomial: at the largest argument the next is below 2⁻⁶⁰ of the sum.
const TERMS: usize = 15;

/// The helpers, private to the source, that a text calls.
pub fn used(body: &str, precision: Precision) -> String {
    let number = precision.name();
    let simple = [
        ("smaller", format!("static {number} smaller({number} a, {number} b) {{ return a < b ? a : b; }}\n\n")),
        ("larger", format!("static {number} larger({number} a, {number} b) {{ return a > b ? a : b; }}\n\n")),
        (
            "choose",
            format!(
                "/* b where a is above zero, else c. */\n\
                 static {number} choose({number} a, {number} b, {number} c) {{ return a > 0 ? b : c; }}\n\n"
            ),
        ),
        ("stumpff", stumpff(precision)),
    ];
    simple.into_iter().filter(|(name, _)| body.contains(&format!("{name}("))).map(|(_, text)| text).collect()
}

/// Stumpff's functions `c_k(x) = Σ (−x)^i/(2i + k)!`, k from 0: the last two by their series, the others by
/// `c_k = 1/k! − x c_{k+2}` downward.
fn stumpff(precision: Precision) -> String {
    const ORDERS: usize = Op::STUMPFF_ORDERS;
    let (number, f) = (precision.name(), precision.suffix());
    let reciprocal = |k: usize| format!("{:?}{f}", 1.0 / factorial(k));
    let mut text = format!(
        "/* c[k] = sum over i of (-x)^i / (2 i + k)!, which rotations by a vector are made of; x >= 0. */\n\
         static void stumpff({number} x, {number} c[{ORDERS}])\n{{\n    if (x > {LARGEST:?}{f}) {{\n        \
         const {number} s = sqrt{f}(x);\n        c[0] = cos{f}(s);\n        c[1] = sin{f}(s) / s;\n"
    );
    for k in 2..ORDERS {
        let _ = writeln!(text, "        c[{k}] = ({} - c[{}]) / x;", reciprocal(k - 2), k - 2);
    }
    text += "        return;\n    }\n";
    for k in [ORDERS - 1, ORDERS - 2] {
        let _ = writeln!(text, "    c[{k}] = {:?}{f};", series(k, TERMS - 1));
        for i in (0..TERMS - 1).rev() {
            let _ = writeln!(text, "    c[{k}] = c[{k}] * x + {:?}{f};", series(k, i));
        }
    }
    for k in (0..ORDERS - 2).rev() {
        let _ = writeln!(text, "    c[{k}] = {} - x * c[{}];", reciprocal(k), k + 2);
    }
    text + "}\n\n"
}

/// `(−1)^i/(2i + k)!`
fn series(k: usize, i: usize) -> f64 {
    let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    sign / factorial(2 * i + k)
}

fn factorial(k: usize) -> f64 {
    (1..=k).map(|n| n as f64).product()
}
