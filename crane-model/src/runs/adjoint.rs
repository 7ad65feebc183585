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
        gradients::{Covector, PullBacks, Slopes, Trace, Weights, columns_by},
    },
    results::{QUANTITIES, Recording, quantities_at},
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
        let mut recorder = Recorder { recording, states: &mut states, proceed: &mut *proceed };
        let found = Trace::new(crane, &start.state, probes, settings, &QUANTITIES, &mut recorder)?;
        Ok(trace.insert(found).run())
    })?;
    let rows = &recorded.table.rows;
    let t: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let weights: Vec<Vec<(usize, f64)>> = asked
        .iter()
        .map(|(column, measure)| measure.weights(&t, &rows.iter().map(|row| row[*column]).collect::<Vec<f64>>()))
        .collect();
    let nothing = || vec![vec![f64::NAN; along.len()]; asked.len()];
    let after = trace.as_ref().and_then(|trace: &Trace<'_>| trace.functions_after(&*functions));
    let (Some(trace), Some(mut after)) = (trace, after) else { return Ok((recorded, nothing())) };
    let first: &mut dyn PullBacks = functions;
    let mut functions = vec![first];
    functions.extend(after.iter_mut().map(|functions| &mut **functions as &mut dyn PullBacks));
    let mut by_samples: Vec<Vec<(usize, Covector)>> = vec![Vec::new(); asked.len()];
    let mut by_times = vec![vec![0.0; crane.description().conditions().count()]; asked.len()];
    let first_time = recorded.table.columns.len() - crane.description().conditions().count();
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
        let (of_times, of_states): (Vec<_>, Vec<_>) =
            here.into_iter().partition(|(index, _)| asked[*index].0 >= first_time);
        for (index, weight) in of_times {
            let condition = asked[index].0 - first_time;
            // Before, the time of an event is 0.
            if rows[sample][asked[index].0] != 0.0 {
                by_times[index][condition] += weight;
            }
        }
        let columns: Vec<usize> = of_states.iter().map(|(index, _)| asked[*index].0).collect();
        let (events, present) = trace.crane_at(sample);
        let found = columns_by(present, &*functions[events], (state.0, &state.1), &columns, quantities_at);
        for ((index, weight), mut covector) in of_states.into_iter().zip(found) {
            covector.motion.iter_mut().chain(&mut covector.numbers).for_each(|entry| *entry *= weight);
            by_samples[index].push((sample, covector));
        }
    }
    let mut gradients = Vec::new();
    for (samples, times) in by_samples.iter().zip(&by_times) {
        let weights = Weights { samples, times };
        let found = if is_off { None } else { trace.pull_back(&mut functions, weights, proceed).ok() };
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
