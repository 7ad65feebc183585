//! Very short motions, steps of a drive, and very long runs.

use super::{
    Specs,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, balanced, cautions, imbalance, timing},
    with_drives,
};
use crane_model::dynamics::Method;

/// Accuracy of a run by each method: a step for rk4, s, and tolerances for the others.
const METHODS: [(Method, f64); 4] =
    [(Method::Rk4, 1e-4), (Method::DormandPrince, 1e-8), (Method::Rosenbrock, 1e-8), (Method::Bdf, 1e-8)];

pub fn cases(specs: &Specs) -> Vec<Case> {
    let mut cases = Vec::new();
    for (method, accuracy) in METHODS {
        for duration in [1.0, 1e-3, 1e-9] {
            cases.push(step(method, accuracy, duration));
        }
        cases.push(vibration(method));
        cases.push(tumble(specs.shipped("double_pendulum"), method));
    }
    cases.push(sagging());
    cases.push(sudden(specs.reference(), 0.05));
    cases.push(sudden(specs.reference(), 1e-3));
    cases
}

/// A carriage of 100 kg on a drive of 1e4 N/m and 400 N s/m, moved by 1 m within a duration. For a step, the spring alone
/// gives `x = 1 − e^{−δt} (cos ωt + δ/ω sin ωt)`, δ = d/2m, ω² = s/m − δ²; the damper's impulse d adds `d/(mω) e^{−δt} sin ωt`.
fn step(method: Method, accuracy: f64, duration: f64) -> Case {
    let (mass, stiffness, damping, end) = (100.0, 1e4, 400.0, 0.5_f64);
    let decay: f64 = damping / (2.0 * mass);
    let omega = (stiffness / mass - decay * decay).sqrt();
    // A short motion acts like a step at the middle of the quintic.
    let t = end - duration / 2.0;
    let (sin, cos) = (omega * t).sin_cos();
    let shrunk = (-decay * t).exp();
    let exact = 1.0 - shrunk * (cos + decay / omega * sin) + damping / (mass * omega) * shrunk * sin;
    let sharp = duration < 0.01;
    // Steps of 1e-4 s may miss it entirely.
    let missed = duration < 1e-6;
    let expected = if missed {
        format!("x = {exact:.6} m at 0.5 s, the closed form of a step, or a caution that it was missed")
    } else if sharp {
        format!("x = {exact:.6} m at 0.5 s, the closed form of a step")
    } else {
        "to the end, energy balanced to 1e-5".to_owned()
    };
    let name = format!("carriage moved by 1 m in {duration:e} s, {method}");
    Case::new("step in a drive", name, expected, move || {
        let spec = Spec::new(format!(
            "format: 1
name: carriage
links: [{{name: carriage, joint: {{prismatic: {{axis: x}}}}, mass: {mass}, com: [0, 0, 0]}}]
drives:
  - {{coordinate: carriage_x, stiffness: {stiffness}, damping: {damping}, motion: {{quintic: {{from: 0, to: 1, duration: {duration:e}}}}}}}
"
        ));
        let recorded = match Subject::new(&spec)?.run(&timing(method, accuracy, end)) {
            Ok(recorded) => recorded,
            // A run that ends with a stated reason does not mislead.
            Err(message) => return expect(missed, message),
        };
        let last = recorded.table.rows.last().map_or(f64::NAN, |row| row[1]);
        let (off, steps) = (imbalance(&recorded), recorded.run.statistics.steps);
        let message = cautions(&recorded);
        let right = if sharp { (last - exact).abs() < 1e-4 } else { off < 1e-5 };
        expect(
            right || missed && !message.is_empty(),
            format!("x = {last:.6} m, energy off by {off:.1e}, {steps} steps{message}"),
        )
    })
}

/// A beam so soft that it falls through θ = 90°, in constant steps.
fn sagging() -> Case {
    let expected = "a caution that the beam passed ±90°, or energy balanced to 1e-3";
    Case::new("angles near ±90°", "soft beam falling through 90°, rk4 with 5e-4 s", expected, move || {
        let recorded = Subject::new(&soft_beam(2.1e8))?.run(&timing(Method::Rk4, 5e-4, 20.0))?;
        let (message, off) = (cautions(&recorded), imbalance(&recorded));
        expect(!message.is_empty() || off < 1e-3, format!("energy off by {off:.1e}{message}"))
    })
}

/// An undamped beam of one section with a weight at its end; `modulus` in Pa.
fn soft_beam(modulus: f64) -> Spec {
    Spec::new(format!(
        "format: 1
name: soft_beam
analyses: [dynamics]
links:
  - name: beam
    beam:
      length: 2
      sections: 1
      section_joint: paper
      material: {{E: {modulus:e}, G: {:e}, density: 7850}}
      section: {{solid: {{height: 0.06, width: 0.04}}}}
  - {{name: weight, mass: 20, com: [0, 0, 0], inertia: {{gyration: [0.1, 0.1, 0.1]}}}}
guess: {{beam_1_psi: 0.1}}
",
        0.4 * modulus
    ))
}

/// The whole manoeuvre of the reference crane within a duration.
fn sudden(spec: Spec, duration: f64) -> Case {
    let expected = "1 s to the end, energy balanced to 1 %";
    Case::new("short motions", format!("eight_link_flexible, manoeuvre of {duration} s"), expected, move || {
        let spec = with_drives(&spec, |_| format!("motion: {{quintic: {{duration: {duration:e}}}}}"));
        let recorded = Subject::new(&spec)?.run(&timing(Method::RECOMMENDED, 1e-4, 1.0))?;
        balanced(&recorded, 0.01)
    })
}

/// A chain of two rods that tumbles for 600 s.
fn tumble(spec: Spec, method: Method) -> Case {
    let (accuracy, kept) = match method {
        Method::Rk4 => (1e-3, 1e-5),
        Method::DormandPrince => (1e-10, 1e-5),
        Method::Rosenbrock => (1e-8, 1e-3),
        Method::Bdf => (1e-9, 1e-3),
    };
    let expected = format!("600 s to the end, energy constant to {kept:e} of the oscillating energy");
    let name = format!("double_pendulum by {method}, {accuracy:e}");
    Case::new("600 s without drift", name, expected, move || {
        let recorded = Subject::new(&spec)?.run(&timing(method, accuracy, 600.0))?;
        balanced(&recorded, kept)
    })
}

/// A soft, undamped beam of one section that vibrates for 600 s.
fn vibration(method: Method) -> Case {
    let (accuracy, kept) = match method {
        Method::Rk4 => (5e-4, 1e-4),
        Method::DormandPrince | Method::Bdf => (1e-8, 1e-4),
        Method::Rosenbrock => (1e-7, 1e-5),
    };
    let expected = format!("600 s to the end, energy constant to {kept:e} of the oscillating energy");
    let case = Case::new("600 s without drift", format!("soft beam by {method}, {accuracy:e}"), expected, move || {
        let recorded = Subject::new(&soft_beam(2.1e9))?.run(&timing(method, accuracy, 600.0))?;
        balanced(&recorded, kept)
    });
    if method.is_explicit() { case.long() } else { case }
}
