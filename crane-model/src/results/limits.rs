//! Drives at the limit of their effort.

use super::{Table, drive_effort};
use crate::dyn_crane::DynCrane;

/// Part of its limit from which a drive is said to be there: what is left is the rounded corner of its law.
const REACHED: f64 = 0.985;

/// Drives that a pose at rest takes to their limits, and how far the joints are from where the drives stand.
pub(super) fn of_pose(rig: &dyn DynCrane, q: &[f64]) -> impl Iterator<Item = String> {
    let description = rig.description();
    let efforts = rig.drive_efforts_at_rest(q);
    let motions = rig.drive_motions_at(0.0);
    let drives = description.drives.iter().zip(rig.drive_limits_at()).zip(efforts.into_iter().zip(motions));
    let reached = drives.filter_map(|((drive, limit), (effort, [position, _]))| {
        let coordinate = &description.coordinates[drive.coordinate];
        let behind = (position - q[drive.coordinate]).abs();
        (effort.abs() >= REACHED * limit?).then(|| {
            format!(
                "the drive of {} cannot hold it: at its limit of {:.1} {} the joint is {behind:.4} {} from where the drive holds",
                coordinate.name,
                effort.abs(),
                coordinate.kind.force_unit(),
                coordinate.kind.unit()
            )
        })
    });
    reached.collect::<Vec<_>>().into_iter()
}

/// Drives that a run takes to their limits: when first, for how long, and how far the joints fall behind.
pub(super) fn of_run(rig: &dyn DynCrane, table: &Table) -> Vec<String> {
    let description = rig.description();
    let limits = description.drives.iter().zip(rig.drive_limits_at());
    let said = limits.filter_map(|(drive, limit)| {
        let (limit, coordinate) = (limit?, &description.coordinates[drive.coordinate]);
        let place = |name: &str| table.columns.iter().position(|column| column.name == name);
        let effort = place(&drive_effort(&coordinate.name, coordinate.kind))?;
        let (own, prescribed) = (place(&coordinate.name)?, place(&format!("{}_prescribed", coordinate.name))?);
        let reached = || table.rows.iter().filter(|row| row[effort].abs() >= REACHED * limit);
        let first = reached().next()?[0];
        let duration = table.rows.last().map_or(0.0, |row| row[0]);
        let time = reached().count() as f64 * duration / (table.rows.len().max(2) - 1) as f64;
        let behind = |row: &Vec<f64>| (row[prescribed] - row[own]).abs();
        let worst = table.rows.iter().max_by(|a, b| behind(a).total_cmp(&behind(b)))?;
        Some(format!(
            "the drive of {} is at its limit of {limit:.1} {} for {time:.2} s, first at {first:.2} s; the joint falls behind its motion by \
             up to {:.4} {}, at {:.2} s",
            coordinate.name,
            coordinate.kind.force_unit(),
            behind(worst),
            coordinate.kind.unit(),
            worst[0]
        ))
    });
    said.collect()
}
