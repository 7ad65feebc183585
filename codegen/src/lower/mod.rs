//! Lowers functions over a graph to straight-line statements: without dead code, ordered and split, with the constants of
//! the live parameters separated.
//!
//! | pass | file | after it |
//! |---|---|---|
//! | reroll, loops, matching | `reroll` | repeated work of consecutive bodies becomes a loop over the operations of one |
//! | constants | `constants` | values that depend only on live parameters are computed once, outside of all functions |
//! | fuse | `fuse` | a product that only sums use becomes part of them, `a b + c` |
//! | bundle | `bundle` | a value used once is inlined where it is used, as long as the expression stays bounded |
//! | order | `order` | angles first, then each value just before its use, each output as soon as it is known |
//! | split | `split` | no piece is too long for rustc; only values that cross a cut are kept |
//!
//! No pass recurses over the depth of the graph.

mod bundle;
mod constants;
mod fuse;
mod loops;
mod matching;
mod order;
mod reroll;
mod split;
#[cfg(test)]
mod tests;

use crate::program::{Argument, Function, OperationCount, Program};

use crate::symbolic::{ExprId, Op, Visit};

pub use constants::Constants;
pub use fuse::fuse;
pub use loops::{LiveOut, Loop, Progression, Rerolled, Source};

/// A program as straight-line code.
#[derive(Debug)]
pub struct LoweredProgram<'p> {
    /// The program it came from, and the bodies of loops.
    pub program: Program,
    /// Values that depend only on live parameters, and the statements that compute them.
    pub constants: Constants,
    /// One per function, in the program's order.
    pub functions: Vec<LoweredFunction<'p>>,
}

/// A function as straight-line pieces that run one after the other.
#[derive(Debug)]
pub struct LoweredFunction<'p> {
    /// The function that it computes.
    pub function: &'p Function,
    /// Whether it reads live parameters or constants computed from them.
    pub reads_parameters: bool,
    /// Whether it reads inputs.
    pub reads_inputs: bool,
    /// The pieces: one, unless the function is long.
    pub pieces: Vec<Vec<Statement>>,
    /// The number of values kept from piece to piece.
    pub kept: usize,
    /// Its loops; their statements are in the pieces.
    pub rerolled: Rerolled,
    /// Its operations, without those of the constants.
    pub count: OperationCount,
    /// For every node of the graph, whether it is inlined into the expressions that use it.
    pub inlined: Vec<bool>,
    /// For every sum or difference, the product that is fused into it.
    pub fused: Vec<Option<ExprId>>,
}

impl LoweredFunction<'_> {
    /// The number of its statements; those of a loop count once.
    #[must_use]
    pub fn statements(&self) -> usize {
        let within = |statement: &Statement| match statement {
            Statement::Loop { body, .. } => body.len(),
            _ => 0,
        };
        self.pieces.iter().flatten().map(|statement| 1 + within(statement)).sum()
    }
}

/// One statement of a straight line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Statement {
    /// Reads an input: `let boom_psi = q[6];`
    Input(ExprId),
    /// Sines and cosines of all angles: `let ([sin_psi, …], [cos_psi, …]) = sin_cos([psi, …]);`
    SinCos(Vec<Angle>),
    /// Stumpff's functions of all arguments: `let [[c0, …], [c1, …], …] = stumpff([x, …]);`
    Stumpff(Vec<StumpffArgument>),
    /// Computes a value: `let t017 = …;`
    Let(ExprId),
    /// A sweep reaches a body: `// Outward: boom_1`. `None` when all sweeps are done.
    At(Option<SweepPosition>),
    /// A loop and the statements of an iteration.
    Loop {
        /// Which loop.
        of: usize,
        /// Its statements.
        body: Vec<Statement>,
    },
    /// Writes a slot of the result.
    Output {
        /// The slot, in the order of the function's shape.
        slot: usize,
        /// Its value.
        value: ExprId,
    },
    /// Keeps a value for a later piece.
    Keep {
        /// Place among the kept values.
        slot: usize,
        /// The value.
        value: ExprId,
    },
    /// Fetches a value from an earlier piece.
    Fetch {
        /// Place among the kept values.
        slot: usize,
        /// The value.
        value: ExprId,
    },
}

