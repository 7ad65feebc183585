//! Local simplification: each rule looks at one operation and its operands.
//!
//! The rules neither distribute products nor flatten sums: in recursive dynamics this more than doubles the operations,
//! because it breaks up the intermediate results that the recursion shares.

use super::Graph;
use super::op::{Constant, ExprId, Op};
use super::stumpff;
use Op::{Add, Cos, Div, Exp, Max, Min, Mul, Neg, Select, Sin, Sqrt, Stumpff, Sub};

/// The node of `op` after all applicable rules.
pub(super) fn simplify(graph: &Graph, op: Op) -> ExprId {
    match op {
        Op::Constant(_) | Op::Symbol(_) => graph.intern(op),
        Neg(a) => negate(graph, a),
        Add(a, b) => add(graph, a, b),
        Sub(a, b) => subtract(graph, a, b),
        Mul(a, b) => multiply(graph, a, b),
        Div(a, b) => divide(graph, a, b),
        Sin(a) => sine(graph, a),
        Cos(a) => cosine(graph, a),
        Stumpff(k, a) => match number(graph, a) {
            Some(x) => constant(graph, stumpff::evaluate(k, x)),
            None => graph.intern(op),
        },
        Min(a, b) => extremum(graph, op, a, b, f64::min),
        Max(a, b) => extremum(graph, op, a, b, f64::max),
        Sqrt(a) => of_number(graph, op, a, libm::sqrt),
        Exp(a) => of_number(graph, op, a, libm::exp),
        Select(a, b, c) => select(graph, a, b, c),
    }
}

fn constant(graph: &Graph, value: f64) -> ExprId {
    graph.intern(Op::Constant(Constant::new(value)))
}

fn number(graph: &Graph, id: ExprId) -> Option<f64> {
    match graph.op(id) {
        Op::Constant(c) => Some(c.value()),
        _ => None,
    }
}

/// `−a`, with the sign moved to where it costs nothing.
fn negate(graph: &Graph, a: ExprId) -> ExprId {
    match graph.op(a) {
        Op::Constant(c) => constant(graph, -c.value()),
        Neg(inner) => inner,
        Sub(x, y) => graph.intern(Sub(y, x)),
        _ => graph.intern(Neg(a)),
    }
}

fn add(graph: &Graph, a: ExprId, b: ExprId) -> ExprId {
    match (number(graph, a), number(graph, b)) {
        (Some(x), Some(y)) => return constant(graph, x + y),
        (Some(0.0), None) => return b,
        (None, Some(0.0)) => return a,
        _ => {}
    }
    match (graph.op(a), graph.op(b)) {
        (Neg(x), Neg(y)) => {
            let sum = add(graph, x, y);
            negate(graph, sum)
        }
        (_, Neg(y)) => subtract(graph, a, y),
        (Neg(x), _) => subtract(graph, b, x),
        _ if a == b => multiply_by(graph, 2.0, a),
        _ => graph.intern(Add(a.min(b), a.max(b))),
    }
}

fn subtract(graph: &Graph, a: ExprId, b: ExprId) -> ExprId {
    match (number(graph, a), number(graph, b)) {
        (Some(x), Some(y)) => return constant(graph, x - y),
        (Some(0.0), None) => return negate(graph, b),
        (None, Some(0.0)) => return a,
        _ => {}
    }
    match (graph.op(a), graph.op(b)) {
        _ if a == b => constant(graph, 0.0),
        (Neg(x), Neg(y)) => subtract(graph, y, x),
        (_, Neg(y)) => add(graph, a, y),
        (Neg(x), _) => {
            let sum = add(graph, x, b);
            negate(graph, sum)
        }
        // If only the difference in the other order exists, share it.
        _ => match graph.known(Sub(b, a)) {
            Some(flipped) if graph.known(Sub(a, b)).is_none() => graph.intern(Neg(flipped)),
            _ => graph.intern(Sub(a, b)),
        },
    }
}

fn multiply(graph: &Graph, a: ExprId, b: ExprId) -> ExprId {
    match (number(graph, a), number(graph, b)) {
        (Some(x), Some(y)) => return constant(graph, x * y),
        (Some(x), None) => return multiply_by(graph, x, b),
        (None, Some(y)) => return multiply_by(graph, y, a),
        (None, None) => {}
    }
    match (graph.op(a), graph.op(b)) {
        (Neg(x), Neg(y)) => multiply(graph, x, y),
        (Neg(x), _) => {
            let product = multiply(graph, x, b);
            negate(graph, product)
        }
        (_, Neg(y)) => {
            let product = multiply(graph, a, y);
            negate(graph, product)
        }
        _ => graph.intern(Mul(a.min(b), a.max(b))),
    }
}

/// `factor · a`; a constant factor always comes first and is positive, so that `2x` and `−2x` share a product.
fn multiply_by(graph: &Graph, factor: f64, a: ExprId) -> ExprId {
    if factor == 0.0 {
        return constant(graph, 0.0);
    }
    if factor == 1.0 {
        return a;
    }
    if factor < 0.0 {
        let positive = multiply_by(graph, -factor, a);
        return negate(graph, positive);
    }
    match graph.op(a) {
        Op::Constant(c) => constant(graph, factor * c.value()),
        Neg(x) => multiply_by(graph, -factor, x),
        Mul(x, y) if number(graph, x).is_some() => {
            let inner = number(graph, x).unwrap_or(1.0);
            multiply_by(graph, factor * inner, y)
        }
        _ => {
            let factor = constant(graph, factor);
            graph.intern(Mul(factor, a))
        }
    }
}

fn divide(graph: &Graph, a: ExprId, b: ExprId) -> ExprId {
    match (number(graph, a), number(graph, b)) {
        (Some(x), Some(y)) => constant(graph, x / y),
        (Some(0.0), None) => a,
        (None, Some(y)) => multiply_by(graph, y.recip(), a),
        _ => graph.intern(Div(a, b)),
    }
}

fn sine(graph: &Graph, a: ExprId) -> ExprId {
    match graph.op(a) {
        // libm instead of the platform's functions: the same bytes on any machine.
        Op::Constant(c) => constant(graph, libm::sin(c.value())),
        Neg(x) => {
            let sin = graph.intern(Sin(x));
            negate(graph, sin)
        }
        _ => graph.intern(Sin(a)),
    }
}

fn cosine(graph: &Graph, a: ExprId) -> ExprId {
    match graph.op(a) {
        Op::Constant(c) => constant(graph, libm::cos(c.value())),
        Neg(x) => graph.intern(Cos(x)),
        _ => graph.intern(Cos(a)),
    }
}

/// A function of one number, computed without the platform's functions: the same bytes on any machine.
fn of_number(graph: &Graph, op: Op, a: ExprId, of: fn(f64) -> f64) -> ExprId {
    number(graph, a).map_or_else(|| graph.intern(op), |x| constant(graph, of(x)))
}

fn select(graph: &Graph, a: ExprId, b: ExprId, c: ExprId) -> ExprId {
    match number(graph, a) {
        Some(x) if x > 0.0 => b,
        Some(_) => c,
        None if b == c => b,
        None => graph.intern(Select(a, b, c)),
    }
}

fn extremum(graph: &Graph, op: Op, a: ExprId, b: ExprId, pick: fn(f64, f64) -> f64) -> ExprId {
    match (number(graph, a), number(graph, b)) {
        (Some(x), Some(y)) => constant(graph, pick(x, y)),
        _ if a == b => a,
        _ => graph.intern(op),
    }
}
