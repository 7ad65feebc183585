//! Each row of the table of functions is derived for some crane: a row that nobody derives would answer zero without a word.

use std::collections::BTreeSet;
use std::path::Path;

use crane_codegen::chain::Analyses;
use crane_codegen::mechanics;
use crane_codegen::program::{FunctionId, Part, Program};
use crane_codegen::{build, compile, read, validate};

#[test]
fn every_function_is_derived_for_some_crane() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut derived = BTreeSet::new();
    for name in CRANES {
        let source = build::open(&folder.join(name)).unwrap_or_else(|failure| panic!("{failure}"));
        let chain = read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
        derived.extend(compile::report(&chain, Analyses::ALL).costs.iter().map(|cost| cost.function.clone()));
    }
    let missing: Vec<_> =
        FunctionId::ALL.iter().copied().map(FunctionId::name).filter(|name| !derived.contains(*name)).collect();
    assert_eq!(missing, BY_OTHERS);
}

/// An interpreted crane finds a function in the part to which it belongs.
#[test]
fn parts_have_the_functions_of_the_whole() {
    let source = build::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../tools/casadi/efforts.yaml"))
        .unwrap_or_else(|failure| panic!("{failure}"));
    let chain = read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let ids = |program: Program| program.functions.iter().map(|function| function.id).collect::<Vec<_>>();
    let mut of_parts = Vec::new();
    for part in Part::ALL {
        let of_part = ids(mechanics::derive_part(&chain, part));
        assert!(of_part.iter().all(|id| id.part() == part), "{part:?}: {of_part:?}");
        of_parts.extend(of_part);
    }
    assert_eq!(of_parts, ids(mechanics::derive(&chain, Analyses::ALL)));
}

/// Few, small cranes that have every part together.
const CRANES: [&str; 4] = [
    "tests/no-std/exact.yaml",
    "codegen/tests/implausible/W024_opening_in_percent.yaml",
    "tools/casadi/efforts.yaml",
    "tools/casadi/pads.yaml",
];

/// Rows that the runtime computes from others.
const BY_OTHERS: [&str; 3] = ["dynamic_residual_derivatives", "inverse_mass_matrix", "forward_dynamics_derivatives"];
