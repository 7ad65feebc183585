//! Poses that no crane should be in: angles near ±90°, upside down, without gravity, without what holds them.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{
    GRAVITY, Specs,
    case::{Case, Finding, expect},
    spec::Spec,
    subject::{Subject, imbalance, timing},
};
use crate::{
    dynamics::Method,
    statics::{Equilibrium, Status},
};

/// The hinges at which the reference crane's grapple hangs.
const HINGES: &[&str] = &["upper_hinge_psi", "rotator_psi"];

pub fn cases(specs: &Specs) -> Vec<Case> {
    let mut cases = Vec::new();
    for angle in [0.0, 1.5, FRAC_PI_2 - 1e-6, FRAC_PI_2] {
        cases.push(base(angle, true));
        cases.push(base(angle, false));
        cases.push(tumbling(angle));
    }
    cases.push(passing());
    let reference = || specs.reference();
    let crane = |name: &str| specs.shipped(name);

    cases.push(named("upside down", "knuckle_boom, load above the hook", Expected::Unstable(&["hook_theta"]), {
        crane("knuckle_boom").with("hook_theta: -30 deg", "hook_theta: 150 deg")
    }));
    cases.push(named("upside down", "knuckle_boom, 1 rad off upside down", Expected::Stable, {
        crane("knuckle_boom").with("hook_theta: -30 deg", "hook_theta: 93 deg")
    }));
    cases.push(named(
        "upside down",
        "eight_link_flexible, grapple above its hinge",
        Expected::Unstable(&["upper_hinge_psi"]),
        { reference().with("upper_hinge_psi: 180 deg", "upper_hinge_psi: 0 deg") },
    ));

    let weightless = |spec: Spec| spec.with("[0, 0, -9.81]", "[0, 0, 0]");
    cases.push(named("zero gravity", "cantilever", Expected::Stable, weightless(specs.cantilever(8))));
    cases.push(named("zero gravity", "eight_link_flexible", Expected::Loose(HINGES), weightless(reference())));
    cases.push(floating(weightless(reference())));

    let group = "nothing holds it";
    let undriven = |coordinate: &str| {
        let stiffness = if coordinate.ends_with("_z") { "1e8" } else { "1e7" };
        let mark = format!("coordinate: {coordinate},");
        reference().on_line(&mark, &format!("stiffness: {stiffness}"), "stiffness: 0")
    };
    cases.push(named(
        group,
        "slewing crane on the ground, joint without a drive",
        Expected::Loose(&["column_psi"]),
        slewing(""),
    ));
    cases.push(named(
        group,
        "slewing crane on the ground, drive of zero stiffness",
        Expected::Loose(&["column_psi"]),
        { slewing("drives: [{coordinate: column_psi, stiffness: 0, damping: 7e3, motion: {hold: 0}}]") },
    ));
    // Its supports give way and let the truck tilt towards the load: slewing has a lowest place.
    cases.push(named(
        group,
        "eight_link_flexible, slewing drive of zero stiffness",
        Expected::Stable,
        undriven("column_psi"),
    ));
    cases.push(named(group, "eight_link_flexible, slewing joint without a drive", Expected::Stable, {
        reference().without("coordinate: column_psi,")
    }));
    cases.push(named(
        group,
        "eight_link_flexible, supports of zero stiffness along x",
        Expected::Loose(&["truck_x"]),
        { reference().with("[3e6, 3e6, 1e7]", "[0, 3e6, 1e7]") },
    ));
    // It rests where its axis is level, and slides on wherever it is pushed.
    cases.push(named(
        group,
        "eight_link_flexible, telescope drive of zero stiffness",
        Expected::Unstable(&["telescope_z"]),
        { undriven("telescope_z") },
    ));
    cases.push(fallen(undriven("boom_psi")));
    cases
}

/// A crane on the ground that slews about the vertical: gravity does nothing about it.
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

