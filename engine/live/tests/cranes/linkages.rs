//! Rocker and link on a boom that bends: foot and pivot are on different elements of it.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::Cut;
use crane_model::dyn_crane::DynCrane;
use crane_model::nalgebra::{DMatrix, Vector3};
use crane_model::results::cylinders_at;
use crane_model::{Wrench, statics};

const GRAVITY: f64 = 9.81;
/// Length of the boom, m.
const BOOM: f64 = 3.2;
/// Positions on the boom, m.
const FOOT: [f64; 3] = [0.9, -0.22, 0.0];
const PIVOT: [f64; 3] = [2.9, 0.02, 0.0];
/// Position on the jib, m.
const HEAD: [f64; 3] = [0.26, -0.18, 0.0];
const ROCKER: f64 = 0.46;
const LINK: f64 = 0.44;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("loader.yaml", text))
        .unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// A beam of the boom's section.
fn beam(length: f64, sections: &str) -> String {
    format!(
        "{{length: {length}, {sections}, material: {{E: 2.1e11, G: 8.1e10, density: 7850}}, \
         section: {{box: {{height: 0.24, width: 0.18, thickness: 0.006}}}}}}"
    )
}

/// A loader crane: a boom in a vertical plane, a jib with a load 3 m beyond it and `aside` of the plane, and what moves the jib.
fn loader(booms: &str, aside: f64, cylinder: &str) -> LiveCrane {
    crane(&format!(
        "format: 1
name: loader
links:
  - {{name: column, joint: {{revolute: {{axis: z}}}}, mass: 300, com: [0, 0, 0.5], inertia: {{Ixx: 40, Iyy: 40, Izz: 20}}}}
{booms}
  - {{name: jib, joint: revolute, mass: 900, com: [3, 0, {aside}], inertia: {{Ixx: 30, Iyy: 300, Izz: 300}}}}
drives:
  - {{coordinate: column_psi, stiffness: 3e6, motion: {{hold: 0}}}}
  - {{coordinate: boom_psi, stiffness: 5e7, motion: {{hold: 0.3}}}}
  - {{coordinate: jib_psi, stiffness: 5e7, motion: {{hold: -0.2}}}}
cylinders:
  - name: knuckle
    coordinate: jib_psi
    {cylinder}
    bore: 0.115
    rod: 0.07
    retracted: 1.3
    stroke: 0.9
    max_pressure: 32e6
    bulk_modulus: 1.2e9
    hose_volumes: [1e-3, 1e-3]
    valve: {{flow: 6e-4, pressure_drop: 1e6, lag: 0.03, gain: 2}}
pump: {{max_flow: 8e-4, pressure: 30e6}}
"
    ))
}

fn boom(length: f64, sections: &str) -> String {
    format!(
        "  - {{name: boom, placement: {{transform: {{translation: [0, 0, 1.4], rotation: {{x: 90 deg}}}}}}, joint: revolute, beam: {}}}",
        beam(length, sections)
    )
}

fn linkage(link: &str, foot: [f64; 3], pivot: [f64; 3]) -> String {
    format!(
        "foot: {{link: {link}, at: {foot:?}}}\n    head: {{link: jib, at: {HEAD:?}}}\n    \
         linkage: {{pivot: {pivot:?}, rocker: {ROCKER}, link: {LINK}, side: right}}"
    )
}

/// The rod's pin from the pivot: r away from it and l away from the head, on the right of the line to the head.
fn rods_pin(to_head: Vector3<f64>, axis: Vector3<f64>) -> Vector3<f64> {
    let distance = to_head.norm();
    let cosine = (distance * distance + ROCKER * ROCKER - LINK * LINK) / (2.0 * distance * ROCKER);
    let across = axis.cross(&to_head).normalize();
    ROCKER * (cosine * to_head / distance - (1.0 - cosine * cosine).sqrt() * across)
}

fn rest(crane: &dyn DynCrane) -> Vec<f64> {
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    equilibrium.q
}

/// The world position of a point of a body.
fn position_at(crane: &dyn DynCrane, q: &[f64], body: usize, at: [f64; 3]) -> Vector3<f64> {
    let point = crane.transforms_at(q)[body] * Vector3::from(at).push(1.0);
    Vector3::new(point.x, point.y, point.z)
}

