//! The cost of one-sided supports and of friction in all joints: at most a quarter of the forward dynamics without them.

use std::path::Path;

use crane_codegen::chain::Analyses;
use crane_codegen::{SourceFile, build, compile, read, validate};

/// Operations of the forward dynamics of a spec.
fn forward_dynamics(source: &SourceFile) -> usize {
    let chain = read(source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let analyses = Analyses { dynamics: true, ..chain.analyses };
    let report = compile::report(&chain, analyses);
    let cost = report.costs.iter().find(|cost| cost.function == "forward_dynamics").expect("forward dynamics");
    cost.operations.total()
}

#[test]
fn feet_that_lift_and_friction_cost_at_most_a_quarter() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/eight_link_flexible.yaml");
    let plain = build::open(&path).unwrap_or_else(|failure| panic!("{failure}"));
    // These are the names of the eight supports of the shipped crane; a new support would need a position.
    let feet = [1, 2, 3, 4, 5, 6, 7, 8].map(|foot| format!("  - {{name: s{foot}, one_sided: true}}\n")).concat();
    let joints =
        ["column_psi", "boom_psi", "outer_boom_psi", "telescope_z", "upper_hinge_psi", "rotator_psi", "grapple_psi"];
    let friction = joints.map(|joint| format!("  {joint}: {{coulomb: 100, breakaway: 130}}\n")).concat();
    let changed = plain.changed(&format!("supports:\n{feet}friction:\n{friction}"));
    let (without, with) = (forward_dynamics(&plain), forward_dynamics(&changed));
    assert!(4 * with <= 5 * without, "{with} operations for {without}");
}
