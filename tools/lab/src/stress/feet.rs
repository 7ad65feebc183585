//! Feet that press and never pull: gaps, tipping, falls.

use std::fmt::Write;

use super::{
    GRAVITY,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, balanced, timing},
};
use crane_model::{dynamics::Method, statics::Status};

const GROUP: &str = "feet that lift";
/// Mass of the truck, kg, half its track, m, and distance of its load, m.
const TRUCK: f64 = 8000.0;
const TRACK: f64 = 1.5;
const RADIUS: f64 = 7.5;

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for kinematics in ["linear", "exact"] {
        for stiffness in [1e6, 1e9, 1e12] {
            for share in [0.9, 1.1] {
                cases.push(loaded(kinematics, stiffness, share));
            }
        }
        for gap in [1e-3, 0.05, 0.5] {
            cases.push(sunk(kinematics, gap));
        }
        cases.push(short_leg(kinematics));
        for damping in [0.0, 1e4, 1e6] {
            cases.push(dropped(kinematics, damping));
        }
    }
    cases
}

/// A truck on four corner feet, anticlockwise from (x, y) = (1.5, 2) m, with the load as a live parameter on its +x side.
fn truck(kinematics: &str, stiffness: f64, damping: f64, gaps: [f64; 4]) -> Spec {
    let mut text = format!(
        "format: 1
name: truck
parameters: {{load: {{value: 0, unit: kg}}}}
links:
  - {{name: truck, joint: free, mass: {TRUCK}, com: [0.2, 0.3, 0.8], inertia: {{Ixx: 6e3, Iyy: 1.8e4, Izz: 2e4}}}}
  - {{name: load, mass: load, com: [{RADIUS}, 0.3, 0.8], inertia: {{gyration: [0.3, 0.3, 0.3]}}}}
supports:
"
    );
    let corners = [(TRACK, 2.0), (-TRACK, 2.0), (-TRACK, -2.0), (TRACK, -2.0)];
    for (index, ((x, y), gap)) in corners.into_iter().zip(gaps).enumerate() {
        let _ = writeln!(
            text,
            "  - {{name: s{index}, at: [{x}, {y}, 0], stiffness: [{stiffness:e}, {stiffness:e}, {stiffness:e}], damping: \
             [{damping:e}, {damping:e}, {damping:e}], free_play: [0, 0, {:e}], kinematics: {kinematics}, one_sided: true}}",
            -gap
        );
    }
    Spec::new(text)
}

/// The load at which the moment about the near feet is zero.
fn tipping() -> f64 {
    TRUCK * (TRACK - 0.2) / (RADIUS - TRACK)
}

/// Below its tipping load the truck stands; above it, it tips over the line between the near feet.
fn loaded(kinematics: &'static str, stiffness: f64, share: f64) -> Case {
    let stands = share < 1.0;
    let expected =
        if stands { "stable, carries its weight".to_owned() } else { "tips over about s3 – s0".to_owned() };
    let name = format!("truck on {kinematics} feet of {stiffness:e} N/m, {share} of its tipping load");
    Case::new(GROUP, name, expected, move || {
        let load = share * tipping();
        let subject = Subject::new(&truck(kinematics, stiffness, 0.0, [0.0; 4]))?.set("load", load)?;
        let equilibrium = subject.equilibrium();
        let carried: f64 =
            subject.crane.support_reactions_at(&equilibrium.q, &[0.0; 6]).iter().map(|force| force.z).sum();
        let right = match &equilibrium.status {
            Status::Converged => stands && (carried / (GRAVITY * (TRUCK + load)) - 1.0).abs() < 1e-6,
            Status::TipsOver { feet } => !stands && feet.join(" ") == "s3 s0",
            _ => false,
        };
        expect(right, format!("{equilibrium}; {carried:.1} N on the feet"))
    })
}

/// The ground is below the feet at the guess: nothing supports the truck there.
fn sunk(kinematics: &'static str, gap: f64) -> Case {
    const STIFFNESS: f64 = 1e7;
    let height = -gap - TRUCK * GRAVITY / (4.0 * STIFFNESS);
    let expected = format!("stable, its middle at z = {height:.6} m");
    Case::new(GROUP, format!("truck on {kinematics} feet {gap} m above the ground"), expected, move || {
        let rest = Subject::new(&truck(kinematics, STIFFNESS, 0.0, [gap; 4]))?.rest()?;
        expect((rest.q[2] - height).abs() < 1e-6, format!("{rest}; z = {:.6} m", rest.q[2]))
    })
}

/// One leg is 20 mm short, and stays off the ground: the moments about the lines between the other three give their forces.
fn short_leg(kinematics: &'static str) -> Case {
    // s2 is short: s1 and s3 carry shares given by their levers, s0 the rest.
    let weight = TRUCK * GRAVITY;
    let (front, right) = ((2.0 + 0.3) / 4.0, (TRACK + 0.2) / (2.0 * TRACK));
    let forces = [weight * (front + right - 1.0), weight * (1.0 - right), 0.0, weight * (1.0 - front)];
    let expected = format!("stable, {:.0}, {:.0}, 0, {:.0} N", forces[0], forces[1], forces[3]);
    Case::new(GROUP, format!("truck on {kinematics} feet, one 20 mm short"), expected, move || {
        let subject = Subject::new(&truck(kinematics, 1e8, 0.0, [0.0, 0.0, 0.02, 0.0]))?;
        let rest = subject.rest()?;
        let found: Vec<f64> =
            subject.crane.support_reactions_at(&rest.q, &[0.0; 6]).iter().map(|force| force.z).collect();
        // The tilt moves the mass centre by its height times an angle of some 1e-4.
        let off = found.iter().zip(forces).map(|(value, force)| (value - force).abs()).fold(0.0, f64::max);
        expect(off < 1e-3 * weight, format!("{rest}; {found:.0?} N"))
    })
}

/// Dropped from half a metre above the ground with its mass centre off the middle: it bounces and rocks.
fn dropped(kinematics: &'static str, damping: f64) -> Case {
    let name = format!("truck dropped by 0.5 m onto {kinematics} feet with {damping:e} N s/m");
    Case::new(GROUP, name, "2 s to the end, energy balanced to 0.1 %", move || {
        let spec = truck(kinematics, 1e7, damping, [0.5; 4]).changed("analyses: [dynamics]");
        let recorded = Subject::new(&spec)?.run(&timing(Method::RECOMMENDED, 1e-6, 2.0))?;
        balanced(&recorded, 1e-3)
    })
}