/// What statics must say.
#[derive(Clone, Copy)]
enum Expected {
    Stable,
    Unstable(&'static [&'static str]),
    Loose(&'static [&'static str]),
}

impl Expected {
    fn words(self) -> String {
        match self {
            Expected::Stable => "stable".to_owned(),
            Expected::Unstable(names) => format!("unstable, {} named", names.join(", ")),
            Expected::Loose(names) => format!("singular, {} named", names.join(", ")),
        }
    }

    fn meets(self, equilibrium: &Equilibrium) -> bool {
        let all = |names: &[&str], found: &[&str]| names.iter().all(|name| found.contains(name));
        match (self, &equilibrium.status) {
            (Expected::Stable, Status::Converged) => true,
            (Expected::Unstable(names), Status::Unstable { coordinates })
            | (Expected::Loose(names), Status::Singular { coordinates }) => all(names, coordinates),
            _ => false,
        }
    }
}

fn named(group: &'static str, name: &str, expected: Expected, spec: Spec) -> Case {
    Case::new(group, name, expected.words(), move || {
        let equilibrium = Subject::new(&spec)?.equilibrium();
        expect(expected.meets(&equilibrium), equilibrium.to_string())
    })
}

/// A block on four supports whose rest is turned about y: 1 m × 1 m, 100 kg, its centre in the plane of the supports.
fn base(angle: f64, exact: bool) -> Case {
    let near = (FRAC_PI_2 - angle).abs() < crate::NEAR_SINGULAR;
    let kinematics = if exact { "exact" } else { "linear" };
    let expected = if near {
        "said that block_theta is near ±90°".to_owned()
    } else if exact || angle < crate::LARGE_TILT {
        "a pose, none of it NaN, nothing said of ±90°".to_owned()
    } else {
        "said that linear supports do not hold so far".to_owned()
    };
    let name = format!("block on {kinematics} supports, base at θ = {angle:.6} rad");
    Case::new("angles near ±90°", name, expected, move || {
        let mut text = format!(
            "format: 1
name: block
gravity: [0, 0, 0]
links:
  - {{name: block, joint: free, mass: 100, com: [0, 0, 0], inertia: {{Ixx: 10, Iyy: 10, Izz: 15}}}}
guess: {{block_theta: {angle:e}}}
supports:
"
        );
        // The springs are at rest in the turned pose.
        let (sin, cos) = angle.sin_cos();
        for (index, (x, y)) in [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)].into_iter().enumerate() {
            let play = if exact { [x * cos - x, 0.0, -x * sin] } else { [0.0, 0.0, -x * angle] };
            text += &format!(
                "  - {{name: s{index}, at: [{x}, {y}, 0], stiffness: [1e5, 1e5, 1e5], free_play: [{:e}, {:e}, {:e}], \
                 kinematics: {kinematics}}}\n",
                play[0], play[1], play[2]
            );
        }
        let subject = Subject::new(&Spec::new(text))?;
        let equilibrium = subject.equilibrium();
        let description = subject.rig.description();
        let finite = equilibrium.q.iter().all(|x| x.is_finite());
        let (singular, tilted) = (description.near_singular(&equilibrium.q), description.large_tilt(&equilibrium.q));
        let right =
            if near { singular.is_some() } else { singular.is_none() && (exact || tilted.is_some() || angle == 0.0) };
        let said = [singular, tilted].into_iter().flatten().map(|said| format!("; {said}")).collect::<String>();
        expect(finite && right, format!("{equilibrium}; θ = {:.6} rad{said}", equilibrium.q[4]))
    })
}

