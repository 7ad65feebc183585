//! Derivatives of expressions with respect to a symbol, operation by operation.

use super::Expr;
use super::graph::Graph;
use super::op::{ExprId, Op};

impl Graph {
    /// `∂f/∂x` of expressions with respect to an input x, forward along the graph: one derivative per node between x and an expression.
    ///
    /// Where a minimum, a maximum or a choice changes branches, the result is the derivative on the side that [`Op::Select`] takes.
    /// For Stumpff's functions `c_k' = (k c_{k+2} − c_{k+1})/2`.
    pub fn derivatives<'g>(&'g self, of: &[Expr<'g>], by: Expr<'g>) -> Vec<Expr<'g>> {
        let zero = self.constant(0.0);
        let last = of.iter().map(|f| f.id().0).max().unwrap_or(0);
        let mut needed = vec![false; last as usize + 1];
        for f in of {
            needed[f.id().index()] = true;
        }
        for id in (0..=last).rev().map(ExprId).filter(|id| id.0 > by.id().0) {
            if needed[id.index()] {
                self.op(id).operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        // Expressions with a smaller id than x cannot depend on x.
        let mut derivatives: Vec<Option<Expr<'g>>> = vec![None; last as usize + 1];
        for id in (by.id().0..=last).map(ExprId).filter(|id| needed[id.index()]) {
            let of = |operand: ExprId| derivatives[operand.index()];
            let depends = id == by.id() || self.op(id).operands().any(|operand| of(operand).is_some());
            if depends {
                let one = || self.constant(1.0);
                let slope =
                    if id == by.id() { one() } else { self.derivative(id, &|operand| of(operand).unwrap_or(zero)) };
                derivatives[id.index()] = (!slope.is_zero()).then_some(slope);
            }
        }
        of.iter().map(|f| derivatives[f.id().index()].unwrap_or(zero)).collect()
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
