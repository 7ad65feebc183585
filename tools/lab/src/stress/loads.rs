//! Loads from zero to a hundred tonnes, adjacent links of very different mass, nearly massless links.

use super::{
    GRAVITY, Specs,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, balanced, timing},
};
use crane_model::{dynamics::Method, modes::undamped, statics::Status};

pub fn cases(specs: &Specs) -> Vec<Case> {
    let mut cases = Vec::new();
    for load in [0.0, 1.0, 500.0, 1e4, 1e5] {
        cases.push(statics(specs.reference(), load));
        cases.push(motion(specs.reference(), load));
    }
    for mass in [-400.0, f64::MAX, -f64::MAX] {
        cases.push(senseless(specs.reference(), mass));
    }
    for (upper, lower) in [(1e6, 1.0), (1.0, 1.0), (1.0, 1e6), (1e-6, 1e6), (1e6, 1e-6)] {
        cases.push(pendulum(upper, lower));
        cases.push(swing(upper, lower));
    }
    for mass in [1e-3, 1e-6, 1e-9, 1e-12] {
        cases.push(nearly_massless(mass));
    }
    cases
}

fn statics(spec: Spec, load: f64) -> Case {
    let weight = GRAVITY * (15000.0 + 515.5 + 408.1 + 335.0 + 224.0 + 346.0 + load);
    let expected = format!("stable; reactions carry {weight:.6e} N, the weight");
    Case::new("load", format!("eight_link_flexible with {load:e} kg, statics"), expected, move || {
        let subject = Subject::new(&spec)?.set("load_mass", load)?;
        let rest = subject.rest()?;
        let reactions = subject.crane.support_reactions_at(&rest.q, &vec![0.0; rest.q.len()]);
        let carried = reactions.iter().map(|force| force.z).sum::<f64>();
        let tilted =
            subject.crane.description().large_tilt(&rest.q).map_or(String::new(), |caution| format!("; {caution}"));
        expect((carried / weight - 1.0).abs() < 1e-8, format!("{rest}; {carried:.6e} N{tilted}"))
    })
}

fn motion(spec: Spec, load: f64) -> Case {
    let expected = "1 s to the end, energy balanced to 0.1 %";
    Case::new("load", format!("eight_link_flexible with {load:e} kg, motion"), expected, move || {
        let recorded = Subject::new(&spec)?.set("load_mass", load)?.run(&timing(Method::RECOMMENDED, 1e-4, 1.0))?;
        balanced(&recorded, 1e-3)
    })
}

/// A mass that no crane has, set as by `--set`.
fn senseless(spec: Spec, mass: f64) -> Case {
    let expected = "refused with a reason; all numbers finite";
    Case::new("load", format!("eight_link_flexible with {mass:e} kg"), expected, move || {
        let subject = match Subject::new(&spec)?.set("load_mass", mass) {
            Ok(subject) => subject,
            Err(refused) => return expect(refused.contains("[E03"), refused),
        };
        match subject.run(&timing(Method::RECOMMENDED, 1e-4, 0.1)) {
            Ok(_) => Err("it ran".to_owned()),
            Err(message) => expect(!message.contains("NaN") && !message.contains("in the results"), message),
        }
    })
}

/// Two rods of 1 m, hinged about y, each with a point mass at its end.
fn rods(upper: f64, lower: f64, guess: [f64; 2]) -> Spec {
    Spec::new(format!(
        "format: 1
name: rods
links:
  - {{name: upper, joint: {{revolute: {{axis: y}}}}, mass: {upper:e}, com: [0, 0, -1]}}
  - name: lower
    placement: {{transform: {{translation: [0, 0, -1]}}}}
    joint: {{revolute: {{axis: y}}}}
    mass: {lower:e}
    com: [0, 0, -1]
guess: {{upper_theta: {:e}, lower_theta: {:e}}}
points: [{{name: end, link: lower, at: [0, 0, -1]}}]
run: {{duration: 10, step: 1e-4}}
",
        guess[0], guess[1]
    ))
}

