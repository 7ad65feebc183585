//! The shipped cranes: a module for each file of `specs/`, compiled by the build script with every analysis.

#[cfg(doctest)]
mod manual;

include!(concat!(env!("OUT_DIR"), "/cranes.rs"));
