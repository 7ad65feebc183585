//! Drives at the limit of their effort.

use crane_quantities::ColumnKind;

use super::{Table, column_name, drive_effort};
use crate::{
    DriveInfo,
    dyn_crane::DynCrane,
    statics::{REACHED, Reached, reached},
};

/// Drives at their limits in a pose at rest, and how far the joints are from the drives' positions.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> impl Iterator<Item = String> {
    let motions = crane.drive_motions_at(0.0);
    let description = crane.description();
    let at_limit = reached(crane, q);
    let limited: Vec<usize> = at_limit.iter().map(|reached| reached.drive).collect();
    let positions: Vec<f64> = motions.iter().map(|[position, _]| *position).collect();
    // A drive that only has an effort holds nothing.
    let holds = |index: usize| {
        let mut moved = positions.clone();
        moved[index] += FAR;
        let [here, there] = [&positions, &moved].map(|positions| crane.drive_efforts_holding(0.0, positions, q)[index]);
        here != there
    };
    let is_far = |(index, drive): &(usize, &DriveInfo)| {
        !limited.contains(index) && (positions[*index] - q[drive.coordinate]).abs() > FAR && holds(*index)
    };
    let far = description.drives.iter().enumerate().filter(is_far).map(|(index, drive)| {
        let coordinate = &description.coordinates[drive.coordinate];
        let away = (positions[index] - q[drive.coordinate]).abs();
        format!(
            "{} rests {away:.3} {} from where its drive holds it: the drive is soft, or a linkage has passed its dead centre",
            coordinate.name,
            coordinate.kind.unit()
        )
    });
    let far: Vec<String> = far.collect();
    let at_limit = at_limit.into_iter().map(move |Reached { drive, effort, limit }| {
        let index = description.drives[drive].coordinate;
        let coordinate = &description.coordinates[index];
        let [position, _] = motions[drive];
        let unit = coordinate.kind.force_unit();
        format!(
            "the drive of {} is at its limit, {:.1} of {limit:.1} {unit}: the joint rests {:.4} {} from where the drive would hold it",
            coordinate.name,
            effort.abs(),
            (position - q[index]).abs(),
            coordinate.kind.unit()
        )
    });
    at_limit.chain(far)
}

/// Distance between a joint at rest and where its drive holds it that nobody means, rad or m.
const FAR: f64 = 0.5;

/// Fraction of its maximum rate from which the effort of a drive is reported to fade: it has fallen by a tenth.
const FADED: f64 = 0.92;

/// Drives that reach their limits in a run: when first, for how long, and how far the joints fall behind.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    let description = crane.description();
    let limits = description.drives.iter().zip(crane.drive_limits_at());
    let cautions = limits.filter_map(|(drive, limit)| {
        let (limit, coordinate) = (limit?, &description.coordinates[drive.coordinate]);
        let index_of = |name: &str| table.columns.iter().position(|column| column.name == name);
        let named = |kind| column_name(kind, &coordinate.name, coordinate.kind.turns());
        let effort = index_of(&drive_effort(&coordinate.name, coordinate.kind))?;
        let (actual, prescribed) = (index_of(&coordinate.name)?, index_of(&named(ColumnKind::Prescribed))?);
        let (rate, unit) = (index_of(&named(ColumnKind::Rate))?, coordinate.kind.unit());
        // Effort, power and rate, as in the words below.
        let met = |row: &[f64]| {
            let power = row[effort] * row[rate];
            let at_rate = |most| power > 0.0 && row[rate].abs() >= FADED * most;
            [
                row[effort].abs() >= REACHED * limit,
                drive.max_power.is_some_and(|most| power >= REACHED * most),
                drive.max_rate.is_some_and(at_rate),
            ]
        };
        let words = [
            format!("{limit:.1} {}", coordinate.kind.force_unit()),
            format!("{:.1} W", drive.max_power.unwrap_or(f64::NAN)),
            format!("{} {unit}/s", drive.max_rate.unwrap_or(f64::NAN)),
        ];
        let some = (0..3).filter(|&kind| table.rows.iter().any(|row| met(row)[kind]));
        let limit = some.map(|kind| words[kind].as_str()).collect::<Vec<_>>().join(" and ");
        let reached = || table.rows.iter().filter(|row| met(row).contains(&true));
        let first = reached().next()?[0];
        let time = table.time_of(reached().count());
        let behind = |row: &Vec<f64>| (row[prescribed] - row[actual]).abs();
        let worst = table.rows.iter().max_by(|a, b| behind(a).total_cmp(&behind(b)))?;
        Some(format!(
            "the drive of {} is at its limit of {limit} for {time:.2} s, first at {first:.2} s; the joint falls behind its motion by \
             up to {:.4} {}, at {:.2} s",
            coordinate.name,
            behind(worst),
            unit,
            worst[0]
        ))
    });
    cautions.collect()
}
