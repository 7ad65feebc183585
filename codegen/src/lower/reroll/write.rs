//! Writes loops, and what remains outside of them, as expressions of their own.

use rustc_hash::FxHashMap;

use super::{Operands, Plan, Rerolling, progression};
use crate::lower::SweepPosition;
use crate::lower::loops::{LiveOut, Loop, Source};
use crate::lower::matching::Match;
use crate::program::{Argument, Function, Shape, Symbol};
use crate::symbolic::{ExprId, Op, Visit};

impl Rerolling<'_> {
    /// Writes the loop's body as separate expressions.
    pub(super) fn write(
        &mut self,
        Plan { template, mut making, sources, sites }: Plan,
        visits: &[Visit],
        matches: &[Match],
    ) {
        making.ends = [&visits[0], &visits[visits.len() - 1]].map(SweepPosition::from);
        let number = self.rerolled.loops.len();
        let mut symbols: FxHashMap<&[ExprId], ExprId> = FxHashMap::default();
        let mut outside: FxHashMap<(ExprId, usize), ExprId> = FxHashMap::default();
        for (site, operands) in &sites {
            let id = match (symbols.get(operands.as_slice()), &sources[operands]) {
                (Some(known), _) => *known,
                (None, Operands::Invariant) => {
                    let same = self.straight(operands[0]);
                    if !self.constants.is_free(self.program, same) {
                        making.invariants.push(same);
                    }
                    same
                }
                (None, found) => {
                    let source = match found {
                        Operands::From(source) => source.clone(),
                        Operands::Saved { of, template, iteration } => {
                            Source::Saved { of: *of, slot: self.save(*of, *template), iteration: *iteration }
                        }
                        Operands::Invariant => unreachable!("matched above"),
                    };
                    let name = self.name_of(operands, &source);
                    let index = self.rerolled.sources.len();
                    self.rerolled.sources.push((number, source));
                    self.program.append_symbol(Symbol { name, argument: Argument::LoopVarying, index })
                }
            };
            symbols.insert(operands, id);
            outside.insert(*site, id);
        }
        for id in template {
            let mut operand_numbers = 0..;
            let op = self.program.op(id).map(|operand| {
                let site = (id, operand_numbers.next().unwrap_or_default());
                outside.get(&site).copied().unwrap_or_else(|| making.body[&operand])
            });
            let inside = self.program.append(op);
            making.body.insert(id, inside);
            let names: Vec<Option<&String>> = matches.iter().map(|m| self.program.names.get(&m.nodes[&id])).collect();
            if let Some(name) = common_name(&names) {
                self.program.names.insert(inside, name);
            }
        }
        for (iteration, m) in matches.iter().enumerate() {
            #[expect(
                clippy::iter_over_hash_type,
                reason = "each entry writes another key, so the order does not matter"
            )]
            for (template, id) in &m.nodes {
                self.places.insert(*id, (number, *template, iteration));
            }
        }
        for gathered in &mut making.gathered {
            for id in gathered {
                *id = self.straight(*id);
            }
        }
        for (initial, next) in &mut making.loop_carried {
            *initial = self.straight(*initial);
            *next = making.body[next];
        }
        self.rerolled.loops.push(making);
    }

    /// The part of a value's name in the model that is the same in all iterations.
    fn name_of(&self, operands: &[ExprId], source: &Source) -> String {
        let of = |id: &ExprId| match self.program.op(*id) {
            Op::Symbol(symbol) => Some(self.program.symbol(symbol).name.clone()),
            Op::Sin(angle) => self.program.names.get(id).cloned().or_else(|| Some(format!("sin_{}", angle.index()))),
            _ => self.program.names.get(id).cloned(),
        };
        let names: Vec<Option<String>> = operands.iter().map(of).collect();
        let common = common_name(&names.iter().map(Option::as_ref).collect::<Vec<_>>());
        match source {
            Source::Number(_) => "number".into(),
            Source::LoopCarried(_) => {
                let iterations: Vec<Option<&String>> = names.iter().skip(1).map(Option::as_ref).collect();
                common.or_else(|| common_name(&iterations)).map_or("before".into(), |name| format!("{name}_before"))
            }
            _ => common.unwrap_or("taken".into()),
        }
    }

    /// The slot in which a loop saves the values of an expression of its first visit.
    fn save(&mut self, of: usize, template: ExprId) -> usize {
        let Loop { saved, body, .. } = &mut self.rerolled.loops[of];
        let value = body[&template];
        saved.iter().position(|known| *known == value).unwrap_or_else(|| {
            saved.push(value);
            saved.len() - 1
        })
    }

    /// An expression outside of loops, in terms of the values that loops leave.
    fn straight(&mut self, root: ExprId) -> ExprId {
        let mut stack = vec![root];
        while let Some(&id) = stack.last() {
            let op = self.program.op(id);
            let moved = if self.moved.contains_key(&id) {
                None
            } else if let Some(&(of, template, iteration)) = self.places.get(&id) {
                Some(self.live_out(id, of, template, iteration))
            } else if self.constants.is_free(self.program, id) || op.is_leaf() || op.is_elementary() {
                Some(id)
            } else {
                let waiting: Vec<ExprId> = op.operands().filter(|operand| !self.moved.contains_key(operand)).collect();
                if !waiting.is_empty() {
                    stack.extend(waiting);
                    continue;
                }
                let same = op.operands().all(|operand| self.moved[&operand] == operand);
                Some(if same { id } else { self.rewritten(id, op) })
            };
            if let Some(moved) = moved {
                self.moved.insert(id, moved);
            }
            stack.pop();
        }
        self.moved[&root]
    }

    fn rewritten(&mut self, id: ExprId, op: Op) -> ExprId {
        let new = self.program.append(op.map(|operand| self.moved[&operand]));
        if let Some(name) = self.program.names.get(&id).cloned() {
            self.program.names.insert(new, name);
        }
        new
    }

    /// The symbol of a value that a loop leaves.
    fn live_out(&mut self, id: ExprId, of: usize, template: ExprId, iteration: usize) -> ExprId {
        let Loop { iterations, loop_carried, body, .. } = &self.rerolled.loops[of];
        let value = body[&template];
        let loop_carried =
            loop_carried.iter().position(|(_, next)| *next == value).filter(|_| iteration + 1 == *iterations);
        let live_out = match loop_carried {
            Some(slot) => LiveOut::LoopCarried { of, slot },
            None => LiveOut::Saved { of, slot: self.save(of, template), iteration },
        };
        let index = self.rerolled.live_outs.len();
        self.rerolled.live_outs.push(live_out);
        let name = self.program.names.get(&id).cloned().unwrap_or("taken".into());
        self.program.append_symbol(Symbol { name, argument: Argument::LiveOut, index })
    }

    /// Decides where each slot of the result is written: in a loop if the indices of its slots form an arithmetic progression, otherwise
    /// outside.
    pub(super) fn return_rows_from_loops(&mut self, function: &Function) {
        let mut rows: FxHashMap<(usize, ExprId), Vec<(usize, usize)>> = FxHashMap::default();
        if matches!(
            function.shape,
            Shape::Vector(_) | Shape::Factors(_) | Shape::Columns { .. } | Shape::Tangent { .. } | Shape::Rows { .. }
        ) {
            for (slot, value) in function.outputs.iter().enumerate() {
                if let Some(&(of, template, iteration)) = self.places.get(value) {
                    rows.entry((of, template)).or_default().push((iteration, slot));
                }
            }
        }
        let mut in_loops = vec![false; function.outputs.len()];
        let mut rows: Vec<_> = rows.into_iter().collect();
        rows.sort();
        for ((of, template), mut slots) in rows {
            slots.sort_unstable();
            let iterations = self.rerolled.loops[of].iterations;
            let complete = slots.iter().map(|(iteration, _)| *iteration).eq(0..iterations);
            // An index of a loop runs along one row.
            let in_a_row = match function.shape {
                Shape::Rows { n, .. } => slots.iter().all(|(_, slot)| slot / n == slots[0].1 / n),
                _ => true,
            };
            let places = progression(slots.iter().map(|(_, slot)| Some(*slot)));
            if let Some(places) = places.filter(|_| complete && in_a_row) {
                for (_, slot) in &slots {
                    in_loops[*slot] = true;
                }
                let value = self.rerolled.loops[of].body[&template];
                self.rerolled.loops[of].results.push((places, value));
            }
        }
        self.rerolled.outputs = function
            .outputs
            .iter()
            .zip(in_loops)
            .map(|(value, in_loop)| (!in_loop).then(|| self.straight(*value)))
            .collect();
        let moved = |visit: &Visit| visit.nodes.iter().filter_map(|id| self.moved.get(id)).copied().collect();
        let visits = function.trace.visits.iter();
        self.rerolled.visits = visits.map(|visit| Visit { nodes: moved(visit), ..visit.clone() }).collect();
    }
}

/// The common part of names: `omega_boom_1_x` and `omega_boom_2_x` become `omega_boom_x`.
fn common_name(names: &[Option<&String>]) -> Option<String> {
    let words: Vec<Vec<&str>> =
        names.iter().map(|name| name.map(|name| name.split('_').collect())).collect::<Option<_>>()?;
    let first = words.first()?;
    if words.iter().any(|other| other.len() != first.len()) {
        return None;
    }
    let common = (0..first.len()).filter(|i| words.iter().all(|other| other[*i] == first[*i])).map(|i| first[i]);
    let common: Vec<&str> = common.collect();
    (!common.is_empty()).then(|| common.join("_"))
}
