//! Loops near a dead centre, and reactions that cannot be determined.

use super::Table;
use crate::{
    dyn_crane::DynCrane,
    loop_joints::{Caution, Watch},
};

/// The cautions of a run: of each kind the first with its time, of dead centres the nearest with the times of all.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    if crane.loop_joints().is_empty() {
        return Vec::new();
    }
    let mut watch = Watch::new(crane);
    let mut found: Vec<LoopColumns> = Vec::new();
    for (index, q) in table.poses(crane.description()).enumerate() {
        for caution in watch.cautions(q) {
            let angle = caution.angle();
            let Some(known) = found.iter_mut().find(|known| known.caution.is_like(&caution)) else {
                found.push(LoopColumns { caution, last: index, passed: vec![(index, angle)] });
                continue;
            };
            match known.passed.last_mut() {
                Some(passed) if known.last + 1 == index => {
                    if is_nearer(angle, passed.1) {
                        *passed = (index, angle);
                    }
                }
                _ => known.passed.push((index, angle)),
            }
            known.last = index;
            if is_nearer(angle, known.caution.angle()) {
                known.caution = caution;
            }
        }
    }
    // Where all joints are in line, those without a drive are, too.
    let in_line = found.iter().any(|known| matches!(known.caution, Caution::DeadCentre { .. }));
    found.retain(|known| !(in_line && matches!(known.caution, Caution::DeadCentreOfDrives { .. })));
    let time = |index: usize| table.rows.get(index).and_then(|row| row.first()).copied().unwrap_or(0.0);
    found.iter().map(|known| format!("{}{}", known.caution, known.when(time))).collect()
}

/// Whether an angle is smaller than another one, beyond rounding: a loop that rests is nearest when it comes to rest.
fn is_nearer(angle: Option<f64>, other: Option<f64>) -> bool {
    const ROUNDING: f64 = 1e-4;
    angle.zip(other).is_some_and(|(angle, other)| angle < other * (1.0 - ROUNDING))
}

/// A kind of caution.
struct LoopColumns {
    /// The first; of a dead centre the nearest.
    caution: Caution,
    /// The last result with such a caution.
    last: usize,
    /// Each time without interruption: of a dead centre the nearest result, otherwise the first.
    passed: Vec<(usize, Option<f64>)>,
}

impl LoopColumns {
    /// When, in brackets; nothing at the start.
    fn when(&self, time: impl Fn(usize) -> f64) -> String {
        /// Times that are listed.
        const MOST: usize = 3;
        let Some((first, angle)) = self.passed.first() else { return String::new() };
        if angle.is_none() {
            return if *first == 0 { String::new() } else { format!(" (first at {:.2} s)", time(*first)) };
        }
        let times: Vec<String> =
            self.passed.iter().take(MOST).map(|(index, _)| format!("{:.3} s", time(*index))).collect();
        let others = self.passed.len() - times.len();
        let more = if others == 0 { String::new() } else { format!(", and {others} times later") };
        let listed = if others == 0 { times.join(" and ") } else { times.join(", ") };
        format!(" (nearest at {listed}{more})")
    }
}
