//! Compiles the reference crane with every analysis.

use crane_codegen::build;
use crane_codegen::chain::Analyses;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    build::compile_spec_for("../../specs/eight_link_flexible.yaml", Some(Analyses::ALL));
}
