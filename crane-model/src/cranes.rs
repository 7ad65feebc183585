//! The shipped cranes: one module a file of `specs/`, compiled by the build script.

include!(concat!(env!("OUT_DIR"), "/cranes.rs"));
