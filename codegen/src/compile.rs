//! The pipeline, one stage per line.

use std::mem;
use std::path::Path;

use crate::chain::{Analyses, Chain, Loops};
use crate::diagnostic::{Diagnostics, SourceFile};
use crate::emit::{GeneratedCode, emit};
use crate::emit_c::{CCode, Precision, emit_c, variables};
use crate::lower::{LoweredProgram, lower};
use crate::mechanics::{derive, derive_verbatim, left_out};
use crate::program::{Function, FunctionId, Part, Product, Shape, has_products};
use crate::read::read;
use crate::report::Report;
use crate::validate::{self, Checked};

/// A crane's Rust module, and warnings about the crane.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The module.
    pub code: GeneratedCode,
    /// Warnings, with their locations.
    pub warnings: Diagnostics,
}

/// Compiles a spec to Rust: the functions that the given `analyses` request or, without them, those that the spec requests.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn compile(source: &SourceFile, analyses: Option<Analyses>) -> Result<Compiled, Diagnostics> {
    let Checked { chain, warnings, .. } = check(source)?;
    // Only the spec can request eight cranes per call.
    let analyses = Analyses { ensemble: chain.analyses.ensemble, ..analyses.unwrap_or(chain.analyses) };
    // A path would differ between machines.
    let file = Path::new(&source.name).file_name().unwrap_or_default().to_string_lossy();
    Ok(Compiled { code: generate(&chain, analyses, &file), warnings })
}

/// Converts a spec to a valid chain.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn load(source: &SourceFile) -> Result<Chain, Diagnostics> {
    validate::validate(&read(source)?)
}

/// Converts a spec to a valid chain, with warnings about implausible numbers.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn check(source: &SourceFile) -> Result<Checked, Diagnostics> {
    validate::check(read(source)?)
}

/// Compiles a chain to Rust. `spec_file` is the name of the YAML file, for the header.
#[must_use]
pub fn generate(chain: &Chain, analyses: Analyses, spec_file: &str) -> GeneratedCode {
    let program = derive(chain, analyses);
    let lowered = lower(&program, chain.loops.min_iterations());
    emit(chain, analyses, &lowered, report_on(&lowered, chain, analyses), spec_file)
}

/// Compiles the named functions of a chain to C, and [products](Product) with their derivatives by their names; `parameters` are the
/// initial values of the live parameters, `header` is the name of the header's file, which the source includes.
///
/// # Errors
/// A function that the crane does not have, or that has no products.
pub fn generate_c(
    chain: &Chain,
    functions: &[impl AsRef<str>],
    parameters: &[f64],
    precision: Precision,
    header: &str,
) -> Result<CCode, NoFunction> {
    let chosen: Vec<(&str, Option<Product>)> = functions.iter().map(|name| Product::split(name.as_ref())).collect();
    let is_chosen = |id: FunctionId| chosen.iter().any(|(name, _)| *name == id.name());
    let analyses = Analyses {
        statics: true,
        dynamics: true,
        modes: is_chosen(FunctionId::Linearise),
        internal_forces: true,
        derivatives: is_chosen(FunctionId::TransformDerivatives),
        motion_derivatives: Part::MotionDerivatives.functions().any(is_chosen),
        ensemble: false,
    };
    // Straight-line code needs no tables of numbers and no loops over columns.
    let chain = Chain { loops: Loops::Never, ..chain.clone() };
    let mut program = derive(&chain, analyses);
    let of_factors =
        |shape: &Shape| matches!(shape, Shape::Columns { .. } | Shape::Tangent { .. } | Shape::TransformFactors { .. });
    let is_straight = |function: &&Function| !of_factors(&function.shape);
    let known: Vec<FunctionId> = program.functions.iter().filter(is_straight).map(|function| function.id).collect();
    let closes_loops = chain.has_loops();
    let with_products: Vec<FunctionId> = known.iter().copied().filter(|id| has_products(*id, closes_loops)).collect();
    let is_missing = |(name, product): &(&str, Option<Product>)| {
        let ids = if product.is_some() { &with_products } else { &known };
        !ids.iter().any(|id| id.name() == *name)
    };
    if let Some(missing) = chosen.iter().position(is_missing) {
        let names = |ids: Vec<FunctionId>| ids.into_iter().map(FunctionId::name).collect();
        let name = functions[missing].as_ref().to_owned();
        return Err(NoFunction { name, known: names(known), with_products: names(with_products) });
    }
    let by = variables(&program);
    for function in mem::take(&mut program.functions) {
        let is_named = |id: FunctionId, product| chosen.contains(&(id.name(), product));
        let products = Product::ALL.into_iter().filter(|product| is_named(function.id, Some(*product)));
        let products: Vec<Function> = products.map(|product| program.product(&function, product, &by)).collect();
        // `solve` needs the factors from `factorise`.
        if is_named(function.id, None) || function.id == FunctionId::Factorise && is_named(FunctionId::Solve, None) {
            program.functions.push(function);
        }
        program.functions.extend(products);
    }
    Ok(emit_c(&chain, &lower(&program, None), parameters, precision, header))
}

/// A function that a crane does not have, or that has no products.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoFunction {
    /// Its name.
    pub name: String,
    /// The functions that the crane has.
    pub known: Vec<&'static str>,
    /// Those that have products with their derivatives.
    pub with_products: Vec<&'static str>,
}

/// The cost of the functions of a chain and what is left out, without writing them.
#[must_use]
pub fn report(chain: &Chain, analyses: Analyses) -> Report {
    report_on(&lower(&derive(chain, analyses), chain.loops.min_iterations()), chain, analyses)
}

fn report_on(lowered: &LoweredProgram, chain: &Chain, analyses: Analyses) -> Report {
    Report::new(lowered, &derive_verbatim(chain, analyses), chain.loops, left_out(chain, analyses))
}
