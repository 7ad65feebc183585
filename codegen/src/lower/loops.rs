//! Loops: what they take, hand from round to round, and leave.

use std::collections::HashMap;

use super::Place;
use crate::program::{Argument, Function};
use crate::symbolic::{ExprId, Visit};

/// Where a loop takes what differs from round to round; `k` counts the rounds.
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
    /// What the round before hands over.
    Carried(usize),
    /// What another loop kept in its round `first + k step`.
    Kept {
        /// Which loop.
        of: usize,
        /// Which of the values it kept.
        slot: usize,
        /// In which of its rounds.
        round: Progression,
    },
    /// A value computed before the loop, one a round.
    Gathered(usize),
}

/// `first + k step`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progression {
    /// In round 0.
    pub first: usize,
    /// From round to round.
    pub step: isize,
}

/// What is taken from a loop after its last round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taking {
    /// What the last round hands over.
    Carried {
        /// By which loop.
        of: usize,
        /// Which value.
        place: usize,
    },
    /// What was kept in a round.
    Kept {
        /// By which loop.
        of: usize,
        /// Which value.
        slot: usize,
        /// In which round.
        round: usize,
    },
}

/// One loop.
#[derive(Clone, Debug, Default)]
pub struct Loop {
    /// How many rounds.
    pub rounds: usize,
    /// Where the sweep is in the first and in the last round.
    pub places: [Place; 2],
    /// Numbers, column by column.
    pub numbers: Vec<Vec<f64>>,
    /// Values computed before the loop, one a round.
    pub gathered: Vec<Vec<ExprId>>,
    /// What a round hands to the next: the value before the first round, and the one computed in each.
    pub carried: Vec<(ExprId, ExprId)>,
    /// Values that are the same in every round.
    pub same: Vec<ExprId>,
    /// Values kept, round by round.
    pub kept: Vec<ExprId>,
    /// Slots of the result, and their values.
    pub results: Vec<(Progression, ExprId)>,
    /// Where each expression of the first visit stands in the loop.
    pub(super) body: HashMap<ExprId, ExprId>,
}

/// A function with loops.
#[derive(Debug, Default)]
pub struct Rolled {
    /// The loops, each after those it takes from.
    pub loops: Vec<Loop>,
    /// What differs from round to round, by the place of its [`Argument::Round`] symbol, and whose loop it is.
    pub sources: Vec<(usize, Source)>,
    /// What is taken from loops, by the place of its [`Argument::Loop`] symbol.
    pub takings: Vec<Taking>,
    /// The slots that no loop writes.
    pub outputs: Vec<Option<ExprId>>,
    /// What is computed outside of loops or taken from them, as the sweeps did.
    pub visits: Vec<Visit>,
}

impl Rolled {
    /// A function without loops.
    pub(super) fn in_line(function: &Function) -> Self {
        let outputs = function.outputs.iter().copied().map(Some).collect();
        Rolled { outputs, visits: function.tape.visits.clone(), ..Rolled::default() }
    }

    /// Everything that is computed outside of loops, then what the loops compute.
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
    /// What a round computes for others.
    pub fn roots(&self) -> Vec<ExprId> {
        let next = self.carried.iter().map(|(_, next)| *next);
        let results = self.results.iter().map(|(_, value)| *value);
        self.kept.iter().copied().chain(results).chain(next).collect()
    }
}
