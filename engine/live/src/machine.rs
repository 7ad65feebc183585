//! Runs bytecode, for one state or for eight at a time, or for one state with its derivatives.

use std::ops::{Add, Div, Mul, Neg};

use crane_codegen::program::Argument;
use crane_model::dyn_crane::Arguments;
use crane_model::rt::derivatives::{Columns, Constant, EightColumns, EightStates};
use crane_model::rt::lanes::{Function, Fused, f64x8};
use crane_model::rt::{exp, fma, select, sin_cos, sin_cos_lanes, sqrt, stumpff, stumpff_lanes};
use wide::bytemuck::cast_slice_mut;

use crate::bytecode::{Code, Fixed, Inputs, Instructions, Kind, Operands};

/// One number, eight of different states, or one with its derivatives.
pub trait Number:
    Copy
    + Fused
    + Function
    + Constant
    + Add<Output = Self>
    + Div<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// How many columns of a matrix of it are computed together.
    type Columns: Columns<Number = Self>;
    /// The form of machine code for it.
    const FORM: Form;
    /// The numbers of several, next to each other; nothing for those with derivatives.
    fn flat(several: &mut [Self]) -> &mut [f64];
    /// The number and its derivatives, eight each.
    fn cells(self) -> [f64x8; 2];
    /// A number of its cells.
    fn of_cells(cells: [f64x8; 2]) -> Self;
    /// The same number everywhere.
    fn splat(number: f64) -> Self;
    /// The smaller of two.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The larger of two.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Sines and cosines of angles.
    fn sin_cos(angles: [Self; ANGLES]) -> ([Self; ANGLES], [Self; ANGLES]);
    /// Stumpff's functions of arguments, order by order.
    fn stumpff(arguments: [Self; ANGLES]) -> [[Self; ANGLES]; 6];
}

/// The form of machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// One number.
    One,
    /// Eight numbers of different states.
    Eight,
    /// One number eight times, and eight derivatives.
    Slopes,
}

/// The number of one state, or numbers of several.
pub trait Batch: Number<Columns: Columns<Lane = f64>> {
    /// How many numbers it holds.
    const LANES: usize;
    /// Made of the numbers at each place.
    fn from_lanes(number: impl Fn(usize) -> f64) -> Self;
    /// The number at a place below [`LANES`](Self::LANES).
    fn lane(&self, index: usize) -> f64;
}

/// Number of angles, or arguments of Stumpff's functions, processed at a time.
pub const ANGLES: usize = 8;

impl Number for f64 {
    type Columns = EightColumns;
    const FORM: Form = Form::One;
    fn flat(several: &mut [Self]) -> &mut [f64] {
        several
    }
    fn cells(self) -> [f64x8; 2] {
        [f64x8::splat(self), f64x8::splat(0.0)]
    }
    fn of_cells([value, _]: [f64x8; 2]) -> Self {
        value.as_array()[0]
    }
    fn splat(number: f64) -> Self {
        number
    }
    fn min(self, other: Self) -> Self {
        f64::min(self, other)
    }
    fn max(self, other: Self) -> Self {
        f64::max(self, other)
    }
    fn sin_cos(angles: [Self; ANGLES]) -> ([Self; ANGLES], [Self; ANGLES]) {
        sin_cos(angles)
    }
    fn stumpff(arguments: [Self; ANGLES]) -> [[Self; ANGLES]; 6] {
        stumpff(arguments)
    }
}

impl Batch for f64 {
    const LANES: usize = 1;
    fn from_lanes(number: impl Fn(usize) -> f64) -> Self {
        number(0)
    }
    fn lane(&self, _: usize) -> f64 {
        *self
    }
}

impl Number for f64x8 {
    type Columns = EightStates;
    const FORM: Form = Form::Eight;
    fn flat(several: &mut [Self]) -> &mut [f64] {
        cast_slice_mut(several)
    }
    fn cells(self) -> [f64x8; 2] {
        [self, f64x8::splat(0.0)]
    }
    fn of_cells([values, _]: [f64x8; 2]) -> Self {
        values
    }
    fn splat(number: f64) -> Self {
        f64x8::splat(number)
    }
    fn min(self, other: Self) -> Self {
        f64x8::min(self, other)
    }
    fn max(self, other: Self) -> Self {
        f64x8::max(self, other)
    }
    fn sin_cos(angles: [Self; ANGLES]) -> ([Self; ANGLES], [Self; ANGLES]) {
        sin_cos_lanes(angles)
    }
    fn stumpff(arguments: [Self; ANGLES]) -> [[Self; ANGLES]; 6] {
        stumpff_lanes(arguments)
    }
}

