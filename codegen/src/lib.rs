//! Compiler from a crane described in YAML to specialised Rust.

pub mod chain;