/// The world position of a point of the boom: on the element that begins before it.
fn on_boom(crane: &dyn DynCrane, q: &[f64], at: [f64; 3]) -> Vector3<f64> {
    let mut start = 0.0;
    let mut found = None;
    for (index, _) in crane.description().bodies.iter().enumerate().filter(|(_, body)| body.link.as_ref() == "boom") {
        if start <= at[0] {
            found = Some((index, start));
        }
        start += crane.body_sizes_at()[index][1];
    }
    let (body, start) = found.expect("an element");
    position_at(crane, q, body, [at[0] - start, at[1], at[2]])
}

fn body_named(crane: &dyn DynCrane, name: &str) -> usize {
    crane.description().bodies.iter().position(|body| body.name.as_ref() == name).expect("a body")
}

fn wrenches(crane: &dyn DynCrane, q: &[f64]) -> Vec<(Cut, Wrench)> {
    let still = vec![0.0; q.len()];
    crane.description().cuts().into_iter().zip(crane.internal_forces_at(0.0, q, &still, &still)).collect()
}

/// A rocker about the axis of the joint turns with the jib, so its pin is a point of the jib: the linkage is a cylinder between the foot
/// and that point. Everything agrees, whatever bends between foot and pivot.
#[test]
fn a_rocker_about_the_joint_is_a_direct_cylinder() {
    let direction = rods_pin(Vector3::from(HEAD), Vector3::z());
    for aside in [0.0, 0.3] {
        for sections in [
            "sections: rigid",
            "sections: 1",
            "sections: 2",
            "sections: 5",
            "sections: 8",
            "sections: 4, section_joint: paper",
        ] {
            let with_linkage = loader(&boom(BOOM, sections), aside, &linkage("boom", FOOT, [BOOM, 0.0, 0.0]));
            let head: [f64; 3] = direction.into();
            let direct = loader(
                &boom(BOOM, sections),
                aside,
                &format!("foot: {{link: boom, at: {FOOT:?}}}\n    head: {{link: jib, at: {head:?}}}"),
            );
            let [one, other]: [&dyn DynCrane; 2] = [&with_linkage, &direct];
            let q = rest(one);
            // Newton's method ends at 1e-10 of the forces.
            for (a, b) in q.iter().zip(rest(other)) {
                assert!((a - b).abs() < 1e-10, "{sections}: {a} for {b}");
            }
            let still = vec![0.0; q.len()];
            let v: Vec<f64> = (0..q.len()).map(|j| (1.3 * j as f64).cos()).collect();
            let [a, b] = [one, other].map(|crane| cylinders_at(crane, &q, &v, &crane.drive_efforts_at_rest(&q))[0]);
            for (a, b, size) in
                [(a.length, b.length, 1.0), (a.arm, b.arm, 1.0), (a.speed, b.speed, 1.0), (a.force, b.force, b.force)]
            {
                assert!((a - b).abs() < 1e-9 * size.abs(), "{sections}: {a} for {b}");
            }
            // Only the crane with a linkage has sections at its pivot.
            let of_bodies = |crane| {
                let all: Vec<(Cut, Wrench)> = wrenches(crane, &q);
                all.into_iter().filter(|(cut, _)| !matches!(cut, Cut::Inside { .. }))
            };
            for ((cut, a), (_, b)) in of_bodies(one).zip(of_bodies(other)) {
                // The jib does not feel the force of the pivot, and the boom, not the jib, holds the rocker upright.
                let of_jib =
                    matches!(cut, Cut::Joint { body } | Cut::Body { body, .. } if body == body_named(one, "jib"));
                if of_jib {
                    assert!((a.moment.z - b.moment.z).abs() < 1e-4, "{sections}: {} for {}", a.moment.z, b.moment.z);
                    continue;
                }
                // Forces are some 1e5 N; Newton's method ends at 1e-10 of them.
                assert!((a.force - b.force).amax() < 1e-4, "{sections}: {cut:?}: {} for {}", a.force, b.force);
                assert!((a.moment - b.moment).amax() < 1e-4, "{sections}: {cut:?}: {} for {}", a.moment, b.moment);
            }
            let [a, b]: [DMatrix<f64>; 2] = [one, other].map(|crane| crane.small_motions_at(&q).stiffness);
            assert!((&a - &b).amax() < 1e-9 * b.amax(), "{sections}: {}", (a - b).amax());
            let [a, b] = [one, other].map(|crane| crane.element_moments_at(&q, &still));
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-3), "{sections}: {a:?} for {b:?}");
        }
    }
}

