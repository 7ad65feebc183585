//! A line as machine code.

use crate::allocate::{Allocated, Processor, allocate};
use crate::line::{Lanes, Rounding, StraightLine, Width};
use crate::memory::Functions;
use crate::operations::Operations;
use crate::places::Pause;

/// A line as machine code: parts, between which the caller computes.
///
/// A frame holds the given values in its first places, then what the code keeps from operation to operation. A place is one
/// number, or eight.
#[derive(Debug)]
pub struct Code {
    functions: Functions,
    pauses: Vec<Option<Pause>>,
    /// Places of numbers that the code needs.
    numbers: Vec<(usize, f64)>,
}

impl Code {
    /// The machine code of a line for this processor; `None` if there is none for it, if the system does not permit to
    /// execute code that was written at run time, or if the line has more than a million results or places.
    ///
    /// # Panics
    /// If a step reads a value that is not made before it.
    #[must_use]
    pub fn compile(line: &StraightLine, rounding: Rounding, width: Width) -> Option<Self> {
        processors(rounding, width).next().and_then(|processor| Self::on(line, rounding, width, processor))
    }

    /// The machine code of a line with each set of instructions that this processor has, the widest first.
    ///
    /// # Panics
    /// As [`compile`](Self::compile).
    #[must_use]
    pub fn each(line: &StraightLine, rounding: Rounding, width: Width) -> Vec<Self> {
        processors(rounding, width).filter_map(|processor| Self::on(line, rounding, width, processor)).collect()
    }

    fn on(
        line: &StraightLine,
        rounding: Rounding,
        width: Width,
        (processor, lanes): (Processor, Lanes),
    ) -> Option<Self> {
        let Allocated { parts, numbers } = allocate(Operations::new(line, rounding), processor);
        let functions = parts.iter().map(|part| part.instructions.as_slice());
        let functions = Functions::new(functions, width, lanes).ok()?;
        Some(Self { functions, pauses: parts.iter().map(|part| part.pause).collect(), numbers })
    }

    /// The number of places in a frame.
    #[must_use]
    pub fn places(&self) -> usize {
        // What a pause makes has a place even if nothing reads it.
        let made = self.pauses.iter().flatten().map(|pause| pause.values + pause.makes);
        made.fold(self.functions.places(), usize::max)
    }

    /// The numbers that a frame holds besides the given values, and their places: to be written before the first call.
    pub fn numbers(&self) -> impl Iterator<Item = (usize, f64)> {
        self.numbers.iter().copied()
    }

    /// The number of parts.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.pauses.len()
    }

    /// What the caller computes after a part, in order of the line's pauses; `None` after the last.
    #[must_use]
    pub fn pause(&self, part: usize) -> Option<Pause> {
        self.pauses[part]
    }

    /// Bytes of machine code.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.functions.bytes()
    }

    /// The number of loops in it.
    #[must_use]
    pub fn loops(&self) -> usize {
        self.functions.loops()
    }

    /// Runs a part.
    ///
    /// # Panics
    /// If the frame has fewer [`places`](Self::places), or there is less room for results than the line has.
    pub fn run(&self, part: usize, frame: &mut [f64], results: &mut [f64]) {
        self.functions.call(part, frame, results);
    }
}

/// What this processor is with each of its sets of instructions, and how many numbers these compute.
#[cfg(target_arch = "x86_64")]
fn processors(rounding: Rounding, width: Width) -> impl Iterator<Item = (Processor, Lanes)> {
    use std::arch::is_x86_feature_detected as has;
    let is_known = has!("avx") && (rounding == Rounding::Separate || has!("fma"));
    let eight = (width == Width::Eight && has!("avx512f")).then_some((32, Lanes::Eight));
    let others = (16, if width == Width::One { Lanes::One } else { Lanes::Four });
    let all = eight.into_iter().chain([others]).filter(move |_| is_known);
    all.map(|(registers, lanes)| (Processor { registers, operands_in_memory: true }, lanes))
}

/// What this processor is with each of its sets of instructions, and how many numbers these compute.
#[cfg(target_arch = "aarch64")]
fn processors(_: Rounding, width: Width) -> impl Iterator<Item = (Processor, Lanes)> {
    let one = (Processor { registers: 32, operands_in_memory: false }, Lanes::One);
    (width == Width::One).then_some(one).into_iter()
}

/// No processor for which there is code.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn processors(_: Rounding, _: Width) -> impl Iterator<Item = (Processor, Lanes)> {
    std::iter::empty()
}
