//! Detection of growth from step to step, long before a run exceeds its bounds.

use crate::memory::{Visit, visit_count, visit_numbers, visit_optional};

/// Rates below this, m/s and rad/s, are rounding near rest.
const REST: f64 = 1e-6;
/// Growth of the roughness, as an energy, that counts as unstable while it dominates the motion: a decaying mode loses energy
/// from step to step, and one that is merely not resolved keeps it.
const GROWTH: f64 = 1e2;

/// Compares the rates after a step with those predicted from the acceleration at its start,
/// `ε = v(t) + h q̈(t) − v(t+h)`.
///
/// A resolved motion has `ε ≈ h² v̈/2`, small compared with v. At the stability limit, a step multiplies the limiting
/// mode by a factor of magnitude 1 although `1 + hλ` is much larger: ε exceeds v, and grows beyond the limit. Both are measured as
/// kinetic energy with the diagonal of the mass matrix, which makes m and rad comparable.
#[derive(Clone, Debug)]
pub(super) struct Roughness {
    weights: Vec<f64>,
    /// Roughness when it started to dominate the motion, and the currently roughest coordinate.
    outweighs: Option<(f64, usize)>,
}

impl Roughness {
    /// Creates the detector, with the diagonal of the mass matrix at the start as weights.
    pub(super) fn new(weights: Vec<f64>) -> Self {
        Self { weights, outweighs: None }
    }

    /// Visits what further comparisons depend on.
    pub(super) fn visit(&mut self, visit: Visit<'_>) {
        visit_numbers(&mut self.weights, visit);
        let (mut since, mut roughest) = self.outweighs.map_or((None, 0), |(since, roughest)| (Some(since), roughest));
        visit_optional(&mut since, visit);
        visit_count(&mut roughest, visit);
        self.outweighs = since.map(|since| (since, roughest.min(self.weights.len().saturating_sub(1))));
    }

    /// The roughest coordinate, if roughness dominates the motion.
    pub(super) fn roughest(&self) -> Option<usize> {
        self.outweighs.map(|(_, roughest)| roughest)
    }

    /// After a step of length `h` from the rates `before` with the accelerations `accelerations` to the rates `after`: whether
    /// the run grows from step to step.
    pub(super) fn grows(&mut self, h: f64, before: &[f64], accelerations: &[f64], after: &[f64]) -> bool {
        let difference = |i: usize| before[i] + accelerations[i] * h - after[i];
        let share = |i: usize| difference(i) * difference(i) * self.weights[i];
        let all = 0..self.weights.len();
        let rough: f64 = all.clone().map(share).sum();
        let energy: f64 = all.clone().map(|i| after[i] * after[i] * self.weights[i]).sum();
        if rough <= energy.max(REST * REST * self.weights.iter().sum::<f64>()) {
            self.outweighs = None;
            return false;
        }
        let since = self.outweighs.map_or(rough, |(since, _)| since);
        self.outweighs = Some((since, all.max_by(|&i, &j| share(i).total_cmp(&share(j))).unwrap_or(0)));
        rough > GROWTH * since
    }
}
