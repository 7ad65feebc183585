//! Materials, cross-sections and damping of beams.

use super::{Plausibility, rounded};
use crate::chain::{CoordinateKind, Force, Group, Spring};
use crate::diagnostic::{Span, rule};
use crate::spec::{Beam, Either, Link, Material, Number, Section, Spanned, entries};

/// Moduli of beam materials, from plastics (2e9 Pa) to tungsten (4e11 Pa), with a margin, Pa.
const YOUNGS_MODULUS: std::ops::RangeInclusive<f64> = 1e9..=1e12;
/// Shear moduli, down to that of wood (5e8 Pa), with a margin, Pa.
const SHEAR_MODULUS: std::ops::RangeInclusive<f64> = 1e8..=5e11;
/// Yield stresses, from soft plastics to piano wire, Pa.
const YIELD_STRESS: std::ops::RangeInclusive<f64> = 1e6..=5e9;
/// Densities from balsa to osmium, kg/m³.
const DENSITY: std::ops::RangeInclusive<f64> = 100.0..=25_000.0;
/// A side of a cross-section beyond this is not in m.
const LONGEST_SIDE: f64 = 5.0;
/// An area beyond this is not in m²: 20 cm × 20 cm in cm² is 400.
const LARGEST_AREA: f64 = 4.0;
/// A second moment of area beyond this is not in m⁴: that of a box of 2 m × 2 m with walls of 5 cm is 0.25.
const LARGEST_MOMENT: f64 = 10.0;
/// Rounding of a second moment of area written with a few digits.
const WRITTEN: f64 = 0.01;
/// `β ω` of the lowest bending vibration beyond which the damping is probably a mistake: from 2 on, the vibration is overdamped.
const MOST_DAMPED: f64 = 10.0;
/// `λ²` of the lowest bending vibration of a cantilever, `ω = λ² √(EJ/μl⁴)`, `cos λ cosh λ = −1`.
const LOWEST_BENDING: f64 = 3.516;

/// Help for a modulus, depending on its magnitude: in a unit larger than Pa, the number is too small.
fn in_pascal(given: f64) -> String {
    let unit =
        [("GPa", 1e9, 1.0..1e3), ("MPa", 1e6, 1e3..1e6)].into_iter().find(|(_, _, range)| range.contains(&given));
    match unit {
        Some((unit, factor, _)) => format!("write it in Pa: {given} {unit} = {:e} Pa", given * factor),
        None => "write it in Pa; steel has E = 2.1e11, G = 8.1e10".to_owned(),
    }
}

/// A side of a hollow section is at most this many times as long as its wall is thick.
const THINNEST: f64 = 300.0;
/// Largest usual thickness of a wall, relative to the smaller side of the section.
const THICKEST: f64 = 0.25;

