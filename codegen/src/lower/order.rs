//! Order of statements: first all angles and all arguments of Stumpff's functions; then the values of the sweeps in the order
//! of their derivation, body by body, each result written as soon as it is known; the rest depth first from each output, so
//! that a value is computed near its use.
//!
//! In the order of the sweeps, independent operations are close together: at 13 coordinates forward dynamics takes 0.26 µs
//! instead of 0.28 in depth-first order, and the bias 0.12 instead of 0.15. Within a loop, where iterations overlap anyway,
//! depth-first order is faster: 1.74 µs instead of 1.89 at 103 coordinates.

use rustc_hash::FxHashMap;

use super::{Angle, Constants, LiveOut, Rerolled, Source, Statement, StumpffArgument, variables_of};
use crate::program::{Argument, Function, Program};
use crate::symbolic::{ExprId, Op, Visit};

/// The straight-line code of a function, with its loops as statements.
pub(super) fn order(
    program: &Program,
    constants: &Constants,
    inlined: &[bool],
    function: &Function,
    rerolled: &Rerolled,
) -> Vec<Statement> {
    let mut line = OrderedStatements {
        program,
        constants,
        inlined,
        rerolled,
        needed: needed_here(program, constants, &rerolled.roots()),
        unwritten: slots(program, rerolled),
        done: vec![false; program.operations.len()],
        run: vec![false; rerolled.loops.len()],
        statements: vec![],
    };
    line.angles(&function.outputs);
    line.stumpff(&function.outputs);
    line.follow(&rerolled.visits);
    for (slot, value) in rerolled.outputs.iter().enumerate() {
        if let Some(value) = value.filter(|value| line.unwritten.contains_key(value)) {
            line.write(value, &[slot]);
        }
    }
    (0..rerolled.loops.len()).for_each(|of| line.run(of));
    line.statements
}

/// All angles whose sines or cosines are needed, in order of construction.
pub(super) fn angles(program: &Program, needed: &[bool]) -> Vec<Angle> {
    let find = |op: Op| program.find(op).filter(|id| needed[id.index()]);
    let mut angles: Vec<Angle> = Vec::new();
    for id in program.ids().take(needed.len()).filter(|id| needed[id.index()]) {
        if let Op::Sin(angle) | Op::Cos(angle) = program.op(id)
            && !angles.iter().any(|known| known.angle == angle)
        {
            angles.push(Angle { angle, sin: find(Op::Sin(angle)), cos: find(Op::Cos(angle)) });
        }
    }
    angles
}

/// All arguments of Stumpff's functions that are needed, in order of construction.
pub(super) fn stumpff_arguments(program: &Program, needed: &[bool]) -> Vec<StumpffArgument> {
    let mut slots: FxHashMap<ExprId, usize> = FxHashMap::default();
    let mut arguments: Vec<StumpffArgument> = Vec::new();
    for id in program.ids().take(needed.len()).filter(|id| needed[id.index()]) {
        if let Op::Stumpff(k, argument) = program.op(id) {
            let slot = *slots.entry(argument).or_insert_with(|| {
                arguments.push(StumpffArgument { argument, values: [None; Op::STUMPFF_ORDERS] });
                arguments.len() - 1
            });
            arguments[slot].values[usize::from(k)] = Some(id);
        }
    }
    arguments
}

/// The nodes that the function itself computes or reads, without those from which stored constants are computed.
pub(super) fn needed_here(program: &Program, constants: &Constants, roots: &[ExprId]) -> Vec<bool> {
    let mut needed = vec![false; program.operations.len()];
    let mut stack = roots.to_vec();
    while let Some(id) = stack.pop() {
        if !constants.is_free(program, id) && !std::mem::replace(&mut needed[id.index()], true) {
            stack.extend(program.op(id).operands());
        }
    }
    needed
}

/// The slots to which values are written outside of loops; zeros are already there.
fn slots(program: &Program, rerolled: &Rerolled) -> FxHashMap<ExprId, Vec<usize>> {
    let mut slots: FxHashMap<ExprId, Vec<usize>> = FxHashMap::default();
    for (slot, value) in rerolled.outputs.iter().enumerate() {
        if let Some(value) = value.filter(|value| program.op(*value) != Op::ZERO) {
            slots.entry(value).or_default().push(slot);
        }
    }
    slots
}

struct OrderedStatements<'a> {
    program: &'a Program,
    constants: &'a Constants,
    inlined: &'a [bool],
    rerolled: &'a Rerolled,
    needed: Vec<bool>,
    /// Slots of the result that have not been written yet, by value.
    unwritten: FxHashMap<ExprId, Vec<usize>>,
    done: Vec<bool>,
    /// The loops that have been written.
    run: Vec<bool>,
    statements: Vec<Statement>,
}

