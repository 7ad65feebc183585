//! What is attached to a beam moves with the element at its own place, whatever it is.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::nalgebra::Vector3;
use crane_model::results::cylinders_at;

/// Length of the boom, m.
const BOOM: f64 = 4.0;
/// On the jib, m, and in the world.
const HEAD: [f64; 3] = [0.3, -0.2, 0.01];
const ANCHOR: [f64; 3] = [-2.0, 1.0, 5.0];
const FORCE: [f64; 3] = [30.0, -50.0, 70.0];
const SIDES: [f64; 2] = [-0.3, 0.07];

/// A boom to which a point, a load, a connector from the world, two cylinders and the pivot of a linkage are attached at one place.
fn crane(x: f64, section_joint: &str) -> LiveCrane {
    let [y, z] = SIDES;
    let at = format!("[{x:?}, {y}, {z}]");
    let rocker = far(x);
    let cylinder = "bore: 0.1, rod: 0.06, retracted: 1, stroke: 1";
    let text = format!(
        "format: 1
name: attached
gravity: [0, 0, 0]
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - name: boom
    placement: {{transform: {{rotation: {{x: 90 deg}}}}}}
    joint: revolute
    beam: {{length: {BOOM}, sections: 4, section_joint: {section_joint}, material: {{E: 2.1e11, G: 8.1e10, density: 7850}}, section: {{tube: {{diameter: 0.1, thickness: 0.01}}}}}}
  - {{name: jib, joint: revolute, mass: 90, com: [1, 0, 0], inertia: {{Ixx: 3, Iyy: 30, Izz: 30}}}}
  - {{name: tool, joint: revolute, mass: 9, com: [1, 0, 0], inertia: {{Ixx: 3, Iyy: 3, Izz: 3}}}}
drives:
  - {{coordinate: post_x, stiffness: 1e6, motion: {{hold: 0}}}}
  - {{coordinate: boom_psi, stiffness: 1e6, motion: {{hold: 0}}}}
  - {{coordinate: jib_psi, stiffness: 1e6, motion: {{hold: 0}}}}
  - {{coordinate: tool_psi, stiffness: 1e6, motion: {{hold: 0}}}}
loads: [{{name: pull, link: boom, at: {at}, force: {FORCE:?}}}]
connectors: [{{name: rope, from: {{at: {ANCHOR:?}}}, to: {{link: boom, at: {at}}}, law: {{rope: {{stiffness: 1e3, length: 1}}}}}}]
cylinders:
  - {{name: lift, coordinate: boom_psi, foot: {{link: post, at: [0.3, 0, -2]}}, head: {{link: boom, at: {at}}}, {cylinder}}}
  - {{name: knuckle, coordinate: jib_psi, foot: {{link: boom, at: [1.1, -0.3, 0]}}, head: {{link: jib, at: {HEAD:?}}},
     linkage: {{pivot: {at}, rocker: {rocker}, link: {rocker}, side: right}}, {cylinder}}}
points:
  - {{name: here, link: boom, at: {at}}}
  - {{name: foot, link: boom, at: [1.1, -0.3, 0]}}
  - {{name: head, link: jib, at: {HEAD:?}}}
"
    );
    LiveCrane::from_spec(&SourceFile::new("attached.yaml", &text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// From the place to the head of the linkage while nothing is bent, m: rocker and link of this length meet.
fn far(x: f64) -> f64 {
    Vector3::new(BOOM + HEAD[0] - x, HEAD[1] - SIDES[0], HEAD[2] - SIDES[1]).norm()
}

#[test]
fn everything_moves_with_the_element_at_its_own_place() {
    for section_joint in ["symmetric", "paper"] {
        // At the ends, near them, between them, on borders of equal sections and beside them, and beyond the ends.
        for x in [-0.2, 0.0, 0.05, 0.3, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 2.5, 2.7, 3.5, 3.95, BOOM, 4.2] {
            let crane = crane(x, section_joint);
            let crane: &dyn DynCrane = &crane;
            let coordinates = &crane.description().coordinates;
            let n = coordinates.len();
            let still = vec![0.0; n];
            let straight: Vector3<f64> = crane.points_at(&still)[0];
            assert!((straight - Vector3::new(x, -SIDES[1], SIDES[0])).amax() < 1e-14, "{x}: {straight}");
            // Which springs move it: those before it. A section ends at the place, so that none is there.
            let lengths = crane.body_sizes_at();
            let elements =
                crane.description().bodies.iter().zip(&lengths).filter(|(body, _)| body.link.as_ref() == "boom");
            let lengths: Vec<f64> = elements.map(|(_, [_, length])| *length).collect();
            for (j, coordinate) in coordinates.iter().enumerate() {
                let Some(spring) =
                    coordinate.name.strip_prefix("boom_").and_then(|name| name[..1].parse::<usize>().ok())
                else {
                    continue;
                };
                let mut q = still.clone();
                q[j] = 0.1;
                let moved = (crane.points_at(&q)[0] - straight).amax() > 1e-9;
                assert_eq!(moved, x >= lengths[..spring].iter().sum(), "{x}: {}", coordinate.name);
            }
            let q: Vec<f64> = (0..n).map(|j| 0.05 * (1.0 + 1.7 * j as f64).sin()).collect();
            let places = |q: &[f64]| {
                let points = crane.points_at(q);
                (points[0], points[1], points[2])
            };
            // A load does work on its own place.
            let mut forces = vec![0.0; n];
            crane.load_forces(0.0, &q, &mut forces);
            for j in 0..n {
                let at = |by: f64| {
                    let mut moved = q.clone();
                    moved[j] += by;
                    places(&moved).0.dot(&Vector3::from(FORCE))
                };
                // Central differences: the third derivative times 1e-10, and rounding over 1e-5, times 90 N.
                assert!((forces[j] - (at(1e-5) - at(-1e-5)) / 2e-5).abs() < 1e-6, "{x}: {j}: {}", forces[j]);
            }
            let (here, foot, head) = places(&q);
            let length = crane.connector_lengths_at(&q, &still)[0][0];
            assert!((length - (here - Vector3::from(ANCHOR)).norm()).abs() < 1e-13, "{x}: {length}");
            let states = cylinders_at(crane, &q, &still, &[0.0; 4]);
            let from = Vector3::new(0.3 + q[0], 0.0, -2.0);
            assert!((states[0].length - (here - from).norm()).abs() < 1e-13, "{x}: {}", states[0].length);
            // The rod's pin is in the plane of place, head and their normal in the plane about the joint's axis.
            let jib = crane.description().bodies.iter().position(|body| body.name.as_ref() == "jib").expect("a body");
            let axis: Vector3<f64> = crane.transforms_at(&q)[jib].fixed_view::<3, 1>(0, 2).into();
            let (across, rocker) = (head - here, far(x));
            let distance = across.norm();
            let cosine = distance / (2.0 * rocker);
            let aside = axis.cross(&across).normalize();
            let pin = here + rocker * (cosine * across / distance - (1.0 - cosine * cosine).sqrt() * aside);
            let length = (pin - foot).norm();
            assert!((states[1].length - length).abs() < 1e-12, "{x}: {} for {length}", states[1].length);
        }
    }
}
