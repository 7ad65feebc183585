//! What feet that lift and friction in all joints cost: at most a quarter of the forward dynamics without them.

use std::path::Path;

use crane_codegen::chain::Analyses;
use crane_codegen::{SourceFile, compile, read, validate};

/// Operations of the forward dynamics of a spec.
fn forward_dynamics(text: String) -> usize {
    let source = SourceFile::new("eight_link_flexible.yaml", text);
    let chain =
        read(&source).and_then(|spec| validate(&spec, &source)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let analyses = Analyses { dynamics: true, ..chain.analyses };
    let report = compile::report(&chain, analyses);
    let cost = report.costs.iter().find(|cost| cost.function == "forward_dynamics").expect("forward dynamics");
    cost.operations.total()
}

#[test]
fn feet_that_lift_and_friction_cost_at_most_a_quarter() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/eight_link_flexible.yaml");
    let plain = std::fs::read_to_string(path).expect("a shipped spec");
    let feet = plain.replace("damping: [5e4, 5e4, 9e4]}", "damping: [5e4, 5e4, 9e4], one_sided: true}");
    assert_eq!(feet.matches("one_sided").count(), 8, "the shipped spec has eight supports");
    let joints =
        ["column_psi", "boom_psi", "outer_boom_psi", "telescope_z", "upper_hinge_psi", "rotator_psi", "grapple_psi"];
    let friction = joints.map(|joint| format!("  {joint}: {{coulomb: 100, breakaway: 130}}\n")).concat();
    let (without, with) = (forward_dynamics(plain), forward_dynamics(format!("{feet}\nfriction:\n{friction}")));
    assert!(4 * with <= 5 * without, "{with} operations for {without}");
}
