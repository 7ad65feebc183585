//! A recorded run with the derivatives of its columns.

use std::ops::ControlFlow;

use super::{Failed, Recorded, Start, recorded::record_by};
use crate::{
    dyn_crane::DynCrane,
    dynamics::{
        Sample, Settings,
        gradients::{self, Slopes, WatchDerivatives, forward_difference, size_of},
        without_events,
    },
    force_states::ForceStates,
    results::{Recording, quantities_at},
};

/// Derivatives of the columns of a run: direction by direction, row by row. NaN for what only the audit of a run has: work, dissipated energy
/// and energy balance.
pub type Gradients = Vec<Vec<Vec<f64>>>;

/// As [`record`](super::record), by the method with derivatives, with the derivatives of all columns along directions. `along`: those of the
/// start `[q, v, x]`.
///
/// # Errors
/// [`Reason::Stopped`](super::Reason::Stopped).
pub fn record_gradients(
    crane: &dyn DynCrane,
    start: &Start,
    settings: &Settings,
    slopes: &mut dyn Slopes,
    along: Vec<Vec<f64>>,
    proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<(Recorded, Gradients), Failed> {
    let mut states = Vec::new();
    let recorded = record_by(crane, start, settings, |recording| {
        without_events(crane.description(), settings, "runs with derivatives")?;
        let mut recorder = Recorder { recording, states: &mut states, proceed };
        gradients::simulate(crane, &start.state(), slopes, along, settings, &mut recorder)
    })?;
    let columns = recorded.table.columns.len();
    let gradients = (0..slopes.count())
        .map(|direction| {
            let of_state = |(state, here): (&State, &Vec<f64>)| {
                let mut row = columns_along(crane, &*slopes, direction, state, here);
                row.resize(columns, f64::NAN);
                row
            };
            states.iter().zip(&recorded.table.rows).map(of_state).collect()
        })
        .collect();
    Ok((recorded, gradients))
}

/// A state of a run with its derivatives.
struct State {
    t: f64,
    motion: Vec<f64>,
    derivatives: Vec<Vec<f64>>,
}

/// Derivatives of the quantities at a state along a direction. `here`: the quantities.
fn columns_along(crane: &dyn DynCrane, slopes: &dyn Slopes, direction: usize, state: &State, here: &[f64]) -> Vec<f64> {
    let n = crane.size();
    let change = &state.derivatives[direction];
    let size = size_of(change, n, &ForceStates::new(crane.description()).scales());
    let motion = (&*state.motion, &**change, size);
    let mut row = forward_difference(crane, slopes.around(direction), motion, here, &mut |crane, motion| {
        let ((q, v), x) = (motion[..2 * n].split_at(n), &motion[2 * n..]);
        quantities_at(crane, state.t, (q, v), x)
    });
    // These need no differences: t, q and v come first.
    row[1..][..2 * n].copy_from_slice(&change[..2 * n]);
    row
}

/// Records every sample with its derivatives, and asks after every step whether to continue.
struct Recorder<'a, 'c> {
    recording: &'a mut Recording<'c>,
    states: &'a mut Vec<State>,
    proceed: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl WatchDerivatives for Recorder<'_, '_> {
    fn sample(&mut self, sample: &Sample<'_>, derivatives: &[Vec<f64>]) {
        self.recording.push(sample);
        let motion = [sample.q, sample.v, sample.x].concat();
        self.states.push(State { t: sample.t, motion, derivatives: derivatives.to_vec() });
    }

    fn step(&mut self, t: f64) -> ControlFlow<()> {
        (self.proceed)(t)
    }
}
