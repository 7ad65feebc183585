//! Derivatives of the generalized forces that a motion requires, in O(n²), by composite bodies.
//!
//! S. Singh, R. P. Russell, P. M. Wensing, IEEE Robotics and Automation Letters 7 (2022); here in the world frame, with the pseudo-inertias
//! of Urbaś instead of spatial matrices, and for joints whose generators depend on their own coordinates.
//!
//! Notation
//! : points at x of a body move with `ẋ = V x`; a coordinate moves everything beyond it by `δx = Ω_j x δq_j`. Of everything beyond coordinate j,
//!   W is the pseudo-inertia `∫ x xᵀ dm`, G is `∫ ẋ xᵀ dm`, and F the force and moment that its motion requires, gravity subtracted; moments are
//!   about the world's origin. `Ω · F` is the power of F at the velocity Ω x.
//!
//! Output
//! : from `δẍ = Ω̈_j x + 2 Ω̇_j ẋ + Ω_j ẍ`, with i not beyond j,
//!   `∂r_i/∂q_j = Ω_i · (Ω̈_j W + 2 Ω̇_j G + Ω_j × F)` and `∂r_j/∂q_i = Ω_j · (Ω̈_i W + 2 Ω̇_i G)`, all sums beyond j; the turn of F is missing in
//!   the latter, since Ω_j turns with F. From `δẍ = 2 Ω̇_j x + 2 Ω_j ẋ`, `∂r_i/∂q̇_j = 2 Ω_i · (Ω̇_j W + Ω_j G)`, and with i and j exchanged. Gravity
//!   does not turn with F: the acceleration `ω_j × γ` is added to `Ω̈_j`.

#[cfg(test)]
mod tests;

use super::inertia::{Inertias, WorldInertia};
use super::kinematics::{Curvature, Generator, Kinematics, Pose};
use super::model::Model;
use super::newton_euler::Wrench;
use super::rotation_vector::RotationVector;
use super::rotors;
use super::twist::Twist;
use super::vector::{Matrix3, Vec3};
use crate::chain::{BodyId, CoordinateId, Step};
use crate::symbolic::Expr;

/// `∂r/∂q` and `∂r/∂v`, row by row, of generalized forces `r = A a − e − f`; `slopes`: [`of_forces`].
pub fn of_residual<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    inertias: &Inertias<'g>,
    slopes: &[Expr<'g>],
) -> Vec<Expr<'g>> {
    let n = model.size();
    let mut rows: Vec<_> = slopes.iter().map(|slope| -*slope).collect();
    let (by_q, by_v) = rows.split_at_mut(n * n);
    let moving = MovingPoint::new(model, kinematics);
    let beyond = moving.beyond(model, inertias);
    let columns = moving.columns(kinematics, inertias, &beyond);
    let add = |matrix: &mut [Expr<'g>], i: usize, j: usize, x: Expr<'g>| {
        matrix[i * n + j] = matrix[i * n + j] + x;
    };
    for (j, column) in columns.iter().enumerate() {
        for CoordinateId(i) in model.chain.coordinates_of(BodyId(kinematics.generators[j].body)) {
            let axis = &moving.axes[i];
            if i < j {
                add(by_q, i, j, power(axis.generator, column.turning));
                add(by_q, j, i, column.lower(axis.second, axis.first.omega));
                add(by_v, j, i, column.lower(double(axis.first), axis.generator.omega));
            } else if i == j {
                add(by_q, j, j, power(axis.generator, column.turned));
            }
            if i <= j {
                add(by_v, i, j, power(axis.generator, column.with_rate));
            }
        }
    }
    for (i, j, effort) in within_rotation_vectors(kinematics, &moving, &beyond) {
        add(by_q, i, j, effort);
    }
    rows
}

/// `∂f/∂q` and `∂f/∂v`, row by row, of forces f.
pub fn of_forces<'g>(model: &Model<'g>, forces: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let n = model.size();
    let mut rows: Vec<Expr<'g>> = Vec::new();
    for inputs in [&model.q, &model.v] {
        let columns: Vec<_> = inputs.iter().map(|input| model.graph.derivatives(forces, *input)).collect();
        rows.extend((0..n * n).map(|index| columns[index % n][index / n]));
    }
    rows
}

