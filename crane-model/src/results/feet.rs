//! Cautions about feet: they pull, which the model is not valid for, they lift off, or the crane tips over.

use crane_quantities::{ColumnKind, DisplayUnit};
use nalgebra::Vector3;

use super::{Extremes, Table, column_name, support_gap};
use crate::{Description, SupportInfo, TIPPED, dyn_crane::DynCrane, feet};

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
    let pressing = description.supports.iter().zip(&reactions);
    let pressing: Vec<_> = pressing.filter_map(|(support, force)| presses_too_hard(support, force.z, "")).collect();
    pulled(&pulls).into_iter().chain(lifted).chain(pressing)
}

/// What to say of a support that presses harder than the ground bears; `when`: the end of the sentence.
fn presses_too_hard(support: &SupportInfo, force: f64, when: &str) -> Option<String> {
    let [pressure, most] = [support.pressure(force)?, support.max_pressure?];
    let [shown, bears] = [pressure, most].map(|pressure| DisplayUnit::Bar.shown(pressure));
    let name = &support.name;
    (pressure > most)
        .then(|| format!("{name} presses on the ground with {shown:.2} bar, which bears {bears} bar{when}"))
}

/// Supports that press harder than the ground bears in a run.
fn pressing(description: &Description, table: &Table) -> impl Iterator<Item = String> {
    description.supports.iter().filter_map(|support| {
        let Extremes { maximum, time_of_maximum, .. } = Extremes::of_column(table, &vertical_reaction(&support.name));
        presses_too_hard(support, maximum, &format!(", at {time_of_maximum:.2} s"))
    })
}

/// Feet over a run: whether the crane tips over, and as for a pose.
pub(super) fn of_run(description: &Description, table: &Table) -> impl Iterator<Item = String> {
    let forces = of_reactions(description, table).into_iter().chain(pressing(description, table));
    tipping(description, table).into_iter().chain(forces).chain(sliding(description, table))
}

/// A foot that slides less than this in a run is not worth a caution, m.
const SLIDES: f64 = 1e-3;

/// Reports which feet slide in a run, how far from where they stood at its beginning, and when they are furthest from there.
fn sliding(description: &Description, table: &Table) -> Option<String> {
    let furthest = |support: &SupportInfo| {
        let values = |axis: usize| Some(table.values(&feet::column(&support.name, axis))?.collect::<Vec<f64>>());
        let [x, y] = [0, 1].map(values);
        let gaps: Vec<f64> = table.values(&support_gap(&support.name))?.collect();
        let (x, y) = (x?, y?);
        let ways = x.iter().zip(&y).map(|(at_x, at_y)| (at_x - x[0]).hypot(at_y - y[0]));
        let on_the_ground = ways.zip(&gaps).enumerate().filter(|(_, (_, gap))| **gap <= 0.0);
        let (row, (way, _)) = on_the_ground.max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
        let words = format!("{} by up to {} mm at {:.2} s", support.name, millimetres(way), table.rows[row][0]);
        (way > SLIDES).then_some(words)
    };
    let one_sided = description.supports.iter().filter(|support| support.one_sided);
    let slides: Vec<String> = one_sided.filter_map(furthest).collect();
    (!slides.is_empty()).then(|| format!("feet that slide on the ground: {}", slides.join("; ")))
}

/// A foot that lifts off the ground in a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lift<'a> {
    /// Its name.
    pub foot: &'a str,
    /// When it first carries nothing, s.
    pub first: f64,
    /// Its largest height above the ground, m.
    pub gap: f64,
    /// When that is, s.
    pub time_of_gap: f64,
}

/// The one-sided feet that lift off the ground in a run.
pub fn lifts<'a>(description: &'a Description, table: &Table) -> Vec<Lift<'a>> {
    let one_sided = description.supports.iter().filter(|support| support.one_sided);
    let lift = |support: &'a SupportInfo| {
        let Extremes { minimum, time_of_minimum, .. } = Extremes::of_column(table, &vertical_reaction(&support.name));
        let gap = Extremes::of_column(table, &support_gap(&support.name));
        (minimum <= 0.0).then_some(Lift {
            foot: &support.name,
            first: time_of_minimum,
            gap: gap.maximum,
            time_of_gap: gap.time_of_maximum,
        })
    };
    one_sided.filter_map(lift).collect()
}

