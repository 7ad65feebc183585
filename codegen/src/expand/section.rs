//! Cross-sections of beams: height h along y, width b along z.

use std::f64::consts::PI;

use crate::chain::{Moduli, Outline, Value};

/// Properties of a cross-section that a beam needs.
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
    /// Section moduli for stresses, if known.
    pub moduli: Option<Moduli>,
    /// Its outline, if known.
    pub outline: Option<Outline>,
}

/// What a cross-section is made from.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// Height, width and thickness.
    Box([Value; 3]),
    /// Height, width, thickness of the flanges and of the webs.
    WeldedBox([Value; 4]),
    /// Outer diameter and thickness.
    Tube([Value; 2]),
    /// Height and width.
    Solid([f64; 2]),
    /// Diameter.
    Circle(Value),
    /// Given by its numbers.
    Numbers(Box<CrossSection>),
}

impl Shape {
    /// Its name in the spec.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Shape::Box(_) => "box",
            Shape::WeldedBox(_) => "welded_box",
            Shape::Tube(_) => "tube",
            Shape::Solid(_) => "solid",
            Shape::Circle(_) => "circle",
            Shape::Numbers(_) => "numbers",
        }
    }

    /// Its properties.
    pub(crate) fn section(&self) -> CrossSection {
        match self {
            Shape::Box([height, width, thickness]) => hollow_rectangle(height, width, thickness),
            Shape::WeldedBox([height, width, flange, web]) => welded_box([height, width], [flange, web]),
            Shape::Tube([diameter, thickness]) => tube(diameter, thickness),
            Shape::Solid([height, width]) => solid_rectangle(*height, *width),
            Shape::Circle(diameter) => circle(diameter),
            Shape::Numbers(section) => (**section).clone(),
        }
    }

    /// The shape at a fraction of the way to another one, with dimensions that change linearly; `None` unless both are given by
    /// dimensions of the same shape.
    pub(crate) fn between(&self, other: &Shape, share: f64) -> Option<Shape> {
        let mix = |a: &Value, b: &Value| (1.0 - share) * a.clone() + share * b.clone();
        Some(match (self, other) {
            (Shape::Box(a), Shape::Box(b)) => Shape::Box(std::array::from_fn(|k| mix(&a[k], &b[k]))),
            (Shape::WeldedBox(a), Shape::WeldedBox(b)) => Shape::WeldedBox(std::array::from_fn(|k| mix(&a[k], &b[k]))),
            (Shape::Tube(a), Shape::Tube(b)) => Shape::Tube(std::array::from_fn(|k| mix(&a[k], &b[k]))),
            (Shape::Solid(a), Shape::Solid(b)) => {
                Shape::Solid(std::array::from_fn(|k| (1.0 - share) * a[k] + share * b[k]))
            }
            (Shape::Circle(a), Shape::Circle(b)) => Shape::Circle(mix(a, b)),
            _ => return None,
        })
    }
}

fn power(base: &Value, exponent: usize) -> Value {
    std::iter::repeat_n(base.clone(), exponent).fold(Value::ONE, |product, factor| product * factor)
}

/// Hollow rectangle; torsion by Bredt's formula for thin walls, `J_o = 2t(b−t)²(h−t)²/(b+h−2t)`, `W_t = 2t(b−t)(h−t)`.
///
/// Shear by Zhuravskii's formula at the neutral axis, where two walls carry it: `A_y = 2t J_z/S_z` with the first moment
/// `S_z = (b h² − b_i h_i²)/8` of half of the section.
pub(crate) fn hollow_rectangle(height: &Value, width: &Value, thickness: &Value) -> CrossSection {
    let (h, b, t) = (height, width, thickness);
    let inner = |side: &Value| side.clone() - 2.0 * t.clone();
    let middle = |side: &Value| side.clone() - t.clone();
    let (hi, bi) = (inner(h), inner(b));
    let second = |b: &Value, h: &Value| b.clone() * power(h, 3) / 12.0.into();
    let area = b.clone() * h.clone() - bi.clone() * hi.clone();
    let (jy, jz) = (second(h, b) - second(&hi, &bi), second(b, h) - second(&bi, &hi));
    let first =
        |b: &Value, h: &Value, bi: &Value, hi: &Value| 0.125 * (b.clone() * power(h, 2) - bi.clone() * power(hi, 2));
    let walls = || 2.0 * t.clone();
    let moduli = Moduli {
        area: area.clone(),
        bending: [2.0 * jy.clone() / b.clone(), 2.0 * jz.clone() / h.clone()],
        torsion: walls() * middle(b) * middle(h),
        shear: [walls() * jz.clone() / first(b, h, &bi, &hi), walls() * jy.clone() / first(h, b, &hi, &bi)],
        has_corners: true,
    };
    CrossSection {
        area,
        jy,
        jz,
        moduli: Some(moduli),
        outline: Some(Outline { size: [h.clone(), b.clone()], round: false }),
        jo: 2.0 * t.clone() * power(&middle(b), 2) * power(&middle(h), 2) / (b.clone() + h.clone() - 2.0 * t.clone()),
    }
}

