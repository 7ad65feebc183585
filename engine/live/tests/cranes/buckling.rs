//! Critical factors of weight and loads against columns and beams in closed form.

use std::f64::consts::PI;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::envelope::{Followed, LoadFactor, SecondOrder, load_factor, second_order};

fn factors(text: String) -> LoadFactor {
    let crane = LiveCrane::from_spec(&SourceFile::new("buckling.yaml", text)).expect("a crane");
    let (mut crane, parameter) = crane.with_load_factor();
    load_factor(&mut crane, parameter).expect("a crane at rest")
}

/// A post of a slender tube without weight, 6 m high, and a force in newtons at its top.
fn post(sections: usize, force: [f64; 3]) -> String {
    format!(
        "format: 1\nname: post\nanalyses: [statics, dynamics]\ngravity: [0, 0, 0]\nlinks:\n  - name: post\n    placement: {{transform: {{rotation: {{y: -90 \
         deg}}}}}}\n    beam:\n      length: 6\n      sections: {sections}\n      material: {{E: 2.1e11, G: 8.1e10, density: 100}}\n      section: {{tube: \
         {{diameter: 0.06, thickness: 0.003}}}}\nloads:\n  - {{name: top, link: post, at: [6, 0, 0], force: {force:?}}}\n"
    )
}

/// `E π (D⁴ − d⁴)/64` of the tube.
fn bending_stiffness() -> f64 {
    2.1e11 * PI * (0.06_f64.powi(4) - 0.054_f64.powi(4)) / 64.0
}

/// A column that is fixed at its foot buckles at `π² E J/(4 L²)`; the error of equal sections falls with their square.
#[test]
fn a_column_buckles_at_eulers_load() {
    let euler = PI.powi(2) * bending_stiffness() / (4.0 * 36.0);
    let error = |sections: usize| {
        let LoadFactor { linearised, followed } = factors(post(sections, [0.0, 0.0, -0.1 * euler]));
        let linearised = linearised.expect("it buckles");
        let Followed { factor, .. } = followed.expect("it buckles");
        // It is straight until it buckles.
        assert!((factor / linearised - 1.0).abs() < 1e-4, "{factor} {linearised}");
        linearised / 10.0 - 1.0
    };
    let [four, eight, sixteen] = [4, 8, 16].map(error);
    assert!(eight.abs() < 0.01, "{eight}");
    for ratio in [four / eight, eight / sixteen] {
        assert!((ratio - 4.0).abs() < 0.1, "{four} {eight} {sixteen}");
    }
}

/// A pull does not make it buckle.
#[test]
fn a_column_that_is_pulled_does_not_buckle() {
    assert_eq!(factors(post(8, [0.0, 0.0, 1000.0])), LoadFactor { linearised: None, followed: None });
}

/// A cantilever of a narrow section tips sideways at `4.0126 √(E J_z G J_x)/L²` under a force at its end.
/// \[S. Timoshenko, J. M. Gere, Theory of Elastic Stability, 1961, section 6.3]
#[test]
fn a_narrow_cantilever_buckles_sideways() {
    let (length, bending, torsion) = (4.0_f64, 1e4_f64, 5e3_f64);
    let critical = 4.0126 * (bending * torsion).sqrt() / length.powi(2);
    // So stiff in its own plane that it stays straight until then.
    let text = |sections: usize| {
        format!(
            "format: 1\nname: cantilever\nanalyses: [statics, dynamics]\ngravity: [0, 0, 0]\nlinks:\n  - name: beam\n    beam:\n      length: {length}\n      \
             sections: {sections}\n      section: {{numbers: {{area: 1e-3, Jy: {}, Jz: {}, Jo: {}}}}}\n      material: {{E: 1e11, G: \
             1e11, density: 1000}}\nloads:\n  - {{name: tip, link: beam, at: [{length}, 0, 0], force: [0, 0, {}]}}\n",
            1e10 / 1e11,
            bending / 1e11,
            torsion / 1e11,
            -0.2 * critical,
        )
    };
    let error = |sections: usize| factors(text(sections)).linearised.expect("it buckles") / 5.0 - 1.0;
    let [eight, sixteen] = [8, 16].map(error);
    assert!(eight.abs() < 0.01, "{eight} {sixteen}");
    assert!(sixteen.abs() < 0.3 * eight.abs() + 1e-4, "{eight} {sixteen}");
}