impl Batch for f64x8 {
    const LANES: usize = 8;
    fn from_lanes(number: impl Fn(usize) -> f64) -> Self {
        f64x8::new(std::array::from_fn(number))
    }
    fn lane(&self, index: usize) -> f64 {
        self.as_array()[index]
    }
}

/// What a function reads; what it does not read may be empty.
#[derive(Clone, Copy, Debug)]
pub struct Environment<'a, T> {
    /// Arguments of functions of the table of quantities.
    pub arguments: Arguments<'a, T>,
    /// Weights of the results of the function of a product.
    pub multiplier: &'a [T],
    /// Added inertias of single coordinates.
    pub added_inertia: &'a [T],
    /// Added inertia of the base, 6×6, column by column.
    pub base: &'a [T],
    /// Results of an earlier function.
    pub factors: &'a [T],
    /// A number that the same machine was given with no other factors: those of the last call are not copied again. 0 if it is not known.
    pub version: u64,
    /// Live parameters.
    pub parameters: &'a [T],
    /// Inputs.
    pub inputs: &'a [T],
}

impl<'a, T: Number> From<Arguments<'a, T>> for Environment<'a, T> {
    /// Nothing but these.
    fn from(arguments: Arguments<'a, T>) -> Self {
        Self {
            arguments,
            multiplier: &[],
            added_inertia: &[],
            base: &[],
            factors: &[],
            version: 0,
            parameters: &[],
            inputs: &[],
        }
    }
}

impl<T: Number> Environment<'_, T> {
    /// Nothing, at t = 0.
    #[must_use]
    pub fn none() -> Self {
        Arguments::none().into()
    }

    /// The numbers of an argument.
    fn numbers(&self, argument: Argument) -> &[T] {
        let Arguments { t, q, v, a, r, positions } = &self.arguments;
        match argument {
            Argument::Time => std::slice::from_ref(t),
            Argument::Position => q,
            Argument::Velocity => v,
            Argument::Acceleration => a,
            Argument::RightHandSide => r,
            Argument::DrivePositions => positions,
            Argument::Multiplier => self.multiplier,
            Argument::AddedInertia => self.added_inertia,
            Argument::BaseAddedInertia => self.base,
            Argument::Factors => self.factors,
            Argument::Parameters => self.parameters,
            Argument::Inputs => self.inputs,
            // Only loops of compiled code have these.
            Argument::LoopVarying | Argument::LiveOut => &[],
        }
    }

    /// The numbers of an input; `None` if they are not given, which means zeros.
    fn given(&self, inputs: &Inputs) -> Option<&[T]> {
        let (numbers, last) = (self.numbers(inputs.argument), inputs.first + inputs.count);
        assert!(
            numbers.is_empty() || numbers.len() >= last,
            "{:?} has {} numbers, not {last}",
            inputs.argument,
            numbers.len()
        );
        numbers.get(inputs.first..last)
    }

    /// Gives those that a function reads after its fixed numbers, each with its register.
    pub(crate) fn each(&self, code: &Code, mut take: impl FnMut(usize, T)) {
        let mut register = code.fixed.len();
        for inputs in &code.inputs {
            match self.given(inputs) {
                Some(given) => given.iter().enumerate().for_each(|(index, number)| take(register + index, *number)),
                None => (0..inputs.count).for_each(|index| take(register + index, T::splat(0.0))),
            }
            register += inputs.count;
        }
    }

    /// Writes those that a function reads after its fixed numbers, into places with the factors of a version.
    pub(crate) fn write(&self, code: &Code, registers: &mut [T], version: u64) {
        let has_factors = version > 0 && version == self.version;
        let mut registers = registers.get_mut(code.fixed.len()..).unwrap_or_default();
        for inputs in &code.inputs {
            let (own, rest) = registers.split_at_mut(inputs.count.min(registers.len()));
            registers = rest;
            if has_factors && inputs.argument == Argument::Factors {
                continue;
            }
            match self.given(inputs) {
                Some(given) => own.copy_from_slice(given),
                None => own.fill(T::splat(0.0)),
            }
        }
    }
}

/// Possible numbers of registers of a machine, powers of two: register indices are masked instead of checked.
const SIZES: [usize; 3] = [1 << 10, 1 << 13, 1 << 16];

