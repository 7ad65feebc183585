//! Random cranes that combine all features of the language, each checked where features meet: by a second description of the same crane, by
//! laws of mechanics, and by finer meshes.
//!
//! A failure is shrunk, and printed as a spec that is ready to be run.

// Descriptions and laws that always apply have the type of those that do not; specs are short texts.
#![allow(clippy::unnecessary_wraps, clippy::format_push_string)]

pub mod changes;
mod charts;
pub mod check;
mod combined;
pub mod crane;
pub mod cuts;
pub mod descriptions;
mod events;
pub mod feature;
mod fleets;
mod forms;
pub mod laws;
pub mod meshes;
pub mod observe;
pub mod pins;
pub mod run_changes;
pub mod second;
mod servos;
pub mod shown;
pub mod tree;
mod whole;
mod wind;
