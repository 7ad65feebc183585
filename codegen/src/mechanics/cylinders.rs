//! Cylinders between their pins: length, its rate, its derivatives, and what a cylinder does to the bodies.
//!
//! Notation
//! : A the foot, B the rod's pin, H the head, P the pivot of the rocker, all in the world; e = (B − A)/ℓ. Without a linkage B = H:
//!
//! ```text
//! ℓ = |B − A|        ℓ̇ = e · (Ḃ − Ȧ)
//! ```
//!
//! With a linkage, B is at the rocker's length r from P and at the link's length l from H, in the plane normal to the joint's axis
//! n. With
//! `w = H − P`, `d = |w|`, `c = w/d` and `m = ± (n × w)/|n × w|`:
//!
//! ```text
//! B = P + a c + h m,                  a = (d² + r² − l²)/2d,   h = √(r² − a²)
//! Ḃ = Ṗ + ȧ c + a ċ + ḣ m + h ṁ,      ȧ = ḋ (1 − a/d),         ḣ = −a ȧ/h
//! ```
//!
//! If something bends between these points, all of them and the axis move against each other:
//!
//! ```text
//! ℓ̇ = g_A · Ȧ + g_P · Ṗ + g_H · Ḣ + g_n · ṅ
//! z = h/|n × w| (e − (e · m) m)
//! g_H = (1 − a/d) (e · c − a/h e · m) c + a/d (e − (e · c) c) + z × n,      g_n = w × z
//! g_A = −e,      g_P = e − g_H
//! ```
//!
//! A cylinder that pushes with F has the power F ℓ̇: it exerts the forces `F g_A`, `F g_P` and `F g_H` at A, P and H, and the moment
//! `F n × g_n` on the body that carries the axis. They are in balance, since ℓ does not change if everything moves together. In a pose in
//! which the linkage cannot be assembled, the square root is of a negative number, and the result is NaN.

use super::kinematics::Kinematics;
use super::model::Model;
use super::place::{Along, Place};
use super::vector::{SymmetricMatrix, Vec3};
use crate::chain::{Body, BodyId, CoordinateId, Cylinder, Linkage, Pin, Value};
use crate::symbolic::Expr;

/// A point on which the length of a cylinder depends.
struct Point<'g> {
    place: Place<'g>,
    position: Vec3<'g>,
    /// g of this point.
    gradient: Vec3<'g>,
}

/// A cylinder in a pose.
struct CylinderLine<'g> {
    /// ℓ
    length: Expr<'g>,
    /// H, A and, if there is a linkage, P
    points: Vec<Point<'g>>,
    /// n and `g_n`, if there is a linkage
    axis: Option<[Vec3<'g>; 2]>,
}

/// A linkage in a pose.
struct Assembled<'g> {
    /// n
    axis: Vec3<'g>,
    /// w and d
    across: Vec3<'g>,
    distance: Expr<'g>,
    /// a, and h with the sign of m: negative if the rod's pin is on the right
    along: Expr<'g>,
    height: Expr<'g>,
    /// c, and m without its sign
    unit_along: Vec3<'g>,
    unit_height: Vec3<'g>,
    /// |n × w|
    normal_length: Expr<'g>,
}

impl<'g> Assembled<'g> {
    fn new(axis: Vec3<'g>, across: Vec3<'g>, [rocker, link]: [Expr<'g>; 2], left: bool) -> Self {
        let distance = across.dot(across).sqrt();
        let along = (distance.squared() + rocker.squared() - link.squared()) / (2.0 * distance);
        let height = (rocker.squared() - along.squared()).sqrt();
        let normal = axis.cross(across);
        let normal_length = normal.dot(normal).sqrt();
        Assembled {
            axis,
            across,
            distance,
            along,
            height: if left { height } else { -height },
            unit_along: (1.0 / distance) * across,
            unit_height: (1.0 / normal_length) * normal,
            normal_length,
        }
    }

    /// B − P
    fn pin(&self) -> Vec3<'g> {
        self.along * self.unit_along + self.height * self.unit_height
    }

    /// `g_H` and `g_n`, from e.
    fn gradients(&self, direction: Vec3<'g>) -> [Vec3<'g>; 2] {
        let (ahead, aside) = (direction.dot(self.unit_along), direction.dot(self.unit_height));
        let share = self.along / self.distance;
        let stretch = (1.0 - share) * (ahead - self.along / self.height * aside);
        let turn = (self.height / self.normal_length) * (direction - aside * self.unit_height);
        let by_head = stretch * self.unit_along + share * (direction - ahead * self.unit_along) + turn.cross(self.axis);
        [by_head, self.across.cross(turn)]
    }
}

