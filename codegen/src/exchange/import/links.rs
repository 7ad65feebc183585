//! Groups of a robot's links as links of a spec.

use std::collections::BTreeSet;

use super::groups::Group;
use super::robot::{Joint, Motion};
use crate::chain::{Axis, CRATES, Form, Frame, LONGEST_NAME, Vector};
use crate::exchange::free_name;
use crate::exchange::mass::{Lump, clean};
use crate::exchange::rotation::along_z;

/// A link of a spec.
pub(super) struct SpecLink<'r> {
    pub(super) name: String,
    /// Name of the robot's link; `joint` is the joint that moves it.
    pub(super) was: &'r str,
    pub(super) joint: Option<&'r Joint>,
    /// Joints without mass before it that are part of a free base, in order.
    pub(super) before: Vec<&'r Joint>,
    /// The index of the link that carries it; `None` if it stands on the world.
    pub(super) on: Option<usize>,
    /// Pose in the frame of that link.
    pub(super) placement: Frame,
    pub(super) motion: SpecMotion,
    pub(super) bodies: Vec<(String, Lump)>,
    /// What it looks like.
    pub(super) shapes: Vec<(Frame, Form)>,
    /// Frames without mass at the ends of the group: name, name of the robot's link, and place.
    pub(super) points: Vec<(String, &'r str, Vector)>,
    /// Whether its frame is turned from that of the robot's link, onto the axis of its joint.
    pub(super) turned: bool,
    /// Joints in it that do not move, and where they stand, m or rad.
    pub(super) held: Vec<(&'r Joint, f64)>,
    /// Frames of the file that move with it.
    pub(super) frames: Vec<FileFrame<'r>>,
}

/// A frame of the file: its name, and its pose in the frame of the link of the spec, or in the world.
pub(super) type FileFrame<'r> = (&'r str, Frame);

/// What a robot's groups of links become.
pub(super) struct Links<'r> {
    /// Links of the spec.
    pub(super) of_spec: Vec<SpecLink<'r>>,
    /// Frames of the file that do not move.
    pub(super) standing: Vec<FileFrame<'r>>,
    /// Frames of the file between axes of a free base, which a spec does not have.
    pub(super) lost: Vec<&'r str>,
}

/// How it moves.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum SpecMotion {
    Fixed,
    Revolute(Axis),
    Prismatic(Axis),
    /// A base with these motions, in the order of the language.
    Free(Vec<(bool, Axis)>),
}

impl<'r> SpecLink<'r> {
    /// Its joints with the names of their coordinates, in order.
    pub(super) fn joints(&self) -> impl Iterator<Item = (&'r Joint, String)> {
        self.before.iter().copied().chain(self.joint).zip(self.motion.coordinates(&self.name))
    }

    /// Makes the inertia of all its bodies together possible, if it is not; returns what was changed.
    fn repair(&mut self) -> Option<String> {
        let lumps: Vec<Lump> = self.bodies.iter().map(|(_, lump)| lump.clone()).collect();
        let sum = Lump::sum(&lumps)?;
        let repaired = sum.repaired()?;
        let written = |lump: &Lump| lump.tensor.map(|moment| format!("{moment:.6}").parse().unwrap_or(moment));
        let remark = format!(
            "Repaired: the inertia of link `{}` about its centre of mass, {:?} kg m², is impossible; written is {:?} \
             (Ixx, Iyy, Izz, Ixy, Ixz, Iyz).",
            self.name,
            written(&sum),
            written(&repaired)
        );
        self.bodies = vec![(self.name.clone(), repaired)];
        Some(remark)
    }
}

impl SpecMotion {
    /// Names of the coordinates that it gives a link.
    pub(super) fn coordinates(&self, link: &str) -> Vec<String> {
        let letter = |turns: bool, axis: Axis| {
            let letters = if turns { ["phi", "theta", "psi"] } else { ["x", "y", "z"] };
            format!("{link}_{}", letters[axis.index()])
        };
        match self {
            SpecMotion::Fixed => Vec::new(),
            SpecMotion::Revolute(axis) => vec![letter(true, *axis)],
            SpecMotion::Prismatic(axis) => vec![letter(false, *axis)],
            SpecMotion::Free(motions) => motions.iter().map(|(turns, axis)| letter(*turns, *axis)).collect(),
        }
    }
}

