//! What a crane does not need is left out of its generated code.

use crane_codegen::chain::{Analyses, Axis};
use crane_codegen::compile;
use crane_codegen::program::FunctionId;
use crane_codegen::symbolic::Op;
use crane_tests::interpreted::Interpreted;
use crane_tests::workspace;

/// Generated text for the spec's own analyses.
fn text(name: &str) -> String {
    let chain = workspace::chain(name);
    compile::generate(&chain, chain.analyses, "spec.yaml").text
}

fn assert_absent(name: &str, words: &[&str]) {
    let text = text(name);
    let code: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    for word in words {
        assert!(!code.iter().any(|line| line.contains(word)), "{name} holds `{word}`");
    }
}

#[test]
fn a_rigid_scene_holds_no_element_code() {
    assert_absent("eight_link_rigid", &["element_forces", "element_energy", "boom_1", "CoordinateRole::Element"]);
    assert!(text("eight_link_flexible").contains("fn element_forces"), "the check can fail");
}

#[test]
fn a_scene_without_supports_holds_none_of_theirs() {
    assert_absent("knuckle_boom", &["support_forces", "support_reactions", "support_energy", "truck"]);
    assert!(text("eight_link_rigid").contains("fn support_forces"), "the check can fail");
}

#[test]
fn a_dynamics_scene_holds_no_tangent_stiffness_and_no_derivatives() {
    assert_absent(
        "double_pendulum",
        &["tangent_stiffness", "static_residual", "linearise", "transform_derivatives", "transform_second_derivatives"],
    );
    assert!(text("double_pendulum").contains("fn mass_matrix"));
}

/// All rotations about one axis of the world: no rotation matrix mixes that axis with the others, nothing moves along it.
#[test]
fn a_planar_scene_holds_nothing_out_of_its_plane() {
    for name in ["knuckle_boom", "double_pendulum"] {
        let crane = Interpreted::new(workspace::chain(name));
        let program = &crane.program;
        let transforms = &program.function(FunctionId::Transforms).unwrap().outputs;
        let constant = |slot: usize| matches!(program.op(transforms[slot]), Op::Constant(_));
        let planes: Vec<Axis> = [Axis::X, Axis::Y, Axis::Z]
            .into_iter()
            .filter(|axis| {
                (0..crane.chain.bodies.len()).all(|p| (0..4).all(|k| constant(12 * p + 4 * axis.index() + k)))
            })
            .collect();
        assert_eq!(planes.len(), 1, "{name}: the row of the normal is constant in every pose");
        // A planar crane costs a fraction of the same chain in space.
        let report = compile::report(&crane.chain, Analyses::ALL);
        let mass_matrix = report.costs.iter().find(|c| c.function == "mass_matrix").unwrap();
        let (kept, all) = (mass_matrix.operations.total(), mass_matrix.verbatim.total());
        assert!(3 * kept < all, "{name}: {kept} of {all} operations");
    }
}

#[test]
fn the_header_says_what_is_left_out_and_why() {
    let text = text("double_pendulum");
    assert!(text.contains("//   supports: the spec has none\n"));
    assert!(text.contains("//   static residual and tangent stiffness: `analyses` does not include statics\n"));
}

/// The feet of the reference crane are symmetric about x = 0: terms that cancel are left out, rather than kept as rounding errors.
#[test]
fn symmetric_supports_couple_nothing_by_rounding() {
    let crane = Interpreted::new(workspace::chain("eight_link_rigid"));
    let forces = crane.program.function(FunctionId::SupportForces).unwrap();
    let needed = crane.program.needed(forces.outputs.iter().copied());
    let smallest = crane
        .program
        .ids()
        .filter(|id| needed[id.index()])
        .filter_map(|id| match crane.program.op(id) {
            Op::Constant(c) if c.value() != 0.0 => Some(c.value().abs()),
            _ => None,
        })
        .fold(f64::INFINITY, f64::min);
    // The smallest true coefficient is a damping of 8 · 5e4 · 0.57 N s.
    assert!(smallest > 1e5, "a coefficient of {smallest}");
}
