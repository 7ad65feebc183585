//! Joints that close loops: equations φ(q) = 0 between two bodies, their rows J = ∂φ/∂q, and what they transmit; and exact couplings.
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
//! On a pad slides the [axis of a beam](super::beam_axis): p₂ = P(σ) and, against twist, a = y(σ) depend on the place `σ = σ₀ ± q_k`, too.
//! Then `∂p₂/∂q_k` has the additional term ± P′, and ẍ₂ has `2 σ̇ Σ q̇_j ∂P′/∂q_j + σ̇² P″`.
//!
//! An exact coupling is `φ = q_j − r q_i − c`: its row has two constant entries, and `J̇ q̇ = 0`.
//!
//! λ are the forces and moments that the second body exerts on the first, along the directions of the equations: the generalized forces
//! are `f = −Jᵀ λ`.

use std::collections::BTreeSet;

use super::beam_axis::AxisPoint;
use super::kinematics::{Curvature, Generator, Kinematics, Pose};
use super::model::Model;
use super::pads::{self, AtPad};
use super::place::{Along, Place};
use super::vector::{Rotation, Vec3};
use crate::chain::{
    Across, Attachment, Axis, BodyId, CoordinateId, Follower, LoopJoint, LoopJointKind, PadDirection, RigidCoupling,
    Sliding, Vector,
};
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
        LoopJointKind::Pad { held } => held.iter().map(|sliding| at_pad(sliding.direction)).collect(),
    }
}

