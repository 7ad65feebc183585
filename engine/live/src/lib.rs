//! A crane from a spec without rustc, for any number of coordinates: its functions as bytecode, for one state or eight at a time.
//!
//! ```
//! use crane_codegen::SourceFile;
//! use crane_live::LiveCrane;
//! use crane_model::dyn_crane::Functions;
//!
//! let text = "
//! format: 1
//! name: pendulum
//! links:
//!   - name: rod
//!     joint: {revolute: {axis: y}}
//!     mass: 2
//!     com: [0.5, 0, 0]
//!     inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}
//! ";
//! let crane = LiveCrane::from_spec(&SourceFile::new("pendulum.yaml", text))?;
//! let mut acceleration = vec![0.0; crane.size()];
//! crane.forward_dynamics(0.0, &[0.0], &[0.0], &mut acceleration);
//! // m g l / (J + m l²)
//! assert!((acceleration[0] - 2.0 * 9.81 * 0.5 / (0.05 + 2.0 * 0.25)).abs() < 1e-12);
//! # Ok::<(), crane_codegen::Diagnostics>(())
//! ```

pub mod assemble;
pub mod bytecode;
mod crane;
mod derivatives;
mod dual;
mod expansion;
pub mod imported;
mod inputs;
mod library;
pub mod machine;
mod motion;
mod native;
pub mod products;
mod reach;
mod refusal;
mod routine;
pub mod sensitivity;
mod sines;
mod steered;
mod tangent;

pub use crane::{Evaluation, LiveCrane, rows};
pub use crane_codegen::program::FunctionId;
pub use dual::{DIRECTIONS, Dual8};
pub use motion::Motion;
pub use reach::Reach;
pub use refusal::Refusal;
pub use routine::Routine;
pub use steered::{Hold, SteeredMotion};
