//! Compiles the two cranes of the default run.

use crane_codegen::build;
use crane_codegen::chain::Analyses;

fn main() {
    // A program over cranes of its own compiles those.
    if std::env::var_os("CARGO_FEATURE_SHIPPED").is_some() {
        for name in ["eight_link_flexible", "eight_link_rigid"] {
            build::compile_spec_for(format!("../../specs/{name}.yaml"), Some(Analyses::COMMAND));
        }
    }
}
