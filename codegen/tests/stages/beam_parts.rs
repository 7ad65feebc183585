//! Stepped, tapered and curved beams: masses, centres of mass and stiffnesses against integrals in closed form, and the shape at rest.

use crane_codegen::chain::{Chain, Frame, Spring, Vector};
use crane_codegen::{SourceFile, read, validate};

const E: f64 = 2.1e11;
const G: f64 = 8.1e10;
const DENSITY: f64 = 7850.0;

/// A crane that consists of a single 3 m beam.
fn beam(keys: &str) -> Chain {
    let text = format!(
        "format: 1\nname: test\nlinks:\n  - name: boom\n    joint: revolute\n    beam: {{length: 3, \
         material: {{E: {E:e}, G: {G:e}, density: {DENSITY}, yield_stress: 3e8}}, {keys}}}\n"
    );
    let source = SourceFile::new("test.yaml", text);
    read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Mass, first and second moment along x about the beginning of the beam, kg, kg m, kg m².
fn moments(chain: &Chain) -> [f64; 3] {
    let mut begin = 0.0;
    let mut sum = [0.0; 3];
    for body in &chain.bodies {
        let inertia = body.inertia.as_ref().expect("an element");
        let [m, x, xx] = [&inertia.mass, &inertia.first[0], &inertia.second[0]].map(|value| value.at(&[]));
        for (sum, of_part) in sum.iter_mut().zip([m, x + m * begin, xx + 2.0 * x * begin + m * begin * begin]) {
            *sum += of_part;
        }
        begin += body.length.at(&[]);
    }
    sum
}

fn assert_close(actual: f64, expected: f64, what: &str) {
    // A few dozen rounding errors, and the error of Gauss quadrature where it is not exact.
    assert!((actual / expected - 1.0).abs() < 1e-12, "{what}: {actual} instead of {expected}");
}

#[test]
fn a_stepped_beam_has_its_mass_where_it_is() {
    let (thick, thin) = (0.2 * 0.2 - 0.18 * 0.18, 0.1 * 0.1);
    for sections in ["rigid", "1", "4", "7"] {
        let chain = beam(&format!(
            "sections: {sections}, extra_mass: 5, parts: [{{length: 1.1, section: {{box: {{height: 0.2, width: 0.2, thickness: 0.01}}}}}}, \
             {{length: 1.9, section: {{solid: {{height: 0.1, width: 0.1}}}}}}]"
        ));
        let [m, x, xx] = moments(&chain);
        let densities = [(0.0, 1.1, DENSITY * thick + 5.0), (1.1, 3.0, DENSITY * thin + 5.0)];
        let integral = |power: i32| -> f64 {
            densities
                .iter()
                .map(|(a, b, mu): &(f64, f64, f64)| mu * (b.powi(power) - a.powi(power)) / f64::from(power))
                .sum()
        };
        assert_close(m, integral(1), sections);
        assert_close(x, integral(2), sections);
        // The extent of the cross-section contributes to the second moments along z and y, not along x.
        assert_close(xx, integral(3), sections);
    }
}

/// A cone: `A = π r²`, r linear, so that mass and moments are polynomials, and `∫ dx/J` is a rational function.
#[test]
fn a_cone_has_its_integrals() {
    let (thick, thin) = (0.15, 0.05);
    let chain = beam(&format!(
        "sections: 5, parts: [{{length: 3, section: {{circle: {{diameter: {}}}}}, to: {{circle: {{diameter: {}}}}}}}]",
        2.0 * thick,
        2.0 * thin
    ));
    let [m, x, _] = moments(&chain);
    let area = std::f64::consts::PI;
    assert_close(m, DENSITY * area * 3.0 / 3.0 * (thick * thick + thick * thin + thin * thin), "mass");
    // ∫ x (a + b x)² dx
    let (a, b, l) = (thick, (thin - thick) / 3.0, 3.0_f64);
    let first = a * a * l.powi(2) / 2.0 + 2.0 * a * b * l.powi(3) / 3.0 + b * b * l.powi(4) / 4.0;
    assert_close(x, DENSITY * area * first, "first moment");
    let radius = |x: f64| a + b * x;
    let springs: Vec<&Spring> = chain.element_springs().collect();
    for (k, springs) in springs.chunks(3).enumerate() {
        let ends = [0.6 * k as f64, 0.6 * (k + 1) as f64];
        // ∫ dx/(E π r⁴/4) = 4/(3 E π b) (1/r₀³ − 1/r₁³)
        let compliance = 4.0 / (3.0 * E * area * b) * (radius(ends[0]).powi(-3) - radius(ends[1]).powi(-3));
        assert_close(springs[0].stiffness.at(&[]), 1.0 / compliance, "bending");
        assert_close(springs[2].stiffness.at(&[]), G * 2.0 / (E * compliance), "torsion");
    }
    // Moduli where the elements begin, and at the end, W = π r³/4.
    let places = [0.0, 0.3, 0.9, 1.5, 2.1, 2.7, 3.0];
    assert_eq!(chain.beams[0].sections.len(), places.len());
    for (x, section) in places.into_iter().zip(&chain.beams[0].sections) {
        let bending = section.moduli.as_ref().expect("known").bending[0].at(&[]);
        assert_close(bending, area * radius(x).powi(3) / 4.0, "modulus");
    }
}

/// A single part is the same as a beam with that cross-section, and so is a taper between equal ends.
#[test]
fn one_part_is_the_beam_without_parts() {
    let section = "{box: {height: 0.25, width: 0.2, thickness: 0.008}}";
    let plain = beam(&format!("sections: 4, section: {section}"));
    for parts in [
        format!("[{{length: 3, section: {section}}}]"),
        format!("[{{length: 0.7, section: {section}}}, {{length: 2.3, section: {section}, to: {section}}}]"),
    ] {
        let divided = beam(&format!("sections: 4, parts: {parts}"));
        for (one, other) in plain.bodies.iter().zip(&divided.bodies) {
            let numbers = |body: &crane_codegen::chain::Body| -> Vec<f64> {
                let inertia = body.inertia.clone().expect("an element");
                let all = [inertia.mass].into_iter().chain(inertia.first).chain(inertia.second);
                all.map(|value| value.at(&[])).collect()
            };
            for (a, b) in numbers(one).iter().zip(numbers(other)) {
                assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} {b}");
            }
        }
        for (one, other) in plain.element_springs().zip(divided.element_springs()) {
            assert_close(other.stiffness.at(&[]), one.stiffness.at(&[]), "spring");
        }
    }
}

