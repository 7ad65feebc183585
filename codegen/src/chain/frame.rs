//! Numeric frames: poses of bodies at given coordinates.

use super::{Axis, Body, BodyId, Chain, CoordinateId, CoordinateKind, Step};

/// A point or a direction: x, y, z.
pub type Vector = [f64; 3];

/// Cross product.
#[must_use]
pub fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// A frame, expressed in another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Directions of its axes x, y, z.
    pub axes: [Vector; 3],
    /// Its origin, m.
    pub origin: Vector,
}

impl Frame {
    /// The world frame, in which all others are ultimately given.
    pub const WORLD: Frame = Frame { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

    /// A direction given in this frame, expressed in the outer frame.
    #[must_use]
    pub fn direction(&self, local: Vector) -> Vector {
        [0, 1, 2].map(|row| (0..3).map(|i| self.axes[i][row] * local[i]).sum())
    }

    /// A point given in this frame, expressed in the outer frame.
    #[must_use]
    pub fn transform_point(&self, local: Vector) -> Vector {
        let along = self.direction(local);
        [0, 1, 2].map(|row| self.origin[row] + along[row])
    }

    /// A direction given in the outer frame, expressed in this frame.
    #[must_use]
    pub fn local_direction(&self, outer: Vector) -> Vector {
        self.axes.map(|axis| (0..3).map(|i| axis[i] * outer[i]).sum())
    }

    /// A frame given in the outer frame, expressed in this frame.
    #[must_use]
    pub fn local(&self, outer: &Frame) -> Frame {
        let way = [0, 1, 2].map(|i| outer.origin[i] - self.origin[i]);
        Frame { axes: outer.axes.map(|axis| self.local_direction(axis)), origin: self.local_direction(way) }
    }

    /// A frame given in this frame, expressed in the outer frame.
    #[must_use]
    pub fn outer(&self, local: &Frame) -> Frame {
        Frame { axes: local.axes.map(|axis| self.direction(axis)), origin: self.transform_point(local.origin) }
    }

    /// This frame rotated about one of its axes.
    #[must_use]
    pub fn rotated(mut self, axis: Axis, sin: f64, cos: f64) -> Frame {
        let (a, b) = ((axis.index() + 1) % 3, (axis.index() + 2) % 3);
        let (u, v) = (self.axes[a], self.axes[b]);
        self.axes[a] = [0, 1, 2].map(|i| cos * u[i] + sin * v[i]);
        self.axes[b] = [0, 1, 2].map(|i| cos * v[i] - sin * u[i]);
        self
    }

    /// This frame after a step of a path, at coordinates `q` and with the given parameter values.
    ///
    /// # Panics
    /// If `q` or `parameters` are shorter than the chain's lists of them.
    #[must_use]
    pub fn after(self, step: &Step, chain: &Chain, q: &[f64], parameters: &[f64]) -> Frame {
        match step {
            Step::Translate(by) => {
                Frame { origin: self.transform_point(by.each_ref().map(|v| v.at(parameters))), ..self }
            }
            Step::Rotate { axis, sin, cos } => self.rotated(*axis, sin.at(parameters), cos.at(parameters)),
            Step::Move(id) => {
                let coordinate = &chain.coordinates[id.0];
                match coordinate.kind {
                    CoordinateKind::Rotation => self.rotated(coordinate.axis, libm::sin(q[id.0]), libm::cos(q[id.0])),
                    CoordinateKind::Translation => {
                        let mut way = [0.0; 3];
                        way[coordinate.axis.index()] = q[id.0];
                        Frame { origin: self.transform_point(way), ..self }
                    }
                }
            }
            Step::RotationVector(ids) => {
                let mut rho = [0.0; 3];
                for id in ids {
                    rho[chain.coordinates[id.0].axis.index()] = q[id.0];
                }
                self.rotated_by(rho)
            }
        }
    }

    /// This frame rotated by a rotation vector given in it.
    fn rotated_by(self, rho: Vector) -> Frame {
        let angle = libm::sqrt(rho.iter().map(|x| x * x).sum());
        if angle == 0.0 {
            return self;
        }
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let [x, y, z] = rho.map(|component| component / angle);
        let v = 1.0 - cos;
        let columns = [
            [cos + v * x * x, v * x * y + sin * z, v * x * z - sin * y],
            [v * x * y - sin * z, cos + v * y * y, v * y * z + sin * x],
            [v * x * z + sin * y, v * y * z - sin * x, cos + v * z * z],
        ];
        Frame { axes: columns.map(|column| self.direction(column)), ..self }
    }
}

impl Chain {
    /// Frames of all bodies in the world at a pose.
    #[must_use]
    pub fn frames(&self, q: &[f64], parameters: &[f64]) -> Vec<Frame> {
        let mut frames: Vec<Frame> = Vec::with_capacity(self.bodies.len());
        for Body { parent, path, .. } in &self.bodies {
            let before = parent.map_or(Frame::WORLD, |BodyId(parent)| frames[parent]);
            frames.push(path.iter().fold(before, |frame, step| frame.after(step, self, q, parameters)));
        }
        frames
    }

