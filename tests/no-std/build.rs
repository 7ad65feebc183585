//! Compiles the cranes with every analysis.

use crane_codegen::build;
use crane_codegen::chain::Analyses;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for spec in ["../../specs/eight_link_flexible.yaml", "../../specs/eight_link_hydraulic.yaml", "exact.yaml"] {
        build::compile_spec_for(spec, Some(Analyses::ALL));
    }
}
