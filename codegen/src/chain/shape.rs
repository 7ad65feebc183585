//! What links look like.

use std::sync::Arc;

use super::{BodyId, Chain, Frame, Step, Value, Vector};

/// A form of a body in pictures, without any effect on its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The body that carries it.
    pub body: BodyId,
    /// The way to its frame from that of the body: translations and rotations.
    pub path: Vec<Step>,
    /// Its form.
    pub form: Form<Value>,
}

/// A form about the origin of its frame; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Form<T = f64> {
    /// A box with sides along x, y and z.
    Box([T; 3]),
    /// A cylinder along z.
    Cylinder {
        /// Its diameter.
        diameter: T,
        /// Its length.
        length: T,
    },
    /// A cylinder along z with half balls at its ends.
    Capsule {
        /// Its diameter.
        diameter: T,
        /// Its length between the middles of the half balls; 0 of a ball.
        length: T,
    },
    /// A surface in a file.
    Mesh {
        /// The file, as exported files name it.
        file: String,
        /// Factor of its coordinates.
        scale: f64,
        /// What is in the file, if somebody has read it: exported files only name it.
        surface: Option<Arc<Surface>>,
    },
}

/// Triangles of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Corners, in the unit of the file.
    pub corners: Vec<Vector>,
    /// Indices of the corners of each triangle, counter-clockwise as seen from outside.
    pub triangles: Vec<[usize; 3]>,
}

impl Shape {
    /// Its form, and its pose in the frame of the body.
    ///
    /// # Panics
    /// If `parameters` is shorter than the chain's list of parameters.
    #[must_use]
    pub fn at(&self, chain: &Chain, parameters: &[f64]) -> (Frame, Form) {
        let frame = self.path.iter().fold(Frame::WORLD, |frame, step| frame.after(step, chain, &[], parameters));
        let number = |value: &Value| value.at(parameters);
        let form = match &self.form {
            Form::Box(sides) => Form::Box(sides.each_ref().map(number)),
            Form::Cylinder { diameter, length } => {
                Form::Cylinder { diameter: number(diameter), length: number(length) }
            }
            Form::Capsule { diameter, length } => Form::Capsule { diameter: number(diameter), length: number(length) },
            Form::Mesh { file, scale, surface } => {
                Form::Mesh { file: file.clone(), scale: *scale, surface: surface.clone() }
            }
        };
        (frame, form)
    }
}

impl Form {
    /// Sides of the box around it along x, y and z, m; of a mesh nothing: see its surface.
    #[must_use]
    pub fn sides(&self) -> Vector {
        match *self {
            Form::Box(sides) => sides,
            Form::Cylinder { diameter, length } => [diameter, diameter, length],
            Form::Capsule { diameter, length } => [diameter, diameter, length + diameter],
            Form::Mesh { .. } => [0.0; 3],
        }
    }
}
