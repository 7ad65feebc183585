//! Mass matrix from composite bodies.
//!
//! Notation
//! : everything beyond a joint, as one composite body: its mass m, first moments s and inertia I about the joint's point, in the
//!   joint's own frame; its momenta at unit rate of coordinate j, `P_j` and, about the point, `L_j`, and the axis `n_j`, in the
//!   world's axes.
//!
//! Output
//! : `a_ij = n_i · L_j` for a rotation i and `n_i · P_j` for a translation, i ≤ j, with L_j about the point of i
//!   [Urbaś 2016, Eq. (5)].
//!
//! In its own frame a joint's axis is one of the unit vectors: momenta are a column of I and two entries of s, and most
//! placements are shifts along one axis. In the world's axes a row of A is one scalar product per column, without rotations
//! from joint to joint. About local points nothing large is subtracted, so the torsional inertia of a slender element keeps
//! its digits; about the world's origin it would be small compared with the inertia of the whole crane.

use super::axis_rotation::AxisRotation;
use super::factors::Factor;
use super::model::Model;
use super::rotors;
use super::vector::{Rotation, Symmetric3, SymmetricMatrix, Vec3};
use crate::chain::{Axis, CoordinateKind, Inertia};
use crate::program::ConcurrentAxes;
use crate::symbolic::Expr;

/// The factors of the mass matrix: for each coordinate its axis, its momenta, and the offset from its point to that of the
/// next coordinate.
pub struct Columns<'g> {
    pub axes: Vec<Vec3<'g>>,
    pub linear: Vec<Vec3<'g>>,
    pub angular: Vec<Vec3<'g>>,
    pub offsets: Vec<Vec3<'g>>,
}

/// Axes, momenta and offsets of all coordinates, in the world's axes.
pub fn columns<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Columns<'g> {
    let mut frames = frames(model, factors);
    let mut frame_before = || frames.pop().expect("as many as outward");
    let zero = Vec3::zero(model.graph);
    let empty = vec![zero; model.size()];
    let mut columns = Columns { axes: empty.clone(), linear: empty.clone(), angular: empty.clone(), offsets: empty };
    let mut composite = Composite::nothing(model);
    let mut offset = zero;
    let sweep = model.graph.sweep();
    for factor in factors.iter().rev() {
        match factor {
            Factor::Body(index) => {
                let body = &model.chain.bodies[*index];
                sweep.visit(&body.name);
                if let Some(inertia) = &body.inertia {
                    composite.add(model, inertia);
                    composite.named(&body.name);
                }
            }
            Factor::Translate(by) => {
                composite.shift(*by);
                offset = offset + frame_before().apply(*by);
            }
            Factor::Prismatic { j, axis } => {
                let (frame, by) = (frame_before(), Vec3::along(*axis, model.q[*j]));
                columns.set(model, *j, (&frame, frame.axis(*axis)), composite.sliding(*axis), offset);
                composite.shift(by);
                offset = frame.apply(by);
            }
            Factor::RotationVector { j, vector } => {
                let frame = frame_before();
                composite.rotate(vector.rotation());
                let jacobian = vector.jacobian();
                let axes = vector.by_coordinates([0, 1, 2].map(|k| jacobian.column(k)));
                for (k, axis) in axes.into_iter().enumerate().rev() {
                    columns.set(model, j + k, (&frame, frame.apply(axis)), composite.turning_about(axis), offset);
                    offset = zero;
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
                            offset,
                        );
                        offset = zero;
                    }
                }
            }
        }
    }
    columns
}

/// The axes of the frame before each rotation and each translation, from the base to the tip.
fn frames<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Vec<Rotation<'g>> {
    let mut frame = Rotation::identity(model.graph);
    let mut frames = Vec::new();
    let sweep = model.graph.sweep();
    for factor in factors {
        match factor {
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
struct Composite<'g> {
    mass: Expr<'g>,
    first: Vec3<'g>,
    second: Symmetric3<'g>,
}

impl<'g> Composite<'g> {
    fn nothing(model: &Model<'g>) -> Self {
        Composite { mass: model.zero(), first: Vec3::zero(model.graph), second: Symmetric3::zero(model.graph) }
    }

    fn add(&mut self, model: &Model<'g>, inertia: &Inertia) {
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

impl<'g> Columns<'g> {
    /// Stores the axis, the momenta and the offset of coordinate j; the momenta are given by their components in a frame.
    fn set(
        &mut self,
        model: &Model<'g>,
        j: usize,
        (frame, axis): (&Rotation<'g>, Vec3<'g>),
        momenta: [Vec3<'g>; 2],
        offset: Vec3<'g>,
    ) {
        self.axes[j] = axis.named(&format!("axis_{}", model.chain.coordinates[j].name));
        [self.linear[j], self.angular[j]] = momenta.map(|momentum| frame.apply(momentum));
        self.offsets[j] = offset;
    }

    /// The mass matrix, written out, including rotors.
    pub fn mass_matrix(&self, model: &Model<'g>) -> SymmetricMatrix<'g> {
        let mut matrix = SymmetricMatrix::zero(model.graph, model.size());
        let mut angular = self.angular.clone();
        for i in (0..model.size()).rev() {
            for j in i + 1..model.size() {
                angular[j] = angular[j] + self.offsets[i].cross(self.linear[j]);
            }
            for j in i..model.size() {
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

    /// The points at which the coordinates act, in order.
    pub fn points(&self, model: &Model<'g>) -> Vec<ConcurrentAxes> {
        let mut points: Vec<ConcurrentAxes> = Vec::new();
        // Whether the next coordinate acts at a new point; the first always does.
        let mut apart = true;
        for (coordinate, offset) in model.chain.coordinates.iter().zip(&self.offsets) {
            let rotate = coordinate.kind == CoordinateKind::Rotation;
            match points.last_mut() {
                Some(point) if !apart && point.rotate == rotate && point.coordinates < 3 => point.coordinates += 1,
                _ => points.push(ConcurrentAxes { coordinates: 1, rotate }),
            }
            apart = !offset.0.iter().all(|x| x.is_zero());
        }
        points
    }

    /// All numbers for a loop: the axes of all coordinates, then all P, all L and all offsets.
    pub fn slots(&self) -> Vec<Expr<'g>> {
        let vectors = [&self.axes, &self.linear, &self.angular, &self.offsets];
        vectors.into_iter().flatten().flat_map(|vector| vector.0).collect()
    }
}
