//! Inverse dynamics by Newton's and Euler's equations in local frames: two sweeps, O(n).
//!
//! J. Y. S. Luh, M. W. Walker, R. P. C. Paul, J. Dyn. Syst. Meas. Control 102 (1980) 69. At q̈ = 0 the efforts are the bias; at
//! any q̈ the forces and moments of the inward sweep are those that the crane transmits.

use super::beam_axis::AxisPoint;
use super::elements::Posed;
use super::factors::{Branches, Factor, Reached};
use super::kinematics::Kinematics;
use super::loads::{self, Action};
use super::model::Model;
use super::outward::{Velocities, along};
use super::pads;
use super::place::{Along, Place};
use super::vector::{Symmetric3, Vec3};
use crate::chain::{Axis, BodyId, Cut, Inertia, Point, Section, Side, Sliding};
use crate::symbolic::Expr;

/// What acts on a body closer to a section than this fraction of the body's length acts at the section.
const SAME_PLACE: f64 = 1e-8;

/// `e = −(h + g)` [Urbaś 2016, Eqs. (5), (7), (9), by recursion]; gravity is an upward acceleration of the base.
pub fn bias<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Vec<Expr<'g>> {
    let motions = outward(model, factors, (&model.v, None), -model.vector(&model.chain.gravity));
    inward(model, factors, &motions, &[], |_, _| None).bias
}

/// `A a − e` without rotors: the generalized forces that a motion requires.
pub fn inverse_dynamics<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Vec<Expr<'g>> {
    let motions = outward(model, factors, (&model.v, Some(&model.a)), -model.vector(&model.chain.gravity));
    inward(model, factors, &motions, &[], |_, _| None).bias.into_iter().map(|effort| -effort).collect()
}

/// Force and moment that the part beyond each cut exerts on the part before it: the inertia and the weight of everything
/// beyond, the loads applied to it and the forces of connectors on it.
pub fn internal_forces<'g>(posed: Posed<'_, 'g>, factors: &[Factor<'g>]) -> Vec<Expr<'g>> {
    let (model, kinematics, _) = posed;
    let motions = outward(model, factors, (&model.v, Some(&model.a)), -model.vector(&model.chain.gravity));
    let applied = loads::on_bodies(posed);
    at_cuts(model, kinematics, factors, (&motions, &applied))
}

/// `R (a + α × r + ω × (ω × r))`, with the motion of the body of each point of interest, R its rotation; world frame, m/s².
pub fn point_accelerations<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    factors: &[Factor<'g>],
) -> Vec<Expr<'g>> {
    let motions = outward(model, factors, (&model.v, Some(&model.a)), Vec3::zero(model.graph));
    let acceleration = |point: &Point| {
        let BodyId(body) = point.body;
        let Some(BodyMotion { velocities: Velocities::Body { omega }, alpha, a }) = motion_of(factors, &motions, body)
        else {
            return [model.zero(); 3];
        };
        let r = model.vector(&point.position);
        let local = *a + alpha.cross(r) + omega.cross(omega.cross(r));
        kinematics.poses[body].rotation.apply(local).0
    };
    model.chain.points.iter().flat_map(acceleration).collect()
}

/// The motion of a body's frame.
fn motion_of<'a, 'g>(factors: &[Factor<'g>], motions: &'a [BodyMotion<'g>], body: usize) -> Option<&'a BodyMotion<'g>> {
    let reached = |factor: &Factor<'g>| matches!(factor, Factor::Body(index) if *index == body);
    factors.iter().zip(motions).find(|(factor, _)| reached(factor)).map(|(_, motion)| motion)
}

/// What forces and moments on bodies add to the internal forces at every cut: the sum of those beyond. They are in the world frame,
/// the moments about its origin.
pub fn transmitted<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    factors: &[Factor<'g>],
    on_bodies: Vec<(Place<'g>, Wrench<'g>)>,
) -> Vec<Expr<'g>> {
    let motions = outward(model, factors, (&model.zeros(), None), Vec3::zero(model.graph));
    let mut applied = vec![Vec::new(); model.chain.bodies.len()];
    for (Place { body: BodyId(body), along }, [force, moment]) in on_bodies {
        let pose = &kinematics.poses[body];
        let wrench = [force, moment - pose.origin.cross(force)].map(|vector| pose.rotation.apply_transposed(vector));
        applied[body].push(Action { along, wrench });
    }
    at_cuts(model, kinematics, factors, (&motions, &applied))
}

/// The wrenches that all cuts transmit.
fn at_cuts<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    factors: &[Factor<'g>],
    (motions, applied): (&[BodyMotion<'g>], &[Vec<Action<'g>>]),
) -> Vec<Expr<'g>> {
    let swept = inward(model, factors, motions, applied, |force, moment| Some([-force, -moment]));
    let wrenches = model.chain.cuts().into_iter().filter_map(|cut| match cut {
        Cut::Ground => swept.ground,
        Cut::Joint(BodyId(body)) => swept.joints[body].or(swept.bodies[body]),
        Cut::Body(BodyId(body)) => swept.bodies[body],
        Cut::Inside(beam, section) => {
            let section = &model.chain.beams[beam].sections[section];
            if let Some(sliding) = &section.slides {
                return at_pad(model, kinematics, (section.side, sliding), &swept, &|body| {
                    Some((motion_of(factors, motions, body)?, applied[body].as_slice()))
                });
            }
            let BodyId(body) = section.body;
            let motion = motion_of(factors, motions, body)?;
            within(model, section, (swept.beyond[body], motion), [&swept.branches[body], &applied[body]])
        }
    });
    wrenches.flatten().flat_map(|vector| vector.0).collect()
}

