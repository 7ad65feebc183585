//! Compiles `crane.yaml` into a Rust module.

fn main() {
    crane_codegen::build::compile_spec("crane.yaml");
}
