//! Order of statements: all angles first, then depth first from each output, so that a value stands near its use.

use super::{Angle, Constants, Statement, variables_of};
use crate::symbolic::{ExprId, Function, Op, Program};

/// One straight line for a function.
pub(super) fn order(program: &Program, constants: &Constants, inlined: &[bool], function: &Function) -> Vec<Statement> {
    let mut line =
        Line { program, constants, inlined, done: vec![false; program.operations.len()], statements: vec![] };
    let needed = needed_here(program, constants, &function.outputs);
    line.angles(&needed);
    for (slot, &value) in function.outputs.iter().enumerate() {
        if program.op(value) != Op::ZERO {
            line.compute_variables(value);
            line.statements.push(Statement::Output { slot, value });
        }
    }
    line.statements
}

/// What the function itself computes or reads: not what stored constants are made of.
fn needed_here(program: &Program, constants: &Constants, roots: &[ExprId]) -> Vec<bool> {
    let mut needed = vec![false; program.operations.len()];
    let mut stack = roots.to_vec();
    while let Some(id) = stack.pop() {
        if !constants.is_free(program, id) && !std::mem::replace(&mut needed[id.index()], true) {
            stack.extend(program.op(id).operands());
        }
    }
    needed
}

struct Line<'a> {
    program: &'a Program,
    constants: &'a Constants,
    inlined: &'a [bool],
    done: Vec<bool>,
    statements: Vec<Statement>,
}

impl Line<'_> {
    /// Sines and cosines of all angles, in one pass. No angle is made of another's sine.
    fn angles(&mut self, needed: &[bool]) {
        let find = |op: Op| self.program.find(op).filter(|id| needed[id.index()]);
        let mut angles: Vec<Angle> = Vec::new();
        for id in self.program.ids().filter(|id| needed[id.index()]) {
            if let Op::Sin(angle) | Op::Cos(angle) = self.program.op(id)
                && !angles.iter().any(|known| known.angle == angle)
            {
                angles.push(Angle { angle, sin: find(Op::Sin(angle)), cos: find(Op::Cos(angle)) });
            }
        }
        for known in &angles {
            self.compute_variables(known.angle);
        }
        for id in angles.iter().flat_map(|known| [known.sin, known.cos]).flatten() {
            self.done[id.index()] = true;
        }
        if !angles.is_empty() {
            self.statements.push(Statement::SinCos(angles));
        }
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
            if matches!(self.program.op(id), Op::Symbol(_)) {
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
