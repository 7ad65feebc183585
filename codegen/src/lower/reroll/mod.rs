//! Turns work that repeats from body to body into loops.
//!
//! The sweeps of a recursion do the same at every rigid element of a flexible link. Consecutive visits of one sweep with
//! identical operations become a loop over the operations of the first. [`Source`] describes how its operands from outside
//! differ from iteration to iteration; values needed outside of the loop are saved, iteration by iteration.

mod write;

use rustc_hash::FxHashMap;

use super::loops::{Loop, Progression, Rerolled, Source};
use super::matching::{Match, matched};
use super::{Angle, Constants, StumpffArgument, order};
use crate::program::{Argument, Function, Program};
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
    template: Vec<ExprId>,
    /// The loop under construction: its iterations and what their operands require.
    making: Loop,
    /// Sources of operands, by their expressions in each iteration.
    sources: FxHashMap<Vec<ExprId>, Operands>,
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
        places: FxHashMap::default(),
        moved: FxHashMap::default(),
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
    rerolling.return_rows_from_loops(function);
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
    places: FxHashMap<ExprId, (usize, ExprId, usize)>,
    /// Expressions outside of loops in terms of the values that loops leave.
    moved: FxHashMap<ExprId, ExprId>,
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
        let mut template: Vec<ExprId> = matches[0].nodes.keys().copied().collect();
        template.sort();
        let mut plan =
            Plan { template, making: Loop { iterations: matches.len(), ..Loop::default() }, ..Plan::default() };
        for &id in &plan.template {
            for (operand, _) in self.program.op(id).operands().enumerate() {
                if matches[0].outside.contains_key(&(id, operand)) {
                    let operands: Vec<ExprId> = matches.iter().map(|m| m.outside[&(id, operand)]).collect();
                    if !plan.sources.contains_key(&operands) {
                        let source = self.source(&operands, matches, &mut plan.making)?;
                        plan.sources.insert(operands.clone(), source);
                    }
                    plan.sites.push(((id, operand), operands));
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
                    | Argument::DrivePositions
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
            let argument_of =
                |id: &ExprId| self.stumpff.iter().position(|known| known.values[usize::from(k)] == Some(*id));
            if let Some(places) = progression(operands.iter().map(argument_of)) {
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
        places.map(|number| number.and_then(|number| isize::try_from(number).ok())).collect::<Option<_>>()?;
    let (first, step) = (*places.first()?, places.get(1)? - places[0]);
    let fits = places.windows(2).all(|pair| pair[1] - pair[0] == step);
    fits.then_some(Progression { first: usize::try_from(first).ok()?, step })
}