/// What the derivatives of `A a − e` are products of, row by row: x, y and z of vectors of all coordinates, their masses, and entries to be added to
/// ∂r/∂q, on five diagonals from the second below the main one; in the order of `crane_model::rt::derivatives`.
pub fn factors_of_residual<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    inertias: &Inertias<'g>,
) -> Vec<Expr<'g>> {
    let n = model.size();
    let moving = MovingPoint::new(model, kinematics);
    let beyond = moving.beyond(model, inertias);
    let gravity = model.vector(&model.chain.gravity);
    let vectors = moving.axes.iter().zip(&kinematics.generators).map(|(axis, generator)| {
        let Axis { generator: Twist { omega, upsilon }, first, before: MotionOfBody { velocity, rate }, added, .. } =
            axis;
        let inertia = &inertias.composites[generator.body];
        let Beyond { turning, momentum, required: [force, moment] } = &beyond[generator.body];
        let [ix, iy, iz] = [0, 1, 2].map(|row| inertia.tensor.row(row));
        let [gx, gy, gz] = [0, 1, 2].map(|row| turning.row(row));
        [
            *omega,
            *upsilon,
            first.omega,
            first.upsilon,
            velocity.omega,
            velocity.upsilon,
            rate.omega,
            rate.upsilon - gravity,
            added.omega,
            added.upsilon,
            inertia.first,
            ix,
            iy,
            iz,
            gx,
            gy,
            gz,
            *momentum,
            *force,
            *moment,
        ]
    });
    let vectors: Vec<_> = vectors.collect();
    let kinds = vectors.first().map_or(0, |vectors| vectors.len());
    let mut rows: Vec<_> = (0..3 * kinds).flat_map(|row| vectors.iter().map(move |of| of[row / 3][row % 3])).collect();
    rows.extend(kinematics.generators.iter().map(|generator| inertias.composites[generator.body].mass));
    let mut diagonals = vec![model.zero(); 5 * n];
    for (i, j, effort) in within_rotation_vectors(kinematics, &moving, &beyond) {
        diagonals[(j + 2 - i) * n + i] = effort;
    }
    rows.extend(diagonals);
    rows
}

/// What a rotation vector, whose axes depend on its coordinates, adds to ∂r/∂q: row, column and effort.
fn within_rotation_vectors<'g>(
    kinematics: &Kinematics<'g>,
    moving: &MovingPoint<'g>,
    beyond: &[Beyond<'g>],
) -> Vec<(usize, usize, Expr<'g>)> {
    let mut added = Vec::new();
    for curvature in &kinematics.curvatures {
        let wrench = beyond[curvature.body].required;
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let change = curvature.generator((j, i));
            let mut effort = power(twist(&change), wrench);
            let (row, column) = (curvature.first + i, curvature.first + j);
            if i < j {
                effort = effort - power(moving.axes[row].generator, turned(moving.axes[column].generator, wrench));
            }
            added.push((row, column, effort));
        }
    }
    added
}

/// `A a − e` with rotors: `required`, which the bodies require, and `I a`.
pub fn with_rotors<'g>(model: &Model<'g>, required: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
    let mut sum = required;
    for (j, armature) in rotors::by_coordinate(model) {
        sum[j] = sum[j] + armature * model.a[j];
    }
    sum
}

/// The generator of a coordinate and its derivatives with respect to time.
struct Axis<'g> {
    /// Ω
    generator: Twist<'g>,
    /// Ω̇
    first: Twist<'g>,
    /// Ω̈, and what gravity adds to it.
    second: Twist<'g>,
    /// The motion of the frame before it.
    before: MotionOfBody<'g>,
    /// What a change within this frame adds to Ω̈.
    added: Twist<'g>,
}

/// Motion of a frame in the world: V and V̇.
#[derive(Clone, Copy)]
struct MotionOfBody<'g> {
    velocity: Twist<'g>,
    rate: Twist<'g>,
}

/// The motion of all bodies.
struct MovingPoint<'g> {
    axes: Vec<Axis<'g>>,
    bodies: Vec<MotionOfBody<'g>>,
}

/// Everything beyond a joint.
#[derive(Clone, Copy)]
struct Beyond<'g> {
    /// `tr(G) 1 − G` for the upper left of G: `∫ x × (s × ẋ) dm` of s.
    turning: Matrix3<'g>,
    /// `∫ ẋ dm`
    momentum: Vec3<'g>,
    /// F
    required: Wrench<'g>,
}

/// Products of a coordinate with everything beyond it.
struct Column<'g> {
    /// `Ω W`: linear and angular momentum.
    momenta: Wrench<'g>,
    /// z, for which `2 Ω · (Ω_i G) = z · ω_i`.
    gyration: Vec3<'g>,
    /// `Ω̈ W + 2 Ω̇ G`
    turned: Wrench<'g>,
    /// The same with `Ω × F`.
    turning: Wrench<'g>,
    /// `2 (Ω̇ W + Ω G)`
    with_rate: Wrench<'g>,
}

impl<'g> Column<'g> {
    /// `Ω · (Ω_1 W + 2 Ω_2 G)`, `ω_2` the rotation of `Ω_2`.
    fn lower(&self, first: Twist<'g>, second: Vec3<'g>) -> Expr<'g> {
        power(first, self.momenta) + self.gyration.dot(second)
    }
}

