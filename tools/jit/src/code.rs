//! A line as machine code.

use crate::allocate::{Allocated, Processor, allocate};
use crate::line::{Line, Rounding, Width};
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
    width: Width,
}

impl Code {
    /// The machine code of a line for this processor; `None` if there is none for it, if the system does not permit to
    /// execute code that was written at run time, or if the line has more than a million results or places.
    ///
    /// # Panics
    /// If a step reads a value that is not made before it.
    #[must_use]
    pub fn of(line: &Line, rounding: Rounding, width: Width) -> Option<Self> {
        let processor = processor(rounding, width)?;
        let Allocated { parts, numbers } = allocate(Operations::of(line, rounding), processor);
        let functions = Functions::new(parts.iter().map(|part| part.instructions.as_slice()), width).ok()?;
        Some(Self { functions, pauses: parts.iter().map(|part| part.pause).collect(), numbers, width })
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
        match self.width {
            Width::One => self.functions.call(part, frame, results, 0),
            // Four of eight at a time: the widest registers that all processors with AVX have.
            Width::Eight => (0..2).for_each(|half| self.functions.call(part, frame, results, 4 * half)),
        }
    }
}

/// This processor, if there is code for it.
#[cfg(target_arch = "x86_64")]
fn processor(rounding: Rounding, _: Width) -> Option<Processor> {
    let fuses = || std::arch::is_x86_feature_detected!("fma");
    let is_known = std::arch::is_x86_feature_detected!("avx") && (rounding == Rounding::Separate || fuses());
    is_known.then_some(Processor { registers: 16, operands_in_memory: true })
}

/// This processor, if there is code for it.
#[cfg(target_arch = "aarch64")]
fn processor(_: Rounding, width: Width) -> Option<Processor> {
    (width == Width::One).then_some(Processor { registers: 32, operands_in_memory: false })
}

/// No processor for which there is code.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn processor(_: Rounding, _: Width) -> Option<Processor> {
    None
}
