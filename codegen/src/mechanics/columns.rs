//! Mass matrix in the world's axes about local points.
//!
//! Notation
//! : by components in the world's axes. At each joint, the axis `n_j`; the composite of all that hangs on it about the
//!   joint's point: mass m, first moments s, inertia I; its momenta at unit rate, `P_j` and, about the point, `L_j`.
//!
//! Output
//! : `a_ij = n_i · L_j` where i turns and `n_i · P_j` where it slides, i ≤ j, with L_j taken about the point of i
//!   [Urbaś 2016, Eq. (5)].
//!
//! About local points nothing large is subtracted: the torsional inertia of a slender element keeps its digits beside the
//! inertia of a whole crane about the world's origin.

use super::factors::Factor;
use super::model::Model;
use super::turn::Turn;
use super::vector::{Rotation, Symmetric3, SymmetricMatrix, Vec3};
use crate::chain::CoordinateKind;
use crate::symbolic::{Expr, Point};

/// One factor of the chain in the world's axes.
#[derive(Clone, Copy, Debug)]
enum Place<'g> {
    /// Rotation by a coordinate about an axis.
    Turning { j: usize, axis: Vec3<'g> },
    /// Translation by a vector, and by a coordinate along an axis if it is one of those.
    Moving { by: Vec3<'g>, sliding: Option<(usize, Vec3<'g>)> },
    /// A body's frame.
    Body { index: usize, rotation: Rotation<'g> },
}

/// A chain in the world's axes.
pub struct Places<'g>(Vec<Place<'g>>);

/// What the mass matrix is made of: for each coordinate its axis, its momenta, and the way from its point to that of the
/// coordinate after it.
pub struct Columns<'g> {
    pub axes: Vec<Vec3<'g>>,
    pub linear: Vec<Vec3<'g>>,
    pub angular: Vec<Vec3<'g>>,
    pub shifts: Vec<Vec3<'g>>,
}

impl<'g> Places<'g> {
    pub fn new(model: &Model<'g>, factors: &[Factor<'g>]) -> Self {
        let mut rotation = Rotation::identity(model.graph);
        let mut places = Vec::new();
        let turning = |rotation: &mut Rotation<'g>, j: usize, turn: &Turn<'g>| {
            let axis = rotation.axis(turn.axis).named(&format!("axis_{}", model.chain.coordinates[j].name));
            *rotation = rotation.turned(turn.axis, turn.sin, turn.cos);
            Place::Turning { j, axis }
        };
        let sweep = model.graph.sweep();
        for factor in factors {
            match factor {
                Factor::Translate(by) => places.push(Place::Moving { by: rotation.apply(*by), sliding: None }),
                Factor::Turn(turn) => rotation = rotation.turned(turn.axis, turn.sin, turn.cos),
                Factor::Revolute { j, turn } => places.push(turning(&mut rotation, *j, turn)),
                Factor::Ball { j, turns } => {
                    for (k, turn) in turns.iter().enumerate() {
                        places.push(turning(&mut rotation, j + k, turn));
                    }
                }
                Factor::Prismatic { j, axis } => {
                    let axis: Vec3<'g> = rotation.axis(*axis);
                    places.push(Place::Moving { by: model.q[*j] * axis, sliding: Some((*j, axis)) });
                }
                Factor::Body(index) => {
                    places.push(Place::Body { index: *index, rotation });
                    sweep.leave(&model.chain.bodies[*index].name);
                }
            }
        }
        Places(places)
    }

    /// Axes and momenta of the coordinates.
    pub fn columns(&self, model: &Model<'g>) -> Columns<'g> {
        let zero = Vec3::zero(model.graph);
        let empty = vec![zero; model.size()];
        let mut columns = Columns { axes: empty.clone(), linear: empty.clone(), angular: empty.clone(), shifts: empty };
        let (mut mass, mut first, mut inertia) = (model.zero(), zero, Symmetric3::zero(model.graph));
        let mut way = zero;
        let sweep = model.graph.sweep();
        for place in self.0.iter().rev() {
            match place {
                Place::Body { index, rotation } => {
                    sweep.visit(&model.chain.bodies[*index].name);
                    if let Some((m, s, i)) = body(model, *index, rotation) {
                        (mass, first, inertia) = (mass + m, first + s, inertia + i);
                        let name = &model.chain.bodies[*index].name;
                        first.named(&format!("first_from_{name}"));
                        inertia.named(&format!("inertia_from_{name}"));
                    }
                }
                Place::Turning { j, axis } => {
                    (columns.axes[*j], columns.shifts[*j]) = (*axis, way);
                    (columns.linear[*j], columns.angular[*j]) = (axis.cross(first), inertia.apply(*axis));
                    way = zero;
                }
                Place::Moving { by, sliding } => {
                    if let Some((j, axis)) = sliding {
                        (columns.axes[*j], columns.shifts[*j]) = (*axis, way);
                        (columns.linear[*j], columns.angular[*j]) = (mass * *axis, first.cross(*axis));
                        way = zero;
                    }
                    inertia = inertia + Symmetric3::outer(first + (0.5 * mass) * *by, *by).tensor();
                    first = first + mass * *by;
                    way = way + *by;
                }
            }
        }
        columns
    }
}

/// Mass, first moments and inertia of a body about its frame's origin, in the world's axes.
fn body<'g>(model: &Model<'g>, index: usize, rotation: &Rotation<'g>) -> Option<(Expr<'g>, Vec3<'g>, Symmetric3<'g>)> {
    let inertia = model.chain.bodies[index].inertia.as_ref()?;
    let second = model.second_moments(inertia);
    let first = rotation.apply(model.vector(&inertia.first));
    Some((model.number(&inertia.mass), first, second.rotated(*rotation).tensor()))
}

impl<'g> Columns<'g> {
    /// The mass matrix, written out.
    pub fn mass_matrix(&self, model: &Model<'g>) -> SymmetricMatrix<'g> {
        let mut matrix = SymmetricMatrix::zero(model.graph, model.size());
        let mut angular = self.angular.clone();
        for i in (0..model.size()).rev() {
            for j in i + 1..model.size() {
                angular[j] = angular[j] + self.shifts[i].cross(self.linear[j]);
            }
            for j in i..model.size() {
                let momentum = match model.chain.coordinates[i].kind {
                    CoordinateKind::Rotation => angular[j],
                    CoordinateKind::Translation => self.linear[j],
                };
                matrix.add(i, j, self.axes[i].dot(momentum));
            }
        }
        matrix
    }

    /// The points that the coordinates act at, in order.
    pub fn points(&self, model: &Model<'g>) -> Vec<Point> {
        let mut points: Vec<Point> = Vec::new();
        // The way from the coordinate before; there is none before the first.
        let mut apart = true;
        for (coordinate, way) in model.chain.coordinates.iter().zip(&self.shifts) {
            let turns = coordinate.kind == CoordinateKind::Rotation;
            match points.last_mut() {
                Some(point) if !apart && point.turns == turns && point.coordinates < 3 => point.coordinates += 1,
                _ => points.push(Point { coordinates: 1, turns }),
            }
            apart = !way.0.iter().all(|x| x.is_zero());
        }
        points
    }

    /// All numbers, for a loop: axes, P, L and shifts, coordinate by coordinate.
    pub fn slots(&self) -> Vec<Expr<'g>> {
        let vectors = [&self.axes, &self.linear, &self.angular, &self.shifts];
        vectors.into_iter().flatten().flat_map(|vector| vector.0).collect()
    }
}
