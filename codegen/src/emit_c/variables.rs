//! The numbers that results are differentiated by, as a struct.

use std::fmt::Write;

use super::function::CWriter;
use super::words::field;
use crate::chain::Input;
use crate::program::{Argument, Product, Program, Symbol};
use crate::symbolic::SymbolId;

/// The numbers by which [`emit_c`](super::emit_c) takes products of a program, in their order: of an input its value, without its rate.
#[must_use]
pub fn variables(program: &Program) -> Vec<SymbolId> {
    let is_value = |symbol: &Symbol| symbol.argument != Argument::Inputs || symbol.index.is_multiple_of(Input::SLOTS);
    program.differentiated_by().filter(|id| is_value(program.symbol(*id))).collect()
}

impl CWriter<'_> {
    /// The fields of the [`variables`], in their order.
    pub fn fields(&self) -> Vec<String> {
        let program = &self.lowered.program;
        let of = |id: SymbolId| {
            let Symbol { name, argument, index } = program.symbol(id);
            match argument {
                Argument::Time => "t".to_owned(),
                Argument::Position => format!("q[{index}]"),
                Argument::Velocity => format!("v[{index}]"),
                Argument::Acceleration => format!("a[{index}]"),
                Argument::Parameters => format!("params.{}", field(name)),
                _ => format!("inputs[{}]", index / Input::SLOTS),
            }
        };
        variables(program).into_iter().map(of).collect()
    }

    /// The struct; empty if no function is a product.
    pub fn variables(&self) -> String {
        if self.lowered.functions.iter().all(|code| code.function.product.is_none()) {
            return String::new();
        }
        let (chain, number) = (self.chain, self.precision.name());
        let n = format!("{}_N", chain.name.to_uppercase());
        let [vjp, jvp] = Product::ALL.map(Product::suffix);
        let mut text = format!(
            "/* All that functions depend on: derivatives, as functions with the ending {vjp} return them, and changes, as functions\n   \
             with the ending {jvp} take them. */\ntypedef struct {{\n    {number} t;\n"
        );
        for vector in ["q", "v", "a"] {
            let _ = writeln!(text, "    {number} {vector}[{n}];");
        }
        if !chain.parameters.is_empty() {
            let _ = writeln!(text, "    {} params;", self.name("params"));
        }
        if !chain.inputs.is_empty() {
            let _ = writeln!(text, "    {number} inputs[{}]; /* values */", chain.inputs.len());
        }
        format!("{text}}} {};\n\n", self.name("variables"))
    }
}
