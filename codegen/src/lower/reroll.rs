//! Turns work that repeats from body to body into loops.
//!
//! The sweeps of a recursion do the same at every rigid element of a flexible link. Consecutive visits of one sweep with
//! identical operations become a loop over the operations of the first. [`Source`] describes how its operands from outside
//! differ from iteration to iteration; values needed outside of the loop are saved, iteration by iteration.

use std::collections::HashMap;

use super::loops::{LiveOut, Loop, Progression, Rerolled, Source};
use super::matching::{Match, matched};
use super::{Angle, Constants, StumpffArgument, SweepPosition, order};
use crate::program::{Argument, Function, Program, Shape, Symbol};
use crate::symbolic::{ExprId, Op, Visit};

/// The source of one operand in all iterations.
#[derive(Clone, Debug)]
enum Operands {
    /// The same operand in every iteration.
    Invariant,
    /// From this source.
    From(Source),
    /// Values of another loop, which can save them.
    Saved { of: usize, template: ExprId, iteration: Progression },
}

/// A loop before it is written out.
#[derive(Debug, Default)]
struct Plan {
    /// The expressions of the first visit, operands before their users.
    own: Vec<ExprId>,
    /// The loop under construction: its iterations and what their operands require.
    making: Loop,
    /// Sources of operands, by their expressions in each iteration.
    sources: HashMap<Vec<ExprId>, Operands>,
    /// Operands from outside, by the expression that uses them and their index.
    sites: Vec<((ExprId, usize), Vec<ExprId>)>,
}

/// Loops with at least `least` iterations, if the function has any.
pub(super) fn reroll(
    program: &mut Program,
    constants: &Constants,
    function: &Function,
    least: usize,
) -> Option<Rerolled> {
    let needed = order::needed_here(program, constants, &function.outputs);
    let rank = ranks(program, function, &needed);
    let angles = order::angles(program, &needed);
    let stumpff = order::stumpff_arguments(program, &needed);
    let mut rerolling = Rerolling {
        program,
        constants,
        rank,
        angles,
        stumpff,
        places: HashMap::new(),
        moved: HashMap::new(),
        rerolled: Rerolled::default(),
    };
    let visits = &function.trace.visits;
    let mut start = 0;
    while start < visits.len() {
        let matches = rerolling.run(visits, start);
        // The last iteration may force values to be gathered, because another loop has one iteration fewer.
        let shorter = matches.split_last().map_or(&[][..], |(_, rest)| rest);
        let later = if shorter.len() >= least { rerolling.run(visits, start + 1) } else { vec![] };
        let candidates = [(0, &matches[..]), (0, shorter), (1, &later)];
        let plans = candidates.into_iter().filter(|(_, iterations)| iterations.len() >= least).filter_map(
            |(skip, iterations)| {
                let plan = rerolling.plan(iterations)?;
                Some((plan.making.gathered.len(), skip, iterations, plan))
            },
        );
        let best =
            plans.min_by_key(|(gathered, skip, iterations, _)| (*gathered, *skip, std::cmp::Reverse(iterations.len())));
        start += match best {
            Some((_, skip, iterations, plan)) => {
                rerolling.write(plan, &visits[start + skip..][..iterations.len()], iterations);
                skip + iterations.len()
            }
            None => 1,
        };
    }
    if rerolling.rerolled.loops.is_empty() {
        return None;
    }
    rerolling.hand_over(function);
    Some(rerolling.rerolled)
}

/// The visit in which each expression is computed: the first that requests or needs it.
fn ranks(program: &Program, function: &Function, needed: &[bool]) -> Vec<usize> {
    let mut rank = vec![usize::MAX; needed.len()];
    for (visit, id) in function.trace.visits.iter().enumerate().flat_map(|(i, v)| v.nodes.iter().map(move |id| (i, id)))
    {
        rank[id.index()] = rank[id.index()].min(visit);
    }
    for index in (0..needed.len()).rev() {
        let op = program.operations[index];
        if !needed[index] || op.is_leaf() || op.is_elementary() {
            // Inputs, and functions of angles and arguments, are available before every visit.
            rank[index] = usize::MAX;
            continue;
        }
        for operand in op.operands() {
            rank[operand.index()] = rank[operand.index()].min(rank[index]);
        }
    }
    rank
}

