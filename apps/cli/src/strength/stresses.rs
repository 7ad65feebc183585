//! Stresses of beams, and how far they use the allowable stress.

use std::cmp::Ordering;

use crane_model::{
    Description, DisplayUnit, SectionModuli, Stress,
    results::{KeyFigure, stressed_over},
    sections::StressedSection,
};
use crane_page::history::Instant;
use crane_page::tables::{Cell, Grid, Report};

use serde_json::Value;

use super::tables::words;
use crate::refinement::{self, StressChanges};

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

/// Reports what the mesh leaves out of the maxima, or why that is not known; returns it for each place.
pub fn mesh(report: &mut Report, changes: Result<StressChanges, &str>) -> Option<Vec<Option<f64>>> {
    let maxima = |what: &str| {
        let words = format!("change of the maximum {what} with twice the sections");
        (words.replace(' ', "_").replace("maximum", "greatest"), words)
    };
    let (key, words) = maxima("stress");
    let StressChanges { stress, utilisation, places } = match changes {
        Ok(changes) => changes,
        Err(why) => {
            report.line(words, format!("not computed: {why}"), "");
            report.value(&key, Value::Null);
            return None;
        }
    };
    report.line(words, 100.0 * stress, "%");
    report.value(&key, stress);
    if let Some(utilisation) = utilisation {
        let (key, words) = maxima("utilisation");
        report.line(words, 100.0 * utilisation, "%");
        report.value(&key, utilisation);
    }
    report.caution(refinement::caution_of_stress(stress).as_deref());
    Some(places)
}

/// Stresses of all sections at rest; `changes`: with twice the sections, if they are known.
pub fn table(
    description: &Description,
    moduli: &[SectionModuli],
    rest: &Instant,
    changes: Option<&[Option<f64>]>,
) -> Grid {
    let with_changes = if changes.is_some() { "; how much both change with twice the sections" } else { "" };
    let title = format!(
        "Stresses of beams at rest: maximum of normal force and bending, of shear forces, of torsion; von Mises' equivalent of all three, and its \
         ratio to yield stress over safety factor{with_changes}"
    );
    let mut headers = vec![
        "beam",
        "x [m]",
        "place",
        "normal [MPa]",
        "shear [MPa]",
        "torsion [MPa]",
        "equivalent [MPa]",
        "utilisation",
    ];
    headers.extend(changes.map(|_| "change [%]"));
    let mut grid = Grid::new("stresses", title, &headers);
    for (index, section) in rest.stressed_sections(description, moduli).into_iter().enumerate() {
        let StressedSection { place, stress: Stress { normal, shear, torsion, equivalent }, utilisation } = section;
        let stresses = [normal, shear, torsion, equivalent].map(|pascal| Cell::Shown(pascal, DisplayUnit::Megapascal));
        let change = changes.map(|changes| changes[index].map_or(Cell::Empty, Cell::Change));
        let row = words(&place, description).into_iter().chain(stresses).chain([utilisation.into()]).chain(change);
        grid.row(row.collect::<Vec<_>>());
    }
    grid
}
