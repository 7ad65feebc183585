//! A robot described in URDF as a spec: `crane import`.
//!
//! ```text
//! SourceFile ─robot::read→ Robot ─serial::chain→ groups of links ─links::links→ links of a spec ─yaml::write→ text
//! ```
//!
//! Links connected by fixed joints become one link of several bodies; massless frames at their ends become points. Joints
//! keep their coordinates: if the axis of a joint is not x, y or z, the frame of the link is rotated so that it is.

mod links;
mod mistakes;
mod robot;
mod serial;
mod yaml;

pub use mistakes::CATALOGUE;

use crate::diagnostic::{Diagnostics, SourceFile};

/// The spec of a robot, as commented YAML. `fixed`: joints that are held at zero.
///
/// Masses and inertias are passed on unchanged; the validation of the spec checks them.
///
/// # Errors
/// Mistakes in the file, and structures that cannot be a crane: branches, and joints that are neither fixed nor about or along
/// one axis.
pub fn import(source: &SourceFile, fixed: &[String]) -> Result<String, Diagnostics> {
    let told = |mistakes| Diagnostics::new(source, mistakes);
    let robot = robot::read(source).map_err(told)?;
    let groups = serial::chain(&robot, fixed).map_err(told)?;
    Ok(yaml::write(&robot, &links::links(&groups), source))
}
