//! Stresses of beams, and how far they use the allowable stress.

use std::cmp::Ordering;

use crane_model::{
    Description, DisplayUnit, SectionModuli, Stress,
    results::{KeyFigure, stressed_over},
    sections::StressedSection,
};
use crane_page::history::Instant;
use crane_page::tables::{Cell, Grid, Report};

use super::tables::words;

type Order = fn(&StressedSection, &StressedSection) -> Ordering;

/// Reports the greatest utilisation and the greatest stress with their places, at rest or over a run. Where beams have different allowable
/// stresses, they may be at different places.
pub fn verdict(
    report: &mut Report,
    description: &Description,
    moduli: &[SectionModuli],
    instants: &[Instant],
    of_what: &str,
) {
    let sections = stressed_over(instants, description, moduli);
    let mut fact = |what: &str, of_what: &str, value: Cell, unit: &str| {
        let key = format!("{what}{of_what}").replace(' ', "_").replace("maximum", "greatest");
        report.fact_as(&key, format!("{what}{of_what}"), value, unit);
    };
    for (order, figure, place) in [
        (StressedSection::by_use as Order, KeyFigure::UTILISATION, "utilisation"),
        (StressedSection::by_stress, KeyFigure::EQUIVALENT_STRESS, "stress"),
    ] {
        let Some((t, section)) = sections.iter().max_by(|(_, a), (_, b)| order(a, b)) else { return };
        let value = match (figure, section.utilisation) {
            (KeyFigure::UTILISATION, Some(utilisation)) => utilisation.into(),
            (KeyFigure::UTILISATION, None) => continue,
            _ => Cell::Shown(section.stress.equivalent, DisplayUnit::Megapascal),
        };
        fact(&format!("maximum {}", figure.name), of_what, value, figure.shown);
        fact(&format!("place of the maximum {place}"), of_what, section.location(description).into(), "");
        if !of_what.is_empty() {
            fact(&format!("time of the maximum {place}"), "", (*t).into(), "s");
        }
    }
}

/// Stresses of all sections at rest.
pub fn table(description: &Description, moduli: &[SectionModuli], rest: &Instant) -> Grid {
    let title = "Stresses of beams at rest: maximum of normal force and bending, of shear forces, of torsion; von Mises' equivalent of \
                 all three, and its ratio to yield stress over safety factor";
    let headers =
        ["beam", "x [m]", "place", "normal [MPa]", "shear [MPa]", "torsion [MPa]", "equivalent [MPa]", "utilisation"];
    let mut grid = Grid::new("stresses", title, &headers);
    for StressedSection { place, stress, utilisation } in rest.stressed_sections(description, moduli) {
        let Stress { normal, shear, torsion, equivalent } = stress;
        let stresses = [normal, shear, torsion, equivalent].map(|pascal| Cell::Shown(pascal, DisplayUnit::Megapascal));
        let row = words(&place, description).into_iter().chain(stresses).chain([utilisation.into()]);
        grid.row(row.collect::<Vec<_>>());
    }
    grid
}
