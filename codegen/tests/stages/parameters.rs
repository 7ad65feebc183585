//! Live parameters obey the rules of every place where they are used, for any value to which they are set.

use crane_codegen::chain::Chain;
use crane_codegen::{SourceFile, read, validate};

/// Cranes with a parameter `p` in various places, one spec per place: `P` is replaced by the parameter or a number.
const USES: [(&str, &str); 16] = [
    ("mass of a link", "links: [{name: arm, joint: revolute, mass: P, com: [1, 0, 0]}]"),
    (
        "one mass of two",
        "links: [{name: arm, joint: revolute, bodies: [{name: a, mass: 5, com: [1, 0, 0]}, {name: b, mass: P, com: [1, 0, 0]}]}]",
    ),
    ("centre of mass", "links: [{name: arm, joint: prismatic, mass: 5, com: [P, 0, 0]}]"),
    (
        "length",
        "links: [{name: arm, beam: {length: P, sections: 1, material: {E: 2e11, G: 8e10, density: 7850}, section: {circle: {diameter: 0.1}}}}]",
    ),
    (
        "modulus",
        "links: [{name: arm, beam: {length: 2, sections: 1, material: {E: P, G: 8e10, density: 7850}, section: {circle: {diameter: 0.1}}}}]",
    ),
    (
        "density",
        "links: [{name: arm, beam: {length: 2, sections: 1, material: {E: 2e11, G: 8e10, density: P}, section: {circle: {diameter: 0.1}}}}]",
    ),
    (
        "diameter",
        "links: [{name: arm, beam: {length: 2, sections: 1, material: {E: 2e11, G: 8e10, density: 7850}, section: {circle: {diameter: P}}}}]",
    ),
    (
        "thickness",
        "links: [{name: arm, beam: {length: 2, sections: 1, material: {E: 2e11, G: 8e10, density: 7850}, section: {tube: {diameter: 0.1, thickness: P}}}}]",
    ),
    (
        "extra mass",
        "links: [{name: arm, beam: {length: 2, sections: 1, material: {E: 2e11, G: 8e10, density: 7850}, section: {circle: {diameter: 0.1}}, extra_mass: P}}]",
    ),
    (
        "beta",
        "links: [{name: arm, beam: {length: 2, sections: 1, material: {E: 2e11, G: 8e10, density: 7850}, section: {circle: {diameter: 0.1}}, damping: {beta: P}}}]",
    ),
    (
        "length of an element",
        "links: [{name: arm, beam: {length: 2, elements: [{length: P, mass: 5, com: [0.5, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}, {length: 1, mass: 5, com: [0.5, 0, 0], inertia: {gyration: [0.1, 0.3, 0.3]}}], springs: [{stiffness: {psi: 1e6, theta: 1e6, phi: 1e6}}]}}]",
    ),
    (
        "stiffness of a drive",
        "links: [{name: arm, joint: prismatic, mass: 5, com: [0, 0, 0]}]\ndrives: [{coordinate: arm_z, stiffness: P, motion: {hold: 0}}]",
    ),
    ("damping of a joint", "links: [{name: arm, joint: prismatic, mass: 5, com: [0, 0, 0]}]\ndamping: {arm_z: P}"),
    (
        "duration",
        "links: [{name: arm, joint: prismatic, mass: 5, com: [0, 0, 0]}]\ndrives: [{coordinate: arm_z, stiffness: 1e6, motion: {quintic: {from: 0, to: 1, duration: P}}}]",
    ),
    ("gravity", "gravity: [0, 0, P]\nlinks: [{name: arm, joint: prismatic, mass: 5, com: [0, 0, 0]}]"),
    (
        "radius of gyration",
        "links: [{name: arm, joint: prismatic, mass: 5, com: [0, 0, 0], inertia: {gyration: [1, 1, P]}}]",
    ),
];

/// The chain of a spec, or the codes of its mistakes.
fn chain(text: &str) -> Result<Chain, Vec<&'static str>> {
    let source = SourceFile::new("test.yaml", text);
    read(&source)
        .and_then(|spec| validate(&spec))
        .map_err(|diagnostics| diagnostics.mistakes().iter().map(|mistake| mistake.code).collect())
}

