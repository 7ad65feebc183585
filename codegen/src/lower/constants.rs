//! Values that depend only on live parameters: computed once when a parameter is set, and read like inputs.

use crate::program::{Argument, Program};

use crate::symbolic::{ExprId, Op};

/// The constants of a program's live parameters.
#[derive(Debug)]
pub struct Constants {
    /// The values that functions read, in order of construction.
    pub stored: Vec<ExprId>,
    is_stored: Vec<bool>,
    /// Whether a node depends on at least one parameter, and only on parameters.
    is_constant: Vec<bool>,
}

impl Constants {
    /// The constants that the functions of a program read.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        let is_constant = parameters_alone(program);
        let mut is_stored = vec![false; program.operations.len()];
        let needed = program.needed(program.functions.iter().flat_map(|f| f.outputs.iter().copied()));
        let mut store = |id: ExprId| {
            is_stored[id.index()] |= is_constant[id.index()] && !program.op(id).is_leaf();
        };
        for (index, op) in program.operations.iter().enumerate() {
            if needed[index] && !is_constant[index] {
                op.operands().for_each(&mut store);
            }
        }
        program.functions.iter().flat_map(|f| f.outputs.iter().copied()).for_each(store);
        let stored = program.ids().filter(|id| is_stored[id.index()]).collect();
        Constants { stored, is_stored, is_constant }
    }

    /// Whether functions read this value instead of computing it.
    #[must_use]
    pub fn is_stored(&self, id: ExprId) -> bool {
        // Expressions added by loops come after these.
        self.is_stored.get(id.index()).is_some_and(|stored| *stored)
    }

    /// Whether the value needs no variable: a number, a live parameter or a stored constant.
    #[must_use]
    pub fn is_free(&self, program: &Program, id: ExprId) -> bool {
        self.is_stored(id)
            || match program.op(id) {
                Op::Constant(_) => true,
                Op::Symbol(symbol) => program.symbol(symbol).argument == Argument::Parameters,
                _ => false,
            }
    }

    /// Whether any of `roots` reads parameters or stored constants.
    pub(super) fn read_by(&self, program: &Program, roots: &[ExprId]) -> bool {
        let needed = program.needed(roots.iter().copied());
        program.ids().any(|id| needed[id.index()] && self.is_constant[id.index()])
    }
}

/// For every node, whether it depends only on parameters and numbers.
fn parameters_alone(program: &Program) -> Vec<bool> {
    // Numbers combine with anything, but alone do not make a constant that depends on a parameter.
    #[derive(Clone, Copy, PartialEq, PartialOrd)]
    enum Depends {
        Number,
        Parameter,
        State,
    }
    let mut depends: Vec<Depends> = Vec::with_capacity(program.operations.len());
    for op in &program.operations {
        let of_op = match op {
            Op::Symbol(id) if program.symbol(*id).argument == Argument::Parameters => Depends::Parameter,
            Op::Symbol(_) => Depends::State,
            _ => Depends::Number,
        };
        let all = op.operands().map(|id| depends[id.index()]).fold(of_op, |a, b| if b > a { b } else { a });
        depends.push(all);
    }
    depends.iter().map(|d| *d == Depends::Parameter).collect()
}
