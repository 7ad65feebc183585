//! Runtime for cranes compiled by `crane-codegen`: statics, motion and small vibrations of types that implement the trait of a generated
//! crane.
//!
//! | what | where | needs |
//! |---|---|---|
//! | what a generated crane implements | [`CraneModel`] | nothing |
//! | one step in time | [`dynamics::rk4`] | nothing |
//! | adaptive steps, explicit and implicit | `dynamics::dormand_prince`, `dynamics::rosenbrock` | `std` |
//! | equilibrium | `statics::Problem` | `std` |
//! | a run with recorded results | `dynamics::Simulation` | `std` |
//! | runs of many cranes, eight at a time | `dynamics::ensemble` | `std` |
//! | complete runs: from rest, recorded, verified; ensembles on threads | `runs` | `std` |
//! | frequencies, damping | `modes` | `std` |
//! | cylinders with a valve: pressures as states | `hydraulics` | `std` |
//! | largest stable step | `stability` | `std` |
//! | moments about tipping lines | `tipping` | `std` |
//! | stresses at the sections of beams | `sections` | `std` |
//! | cycles of stress over a run, and their damage | `fatigue` | `std` |
//! | the largest load within limits over ranges of poses | `envelope` | `std` |
//! | cranes of any size through one pointer | `dyn_crane` | `std` |
//!
//! With `default-features = false` the crate is `no_std` and needs no heap.

#![cfg_attr(not(feature = "std"), no_std)]

// Generated code refers to the runtime by its crate name, here as in a user's crate.
extern crate self as crane_model;

mod links;
mod methods;
mod model;
mod stress;
mod wrench;

#[cfg(feature = "std")]
mod bristles;
#[cfg(feature = "std")]
mod column;
#[cfg(feature = "std")]
mod crane;
#[cfg(feature = "std")]
pub mod dyn_crane;
pub mod dynamics;
#[cfg(feature = "std")]
pub mod envelope;
#[cfg(feature = "std")]
pub mod fatigue;
#[cfg(feature = "std")]
mod feet;
#[cfg(feature = "std")]
pub mod force_states;
#[cfg(feature = "std")]
pub mod hydraulics;
#[cfg(feature = "std")]
mod interleaved;
#[cfg(feature = "std")]
mod least_squares;
#[cfg(feature = "std")]
pub mod linear;
#[cfg(feature = "std")]
pub mod loop_joints;
#[cfg(feature = "std")]
pub mod margins;
#[cfg(feature = "std")]
mod memory;
#[cfg(feature = "std")]
pub mod modes;
#[cfg(feature = "std")]
pub mod results;
pub mod rt;
#[cfg(feature = "std")]
pub mod runs;
#[cfg(feature = "std")]
pub mod sections;
#[cfg(feature = "std")]
pub mod stability;
#[cfg(feature = "std")]
mod state_at;
#[cfg(feature = "std")]
mod stateful_force;
#[cfg(feature = "std")]
pub mod statics;
#[cfg(feature = "std")]
pub mod tipping;

#[cfg(feature = "std")]
pub use crane_quantities::Tree;
pub use crane_quantities::{
    AttachmentInfo, BodyInfo, Bound, BristleInfo, ColumnKind, ConditionInfo, ConnectorInfo, CoordinateInfo,
    CoordinateKind, CoordinateRole, Count, Cut, CylinderInfo, Description, DisplayUnit, DriveInfo, EventInfo,
    InputInfo, JoinsInfo, LARGE_TILT, List, LoadInfo, LoopEquationInfo, LoopJointInfo, Moment, NEAR_SINGULAR,
    ParameterError, ParameterInfo, Part, PumpInfo, Refusal, SectionInfo, Side, StageInfo, SupportInfo, TIPPED, Text,
    ValveInfo,
};
pub use links::fill_links;
pub use model::{CraneModel, LaneDynamics, Linearisation, OneByOne};
/// The linear algebra of every signature, so that generated code needs only this crate.
pub use nalgebra;
#[cfg(feature = "std")]
pub use state_at::StateAt;
pub use stress::SectionModuli;
#[cfg(feature = "std")]
pub use stress::Stress;
pub use wrench::{Tension, Wrench};
