//! Mass matrix from composite bodies.
//!
//! Notation
//! : everything beyond a joint, as one composite body: its mass m, first moments s and inertia I about the joint's point, in the
//!   joint's own frame; its momenta at unit rate of coordinate j, `P_j` and, about the point, `L_j`, and the axis `n_j`, in the
//!   world's axes.
//!
//! Output
//! : `a_ij = n_i · L_j` for a rotation i and `n_i · P_j` for a translation, i ≤ j, with L_j about the point of i
//!   [Urbaś 2016, Eq. (5)], and zero if neither of i and j is on the path of the other.
//!
//! In its own frame a joint's axis is one of the unit vectors: momenta are a column of I and two entries of s, and most
//! placements are shifts along one axis. In the world's axes a row of A is one scalar product per column, without rotations
//! from joint to joint. About local points nothing large is subtracted, so the torsional inertia of a slender element keeps
//! its digits; about the world's origin it would be small compared with the inertia of the whole crane.

use std::ops::Add;

use super::axis_rotation::AxisRotation;
use super::factors::{Branches, Factor, Reached};
use super::model::Model;
use super::rotors;
use super::vector::{Rotation, Symmetric3, SymmetricMatrix, Vec3};
use crate::chain::{Axis, CoordinateId, CoordinateKind, Inertia};
use crate::program::ConcurrentAxes;
use crate::symbolic::Expr;

/// The factors of the mass matrix: for each coordinate its axis, its momenta, and the offset to its point from that of the
/// coordinate before it on its path.
pub struct Columns<'g> {
    pub axes: Vec<Vec3<'g>>,
    pub linear: Vec<Vec3<'g>>,
    pub angular: Vec<Vec3<'g>>,
    pub offsets: Vec<Vec3<'g>>,
    /// From the point of the last coordinate to the tip.
    tip: Vec3<'g>,
}

/// The offset, from where the inward sweep is, to the point of the coordinate that it passed last; without a coordinate, to the tip.
type Offset<'g> = (Option<usize>, Vec3<'g>);

/// Axes, momenta and offsets of all coordinates, in the world's axes.
pub fn columns<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Columns<'g> {
    let mut frames = frames(model, factors);
    let mut frame_before = || frames.pop().expect("as many as outward");
    let zero = Vec3::zero(model.graph);
    let empty = vec![zero; model.size()];
    let mut columns =
        Columns { axes: empty.clone(), linear: empty.clone(), angular: empty.clone(), offsets: empty, tip: zero };
    let mut composite = Composite::nothing(model);
    // One for each branch beyond.
    let mut offsets: Vec<Offset<'g>> = vec![(None, zero)];
    let mut branches = Branches::new(model);
    let sweep = model.graph.sweep();
    for factor in factors.iter().rev() {
        match factor {
            Factor::Body(index) => {
                let body = &model.chain.bodies[*index];
                sweep.visit(&body.name);
                for (branch, of_branch) in branches.take(*index) {
                    composite = composite + branch;
                    offsets.extend(of_branch);
                }
                if let Some(inertia) = &body.inertia {
                    composite.add_body(model, inertia);
                    composite.named(&body.name);
                }
            }
            Factor::Branch(from) => {
                let of_branch = (composite, std::mem::take(&mut offsets));
                composite = Composite::nothing(model);
                branches.bring(*from, of_branch);
            }
            Factor::Translate(by) => {
                composite.shift(*by);
                let frame = frame_before();
                for (_, offset) in &mut offsets {
                    *offset = *offset + frame.apply(*by);
                }
            }
            Factor::Prismatic { j, axis } => {
                let (frame, by) = (frame_before(), Vec3::along(*axis, model.q[*j]));
                columns.set(model, *j, (&frame, frame.axis(*axis)), composite.sliding(*axis), &mut offsets);
                composite.shift(by);
                offsets = vec![(Some(*j), frame.apply(by))];
            }
            Factor::RotationVector { j, vector } => {
                let frame = frame_before();
                composite.rotate(vector.rotation());
                let jacobian = vector.jacobian();
                let axes = vector.by_coordinates([0, 1, 2].map(|k| jacobian.column(k)));
                for (k, axis) in axes.into_iter().enumerate().rev() {
                    let momenta = composite.turning_about(axis);
                    columns.set(model, j + k, (&frame, frame.apply(axis)), momenta, &mut offsets);
                }
            }
            Factor::Rotation(_) | Factor::Revolute { .. } | Factor::Ball { .. } => {
                for (j, rotation) in factor.rotations().into_iter().rev() {
                    let frame = frame_before();
                    composite.rotate_about_axis(&rotation);
                    if let Some(j) = j {
                        columns.set(
                            model,
                            j,
                            (&frame, frame.axis(rotation.axis)),
                            composite.turning(rotation.axis),
                            &mut offsets,
                        );
                    }
                }
            }
        }
    }
    for (to, offset) in offsets {
        if let Some(first) = to {
            columns.offsets[first] = offset;
        }
    }
    columns
}

