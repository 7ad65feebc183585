//! Cranes written by hand from textbook formulas: they share nothing with the compiler.
#![allow(dead_code, unused_imports, reason = "every test file uses its own part")]

mod fixed;
pub mod implicit;
mod lift;
mod pendulum;
mod sledge;

pub use fixed::Fixed;
pub use lift::Lift;
pub use pendulum::DoublePendulum;
pub use sledge::Sledge;

use crane_model::{CoordinateInfo, CoordinateKind, CoordinateRole, Description, List, Text};

/// Gravity, m/s².
pub const GRAVITY: f64 = 9.81;

/// A description with nothing but coordinates.
pub const fn description(
    name: &'static str,
    coordinates: &'static [CoordinateInfo],
    guess: &'static [Option<f64>],
) -> Description {
    Description {
        name: Text::Static(name),
        title: Text::Static(name),
        spec_hash: Text::Static("by hand"),
        parameters: List::Static(&[]),
        coordinates: List::Static(coordinates),
        bodies: List::Static(&[]),
        sections: List::Static(&[]),
        supports: List::Static(&[]),
        drives: List::Static(&[]),
        stops: List::Static(&[]),
        frictions: List::Static(&[]),
        bristles: List::Static(&[]),
        loads: List::Static(&[]),
        connectors: List::Static(&[]),
        inputs: List::Static(&[]),
        cylinders: List::Static(&[]),
        pump: None,
        points: List::Static(&[]),
        statics: true,
        guess: List::Static(guess),
        duration: 10.0,
        step: 1e-3,
        output: 0.01,
        events: List::Static(&[]),
    }
}

/// A coordinate.
pub const fn coordinate(name: &'static str, kind: CoordinateKind, role: CoordinateRole) -> CoordinateInfo {
    CoordinateInfo { name: Text::Static(name), kind, role }
}
