//! Order of statements: all angles and all arguments of Stumpff's functions first; then what sweeps derive, as they do, body by body, each result written as soon
//! as it is known; the rest depth first from each output, so that a value stands near its use.
//!
//! In the order of its sweeps, where what does not depend on each other stands side by side, forward dynamics takes
//! 0.26 µs at 13 coordinates against 0.28 depth first, the bias 0.12 against 0.15. Within a loop, where rounds overlap
//! anyway, depth first is faster: 1.74 µs against 1.89 at 103.

use std::collections::HashMap;

use super::{Angle, Constants, Rolled, Source, Statement, StumpffArgument, Taking, variables_of};
use crate::program::{Argument, Function, Program};
use crate::symbolic::{ExprId, Op, Visit};

/// One straight line for a function, its loops in it as statements.
pub(super) fn order(
    program: &Program,
    constants: &Constants,
    inlined: &[bool],
    function: &Function,
    rolled: &Rolled,
) -> Vec<Statement> {
    let mut line = Line {
        program,
        constants,
        inlined,
        rolled,
        needed: needed_here(program, constants, &rolled.roots()),
        unwritten: slots(program, rolled),
        done: vec![false; program.operations.len()],
        run: vec![false; rolled.loops.len()],
        statements: vec![],
    };
    line.angles(&function.outputs);
    line.stumpff(&function.outputs);
    line.follow(&rolled.visits);
    for (slot, value) in rolled.outputs.iter().enumerate() {
        if let Some(value) = value.filter(|value| line.unwritten.contains_key(value)) {
            line.write(value, &[slot]);
        }
    }
    (0..rolled.loops.len()).for_each(|of| line.run(of));
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
    let mut places: HashMap<ExprId, usize> = HashMap::new();
    let mut arguments: Vec<StumpffArgument> = Vec::new();
    for id in program.ids().take(needed.len()).filter(|id| needed[id.index()]) {
        if let Op::Stumpff(k, argument) = program.op(id) {
            let place = *places.entry(argument).or_insert_with(|| {
                arguments.push(StumpffArgument { argument, values: [None; Op::STUMPFF_ORDERS] });
                arguments.len() - 1
            });
            arguments[place].values[usize::from(k)] = Some(id);
        }
    }
    arguments
}

/// What the function itself computes or reads: not what stored constants are made of.
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

/// The slots that values are written to outside of loops; what is zero is there already.
fn slots(program: &Program, rolled: &Rolled) -> HashMap<ExprId, Vec<usize>> {
    let mut slots: HashMap<ExprId, Vec<usize>> = HashMap::new();
    for (slot, value) in rolled.outputs.iter().enumerate() {
        if let Some(value) = value.filter(|value| program.op(*value) != Op::ZERO) {
            slots.entry(value).or_default().push(slot);
        }
    }
    slots
}

struct Line<'a> {
    program: &'a Program,
    constants: &'a Constants,
    inlined: &'a [bool],
    rolled: &'a Rolled,
    needed: Vec<bool>,
    /// Slots of the result that wait for a value that sweeps may know.
    unwritten: HashMap<ExprId, Vec<usize>>,
    done: Vec<bool>,
    /// Which loops are written.
    run: Vec<bool>,
    statements: Vec<Statement>,
}

impl Line<'_> {
    /// Sines and cosines of all angles, in one pass. No angle is made of another's sine.
    fn angles(&mut self, outputs: &[ExprId]) {
        let mut angles = angles(self.program, &needed_here(self.program, self.constants, outputs));
        for known in &angles {
            self.compute_variables(known.angle);
        }
        for id in angles.iter().flat_map(|known| [known.sin, known.cos]).flatten() {
            self.done[id.index()] = true;
        }
        // Loops take theirs by place.
        let outside = needed_here(self.program, self.constants, &self.rolled.roots());
        let named = |id: &ExprId| self.rolled.loops.is_empty() || outside[id.index()];
        for known in &mut angles {
            (known.sin, known.cos) = (known.sin.filter(named), known.cos.filter(named));
        }
        if !angles.is_empty() {
            self.statements.push(Statement::SinCos(angles));
        }
    }

    /// Stumpff's functions of all arguments, in one pass. No argument is made of another's function.
    fn stumpff(&mut self, outputs: &[ExprId]) {
        let mut arguments = stumpff_arguments(self.program, &needed_here(self.program, self.constants, outputs));
        for known in &arguments {
            self.compute_variables(known.argument);
        }
        for id in arguments.iter().flat_map(|known| known.values).flatten() {
            self.done[id.index()] = true;
        }
        // Loops take theirs by place.
        let outside = needed_here(self.program, self.constants, &self.rolled.roots());
        let named = |id: &ExprId| self.rolled.loops.is_empty() || outside[id.index()];
        for known in &mut arguments {
            known.values = known.values.map(|value| value.filter(named));
        }
        if !arguments.is_empty() {
            self.statements.push(Statement::Stumpff(arguments));
        }
    }

    /// The statement of a loop, after everything it takes from outside.
    fn run(&mut self, of: usize) {
        if std::mem::replace(&mut self.run[of], true) {
            return;
        }
        let rolled = self.rolled;
        for (_, source) in rolled.sources.iter().filter(|(user, _)| *user == of) {
            if let Source::Kept { of, .. } = source {
                self.run(*of);
            }
        }
        let own = &rolled.loops[of];
        let initial = own.carried.iter().map(|(initial, _)| initial);
        for value in initial.chain(own.gathered.iter().flatten()).chain(&own.same) {
            self.compute_variables(*value);
        }
        let before = std::mem::take(&mut self.statements);
        own.roots().into_iter().for_each(|value| self.compute_variables(value));
        let body = std::mem::replace(&mut self.statements, before);
        self.statements.push(Statement::Loop { of, body });
    }

    /// Computes what is needed of what sweeps asked for, in their order, and writes what is a result at once.
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
            // A loop says itself where it is.
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

    /// What has to stand in variables before `id` can be an argument.
    fn compute_variables(&mut self, id: ExprId) {
        if self.inlined[id.index()] {
            for variable in variables_of(self.program, self.constants, self.inlined, id) {
                self.compute(variable);
            }
        } else {
            self.compute(id);
        }
    }

    /// Statements for `root` and everything it needs that is not there yet, operands first.
    fn compute(&mut self, root: ExprId) {
        let mut stack = vec![(root, false)];
        while let Some((id, ready)) = stack.pop() {
            if self.done[id.index()] || self.constants.is_free(self.program, id) {
                continue;
            }
            if let Op::Symbol(symbol) = self.program.op(id) {
                let symbol = self.program.symbol(symbol);
                if symbol.argument == Argument::Loop {
                    let (Taking::Carried { of, .. } | Taking::Kept { of, .. }) = self.rolled.takings[symbol.index];
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