    /// The axis of a coordinate in the world at a pose: a point on it, and its direction.
    #[must_use]
    pub fn axis(&self, coordinate: CoordinateId, q: &[f64], parameters: &[f64]) -> [Vector; 2] {
        let mut frame = Frame::WORLD;
        let path = self.path(self.coordinates[coordinate.0].body);
        for step in path.iter().flat_map(|BodyId(body)| &self.bodies[*body].path) {
            // A rotation about the axis and a translation along it leave its direction in place.
            frame = frame.after(step, self, q, parameters);
            if step.coordinates().contains(&coordinate) {
                break;
            }
        }
        [frame.origin, frame.axes[self.coordinates[coordinate.0].axis.index()]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_vector_along_one_axis_is_a_turn_about_it() {
        for (axis, rho) in [(Axis::X, [0.7, 0.0, 0.0]), (Axis::Y, [0.0, 0.7, 0.0]), (Axis::Z, [0.0, 0.0, 0.7])] {
            let (vector, rotated) =
                (Frame::WORLD.rotated_by(rho), Frame::WORLD.rotated(axis, 0.7_f64.sin(), 0.7_f64.cos()));
            for (a, b) in vector.axes.iter().flatten().zip(rotated.axes.iter().flatten()) {
                assert!((a - b).abs() < 1e-15, "{axis:?}: {vector:?}");
            }
        }
        // A third of a turn about (1, 1, 1) maps x to y, y to z, z to x.
        let third = std::f64::consts::TAU / 3.0 / 3.0_f64.sqrt();
        let axes = Frame::WORLD.rotated_by([third; 3]).axes;
        for (k, axis) in axes.iter().enumerate() {
            assert!((axis[(k + 1) % 3] - 1.0).abs() < 1e-15, "{axes:?}");
        }
        assert_eq!(Frame::WORLD.rotated_by([0.0; 3]), Frame::WORLD);
    }

    #[test]
    fn a_frame_seen_from_itself_is_the_world() {
        let (sin, cos) = (0.6, 0.8);
        let frame =
            Frame { origin: [1.0, -2.0, 3.0], ..Frame::WORLD }.rotated(Axis::Y, sin, cos).rotated(Axis::X, 0.8, 0.6);
        let own = frame.local(&frame);
        let back = frame.outer(&Frame { origin: [4.0, 5.0, 6.0], ..Frame::WORLD });
        for (i, k) in (0..3).flat_map(|i| (0..3).map(move |k| (i, k))) {
            // A few rounding errors of numbers of order 1.
            assert!((own.axes[i][k] - Frame::WORLD.axes[i][k]).abs() < 1e-15 && own.origin[k] == 0.0, "{own:?}");
            assert!((frame.local(&back).origin[k] - [4.0, 5.0, 6.0][k]).abs() < 1e-14);
        }
        // About y from z to x.
        assert_eq!(Frame::WORLD.rotated(Axis::Y, 1.0, 0.0).axes[2], [1.0, 0.0, 0.0]);
    }
}
