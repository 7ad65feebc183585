//! Stresses of beams, and how far they use the allowable stress.

use std::cmp::Ordering;

use crane_model::{Cut, Description, SectionModuli, Stress, Wrench};

use crate::report::{Cell, Grid, Report};

use super::history::Instant;

/// Pascals in a newton per square millimetre.
const MEGA: f64 = 1e6;

/// A section where stresses are known.
pub struct Stressed<'a> {
    /// Name of the beam's link.
    pub beam: &'a str,
    /// Distance from the beam's beginning, m.
    pub x: f64,
    /// Its stresses.
    pub stress: Stress,
    /// Equivalent stress over the allowable one, if there is one.
    pub utilisation: Option<f64>,
}

/// All sections whose moduli are known.
pub fn of<'a>(description: &'a Description, moduli: &[SectionModuli], wrenches: &[Wrench]) -> Vec<Stressed<'a>> {
    let beams = description.beams();
    let at = |(cut, wrench): (Cut, &Wrench)| {
        let Cut::Body { body, x: Some(x) } = cut else { return None };
        let beam = description.bodies[body].link.as_str();
        let moduli = &moduli[beams.iter().position(|name| *name == beam)?];
        let stress = moduli.stress(wrench)?;
        Some(Stressed { beam, x, stress, utilisation: moduli.utilisation(&stress) })
    };
    description.cuts().into_iter().zip(wrenches).filter_map(at).collect()
}

/// Orders sections by utilisation; where no beam has a yield stress, by equivalent stress.
fn by_use(a: &Stressed<'_>, b: &Stressed<'_>) -> Ordering {
    let used = |section: &Stressed<'_>| section.utilisation.unwrap_or(0.0);
    used(a).total_cmp(&used(b)).then(a.stress.equivalent.total_cmp(&b.stress.equivalent))
}

/// Says which section is used most, at rest or of all moments of a run.
pub fn verdict(
    report: &mut Report,
    description: &Description,
    moduli: &[SectionModuli],
    instants: &[Instant],
    of_what: &str,
) {
    let sections = instants.iter().flat_map(|instant| {
        let sections = of(description, moduli, &instant.wrenches);
        sections.into_iter().map(|section| (instant.t, section))
    });
    let greatest = sections.max_by(|(_, a), (_, b)| by_use(a, b));
    let Some((t, Stressed { beam, x, stress, utilisation })) = greatest else { return };
    let place = format!("{beam}, {x:.3} m from its start");
    if let Some(utilisation) = utilisation {
        report.fact(format!("greatest utilisation{of_what}"), utilisation, "");
        if utilisation > 1.0 {
            report.caution(Some(format!(
                "{place}{of_what}: the equivalent stress of {:.0} MPa is {:.2} times the allowable stress",
                stress.equivalent / MEGA,
                utilisation
            )));
        }
    }
    report.fact(format!("greatest equivalent stress{of_what}"), stress.equivalent / MEGA, "MPa");
    report.fact(format!("place of the greatest stress{of_what}"), place, "");
    if !of_what.is_empty() {
        report.fact("time of the greatest stress", t, "s");
    }
}

/// Stresses of all sections at rest.
pub fn table(description: &Description, moduli: &[SectionModuli], wrenches: &[Wrench]) -> Grid {
    let title = "Stresses of beams at rest: greatest of normal force and bending, of shear forces, of torsion; von Mises' equivalent of \
                 all three, and its part of yield stress over safety factor";
    let headers = ["beam", "x [m]", "normal [MPa]", "shear [MPa]", "torsion [MPa]", "equivalent [MPa]", "utilisation"];
    let mut grid = Grid::new("stresses", title, &headers);
    for Stressed { beam, x, stress, utilisation } in of(description, moduli, wrenches) {
        let Stress { normal, shear, torsion, equivalent } = stress;
        let stresses = [normal, shear, torsion, equivalent].map(|pascal| Cell::from(pascal / MEGA));
        let row = [Cell::from(beam), x.into()].into_iter().chain(stresses).chain([utilisation.into()]);
        grid.row(row.collect::<Vec<_>>());
    }
    grid
}