/// An array of registers, of one of three sizes; of any size for wide instructions.
#[derive(Clone, Debug)]
enum File<T> {
    Small(Box<[T; SIZES[0]]>),
    Medium(Box<[T; SIZES[1]]>),
    Large(Box<[T; SIZES[2]]>),
    Wide(Vec<T>),
}

impl<T> File<T> {
    fn registers(&mut self) -> &mut [T] {
        match self {
            File::Small(file) => file.as_mut_slice(),
            File::Medium(file) => file.as_mut_slice(),
            File::Large(file) => file.as_mut_slice(),
            File::Wide(file) => file,
        }
    }
}

/// The registers of a function, including its fixed numbers.
#[derive(Clone, Debug)]
pub struct Machine<T> {
    file: File<T>,
    /// The frame of machine code, once there is any.
    frame: Vec<T>,
    /// The version of the factors in it.
    version: u64,
    /// The same with derivatives in cells of their own, and its results.
    cells: [Vec<f64x8>; 2],
}

impl<T: Number> Machine<T> {
    /// Registers for a function, all zero.
    pub fn new(code: &Code) -> Self {
        let file = match code.registers {
            count if count <= SIZES[0] => File::Small(zeros()),
            count if count <= SIZES[1] => File::Medium(zeros()),
            count if count <= SIZES[2] => File::Large(zeros()),
            count => File::Wide(vec![T::splat(0.0); count]),
        };
        Self { file, frame: vec![], version: 0, cells: [vec![], vec![]] }
    }

    /// Sets the fixed numbers of a function; `parameter` and `stored` return live parameters and the constants computed from them, by index.
    pub fn fix(&mut self, code: &Code, parameter: impl Fn(usize) -> T, stored: impl Fn(usize) -> T) {
        // −x, computed as −1 x − 0.
        let negative = |x: T| fma(T::splat(-1.0), x, T::splat(-0.0));
        for (register, fixed) in self.registers().iter_mut().zip(&code.fixed) {
            let (number, sign) = match *fixed {
                Fixed::Number(number) => (T::splat(number), false),
                Fixed::Parameter { index, negative } => (parameter(index), negative),
                Fixed::Stored { index, negative } => (stored(index), negative),
            };
            *register = if sign { negative(number) } else { number };
        }
        // Machine code has them in the first places of its frame.
        let Self { file, frame, cells, .. } = self;
        // Those with derivatives are written again before the next call.
        cells[0].clear();
        frame.iter_mut().zip(file.registers()).take(code.fixed.len()).for_each(|(place, fixed)| *place = *fixed);
    }

    fn registers(&mut self) -> &mut [T] {
        self.file.registers()
    }

    /// Runs the function for which the machine was made. What is not given is zero.
    pub fn run(&mut self, code: &Code, environment: &Environment<'_, T>, out: &mut [T]) {
        environment.write(code, self.registers(), 0);
        match (&code.instructions, &mut self.file) {
            (Instructions::Narrow(narrow), File::Small(file)) => run(code, narrow, &mut **file, out),
            (Instructions::Narrow(narrow), File::Medium(file)) => run(code, narrow, &mut **file, out),
            (Instructions::Narrow(narrow), File::Large(file)) => run(code, narrow, &mut **file, out),
            (Instructions::Narrow(narrow), File::Wide(file)) => run(code, narrow, &mut **file, out),
            (Instructions::Wide(wide), file) => run(code, wide, file.registers(), out),
        }
    }

    /// The registers, of which the first have the fixed numbers; the frame of machine code with derivatives, and room for its results.
    pub(crate) fn with_cells(&mut self) -> (&[T], &mut [Vec<f64x8>; 2]) {
        let Self { file, cells, .. } = self;
        (file.registers(), cells)
    }

    /// The frame of machine code, made from the fixed numbers if there is none, and the version of the factors in it.
    pub(crate) fn frame(&mut self, make: impl FnOnce(&[T]) -> Vec<T>) -> (&mut [T], &mut u64) {
        if self.frame.is_empty() {
            self.frame = make(self.registers());
        }
        (&mut self.frame, &mut self.version)
    }
}

#[expect(clippy::unnecessary_box_returns, reason = "the largest have megabytes")]
fn zeros<T: Number, const SIZE: usize>() -> Box<[T; SIZE]> {
    let zeros = vec![T::splat(0.0); SIZE].into_boxed_slice();
    match zeros.try_into() {
        Ok(zeros) => zeros,
        Err(_) => unreachable!("as many as were asked for"),
    }
}

