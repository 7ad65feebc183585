//! Whether the mass matrix is regular: every coordinate moves a mass of its own.
//!
//! An articulated-body recursion from the tips to the base, in world coordinates about the world's origin, gives the
//! pivots of the mass matrix one by one: the inertia `D_j` that coordinate j feels with all later joints free.

use super::{Check, Owner};
use crate::chain::{Axis, BodyId, Chain, CoordinateId, CoordinateKind, Frame, Inertia, Vector, cross};
use crate::diagnostic::{Span, rule};
use crate::spec::Crane;

/// A pivot below this fraction of the coordinate's inertia with all later joints locked counts as zero. The smallest pivot
/// of a realistic crane, torsion of one of 1000 elements under a long load, is four orders of magnitude larger.
const VANISHING: f64 = 1e-10;

/// Forces have the moment first, velocities the angular velocity.
type Spatial = [f64; 6];
type SpatialInertia = [[f64; 6]; 6];

fn dot(a: &Spatial, b: &Spatial) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn apply(inertia: &SpatialInertia, motion: &Spatial) -> Spatial {
    inertia.each_ref().map(|row| dot(row, motion))
}

/// Spatial velocity about the world's origin for a unit velocity of a coordinate.
fn unit_motion(frame: &Frame, kind: CoordinateKind, axis: Axis) -> Spatial {
    let direction = frame.axes[axis.index()];
    let (turning, moving) = match kind {
        CoordinateKind::Rotation => (direction, cross(frame.origin, direction)),
        CoordinateKind::Translation => ([0.0; 3], direction),
    };
    std::array::from_fn(|k| if k < 3 { turning[k] } else { moving[k - 3] })
}

/// Spatial inertia about the world's origin of a pseudo-inertia in this frame.
fn inertia_in_world(frame: &Frame, inertia: &Inertia, parameters: &[f64]) -> SpatialInertia {
    let mass = inertia.mass.at(parameters);
    let first = inertia.first.each_ref().map(|v| v.at(parameters));
    let [xx, yy, zz, xy, xz, yz] = inertia.second.each_ref().map(|v| v.at(parameters));
    let second = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let turned = |k: usize, v: Vector| -> f64 { (0..3).map(|i| frame.axes[i][k] * v[i]).sum() };
    let o = frame.origin;
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

impl Check<'_> {
    /// Reports coordinates that move no mass of their own.
    pub(super) fn regular(&mut self, chain: &Chain, crane: &Crane) {
        let idle = self.idle_coordinates(chain, &self.defaults);
        let in_beam =
            |(_, CoordinateId(index)): &&(BodyId, CoordinateId)| matches!(self.owners[*index], Owner::Beam(_));
        let mut light: Vec<&str> =
            idle.iter().filter(in_beam).map(|(body, _)| chain.bodies[body.0].link.as_str()).collect();
        light.sort_unstable();
        light.dedup();
        for link in &light {
            let elements = chain.bodies.iter().filter(|body| body.link == *link);
            let inertias = elements.filter_map(|body| body.inertia.as_ref());
            let mass: f64 = inertias.map(|inertia| self.now(&inertia.mass)).sum();
            self.report(rule::too_light(joint_span(crane, link), link, format!("{mass:.3e}")));
        }
        // With a massless beam, rounding decides which other joints appear to be singular.
        if light.is_empty() {
            for (body, CoordinateId(index)) in idle {
                let span = joint_span(crane, &chain.bodies[body.0].link);
                self.report(rule::moves_nothing(span, &chain.coordinates[index].name));
            }
        }
    }

    /// Coordinates that move no mass of their own, each with the body to whose joint it belongs, at a generic pose.
    pub(super) fn idle_coordinates(&self, chain: &Chain, parameters: &[f64]) -> Vec<(BodyId, CoordinateId)> {
        let mut idle = Vec::new();
        let mut frames: Vec<Frame> = Vec::with_capacity(chain.bodies.len());
        let mut motions = vec![[0.0; 6]; chain.coordinates.len()];
        // Beams stay nearly straight; each joint has a different angle, without symmetry.
        let offset = |n: usize| if matches!(self.owners[n], Owner::Beam(_)) { 0.0 } else { generic(n) };
        let q: Vec<f64> = chain.guess.iter().enumerate().map(|(n, guess)| guess + offset(n)).collect();
        for body in &chain.bodies {
            let mut frame = body.parent.map_or(Frame::WORLD, |BodyId(parent)| frames[parent]);
            for step in &body.path {
                // Beams are straight here, so a rotation vector's axes are those of the frame.
                for id in step.coordinates() {
                    let coordinate = &chain.coordinates[id.0];
                    motions[id.0] = unit_motion(&frame, coordinate.kind, coordinate.axis);
                }
                frame = frame.after(step, chain, &q, parameters);
            }
            frames.push(frame);
        }

        // With all joints beyond free, and with all of them locked.
        let mut beyond = vec![[[[0.0; 6]; 6]; 2]; chain.bodies.len()];
        for (index, (body, frame)) in chain.bodies.iter().zip(&frames).enumerate().rev() {
            let [mut articulated, mut locked] = beyond[index];
            if let Some(inertia) = &body.inertia {
                let of_body = inertia_in_world(frame, inertia, parameters);
                for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                    articulated[i][j] += of_body[i][j];
                    locked[i][j] += of_body[i][j];
                }
            }
            for id in body.path.iter().rev().flat_map(|step| step.coordinates().iter().rev()) {
                let motion = &motions[id.0];
                let force = apply(&articulated, motion);
                let armature = armature(chain, *id, parameters);
                let pivot = dot(&force, motion) + armature;
                if pivot <= VANISHING * (dot(&apply(&locked, motion), motion) + armature) {
                    idle.push((BodyId(index), *id));
                    continue;
                }
                for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                    articulated[i][j] -= force[i] * force[j] / pivot;
                }
            }
            if let Some(BodyId(parent)) = body.parent {
                for (sum, own) in beyond[parent].iter_mut().zip([articulated, locked]) {
                    for (sum, own) in sum.iter_mut().flatten().zip(own.iter().flatten()) {
                        *sum += own;
                    }
                }
            }
        }
        idle
    }
}

/// Inertia of a coordinate's rotor.
fn armature(chain: &Chain, id: CoordinateId, parameters: &[f64]) -> f64 {
    chain.rotors.iter().filter(|rotor| rotor.coordinate == id).map(|rotor| rotor.armature.at(parameters)).sum()
}

/// An angle or distance of order 1 for the n-th coordinate, in no simple relation to any other.
fn generic(n: usize) -> f64 {
    0.3 + 0.5 * (1.7 * n as f64 + 0.4).sin()
}

/// The location of a link's joint.
fn joint_span(crane: &Crane, name: &str) -> Span {
    let links = crane.links.value.as_deref().unwrap_or_default().iter().filter_map(|link| link.value.as_ref());
    let named = links.into_iter().find(|link| link.name.value.as_deref() == Some(name));
    named.map_or(Span::START, |link| link.joint.as_ref().map_or(link.name.span, |joint| joint.span))
}
