//! The rules for the values of live parameters, checked whenever they are set.

use quote::{format_ident, quote};
use syn::{Expr, Item, parse_quote};

use super::arithmetic::{call, difference, field, integer, literal, negative, product, quotient, sum, variable};
use super::description::expression as constant_expression;
use super::names::field_name;
use crate::chain::{Chain, ParameterId, Relation, Value};

/// `PARAMETERS` with their ranges, and the check of all values together; nothing if all numbers are compiled in.
pub fn limits(chain: &Chain) -> Vec<Item> {
    if chain.parameters.is_empty() {
        return vec![];
    }
    let infos = constant_expression(&chain.description().parameters.as_slice());
    let count = integer(chain.parameters.len());
    let ranges = chain.parameters.iter().enumerate().map(|(index, p)| {
        let (index, name) = (integer(index), format_ident!("{}", field_name(&p.name)));
        quote!(PARAMETERS[#index].check(self.#name)?;)
    });
    let relations = chain.relations.iter().map(|Relation { margin, refusal: broken }| {
        let (margin, broken) = (expression(margin, chain, &variable("self")), constant_expression(broken));
        quote! {
            let margin = #margin;
            if margin.is_nan() || margin <= 0.0 {
                return Err(ParameterError { given: None, refusal: #broken });
            }
        }
    });
    vec![
        parse_quote! {
            #[doc = " Live parameters: names, units and allowed values."]
            pub const PARAMETERS: [ParameterInfo; #count] = #infos;
        },
        parse_quote! {
            impl Params {
                #[doc = " Checks these values against the rules of the spec language."]
                #[doc = ""]
                #[doc = " # Errors"]
                #[doc = " The first rule that they break."]
                pub fn check(&self) -> Result<(), ParameterError> {
                    #(#ranges)*
                    #(#relations)*
                    Ok(())
                }
            }
        },
    ]
}

/// A number of the chain over the fields of `parameters`.
pub fn expression(value: &Value, chain: &Chain, parameters: &Expr) -> Expr {
    let of = |value: &Value| expression(value, chain, parameters);
    match value {
        Value::Constant(c) => literal(*c),
        Value::Parameter(ParameterId(index)) => field(parameters.clone(), &field_name(&chain.parameters[*index].name)),
        Value::Neg(a) => negative(of(a)),
        Value::Add(a, b) => match &**b {
            Value::Neg(b) => difference(of(a), of(b)),
            b => sum(of(a), of(b)),
        },
        Value::Mul(a, b) => product(of(a), of(b)),
        Value::Div(a, b) => quotient(of(a), of(b)),
        Value::Sin(a) => {
            let a = of(a);
            parse_quote!(sin_cos([#a]).0[0])
        }
        Value::Cos(a) => {
            let a = of(a);
            parse_quote!(sin_cos([#a]).1[0])
        }
        Value::Sqrt(a) => call("sqrt", [of(a)]),
    }
}
