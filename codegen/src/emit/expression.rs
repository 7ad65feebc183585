//! Expressions of statements: variables, numbers, constants and operations.

use syn::{Expr, parse_quote};

use super::arguments::argument_name;
use super::arithmetic::{call, difference, element, field, method, negative, product, quotient, sum, variable};
use super::names::{Names, field_name};
use super::number::Number;
use super::writer::{RustWriter, Used};
use crate::program::Argument;
use crate::symbolic::{ExprId, Op};

impl RustWriter<'_> {
    /// An argument of a statement: a variable, a number, a constant, or an inlined operation.
    pub(super) fn expression(&self, id: ExprId, names: &mut Names, used: &mut Used) -> Expr {
        let program = &self.lowered.program;
        if self.lowered.constants.is_stored(id) {
            used.insert(Argument::Parameters);
            return field(variable("c"), &self.labels.constant(id));
        }
        match program.op(id) {
            Op::Constant(c) => self.number.literal(c.value()),
            Op::Symbol(symbol) if program.symbol(symbol).argument == Argument::Parameters => {
                used.insert(Argument::Parameters);
                field(field(variable("c"), "params"), &field_name(&program.symbol(symbol).name))
            }
            _ if self.code.inlined[id.index()] => self.operation(id, names, used),
            _ => variable(&names.name(id)),
        }
    }

    /// An operation on its arguments. Recursion ends within the bound of one statement.
    pub(super) fn operation(&self, id: ExprId, names: &mut Names, used: &mut Used) -> Expr {
        if let Some(product) = self.code.fused[id.index()] {
            return self.fused(id, product, names, used);
        }
        operation(self.lowered.program.op(id), self.number, &mut |operand| self.expression(operand, names, used))
    }

    /// A sum or difference with a product in it: `fma(a, b, c)`.
    fn fused(&self, id: ExprId, product: ExprId, names: &mut Names, used: &mut Used) -> Expr {
        let program = &self.lowered.program;
        let Op::Mul(a, b) = program.op(product) else { unreachable!("only products are fused") };
        let mut of = |operand: ExprId| self.expression(operand, names, used);
        let (a, b) = (of(a), of(b));
        let [a, b, c] = match program.op(id) {
            Op::Add(x, y) => [a, b, of(if x == product { y } else { x })],
            Op::Sub(x, y) if x == product => [a, b, negative(of(y))],
            Op::Sub(x, _) => [negative(a), b, of(x)],
            _ => unreachable!("only sums and differences take a product"),
        };
        call("fma", [a, b, c])
    }

    pub(super) fn input(&self, id: ExprId, used: &mut Used) -> Expr {
        let Op::Symbol(symbol) = self.lowered.program.op(id) else { unreachable!("inputs are symbols") };
        let symbol = self.lowered.program.symbol(symbol);
        match symbol.argument {
            Argument::LoopVarying => return self.source(symbol.index, used),
            Argument::LiveOut => return self.live_out(symbol.index),
            _ => used.insert(symbol.argument),
        };
        match symbol.argument {
            Argument::Time => variable("t"),
            Argument::BaseAddedInertia => {
                let columns = field(field(variable("base"), "data"), "0");
                element(element(columns, symbol.index / 6), symbol.index % 6)
            }
            Argument::Parameters => unreachable!("parameters are read where they are used"),
            vector => element(self.argument(vector, used), symbol.index),
        }
    }

    /// An argument by its name.
    pub(super) fn argument(&self, argument: Argument, used: &mut Used) -> Expr {
        used.insert(argument);
        variable(argument_name(argument, self.number).0)
    }
}

/// An operation as Rust.
pub fn operation(op: Op, number: Number, of: &mut dyn FnMut(ExprId) -> Expr) -> Expr {
    match op {
        Op::Neg(a) => negative(of(a)),
        Op::Add(a, b) => sum(of(a), of(b)),
        Op::Sub(a, b) => difference(of(a), of(b)),
        Op::Mul(a, b) => product(of(a), of(b)),
        Op::Div(a, b) => quotient(of(a), of(b)),
        Op::Min(a, b) => extreme("min", of(a), of(b)),
        Op::Max(a, b) => extreme("max", of(a), of(b)),
        Op::Sqrt(a) => call("sqrt", [of(a)]),
        Op::Exp(a) => call("exp", [of(a)]),
        Op::Select(a, b, c) => {
            let (a, b) = (of(a), of(b));
            call("select", [a, b, of(c)])
        }
        Op::Sin(a) => field_of_pair(&of(a), 0),
        Op::Cos(a) => field_of_pair(&of(a), 1),
        Op::Stumpff(k, a) => {
            let argument = of(a);
            element(element(call("stumpff", [parse_quote!([#argument])]), usize::from(k)), 0)
        }
        Op::Constant(c) => number.literal(c.value()),
        Op::Symbol(_) => unreachable!("inputs are read, not computed"),
    }
}

/// `a.min(b)` or `a.max(b)`, with a literal as the argument: it has no type as the receiver.
fn extreme(name: &str, a: Expr, b: Expr) -> Expr {
    if matches!(a, Expr::Lit(_)) { method(b, name, a) } else { method(a, name, b) }
}

/// `sin_cos([angle]).0[0]`
fn field_of_pair(angle: &Expr, index: u32) -> Expr {
    let angles: Expr = parse_quote!([#angle]);
    element(field(call("sin_cos", [angles]), &index.to_string()), 0)
}
