//! What the crane carries: drives, feet, cylinders.

use crane_model::{
    CylinderInfo,
    results::{
        Extremes, KeyFigure, beyond_stroke, drive_effort, highest_pressure, lifts, pulls, tips_over, vertical_reaction,
    },
    tipping::governing,
};

use super::{Figure, quantity, scaled, spoken};
use crate::{crane::Shown, tables::readable};

/// A pose that is not a stable equilibrium.
pub(super) fn equilibrium(crane: &Shown<'_>) -> Option<Figure> {
    let equilibrium = crane.subject.equilibrium;
    if equilibrium.is_stable() {
        return None;
    }
    let name = equilibrium.status.name().replace('_', " ");
    let figure = Figure::new("equilibrium", "equilibrium", name.clone(), equilibrium.to_string());
    Some(figure.judged(Some(format!("the pose at rest is {name}"))))
}

/// The largest torque and the largest force of a drive.
pub(super) fn drives(crane: &Shown<'_>) -> Vec<Figure> {
    let description = crane.subject.crane.description();
    let largest = |(key, title, unit): (&'static str, &str, &str)| {
        let coordinates = description.drives.iter().map(|drive| &description.coordinates[drive.coordinate]);
        let of_unit = coordinates.filter(|coordinate| coordinate.kind.force_unit() == unit);
        let all = of_unit.map(|coordinate| {
            let of = Extremes::of_column(&crane.table, &drive_effort(&coordinate.name, coordinate.kind));
            if -of.minimum > of.maximum {
                (coordinate, of.minimum, of.time_of_minimum)
            } else {
                (coordinate, of.maximum, of.time_of_maximum)
            }
        });
        let (coordinate, value, time) = all.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let note = format!("{}, {}", spoken(&coordinate.name), crane.when(time));
        Some(Figure::new(key, title, quantity(value, unit), note))
    };
    let kinds = [
        ("largest_drive_torque", "largest torque of a drive", "N m"),
        ("largest_drive_force", "largest force of a drive", "N"),
    ];
    kinds.into_iter().filter_map(largest).collect()
}

/// Vertical reactions, and whether feet lift off or pull.
pub(super) fn reactions(crane: &Shown<'_>) -> Option<Figure> {
    let description = crane.subject.crane.description();
    let name = |index: usize| spoken(&description.supports[index].name);
    let all: Vec<Extremes> = description
        .supports
        .iter()
        .map(|support| Extremes::of_column(&crane.table, &vertical_reaction(&support.name)))
        .collect();
    let least = (0..all.len()).min_by(|&a, &b| all[a].minimum.total_cmp(&all[b].minimum))?;
    let most = (0..all.len()).max_by(|&a, &b| all[a].maximum.total_cmp(&all[b].maximum))?;
    let (low, high) = (all[least].minimum, all[most].maximum);
    let size = low.abs().max(high.abs());
    let [(from, unit), (to, _)] = [low, high].map(|force| scaled(force, size, "N"));
    let value = format!("{} … {} {unit}", readable(from), readable(to));
    let lifted = lifts(description, &crane.table);
    let pulled = pulls(description, &crane.table);
    let lifts = |verb: &str| {
        let feet = lifted.iter().map(|lift| {
            let first = if crane.moves() { format!(" first {}", crane.when(lift.first)) } else { String::new() };
            format!("{}{first}, by up to {}", spoken(lift.foot), quantity(lift.gap, "m"))
        });
        format!("{verb}: {}", feet.collect::<Vec<_>>().join("; "))
    };
    let pulls = |words: &str| {
        let feet = pulled
            .iter()
            .map(|pull| format!("{} by {} {}", spoken(pull.foot), quantity(-pull.force, "N"), crane.when(pull.time)));
        format!("{words}: {}", feet.collect::<Vec<_>>().join("; "))
    };
    let names = |feet: Vec<String>, one: &str, several: &str| match feet.as_slice() {
        [foot] => format!("{foot} {one}"),
        feet => format!("{} {several}", feet.join(", ")),
    };
    let (note, excess) = if !lifted.is_empty() {
        let feet = lifted.iter().map(|lift| spoken(lift.foot)).collect();
        (lifts("lifts off the ground"), Some(names(feet, "lifts off the ground", "lift off the ground")))
    } else if !pulled.is_empty() {
        let feet = pulled.iter().map(|pull| spoken(pull.foot)).collect();
        let excess = names(feet, "pulls on the ground", "pull on the ground");
        (pulls("pulls on the ground, where a real foot would lift"), Some(excess))
    } else {
        (format!("smallest at {}, largest at {}: no foot lifts", name(least), name(most)), None)
    };
    Some(Figure::new("vertical_reactions", "vertical reactions", value, note).judged(excess))
}