/// Position and frame of the tip of a single-beam chain at rest.
fn tip(chain: &Chain) -> (Frame, Vector) {
    let rest = vec![0.0; chain.coordinates.len()];
    let frame = chain
        .bodies
        .iter()
        .flat_map(|body| &body.path)
        .fold(Frame::WORLD, |frame, step| frame.after(step, chain, &rest, &[]));
    let length = chain.bodies.last().expect("an element").length.at(&[]);
    (frame, frame.transform_point([length, 0.0, 0.0]))
}

/// A curved beam at rest is an arc of radius R = l/α: its tip is at `R (sin α, 1 − cos α)` and turned by α. Rigid elements are
/// tangent to the arcs at their midpoints: R is replaced by `(d/2)/tan(α/2n)`, which is smaller by a fraction `(α/n)²/12`.
#[test]
fn a_curved_beam_is_an_arc() {
    let angle = 1.2_f64;
    for (key, plane) in [("psi", 1), ("theta", 2)] {
        for sections in [1, 4, 32] {
            let chain = beam(&format!(
                "sections: {sections}, section: {{circle: {{diameter: 0.1}}}}, bend: {{{key}: {angle}}}"
            ));
            let (frame, tip) = tip(&chain);
            // A positive angle about y turns x towards −z.
            let sign = if plane == 1 { 1.0 } else { -1.0 };
            let step = angle / f64::from(sections);
            let radius = 3.0 / f64::from(sections) / 2.0 / (step / 2.0).tan();
            let polygon = [radius * angle.sin(), sign * radius * (1.0 - angle.cos())];
            assert!(
                (tip[0] - polygon[0]).abs() < 1e-14 && (tip[plane] - polygon[1]).abs() < 1e-14,
                "{tip:?} {polygon:?}"
            );
            assert!((frame.axes[0][0] - angle.cos()).abs() < 1e-14);
            assert!((radius * angle / 3.0 - 1.0).abs() < 1.05 * step * step / 12.0, "{radius}");
        }
    }
}
