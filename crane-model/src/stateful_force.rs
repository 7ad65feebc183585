//! Forces with states of their own: what they have in common, at which state they are evaluated, what they return, and on which
//! coordinates they act.

use std::{any::Any, fmt::Debug};

use nalgebra::DMatrixViewMut;

use crate::{StateAt, dyn_crane::Functions};

/// Forces of one kind that have states. Indices of states are those among the states of this kind, except in [`StateAt`] and
/// [`StatefulForce`], whose users see all states.
pub(crate) trait StatefulForces: Any + Debug + Send + Sync {
    /// Their states, in order.
    fn states(&self) -> Vec<ForceState>;

    /// Their rows, with the coordinates on which they act.
    fn rows(&self) -> Vec<ForceRow>;

    /// Whether each of them has one state, which depends on no other, and acts on one coordinate: an implicit step eliminates it there.
    fn is_local(&self) -> bool;

    /// Whether they supply power, as a pump does; all others dissipate it.
    fn supplies_power(&self) -> bool;

    /// The states that hold a pose at rest at a given time.
    fn holding(&mut self, crane: &dyn Functions, t: f64, q: &[f64]) -> Vec<f64>;

    /// As [`holding`](Self::holding), with valves that have opened slightly, in either direction.
    fn slightly_open(&mut self, crane: &dyn Functions, t: f64, q: &[f64]) -> [Vec<f64>; 2] {
        let states = self.holding(crane, t, q);
        [states.clone(), states]
    }

    /// Evaluates all forces, their rows and the rates of their states; `by_states`, if given, receives the derivatives of the rates with
    /// respect to the states and contains zeros before. In `moment`, `x` has only their states.
    fn evaluate(
        &mut self,
        crane: &dyn Functions,
        moment: &StateAt<'_>,
        out: Evaluated<'_>,
        by_states: Option<DMatrixViewMut<'_, f64>>,
    );

    /// Energy that the forces, as last evaluated, have stored beyond what the crane's functions contain, J, and its rate, W, from their states and
    /// the rates of these.
    fn energy_and_rate(&self, _x: &[f64], _rates: &[f64]) -> [f64; 2] {
        [0.0; 2]
    }

    /// Replaces slopes where a law sticks by the steeper ones on either side of rest; `c` is the implicit part of a step, s.
    fn steepen(&self, _moment: &StateAt<'_>, _c: f64, _forces: &mut [StatefulForce]) {}

    /// Takes out leakage, by which a state at rest drifts.
    fn seal(&mut self) {}

    /// Motions and commands change: what is kept of the last time does not hold any more.
    fn forget(&mut self) {}

    /// Appends which branch of its law each force is on.
    fn branches(&mut self, crane: &dyn Functions, moment: &StateAt<'_>, out: &mut Vec<bool>);
}

/// A state of a force.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ForceState {
    /// Name of its column of results.
    pub name: String,
    /// The size by which its errors are measured.
    pub scale: f64,
    /// The range that it cannot leave, and what that means.
    pub range: Option<([f64; 2], &'static str)>,
}

/// What an evaluation of forces returns.
pub(crate) struct Evaluated<'a> {
    /// The rates of their states.
    pub rates: &'a mut [f64],
    /// The forces.
    pub forces: &'a mut [StatefulForce],
    /// Their rows.
    pub rows: &'a mut [ForceRow],
}

/// Maximum number of states of a force.
pub(crate) const STATES: usize = 3;

/// A force with states of its own, evaluated at a state of the crane, and its derivatives. ℓ is the length of a cylinder, the coordinate
/// of a joint with bristles, or the elongation of a foot along x or y.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StatefulForce {
    /// The first of its states, and their number.
    pub first: usize,
    pub count: usize,
    /// F, N or N m, and its derivatives with respect to ℓ, ℓ̇ and its states.
    pub force: f64,
    pub by_length: f64,
    pub by_speed: f64,
    pub by_states: [f64; STATES],
    /// Derivatives of the rates of its states with respect to ℓ and ℓ̇.
    pub rates_by_length: [f64; STATES],
    pub rates_by_speed: [f64; STATES],
    /// The cylinder that exerts it, by its index among all, if one does.
    pub cylinder: Option<usize>,
    /// Whether a foot exerts it: what else it depends on, gradients take from the feet themselves.
    pub is_of_foot: bool,
    /// Derivatives of the rate of its last state, a spool, with respect to the wanted length of the cylinder, the rate of this length, and the
    /// opening that the spec gives over time.
    pub by_command: [f64; 3],
    /// ℓ̇, m/s or rad/s.
    pub speed: f64,
    /// Flow from the pump, m³/s.
    pub from_pump: f64,
}

/// `J = ∂ℓ/∂q` of a force: its entries from the first to the last that is not zero.
#[derive(Clone, Debug)]
pub(crate) struct ForceRow {
    pub first: usize,
    pub entries: Vec<f64>,
}

impl ForceRow {
    /// The entry of a coordinate.
    pub fn entry(&self, coordinate: usize) -> f64 {
        coordinate.checked_sub(self.first).and_then(|index| self.entries.get(index)).copied().unwrap_or(0.0)
    }

    /// J x
    pub fn along(&self, x: &[f64]) -> f64 {
        self.entries.iter().zip(&x[self.first..]).map(|(entry, x)| entry * x).sum()
    }

    /// Adds `Jᵀ F`.
    pub fn add_to(&self, generalized: &mut [f64], force: f64) {
        for (sum, entry) in generalized[self.first..].iter_mut().zip(&self.entries) {
            *sum += entry * force;
        }
    }
}
