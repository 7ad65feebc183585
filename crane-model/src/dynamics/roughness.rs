//! Growth from step to step, recognised long before a run leaves all bounds.

use nalgebra::{SMatrix, SVector};

/// Rates below this, m/s and rad/s, are rounding about a rest.
const REST: f64 = 1e-6;
/// Growth of roughness, as energy, while it outweighs the motion: a decaying mode loses energy from step to step, and one
/// that is merely not resolved keeps it.
const GROWTH: f64 = 1e2;

/// Compares the rates that a step found with those that the acceleration at its beginning foretold,
/// `ε = v(t) + h q̈(t) − v(t+h)`.
///
/// A resolved motion has `ε ≈ h² v̈/2`, small against v. At the limit of stability a step multiplies the limiting mode by
/// a factor of size 1 though `1 + hλ` is well beyond: ε outweighs v, and grows beyond the limit. Both are measured as
/// kinetic energy with the diagonal of the mass matrix, which makes m and rad comparable.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roughness<const N: usize> {
    weights: SVector<f64, N>,
    /// Roughness when it came to outweigh the motion, and the coordinate that is roughest now.
    outweighs: Option<(f64, usize)>,
}

impl<const N: usize> Roughness<N> {
    /// With the mass matrix at the start.
    pub(super) fn new(mass: &SMatrix<f64, N, N>) -> Self {
        Self { weights: mass.diagonal(), outweighs: None }
    }

    /// The roughest coordinate, where roughness outweighs the motion.
    pub(super) fn roughest(&self) -> Option<usize> {
        self.outweighs.map(|(_, roughest)| roughest)
    }

    /// After a step that was foretold to end with rates `foretold`, and ended with `v`: whether the run grows from step to
    /// step.
    pub(super) fn grows(&mut self, foretold: &SVector<f64, N>, v: &SVector<f64, N>) -> bool {
        let energy = |rates: &SVector<f64, N>| rates.component_mul(rates).dot(&self.weights);
        let difference = foretold - v;
        let rough = energy(&difference);
        if rough <= energy(v).max(REST * REST * self.weights.sum()) {
            self.outweighs = None;
            return false;
        }
        let since = self.outweighs.map_or(rough, |(since, _)| since);
        let share = |i: usize| difference[i] * difference[i] * self.weights[i];
        self.outweighs = Some((since, (0..N).max_by(|&i, &j| share(i).total_cmp(&share(j))).unwrap_or(0)));
        rough > GROWTH * since
    }
}
