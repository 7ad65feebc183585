//! A recorded run with the derivatives of a few numbers of it by many.

use std::ops::ControlFlow;

use super::{
    Failed, Measure, Recorded, Start,
    recorded::{clock, record_by},
};
use crate::{
    dyn_crane::DynCrane,
    dynamics::{
        Sample, Settings, Watch,
        gradients::{Around, Covector, PullBacks, Slopes, Trace, difference, size_of},
        without_events,
    },
    force_states::ForceStates,
    results::{Recording, quantities_at},
};

/// What a run in adjoint mode needs of its crane.
pub struct Transposed<'a> {
    /// Its functions, in all directions.
    pub functions: &'a mut dyn PullBacks,
    /// The derivatives of the start `[q, v, x]`, direction by direction.
    pub along: &'a [Vec<f64>],
    /// Its functions along a few directions, sums of the others, whose errors the steps allow, and the derivatives of the start along them.
    pub probes: (&'a mut dyn Slopes, Vec<Vec<f64>>),
}

/// As [`record`](super::record), by the method with derivatives, with the derivatives of measures of columns, given by their indices, in all directions.
/// `proceed` also receives the times of the way back; if it ends the run there, derivatives are NaN, as they are where they are not finite.
///
/// # Errors
/// [`Reason::Stopped`](super::Reason::Stopped).
pub fn record_adjoint(
    crane: &dyn DynCrane,
    start: &Start,
    settings: &Settings,
    Transposed { functions, along, probes }: Transposed<'_>,
    asked: &[(usize, Measure)],
    proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<(Recorded, Vec<Vec<f64>>), Failed> {
    let begin = clock();
    let (mut states, mut trace) = (Vec::new(), None);
    let mut recorded = record_by(crane, start, settings, |recording| {
        without_events(crane.description(), settings, "runs with derivatives")?;
        let mut recorder = Recorder { recording, states: &mut states, proceed: &mut *proceed };
        let found = Trace::new(crane, &start.state(), probes, settings, &mut recorder)?;
        Ok(trace.insert(found).run())
    })?;
    let rows = &recorded.table.rows;
    let t: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let weights: Vec<Vec<(usize, f64)>> = asked
        .iter()
        .map(|(column, measure)| measure.weights(&t, &rows.iter().map(|row| row[*column]).collect::<Vec<f64>>()))
        .collect();
    let mut by_samples: Vec<Vec<(usize, Covector)>> = vec![Vec::new(); asked.len()];
    let mut is_off = false;
    for (sample, state) in states.iter().enumerate() {
        is_off |= proceed(state.0).is_break();
        if is_off {
            break;
        }
        let here: Vec<(usize, f64)> = weights
            .iter()
            .enumerate()
            .filter_map(|(index, of)| of.iter().find(|(row, _)| *row == sample).map(|(_, weight)| (index, *weight)))
            .collect();
        let columns: Vec<usize> = here.iter().map(|(index, _)| asked[*index].0).collect();
        let found = derivatives(crane, &*functions, state, &columns);
        for ((index, weight), mut covector) in here.into_iter().zip(found) {
            covector.motion.iter_mut().chain(&mut covector.numbers).for_each(|entry| *entry *= weight);
            by_samples[index].push((sample, covector));
        }
    }
    let mut gradients = Vec::new();
    for own in &by_samples {
        let found = trace.as_mut().filter(|_| !is_off);
        let found = found.and_then(|trace| trace.pull_back(functions, own, proceed).ok());
        let by = |direction: usize| {
            found.as_ref().map_or(f64::NAN, |Covector { motion, numbers }| {
                let of_start: f64 = along[direction].iter().zip(motion).map(|(along, by)| along * by).sum();
                of_start + numbers[direction]
            })
        };
        gradients.push((0..along.len()).map(by).collect());
    }
    recorded.wall = begin.map(|begin| begin.elapsed());
    Ok((recorded, gradients))
}

/// Derivatives of columns at a state, each with respect to the motion and to the numbers of all directions.
fn derivatives(
    crane: &dyn DynCrane,
    functions: &dyn PullBacks,
    (t, motion): &(f64, Vec<f64>),
    columns: &[usize],
) -> Vec<Covector> {
    let (n, len, directions) = (crane.size(), motion.len(), functions.count());
    let mut all = vec![Covector::zero(len, directions); columns.len()];
    // t, q and v come first.
    let is_of_motion = |column: usize| (1..=2 * n).contains(&column);
    for (covector, column) in all.iter_mut().zip(columns).filter(|(_, column)| is_of_motion(**column)) {
        covector.motion[column - 1] = 1.0;
    }
    if columns.iter().all(|column| is_of_motion(*column)) {
        return all;
    }
    let scales = ForceStates::new(crane.description()).scales();
    let row = |around: Option<Around<'_>>, change: &[f64]| {
        let size = size_of(change, n, &scales);
        // To both sides: energies of stiff springs are squares of small numbers.
        difference(crane, around, (motion, change, size), &mut |crane, motion| {
            let ((q, v), x) = (motion[..2 * n].split_at(n), &motion[2 * n..]);
            quantities_at(crane, *t, (q, v), x)
        })
    };
    let nothing = vec![0.0; len];
    let by_motion: Vec<Vec<f64>> = (0..len)
        .map(|place| {
            let mut change = nothing.clone();
            change[place] = 1.0;
            row(None, &change)
        })
        .collect();
    let by_numbers: Vec<Vec<f64>> =
        (0..directions).map(|direction| row(functions.around(direction), &nothing)).collect();
    for (covector, column) in all.iter_mut().zip(columns).filter(|(_, column)| !is_of_motion(**column)) {
        // What only the audit of a run has does not follow from a state.
        let of_rows =
            |rows: &[Vec<f64>]| rows.iter().map(|row| row.get(*column).copied().unwrap_or(f64::NAN)).collect();
        (covector.motion, covector.numbers) = (of_rows(&by_motion), of_rows(&by_numbers));
    }
    all
}

/// Records every sample and keeps its motion, and asks after every step whether to continue.
struct Recorder<'a, 'c> {
    recording: &'a mut Recording<'c>,
    states: &'a mut Vec<(f64, Vec<f64>)>,
    proceed: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl Watch for Recorder<'_, '_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.recording.push(sample);
        self.states.push((sample.t, [sample.q, sample.v, sample.x].concat()));
        ControlFlow::Continue(())
    }

    fn step(&mut self, t: f64) -> ControlFlow<()> {
        (self.proceed)(t)
    }
}
