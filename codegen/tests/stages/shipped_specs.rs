//! Every shipped spec is valid, and the reference crane is the one that the documentation describes.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

use crane_codegen::chain::{Chain, CoordinateKind, Inertia, Profile, Step, Value};
use crane_codegen::{SourceFile, build, json_schema, read, validate};

/// The folder of shipped specs.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs")
}

/// A shipped spec as a chain; its mistakes fail the test.
fn chain(name: &str) -> Chain {
    let source = build::open(&folder().join(format!("{name}.yaml"))).unwrap_or_else(|failure| panic!("{failure}"));
    read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Names of all shipped specs.
fn names() -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .expect("the folder of specs")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "yaml"))
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Mass of the whole crane, kg.
fn mass(chain: &Chain) -> f64 {
    let masses = chain.bodies.iter().filter_map(|body| body.inertia.as_ref());
    masses.map(|inertia| inertia.mass.at(&chain.parameter_defaults())).sum()
}

#[test]
fn every_shipped_spec_is_sound() {
    for name in names() {
        let chain = chain(&name);
        assert_eq!(chain.name, name, "named as its file");
        assert_eq!(chain.guess.len(), chain.coordinates.len());
    }
}

#[test]
fn reference_crane() {
    let chain = chain("eight_link_flexible");
    assert_eq!(chain.coordinates.len(), 13 + 3 * 4);
    assert_eq!(chain.bodies.len(), 8 + 4);
    assert_eq!(chain.supports.len(), 8);
    assert_eq!(chain.drives.len(), 5);
    assert_eq!(chain.element_springs().count(), 12);
    let names: Vec<&str> = chain.coordinates.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        names[..8],
        ["truck_x", "truck_y", "truck_z", "truck_psi", "truck_theta", "truck_phi", "column_psi", "boom_psi"]
    );
    assert_eq!(names[8..11], ["boom_1_psi", "boom_1_theta", "boom_1_phi"]);
    assert_eq!(names[20..], ["outer_boom_psi", "telescope_z", "upper_hinge_psi", "rotator_psi", "grapple_psi"]);
    // 15000 + 515.5 + 408.1 + 335 + 224 + 15 + 55 + 276 + 500 kg, up to rounding.
    assert!((mass(&chain) - 17_328.6).abs() < 1e-8, "{}", mass(&chain));

    // The stiffness E J_z/d, with J_z known to five digits, and the damping β s.
    let spring = chain.element_springs().next().expect("a flexible link");
    let (stiffness, damping) = (spring.stiffness.at(&[]), spring.damping.at(&[]));
    assert!((stiffness / 1.5348e7 - 1.0).abs() < 1e-4, "{stiffness}");
    assert!((damping / stiffness / 1.5e-3 - 1.0).abs() < 1e-15);
    assert_eq!(chain.bodies[2].name, "boom_0");
    assert_eq!(chain.bodies[7].path[0], Step::Translate([0.4375.into(), 0.0.into(), 0.0.into()]));

    // A driven coordinate starts at its drive's position, one with a guess at its guess.
    assert_eq!(chain.guess[20..23].to_vec(), vec![FRAC_PI_2, 2.0, PI]);
    let Profile::Quintic(ramp) = &chain.drives[1].profile else { panic!("not quintic") };
    assert_eq!(ramp.to, Value::Constant(7.0 * PI / 18.0));
}

#[test]
fn the_load_stays_live() {
    let chain = chain("eight_link_flexible");
    let Some(Inertia { mass, second, .. }) = &chain.bodies.last().expect("a grapple").inertia else {
        panic!("no mass")
    };
    for (load, whole) in [(500.0, 776.0), (0.0, 276.0)] {
        assert!((mass.at(&[load]) - whole).abs() < 1e-12);
    }
    // ∫z² of the log about the grapple's origin: ½(11 + 672 − 672) + 500 · 1² at six digits of the radii.
    let log = second[2].at(&[500.0]) - second[2].at(&[0.0]);
    assert!((log - (5.5 + 500.0)).abs() < 2e-4, "{log}");
}

