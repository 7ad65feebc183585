//! Poses that no crane should be in: upside down, without gravity, with nothing to hold it.

use std::f64::consts::PI;

use super::{
    GRAVITY, SUPPORT, Specs, WEIGHTLESS,
    case::{Case, Finding, expect},
    spec::Spec,
    subject::{Subject, balanced, timing},
    with_supports,
};
use crane_model::{
    Text,
    dynamics::Method,
    statics::{Equilibrium, Status},
};

/// The hinges at which the reference crane's grapple hangs.
const HINGES: &[&str] = &["upper_hinge_psi", "rotator_psi"];

pub fn cases(specs: &Specs) -> Vec<Case> {
    let mut cases = Vec::new();
    let reference = || specs.reference();
    let crane = |name: &str| specs.shipped(name);

    cases.push(named_case("upside down", "knuckle_boom, load above the hook", Expected::Unstable(&["hook_theta"]), {
        crane("knuckle_boom").changed("guess: {hook_theta: 150 deg}")
    }));
    cases.push(named_case("upside down", "knuckle_boom, 1 rad off upside down", Expected::Stable, {
        crane("knuckle_boom").changed("guess: {hook_theta: 93 deg}")
    }));
    cases.push(named_case(
        "upside down",
        "eight_link_flexible, grapple above its hinge",
        Expected::Unstable(&["upper_hinge_psi"]),
        reference().changed("guess: {upper_hinge_psi: 0}"),
    ));

    let weightless = |spec: Spec| spec.changed(WEIGHTLESS);
    cases.push(named_case("zero gravity", "cantilever", Expected::Stable, weightless(specs.cantilever(8))));
    cases.push(named_case("zero gravity", "eight_link_flexible", Expected::Singular(HINGES), weightless(reference())));
    cases.push(floating(weightless(reference())));

    let group = "nothing holds it";
    let undriven =
        |coordinate: &str| reference().changed(&format!("drives: [{{coordinate: {coordinate}, stiffness: 0}}]"));
    cases.push(named_case(
        group,
        "slewing crane on the ground, joint without a drive",
        Expected::Singular(&["column_psi"]),
        slewing(""),
    ));
    cases.push(named_case(
        group,
        "slewing crane on the ground, drive of zero stiffness",
        Expected::Singular(&["column_psi"]),
        slewing("drives: [{coordinate: column_psi, stiffness: 0, damping: 7e3, motion: {hold: 0}}]"),
    ));
    // Its supports give way and let the truck tilt towards the load: slewing has a lowest position.
    cases.push(named_case(
        group,
        "eight_link_flexible, slewing drive of zero stiffness",
        Expected::Stable,
        undriven("column_psi"),
    ));
    cases.push(named_case(group, "eight_link_flexible, slewing joint without a drive", Expected::Stable, {
        reference().changed("drives: [{coordinate: column_psi, remove: true}]")
    }));
    cases.push(named_case(
        group,
        "eight_link_flexible, supports of zero stiffness along x",
        Expected::Singular(&["truck_x"]),
        with_supports(&reference(), [0.0, SUPPORT[1], SUPPORT[2]]),
    ));
    // It rests where its axis is level, and slides away when pushed.
    cases.push(named_case(
        group,
        "eight_link_flexible, telescope drive of zero stiffness",
        Expected::Unstable(&["telescope_z"]),
        undriven("telescope_z"),
    ));
    cases.push(fallen(undriven("boom_psi")));
    cases
}

/// A crane on the ground that slews about the vertical: gravity exerts no moment about that axis.
fn slewing(drives: &str) -> Spec {
    Spec::new(format!(
        "format: 1
name: slewing
links:
  - {{name: column, joint: revolute, mass: 500, com: [0.1, 0, 1], inertia: {{Ixx: 200, Iyy: 200, Izz: 30}}}}
  - {{name: boom, placement: {{transform: {{translation: [0, 0, 2]}}}}, mass: 300, com: [2, 0, 0]}}
{drives}
"
    ))
}

/// What statics must report.
#[derive(Clone, Copy)]
enum Expected {
    Stable,
    Unstable(&'static [&'static str]),
    Singular(&'static [&'static str]),
}

impl Expected {
    fn words(self) -> String {
        match self {
            Expected::Stable => "stable".to_owned(),
            Expected::Unstable(names) => format!("unstable, {} named", names.join(", ")),
            Expected::Singular(names) => format!("singular, {} named", names.join(", ")),
        }
    }

    fn meets(self, equilibrium: &Equilibrium) -> bool {
        let all = |names: &[&str], found: &[Text]| names.iter().all(|name| found.iter().any(|found| found == name));
        match (self, &equilibrium.status) {
            (Expected::Stable, Status::Converged) => true,
            (Expected::Unstable(names), Status::Unstable { coordinates })
            | (Expected::Singular(names), Status::Singular { coordinates }) => all(names, coordinates),
            _ => false,
        }
    }
}

fn named_case(group: &'static str, name: &str, expected: Expected, spec: Spec) -> Case {
    Case::new(group, name, expected.words(), move || {
        let equilibrium = Subject::new(&spec)?.equilibrium();
        expect(expected.meets(&equilibrium), equilibrium.to_string())
    })
}

/// Without gravity the hinges have no definite rest position; the motion from the guess is still well posed.
fn floating(spec: Spec) -> Case {
    let expected = "1 s from the guess, energy balanced to 0.1 %";
    Case::new("zero gravity", "eight_link_flexible, motion", expected, move || {
        let recorded =
            Subject::new(&spec.changed("analyses: [dynamics, modes]"))?.run(&timing(Method::RECOMMENDED, 1e-4, 1.0))?;
        balanced(&recorded, 1e-3)
    })
}

/// Without stiffness in the boom's drive everything beyond its pin hangs below it.
fn fallen(spec: Spec) -> Case {
    let expected = "stable: everything beyond the boom's pin hangs vertically below it, and its drive carries nothing";
    Case::new("nothing holds it", "eight_link_flexible, boom drive of zero stiffness", expected, move || -> Finding {
        let subject = Subject::new(&spec)?;
        let rest = subject.rest()?;
        let boom = subject.index("boom_psi")?;
        let weights = subject.crane.bias_at(&rest.q, &vec![0.0; rest.q.len()]);
        let turned = (rest.q[boom] + PI).rem_euclid(2.0 * PI) - PI;
        // Gravity's moment about the pin is zero: the common centre of mass is below it.
        let right = weights[boom].abs() < 1e-4 * GRAVITY * 1e4 && turned < 0.0;
        expect(right, format!("{rest}; boom at {turned:.4} rad, {:.1e} N m about its pin", weights[boom]))
    })
}
