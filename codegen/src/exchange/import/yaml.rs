//! A spec as a person would write it.

use std::fmt::Write;
use std::path::Path;

use super::links::{FileFrame, Names, SpecLink, SpecMotion, identifier};
use super::robot::{Coupling, Follows, Joint, Motion, Robot, Spring};
use crate::chain::{Axis, Form, Frame, Vector};
use crate::diagnostic::{SourceFile, is_one_line, printable, quoted};
use crate::exchange::mass::{Lump, clean, without_rounding};
use crate::exchange::rotation::roll_pitch_yaw;
use crate::exchange::xml::number_text;

/// The text of a spec.
///
/// `standing`: frames of the robot in the world. `stopped`: joints that do not move, and where they stand, m or rad. `remarks`: what the spec
/// lacks of the robot, which stands at its head.
pub(super) fn write_spec(
    robot: &Robot,
    links: &[SpecLink],
    standing: &[FileFrame],
    stopped: &[(&Joint, f64)],
    remarks: &[String],
    source: &SourceFile,
) -> String {
    let file = Path::new(&source.name).file_name().unwrap_or_default().to_string_lossy();
    let (file, robot_name) = (plain(&file), plain(&robot.name));
    let mut text = format!("# The robot {robot_name}, from {file}. SI units; angles in rad, or written as `90 deg`.\n");
    text += "# Positions, velocities and zero positions of joints are those of the robot.\n";
    if links.iter().any(|link| link.turned) {
        text += "# Frames of links are those of the robot, except where `frame turned` says that z lies along the joint's axis; `frames` has the robot's.\n";
    }
    if !remarks.is_empty() {
        text += "# What the robot has and this spec does not:\n";
    }
    for remark in remarks {
        let _ = writeln!(text, "#   {}", remark.replace(char::is_control, "\u{fffd}"));
    }
    let _ =
        write!(text, "format: 1\nname: {}\ntitle: \"{robot_name}, from {file}\"\n\nlinks:\n", identifier(&robot.name));
    for (index, link) in links.iter().enumerate() {
        let carrier = link.on.filter(|on| Some(*on) != index.checked_sub(1)).map(|on| links[on].name.as_str());
        text += &link_text(link, carrier);
    }

    if let Some(gravity) = robot.gravity {
        let _ = writeln!(text, "gravity: {}               # m/s²\n", list(gravity));
    }
    let joints = || links.iter().flat_map(SpecLink::joints);
    let drives: Vec<String> = joints().filter_map(|(joint, name)| drive(joint, &name)).collect();
    text += &section("drives", "springs of joints, and joints that are held", &drives);
    let undriven = || joints().filter(|(joint, _)| joint.spring.is_none() && joint.held.is_none());
    let numbers = |given: &dyn Fn(&Joint) -> f64| -> Vec<String> {
        let found = undriven().map(|(joint, name)| (name, given(joint))).filter(|(_, number)| *number != 0.0);
        found.map(|(name, number)| format!("{name}: {}", decimal(number))).collect()
    };
    text += &section("damping", "N m s/rad, N s/m; omit joints with a drive", &numbers(&|joint| joint.damping));
    text += &section("armature", "rotors, kg m², kg", &numbers(&|joint| joint.armature));
    let rubbing = joints().filter(|(joint, _)| joint.friction > 0.0);
    let rubbing: Vec<String> =
        rubbing.map(|(joint, name)| format!("{name}: {{coulomb: {}}}", decimal(joint.friction))).collect();
    text += &section("friction", "N m, N", &rubbing);
    text += &couplings(robot, links);
    text += &section("joints", "of the robot, by its names, in its order", &joint_names(robot, links, stopped));
    let frames: Vec<String> = frames(links, standing);
    text += &section("frames", "of the robot, by its names", &frames);
    let points: Vec<_> = links.iter().flat_map(|link| link.points.iter().map(move |point| (link, point))).collect();
    if !points.is_empty() {
        text += "points:                         # frames without mass\n";
        for (link, (name, was, at)) in points {
            let was = if name == was { String::new() } else { format!("   # {}", plain(was)) };
            let _ = writeln!(text, "  - {{name: {name}, link: {}, at: {}}}{was}", link.name, list(*at));
        }
        text.push('\n');
    }
    let free = joints().filter(|(joint, _)| joint.held.is_none());
    let starts = free.filter_map(|(joint, name)| Some(format!("{name}: {}", decimal(joint.start?))));
    text += &section("guess", "the start, rad, m", &starts.collect::<Vec<_>>());
    if let (true, Some((_, name))) = (drives.is_empty(), joints().next()) {
        let _ = write!(
            text,
            "# {} To hold or move a joint, give it a spring and a damper:\n\
             # drives:\n\
             #   - {{coordinate: {name}, stiffness: 1e6, damping: 1e4, motion: {{quintic: {{from: 0, to: 0.5, duration: 2}}}}}}\n",
            robot.no_drives
        );
    }
    text
}

