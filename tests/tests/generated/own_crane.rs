//! The example of your own crane: shown verbatim in the manual, valid, and stable at rest.

use std::fs;

use crane_codegen::{SourceFile, compile};
use crane_tests::interpreted::Interpreted;
use crane_tests::workspace;

const FOLDER: &str = "examples/own-crane";

fn text(path: &str) -> String {
    fs::read_to_string(workspace::root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Contents of the blocks fenced as `language`, in order.
fn blocks<'a>(markdown: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    markdown.split(&fence).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// The spec without the comments at its head, which are for the tests of the command.
fn spec() -> String {
    let text = text(&format!("{FOLDER}/crane.yaml"));
    text[text.find("format:").expect("a spec")..].to_owned()
}

#[test]
fn the_pages_show_the_files_to_the_byte() {
    let manual = text("docs/manual/own-program.md");
    let shown = [("rust,ignore", vec!["build.rs", "src/main.rs"]), ("toml", vec!["Cargo.toml"])];
    for (language, files) in shown {
        let files: Vec<String> = files.iter().map(|file| text(&format!("{FOLDER}/{file}"))).collect();
        assert_eq!(blocks(&manual, language), files, "{language}");
    }
    for page in [&manual, &text("README.md")] {
        assert_eq!(blocks(page, "yaml"), [spec()]);
    }
}

#[test]
fn the_spec_compiles_through_the_library() {
    let source = SourceFile::new("crane.yaml", text(&format!("{FOLDER}/crane.yaml")));
    let code = compile::compile(&source, None).unwrap_or_else(|mistakes| panic!("{mistakes}")).code;
    assert_eq!(code.name, "own_crane");
    assert!(code.text.contains("pub payload: f64"), "the payload is live");
}

#[test]
fn it_rests_stably() {
    let spec = text(&format!("{FOLDER}/crane.yaml"));
    let crane = Interpreted::new(workspace::chain_of("own_crane", &spec));
    let rest = crane.equilibrium();
    // By hand: box section, drive's spring, boom as Euler–Bernoulli beam under its own weight and the payload.
    let (length, stiffness, payload) = (4.0_f64, 4e6, 300.0 * 9.81);
    let (second_moment, area) =
        ((0.15 * 0.2_f64.powi(3) - 0.138 * 0.188_f64.powi(3)) / 12.0, 0.15 * 0.2 - 0.138 * 0.188);
    let (bending, weight) = (2.1e11 * second_moment, 7850.0 * area * 9.81);
    let moment = payload * length + weight * length.powi(2) / 2.0;
    // Three sections: tests/cantilever.rs.
    let tip = payload * length.powi(3) / (3.0 * bending) * (1.0 - 1.0 / 36.0);
    let by_weight = weight * length.powi(4) / (8.0 * bending) * (1.0 - 1.0 / 18.0);
    let sag = moment / stiffness * length + tip + by_weight;

    // The residual is rounding of that moment.
    assert!(crane.vector("static_residual", &rest).amax() < 1e-12 * moment);
    assert!(
        crane.matrix("tangent_stiffness", &rest).cholesky().is_some(),
        "the tangent stiffness is positive definite"
    );
    let hook = crane.get("points", &crane.inputs(&rest), 3);
    // Nonlinear in the angles: (sag/length)², 5e-5.
    assert!(((2.0 - 1.5 - hook[2]) / sag - 1.0).abs() < 2e-4, "{hook:?} {sag}");
}
