//! The dynamics of a robot link by link, as its file describes it: what a spec made from it has to agree with.
//!
//! No groups, no turned frames, no text: every link of the file, fixed or not, with its own frame in the world. With the Jacobians `J_v` and
//! `J_ω` of a centre of mass, its acceleration a and the link's α for `q̈ = 0`:
//!
//! ```text
//! A = Σ m J_vᵀ J_v + J_ωᵀ I J_ω + rotors        e = −Σ m J_vᵀ (a − g) + J_ωᵀ (I α + ω × I ω)
//! ```

use std::collections::BTreeMap;

use super::groups::{Held, groups};
use super::links::SpecLink;
use super::robot::{Coupling, Joint, Motion, Robot, Spring};
use crate::chain::{Frame, Vector, cross};
use crate::exchange::mass::Lump;
use crate::exchange::rotation::length;

/// Acceleration of gravity of a spec that gives none, m/s².
const GRAVITY: Vector = [0.0, 0.0, -9.81];

/// A robot, link by link.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    links: Vec<ReferenceLink>,
    gravity: Vector,
    /// Names of the coordinates that its joints have in the spec, in the order of the spec.
    pub coordinates: Vec<String>,
    forces: Vec<Law>,
    /// Whether `forces` are all that act on the joints of the spec.
    pub forces_are_complete: bool,
}

/// A link on its joint.
#[derive(Clone, Debug, PartialEq)]
struct ReferenceLink {
    parent: Option<usize>,
    /// In the frame of the parent, at zero.
    placement: Frame,
    moves: Option<Moves>,
    /// Its mass in its own frame.
    lump: Option<Lump>,
}

/// The coordinate of a joint, its unit axis in the frame of the child, and its rotor.
#[derive(Clone, Debug, PartialEq)]
struct Moves {
    coordinate: usize,
    turns: bool,
    axis: Vector,
    armature: f64,
}

/// A force `−k (s − rest) − d ṡ` along the sum s of positions with coefficients.
#[derive(Clone, Debug, PartialEq)]
struct Law {
    terms: Vec<(usize, f64)>,
    stiffness: f64,
    damping: f64,
    rest: f64,
}

/// A, e and the forces of springs and dampers at a state, each with the size of the terms whose sum it is.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceDynamics {
    /// A, n × n.
    pub mass_matrix: Vec<f64>,
    /// e, n.
    pub bias: Vec<[f64; 2]>,
    /// n.
    pub forces: Vec<[f64; 2]>,
}

/// A link at a state: its frame, ω and α, velocity and acceleration of its origin.
#[derive(Clone, Copy)]
struct MovingLink {
    frame: Frame,
    omega: Vector,
    alpha: Vector,
    acceleration: Vector,
}

impl Reference {
    /// A robot whose joints have the coordinates of links of a spec.
    pub(super) fn new(robot: &Robot, links: &[SpecLink]) -> Self {
        let held = links.iter().flat_map(|link| &link.held).map(|(joint, at)| (joint.name.as_str(), *at));
        Self::with_joints(robot, links.iter().flat_map(SpecLink::joints).collect(), &held.collect())
    }

    /// `1/(A⁻¹)_jj` where every joint is at its `ref`: the inertia that a force on a joint meets while all others move freely. By the joints
    /// that move, with their names.
    pub(super) fn inertias_at_reference(robot: &Robot) -> Vec<(String, f64)> {
        let moves = |joint: &&Joint| matches!(joint.motion, Motion::Revolute | Motion::Prismatic);
        let joints: Vec<&Joint> = robot.joints.iter().filter(moves).collect();
        let q: Vec<f64> = joints.iter().map(|joint| joint.reference).collect();
        let named = joints.into_iter().map(|joint| (joint, joint.name.clone())).collect();
        let reference = Self::with_joints(robot, named, &BTreeMap::new());
        let mass_matrix = reference.dynamics(&q, &vec![0.0; q.len()]).mass_matrix;
        reference.coordinates.into_iter().zip(free_inertias(mass_matrix, q.len())).collect()
    }

