//! Equilibria of the shipped cranes, and limits that they must tend to.

use crane_tests::interpreted::Interpreted;
use crane_tests::registry;
use crane_tests::workspace;

fn weight(crane: &Interpreted) -> f64 {
    let parameters = crane.chain.parameter_defaults();
    let mass: f64 = crane.chain.bodies.iter().filter_map(|b| b.inertia.as_ref()).map(|i| i.mass.at(&parameters)).sum();
    9.81 * mass
}

#[test]
fn support_reactions_add_up_to_the_weight() {
    for name in ["eight_link_rigid", "eight_link_flexible", "eight_link_identified", "eight_link_two_flexible"] {
        let crane = Interpreted::new(workspace::chain(name));
        let state = crane.equilibrium();
        let reactions = crane.get("support_reactions", &crane.inputs(&state), 0);
        let total = |axis: usize| reactions.iter().skip(axis).step_by(3).sum::<f64>();
        let weight = weight(&crane);
        // Newton's method ends at the rounding error of the springs' forces, 1e5 N each.
        assert!((total(2) / weight - 1.0).abs() < 1e-10, "{name}: {} against {weight} N", total(2));
        assert!(total(0).abs() < 1e-10 * weight && total(1).abs() < 1e-10 * weight, "{name}");
    }
}

/// The runtime's Newton method on generated code against a plain one on the interpreter.
#[test]
fn the_runtime_finds_the_same_equilibria() {
    // A plain Newton method does not find which feet are in contact.
    let lifts = |name: &str| name == "eight_link_hydraulic";
    for entry in registry::all().into_iter().filter(|e| e.name.starts_with("eight_link") && !lifts(e.name)) {
        let found = (entry.crane)().equilibrium(&crane_model::statics::Settings::default());
        let expected = Interpreted::new(workspace::chain(entry.name)).equilibrium();
        for (a, b) in found.q.iter().zip(&expected.q) {
            // The error is a residual of rounding size over the smallest stiffness.
            assert!((a - b).abs() < 1e-9, "{}: {a} against {b}", entry.name);
        }
    }
}

/// The stiffer the boom, the closer to the rigid crane: the difference falls as 1/E.
#[test]
fn a_stiff_boom_tends_to_the_rigid_crane() {
    let reference = workspace::shipped("eight_link_flexible");
    let tip = |changes: &str| {
        let crane = Interpreted::new(workspace::chain_in(&reference.changed(changes)));
        crane.get("points", &crane.inputs(&crane.equilibrium()), 0)[5]
    };
    let rigid = tip("links: [{name: boom, beam: {sections: rigid}}]");
    let deflection = |factor: f64| {
        let (e, g) = (2.1e11 * factor, 8.1e10 * factor);
        tip(&format!("materials: {{steel: {{E: {e:?}, G: {g:?}}}}}")) - rigid
    };
    let (soft, stiff, stiffer) = (deflection(1.0), deflection(1e2), deflection(1e4));
    assert!(soft < -1e-3, "the flexible boom hangs lower: {soft} m");
    for ratio in [soft / stiff, stiff / stiffer] {
        // Second order of small angles; 1e-6 m is still far above rounding.
        assert!((ratio / 100.0 - 1.0).abs() < 0.02, "{soft} {stiff} {stiffer}");
    }
}
