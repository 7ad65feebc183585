//! Joints that close loops: equations φ(q) = 0 between two bodies, their rows J = ∂φ/∂q, and what they transmit.
//!
//! Notation
//! : R the axes of the first body; p₁, p₂ the points in the world; a the axis on the second body in the world.
//!   `r = Rᵀ (p₂ − p₁)`, `s = Rᵀ a`. Every equation is linear in r or s, except that of a rod, `|r| − L`.
//!
//! Only the motion of the second body relative to the first counts. With `Ω_j` the generator of coordinate j and `σ_j` 1 if it moves
//! only the second body, −1 if it moves only the first, 0 otherwise:
//!
//! ```text
//! ∂r/∂q_j = σ_j Rᵀ Ω_j p₂            ∂s/∂q_j = σ_j Rᵀ (ω_j × a)
//! r̈ = Rᵀ (ẍ₂ − ẍ₁ − 2 ω₁ × (ẋ₂ − ẋ₁))                    at p₂, x₁ and x₂ points of the bodies there
//! ```
//!
//! and the same for s with directions in place of points. What is needed of r̈ is its value for q̈ = 0, so that `φ̈ = J q̈ + J̇ q̇`.
//!
//! λ are the forces and moments that the second body exerts on the first, along the directions of the equations: the generalized forces
//! are `f = −Jᵀ λ`.

use super::kinematics::{Curvature, Generator, Kinematics, Pose};
use super::model::Model;
use super::place::Place;
use super::vector::{Rotation, Vec3};
use crate::chain::{Across, Attachment, BodyId, CoordinateId, LoopJoint, LoopJointKind, Vector};
use crate::symbolic::Expr;

/// An equation of a joint.
#[derive(Clone, Copy)]
enum Equation {
    /// `d · r`
    Along(Vector),
    /// `d · s`
    Turn(Vector),
    /// `|r| − L`
    Rod,
}

/// The equations of a joint, in the order of [`LoopJointKind::equations`]. Those of a pin's axis are such that their λ are moments about
/// u and w: `a × (−w) = u`, `a × u = w`.
fn equations(kind: &LoopJointKind) -> Vec<Equation> {
    let points = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Equation::Along);
    match kind {
        LoopJointKind::Ball => points.to_vec(),
        LoopJointKind::Pin { across: Across { directions: [u, w], .. }, .. } => {
            [points.as_slice(), &[Equation::Turn(w.map(|x| -x)), Equation::Turn(*u)]].concat()
        }
        LoopJointKind::Rod { .. } => vec![Equation::Rod],
        LoopJointKind::Slide { across } => across.directions.map(Equation::Along).to_vec(),
    }
}

/// Numbers of a direction as expressions.
fn direction<'g>(model: &Model<'g>, vector: Vector) -> Vec3<'g> {
    Vec3(vector.map(|x| model.graph.constant(x)))
}

/// The frame of an end, and its point in the world.
fn placed<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, end: &Attachment) -> (Rotation<'g>, Vec3<'g>) {
    let at = model.vector(&end.position);
    match end.body {
        Some(BodyId(body)) => {
            let Pose { rotation, origin } = kinematics.poses[body];
            (rotation, origin + rotation.apply(at))
        }
        None => (Rotation::identity(model.graph), at),
    }
}

/// A vector with its rate, and its second rate for q̈ = 0, in the axes of the first body; and the entries of its derivative by coordinates.
struct Moving<'g> {
    motion: [Vec3<'g>; 3],
    slopes: Vec<(usize, Vec3<'g>)>,
}

/// A joint at a state.
struct Closed<'g> {
    gap: Moving<'g>,
    /// s, of a pin.
    axis: Option<Moving<'g>>,
    /// L of a rod, otherwise 0.
    length: Expr<'g>,
}

