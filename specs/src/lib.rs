//! The shipped cranes: one module a file of `specs/`, compiled by the build script.

#[cfg(doctest)]
mod manual;

include!(concat!(env!("OUT_DIR"), "/cranes.rs"));
