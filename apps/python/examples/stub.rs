//! The native part once more, with what `cargo xtask bless` writes the stub from: beside the library, whose file it leaves alone.

#[path = "../src/lib.rs"]
mod native;

#[expect(clippy::wildcard_imports, reason = "paths of its modules begin at the root of the crate")]
use native::*;
