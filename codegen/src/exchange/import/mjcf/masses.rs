//! What `<compiler>` changes of masses, in the order in which `MuJoCo` does.

use crate::exchange::import::robot::Robot;
use crate::exchange::mass::Lump;

/// Settings of `<compiler>` for masses of bodies.
#[derive(Default)]
pub(super) struct MassSettings {
    /// `boundmass`, kg: no body has less.
    pub(super) least_mass: f64,
    /// `boundinertia`, kg m²: no principal moment is less.
    pub(super) least_inertia: f64,
    /// `balanceinertia`: principal moments of which one exceeds the sum of the others become their mean.
    pub(super) balances: bool,
    /// `settotalmass`, kg: masses and moments of all bodies are scaled to this sum.
    pub(super) total: Option<f64>,
}

impl MassSettings {
    /// The mass of a body.
    pub(super) fn of_body(&self, lump: Option<Lump>) -> Option<Lump> {
        let bounded = self.least_mass > 0.0 || self.least_inertia > 0.0;
        let mut lump = lump.or_else(|| bounded.then(Lump::nothing))?;
        lump.mass = lump.mass.max(self.least_mass);
        let least = self.least_inertia;
        let balances = self.balances;
        lump.change_moments(|moments| {
            let mut changed = moments.map(|moment| moment.max(least));
            let sum: f64 = changed.iter().sum();
            if balances && changed.iter().any(|moment| 2.0 * moment > sum) {
                changed = [sum / 3.0; 3];
            }
            changed
        });
        Some(lump)
    }

    /// Scales the masses of all bodies.
    pub(super) fn scale(&self, robot: &mut Robot) {
        let Some(total) = self.total else { return };
        let sum: f64 = robot.links.iter().filter_map(|link| Some(link.lump.as_ref()?.mass)).sum();
        for lump in robot.links.iter_mut().filter_map(|link| link.lump.as_mut()).filter(|_| sum > 0.0) {
            lump.mass *= total / sum;
            lump.tensor = lump.tensor.map(|entry| entry * total / sum);
        }
    }
}