impl<'g> Closed<'g> {
    /// Coordinates that move both bodies or none do not matter and are at zero.
    fn new(model: &Model<'g>, joint: &LoopJoint) -> Self {
        let closed_by = model.chain.closed_by(joint);
        let mut model = model.clone();
        for j in (0..model.size()).filter(|j| !closed_by.contains(&CoordinateId(*j))) {
            (model.q[j], model.v[j]) = (model.zero(), model.zero());
        }
        let kinematics = Kinematics::new(&model);
        let bodies = Bodies { model: &model, kinematics: &kinematics, joint };
        let [(frame, one), (of_second, other)] = joint.ends.each_ref().map(|end| placed(&model, &kinematics, end));
        let gap = bodies.relative(frame, other - one, &|generator| generator.velocity(other));
        let (mut axis, mut length) = (None, model.zero());
        match &joint.kind {
            LoopJointKind::Pin { to_axis, .. } => {
                let along = of_second.apply(direction(&model, *to_axis));
                axis = Some(bodies.relative(frame, along, &|generator| generator.rotate(along)));
            }
            LoopJointKind::Rod { length: given } => length = model.number(given),
            LoopJointKind::Ball | LoopJointKind::Slide { .. } => {}
        }
        Closed { gap, axis, length }
    }

    /// φ, its rate, and its second rate for q̈ = 0.
    fn state(&self, model: &Model<'g>, equation: Equation) -> [Expr<'g>; 3] {
        match equation {
            Equation::Along(along) => self.gap.motion.map(|of| direction(model, along).dot(of)),
            Equation::Turn(along) => match &self.axis {
                Some(axis) => axis.motion.map(|of| direction(model, along).dot(of)),
                None => [model.zero(); 3],
            },
            Equation::Rod => {
                let [_, rate, second] = self.gap.motion;
                let (length, unit) = self.rod();
                let of_length = unit.dot(rate);
                let bend = (rate.dot(rate) - of_length.squared()) / length;
                [length - self.length, of_length, unit.dot(second) + bend]
            }
        }
    }

    /// |r| and the unit vector along r.
    fn rod(&self) -> (Expr<'g>, Vec3<'g>) {
        let [gap, ..] = self.gap.motion;
        let length = gap.dot(gap).sqrt();
        (length, (1.0 / length) * gap)
    }

    /// The row of J of an equation.
    fn row(&self, model: &Model<'g>, equation: Equation) -> Vec<Expr<'g>> {
        let mut row = model.zeros();
        let (slopes, along) = match equation {
            Equation::Along(along) => (Some(&self.gap.slopes), direction(model, along)),
            Equation::Turn(along) => (self.axis.as_ref().map(|axis| &axis.slopes), direction(model, along)),
            Equation::Rod => (Some(&self.gap.slopes), self.rod().1),
        };
        for (j, slope) in slopes.into_iter().flatten() {
            row[*j] = along.dot(*slope);
        }
        row
    }
}

/// The two bodies of a joint.
struct Bodies<'a, 'g> {
    model: &'a Model<'g>,
    kinematics: &'a Kinematics<'g>,
    joint: &'a LoopJoint,
}

/// What a generator does to the point or direction whose motion is asked for.
type Moves<'a, 'g> = &'a dyn Fn(&Generator<'g>) -> Vec3<'g>;

