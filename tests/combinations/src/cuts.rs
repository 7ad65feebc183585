//! Every body is in balance: what the two sides of its cuts transmit, its weight, its inertia and what acts on it from outside.
//!
//! The balance is summed body by body in the world frame, from a chain's frames and masses; the accelerations are second differences of
//! transforms. The recursion that it checks works in the frames of the bodies, outward and back.

use crane_codegen::chain::{
    Attachment, Axis, BodyId, Cylinder, Inertia, Load, LoadAxes, LoopJointKind, PadDirection, Pin, Section, Sliding,
    Strain, StrainLine, Value,
};
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::nalgebra::{DVector, Matrix3, Matrix4, Vector3, Vector6};
use crane_model::sections::{Place, places};
use crane_model::{Cut, Side, Wrench};

/// A force and its moment about the world's origin, N and N m.
type Screw = Vector6<f64>;

/// Step of the second differences, s: with those over half of it, their error is its fourth power times sixth derivatives, and rounding over
/// its square. With large accelerations, it is so short that poses change by no more than [`CHANGE`].
const STEP: f64 = 1e-4;
/// m and rad.
const CHANGE: f64 = 3e-4;

/// A state of motion: time, pose, rates, accelerations.
pub struct Motion<'a> {
    /// Time, s.
    pub t: f64,
    /// Pose, m and rad.
    pub q: &'a [f64],
    /// Rates.
    pub v: &'a [f64],
    /// Accelerations.
    pub a: &'a [f64],
}

/// What is missing for the balance of each body: its name, and what remains of the sum relative to the largest part of any body.
#[must_use]
pub fn imbalances(crane: &LiveCrane, motion: &Motion) -> Vec<(String, f64)> {
    let chain = crane.chain();
    let transforms = crane_transforms(crane, motion.q);
    let mut sums = vec![Screw::zeros(); chain.bodies.len()];
    let mut size: f64 = 0.0;
    for (body, screw) in known_forces(crane, motion, &transforms) {
        sums[body] += screw;
        size = size.max(screw.norm());
    }
    let rest = remainder(&sums, &unknown_forces(crane, motion.q, &transforms));
    let missing = |body: usize| rest.fixed_rows::<6>(6 * body).norm() / size.max(1.0);
    chain.bodies.iter().enumerate().map(|(body, own)| (own.name.clone(), missing(body))).collect()
}

/// By how much what a beam carries before each pad on which it slides differs from what it carries after it, without what pads exert there,
/// relative to what it carries: the name of the place, and what remains.
///
/// # Panics
/// If a pad has a section on one side alone.
#[must_use]
pub fn jumps(crane: &LiveCrane, motion: &Motion) -> Vec<(String, f64)> {
    let whole: &dyn DynCrane = crane;
    let description = whole.description();
    let transforms = crane_transforms(crane, motion.q);
    let tensions = whole.connector_tensions_at(motion.t, motion.q, motion.v);
    let wrenches = whole.internal_forces_at(motion.t, motion.q, motion.v, motion.a);
    let all = places(description, &whole.section_places_at(motion.q), &wrenches);
    let sections: Vec<&Section> = crane.chain().beams.iter().flat_map(|beam| &beam.sections).collect();
    let mut found = Vec::new();
    for before in all.iter().filter(|place| place.info(description).side == Side::Before) {
        let info = before.info(description);
        let Some(sliding) = &sections[before.section].slides else { continue };
        let same = |other: &&Place| other.section == before.section + 1 && other.info(description).at == info.at;
        let after = all.iter().find(same).expect("both sides");
        // The element on which the pad is, and the centre of its section there.
        let (first, x) = (sliding.beam.first.0, before.x);
        let long = |body: usize| crane.chain().bodies[body].length.at(crane.parameters());
        let (mut body, mut begins) = (first, 0.0);
        while body < sliding.beam.last().0 && begins + long(body) < x {
            begins += long(body);
            body += 1;
        }
        let at_centre = |wrench: &Wrench| {
            let mut shifted = transforms[body];
            let centre = transforms[body].transform_point(&Vector3::new(x - begins, 0.0, 0.0).into());
            shifted.fixed_view_mut::<3, 1>(0, 3).copy_from(&centre.coords);
            screw(&shifted, wrench)
        };
        let jump = at_centre(&before.wrench) - at_centre(&after.wrench);
        let size = at_centre(&before.wrench).norm().max(at_centre(&after.wrench).norm()).max(1.0);
        let own =
            |other: &Sliding| other.pad == sliding.pad && other.start == sliding.start && other.beam == sliding.beam;
        let on_beam = |other: &Sliding, tension: f64| {
            let forces = pad_forces(crane, other, tension, (motion.q, &transforms));
            forces.into_iter().filter(|(on, _)| *on == body).map(|(_, force)| (0, force)).collect::<Vec<_>>()
        };
        let mut rest = jump;
        for (connector, tension) in crane.chain().connectors().iter().zip(&tensions) {
            if let Some(other) = connector.strain.sliding().filter(|other| own(other)) {
                rest -= on_beam(other, tension.force).into_iter().fold(Screw::zeros(), |sum, (_, force)| sum + force);
            }
        }
        let held = crane.chain().loop_joints.iter().flat_map(|joint| match &joint.kind {
            LoopJointKind::Pad { held } => held.as_slice(),
            _ => &[],
        });
        let unknown: Vec<_> = held.filter(|other| own(other)).map(|other| on_beam(other, 1.0)).collect();
        found.push((before.location(description), remainder(&[rest], &unknown).norm() / size));
    }
    found
}

