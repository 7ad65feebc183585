//! Rust text from straight-line code. This is the only module that knows Rust.

mod arguments;
mod arithmetic;
mod crane;
mod description;
mod expression;
mod function;
mod header;
mod labels;
mod lanes;
mod limits;
mod loops;
mod names;
mod number;
mod parameters;
mod print;
mod shape;
mod writer;

use std::collections::HashSet;
use std::fmt::Write;

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;

use syn::parse_quote;

use crate::chain::{Analyses, Chain};
use crate::lower::LoweredProgram;
use crate::program::Shape;
use crate::report::Report;
use arithmetic::integer;
use number::Number;

pub(crate) use labels::Labels;
pub(crate) use names::Names;

/// The module of a crane.
#[derive(Clone, Debug)]
pub struct GeneratedCode {
    /// Name of the crane and of its module.
    pub name: String,
    /// Rust text, to be included into a module.
    pub text: String,
    /// Its operation counts and what is left out.
    pub report: Report,
}

/// Writes the module. `spec_file` is the name of the YAML file.
#[must_use]
pub fn emit(
    chain: &Chain,
    analyses: Analyses,
    lowered: &LoweredProgram,
    report: Report,
    spec_file: &str,
) -> GeneratedCode {
    let labels = Labels::new(chain, lowered);
    let mut items = Vec::new();
    items.extend(description::description(chain));
    items.extend(description::loop_joints(chain));
    items.extend(parameters::parameters(chain, lowered, &labels, Number::Single));
    items.extend(limits::limits(chain));
    items.push(parse_quote!(
        const BLANK: Matrix4<f64> =
            Matrix4::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    ));
    for code in &lowered.functions {
        if let Shape::Factors(count) = code.function.shape {
            let count = integer(count);
            items.push(parse_quote!(
                #[doc = " The factors that [`factorise`] computes for [`solve`]."]
                pub type Factors = [f64; #count];
            ));
        }
        items.extend(function::function(lowered, code, &labels, Number::Single));
    }
    let (module, lanes) = if analyses.ensemble {
        let (module, lanes) = lanes::lanes(chain, lowered, &labels);
        (Some(module), lanes)
    } else {
        (None, lanes::one_by_one())
    };
    items.extend(module);
    items.extend(crane::crane(chain, analyses, lowered, lanes));
    items.iter_mut().for_each(allow_double_underscores);
    let imports = imports(&items);
    let body = print::file(items);
    let text = format!("{}\n{}\n{body}", header::header(chain, &report, spec_file), imports);
    GeneratedCode { name: chain.name.clone(), text, report }
}

/// Imports only of names that the body uses; nalgebra is imported through the runtime, so that a user's crate depends only on
/// the runtime.
fn imports(items: &[syn::Item]) -> String {
    const SOURCES: [(&str, &[&str]); 3] = [
        ("::crane_model::nalgebra", &["Matrix4", "SMatrix", "SVector", "Vector3"]),
        (
            "::crane_model::rt",
            &[
                "MassAndBias",
                "MassColumns",
                "ConcurrentAxes",
                "TransformFactors",
                "exp",
                "fill",
                "fill_tangent",
                "fma",
                "mirror",
                "select",
                "sin_cos",
                "sqrt",
                "stumpff",
                "symmetric",
            ],
        ),
        (
            "::crane_model",
            &[
                "AttachmentInfo",
                "BodyInfo",
                "Bound",
                "BristleInfo",
                "ConditionInfo",
                "ConnectorInfo",
                "CoordinateInfo",
                "CoordinateKind",
                "CoordinateRole",
                "CraneModel",
                "CylinderInfo",
                "Description",
                "DriveInfo",
                "EventInfo",
                "InputInfo",
                "JoinsInfo",
                "Linearisation",
                "List",
                "LoadInfo",
                "LoopEquationInfo",
                "LoopJointInfo",
                "Moment",
                "OneByOne",
                "ParameterError",
                "ParameterInfo",
                "Part",
                "PumpInfo",
                "Refusal",
                "SectionInfo",
                "SectionModuli",
                "Side",
                "StageInfo",
                "SupportInfo",
                "Tension",
                "Text",
                "ValveInfo",
                "Wrench",
            ],
        ),
    ];
    let words = identifiers(items);
    let mut text = String::new();
    for (source, names) in SOURCES {
        let used: Vec<&str> = names.iter().copied().filter(|name| words.contains(*name)).collect();
        let _ = writeln!(text, "use {source}::{{{}}};", used.join(", "));
    }
    syn::parse_file(&text).map(|file| prettyplease::unparse(&file)).unwrap_or(text)
}

/// A user's name that ends in `_` leads to names such as `box__psi`, which rustc does not accept as snake case.
fn allow_double_underscores(item: &mut syn::Item) {
    if !identifiers(std::slice::from_ref(item)).iter().any(|name| name.contains("__")) {
        return;
    }
    let attributes = match item {
        syn::Item::Fn(item) => &mut item.attrs,
        syn::Item::Impl(item) => &mut item.attrs,
        syn::Item::Mod(item) => &mut item.attrs,
        syn::Item::Struct(item) => &mut item.attrs,
        _ => return,
    };
    attributes.push(parse_quote!(#[allow(non_snake_case)]));
}

/// All identifiers of the code, without the contents of strings and documentation, which belong to the user.
fn identifiers(items: &[syn::Item]) -> HashSet<String> {
    let mut found = HashSet::new();
    let mut streams: Vec<TokenStream> = items.iter().map(ToTokens::to_token_stream).collect();
    while let Some(stream) = streams.pop() {
        for token in stream {
            match token {
                TokenTree::Ident(ident) => {
                    found.insert(ident.to_string());
                }
                TokenTree::Group(group) => streams.push(group.stream()),
                TokenTree::Punct(_) | TokenTree::Literal(_) => {}
            }
        }
    }
    found
}