fn pin_position<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, pin: &Pin) -> Vec3<'g> {
    let pose = &kinematics.poses[pin.body.0];
    pose.origin + pose.rotation.apply(model.vector(&pin.position))
}

impl<'g> CylinderLine<'g> {
    fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, cylinder: &Cylinder) -> Self {
        let [foot, head] = [&cylinder.foot, &cylinder.head].map(|pin| pin_position(model, kinematics, pin));
        let axis = kinematics.generators[cylinder.coordinate.0].omega;
        let linkage = cylinder.linkage.as_ref().map(|Linkage { pivot, rocker, link, left }| {
            let position = pin_position(model, kinematics, pivot);
            let lengths = [rocker, link].map(|length| model.number(length));
            (pivot, position, Assembled::new(axis, head - position, lengths, *left))
        });
        let pin = linkage.as_ref().map_or(head, |(_, pivot, linkage)| *pivot + linkage.pin());
        let way = pin - foot;
        let length = way.dot(way).sqrt();
        let direction = (1.0 / length) * way;
        let point = |pin: &Pin, position, gradient| {
            let place = Place { body: pin.body, along: Along::Fixed(pin.position[0].clone()) };
            Point { place, position, gradient }
        };
        let of_foot = point(&cylinder.foot, foot, -direction);
        if let Some((pin, pivot, linkage)) = linkage {
            let [by_head, by_axis] = linkage.gradients(direction);
            let of_head = point(&cylinder.head, head, by_head);
            let of_pivot = point(pin, pivot, direction - by_head);
            CylinderLine { length, points: vec![of_head, of_foot, of_pivot], axis: Some([axis, by_axis]) }
        } else {
            let of_head = point(&cylinder.head, head, direction);
            CylinderLine { length, points: vec![of_head, of_foot], axis: None }
        }
    }

    /// Indices and values of the entries of `∂ℓ/∂q`: the rate of ℓ while a coordinate moves the side of the head against the other, which
    /// is the opposite of that while it moves the other side.
    fn jacobian(&self, model: &Model<'g>, kinematics: &Kinematics<'g>, cylinder: &Cylinder) -> Vec<(usize, Expr<'g>)> {
        let joint = cylinder.coordinate;
        let of_joint = model.chain.coordinates[joint.0].body;
        let entry = |id: CoordinateId| {
            let CoordinateId(j) = id;
            let generator = &kinematics.generators[j];
            let moves = |body: BodyId| model.chain.moves(id, body);
            let with_head = self.points.iter().filter(|point| moves(point.place.body) == moves(cylinder.head.body));
            let of_points = with_head.map(|point| point.gradient.dot(generator.velocity(point.position)));
            // The joint's own motion leaves its axis in place, and so do those after it.
            let moves_axis = id < joint && moves(of_joint);
            let turns_axis = id != joint && moves_axis == moves(cylinder.head.body);
            let of_axis = self.axis.filter(|_| turns_axis).map(|[axis, by_axis]| by_axis.dot(generator.rotate(axis)));
            let rate = of_points.chain(of_axis).fold(model.zero(), |sum, rate| sum + rate);
            (j, if moves(cylinder.head.body) { rate } else { -rate })
        };
        model.chain.spanned_by(cylinder).into_iter().map(entry).collect()
    }
}

/// Each cylinder, and its ℓ and ∂ℓ/∂q. They do not depend on the rest of the pose: what is not between the pins of any cylinder is at zero.
fn lines<'g, 'a>(model: &'a Model<'g>) -> impl Iterator<Item = (&'a Cylinder, Expr<'g>, Vec<(usize, Expr<'g>)>)> {
    let cylinders = &model.chain.cylinders;
    let mut q = model.zeros();
    for CoordinateId(j) in cylinders.iter().flat_map(|cylinder| model.chain.spanned_by(cylinder)) {
        q[j] = model.q[j];
    }
    let model = model.at(q);
    let kinematics = Kinematics::new(&model);
    cylinders.iter().map(move |cylinder| {
        let line = CylinderLine::new(&model, &kinematics, cylinder);
        (cylinder, line.length, line.jacobian(&model, &kinematics, cylinder))
    })
}

/// ℓ, ℓ̇ and `∂ℓ/∂q_j` of every cylinder, m, m/s and m or m/rad.
pub fn states<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let state = |(cylinder, length, jacobian): (&Cylinder, Expr<'g>, Vec<(usize, Expr<'g>)>)| {
        let rate = jacobian.iter().fold(model.zero(), |sum, &(j, entry)| sum + entry * model.v[j]);
        [length, rate, arm(&jacobian, cylinder)]
    };
    lines(model).flat_map(state).collect()
}