/// What cuts transmit to the bodies on their two sides, the negative of inertia and weight, and the forces of connectors and of loads with a
/// constant factor.
fn known_forces(crane: &LiveCrane, motion: &Motion, transforms: &[Matrix4<f64>]) -> Vec<(usize, Screw)> {
    let mut forces = Vec::new();
    for (body, wrench) in cuts(crane, motion) {
        // A wrench is what the part beyond the cut exerts.
        let transmitted = -screw(&transforms[body], &wrench);
        forces.push((body, transmitted));
        forces.extend(crane.chain().bodies[body].parent.map(|parent| (parent.0, -transmitted)));
    }
    forces.extend(inertias(crane, motion).into_iter().map(|inertial| -inertial).enumerate());
    forces.extend(connectors(crane, motion, transforms));
    forces.extend(loads(crane, transforms, false).into_iter().flatten());
    forces
}

/// Forces of 1, whose factors are whatever balances all bodies best: the efforts of cylinders, the forces of loops, and the factors of loads
/// over time.
fn unknown_forces(crane: &LiveCrane, q: &[f64], transforms: &[Matrix4<f64>]) -> Vec<Vec<(usize, Screw)>> {
    let mut unknown = loads(crane, transforms, true);
    unknown.extend(loop_forces(crane, q, transforms));
    let cylinders = crane.chain().cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
    unknown.extend(cylinders.map(|cylinder| cylinder_forces(crane, cylinder, q, transforms)));
    unknown
}

/// What remains of sums, body by body, beside the best multiples of unknown forces: the part normal to all of them. Twice, by Gram and Schmidt:
/// what rounding leaves of one pass goes with the second.
fn remainder(sums: &[Screw], unknown: &[Vec<(usize, Screw)>]) -> DVector<f64> {
    let mut rest = DVector::from_iterator(6 * sums.len(), sums.iter().flat_map(|sum| sum.iter().copied()));
    let mut directions: Vec<DVector<f64>> = Vec::new();
    let normal = |vector: &mut DVector<f64>, directions: &[DVector<f64>]| {
        for direction in directions.iter().chain(directions) {
            *vector -= direction * direction.dot(vector);
        }
    };
    for forces in unknown {
        let mut direction = DVector::zeros(rest.len());
        for (body, force) in forces {
            let mut rows = direction.fixed_rows_mut::<6>(6 * body);
            rows += force;
        }
        let whole = direction.norm();
        normal(&mut direction, &directions);
        // The others already contain it.
        if direction.norm() > 1e-9 * whole {
            directions.push(direction.normalize());
        }
    }
    normal(&mut rest, &directions);
    rest
}

