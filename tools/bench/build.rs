//! Compiles the reference crane with several numbers of sections.

use std::{env, fs, io};

use crane_codegen::chain::Analyses;
use crane_codegen::{SourceFile, build};

const SPEC: &str = "../../specs/eight_link_flexible.yaml";
/// Sections of the boom; 0 means a rigid boom. `CRANE_BENCH_SECTIONS="0 4"` in the environment builds fewer.
const SECTIONS: &str = "0 4 10 20 30";
/// Maximum number of sections for which the derivatives of all transforms are generated, for the explicit triple sum.
const DERIVATIVES_UP_TO: usize = 4;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={SPEC}");
    println!("cargo::rerun-if-env-changed=CRANE_BENCH_SECTIONS");
    let reference = build::open(SPEC.as_ref()).map_err(io::Error::other)?;
    let wanted = env::var("CRANE_BENCH_SECTIONS").unwrap_or_else(|_| SECTIONS.to_owned());
    let (mut small, mut large) = (Vec::new(), Vec::new());
    for word in wanted.split_whitespace() {
        let sections: usize = word.parse().map_err(io::Error::other)?;
        let spec = build::out_dir().join(format!("crane_{sections}.yaml"));
        fs::write(&spec, with_sections(&reference, sections).text)?;
        let derivatives = sections <= DERIVATIVES_UP_TO;
        let analyses = Analyses {
            statics: false,
            modes: false,
            internal_forces: false,
            derivatives,
            ensemble: true,
            ..Analyses::ALL
        };
        let name = build::compile_spec_for(&spec, Some(analyses)).name;
        (if derivatives { &mut small } else { &mut large }).push(name);
    }
    let cranes = format!("cranes! {{ small: [{}], large: [{}] }}\n", small.join(", "), large.join(", "));
    fs::write(build::out_dir().join("cranes.rs"), cranes)
}

/// The reference crane with another number of sections.
fn with_sections(reference: &SourceFile, sections: usize) -> SourceFile {
    let count = if sections == 0 { "rigid".to_owned() } else { sections.to_string() };
    reference.changed(&format!("name: crane_{sections}\nlinks: [{{name: boom, beam: {{sections: {count}}}}}]"))
}