impl<'g> MovingPoint<'g> {
    /// From the base to the tips.
    fn new(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Self {
        let nothing = still(model);
        let (mut axes, mut bodies): (Vec<Axis<'g>>, Vec<MotionOfBody<'g>>) = (Vec::new(), Vec::new());
        let mut curvatures = kinematics.curvatures.iter();
        for body in &model.chain.bodies {
            let mut motion =
                body.parent.map_or(MotionOfBody { velocity: nothing, rate: nothing }, |BodyId(parent)| bodies[parent]);
            for step in &body.path {
                let own = match step {
                    Step::Translate(_) | Step::Rotate { .. } => continue,
                    Step::Move(_) => vec![[nothing; 2]],
                    Step::RotationVector(_) => {
                        curvatures.next().map_or_else(Vec::new, |curvature| within_joint(model, curvature))
                    }
                };
                let before = motion;
                for ([rate, second], CoordinateId(j)) in own.into_iter().zip(step.coordinates()) {
                    let axis = axis(before, &kinematics.generators[*j], [rate, second]);
                    motion.velocity = sum(motion.velocity, scaled(model.v[*j], axis.generator));
                    let of_rate = scaled(model.v[*j], axis.first);
                    motion.rate = sum(motion.rate, sum(scaled(model.a[*j], axis.generator), of_rate));
                    axes.push(axis);
                }
            }
            bodies.push(motion);
        }
        // What gravity adds, which is not part of the motion.
        let gravity = model.vector(&model.chain.gravity);
        for axis in &mut axes {
            axis.second.upsilon = axis.second.upsilon + axis.generator.omega.cross(gravity);
        }
        MovingPoint { axes, bodies }
    }

    /// From the tips to the base: sums over everything beyond each body.
    fn beyond(&self, model: &Model<'g>, inertias: &Inertias<'g>) -> Vec<Beyond<'g>> {
        let zero = Vec3::zero(model.graph);
        let nothing = Beyond { turning: Matrix3::zero(model.graph), momentum: zero, required: [zero; 2] };
        let mut sums = vec![nothing; model.chain.bodies.len()];
        for (index, body) in model.chain.bodies.iter().enumerate().rev() {
            if let Some(inertia) = &inertias.bodies[index] {
                sums[index] = sums[index].plus(of_body(model, &self.bodies[index], inertia));
            }
            if let Some(BodyId(parent)) = body.parent {
                sums[parent] = sums[parent].plus(sums[index]);
            }
        }
        sums
    }

    fn columns(&self, kinematics: &Kinematics<'g>, inertias: &Inertias<'g>, beyond: &[Beyond<'g>]) -> Vec<Column<'g>> {
        let of_axis = |(axis, generator): (&Axis<'g>, &Generator<'g>)| {
            let (inertia, beyond) = (&inertias.composites[generator.body], &beyond[generator.body]);
            let [s, u] = [axis.generator.omega, axis.generator.upsilon];
            let turned_inertia = plus(momenta(inertia, axis.second), beyond.turn(double_of(axis.first.omega)));
            Column {
                momenta: momenta(inertia, axis.generator),
                gyration: double_of(beyond.turning.apply_transposed(s) + beyond.momentum.cross(u)),
                turned: turned_inertia,
                turning: plus(turned_inertia, turned(axis.generator, beyond.required)),
                with_rate: plus(momenta(inertia, double(axis.first)), beyond.turn(double_of(s))),
            }
        };
        self.axes.iter().zip(&kinematics.generators).map(of_axis).collect()
    }
}

impl<'g> Beyond<'g> {
    fn plus(self, other: Self) -> Self {
        Beyond {
            turning: self.turning + other.turning,
            momentum: self.momentum + other.momentum,
            required: plus(self.required, other.required),
        }
    }

    /// `∫ s × ẋ dm`, and its moment.
    fn turn(&self, s: Vec3<'g>) -> Wrench<'g> {
        [s.cross(self.momentum), self.turning.apply(s)]
    }
}

/// The sums of a single body: `G = V W` and `F = ∫ (ẍ − γ) dm` with `ẍ = (V̇ + V V) x`.
fn of_body<'g>(model: &Model<'g>, motion: &MotionOfBody<'g>, inertia: &WorldInertia<'g>) -> Beyond<'g> {
    let MotionOfBody { velocity: Twist { omega, upsilon }, rate } = *motion;
    let WorldInertia { mass, first, tensor } = *inertia;
    // Σ = ½ tr(I) 1 − I; the upper left of G is [ω]× Σ + υ sᵀ.
    let half = 0.5 * (tensor.at(0, 0) + tensor.at(1, 1) + tensor.at(2, 2));
    let along = first.dot(upsilon);
    let second = |i: usize, j: usize| if i == j { half - tensor.at(i, j) } else { -tensor.at(i, j) };
    let columns = [0, 1, 2].map(|j| omega.cross(Vec3([0, 1, 2].map(|i| second(i, j)))) + first[j] * upsilon);
    let entry = |i: usize, j: usize| if i == j { along - columns[j][i] } else { -columns[j][i] };
    let turning = Matrix3([0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))));
    // The acceleration of the point at the world's origin.
    let a = rate.upsilon + omega.cross(upsilon) - model.vector(&model.chain.gravity);
    let force = mass * a + rate.omega.cross(first) + omega.cross(omega.cross(first));
    let moment = tensor.apply(rate.omega) + omega.cross(tensor.apply(omega)) + first.cross(a);
    Beyond { turning, momentum: inertia.linear_momentum(omega, upsilon), required: [force, moment] }
}

