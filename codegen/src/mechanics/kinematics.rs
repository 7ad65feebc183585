//! Poses of bodies and axes of motion, in one pass from the base to the tips.
//!
//! Notation
//! : `T(p)` pose of body p in the world; `R`, `r` its rotation and origin. For coordinate j the generator in the world
//!   is `Ω_j = P G_j P⁻¹`, P the pose just before its elementary motion. Ω_j moves the point at x with the velocity
//!   `ω_j × x + υ_j`: a rotation has its axis ω_j through `o_j`, so `υ_j = o_j × ω_j`; a translation has ω_j = 0.
//!
//! Input
//! : paths of the bodies, q.
//!
//! Output
//! : `T(p) = T(λ(p)) T̃(p)`, λ(p) the body to which p is attached [Urbaś 2016, Eq. (3), where it is p − 1], and Ω_j, with which `∂T/∂q_j = Ω_j T`. Second derivatives are
//!   `∂²T/∂q_m∂q_n = Ω_m Ω_n T`, m ≤ n; for two coordinates of one rotation vector, each of whose axes depends on the other
//!   coordinate, with an additional rotation about the same point ([`Curvature`]).

use crate::chain::{BodyId, CoordinateId, CoordinateKind, Step};
use crate::symbolic::Expr;

use super::axis_rotation::AxisRotation;
use super::model::Model;
use super::rotation_vector::RotationVector;
use super::vector::{Rotation, SymmetricMatrix, Vec3};

/// A frame in the world.
#[derive(Clone, Copy, Debug)]
pub struct Pose<'g> {
    pub rotation: Rotation<'g>,
    pub origin: Vec3<'g>,
}

/// The generator Ω_j of a coordinate in the world frame.
#[derive(Clone, Copy, Debug)]
pub struct Generator<'g> {
    pub kind: CoordinateKind,
    /// ω_j: axis of rotation; zero for a translation.
    pub omega: Vec3<'g>,
    /// υ_j: velocity of the point at the world's origin.
    pub upsilon: Vec3<'g>,
    /// o_j: a point on the axis.
    pub point: Vec3<'g>,
    /// Index of the first body that it moves.
    pub body: usize,
}

impl<'g> Generator<'g> {
    /// A rotation about an axis through a point.
    fn through(point: Vec3<'g>, omega: Vec3<'g>, body: usize) -> Self {
        Generator { kind: CoordinateKind::Rotation, omega, upsilon: point.cross(omega), point, body }
    }

    /// `Ω_j x` for a point x: its velocity at unit rate.
    pub fn velocity(&self, x: Vec3<'g>) -> Vec3<'g> {
        match self.kind {
            CoordinateKind::Rotation => self.omega.cross(x - self.point),
            CoordinateKind::Translation => self.upsilon,
        }
    }

    /// `Ω_j u` for a direction u: its rate at unit rate.
    pub fn rotate(&self, u: Vec3<'g>) -> Vec3<'g> {
        self.omega.cross(u)
    }
}

/// A rotation vector whose second derivatives `∂²T/∂q_m∂q_n` contain a rotation `E_mn` about the joint's point in addition to `Ω_m Ω_n T`.
#[derive(Clone, Copy, Debug)]
pub struct Curvature<'g> {
    /// First of the three coordinates.
    pub first: usize,
    /// Index of the first body that it moves.
    pub body: usize,
    /// The frame before it.
    pub pose: Pose<'g>,
    vector: RotationVector<'g>,
}

impl<'g> Curvature<'g> {
    /// Indices m ≤ n among the three coordinates, row by row of a triangle.
    pub const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

    /// The rotation vector.
    pub fn vector(&self) -> &RotationVector<'g> {
        &self.vector
    }

    /// Axes of two coordinates.
    fn axes(&self, (m, n): (usize, usize)) -> (usize, usize) {
        let axes = self.vector.by_coordinates([0, 1, 2]);
        (axes[m], axes[n])
    }

    /// `E_mn`
    pub fn generator(&self, pair: (usize, usize)) -> Generator<'g> {
        let axis = self.vector.curvature(self.axes(pair));
        Generator::through(self.pose.origin, self.pose.rotation.apply(axis), self.body)
    }

    /// `E_mn` as `Σ_k share_k Ω_k` over the coordinates k of the joint.
    pub fn shares(&self, pair: (usize, usize)) -> [Expr<'g>; 3] {
        self.vector.by_coordinates(self.vector.rates_of(self.vector.curvature(self.axes(pair))).0)
    }

    /// Power of a torque, given in the world frame, at unit rate of each `E_mn`.
    pub fn works(&self, torque: Vec3<'g>) -> [Expr<'g>; 6] {
        let local = self.pose.rotation.apply_transposed(torque);
        Self::PAIRS.map(|pair| self.vector.curvature_along(local, self.axes(pair)))
    }

    /// Adds [`works`](Self::works) at the entries of their coordinates.
    pub fn add_works(&self, torque: Vec3<'g>, matrix: &mut SymmetricMatrix<'g>) {
        for ((m, n), work) in Self::PAIRS.into_iter().zip(self.works(torque)) {
            matrix.add(self.first + m, self.first + n, work);
        }
    }
}