#[test]
fn the_schema_is_current() {
    let path = folder().join("crane.schema.json");
    if std::env::var_os("UPDATE_SCHEMA").is_some() {
        std::fs::write(&path, json_schema()).expect("a writable schema");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(committed == json_schema(), "specs/crane.schema.json is not current: run this test with UPDATE_SCHEMA=1");
}

#[test]
fn every_spec_names_its_schema() {
    for name in names() {
        let text = std::fs::read_to_string(folder().join(format!("{name}.yaml"))).expect("a shipped spec");
        assert_eq!(text.lines().next(), Some("# yaml-language-server: $schema=crane.schema.json"), "{name}");
    }
}

type Vector = [f64; 3];

/// World position of a point at the guess, elements undeformed.
fn position(chain: &Chain, name: &str) -> Vector {
    let parameters = chain.parameter_defaults();
    let point = chain.points.iter().find(|point| point.name == name).expect("a point");
    // From the point back to the world: each step transforms it into the frame before.
    let mut r = point.position.each_ref().map(|v| v.at(&parameters));
    let turn = |r: &mut Vector, axis: usize, (sin, cos): (f64, f64)| {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        (r[a], r[b]) = (cos * r[a] - sin * r[b], sin * r[a] + cos * r[b]);
    };
    for step in chain.bodies[..=point.body.0].iter().flat_map(|body| &body.path).rev() {
        match step {
            Step::Translate(by) => by.iter().zip(&mut r).for_each(|(by, r)| *r += by.at(&parameters)),
            Step::Rotate { axis, sin, cos } => turn(&mut r, axis.index(), (sin.at(&parameters), cos.at(&parameters))),
            Step::RotationVector(ids) => assert!(ids.iter().all(|id| chain.guess[id.0] == 0.0), "elements undeformed"),
            Step::Move(id) => {
                let (coordinate, q) = (&chain.coordinates[id.0], chain.guess[id.0]);
                match coordinate.kind {
                    CoordinateKind::Translation => r[coordinate.axis.index()] += q,
                    CoordinateKind::Rotation => turn(&mut r, coordinate.axis.index(), q.sin_cos()),
                }
            }
        }
    }
    r
}

/// Agreement of positions of about ten metres after a few dozen rotations.
const ROUNDING: f64 = 1e-13;

fn assert_same(a: Vector, b: Vector) {
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING * 10.0), "{a:?} {b:?}");
}

#[test]
fn undeformed_variants_of_the_reference_crane_are_one_crane() {
    let reference = chain("eight_link_flexible");
    for name in ["eight_link_rigid", "eight_link_identified", "eight_link_two_flexible"] {
        let variant = chain(name);
        assert!((mass(&variant) - mass(&reference)).abs() < 1e-3, "{name}: masses are written to 0.1 g/m");
        for point in ["log_left", "log_middle", "log_right"] {
            assert_same(position(&variant, point), position(&reference, point));
        }
    }
    // Also with the telescope, the outer boom and the column elsewhere, so that it slides along the same line.
    let [mut a, mut b] = [reference, chain("eight_link_two_flexible")];
    for chain in [&mut a, &mut b] {
        for (coordinate, q) in chain.coordinates.iter().zip(&mut chain.guess) {
            match coordinate.name.as_str() {
                "telescope_z" => *q = 1.25,
                "outer_boom_psi" => *q = 0.9,
                "column_psi" => *q = 0.4,
                _ => {}
            }
        }
    }
    assert_same(position(&a, "log_left"), position(&b, "log_left"));
}

#[test]
fn loads_hang_at_the_guess() {
    // Column 2.4 m high, 3.5 m of boom, 2.2 + 2 m of outer boom and telescope, then hinge, rotator and log below.
    let log = position(&chain("eight_link_flexible"), "log_middle");
    assert_same(log, [3.5 + 2.2 + 2.0, 0.0, 2.4 - 0.223 - 0.34 - 1.0]);
    let knuckle = chain("knuckle_boom");
    let (tip, load) = (position(&knuckle, "boom_tip"), position(&knuckle, "load_centre"));
    assert_same(load, [tip[0], 0.0, tip[2] - 1.2]);
}

#[test]
fn points_of_a_beam_belong_to_the_element_that_holds_them() {
    let chain = chain("cantilever");
    // Elements of 0.125, 0.25, ... m: x = 1 m is in the middle of element 4, which begins at 0.875 m.
    assert_eq!(chain.bodies[chain.points[0].body.0].name, "beam_4");
    assert_eq!(chain.points[0].position, [0.125, 0.0, 0.0].map(Value::from));
}

/// Statics begin where couplings put what follows, whatever their order: c = 0.3 + 2 b, b = 0.1 − 0.5 a, a = 0.4. A written guess is kept.
#[test]
fn what_follows_begins_where_its_coupling_puts_it() {
    let links = ["a", "b", "c", "d"]
        .map(|name| format!("  - {{name: {name}, joint: {{prismatic: {{axis: x}}}}, mass: 10, com: [0, 0, 0]}}\n"));
    let coupled = |name: &str, follows: &str, law: &str| {
        format!("  - {{name: {name}_chain, coordinate: {name}_x, follows: {follows}_x, {law}, stiffness: 1e5}}\n")
    };
    let text = format!(
        "format: 1\nname: chain\nlinks:\n{}couplings:\n{}{}{}guess: {{d_x: 7}}\n\
         drives: [{{coordinate: a_x, stiffness: 1e5, motion: {{quintic: {{from: 0.4, to: 1, duration: 2}}}}}}]\n",
        links.concat(),
        coupled("c", "b", "ratio: 2, offset: 0.3"),
        coupled("b", "a", "ratio: -0.5, offset: 0.1"),
        coupled("d", "a", "ratio: 1"),
    );
    let source = SourceFile::new("chain.yaml", text);
    let chain = read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let expected = [0.4, 0.1 - 0.5 * 0.4, 0.3 + 2.0 * (0.1 - 0.5 * 0.4), 7.0];
    assert!(
        chain.guess.iter().zip(expected).all(|(guess, expected)| (guess - expected).abs() < 1e-15),
        "{:?}",
        chain.guess
    );
}