/// Every section between foot and pivot carries the weight beyond it and the force of the rod; between pivot and joint, the weight and the
/// force of the link.
#[test]
fn a_boom_carries_the_weight_and_the_rod() {
    for sections in [1, 2, 4, 9] {
        let crane = loader(&boom(BOOM, &format!("sections: {sections}")), 0.0, &linkage("boom", FOOT, PIVOT));
        let crane: &dyn DynCrane = &crane;
        let q = rest(crane);
        let jib = body_named(crane, "jib");
        let [foot, pivot] = [FOOT, PIVOT].map(|at| on_boom(crane, &q, at));
        let [head, load] = [HEAD, [3.0, 0.0, 0.0]].map(|at| position_at(crane, &q, jib, at));
        // Angles grow about the world's −y.
        let axis = -Vector3::y();
        let pin = pivot + rods_pin(head - pivot, axis);
        let turning = |arm: Vector3<f64>, force: Vector3<f64>| arm.cross(&force).dot(&axis);
        let weight = |mass: f64| Vector3::new(0.0, 0.0, -mass * GRAVITY);
        let joint = position_at(crane, &q, jib, [0.0; 3]);
        // The link alone holds the jib, and the rod alone holds the rocker against the link.
        let of_link = (head - pin).normalize();
        let thrust = -turning(load - joint, weight(900.0)) / turning(head - joint, of_link);
        let of_rod = (pin - foot).normalize();
        let push = thrust * turning(pin - pivot, of_link) / turning(pin - pivot, of_rod);
        let still = vec![0.0; q.len()];
        let state = cylinders_at(crane, &q, &still, &crane.drive_efforts_at_rest(&q))[0];
        assert!((state.length - (pin - foot).norm()).abs() < 1e-12, "{sections}: {}", state.length);
        assert!((state.force / push - 1.0).abs() < 1e-8, "{sections}: {} for {push}", state.force);
        let density = 7850.0 * (0.24 * 0.18 - 0.228 * 0.168);
        let (mut between, mut beyond) = (0, 0);
        for (cut, wrench) in wrenches(crane, &q) {
            let Cut::Body { body, section: Some(section) } = cut else { continue };
            let x = crane.section_places_at(&q)[section];
            let origin = position_at(crane, &q, body, [0.0; 3]);
            let bodies = crane.description().bodies.iter().enumerate().skip(body);
            let by_boom: f64 = bodies
                .filter(|(_, body)| body.link.as_ref() == "boom")
                .map(|(index, _)| {
                    let [_, length] = crane.body_sizes_at()[index];
                    let middle = position_at(crane, &q, index, [0.5 * length, 0.0, 0.0]);
                    turning(middle - origin, weight(density * length))
                })
                .sum();
            let weights = by_boom + turning(load - origin, weight(900.0));
            let expected = if x > PIVOT[0] {
                beyond += 1;
                weights + turning(head - origin, thrust * of_link)
            } else if x > FOOT[0] {
                between += 1;
                weights + turning(foot - origin, push * of_rod)
            } else {
                weights
            };
            // Newton's method ends at 1e-10 of the forces, which are some 1e5 N.
            assert!((wrench.moment.z - expected).abs() < 1e-3, "{sections}: {x} m: {} for {expected}", wrench.moment.z);
        }
        assert!(between >= 1 && (sections < 9 || beyond >= 1), "{sections}: {between}, {beyond}");
    }
}

