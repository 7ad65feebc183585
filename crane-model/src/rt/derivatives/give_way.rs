//! How what is beyond each coordinate gives way to its changes, by an inward sweep.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]

use super::changes::{COLUMNS, Changes};
use super::columns::{Columns, Constant};
use super::residual::own;
use super::sweeps::{Entry, States, Sweeps, mass};
use super::vectors::three;
use super::{Link, Own, combine};

/// Gives the changes and the coordinates what follows from the way in which everything beyond gives way. `rows`: those of the derivatives of the residual.
#[inline(always)]
pub(super) fn give_way<C: Columns>(
    sweeps: &mut Sweeps<'_, C>,
    rows: &[Own<C>],
    changes: &mut [Changes<C>],
    swept: &mut [Entry<C>],
    states: &mut States<'_, C>,
) {
    let n = sweeps.links.len();
    for (j, Link { before, .. }) in sweeps.links.iter().enumerate() {
        let from = before.and_then(|before| changes.get(before)).map_or([C::Number::constant(0.0); 3], |one| one.point);
        if let (Some(change), Some(joint)) = (changes.get_mut(j), sweeps.joints.get(j)) {
            change.point = three!(|k| combine::<C, 2>([&from[k], &joint.own[mass::OFFSET + k]], |[a, b]| a + b));
        }
    }
    let (stride, units) = (swept.len() / n.max(1), COLUMNS.div_ceil(C::WIDTH));
    for (row, own) in swept.chunks_exact_mut(stride.max(1)).zip(rows) {
        for unit in 0..row.len().min(COLUMNS.div_ceil(C::WIDTH)) {
            row[unit][0] = C::load(&own[own::LINEAR_MOMENTUM + unit * C::WIDTH..own::LINEAR_MOMENTUM + COLUMNS]);
        }
    }
    sweeps.inward::<false>(0..n, |_| 0..units, swept, states, &[], changes);
    for (joint, row) in sweeps.joints.iter_mut().zip(swept.chunks_exact(stride.max(1))) {
        for k in 0..3 {
            let column = COLUMNS - 3 + k;
            if let Some([answers, ..]) = row.get(column / C::WIDTH) {
                joint.own[mass::ANSWER + k] = C::number(answers, column % C::WIDTH);
            }
        }
    }
}