    /// A robot that moves in some joints, whose coordinates have names; others stand where `held` says, or at zero.
    fn with_joints(robot: &Robot, joints: Vec<(&Joint, String)>, held: &BTreeMap<&str, f64>) -> Self {
        let index = |name: &str| joints.iter().position(|(joint, _)| joint.name == name);
        let by_child: BTreeMap<&str, &Joint> =
            robot.joints.iter().map(|joint| (joint.child.name.as_str(), joint)).collect();
        // Links in an order in which each comes after its parent.
        let depth = |name: &str| {
            let next = |name: &&str| by_child.get(name).map(|joint| joint.parent.name.as_str());
            std::iter::successors(Some(name), next).take(robot.links.len()).count()
        };
        let mut order: Vec<_> = robot.links.iter().map(|link| (depth(&link.name), link)).collect();
        order.sort_by_key(|(depth, _)| *depth);
        let place: BTreeMap<&str, usize> =
            order.iter().enumerate().map(|(index, (_, link))| (link.name.as_str(), index)).collect();
        let of_link = |(_, link): &(usize, &super::robot::Link)| {
            let joint = by_child.get(link.name.as_str());
            let moves = joint.and_then(|joint| {
                let turns = matches!(joint.motion, Motion::Revolute);
                Some(Moves { coordinate: index(&joint.name)?, turns, axis: joint.axis, armature: joint.armature })
            });
            let placement = joint.map_or(Frame::WORLD, |joint| {
                joint.placement.outer(&joint.moved_by(held.get(joint.name.as_str()).copied().unwrap_or(0.0)))
            });
            let parent = joint.and_then(|joint| place.get(joint.parent.name.as_str()).copied());
            ReferenceLink { parent, placement, moves, lump: link.lump.clone() }
        };
        let mut forces: Vec<Law> = Vec::new();
        for (coordinate, (joint, _)) in joints.iter().enumerate() {
            let (stiffness, rest) =
                joint.spring.as_ref().map_or((0.0, 0.0), |Spring { stiffness, rest }| (*stiffness, *rest));
            forces.push(Law { terms: vec![(coordinate, 1.0)], stiffness, damping: joint.damping, rest });
        }
        let couplings = robot.couplings.iter().filter_map(|coupling| {
            let &Coupling { ref follower, ref leader, ratio, offset, stiffness, damping, .. } = coupling;
            Some(Law {
                terms: vec![(index(follower)?, 1.0), (index(leader)?, -ratio)],
                stiffness,
                damping,
                rest: offset,
            })
        });
        forces.extend(couplings);
        let plain = |(joint, _): &(&Joint, String)| joint.friction == 0.0 && joint.held.is_none();
        Reference {
            links: order.iter().map(of_link).collect(),
            gravity: robot.gravity.unwrap_or(GRAVITY),
            forces,
            forces_are_complete: joints.iter().all(plain),
            coordinates: joints.into_iter().map(|(_, name)| name).collect(),
        }
    }

    /// A, e and forces at a state.
    ///
    /// # Panics
    /// If `q` or `v` is shorter than the list of coordinates.
    #[must_use]
    pub fn dynamics(&self, q: &[f64], v: &[f64]) -> ReferenceDynamics {
        let n = self.coordinates.len();
        let mut result =
            ReferenceDynamics { mass_matrix: vec![0.0; n * n], bias: vec![[0.0; 2]; n], forces: vec![[0.0; 2]; n] };
        let mut states: Vec<MovingLink> = Vec::with_capacity(self.links.len());
        for link in &self.links {
            let before = link.parent.map_or(MovingLink::AT_REST, |parent| states[parent]);
            let state = before.carrying(link, q, v);
            states.push(state);
            if let Some(moves) = &link.moves {
                result.mass_matrix[moves.coordinate * (n + 1)] += moves.armature;
            }
            if let Some(lump) = &link.lump {
                self.add_lump(&mut result, &states, lump);
            }
        }
        for Law { terms, stiffness, damping, rest } in &self.forces {
            let of = |numbers: &[f64]| terms.iter().map(|(k, share)| share * numbers[*k]).sum::<f64>();
            let size_of = |numbers: &[f64]| terms.iter().map(|(k, share)| (share * numbers[*k]).abs()).sum::<f64>();
            let force = -stiffness * (of(q) - rest) - damping * of(v);
            let size = stiffness.abs() * (size_of(q) + rest.abs()) + damping.abs() * size_of(v);
            for (k, share) in terms {
                result.forces[*k][0] += share * force;
                result.forces[*k][1] += share.abs() * size;
            }
        }
        result
    }

