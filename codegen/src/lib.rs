//! Compiler from a crane described in YAML to specialised Rust.

pub mod chain;
pub mod compile;
pub mod emit;
pub mod lower;
pub mod mechanics;
pub mod symbolic;