/// Hollow rectangle with flanges of thickness `t_f` and webs of thickness `t_w`, `h_m = h − t_f` and `b_m = b − t_w` between their middles;
/// torsion by Bredt's formulas for thin walls, `J_o = 4 (b_m h_m)²/(2b_m/t_f + 2h_m/t_w)` and `W_t = 2 b_m h_m min(t_f, t_w)`.
///
/// Shear by Zhuravskii's formula at the neutral axis, where two webs, or two flanges, carry it: `A_y = 2t_w J_z/S_z`, `A_z = 2t_f J_y/S_y`.
pub(crate) fn welded_box([h, b]: [&Value; 2], [flange, web]: [&Value; 2]) -> CrossSection {
    let twice = |thickness: &Value| 2.0 * thickness.clone();
    let (hi, bi) = (h.clone() - twice(flange), b.clone() - twice(web));
    let second = |b: &Value, h: &Value| b.clone() * power(h, 3) / 12.0.into();
    let first =
        |b: &Value, h: &Value, bi: &Value, hi: &Value| 0.125 * (b.clone() * power(h, 2) - bi.clone() * power(hi, 2));
    let area = b.clone() * h.clone() - bi.clone() * hi.clone();
    let (jy, jz) = (second(h, b) - second(&hi, &bi), second(b, h) - second(&bi, &hi));
    let (hm, bm) = (h.clone() - flange.clone(), b.clone() - web.clone());
    let enclosed = bm.clone() * hm.clone();
    let thinner = 0.5 * (flange.clone() + web.clone() - power(&(flange.clone() - web.clone()), 2).sqrt());
    let moduli = Moduli {
        area: area.clone(),
        bending: [2.0 * jy.clone() / b.clone(), 2.0 * jz.clone() / h.clone()],
        torsion: 2.0 * enclosed.clone() * thinner,
        shear: [twice(web) * jz.clone() / first(b, h, &bi, &hi), twice(flange) * jy.clone() / first(h, b, &hi, &bi)],
        has_corners: true,
    };
    CrossSection {
        area,
        jy,
        jz,
        jo: 2.0 * power(&enclosed, 2) / (bm / flange.clone() + hm / web.clone()),
        moduli: Some(moduli),
        outline: Some(Outline { size: [h.clone(), b.clone()], round: false }),
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

/// Ring; shear at the neutral axis, `A_y = 3J (R − r)/(R³ − r³) = 3J/(R² + Rr + r²)`.
fn ring(outer: &Value, inner: &Value) -> CrossSection {
    let polar = PI / 2.0 * (power(outer, 4) - power(inner, 4));
    let area = PI * (power(outer, 2) - power(inner, 2));
    let second = 0.5 * polar.clone();
    let bending = second.clone() / outer.clone();
    let shear = 3.0 * second.clone() / (power(outer, 2) + outer.clone() * inner.clone() + power(inner, 2));
    let moduli = Moduli {
        area: area.clone(),
        bending: [bending.clone(), bending],
        torsion: polar.clone() / outer.clone(),
        shear: [shear.clone(), shear],
        has_corners: false,
    };
    let diameter = 2.0 * outer.clone();
    let outline = Outline { size: [diameter.clone(), diameter], round: true };
    CrossSection { area, jy: second.clone(), jz: second, jo: polar, moduli: Some(moduli), outline: Some(outline) }
}

/// Solid rectangle; torsion by Saint-Venant's series, with sides a ≥ b:
/// `J_o = a b³ (1/3 − (64/π⁵) (b/a) Σ tanh(nπa/2b)/n⁵)`, n = 1, 3, 5, …, and in the middle of the longer side
/// `W_t = J_o/(b (1 − (8/π²) Σ 1/(n² cosh(nπa/2b))))`. Shear `1.5 Q/A`.
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
    // The terms left out are below rounding, as in the series above.
    let along: f64 = (0..2 * TERMS)
        .rev()
        .map(|k| f64::from(2 * k + 1))
        .map(|n| 1.0 / (n * n * libm::cosh(0.5 * n * PI * a / b)))
        .sum();
    let moduli = Moduli {
        area: (height * width).into(),
        bending: [(height * width.powi(2) / 6.0).into(), (width * height.powi(2) / 6.0).into()],
        torsion: (jo / (b * (1.0 - 8.0 / (PI * PI) * along))).into(),
        shear: [height * width / 1.5, height * width / 1.5].map(Value::from),
        has_corners: true,
    };
    CrossSection {
        area: (height * width).into(),
        jy: (height * width.powi(3) / 12.0).into(),
        jz: (width * height.powi(3) / 12.0).into(),
        jo: jo.into(),
        moduli: Some(moduli),
        outline: Some(Outline { size: [height.into(), width.into()], round: false }),
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

    fn moduli(section: CrossSection) -> Moduli {
        section.moduli.expect("the section has a shape")
    }

    #[test]
    fn moduli_of_a_box() {
        // 0.25 m high, 0.2 m wide, 8 mm thick: W = 2J/h from the second moments, Bredt's 2t(b − t)(h − t), and 2t J/S with
        // S = (0.2 · 0.25² − 0.184 · 0.234²)/8 = 3.031e-4 m³.
        let Moduli { bending, torsion, shear, .. } = moduli(hollow_rectangle(&0.25.into(), &0.2.into(), &0.008.into()));
        close(&bending[1], 2.0 * 6.395e-5 / 0.25, 1e-4);
        close(&bending[0], 2.0 * 4.519e-5 / 0.2, 1e-4);
        close(&torsion, 0.016 * 0.192 * 0.242, 1e-13);
        close(&shear[0], 0.016 * 6.395e-5 / 3.031e-4, 2e-4);
    }

    #[test]
    fn a_welded_box_is_its_four_plates() {
        // By Steiner's theorem, plate by plate: 0.3 m high, 0.2 m wide, flanges of 12 mm and webs of 6 mm between them.
        let (h, b, flange, web) = (0.3, 0.2, 0.012, 0.006);
        let section = welded_box([&h.into(), &b.into()], [&flange.into(), &web.into()]);
        let inner = h - 2.0 * flange;
        close(&section.area, 2.0 * (b * flange + inner * web), 1e-13);
        let flanges = 2.0 * (b * flange.powi(3) / 12.0 + b * flange * (0.5 * (h - flange)).powi(2));
        close(&section.jz, flanges + 2.0 * web * inner.powi(3) / 12.0, 1e-12);
        let webs = 2.0 * (inner * web.powi(3) / 12.0 + inner * web * (0.5 * (b - web)).powi(2));
        close(&section.jy, webs + 2.0 * flange * b.powi(3) / 12.0, 1e-12);
        // Bredt by its line integral; the webs, which are thinner, have the largest shear stress.
        let middle = (h - flange) * (b - web);
        close(&section.jo, 4.0 * middle * middle / (2.0 * (b - web) / flange + 2.0 * (h - flange) / web), 1e-13);
        let Moduli { torsion, shear, .. } = moduli(section.clone());
        close(&torsion, 2.0 * middle * web, 1e-13);
        // First moments of half of the section: a flange and two halves of webs; a web and two halves of flanges.
        let upper = b * flange * 0.5 * (h - flange) + 2.0 * web * (0.5 * inner).powi(2) / 2.0;
        close(&shear[0], 2.0 * web * section.jz.at(&[]) / upper, 1e-12);
        let side = inner * web * 0.5 * (b - web) + 2.0 * flange * (0.5 * b).powi(2) / 2.0;
        close(&shear[1], 2.0 * flange * section.jy.at(&[]) / side, 1e-12);
    }

    #[test]
    fn a_welded_box_of_equal_plates_is_a_box() {
        let [h, b, t] = [0.25, 0.2, 0.008].map(Value::from);
        let (welded, plain) = (welded_box([&h, &b], [&t, &t]), hollow_rectangle(&h, &b, &t));
        for (welded, plain) in
            [(&welded.area, &plain.area), (&welded.jy, &plain.jy), (&welded.jz, &plain.jz), (&welded.jo, &plain.jo)]
        {
            close(welded, plain.at(&[]), 1e-14);
        }
        let (welded, plain) = (moduli(welded), moduli(plain));
        close(&welded.torsion, plain.torsion.at(&[]), 1e-14);
        for k in 0..2 {
            close(&welded.bending[k], plain.bending[k].at(&[]), 1e-14);
            close(&welded.shear[k], plain.shear[k].at(&[]), 1e-14);
        }
    }

    #[test]
    fn moduli_of_solid_rectangles() {
        // Timoshenko & Goodier, section 109: τ = Mx/(k₂ a b²).
        for (ratio, k2, tolerance) in [(1.0, 0.208, 2e-3), (2.0, 0.246, 2e-3), (5.0, 0.291, 2e-3), (10.0, 0.312, 2e-3)]
        {
            close(&moduli(solid_rectangle(ratio * 0.1, 0.1)).torsion, k2 * ratio * 1e-3, tolerance);
            close(&moduli(solid_rectangle(0.1, ratio * 0.1)).torsion, k2 * ratio * 1e-3, tolerance);
        }
        let Moduli { bending, shear, .. } = moduli(solid_rectangle(0.3, 0.1));
        close(&bending[1], 0.1 * 0.09 / 6.0, 1e-14);
        close(&bending[0], 0.3 * 0.01 / 6.0, 1e-14);
        close(&shear[0], 0.02, 1e-14);
    }

    #[test]
    fn moduli_of_circles_and_thin_tubes() {
        let Moduli { bending, torsion, shear, has_corners, .. } = moduli(circle(&0.2.into()));
        close(&bending[0], PI * 1e-3 / 4.0, 1e-14);
        close(&torsion, PI * 1e-3 / 2.0, 1e-14);
        // 4/3 of the mean.
        close(&shear[1], 0.75 * PI * 0.01, 1e-14);
        assert!(!has_corners);
        // For a thin tube, twice the mean.
        let thin = tube(&0.2.into(), &1e-5.into());
        close(&(thin.area.clone() / moduli(thin).shear[0].clone()), 2.0, 1e-4);
    }

    #[test]
    fn outlines_are_height_and_width_of_what_is_given() {
        let size = |section: CrossSection| {
            let Outline { size, round } = section.outline.expect("the section has a shape");
            (size.map(|length| length.at(&[])), round)
        };
        assert_eq!(size(hollow_rectangle(&0.2.into(), &0.1.into(), &0.01.into())), ([0.2, 0.1], false));
        assert_eq!(size(solid_rectangle(0.2, 0.1)), ([0.2, 0.1], false));
        assert_eq!(size(tube(&0.3.into(), &0.01.into())), ([0.3, 0.3], true));
        assert_eq!(size(circle(&0.3.into())), ([0.3, 0.3], true));
    }

    #[test]
    fn rings_and_circles() {
        close(&circle(&0.2.into()).jo, PI * 0.1f64.powi(4) / 2.0, 1e-15);
        let tube = tube(&0.2.into(), &0.01.into());
        close(&tube.area, PI * (0.01 - 0.0081), 1e-13);
        close(&tube.jz, PI * (0.1f64.powi(4) - 0.09f64.powi(4)) / 4.0, 1e-13);
    }
}
