//! Strains at the present pose: coordinates, lengths of lines through points, couplings of coordinates.
//!
//! Notation
//! : points `p_i` of a line in the world, `ℓ = Σ m_i |p_{i+1} − p_i|`; `m_i` is 1, and of the last part the number of the line's falls;
//!   `u_i = m_i (p_{i+1} − p_i)/|p_{i+1} − p_i|`. `J_j = ∂ℓ/∂q_j = Σ u_i · (∂p_{i+1}/∂q_j − ∂p_i/∂q_j)`, summed over the parts of which
//!   j moves only one end: if it moves both, their distance stays the same. `ℓ̇ = J q̇`. For a coupling `ℓ = q_j − r q_i`, `J_j = 1`,
//!   `J_i = −r`.
//! : `∂²ℓ/∂q_i∂q_j` of a part that i and j change, with its distance d and `C_j` the velocity of its second end relative to its first at unit
//!   rate of j, is `m (C_i · C_j − (u · C_i)(u · C_j))/d`, and in addition `m ω_i · (C_j × u)` if i and j move the same end, i ≤ j: j turns and moves the
//!   forces at both ends, which i meets as in every [tangent](super::tangent).
//! : for a point and the ground `ℓ = h − z`, `J_j = −e_z · ∂p/∂q_j`; a force F pushes the point with `F e_z`, and its tangent is that of a load.
//! : for a beam as seen from a pad: [`pads`](super::pads); for a pin that turns: [`turning`](super::turning).

use std::collections::{BTreeMap, BTreeSet};

use super::kinematics::{Kinematics, Pose};
use super::model::Model;
use super::pads::{self, AtPad};
use super::place::{Along, Place, Pull};
use super::tangent::Tangent;
use super::turning::Turned;
use super::vector::{Rotation, SymmetricMatrix, Vec3};
use crate::chain::{Attachment, Axis, BodyId, CoordinateId, LinePart, Strain, StrainLine, Value};
use crate::symbolic::Expr;

/// A strain at the present pose.
#[derive(Clone)]
pub struct Strained<'g> {
    /// ℓ, m or rad.
    pub length: Expr<'g>,
    /// Indices and values of the entries of J.
    pub jacobian: Vec<(usize, Expr<'g>)>,
    /// `p_i` of a line.
    points: Vec<Vec3<'g>>,
    /// `u_i` of its parts: a tension of 1 N pulls `p_i` with `u_i`, and `p_{i+1}` with `−u_i`.
    pulls: Vec<Vec3<'g>>,
    /// What a tension of 1 exerts at a pad, N, or in a pin, N m.
    on_bodies: Vec<(Place<'g>, Pull<'g>)>,
}

/// The position of an end in the world.
pub(super) fn point<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, end: &Attachment) -> Vec3<'g> {
    let at = model.vector(&end.position);
    match end.body {
        Some(BodyId(body)) => {
            let Pose { rotation, origin } = kinematics.poses[body];
            origin + rotation.apply(at)
        }
        None => at,
    }
}