/// The axes of the frame before each rotation and each translation, from the base to the tips.
pub fn frames<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Vec<Rotation<'g>> {
    let mut frame = Rotation::identity(model.graph);
    let mut frames = Vec::new();
    let mut reached = Reached::new();
    let sweep = model.graph.sweep();
    for factor in factors {
        reached.follow(factor, &mut frame);
        match factor {
            Factor::Branch(_) => {}
            Factor::Body(index) => sweep.leave(&model.chain.bodies[*index].name),
            Factor::Translate(_) | Factor::Prismatic { .. } => frames.push(frame),
            Factor::RotationVector { vector, .. } => {
                frames.push(frame);
                frame = frame.times(vector.rotation());
            }
            Factor::Rotation(_) | Factor::Revolute { .. } | Factor::Ball { .. } => {
                for (_, rotation) in factor.rotations() {
                    frames.push(frame);
                    frame = frame.rotated(rotation.axis, rotation.sin, rotation.cos);
                }
            }
        }
    }
    frames
}

/// Everything beyond a frame, as one composite body: mass, first and second moments about the frame's origin in its components.
#[derive(Clone, Copy)]
struct Composite<'g> {
    mass: Expr<'g>,
    first: Vec3<'g>,
    second: Symmetric3<'g>,
}

impl<'g> Composite<'g> {
    fn nothing(model: &Model<'g>) -> Self {
        Composite { mass: model.zero(), first: Vec3::zero(model.graph), second: Symmetric3::zero(model.graph) }
    }

    fn add_body(&mut self, model: &Model<'g>, inertia: &Inertia) {
        self.mass = self.mass + model.number(&inertia.mass);
        self.first = self.first + model.vector(&inertia.first);
        self.second = self.second + model.second_moments(inertia);
    }

    /// Names the quantities in generated code, at the frame of a body.
    fn named(&self, body: &str) {
        self.first.named(&format!("first_from_{body}"));
        self.second.named(&format!("second_from_{body}"));
    }

    /// Transforms to components in the frame before a rotation.
    fn rotate_about_axis(&mut self, rotation: &AxisRotation<'g>) {
        self.first = rotation.to_outer(self.first);
        self.second = rotation.to_outer_symmetric(&self.second);
    }

    /// The same for a rotation given by its matrix.
    fn rotate(&mut self, rotation: Rotation<'g>) {
        self.first = rotation.apply(self.first);
        self.second = self.second.rotated(rotation);
    }

    /// Moves the reference point from d to the frame's own origin: `Σ + u dᵀ + d uᵀ` with `u = s + ½ m d`.
    fn shift(&mut self, d: Vec3<'g>) {
        self.second = self.second + Symmetric3::outer(self.first + (0.5 * self.mass) * d, d);
        self.first = self.first + self.mass * d;
    }

    /// Momenta P and L of a rotation about an axis of the frame at unit rate: `e × s` and `I e`.
    fn turning(&self, axis: Axis) -> [Vec3<'g>; 2] {
        let unit = Vec3::along(axis, self.mass.graph().constant(1.0));
        [unit.cross(self.first), self.second.tensor().row(axis.index())]
    }

