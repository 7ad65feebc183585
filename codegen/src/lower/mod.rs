//! Lowers functions over a graph to straight-line statements: without dead code, ordered and split, with the constants of
//! the live parameters separated.
//!
//! | pass | file | after it |
//! |---|---|---|
//! | roll, loops, matching | `roll` | repeated work of consecutive bodies is a loop over the operations of one |
//! | constants | `constants` | values that depend only on live parameters are computed once, outside of all functions |
//! | fuse | `fuse` | a product that only sums use is part of them, `a b + c` |
//! | bundle | `bundle` | a value used once is inlined where it is used, as long as the expression stays bounded |
//! | order | `order` | angles first, then each value just before its use, each output as soon as it is known |
//! | split | `split` | no piece is too long for rustc; only values that cross a cut are carried |
//!
//! No pass recurses over the depth of the graph.

mod bundle;
mod constants;
mod fuse;
mod loops;
mod matching;
mod order;
mod roll;
mod split;
#[cfg(test)]
mod tests;

use crate::program::{Argument, Function, OperationCount, Program};

use crate::symbolic::{ExprId, Op, Visit};

pub use constants::Constants;
pub use fuse::fuse;
pub use loops::{Loop, Progression, Rolled, Source, Taking};

/// A program as straight-line code.
#[derive(Debug)]
pub struct Blocks<'p> {
    /// The program it came from, and the bodies of loops.
    pub program: Program,
    /// Values that depend only on live parameters, and the statements that compute them.
    pub constants: Constants,
    /// One block per function, in the program's order.
    pub functions: Vec<Block<'p>>,
}

/// A function as straight-line pieces that run one after the other.
#[derive(Debug)]
pub struct Block<'p> {
    /// The function that it computes.
    pub function: &'p Function,
    /// Whether it reads live parameters or constants computed from them.
    pub reads_parameters: bool,
    /// Whether it reads inputs.
    pub reads_inputs: bool,
    /// The pieces: one, unless the function is long.
    pub pieces: Vec<Vec<Statement>>,
    /// The number of values carried from piece to piece.
    pub carried: usize,
    /// Its loops; their statements are in the pieces.
    pub rolled: Rolled,
    /// Its operations, without those of the constants.
    pub count: OperationCount,
    /// For every node of the graph, whether it is inlined into the expressions that use it.
    pub inlined: Vec<bool>,
    /// For every sum or difference, the product that is fused into it.
    pub fused: Vec<Option<ExprId>>,
}

impl Block<'_> {
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
    At(Option<Place>),
    /// A loop and the statements of a round.
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
        /// Place among the carried values.
        place: usize,
        /// The value.
        value: ExprId,
    },
    /// Fetches a value from an earlier piece.
    Fetch {
        /// Place among the carried values.
        place: usize,
        /// The value.
        value: ExprId,
    },
}

/// Position of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Name of the body.
    pub body: String,
    /// Whether the sweep goes from base to tip.
    pub outward: bool,
}

impl From<&Visit> for Place {
    fn from(visit: &Visit) -> Self {
        Place { body: visit.body.clone(), outward: visit.outward }
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

/// Lowers a program; equal work at `least_rounds` or more consecutive bodies becomes a loop.
#[must_use]
pub fn lower(program: &Program, least_rounds: Option<usize>) -> Blocks<'_> {
    let constants = Constants::of(program);
    let mut extended = program.clone();
    let mut block = |function| block(&mut extended, &constants, function, least_rounds);
    let functions = program.functions.iter().map(&mut block).collect();
    // AFTER THIS POINT: every statement is bounded, every value is computed before it is used, in its own piece.
    Blocks { program: extended, constants, functions }
}

fn block<'p>(
    program: &mut Program,
    constants: &Constants,
    function: &'p Function,
    least_rounds: Option<usize>,
) -> Block<'p> {
    let rolled = least_rounds.and_then(|least| roll::roll(program, constants, function, least));
    let in_line = || Rolled::in_line(function);
    let (line, rolled, inlined, fused) = match rolled.map(|rolled| line(program, constants, function, rolled)) {
        // Loops and the values that they leave stay in one piece.
        Some(loops) if !split::is_long(&loops.0) => loops,
        _ => line(program, constants, function, in_line()),
    };
    let program = &*program;
    let (pieces, carried) = split::split(program, constants, &inlined, line);
    let mut count = program.count(&function.outputs, |id| constants.is_stored(id));
    count += function.shape.closing_count();
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
    Block { function, reads_parameters, reads_inputs, pieces, carried, rolled, count, inlined, fused }
}

/// Statements in order, with inlined expressions and fused products.
fn line(program: &Program, constants: &Constants, function: &Function, rolled: Rolled) -> Line {
    let roots = rolled.roots();
    let fused = fuse::fuse(program, constants, &roots);
    let inlined = bundle::bundle(program, constants, &fused, &roots);
    let line = order::order(program, constants, &inlined, function, &rolled);
    (line, rolled, inlined, fused)
}

type Line = (Vec<Statement>, Rolled, Vec<bool>, Vec<Option<ExprId>>);

/// The values that need variables before `id` can be written: its operands, or, for an inlined operand, the values that it
/// needs in turn.
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
