//! Every shipped spec is sound, and the reference crane is the one that the documentation describes.

use std::path::{Path, PathBuf};

use crane_codegen::chain::{Chain, Inertia, Profile, Step};
use crane_codegen::{SourceFile, json_schema, read, validate};

/// The folder of shipped specs.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs")
}

/// A shipped spec as a chain; its mistakes fail the test.
fn chain(name: &str) -> Chain {
    let text = std::fs::read_to_string(folder().join(format!("{name}.yaml"))).expect("a shipped spec");
    let source = SourceFile::new(format!("specs/{name}.yaml"), text);
    read(&source).and_then(|spec| validate(&spec, &source)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
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
    assert_eq!(chain.elements.len(), 12);
    let names: Vec<&str> = chain.coordinates.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names[..8], ["truck_x", "truck_y", "truck_z", "truck_psi", "truck_theta", "truck_phi", "column_psi", "boom_psi"]);
    assert_eq!(names[8..11], ["boom_1_psi", "boom_1_theta", "boom_1_phi"]);
    assert_eq!(names[20..], ["outer_boom_psi", "telescope_z", "upper_hinge_psi", "rotator_psi", "grapple_psi"]);
    // 15000 + 515.5 + 408.1 + 335 + 224 + 15 + 55 + 276 + 500 kg, to rounding.
    assert!((mass(&chain) - 17_328.6).abs() < 1e-8, "{}", mass(&chain));

    // E J_z/d, with J_z known to five digits; β s beside it.
    let spring = &chain.elements[0];
    let (stiffness, damping) = (spring.stiffness.at(&[]), spring.damping.at(&[]));
    assert!((stiffness / 1.5348e7 - 1.0).abs() < 1e-4, "{stiffness}");
    assert!((damping / stiffness / 1.5e-3 - 1.0).abs() < 1e-15);
    assert_eq!(chain.bodies[2].name, "boom_0");
    assert_eq!(chain.bodies[7].path[0], Step::Translate([0.4375.into(), 0.0.into(), 0.0.into()]));

    // A driven coordinate starts at its drive, a given one where it is given.
    assert_eq!(chain.guess[20], std::f64::consts::FRAC_PI_2);
    assert_eq!(chain.guess[21], 2.0);
    assert_eq!(chain.guess[22], std::f64::consts::PI);
    assert!(matches!(&chain.drives[1].profile, Profile::Quintic(ramp) if ramp.to.at(&[]) == 7.0 * std::f64::consts::PI / 18.0));
}

#[test]
fn the_load_stays_live() {
    let chain = chain("eight_link_flexible");
    let Some(Inertia { mass, second, .. }) = &chain.bodies.last().expect("a grapple").inertia else { panic!("no mass") };
    assert_eq!((mass.at(&[500.0]), mass.at(&[0.0])), (776.0, 276.0));
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
