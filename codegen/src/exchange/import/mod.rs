//! A robot described in URDF or MJCF as a spec: `crane import`.
//!
//! ```text
//! SourceFile ─urdf::read_robot, mjcf::read_robot→ Robot ─split::split_joints→ Robot ─groups::groups→ groups of links
//!     ─links::links→ links of a spec ─yaml::write_spec→ text
//! ```
//!
//! Links connected by fixed joints become one link of several bodies; massless frames at their ends become points. Joints
//! keep their coordinates: if the axis of a joint is not x, y or z, the frame of the link is rotated so that it is. Frames of the file that
//! are no longer those of links with their names are `frames` of the spec; `joints` has the names and the order of its joints.

mod document;
mod groups;
mod includes;
mod links;
mod mistakes;
mod mjcf;
mod reference;
mod robot;
mod split;
mod urdf;
mod yaml;

pub use includes::with_includes;
pub use mistakes::CATALOGUE;
pub use reference::{Reference, ReferenceDynamics};

use crate::diagnostic::{Diagnostics, SourceFile};
use document::Element;
use links::Links;

/// How a robot is converted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// Joints that are held at zero.
    pub fixed: Vec<String>,
    /// Whether inertias that are not possible become the nearest possible ones.
    pub repair: bool,
}

/// A robot as a spec.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The spec, commented YAML.
    pub spec: String,
    /// What the robot has and the spec does not, and what was changed, one sentence each.
    pub left_out: Vec<String>,
    /// The robot link by link, to compare the spec with; `None` if inertias were repaired.
    pub reference: Option<Reference>,
}

/// The spec of a robot in URDF or MJCF; the root of the file decides which.
///
/// Without `repair`, masses and inertias are passed on unchanged; the validation of the spec checks them.
///
/// # Errors
/// Mistakes in the file, and structures that cannot be a crane: closed loops, joints of unknown kinds, and those with several
/// axes on which forces act.
pub fn import(source: &SourceFile, options: &ImportOptions) -> Result<Imported, Diagnostics> {
    let diagnostics = |mistakes| Diagnostics::new(source, mistakes);
    let document = document::parse(source).map_err(diagnostics)?;
    let notes = document::Notes::default();
    let root = Element::root(&document, &notes);
    let robot = match root.local_name() {
        "robot" => urdf::read_robot(root),
        "mujoco" => mjcf::read_robot(root),
        _ => Err(vec![mistakes::rule::not_a_robot(root.tag(), root.name())]),
    };
    let mut robot = robot.map_err(diagnostics)?;
    let mistakes = split::split_joints(&mut robot, &options.fixed);
    if !mistakes.is_empty() {
        return Err(diagnostics(mistakes));
    }
    reference::set_oscillations(&mut robot);
    let mut left_out = root.remarks();
    left_out.append(&mut robot.left_out);
    if robot.joints.iter().any(|joint| joint.range().is_some()) {
        left_out.push("Ranges of joints become comments: write `stops` for those that the crane reaches.".to_owned());
    }
    let held = groups::held(&robot, &options.fixed);
    let groups = groups::groups(&robot, &options.fixed, &held).map_err(diagnostics)?;
    let unrepaired = left_out.len();
    let Links { of_spec: links, standing, lost } =
        links::links(&groups, &robot.tied(), options.repair.then_some(&mut left_out));
    let repaired = left_out.len() > unrepaired;
    // Two joints that follow one need not be where it puts both.
    let stopped: Vec<_> = groups.iter().flat_map(|group| group.held.iter().copied()).collect();
    left_out.extend(stopped.iter().filter_map(|(joint, position)| {
        let asked = *held.get(joint.name.as_str())?;
        let leader = &joint.follows.as_ref()?.leader.name;
        let elsewhere = (asked - position).abs() > 1e-12 * asked.abs().max(1.0);
        elsewhere.then(|| {
            let [position, asked] = [*position, asked].map(yaml::decimal);
            format!("Joint `{}` is held at {position}, where `{leader}` puts it, and not at {asked}.", joint.name)
        })
    }));
    if !lost.is_empty() {
        let lost: Vec<String> = lost.into_iter().map(|name| format!("`{name}`")).collect();
        left_out.push(format!("Frames between axes of the free base are left out: {}.", lost.join(", ")));
    }
    let shown: usize = links.iter().map(|link| link.shapes.len()).sum();
    let lost = robot.links.iter().map(|link| link.shapes.len()).sum::<usize>() - shown;
    if lost > 0 {
        left_out.push(format!("Left out, shapes of what the spec does not have, such as the world: {lost}."));
    }
    let lost = robot.couplings.iter().filter(|coupling| yaml::coupled(coupling, &links).is_none());
    let told = lost.map(|coupling| format!("The spring `{}` is left out: one of its joints is held.", coupling.name));
    left_out.extend(told);
    let spec = yaml::write_spec(&robot, &links, &standing, &stopped, &left_out, source);
    let reference = (!repaired).then(|| Reference::new(&robot, &links));
    Ok(Imported { spec, left_out, reference })
}
