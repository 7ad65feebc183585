//! Columns of a matrix that are computed together.

use core::marker::PhantomData;
use core::ops::{Add, Mul, Neg};

use crate::rt::fused::{Fused, fma};
use crate::rt::lanes::f64x8;

/// Columns of a matrix that are computed together.
pub trait Columns: Copy {
    /// An entry of the matrix.
    type Number: Copy
        + Fused
        + Constant
        + Neg<Output = Self::Number>
        + Add<Output = Self::Number>
        + Mul<Output = Self::Number>;
    /// Entries of neighbouring columns.
    type Block: Copy + Fused + Neg<Output = Self::Block> + Add<Output = Self::Block> + Mul<Output = Self::Block>;
    /// How many columns.
    const WIDTH: usize;
    /// The same number in all columns.
    fn splat(number: Self::Number) -> Self::Block;
    /// The first numbers of a list; zero where it ends.
    fn load(row: &[Self::Number]) -> Self::Block;
    /// Writes as many numbers as the row has.
    fn store(block: Self::Block, row: &mut [Self::Number]);
    /// Columns of `before` up to `first`, and of `from` from there on.
    fn join(before: Self::Block, from: Self::Block, first: usize) -> Self::Block;
}

/// Sixteen columns of a matrix of plain numbers.
#[derive(Clone, Copy, Debug)]
pub struct Sixteen;

/// Two blocks of eight columns: their operations do not depend on each other, so none has to wait.
#[derive(Clone, Copy, Debug)]
pub struct Eights([f64x8; 2]);

impl Fused for Eights {
    #[inline]
    fn fma(a: Self, b: Self, c: Self) -> Self {
        Eights([fma(a.0[0], b.0[0], c.0[0]), fma(a.0[1], b.0[1], c.0[1])])
    }
}

impl Neg for Eights {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Eights([-self.0[0], -self.0[1]])
    }
}

impl Add for Eights {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Eights([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Mul for Eights {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Eights([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}

impl Columns for Sixteen {
    type Number = f64;
    type Block = Eights;
    const WIDTH: usize = 16;

    #[inline]
    fn splat(number: f64) -> Eights {
        Eights([f64x8::splat(number); 2])
    }

    #[inline]
    fn load(row: &[f64]) -> Eights {
        if let Some(chunk) = row.first_chunk::<16>() {
            let eight = |numbers: Option<&[f64; 8]>| numbers.map_or(f64x8::ZERO, |numbers| f64x8::new(*numbers));
            return Eights([eight(chunk.first_chunk()), eight(chunk.last_chunk())]);
        }
        let mut numbers = [[0.0; 8]; 2];
        numbers.as_flattened_mut().iter_mut().zip(row).for_each(|(number, entry)| *number = *entry);
        Eights([f64x8::new(numbers[0]), f64x8::new(numbers[1])])
    }

    #[inline]
    fn store(block: Eights, row: &mut [f64]) {
        let (eights, rest) = row.as_chunks_mut::<8>();
        let [first, second] = [block.0[0].to_array(), block.0[1].to_array()];
        match eights {
            [] => rest.iter_mut().zip(first).for_each(|(entry, number)| *entry = number),
            [one] => {
                *one = first;
                rest.iter_mut().zip(second).for_each(|(entry, number)| *entry = number);
            }
            [one, two, ..] => [*one, *two] = [first, second],
        }
    }

    #[inline]
    #[expect(clippy::cast_precision_loss, reason = "indices of columns are small")]
    fn join(before: Eights, from: Eights, first: usize) -> Eights {
        let first = f64x8::splat(first as f64);
        let join = |lanes: f64x8, before: f64x8, from: f64x8| lanes.simd_ge(first).select(from, before);
        Eights([join(LANES, before.0[0], from.0[0]), join(LANES + f64x8::splat(8.0), before.0[1], from.0[1])])
    }
}

/// The indices of eight columns.
const LANES: f64x8 = f64x8::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);

/// One column of a matrix of any numbers, for example of those of eight states.
#[derive(Clone, Copy, Debug)]
pub struct One<T>(PhantomData<T>);

/// Numbers with constants.
pub trait Constant {
    /// The same number everywhere.
    fn constant(number: f64) -> Self;
    /// Whether it is zero everywhere.
    fn is_zero(&self) -> bool;
}

impl Constant for f64 {
    #[inline]
    fn constant(number: f64) -> f64 {
        number
    }

    #[inline]
    fn is_zero(&self) -> bool {
        *self == 0.0
    }
}

impl Constant for f64x8 {
    #[inline]
    fn constant(number: f64) -> f64x8 {
        f64x8::splat(number)
    }

    #[inline]
    fn is_zero(&self) -> bool {
        *self == f64x8::ZERO
    }
}

impl<T: Copy + Fused + Constant + Neg<Output = T> + Add<Output = T> + Mul<Output = T>> Columns for One<T> {
    type Number = T;
    type Block = T;
    const WIDTH: usize = 1;

    #[inline]
    fn splat(number: T) -> T {
        number
    }

    #[inline]
    fn load(row: &[T]) -> T {
        match row {
            [first, ..] => *first,
            [] => T::constant(0.0),
        }
    }

    #[inline]
    fn store(block: T, row: &mut [T]) {
        if let Some(entry) = row.first_mut() {
            *entry = block;
        }
    }

    #[inline]
    fn join(before: T, from: T, first: usize) -> T {
        if first == 0 { from } else { before }
    }
}