/// Frames of the robot, except those that are links of the spec with the same name.
fn frames(links: &[SpecLink], standing: &[FileFrame]) -> Vec<String> {
    let of_links = links.iter().flat_map(|link| link.frames.iter().map(move |frame| (Some(link.name.as_str()), frame)));
    let all = standing.iter().map(|frame| (None, frame)).chain(of_links);
    let differs = |(link, (name, pose)): &(Option<&str>, &FileFrame)| *link != Some(*name) || placement(pose).is_some();
    let written = all.filter(differs).filter(|(_, (name, _))| is_one_line(name));
    let line = |(link, (name, pose)): (Option<&str>, &FileFrame)| {
        let link = link.map_or_else(String::new, |link| format!(", link: {link}"));
        let transform = placement(pose).map_or_else(String::new, |text| format!(", transform: {{{text}}}"));
        format!("- {{name: {}{link}{transform}}}", quoted(name))
    };
    written.map(line).collect()
}

/// Joints of the robot that can move, in its order.
fn joint_names(robot: &Robot, links: &[SpecLink], stopped: &[(&Joint, f64)]) -> Vec<String> {
    let line = |joint: &Joint| {
        let held = || stopped.iter().find(|(other, _)| other.name == joint.name);
        let place = match coordinate_of(&joint.name, links) {
            Some(coordinate) => format!("coordinate: {coordinate}"),
            None => format!("at: {}", decimal(held()?.1)),
        };
        is_one_line(&joint.name).then(|| format!("- {{name: {}, {place}}}", quoted(&joint.name)))
    };
    robot.joints.iter().filter_map(line).collect()
}

/// A key with a comment and the lines under it; empty if there are none.
fn section(key: &str, comment: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    format!("{:<31} # {comment}\n  {}\n\n", format!("{key}:"), lines.join("\n  "))
}

/// The spring of a joint as a drive that holds it where the spring is relaxed; a joint that is held as a rigid drive.
fn drive(joint: &Joint, coordinate: &str) -> Option<String> {
    let rotor = if joint.armature == 0.0 { String::new() } else { format!(", armature: {}", decimal(joint.armature)) };
    let law = match (&joint.spring, joint.held) {
        (_, Some(held)) => format!("rigid: true, motion: {{hold: {}}}", decimal(held)),
        (Some(Spring { stiffness, rest }), None) => {
            let damping =
                if joint.damping == 0.0 { String::new() } else { format!(", damping: {}", decimal(joint.damping)) };
            format!("stiffness: {}{damping}, motion: {{hold: {}}}", decimal(*stiffness), decimal(*rest))
        }
        (None, None) => return None,
    };
    Some(format!("- {{coordinate: {coordinate}, {law}{rotor}}}"))
}

/// The coordinate that a joint has in a spec; `None` if it does not move.
fn coordinate_of(joint: &str, links: &[SpecLink]) -> Option<String> {
    links.iter().flat_map(SpecLink::joints).find(|(other, _)| other.name == joint).map(|(_, name)| name)
}

/// The coordinates of a spring between joints; `None` if one of them does not move.
pub(super) fn coupled(coupling: &Coupling, links: &[SpecLink]) -> Option<[String; 2]> {
    Some([coordinate_of(&coupling.follower, links)?, coordinate_of(&coupling.leader, links)?])
}