/// A foot that pulls the crane down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull<'a> {
    /// Its name.
    pub foot: &'a str,
    /// Its least vertical force, N, negative.
    pub force: f64,
    /// When that is, s.
    pub time: f64,
}

/// The feet that pull the crane down in a run.
pub fn pulls<'a>(description: &'a Description, table: &Table) -> Vec<Pull<'a>> {
    let with_extremes =
        |support: &'a SupportInfo| (support, Extremes::of_column(table, &vertical_reaction(&support.name)));
    let reactions: Vec<_> = description.supports.iter().map(with_extremes).collect();
    let greatest = reactions.iter().map(|(_, reaction)| reaction.size()).fold(0.0, f64::max);
    let pull = |(support, reaction): (&'a SupportInfo, Extremes)| {
        let Extremes { minimum, time_of_minimum, .. } = reaction;
        let pull = Pull { foot: &support.name, force: minimum, time: time_of_minimum };
        (minimum < -ROUNDING * greatest).then_some(pull)
    };
    reactions.into_iter().filter_map(pull).collect()
}

/// Name of the column with the vertical force of a support.
pub fn vertical_reaction(foot: &str) -> String {
    column_name(ColumnKind::VerticalReaction, foot, false)
}

/// Feet that pull the crane down over a run, and those that lift off.
fn of_reactions(description: &Description, table: &Table) -> Vec<String> {
    let pulls = pulls(description, table).into_iter().map(|Pull { foot, force, time }| (foot, force, Some(time)));
    let lifted = lifts(description, table).into_iter().map(|Lift { foot, first, gap, time_of_gap }| {
        format!("{foot} first at {first:.2} s, by up to {} mm at {time_of_gap:.2} s", millimetres(gap))
    });
    let lifted: Vec<String> = lifted.collect();
    let lifted = (!lifted.is_empty()).then(|| format!("feet that lift off the ground: {}", lifted.join("; ")));
    pulled(&pulls.collect::<Vec<_>>()).into_iter().chain(lifted).collect()
}

/// A gap, given in m, as text in mm that does not round it to zero.
fn millimetres(gap: f64) -> String {
    if gap < 1e-5 { format!("{:.1e}", 1e3 * gap) } else { format!("{:.3}", 1e3 * gap) }
}

/// A crane that tips over in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct TipsOver {
    /// When its base has rotated by more than [`TIPPED`], s.
    pub time: f64,
    /// The feet that carried it last, if any did.
    pub about: Option<String>,
}

/// Whether the base of a crane on feet that lift tips over in a run, and which feet carried it last.
pub fn tips_over(description: &Description, table: &Table) -> Option<TipsOver> {
    let n = description.coordinates.len();
    let pose = |row: &[f64]| row[1..=n].to_vec();
    let start = pose(table.rows.first()?);
    let lifts = description.supports.iter().any(|support| support.one_sided);
    let over = table.rows.iter().position(|row| lifts && description.has_tipped(&start, &pose(row)))?;
    let presses = |row: &[f64], name: &str| {
        let column = vertical_reaction(name);
        table.columns.iter().position(|known| known.name == column).is_some_and(|index| row[index] > 0.0)
    };
    let about = table.rows[..=over].iter().rev().find_map(|row| {
        let names = description.supports.iter().map(|support| support.name.as_str());
        let pressing: Vec<&str> = names.filter(|name| presses(row, name)).collect();
        (!pressing.is_empty()).then(|| pressing.join(" – "))
    });
    Some(TipsOver { time: table.rows[over][0], about })
}

/// Reports that a crane tips over in a run.
fn tipping(description: &Description, table: &Table) -> Option<String> {
    let TipsOver { time, about } = tips_over(description, table)?;
    let about = about.map_or_else(String::new, |feet| format!(" about {feet}"));
    let degrees = TIPPED.to_degrees();
    Some(format!("the crane tips over{about}: at {time:.2} s its base has rotated by more than {degrees:.0}°"))
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
