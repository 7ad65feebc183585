//! Compares two visits operation by operation.

use rustc_hash::FxHashMap;

use crate::program::Program;

use crate::symbolic::{ExprId, Op};

/// A visit with the same operations as the first visit of its loop.
#[derive(Clone, Debug, Default)]
pub(super) struct Match {
    /// Its expression for each expression of the first visit.
    pub nodes: FxHashMap<ExprId, ExprId>,
    /// Its operands from outside the visit, by the first visit's expression and the operand's index.
    pub outside: FxHashMap<(ExprId, usize), ExprId>,
    templates: FxHashMap<ExprId, ExprId>,
}

impl Match {
    /// The expression of the first visit that corresponds to one of this visit.
    pub fn template_of(&self, id: ExprId) -> Option<ExprId> {
        self.templates.get(&id).copied()
    }
}

/// Pairs the expressions of two visits, from those that each visit requests down to those that only this visit needs.
pub(super) fn matched(
    program: &Program,
    rank: &[usize],
    (first, expected): (usize, &[ExprId]),
    (second, others): (usize, &[ExprId]),
) -> Option<Match> {
    if expected.len() != others.len() {
        return None;
    }
    let mut found = Match::default();
    // The previous partner of an operand from outside the visit.
    let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    let mut stack: Vec<(ExprId, ExprId)> = expected.iter().copied().zip(others.iter().copied()).rev().collect();
    let asked: FxHashMap<ExprId, ExprId> = stack.iter().copied().collect();
    while let Some((a, b)) = stack.pop() {
        if let Some(paired) = found.nodes.get(&a) {
            if *paired != b {
                return None;
            }
            continue;
        }
        if found.templates.insert(b, a).is_some() {
            return None;
        }
        found.nodes.insert(a, b);
        let (op, other) = (program.op(a), program.op(b));
        if std::mem::discriminant(&op) != std::mem::discriminant(&other) {
            return None;
        }
        let inside = |x: ExprId, y: ExprId| match (rank[x.index()] == first, rank[y.index()] == second) {
            (true, true) => {
                let paired = found.nodes.get(&x).or_else(|| asked.get(&x));
                let alike = std::mem::discriminant(&program.op(x)) == std::mem::discriminant(&program.op(y));
                Some(2 * usize::from(alike && paired.is_none_or(|z| *z == y)))
            }
            (false, false) => Some(match known.get(&x) {
                Some(z) => 2 * usize::from(*z == y),
                None => usize::from(class(program, x) == class(program, y)),
            }),
            _ => None,
        };
        let pairs: Vec<(ExprId, ExprId)> = op.operands().zip(other.operands()).collect();
        let order = match (op, pairs.as_slice()) {
            (Op::Add(..) | Op::Mul(..), &[(x1, y1), (x2, y2)]) => {
                let straight = inside(x1, y1).zip(inside(x2, y2)).map(|(a, b)| a + b);
                let swapped = inside(x1, y2).zip(inside(x2, y1)).map(|(a, b)| a + b);
                match (straight, swapped) {
                    (None, None) => return None,
                    (straight, swapped) if straight >= swapped => pairs,
                    _ => vec![(x1, y2), (x2, y1)],
                }
            }
            _ => pairs,
        };
        for (operand, (x, y)) in order.into_iter().enumerate() {
            match (rank[x.index()] == first, rank[y.index()] == second) {
                (true, true) => stack.push((x, y)),
                (false, false) => {
                    known.entry(x).or_insert(y);
                    found.outside.insert((a, operand), y);
                }
                _ => return None,
            }
        }
    }
    Some(found)
}

/// The kind of an operand from outside the visit.
fn class(program: &Program, id: ExprId) -> usize {
    match program.op(id) {
        Op::Constant(_) => 0,
        Op::Symbol(symbol) => 1 + program.symbol(symbol).argument as usize,
        Op::Sin(_) => 100,
        Op::Cos(_) => 101,
        Op::Stumpff(k, _) => 103 + usize::from(k),
        _ => 102,
    }
}
