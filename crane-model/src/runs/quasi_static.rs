//! What a crane would carry if its motion took forever.

use std::ops::ControlFlow;

use super::Start;
use crate::{
    dyn_crane::DynCrane,
    dynamics::{Phases, event_times},
    results::{Instant, Recording, Table},
    statics::Problem,
};

/// A crane at rest at some times of a run, with the drives, the loads and the parameters of these times.
pub struct QuasiStatic {
    /// The results of a run, at these times.
    pub table: Table,
    /// What it carries there.
    pub instants: Vec<Instant>,
    /// The times at which it does not rest, s.
    pub restless: Vec<f64>,
}

impl QuasiStatic {
    /// At about `most` of the results of a run, evenly spread. `proceed` receives the times, s, and may stop.
    pub fn along(
        crane: &dyn DynCrane,
        start: &Start,
        run: &Table,
        most: usize,
        proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Self {
        let (mut phases, mut recording, mut q) = (Phases::new(crane), Recording::new(crane), start.q.clone());
        let (mut instants, mut restless) = (Vec::new(), Vec::new());
        let every = run.rows.len().div_ceil(most).max(1);
        let last = run.rows.len().saturating_sub(1);
        for (_, row) in run.rows.iter().enumerate().filter(|(index, _)| index % every == 0 || *index == last) {
            let (t, times) = (row[0], event_times(crane.description(), row));
            let present = phases.at(t, times);
            let equilibrium = Problem::new(present).at_time(t).from(&q).solve();
            if equilibrium.is_stable() {
                q = equilibrium.q;
                recording.push_rest(t, &q, times);
                instants.push(Instant::at_rest_with(present, t, &q));
            } else {
                restless.push(t);
            }
            if proceed(t).is_break() {
                break;
            }
        }
        Self { table: recording.into_table(), instants, restless }
    }
}
