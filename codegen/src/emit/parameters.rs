//! Live parameters and the constants computed from them.

use quote::format_ident;
use syn::{Item, Stmt, parse_quote};

use super::arithmetic::{field, variable};
use super::expression::operation;
use super::labels::Labels;
use super::names::field_name;
use super::number::Number;
use super::print::plain;
use super::writer::local;
use crate::chain::{Chain, Parameter};
use crate::lower::LoweredProgram;
use crate::program::Argument;
use crate::symbolic::{ExprId, Op};

/// `Params` with defaults and units, and `Constants`, which functions read; nothing if all numbers are compiled in.
pub fn parameters(chain: &Chain, lowered: &LoweredProgram, labels: &Labels, number: Number) -> Vec<Item> {
    if chain.parameters.is_empty() {
        return vec![];
    }
    let names: Vec<_> = chain.parameters.iter().map(|p| format_ident!("{}", field_name(&p.name))).collect();
    let docs: Vec<String> = chain.parameters.iter().map(documentation).collect();
    let defaults = chain.parameters.iter().map(|p| number.literal(p.default));
    let stored: Vec<_> = lowered.constants.stored.iter().map(|id| format_ident!("{}", labels.constant(*id))).collect();
    let body = constants_body(lowered, labels, number);
    let number = number.type_tokens();
    vec![
        parse_quote! {
            #[doc = " Values that stay live at run time."]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Params {
                #(#[doc = #docs] pub #names: #number,)*
            }
        },
        parse_quote! {
            impl Default for Params {
                fn default() -> Self {
                    Params { #(#names: #defaults),* }
                }
            }
        },
        parse_quote! {
            #[doc = " Live parameters, and constants that depend only on them, computed once."]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Constants {
                params: Params,
                #(#stored: #number,)*
            }
        },
        parse_quote! {
            impl Constants {
                fn new(params: &Params) -> Self {
                    #(#body)*
                    Constants { params: *params, #(#stored),* }
                }
            }
        },
    ]
}

/// Description and unit of a parameter, if the user gave them.
fn documentation(parameter: &Parameter) -> String {
    let words = [&parameter.about, &parameter.unit].map(|text| plain(text));
    let texts: Vec<String> = words.into_iter().filter(|text| !text.is_empty()).collect();
    if texts.is_empty() { format!(" `{}`.", parameter.name) } else { format!(" {}.", texts.join(", ")) }
}

/// One `let` for each intermediate value of the stored constants.
fn constants_body(lowered: &LoweredProgram, labels: &Labels, number: Number) -> Vec<Stmt> {
    let program = &lowered.program;
    let needed = program.needed(lowered.constants.stored.iter().copied());
    let name = |id: ExprId| {
        if lowered.constants.is_stored(id) { labels.constant(id) } else { format!("t{:03}", id.index()) }
    };
    let argument = |id: ExprId| match program.op(id) {
        Op::Constant(c) => number.literal(c.value()),
        Op::Symbol(symbol) => {
            debug_assert_eq!(program.symbol(symbol).argument, Argument::Parameters);
            field(variable("params"), &field_name(&program.symbol(symbol).name))
        }
        _ => variable(&name(id)),
    };
    program
        .ids()
        .filter(|id| needed[id.index()] && !program.op(*id).is_leaf())
        .map(|id| local(&name(id), &operation(program.op(id), number, &mut |operand| argument(operand))))
        .collect()
}
