//! From a function over a graph to bytecode.
//!
//! | pass | file | after it |
//! |---|---|---|
//! | select | `select` | each value is one operation, with the signs that its users need |
//! | order | `line` | straight-line code: angles first, then in the order of derivation; results as soon as a batch of them is known |
//! | registers | `registers` | registers are reused after the last use of their values |

mod line;
mod registers;
mod select;

use crane_codegen::lower::{Constants, fuse};
use crane_codegen::program::{Function, Program};
use crane_codegen::symbolic::ExprId;

use crate::bytecode::Code;
use crate::layout::layout;
use line::Line;
use select::Selection;

/// A function needs more registers than bytecode can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// Their number.
    pub registers: usize,
}

/// A function of a program; `constants` are those of the program.
///
/// # Errors
/// It needs too many registers.
pub fn assemble(program: &Program, constants: &Constants, function: &Function) -> Result<Code, TooLarge> {
    let fused = fuse(program, constants, &function.outputs);
    let graph = Graph { program, constants: Some(constants), fused };
    let entries = layout(&function.shape);
    let selection = Selection::of(&graph, &function.outputs);
    registers::assign(&Line::of(&graph, &selection, &function.outputs, &entries))
}

/// The stored constants of a program, as a function of its live parameters: each operation rounds, as in compiled code.
///
/// # Errors
/// It needs too many registers.
pub fn assemble_constants(program: &Program, constants: &Constants) -> Result<Code, TooLarge> {
    let graph = Graph { program, constants: None, fused: vec![None; program.operations.len()] };
    let outputs = &constants.stored;
    let entries: Vec<_> = (0..outputs.len()).map(crate::layout::Entry::Slot).collect();
    let selection = Selection::of(&graph, outputs);
    registers::assign(&Line::of(&graph, &selection, outputs, &entries))
}

/// A program, and its expressions that need no separate operation.
struct Graph<'p> {
    program: &'p Program,
    /// Values available before a call.
    constants: Option<&'p Constants>,
    /// For every sum or difference, the product that is fused into it.
    fused: Vec<Option<ExprId>>,
}
