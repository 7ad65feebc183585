//! Changes of forces and of the drives' motions between steps.

use super::{Bdf, History, SAME};
use crate::dynamics::{Stopped, equations::Equations, motion::add, state::NotFinite};

impl Bdf<'_> {
    /// Goes back to `t` and continues from there after `change`.
    ///
    /// The past is not that of the motion which follows. But a motion with the same position and rate and the changed acceleration at `t` has
    /// a past, too, which differs from this one by `½ δq̈ (t′ − t)²` if only accelerations jump: with it the method goes on. The error of the
    /// next step is large if more than that has changed.
    pub(super) fn go_on_after(&mut self, t: f64, change: &mut dyn FnMut()) -> Result<(), Stopped> {
        if (t - self.history.t).abs() > SAME * self.history.h {
            self.history.go_back(t);
            self.control.steps_since_change = 0;
        }
        self.is_steered = true;
        self.accept();
        let slope_at = |bdf: &mut Self| {
            let mut slope = vec![0.0; bdf.motion.len()];
            let found = bdf.equations.slope_in_full(t, &bdf.motion, &mut slope);
            found.map(|()| slope).map_err(|NotFinite| bdf.stuck())
        };
        let before = slope_at(self)?;
        let mut past = self.past_references();
        change();
        self.equations.forget();
        self.correction.forget();
        self.switches.start();
        let after = slope_at(self)?;
        let Equations { crane, n, .. } = self.equations;
        let jumps: Vec<f64> = after.iter().zip(&before).map(|(after, before)| after - before).collect();
        for (m, state) in past.iter_mut().enumerate() {
            let back = -self.history.h * m as f64;
            self.equations.references.add(crane, t + back, -1.0, n, state);
            add(state, back, &jumps);
            add(&mut state[..n], 0.5 * back * back, &jumps[n..2 * n]);
        }
        self.history.add_to_states(past);
        Ok(())
    }

    /// The references at the last k + 3 states, the most recent first.
    fn past_references(&mut self) -> Vec<Vec<f64>> {
        let History { t, h, order, .. } = self.history;
        let Equations { crane, n, .. } = self.equations;
        let mut past = vec![vec![0.0; self.motion.len()]; order + 3];
        for (m, state) in past.iter_mut().enumerate() {
            self.equations.references.add(crane, t - h * m as f64, 1.0, n, state);
        }
        past
    }
}
