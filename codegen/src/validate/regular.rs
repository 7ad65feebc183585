//! Whether the mass matrix is regular: every coordinate moves a mass of its own.
//!
//! An articulated-body recursion from the tip to the base, in world coordinates about the world's origin, gives the
//! pivots of the mass matrix one by one: the inertia `D_j` that coordinate j feels with all later joints free.

use super::{Check, Owner};
use crate::chain::{Axis, Chain, CoordinateKind, Inertia, Step};
use crate::diagnostic::{Span, rule};
use crate::spec::Crane;

/// A pivot below this share of what the coordinate would feel with all later joints locked is zero to rounding. The
/// smallest that a crane reaches, torsion of one of 1000 elements below a long load, is four orders above.
const VANISHING: f64 = 1e-10;

type Vector = [f64; 3];
/// Of a rotation: moment first; of a motion: angular velocity first.
type Spatial = [f64; 6];
type SpatialInertia = [[f64; 6]; 6];

/// A frame in the world: origin and axes.
#[derive(Clone, Copy)]
struct Frame {
    origin: Vector,
    axes: [Vector; 3],
}

fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn dot(a: &Spatial, b: &Spatial) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn apply(inertia: &SpatialInertia, motion: &Spatial) -> Spatial {
    inertia.each_ref().map(|row| dot(row, motion))
}

impl Frame {
    fn translate(&mut self, by: Vector) {
        for (axis, by) in self.axes.iter().zip(by) {
            for k in 0..3 {
                self.origin[k] += by * axis[k];
            }
        }
    }

    fn rotate(&mut self, axis: Axis, sin: f64, cos: f64) {
        let (a, b) = ((axis.index() + 1) % 3, (axis.index() + 2) % 3);
        for k in 0..3 {
            let (u, v) = (self.axes[a][k], self.axes[b][k]);
            self.axes[a][k] = cos * u + sin * v;
            self.axes[b][k] = cos * v - sin * u;
        }
    }

    /// Velocity of the world's origin, were it carried along by a unit velocity of a coordinate.
    fn motion(&self, kind: CoordinateKind, axis: Axis) -> Spatial {
        let direction = self.axes[axis.index()];
        let (turning, moving) = match kind {
            CoordinateKind::Rotation => (direction, cross(self.origin, direction)),
            CoordinateKind::Translation => ([0.0; 3], direction),
        };
        std::array::from_fn(|k| if k < 3 { turning[k] } else { moving[k - 3] })
    }

    /// Spatial inertia about the world's origin of a pseudo-inertia in this frame.
    fn inertia(&self, inertia: &Inertia, parameters: &[f64]) -> SpatialInertia {
        let mass = inertia.mass.at(parameters);
        let first = inertia.first.each_ref().map(|v| v.at(parameters));
        let [xx, yy, zz, xy, xz, yz] = inertia.second.each_ref().map(|v| v.at(parameters));
        let second = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let turned = |k: usize, v: Vector| -> f64 { (0..3).map(|i| self.axes[i][k] * v[i]).sum() };
        let o = self.origin;
        let s: Vector = std::array::from_fn(|k| turned(k, first));
        // ∫ r rᵀ dm about the world's origin.
        let planar = |i: usize, j: usize| {
            turned(i, second.map(|row| turned(j, row))) + o[i] * s[j] + s[i] * o[j] + mass * o[i] * o[j]
        };
        let trace = planar(0, 0) + planar(1, 1) + planar(2, 2);
        let moment: Vector = std::array::from_fn(|k| s[k] + mass * o[k]);
        let [x, y, z] = moment;
        let skew = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i < 3, j < 3) {
                (true, true) => f64::from(u8::from(i == j)) * trace - planar(i, j),
                (true, false) => skew[i][j - 3],
                (false, true) => -skew[i - 3][j],
                (false, false) => f64::from(u8::from(i == j)) * mass,
            })
        })
    }
}

impl Check<'_> {
    /// Reports coordinates that move no mass of their own, at a pose that no structure singles out.
    pub(super) fn regular(&mut self, chain: &Chain, crane: &Crane) {
        let mut frame = Frame { origin: [0.0; 3], axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
        let mut frames = Vec::with_capacity(chain.bodies.len());
        let mut motions = vec![[0.0; 6]; chain.coordinates.len()];
        for body in &chain.bodies {
            for step in &body.path {
                match step {
                    Step::Translate(by) => frame.translate(by.each_ref().map(|v| self.now(v))),
                    Step::Rotate { axis, sin, cos } => frame.rotate(*axis, self.now(sin), self.now(cos)),
                    Step::Move(id) => {
                        let coordinate = &chain.coordinates[id.0];
                        motions[id.0] = frame.motion(coordinate.kind, coordinate.axis);
                        // Beams stay nearly straight; joints turn by an angle of their own each, off any symmetry.
                        let offset = if matches!(self.owners[id.0], Owner::Beam(_)) { 0.0 } else { generic(id.0) };
                        let position = chain.guess[id.0] + offset;
                        match coordinate.kind {
                            CoordinateKind::Rotation => frame.rotate(coordinate.axis, position.sin(), position.cos()),
                            CoordinateKind::Translation => {
                                let mut by = [0.0; 3];
                                by[coordinate.axis.index()] = position;
                                frame.translate(by);
                            }
                        }
                    }
                }
            }
            frames.push(frame);
        }

        let (mut articulated, mut locked) = ([[0.0; 6]; 6], [[0.0; 6]; 6]);
        for (body, frame) in chain.bodies.iter().zip(&frames).rev() {
            if let Some(inertia) = &body.inertia {
                let own = frame.inertia(inertia, &self.defaults);
                for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                    articulated[i][j] += own[i][j];
                    locked[i][j] += own[i][j];
                }
            }
            for step in body.path.iter().rev() {
                let Step::Move(id) = step else { continue };
                let motion = &motions[id.0];
                let force = apply(&articulated, motion);
                let pivot = dot(&force, motion);
                if pivot <= VANISHING * dot(&apply(&locked, motion), motion) {
                    self.report(rule::moves_nothing(joint_span(crane, &body.link), &chain.coordinates[id.0].name));
                    continue;
                }
                for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                    articulated[i][j] -= force[i] * force[j] / pivot;
                }
            }
        }
    }
}

/// An angle or distance of order 1 for the n-th coordinate, in no simple relation to any other.
fn generic(n: usize) -> f64 {
    0.3 + 0.5 * (1.7 * n as f64 + 0.4).sin()
}

/// Where the joint of a link stands.
fn joint_span(crane: &Crane, name: &str) -> Span {
    let links = crane.links.value.as_deref().unwrap_or_default().iter().filter_map(|link| link.value.as_ref());
    let named = links.into_iter().find(|link| link.name.value.as_deref() == Some(name));
    named.map_or(Span::START, |link| link.joint.as_ref().map_or(link.name.span, |joint| joint.span))
}
