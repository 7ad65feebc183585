//! The point whose radius and height are shown, and the axis of the radius: by hand, and on cranes that are described in two ways.

use crane_codegen::{SourceFile, build};
use crane_live::{LiveCrane, Reach};
use crane_model::dyn_crane::Functions;
use crane_model::envelope::only_mass;

/// The reach of a crane for its only mass, or a point.
fn reach(source: &SourceFile, point: Option<&str>) -> (LiveCrane, Reach) {
    let crane = LiveCrane::from_spec(source).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let index = |name: &str| crane.description().points.iter().position(|own| own == name).expect("a point");
    let reach = Reach::new(crane.chain(), crane.parameters(), only_mass(crane.description()), point.map(index));
    (crane, reach)
}

/// In words, and radius and height at the guess with some coordinates changed.
fn shown(links: &str, changed: &[(usize, f64)]) -> (String, [f64; 2]) {
    let text = format!("format: 1\nname: crane\nparameters: {{payload: {{value: 300, unit: kg}}}}\n{links}");
    let (crane, reach) = reach(&SourceFile::new("crane.yaml", text), None);
    let mut q = crane.chain().guess_at(crane.parameters());
    for (index, value) in changed {
        q[*index] = *value;
    }
    (reach.words(), reach.radius_and_height(&q, crane.parameters()))
}

/// Some roundings of lengths of some metres.
#[track_caller]
fn assert_near(found: [f64; 2], expected: [f64; 2]) {
    assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12), "{found:?}");
}

const AXIS: &str = "inertia: {gyration: [1, 1, 1]}";
const POST: &str = "placement: {transform: {translation: [0.25, 0, 1]";

#[test]
fn the_slewing_axis_is_found_where_it_stands() {
    // Also where the joint's own axis points downwards.
    for (turned, height) in [("", 0.5), (", rotation: {x: 180 deg}", 1.5)] {
        let links = format!(
            "links: [{{name: arm, {POST}{turned}}}}}, joint: revolute, mass: payload, com: [5, 0, -0.5], {AXIS}}}]\n\
             drives: [{{coordinate: arm_psi, rigid: true, motion: {{hold: 0}}}}]"
        );
        let (words, found) = shown(&links, &[(0, 0.7)]);
        assert_eq!(words, "radius of the centre of mass of arm from the axis of arm_psi", "{turned}");
        assert_near(found, [5.0, height]);
    }
    let boom = format!(
        "links: [{{name: arm, {POST}, rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: payload, com: [5, 0, 0], {AXIS}}}]\n\
         drives: [{{coordinate: arm_psi, rigid: true, motion: {{hold: 0}}}}]"
    );
    let (words, found) = shown(&boom, &[]);
    assert_eq!(words, "radius of the centre of mass of arm from the world's origin");
    assert_near(found, [5.25, 1.0]);
}

/// On a carriage the axis moves along; a rotator at the end does not slew the crane.
#[test]
fn the_axis_moves_along_and_is_not_that_of_a_rotator() {
    let links = |column: &str| {
        format!(
            "links:
  - {{name: carriage, joint: {{prismatic: {{axis: x}}}}, mass: 2000, com: [0, 0, 0]}}
  - {{name: column, joint: {column}, mass: 300, com: [0, 0, 0], {AXIS}}}
  - {{name: boom, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: 200, com: [2, 0, 0], {AXIS}}}
  - {{name: load, placement: {{transform: {{translation: [4, 0, 0], rotation: {{x: -90 deg}}}}}}, joint: revolute, mass: payload, com: [0, 0, -1], {AXIS}}}
drives: [{}{{coordinate: carriage_x, rigid: true, motion: {{hold: 10}}}}, {{coordinate: boom_psi, rigid: true, motion: {{hold: 0}}}}, {{coordinate: load_psi, rigid: true, motion: {{hold: 0}}}}]",
            if column == "fixed" { "" } else { "{coordinate: column_psi, rigid: true, motion: {hold: 0}}, " }
        )
    };
    let (words, found) = shown(&links("revolute"), &[(0, 12.0), (1, 0.5)]);
    assert_eq!(words, "radius of the centre of mass of load from the axis of column_psi");
    assert_near(found, [4.0, -1.0]);
    let (words, found) = shown(&links("fixed"), &[(0, 12.0)]);
    assert_eq!(words, "radius of the centre of mass of load from the world's origin");
    assert_near(found, [16.0, -1.0]);
}

/// The load is what becomes heavier with the parameter: the log, not the claws around it; where a force acts; two halves in their middle.
#[test]
fn the_load_is_what_grows_with_its_parameter() {
    let claws = "links: [{name: grapple, joint: revolute, bodies: [{name: claws, mass: 140, com: [0, 0, 0], inertia: {gyration: [1, 1, 1]}}, {name: log, \
                 mass: payload, com: [0, -1.5, -2], inertia: {gyration: [1, 1, 1]}}]}]";
    let (words, found) = shown(claws, &[(0, 0.3)]);
    assert_eq!(words, "radius of the centre of mass of log from the world's origin");
    assert_near(found, [1.5, -2.0]);
    let halves = format!(
        "links: [{{name: one, joint: revolute, mass: payload, com: [1, 0, 0], {AXIS}}}, {{name: two, on: one, mass: payload, com: [3, 0, 2]}}]"
    );
    let (words, found) = shown(&halves, &[]);
    assert_eq!(words, "radius of the centre of mass of one and two from the world's origin");
    assert_near(found, [2.0, 1.0]);
    let pull = "format: 1\nname: crane\nparameters: {pull: {value: 300, unit: N}}\nlinks: [{name: arm, joint: revolute, mass: 5, com: [0, 0, 0], inertia: \
                {gyration: [1, 1, 1]}}]\nloads: [{name: hoist, link: arm, at: [3, 4, 1], force: [0, 0, pull]}]\n";
    let crane = LiveCrane::from_spec(&SourceFile::new("crane.yaml", pull)).unwrap_or_else(|wrong| panic!("\n{wrong}"));
    let reach = Reach::new(crane.chain(), crane.parameters(), Some(0), None);
    assert_eq!(reach.words(), "radius of the place of hoist from the world's origin");
    assert_near(reach.radius_and_height(&[0.0], crane.parameters()), [5.0, 1.0]);
}

/// The grapple of one arm, although the last link is a lamp on the other one; and the same with the arms in the other order.
#[test]
fn the_point_is_on_the_arm_that_carries_the_load() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../specs/two_arms.yaml");
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    let (crane, own) = reach(&source, None);
    let q = crane.chain().guess_at(crane.parameters());
    let (_, named) = reach(&source, Some("log_centre"));
    assert_eq!(own.words(), "radius of log_centre from the axis of column_psi");
    let found = own.radius_and_height(&q, crane.parameters());
    assert_eq!(found, named.radius_and_height(&q, crane.parameters()));

    let text = std::fs::read_to_string(path).expect("a shipped crane");
    let [boom, jib, supports] = ["  - name: boom", "  - name: jib", "supports:"].map(|key| text.find(key).expect(key));
    let other = [&text[..boom], &text[jib..supports], &text[boom..jib], &text[supports..]].concat();
    let other = other.replacen("  - name: boom ", "  - name: boom\n    on: column\n    # ", 1);
    let (exchanged, own) = reach(&SourceFile::new("two_arms.yaml", other), None);
    assert_eq!(own.words(), "radius of log_centre from the axis of column_psi");
    let q = exchanged.chain().guess_at(exchanged.parameters());
    assert_near(own.radius_and_height(&q, exchanged.parameters()), found);
}