impl<'g> Strained<'g> {
    pub fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, strain: &Strain) -> Self {
        match strain {
            Strain::Coordinate(CoordinateId(j)) => {
                Strained::without_points(model.q[*j], vec![(*j, model.graph.constant(1.0))])
            }
            Strain::Line(line) => Strained::of_line(model, kinematics, line),
            Strain::Sliding(sliding) => {
                let AtPad { length, jacobian, pulls } = AtPad::new(model, kinematics, sliding);
                Strained { on_bodies: pulls, ..Strained::without_points(length, jacobian) }
            }
            Strain::Turning(turning) => {
                let Turned { angle, jacobian, pulls } = Turned::new(model, kinematics, turning);
                Strained { on_bodies: pulls, ..Strained::without_points(angle, jacobian) }
            }
            Strain::Depth { point: end, height } => Strained::of_depth(model, kinematics, end, height),
            Strain::Coupling { coordinate: CoordinateId(j), leader: CoordinateId(i), ratio } => {
                let ratio = model.number(ratio);
                let mut jacobian = vec![(*j, model.graph.constant(1.0)), (*i, -ratio)];
                jacobian.sort_by_key(|(index, _)| *index);
                Strained::without_points(model.q[*j] - ratio * model.q[*i], jacobian)
            }
        }
    }

    fn without_points(length: Expr<'g>, jacobian: Vec<(usize, Expr<'g>)>) -> Self {
        Strained { length, jacobian, points: Vec::new(), pulls: Vec::new(), on_bodies: Vec::new() }
    }

    fn of_depth(model: &Model<'g>, kinematics: &Kinematics<'g>, end: &Attachment, height: &Value) -> Self {
        let (point, up) = (point(model, kinematics, end), Rotation::identity(model.graph).axis(Axis::Z));
        let slope = |id: CoordinateId| (id.0, -up.dot(kinematics.generators[id.0].velocity(point)));
        let jacobian = model.chain.reach(end).into_iter().map(slope).collect();
        let place = end.body.map(|body| Place { body, along: Along::Fixed(end.position[0].clone()) });
        let pulls = place.map(|place| (place, Pull::of_force(point, up)));
        Strained {
            on_bodies: pulls.into_iter().collect(),
            ..Strained::without_points(model.number(height) - up.dot(point), jacobian)
        }
    }

    fn of_line(model: &Model<'g>, kinematics: &Kinematics<'g>, line: &StrainLine) -> Self {
        let points: Vec<Vec3<'g>> = line.points.iter().map(|end| point(model, kinematics, end)).collect();
        let (mut length, mut pulls) = (model.zero(), Vec::new());
        let mut jacobian = BTreeMap::new();
        for (part, ends) in line.parts().zip(points.windows(2)) {
            let way = ends[1] - ends[0];
            let distance = way.dot(way).sqrt();
            let pull = times(model, part.falls, (1.0 / distance) * way);
            let of_second = model.chain.reach(part.ends[1]);
            for id in model.chain.changing(part) {
                let (moved, sign) = if of_second.contains(&id) { (ends[1], 1.0) } else { (ends[0], -1.0) };
                let column = sign * pull.dot(kinematics.generators[id.0].velocity(moved));
                let sum = jacobian.remove(&id.0).map_or(column, |others: Expr<'g>| others + column);
                jacobian.insert(id.0, sum);
            }
            length = length + f64::from(part.falls) * distance;
            pulls.push(pull);
        }
        Strained { length, jacobian: jacobian.into_iter().collect(), points, pulls, on_bodies: Vec::new() }
    }

    /// ℓ̇
    pub fn rate(&self, model: &Model<'g>, v: &[Expr<'g>]) -> Expr<'g> {
        self.jacobian.iter().fold(model.zero(), |sum, &(j, column)| sum + column * v[j])
    }

    /// Adds `c Jᵀ J`.
    pub fn add_square(&self, c: Expr<'g>, matrix: &mut SymmetricMatrix<'g>) {
        for (index, &(j, one)) in self.jacobian.iter().enumerate() {
            for &(i, other) in &self.jacobian[..=index] {
                matrix.add(i, j, c * one * other);
            }
        }
    }

    /// Adds `∂F/∂ℓ Jᵀ J + F ∂²ℓ/∂q∂q` of a force with the tension F: the stiffness of the material and, since J depends on the pose, that of the
    /// geometry.
    pub fn add_tangent(
        &self,
        (model, kinematics): (&Model<'g>, &Kinematics<'g>),
        strain: &Strain,
        [tension, slope]: [Expr<'g>; 2],
        tangent: &mut Tangent<'_, 'g>,
    ) {
        if let Strain::Line(line) = strain {
            for ((part, ends), pull) in line.parts().zip(self.points.windows(2)).zip(&self.pulls) {
                let part = StrainPart::new((model, kinematics), part, [ends[0], ends[1]]);
                for &(j, column) in &self.jacobian {
                    part.add(j, slope * column * *pull, tangent);
                }
                part.add_curvature((model, kinematics), tension, tangent);
            }
            return;
        }
        let matrix = &mut tangent.matrix;
        self.add_square(slope, matrix);
        match strain {
            Strain::Coordinate(_) | Strain::Coupling { .. } | Strain::Line(_) => {}
            Strain::Sliding(sliding) => pads::add_curvature((model, kinematics), sliding, tension, matrix),
            Strain::Depth { point: end, .. } => {
                let (point, down) =
                    (point(model, kinematics, end), -tension * Rotation::identity(model.graph).axis(Axis::Z));
                let none = Vec3::zero(model.graph);
                for &(j, _) in &self.jacobian {
                    let velocity = kinematics.generators[j].velocity(point);
                    tangent.add(j, [end.body, None], [none, velocity.cross(down)]);
                    if let Some(curvature) = kinematics.curvatures.iter().find(|curvature| curvature.first == j) {
                        curvature.add_works((point - curvature.pose.origin).cross(down), &mut tangent.matrix);
                    }
                }
            }
            Strain::Turning(_) => {
                let slopes: Vec<_> = self.jacobian.iter().map(|(_, slope)| *slope).collect();
                for (index, &(j, _)) in self.jacobian.iter().enumerate() {
                    let by_j = model.graph.derivatives(&slopes[..=index], model.q[j]);
                    for (&(i, _), second) in self.jacobian.iter().zip(by_j) {
                        matrix.add(i, j, tension * second);
                    }
                }
            }
        }
    }

    /// The bodies that a tension of 1 N pulls, in the world: of all parts of a line or of some, at a pad, or in a pin. A strain of coordinates has none:
    /// its force acts on joints, like that of a drive.
    pub fn pulls(&self, strain: &Strain, counts: impl Fn(&LinePart<'_>) -> bool) -> Vec<(Place<'g>, Pull<'g>)> {
        let Some(line) = strain.line() else { return self.on_bodies.clone() };
        let mut sums: Vec<Option<Vec3<'g>>> = vec![None; self.points.len()];
        for (index, (_, pull)) in line.parts().zip(&self.pulls).enumerate().filter(|(_, (part, _))| counts(part)) {
            for (sum, pull) in sums[index..].iter_mut().zip([*pull, -*pull]) {
                *sum = Some(sum.map_or(pull, |others| others + pull));
            }
        }
        let of_point = |((end, point), pull): ((&Attachment, &Vec3<'g>), Option<Vec3<'g>>)| {
            let place = Place { body: end.body?, along: Along::Fixed(end.position[0].clone()) };
            Some((place, Pull::of_force(*point, pull?)))
        };
        line.points.iter().zip(&self.points).zip(sums).filter_map(of_point).collect()
    }
}

/// A straight part of a line at the present pose.
struct StrainPart<'g> {
    falls: u32,
    ends: [Vec3<'g>; 2],
    /// The bodies of the ends, and the last one that carries both.
    bodies: [Option<BodyId>; 2],
    meeting: Option<BodyId>,
    /// The coordinates that change it: whether each moves the second end, and the velocity of its second end relative to the first.
    changing: Vec<(usize, bool, Vec3<'g>)>,
}

impl<'g> StrainPart<'g> {
    fn new((model, kinematics): (&Model<'g>, &Kinematics<'g>), part: LinePart<'_>, ends: [Vec3<'g>; 2]) -> Self {
        let bodies = part.ends.map(|end| end.body);
        let of_second: BTreeSet<CoordinateId> = model.chain.reach(part.ends[1]).into_iter().collect();
        let moved = |id: CoordinateId| {
            let (generator, on_second) = (&kinematics.generators[id.0], of_second.contains(&id));
            (id.0, on_second, if on_second { generator.velocity(ends[1]) } else { -generator.velocity(ends[0]) })
        };
        StrainPart {
            falls: part.falls,
            ends,
            bodies,
            meeting: model.chain.meeting(bodies),
            changing: model.chain.changing(part).into_iter().map(moved).collect(),
        }
    }

    /// Adds to `S_j` a force on the second end, and its opposite on the first.
    fn add(&self, j: usize, force: Vec3<'g>, tangent: &mut Tangent<'_, 'g>) {
        for ((body, end), force) in self.bodies.into_iter().zip(self.ends).zip([-force, force]) {
            tangent.add(j, [body, self.meeting], [force, end.cross(force)]);
        }
    }

    /// Adds `F ∂²d/∂q∂q` of its distance d.
    fn add_curvature(
        &self,
        (model, kinematics): (&Model<'g>, &Kinematics<'g>),
        tension: Expr<'g>,
        tangent: &mut Tangent<'_, 'g>,
    ) {
        let way = self.ends[1] - self.ends[0];
        let distance = way.dot(way).sqrt();
        let tension = f64::from(self.falls) * tension;
        let (unit, across) = ((1.0 / distance) * way, tension / distance);
        let pull = tension * unit;
        let none = Vec3::zero(model.graph);
        for &(j, on_second, velocity) in &self.changing {
            self.add(j, across * (velocity - unit.dot(velocity) * unit), tangent);
            let body = self.bodies[usize::from(on_second)];
            tangent.add(j, [body, self.meeting], [none, velocity.cross(pull)]);
            if let Some(curvature) = kinematics.curvatures.iter().find(|curvature| curvature.first == j) {
                let [end, force] = if on_second { [self.ends[1], pull] } else { [self.ends[0], -pull] };
                curvature.add_works((end - curvature.pose.origin).cross(force), &mut tangent.matrix);
            }
        }
    }
}

/// A vector as many times as a line has falls; once without an operation.
fn times<'g>(model: &Model<'g>, falls: u32, vector: Vec3<'g>) -> Vec3<'g> {
    if falls == 1 { vector } else { model.graph.constant(f64::from(falls)) * vector }
}
