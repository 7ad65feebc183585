//! Stresses of beams, and how far they use the allowable stress.

use std::cmp::Ordering;

use crane_model::{Description, DisplayUnit, SectionModuli, Stress, sections::StressedSection};
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
    let sections = instants.iter().flat_map(|instant| {
        let sections = instant.stressed_sections(description, moduli);
        sections.into_iter().map(|section| (instant.t, section))
    });
    let sections: Vec<(f64, StressedSection)> = sections.collect();
    let mut fact = |what: &str, of_what: &str, value: Cell, unit: &str| {
        let key = format!("{what}{of_what}").replace(' ', "_").replace("maximum", "greatest");
        report.fact_as(&key, format!("{what}{of_what}"), value, unit);
    };
    for (order, use_counts) in [(StressedSection::by_use as Order, true), (StressedSection::by_stress, false)] {
        let Some((t, section)) = sections.iter().max_by(|(_, a), (_, b)| order(a, b)) else { return };
        let (name, place) = if use_counts { ("utilisation", "utilisation") } else { ("equivalent stress", "stress") };
        let stress = Cell::Shown(section.stress.equivalent, DisplayUnit::Megapascal);
        let (value, unit) = match section.utilisation {
            Some(utilisation) if use_counts => (utilisation.into(), ""),
            None if use_counts => continue,
            _ => (stress, "MPa"),
        };
        fact(&format!("maximum {name}"), of_what, value, unit);
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
