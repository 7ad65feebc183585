//! Loops near a dead centre, and reactions that cannot be determined.

use super::Table;
use crate::{dyn_crane::DynCrane, loop_joints};

/// The first cautions of a run, each with its time.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    if crane.loop_joints().is_empty() {
        return Vec::new();
    }
    let mut found: Vec<(String, String)> = Vec::new();
    for (index, q) in table.poses(crane.description()).enumerate() {
        for caution in loop_joints::cautions(crane, q) {
            // Cautions of one kind differ in their numbers.
            let kind = caution.split(|c: char| c.is_ascii_digit()).next().unwrap_or_default().to_owned();
            if !found.iter().any(|(known, _)| *known == kind) {
                let time = table.rows.get(index).and_then(|row| row.first()).copied().unwrap_or(0.0);
                let when = if index == 0 { String::new() } else { format!(" (first at {time:.2} s)") };
                found.push((kind, caution + &when));
            }
        }
    }
    found.into_iter().map(|(_, caution)| caution).collect()
}
