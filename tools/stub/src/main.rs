//! Prints the stub of a Python module: `stub LIBRARY MODULE`.

use std::error::Error;

use pyo3_introspection::{introspect_cdylib, module_stub_files};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [library, module] = arguments.as_slice() else { return Err("usage: stub LIBRARY MODULE".into()) };
    let files = module_stub_files(&introspect_cdylib(library, module)?);
    for text in files.values() {
        print!("{text}");
    }
    Ok(())
}
