//! Cylinders with a valve whose pins are on a flexible boom: they bend it.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::Cut;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{Method, Settings};
use crane_model::nalgebra::Vector3;
use crane_model::results::cylinders_at;
use crane_model::runs::{self, Start};
use crane_model::{statics, tipping};
use std::ops::ControlFlow;

const GRAVITY: f64 = 9.81;
/// Position of the cylinder's head along the boom, m.
const HEAD: f64 = 1.7;

/// A boom of 4 m in a vertical plane, 500 kg at its end, lifted by a cylinder below it.
fn boom(motion: &str) -> LiveCrane {
    let text = format!(
        "format: 1
name: boom
materials:
  steel: {{E: 2.1e11, G: 8.1e10, density: 7850}}
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - name: boom
    placement: {{transform: {{rotation: {{x: 90 deg}}}}}}
    joint: {{revolute: {{axis: z}}}}
    beam: {{length: 4, sections: 5, section_joint: symmetric, material: steel, section: {{box: {{height: 0.16, width: 0.12, thickness: 0.006}}}}}}
  - {{name: tip, joint: fixed, mass: 500, com: [0, 0, 0], inertia: {{Ixx: 20, Iyy: 20, Izz: 20}}}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: boom_psi, stiffness: 1e8, motion: {motion}}}
cylinders:
  - name: lift
    coordinate: boom_psi
    foot: {{link: post, at: [0.1, 0, -1.2]}}
    head: {{link: boom, at: [{HEAD}, -0.1, 0]}}
    bore: 0.1
    rod: 0.06
    retracted: 1.3
    stroke: 1.2
    back_pressure: 3e5
    max_pressure: 3e7
    bulk_modulus: 1.2e9
    hose_volumes: [1e-3, 1e-3]
    valve: {{flow: 1e-3, pressure_drop: 1e6, lag: 0.03, gain: 0, feed_forward: 0}}
pump: {{max_flow: 2e-3, pressure: 2.5e7}}
run: {{duration: 1, output: 0.01}}
"
    );
    LiveCrane::from_spec(&SourceFile::new("boom.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn rest(crane: &dyn DynCrane) -> Vec<f64> {
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    equilibrium.q
}

fn names(crane: &dyn DynCrane) -> Vec<String> {
    crane.description().coordinates.iter().map(|coordinate| coordinate.name.to_string()).collect()
}

/// At rest the force of the cylinder follows from the moments about the joint, every section carries the weight beyond it and the force of
/// the cylinder if that is beyond it, and the springs of the boom carry the same moments.
#[test]
fn a_boom_bends_under_its_cylinder() {
    let crane = boom("{hold: 0.4}");
    let crane: &dyn DynCrane = &crane;
    let (q, still) = (rest(crane), vec![0.0; crane.size()]);
    let transforms = crane.transforms_at(&q);
    let position = |body: usize, at: [f64; 3]| {
        let point = transforms[body] * Vector3::from(at).push(1.0);
        Vector3::new(point.x, point.y, point.z)
    };
    let bodies = &crane.description().bodies;
    let of_head = bodies.iter().position(|body| body.name.as_ref() == "boom_2").expect("an element");
    // A section ends at the head: two are 0.85 m long before it, three 0.767 m behind it. Elements begin at 0, 0.425, 1.275, 2.083, 2.85 and 3.617 m.
    let head = position(of_head, [HEAD - 1.275, -0.1, 0.0]);
    let foot = position(0, [0.1, 0.0, -1.2]);
    let along = (head - foot).normalize();
    // Weights of the elements, each in its middle, and of the load.
    let density = 7850.0 * (0.16 * 0.12 - 0.148 * 0.108);
    let lengths: Vec<f64> = crane.body_sizes_at().iter().map(|[_, length]| *length).collect();
    let mut weights = vec![(bodies.len() - 1, position(bodies.len() - 1, [0.0; 3]), 500.0)];
    for (index, _) in bodies.iter().enumerate().filter(|(_, body)| body.link.as_ref() == "boom") {
        weights.push((index, position(index, [0.5 * lengths[index], 0.0, 0.0]), density * lengths[index]));
    }
    let turning = |at: &Vector3<f64>, force: Vector3<f64>| at.cross(&force).y;
    let down = |mass: f64| Vector3::new(0.0, 0.0, -mass * GRAVITY);
    let moment: f64 = weights.iter().map(|(_, at, mass)| turning(at, down(*mass))).sum();
    let push = -moment / turning(&head, along);
    let state = cylinders_at(crane, &q, &still, &crane.drive_efforts_at_rest(&q))[0];
    assert!((state.force / push - 1.0).abs() < 1e-8, "{} for {push}", state.force);

    let wrenches = crane.internal_forces_at(0.0, &q, &still, &still);
    let (mut between, mut bent) = (0, 0);
    let moments = crane.element_moments_at(&q, &still);
    let mut elements =
        names(crane).into_iter().filter(|name| name.starts_with("boom_") && name != "boom_psi").zip(moments);
    let mut springs: Vec<(String, f64)> = elements.by_ref().filter(|(name, _)| name.ends_with("psi")).collect();
    springs.reverse();
    for (cut, wrench) in crane.description().cuts().into_iter().zip(&wrenches) {
        let Cut::Body { body, section: Some(_) } = cut else { continue };
        let origin = position(body, [0.0; 3]);
        let beyond = weights.iter().filter(|(index, ..)| *index >= body);
        let mut force: Vector3<f64> = beyond.clone().map(|(_, _, mass)| down(*mass)).sum();
        let mut bending: f64 = beyond.map(|(_, at, mass)| turning(&(at - origin), down(*mass))).sum();
        if body <= of_head {
            force += push * along;
            bending += turning(&(head - origin), push * along);
            between += 1;
        }
        let turn = transforms[body].fixed_view::<3, 3>(0, 0).transpose();
        assert!((wrench.force - turn * force).amax() < 1e-6 * push, "{body}: {} for {}", wrench.force, turn * force);
        // The boom's z axis is the world's −y.
        assert!((wrench.moment.z + bending).abs() < 1e-6 * push, "{body}: {} for {}", wrench.moment.z, -bending);
        if body > 1 {
            let (name, spring) = springs.pop().expect("a spring at every section but the first");
            assert!((spring - wrench.moment.z).abs() < 1e-6 * push, "{name}: {spring} for {}", wrench.moment.z);
            bent += 1;
        } else {
            // The joint turns freely: the cylinder carries the moment.
            assert!(wrench.moment.z.abs() < 1e-6 * push, "{}", wrench.moment.z);
        }
    }
    assert_eq!((between, bent), (3, 5));
}

/// With shut valves nothing moves: the oil holds the bent boom as the springs of statics do.
#[test]
fn shut_valves_hold_a_bent_boom() {
    let crane = boom("{hold: 0.4}");
    let start = Start::new(&crane).expect("it rests");
    for method in [Method::Bdf, Method::Rosenbrock] {
        let settings =
            Settings { method, tolerance: 1e-9, duration: 0.3, ..Settings::from_description(crane.description()) };
        let run = runs::record(&crane, &start, &settings, &mut |_| ControlFlow::Continue(()));
        let table = run.unwrap_or_else(|failed| panic!("{failed:?}")).table;
        for name in names(&crane) {
            let values: Vec<f64> = table.values(&name).expect("a column").collect();
            let moved = values.iter().map(|now| (now - values[0]).abs()).fold(0.0, f64::max);
            assert!(moved < 1e-9, "{method:?}: {name} moves by {moved:.1e}");
        }
    }
}

/// About rest the oil of a shut cylinder is a spring along it, as the spring of its drive is in statics: the two stiffnesses of the crane
/// differ by a multiple of Jᵀ J only. What the force contributes by turning with the boom is the same in both, here differentiated by the
/// compiler and there by differences.
#[test]
fn shut_oil_and_its_spring_in_statics_differ_along_the_cylinder_only() {
    let crane = boom("{hold: 0.4}");
    let crane: &dyn DynCrane = &crane;
    let (q, n) = (rest(crane), crane.size());
    let mut row = vec![0.0; n];
    crane.cylinder_jacobians(&q, &mut row);
    let mut tangent = vec![0.0; n * n];
    crane.tangent_stiffness(0.0, &q, &crane.drive_positions_at(0.0), &mut tangent);
    let small = crane.small_motions_at(&q);
    let push = cylinders_at(crane, &q, &vec![0.0; n], &crane.drive_efforts_at_rest(&q))[0].force;
    let entry = |i: usize, j: usize| small.stiffness[(i, j)] - tangent[small.unknowns[i] * n + small.unknowns[j]];
    let at = |i: usize| row[small.unknowns[i]];
    let joint = small.unknowns.iter().position(|unknown| *unknown == 1).expect("the joint of the boom");
    let along = entry(joint, joint) / (at(joint) * at(joint));
    let (mut off, mut greatest) = (0.0_f64, 0.0_f64);
    for i in 0..small.unknowns.len() {
        for j in 0..small.unknowns.len() {
            off = off.max((entry(i, j) - along * at(i) * at(j)).abs());
            greatest = greatest.max((at(i) * at(j)).abs());
        }
    }
    // The curvature of ℓ is of the order of 1 m, and the differences have errors of 1e-8 of it and of rounding in 2e8 N/m.
    assert!(push.abs() > 1e4 && off < 1e-5 * push.abs() + 1e-10 * along.abs() * greatest, "{off} beside {push} N");
}

/// The servo measures its cylinder: at rest the cylinder is as long as that of a boom that does not bend, except for what its spring of 1e8
/// N m/rad yields.
#[test]
fn a_cylinder_keeps_the_length_of_a_straight_boom() {
    let crane = boom("{hold: 0.4}");
    let crane: &dyn DynCrane = &crane;
    let (q, still) = (rest(crane), vec![0.0; crane.size()]);
    let mut straight = still.clone();
    straight[1] = 0.4;
    let length = |q: &[f64]| cylinders_at(crane, q, &still, &[0.0; 2])[0];
    let (now, meant) = (length(&q), length(&straight));
    let force = cylinders_at(crane, &q, &still, &crane.drive_efforts_at_rest(&q))[0].force;
    let yielded = force * meant.arm * meant.arm / 1e8;
    assert!((meant.length - now.length - yielded).abs() < 1e-12, "{} for {yielded}", meant.length - now.length);
    // The boom bends by much more: its joint turns by as much as the boom yields under the cylinder.
    assert!((q[1] - 0.4).abs() > 3.0 * yielded, "{}", q[1]);
}

/// Positions given to statics have the same effect as those of the motion.
#[test]
fn statics_hold_cylinders_at_given_positions() {
    let (crane, other) = (boom("{hold: 0.4}"), boom("{hold: 0.7}"));
    let (crane, other): (&dyn DynCrane, &dyn DynCrane) = (&crane, &other);
    let expected = rest(other);
    let equilibrium = statics::Problem::new(crane).holding(&[0.0, 0.7]).from(&rest(crane)).solve();
    assert!(equilibrium.is_stable(), "{equilibrium}");
    for (value, expected) in equilibrium.q.iter().zip(&expected) {
        assert!((value - expected).abs() < 1e-10, "{value} for {expected}");
    }
    let efforts = crane.drive_efforts_holding(0.0, &[0.0, 0.7], &equilibrium.q);
    let meant = other.drive_efforts_at_rest(&expected);
    assert!((efforts[1] / meant[1] - 1.0).abs() < 1e-8, "{efforts:?} for {meant:?}");
}

/// A force between two links does not tip a crane: the moments about tipping lines are those of the weights, whatever a gas spring or the
/// cylinder pushes with.
#[test]
fn forces_within_a_crane_do_not_tip_it() {
    let lines = |spring: &str| {
        let text = format!(
            "format: 1
name: on_feet
links:
  - {{name: truck, joint: free, mass: 2000, com: [0, 0, 0.5], inertia: {{Ixx: 900, Iyy: 900, Izz: 900}}}}
  - {{name: arm, placement: {{transform: {{translation: [0, 0, 1]}}}}, joint: {{revolute: {{axis: y}}}}, mass: 300, com: [2, 0, 0], inertia: {{Ixx: 9, Iyy: 90, Izz: 90}}}}
supports:
  - {{name: a, at: [1, 1, 0], stiffness: [1e6, 1e6, 1e6]}}
  - {{name: b, at: [1, -1, 0], stiffness: [1e6, 1e6, 1e6]}}
  - {{name: c, at: [-1, 0, 0], stiffness: [1e6, 1e6, 1e6]}}
drives: [{{coordinate: arm_theta, stiffness: 1e6, motion: {{hold: 0}}}}]
{spring}"
        );
        let crane = LiveCrane::from_spec(&SourceFile::new("on_feet.yaml", text));
        let crane = crane.unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
        let still = vec![0.0; crane.size()];
        tipping::lines(&crane, 0.0, &still, &still, &still)
    };
    let spring = "connectors: [{name: strut, from: {link: truck, at: [0.9, 0.2, 0]}, to: {link: arm, at: [0.8, 0, 0]}, \
                  law: {gas_spring: {force: 2e4, length: 1}}}]\n";
    let (without, with) = (lines(""), lines(spring));
    assert_eq!(without.len(), 3);
    for (without, with) in without.iter().zip(&with) {
        for (one, other) in [(without.stabilising, with.stabilising), (without.overturning, with.overturning)] {
            assert!((one - other).abs() < 1e-8 * without.stabilising, "{without:?} and {with:?}");
        }
    }
    // The arm's weight is 1 m beyond the line from a to b; the truck's is 1 m within it.
    let governing = tipping::governing(&with).expect("a line");
    assert!((governing.overturning / (300.0 * GRAVITY) - 1.0).abs() < 1e-9, "{governing:?}");
    assert!((governing.stabilising / (2000.0 * GRAVITY) - 1.0).abs() < 1e-9, "{governing:?}");
}
