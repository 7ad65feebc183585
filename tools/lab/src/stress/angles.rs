//! Angles θ of a base near ±90°, where ψ and φ rotate about the same axis.

use std::{f64::consts::FRAC_PI_2, fmt::Write};

use super::{
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, appended, balanced, cautions, timing},
};
use crane_model::{LARGE_TILT, NEAR_SINGULAR, dynamics::Method};

pub fn cases() -> Vec<Case> {
    let angles = [0.0, 1.5, FRAC_PI_2 - 1e-6, FRAC_PI_2];
    let of = |angle| [base(angle, true), base(angle, false), tumbling(angle)];
    angles.into_iter().flat_map(of).chain([passing()]).collect()
}

/// A block on four supports that are unloaded when it is rotated by an angle about y: 1 m × 1 m, 100 kg, its centre in the plane of
/// the supports.
fn base(angle: f64, exact: bool) -> Case {
    let near = (FRAC_PI_2 - angle).abs() < NEAR_SINGULAR;
    let kinematics = if exact { "exact" } else { "linear" };
    let expected = if near {
        "a caution that block_theta is near ±90°".to_owned()
    } else if exact || angle < LARGE_TILT {
        "a pose without NaN, no caution about ±90°".to_owned()
    } else {
        "a caution about linear supports".to_owned()
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
            let _ = writeln!(
                text,
                "  - {{name: s{index}, at: [{x}, {y}, 0], stiffness: [1e5, 1e5, 1e5], free_play: [{:e}, {:e}, {:e}], \
                 kinematics: {kinematics}}}",
                play[0], play[1], play[2]
            );
        }
        let subject = Subject::new(&Spec::new(text))?;
        let equilibrium = subject.equilibrium();
        let description = subject.crane.description();
        let finite = equilibrium.q.iter().all(|x| x.is_finite());
        let (singular, tilted) = (description.near_singular(&equilibrium.q), description.large_tilt(&equilibrium.q));
        let right = if near { singular.is_some() } else { singular.is_none() };
        let right = right && tilted.is_some() == (!exact && angle >= LARGE_TILT);
        let cautions = appended(singular.iter().chain(&tilted));
        expect(finite && right, format!("{equilibrium}; θ = {:.6} rad{cautions}", equilibrium.q[4]))
    })
}

/// A free body that starts at θ near 90°, at rest and without forces: it must stay, or be refused with a message that names that angle.
fn tumbling(angle: f64) -> Case {
    let expected = if angle == FRAC_PI_2 {
        "refused or stopped, naming block_theta"
    } else {
        "stays where it is, or a message names block_theta"
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
        match subject.run(&timing(Method::RECOMMENDED, 1e-6, 1.0)) {
            Err(message) => expect(message.contains("block_theta"), message),
            Ok(recorded) => {
                let last = recorded.table.rows.last().map_or(f64::NAN, |row| row[5]);
                let message = cautions(&recorded);
                let right = angle != FRAC_PI_2 && (last - angle).abs() < 1e-9;
                expect(right, format!("θ = {last:.6} rad at the end{message}"))
            }
        }
    })
}

/// A free block that tumbles through θ = 90° and beyond.
fn passing() -> Case {
    let expected = "passes with energy constant to 0.1 %, or stops and reports that block_theta is near ±90°";
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
        match subject.run(&timing(Method::RECOMMENDED, 1e-6, 3.0)) {
            Err(message) => expect(message.contains("block_theta") && message.contains("90°"), message),
            Ok(recorded) => balanced(&recorded, 1e-3),
        }
    })
}
