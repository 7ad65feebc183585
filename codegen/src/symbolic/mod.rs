//! Expressions, programs and their semantics, independent of cranes and of Rust.

mod count;
mod derivative;
mod expr;
mod graph;
mod interpret;
mod op;
mod program;
mod rules;
mod shape;
mod stage;
mod stumpff;
mod tape;
#[cfg(test)]
mod tests;

pub use count::OperationCount;
pub use expr::Expr;
pub use graph::Graph;
pub use interpret::{Inputs, Scalar};
pub use op::{Constant, ExprId, Op, SymbolId};
pub use program::{Argument, Function, Program, Symbol};
pub use shape::{Point, Shape, Struct};
pub use stage::Stages;
pub use tape::{Sweep, Tape, Visit};
