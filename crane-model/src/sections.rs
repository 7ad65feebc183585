//! Stresses at the sections of a crane's beams.

use std::cmp::Ordering;

use crate::{Cut, Description, SectionInfo, SectionModuli, Stress, Wrench};

/// A section where stresses are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressedSection {
    /// Its index among [`Description::sections`].
    pub section: usize,
    /// Its stresses.
    pub stress: Stress,
    /// Equivalent stress over the allowable one, if there is one.
    pub utilisation: Option<f64>,
}

impl StressedSection {
    /// Where it is.
    pub fn info<'a>(&self, description: &'a Description) -> &'a SectionInfo {
        &description.sections[self.section]
    }

    /// Name of the beam's link.
    pub fn beam<'a>(&self, description: &'a Description) -> &'a str {
        description.bodies[self.info(description).body].link.as_str()
    }

    /// Where it is, in words: the beam, the distance from its start, and what is there.
    pub fn location(&self, description: &Description) -> String {
        let info = self.info(description);
        let text = format!("{}, {:.3} m from its start", self.beam(description), info.x);
        if info.at.is_empty() { text } else { format!("{text}, {}", info.location()) }
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
    let at = |(cut, wrench): (Cut, &Wrench)| {
        let section = cut.section()?;
        let moduli = moduli.get(section)?;
        let stress = moduli.stress(wrench)?;
        Some(StressedSection { section, stress, utilisation: moduli.utilisation(&stress) })
    };
    description.cuts().into_iter().zip(wrenches).filter_map(at).collect()
}
