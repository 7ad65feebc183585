//! Cautions about what a crane carries: sections beyond their allowable stress, and moments that tip it over.

use super::{Instant, Table, instants};
use crate::{Description, SectionModuli, dyn_crane::DynCrane, sections::StressedSection, tipping::governing};

/// At a pose at rest.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    if carries_nothing(crane) {
        return Vec::new();
    }
    of_instants(crane, &[Instant::at_rest(crane, q)], false)
}

/// Over a run, at its results.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    if carries_nothing(crane) {
        return Vec::new();
    }
    of_instants(crane, &instants(crane, table.rows.iter()), true)
}

/// Whether a crane has neither tipping lines nor sections with an allowable stress.
fn carries_nothing(crane: &dyn DynCrane) -> bool {
    let limited = |moduli: &SectionModuli| moduli.allowable_stress > 0.0;
    crane.description().supports.is_empty() && !crane.section_moduli_at().iter().any(limited)
}

fn of_instants(crane: &dyn DynCrane, history: &[Instant], moves: bool) -> Vec<String> {
    let description = crane.description();
    let over_a_line = tipping(description, history, moves);
    over_a_line.into_iter().chain(overstress(description, &crane.section_moduli_at(), history, moves)).collect()
}

/// The line over which the crane tips most.
fn tipping(description: &Description, history: &[Instant], moves: bool) -> Option<String> {
    let governing = |instant: &Instant| Some((instant.t, *governing(&instant.lines)?));
    let (t, line) = history.iter().filter_map(governing).min_by(|(_, a), (_, b)| a.margin().total_cmp(&b.margin()))?;
    let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
    let (begins, when) = if moves { ("begins to tip", format!(" at {t:.2} s")) } else { ("tips", String::new()) };
    (line.margin() <= 0.0).then(|| {
        let why = if line.has_tipped {
            "no other foot carries anything".to_owned()
        } else {
            format!("the overturning moment exceeds the stabilising moment by {:.4} kN m", -line.balance() / 1e3)
        };
        format!("the crane {begins} over the line {from} – {to}{when}: {why}")
    })
}

/// The section with the greatest utilisation of each beam that is beyond its allowable stress; the worst beam first.
fn overstress(description: &Description, moduli: &[SectionModuli], history: &[Instant], moves: bool) -> Option<String> {
    let mut worst: Vec<(f64, f64, StressedSection)> = Vec::new();
    for instant in history {
        for section in instant.stressed_sections(description, moduli) {
            let Some(used) = section.utilisation.filter(|used| *used > 1.0) else { continue };
            let same =
                |(.., other): &&mut (f64, f64, StressedSection)| other.beam(description) == section.beam(description);
            match worst.iter_mut().find(same) {
                Some(known) if known.0 < used => *known = (used, instant.t, section),
                Some(_) => {}
                None => worst.push((used, instant.t, section)),
            }
        }
    }
    worst.sort_by(|a, b| b.0.total_cmp(&a.0));
    let each = worst.iter().map(|(used, t, section)| {
        let when = if moves { format!(" at {t:.2} s") } else { String::new() };
        format!(
            "{}{when}: {:.0} MPa, {used:.2} times the allowable stress",
            section.location(description),
            section.stress.equivalent / 1e6
        )
    });
    (!worst.is_empty()).then(|| format!("overstressed: {}", each.collect::<Vec<_>>().join("; ")))
}
