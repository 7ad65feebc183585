//! Loops: the values that they take, pass from iteration to iteration, and leave.

use rustc_hash::FxHashMap;

use super::SweepPosition;
use crate::program::{Argument, Function};
use crate::symbolic::{ExprId, Visit};

/// Source of a value that differs from iteration to iteration; `k` counts the iterations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A column of the loop's table of numbers.
    Number(usize),
    /// `argument[first + k step]`
    Input(Argument, Progression),
    /// The sine of the angle at `first + k step`.
    Sine(Progression),
    /// The cosine of the angle at `first + k step`.
    Cosine(Progression),
    /// Stumpff's function of this order of the argument at `first + k step`.
    Stumpff(u8, Progression),
    /// A value passed on by the previous iteration.
    LoopCarried(usize),
    /// A value that another loop saved in its iteration `first + k step`.
    Saved {
        /// The loop.
        of: usize,
        /// The index of the saved value.
        slot: usize,
        /// The iteration in which it was saved.
        iteration: Progression,
    },
    /// A value computed before the loop, one per iteration.
    Gathered(usize),
}

/// `first + k step`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progression {
    /// In iteration 0.
    pub first: usize,
    /// Increment per iteration.
    pub step: isize,
}

/// A value taken from a loop after its last iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LiveOut {
    /// A value that the last iteration passes on.
    LoopCarried {
        /// The loop.
        of: usize,
        /// The index of the value.
        slot: usize,
    },
    /// A value that was saved in an iteration.
    Saved {
        /// The loop.
        of: usize,
        /// The index of the value.
        slot: usize,
        /// The iteration.
        iteration: usize,
    },
}

/// One loop.
#[derive(Clone, Debug, Default)]
pub struct Loop {
    /// The number of iterations.
    pub iterations: usize,
    /// The position of the sweep in the first and in the last iteration.
    pub ends: [SweepPosition; 2],
    /// Numbers, column by column.
    pub numbers: Vec<Vec<f64>>,
    /// Values computed before the loop, one per iteration.
    pub gathered: Vec<Vec<ExprId>>,
    /// Values that an iteration passes to the next: the value before the first iteration, and the one computed in each.
    pub loop_carried: Vec<(ExprId, ExprId)>,
    /// Values that are the same in every iteration.
    pub invariants: Vec<ExprId>,
    /// Values saved, iteration by iteration.
    pub saved: Vec<ExprId>,
    /// Slots of the result, and their values.
    pub results: Vec<(Progression, ExprId)>,
    /// The position of each expression of the first visit in the loop.
    pub(super) body: FxHashMap<ExprId, ExprId>,
}

/// A function with loops.
#[derive(Debug, Default)]
pub struct Rerolled {
    /// The loops, each after those from which it takes values.
    pub loops: Vec<Loop>,
    /// The values that differ from iteration to iteration, by the index of their [`Argument::LoopVarying`] symbols, and their loops.
    pub sources: Vec<(usize, Source)>,
    /// The values taken from loops, by the index of their [`Argument::LiveOut`] symbols.
    pub live_outs: Vec<LiveOut>,
    /// The slots that no loop writes.
    pub outputs: Vec<Option<ExprId>>,
    /// The expressions computed outside of loops or taken from them, in the order of the sweeps.
    pub visits: Vec<Visit>,
}

impl Rerolled {
    /// A function without loops.
    pub(super) fn in_line(function: &Function) -> Self {
        let outputs = function.outputs.iter().copied().map(Some).collect();
        Rerolled { outputs, visits: function.trace.visits.clone(), ..Rerolled::default() }
    }

    /// Everything that is computed outside of loops, then the expressions of the loops.
    pub fn roots(&self) -> Vec<ExprId> {
        let before = |l: &Loop| -> Vec<ExprId> {
            let initial = l.loop_carried.iter().map(|(initial, _)| *initial);
            initial.chain(l.gathered.iter().flatten().copied()).chain(l.invariants.iter().copied()).collect()
        };
        let outputs = self.outputs.iter().flatten().copied();
        outputs.chain(self.loops.iter().flat_map(|l| [before(l), l.roots()].concat())).collect()
    }
}

impl Loop {
    /// The values that an iteration computes for others.
    pub fn roots(&self) -> Vec<ExprId> {
        let next = self.loop_carried.iter().map(|(_, next)| *next);
        let results = self.results.iter().map(|(_, value)| *value);
        self.saved.iter().copied().chain(results).chain(next).collect()
    }
}
