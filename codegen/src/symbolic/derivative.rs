//! Derivatives of expressions with respect to a symbol, operation by operation.

use super::Expr;
use super::graph::Graph;
use super::op::{ExprId, Op};

/// What makes the change of a node from those of its operands.
type Rule<'r, 'g> = &'r dyn Fn(ExprId, &dyn Fn(ExprId) -> Expr<'g>) -> Expr<'g>;

impl Graph {
    /// `∂f/∂x` of expressions with respect to an input x, forward along the graph: one derivative per node between x and an expression.
    ///
    /// Where a minimum, a maximum or a choice changes branches, the result is the derivative on the side that [`Op::Select`] takes.
    /// For Stumpff's functions `c_k' = (k c_{k+2} − c_{k+1})/2`.
    pub fn derivatives<'g>(&'g self, of: &[Expr<'g>], by: Expr<'g>) -> Vec<Expr<'g>> {
        self.forward(of, &[by], &[self.constant(1.0)], &|id, of| self.derivative(id, of))
    }

    /// `Σ ∂f/∂x δx` of expressions f, with a change δx of each input x of a list: forward along the graph, so that the number of inputs hardly
    /// matters.
    ///
    /// At kinks the derivative is that of [`derivatives`](Self::derivatives), and zero for a root at 0.
    pub fn push_forward<'g>(&'g self, of: &[Expr<'g>], by: &[Expr<'g>], changes: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let zero = self.constant(0.0);
        self.forward(of, by, changes, &|id, of| match self.op(id) {
            Op::Sqrt(_) => self.expr(id).select(self.derivative(id, of), zero),
            _ => self.derivative(id, of),
        })
    }

    /// Changes of expressions from those of inputs, with a rule that makes the change of a node from those of its operands.
    fn forward<'g>(
        &'g self,
        of: &[Expr<'g>],
        by: &[Expr<'g>],
        changes: &[Expr<'g>],
        rule: Rule<'_, 'g>,
    ) -> Vec<Expr<'g>> {
        let zero = self.constant(0.0);
        // Expressions with a smaller id than all inputs cannot depend on them.
        let first = by.iter().map(|x| x.id().index()).min().unwrap_or(0);
        let last = of.iter().map(|f| f.id().index() + 1).max().unwrap_or(0);
        let mut needed = vec![false; last];
        for f in of {
            needed[f.id().index()] = true;
        }
        for id in (first..last).rev().map(ExprId::at) {
            if needed[id.index()] {
                self.op(id).operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        let mut known: Vec<Option<Expr<'g>>> = vec![None; last];
        for (x, change) in by.iter().zip(changes).filter(|(x, _)| x.id().index() < last) {
            known[x.id().index()] = (!change.is_zero()).then_some(*change);
        }
        for id in (first..last).map(ExprId::at).filter(|id| needed[id.index()]) {
            let of = |operand: ExprId| known[operand.index()];
            if self.op(id).operands().any(|operand| of(operand).is_some()) {
                let change = rule(id, &|operand| of(operand).unwrap_or(zero));
                known[id.index()] = (!change.is_zero()).then_some(change);
            }
        }
        of.iter().map(|f| known[f.id().index()].unwrap_or(zero)).collect()
    }

    /// The derivative of a node from those of its operands.
    fn derivative<'g>(&'g self, id: ExprId, of: &dyn Fn(ExprId) -> Expr<'g>) -> Expr<'g> {
        let x = |operand: ExprId| self.expr(operand);
        let itself = x(id);
        match self.op(id) {
            Op::Constant(_) | Op::Symbol(_) => self.constant(0.0),
            Op::Neg(a) => -of(a),
            Op::Add(a, b) => of(a) + of(b),
            Op::Sub(a, b) => of(a) - of(b),
            Op::Mul(a, b) => of(a) * x(b) + x(a) * of(b),
            Op::Div(a, b) => (of(a) - itself * of(b)) / x(b),
            Op::Sin(a) => of(a) * x(a).cos(),
            Op::Cos(a) => -(of(a) * x(a).sin()),
            Op::Stumpff(k, a) => of(a) * 0.5 * twice_stumpff_slope(k, x(a)),
            Op::Min(a, b) => (x(b) - x(a)).select(of(a), of(b)),
            Op::Max(a, b) => (x(a) - x(b)).select(of(a), of(b)),
            // Infinite where a is 0: laws with a root keep its argument above 0.
            Op::Sqrt(a) => of(a) * 0.5 / itself,
            Op::Exp(a) => of(a) * itself,
            Op::Select(a, b, c) => x(a).select(of(b), of(c)),
        }
    }
}

/// Twice the derivative of Stumpff's function of an order.
pub(super) fn twice_stumpff_slope(k: u8, x: Expr<'_>) -> Expr<'_> {
    f64::from(k) * x.stumpff(k + 2) - x.stumpff(k + 1)
}
