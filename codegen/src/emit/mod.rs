//! Rust text from straight lines. The only module that knows Rust.

mod arithmetic;
mod crane;
mod description;
mod function;
mod header;
mod labels;
mod names;
mod parameters;
mod print;
mod report;
mod shape;

use syn::{Item, parse_quote};

use crate::chain::Chain;
use crate::lower::Blocks;
use labels::Labels;

pub use report::{FunctionCost, Report};

/// The module of a crane.
#[derive(Clone, Debug)]
pub struct GeneratedCode {
    /// Name of the crane and of its module.
    pub name: String,
    /// Rust text, to be included into a module.
    pub text: String,
    /// What it costs and what is left out.
    pub report: Report,
}

/// Writes the module. `spec_file` is the name of the YAML file.
#[must_use]
pub fn emit(chain: &Chain, blocks: &Blocks, report: Report, spec_file: &str) -> GeneratedCode {
    let labels = Labels::new(chain, blocks);
    let mut items = imports(blocks);
    items.extend(description::description(chain));
    items.extend(parameters::parameters(chain, blocks, &labels));
    items.push(parse_quote!(
        const BLANK: Matrix4<f64> = Matrix4::new(
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0
        );
    ));
    for block in &blocks.functions {
        items.extend(function::function(blocks, block, &labels));
    }
    items.extend(crane::crane(chain, blocks));
    let text = format!("{}\n{}", header::header(chain, &report, spec_file), print::file(items));
    GeneratedCode { name: chain.name.clone(), text, report }
}

/// Imports: nalgebra through the runtime, so that a user's crate depends on the runtime alone.
fn imports(blocks: &Blocks) -> Vec<Item> {
    let has = |name: &str| blocks.functions.iter().any(|b| b.function.name == name);
    let mut items: Vec<Item> = vec![
        parse_quote!(use ::crane_model::nalgebra::{Matrix4, SMatrix, SVector, Vector3};),
        parse_quote!(use ::crane_model::support::{fill, sin_cos, symmetric};),
        parse_quote!(use ::crane_model::{BodyInfo, CoordinateInfo, CoordinateKind, CoordinateRole, CraneModel, Description, DriveInfo, ParameterInfo, SupportInfo};),
    ];
    if has("mass_matrix") {
        items.push(parse_quote!(use ::crane_model::Dynamics;));
    }
    if has("static_residual") {
        items.push(parse_quote!(use ::crane_model::Statics;));
    }
    if has("linearise") {
        items.push(parse_quote!(use ::crane_model::{Linearisation, Linearise};));
    }
    if has("transform_derivatives") {
        items.push(parse_quote!(use ::crane_model::TransformDerivatives;));
    }
    items
}
