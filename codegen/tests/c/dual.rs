//! Numbers with one derivative, through the interpreter: independent of the compiler's own rules.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crane_codegen::symbolic::Scalar;

/// A value and its derivative.
#[derive(Clone, Copy, Debug)]
pub struct Dual(pub f64, pub f64);

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Dual(-self.0, -self.1)
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Dual(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Dual(self.0 * other.0, self.1 * other.0 + self.0 * other.1)
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Dual(self.0 / other.0, (self.1 * other.0 - self.0 * other.1) / (other.0 * other.0))
    }
}

impl Scalar for Dual {
    fn from_f64(value: f64) -> Self {
        Dual(value, 0.0)
    }
    fn sin_cos(&self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Dual(sin, cos * self.1), Dual(cos, -sin * self.1))
    }
    fn min(self, other: Self) -> Self {
        if other.0 < self.0 { other } else { self }
    }
    fn max(self, other: Self) -> Self {
        if other.0 > self.0 { other } else { self }
    }
    fn sqrt(&self) -> Self {
        let root = self.0.sqrt();
        Dual(root, if self.1 == 0.0 { 0.0 } else { self.1 / (2.0 * root) })
    }
    fn exp(&self) -> Self {
        Dual(self.0.exp(), self.0.exp() * self.1)
    }
    fn select(&self, positive: Self, other: Self) -> Self {
        if self.0 > 0.0 { positive } else { other }
    }
}
