//! Positions and orientations.

use super::File;
use crate::chain::{Axis, Frame, Value, Vector, cross};
use crate::exchange::import::document::{Element, Reader};
use crate::exchange::import::mistakes::rule;
use crate::exchange::rotation::{about, from_quaternion, length};

/// How a file writes angles.
pub(super) struct Angles {
    /// Radians in a unit of angle.
    pub(super) unit: f64,
    /// Axes of the Euler angles: lower-case letters are axes of the rotated frame, upper-case letters axes of the initial frame.
    sequence: [char; 3],
}

impl Default for Angles {
    fn default() -> Self {
        Self { unit: 1_f64.to_radians(), sequence: ['x', 'y', 'z'] }
    }
}

impl Angles {
    /// The settings of a `<compiler>`.
    pub(super) fn read(&mut self, node: Element, reader: &mut Reader) {
        if let Some(unit) = node.text("angle") {
            self.unit = if unit == "radian" { 1.0 } else { 1_f64.to_radians() };
        }
        let Some(attribute) = node.attribute("eulerseq") else { return };
        let letters: Vec<char> = attribute.value().chars().collect();
        match <[char; 3]>::try_from(letters) {
            Ok(letters) if letters.iter().all(|letter| "xyzXYZ".contains(*letter)) => self.sequence = letters,
            _ => reader.wrong_numbers(attribute, "`eulerseq` of <compiler>", "three letters of x, y, z, X, Y, Z"),
        }
    }
}

/// The ways to write an orientation.
const ORIENTATIONS: [&str; 5] = ["quat", "axisangle", "xyaxes", "zaxis", "euler"];

impl<'a, 'i> File<'a, 'i> {
    /// Position and orientation of an element in the frame around it.
    pub(super) fn pose(&mut self, node: Element<'a, 'i>, class: Option<&str>, owner: &str) -> Frame {
        let origin = self.numbers(node, class, "pos", owner).unwrap_or([0.0; 3]);
        Frame { origin, ..self.orientation(node, class, owner) }
    }

    /// Orientation of an element in the frame around it.
    pub(super) fn orientation(&mut self, node: Element<'a, 'i>, class: Option<&str>, owner: &str) -> Frame {
        let Some(element) = self.classes.with_any(node, class, &ORIENTATIONS) else { return Frame::WORLD };
        let keys: Vec<&str> = ORIENTATIONS.into_iter().filter(|key| element.has(key)).collect();
        let [key] = keys.as_slice() else {
            let both = keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(" and ");
            self.reader.mistakes.push(rule::two_orientations(element.tag(), owner, both));
            return Frame::WORLD;
        };
        // Numbers that could not be read are already reported; a direction without length is reported here.
        let frame = match *key {
            "quat" => self.numbers_of::<4>(element, key, owner).map(from_quaternion),
            "axisangle" => self.numbers_of::<4>(element, key, owner).map(|[x, y, z, angle]| {
                let axis = unit([x, y, z])?;
                Some(about(axis, angle * self.angles.unit))
            }),
            "xyaxes" => {
                self.numbers_of::<6>(element, key, owner).map(|[a, b, c, d, e, f]| from_x_and_y([a, b, c], [d, e, f]))
            }
            "zaxis" => self.numbers_of::<3>(element, key, owner).map(with_z_along),
            _ => self.numbers_of::<3>(element, key, owner).map(|angles| Some(self.euler(angles))),
        };
        if let Some(None) = frame {
            self.reader.mistakes.push(rule::no_orientation(element.tag(), owner, key));
        }
        frame.flatten().unwrap_or(Frame::WORLD)
    }

    /// Numbers of an element's own attribute.
    fn numbers_of<const N: usize>(&mut self, node: Element, key: &str, owner: &str) -> Option<[f64; N]> {
        self.reader.exact_numbers(node.attribute(key)?, &format!("`{key}` of {owner}"))
    }

    /// Rotations about three axes, one after the other.
    fn euler(&self, angles: Vector) -> Frame {
        self.angles.sequence.iter().zip(angles).fold(Frame::WORLD, |frame, (letter, angle)| {
            let axis = match letter.to_ascii_lowercase() {
                'x' => Axis::X,
                'y' => Axis::Y,
                _ => Axis::Z,
            };
            // Quarter turns are exact.
            let (sin, cos) = Value::Constant(angle * self.angles.unit).sin_cos();
            let turn = Frame::WORLD.rotated(axis, sin.at(&[]), cos.at(&[]));
            if letter.is_ascii_lowercase() { frame.outer(&turn) } else { turn.outer(&frame) }
        })
    }
}

/// A direction of length 1.
pub(super) fn unit(vector: Vector) -> Option<Vector> {
    let size = length(vector);
    (size > 0.0).then(|| vector.map(|component| component / size))
}

/// A frame by its x axis, and a direction in the plane of x and y.
fn from_x_and_y(x: Vector, y: Vector) -> Option<Frame> {
    let x = unit(x)?;
    let along: f64 = (0..3).map(|i| x[i] * y[i]).sum();
    let y = unit([0, 1, 2].map(|i| y[i] - along * x[i]))?;
    Some(Frame { axes: [x, y, cross(x, y)], origin: [0.0; 3] })
}

/// A frame with z along a direction, rotated about the axis perpendicular to both; half a turn is about x.
fn with_z_along(direction: Vector) -> Option<Frame> {
    let [x, y, z] = unit(direction)?;
    let across = x.hypot(y);
    let axis = if across > 0.0 { [-y / across, x / across, 0.0] } else { [1.0, 0.0, 0.0] };
    Some(about(axis, across.atan2(z)))
}