/// The wrench that a section within a body transmits, about its centre: what is beyond the body, the branches that begin beyond the section,
/// the inertia and weight of the part of the body beyond the section, and what acts on that part.
fn within<'g>(
    model: &Model<'g>,
    section: &Section,
    (beyond, motion): (Option<Wrench<'g>>, &BodyMotion<'g>),
    [branches, applied]: [&[Action<'g>]; 2],
) -> Option<Wrench<'g>> {
    let ([mut force, mut moment], inside) = (beyond?, section.inside.as_ref()?);
    let Velocities::Body { omega } = &motion.velocities else { return None };
    let sum_beyond = |actions: &[Action<'g>]| {
        let beyond: Vec<Action<'g>> =
            actions.iter().filter_map(|action| acting_beyond(model, section, action)).collect();
        loads::sum(beyond.iter())
    };
    if let Some([more, more_moment]) = sum_beyond(branches) {
        (force, moment) = (force + more, moment + more_moment);
    }
    [force, moment] =
        with_inertia([force, moment], &Masses::new(model, &inside.beyond), *omega, (motion.alpha, motion.a));
    if let Some([load, moment_of_load]) = sum_beyond(applied) {
        (force, moment) = (force - load, moment - moment_of_load);
    }
    let lever = Vec3::along(Axis::X, model.number(&inside.distance));
    Some([-force, -(moment - lever.cross(force))])
}

/// What acts on a body beyond a section; `None` if nothing of it does. What is beside the body acts on its end. The place of a load is
/// that with default parameters, the place of a pad the present one.
fn acting_beyond<'g>(model: &Model<'g>, section: &Section, action: &Action<'g>) -> Option<Action<'g>> {
    let Some(inside) = &section.inside else { return Some(action.clone()) };
    let length = &model.chain.bodies[section.body.0].length;
    match &action.along {
        Along::Fixed(along) => {
            let defaults = model.chain.parameter_defaults();
            let [length, distance, along] = [length, &inside.distance, along].map(|value| value.at(&defaults));
            let along = along.clamp(0.0, length);
            let same = (along - distance).abs() <= SAME_PLACE * length;
            let acts = if same { section.side != Side::After } else { along > distance };
            acts.then(|| action.clone())
        }
        &Along::Pad(s) => {
            let (x, length) = (model.number(&section.x), model.number(length));
            Some(action.times(is_beyond(model, section.side, (s - x, length))))
        }
    }
}

/// 1 if what acts farther along a beam than a section by a distance, m, acts beyond the section, otherwise 0. What acts at the section itself, to
/// [`SAME_PLACE`] of a length, acts beyond it unless the section is just after.
fn is_beyond<'g>(model: &Model<'g>, side: Side, (distance, length): (Expr<'g>, Expr<'g>)) -> Expr<'g> {
    let same = SAME_PLACE * length;
    let past = if side == Side::After { distance - same } else { distance + same };
    past.select(model.graph.constant(1.0), model.zero())
}