/// A boom cut in two by a fixed joint is the boom in one piece: the same springs, the same places.
#[test]
fn a_boom_in_two_pieces_is_a_boom_in_one() {
    let points = |crane: &dyn DynCrane, q: &[f64]| {
        let jib = body_named(crane, "jib");
        [[0.0; 3], [3.0, 0.0, 0.0]].map(|at| position_at(crane, q, jib, at))
    };
    let whole = loader(&boom(BOOM, "sections: 8"), 0.3, &linkage("boom", FOOT, PIVOT));
    // Where the foot is, a section ends. Before it two are 0.45 m long, behind it five 0.4 m and one 0.3 m.
    let cut = FOOT[0];
    let pieces = format!(
        "{}\n  - {{name: rest, joint: fixed, beam: {}}}",
        boom(cut, "sections: 2"),
        beam(BOOM - cut, "sections: 6")
    );
    let shifted = |[x, y, z]: [f64; 3]| [x - cut, y, z];
    let pieces = loader(&pieces, 0.3, &linkage("rest", shifted(FOOT), shifted(PIVOT)));
    let [whole, pieces]: [&dyn DynCrane; 2] = [&whole, &pieces];
    let [q, of_pieces] = [whole, pieces].map(rest);
    for (one, other) in points(whole, &q).iter().zip(points(pieces, &of_pieces)) {
        assert!((one - other).amax() < 1e-9, "{one} for {other}");
    }
    let moments = |crane: &dyn DynCrane, q: &[f64]| crane.element_moments_at(q, &vec![0.0; q.len()]);
    let [one, other] = [moments(whole, &q), moments(pieces, &of_pieces)];
    assert!(one.iter().any(|moment| moment.abs() > 1e4), "{one:?}");
    for (one, other) in one.iter().zip(&other) {
        assert!((one - other).abs() < 1e-3, "{one} for {other}");
    }
}

/// The deflection and the force of the cylinder depend on the mesh only through the pose: their errors fall with the square of the number
/// of sections.
#[test]
fn finer_meshes_converge_with_order_two() {
    // Where equal sections end on every mesh, so that errors fall evenly.
    let foot = [0.8, -0.22, 0.0];
    let longer = linkage("boom", foot, [2.4, 0.02, 0.0]).replace("rocker: 0.46, link: 0.44", "rocker: 0.9, link: 0.8");
    let results = |sections: usize| {
        let crane = loader(&boom(BOOM, &format!("sections: {sections}")), 0.0, &longer);
        let q = rest(&crane);
        let jib = body_named(&crane, "jib");
        let load = position_at(&crane, &q, jib, [3.0, 0.0, 0.0]);
        let state =
            cylinders_at(&crane, &q, &vec![0.0; q.len()], &(&crane as &dyn DynCrane).drive_efforts_at_rest(&q))[0];
        [load.z, state.force]
    };
    let [coarse, middle, fine, finest] = [4, 8, 16, 32].map(results);
    for k in 0..2 {
        let [first, second, third] = [coarse[k] - middle[k], middle[k] - fine[k], fine[k] - finest[k]].map(f64::abs);
        assert!(first > 1e-9 * coarse[k].abs(), "{k}: it does not depend on the mesh: {first}");
        let orders = [(first / second).log2(), (second / third).log2()];
        assert!(orders.iter().all(|order| *order > 1.9), "{k}: {orders:?}");
        assert!((4.0 / 3.0 * first) < 0.02 * coarse[k].abs(), "{k}: {first} of {}", coarse[k]);
    }
}

