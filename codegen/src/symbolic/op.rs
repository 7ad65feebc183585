//! Operations of the expression graph.

/// Index of an expression in its [`Graph`](super::Graph). Operands always have smaller indices than their users.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(pub(super) u32);

impl ExprId {
    /// The expression at a position in [`Nodes::operations`](super::Nodes::operations).
    ///
    /// # Panics
    /// If the position is 2^32 or beyond, which no graph can hold.
    #[must_use]
    pub fn at(index: usize) -> Self {
        ExprId(u32::try_from(index).expect("fewer than 2^32 expressions"))
    }

    /// Position in [`Nodes::operations`](super::Nodes::operations).
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Index of an input of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SymbolId(pub u32);

/// A constant, compared by its bits so that it can be hashed. −0 is stored as 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Constant(u64);

impl Constant {
    /// The constant for a number.
    #[must_use]
    pub fn new(number: f64) -> Self {
        Constant((number + 0.0).to_bits())
    }

    /// The number.
    #[must_use]
    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// One operation, on at most three operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// A number.
    Constant(Constant),
    /// An input.
    Symbol(SymbolId),
    /// −a
    Neg(ExprId),
    /// a + b
    Add(ExprId, ExprId),
    /// a − b
    Sub(ExprId, ExprId),
    /// a · b
    Mul(ExprId, ExprId),
    /// a / b
    Div(ExprId, ExprId),
    /// sin a
    Sin(ExprId),
    /// cos a
    Cos(ExprId),
    /// Stumpff's function `c_k(a) = Σ (−a)^i/(2i + k)!`, k ≤ [`Op::STUMPFF_ORDERS`] − 1, a ≥ 0.
    Stumpff(u8, ExprId),
    /// Smaller of a and b
    Min(ExprId, ExprId),
    /// Larger of a and b
    Max(ExprId, ExprId),
    /// √a, a ≥ 0
    Sqrt(ExprId),
    /// eᵃ
    Exp(ExprId),
    /// b if a > 0, otherwise c: both are computed, and there is no branch.
    Select(ExprId, ExprId, ExprId),
}

impl Op {
    /// The number zero.
    pub const ZERO: Op = Op::Constant(Constant(0));

    /// The number of Stumpff's functions available as operations: c₀ to c₅.
    pub const STUMPFF_ORDERS: usize = 6;

    /// Operands, in order.
    pub fn operands(self) -> impl DoubleEndedIterator<Item = ExprId> {
        let operands = match self {
            Op::Constant(_) | Op::Symbol(_) => [None, None, None],
            Op::Neg(a) | Op::Sin(a) | Op::Cos(a) | Op::Stumpff(_, a) | Op::Sqrt(a) | Op::Exp(a) => {
                [Some(a), None, None]
            }
            Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) | Op::Min(a, b) | Op::Max(a, b) => {
                [Some(a), Some(b), None]
            }
            Op::Select(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        operands.into_iter().flatten()
    }

    /// The same operation on other operands.
    #[must_use]
    pub fn map(self, mut of: impl FnMut(ExprId) -> ExprId) -> Op {
        match self {
            Op::Constant(_) | Op::Symbol(_) => self,
            Op::Neg(a) => Op::Neg(of(a)),
            Op::Sin(a) => Op::Sin(of(a)),
            Op::Cos(a) => Op::Cos(of(a)),
            Op::Stumpff(k, a) => Op::Stumpff(k, of(a)),
            Op::Add(a, b) => Op::Add(of(a), of(b)),
            Op::Sub(a, b) => Op::Sub(of(a), of(b)),
            Op::Mul(a, b) => Op::Mul(of(a), of(b)),
            Op::Div(a, b) => Op::Div(of(a), of(b)),
            Op::Min(a, b) => Op::Min(of(a), of(b)),
            Op::Max(a, b) => Op::Max(of(a), of(b)),
            Op::Sqrt(a) => Op::Sqrt(of(a)),
            Op::Exp(a) => Op::Exp(of(a)),
            Op::Select(a, b, c) => Op::Select(of(a), of(b), of(c)),
        }
    }

    /// Whether it is a function that is evaluated for all arguments at once, before everything else: a sine, a cosine, one of
    /// Stumpff's functions.
    #[must_use]
    pub fn is_elementary(self) -> bool {
        matches!(self, Op::Sin(_) | Op::Cos(_) | Op::Stumpff(..))
    }

    /// Whether it is an input or a number, which cost nothing.
    #[must_use]
    pub fn is_leaf(self) -> bool {
        matches!(self, Op::Constant(_) | Op::Symbol(_))
    }
}
