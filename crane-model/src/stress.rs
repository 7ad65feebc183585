//! Stresses of beams from the forces and moments of their sections.
//!
//! The stresses are elastic, for a straight prismatic beam: they do not cover buckling of plates or of the beam, notches, welds,
//! holes or load introduction, and are not a verification by a design code.

use bytemuck::{Pod, Zeroable};

#[cfg(feature = "std")]
use crate::wrench::Wrench;

/// Properties that relate forces and moments of a section to its largest stresses; all zero if the spec does not give them.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct SectionModuli {
    /// Area, m²: `σ = N/A`.
    pub area: f64,
    /// Modulus of bending about y, m³.
    pub bending_y: f64,
    /// Modulus of bending about z, m³.
    pub bending_z: f64,
    /// Modulus of torsion, m³: the largest `τ = Mx/W`.
    pub torsion: f64,
    /// Shear area along y, m²: the largest `τ = Qy/A`.
    pub shear_y: f64,
    /// Shear area along z, m².
    pub shear_z: f64,
    /// 1 if the stresses of bending about y and z add up in a corner, 0 for a round section, where they combine as a vector.
    pub corners: f64,
    /// Yield stress over the safety factor, Pa; 0 without a yield stress.
    pub allowable_stress: f64,
}

impl SectionModuli {
    /// Unknown moduli.
    pub const ZERO: SectionModuli = SectionModuli {
        area: 0.0,
        bending_y: 0.0,
        bending_z: 0.0,
        torsion: 0.0,
        shear_y: 0.0,
        shear_z: 0.0,
        corners: 0.0,
        allowable_stress: 0.0,
    };
}

/// Largest stresses of a section, Pa, not negative.
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stress {
    /// Normal stress of N, My and Mz, at the corner or on the rim where it is largest.
    pub normal: f64,
    /// Shear stress of Qy and Qz, at the neutral axis.
    pub shear: f64,
    /// Shear stress of Mx.
    pub torsion: f64,
    /// Von Mises equivalent stress `√(σ² + 3τ²)` with the largest σ and the sum of both τ, as if they acted at one point: an upper
    /// bound of the true one.
    pub equivalent: f64,
}

#[cfg(feature = "std")]
impl SectionModuli {
    /// A mean with another one, which counts for a `part`.
    #[must_use]
    pub fn mean(&self, other: &Self, part: f64) -> Self {
        let mean = |of: fn(&Self) -> f64| of(self) + part * (of(other) - of(self));
        Self {
            area: mean(|moduli| moduli.area),
            bending_y: mean(|moduli| moduli.bending_y),
            bending_z: mean(|moduli| moduli.bending_z),
            torsion: mean(|moduli| moduli.torsion),
            shear_y: mean(|moduli| moduli.shear_y),
            shear_z: mean(|moduli| moduli.shear_z),
            corners: mean(|moduli| moduli.corners),
            allowable_stress: mean(|moduli| moduli.allowable_stress),
        }
    }

    /// Stresses of a section that transmits a wrench, in the section's frame; `None` if its moduli are not known.
    pub fn stress(&self, Wrench { force, moment }: &Wrench) -> Option<Stress> {
        if self.area <= 0.0 {
            return None;
        }
        let (about_y, about_z) = ((moment.y / self.bending_y).abs(), (moment.z / self.bending_z).abs());
        let bending = if self.corners > 0.5 { about_y + about_z } else { about_y.hypot(about_z) };
        let normal = (force.x / self.area).abs() + bending;
        let shear = (force.y / self.shear_y).hypot(force.z / self.shear_z);
        let torsion = (moment.x / self.torsion).abs();
        Some(Stress { normal, shear, torsion, equivalent: normal.hypot(3.0f64.sqrt() * (shear + torsion)) })
    }

    /// Equivalent stress over the allowable one; `None` without a yield stress.
    pub fn utilisation(&self, stress: &Stress) -> Option<f64> {
        (self.allowable_stress > 0.0).then(|| stress.equivalent / self.allowable_stress)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    const SECTION: SectionModuli = SectionModuli {
        area: 2.0,
        bending_y: 4.0,
        bending_z: 5.0,
        torsion: 10.0,
        shear_y: 1.0,
        shear_z: 0.5,
        corners: 1.0,
        allowable_stress: 50.0,
    };

    #[test]
    fn bending_adds_up_in_a_corner_and_not_on_a_rim() {
        let wrench = Wrench { force: Vector3::new(-2.0, 0.0, 0.0), moment: Vector3::new(0.0, 12.0, -20.0) };
        let stress = SECTION.stress(&wrench).unwrap();
        assert_eq!(stress, Stress { normal: 8.0, shear: 0.0, torsion: 0.0, equivalent: 8.0 });
        assert_eq!(SECTION.utilisation(&stress), Some(0.16));
        let round = SectionModuli { corners: 0.0, ..SECTION };
        assert_eq!(round.stress(&wrench).unwrap().normal, 1.0 + 5.0);
    }

    /// `√(4² + 3 (5 + 2)²)`
    #[test]
    fn shear_and_torsion_join_in_the_equivalent_stress() {
        let wrench = Wrench { force: Vector3::new(8.0, 3.0, 2.0), moment: Vector3::new(-20.0, 0.0, 0.0) };
        let stress = SECTION.stress(&wrench).unwrap();
        assert_eq!((stress.normal, stress.shear, stress.torsion), (4.0, 5.0, 2.0));
        assert!((stress.equivalent - 163.0f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn nothing_is_made_up() {
        assert_eq!(SectionModuli::ZERO.stress(&Wrench::ZERO), None);
        let without_yield = SectionModuli { allowable_stress: 0.0, ..SECTION };
        let stress = without_yield.stress(&Wrench::ZERO).unwrap();
        assert_eq!(without_yield.utilisation(&stress), None);
    }
}
