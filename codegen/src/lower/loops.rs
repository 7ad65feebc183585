//! Loops: the values that they take, pass from round to round, and leave.

use std::collections::HashMap;

use super::Place;
use crate::program::{Argument, Function};
use crate::symbolic::{ExprId, Visit};

/// Source of a value that differs from round to round; `k` counts the rounds.
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
    /// A value passed on by the previous round.
    Carried(usize),
    /// A value that another loop kept in its round `first + k step`.
    Kept {
        /// The loop.
        of: usize,
        /// The index of the kept value.
        slot: usize,
        /// The round in which it was kept.
        round: Progression,
    },
    /// A value computed before the loop, one per round.
    Gathered(usize),
}

/// `first + k step`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progression {
    /// In round 0.
    pub first: usize,
    /// Increment per round.
    pub step: isize,
}

/// A value taken from a loop after its last round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taking {
    /// A value that the last round passes on.
    Carried {
        /// The loop.
        of: usize,
        /// The index of the value.
        place: usize,
    },
    /// A value that was kept in a round.
    Kept {
        /// The loop.
        of: usize,
        /// The index of the value.
        slot: usize,
        /// The round.
        round: usize,
    },
}

/// One loop.
#[derive(Clone, Debug, Default)]
pub struct Loop {
    /// The number of rounds.
    pub rounds: usize,
    /// The position of the sweep in the first and in the last round.
    pub places: [Place; 2],
    /// Numbers, column by column.
    pub numbers: Vec<Vec<f64>>,
    /// Values computed before the loop, one per round.
    pub gathered: Vec<Vec<ExprId>>,
    /// Values that a round passes to the next: the value before the first round, and the one computed in each.
    pub carried: Vec<(ExprId, ExprId)>,
    /// Values that are the same in every round.
    pub same: Vec<ExprId>,
    /// Values kept, round by round.
    pub kept: Vec<ExprId>,
    /// Slots of the result, and their values.
    pub results: Vec<(Progression, ExprId)>,
    /// The position of each expression of the first visit in the loop.
    pub(super) body: HashMap<ExprId, ExprId>,
}

/// A function with loops.
#[derive(Debug, Default)]
pub struct Rolled {
    /// The loops, each after those from which it takes values.
    pub loops: Vec<Loop>,
    /// The values that differ from round to round, by the index of their [`Argument::Round`] symbols, and their loops.
    pub sources: Vec<(usize, Source)>,
    /// The values taken from loops, by the index of their [`Argument::Loop`] symbols.
    pub takings: Vec<Taking>,
    /// The slots that no loop writes.
    pub outputs: Vec<Option<ExprId>>,
    /// The expressions computed outside of loops or taken from them, in the order of the sweeps.
    pub visits: Vec<Visit>,
}

impl Rolled {
    /// A function without loops.
    pub(super) fn in_line(function: &Function) -> Self {
        let outputs = function.outputs.iter().copied().map(Some).collect();
        Rolled { outputs, visits: function.tape.visits.clone(), ..Rolled::default() }
    }

    /// Everything that is computed outside of loops, then the expressions of the loops.
    pub fn roots(&self) -> Vec<ExprId> {
        let before = |l: &Loop| -> Vec<ExprId> {
            let initial = l.carried.iter().map(|(initial, _)| *initial);
            initial.chain(l.gathered.iter().flatten().copied()).chain(l.same.iter().copied()).collect()
        };
        let outputs = self.outputs.iter().flatten().copied();
        outputs.chain(self.loops.iter().flat_map(|l| [before(l), l.roots()].concat())).collect()
    }
}

impl Loop {
    /// The values that a round computes for others.
    pub fn roots(&self) -> Vec<ExprId> {
        let next = self.carried.iter().map(|(_, next)| *next);
        let results = self.results.iter().map(|(_, value)| *value);
        self.kept.iter().copied().chain(results).chain(next).collect()
    }
}
