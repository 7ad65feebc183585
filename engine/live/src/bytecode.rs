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

/// Number of a register in [`Instructions::Narrow`].
pub type Register = u16;

/// A function as bytecode.
#[derive(Clone, Debug, Default)]
pub struct Code {
    /// Numbers that never change, in the first registers.
    pub fixed: Vec<Fixed>,
    /// Inputs in the next registers, in sequence.
    pub inputs: Vec<Inputs>,
    /// Operations, in order.
    pub instructions: Instructions,
    /// Results and their registers, in order.
    pub stores: Vec<Store>,
    /// The segments, in the order of execution.
    pub segments: Vec<Segment>,
    /// The number of registers, including those of fixed numbers and inputs.
    pub registers: usize,
    /// The number of results.
    pub results: usize,
}

impl Code {
    /// Whether it has more registers than 16 bits can name.
    #[must_use]
    pub fn is_wide(&self) -> bool {
        matches!(self.instructions, Instructions::Wide(_))
    }
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

/// Operations in order, as wide as the numbers of their registers need.
#[derive(Clone, Debug)]
pub enum Instructions {
    /// With up to 65,536 registers.
    Narrow(Vec<Instruction>),
    /// With more: dense tangents of cranes with many coordinates. They take twice the memory, and have no machine code.
    Wide(Vec<WideInstruction>),
}

impl Default for Instructions {
    fn default() -> Self {
        Instructions::Narrow(Vec::new())
    }
}

/// The registers of an operation, whose meaning depends on the kind.
pub trait Operands: Copy {
    /// Register of the result.
    fn out(self) -> usize;
    /// First operand.
    fn a(self) -> usize;
    /// Second operand.
    fn b(self) -> usize;
    /// Third operand.
    fn c(self) -> usize;
}

/// An operation: four 16-bit numbers in one, which are loaded together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction(u64);

/// An operation on any number of registers: its result, then its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WideInstruction(pub [u32; 4]);

impl WideInstruction {
    /// The same in half the memory, if all its registers have numbers of 16 bits.
    #[must_use]
    pub fn narrow(self) -> Option<Instruction> {
        let [out, a, b, c] = self.0.map(Register::try_from);
        Some(Instruction::new(out.ok()?, [a.ok()?, b.ok()?, c.ok()?]))
    }
}

impl Operands for WideInstruction {
    #[inline]
    fn out(self) -> usize {
        self.0[0] as usize
    }

    #[inline]
    fn a(self) -> usize {
        self.0[1] as usize
    }

    #[inline]
    fn b(self) -> usize {
        self.0[2] as usize
    }

    #[inline]
    fn c(self) -> usize {
        self.0[3] as usize
    }
}

impl Instruction {
    /// An operation with a result and three operands.
    #[must_use]
    pub fn new(out: Register, operands: [Register; 3]) -> Self {
        let [a, b, c] = operands.map(u64::from);
        Self(u64::from(out) << 48 | c << 32 | b << 16 | a)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "each has 16 bits of its own")]
impl Operands for Instruction {
    #[inline]
    fn out(self) -> usize {
        usize::from((self.0 >> 48) as Register)
    }

    #[inline]
    fn a(self) -> usize {
        usize::from(self.0 as Register)
    }

    #[inline]
    fn b(self) -> usize {
        usize::from((self.0 >> 16) as Register)
    }

    #[inline]
    fn c(self) -> usize {
        usize::from((self.0 >> 32) as Register)
    }
}

/// A result and its register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Store {
    /// Its index among the results.
    pub place: u32,
    /// The register.
    pub register: u32,
}