/// A free body that starts at θ near 90°, at rest and without forces: it must stay, or be refused with that angle named.
fn tumbling(angle: f64) -> Case {
    let expected = if angle == FRAC_PI_2 {
        "refused or stopped, block_theta named"
    } else {
        "stays where it is, or block_theta named"
    };
    Case::new("angles near ±90°", format!("free block, run from θ = {angle:.6} rad"), expected, move || {
        let text = format!(
            "format: 1
name: block
gravity: [0, 0, -1]
analyses: [dynamics]
links:
  - {{name: block, joint: free, mass: 100, com: [0, 0, 0], inertia: {{Ixx: 10, Iyy: 12, Izz: 15}}}}
guess: {{block_theta: {angle:e}}}
run: {{duration: 1}}
"
        );
        let subject = Subject::new(&Spec::new(text))?;
        match subject.run(&timing(Method::Rosenbrock, 1e-6, 1.0)) {
            Err(said) => expect(said.contains("block_theta"), said),
            Ok(recorded) => {
                let last = recorded.table.rows.last().map_or(f64::NAN, |row| row[5]);
                let named = recorded.cautions.join("; ");
                let right = angle != FRAC_PI_2 && (last - angle).abs() < 1e-9;
                expect(right, format!("θ = {last:.6} rad at the end; {named}"))
            }
        }
    })
}

/// A free block that tumbles through θ = 90° and on.
fn passing() -> Case {
    let expected = "said that block_theta is near ±90°: the run goes through it or ends there";
    Case::new("angles near ±90°", "free block, turning through θ = 90°", expected, move || {
        let text = "format: 1
name: block
gravity: [0, 0, -9.81]
links:
  - {name: block, joint: free, mass: 100, com: [0.4, 0.02, 0.1], inertia: {Ixx: 10, Iyy: 12, Izz: 15}}
supports:
  - {name: pin, at: [0, 0, 0], stiffness: [1e6, 1e6, 1e6], damping: [1e3, 1e3, 1e3], kinematics: exact}
analyses: [dynamics]
run: {duration: 3}
";
        let subject = Subject::new(&Spec::new(text))?;
        match subject.run(&timing(Method::Rosenbrock, 1e-6, 3.0)) {
            Err(said) => expect(said.contains("block_theta") && said.contains("90°"), said),
            Ok(recorded) => {
                let named = recorded.cautions.join("; ");
                let off = imbalance(&recorded);
                expect(named.contains("block_theta") && off < 1e-3, format!("energy off by {off:.1e}; {named}"))
            }
        }
    })
}

/// Without weight the hinges hang nowhere; the motion itself is well posed from the guess.
fn floating(spec: Spec) -> Case {
    let expected = "1 s by rosw4 from the guess, energy balanced to 0.1 %";
    Case::new("zero gravity", "eight_link_flexible, motion", expected, move || {
        let spec = spec.with("analyses: [statics, dynamics, modes, ensemble]", "analyses: [dynamics, modes]");
        let recorded = Subject::new(&spec)?.run(&timing(Method::Rosenbrock, 1e-4, 1.0))?;
        let off = imbalance(&recorded);
        expect(off < 1e-3, format!("{} steps, energy off by {off:.1e}", recorded.run.statistics.steps))
    })
}

/// Without stiffness in the boom's drive everything beyond its pin hangs below it.
fn fallen(spec: Spec) -> Case {
    let expected = "stable: everything beyond the boom's pin hangs straight below it, its drive carries nothing";
    Case::new("nothing holds it", "eight_link_flexible, boom drive of zero stiffness", expected, move || -> Finding {
        let subject = Subject::new(&spec)?;
        let rest = subject.rest()?;
        let boom = subject.index("boom_psi")?;
        let weights = subject.rig.bias(&rest.q, &vec![0.0; rest.q.len()]);
        let turned = (rest.q[boom] + PI).rem_euclid(2.0 * PI) - PI;
        // Gravity's moment about the pin is zero: the common centre of mass is below it.
        let right = weights[boom].abs() < 1e-4 * GRAVITY * 1e4 && turned < 0.0;
        expect(right, format!("{rest}; boom at {turned:.4} rad, {:.1e} N m about its pin", weights[boom]))
    })
}
