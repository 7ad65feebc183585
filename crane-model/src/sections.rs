//! Stresses at the sections of a crane's beams.

use std::cmp::Ordering;

use crate::{Cut, Description, SectionModuli, Stress, Wrench};

/// A section where stresses are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressedSection {
    /// Index of the body that begins at the section.
    pub body: usize,
    /// Distance from the beam's beginning, m.
    pub x: f64,
    /// Its stresses.
    pub stress: Stress,
    /// Equivalent stress over the allowable one, if there is one.
    pub utilisation: Option<f64>,
}

impl StressedSection {
    /// Name of the beam's link.
    pub fn beam<'a>(&self, description: &'a Description) -> &'a str {
        description.bodies[self.body].link.as_str()
    }

    /// Orders sections by utilisation; where no beam has a yield stress, by equivalent stress.
    pub fn by_use(a: &Self, b: &Self) -> Ordering {
        let used = |section: &Self| section.utilisation.unwrap_or(0.0);
        used(a).total_cmp(&used(b)).then(a.stress.equivalent.total_cmp(&b.stress.equivalent))
    }
}

/// All sections whose moduli are known; `moduli` one per section, as [`Description::sections`] lists them, `wrenches` one per cut.
pub fn stressed_sections(
    description: &Description,
    moduli: &[SectionModuli],
    wrenches: &[Wrench],
) -> Vec<StressedSection> {
    let of_sections = description.cuts().into_iter().zip(wrenches).filter_map(|(cut, wrench)| match cut {
        Cut::Body { body, x: Some(x) } => Some((body, x, wrench)),
        _ => None,
    });
    let at = |((body, x, wrench), moduli): ((usize, f64, &Wrench), &SectionModuli)| {
        let stress = moduli.stress(wrench)?;
        Some(StressedSection { body, x, stress, utilisation: moduli.utilisation(&stress) })
    };
    of_sections.zip(moduli).filter_map(at).collect()
}
