//! Cautions about feet: they pull, which the model is not valid for, they lift off, or the crane tips over.

use nalgebra::Vector3;

use super::{Extremes, Table, support_gap};
use crate::{Description, TIPPED, dyn_crane::DynCrane};

/// Fraction of the maximum reaction below which a pull is a rounding error.
const ROUNDING: f64 = 1e-9;

/// Feet at a pose at rest: those that pull the crane down, and those that have lifted off.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> impl Iterator<Item = String> {
    let description = crane.description();
    let reactions = crane.support_reactions_at(q, &vec![0.0; q.len()]);
    let greatest = reactions.iter().map(Vector3::amax).fold(0.0, f64::max);
    let forces =
        description.supports.iter().zip(&reactions).map(|(support, force)| (support.name.as_str(), force.z, None));
    let pulls: Vec<_> = forces.filter(|(_, force, _)| *force < -ROUNDING * greatest).collect();
    let gaps = description.supports.iter().zip(crane.support_gaps_at(q));
    let lifted = gaps.filter(|(support, gap)| support.one_sided && *gap > 0.0);
    let lifted: Vec<_> = lifted.map(|(support, gap)| format!("{} by {} mm", support.name, millimetres(gap))).collect();
    let lifted = (!lifted.is_empty()).then(|| format!("feet off the ground: {}", lifted.join(", ")));
    pulled(&pulls).into_iter().chain(lifted)
}

/// Feet over a run: as for a pose, and whether the crane tips over.
pub(super) fn of_run(description: &Description, table: &Table) -> impl Iterator<Item = String> {
    of_reactions(description, table).into_iter().chain(tips_over(description, table))
}

/// Feet that pull the crane down over a run, and those that lift off.
fn of_reactions(description: &Description, table: &Table) -> Vec<String> {
    let reaction = |name: &str| Extremes::of(table, &format!("{name}_reaction_z"));
    let greatest = description.supports.iter().map(|support| reaction(&support.name).size()).fold(0.0, f64::max);
    let pulls = description.supports.iter().filter_map(|support| {
        let Extremes { minimum, time_of_minimum, .. } = reaction(&support.name);
        (minimum < -ROUNDING * greatest).then_some((support.name.as_str(), minimum, Some(time_of_minimum)))
    });
    let lifted = description.supports.iter().filter(|support| support.one_sided).filter_map(|support| {
        let Extremes { minimum, time_of_minimum, .. } = reaction(&support.name);
        (minimum <= 0.0).then(|| {
            let gap = Extremes::of(table, &support_gap(&support.name));
            let (most, time) = (millimetres(gap.maximum), gap.time_of_maximum);
            format!("{} first at {time_of_minimum:.2} s, by up to {most} mm at {time:.2} s", support.name)
        })
    });
    let lifted: Vec<String> = lifted.collect();
    let lifted = (!lifted.is_empty()).then(|| format!("feet that lift off the ground: {}", lifted.join("; ")));
    pulled(&pulls.collect::<Vec<_>>()).into_iter().chain(lifted).collect()
}

/// A gap, given in m, as text in mm that does not round it to zero.
fn millimetres(gap: f64) -> String {
    if gap < 1e-5 { format!("{:.1e}", 1e3 * gap) } else { format!("{:.3}", 1e3 * gap) }
}

/// Reports that the base of a crane on feet that lift tips over in a run, and which feet carried it last.
fn tips_over(description: &Description, table: &Table) -> Option<String> {
    let n = description.coordinates.len();
    let pose = |row: &[f64]| row[1..=n].to_vec();
    let start = pose(table.rows.first()?);
    let lifts = description.supports.iter().any(|support| support.one_sided);
    let over = table.rows.iter().position(|row| lifts && description.has_tipped(&start, &pose(row)))?;
    let presses = |row: &[f64], name: &str| {
        let column = format!("{name}_reaction_z");
        table.columns.iter().position(|own| own.name == column).is_some_and(|place| row[place] > 0.0)
    };
    let last = table.rows[..=over].iter().rev().find_map(|row| {
        let names = description.supports.iter().map(|support| support.name.as_str());
        let pressing: Vec<&str> = names.filter(|name| presses(row, name)).collect();
        (!pressing.is_empty()).then(|| pressing.join(" – "))
    });
    let about = last.map_or_else(String::new, |feet| format!(" about {feet}"));
    let (t, degrees) = (table.rows[over][0], TIPPED.to_degrees());
    Some(format!("the crane tips over{about}: at {t:.2} s its base has rotated by more than {degrees:.0}°"))
}

/// Reports which feet pull, with what force, and when.
fn pulled(pulls: &[(&str, f64, Option<f64>)]) -> Option<String> {
    let each = pulls.iter().map(|(name, force, time)| {
        let when = time.map_or_else(String::new, |t| format!(" at {t:.2} s"));
        format!("{name} ({:.2} kN{when})", force / 1e3)
    });
    let feet = each.collect::<Vec<_>>().join(", ");
    let (pull, would) = if pulls.len() == 1 { ("pulls", "a real foot") } else { ("pull", "real feet") };
    (!pulls.is_empty()).then(|| {
        format!(
            "{feet} {pull} on the ground: {would} would lift off and the crane might tip; forces and poses are valid only for \
             anchored feet"
        )
    })
}