/// Joints that follow others, and springs between joints.
fn couplings(robot: &Robot, links: &[SpecLink]) -> String {
    let mut lines = Vec::new();
    let mut line = |name: &str, [follower, leading]: [String; 2], [ratio, offset]: [f64; 2], law: &str| {
        let offset = if offset == 0.0 { String::new() } else { format!("offset: {}, ", decimal(offset)) };
        let ratio = decimal(ratio);
        lines.push(format!(
            "- {{name: {name}, coordinate: {follower}, follows: {leading}, ratio: {ratio}, {offset}{law}}}"
        ));
    };
    let mut names = Names::default();
    for (joint, follower) in links.iter().flat_map(SpecLink::joints) {
        let Some(Follows { leader, multiplier, offset }) = &joint.follows else { continue };
        let Some(leading) = coordinate_of(&leader.name, links) else { continue };
        let name = names.unique(&format!("{follower}_follows"));
        line(&name, [follower, leading], [*multiplier, *offset], "rigid: true");
    }
    for coupling in &robot.couplings {
        let Some(ends) = coupled(coupling, links) else { continue };
        let law = format!("stiffness: {}, damping: {}", decimal(coupling.stiffness), decimal(coupling.damping));
        line(&names.unique(&coupling.name), ends, [coupling.ratio, coupling.offset], &law);
    }
    section("couplings", "joints that follow others, exactly or through springs", &lines)
}

/// A link; `on` is the one that carries it, unless it is the previous one.
fn link_text(link: &SpecLink, on: Option<&str>) -> String {
    let mut comments = Vec::new();
    match (link.joint, &link.motion) {
        (_, SpecMotion::Free(_)) => comments.push("the base, free".to_owned()),
        (Some(joint), _) => comments.push(format!("joint {}", plain(&joint.name))),
        (None, _) => comments.push("fixed".to_owned()),
    }
    if link.name != link.was {
        comments.push(format!("link {}", plain(link.was)));
    }
    if link.turned {
        comments.push("frame turned".to_owned());
    }
    let unit = |joint: &Joint| if matches!(joint.motion, Motion::Prismatic) { "m" } else { "rad" };
    if let Some((joint, [lower, upper])) = link.joint.and_then(|joint| Some((joint, joint.range()?))) {
        comments.push(format!("from {} to {} {}", decimal(lower), decimal(upper), unit(joint)));
    }
    let (zero, elsewhere): (Vec<_>, Vec<_>) = link.held.iter().partition(|(_, position)| *position == 0.0);
    if !zero.is_empty() {
        let names: Vec<String> = zero.iter().map(|(joint, _)| plain(&joint.name)).collect();
        comments.push(format!("held at zero: {}", names.join(", ")));
    }
    for (joint, position) in elsewhere {
        comments.push(format!("held at {} {}: {}", decimal(position), unit(joint), plain(&joint.name)));
    }
    let mut text = format!("  - {:<27} # {}\n", format!("name: {}", link.name), comments.join("; "));
    if let Some(carrier) = on {
        let _ = writeln!(text, "    on: {carrier}");
    }
    if let Some(placement) = placement(&link.placement) {
        let _ = writeln!(text, "    placement: {{transform: {{{placement}}}}}");
    }
    if let Some(motion) = motion(&link.motion) {
        let _ = writeln!(text, "    joint: {motion}");
    }
    match link.bodies.as_slice() {
        [] => {}
        [(_, lump)] => mass(lump).iter().for_each(|line| text += &["    ", line, "\n"].concat()),
        several => {
            text += "    bodies:\n";
            for (name, lump) in several {
                let _ = writeln!(text, "      - {{name: {name}, {}}}", mass(lump).join(", "));
            }
        }
    }
    match link.shapes.as_slice() {
        [] => {}
        [one] => {
            let _ = writeln!(text, "    shape: {}", shape(one));
        }
        several => {
            text += "    shape:\n";
            for one in several {
                let _ = writeln!(text, "      - {}", shape(one));
            }
        }
    }
    text.push('\n');
    text
}

/// A form with its pose.
fn shape((frame, form): &(Frame, Form)) -> String {
    let round = |diameter: f64, length: f64| format!("diameter: {}, length: {}", decimal(diameter), decimal(length));
    let (kind, keys) = match form {
        Form::Box(sides) => ("box", format!("size: {}", list(*sides))),
        Form::Cylinder { diameter, length } => ("cylinder", round(*diameter, *length)),
        Form::Capsule { diameter, length } => ("capsule", round(*diameter, *length)),
        Form::Mesh { file, .. } => ("mesh", format!("file: {}", quoted(file))),
    };
    let pose = pose("at", frame).map_or_else(String::new, |pose| format!(", {pose}"));
    format!("{{{kind}: {{{keys}{pose}}}}}")
}

