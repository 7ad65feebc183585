//! Derivatives of expressions with respect to a symbol, operation by operation.

use rustc_hash::{FxHashMap, FxHashSet};

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
        let mut known: FxHashMap<ExprId, Expr<'g>> = FxHashMap::default();
        for (x, change) in by.iter().zip(changes).filter(|(_, change)| !change.is_zero()) {
            known.insert(x.id(), *change);
        }
        for id in self.between(first, of) {
            let of = |operand: ExprId| known.get(&operand).copied();
            if self.op(id).operands().any(|operand| of(operand).is_some()) {
                let change = rule(id, &|operand| of(operand).unwrap_or(zero));
                if !change.is_zero() {
                    known.insert(id, change);
                }
            }
        }
        of.iter().map(|f| known.get(&f.id()).copied().unwrap_or(zero)).collect()
    }

    /// What expressions are made of, from a position on, operands before their users: as many steps as there are such nodes, however large the
    /// graph is.
    fn between(&self, first: usize, of: &[Expr<'_>]) -> Vec<ExprId> {
        let mut waiting: Vec<ExprId> = of.iter().map(|f| f.id()).collect();
        let mut seen = FxHashSet::default();
        while let Some(id) = waiting.pop() {
            if id.index() >= first && seen.insert(id) {
                waiting.extend(self.op(id).operands());
            }
        }
        let mut nodes: Vec<ExprId> = seen.into_iter().collect();
        nodes.sort_unstable();
        nodes
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