    /// Adds the mass of the last link in `states`.
    fn add_lump(&self, result: &mut ReferenceDynamics, states: &[MovingLink], lump: &Lump) {
        let n = self.coordinates.len();
        let Some((own, &state)) = states.len().checked_sub(1).zip(states.last()) else { return };
        let Lump { mass, com, tensor } = lump.seen_through(&state.frame);
        let [xx, yy, zz, xy, xz, yz] = tensor;
        let inertia = |w: Vector| [dot([xx, xy, xz], w), dot([xy, yy, yz], w), dot([xz, yz, zz], w)];
        let way = minus(com, state.frame.origin);
        let turning = plus(cross(state.alpha, way), cross(state.omega, cross(state.omega, way)));
        let force = scaled(mass, minus(plus(state.acceleration, turning), self.gravity));
        let moment = plus(inertia(state.alpha), cross(state.omega, inertia(state.omega)));
        // Columns of J_v and J_ω.
        let mut columns: Vec<(usize, Vector, Vector)> = Vec::new();
        let path = std::iter::successors(Some(own), |link| self.links[*link].parent);
        for link in path {
            let (Some(moves), MovingLink { frame, .. }) = (&self.links[link].moves, &states[link]) else { continue };
            let axis = frame.direction(moves.axis);
            columns.push(if moves.turns {
                (moves.coordinate, cross(axis, minus(com, frame.origin)), axis)
            } else {
                (moves.coordinate, axis, [0.0; 3])
            });
        }
        for &(row, along, about) in &columns {
            let [linear, angular] = [dot(along, force), dot(about, moment)];
            result.bias[row][0] -= linear + angular;
            result.bias[row][1] += (length(along) * length(force)).max(linear.abs()) + angular.abs();
            for &(column, other_along, other_about) in &columns {
                result.mass_matrix[row * n + column] +=
                    mass * dot(along, other_along) + dot(about, inertia(other_about));
            }
        }
    }
}

/// Sets springs and dampers that give joints their oscillations, with the inertia J that a force on the joint meets where all are at their
/// `ref`: `k = J / (T ζ)²`, `d = 2 J / T`.
pub(super) fn set_oscillations(robot: &mut Robot) {
    // Links that are not a tree are refused later.
    if robot.joints.iter().all(|joint| joint.oscillation.is_none()) || groups(robot, &[], &Held::new()).is_err() {
        return;
    }
    for (name, inertia) in Reference::inertias_at_reference(robot) {
        let Some(joint) = robot.joints.iter_mut().find(|joint| joint.name == name) else { continue };
        if let Some([time, ratio]) = joint.oscillation {
            joint.spring = Some(Spring { stiffness: inertia / (time * ratio).powi(2), rest: joint.relaxed });
            joint.damping = 2.0 * inertia / time;
        }
    }
}

impl MovingLink {
    const AT_REST: MovingLink =
        MovingLink { frame: Frame::WORLD, omega: [0.0; 3], alpha: [0.0; 3], acceleration: [0.0; 3] };

    /// The state of a link on this one.
    fn carrying(self, link: &ReferenceLink, q: &[f64], v: &[f64]) -> Self {
        let mut frame = self.frame.outer(&link.placement);
        let MovingLink { mut omega, mut alpha, .. } = self;
        let mut own = [0.0; 3];
        if let Some(Moves { coordinate, turns, axis, .. }) = link.moves {
            let motion = if turns { Motion::Revolute } else { Motion::Prismatic };
            frame = frame.outer(&motion.moved_by(axis, q[coordinate]));
            let rate = scaled(v[coordinate], frame.direction(axis));
            if turns {
                omega = plus(omega, rate);
                alpha = plus(alpha, cross(self.omega, rate));
            } else {
                own = scaled(2.0, cross(self.omega, rate));
            }
        }
        let way = minus(frame.origin, self.frame.origin);
        let carried = plus(cross(self.alpha, way), cross(self.omega, cross(self.omega, way)));
        MovingLink { frame, omega, alpha, acceleration: plus(plus(self.acceleration, carried), own) }
    }
}

/// `1/(A⁻¹)_jj` of a positive definite n × n matrix: with `A = L Lᵀ`, `(A⁻¹)_jj = Σ_i (L⁻¹)_ij²`.
fn free_inertias(mut a: Vec<f64>, n: usize) -> Vec<f64> {
    for j in 0..n {
        for i in j..n {
            let sum: f64 = (0..j).map(|k| a[i * n + k] * a[j * n + k]).sum();
            let rest = a[i * n + j] - sum;
            a[i * n + j] = if i == j { rest.sqrt() } else { rest / a[j * n + j] };
        }
    }
    let inertia = |j: usize| {
        let mut column = vec![0.0; n];
        for i in j..n {
            let sum: f64 = (j..i).map(|k| a[i * n + k] * column[k]).sum();
            column[i] = (f64::from(u8::from(i == j)) - sum) / a[i * n + i];
        }
        1.0 / column.iter().map(|entry| entry * entry).sum::<f64>()
    };
    (0..n).map(inertia).collect()
}

fn plus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + b[i])
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn scaled(by: f64, a: Vector) -> Vector {
    a.map(|x| by * x)
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}