/// The wrench that the section of a beam at a pad transmits, before or after the pad: in the frame of the element on which the pad is, about the
/// element's axis there. It is what that element requires where it begins, without what is between there and the pad.
fn at_pad<'a, 'g: 'a>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    (side, sliding): (Side, &Sliding),
    swept: &Inward<'g>,
    on_element: &impl Fn(usize) -> Option<(&'a BodyMotion<'g>, &'a [Action<'g>])>,
) -> Option<Wrench<'g>> {
    let (axis, zero) = (&sliding.beam, model.zero());
    let whole = model.number(&axis.length);
    let springs: Vec<_> = axis.division.springs().map(|place| model.number(&place)).collect();
    let here = AxisPoint::new(model, kinematics, axis, pads::place(model, sliding).1).here();
    let s = pads::place_on_beam(model, sliding);
    let none = Vec3::zero(model.graph);
    let (mut wrench, mut masses) = ([none; 2], Masses::zero(model));
    let (mut omega, mut alpha, mut a, mut start) = (none, none, none, zero);
    for ((element, BodyId(body)), here) in axis.elements().enumerate().zip(here) {
        let begins = element.checked_sub(1).map_or(zero, |spring| springs[spring]);
        let ends = springs.get(element).copied().unwrap_or(whole);
        let (motion, applied) = on_element(body)?;
        let Velocities::Body { omega: own_omega } = &motion.velocities else { return None };
        let [force, moment] = swept.bodies[body]?;
        let mut required = [-force, -moment];
        // What acts before the section is no longer required beyond it.
        let before = |action: &Action<'g>| {
            let place = match &action.along {
                Along::Fixed(along) => begins + model.number(along).clamp(zero, ends - begins),
                &Along::Pad(s) => s,
            };
            action.times(1.0 - is_beyond(model, side, (place - s, whole)))
        };
        for action in applied {
            let [load, of_load] = before(action).wrench;
            required = [required[0] + load, required[1] + of_load];
        }
        for branch in &swept.branches[body] {
            let [pull, of_pull] = before(branch).wrench;
            required = [required[0] - pull, required[1] - of_pull];
        }
        for (sum, part) in wrench.iter_mut().zip(required) {
            *sum = *sum + here * part;
        }
        omega = omega + here * *own_omega;
        alpha = alpha + here * motion.alpha;
        a = a + here * motion.a;
        start = start + here * begins;
        if let Some(inertia) = &model.chain.bodies[body].inertia {
            masses = masses.plus(here, &Masses::new(model, inertia).until(s - begins, ends - begins));
        }
    }
    let [of_masses, turning] = with_inertia([none; 2], &masses, omega, (alpha, a));
    let [force, moment] = [wrench[0] - of_masses, wrench[1] - turning];
    let lever = Vec3::along(Axis::X, s - start);
    Some([-force, -(moment - lever.cross(force))])
}

/// Mass and its moments about the origin of a body's frame, in its axes.
struct Masses<'g> {
    mass: Expr<'g>,
    first: Vec3<'g>,
    second: Symmetric3<'g>,
}

impl<'g> Masses<'g> {
    fn new(model: &Model<'g>, inertia: &Inertia) -> Self {
        Masses {
            mass: model.number(&inertia.mass),
            first: model.vector(&inertia.first),
            second: model.second_moments(inertia),
        }
    }

    fn zero(model: &Model<'g>) -> Self {
        let zero = model.zero();
        Masses { mass: zero, first: Vec3::zero(model.graph), second: Symmetric3([zero; 6]) }
    }

    fn plus(self, factor: Expr<'g>, other: &Self) -> Self {
        let second = std::array::from_fn(|i| self.second.0[i] + factor * other.second.0[i]);
        Masses {
            mass: self.mass + factor * other.mass,
            first: self.first + factor * other.first,
            second: Symmetric3(second),
        }
    }

    /// Of the part of an element of a length l from its beginning to x: as if the mass per length changed linearly between its ends. With `∫ x dm = S`
    /// it is `a + b x`, `a = (4 m − 6 S/l)/l`, `b = (12 S/l − 6 m)/l²`; exact for a uniform element.
    fn until(&self, x: Expr<'g>, l: Expr<'g>) -> Self {
        let (t, mean) = (x / l, self.first[0] / l);
        let (a, b) = (4.0 * self.mass - 6.0 * mean, 12.0 * mean - 6.0 * self.mass);
        let squared = t.squared();
        let of_first = squared * (0.5 * a + (1.0 / 3.0) * (b * t));
        let of_second = t * squared * ((1.0 / 3.0) * a + 0.25 * (b * t));
        let [_, yy, zz, xy, xz, yz] = self.second.0;
        Masses {
            mass: t * (a + 0.5 * (b * t)),
            first: Vec3([l * of_first, t * self.first[1], t * self.first[2]]),
            second: Symmetric3([l * l * of_second, t * yy, t * zz, squared * xy, squared * xz, t * yz]),
        }
    }
}

