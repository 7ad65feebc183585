//! Triangles of boxes, rods, balls and hooks.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Rotation3, Vector3};

use crane_codegen::chain::{Form, Frame};

use crate::scene::matrix;

/// Triangles between corners, counter-clockwise as seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Corners, m.
    pub corners: Vec<Vector3<f64>>,
    /// Indices of the corners of each triangle.
    pub triangles: Vec<[usize; 3]>,
    /// The solid that the triangles approximate, and its pose, if it is one that other programs know.
    pub solid: Option<(Frame, Form)>,
}

/// A frame about the middle between two places, whose axis of this index is the first column of a rotation.
fn about_middle(turn: &Matrix3<f64>, [from, to]: [Vector3<f64>; 2], along: usize) -> Frame {
    let mut axes = [0, 1, 2].map(|axis| turn.column(axis).into_owned().into());
    axes.rotate_right(along);
    Frame { axes, origin: ((from + to) / 2.0).into() }
}

impl Mesh {
    /// A box from `from` to `to`, its ends in the middle of two sides, with these sizes across. Nothing if both are one place.
    pub fn bar(from: Vector3<f64>, to: Vector3<f64>, [high, wide]: [f64; 2]) -> Self {
        let turn = turned(Vector3::x(), to - from);
        let ring = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let across = ring.map(|[y, z]| turn * Vector3::new(0.0, y * high / 2.0, z * wide / 2.0));
        let solid = (about_middle(&turn, [from, to], 0), Form::Box([(to - from).norm(), high, wide]));
        Self { solid: Some(solid), ..Self::between(&[from, to].map(|end| across.map(|across| end + across).to_vec())) }
    }

    /// A box with its middle at `middle` and sides along the axes.
    pub fn block(middle: Vector3<f64>, [x, y, z]: [f64; 3]) -> Self {
        let half = Vector3::x() * (x / 2.0);
        Self::bar(middle - half, middle + half, [y, z])
    }

    /// A round rod or frustum of `sides` faces.
    pub fn rod(from: Vector3<f64>, to: Vector3<f64>, [first, last]: [f64; 2], sides: u32) -> Self {
        let turn = turned(Vector3::x(), to - from);
        let ring = |(end, radius): (Vector3<f64>, f64)| {
            let corner = |side: u32| {
                let (sin, cos) = (TAU * f64::from(side) / f64::from(sides)).sin_cos();
                end + turn * Vector3::new(0.0, radius * cos, radius * sin)
            };
            (0..sides).map(corner).collect()
        };
        let round = || Form::Cylinder { diameter: 2.0 * first, length: (to - from).norm() };
        let solid = (first.to_bits() == last.to_bits()).then(|| (about_middle(&turn, [from, to], 2), round()));
        Self { solid, ..Self::between(&[(from, first), (to, last)].map(ring)) }
    }

    /// A ball.
    pub fn ball(middle: Vector3<f64>, radius: f64) -> Self {
        let form = Form::Capsule { diameter: 2.0 * radius, length: 0.0 };
        let solid = (Frame { origin: middle.into(), ..Frame::WORLD }, form);
        Self { solid: Some(solid), ..Self::round([middle; 2], &Matrix3::identity(), radius) }
    }

    /// The surface at a distance from a line, along x as turned; a ball if both of its ends are one place.
    fn round([from, to]: [Vector3<f64>; 2], turn: &Matrix3<f64>, radius: f64) -> Self {
        let (rings, sides) = (8, 16);
        let ring = |(end, ring): (Vector3<f64>, u32)| {
            let (out, along) = (PI * f64::from(ring) / f64::from(rings)).sin_cos();
            let corner = |side: u32| {
                let (sin, cos) = (TAU * f64::from(side) / f64::from(sides)).sin_cos();
                end + radius * (turn * Vector3::new(-along, out * cos, out * sin))
            };
            (0..sides).map(corner).collect()
        };
        let half = rings / 2;
        let second = if from == to { half + 1 } else { half };
        let places = (0..=half).map(|ring| (from, ring)).chain((second..=rings).map(|ring| (to, ring)));
        Self::between(&places.map(ring).collect::<Vec<_>>())
    }

    /// A form in a frame; of a surface in a file that nobody has read, there are no triangles.
    pub fn solid(frame: &Frame, form: &Form) -> Self {
        let along_z = |length: f64| [-0.5, 0.5].map(|end| Vector3::z() * (end * length));
        let mut mesh = match *form {
            Form::Box(sides) => Self::block(Vector3::zeros(), sides),
            Form::Cylinder { diameter, length } => {
                let [from, to] = along_z(length);
                Self::rod(from, to, [diameter / 2.0; 2], 28)
            }
            Form::Capsule { diameter, length } => {
                Self::round(along_z(length), &turned(Vector3::x(), Vector3::z()), diameter / 2.0)
            }
            Form::Mesh { ref surface, scale, .. } => surface.as_ref().map_or_else(Self::default, |surface| Self {
                corners: surface.corners.iter().map(|corner| scale * Vector3::from(*corner)).collect(),
                triangles: surface.triangles.clone(),
                solid: None,
            }),
        };
        let pose = matrix(frame);
        mesh.corners.iter_mut().for_each(|corner| *corner = (pose * corner.push(1.0)).xyz());
        Self { solid: Some((*frame, form.clone())), ..mesh }
    }

    /// A hook about the origin, open towards `down`.
    pub fn hook(down: Vector3<f64>, radius: f64, thickness: f64) -> Self {
        let (rings, sides) = (20, 8);
        let turn = turned(-Vector3::y(), down);
        let ring = |ring: u32| {
            let (sin, cos) = (1.6 * PI * f64::from(ring) / f64::from(rings)).sin_cos();
            let out = Vector3::new(cos, sin, 0.0);
            let corner = |side: u32| {
                let (up, aside) = (TAU * f64::from(side) / f64::from(sides)).sin_cos();
                turn * (radius * out + thickness * (aside * out - up * Vector3::z()))
            };
            (0..sides).map(corner).collect()
        };
        Self::between(&(0..=rings).map(ring).collect::<Vec<_>>())
    }

    /// The surface through rings of as many corners, clockwise as seen along the way from the first to the last, closed at both ends.
    pub fn between(rings: &[Vec<Vector3<f64>>]) -> Self {
        let sides = rings.first().map_or(0, Vec::len);
        let last = sides * rings.len().saturating_sub(1);
        let face = move |begin: usize, side: usize| {
            let [a, b] = [begin + side, begin + (side + 1) % sides];
            [[a, b, b + sides], [a, b + sides, a + sides]]
        };
        let around =
            (0..last).step_by(sides.max(1)).flat_map(|begin| (0..sides).flat_map(move |side| face(begin, side)));
        let ends =
            (1..sides.saturating_sub(1)).flat_map(|side| [[0, side + 1, side], [last, last + side, last + side + 1]]);
        Self { corners: rings.concat(), triangles: around.chain(ends).collect(), solid: None }
    }

    /// Adds the triangles of another one.
    pub fn add(&mut self, other: &Mesh) {
        let first = self.corners.len();
        self.solid = None;
        self.corners.extend(&other.corners);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|corner| corner + first)));
    }
}

/// The shortest rotation that turns `from` towards `to`.
fn turned(from: Vector3<f64>, to: Vector3<f64>) -> Matrix3<f64> {
    let half_turn = || Rotation3::from_axis_angle(&Vector3::z_axis(), PI);
    Rotation3::rotation_between(&from, &to).unwrap_or_else(half_turn).into_inner()
}
