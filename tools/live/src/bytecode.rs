//! A function as bytecode: operations on numbered registers, in runs of one kind.
//!
//! Nearly all arithmetic is the one operation `a b + c`: a sum is `1 a + b`, a product `a b − 0`, a difference takes a negative,
//! which is kept in addition to the positive value if both are needed. The results are those of the separate operations, except for
//! the sign of a zero. So the inner loop has no branches to predict except the few ends of runs.

use crane_codegen::program::Argument;
use crane_jit::Rounding;

/// How products and sums round in this build, in which bytecode and machine code agree.
pub const ROUNDING: Rounding =
    if cfg!(any(target_feature = "fma", target_arch = "aarch64")) { Rounding::Fused } else { Rounding::Separate };

/// Number of a register.
pub type Register = u16;

/// A function as bytecode.
#[derive(Clone, Debug, Default)]
pub struct Code {
    /// Numbers that never change, in the first registers.
    pub fixed: Vec<Fixed>,
    /// Inputs in the next registers, in sequence.
    pub inputs: Vec<Inputs>,
    /// Operations, in order.
    pub instructions: Vec<Instruction>,
    /// Results and their registers, in order.
    pub stores: Vec<Store>,
    /// The segments, in the order of execution.
    pub segments: Vec<Segment>,
    /// The number of registers, including those of fixed numbers and inputs.
    pub registers: usize,
    /// The number of results.
    pub results: usize,
}

/// A number that is available before a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fixed {
    /// A number of the program.
    Number(f64),
    /// A live parameter or its negative.
    Parameter {
        /// Its index.
        index: usize,
        /// Whether its sign is changed.
        negative: bool,
    },
    /// A constant computed from live parameters, or its negative.
    Stored {
        /// Its index.
        index: usize,
        /// Whether its sign is changed.
        negative: bool,
    },
}

/// Consecutive inputs of a call in an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// The argument that carries them.
    pub argument: Argument,
    /// The index of the first in that argument.
    pub first: usize,
    /// Their number.
    pub count: usize,
}

/// Operations of one kind, or results to be stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// The kind of operation.
    pub kind: Kind,
    /// The number of operations or results.
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
    /// `out = b` if a > 0, otherwise c
    Select,
    /// `out = sin a` and `b = cos a`
    Angle,
    /// `out = c_0(a), b = c_1(a), c = c_2(a)`, and in a second instruction the same with c₃, c₄, c₅
    Stumpff,
    /// A register becomes a result.
    Store,
}

impl Kind {
    /// The number of instructions per operation.
    #[must_use]
    pub fn instructions(self) -> u32 {
        if self == Kind::Stumpff { 2 } else { 1 }
    }
}

/// An operation on registers, whose meaning depends on the kind: four 16-bit numbers in one, which are loaded together.
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

/// A result and its register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Store {
    /// Its index among the results.
    pub place: u32,
    /// The register.
    pub register: Register,
}
