//! Derivatives of columns of results.

use super::{Around, Covector, DIFFERENCE, Numbers, OfMotion, TOGETHER, difference, size_of};
use crate::{StateAt, dyn_crane::DynCrane, dynamics::ResultsAt, force_states::ForceStates};

/// A column of coordinates and their rates, which follow the time: its place in a motion.
fn of_motion(n: usize, column: usize) -> Option<usize> {
    (1..=2 * n).contains(&column).then(|| column - 1)
}

/// Results of a crane, as a function of a motion.
fn results(n: usize, t: f64, at: ResultsAt) -> impl FnMut(&dyn DynCrane, &[f64]) -> Vec<f64> {
    move |crane, motion| at(crane, &StateAt::from_motion(t, n, motion))
}

/// Derivatives of the columns at a motion along a direction, in which the motion changes by `change`. `here`: the columns.
#[must_use]
pub fn columns_along(
    crane: &dyn DynCrane,
    around: Option<Around<'_>>,
    (t, motion): (f64, &[f64]),
    change: &[f64],
    here: &[f64],
    at: ResultsAt,
) -> Vec<f64> {
    let n = crane.size();
    let size = size_of(change, n, &ForceStates::new(crane.description()).scales());
    let mut row = forward_difference(crane, around, (motion, change, size), here, &mut results(n, t, at));
    // These need no differences: t, q and v come first.
    row[1..][..2 * n].copy_from_slice(&change[..2 * n]);
    row
}

/// The same of one column, with differences to both sides.
pub(super) fn column_along(
    crane: &dyn DynCrane,
    around: Option<Around<'_>>,
    (t, motion): (f64, &[f64]),
    change: &[f64],
    column: usize,
    at: ResultsAt,
) -> f64 {
    let n = crane.size();
    if let Some(index) = of_motion(n, column) {
        return change[index];
    }
    let size = size_of(change, n, &ForceStates::new(crane.description()).scales());
    difference(crane, around, (motion, change, size), &mut results(n, t, at))[column]
}

/// Derivatives of some columns at a motion, each with respect to the motion and to the numbers of all directions; NaN for those that no state has.
#[must_use]
pub fn columns_by(
    crane: &dyn DynCrane,
    numbers: &dyn Numbers,
    (t, motion): (f64, &[f64]),
    columns: &[usize],
    at: ResultsAt,
) -> Vec<Covector> {
    let (n, len, directions) = (crane.size(), motion.len(), numbers.count());
    let mut all = vec![Covector::zero(len, directions); columns.len()];
    for (covector, column) in all.iter_mut().zip(columns) {
        if let Some(place) = of_motion(n, *column) {
            covector.motion[place] = 1.0;
        }
    }
    let others = || columns.iter().enumerate().filter(|(_, column)| of_motion(n, **column).is_none());
    if others().next().is_none() {
        return all;
    }
    let scales = ForceStates::new(crane.description()).scales();
    let row = |around: Option<Around<'_>>, change: &[f64]| {
        let size = size_of(change, n, &scales);
        // To both sides: energies of stiff springs are squares of small numbers.
        difference(crane, around, (motion, change, size), &mut results(n, t, at))
    };
    let nothing = vec![0.0; len];
    let by_motion: Vec<Vec<f64>> = (0..len)
        .map(|place| {
            let mut change = nothing.clone();
            change[place] = 1.0;
            row(None, &change)
        })
        .collect();
    let by_numbers: Vec<Vec<f64>> = (0..directions).map(|direction| row(numbers.around(direction), &nothing)).collect();
    for (index, column) in others() {
        let of_rows =
            |rows: &[Vec<f64>]| rows.iter().map(|row| row.get(*column).copied().unwrap_or(f64::NAN)).collect();
        all[index] = Covector { motion: of_rows(&by_motion), numbers: of_rows(&by_numbers) };
    }
    all
}

/// The same to one side, given the values at the motion: the error is the step instead of its square.
fn forward_difference(
    crane: &dyn DynCrane,
    around: Option<Around<'_>>,
    (motion, change, size): (&[f64], &[f64], f64),
    here: &[f64],
    of: OfMotion<'_>,
) -> Vec<f64> {
    let mut between = |crane: &dyn DynCrane, along: f64, width: f64| -> Vec<f64> {
        let moved: Vec<f64> = motion.iter().zip(change).map(|(x, change)| x + along * change).collect();
        of(crane, &moved).iter().zip(here).map(|(there, here)| (there - here) / width).collect()
    };
    let alone = DIFFERENCE / size;
    let Some(Around { cranes: [less, more], steps: [down, up] }) = around else {
        return if size == 0.0 { vec![0.0; here.len()] } else { between(crane, alone, alone) };
    };
    let (beside, step) = if up > 0.0 { (more, up) } else { (less, -down) };
    if TOGETHER.contains(&(size * step.abs())) {
        return between(beside, step, step);
    }
    let of_crane = between(beside, 0.0, step);
    if size == 0.0 {
        return of_crane;
    }
    of_crane.iter().zip(between(crane, alone, alone)).map(|(one, other)| one + other).collect()
}
