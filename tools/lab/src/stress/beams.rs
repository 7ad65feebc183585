//! Beams of 1 to 50 sections, and columns near their buckling load.

use std::f64::consts::{FRAC_PI_4, PI};

use super::{
    GRAVITY, Specs,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, balanced, timing},
    with_boom,
};
use crane_model::{dynamics::Method, statics::Status};

/// Young's modulus of the shipped steel, Pa.
const MODULUS: f64 = 2.1e11;

pub fn cases(specs: &Specs) -> Vec<Case> {
    let mut cases: Vec<Case> = [1, 2, 4, 8, 50].map(|sections| deflection(specs.cantilever(sections), sections)).into();
    for sections in [1, 4, 16] {
        cases.push(motion(with_boom(&specs.reference(), &format!("sections: {sections}")), sections));
    }
    for sections in [1, 4] {
        for load in [0.5, 0.999, 1.001, 2.0] {
            cases.push(buckling(sections, load));
        }
        cases.push(buckled(sections));
    }
    cases
}

/// `δ = F l³/3EI (1 − 1/4n²) + μ g l⁴/8EI (1 − 1/2n²)`, exact for rigid elements at small deflections.
fn deflection(spec: Spec, sections: usize) -> Case {
    const LENGTH: f64 = 2.0;
    const RIGIDITY: f64 = MODULUS * 0.06 * 0.04 * 0.04 * 0.04 / 12.0;
    let square = (sections * sections) as f64;
    let load = 20.0 * GRAVITY * LENGTH.powi(3) / (3.0 * RIGIDITY) * (1.0 - 1.0 / (4.0 * square));
    let by_weight = 7850.0 * 0.06 * 0.04 * GRAVITY * LENGTH.powi(4) / (8.0 * RIGIDITY) * (1.0 - 1.0 / (2.0 * square));
    let sunk = load + by_weight;
    let expected = format!("stable; tip sinks by {:.4} mm, the Euler–Bernoulli beam divided into sections", sunk * 1e3);
    Case::new("number of sections", format!("cantilever of {sections}, statics"), expected, move || {
        let subject = Subject::new(&spec)?;
        let rest = subject.rest()?;
        let tip = subject.crane.points_at(&rest.q)[1].z;
        // The deflection is 0.7 % of the length; the linear law neglects its square.
        expect((tip / sunk + 1.0).abs() < 1e-4, format!("{rest}; {:.4} mm", -tip * 1e3))
    })
}

fn motion(spec: Spec, sections: usize) -> Case {
    let expected = "1 s to the end, energy balanced to 0.1 %";
    let case =
        Case::new("number of sections", format!("eight_link_flexible of {sections}, motion"), expected, move || {
            let recorded = Subject::new(&spec)?.run(&timing(Method::RECOMMENDED, 1e-4, 1.0))?;
            balanced(&recorded, 1e-3)
        });
    if sections < 16 { case } else { case.long() }
}

/// A column of `n` sections, EI = 1e4 N m², 4 m long and of 4 g, with a load on its top.
fn column(sections: usize, load: f64, lean: f64) -> Spec {
    let guess =
        (1..=sections).map(|section| format!("column_{section}_theta: {lean:e}")).collect::<Vec<_>>().join(", ");
    Spec::new(format!(
        "format: 1
name: column
gravity: [0, 0, -9.81]
links:
  - name: column
    placement: {{transform: {{rotation: {{y: -90 deg}}}}}}
    beam:
      length: 4
      sections: {sections}
      material: {{E: 1.0e10, G: 4.0e9, density: 1.0}}
      section: {{numbers: {{area: 1.0e-3, Jy: 1.0e-6, Jz: 4.0e-6, Jo: 4.0e-6}}}}
      damping: {{beta: 1e-3}}
  - {{name: head, mass: {:e}, com: [0, 0, 0], inertia: {{gyration: [0.1, 0.1, 0.1]}}}}
points:
  - {{name: head, link: head, at: [0, 0, 0]}}
guess: {{{guess}}}
",
        load / GRAVITY
    ))
}

/// `P = 4 EI n²/l² sin²(π/4n)`: the chain's difference equation `α₊ − (2 − P d/s) α + α₋ = 0` with a clamped and a free end.
/// For many sections it tends to Euler's π² EI/4l².
fn critical(sections: usize) -> f64 {
    const RIGIDITY: f64 = 1e10 * 1e-6;
    const LENGTH: f64 = 4.0;
    let n = sections as f64;
    4.0 * RIGIDITY * n * n / (LENGTH * LENGTH) * (FRAC_PI_4 / n).sin().powi(2)
}

fn buckling(sections: usize, part: f64) -> Case {
    let load = part * critical(sections);
    let stands = part < 1.0;
    let expected = if stands { "stable, straight" } else { "unstable in the weak direction" };
    let name = format!("column of {sections} under {part} of its buckling load {:.2} N", critical(sections));
    Case::new("buckling", name, expected, move || {
        let subject = Subject::new(&column(sections, load, 0.0))?;
        let equilibrium = subject.equilibrium();
        let right = match &equilibrium.status {
            Status::Converged => stands,
            Status::Unstable { coordinates } => !stands && coordinates.iter().all(|name| name.ends_with("_theta")),
            _ => false,
        };
        expect(right, equilibrium.to_string())
    })
}

/// A column beyond its buckling load, from a leaning guess: it comes to rest bent. One section is a rod on one spring,
/// `s θ = P l/2 sin θ`.
fn buckled(sections: usize) -> Case {
    let load = 1.2 * critical(sections);
    let angle = (sections == 1).then(|| {
        let (spring, lever) = (1e4 / 4.0, load * 2.0);
        let (mut low, mut high) = (0.1, PI);
        for _ in 0..100 {
            let middle = f64::midpoint(low, high);
            if spring * middle < lever * middle.sin() { low = middle } else { high = middle }
        }
        low
    });
    let expected =
        angle.map_or_else(|| "stable, buckled".to_owned(), |angle| format!("stable, buckled by {angle:.4} rad"));
    let name = format!("column of {sections} under 1.2 of its buckling load, from an inclined guess");
    Case::new("buckling", name, expected, move || {
        let subject = Subject::new(&column(sections, load, 0.8 / sections as f64))?;
        let rest = subject.rest()?;
        let turned = rest.q[subject.index("column_1_theta")?];
        // The column's four grams are neglected against a load of a kilonewton.
        let right = angle.map_or(turned.abs() > 0.1, |angle| (turned.abs() - angle).abs() < 1e-3);
        expect(right, format!("{rest}; {turned:.4} rad"))
    })
}