impl Plausibility<'_> {
    pub(super) fn beams(&mut self) {
        let crane = self.crane;
        let materials = crane.materials.as_ref().and_then(|materials| materials.value.as_ref());
        for (name, material) in materials.into_iter().flat_map(|materials| &materials.0) {
            if let (Some(name), Some(material)) = (&name.value, &material.value) {
                self.material(material, &format!("material `{name}`"));
            }
        }
        for link in entries(Some(&crane.links)) {
            if let Some(beam) = link.beam.as_ref().and_then(|beam| beam.value.as_ref()) {
                self.beam(link, beam);
            }
        }
    }

    fn beam(&mut self, link: &Link, beam: &Beam) {
        let name = link.name.value.as_deref().unwrap_or_default();
        let subject = format!("beam `{name}`");
        if let Some(Either::Full(material)) = beam.material.as_ref().and_then(|material| material.value.as_ref()) {
            self.material(material, &subject);
        }
        if let Some(given) = &beam.safety_factor {
            let (factor, at) = self.number(given);
            if factor < 1.0 {
                self.warn(rule::unsafe_factor(at, name, factor));
            }
        }
        let of_parts = entries(beam.parts.as_ref()).flat_map(|part| [Some(&part.section), part.to.as_ref()]);
        let sections = std::iter::once(beam.section.as_ref()).chain(of_parts).flatten();
        for section in sections.filter_map(|section| section.value.as_ref()) {
            self.section(section, &subject, self.number(&beam.length).0);
        }
    }

    pub(super) fn damping(&mut self) {
        for link in entries(Some(&self.crane.links)) {
            let damping = link.beam.as_ref().and_then(|beam| beam.value.as_ref()?.damping.as_ref());
            if let (Some(name), Some(damping)) = (&link.name.value, damping) {
                self.damping_of(name, damping.span);
            }
        }
    }

    fn material(&mut self, material: &Material, subject: &str) {
        let ((e, at), (g, at_g)) = (self.number(&material.youngs_modulus), self.number(&material.shear_modulus));
        let (density, at_density) = self.number(&material.density);
        if !YOUNGS_MODULUS.contains(&e) {
            self.warn(rule::modulus(at, "Young's modulus `E`", subject, e, "1e9 to 1e12", in_pascal(e)));
        }
        if !SHEAR_MODULUS.contains(&g) {
            self.warn(rule::modulus(at_g, "the shear modulus `G`", subject, g, "1e8 to 5e11", in_pascal(g)));
        }
        if let Some((stress, at)) = material.yield_stress.as_ref().map(|given| self.number(given))
            && !YIELD_STRESS.contains(&stress)
        {
            let help = if (10.0..=5e3).contains(&stress) {
                format!("write it in Pa: {stress} MPa = {:e} Pa", stress * 1e6)
            } else {
                "write it in Pa; structural steel has 2.35e8 to 1.1e9".to_owned()
            };
            self.warn(rule::modulus(at, "the `yield_stress`", subject, stress, "1e6 to 5e9", help));
        }
        if YOUNGS_MODULUS.contains(&e) && SHEAR_MODULUS.contains(&g) && g > 0.5 * e {
            self.warn(rule::poisson(at_g, subject, rounded(e / (2.0 * g) - 1.0)));
        }
        if !DENSITY.contains(&density) {
            let help = if (0.5..=25.0).contains(&density) {
                format!("write it in kg/m³: {density} t/m³ = {} kg/m³", rounded(1e3 * density))
            } else {
                "write it in kg/m³; steel has 7850".to_owned()
            };
            self.warn(rule::density(at_density, subject, density, help));
        }
    }

    fn section(&mut self, section: &Section, subject: &str, length: f64) {
        let sides: Vec<(&str, &Spanned<Number>)> = match section {
            Section::Box { height, width, .. }
            | Section::WeldedBox { height, width, .. }
            | Section::Solid { height, width } => {
                vec![("height", height), ("width", width)]
            }
            Section::Tube { diameter, .. } | Section::Circle { diameter } => vec![("diameter", diameter)],
            Section::Numbers { area, jy, jz, jo, .. } => return self.section_numbers([area, jy, jz, jo], subject),
        };
        let walls: Vec<(&str, &Spanned<Number>)> = match section {
            Section::Box { thickness, .. } | Section::Tube { thickness, .. } => vec![("thickness", thickness)],
            Section::WeldedBox { flange, web, .. } => vec![("flange", flange), ("web", web)],
            Section::Solid { .. } | Section::Circle { .. } | Section::Numbers { .. } => Vec::new(),
        };
        let least = sides.iter().map(|(_, given)| self.number(given).0).fold(f64::INFINITY, f64::min);
        // Only the first implausible number is reported.
        for (key, given) in walls {
            let (thickness, at) = self.number(given);
            if thickness > THICKEST * least {
                return self.warn(rule::thick_wall(at, subject, key, thickness, least));
            }
            if THINNEST * thickness < least {
                return self.warn(rule::thin_wall(at, subject, key, thickness, least));
            }
        }
        for (key, given) in sides {
            let (side, at) = self.number(given);
            if side > LONGEST_SIDE {
                return self.warn(rule::section_size(at, subject, format!("a `{key}` of {side} m"), in_metres(side)));
            }
            if side > length {
                return self.warn(rule::stubby(at, subject, key, side, length));
            }
        }
    }

    fn section_numbers(&mut self, [area, jy, jz, jo]: [&Spanned<Number>; 4], subject: &str) {
        let (a, at) = self.number(area);
        if a > LARGEST_AREA {
            let help = "write it in m²: 1 mm² is 1e-6, 1 cm² is 1e-4";
            return self.warn(rule::section_size(at, subject, format!("an `area` of {a} m²"), help));
        }
        for (key, given) in [("Jy", jy), ("Jz", jz), ("Jo", jo)] {
            let (moment, at) = self.number(given);
            if moment > LARGEST_MOMENT {
                let help = "write it in m⁴: 1 mm⁴ is 1e-12, 1 cm⁴ is 1e-8";
                return self.warn(rule::section_size(at, subject, format!("`{key}` = {moment} m⁴"), help));
            }
        }
        let ((jy, _), (jz, _), (jo, at)) = (self.number(jy), self.number(jz), self.number(jo));
        if jo > (1.0 + WRITTEN) * (jy + jz) {
            let polar = format!("{:e}", rounded(jy + jz));
            self.warn(rule::torsion_constant(at, subject, format!("{jo:e}"), polar));
        }
    }

    /// Damping proportional to stiffness, evaluated for the lowest bending vibration of the beam alone, clamped at one end.
    fn damping_of(&mut self, link: &str, at: Span) {
        let bodies: Vec<_> = self.chain.bodies.iter().filter(|body| body.link == link).collect();
        let now = |value: &crate::chain::Value| value.at(&self.values);
        let length: f64 = bodies.iter().map(|body| now(&body.length)).sum();
        let mass: f64 = bodies.iter().filter_map(|body| body.inertia.as_ref()).map(|inertia| now(&inertia.mass)).sum();
        let springs = self.chain.forces_of_group(Group::Elements).iter().filter(|spring| {
            let Some(id) = spring.coordinate() else { return false };
            let coordinate = &self.chain.coordinates[id.0];
            // Torsion is about x; its frequencies are higher.
            coordinate.kind == CoordinateKind::Rotation
                && coordinate.axis != crate::chain::Axis::X
                && self.chain.bodies[coordinate.body.0].link == link
        });
        let of = |spring: &Spring| {
            let (stiffness, damping) = (now(&spring.stiffness), now(&spring.damping));
            // n springs of stiffness s correspond to EJ = s l/n.
            let frequency = LOWEST_BENDING * (stiffness / (mass * (bodies.len() - 1) as f64)).sqrt() / length;
            (damping / stiffness, frequency)
        };
        let worst =
            springs.filter_map(Force::spring).map(of).filter(|(beta, frequency)| beta * frequency > MOST_DAMPED);
        let worst = worst.max_by(|(a, f), (b, g)| (a * f).total_cmp(&(b * g)));
        if let Some((beta, frequency)) = worst {
            self.warn(rule::overdamped(at, link, rounded(beta), rounded(frequency), rounded(beta * frequency)));
        }
    }
}

/// Help for a length that is probably in mm.
pub(super) fn in_metres(given: f64) -> String {
    format!("write it in m: {given} mm = {} m", rounded(1e-3 * given))
}
