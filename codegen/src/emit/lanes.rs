//! Eight cranes per call: the same statements over vectors of eight numbers, each crane with its own state and parameters.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Item, ItemMod, parse_quote};

use super::arithmetic::{integer, variable};
use super::crane::fields;
use super::function;
use super::identifiers;
use super::labels::Labels;
use super::names::field_name;
use super::number::Number;
use super::parameters;
use crate::chain::{Chain, Input};
use crate::lower::{LoweredFunction, LoweredProgram, Statement};
use crate::program::FunctionId;

/// Functions that a simulation of many cranes calls in every step.
const FUNCTIONS: [FunctionId; 1] = [FunctionId::ForwardDynamics];

/// Eight cranes per call for a spec that does not request them: one after the other.
pub fn one_by_one() -> (TokenStream, TokenStream) {
    (
        quote!(OneByOne<Crane>),
        quote! {
            fn lanes(cranes: [&Self; 8]) -> OneByOne<Crane> {
                OneByOne(cranes.map(|crane| *crane))
            }
        },
    )
}

/// The module `lanes`, the type of eight cranes in it, and the method that makes them.
pub fn lanes(chain: &Chain, lowered: &LoweredProgram, labels: &Labels) -> (Item, (TokenStream, TokenStream)) {
    let mut items = parameters::parameters(chain, lowered, labels, Number::Lanes);
    for code in lowered.functions.iter().filter(|code| FUNCTIONS.contains(&code.function.id)) {
        items.extend(function::function(lowered, code, labels, Number::Lanes));
    }
    let live = !chain.parameters.is_empty();
    let has_inputs = !chain.inputs.is_empty();
    let fields = fields(chain);
    let slots = Input::SLOTS * chain.inputs.len();
    if has_inputs {
        let slots = integer(slots);
        items.push(parse_quote!(
            #[doc = " Inputs of eight cranes."]
            pub type Inputs = [f64x8; #slots];
        ));
    }
    let constants =
        lowered.functions.iter().any(|b| b.function.id == FunctionId::ForwardDynamics && b.reads_parameters);
    let constants = constants.then(|| quote!(, &self.constants));
    let reads_inputs = lowered.functions.iter().any(|b| b.function.id == FunctionId::ForwardDynamics && b.reads_inputs);
    let inputs = reads_inputs.then(|| quote!(, &self.inputs));
    let takes_stumpff = |code: &LoweredFunction| {
        code.pieces.iter().flatten().any(|statement| matches!(statement, Statement::Stumpff(_)))
    };
    let in_lanes = || lowered.functions.iter().filter(|code| FUNCTIONS.contains(&code.function.id));
    let stumpff = in_lanes().any(takes_stumpff).then(|| quote!(, stumpff));
    let words = identifiers(&items);
    let functions = ["exp", "select", "sqrt"].into_iter().filter(|name| words.contains(*name)).map(variable);
    let functions: Vec<_> = functions.collect();
    let mut module: ItemMod = parse_quote! {
        #[doc = " Eight cranes per call."]
        pub mod lanes {
            use ::crane_model::nalgebra::SVector;
            use ::crane_model::rt::lanes::{f64x8, fma, sin_cos, splat #stumpff #(, #functions)*};
            use ::crane_model::LaneDynamics;
            use super::N;
        }
    };
    items.push(parse_quote! {
        #[doc = " Eight cranes with their own parameters."]
        #[derive(Clone, Copy, Debug)]
        pub struct Cranes #fields
    });
    items.push(parse_quote! {
        impl LaneDynamics<N> for Cranes {
            fn forward_dynamics(&self, t: f64x8, q: &SVector<f64x8, N>, v: &SVector<f64x8, N>) -> SVector<f64x8, N> {
                forward_dynamics(t, q, v #constants #inputs)
            }
        }
    });
    let places = (0..slots).map(integer);
    let of_eight = quote!([#(cranes.map(|crane| crane.inputs[#places]).into()),*]);
    let [taken, kept, given] = if has_inputs {
        [quote!(, inputs: Inputs), quote!(, inputs), quote!(, #of_eight)]
    } else {
        [quote!(), quote!(), quote!()]
    };
    let make_lanes = if live {
        let names: Vec<_> = chain.parameters.iter().map(|p| format_ident!("{}", field_name(&p.name))).collect();
        items.push(parse_quote! {
            impl Cranes {
                #[doc = " Eight cranes with these values of their live parameters, which each crane has checked."]
                pub(super) fn new(params: &Params #taken) -> Self {
                    Cranes { constants: Constants::new(params) #kept }
                }
            }
        });
        quote! {
            lanes::Cranes::new(&lanes::Params {
                #(#names: cranes.map(|crane| crane.constants.params.#names).into()),*
            } #given)
        }
    } else if has_inputs {
        items.push(parse_quote! {
            impl Cranes {
                #[doc = " Eight cranes with these inputs."]
                pub(super) fn new(inputs: Inputs) -> Self {
                    Cranes { inputs }
                }
            }
        });
        quote!(lanes::Cranes::new(#of_eight))
    } else {
        quote!(lanes::Cranes)
    };
    if let Some((_, content)) = &mut module.content {
        content.append(&mut items);
    }
    let cranes = if live || has_inputs { quote!(cranes) } else { quote!(_cranes) };
    let make = quote! {
        fn lanes(#cranes: [&Self; 8]) -> lanes::Cranes {
            #make_lanes
        }
    };
    (Item::Mod(module), (quote!(lanes::Cranes), make))
}