fn crane_transforms(crane: &LiveCrane, q: &[f64]) -> Vec<Matrix4<f64>> {
    let crane: &dyn DynCrane = crane;
    crane.transforms_at(q)
}

/// A wrench in a body's frame, about its origin, as a screw of the world.
fn screw(transform: &Matrix4<f64>, wrench: &Wrench) -> Screw {
    let turn = transform.fixed_view::<3, 3>(0, 0);
    let mut whole = force_at(origin(transform), turn * wrench.force);
    let mut moment = whole.fixed_rows_mut::<3>(3);
    moment += turn * wrench.moment;
    whole
}

fn origin(transform: &Matrix4<f64>) -> Vector3<f64> {
    transform.fixed_view::<3, 1>(0, 3).into_owned()
}

/// A force at a point of the world.
fn force_at(point: Vector3<f64>, force: Vector3<f64>) -> Screw {
    let moment = point.cross(&force);
    Screw::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// What is transmitted to each body through the cut before it.
fn cuts(crane: &LiveCrane, Motion { t, q, v, a }: &Motion) -> Vec<(usize, Wrench)> {
    let whole: &dyn DynCrane = crane;
    let cuts = whole.description().cuts();
    let of_bodies = cuts.iter().zip(whole.internal_forces_at(*t, q, v, a));
    of_bodies
        .filter_map(|(cut, wrench)| if let Cut::Body { body, .. } = cut { Some((*body, wrench)) } else { None })
        .collect()
}

/// `∫ (r̈ − g) dm` and `∫ r × (r̈ − g) dm` of each body, from `∫ r̈ rᵀ dm = T̈ H Tᵀ`.
fn inertias(crane: &LiveCrane, motion: &Motion) -> Vec<Screw> {
    let chain = crane.chain();
    let parameters = crane.parameters();
    let fastest = motion.a.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
    let step = STEP.min((CHANGE / fastest).sqrt());
    let after = |time: f64| {
        let terms = motion.q.iter().zip(motion.v).zip(motion.a);
        let q: Vec<f64> = terms.map(|((q, v), a)| q + time * (v + 0.5 * time * a)).collect();
        crane_transforms(crane, &q)
    };
    let [before, earlier, now, later, after] = [-step, -0.5 * step, 0.0, 0.5 * step, step].map(after);
    let gravity = Vector3::from(chain.gravity.each_ref().map(|g| g.at(parameters)));
    let of_body = |body: usize| {
        let Some(inertia) = &chain.bodies[body].inertia else { return Screw::zeros() };
        let matrix = pseudo_inertia(inertia, parameters);
        let wide = (after[body] - 2.0 * now[body] + before[body]) / (step * step);
        let narrow = (later[body] - 2.0 * now[body] + earlier[body]) / (0.25 * step * step);
        let mut second = (4.0 * narrow - wide) / 3.0;
        if motion.v.iter().chain(motion.a).all(|rate| *rate == 0.0) {
            second.fill(0.0);
        }
        // A body that is held against gravity accelerates upward in free fall's view.
        let mut falling = second;
        let mut column = falling.fixed_view_mut::<3, 1>(0, 3);
        column -= gravity;
        let rate = falling * matrix * now[body].transpose();
        let moment = [rate[(2, 1)] - rate[(1, 2)], rate[(0, 2)] - rate[(2, 0)], rate[(1, 0)] - rate[(0, 1)]];
        Screw::new(rate[(0, 3)], rate[(1, 3)], rate[(2, 3)], moment[0], moment[1], moment[2])
    };
    (0..chain.bodies.len()).map(of_body).collect()
}

/// `H = ∫ r rᵀ dm`, `r = [x y z 1]ᵀ`.
fn pseudo_inertia(inertia: &Inertia, parameters: &[f64]) -> Matrix4<f64> {
    let [xx, yy, zz, xy, xz, yz] = inertia.second.each_ref().map(|second| second.at(parameters));
    let [x, y, z] = inertia.first.each_ref().map(|first| first.at(parameters));
    Matrix4::new(xx, xy, xz, x, xy, yy, yz, y, xz, yz, zz, z, x, y, z, inertia.mass.at(parameters))
}

/// The forces of springs, ropes and pads on the bodies at their ends and at sheaves.
fn connectors(crane: &LiveCrane, motion: &Motion, transforms: &[Matrix4<f64>]) -> Vec<(usize, Screw)> {
    let whole: &dyn DynCrane = crane;
    let tensions = whole.connector_tensions_at(motion.t, motion.q, motion.v);
    let mut forces = Vec::new();
    for (connector, tension) in crane.chain().connectors().iter().zip(tensions) {
        if let Strain::Sliding(sliding) = &connector.strain {
            forces.extend(pad_forces(crane, sliding, tension.force, (motion.q, transforms)));
        }
        if let Strain::Depth { point, .. } = &connector.strain {
            let up = force_at(point_of(crane, point, transforms), tension.force * Vector3::z());
            forces.extend(point.body.map(|body| (body.0, up)));
        }
        let Some(StrainLine { points, falls }) = connector.strain.line() else { continue };
        for (index, ends) in points.windows(2).enumerate() {
            let [one, other] = [&ends[0], &ends[1]].map(|end| point_of(crane, end, transforms));
            let parts = if index + 2 == points.len() { f64::from(*falls) } else { 1.0 };
            let pull = parts * tension.force * (other - one).normalize();
            for (end, at, force) in [(&ends[0], one, pull), (&ends[1], other, -pull)] {
                forces.extend(end.body.map(|body| (body.0, force_at(at, force))));
            }
        }
    }
    forces
}

/// What a pad and the beam that slides on it exert on bodies: on the beam, on the element on which the pad is. Where the axis passes the pad follows
/// by de Casteljau's algorithm: in each section it is the quadratic curve from its beginning, on one element, over the spring to its end, on the next
/// one; it begins and ends where the beam does.
fn pad_forces(
    crane: &LiveCrane,
    Sliding { pad, beam, start, grows, coordinate, direction, .. }: &Sliding,
    tension: f64,
    (q, transforms): (&[f64], &[Matrix4<f64>]),
) -> Vec<(usize, Screw)> {
    let (chain, parameters) = (crane.chain(), crane.parameters());
    let Some(BodyId(carrier)) = pad.body else { return Vec::new() };
    let long = |body: usize| chain.bodies[body].length.at(parameters);
    let (first, n, length) = (beam.first.0, beam.sections(), beam.length.at(parameters));
    // Springs are at the ends of the elements, and in the middles of the sections.
    let (mut springs, mut borders) = (Vec::new(), vec![0.0]);
    for element in first..first + n {
        springs.push(springs.last().unwrap_or(&0.0) + long(element));
        borders.push(2.0 * springs[springs.len() - 1] - borders[borders.len() - 1]);
    }
    let slid = q[coordinate.0];
    let s = start.at(parameters) + if *grows { slid } else { -slid };
    let k = (1..n).take_while(|&k| borders[k] <= s).count();
    let part = if n == 0 { 0.0 } else { (s - borders[k]) / (borders[k + 1] - borders[k]) };
    let on = first + springs.iter().take_while(|spring| **spring < s).count();
    let axis = |body: usize, index: usize| -> Vector3<f64> { transforms[body].fixed_view::<3, 1>(0, index).into() };
    let [y, z] = [1, 2].map(|index| axis(carrier, index));
    if *direction == PadDirection::Twist {
        let shares = [(first + k, 1.0 - part.clamp(0.0, 1.0)), (first + k + 1, part.clamp(0.0, 1.0))];
        let shares = shares.into_iter().filter(|(_, share)| *share != 0.0);
        let turned = |moment: Vector3<f64>| Screw::new(0.0, 0.0, 0.0, moment.x, moment.y, moment.z);
        return shares
            .flat_map(|(body, share)| {
                let moment = tension * share * axis(body, 1).cross(&z);
                [(carrier, turned(moment)), (on, turned(-moment))]
            })
            .collect();
    }
    let points = if n == 0 || part < 0.0 {
        vec![(first, s, 1.0)]
    } else if part > 1.0 {
        vec![(first + n, long(first + n) + s - length, 1.0)]
    } else {
        let (from, to) = (first + k, first + k + 1);
        let half = 0.5 * (borders[k + 1] - borders[k]);
        let (begin, end) = (long(from) - half, half);
        let rest = 1.0 - part;
        vec![(from, begin, rest * rest), (from, long(from), 2.0 * part * rest), (to, end, part * part)]
    };
    let normal = if *direction == PadDirection::Along(Axis::Y) { y } else { z };
    let at = |body: usize, x: f64| transforms[body].transform_point(&Vector3::new(x, 0.0, 0.0).into()).coords;
    points
        .into_iter()
        .flat_map(|(body, x, share)| {
            let force = force_at(at(body, x), tension * share * normal);
            [(carrier, force), (on, -force)]
        })
        .collect()
}

/// Forces of 1 N that joints which close loops transmit, force by force: along a rod, in any direction through a point, those of a pad; and
/// moments of a pin in any direction, which include its friction.
fn loop_forces(crane: &LiveCrane, q: &[f64], transforms: &[Matrix4<f64>]) -> Vec<Vec<(usize, Screw)>> {
    let mut forces = Vec::new();
    for joint in &crane.chain().loop_joints {
        if let LoopJointKind::Pad { held } = &joint.kind {
            forces.extend(held.iter().map(|sliding| pad_forces(crane, sliding, 1.0, (q, transforms))));
            continue;
        }
        let [one, other] = joint.ends.each_ref().map(|end| point_of(crane, end, transforms));
        let directions = match joint.kind {
            LoopJointKind::Rod { .. } => vec![(other - one).normalize()],
            _ => vec![Vector3::x(), Vector3::y(), Vector3::z()],
        };
        // A gap is measured in the frame of the first end: also where the loop is open, both forces act at the second point.
        let first = if matches!(joint.kind, LoopJointKind::Rod { .. }) { one } else { other };
        if matches!(joint.kind, LoopJointKind::Pin { .. }) {
            let bodies = joint.ends.each_ref().map(|end| end.body);
            forces.extend([Vector3::x(), Vector3::y(), Vector3::z()].map(|axis: Vector3<f64>| {
                let on = [(bodies[0], axis), (bodies[1], -axis)].into_iter();
                on.filter_map(|(body, m)| Some((body?.0, Screw::new(0.0, 0.0, 0.0, m.x, m.y, m.z)))).collect()
            }));
        }
        for direction in directions {
            let ends = [(&joint.ends[0], first, direction), (&joint.ends[1], other, -direction)];
            forces.push(
                ends.into_iter().filter_map(|(end, at, force)| Some((end.body?.0, force_at(at, force)))).collect(),
            );
        }
    }
    forces
}

/// An attachment's position in the world, m.
fn point_of(crane: &LiveCrane, end: &Attachment, transforms: &[Matrix4<f64>]) -> Vector3<f64> {
    point_at(crane, end.body, &end.position, transforms)
}

/// The position in the world of a point of a body, or of the world itself, m.
fn point_at(
    crane: &LiveCrane,
    body: Option<BodyId>,
    position: &[Value; 3],
    transforms: &[Matrix4<f64>],
) -> Vector3<f64> {
    let local = Vector3::from(position.each_ref().map(|x| x.at(crane.parameters())));
    body.map_or(local, |body| transforms[body.0].transform_point(&local.into()).coords)
}

/// The loads whose factor changes over time, or those whose factor is 1: load by load.
fn loads(crane: &LiveCrane, transforms: &[Matrix4<f64>], scaled: bool) -> Vec<Vec<(usize, Screw)>> {
    let chosen = crane.chain().loads.iter().filter(|load| load.scale.is_some() == scaled);
    chosen.map(|load| vec![(load.body.0, load_screw(crane, load, &transforms[load.body.0]))]).collect()
}

fn load_screw(crane: &LiveCrane, load: &Load, transform: &Matrix4<f64>) -> Screw {
    let [position, force, moment] = [&load.position, &load.force, &load.moment]
        .map(|vector| Vector3::from(vector.each_ref().map(|x| x.at(crane.parameters()))));
    let turn = match load.axes {
        LoadAxes::World => Matrix3::identity(),
        LoadAxes::Link => transform.fixed_view::<3, 3>(0, 0).into_owned(),
    };
    let mut whole = force_at(transform.transform_point(&position.into()).coords, turn * force);
    let mut rest = whole.fixed_rows_mut::<3>(3);
    rest += turn * moment;
    whole
}

/// Step of the differences of a cylinder's length, m: their error is its square, and rounding over it.
const SMALL_STEP: f64 = 1e-5;

/// What a cylinder exerts on the bodies of its pins for a push of 1 N: along the derivatives of its length. A linkage stays in the plane
/// normal to the joint's axis, so what turns the axis exerts a moment on the link that carries it, on the side of the joint where the head is
/// not.
fn cylinder_forces(
    crane: &LiveCrane,
    cylinder: &Cylinder,
    q: &[f64],
    transforms: &[Matrix4<f64>],
) -> Vec<(usize, Screw)> {
    let (chain, parameters) = (crane.chain(), crane.parameters());
    let point = |pin: &Pin| point_at(crane, Some(pin.body), &pin.position, transforms);
    let (foot, head) = (point(&cylinder.foot), point(&cylinder.head));
    let Some(linkage) = &cylinder.linkage else {
        let push = (head - foot).normalize();
        return vec![(cylinder.foot.body.0, force_at(foot, -push)), (cylinder.head.body.0, force_at(head, push))];
    };
    let [rocker, link] = [&linkage.rocker, &linkage.link].map(|length| length.at(parameters));
    // From the pivot, the pin of the rod is at the angle of the law of cosines to the line to the head.
    let length = |[foot, head, pivot, axis]: [Vector3<f64>; 4]| {
        let across = head - pivot;
        let aside = axis.cross(&across).normalize() * if linkage.left { 1.0 } else { -1.0 };
        let cosine = (rocker.powi(2) + across.norm_squared() - link.powi(2)) / (2.0 * rocker * across.norm());
        let sine = (1.0 - cosine * cosine).sqrt();
        (pivot + rocker * (cosine * across.normalize() + sine * aside) - foot).norm()
    };
    let [_, axis] = chain.axis(cylinder.coordinate, q, parameters);
    let given = [foot, head, point(&linkage.pivot), Vector3::from(axis)];
    let gradient = |k: usize| {
        Vector3::from_fn(|i, _| {
            let stepped = |step: f64| {
                let mut moved = given;
                moved[k][i] += step;
                length(moved)
            };
            (stepped(SMALL_STEP) - stepped(-SMALL_STEP)) / (2.0 * SMALL_STEP)
        })
    };
    let joint = chain.coordinates[cylinder.coordinate.0].body;
    let mut beyond = Some(cylinder.head.body);
    while beyond.is_some_and(|body| body > joint) {
        beyond = beyond.and_then(|body| chain.bodies[body.0].parent);
    }
    let carrier = if beyond == Some(joint) { chain.bodies[joint.0].parent } else { Some(joint) };
    let moment = given[3].cross(&gradient(3));
    let pins = [&cylinder.foot, &cylinder.head, &linkage.pivot].into_iter().enumerate();
    let on_pins = pins.map(|(k, pin)| (pin.body.0, force_at(given[k], gradient(k))));
    on_pins.chain(carrier.map(|body| (body.0, Screw::new(0.0, 0.0, 0.0, moment.x, moment.y, moment.z)))).collect()
}