/// The smallest tipping margin, and whether the crane tips over.
pub(super) fn tipping(crane: &Shown<'_>) -> Option<Figure> {
    let description = crane.subject.crane.description();
    let margins = crane.history.iter().filter_map(|instant| Some((governing(&instant.lines)?, instant.t)));
    let least = margins.min_by(|(a, _), (b, _)| a.margin().total_cmp(&b.margin()));
    let over = tips_over(description, &crane.table);
    let value = least.map_or(f64::NEG_INFINITY, |(line, _)| line.margin());
    let line = least.map(|(line, _)| line.feet.map(|foot| description.supports[foot].name.as_str()).join(" – "));
    let about = |feet: Option<String>| feet.map_or_else(String::new, |feet| format!(" about {}", spoken(&feet)));
    let (note, excess) = match (over, least) {
        (Some(over), _) => {
            let what = format!("the crane tips over{}, {}", about(over.about.or(line)), crane.when(over.time));
            (what.clone(), Some(what))
        }
        (None, Some((_, time))) => {
            let what = format!("{}, {}", about(line).trim_start(), crane.when(time));
            let excess = (value <= 0.0).then(|| format!("no margin against tipping {what}"));
            (what, excess)
        }
        (None, None) => return None,
    };
    let value = if value.is_finite() { readable(value) } else { "none".to_owned() };
    let KeyFigure { key, name, .. } = KeyFigure::TIPPING_MARGIN;
    Some(Figure::new(key, format!("smallest {name}"), value, note).judged(excess))
}

/// The highest pressure, relative to the pressure at which a relief valve opens if there is one.
pub(super) fn pressure(crane: &Shown<'_>) -> Option<Figure> {
    let cylinders = crane.subject.crane.description().cylinders.iter();
    let all: Vec<_> = cylinders.map(|info| (info, highest_pressure(info, &crane.table))).collect();
    // Cylinders without a relief valve count only where none has one.
    let share = |index: usize| all[index].0.max_pressure.map_or(0.0, |limit| all[index].1.pressure / limit);
    let size = |index: usize| all[index].1.pressure;
    let greatest = (0..all.len()).max_by(|&a, &b| share(a).total_cmp(&share(b)).then(size(a).total_cmp(&size(b))))?;
    let (info, highest) = all[greatest];
    let limit = info.max_pressure.map(|limit| format!("; relief valve at {}", quantity(limit, "Pa")));
    let location = format!("{}, side of its {}, {}", spoken(&info.name), highest.side, crane.when(highest.time));
    let figure = Figure::new(
        "highest_pressure",
        "highest pressure",
        quantity(highest.pressure, "Pa"),
        location + limit.as_deref().unwrap_or_default(),
    );
    let open: Vec<String> = all
        .iter()
        .filter_map(|(info, highest)| {
            let relief = quantity(highest.relief(info)?, "Pa");
            Some(format!(
                "{} needs {}: its relief valve opens at {relief}",
                spoken(&info.name),
                quantity(highest.pressure, "Pa")
            ))
        })
        .collect();
    let excess = (!open.is_empty()).then(|| open.join("; "));
    Some(if limit.is_some() { figure.judged(excess) } else { figure })
}

/// Cylinders beyond an end of their strokes, if there are any: those of which a caution says so.
pub(super) fn strokes(crane: &Shown<'_>) -> Option<Figure> {
    let cylinders = crane.subject.crane.description().cylinders.iter();
    let beyond = cylinders.filter_map(|info| {
        let [length, time] = beyond_stroke(info, &Extremes::of_column(&crane.table, &format!("{}_length", info.name)))?;
        Some((info, (length - info.retracted) / info.stroke, time))
    });
    let beyond: Vec<_> = beyond.collect();
    let percent = |part: f64| readable(100.0 * part);
    let (info, part, time) = beyond.iter().max_by(|a, b| (a.1 - 0.5).abs().total_cmp(&(b.1 - 0.5).abs()))?;
    let note = format!("{}, {}", spoken(&info.name), crane.when(*time));
    let words = |(info, part, _): &(&CylinderInfo, f64, f64)| {
        format!("{} is at {} % of its stroke", spoken(&info.name), percent(*part))
    };
    let excess = beyond.iter().map(words).collect::<Vec<_>>().join("; ");
    Some(Figure::new("stroke", "stroke of a cylinder", format!("{} %", percent(*part)), note).judged(Some(excess)))
}

/// The largest error of the energy balance of a run.
pub(super) fn energy(crane: &Shown<'_>) -> Option<Figure> {
    crane.subject.run?;
    let of = Extremes::of_column(&crane.table, "energy_balance");
    let time = if -of.minimum > of.maximum { of.time_of_minimum } else { of.time_of_maximum };
    let value = quantity(of.size(), "J");
    Some(Figure::new("energy_balance", "error of the energy balance", value, format!("largest, {}", crane.when(time))))
}
