//! Places along a crane's beams: what they carry, and their stresses. Every table, diagram, file, limit and derivative reads this list.

use std::cmp::Ordering;
use std::ops::Range;

use crate::{Cut, Description, SectionInfo, SectionModuli, Stress, Wrench};

/// A place of a beam in a pose, on one side of what is there, and what it carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Its index among [`Description::sections`].
    pub section: usize,
    /// Index of its cut.
    pub cut: usize,
    /// Distance from the beginning of the beam, m.
    pub x: f64,
    /// What the part beyond exerts on the part before, in the section's frame.
    pub wrench: Wrench,
    /// Whose moduli it has.
    pub moduli: Between,
}

/// A mean of two sections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Their indices; twice the same for a section with its own.
    pub sections: [usize; 2],
    /// The part of the second.
    pub part: f64,
}

impl Between {
    const fn own(section: usize) -> Self {
        Self { sections: [section; 2], part: 0.0 }
    }

    /// The mean of numbers of both sections.
    pub fn mean<T>(&self, of: impl Fn(usize) -> T, mean: impl Fn(T, T, f64) -> T) -> T {
        let [one, other] = self.sections;
        if self.part == 0.0 { of(one) } else { mean(of(one), of(other), self.part) }
    }
}

impl Place {
    /// What the description says about it.
    pub fn info<'a>(&self, description: &'a Description) -> &'a SectionInfo {
        &description.sections[self.section]
    }

    /// Its moduli, of those of the sections.
    pub fn section_moduli(&self, moduli: &[SectionModuli]) -> SectionModuli {
        let of = |section: usize| moduli.get(section).copied().unwrap_or(SectionModuli::ZERO);
        self.moduli.mean(of, |one, other, part| one.mean(&other, part))
    }

    /// Name of the beam's link.
    pub fn beam<'a>(&self, description: &'a Description) -> &'a str {
        description.bodies[self.info(description).body].link.as_str()
    }

    /// Where it is, in words: the beam, the distance from its start, and what is there.
    pub fn location(&self, description: &Description) -> String {
        location(description, self.section, Some(self.x))
    }
}

/// Where a section is, in words: `x` m from the beginning of its beam. Where that differs from pose to pose and none is meant, it has no distance.
pub fn location(description: &Description, section: usize, x: Option<f64>) -> String {
    let info = &description.sections[section];
    let beam = description.bodies[info.body].link.to_string();
    let distance = x.map(|x| format!("{x:.3} m from its start"));
    let what = (!info.at.is_empty()).then(|| info.location());
    [Some(beam), distance, what].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// All places of beams and ropes in a pose, beam by beam from the beginning to the end; `x` where the sections are, m, `wrenches` one per cut.
pub fn places(description: &Description, x: &[f64], wrenches: &[Wrench]) -> Vec<Place> {
    let mut cuts = vec![None; x.len()];
    for (index, cut) in description.cuts().iter().enumerate() {
        if let Some(section) = Cut::section(cut) {
            cuts[section] = Some(index);
        }
    }
    let of_beam = |beam: Range<usize>| {
        let mut order: Vec<usize> = beam.collect();
        order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
        let place = |(position, &section): (usize, &usize)| {
            let cut = cuts[section]?;
            let moduli = around(description, x, &order, position);
            Some(Place { section, cut, x: x[section], wrench: *wrenches.get(cut)?, moduli })
        };
        order.iter().enumerate().filter_map(place).collect::<Vec<_>>()
    };
    description.sections_of_beams().into_iter().flat_map(of_beam).collect()
}

/// The sections whose moduli a place has: its own, or where it slides those around it. Between them the shape changes linearly.
fn around(description: &Description, x: &[f64], order: &[usize], position: usize) -> Between {
    let section = order[position];
    let fixed = |section: &&usize| !description.sections[**section].slides;
    let before = order[..position].iter().rev().find(fixed);
    let after = order[position..].iter().find(fixed);
    match (description.sections[section].slides, before, after) {
        (false, ..) | (_, None, None) => Between::own(section),
        (_, Some(&one), None) | (_, None, Some(&one)) => Between::own(one),
        (_, Some(&one), Some(&other)) => {
            let way = x[other] - x[one];
            Between { sections: [one, other], part: if way > 0.0 { (x[section] - x[one]) / way } else { 0.0 } }
        }
    }
}

/// A place where stresses are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressedSection {
    /// The place.
    pub place: Place,
    /// Its stresses.
    pub stress: Stress,
    /// Equivalent stress over the allowable one, if there is one.
    pub utilisation: Option<f64>,
}

impl StressedSection {
    /// What the description says about it.
    pub fn info<'a>(&self, description: &'a Description) -> &'a SectionInfo {
        self.place.info(description)
    }

    /// Name of the beam's link.
    pub fn beam<'a>(&self, description: &'a Description) -> &'a str {
        self.place.beam(description)
    }

    /// Where it is, in words: the beam, the distance from its start, and what is there.
    pub fn location(&self, description: &Description) -> String {
        self.place.location(description)
    }

    /// Orders sections by equivalent stress.
    pub fn by_stress(a: &Self, b: &Self) -> Ordering {
        a.stress.equivalent.total_cmp(&b.stress.equivalent)
    }

    /// Orders sections by utilisation; where no beam has a yield stress, by equivalent stress.
    pub fn by_use(a: &Self, b: &Self) -> Ordering {
        let used = |section: &Self| section.utilisation.unwrap_or(0.0);
        used(a).total_cmp(&used(b)).then(Self::by_stress(a, b))
    }
}

/// All [places] in a pose whose moduli are known; `moduli` one per section, as [`Description::sections`] lists them, the rest as there.
pub fn stressed_sections(
    description: &Description,
    moduli: &[SectionModuli],
    x: &[f64],
    wrenches: &[Wrench],
) -> Vec<StressedSection> {
    places(description, x, wrenches).into_iter().filter_map(|place| stressed(moduli, place)).collect()
}

/// The stresses of a place; `None` where its moduli are not known.
pub fn stressed(moduli: &[SectionModuli], place: Place) -> Option<StressedSection> {
    let moduli = place.section_moduli(moduli);
    let stress = moduli.stress(&place.wrench)?;
    Some(StressedSection { place, stress, utilisation: moduli.utilisation(&stress) })
}