/// `n · r` or `z · y`
fn at_pad(direction: PadDirection) -> Equation {
    match direction {
        PadDirection::Along(axis) => Equation::Along(axis.unit_vector()),
        PadDirection::Twist => Equation::Turn(Axis::Z.unit_vector()),
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
struct MovingEnd<'g> {
    motion: [Vec3<'g>; 3],
    slopes: Vec<(usize, Vec3<'g>)>,
}

/// A joint at a state.
struct Closed<'g> {
    gap: MovingEnd<'g>,
    /// s, of a pin or a pad.
    axis: Option<MovingEnd<'g>>,
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
        let ends = joint.ends.iter().filter_map(|end| end.body);
        let ends = ends.chain(joint.kind.slides().map(|sliding| sliding.beam.last()));
        let counted: BTreeSet<BodyId> = ends.flat_map(|end| model.chain.path(end)).collect();
        let kinematics = Kinematics::with_bodies(&model, |body| counted.contains(&BodyId(body)));
        let bodies = Bodies { model: &model, kinematics: &kinematics, joint };
        let [(frame, one), (of_second, other)] = joint.ends.each_ref().map(|end| placed(&model, &kinematics, end));
        if let Some(sliding) = joint.kind.slides() {
            return bodies.on_pad((frame, one), sliding);
        }
        let carried = |generator: &Generator<'g>| generator.velocity(other);
        let gap = bodies.relative(frame, other - one, [&carried, &carried], None);
        let (mut axis, mut length) = (None, model.zero());
        match &joint.kind {
            LoopJointKind::Pin { to_axis, .. } => {
                let along = of_second.apply(direction(&model, *to_axis));
                let turned = |generator: &Generator<'g>| generator.rotate(along);
                axis = Some(bodies.relative(frame, along, [&turned, &turned], None));
            }
            LoopJointKind::Rod { length: given } => length = model.number(given),
            LoopJointKind::Ball | LoopJointKind::Slide { .. } | LoopJointKind::Pad { .. } => {}
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

/// How a point or direction of a beam that slides depends on its place σ.
struct ByPlace<'a, 'g> {
    /// k
    coordinate: usize,
    /// `∂σ/∂q_k`
    sign: Expr<'g>,
    /// First and second derivative by σ.
    slopes: [Vec3<'g>; 2],
    /// What a generator does to the first derivative.
    moves: Moves<'a, 'g>,
}

impl<'g> Bodies<'_, 'g> {
    /// The coordinates that move one of the bodies, or a part of the beam that slides.
    fn reach(&self, end: usize) -> Vec<CoordinateId> {
        match self.joint.kind.slides() {
            Some(sliding) if end == 1 => self.model.chain.coordinates_of(sliding.beam.last()),
            _ => self.model.chain.reach(&self.joint.ends[end]),
        }
    }

    /// A beam at a pad of the frame and the point.
    fn on_pad(&self, (frame, pad): (Rotation<'g>, Vec3<'g>), sliding: &Sliding) -> Closed<'g> {
        let Self { model, kinematics, .. } = self;
        let (sign, s) = pads::place(model, sliding);
        let beam = AxisPoint::new(model, kinematics, &sliding.beam, s);
        let (CoordinateId(coordinate), sign) = (sliding.coordinate, model.graph.constant(sign));
        let (position, y) = (beam.position(), beam.cross_axis(Axis::Y));
        let ways = beam.ways_beyond();
        let [along, along_slopes, across, across_slopes] =
            [(Axis::X, false), (Axis::X, true), (Axis::Y, false), (Axis::Y, true)]
                .map(|(axis, by_place)| beam.axis_beyond(axis, by_place));
        // Of a beam, a generator moves what is beyond its element; those before the beam move all of it.
        let element = |generator: &Generator<'g>| generator.body.saturating_sub(sliding.beam.first.0);
        let moved = |generator: &Generator<'g>| match element(generator) {
            0 => generator.velocity(position),
            element => generator.rotate(ways[element]),
        };
        let of_direction = |generator: &Generator<'g>| generator.rotate(along[element(generator)]);
        let gap = self.relative(
            frame,
            position - pad,
            [&|generator| generator.velocity(position), &moved],
            Some(&ByPlace { coordinate, sign, slopes: [along[0], along_slopes[0]], moves: &of_direction }),
        );
        let turned = |generator: &Generator<'g>| generator.rotate(across[element(generator)]);
        let of_slope = |generator: &Generator<'g>| generator.rotate(across_slopes[element(generator)]);
        let flat = Vec3::zero(model.graph);
        let axis = self.relative(
            frame,
            y,
            [&|generator| generator.rotate(y), &turned],
            Some(&ByPlace { coordinate, sign, slopes: [across_slopes[0], flat], moves: &of_slope }),
        );
        Closed { gap, axis: Some(axis), length: model.zero() }
    }

    /// The generators of the coordinates that move one of the bodies, in order.
    fn moving(&self, end: usize) -> impl DoubleEndedIterator<Item = (usize, &Generator<'g>)> {
        let generators = &self.kinematics.generators;
        self.reach(end).into_iter().map(|CoordinateId(j)| (j, &generators[j]))
    }

    /// A vector of the second body as seen from the first; generators move it as part of either of them.
    fn relative(
        &self,
        frame: Rotation<'g>,
        value: Vec3<'g>,
        [of_first, of_second]: [Moves<'_, 'g>; 2],
        by_place: Option<&ByPlace<'_, 'g>>,
    ) -> MovingEnd<'g> {
        let Model { v, graph, .. } = self.model;
        let zero = Vec3::zero(graph);
        let mut by_coordinate = vec![zero; v.len()];
        for (j, generator) in self.moving(1) {
            by_coordinate[j] = of_second(generator);
        }
        for (j, generator) in self.moving(0) {
            by_coordinate[j] = by_coordinate[j] - of_first(generator);
        }
        if let Some(ByPlace { coordinate, sign, slopes: [slope, _], .. }) = by_place {
            by_coordinate[*coordinate] = by_coordinate[*coordinate] + *sign * *slope;
        }
        let between = self.model.chain.closed_by(self.joint);
        let rate = between.iter().fold(zero, |sum, &CoordinateId(j)| sum + v[j] * by_coordinate[j]);
        let turning = self.moving(0).fold(zero, |sum, (j, generator)| sum + v[j] * generator.omega);
        let coriolis = turning.cross(rate);
        let mut second = self.second_rate(1, of_second) - self.second_rate(0, of_first) - (coriolis + coriolis);
        if let Some(ByPlace { coordinate, sign, slopes: [_, bend], moves }) = by_place {
            let along = *sign * v[*coordinate];
            let turning = self.moving(1).fold(zero, |sum, (j, generator)| sum + v[j] * moves(generator));
            second = second + along * (turning + turning + along * *bend);
        }
        MovingEnd {
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

/// All equations at the present state, those of couplings last.
pub struct LoopEquations<'g> {
    /// φ, φ̇ and J̇ q̇ of every equation.
    pub states: Vec<Expr<'g>>,
    /// J, row by row.
    pub rows: Vec<Expr<'g>>,
}

impl<'g> LoopEquations<'g> {
    pub fn new(model: &Model<'g>) -> Self {
        let couplings = &model.chain.rigid_couplings;
        let (mut states, mut joints) = (Vec::new(), Vec::new());
        for joint in &model.chain.loop_joints {
            let (closed, equations) = (Closed::new(model, joint), equations(&joint.kind));
            states.extend(equations.iter().flat_map(|equation| closed.state(model, *equation)));
            joints.push((closed, equations));
        }
        let of_coupling = |RigidCoupling { follower, .. }: &RigidCoupling| {
            let Follower { coordinate: CoordinateId(j), leader: CoordinateId(i), ratio, offset } = follower;
            let slip = |of: &[Expr<'g>]| of[*j] - model.number(ratio) * of[*i];
            [slip(&model.q) - model.number(offset), slip(&model.v), model.zero()]
        };
        states.extend(couplings.iter().flat_map(of_coupling));
        let of_joint = |(closed, equations): &(Closed<'g>, Vec<Equation>)| -> Vec<Expr<'g>> {
            equations.iter().flat_map(|equation| closed.row(model, *equation)).collect()
        };
        let of_coupling = |RigidCoupling { follower, .. }: &RigidCoupling| {
            let mut row = model.zeros();
            row[follower.coordinate.0] = model.graph.constant(1.0);
            row[follower.leader.0] = -model.number(&follower.ratio);
            row
        };
        let rows = joints.iter().flat_map(of_joint).chain(couplings.iter().flat_map(of_coupling)).collect();
        Self { states, rows }
    }
}

/// Force and moment about the world's origin on both bodies, in the world, for a unit λ of each equation of a joint.
pub fn actions<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    joint: &LoopJoint,
) -> Vec<Vec<(Place<'g>, [Vec3<'g>; 2])>> {
    let zero = Vec3::zero(model.graph);
    if let LoopJointKind::Pad { held } = &joint.kind {
        let on_bodies = |sliding: &Sliding| {
            let pulls = AtPad::new(model, kinematics, sliding).pulls.into_iter();
            pulls.map(|(place, pull)| (place, pull.about_origin())).collect()
        };
        return held.iter().map(on_bodies).collect();
    }
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
        let place =
            |end: &Attachment| end.body.map(|body| Place { body, along: Along::Fixed(end.position[0].clone()) });
        let of_ends = joint.ends.iter().zip([wrench, wrench.map(|vector| -vector)]);
        of_ends.filter_map(|(end, wrench)| Some((place(end)?, wrench))).collect()
    };
    equations(&joint.kind).into_iter().map(on_first).map(on_both).collect()
}