/// Links of a spec, one per group; the fixed group is left out if it has no mass and carries one group.
///
/// `tied`: names of joints in springs or equations with other joints, which no free base can have. `repair`: inertias of links that are not
/// possible become the nearest possible ones; what was changed is added to it.
pub(super) fn links<'r>(
    groups: &[Group<'r>],
    tied: &BTreeSet<&str>,
    mut repair: Option<&mut Vec<String>>,
) -> Links<'r> {
    let mut standing = Vec::new();
    let mut names = Names::default();
    let mut links: Vec<SpecLink> = Vec::new();
    // For each group, its link, and the frame of that link expressed in the frame of the robot's link.
    let mut done: Vec<(Option<usize>, Frame)> = Vec::new();
    for group in groups {
        let Some((carrier, _)) = group.links.first() else { continue };
        let (on, before) = group.carrier.map_or((None, Frame::WORLD), |carrier| done[carrier]);
        let (mut placement, mut motion) = (Frame::WORLD, SpecMotion::Fixed);
        let mut rotated = Frame::WORLD;
        if let Some((joint, at)) = &group.joint {
            let (axis, frame) = onto_an_axis(joint.axis);
            rotated = frame;
            placement = before.local(&at.outer(&rotated));
            motion = if matches!(joint.motion, Motion::Revolute) {
                SpecMotion::Revolute(axis)
            } else {
                SpecMotion::Prismatic(axis)
            };
        }
        let mut link = SpecLink {
            name: String::new(),
            was: &carrier.name,
            joint: group.joint.map(|(joint, _)| joint),
            before: Vec::new(),
            on,
            placement,
            motion,
            bodies: Vec::new(),
            shapes: Vec::new(),
            points: Vec::new(),
            turned: rotated != Frame::WORLD,
            held: group.held.clone(),
            frames: Vec::new(),
        };
        let mut bodies = Names::default();
        let ends = group.links.len() > 1 && link.joint.is_some();
        for (index, (member, frame)) in group.links.iter().enumerate() {
            let pose = rotated.local(frame);
            link.shapes.extend(member.shapes.iter().map(|(at, form)| (pose.outer(at), form.clone())));
            link.frames.extend(member.frame.map(|own| (member.name.as_str(), pose.outer(&own))));
            match &member.lump {
                Some(lump) => link.bodies.push((bodies.unique(&member.name), lump.seen_through(&pose))),
                None if ends && index > 0 => link.points.push((String::new(), &member.name, clean(pose.origin))),
                None => {}
            }
        }
        let carried = groups.iter().filter(|other| other.carrier == Some(done.len())).count();
        let is_link = link.joint.is_some() || !link.bodies.is_empty() || carried > 1;
        done.push((is_link.then_some(links.len()).or(on), rotated));
        if is_link {
            // The fixed group is named after what it carries, not `world`.
            let heavy = group.links.iter().find(|(member, _)| member.lump.is_some() && link.joint.is_none());
            link.was = &heavy.map_or(carrier, |(heavy, _)| heavy).name;
            link.name = names.unique(link.was);
            if let Some(changes) = repair.as_deref_mut().filter(|_| link.joint.is_some()) {
                changes.extend(link.repair());
            }
            links.push(link);
        } else {
            standing.extend(link.frames);
        }
    }
    let lost = free_base(&mut links, tied);
    let mut points = Names(links.iter().flat_map(|link| link.motion.coordinates(&link.name)).collect());
    for (name, was, _) in links.iter_mut().flat_map(|link| &mut link.points) {
        *name = points.unique_point(was);
    }
    Links { of_spec: links, standing, lost }
}

/// Combines joints along x, y, z and about z, y, x at the start of the chain, which carry only the next joint, into a free
/// base. Returns the frames of the file between them.
fn free_base<'r>(links: &mut Vec<SpecLink<'r>>, tied: &BTreeSet<&str>) -> Vec<&'r str> {
    /// x, y, z, psi, theta, phi.
    const ORDER: [(bool, Axis); 6] =
        [(false, Axis::X), (false, Axis::Y), (false, Axis::Z), (true, Axis::Z), (true, Axis::Y), (true, Axis::X)];
    let mut motions: Vec<(bool, Axis)> = Vec::new();
    let mut next = 0;
    for (index, link) in links.iter().enumerate() {
        // A free base has neither springs nor dampers of its own.
        if !link.joint.is_some_and(|joint| joint.is_plain() && !tied.contains(joint.name.as_str())) {
            return Vec::new();
        }
        let motion = match link.motion {
            SpecMotion::Prismatic(axis) => (false, axis),
            SpecMotion::Revolute(axis) => (true, axis),
            _ => return Vec::new(),
        };
        let Some(found) = ORDER[next..].iter().position(|other| *other == motion) else { return Vec::new() };
        if index > 0 && (link.placement != Frame::WORLD || link.on != Some(index - 1)) {
            return Vec::new();
        }
        // It carries nothing else.
        if links.iter().skip(index + 2).any(|other| other.on == Some(index)) && link.bodies.is_empty() {
            return Vec::new();
        }
        next += found + 1;
        motions.push(motion);
        if !link.bodies.is_empty() || !link.points.is_empty() {
            break;
        }
    }
    let mut lost = Vec::new();
    // A single motion is an ordinary joint.
    if motions.len() > 1 && links.get(motions.len() - 1).is_some_and(|base| !base.bodies.is_empty()) {
        let placement = links[0].placement;
        let removed = motions.len() - 1;
        let before: Vec<SpecLink> = links.drain(..removed).collect();
        lost.extend(before.iter().flat_map(|link| &link.frames).map(|(name, _)| *name));
        for link in links.iter_mut() {
            link.on = link.on.and_then(|on| on.checked_sub(removed));
        }
        links[0].before = before.into_iter().filter_map(|link| link.joint).collect();
        links[0].placement = placement;
        links[0].motion = SpecMotion::Free(motions);
    }
    lost
}

