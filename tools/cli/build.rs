//! Compiles the two cranes of the default run.

use crane_codegen::build;
use crane_codegen::chain::Analyses;

fn main() {
    // A program with its own cranes compiles those instead.
    if std::env::var_os("CARGO_FEATURE_SHIPPED").is_some() {
        for name in ["eight_link_flexible", "eight_link_rigid"] {
            build::compile_spec_for(format!("../../specs/{name}.yaml"), Some(Analyses::COMMAND));
        }
    }
}
