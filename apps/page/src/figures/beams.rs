//! What bending beams do: utilisation, deflection, vibration.

use crane_model::{
    Description,
    modes::Vibration,
    results::{KeyFigure, stressed_over},
    sections::StressedSection,
};
use nalgebra::Vector3;

use super::{Figure, quantity, spoken};
use crate::{
    crane::Shown,
    tables::{readable, uncertain},
};

/// The greatest utilisation of a section, or the greatest stress if no beam has a yield stress.
pub(super) fn utilisation(crane: &Shown<'_>) -> Option<Figure> {
    let live = crane.subject.crane;
    let (description, moduli) = (live.description(), live.section_moduli_at());
    let sections = stressed_over(&crane.history, description, &moduli);
    let (time, section) = sections.into_iter().max_by(|(_, a), (_, b)| StressedSection::by_use(a, b))?;
    let location = section.location(description);
    let stress = format!("{} MPa", readable(section.stress.equivalent / 1e6));
    let when = crane.when(time);
    let figure =
        |KeyFigure { key, name, .. }: KeyFigure, value, note| Figure::new(key, format!("largest {name}"), value, note);
    let Some(used) = section.utilisation else {
        let note = format!("{location}, {when}; no yield stress is given");
        return Some(figure(KeyFigure::EQUIVALENT_STRESS, stress, note));
    };
    let value = format!("{} %", readable(100.0 * used));
    let beyond = (used > 1.0)
        .then(|| format!("stress of {} is {value} of the allowable one", spoken(section.beam(description))));
    let note = format!("{location}, {when}; {stress}");
    Some(figure(KeyFigure::UTILISATION, value, note).judged(beyond))
}

/// How far the points are from those of the rigid crane.
pub(super) fn deflection(crane: &Shown<'_>, rigid: &Shown<'_>) -> Option<Figure> {
    let places = |shown: &Shown<'_>, point: &str| -> Option<Vec<Vector3<f64>>> {
        let names = ["x", "y", "z"].map(|axis| format!("{point}_{axis}"));
        let [x, y, z] = names.each_ref().map(|name| shown.table.values(name));
        Some(x?.zip(y?).zip(z?).map(|((x, y), z)| Vector3::new(x, y, z)).collect())
    };
    let ways = crane.subject.crane.description().points.iter().filter_map(|point| {
        let (flexible, other) = (places(crane, point)?, places(rigid, point)?);
        Some((
            point,
            flexible.iter().zip(&other).map(|(flexible, other)| (flexible - other).norm()).collect::<Vec<f64>>(),
        ))
    });
    let ways: Vec<_> = ways.collect();
    // A run may start elsewhere.
    let [own, other] = [crane, rigid].map(|shown| shown.subject.crane.points_at(&shown.pose));
    let rest = own.iter().zip(&other).map(|(own, other)| (own - other).norm()).max_by(f64::total_cmp)?;
    let all = ways.iter().flat_map(|(point, distances)| {
        distances.iter().zip(&crane.table.rows).map(move |(distances, row)| (point, *distances, row[0]))
    });
    let (point, most, time) = all.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let motion = format!("; up to {} in motion ({}, {})", quantity(most, "m"), spoken(point), crane.when(time));
    let note = format!("compared with the rigid crane{}", if crane.moves() { motion } else { String::new() });
    Some(Figure::new("deflection", "deflection at rest", quantity(rest, "m"), note))
}

/// The lowest frequency, with its damping.
pub(crate) fn vibration(modes: &[Vibration], description: &Description) -> Option<Figure> {
    let lowest = modes.first()?;
    let names = lowest.mode.dominating.iter().take(2).map(|&index| spoken(&description.coordinates[index].name));
    let names = names.collect::<Vec<_>>().join(", ");
    let damping =
        lowest.damping_ratio().map_or_else(String::new, |ratio| format!("; damping ratio {}", uncertain(ratio)));
    let value = format!("{} Hz", readable(lowest.mode.frequency()?));
    Some(Figure::new("lowest_frequency", "lowest frequency at rest", value, names + &damping))
}
