//! 192-bit numbers through the interpreter: the reference for rounding errors in 64 bits.

use std::cell::RefCell;

use astro_float::{BigFloat, Consts, RoundingMode};
use crane_codegen::symbolic::Scalar;

const BITS: usize = 192;
const ROUNDING: RoundingMode = RoundingMode::ToEven;

thread_local! {
    /// Digits of π, computed once.
    static CONSTANTS: RefCell<Consts> = RefCell::new(Consts::new().expect("memory for the digits of π"));
}

/// A number of about 57 decimal digits.
#[derive(Clone, Debug)]
pub struct Precise(BigFloat);

impl Precise {
    /// The nearest 64-bit number.
    ///
    /// # Panics
    /// If it is not a number.
    #[must_use]
    pub fn round(&self) -> f64 {
        self.0.to_string().parse().expect("a finite number")
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl std::ops::$trait for Precise {
            type Output = Precise;
            fn $method(self, other: Precise) -> Precise {
                Precise(self.0.$method(&other.0, BITS, ROUNDING))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl std::ops::Neg for Precise {
    type Output = Precise;
    fn neg(self) -> Precise {
        Precise(self.0.neg())
    }
}

impl Scalar for Precise {
    fn from_f64(value: f64) -> Self {
        Precise(BigFloat::from_f64(value, BITS))
    }
    fn sin_cos(&self) -> (Self, Self) {
        CONSTANTS.with_borrow_mut(|constants| {
            (Precise(self.0.sin(BITS, ROUNDING, constants)), Precise(self.0.cos(BITS, ROUNDING, constants)))
        })
    }
    fn min(self, other: Self) -> Self {
        if other.0 < self.0 { other } else { self }
    }
    fn max(self, other: Self) -> Self {
        if other.0 > self.0 { other } else { self }
    }
    fn sqrt(&self) -> Self {
        Precise(self.0.sqrt(BITS, ROUNDING))
    }
    fn exp(&self) -> Self {
        CONSTANTS.with_borrow_mut(|constants| Precise(self.0.exp(BITS, ROUNDING, constants)))
    }
    fn select(&self, positive: Self, other: Self) -> Self {
        if self.0.is_positive() && !self.0.is_zero() { positive } else { other }
    }
}

/// Solves `A x = b` for a positive definite A, by elimination.
#[must_use]
pub fn solve(mut a: Vec<Vec<Precise>>, mut b: Vec<Precise>) -> Vec<Precise> {
    let n = b.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = a[i][k].clone() / a[k][k].clone();
            for j in k..n {
                a[i][j] = a[i][j].clone() - factor.clone() * a[k][j].clone();
            }
            b[i] = b[i].clone() - factor * b[k].clone();
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            b[k] = b[k].clone() - a[k][j].clone() * b[j].clone();
        }
        b[k] = b[k].clone() / a[k][k].clone();
    }
    b
}
