//! What can be computed with a crane in one call: its equilibrium, small motions, runs, and quantities with the states of its forces.

use std::ops::ControlFlow;

use crate::{
    ParameterError, StateAt, Wrench,
    dyn_crane::{DynCrane, Energies},
    dynamics,
    dynamics::{InitialState, Run, Sample, Stopped, ensemble, ensemble::Member},
    feet::{Feet, Slid},
    force_states,
    hydraulics::Oil,
    modes,
    modes::SmallMotions,
    results::{QUANTITIES, drive_efforts_with, energies_with},
    statics,
    statics::Equilibrium,
};

/// # Panics
/// If `q`, `v` or a start does not have as many numbers as the crane has coordinates.
impl dyn DynCrane + '_ {
    /// Torques and forces of the drives at a sample of a run, those of cylinders with a valve from their pressures: N m and N.
    pub fn drive_efforts_of(&self, sample: &Sample<'_>) -> Vec<f64> {
        drive_efforts_with(self, sample)
    }

    /// How much of its friction each one-sided support on the ground uses in a pose at rest, |F|/(μ N), with its index: from 1 on it slides.
    pub fn friction_utilisations_at(&self, q: &[f64]) -> Vec<(usize, f64)> {
        Feet::at_rest(self, q).utilisations_on_the_ground().collect()
    }

    /// Energies at a sample of a run, with the springs of feet that have slid, J.
    pub fn energies_of(&self, sample: &Sample<'_>) -> Energies {
        energies_with(self, sample, &Slid::at(self, sample))
    }

    /// As `internal_forces_at`, with cylinders that push with the force of their pressures, which are among the states `x` of forces.
    pub fn internal_forces_of(&self, moment: &StateAt<'_>, a: &[f64]) -> Vec<Wrench> {
        let mut pushes = vec![0.0; self.description().cylinders.len()];
        if let Some(oil) = Oil::at(self, moment) {
            for (index, state, _) in &oil.cylinders {
                pushes[*index] = state.force;
            }
        }
        let closed = force_states::motion_at(self, moment);
        self.internal_forces_with(moment.t, [moment.q, moment.v, a], &pushes, closed.multipliers())
    }

    /// Static equilibrium from the guess: [`statics::Problem`].
    pub fn equilibrium(&self, settings: &statics::Settings) -> Equilibrium {
        statics::Problem::new(self).settings(settings).solve()
    }

    /// Coefficients of small motions about a pose at rest, with shut valves and joints that stick.
    pub fn small_motions_at(&self, q: &[f64]) -> SmallMotions {
        let mut motions = SmallMotions::about_pose(self, q);
        modes::stiffen_by_oil(self, q, &mut motions);
        modes::stiffen_by_bristles(self.description(), &mut motions);
        motions.with_closed_loops(self, 0.0, q)
    }

    /// A run: [`dynamics::Simulation`], with the events of the crane.
    ///
    /// # Errors
    /// [`Stopped`] if the run ends early.
    pub fn simulate(
        &self,
        start: &InitialState,
        settings: &dynamics::Settings,
        observe: &mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>,
    ) -> Result<Run, Stopped> {
        dynamics::Simulation::with_events(self, &QUANTITIES, start, settings).observe(observe)
    }

    /// Runs of cranes that differ in their parameters, several at a time: [`ensemble::simulate`], with the events of the crane.
    ///
    /// # Errors
    /// The parameters of a member break a rule of the spec language.
    pub fn simulate_ensemble(
        &self,
        members: &[Member],
        settings: &dynamics::Settings,
        observe: &mut dyn FnMut(usize, &Sample<'_>),
    ) -> Result<Vec<Result<Run, Stopped>>, ParameterError> {
        if self.description().events.is_empty() {
            return ensemble::simulate((self, members), settings, observe);
        }
        // Lanes do not change their parameters during a run.
        let run = |(index, member): (usize, &Member)| {
            let mut watch = |sample: &Sample<'_>| {
                observe(index, sample);
                ControlFlow::Continue(())
            };
            Ok(member.crane(self)?.simulate(&member.start, settings, &mut watch))
        };
        members.iter().enumerate().map(run).collect()
    }
}
