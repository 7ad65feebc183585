//! A number with its slopes in eight directions: exact derivatives of any function of a crane, by the rule of each operation.
//!
//! Eight directions fill the widest registers, so a derivative costs about half as much as a value, and no expressions have to be derived.

use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crane_model::rt::derivatives::{Constant, One};
use crane_model::rt::lanes::{Function, Fused, f64x8};
use crane_model::rt::{exp, fma, next_stumpff, select, sin_cos, sqrt, stumpff};

use crate::machine::{ANGLES, Form, Number};

/// Directions of a number.
pub const DIRECTIONS: usize = 8;

/// A number and its derivatives in eight directions.
#[derive(Clone, Copy, Debug)]
pub struct Dual8 {
    value: f64,
    slopes: f64x8,
}

impl Dual8 {
    /// A number with slope 1 in one direction; with zero slopes only, if `direction` is none of the eight.
    pub fn along(value: f64, direction: Option<usize>) -> Self {
        let slope = |index: usize| if Some(index) == direction { 1.0 } else { 0.0 };
        Self { value, slopes: f64x8::new(std::array::from_fn(slope)) }
    }

    /// A number with these slopes.
    pub fn new(value: f64, slopes: [f64; DIRECTIONS]) -> Self {
        Self { value, slopes: f64x8::new(slopes) }
    }

    /// The number itself.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Its magnitude; 0 has the slopes of a positive number.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.value < 0.0 { -self } else { self }
    }

    /// `√(x² + y²)`. At 0 it has a kink; its slopes there are 0.
    #[must_use]
    pub fn hypot(self, other: Self) -> Self {
        if self.value == 0.0 && other.value == 0.0 { Self::splat(0.0) } else { (self * self + other * other).sqrt() }
    }

    /// The derivative in a direction below [`DIRECTIONS`].
    pub fn slope(&self, direction: usize) -> f64 {
        self.slopes.as_array()[direction]
    }

    /// A function of this number, from its value and its derivative here.
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, slopes: self.slopes * f64x8::splat(derivative) }
    }
}

impl Constant for Dual8 {
    fn constant(number: f64) -> Self {
        Self::along(number, None)
    }

    /// And all its slopes.
    fn is_zero(&self) -> bool {
        self.value == 0.0 && self.slopes.as_array().iter().all(|slope| *slope == 0.0)
    }
}

impl Fused for Dual8 {
    fn fma(a: Self, b: Self, c: Self) -> Self {
        let of_factors = fma(a.slopes, f64x8::splat(b.value), c.slopes);
        Self { value: fma(a.value, b.value, c.value), slopes: fma(b.slopes, f64x8::splat(a.value), of_factors) }
    }
}

impl Function for Dual8 {
    /// A zero slope stays zero, even at 0, where the root has a vertical tangent.
    fn sqrt(self) -> Self {
        let root = sqrt(self.value);
        let changes = self.slopes.simd_ne(f64x8::splat(0.0));
        let slopes = changes.select(self.slopes * f64x8::splat(0.5 / root), f64x8::splat(0.0));
        Self { value: root, slopes }
    }

    fn exp(self) -> Self {
        let value = exp(self.value);
        self.chain(value, value)
    }

    fn select(self, positive: Self, other: Self) -> Self {
        Self {
            value: select(self.value, positive.value, other.value),
            slopes: if self.value > 0.0 { positive.slopes } else { other.slopes },
        }
    }
}

impl Add for Dual8 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slopes: self.slopes + other.slopes }
    }
}

impl Sub for Dual8 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slopes: self.slopes - other.slopes }
    }
}

impl Sum for Dual8 {
    fn sum<I: Iterator<Item = Self>>(numbers: I) -> Self {
        numbers.fold(Self::splat(0.0), Add::add)
    }
}

impl Mul<f64> for Dual8 {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }
}

impl Mul for Dual8 {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let slopes = self.slopes * f64x8::splat(other.value) + other.slopes * f64x8::splat(self.value);
        Self { value: self.value * other.value, slopes }
    }
}

impl Div for Dual8 {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let above = fma(-other.slopes, f64x8::splat(value), self.slopes);
        Self { value, slopes: above / f64x8::splat(other.value) }
    }
}

impl Neg for Dual8 {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: -self.slopes }
    }
}

/// Stumpff's functions c₀ to c₇, order by order: c₆ and c₇ are in the derivatives of c₄ and c₅.
pub(crate) fn eight_orders(arguments: [f64; ANGLES]) -> [[f64; ANGLES]; 8] {
    let [c0, c1, c2, c3, c4, c5] = stumpff(arguments);
    let next = arguments.map(next_stumpff);
    let [c6, c7] = [0, 1].map(|order| next.map(|pair| pair[order]));
    [c0, c1, c2, c3, c4, c5, c6, c7]
}

impl Number for Dual8 {
    type Columns = One<Dual8>;
    const FORM: Form = Form::Slopes;

    fn flat(_: &mut [Self]) -> &mut [f64] {
        &mut []
    }

    fn cells(self) -> [f64x8; 2] {
        [f64x8::splat(self.value), self.slopes]
    }

    fn of_cells([value, slopes]: [f64x8; 2]) -> Self {
        Self { value: value.as_array()[0], slopes }
    }

    fn splat(number: f64) -> Self {
        Self { value: number, slopes: f64x8::splat(0.0) }
    }

    fn min(self, other: Self) -> Self {
        if other.value > self.value { self } else { other }
    }

    fn max(self, other: Self) -> Self {
        if self.value > other.value { self } else { other }
    }

    fn sin_cos(angles: [Self; ANGLES]) -> ([Self; ANGLES], [Self; ANGLES]) {
        let (sines, cosines) = sin_cos(angles.map(|angle| angle.value));
        let of = |value: &dyn Fn(usize) -> f64, derivative: &dyn Fn(usize) -> f64| {
            std::array::from_fn(|index| angles[index].chain(value(index), derivative(index)))
        };
        (of(&|i| sines[i], &|i| cosines[i]), of(&|i| cosines[i], &|i| -sines[i]))
    }

    /// `c_k' = (k c_{k+2} − c_{k+1})/2`
    fn stumpff(arguments: [Self; ANGLES]) -> [[Self; ANGLES]; 6] {
        let orders = eight_orders(arguments.map(|argument| argument.value));
        std::array::from_fn(|k| {
            let derivative = |index: usize| 0.5 * fma(k as f64, orders[k + 2][index], -orders[k + 1][index]);
            std::array::from_fn(|index| arguments[index].chain(orders[k][index], derivative(index)))
        })
    }
}
