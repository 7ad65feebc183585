//! Code shared by the whole-system tests of the compiler and the runtime.

#![allow(clippy::missing_panics_doc, reason = "tests fail by panicking")]

pub mod dual;
pub mod interpreted;
pub mod precise;
pub mod quantities;
pub mod random;
pub mod registry;
pub mod runtime;
pub mod states;
pub mod workspace;

/// The small crane with exact kinematics of `tests/no-std`.
#[allow(clippy::all, clippy::pedantic)]
pub mod exact {
    include!(concat!(env!("OUT_DIR"), "/exact.rs"));
}
