//! Exact operation counts of functions.

use std::fmt;
use std::ops::AddAssign;

use super::Program;
use crate::symbolic::{ExprId, Op};

/// Floating-point operations by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OperationCount {
    /// Additions, subtractions and negations.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions.
    pub divisions: usize,
    /// Angles whose sine, cosine or both are taken.
    pub angles: usize,
    /// Arguments for which one or more of Stumpff's functions are evaluated.
    pub stumpff: usize,
    /// Minima and maxima.
    pub comparisons: usize,
    /// Choices between two values.
    pub choices: usize,
    /// Square roots.
    pub roots: usize,
    /// Exponentials.
    pub exponentials: usize,
}

impl OperationCount {
    /// All operations; an angle counts as one operation, and so does an argument of Stumpff's functions.
    #[must_use]
    pub fn total(&self) -> usize {
        let arithmetic = self.additions + self.multiplications + self.divisions + self.comparisons + self.choices;
        arithmetic + self.angles + self.stumpff + self.roots + self.exponentials
    }
}

impl AddAssign for OperationCount {
    fn add_assign(&mut self, other: Self) {
        self.additions += other.additions;
        self.multiplications += other.multiplications;
        self.divisions += other.divisions;
        self.angles += other.angles;
        self.stumpff += other.stumpff;
        self.comparisons += other.comparisons;
        self.choices += other.choices;
        self.roots += other.roots;
        self.exponentials += other.exponentials;
    }
}

impl fmt::Display for OperationCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} add, {} mul, {} div, {} sin_cos",
            self.additions, self.multiplications, self.divisions, self.angles
        )?;
        let others = [
            (self.stumpff, "stumpff"),
            (self.comparisons, "min/max"),
            (self.choices, "select"),
            (self.roots, "sqrt"),
            (self.exponentials, "exp"),
        ];
        others.iter().filter(|(count, _)| *count > 0).try_for_each(|(count, name)| write!(f, ", {count} {name}"))
    }
}

impl Program {
    /// Operations that `roots` need, each distinct one counted once, without those that `free` declares available.
    pub fn count(&self, roots: &[ExprId], free: impl Fn(ExprId) -> bool) -> OperationCount {
        let mut seen = vec![false; self.operations.len()];
        let mut angles = vec![false; self.operations.len()];
        let mut arguments = vec![false; self.operations.len()];
        let mut stack: Vec<ExprId> = roots.to_vec();
        let mut count = OperationCount::default();
        while let Some(id) = stack.pop() {
            if std::mem::replace(&mut seen[id.index()], true) || free(id) {
                continue;
            }
            let op = self.op(id);
            match op {
                Op::Constant(_) | Op::Symbol(_) => {}
                Op::Neg(_) | Op::Add(..) | Op::Sub(..) => count.additions += 1,
                Op::Mul(..) => count.multiplications += 1,
                Op::Div(..) => count.divisions += 1,
                Op::Sin(a) | Op::Cos(a) => {
                    if !std::mem::replace(&mut angles[a.index()], true) {
                        count.angles += 1;
                    }
                }
                Op::Stumpff(_, a) => {
                    if !std::mem::replace(&mut arguments[a.index()], true) {
                        count.stumpff += 1;
                    }
                }
                Op::Min(..) | Op::Max(..) => count.comparisons += 1,
                Op::Select(..) => count.choices += 1,
                Op::Sqrt(_) => count.roots += 1,
                Op::Exp(_) => count.exponentials += 1,
            }
            stack.extend(op.operands());
        }
        count
    }
}