/// Position of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SweepPosition {
    /// Name of the body.
    pub body: String,
    /// Whether the sweep goes from base to tip.
    pub outward: bool,
}

impl From<&Visit> for SweepPosition {
    fn from(visit: &Visit) -> Self {
        SweepPosition { body: visit.body.clone(), outward: visit.outward }
    }
}

/// An angle and the functions of it that are needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Angle {
    /// The angle.
    pub angle: ExprId,
    /// Node of its sine.
    pub sin: Option<ExprId>,
    /// Node of its cosine.
    pub cos: Option<ExprId>,
}

/// An argument of Stumpff's functions and the functions of it that are needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StumpffArgument {
    /// The argument.
    pub argument: ExprId,
    /// Nodes of c₀, c₁, ….
    pub values: [Option<ExprId>; Op::STUMPFF_ORDERS],
}

/// Lowers a program; equal work at `min_iterations` or more consecutive bodies becomes a loop.
#[must_use]
pub fn lower(program: &Program, min_iterations: Option<usize>) -> LoweredProgram<'_> {
    let constants = Constants::new(program);
    let mut extended = program.clone();
    let mut lower_one = |function| lower_function(&mut extended, &constants, function, min_iterations);
    let functions = program.functions.iter().map(&mut lower_one).collect();
    // AFTER THIS POINT: every statement is bounded, every value is computed before it is used, in its own piece.
    LoweredProgram { program: extended, constants, functions }
}

fn lower_function<'p>(
    program: &mut Program,
    constants: &Constants,
    function: &'p Function,
    min_iterations: Option<usize>,
) -> LoweredFunction<'p> {
    let rerolled = min_iterations.and_then(|least| reroll::reroll(program, constants, function, least));
    let in_line = || Rerolled::in_line(function);
    let (line, rerolled, inlined, fused) = match rerolled.map(|rerolled| line(program, constants, function, rerolled)) {
        // Loops and the values taken from them must stay in one piece.
        Some(loops) if !split::is_long(&loops.0) => loops,
        _ => line(program, constants, function, in_line()),
    };
    let program = &*program;
    let (pieces, kept) = split::split(program, constants, &inlined, line);
    let mut count = program.count(&function.outputs, |id| constants.is_stored(id));
    count += function.shape.expansion_count();
    // −(2 · b) is written as −2 · b.
    let folded = |id: &ExprId| match program.op(*id) {
        Op::Neg(a) => match program.op(a) {
            Op::Mul(factor, _) => inlined[a.index()] && matches!(program.op(factor), Op::Constant(_)),
            _ => false,
        },
        _ => false,
    };
    let needed = program.needed(function.outputs.iter().copied());
    count.additions -= program.ids().filter(|id| needed[id.index()]).filter(folded).count();
    let reads_parameters = constants.read_by(program, &function.outputs);
    let is_input = |op: Op| matches!(op, Op::Symbol(symbol) if program.symbol(symbol).argument == Argument::Inputs);
    let reads_inputs = program.ids().filter(|id| needed[id.index()]).any(|id| is_input(program.op(id)));
    LoweredFunction { function, reads_parameters, reads_inputs, pieces, kept, rerolled, count, inlined, fused }
}

/// Statements in order, with inlined expressions and fused products.
fn line(program: &Program, constants: &Constants, function: &Function, rerolled: Rerolled) -> Line {
    let roots = rerolled.roots();
    let fused = fuse::fuse(program, constants, &roots);
    let inlined = bundle::bundle(program, constants, &fused, &roots);
    let line = order::order(program, constants, &inlined, function, &rerolled);
    (line, rerolled, inlined, fused)
}

type Line = (Vec<Statement>, Rerolled, Vec<bool>, Vec<Option<ExprId>>);

/// The values that need variables before `id` can be written: its operands, or, for an inlined operand, the values that it
/// needs itself.
fn variables_of(program: &Program, constants: &Constants, inlined: &[bool], id: ExprId) -> Vec<ExprId> {
    let mut variables = Vec::new();
    let mut stack: Vec<ExprId> = program.op(id).operands().rev().collect();
    while let Some(operand) = stack.pop() {
        if constants.is_free(program, operand) {
            continue;
        }
        if inlined[operand.index()] {
            stack.extend(program.op(operand).operands().rev());
        } else {
            variables.push(operand);
        }
    }
    variables
}