/// The registers of a run, by their numbers.
trait Registers<T> {
    fn get(&self, register: usize) -> T;
    fn set(&mut self, register: usize, value: T);
}

/// With a power of two the number is masked, without a comparison.
impl<T: Copy, const SIZE: usize> Registers<T> for [T; SIZE] {
    #[inline]
    fn get(&self, register: usize) -> T {
        self[register % SIZE]
    }

    #[inline]
    fn set(&mut self, register: usize, value: T) {
        self[register % SIZE] = value;
    }
}

impl<T: Copy> Registers<T> for [T] {
    #[inline]
    fn get(&self, register: usize) -> T {
        self[register]
    }

    #[inline]
    fn set(&mut self, register: usize, value: T) {
        self[register] = value;
    }
}

/// Runs all segments.
fn run<T: Number, I: Operands, F: Registers<T> + ?Sized>(
    code: &Code,
    mut instructions: &[I],
    file: &mut F,
    out: &mut [T],
) {
    let mut copies = code.stores.as_slice();
    for segment in &code.segments {
        let length = segment.length as usize;
        if segment.kind == Kind::Store {
            let (own, rest) = copies.split_at(length);
            copies = rest;
            for copy in own {
                if let Some(place) = out.get_mut(copy.place as usize) {
                    *place = file.get(copy.register as usize);
                }
            }
            continue;
        }
        let (own, rest) = instructions.split_at(length);
        instructions = rest;
        match segment.kind {
            Kind::MulAdd => multiply_and_add(own, file),
            Kind::Div => own.iter().for_each(|i| file.set(i.out(), file.get(i.a()) / file.get(i.b()))),
            Kind::Min => own.iter().for_each(|i| file.set(i.out(), file.get(i.a()).min(file.get(i.b())))),
            Kind::Max => own.iter().for_each(|i| file.set(i.out(), file.get(i.a()).max(file.get(i.b())))),
            Kind::Sqrt => own.iter().for_each(|i| file.set(i.out(), sqrt(file.get(i.a())))),
            Kind::Exp => own.iter().for_each(|i| file.set(i.out(), exp(file.get(i.a())))),
            Kind::Select => {
                for i in own {
                    file.set(i.out(), select(file.get(i.a()), file.get(i.b()), file.get(i.c())));
                }
            }
            Kind::Angle => take_angles(own, file),
            Kind::Stumpff => take_stumpff(own, file),
            Kind::Store => {}
        }
    }
}

fn multiply_and_add<T: Number, I: Operands, F: Registers<T> + ?Sized>(instructions: &[I], file: &mut F) {
    for i in instructions {
        file.set(i.out(), fma(file.get(i.a()), file.get(i.b()), file.get(i.c())));
    }
}

/// Sines and cosines of angles, eight by eight; all eight are read before one is written.
fn take_angles<T: Number, I: Operands, F: Registers<T> + ?Sized>(instructions: &[I], file: &mut F) {
    for eight in instructions.chunks(ANGLES) {
        let mut angles = [T::splat(0.0); ANGLES];
        for (angle, i) in angles.iter_mut().zip(eight) {
            *angle = file.get(i.a());
        }
        let (sines, cosines) = T::sin_cos(angles);
        for (i, (sin, cos)) in eight.iter().zip(sines.into_iter().zip(cosines)) {
            file.set(i.out(), sin);
            file.set(i.b(), cos);
        }
    }
}

/// Stumpff's functions of arguments, eight by eight, two instructions each; all eight are read before one is written.
fn take_stumpff<T: Number, I: Operands, F: Registers<T> + ?Sized>(instructions: &[I], file: &mut F) {
    for eight in instructions.chunks(2 * ANGLES) {
        let mut arguments = [T::splat(0.0); ANGLES];
        for (argument, i) in arguments.iter_mut().zip(eight.iter().step_by(2)) {
            *argument = file.get(i.a());
        }
        let [c0, c1, c2, c3, c4, c5] = T::stumpff(arguments);
        let halves = c0.into_iter().zip(c1).zip(c2).zip(c3.into_iter().zip(c4).zip(c5));
        for (pair, (((c0, c1), c2), ((c3, c4), c5))) in eight.chunks(2).zip(halves) {
            for (i, [out, b, c]) in pair.iter().zip([[c0, c1, c2], [c3, c4, c5]]) {
                file.set(i.out(), out);
                file.set(i.b(), b);
                file.set(i.c(), c);
            }
        }
    }
}
