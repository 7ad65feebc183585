//! Loads and moments about tipping lines over a run.

use crane_model::{
    Cut, Description, SectionInfo, Wrench,
    results::Table,
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
            let SectionInfo { body, side, at, .. } = &description.sections[section];
            let what = at.replace(' ', "_");
            Some((format!("{}_{}_{what}", description.bodies[*body].name, side.name()), OF_SECTIONS))
        }
    }
}

/// The history in columns: `t`; for a tipping line `<from>_<to>_stabilising` and `_overturning`; for the ground, joints and
/// sections the six components. A section within an element is named after the element and what is there.
pub fn table(description: &Description, history: &[Instant]) -> Table {
    let mut table = Table::default();
    table.add("t", "s");
    for line in history.first().map_or(&[][..], |instant| &instant.lines) {
        let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
        for what in ["stabilising", "overturning"] {
            table.add(format!("{from}_{to}_{what}"), "N m");
        }
    }
    let cuts = description.cuts();
    for (prefix, components) in cuts.iter().filter_map(|cut| prefix(description, *cut)) {
        for (component, unit) in components.into_iter().zip(UNITS) {
            table.add(format!("{prefix}_{component}"), unit);
        }
    }
    let row = |instant: &Instant| {
        let moments = instant.lines.iter().flat_map(|line| [line.stabilising, line.overturning]);
        let shown = cuts.iter().zip(&instant.wrenches).filter(|(cut, _)| prefix(description, **cut).is_some());
        [instant.t].into_iter().chain(moments).chain(shown.flat_map(|(_, wrench)| numbers(wrench))).collect()
    };
    table.rows = history.iter().map(row).collect();
    table
}

/// Force, then moment.
pub fn numbers(wrench: &Wrench) -> [f64; 6] {
    let Wrench { force, moment } = wrench;
    [force.x, force.y, force.z, moment.x, moment.y, moment.z]
}