impl<'g> Bodies<'_, 'g> {
    /// The coordinates that move one of the bodies.
    fn reach(&self, end: usize) -> Vec<CoordinateId> {
        self.model.chain.reach(&self.joint.ends[end])
    }

    /// The generators of the coordinates that move one of the bodies, in order.
    fn moving(&self, end: usize) -> impl DoubleEndedIterator<Item = (usize, &Generator<'g>)> {
        let generators = &self.kinematics.generators;
        self.reach(end).into_iter().map(|CoordinateId(j)| (j, &generators[j]))
    }

    /// A vector of the second body as seen from the first.
    fn relative(&self, frame: Rotation<'g>, value: Vec3<'g>, moves: Moves<'_, 'g>) -> Moving<'g> {
        let Model { v, graph, .. } = self.model;
        let zero = Vec3::zero(graph);
        let mut by_coordinate = vec![zero; v.len()];
        for (j, generator) in self.moving(1) {
            by_coordinate[j] = moves(generator);
        }
        for (j, generator) in self.moving(0) {
            by_coordinate[j] = by_coordinate[j] - moves(generator);
        }
        let between = self.model.chain.closed_by(self.joint);
        let rate = between.iter().fold(zero, |sum, &CoordinateId(j)| sum + v[j] * by_coordinate[j]);
        let turning = self.moving(0).fold(zero, |sum, (j, generator)| sum + v[j] * generator.omega);
        let coriolis = turning.cross(rate);
        let second = self.second_rate(1, moves) - self.second_rate(0, moves) - (coriolis + coriolis);
        Moving {
            motion: [value, rate, second].map(|vector| frame.apply_transposed(vector)),
            slopes: between.into_iter().map(|CoordinateId(j)| (j, frame.apply_transposed(by_coordinate[j]))).collect(),
        }
    }

    /// Second rate for q̈ = 0 of a point or direction that is fixed to one of the bodies: `Σ q̇_m q̇_n ∂²T/∂q_m∂q_n`, where the derivative
    /// is `Ω_m Ω_n T` for m ≤ n, with an additional term for two coordinates of one rotation vector.
    fn second_rate(&self, end: usize, moves: Moves<'_, 'g>) -> Vec3<'g> {
        let v = &self.model.v;
        let (mut sum, mut beyond) = (Vec3::zero(self.model.graph), Vec3::zero(self.model.graph));
        for (j, generator) in self.moving(end).rev() {
            let own = v[j] * moves(generator);
            sum = sum + v[j] * generator.omega.cross(own + beyond + beyond);
            beyond = beyond + own;
        }
        let reach = self.reach(end);
        let moves_it = |curvature: &&Curvature<'g>| reach.contains(&CoordinateId(curvature.first));
        for curvature in self.kinematics.curvatures.iter().filter(moves_it) {
            for pair @ (m, n) in Curvature::PAIRS {
                let rates = v[curvature.first + m] * v[curvature.first + n];
                let share = if m == n { rates } else { 2.0 * rates };
                sum = sum + share * moves(&curvature.generator(pair));
            }
        }
        sum
    }
}

/// Every joint at the present state, with its equations.
fn all<'g>(model: &Model<'g>) -> impl Iterator<Item = (Closed<'g>, Vec<Equation>)> {
    model.chain.loop_joints.iter().map(|joint| (Closed::new(model, joint), equations(&joint.kind)))
}

/// φ, φ̇ and J̇ q̇ of every equation.
pub fn states<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let of_joint = |(closed, equations): (Closed<'g>, Vec<Equation>)| -> Vec<Expr<'g>> {
        equations.into_iter().flat_map(|equation| closed.state(model, equation)).collect()
    };
    all(model).flat_map(of_joint).collect()
}

/// J, row by row.
pub fn jacobians<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let of_joint = |(closed, equations): (Closed<'g>, Vec<Equation>)| -> Vec<Expr<'g>> {
        equations.into_iter().flat_map(|equation| closed.row(model, equation)).collect()
    };
    all(model).flat_map(of_joint).collect()
}

/// Force and moment about the world's origin on both bodies, in the world, for a unit λ of each equation of a joint.
pub fn actions<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    joint: &LoopJoint,
) -> Vec<Vec<(Place, [Vec3<'g>; 2])>> {
    let zero = Vec3::zero(model.graph);
    let [(frame, one), (of_second, other)] = joint.ends.each_ref().map(|end| placed(model, kinematics, end));
    let on_first = |equation| match equation {
        Equation::Along(along) => {
            let force = frame.apply(direction(model, along));
            [force, other.cross(force)]
        }
        Equation::Turn(along) => {
            let LoopJointKind::Pin { to_axis, .. } = &joint.kind else { return [zero; 2] };
            let axis = of_second.apply(direction(model, *to_axis));
            [zero, axis.cross(frame.apply(direction(model, along)))]
        }
        Equation::Rod => {
            let way = other - one;
            let force = (1.0 / way.dot(way).sqrt()) * way;
            [force, other.cross(force)]
        }
    };
    let on_both = |wrench: [Vec3<'g>; 2]| {
        let place = |end: &Attachment| end.body.map(|body| Place { body, along: end.position[0].clone() });
        let of_ends = joint.ends.iter().zip([wrench, wrench.map(|vector| -vector)]);
        of_ends.filter_map(|(end, wrench)| Some((place(end)?, wrench))).collect()
    };
    equations(&joint.kind).into_iter().map(on_first).map(on_both).collect()
}
