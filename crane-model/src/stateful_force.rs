//! A force with states of its own: at which state it is evaluated, what it returns, and on which coordinates it acts.

/// A state of a crane, with the states of its forces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StateAt<'a> {
    pub t: f64,
    pub q: &'a [f64],
    pub v: &'a [f64],
    pub x: &'a [f64],
}

/// Maximum number of states of a force.
pub(crate) const STATES: usize = 3;

/// A force with states of its own, evaluated at a state of the crane, and its derivatives. ℓ is the length of a cylinder, or the coordinate
/// of a joint with bristles.
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
    /// ℓ̇, m/s or rad/s.
    pub speed: f64,
    /// Flow from the pump, m³/s.
    pub from_pump: f64,
}

/// `J = ∂ℓ/∂q` of a force: its entries from the first to the last that is not zero.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub first: usize,
    pub entries: Vec<f64>,
}

impl Row {
    /// The entry of a coordinate.
    pub fn entry(&self, coordinate: usize) -> f64 {
        coordinate.checked_sub(self.first).and_then(|place| self.entries.get(place)).copied().unwrap_or(0.0)
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
