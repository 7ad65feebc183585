//! The type that implements the runtime's trait by calling the generated functions.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Item, parse_quote};

use super::arguments::argument_name;
use super::arithmetic::{integer, literal};
use super::description::expression as constant_expression;
use super::limits::expression;
use super::names::field_name;
use super::number::Number;
use super::print::plain;
use super::shape::{Storage, struct_name};
use crate::chain::{Analyses, Chain, Input};
use crate::lower::{LoweredFunction, LoweredProgram};
use crate::program::{Argument, FunctionId, Part, Shape};

/// `Crane` and its methods; `lanes`: the type of eight cranes, and the method that makes them.
pub fn crane(
    chain: &Chain,
    analyses: Analyses,
    lowered: &LoweredProgram,
    lanes: (TokenStream, TokenStream),
) -> Vec<Item> {
    let live = !chain.parameters.is_empty();
    let title = format!(" {}: the generated functions behind the trait of the runtime.", plain(&chain.title));
    let has_inputs = !chain.inputs.is_empty();
    let fields = fields(chain);
    let inputs = has_inputs.then(|| quote!(, inputs: NOT_SET));
    let mut items: Vec<Item> = Vec::new();
    if has_inputs {
        let slots = integer(Input::SLOTS * chain.inputs.len());
        let not_set = chain.inputs.iter().flat_map(|_| Input::NOT_SET).map(literal);
        items.push(parse_quote!(
            #[doc = " Three numbers per input: its value at t = 0 while it is set, else 0; 0 while it is set, else 1; and its rate."]
            pub type Inputs = [f64; #slots];
        ));
        items.push(parse_quote!(
            const NOT_SET: Inputs = [#(#not_set),*];
        ));
    }
    items.push(parse_quote! {
        #[doc = #title]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Crane #fields
    });
    if live {
        items.push(parse_quote! {
            impl Crane {
                #[doc = " The crane with these values of its live parameters."]
                #[doc = ""]
                #[doc = " # Errors"]
                #[doc = " The values break a rule of the spec language."]
                pub fn new(params: Params) -> Result<Self, ParameterError> {
                    params.check()?;
                    Ok(Crane { constants: Constants::new(&params) #inputs })
                }

                #[doc = " Values of the live parameters."]
                #[allow(dead_code)]
                pub fn params(&self) -> &Params {
                    &self.constants.params
                }
            }
        });
    }
    let default = match (live, has_inputs) {
        (true, _) => quote!(Crane { constants: Constants::new(&Params::default()) #inputs }),
        (false, true) => quote!(Crane { inputs: NOT_SET }),
        (false, false) => quote!(Crane),
    };
    items.push(parse_quote! {
        impl Default for Crane {
            fn default() -> Self {
                #default
            }
        }
    });
    let parts = Part::ALL.into_iter().filter(|part| analyses.request(*part));
    let parts = parts.map(|part| format_ident!("{part:?}"));
    let (factors, factorise) = match find(lowered, FunctionId::Factorise) {
        Some(code) => (quote!(Factors), method(code)),
        None => (
            quote!(()),
            quote!(
                fn factorise(
                    &self,
                    _q: &SVector<f64, N>,
                    _added_inertia: &SVector<f64, N>,
                    _base: &SMatrix<f64, 6, 6>,
                ) {
                }
            ),
        ),
    };
    let (lanes, make_lanes) = lanes;
    let common = common_methods(chain);
    let methods =
        FunctionId::ALL.iter().filter_map(|id| find(lowered, *id)).filter_map(|code| match code.function.id {
            FunctionId::Factorise => None,
            FunctionId::PrescribedMotions => Some(prescribe(chain, code)),
            _ => Some(method(code)),
        });
    items.push(parse_quote! {
        impl CraneModel<N> for Crane {
            const PARTS: &'static [Part] = &[#(Part::#parts),*];

            type Factors = #factors;
            type Lanes = #lanes;

            #common
            #make_lanes
            #factorise
            #(#methods)*
        }
    });
    items
}

fn find<'a>(lowered: &'a LoweredProgram<'a>, id: FunctionId) -> Option<&'a LoweredFunction<'a>> {
    lowered.functions.iter().find(|code| code.function.id == id)
}

/// Fields of a crane, or of eight cranes.
pub(super) fn fields(chain: &Chain) -> TokenStream {
    match (!chain.parameters.is_empty(), !chain.inputs.is_empty()) {
        (true, true) => quote!({ constants: Constants, inputs: Inputs }),
        (true, false) => quote!({ constants: Constants }),
        (false, true) => quote!({ inputs: Inputs }),
        (false, false) => quote!(;),
    }
}

/// Description and parameters.
fn common_methods(chain: &Chain) -> TokenStream {
    let names: Vec<_> = chain.parameters.iter().map(|p| format_ident!("{}", field_name(&p.name))).collect();
    let indices: Vec<_> = (0..names.len()).map(integer).collect();
    let again = if chain.inputs.is_empty() {
        quote!(Crane::new(params)?)
    } else {
        quote!(Crane { inputs: self.inputs, ..Crane::new(params)? })
    };
    let (get, set) = if names.is_empty() {
        (
            quote!(
                fn parameter(&self, _index: usize) -> f64 {
                    f64::NAN
                }
            ),
            quote!(
                fn set_parameter(&mut self, _index: usize, _value: f64) -> Result<(), ParameterError> {
                    Ok(())
                }
            ),
        )
    } else {
        (
            quote!(
                fn parameter(&self, index: usize) -> f64 {
                    match index {
                        #(#indices => self.constants.params.#names,)*
                        _ => f64::NAN,
                    }
                }
            ),
            quote!(
                fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
                    let mut params = self.constants.params;
                    match index {
                        #(#indices => params.#names = value,)*
                        _ => {}
                    }
                    *self = #again;
                    Ok(())
                }

                fn set_parameters(&mut self, values: &[f64]) -> Result<(), ParameterError> {
                    let mut params = self.constants.params;
                    for (index, &value) in values.iter().enumerate() {
                        match index {
                            #(#indices => params.#names = value,)*
                            _ => {}
                        }
                    }
                    *self = #again;
                    Ok(())
                }
            ),
        )
    };
    let inputs = input_methods(chain);
    let loop_joints = chain.has_loops().then(|| {
        quote!(
            fn loop_joints(&self) -> &[LoopJointInfo] {
                &LOOP_JOINTS
            }
        )
    });
    let stages = stages(chain);
    let parents = chain.has_branches().then(|| {
        let parents = constant_expression(&chain.parents());
        quote! {
            fn parents(&self) -> &[usize] {
                &#parents
            }
        }
    });
    quote! {
        fn description(&self) -> &Description {
            &DESCRIPTION
        }
        #parents
        #get
        #set
        #inputs
        #loop_joints
        #stages
    }
}

/// The methods that list the stages of telescopes and give the heights of their sections; `None` without any.
fn stages(chain: &Chain) -> Option<TokenStream> {
    let stages = chain.stages();
    let infos = constant_expression(&chain.stage_infos());
    let parameters = parse_quote!(self.constants.params);
    let heights = stages.iter().enumerate().map(|(index, stage)| {
        let (index, height) = (integer(index), chain.height_of(stage.inner));
        let height = height.map_or_else(|| literal(0.0), |height| expression(height, chain, &parameters));
        quote!(#index => #height)
    });
    (!stages.is_empty()).then(|| {
        quote! {
            fn stages(&self) -> &[StageInfo] {
                &#infos
            }

            fn stage_height(&self, stage: usize) -> f64 {
                match stage {
                    #(#heights,)*
                    _ => 0.0,
                }
            }
        }
    })
}

/// Methods that read and set inputs; `None` if the crane has no inputs.
fn input_methods(chain: &Chain) -> Option<TokenStream> {
    let not_set = Input::NOT_SET.map(literal);
    let not_set = quote!([#(#not_set),*]);
    (!chain.inputs.is_empty()).then(|| {
        quote! {
            fn input(&self, index: usize) -> Option<f64> {
                let [value, free, _] = self.inputs.as_chunks().0.get(index).unwrap_or(&#not_set);
                if *free > 0.0 { None } else { Some(*value) }
            }

            fn set_input(&mut self, index: usize, value: Option<f64>) {
                let slots = value.map_or(#not_set, |value| [value, 0.0, 0.0]);
                if let Some(own) = self.inputs.as_chunks_mut().0.get_mut(index) {
                    *own = slots;
                }
            }
        }
    })
}

/// The method that sets prescribed coordinates and their rates.
fn prescribe(chain: &Chain, code: &LoweredFunction) -> TokenStream {
    let coordinates: Vec<_> = chain.rigid_drives().map(|drive| integer(drive.coordinate.0)).collect();
    let (positions, rates): (Vec<_>, Vec<_>) = chain
        .rigid_drives()
        .map(|drive| &chain.coordinates[drive.coordinate.0].name)
        .map(|name| (format_ident!("{name}_position"), format_ident!("{name}_rate")))
        .unzip();
    let constants = code.reads_parameters.then(|| quote!(, &self.constants));
    quote! {
        fn prescribe(&self, t: f64, q: &mut SVector<f64, N>, v: &mut SVector<f64, N>) {
            let [#([#positions, #rates]),*] = prescribed_motions(t #constants);
            let ([q], [v]) = (&mut q.data.0, &mut v.data.0);
            #(q[#coordinates] = #positions;)*
            #(v[#coordinates] = #rates;)*
        }
    }
}

/// A method that calls the function of the same name.
fn method(code: &LoweredFunction) -> TokenStream {
    let function = code.function;
    let name = format_ident!("{}", function.id.name());
    let of = |argument: &Argument| {
        let (name, of) = argument_name(*argument, Number::Single);
        (format_ident!("{name}"), of)
    };
    let (names, types): (Vec<_>, Vec<_>) = function.arguments.iter().map(of).unzip();
    let constants = code.reads_parameters.then(|| quote!(&self.constants));
    let inputs = code.reads_inputs.then(|| quote!(&self.inputs));
    let arguments: Vec<_> = names.iter().map(|name| quote!(#name)).chain(constants).chain(inputs).collect();
    match &function.shape {
        Shape::MassAndBias(_) | Shape::Columns { bias: true, .. } => {
            quote! {
                fn #name(&self, #(#names: #types,)* mass: &mut SMatrix<f64, N, N>) -> SVector<f64, N> {
                    #name(#(#arguments,)* mass)
                }
            }
        }
        Shape::Symmetric(_) | Shape::Tangent { .. } | Shape::Columns { bias: false, .. } => {
            quote! {
                fn #name(&self, #(#names: #types,)* out: &mut SMatrix<f64, N, N>) {
                    #name(#(#arguments,)* out);
                }
            }
        }
        Shape::Factors(_) => {
            quote! {
                fn #name(&self, #(#names: #types),*) -> Factors {
                    #name(#(#arguments),*)
                }
            }
        }
        Shape::Vectors(_) | Shape::Pairs(_) | Shape::Structs(..) | Shape::Transforms { corner: 1, .. } => {
            let element = match function.shape {
                Shape::Vectors(_) => quote!(Vector3<f64>),
                Shape::Pairs(_) => quote!([f64; 2]),
                Shape::Structs(of, _) => struct_name(of),
                _ => quote!(Matrix4<f64>),
            };
            quote! {
                fn #name(&self, #(#names: #types,)* out: &mut [#element]) {
                    fill(out, &#name(#(#arguments),*));
                }
            }
        }
        Shape::Rows { .. } | Shape::Transforms { .. } | Shape::TransformFactors { .. } => {
            let (item, total) = match function.shape {
                Shape::Rows { count, .. } => (quote!([f64; N]), integer(count)),
                _ => (quote!(Matrix4<f64>), integer(function.shape.matrices())),
            };
            quote! {
                fn #name(&self, #(#names: #types,)* out: &mut [#item]) {
                    if let Some(out) = out.first_chunk_mut::<#total>() {
                        #name(#(#arguments,)* out);
                    }
                }
            }
        }
        _ => {
            let result = Storage::new(function, Number::Single).public_type();
            quote! {
                fn #name(&self, #(#names: #types),*) -> #result {
                    #name(#(#arguments),*)
                }
            }
        }
    }
}
