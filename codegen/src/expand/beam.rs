//! Beams as rigid finite elements.

use super::inertia::about_com;
use super::section::CrossSection;
use crate::chain::{Inertia, Value};

/// A rigid finite element.
#[derive(Clone, Debug)]
pub(crate) struct RigidElement {
    /// Length along x, m.
    pub length: Value,
    /// Pseudo-inertia about its start.
    pub inertia: Inertia,
}

/// Spring and damper between two elements, about z (ψ), y (θ), x (φ).
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    /// Stiffness, N m/rad.
    pub stiffness: [Value; 3],
    /// Damping, N m s/rad.
    pub damping: [Value; 3],
}

/// A beam of rigid elements with a joint between neighbours.
#[derive(Clone, Debug)]
pub(crate) struct Elements {
    /// Elements, from the start to the tip.
    pub elements: Vec<RigidElement>,
    /// Joints, one fewer.
    pub joints: Vec<Joint>,
}

/// Lengths of the elements of a beam of n equal sections, [Urbaś 2016, section 2.2]: a spring is in the middle of each
/// section of length `d = l/n`, so that the elements are `d/2, d, …, d, d/2` long.
pub(crate) fn element_lengths(length: &Value, sections: usize) -> Vec<Value> {
    let section = length.clone() / (sections as f64).into();
    let half = 0.5 * section.clone();
    let mut lengths = vec![section; sections + 1];
    lengths[0] = half.clone();
    lengths[sections] = half;
    lengths
}

/// A prismatic element of length ℓ with line density μ, kg/m:
/// `m = μℓ`, `I_x = m(J_y+J_z)/A`, `I_y = m(ℓ²/12 + J_y/A)`, `I_z = m(ℓ²/12 + J_z/A)`, centre of mass at ℓ/2.
pub(crate) fn prismatic(length: Value, line_density: &Value, section: &CrossSection) -> RigidElement {
    let mass = line_density.clone() * length.clone();
    // Squares of the section's radii of gyration.
    let iy2 = section.jy.clone() / section.area.clone();
    let iz2 = section.jz.clone() / section.area.clone();
    let slender = length.clone() * length.clone() / 12.0.into();
    let tensor = [
        mass.clone() * (iy2.clone() + iz2.clone()),
        mass.clone() * (slender.clone() + iy2),
        mass.clone() * (slender + iz2),
        Value::ZERO,
        Value::ZERO,
        Value::ZERO,
    ];
    let com = [0.5 * length.clone(), Value::ZERO, Value::ZERO];
    RigidElement { inertia: about_com(mass, &com, &tensor), length }
}

/// Stiffness of the spring of a section of length d, [Urbaś 2016, Eqs. (14)–(15)]:
/// `s_ψ = E J_z/d`, `s_θ = E J_y/d`, `s_φ = G J_o/d`, N m/rad.
pub(crate) fn stiffness(youngs: &Value, shear: &Value, section: &CrossSection, d: &Value) -> [Value; 3] {
    let spring = |modulus: &Value, moment: &Value| modulus.clone() * moment.clone() / d.clone();
    [spring(youngs, &section.jz), spring(youngs, &section.jy), spring(shear, &section.jo)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expand::section::hollow_rectangle;

    fn boom() -> CrossSection {
        hollow_rectangle(&0.25.into(), &0.2.into(), &0.008.into())
    }

    #[test]
    fn elements_of_the_reference_boom() {
        let lengths: Vec<f64> = element_lengths(&3.5.into(), 4).iter().map(|l| l.at(&[])).collect();
        assert_eq!(lengths, [0.4375, 0.875, 0.875, 0.875, 0.4375]);
        let one: Vec<f64> = element_lengths(&3.5.into(), 1).iter().map(|l| l.at(&[])).collect();
        assert_eq!(one, [1.75, 1.75]);

        let line_density = Value::from(7850.0) * boom().area + 62.0896.into();
        let mass: f64 =
            lengths.iter().map(|l| prismatic((*l).into(), &line_density, &boom()).inertia.mass.at(&[])).sum();
        // 116.6 kg/m over 3.5 m, to all given digits.
        assert!((mass - 408.1).abs() < 1e-9, "{mass}");
    }

    #[test]
    fn springs_of_the_reference_boom() {
        let springs = stiffness(&2.1e11.into(), &8.1e10.into(), &boom(), &0.875.into());
        // The section's moments are known to four digits.
        for (spring, expected) in springs.iter().zip([1.5348e7, 1.0846e7, 7.3678e6]) {
            assert!((spring.at(&[]) / expected - 1.0).abs() < 2e-4, "{spring:?} {expected}");
        }
    }

    #[test]
    fn halves_have_the_pseudo_inertia_of_the_whole() {
        // Two halves end to end are the whole beam: ∫x² = m l²/3 however it is divided.
        let density = Value::from(100.0);
        let whole = prismatic(2.0.into(), &density, &boom()).inertia;
        let half = prismatic(1.0.into(), &density, &boom()).inertia;
        let [m, mx, mxx] = [&half.mass, &half.first[0], &half.second[0]].map(|v| v.at(&[]));
        let moved = mxx + 2.0 * mx + m;
        assert!((whole.second[0].at(&[]) - (mxx + moved)).abs() < 1e-12 * moved);
        assert!((whole.second[1].at(&[]) - 2.0 * half.second[1].at(&[])).abs() < 1e-14);
    }
}
