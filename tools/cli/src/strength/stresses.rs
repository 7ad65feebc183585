//! Stresses of beams, and how far they use the allowable stress.

use crane_model::{Description, SectionModuli, Stress, sections::StressedSection};
use crane_page::history::Instant;
use crane_page::tables::{Cell, Grid, Report, Scale};

use super::tables::words;

/// Reports the section with the highest utilisation, at rest or over a run.
pub fn verdict(
    report: &mut Report,
    description: &Description,
    moduli: &[SectionModuli],
    instants: &[Instant],
    of_what: &str,
) {
    let sections = instants.iter().flat_map(|instant| {
        let sections = instant.stressed_sections(description, moduli);
        sections.into_iter().map(|section| (instant.t, section))
    });
    let greatest = sections.max_by(|(_, a), (_, b)| StressedSection::by_use(a, b));
    let Some((t, section)) = greatest else { return };
    let StressedSection { stress, utilisation, .. } = section;
    let location = section.location(description);
    let key = |name: &str| format!("{name}{of_what}").replace(' ', "_");
    if let Some(utilisation) = utilisation {
        report.fact_as(&key("greatest utilisation"), format!("maximum utilisation{of_what}"), utilisation, "");
    }
    let equivalent = format!("maximum equivalent stress{of_what}");
    report.fact_as(
        &key("greatest equivalent stress"),
        equivalent,
        Cell::Shown(stress.equivalent, Scale::Megapascal),
        "MPa",
    );
    report.fact_as(&key("place of the greatest stress"), format!("place of the maximum stress{of_what}"), location, "");
    if !of_what.is_empty() {
        report.fact_as("time_of_the_greatest_stress", "time of the maximum stress", t, "s");
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
        let stresses = [normal, shear, torsion, equivalent].map(|pascal| Cell::Shown(pascal, Scale::Megapascal));
        let row = words(&place, description).into_iter().chain(stresses).chain([utilisation.into()]);
        grid.row(row.collect::<Vec<_>>());
    }
    grid
}
