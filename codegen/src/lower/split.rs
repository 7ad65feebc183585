//! Splits long straight-line code into pieces that rustc compiles fast.

use std::collections::{BTreeMap, BTreeSet};

use super::{Constants, Statement, variables_of};
use crate::program::Program;
use crate::symbolic::{ExprId, Op};

/// A piece has at least this many statements before it is cut …
const SHORTEST_PIECE: usize = 500;
/// … and at most this many; the cut in between that carries the fewest values is chosen. Every `let` opens a scope within the
/// previous one, and rustc's stack overflows on the debug information of about 2,000 of them.
const LONGEST_PIECE: usize = 1500;

/// Whether the code has to be split: by the maximum number of open scopes, where those of a loop are inside those before it.
pub(super) fn is_long(line: &[Statement]) -> bool {
    let body_length = |statement: &Statement| match statement {
        Statement::Loop { body, .. } => body.len(),
        _ => 0,
    };
    line.len() + line.iter().map(body_length).max().unwrap_or(0) > LONGEST_PIECE
}

/// The pieces, and how many values are kept between them.
pub(super) fn split(
    program: &Program,
    constants: &Constants,
    inlined: &[bool],
    line: Vec<Statement>,
) -> (Vec<Vec<Statement>>, usize) {
    if !is_long(&line) {
        return (vec![line], 0);
    }
    let lives = Lives::new(program, constants, inlined, &line);
    let mut cuts = vec![0];
    while line.len() - cuts.last().unwrap_or(&0) > LONGEST_PIECE {
        let start = *cuts.last().unwrap_or(&0);
        let best = (start + SHORTEST_PIECE..=start + LONGEST_PIECE).min_by_key(|&at| lives.alive[at]);
        cuts.push(best.unwrap_or(start + LONGEST_PIECE));
    }
    cuts.push(line.len());
    lives.pieces(program, &line, &cuts)
}

/// Lifetimes of the variables.
struct Lives {
    /// Statement that defines a value.
    defined: BTreeMap<ExprId, usize>,
    /// Values that a statement reads.
    reads: Vec<Vec<ExprId>>,
    /// The number of computed values that live across the cut before a statement.
    alive: Vec<usize>,
}

impl Lives {
    fn new(program: &Program, constants: &Constants, inlined: &[bool], line: &[Statement]) -> Self {
        let mut defined = BTreeMap::new();
        let mut last_read = BTreeMap::new();
        let mut reads = Vec::with_capacity(line.len());
        for (at, statement) in line.iter().enumerate() {
            let read = match statement {
                Statement::SinCos(angles) => {
                    angles.iter().flat_map(|known| operands(program, constants, inlined, known.angle)).collect()
                }
                Statement::Stumpff(arguments) => {
                    arguments.iter().flat_map(|known| operands(program, constants, inlined, known.argument)).collect()
                }
                Statement::Let(id) => variables_of(program, constants, inlined, *id),
                Statement::Output { value, .. } => operands(program, constants, inlined, *value),
                Statement::Input(_)
                | Statement::At(_)
                | Statement::Keep { .. }
                | Statement::Fetch { .. }
                | Statement::Loop { .. } => vec![],
            };
            for id in &read {
                last_read.insert(*id, at);
            }
            reads.push(read);
            for id in defines(statement) {
                defined.insert(id, at);
            }
        }
        // Inputs are read again in each piece, so they cost nothing at a cut.
        let mut change = vec![0isize; line.len() + 1];
        for (id, last) in last_read {
            if !matches!(program.op(id), Op::Symbol(_)) {
                change[defined[&id] + 1] += 1;
                change[last + 1] -= 1;
            }
        }
        let mut sum = 0;
        let alive = change
            .iter()
            .map(|step| {
                sum += step;
                sum.unsigned_abs()
            })
            .collect();
        Lives { defined, reads, alive }
    }

    fn pieces(&self, program: &Program, line: &[Statement], cuts: &[usize]) -> (Vec<Vec<Statement>>, usize) {
        let mut slots: BTreeMap<ExprId, usize> = BTreeMap::new();
        let mut heads = Vec::new();
        for window in cuts.windows(2) {
            let mut head = Vec::new();
            let mut here = BTreeSet::new();
            for id in self.reads[window[0]..window[1]].iter().flatten() {
                if self.defined[id] >= window[0] || !here.insert(*id) {
                    continue;
                }
                if matches!(program.op(*id), Op::Symbol(_)) {
                    head.push(Statement::Input(*id));
                } else {
                    let next = slots.len();
                    head.push(Statement::Fetch { slot: *slots.entry(*id).or_insert(next), value: *id });
                }
            }
            heads.push(head);
        }
        let pieces = cuts
            .windows(2)
            .zip(heads)
            .map(|(window, mut piece)| {
                let read_here: BTreeSet<ExprId> = self.reads[window[0]..window[1]].iter().flatten().copied().collect();
                for statement in &line[window[0]..window[1]] {
                    // An input at the end of a piece is needed by the next, which reads it again.
                    if matches!(statement, Statement::Input(id) if !read_here.contains(id)) {
                        continue;
                    }
                    piece.push(statement.clone());
                    for id in defines(statement) {
                        if let Some(&slot) = slots.get(&id) {
                            piece.push(Statement::Keep { slot, value: id });
                        }
                    }
                }
                piece
            })
            .collect();
        (pieces, slots.len())
    }
}

/// Variables behind an argument, which itself may be inlined or a number.
fn operands(program: &Program, constants: &Constants, inlined: &[bool], id: ExprId) -> Vec<ExprId> {
    if constants.is_free(program, id) {
        vec![]
    } else if inlined[id.index()] {
        variables_of(program, constants, inlined, id)
    } else {
        vec![id]
    }
}

/// Values that a statement defines.
fn defines(statement: &Statement) -> Vec<ExprId> {
    match statement {
        Statement::Input(id) | Statement::Let(id) | Statement::Fetch { value: id, .. } => vec![*id],
        Statement::SinCos(angles) => angles.iter().flat_map(|known| [known.sin, known.cos]).flatten().collect(),
        Statement::Stumpff(arguments) => arguments.iter().flat_map(|known| known.values).flatten().collect(),
        Statement::At(_) | Statement::Output { .. } | Statement::Keep { .. } | Statement::Loop { .. } => vec![],
    }
}
