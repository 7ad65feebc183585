//! Compiler from a crane described in YAML to specialised, unrolled Rust for its statics and dynamics.
//!
//! ```text
//! SourceFile ─read→ CraneSpec ─validate→ Chain ─derive→ Program ─lower→ LoweredProgram ─emit→ GeneratedCode
//! text              as written           validated      named functions  straight line,  Rust text and
//!                                                       over one graph   split, ordered  operation counts
//! ```
//!
//! There are three entry points: [`build::compile_spec`] in a build script, the command `crane`, and [`compile::compile`].
//! [`program::Program::evaluate`] runs a program without rustc.

#[macro_use]
mod point_laws;

pub mod build;
pub mod chain;
pub mod compile;
pub mod diagnostic;
pub mod dump;
pub mod edit;
pub mod emit;
pub mod emit_c;
pub mod exchange;
mod expand;
pub mod explain;
pub mod files;
pub mod lower;
pub mod mechanics;
mod node;
pub mod presets;
pub mod program;
mod read;
pub mod report;
pub mod spec;
pub mod symbolic;
pub mod units;
mod validate;

pub use diagnostic::{Diagnostics, Located, SourceFile, WrongPlace};
pub use emit::GeneratedCode;
pub use read::{Change, read};
pub use spec::{CraneSpec, json_schema};
pub use validate::{Checked, check, outline, validate};
