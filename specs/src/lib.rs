//! The shipped cranes: a module for each file of `specs/`, compiled by the build script, and their specs.
//!
//! Without the feature `compiled` it has the specs alone, and builds in a moment.

#[cfg(all(doctest, feature = "compiled"))]
mod manual;

include!(concat!(env!("OUT_DIR"), "/cranes.rs"));