impl OrderedStatements<'_> {
    /// Sines and cosines of all angles, in one pass. No angle depends on the sine of another.
    fn angles(&mut self, outputs: &[ExprId]) {
        let mut angles = angles(self.program, &needed_here(self.program, self.constants, outputs));
        for known in &angles {
            self.compute_variables(known.angle);
        }
        for id in angles.iter().flat_map(|known| [known.sin, known.cos]).flatten() {
            self.done[id.index()] = true;
        }
        // Loops read sines and cosines by index.
        let outside = needed_here(self.program, self.constants, &self.rerolled.roots());
        let named = |id: &ExprId| self.rerolled.loops.is_empty() || outside[id.index()];
        for known in &mut angles {
            (known.sin, known.cos) = (known.sin.filter(named), known.cos.filter(named));
        }
        if !angles.is_empty() {
            self.statements.push(Statement::SinCos(angles));
        }
    }

    /// Stumpff's functions of all arguments, in one pass. No argument depends on a function of another.
    fn stumpff(&mut self, outputs: &[ExprId]) {
        let mut arguments = stumpff_arguments(self.program, &needed_here(self.program, self.constants, outputs));
        for known in &arguments {
            self.compute_variables(known.argument);
        }
        for id in arguments.iter().flat_map(|known| known.values).flatten() {
            self.done[id.index()] = true;
        }
        // Loops read the functions by index.
        let outside = needed_here(self.program, self.constants, &self.rerolled.roots());
        let named = |id: &ExprId| self.rerolled.loops.is_empty() || outside[id.index()];
        for known in &mut arguments {
            known.values = known.values.map(|value| value.filter(named));
        }
        if !arguments.is_empty() {
            self.statements.push(Statement::Stumpff(arguments));
        }
    }

    /// The statement of a loop, after everything that it needs from outside.
    fn run(&mut self, of: usize) {
        if std::mem::replace(&mut self.run[of], true) {
            return;
        }
        let rerolled = self.rerolled;
        for (_, source) in rerolled.sources.iter().filter(|(user, _)| *user == of) {
            if let Source::Saved { of, .. } = source {
                self.run(*of);
            }
        }
        let rolled = &rerolled.loops[of];
        let initial = rolled.loop_carried.iter().map(|(initial, _)| initial);
        for value in initial.chain(rolled.gathered.iter().flatten()).chain(&rolled.invariants) {
            self.compute_variables(*value);
        }
        let before = std::mem::take(&mut self.statements);
        rolled.roots().into_iter().for_each(|value| self.compute_variables(value));
        let body = std::mem::replace(&mut self.statements, before);
        self.statements.push(Statement::Loop { of, body });
    }

    /// Computes the needed expressions of the sweeps in their order, and writes results immediately.
    fn follow(&mut self, visits: &[Visit]) {
        for visit in visits {
            let before = self.statements.len();
            for id in &visit.nodes {
                if self.needed[id.index()] && !self.inlined[id.index()] {
                    self.compute(*id);
                }
                if let Some(slots) = self.unwritten.remove(id) {
                    self.write(*id, &slots);
                }
            }
            // A loop states its position itself.
            let begins = self.statements.get(before).is_some_and(|first| !matches!(first, Statement::Loop { .. }));
            if begins && !visit.body.is_empty() {
                self.statements.insert(before, Statement::At(Some(visit.into())));
            }
        }
        if !visits.is_empty() {
            self.statements.push(Statement::At(None));
        }
    }

    /// Writes a value to slots of the result.
    fn write(&mut self, value: ExprId, slots: &[usize]) {
        self.compute_variables(value);
        self.statements.extend(slots.iter().map(|&slot| Statement::Output { slot, value }));
    }

    /// The values that need variables before `id` can be an argument.
    fn compute_variables(&mut self, id: ExprId) {
        if self.inlined[id.index()] {
            for variable in variables_of(self.program, self.constants, self.inlined, id) {
                self.compute(variable);
            }
        } else {
            self.compute(id);
        }
    }

    /// Statements for `root` and everything it needs that has not been computed yet, operands first.
    fn compute(&mut self, root: ExprId) {
        let mut stack = vec![(root, false)];
        while let Some((id, ready)) = stack.pop() {
            if self.done[id.index()] || self.constants.is_free(self.program, id) {
                continue;
            }
            if let Op::Symbol(symbol) = self.program.op(id) {
                let symbol = self.program.symbol(symbol);
                if symbol.argument == Argument::LiveOut {
                    let (LiveOut::LoopCarried { of, .. } | LiveOut::Saved { of, .. }) =
                        self.rerolled.live_outs[symbol.index];
                    self.run(of);
                }
                self.done[id.index()] = true;
                self.statements.push(Statement::Input(id));
            } else if ready {
                self.done[id.index()] = true;
                self.statements.push(Statement::Let(id));
            } else {
                stack.push((id, true));
                let variables = variables_of(self.program, self.constants, self.inlined, id);
                stack.extend(variables.into_iter().rev().map(|variable| (variable, false)));
            }
        }
    }
}