/// A beam that a cylinder holds buckles with the same factor whatever stands beside it, also where its drive is no longer the first coordinate.
#[test]
fn the_order_of_coordinates_does_not_move_a_factor() {
    let beam = |name: &str, rest: &str| {
        format!(
            "  - name: {name}\n    on: base\n{rest}    beam: {{length: 4, sections: 2, material: {{E: 2.1e11, G: 8.1e10, density: 7850}}, section: {{tube: \
             {{diameter: 0.1, thickness: 0.004}}}}}}\n"
        )
    };
    let crane = |others: &[String]| {
        let boom = beam("boom", "    joint: revolute\n");
        format!(
            "format: 1\nname: held\nanalyses: [statics, dynamics]\ngravity: [0, -9.81, 0]\nlinks:\n  - {{name: base, joint: fixed}}\n{}{boom}\
             drives: [{{coordinate: boom_psi, motion: {{hold: 0.6}}, stiffness: 2e6, damping: 1e4}}]\ncylinders:\n  - {{name: lift, coordinate: boom_psi, bore: 0.1, \
             rod: 0.05, retracted: 0.8, stroke: 0.7, foot: {{link: base, at: [0.2, -0.6, 0]}}, head: {{link: boom, at: [1.3, 0, 0]}}, bulk_modulus: 1.2e9, max_pressure: 28e6, \
             hose_volumes: [1e-3, 1e-3], valve: {{flow: 6e-4, pressure_drop: 1e6, lag: 0.03, gain: 2}}}}\npump: {{pressure: 2e7, max_flow: 1e-3}}\nloads:\n  - {{name: push, link: boom, at: [4, 0, \
             0], axes: link, force: [-3e4, 0, 0]}}\n",
            others.concat()
        )
    };
    let alone = factors(crane(&[])).linearised.expect("it buckles");
    let beside = factors(crane(&[beam("mast", "    joint: fixed\n")])).linearised.expect("it buckles");
    assert!((beside / alone - 1.0).abs() < 1e-9, "{alone} alone, {beside} beside a mast");
}

/// A force of 20 mN bends a post by its lever arm, in both orders.
#[test]
fn the_first_order_of_a_light_force_is_its_lever_arm() {
    let crane = LiveCrane::from_spec(&SourceFile::new("post.yaml", post(4, [0.02, 0.0, 0.0]))).expect("a crane");
    let (mut crane, parameter) = crane.with_load_factor();
    let SecondOrder { beams, .. } = second_order(&mut crane, parameter).expect("a crane at rest");
    // Extrapolated from parts of 1e-4, of which statics know ten digits.
    assert!(beams[0].1.iter().all(|moment| (moment / 0.12 - 1.0).abs() < 1e-5), "{beams:?}");
}

/// A column with a force across its top: with `u = L √(P/EJ)`, the deflection is `3 (tan u − u)/u³` times that of the first order, `H L³/3EJ`, and the moment at its
/// foot `tan u/u` times `H L`. Near Euler's load both become `1/(1 − P/P_cr)`. \[S. Timoshenko, J. M. Gere, Theory of Elastic Stability, 1961, section 1.3]
#[test]
fn the_second_order_of_a_column_is_that_of_timoshenko() {
    let (stiffness, length, across) = (bending_stiffness(), 6.0, 20.0);
    let euler = PI.powi(2) * stiffness / (4.0 * length * length);
    for part in [0.1, 0.5] {
        let text = post(16, [across, 0.0, -part * euler]) + "points: [{name: top, link: post, at: [6, 0, 0]}]\n";
        let crane = LiveCrane::from_spec(&SourceFile::new("column.yaml", text)).expect("a crane");
        let (mut crane, parameter) = crane.with_load_factor();
        let SecondOrder { points, beams } = second_order(&mut crane, parameter).expect("a crane at rest");
        let description = (&crane as &dyn DynCrane).description();
        let (place, moments) = beams[0];
        assert!(place.x == 0.0 && place.beam(description) == "post", "{place:?}");
        let u = length * (part * euler / stiffness).sqrt();
        let of_deflection = 3.0 * (u.tan() - u) / u.powi(3);
        // The top also sinks, by squares of its angle; 16 sections buckle at 0.25 % of Euler's load away.
        let deflection = across * length.powi(3) / (3.0 * stiffness);
        let [first, second] = points[0].map(|moved| moved.x);
        for (value, exact, tolerance) in [
            (first, deflection, 2e-3),
            (second / first, of_deflection, 5e-3),
            (moments[0], across * length, 1e-3),
            (moments[1] / moments[0], u.tan() / u, 5e-3),
        ] {
            assert!((value / exact - 1.0).abs() < tolerance, "{part}: {value}, not {exact}");
        }
        assert!((of_deflection * (1.0 - part) - 1.0).abs() < 0.02, "the rule of thumb");
    }
}
