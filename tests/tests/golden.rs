//! Generated code as files that are readable in a diff, compiled with warnings denied, and operation counts of all specs.
//!
//! `cargo xtask bless` writes the files again; commit them with the reason.

use std::fmt::Write;
use std::path::Path;

use crane_codegen::SourceFile;
use crane_codegen::build;
use crane_codegen::chain::Analyses;
use crane_codegen::compile;
use crane_codegen::explain;
use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{Arguments, Derived, Functions, Instance};
use crane_tests::workspace;

mod compiled {
    #![deny(warnings)]
    // Clippy asks for named constants where a number of the crane happens to be π/4.
    #![allow(clippy::all, clippy::pedantic)]
    #![allow(missing_docs, unreachable_pub, dead_code)]
    pub mod double_pendulum {
        include!("../golden/double_pendulum.rs");
    }
    pub mod knuckle_boom {
        include!("../golden/knuckle_boom.rs");
    }
}

/// The double pendulum has dynamics alone: its boxed crane answers for functions of other parts that it does not have them, and they are NaN; what it lacks
/// a component for is zero.
#[test]
fn a_crane_says_which_functions_it_does_not_have() {
    use compiled::double_pendulum::{Crane, N};
    let crane = Instance::<N, _>(Crane);
    let arguments = Arguments { q: &[0.3, -0.2], v: &[0.1, 0.2], positions: &[0.0; N], ..Arguments::none() };
    let call = |id: FunctionId, count: usize| {
        let mut results = vec![1.0; count];
        (crane.call(id, &arguments, &mut results), results)
    };
    for (id, count) in
        [(FunctionId::StaticResidual, N), (FunctionId::Linearise, 3 * N * N), (FunctionId::PointJacobians, 3 * N)]
    {
        let (derived, results) = call(id, count);
        assert!(derived == Derived::No && results.iter().all(|number| number.is_nan()), "{}: {results:?}", id.name());
    }
    assert_eq!(call(FunctionId::SupportForces, N), (Derived::Yes, vec![0.0; N]));
    let (derived, mass) = call(FunctionId::MassMatrix, N * N);
    assert!(derived == Derived::Yes && mass[0] > mass[3] && mass[1].to_bits() == mass[2].to_bits(), "{mass:?}");
}

fn assert_golden(path: &Path, actual: &str) {
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        build::write_text(path, actual).unwrap();
    }
    let golden = std::fs::read_to_string(path).unwrap_or_default();
    let differs = golden.lines().zip(actual.lines()).position(|(a, b)| a != b);
    assert!(golden == actual, "{} is not current (line {:?})", path.display(), differs.map(|line| line + 1));
}

#[test]
fn generated_code_of_two_small_cranes() {
    for name in ["double_pendulum", "knuckle_boom"] {
        let chain = workspace::chain(name);
        let code = compile::generate(&chain, chain.analyses, &format!("{name}.yaml"));
        assert_golden(&workspace::root().join(format!("tests/golden/{name}.rs")), &code.text);
    }
    assert_eq!(compiled::double_pendulum::N, 2);
    assert_eq!(compiled::knuckle_boom::DESCRIPTION.name, "knuckle_boom");
}

/// Length and hash of the generated Rust of shipped cranes and examples, with all functions: what is equal here is equal to the byte.
#[test]
fn generated_code_of_all_cranes() {
    let examples = ["loader_crane", "parallel_harvester"];
    let examples = examples.map(|name| workspace::root().join(format!("specs/examples/{name}.yaml")));
    let mut text = String::new();
    for path in workspace::specs().into_iter().chain(examples) {
        let chain = workspace::chain_in(&workspace::source(&path));
        let code = compile::generate(&chain, Analyses::ALL, "spec.yaml").text;
        let _ = writeln!(text, "{} {} {}", chain.name, code.len(), SourceFile::new("spec.rs", code.as_str()).hash());
    }
    assert_golden(&workspace::root().join("tests/golden/generated.txt"), &text);
}

/// The table of docs/OPERATIONS.md, as `crane operations` prints it.
#[test]
fn operations_table_of_the_documentation() {
    let reports: Vec<_> = workspace::specs()
        .iter()
        .map(|path| {
            let chain = workspace::chain(&path.file_stem().unwrap().to_string_lossy());
            (chain.name.clone(), compile::report(&chain, Analyses::ALL))
        })
        .collect();
    let text = format!(
        "# Operations of the generated functions\n\n\
         Floating-point operations of one call, where sine and cosine of an angle count as one; all functions of all \
         shipped cranes,\nincluding those that a spec's `analyses` do not request. A cell is empty if the crane does not \
         need the function.\n\n`cargo run --release -- operations specs/*.yaml` prints the table.\n\n{}",
        explain::operations_table(&reports)
    );
    assert_golden(&workspace::root().join("docs/OPERATIONS.md"), &text);
}

#[test]
fn operations_of_all_specs() {
    let mut text = String::new();
    for path in workspace::specs() {
        let name = path.file_stem().unwrap().to_string_lossy();
        let report = compile::report(&workspace::chain(&name), Analyses::ALL);
        let _ = writeln!(text, "{name}");
        for cost in report.costs {
            let _ = writeln!(text, "  {:<30} {}", cost.function, cost.operations);
        }
    }
    assert_golden(&workspace::root().join("tests/golden/operations.txt"), &text);
}