/// Poses and generators of a chain.
pub struct Kinematics<'g> {
    /// T(p), one per body.
    pub poses: Vec<Pose<'g>>,
    /// Ω_j, one per coordinate.
    pub generators: Vec<Generator<'g>>,
    /// One per rotation vector.
    pub curvatures: Vec<Curvature<'g>>,
}

impl<'g> Kinematics<'g> {
    pub fn new(model: &Model<'g>) -> Self {
        Self::with_bodies(model, |_| true)
    }

    /// Those of the bodies for which `counts` holds, of which each one's parent is another; others rest at the origin.
    pub fn with_bodies(model: &Model<'g>, counts: impl Fn(usize) -> bool) -> Self {
        let world = Pose { rotation: Rotation::identity(model.graph), origin: Vec3::zero(model.graph) };
        let (mut poses, mut generators, mut curvatures): (Vec<Pose<'g>>, _, _) = (Vec::new(), Vec::new(), Vec::new());
        for (index, body) in model.chain.bodies.iter().enumerate() {
            if !counts(index) {
                let Pose { origin: zero, .. } = world;
                generators.extend(model.chain.own_coordinates(index).map(|CoordinateId(j)| Generator {
                    kind: model.chain.coordinates[j].kind,
                    omega: zero,
                    upsilon: zero,
                    point: zero,
                    body: index,
                }));
                poses.push(world);
                continue;
            }
            let mut pose = body.parent.map_or(world, |BodyId(parent)| poses[parent]);
            for step in &body.path {
                match step {
                    Step::Translate(by) => pose.origin = pose.origin + pose.rotation.apply(model.vector(by)),
                    Step::Rotate { axis, sin, cos } => {
                        pose.rotation = pose.rotation.rotated(*axis, model.number(sin), model.number(cos));
                    }
                    Step::Move(id) => {
                        generators.push(generator(model, pose, *id, index));
                        pose = moved(model, pose, *id);
                    }
                    Step::RotationVector(ids) => {
                        let vector = RotationVector::new(model, ids);
                        generators.extend(generators_of(model, pose, (ids, &vector), index));
                        curvatures.push(Curvature { first: ids[0].0, body: index, pose, vector });
                        pose.rotation = pose.rotation.times(vector.rotation());
                    }
                }
            }
            for (column, axis) in pose.rotation.0.iter().zip(["x", "y", "z"]) {
                column.named(&format!("{}_axis_{axis}", body.name));
            }
            pose.origin.named(&format!("{}_origin", body.name));
            poses.push(pose);
        }
        Kinematics { poses, generators, curvatures }
    }
}

/// Ω_j, its motion starting from `pose`.
fn generator<'g>(model: &Model<'g>, pose: Pose<'g>, id: CoordinateId, body: usize) -> Generator<'g> {
    let coordinate = &model.chain.coordinates[id.0];
    let axis = pose.rotation.axis(coordinate.axis);
    let (omega, upsilon) = match coordinate.kind {
        CoordinateKind::Rotation => (
            axis.named(&format!("omega_{}", coordinate.name)),
            pose.origin.cross(axis).named(&format!("upsilon_{}", coordinate.name)),
        ),
        CoordinateKind::Translation => (Vec3::zero(model.graph), axis.named(&format!("upsilon_{}", coordinate.name))),
    };
    Generator { kind: coordinate.kind, omega, upsilon, point: pose.origin, body }
}

/// Ω_j of a rotation vector, its motion starting from `pose`.
fn generators_of<'g>(
    model: &Model<'g>,
    pose: Pose<'g>,
    (ids, vector): (&[CoordinateId; 3], &RotationVector<'g>),
    body: usize,
) -> [Generator<'g>; 3] {
    let jacobian = vector.jacobian();
    let axes = vector.by_coordinates([0, 1, 2].map(|k| pose.rotation.apply(jacobian.column(k))));
    [0, 1, 2].map(|k| {
        let name = &model.chain.coordinates[ids[k].0].name;
        let generator = Generator::through(pose.origin, axes[k].named(&format!("omega_{name}")), body);
        generator.upsilon.named(&format!("upsilon_{name}"));
        generator
    })
}

/// The pose after the elementary motion of a coordinate.
fn moved<'g>(model: &Model<'g>, pose: Pose<'g>, id: CoordinateId) -> Pose<'g> {
    let coordinate = &model.chain.coordinates[id.0];
    match coordinate.kind {
        CoordinateKind::Rotation => {
            let AxisRotation { axis, sin, cos } = model.axis_rotation(id.0);
            Pose { rotation: pose.rotation.rotated(axis, sin, cos), ..pose }
        }
        CoordinateKind::Translation => {
            let along: Vec3<'g> = model.q[id.0] * pose.rotation.axis(coordinate.axis);
            Pose { origin: pose.origin + along, ..pose }
        }
    }
}