/// Forces at head, foot, pivot and axis do the work of the cylinder, also where boom and jib bend, twist and are aside of the plane: the
/// wrench at the beginning of an element is the derivative of the length by the angles there.
#[test]
fn a_linkage_does_the_work_of_its_cylinder() {
    for (foot, pivot) in [(FOOT, PIVOT), ([1.9, -0.2, 0.05], [1.3, 0.3, -0.04]), ([0.3, -0.1, 0.1], [0.4, 0.0, 0.0])] {
        let reach = Vector3::new(BOOM + 0.26 - pivot[0], -0.18 - pivot[1], -pivot[2]).norm();
        let cylinder = format!(
            "foot: {{link: boom, at: {foot:?}}}\n    head: {{link: jib, at: [0.26, -0.18, 0.02]}}\n    \
             linkage: {{pivot: {pivot:?}, rocker: {reach}, link: 0.5, side: left}}"
        );
        let crane = loader(&boom(BOOM, "sections: 4"), 0.4, &cylinder);
        let crane: &dyn DynCrane = &crane;
        let description = crane.description();
        let n = description.coordinates.len();
        // Elements that are not turned have axes parallel to those of their springs.
        let mut q = vec![0.0; n];
        (q[0], q[1], q[n - 1]) = (0.4, 0.3, -0.3);
        let mut row = vec![0.0; n];
        crane.cylinder_jacobians(&q, &mut row);
        let cuts = description.cuts();
        let mut wrenches = vec![Wrench::ZERO; cuts.len()];
        crane.cylinder_wrenches(&q, &mut wrenches);
        let mut compared = 0;
        for (cut, wrench) in cuts.iter().zip(&wrenches) {
            let Cut::Body { body, section: Some(section) } = *cut else { continue };
            let x = crane.section_places_at(&q)[section];
            let name = &description.bodies[body].name;
            let axes = [("psi", wrench.moment.z), ("theta", wrench.moment.y), ("phi", wrench.moment.x)];
            for (symbol, moment) in axes.into_iter().filter(|_| x > 0.0) {
                let coordinate = format!("{name}_{symbol}");
                let j = description.coordinates.iter().position(|other| other.name.as_ref() == coordinate);
                let slope = row[j.expect("an element's coordinate")];
                assert!((slope - moment).abs() < 1e-12, "{foot:?} {coordinate}: {slope} for {moment}");
                compared += usize::from(slope.abs() > 1e-3);
            }
        }
        assert!(compared >= 3, "{compared} entries");
        // The slope is that of the length, in a pose in which everything is turned.
        let still = vec![0.0; n];
        let bent: Vec<f64> = q.iter().enumerate().map(|(j, q)| q + 0.02 * (1.0 + 2.3 * j as f64).sin()).collect();
        crane.cylinder_jacobians(&bent, &mut row);
        for j in 0..n {
            let at = |by: f64| {
                let mut moved = bent.clone();
                moved[j] += by;
                cylinders_at(crane, &moved, &still, &[0.0; 3])[0].length
            };
            // Central differences: the third derivative times 1e-10, and rounding over 1e-5.
            let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
            assert!((row[j] - slope).abs() < 1e-8, "{foot:?} coordinate {j}: {} for {slope}", row[j]);
        }
    }
}

/// The jib carries its weight and the force of the link at its head: the boom, not the jib, holds the rocker upright, also where the rod pushes
/// aside of the plane. The force is that of the cylinder times the slope of its length by the position of the head.
#[test]
fn the_boom_holds_the_rocker_upright() {
    let aside = [FOOT[0], FOOT[1], 0.06];
    let crane = loader(&boom(BOOM, "sections: 4"), 0.3, &linkage("boom", aside, PIVOT));
    let crane: &dyn DynCrane = &crane;
    let q = rest(crane);
    let jib = body_named(crane, "jib");
    let [foot, pivot] = [aside, PIVOT].map(|at| on_boom(crane, &q, at));
    let [joint, head, load, beside] =
        [[0.0; 3], HEAD, [3.0, 0.0, 0.3], [0.0, 0.0, 1.0]].map(|at| position_at(crane, &q, jib, at));
    let length = |head: Vector3<f64>| (pivot + rods_pin(head - pivot, beside - joint) - foot).norm();
    let slope = Vector3::from_fn(|axis, _| {
        let at = |by: f64| {
            let mut moved = head;
            moved[axis] += by;
            length(moved)
        };
        (at(1e-5) - at(-1e-5)) / 2e-5
    });
    let still = vec![0.0; q.len()];
    let push = cylinders_at(crane, &q, &still, &crane.drive_efforts_at_rest(&q))[0].force * slope;
    let weight = Vector3::new(0.0, 0.0, -900.0 * GRAVITY);
    let moment = (load - joint).cross(&weight) + (head - joint).cross(&push);
    let turn = crane.transforms_at(&q)[jib].fixed_view::<3, 3>(0, 0).transpose();
    let of_joint = |(cut, _): &(Cut, Wrench)| *cut == Cut::Joint { body: jib };
    let (_, wrench) = wrenches(crane, &q).into_iter().find(of_joint).expect("the joint");
    // Forces are some 1e5 N; central differences are exact to the third derivative times 1e-10, and to rounding over 1e-5.
    assert!((wrench.force - turn * (weight + push)).amax() < 1e-2, "{}", wrench.force - turn * (weight + push));
    assert!((wrench.moment - turn * moment).amax() < 1e-2, "{}", wrench.moment - turn * moment);
}
