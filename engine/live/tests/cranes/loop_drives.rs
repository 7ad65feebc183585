//! Drives that hold a loop too little or too much.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::force_states::ForceStates;
use crane_model::runs::Start;
use crane_model::{StateAt, force_states, loop_joints, statics};

/// A four-bar whose pins on the ground are 1.2 m apart.
fn four_bar(more: &str) -> LiveCrane {
    let bar = |name: &str, placement: &str, length: f64, mass: f64| {
        format!(
            "- {{name: {name}, placement: {{transform: {{{placement}}}}}, joint: revolute, mass: {mass}, com: [{}, 0, 0], inertia: {{gyration: [0.1, {g}, {g}]}}}}\n",
            0.5 * length,
            g = 0.3 * length
        )
    };
    let text = format!(
        "format: 1\nname: bars\nlinks:\n{}{}{}\
         loop_joints: [{{name: hinge, from: {{at: [1.2, 0, 0]}}, to: {{link: rocker, at: [0.9, 0, 0]}}, joint: {{slide: {{axis: [0, 1, 0]}}}}}}]\n{more}\n",
        bar("crank", "rotation: {x: 90 deg}", 0.4, 30.0),
        bar("coupler", "translation: [0.4, 0, 0]", 1.1, 80.0),
        bar("rocker", "translation: [1.1, 0, 0]", 0.9, 60.0),
    );
    LiveCrane::from_spec(&SourceFile::new("bars.yaml", text.as_str()))
        .unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// Angles of coupler and rocker on the crank and on the coupler, with the crank at θ: triangles of the crank's end and both ends of the rocker.
fn angles(theta: f64) -> [f64; 3] {
    let way = [1.2 - 0.4 * theta.cos(), -0.4 * theta.sin()];
    let distance = way[0].hypot(way[1]);
    let at_crank = ((distance * distance + 1.1 * 1.1 - 0.9 * 0.9) / (2.0 * distance * 1.1)).acos();
    let at_coupler = ((1.1 * 1.1 + 0.9 * 0.9 - distance * distance) / (2.0 * 1.1 * 0.9_f64)).acos();
    let coupler = way[1].atan2(way[0]) + at_crank;
    [theta, coupler - theta, at_coupler - std::f64::consts::PI]
}

/// Where the crank is in line with the pins on the ground, a drive between coupler and rocker no longer decides how it moves on.
#[test]
fn a_dead_centre_of_the_drives_is_named() {
    let drive = |coordinate: &str| {
        four_bar(&format!("drives: [{{coordinate: {coordinate}, stiffness: 4e3, motion: {{hold: 0}}}}]"))
    };
    let cautions = |crane: &LiveCrane, theta: f64| loop_joints::cautions(crane as &dyn DynCrane, &angles(theta));
    let (at_rocker, at_crank) = (drive("rocker_psi"), drive("crank_psi"));
    let found = cautions(&at_rocker, 0.01);
    // The directions are those of the ways from both ends of the crank to the pin, 1.2 m and 0.8 m long: 0.01 · 0.4/0.8 rad apart.
    let expected = f64::to_degrees(0.4 * 0.01_f64.sin() / 0.8);
    assert!(
        found.len() == 1
            && found[0].starts_with(&format!("the loop of hinge is {expected:.2}° from a dead centre of its drives")),
        "{found:?}"
    );
    assert!(cautions(&at_rocker, 0.2).is_empty() && cautions(&at_crank, 0.01).is_empty());
}

#[test]
fn rigid_drives_that_prescribe_too_much_are_named() {
    let crane = four_bar(
        "drives:\n- {coordinate: crank_psi, rigid: true, motion: {hold: 45 deg}}\n- {coordinate: coupler_psi, rigid: true, motion: {hold: -0.2}}\n\
         guess: {rocker_psi: -2}",
    );
    let crane: &dyn DynCrane = &crane;
    let diagnosis = statics::Diagnosis::new(crane, &crane.equilibrium(&statics::Settings::default()));
    assert!(diagnosis.to_string().contains("joint hinge is open by"), "{diagnosis}");
    assert!(
        diagnosis.advice().starts_with("rigid drives prescribe crank_psi and coupler_psi"),
        "{}",
        diagnosis.advice()
    );
    assert!(loop_joints::cautions(crane, &crane.guess()).is_empty(), "nothing else about the loop");
}

/// Two cylinders with valves hold one freedom: the oil starts with pressures that hold the crane, and with no more.
#[test]
fn cylinders_that_hold_one_loop_together_are_named() {
    let rest = angles(1.4);
    let cylinder = |name: &str, coordinate: &str, foot: &str, head: &str| {
        format!(
            "- {{name: {name}, coordinate: {coordinate}, foot: {{link: {foot}, at: [0.4, -0.1, 0]}}, head: {{link: {head}, at: [0.3, -0.2, 0]}}, \
             bore: 0.05, rod: 0.03, retracted: 0.3, stroke: 0.5, max_pressure: 3e7, bulk_modulus: 1.2e9, hose_volumes: [8e-4, 8e-4], \
             valve: {{flow: 1e-4, pressure_drop: 1e6, lag: 0.03, gain: 5}}}}\n"
        )
    };
    let crane = four_bar(&format!(
        "drives:\n- {{coordinate: coupler_psi, stiffness: 4e5, motion: {{hold: {}}}}}\n- {{coordinate: rocker_psi, stiffness: 4e5, motion: {{hold: {}}}}}\n\
         cylinders:\n{}{}pump: {{max_flow: 1e-3, pressure: 2e7}}\nguess: {{crank_psi: 1.4}}",
        rest[1] - 0.05,
        rest[2],
        cylinder("one", "coupler_psi", "crank", "coupler").replace("at: [0.4, -0.1, 0]", "at: [0.1, -0.1, 0]"),
        cylinder("two", "rocker_psi", "coupler", "rocker"),
    ));
    let crane: &dyn DynCrane = &crane;
    let start = Start::new(crane).expect("it rests");
    let cautions = loop_joints::cautions(crane, &start.q);
    assert!(cautions.len() == 1 && cautions[0].starts_with("one and two hold one loop together"), "{cautions:?}");
    // The springs of the drives, 0.05 rad apart, push against each other with 10 kN; the oil holds only the weight.
    let names = force_states::columns(crane.description());
    let x = ForceStates::new(crane.description()).holding(crane, 0.0, &start.q);
    assert!(names.iter().zip(&x).all(|(name, x)| name == "pump_pressure" || x.abs() < 4e5), "{names:?} {x:?}");
    let (a, _) = force_states::accelerations(crane, &StateAt { t: 0.0, q: &start.q, v: &start.v, x: &x });
    assert!(a.iter().all(|a| a.abs() < 1e-8), "{a:?}");
}
