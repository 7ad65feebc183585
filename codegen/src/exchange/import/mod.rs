//! A robot described in URDF as a spec: `crane import`.
//!
//! ```text
//! SourceFile ─robot::read→ Robot ─serial::chain→ groups of links ─links::links→ links of a spec ─yaml::write→ text
//! ```
//!
//! Links that fixed joints hold together become one link of several bodies, frames without mass at their ends points. Joints
//! keep their coordinates: where the axis of a joint is none of x, y, z, the frame of the link is turned so that it is.

mod links;
mod mistakes;
mod robot;
mod serial;
mod yaml;

pub use mistakes::CATALOGUE;

use crate::diagnostic::{Diagnostics, SourceFile};

/// The spec of a robot, as commented YAML. `fixed`: joints that are held at zero.
///
/// Masses and inertias are passed on as they are: whether they are sound is for the reader of the spec to say.
///
/// # Errors
/// What is wrong with the file, or cannot be a crane: branches, joints other than of one axis or fixed.
pub fn import(source: &SourceFile, fixed: &[String]) -> Result<String, Diagnostics> {
    let told = |mistakes| Diagnostics::new(source, mistakes);
    let robot = robot::read(source).map_err(told)?;
    let groups = serial::chain(&robot, fixed).map_err(told)?;
    Ok(yaml::write(&robot, &links::links(&groups), source))
}
