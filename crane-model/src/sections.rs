//! Places along a crane's beams: what they carry, and their stresses. Every table, diagram, file, limit and derivative reads this list.

use std::cmp::Ordering;
use std::ops::Range;

use crate::{Cut, Description, SectionInfo, SectionModuli, Side, Stress, Wrench};

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
    in_words(&description.bodies[info.body].link, x, info.location())
}

/// The beam, the distance from its start, m, and what is there, if anything is.
pub(crate) fn in_words(beam: &str, x: Option<f64>, what: String) -> String {
    let distance = x.map(|x| format!("{x:.3} m from its start"));
    let what = Some(what).filter(|what| !what.is_empty());
    [Some(beam.to_owned()), distance, what].into_iter().flatten().collect::<Vec<_>>().join(", ")
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
        let fixed: Vec<usize> =
            order.iter().copied().filter(|section| !description.sections[*section].slides).collect();
        let place = |&section: &usize| {
            let (cut, slides) = (cuts[section]?, description.sections[section].slides);
            let around = around(&fixed, |section| x[*section], x[section], Side::After).filter(|_| slides);
            let moduli =
                around.map_or(Between::own(section), |([one, other], part)| Between { sections: [*one, *other], part });
            Some(Place { section, cut, x: x[section], wrench: *wrenches.get(cut)?, moduli })
        };
        order.iter().filter_map(place).collect::<Vec<_>>()
    };
    description.sections_of_beams().into_iter().flat_map(of_beam).collect()
}

/// What is around a distance `at` in places along a beam, in their order: two places, and the part of the second; beyond an end twice the last one. Of
/// places at the distance itself, the first has what is before it, the last what is after it.
fn around<P>(places: &[P], x: impl Fn(&P) -> f64, at: f64, side: Side) -> Option<([&P; 2], f64)> {
    let is_before = |place: &P| x(place) < at || (side == Side::After && x(place) == at);
    let (before, after) = places.split_at(places.partition_point(is_before));
    match (before.last(), after.first()) {
        (Some(one), Some(other)) => Some(([one, other], (at - x(one)) / (x(other) - x(one)))),
        (one, other) => one.or(other).map(|end| ([end; 2], 0.0)),
    }
}

/// What the steel of a beam carries at a distance from its beginning, m, and the sections whose moduli it has; `places`: those of the beam in a pose,
/// in their order.
///
/// Between two places forces and moments are linear: exactly so, where all that acts does so at places, and to the second order in their
/// distance with weight and inertia in between.
pub(crate) fn carried(description: &Description, places: &[Place], at: f64, side: Side) -> Option<(Wrench, Between)> {
    let ([one, other], part) = around(places, |place| place.x, at, side)?;
    let wrench = Wrench {
        force: one.wrench.force.lerp(&other.wrench.force, part),
        moment: one.wrench.moment.lerp(&other.wrench.moment, part),
    };
    let fixed: Vec<&Place> = places.iter().filter(|place| !place.info(description).slides).collect();
    let ([one, other], part) = around(&fixed, |place| place.x, at, side)?;
    Some((wrench, Between { sections: [one.section, other.section], part }))
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
