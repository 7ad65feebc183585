//! Hash-consed expression graph: every distinct expression exists once.

use std::cell::RefCell;

use rustc_hash::FxHashMap;

use super::op::{Constant, ExprId, Op, SymbolId};
use super::trace::Recorder;
use super::{Expr, rules};

/// A growing graph of expressions. Equal expressions are the same node.
///
/// The map is looked up, never iterated: the order of nodes is the order of their first construction, so the same
/// input gives the same graph on any machine.
#[derive(Debug)]
pub struct Graph {
    nodes: RefCell<Nodes>,
    pub(super) recorder: RefCell<Recorder>,
    simplify: bool,
}

/// The contents of a graph.
#[derive(Debug, Default)]
pub struct Nodes {
    /// All operations, operands before their users.
    pub operations: Vec<Op>,
    /// The position of each operation.
    pub index: FxHashMap<Op, ExprId>,
    /// Names that the model gives to some of them.
    pub names: FxHashMap<ExprId, String>,
}

impl Graph {
    /// A graph that simplifies with local rules: 0, 1, constants, signs, order of commutative operands, `x + x`.
    #[must_use]
    pub fn simplifying() -> Self {
        Graph { nodes: RefCell::default(), recorder: RefCell::default(), simplify: true }
    }

    /// A graph that keeps every operation as written, to measure the effect of simplification.
    #[must_use]
    pub fn verbatim() -> Self {
        Graph { nodes: RefCell::default(), recorder: RefCell::default(), simplify: false }
    }

    /// A graph that simplifies, with the nodes of another.
    #[must_use]
    pub fn resumed(nodes: Nodes) -> Self {
        Graph { nodes: RefCell::new(nodes), ..Self::simplifying() }
    }

    /// The number `value`.
    pub fn constant(&self, value: f64) -> Expr<'_> {
        self.expr(self.intern(Op::Constant(Constant::new(value))))
    }

    /// An input.
    pub fn symbol(&self, symbol: SymbolId) -> Expr<'_> {
        self.expr(self.intern(Op::Symbol(symbol)))
    }

    /// The expression of an operation, simplified if the graph simplifies.
    pub(crate) fn build(&self, op: Op) -> Expr<'_> {
        let id = if self.simplify { rules::simplify(self, op) } else { self.intern(op) };
        self.expr(id)
    }

    /// The node of exactly this operation, new or existing.
    pub(super) fn intern(&self, op: Op) -> ExprId {
        let Nodes { operations, index, .. } = &mut *self.nodes.borrow_mut();
        let id = *index.entry(op).or_insert_with(|| {
            operations.push(op);
            ExprId::at(operations.len() - 1)
        });
        if !op.is_leaf() {
            self.recorder.borrow_mut().ask(id);
        }
        id
    }

    /// The node of exactly this operation, if it exists.
    pub(super) fn known(&self, op: Op) -> Option<ExprId> {
        self.nodes.borrow().index.get(&op).copied()
    }

    /// The operation of a node.
    pub(super) fn op(&self, id: ExprId) -> Op {
        self.nodes.borrow().operations[id.index()]
    }

    /// Gives a node its name in the model; the first name is kept. Leaves keep their own.
    pub fn name(&self, expr: Expr<'_>, name: impl Into<String>) {
        if !self.op(expr.id()).is_leaf() {
            self.nodes.borrow_mut().names.entry(expr.id()).or_insert_with(|| name.into());
        }
    }

    /// All nodes, once the graph has all its expressions.
    #[must_use]
    pub fn into_nodes(self) -> Nodes {
        self.nodes.into_inner()
    }

    /// A node as an expression.
    pub(crate) fn expr(&self, id: ExprId) -> Expr<'_> {
        Expr::new(self, id)
    }
}
