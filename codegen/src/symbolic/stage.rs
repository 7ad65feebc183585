//! One function in two stages: the part that does not depend on some of its inputs is computed first and used many times.

use super::Expr;
use super::graph::Graph;
use super::op::{ExprId, Op, SymbolId};
use super::trace::{SweepTrace, Visit};

/// A computation split in two.
#[derive(Debug)]
pub struct Stages<'g> {
    /// Values that the first stage passes to the second, in order of construction.
    pub factors: Vec<Expr<'g>>,
    /// The results, in terms of only the factors' symbols and the late inputs.
    pub results: Vec<Expr<'g>>,
    /// The part of the sweeps that remains for the second stage.
    pub trace: SweepTrace,
}

impl Graph {
    /// Splits the computation of `results` by the sweeps of `trace` where it first uses a `late` symbol. The factors are
    /// assigned the symbols from `first` on.
    pub fn stages<'g>(
        &'g self,
        results: &[Expr<'g>],
        trace: &SweepTrace,
        late: impl Fn(SymbolId) -> bool,
        first: SymbolId,
    ) -> Stages<'g> {
        let last = results.iter().map(|result| result.id().0).max();
        let ids: Vec<ExprId> = last.map_or(vec![], |last| (0..=last).map(ExprId).collect());
        let is_result = |id: ExprId| results.iter().any(|result| result.id() == id);
        let mut is_late = vec![false; ids.len()];
        for id in &ids {
            let op = self.op(*id);
            is_late[id.index()] =
                matches!(op, Op::Symbol(symbol) if late(symbol)) || op.operands().any(|id| is_late[id.index()]);
        }
        let mut needed = vec![false; ids.len()];
        for id in ids.iter().rev() {
            needed[id.index()] |= is_result(*id);
            if needed[id.index()] && is_late[id.index()] {
                self.op(*id).operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        let mut factors = Vec::new();
        let mut next = (first.0..).map(SymbolId);
        // The counterpart of each needed expression in the second stage.
        let mut moved = ids.clone();
        for id in ids.into_iter().filter(|id| needed[id.index()]) {
            let op = self.op(id);
            if is_late[id.index()] {
                moved[id.index()] = self.build(op.map(|operand| moved[operand.index()])).id();
            } else if !matches!(op, Op::Constant(_)) {
                factors.push(self.expr(id));
                moved[id.index()] = next.next().map_or(id, |symbol| self.symbol(symbol).id());
            }
        }
        let is_moved = |id: &&ExprId| is_late.get(id.index()).is_some_and(|late| *late) && needed[id.index()];
        let visits = trace.visits.iter().map(|visit| Visit {
            nodes: visit.nodes.iter().filter(is_moved).map(|id| moved[id.index()]).collect(),
            ..visit.clone()
        });
        let trace = SweepTrace { visits: visits.collect() };
        Stages { factors, results: results.iter().map(|result| self.expr(moved[result.id().index()])).collect(), trace }
    }
}
