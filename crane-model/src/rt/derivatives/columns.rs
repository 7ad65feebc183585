//! Columns of a matrix that are computed together.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]
#![expect(clippy::manual_memcpy, reason = "short: a call would take longer than the loop")]

use core::marker::PhantomData;
use core::ops::{Add, Mul, Neg};

use wide::f64x2;

use crate::rt::fused::{Fused, fma};
use crate::rt::lanes::f64x8;

/// Numbers of one state that can be added and multiplied.
pub trait Scalar:
    Copy + Fused + Constant + Neg<Output = Self> + Add<Output = Self> + Mul<Output = Self> + 'static
{
}

impl<T: Copy + Fused + Constant + Neg<Output = T> + Add<Output = T> + Mul<Output = T> + 'static> Scalar for T {}

/// Columns of a matrix that are computed together, of one state or of several: loops over lanes, each with a column of a state.
///
/// The compiler makes vectors of the lanes, as wide as the target has.
pub trait Columns: Copy {
    /// An entry of the matrix, of all states.
    type Number: Copy + Constant;
    /// An entry of one state.
    type Lane: Scalar;
    /// What is computed together.
    type Unit: Copy + AsRef<[Self::Lane]> + AsMut<[Self::Lane]>;
    /// How many columns.
    const WIDTH: usize;
    /// How many states.
    const STATES: usize;
    /// Zero in all lanes.
    fn zero() -> Self::Unit;
    /// A number of all columns in a lane.
    fn lane(number: &Self::Number, lane: usize) -> Self::Lane;
    /// A number of a column, from its states.
    fn number(unit: &Self::Unit, column: usize) -> Self::Number;
    /// `number · unit + sum`, in vectors: of a loop that is as short as this one the compiler makes single numbers.
    fn product_add(number: &Self::Number, unit: &Self::Unit, sum: &Self::Unit) -> Self::Unit;
    /// The first numbers of a list; zero where it ends.
    fn load(row: &[Self::Number]) -> Self::Unit;
    /// The numbers of eight units in two neighbouring lanes.
    fn across(units: [&Self::Unit; 8], pair: usize) -> [[Self::Lane; 8]; 2];
    /// Writes as many numbers as the row has.
    fn store(unit: &Self::Unit, row: &mut [Self::Number]);
}

/// Moment, force and answers to angular rates; or angular and linear acceleration: x, y and z of each, in the lanes of a unit.
pub type Carried<C> = [<C as Columns>::Unit; 9];

/// A number for each lane.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Lanes<T, const COUNT: usize>([T; COUNT]);

impl<T, const COUNT: usize> AsRef<[T]> for Lanes<T, COUNT> {
    #[inline(always)]
    fn as_ref(&self) -> &[T] {
        &self.0
    }
}

impl<T, const COUNT: usize> AsMut<[T]> for Lanes<T, COUNT> {
    #[inline(always)]
    fn as_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

/// [`Columns::across`] by vectors of two numbers, which every target has.
#[inline(always)]
fn across(units: [&Lanes<f64, 8>; 8], pair: usize) -> [[f64; 8]; 2] {
    let mut lines = [[0.0; 8]; 2];
    for k in 0..4 {
        let two = |unit: &Lanes<f64, 8>| f64x2::new([unit.0[2 * pair], unit.0[2 * pair + 1]]);
        let [one, other] = f64x2::transpose([two(units[2 * k]), two(units[2 * k + 1])]);
        ([lines[0][2 * k], lines[0][2 * k + 1]], [lines[1][2 * k], lines[1][2 * k + 1]]) =
            (one.to_array(), other.to_array());
    }
    lines
}

/// Eight columns of a matrix of one state.
#[derive(Clone, Copy, Debug)]
pub struct EightColumns;

impl Columns for EightColumns {
    type Number = f64;
    type Lane = f64;
    type Unit = Lanes<f64, 8>;
    const WIDTH: usize = 8;
    const STATES: usize = 1;

    #[inline(always)]
    fn zero() -> Lanes<f64, 8> {
        Lanes([0.0; 8])
    }

    #[inline(always)]
    fn lane(number: &f64, _: usize) -> f64 {
        *number
    }

    #[inline(always)]
    fn number(unit: &Lanes<f64, 8>, column: usize) -> f64 {
        unit.0[column]
    }

    #[inline(always)]
    fn product_add(number: &f64, unit: &Lanes<f64, 8>, sum: &Lanes<f64, 8>) -> Lanes<f64, 8> {
        EightStates::product_add(&f64x8::splat(*number), unit, sum)
    }

