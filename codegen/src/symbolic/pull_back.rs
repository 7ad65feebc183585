//! Derivatives of weighted sums of expressions with respect to all symbols at once, from the expressions back to the symbols.

use super::Expr;
use super::derivative::twice_stumpff_slope;
use super::graph::Graph;
use super::op::{ExprId, Op};

/// The weight of a node while it is passed on: the derivative of the weighted sum with respect to it.
#[derive(Clone, Copy)]
struct Weight<'g> {
    sum: Expr<'g>,
    /// Whether part of it is zero on one side of a choice. The slopes there may be infinite, as that of a root at 0.
    is_chosen: bool,
}

impl Graph {
    /// `Σ wᵢ ∂fᵢ/∂x` of expressions f with weights w, for each input x of a list: backward along the graph, so that the number of inputs
    /// does not matter (B. Speelpenning, Compiling fast partial derivatives of functions given by algorithms, Illinois 1980).
    ///
    /// At kinks the derivative is that of [`derivatives`](Self::derivatives), and zero for a root at 0.
    pub fn pull_back<'g>(&'g self, of: &[Expr<'g>], weights: &[Expr<'g>], by: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let zero = self.constant(0.0);
        let last = of.iter().map(|f| f.id().index() + 1).max().unwrap_or(0);
        let mut depends = vec![false; last];
        by.iter().filter(|x| x.id().index() < last).for_each(|x| depends[x.id().index()] = true);
        for id in (0..last).map(ExprId::at) {
            depends[id.index()] |= self.op(id).operands().any(|operand| depends[operand.index()]);
        }
        let mut all: Vec<Option<Weight<'g>>> = vec![None; last];
        let add = |all: &mut Vec<Option<Weight<'g>>>, id: ExprId, weight: Weight<'g>| {
            if depends[id.index()] && !weight.sum.is_zero() {
                let place = &mut all[id.index()];
                *place = Some(place.map_or(weight, |known| Weight {
                    sum: known.sum + weight.sum,
                    is_chosen: known.is_chosen || weight.is_chosen,
                }));
            }
        };
        for (f, weight) in of.iter().zip(weights) {
            add(&mut all, f.id(), Weight { sum: *weight, is_chosen: false });
        }
        for id in (0..last).rev().map(ExprId::at) {
            let Some(weight) = all[id.index()] else { continue };
            for (operand, sum, is_chosen) in self.passed_on(id, weight).into_iter().flatten() {
                add(&mut all, operand, Weight { sum, is_chosen });
            }
        }
        by.iter().map(|x| all.get(x.id().index()).copied().flatten().map_or(zero, |weight| weight.sum)).collect()
    }

    /// What a node passes on of its weight, operand by operand.
    fn passed_on<'g>(&'g self, id: ExprId, weight: Weight<'g>) -> [Option<(ExprId, Expr<'g>, bool)>; 2] {
        let Weight { sum: w, is_chosen } = weight;
        let x = |operand: ExprId| self.expr(operand);
        let itself = x(id);
        let zero = self.constant(0.0);
        let (one, both) = (
            |a: ExprId, to_a: Expr<'g>| [Some((a, to_a, is_chosen)), None],
            |[a, b]: [ExprId; 2], [to_a, to_b]: [Expr<'g>; 2], chosen: bool| {
                let is_chosen = is_chosen || chosen;
                [Some((a, to_a, is_chosen)), Some((b, to_b, is_chosen))]
            },
        );
        // Zero times an infinite slope would be NaN.
        let unless_zero = |slope: Expr<'g>| if is_chosen { w.max(-w).select(slope, zero) } else { slope };
        match self.op(id) {
            Op::Constant(_) | Op::Symbol(_) => [None, None],
            Op::Neg(a) => one(a, -w),
            Op::Add(a, b) => both([a, b], [w, w], false),
            Op::Sub(a, b) => both([a, b], [w, -w], false),
            Op::Mul(a, b) => both([a, b], [unless_zero(w * x(b)), unless_zero(w * x(a))], false),
            Op::Div(a, b) => {
                let of_first = unless_zero(w / x(b));
                both([a, b], [of_first, unless_zero(-(of_first * itself))], false)
            }
            Op::Sin(a) => one(a, w * x(a).cos()),
            Op::Cos(a) => one(a, -(w * x(a).sin())),
            Op::Stumpff(k, a) => one(a, w * 0.5 * twice_stumpff_slope(k, x(a))),
            Op::Min(a, b) => {
                let first = x(b) - x(a);
                both([a, b], [first.select(w, zero), first.select(zero, w)], true)
            }
            Op::Max(a, b) => {
                let first = x(a) - x(b);
                both([a, b], [first.select(w, zero), first.select(zero, w)], true)
            }
            Op::Sqrt(a) => one(a, itself.select(w * 0.5 / itself, zero)),
            Op::Exp(a) => one(a, unless_zero(w * itself)),
            Op::Select(a, b, c) => both([b, c], [x(a).select(w, zero), x(a).select(zero, w)], true),
        }
    }
}
