//! A recorded run with the derivatives of its columns.

use std::ops::ControlFlow;

use super::{Failed, Recorded, Start, recorded::record_by};
use crate::{
    dyn_crane::DynCrane,
    dynamics::{
        Sample, Settings,
        gradients::{self, Derivatives, Slopes, WatchDerivatives, columns_along},
    },
    results::{QUANTITIES, Recording, quantities_at},
};

/// Derivatives of the columns of a run: direction by direction, row by row. NaN for what only the audit of a run has: work, dissipated energy
/// and energy balance. Parameters that an event sets change nothing after it.
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
    let mut gradients = vec![Vec::new(); slopes.count()];
    let recorded = record_by(crane, start, settings, |recording| {
        let mut recorder = Recorder { recording, gradients: &mut gradients, proceed };
        gradients::simulate(crane, &start.state, slopes, along, settings, &QUANTITIES, &mut recorder)
    })?;
    Ok((recorded, gradients))
}

/// Records every sample with its derivatives, and asks after every step whether to continue.
struct Recorder<'a, 'c> {
    recording: &'a mut Recording<'c>,
    gradients: &'a mut Gradients,
    proceed: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl WatchDerivatives for Recorder<'_, '_> {
    fn sample(&mut self, sample: &Sample<'_>, derivatives: &Derivatives<'_>) {
        self.recording.push(sample);
        let here = self.recording.last();
        let motion = [sample.q, sample.v, sample.x].concat();
        let Derivatives { crane, numbers, motion: changes, times } = *derivatives;
        for (direction, rows) in self.gradients.iter_mut().enumerate() {
            let (around, change) = (numbers.around(direction), &changes[direction]);
            let mut row = columns_along(crane, around, (sample.t, &motion), change, here, quantities_at);
            row.resize(here.len() - times[direction].len(), f64::NAN);
            row.extend(&times[direction]);
            rows.push(row);
        }
    }

    fn step(&mut self, t: f64) -> ControlFlow<()> {
        (self.proceed)(t)
    }
}
