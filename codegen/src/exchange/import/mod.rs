//! A robot described in URDF or MJCF as a spec: `crane import`.
//!
//! ```text
//! SourceFile ─urdf::read_robot, mjcf::read_robot→ Robot ─groups::groups→ groups of links
//!     ─links::links→ links of a spec ─yaml::write_spec→ text
//! ```
//!
//! Links connected by fixed joints become one link of several bodies; massless frames at their ends become points. Joints
//! keep their coordinates: if the axis of a joint is not x, y or z, the frame of the link is rotated so that it is.

mod document;
mod groups;
mod links;
mod mistakes;
mod mjcf;
mod robot;
mod urdf;
mod yaml;

pub use mistakes::CATALOGUE;

use crate::diagnostic::{Diagnostics, SourceFile};

/// A robot as a spec.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Imported {
    /// The spec, commented YAML.
    pub spec: String,
    /// What the robot has and the spec does not, one sentence each.
    pub left_out: Vec<String>,
}

/// The spec of a robot in URDF or MJCF; the root of the file decides which. `fixed`: joints that are held at zero.
///
/// Masses and inertias are passed on unchanged; the validation of the spec checks them.
///
/// # Errors
/// Mistakes in the file, and structures that cannot be a crane: closed loops, and joints that are neither fixed nor about or along
/// one axis.
pub fn import(source: &SourceFile, fixed: &[String]) -> Result<Imported, Diagnostics> {
    let diagnostics = |mistakes| Diagnostics::new(source, mistakes);
    let document = document::parse(source).map_err(diagnostics)?;
    let root = document.root_element();
    let robot = match root.tag_name().name() {
        "robot" => urdf::read_robot(root),
        "mujoco" => mjcf::read_robot(root),
        _ => Err(vec![mistakes::rule::not_a_robot(document::tag(root), document::name_of(root))]),
    };
    let robot = robot.map_err(diagnostics)?;
    let groups = groups::groups(&robot, fixed).map_err(diagnostics)?;
    let spec = yaml::write_spec(&robot, &links::links(&groups), source);
    Ok(Imported { spec, left_out: robot.left_out })
}