/// A wrench about a body's origin, plus what the motion of masses of the body requires.
fn with_inertia<'g>(
    [force, moment]: Wrench<'g>,
    masses: &Masses<'g>,
    omega: Vec3<'g>,
    (alpha, a): (Vec3<'g>, Vec3<'g>),
) -> Wrench<'g> {
    let &Masses { mass, first, second } = masses;
    let tensor = second.tensor();
    [
        force + mass * a + alpha.cross(first) + omega.cross(omega.cross(first)),
        moment + tensor.apply(alpha) + omega.cross(tensor.apply(omega)) + first.cross(a),
    ]
}

/// A wrench about a body's origin, plus what branches require.
fn with_branches<'g>(own: Wrench<'g>, branches: &[Action<'g>]) -> Wrench<'g> {
    branches.iter().fold(own, |[force, moment], branch| [force + branch.wrench[0], moment + branch.wrench[1]])
}

/// The motion of the frame after one factor.
struct BodyMotion<'g> {
    velocities: Velocities<'g>,
    /// Angular acceleration of the frame after the factor, in its components.
    alpha: Vec3<'g>,
    /// Acceleration of its origin, gravity subtracted.
    a: Vec3<'g>,
}

/// From the base to the tips: ω, α and a of each frame, the base accelerated by `start`. In one sweep the three chains of dependent operations are
/// interleaved.
fn outward<'g>(
    model: &Model<'g>,
    factors: &[Factor<'g>],
    (v, accelerations): (&[Expr<'g>], Option<&[Expr<'g>]>),
    start: Vec3<'g>,
) -> Vec<BodyMotion<'g>> {
    let zero = Vec3::zero(model.graph);
    let (mut omega, mut alpha, mut a) = (zero, zero, start);
    let mut reached = Reached::new();
    let own = |vector: Vec3<'g>, own: &dyn Fn(&[Expr<'g>]) -> Vec3<'g>| match accelerations {
        Some(accelerations) => vector + own(accelerations),
        None => vector,
    };
    let mut motions = Vec::new();
    let sweep = model.graph.sweep();
    for factor in factors {
        let velocities = along(model, &mut omega, factor, v);
        match (factor, &velocities) {
            (Factor::Rotation(rotation), _) => (alpha, a) = (rotation.to_inner(alpha), rotation.to_inner(a)),
            (Factor::Revolute { j, rotation }, Velocities::Revolute { gyration }) => {
                alpha = own(rotation.to_inner(alpha) + *gyration, &|q| Vec3::along(rotation.axis, q[*j]));
                a = rotation.to_inner(a);
            }
            (Factor::Ball { j, rotations }, Velocities::Ball { gyrations }) => {
                for (k, (rotation, gyration)) in rotations.iter().zip(gyrations).enumerate() {
                    alpha = own(rotation.to_inner(alpha) + *gyration, &|q| Vec3::along(rotation.axis, q[j + k]));
                    a = rotation.to_inner(a);
                }
            }
            (Factor::RotationVector { j, vector }, Velocities::RotationVector { rates, gyration }) => {
                let rotation = vector.rotation();
                let rates = rotation.apply_transposed(alpha) + *gyration + vector.spin_rate(*rates);
                alpha = own(rates, &|q| vector.project(Vec3(vector.along_axes([q[*j], q[j + 1], q[j + 2]]))));
                a = rotation.apply_transposed(a);
            }
            (_, Velocities::Translation { by, acceleration }) => {
                a = a + alpha.cross(*by) + *acceleration;
                if let Factor::Prismatic { j, axis } = factor {
                    a = own(a, &|q| Vec3::along(*axis, q[*j]));
                }
            }
            (Factor::Body(index), _) => sweep.leave(&model.chain.bodies[*index].name),
            _ => {}
        }
        let mut state = [omega, alpha, a];
        reached.follow(factor, &mut state);
        [omega, alpha, a] = state;
        motions.push(BodyMotion { velocities, alpha, a });
    }
    motions
}

/// Force and moment about the origin of the frame in whose components both are given.
pub type Wrench<'g> = [Vec3<'g>; 2];