/// Loops under construction.
struct Rerolling<'a> {
    program: &'a mut Program,
    constants: &'a Constants,
    rank: Vec<usize>,
    angles: Vec<Angle>,
    stumpff: Vec<StumpffArgument>,
    /// Expressions that loops compute: the loop, the expression of its first visit, and the iteration.
    places: HashMap<ExprId, (usize, ExprId, usize)>,
    /// Expressions outside of loops in terms of the values that loops leave.
    moved: HashMap<ExprId, ExprId>,
    rerolled: Rerolled,
}

impl Rerolling<'_> {
    /// The expressions that a visit requests and that no earlier visit requests or needs.
    fn anchors(&self, visit: &Visit, at: usize) -> Vec<ExprId> {
        visit.nodes.iter().copied().filter(|id| self.rank[id.index()] == at).collect()
    }

    /// The consecutive visits with the same operations, from `start` on.
    fn run(&self, visits: &[Visit], start: usize) -> Vec<Match> {
        let Some(visit) = visits.get(start) else { return vec![] };
        let first = self.anchors(visit, start);
        if first.is_empty() {
            return vec![];
        }
        let others = visits.iter().enumerate().skip(start).take_while(|(_, other)| other.sweep == visit.sweep);
        let iterations = others.map_while(|(at, other)| {
            matched(self.program, &self.rank, (start, &first), (at, &self.anchors(other, at)))
        });
        iterations.collect()
    }

    /// The loop of these iterations, if all its operands from outside have a source.
    fn plan(&self, matches: &[Match]) -> Option<Plan> {
        let mut own: Vec<ExprId> = matches[0].nodes.keys().copied().collect();
        own.sort();
        let mut plan = Plan { own, making: Loop { iterations: matches.len(), ..Loop::default() }, ..Plan::default() };
        for &id in &plan.own {
            for (place, _) in self.program.op(id).operands().enumerate() {
                if matches[0].outside.contains_key(&(id, place)) {
                    let operands: Vec<ExprId> = matches.iter().map(|m| m.outside[&(id, place)]).collect();
                    if !plan.sources.contains_key(&operands) {
                        let source = self.source(&operands, matches, &mut plan.making)?;
                        plan.sources.insert(operands.clone(), source);
                    }
                    plan.sites.push(((id, place), operands));
                }
            }
        }
        Some(plan)
    }

    /// Where one operand comes from in each iteration, if there is a source; adds to `making` what the source requires.
    fn source(&self, operands: &[ExprId], matches: &[Match], making: &mut Loop) -> Option<Operands> {
        let program = &*self.program;
        let first = operands[0];
        if operands.iter().all(|id| *id == first) {
            return Some(Operands::Invariant);
        }
        let ops: Vec<Op> = operands.iter().map(|id| program.op(*id)).collect();
        if let Some(numbers) = ops.iter().map(|op| number(*op)).collect::<Option<Vec<f64>>>() {
            making.numbers.push(numbers);
            return Some(Operands::From(Source::Number(making.numbers.len() - 1)));
        }
        if let Op::Symbol(symbol) = ops[0] {
            let argument = program.symbol(symbol).argument;
            let index = |op: &Op| match op {
                Op::Symbol(id) if program.symbol(*id).argument == argument => Some(program.symbol(*id).index),
                _ => None,
            };
            let in_order = matches!(
                argument,
                Argument::Position
                    | Argument::Velocity
                    | Argument::Acceleration
                    | Argument::RightHandSide
                    | Argument::AddedInertia
                    | Argument::Factors
            );
            if let Some(places) = progression(ops.iter().map(index)).filter(|_| in_order) {
                return Some(Operands::From(Source::Input(argument, places)));
            }
        }
        let angle = |of: fn(&Angle) -> Option<ExprId>| {
            progression(operands.iter().map(|id| self.angles.iter().position(|angle| of(angle) == Some(*id))))
        };
        if let Some(places) = angle(|angle| angle.sin) {
            return Some(Operands::From(Source::Sine(places)));
        }
        if let Some(places) = angle(|angle| angle.cos) {
            return Some(Operands::From(Source::Cosine(places)));
        }
        if let Op::Stumpff(k, _) = ops[0] {
            let place = |id: &ExprId| self.stumpff.iter().position(|known| known.values[usize::from(k)] == Some(*id));
            if let Some(places) = progression(operands.iter().map(place)) {
                return Some(Operands::From(Source::Stumpff(k, places)));
            }
        }
        // The same expression in the previous iteration; in the first iteration, any value from before the loop.
        let before = |k: usize| matches[k - 1].template_of(operands[k]);
        if let Some(next) = before(1)
            && (1..operands.len()).all(|k| before(k) == Some(next))
        {
            making.loop_carried.push((first, next));
            return Some(Operands::From(Source::LoopCarried(making.loop_carried.len() - 1)));
        }
        if let Some(&(of, template, _)) = self.places.get(&first) {
            let iteration = |id: &ExprId| {
                self.places.get(id).filter(|(l, t, _)| (*l, *t) == (of, template)).map(|(_, _, iteration)| *iteration)
            };
            if let Some(iteration) = progression(operands.iter().map(iteration)) {
                return Some(Operands::Saved { of, template, iteration });
            }
        }
        let is_within = |id: &ExprId| matches.iter().any(|m| m.template_of(*id).is_some());
        if operands.iter().any(is_within) {
            return None;
        }
        making.gathered.push(operands.to_vec());
        Some(Operands::From(Source::Gathered(making.gathered.len() - 1)))
    }

    /// Writes the loop's body as separate expressions.
    fn write(&mut self, Plan { own, mut making, sources, sites }: Plan, visits: &[Visit], matches: &[Match]) {
        making.ends = [&visits[0], &visits[visits.len() - 1]].map(SweepPosition::from);
        let number = self.rerolled.loops.len();
        let mut symbols: HashMap<&[ExprId], ExprId> = HashMap::new();
        let mut outside: HashMap<(ExprId, usize), ExprId> = HashMap::new();
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
        for id in own {
            let mut place = 0..;
            let op = self.program.op(id).map(|operand| {
                let site = (id, place.next().unwrap_or_default());
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
            #[expect(clippy::iter_over_hash_type, reason = "each goes to a place of its own, in any order")]
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
            Some(place) => LiveOut::LoopCarried { of, place },
            None => LiveOut::Saved { of, slot: self.save(of, template), iteration },
        };
        let index = self.rerolled.live_outs.len();
        self.rerolled.live_outs.push(live_out);
        let name = self.program.names.get(&id).cloned().unwrap_or("taken".into());
        self.program.append_symbol(Symbol { name, argument: Argument::LiveOut, index })
    }

    /// Decides where each slot of the result is written: in a loop if the indices of its slots form an arithmetic progression, otherwise
    /// outside.
    fn hand_over(&mut self, function: &Function) {
        let mut rows: HashMap<(usize, ExprId), Vec<(usize, usize)>> = HashMap::new();
        if matches!(function.shape, Shape::Vector(_) | Shape::Factors(_) | Shape::Columns { .. }) {
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
            if let Some(places) = progression(slots.iter().map(|(_, slot)| Some(*slot))).filter(|_| complete) {
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

fn number(op: Op) -> Option<f64> {
    match op {
        Op::Constant(c) => Some(c.value()),
        _ => None,
    }
}

/// The arithmetic progression that the indices form, if they do and there are at least two.
fn progression(places: impl Iterator<Item = Option<usize>>) -> Option<Progression> {
    let places: Vec<isize> =
        places.map(|place| place.and_then(|place| isize::try_from(place).ok())).collect::<Option<_>>()?;
    let (first, step) = (*places.first()?, places.get(1)? - places[0]);
    let fits = places.windows(2).all(|pair| pair[1] - pair[0] == step);
    fits.then_some(Progression { first: usize::try_from(first).ok()?, step })
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
