//! Any input yields a chain or mistakes that can be drawn, never a panic.
//!
//! From `codegen/`: `cargo fuzz run read_and_validate fuzz/corpus ../specs tests/bad -- -dict=fuzz/spec.dict`; on a stable
//! toolchain with `RUSTC_BOOTSTRAP=1`. New inputs go to the first folder; the others contain initial inputs.
#![no_main]

use crane_codegen::{SourceFile, read, validate};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let chain = SourceFile::from_bytes("fuzz.yaml", bytes)
        .and_then(|source| read(&source).and_then(|spec| validate(&spec, &source)));
    if let Err(mistakes) = chain {
        assert!(!mistakes.to_string().is_empty() && !mistakes.headline().contains('\n'));
    }
});
