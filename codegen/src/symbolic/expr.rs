//! Expressions as values, so that code reads like the printed equations.

use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Graph;
use super::op::{Constant, ExprId, Op};

/// An expression of a [`Graph`].
#[derive(Clone, Copy)]
pub struct Expr<'g> {
    graph: &'g Graph,
    id: ExprId,
}

impl<'g> Expr<'g> {
    pub(super) fn new(graph: &'g Graph, id: ExprId) -> Self {
        Expr { graph, id }
    }

    /// Its node.
    #[must_use]
    pub fn id(self) -> ExprId {
        self.id
    }

    /// The graph it belongs to.
    #[must_use]
    pub fn graph(self) -> &'g Graph {
        self.graph
    }

    /// The number, if it is one.
    #[must_use]
    pub fn as_constant(self) -> Option<f64> {
        match self.graph.op(self.id) {
            Op::Constant(c) => Some(c.value()),
            _ => None,
        }
    }

    /// Whether it is the number zero.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.graph.op(self.id) == Op::Constant(Constant::new(0.0))
    }

    /// sin x
    #[must_use]
    pub fn sin(self) -> Self {
        self.graph.build(Op::Sin(self.id))
    }

    /// cos x
    #[must_use]
    pub fn cos(self) -> Self {
        self.graph.build(Op::Cos(self.id))
    }

    /// The larger of x and y.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.graph.build(Op::Max(self.id, other.id))
    }

    /// The smaller of x and y.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        self.graph.build(Op::Min(self.id, other.id))
    }

    /// √x, x ≥ 0
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.graph.build(Op::Sqrt(self.id))
    }

    /// eˣ
    #[must_use]
    pub fn exp(self) -> Self {
        self.graph.build(Op::Exp(self.id))
    }

    /// tanh x, as `sign x (1 − e)/(1 + e)` with `e = exp(−2|x|)`, which never overflows.
    #[must_use]
    pub fn tanh(self) -> Self {
        let e = (-2.0 * self.max(-self)).exp();
        let size = (1.0 - e) / (1.0 + e);
        self.select(size, -size)
    }

    /// The angle of the point (x, y) in (−π, π], y being this number. Operations that exist make it: it is reduced to tan φ ≤ 1 by symmetry, then
    /// halved twice by `tan φ/2 = tan φ/(1 + √(1 + tan² φ))`, and Gregory's series ends below rounding.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        use std::f64::consts::{FRAC_PI_2, PI};
        let (across, along) = (self.max(-self), x.max(-x));
        let halved = |t: Self| t / (1.0 + (1.0 + t.squared()).sqrt());
        let t = halved(halved(across.min(along) / across.max(along)));
        let squared = t.squared();
        let series = (0..11).rev().fold(self.graph.constant(0.0), |sum, k: i32| {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            sign / f64::from(2 * k + 1) + squared * sum
        });
        let octant = 4.0 * (t * series);
        let quadrant = (across - along).select(FRAC_PI_2 - octant, octant);
        let half = (-x).select(PI - quadrant, quadrant);
        (-self).select(-half, half)
    }

    /// `positive` if x > 0, otherwise `other`.
    #[must_use]
    pub fn select(self, positive: Self, other: Self) -> Self {
        self.graph.build(Op::Select(self.id, positive.id, other.id))
    }

    /// Stumpff's function cₖ(x), x ≥ 0. c₆ and c₇ have no operation: they are `c_k = (1/(k−2)! − c_{k−2})/x`, and for `x ≤ 1`, where this cancels,
    /// their series.
    ///
    /// # Panics
    /// If k > 7.
    #[must_use]
    pub fn stumpff(self, k: u8) -> Self {
        if usize::from(k) < Op::STUMPFF_ORDERS {
            return self.graph.build(Op::Stumpff(k, self.id));
        }
        assert!(k < 8, "Stumpff's functions end at c_7");
        let k = u32::from(k);
        let factorial = f64::from((1..=k).product::<u32>());
        let lower = self.graph.build(Op::Stumpff(if k == 6 { 4 } else { 5 }, self.id));
        let away = 1.0 / self.max(self.graph.constant(1.0));
        // The first term left out is below 1e-17 of the first.
        let series = (0..8).rev().fold(self.graph.constant(1.0), |sum, i| {
            let next = f64::from((2 * i + k + 1) * (2 * i + k + 2));
            1.0 - (self * (1.0 / next)) * sum
        });
        let (below, lowest) = ((1.0 / factorial) * series, factorial / f64::from(k * (k - 1)));
        (self - 1.0).select((1.0 / lowest - lower) * away, below)
    }

    /// The nearest number to x in [low, high].
    #[must_use]
    pub fn clamp(self, low: Self, high: Self) -> Self {
        let at_least = self.graph.build(Op::Max(self.id, low.id));
        self.graph.build(Op::Min(at_least.id, high.id))
    }

    /// x²
    #[must_use]
    pub fn squared(self) -> Self {
        self * self
    }
}

impl fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.graph.op(self.id))
    }
}

macro_rules! binary {
    ($trait:ident, $method:ident) => {
        impl<'g> $trait for Expr<'g> {
            type Output = Expr<'g>;
            fn $method(self, other: Expr<'g>) -> Expr<'g> {
                self.graph.build(Op::$trait(self.id, other.id))
            }
        }

        impl<'g> $trait<f64> for Expr<'g> {
            type Output = Expr<'g>;
            fn $method(self, other: f64) -> Expr<'g> {
                self.$method(self.graph.constant(other))
            }
        }

        impl<'g> $trait<Expr<'g>> for f64 {
            type Output = Expr<'g>;
            fn $method(self, other: Expr<'g>) -> Expr<'g> {
                other.graph.constant(self).$method(other)
            }
        }
    };
}

binary!(Add, add);
binary!(Sub, sub);
binary!(Mul, mul);
binary!(Div, div);

impl<'g> Neg for Expr<'g> {
    type Output = Expr<'g>;
    fn neg(self) -> Expr<'g> {
        self.graph.build(Op::Neg(self.id))
    }
}