/// A frame with an axis along a direction, and which axis that is: x, y or z. The frame is expressed in the frame of the
/// direction, and is the identity where possible.
fn onto_an_axis(direction: Vector) -> (Axis, Frame) {
    for (index, axis) in [Axis::X, Axis::Y, Axis::Z].into_iter().enumerate() {
        // Half a turn about another axis makes a negative direction positive.
        let other = if axis == Axis::Z { Axis::X } else { Axis::Z };
        if direction[index] == 1.0 {
            return (axis, Frame::WORLD);
        } else if direction[index] == -1.0 {
            return (axis, Frame::WORLD.rotated(other, 0.0, -1.0));
        }
    }
    (Axis::Z, along_z(direction))
}

/// Names that are in use.
#[derive(Default)]
pub(super) struct Names(BTreeSet<String>);

impl Names {
    /// An identifier derived from a name, not in use yet.
    pub(super) fn unique(&mut self, name: &str) -> String {
        self.free(&identifier(name), &|_, _| true)
    }

    /// The same for a point, whose result columns, `<point>_x` …, must differ from those of the coordinates.
    fn unique_point(&mut self, name: &str) -> String {
        let fits = |taken: &BTreeSet<String>, name: &str| {
            ["x", "y", "z"].iter().all(|letter| !taken.contains(&format!("{name}_{letter}")))
        };
        self.free(&identifier(name), &fits)
    }

    fn free(&mut self, name: &str, fits: &dyn Fn(&BTreeSet<String>, &str) -> bool) -> String {
        free_name(&mut self.0, name, fits)
    }
}

/// A `snake_case` identifier that the language does not reserve.
pub(super) fn identifier(name: &str) -> String {
    /// Room for what makes a name unique.
    const ENDING: usize = 6;
    let mut text = String::new();
    let mut lower = false;
    for c in name.chars() {
        if text.len() + ENDING >= LONGEST_NAME {
            break;
        }
        if c.is_ascii_uppercase() && lower {
            text.push('_');
        }
        lower = c.is_ascii_lowercase() || c.is_ascii_digit();
        text.push(if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' });
    }
    let text = text.trim_matches('_');
    let is_keyword = text == "gen" || CRATES.contains(&text) || syn::parse_str::<syn::Ident>(text).is_err();
    match text.chars().next() {
        None => "link".to_owned(),
        Some(first) if !first.is_ascii_lowercase() => format!("link_{text}"),
        Some(_) if is_keyword => format!("{text}_1"),
        Some(_) => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        for (name, expected) in [
            ("panda_link0", "panda_link0"),
            ("LeftArm", "left_arm"),
            ("wrist-3 link", "wrist_3_link"),
            ("3rd", "link_3rd"),
            ("move", "move_1"),
            ("gen", "gen_1"),
            ("core", "core_1"),
            ("__", "link"),
            ("Größe", "gr__e"),
        ] {
            assert_eq!(identifier(name), expected);
        }
        assert!(identifier(&"a".repeat(100)).len() < LONGEST_NAME);
        let mut names = Names::default();
        assert_eq!([names.unique("a"), names.unique("A"), names.unique("a")], ["a", "a_2", "a_3"]);
    }

    #[test]
    fn a_frame_is_turned_onto_the_axis_of_its_joint() {
        for direction in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [0.6, 0.0, -0.8]] {
            let (axis, frame) = onto_an_axis(direction);
            for k in 0..3 {
                assert!((frame.axes[axis.index()][k] - direction[k]).abs() < 1e-15, "{direction:?}");
            }
        }
    }
}
