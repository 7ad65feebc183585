//! Expressions. This module does not know about cranes or Rust.

mod derivative;
mod expr;
mod graph;
mod op;
mod pull_back;
mod rules;
mod scalar;
mod stage;
mod stumpff;
mod substitute;
#[cfg(test)]
mod tests;
mod trace;

pub use expr::Expr;
pub use graph::{Graph, Nodes};
pub use op::{Constant, ExprId, Op, SymbolId};
pub use scalar::Scalar;
pub use stage::Stages;
pub use trace::{Sweep, SweepTrace, Visit};
