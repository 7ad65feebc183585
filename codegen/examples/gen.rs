use crane_codegen::{build, compile};
fn main() {
    for file in std::env::args().skip(1) {
        let source = build::open(file.as_ref()).unwrap_or_else(|e| panic!("{e}"));
        let compiled = compile::compile(&source, Some(crane_codegen::chain::Analyses::ALL)).unwrap_or_else(|e| panic!("{e}"));
        println!("{file}\n{}", compiled.code.text);
    }
}
