//! Loads and moments about tipping lines over a run.

use crane_model::{
    ColumnKind, Cut, Description, SectionInfo, SectionModuli, Stress, Wrench,
    results::Table,
    sections::StressedSection,
    tipping::{TippingLine, governing},
};
use crane_page::history::Instant;

/// Components of what a joint carries.
pub const OF_JOINTS: [&str; 6] = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"];
/// Components of what a section carries.
pub const OF_SECTIONS: [&str; 6] = ["N", "Qy", "Qz", "Mx", "My", "Mz"];
/// Their units.
pub const UNITS: [&str; 6] = ["N", "N", "N", "N m", "N m", "N m"];

/// The instant nearest to tipping, or the first one.
pub fn least_margin(history: &[Instant]) -> Option<&Instant> {
    let margin = |instant: &Instant| governing(&instant.lines).map_or(f64::INFINITY, TippingLine::margin);
    history.iter().min_by(|a, b| margin(a).total_cmp(&margin(b)))
}

/// Prefix and components of the columns of a cut; `None` for a rigid link, whose joint shows the same.
pub fn prefix(description: &Description, cut: Cut) -> Option<(String, [&'static str; 6])> {
    match cut {
        Cut::Ground => Some(("ground".to_owned(), OF_JOINTS)),
        Cut::Joint { body } => Some((format!("{}_joint", description.bodies[body].link), OF_JOINTS)),
        Cut::Body { body, section: Some(_) } => {
            Some((format!("{}_section", description.bodies[body].name), OF_SECTIONS))
        }
        Cut::Body { section: None, .. } => None,
        Cut::Inside { section } => {
            let SectionInfo { body, side, at, slides, .. } = &description.sections[section];
            let (what, body) = (at.replace(' ', "_"), &description.bodies[*body]);
            let on = if *slides { &body.link } else { &body.name };
            Some((format!("{on}_{}_{what}", side.name()), OF_SECTIONS))
        }
    }
}

/// The name of a column about a cut of a beam.
pub fn column(description: &Description, cut: usize, what: &str) -> String {
    let prefix = description.cuts().get(cut).and_then(|cut| prefix(description, *cut));
    prefix.map_or_else(|| what.to_owned(), |(prefix, _)| format!("{prefix}_{what}"))
}

/// The history in columns: `t`; for a tipping line `<from>_<to>_stabilising` and `_overturning`; for the ground, joints and
/// sections the six components, and for sections whose moduli are known four stresses and the utilisation. A section within an element is named
/// after the element and what is there, one at a pad on which the beam slides after the beam; of the latter, `x` is where it is on the beam.
pub fn table(description: &Description, moduli: &[SectionModuli], history: &[Instant]) -> Table {
    let mut table = Table::default();
    table.add("t", "s");
    for line in history.first().map_or(&[][..], |instant| &instant.lines) {
        let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
        let (kind, line) = (ColumnKind::TippingMoment, format!("{from}_{to}"));
        kind.endings(false).iter().for_each(|ending| table.add(format!("{line}{ending}"), kind.unit(false)));
    }
    let cuts = description.cuts();
    for (prefix, components) in cuts.iter().filter_map(|cut| prefix(description, *cut)) {
        for (component, unit) in components.into_iter().zip(UNITS) {
            table.add(format!("{prefix}_{component}"), unit);
        }
    }
    // Columns are in the order of the sections, whose order along a beam changes where it slides.
    let stressed = |instant: &Instant| {
        let mut sections = instant.stressed_sections(description, moduli);
        sections.sort_by_key(|section| section.place.section);
        sections
    };
    for StressedSection { place, utilisation, .. } in history.first().map(stressed).unwrap_or_default() {
        let Some((prefix, _)) = prefix(description, cuts[place.cut]) else { continue };
        if place.info(description).slides {
            table.add(format!("{prefix}_x"), "m");
        }
        for what in ["normal", "shear", "torsion", "equivalent"] {
            table.add(format!("{prefix}_{what}_stress"), "Pa");
        }
        if utilisation.is_some() {
            table.add(format!("{prefix}_utilisation"), "");
        }
    }
    let of_stresses = |StressedSection { place, stress, utilisation }: StressedSection| {
        let Stress { normal, shear, torsion, equivalent } = stress;
        let x = place.info(description).slides.then_some(place.x);
        x.into_iter().chain([normal, shear, torsion, equivalent]).chain(utilisation)
    };
    let row = |instant: &Instant| {
        let moments = instant.lines.iter().flat_map(|line| [line.stabilising, line.overturning]);
        let shown = cuts.iter().zip(&instant.wrenches).filter(|(cut, _)| prefix(description, **cut).is_some());
        let wrenches = shown.flat_map(|(_, wrench)| numbers(wrench));
        let stresses = stressed(instant).into_iter().flat_map(of_stresses);
        [instant.t].into_iter().chain(moments).chain(wrenches).chain(stresses).collect()
    };
    table.rows = history.iter().map(row).collect();
    table
}

/// Force, then moment.
pub fn numbers(wrench: &Wrench) -> [f64; 6] {
    let Wrench { force, moment } = wrench;
    [force.x, force.y, force.z, moment.x, moment.y, moment.z]
}
