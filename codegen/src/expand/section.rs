//! Cross-sections of beams: height h along y, width b along z.

use std::f64::consts::PI;

use crate::chain::Value;

/// What a beam needs to know of its cross-section.
#[derive(Clone, Debug)]
pub(crate) struct CrossSection {
    /// Area A, m².
    pub area: Value,
    /// `∫ z² dA`, m⁴: bending in the x–z plane, about y.
    pub jy: Value,
    /// `∫ y² dA`, m⁴: bending in the x–y plane, about z.
    pub jz: Value,
    /// Torsion constant, m⁴.
    pub jo: Value,
}

fn power(base: &Value, exponent: usize) -> Value {
    std::iter::repeat_n(base.clone(), exponent).fold(Value::ONE, |product, factor| product * factor)
}

/// Hollow rectangle; torsion by Bredt's formula for thin walls, `J_o = 2t(b−t)²(h−t)²/(b+h−2t)`.
pub(crate) fn hollow_rectangle(height: &Value, width: &Value, thickness: &Value) -> CrossSection {
    let (h, b, t) = (height, width, thickness);
    let inner = |side: &Value| side.clone() - 2.0 * t.clone();
    let middle = |side: &Value| side.clone() - t.clone();
    let (hi, bi) = (inner(h), inner(b));
    let second = |b: &Value, h: &Value| b.clone() * power(h, 3) / 12.0.into();
    CrossSection {
        area: b.clone() * h.clone() - bi.clone() * hi.clone(),
        jy: second(h, b) - second(&hi, &bi),
        jz: second(b, h) - second(&bi, &hi),
        jo: 2.0 * t.clone() * power(&middle(b), 2) * power(&middle(h), 2) / (b.clone() + h.clone() - 2.0 * t.clone()),
    }
}

/// Hollow circle of outer radius R and inner radius r: `J_o = π(R⁴ − r⁴)/2 = 2 J_y = 2 J_z`.
pub(crate) fn tube(diameter: &Value, thickness: &Value) -> CrossSection {
    let outer = 0.5 * diameter.clone();
    let inner = outer.clone() - thickness.clone();
    ring(&outer, &inner)
}

/// Solid circle.
pub(crate) fn circle(diameter: &Value) -> CrossSection {
    ring(&(0.5 * diameter.clone()), &Value::ZERO)
}

fn ring(outer: &Value, inner: &Value) -> CrossSection {
    let polar = PI / 2.0 * (power(outer, 4) - power(inner, 4));
    CrossSection {
        area: PI * (power(outer, 2) - power(inner, 2)),
        jy: 0.5 * polar.clone(),
        jz: 0.5 * polar.clone(),
        jo: polar,
    }
}

/// Solid rectangle; torsion by Saint-Venant's series, with sides a ≥ b:
/// `J_o = a b³ (1/3 − (64/π⁵) (b/a) Σ tanh(nπa/2b)/n⁵)`, n = 1, 3, 5, …
///
/// The series itself converges as n⁻⁴; with `tanh x = 1 − 2/(e²ˣ + 1)` its slow part is `Σ n⁻⁵ = 31/32 ζ(5)` and the rest
/// falls as e^{−nπ}.
pub(crate) fn solid_rectangle(height: f64, width: f64) -> CrossSection {
    const ZETA_5: f64 = 1.036_927_755_143_37;
    /// The first term left out is below e^{−21π} of the sum.
    const TERMS: u32 = 10;
    let (a, b) = (height.max(width), height.min(width));
    let falling: f64 = (0..TERMS)
        .rev() // smallest first, for rounding
        .map(|k| f64::from(2 * k + 1))
        .map(|n| 2.0 / ((libm::exp(n * PI * a / b) + 1.0) * n.powi(5)))
        .sum();
    let series = 31.0 / 32.0 * ZETA_5 - falling;
    let jo = a * b.powi(3) * (1.0 / 3.0 - 64.0 / PI.powi(5) * (b / a) * series);
    CrossSection {
        area: (height * width).into(),
        jy: (height * width.powi(3) / 12.0).into(),
        jz: (width * height.powi(3) / 12.0).into(),
        jo: jo.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative error.
    fn close(value: &Value, expected: f64, tolerance: f64) {
        let error = (value.at(&[]) / expected - 1.0).abs();
        assert!(error < tolerance, "{value:?} instead of {expected}: {error:e}");
    }

    #[test]
    fn box_of_the_reference_boom() {
        let section = hollow_rectangle(&0.25.into(), &0.2.into(), &0.008.into());
        // The expected values are given to four digits.
        close(&section.area, 6.944e-3, 1e-4);
        close(&section.jz, 6.395e-5, 1e-4);
        close(&section.jy, 4.519e-5, 1e-4);
        close(&section.jo, 7.959e-5, 1e-4);
    }

    #[test]
    fn torsion_of_solid_rectangles() {
        // Timoshenko & Goodier, Theory of Elasticity, section 109: J = k₁ a b³, k₁ to three or four digits.
        for (ratio, k1, tolerance) in [(1.0, 0.1406, 3e-4), (2.0, 0.229, 2e-3), (5.0, 0.291, 2e-3), (10.0, 0.312, 2e-3)]
        {
            close(&solid_rectangle(ratio * 0.1, 0.1).jo, k1 * ratio * 1e-4, tolerance);
            close(&solid_rectangle(0.1, ratio * 0.1).jo, k1 * ratio * 1e-4, tolerance);
        }
        // The square to more digits: 0.140577.
        close(&solid_rectangle(1.0, 1.0).jo, 0.140_577, 1e-6);
    }

    #[test]
    fn rings_and_circles() {
        close(&circle(&0.2.into()).jo, PI * 0.1f64.powi(4) / 2.0, 1e-15);
        let tube = tube(&0.2.into(), &0.01.into());
        close(&tube.area, PI * (0.01 - 0.0081), 1e-13);
        close(&tube.jz, PI * (0.1f64.powi(4) - 0.09f64.powi(4)) / 4.0, 1e-13);
    }
}
