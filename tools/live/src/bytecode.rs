//! A function as bytecode: operations on numbered registers, in runs of one kind.
//!
//! Nearly all arithmetic is the one operation `a b + c`: a sum is `1 a + b`, a product `a b − 0`, a difference takes a negative,
//! which is kept beside its positive where both are needed. The numbers are those of the separate operations, but for the sign of
//! a zero. So the inner loop has nothing to decide, and a processor guesses the few ends of runs.

use crane_codegen::program::Argument;

/// Number of a register.
pub type Register = u16;

/// A function as bytecode.
#[derive(Clone, Debug, Default)]
pub struct Code {
    /// Numbers that never change, in the first registers.
    pub fixed: Vec<Fixed>,
    /// Inputs in the registers after them, one after the other.
    pub inputs: Vec<Inputs>,
    /// Operations, in order.
    pub instructions: Vec<Instruction>,
    /// Results and the registers they are found in, in order.
    pub stores: Vec<Store>,
    /// What is run, one segment after the other.
    pub segments: Vec<Segment>,
    /// How many registers it needs, those of fixed numbers and inputs included.
    pub registers: usize,
    /// How many numbers it returns.
    pub results: usize,
}

/// A number that is there before a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fixed {
    /// A number of the program.
    Number(f64),
    /// A live parameter or its negative.
    Parameter {
        /// Its place.
        index: usize,
        /// Whether its sign is changed.
        negative: bool,
    },
    /// A constant made of live parameters, or its negative.
    Stored {
        /// Its place.
        index: usize,
        /// Whether its sign is changed.
        negative: bool,
    },
}

/// Inputs of a call that follow each other in an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// The argument that carries them.
    pub argument: Argument,
    /// The place of the first in that argument.
    pub first: usize,
    /// How many there are.
    pub count: usize,
}

/// Operations of one kind, or results to be stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// What is done.
    pub kind: Kind,
    /// How often.
    pub length: u32,
}

/// Kind of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `out = a b + c`
    MulAdd,
    /// `out = a / b`
    Div,
    /// `out = min(a, b)`
    Min,
    /// `out = max(a, b)`
    Max,
    /// `out = √a`
    Sqrt,
    /// `out = eᵃ`
    Exp,
    /// `out = b` where a > 0, else c
    Select,
    /// `out = sin a` and `b = cos a`
    Angle,
    /// `out = c_0(a), b = c_1(a), c = c_2(a)`, and in a second instruction the same with c₃, c₄, c₅
    Stumpff,
    /// A register becomes a result.
    Store,
}

impl Kind {
    /// How many instructions one operation takes.
    #[must_use]
    pub fn instructions(self) -> u32 {
        if self == Kind::Stumpff { 2 } else { 1 }
    }
}

/// An operation on registers; what they mean is for the kind to say. Four numbers of 16 bits in one: it is loaded once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction(u64);

#[expect(clippy::cast_possible_truncation, reason = "each has 16 bits of its own")]
impl Instruction {
    /// An operation with a result and three operands.
    #[must_use]
    pub fn new(out: Register, operands: [Register; 3]) -> Self {
        let [a, b, c] = operands.map(u64::from);
        Self(u64::from(out) << 48 | c << 32 | b << 16 | a)
    }

    /// Register of the result.
    #[inline]
    #[must_use]
    pub fn out(self) -> Register {
        (self.0 >> 48) as Register
    }

    /// First operand.
    #[inline]
    #[must_use]
    pub fn a(self) -> Register {
        self.0 as Register
    }

    /// Second operand.
    #[inline]
    #[must_use]
    pub fn b(self) -> Register {
        (self.0 >> 16) as Register
    }

    /// Third operand.
    #[inline]
    #[must_use]
    pub fn c(self) -> Register {
        (self.0 >> 32) as Register
    }
}

/// A result and the register it is found in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Store {
    /// Its place among the results.
    pub place: u32,
    /// The register.
    pub register: Register,
}
