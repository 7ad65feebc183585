//! From functions over a graph to straight lines of statements: dead code gone, ordered, split, with constants of the
//! live parameters set apart.
//!
//! | pass | file | after it |
//! |---|---|---|
//! | constants | `constants` | what depends on live parameters alone is computed once, outside of all functions |
//! | fuse | `fuse` | a product that only sums use is part of them, `a b + c` |
//! | bundle | `bundle` | a value used once stands where it is used, as long as the expression stays bounded |
//! | order | `order` | angles first, then each value shortly before its use, each output as soon as it is known |
//! | split | `split` | no piece is longer than rustc likes; only what crosses a cut is carried |
//!
//! No pass recurses over the depth of the graph.

mod bundle;
mod constants;
mod fuse;
mod order;
mod split;

use crate::symbolic::{ExprId, Function, Op, OperationCount, Program};

pub use constants::Constants;

/// A program as straight lines.
#[derive(Debug)]
pub struct Blocks<'p> {
    /// The program it came from.
    pub program: &'p Program,
    /// Values that depend on live parameters alone, and the statements that compute them.
    pub constants: Constants,
    /// One block a function, in the program's order.
    pub functions: Vec<Block<'p>>,
}

/// A function as straight-line pieces that run one after the other.
#[derive(Debug)]
pub struct Block<'p> {
    /// What it computes.
    pub function: &'p Function,
    /// Whether it reads live parameters or constants made of them.
    pub reads_parameters: bool,
    /// The pieces; one unless the function is long.
    pub pieces: Vec<Vec<Statement>>,
    /// How many values are carried from piece to piece.
    pub carried: usize,
    /// Its operations, without those of the constants.
    pub count: OperationCount,
    /// For every node of the graph, whether it stands inside the expressions that use it.
    pub inlined: Vec<bool>,
    /// For every sum or difference, the product that is fused into it.
    pub fused: Vec<Option<ExprId>>,
}

/// One statement of a straight line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Statement {
    /// Reads an input: `let boom_psi = q[6];`
    Input(ExprId),
    /// Sines and cosines of all angles: `let ([sin_psi, …], [cos_psi, …]) = sin_cos([psi, …]);`
    SinCos(Vec<Angle>),
    /// Computes a value: `let t017 = …;`
    Let(ExprId),
    /// Writes a slot of the result.
    Output {
        /// Which slot, in the order of the function's shape.
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

/// An angle and what is needed of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Angle {
    /// The angle.
    pub angle: ExprId,
    /// Node of its sine.
    pub sin: Option<ExprId>,
    /// Node of its cosine.
    pub cos: Option<ExprId>,
}

/// Lowers a program.
#[must_use]
pub fn lower(program: &Program) -> Blocks<'_> {
    let constants = Constants::of(program);
    let functions = program.functions.iter().map(|function| block(program, &constants, function)).collect();
    // AFTER THIS POINT: every statement is bounded, every value is computed before it is used, in its own piece.
    Blocks { program, constants, functions }
}

fn block<'p>(program: &'p Program, constants: &Constants, function: &'p Function) -> Block<'p> {
    let fused = fuse::fuse(program, constants, &function.outputs);
    let inlined = bundle::bundle(program, constants, &fused, &function.outputs);
    let line = order::order(program, constants, &inlined, function);
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
    Block { function, reads_parameters, pieces, carried, count, inlined, fused }
}

/// The values that must stand in variables of their own before `id` can be written down: its operands, or, where an
/// operand is inlined, what that needs in turn.
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
