//! A crane from a spec without rustc: its functions as bytecode, for one state or eight at a time.

pub mod assemble;
pub mod bytecode;
pub mod layout;
pub mod machine;
mod routine;

pub use routine::Routine;