    #[inline(always)]
    fn load(row: &[f64]) -> Lanes<f64, 8> {
        if let Some(eight) = row.first_chunk() {
            return Lanes(*eight);
        }
        let mut unit = Self::zero();
        for k in 0..row.len().min(8) {
            unit.0[k] = row[k];
        }
        unit
    }

    #[inline(always)]
    fn store(unit: &Lanes<f64, 8>, row: &mut [f64]) {
        if let Some(eight) = row.first_chunk_mut() {
            *eight = unit.0;
            return;
        }
        for k in 0..row.len().min(8) {
            row[k] = unit.0[k];
        }
    }

    #[inline(always)]
    fn across(units: [&Lanes<f64, 8>; 8], pair: usize) -> [[f64; 8]; 2] {
        across(units, pair)
    }
}

/// One column of a matrix of eight states.
#[derive(Clone, Copy, Debug)]
pub struct EightStates;

impl Columns for EightStates {
    type Number = f64x8;
    type Lane = f64;
    type Unit = Lanes<f64, 8>;
    const WIDTH: usize = 1;
    const STATES: usize = 8;

    #[inline(always)]
    fn zero() -> Lanes<f64, 8> {
        Lanes([0.0; 8])
    }

    #[inline(always)]
    fn lane(number: &f64x8, lane: usize) -> f64 {
        number.as_array()[lane]
    }

    #[inline(always)]
    fn number(unit: &Lanes<f64, 8>, _: usize) -> f64x8 {
        f64x8::new(unit.0)
    }

    #[inline(always)]
    fn product_add(number: &f64x8, unit: &Lanes<f64, 8>, sum: &Lanes<f64, 8>) -> Lanes<f64, 8> {
        Lanes(fma(*number, f64x8::new(unit.0), f64x8::new(sum.0)).to_array())
    }

    #[inline(always)]
    fn load(row: &[f64x8]) -> Lanes<f64, 8> {
        row.first().map_or_else(Self::zero, |number| Lanes(number.to_array()))
    }

    #[inline(always)]
    fn store(unit: &Lanes<f64, 8>, row: &mut [f64x8]) {
        if let Some(entry) = row.first_mut() {
            *entry = f64x8::new(unit.0);
        }
    }

    #[inline(always)]
    fn across(units: [&Lanes<f64, 8>; 8], pair: usize) -> [[f64; 8]; 2] {
        across(units, pair)
    }
}

/// One column of a matrix of any numbers.
#[derive(Clone, Copy, Debug)]
pub struct One<T>(PhantomData<T>);

impl<T: Scalar> Columns for One<T> {
    type Number = T;
    type Lane = T;
    type Unit = [T; 1];
    const WIDTH: usize = 1;
    const STATES: usize = 1;

    #[inline(always)]
    fn zero() -> [T; 1] {
        [T::constant(0.0)]
    }

    #[inline(always)]
    fn lane(number: &T, _: usize) -> T {
        *number
    }

    #[inline(always)]
    fn number([number]: &[T; 1], _: usize) -> T {
        *number
    }

    #[inline(always)]
    fn product_add(number: &T, [unit]: &[T; 1], [sum]: &[T; 1]) -> [T; 1] {
        [fma(*number, *unit, *sum)]
    }

    #[inline(always)]
    fn load(row: &[T]) -> [T; 1] {
        [row.first().copied().unwrap_or(T::constant(0.0))]
    }

    #[inline(always)]
    fn store([number]: &[T; 1], row: &mut [T]) {
        if let Some(entry) = row.first_mut() {
            *entry = *number;
        }
    }

    #[inline(always)]
    fn across(units: [&[T; 1]; 8], _: usize) -> [[T; 8]; 2] {
        [units.map(|[number]| *number); 2]
    }
}

/// Numbers with constants.
pub trait Constant {
    /// The same number everywhere.
    fn constant(number: f64) -> Self;
    /// Whether it is zero everywhere.
    fn is_zero(&self) -> bool;
}

impl Constant for f64 {
    #[inline(always)]
    fn constant(number: f64) -> f64 {
        number
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        *self == 0.0
    }
}

impl Constant for f64x8 {
    #[inline(always)]
    fn constant(number: f64) -> f64x8 {
        f64x8::splat(number)
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        let mut is_zero = true;
        for number in self.as_array() {
            is_zero &= *number == 0.0;
        }
        is_zero
    }
}