    /// Momenta P and L of a rotation about any axis n at unit rate: `n × s` and `I n`.
    fn turning_about(&self, axis: Vec3<'g>) -> [Vec3<'g>; 2] {
        [axis.cross(self.first), self.second.tensor().apply(axis)]
    }

    /// Momenta P and L of a translation along an axis of the frame at unit rate: `m e` and `s × e`.
    fn sliding(&self, axis: Axis) -> [Vec3<'g>; 2] {
        let unit = Vec3::along(axis, self.mass.graph().constant(1.0));
        [self.mass * unit, self.first.cross(unit)]
    }
}

impl Add for Composite<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Composite { mass: self.mass + other.mass, first: self.first + other.first, second: self.second + other.second }
    }
}

impl<'g> Columns<'g> {
    /// Stores the axis and the momenta of coordinate j, and the offsets from its point, where the next ones begin; the momenta are given by
    /// their components in a frame.
    fn set(
        &mut self,
        model: &Model<'g>,
        j: usize,
        (frame, axis): (&Rotation<'g>, Vec3<'g>),
        momenta: [Vec3<'g>; 2],
        offsets: &mut Vec<Offset<'g>>,
    ) {
        self.axes[j] = axis.named(&format!("axis_{}", model.chain.coordinates[j].name));
        [self.linear[j], self.angular[j]] = momenta.map(|momentum| frame.apply(momentum));
        for (to, offset) in offsets.drain(..) {
            match to {
                Some(next) => self.offsets[next] = offset,
                None => self.tip = offset,
            }
        }
        offsets.push((Some(j), Vec3::zero(model.graph)));
    }

    /// The mass matrix, written out, including rotors. It is zero for two coordinates that are not on one path.
    pub fn mass_matrix(&self, model: &Model<'g>) -> SymmetricMatrix<'g> {
        let mut matrix = SymmetricMatrix::zero(model.graph, model.size());
        let mut angular = self.angular.clone();
        let before = model.chain.coordinates_before();
        for i in (0..model.size()).rev() {
            // The coordinate after i on the path of each that is beyond i.
            let mut after = vec![None; model.size()];
            for j in i + 1..model.size() {
                after[j] = before[j].and_then(|CoordinateId(k)| if k == i { Some(j) } else { after[k] });
                if let Some(next) = after[j] {
                    angular[j] = angular[j] + self.offsets[next].cross(self.linear[j]);
                }
            }
            for j in (i..model.size()).filter(|&j| j == i || after[j].is_some()) {
                let momentum = match model.chain.coordinates[i].kind {
                    CoordinateKind::Rotation => angular[j],
                    CoordinateKind::Translation => self.linear[j],
                };
                matrix.add(i, j, self.axes[i].dot(momentum));
            }
        }
        for (j, armature) in rotors::by_coordinate(model) {
            matrix.add(j, j, armature);
        }
        matrix
    }

    /// The points at which the coordinates of a chain without branches act, in order.
    pub fn points(&self, model: &Model<'g>) -> Vec<ConcurrentAxes> {
        let mut points: Vec<ConcurrentAxes> = Vec::new();
        // Whether the next coordinate acts at a new point; the first always does.
        let mut apart = true;
        for (coordinate, offset) in model.chain.coordinates.iter().zip(self.to_next()) {
            let rotate = coordinate.kind == CoordinateKind::Rotation;
            match points.last_mut() {
                Some(point) if !apart && point.rotate == rotate && point.coordinates < 3 => point.coordinates += 1,
                _ => points.push(ConcurrentAxes { coordinates: 1, rotate }),
            }
            apart = !offset.0.iter().all(|x| x.is_zero());
        }
        points
    }

    /// All numbers for a loop, without branches: the axes of all coordinates, then all P, all L and all offsets to the next coordinate.
    pub fn slots(&self) -> Vec<Expr<'g>> {
        let vectors = [&self.axes, &self.linear, &self.angular].into_iter().flatten();
        vectors.chain(self.to_next()).flat_map(|vector| vector.0).collect()
    }

    /// From the point of each coordinate to that of the next one, and of the last one to the tip.
    fn to_next(&self) -> impl Iterator<Item = &Vec3<'g>> {
        self.offsets.iter().skip(1).chain([&self.tip])
    }
}