/// The code of the rule in a chain that refuses a value of its only parameter, if there is one.
fn refused(chain: &Chain, value: f64) -> Option<&str> {
    let lower = chain.parameters[0].lower_bound.as_ref();
    let below = lower.filter(|lower| value < lower.value || (value == lower.value && !lower.allowed));
    let below = below.map(|lower| &lower.refusal);
    below.or_else(|| Some(&chain.broken_relation(&[value])?.refusal)).map(|refusal| refusal.code.as_str())
}

#[test]
fn a_value_is_refused_at_run_time_where_the_spec_refuses_it() {
    for (subject, spec) in USES {
        // A valid value in every place.
        let sound = if subject == "thickness" { 0.01 } else { 1.0 };
        let live = |default: f64| {
            format!("format: 1\nname: test\nparameters: {{p: {{value: {default:?}}}}}\n{}", spec.replace('P', "p"))
        };
        let compiled = chain(&live(sound)).unwrap_or_else(|codes| panic!("{subject}: {codes:?}"));
        for value in [-1e3, -1.0, -1e-6, 0.0, 1e-6, 0.04, 0.06, 1.0, 2.0, 1e3] {
            let written = chain(&live(value));
            let refused = refused(&compiled, value);
            assert_eq!(refused.is_some(), written.is_err(), "{subject} = {value}: {refused:?}, {written:?}");
            if let (Some(code), Err(codes)) = (refused, written) {
                // For a mass that cannot be zero, a spec reports that it is negative, or that the joint moves nothing (E046).
                let mass = subject == "mass of a link" && code == "E031" && matches!(codes[..], ["E032" | "E046"]);
                assert!(mass || codes.contains(&code), "{subject} = {value}: {code}, {codes:?}");
            }
        }
    }
}

#[test]
fn the_strictest_of_several_places_counts() {
    let spec = "format: 1\nname: test\nparameters: {p: {value: 1}}\n\
        links: [{name: arm, joint: revolute, mass: 5, com: [p, 0, 0]}]\n\
        damping: {arm_psi: p}\n\
        drives: []\nrun: {duration: 1, step: 1e-3}\ngravity: [p, 0, 0]\n";
    let lower = chain(spec).expect("a sound spec").parameters.remove(0).lower_bound.expect("damping is not below zero");
    assert_eq!((lower.value, lower.allowed, lower.refusal.code.as_str()), (0.0, true, "E032"));
    assert_eq!(lower.refusal.title, "the damping of `arm_psi` must not be negative, but is");
    assert_eq!(lower.refusal.help, "write 0 or a positive number, in N m s/rad");
}

/// What a rule compares may be equal: one result and one step of a run.
#[test]
fn equal_numbers_are_allowed() {
    let text = "format: 1\nname: equal\nlinks: [{name: arm, joint: prismatic, mass: 5, com: [0, 0, 0]}]\nrun: {duration: 2, output: 2, step: 2}\n";
    if let Err(mistakes) = crane_codegen::compile::check(&SourceFile::new("equal.yaml", text)) {
        panic!("{mistakes}");
    }
}

/// What is not written of a cylinder has no pressure and no volume.
#[test]
fn what_is_not_written_of_a_cylinder_is_nothing() {
    let text = "format: 1\nname: lift\nlinks: [{name: post, joint: fixed}, {name: arm, joint: revolute, mass: 5, com: [1, 0, 0]}]\n\
                drives: [{coordinate: arm_psi, stiffness: 1e6, motion: {hold: 0}}]\n\
                cylinders: [{name: lift, coordinate: arm_psi, bore: 0.1, rod: 0.05, retracted: 0.8, stroke: 0.7, foot: {link: post, at: [0.2, -0.6, 0]}, \
                head: {link: arm, at: [1.3, 0, 0]}}]\n";
    let checked = crane_codegen::compile::check(&SourceFile::new("lift.yaml", text))
        .unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let lift = &checked.chain.cylinders[0];
    assert_eq!((lift.back_pressure, lift.hose_volumes), (0.0, [0.0; 2]));
}