/// The forces that a motion requires.
struct Inward<'g> {
    /// Generalized forces that the motion requires.
    bias: Vec<Expr<'g>>,
    /// The wrench recorded for each body in the frame after its last coordinate; `None` if it has no coordinate.
    joints: Vec<Option<Wrench<'g>>>,
    /// The wrench recorded for each body in its own frame.
    bodies: Vec<Option<Wrench<'g>>>,
    /// What everything attached to the end of a body requires, in the body's frame.
    beyond: Vec<Option<Wrench<'g>>>,
    /// What each branch that begins at a body requires, in the body's frame.
    branches: Vec<Vec<Action<'g>>>,
    /// The wrench recorded in the world frame.
    ground: Option<Wrench<'g>>,
}

/// From the tips to the base: the force and moment that each frame requires, minus the loads `applied` to the bodies. `note` converts them to
/// the wrench recorded at each cut.
fn inward<'g>(
    model: &Model<'g>,
    factors: &[Factor<'g>],
    motions: &[BodyMotion<'g>],
    applied: &[Vec<Action<'g>>],
    note: impl Fn(Vec3<'g>, Vec3<'g>) -> Option<Wrench<'g>>,
) -> Inward<'g> {
    let zero = Vec3::zero(model.graph);
    let (mut force, mut moment) = (zero, zero);
    let mut bias = model.zeros();
    let mut joints = vec![None; model.chain.bodies.len()];
    let (mut bodies, mut beyond) = (joints.clone(), joints.clone());
    let mut branches = Branches::new(model);
    let mut at_bodies = vec![Vec::new(); model.chain.bodies.len()];
    // The body whose path the sweep follows.
    let mut on = 0;
    let sweep = model.graph.sweep();
    for (factor, BodyMotion { velocities, alpha, a }) in factors.iter().zip(motions).rev() {
        if factor.moves() && joints[on].is_none() {
            joints[on] = note(force, moment);
        }
        match (factor, velocities) {
            (Factor::Body(index), Velocities::Body { omega }) => {
                let body = &model.chain.bodies[*index];
                sweep.visit(&body.name);
                let (at_end, elsewhere): (Vec<_>, Vec<_>) = branches.take(*index).into_iter().partition(
                    |branch: &Action<'g>| matches!(&branch.along, Along::Fixed(along) if *along == body.length),
                );
                [force, moment] = with_branches([force, moment], &at_end);
                beyond[*index] = Some([force, moment]);
                [force, moment] = with_branches([force, moment], &elsewhere);
                at_bodies[*index] = elsewhere;
                if let Some(inertia) = &body.inertia {
                    [force, moment] = with_inertia([force, moment], &Masses::new(model, inertia), *omega, (*alpha, *a));
                    force.named(&format!("force_{}", body.name));
                    moment.named(&format!("moment_{}", body.name));
                }
                if let Some([load, moment_of_load]) = applied.get(*index).and_then(|actions| loads::sum(actions.iter()))
                {
                    (force, moment) = (force - load, moment - moment_of_load);
                }
                on = *index;
                bodies[on] = note(force, moment);
            }
            (Factor::Branch(from), _) => {
                branches.bring(
                    *from,
                    Action { along: Along::Fixed(model.chain.bodies[on].along.clone()), wrench: [force, moment] },
                );
                (force, moment) = (zero, zero);
            }
            (Factor::Rotation(_) | Factor::Revolute { .. } | Factor::Ball { .. }, _) => {
                for (j, rotation) in factor.rotations().into_iter().rev() {
                    if let Some(j) = j {
                        bias[j] = -moment[rotation.axis.index()];
                    }
                    (force, moment) = (rotation.to_outer(force), rotation.to_outer(moment));
                }
            }
            (Factor::RotationVector { j, vector }, _) => {
                // Jᵀ R = J: the effect of the moment on the coordinates, from its components after the joint.
                let efforts = vector.jacobian().apply(moment);
                for (k, effort) in vector.by_coordinates(efforts.0).into_iter().enumerate() {
                    bias[j + k] = -effort;
                }
                let rotation = vector.rotation();
                (force, moment) = (rotation.apply(force), rotation.apply(moment));
            }
            (factor, Velocities::Translation { by, .. }) => {
                if let Factor::Prismatic { j, axis } = factor {
                    bias[*j] = -force[axis.index()];
                }
                moment = moment + by.cross(force);
            }
            _ => {}
        }
    }
    Inward { bias, joints, bodies, beyond, branches: at_bodies, ground: note(force, moment) }
}