/// The entry of a joint, which is always between the pins.
fn arm<'g>(jacobian: &[(usize, Expr<'g>)], cylinder: &Cylinder) -> Expr<'g> {
    jacobian
        .iter()
        .find(|(j, _)| *j == cylinder.coordinate.0)
        .map(|(_, arm)| *arm)
        .expect("the joint is between the pins")
}

/// `∂ℓ/∂q` of every cylinder, row by row.
pub fn jacobians<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let row = |(_, _, jacobian): (_, _, Vec<(usize, Expr<'g>)>)| {
        let mut row = model.zeros();
        for (j, entry) in jacobian {
            row[j] = entry;
        }
        row
    };
    lines(model).flat_map(row).collect()
}

/// Force and moment about the world's origin, in the world frame, that a cylinder that pushes with 1 N exerts on bodies.
pub fn pushes<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    cylinder: &Cylinder,
) -> Vec<(Place<'g>, [Vec3<'g>; 2])> {
    let line = CylinderLine::new(model, kinematics, cylinder);
    let at = |point: &Point<'g>| (point.place.clone(), [point.gradient, point.position.cross(point.gradient)]);
    // The joint leaves its axis in place, seen from both of its sides: that on which the head is not. On the body before it, it is at the end.
    let beyond = model.chain.coordinates[cylinder.coordinate.0].body;
    let Body { parent, along, .. } = &model.chain.bodies[beyond.0];
    let carrier = match parent {
        Some(parent) if model.chain.moves(cylinder.coordinate, cylinder.head.body) => {
            Place { body: *parent, along: Along::Fixed(along.clone()) }
        }
        _ => Place { body: beyond, along: Along::Fixed(Value::ZERO) },
    };
    let on_carrier = line.axis.map(|[axis, by_axis]| (carrier, [Vec3::zero(model.graph), axis.cross(by_axis)]));
    line.points.iter().map(at).chain(on_carrier).collect()
}

/// The stiffness at rest of the drive whose joint oil moves; `None` for a cylinder without a valve.
fn holding<'a>(model: &'a Model<'_>, cylinder: &Cylinder) -> Option<&'a Value> {
    model.chain.drives[model.chain.drive_of(cylinder)].oil()
}

/// Generalized forces of cylinders with a valve that hold the crane at rest, with the drives at given positions, by coordinate: springs
/// along the cylinders.
///
/// ```text
/// f = k (ℓ₀ − ℓ) ∂ℓ/∂q,     k = s/(∂ℓ/∂q_j)₀²
/// ```
///
/// The index 0 is for the crane with the drives at their positions and straight beams; s is the stiffness of the drive.
pub fn holding_forces<'g>(model: &Model<'g>, positions: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    let mut straight = model.zeros();
    for j in model.chain.cylinders.iter().map(|cylinder| cylinder.coordinate.0) {
        straight[j] = positions[j];
    }
    let straight = model.at(straight);
    for ((cylinder, length, jacobian), (_, meant, of_straight)) in lines(model).zip(lines(&straight)) {
        let Some(stiffness) = holding(model, cylinder) else { continue };
        let push = model.number(stiffness) / arm(&of_straight, cylinder).squared() * (meant - length);
        for (j, entry) in jacobian {
            forces[j] = forces[j] + entry * push;
        }
    }
    forces
}

/// Adds `−∂f/∂q` of the forces that hold the crane at rest.
pub fn holding_stiffness<'g>(model: &Model<'g>, positions: &[Expr<'g>], matrix: &mut SymmetricMatrix<'g>) {
    let held = model.chain.cylinders.iter().filter(|cylinder| holding(model, cylinder).is_some());
    let spanned = held.flat_map(|cylinder| model.chain.spanned_by(cylinder)).map(|CoordinateId(j)| j).collect();
    model.add_tangent(&holding_forces(model, positions), &spanned, matrix);
}
