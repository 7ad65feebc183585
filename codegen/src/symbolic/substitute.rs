//! Replacing symbols by expressions.

use rustc_hash::FxHashMap;

use super::Expr;
use super::graph::Graph;
use super::op::ExprId;

impl Graph {
    /// An expression in which symbols are replaced, simplified again.
    pub fn substitute<'g>(&'g self, of: Expr<'g>, replaced: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
        let mut known = replaced.iter().map(|(symbol, by)| (symbol.id(), by.id())).collect();
        self.expr(self.substituted(of.id(), &mut known))
    }

    fn substituted(&self, id: ExprId, known: &mut FxHashMap<ExprId, ExprId>) -> ExprId {
        if let Some(known) = known.get(&id) {
            return *known;
        }
        let op = self.op(id);
        let own = if op.is_leaf() { id } else { self.build(op.map(|operand| self.substituted(operand, known))).id() };
        known.insert(id, own);
        own
    }
}