/// Translation and rotation, unless they are zero.
fn placement(frame: &Frame) -> Option<String> {
    pose("translation", frame)
}

/// The same with another word for the translation.
fn pose(origin: &str, frame: &Frame) -> Option<String> {
    let mut parts = Vec::new();
    let at = clean(frame.origin);
    if at != [0.0; 3] {
        parts.push(format!("{origin}: {}", list(at)));
    }
    let [roll, pitch, yaw] = roll_pitch_yaw(frame).map(|angle| without_rounding(angle, 1.0));
    let turns = [("z", yaw), ("y", pitch), ("x", roll)].into_iter().filter(|(_, angle)| *angle != 0.0);
    let turns: Vec<String> = turns.map(|(axis, turn)| format!("{{{axis}: {}}}", angle(turn))).collect();
    match turns.as_slice() {
        [] => {}
        [one] => parts.push(format!("rotation: {one}")),
        several => parts.push(format!("rotation: [{}]", several.join(", "))),
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}

fn motion(motion: &SpecMotion) -> Option<String> {
    let of = |kind: &str, axis: &Axis| match axis {
        Axis::Z => kind.to_owned(),
        Axis::X => format!("{{{kind}: {{axis: x}}}}"),
        Axis::Y => format!("{{{kind}: {{axis: y}}}}"),
    };
    match motion {
        SpecMotion::Fixed => None,
        SpecMotion::Revolute(axis) => Some(of("revolute", axis)),
        SpecMotion::Prismatic(axis) => Some(of("prismatic", axis)),
        SpecMotion::Free(motions) if motions.len() == 6 => Some("free".to_owned()),
        SpecMotion::Free(_) => {
            let names = motion.coordinates("").join(", ").replace('_', "");
            Some(format!("{{free: [{names}]}}"))
        }
    }
}

/// Mass, centre of mass, inertia: one key each.
fn mass(Lump { mass, com, tensor }: &Lump) -> Vec<String> {
    let mut lines = vec![format!("mass: {}", decimal(*mass)), format!("com: {}", list(*com))];
    if *tensor != [0.0; 6] {
        let keys = ["Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"].into_iter().zip(tensor).enumerate();
        let given = keys.filter(|(index, (_, entry))| *index < 3 || **entry != 0.0);
        let given: Vec<String> = given.map(|(_, (key, entry))| format!("{key}: {}", decimal(*entry))).collect();
        lines.push(format!("inertia: {{{}}}", given.join(", ")));
    }
    lines
}

fn list(vector: Vector) -> String {
    format!("[{}]", vector.map(decimal).join(", "))
}

/// An angle: in degrees if it is a multiple of 5°, otherwise in rad.
fn angle(angle: f64) -> String {
    let degrees = angle.to_degrees();
    let round = (degrees / 5.0).round() * 5.0;
    // A few rounding errors of matrices between the file and here.
    if (degrees - round).abs() <= 1e-15 * 180.0 { format!("{} deg", number_text(round)) } else { decimal(angle) }
}

/// The shortest decimal number that is equal up to a few rounding errors: 0.3 for 0.30000000000000004.
pub(super) fn decimal(number: f64) -> String {
    /// About five rounding errors.
    const ROUNDING: f64 = 1e-15;
    /// Smaller numbers are not allowed in a spec (E033): they are residues of rounding.
    const LEAST: f64 = 1e-30;
    if number.abs() < LEAST {
        return number_text(0.0);
    }
    let rounded = (0..17).map(|digits| format!("{number:.digits$e}").parse().unwrap_or(number));
    let short = rounded.into_iter().find(|short: &f64| (short - number).abs() <= ROUNDING * number.abs());
    number_text(short.unwrap_or(number))
}

/// A name on one line, without characters that would end a comment or a text.
fn plain(name: &str) -> String {
    printable(name).replace(['"', '\\'], "'")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn numbers_are_as_short_as_they_may_be() {
        for (number, text) in
            [(0.1 + 0.2, "0.3"), (1.0 / 3.0, "0.333333333333333"), (-2.0, "-2"), (0.0, "0"), (1.57, "1.57")]
        {
            assert_eq!(decimal(number), text);
        }
        for (turn, text) in [(FRAC_PI_2, "90 deg"), (-PI, "-180 deg"), (PI / 12.0, "15 deg"), (1.2345, "1.2345")] {
            assert_eq!(angle(turn), text);
        }
    }
}