/// The derivatives of a generator that moves with the frame before it, and changes in this frame with the rates `own`:
/// `Ω̇ = [V, Ω] + Ω̇'`, `Ω̈ = [V̇, Ω] + [V, Ω̇ + Ω̇'] + Ω̈'`.
fn axis<'g>(before: MotionOfBody<'g>, generator: &Generator<'g>, own: [Twist<'g>; 2]) -> Axis<'g> {
    let [own_first, own_second] = own;
    let generator = twist(generator);
    let first = sum(commutator(before.velocity, generator), own_first);
    let added = sum(commutator(before.velocity, own_first), own_second);
    let second = sum(sum(commutator(before.rate, generator), commutator(before.velocity, first)), added);
    Axis { generator, first, second, before, added }
}

/// First and second derivatives of the generators of a rotation vector in the frame before it, coordinate by coordinate, in the world.
fn within_joint<'g>(model: &Model<'g>, curvature: &Curvature<'g>) -> Vec<[Twist<'g>; 2]> {
    let Curvature { first, pose: Pose { rotation, origin }, .. } = *curvature;
    let vector: &RotationVector<'g> = curvature.vector();
    let of = |numbers: &[Expr<'g>]| Vec3(vector.along_axes([numbers[first], numbers[first + 1], numbers[first + 2]]));
    let through = |axis: Vec3<'g>| {
        let omega = rotation.apply(axis);
        Twist { omega, upsilon: origin.cross(omega) }
    };
    let [rates, seconds] = vector.jacobian_rates(of(&model.v), of(&model.a));
    let by_axis = [0, 1, 2].map(|k| [through(rates[k]), through(seconds[k])]);
    vector.by_coordinates(by_axis).to_vec()
}

/// Ω of a generator.
fn twist<'g>(generator: &Generator<'g>) -> Twist<'g> {
    Twist { omega: generator.omega, upsilon: generator.upsilon }
}

/// `Ω · F`
fn power<'g>(twist: Twist<'g>, [force, moment]: Wrench<'g>) -> Expr<'g> {
    twist.omega.dot(moment) + twist.upsilon.dot(force)
}

/// `Ω W`
fn momenta<'g>(inertia: &WorldInertia<'g>, Twist { omega, upsilon }: Twist<'g>) -> Wrench<'g> {
    [inertia.linear_momentum(omega, upsilon), inertia.angular_momentum(omega, upsilon)]
}

/// `Ω × F`: how a force and its moment change if they turn and move with Ω.
fn turned<'g>(Twist { omega, upsilon }: Twist<'g>, [force, moment]: Wrench<'g>) -> Wrench<'g> {
    [omega.cross(force), omega.cross(moment) + upsilon.cross(force)]
}

/// `[V, Ω] = V Ω − Ω V`
fn commutator<'g>(v: Twist<'g>, of: Twist<'g>) -> Twist<'g> {
    Twist { omega: v.omega.cross(of.omega), upsilon: v.omega.cross(of.upsilon) + v.upsilon.cross(of.omega) }
}

fn still<'g>(model: &Model<'g>) -> Twist<'g> {
    let zero = Vec3::zero(model.graph);
    Twist { omega: zero, upsilon: zero }
}

fn sum<'g>(a: Twist<'g>, b: Twist<'g>) -> Twist<'g> {
    Twist { omega: a.omega + b.omega, upsilon: a.upsilon + b.upsilon }
}

fn scaled<'g>(factor: Expr<'g>, of: Twist<'g>) -> Twist<'g> {
    Twist { omega: factor * of.omega, upsilon: factor * of.upsilon }
}

fn double_of(vector: Vec3<'_>) -> Vec3<'_> {
    Vec3(vector.0.map(|component| 2.0 * component))
}

fn double(of: Twist<'_>) -> Twist<'_> {
    Twist { omega: double_of(of.omega), upsilon: double_of(of.upsilon) }
}

fn plus<'g>(a: Wrench<'g>, b: Wrench<'g>) -> Wrench<'g> {
    [a[0] + b[0], a[1] + b[1]]
}