/// `ω² = g/l (1 + μ)(1 ± √(μ/(1 + μ)))`, μ = m₂/m₁, of the double pendulum of equal lengths (L. D. Landau, E. M. Lifshitz,
/// Mechanics, §23, problem 2).
fn pendulum(upper: f64, lower: f64) -> Case {
    let ratio = lower / upper;
    let split = (ratio / (1.0 + ratio)).sqrt();
    // 1 − split without cancellation.
    let slow = GRAVITY * (1.0 + ratio) * (1.0 / (1.0 + ratio)) / (1.0 + split);
    let omegas = [slow.sqrt(), (GRAVITY * (1.0 + ratio) * (1.0 + split)).sqrt()];
    let expected = format!("stable; ω = {:.6e} and {:.6e} rad/s", omegas[0], omegas[1]);
    Case::new("mass ratio", format!("pendulum of {upper:e} and {lower:e} kg, modes"), expected, move || {
        let subject = Subject::new(&rods(upper, lower, [0.1, -0.1]))?;
        let rest = subject.rest()?;
        let modes = undamped(&subject.crane.small_motions_at(&rest.q)).map_err(|error| error.to_string())?;
        let found: Vec<f64> = modes.iter().map(|mode| mode.omega_squared.abs().sqrt()).collect();
        // The condition number of A is the mass ratio, and the eigenvalues are the squares of ω.
        let tolerance = 1e-15 * (1.0 + ratio.max(1.0 / ratio)) + 1e-9;
        let off = found.iter().zip(&omegas).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        expect(off < tolerance, format!("{rest}; {:.6e} and {:.6e} rad/s", found[0], found[1]))
    })
}

fn swing(upper: f64, lower: f64) -> Case {
    // A nearly massless upper link is a string: the load falls freely, and bounces within microseconds where the string is taut.
    let bounces = (GRAVITY * (1.0 + lower / upper)).sqrt() > 1e4;
    if bounces {
        let expected = "dopri5 to the end, energy constant to 1e-5; the implicit default stops early and says that a very light link vibrates \
                        too fast for any step";
        return Case::new(
            "mass ratio",
            format!("pendulum of {upper:e} and {lower:e} kg, motion"),
            expected,
            move || {
                let subject = Subject::new(&rods(upper, lower, [1.0, 0.5]).changed("analyses: [dynamics]"))?;
                let energy = balanced(&subject.run(&timing(Method::DormandPrince, 1e-9, 2.0))?, 1e-5)?;
                match subject.run(&timing(Method::RECOMMENDED, 1e-6, 2.0)) {
                    Err(message) if message.contains("very light link") => Ok(format!("{energy}; {message}")),
                    Err(message) => Err(message),
                    Ok(_) => Err(format!("{} came to the end", Method::RECOMMENDED)),
                }
            },
        );
    }
    let expected = "2 s to the end with dopri5, energy constant to 1e-5";
    Case::new("mass ratio", format!("pendulum of {upper:e} and {lower:e} kg, motion"), expected, move || {
        let spec = rods(upper, lower, [1.0, 0.5]).changed("analyses: [dynamics]");
        let recorded = Subject::new(&spec)?.run(&timing(Method::DormandPrince, 1e-9, 2.0))?;
        balanced(&recorded, 1e-5)
    })
}

/// A crank of `mass` kg carries a load of 100 kg, which must hang and swing as on a massless crank.
fn nearly_massless(mass: f64) -> Case {
    let expected = "stable; slowest ω within 1e-4 of the massless link's √(g/l), l = 2 m";
    Case::new("nearly massless links", format!("link of {mass:e} kg over 100 kg"), expected, move || {
        let spec = Spec::new(format!(
            "format: 1
name: crank
links:
  - {{name: crank, joint: {{revolute: {{axis: y}}}}, mass: {mass:e}, com: [0, 0, -0.5], inertia: {{gyration: [0.1, 0.1, 0.1]}}}}
  - name: load
    placement: {{transform: {{translation: [0, 0, -1]}}}}
    joint: {{revolute: {{axis: y}}}}
    mass: 100
    com: [0, 0, -1]
guess: {{crank_theta: 0.2, load_theta: 0.1}}
"
        ));
        let subject = Subject::new(&spec)?;
        let equilibrium = subject.equilibrium();
        if equilibrium.status != Status::Converged {
            return Err(equilibrium.to_string());
        }
        let modes = undamped(&subject.crane.small_motions_at(&equilibrium.q)).map_err(|error| error.to_string())?;
        let omega = modes.first().map_or(f64::NAN, |mode| mode.omega_squared.sqrt());
        let right = (omega / (GRAVITY / 2.0).sqrt() - 1.0).abs() < 1e-4;
        expect(right, format!("{equilibrium}; {omega:.6} rad/s"))
    })
}
