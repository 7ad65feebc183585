//! The chain from the base to the tips as a sequence of factors: constant placements, joints, bodies.
//!
//! Where a branch begins, the sequence continues from a body that was reached before. An outward sweep takes the state up again that it had
//! there ([`Reached`]); an inward sweep adds what the branch brings when it arrives at that body ([`Branches`]).

use crate::chain::{Axis, BodyId, CoordinateKind, Step};

use super::axis_rotation::AxisRotation;
use super::model::Model;
use super::rotation_vector::RotationVector;
use super::vector::Vec3;

/// One factor of the chain from the base to the tips.
#[derive(Clone, Debug)]
pub enum Factor<'g> {
    /// Constant translation.
    Translate(Vec3<'g>),
    /// Constant rotation.
    Rotation(AxisRotation<'g>),
    /// Rotation by coordinate `j`.
    Revolute { j: usize, rotation: AxisRotation<'g> },
    /// Translation by coordinate `j` along an axis.
    Prismatic { j: usize, axis: Axis },
    /// Three rotations through one point about three different axes, by coordinates `j`, `j + 1`, `j + 2`: a ball joint.
    Ball { j: usize, rotations: [AxisRotation<'g>; 3] },
    /// Rotation by the vector of coordinates `j`, `j + 1`, `j + 2`.
    RotationVector { j: usize, vector: Box<RotationVector<'g>> },
    /// The frame reached is that of a body.
    Body(usize),
    /// The factors that follow, up to the next branch, begin at the frame of this body: a branch.
    Branch(usize),
}

/// The states of an outward sweep at the bodies that it has reached.
#[derive(Debug)]
pub struct Reached<S>(Vec<S>);

impl<S: Copy> Reached<S> {
    /// None so far.
    pub fn new() -> Self {
        Reached(Vec::new())
    }

    /// At the frame of a body, notes the state; at the beginning of a branch, takes up that of its body.
    pub fn follow(&mut self, factor: &Factor<'_>, state: &mut S) {
        match factor {
            Factor::Body(_) => self.0.push(*state),
            Factor::Branch(from) => *state = self.0[*from],
            _ => {}
        }
    }
}

/// What an inward sweep brings from branches to the bodies at which they begin.
#[derive(Debug)]
pub struct Branches<T>(Vec<Vec<T>>);

impl<T> Branches<T> {
    /// None so far.
    pub fn new(model: &Model<'_>) -> Self {
        Branches(model.chain.bodies.iter().map(|_| Vec::new()).collect())
    }

    /// The sweep has passed a branch that begins at a body.
    pub fn bring(&mut self, to: usize, what: T) {
        self.0[to].push(what);
    }

    /// The sweep reaches a body: what all branches that begin at it bring.
    pub fn take(&mut self, at: usize) -> Vec<T> {
        std::mem::take(&mut self.0[at])
    }
}

impl<'g> Factor<'g> {
    /// Whether it depends on coordinates.
    pub fn moves(&self) -> bool {
        !matches!(self, Factor::Translate(_) | Factor::Rotation(_) | Factor::Body(_) | Factor::Branch(_))
    }

    /// Its elementary rotations, from the base to the tip, with their coordinates.
    pub fn rotations(&self) -> Vec<(Option<usize>, AxisRotation<'g>)> {
        match self {
            Factor::Rotation(rotation) => vec![(None, *rotation)],
            Factor::Revolute { j, rotation } => vec![(Some(*j), *rotation)],
            Factor::Ball { j, rotations } => {
                rotations.iter().enumerate().map(|(k, rotation)| (Some(j + k), *rotation)).collect()
            }
            Factor::Translate(_)
            | Factor::Prismatic { .. }
            | Factor::RotationVector { .. }
            | Factor::Body(_)
            | Factor::Branch(_) => vec![],
        }
    }
}

/// The factors of a chain, from the base to the tips.
pub fn factors<'g>(model: &Model<'g>) -> Vec<Factor<'g>> {
    let mut factors = Vec::new();
    for (index, body) in model.chain.bodies.iter().enumerate() {
        if model.chain.begins_branch(BodyId(index)) {
            factors.extend(body.parent.map(|BodyId(parent)| Factor::Branch(parent)));
        }
        let mut path = body.path.as_slice();
        while let Some((step, rest)) = path.split_first() {
            path = rest;
            factors.push(match step {
                Step::Translate(by) => Factor::Translate(model.vector(by)),
                Step::Rotate { axis, sin, cos } => {
                    Factor::Rotation(AxisRotation { axis: *axis, sin: model.number(sin), cos: model.number(cos) })
                }
                Step::RotationVector(ids) => {
                    Factor::RotationVector { j: ids[0].0, vector: Box::new(RotationVector::new(model, ids)) }
                }
                Step::Move(id) => {
                    let j = id.0;
                    let joint = joint(model, j);
                    match (&joint, path) {
                        (Factor::Revolute { rotation, .. }, [Step::Move(_), Step::Move(_), rest @ ..]) => {
                            if let Some(rotations) = ball(model, j, *rotation) {
                                path = rest;
                                Factor::Ball { j, rotations }
                            } else {
                                joint
                            }
                        }
                        _ => joint,
                    }
                }
            });
        }
        factors.push(Factor::Body(index));
    }
    factors
}

/// The joint of one coordinate.
fn joint<'g>(model: &Model<'g>, j: usize) -> Factor<'g> {
    let coordinate = &model.chain.coordinates[j];
    match coordinate.kind {
        CoordinateKind::Translation => Factor::Prismatic { j, axis: coordinate.axis },
        CoordinateKind::Rotation => Factor::Revolute { j, rotation: model.axis_rotation(j) },
    }
}

/// The rotations of coordinates j, j + 1, j + 2, all elementary motions without a placement between them, if they form a ball
/// joint.
fn ball<'g>(model: &Model<'g>, j: usize, first: AxisRotation<'g>) -> Option<[AxisRotation<'g>; 3]> {
    let (Factor::Revolute { rotation: second, .. }, Factor::Revolute { rotation: third, .. }) =
        (joint(model, j + 1), joint(model, j + 2))
    else {
        return None;
    };
    let different = first.axis != second.axis && second.axis != third.axis && third.axis != first.axis;
    different.then_some([first, second, third])
}
