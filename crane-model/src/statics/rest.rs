//! The pose at rest with the drives at given positions: the one search of `statics`, load charts, critical loads and sensitivities.

use super::{Equilibrium, Settings, guess::guess_with, solve::solve_holding_dyn, tipped::with_tipped_status};
use crate::dyn_crane::DynCrane;

/// Newton's method alone: where it fails from a pose, there is no pose at rest nearby.
const NEWTON: Settings = Settings { tolerance: 1e-10, iterations: 30, load_steps: 0 };
/// Longest stride of the drives between two poses at rest, m or rad.
const STRIDE: f64 = 0.2;
/// Shortest stride, as a fraction of the longest.
const SHORTEST: f64 = 1.0 / 32.0;

/// A crane with its drives at given positions, at t = 0, that is asked where it rests.
///
/// A crane rests where statics finds a stable pose with its base upright. A pose nearby makes the search faster and is never a condition: without one, or where
/// it does not help, the search begins at the guess, at which coordinates that follow others, and loops, move with the drives; and at
/// last the drives move from where their motions begin, in strides between which the crane rests.
#[derive(Clone, Copy)]
pub struct RestSearch<'a> {
    /// The crane.
    pub crane: &'a dyn DynCrane,
    /// Positions of the drives, one per drive, m and rad.
    pub positions: &'a [f64],
}

impl RestSearch<'_> {
    /// The pose at rest near the pose `q`, by Newton's method alone: as a crane moves if a little changes slowly.
    pub fn find_near(&self, q: &[f64]) -> Option<Equilibrium> {
        Some(self.search(q, &NEWTON)).filter(Equilibrium::is_stable)
    }

    /// The pose at rest, or how the search from the guess ended. `near`: positions of the drives, and the pose in which the crane rests there.
    pub fn find(&self, near: Option<(&[f64], &[f64])>) -> Equilibrium {
        if let Some(found) = near.and_then(|(from, q)| self.walk(from, q)) {
            return found;
        }
        let found = self.find_from_guess();
        if found.is_stable() {
            return found;
        }
        self.walk_from_begin().unwrap_or(found)
    }

    /// The pose at rest found from the guess, or how the search ended: as for a spec whose drives hold these positions.
    pub fn find_from_guess(&self) -> Equilibrium {
        self.search(&guess_with(self.crane, self.positions.iter().copied()), &Settings::default())
    }

    /// The end of a walk from the beginning of the drives' motions.
    fn walk_from_begin(&self) -> Option<Equilibrium> {
        let begin: Vec<f64> = self.crane.drive_motions_at(0.0).iter().map(|[position, _]| *position).collect();
        if begin == self.positions {
            return None;
        }
        let found = RestSearch { positions: &begin, ..*self }.find_from_guess();
        if found.is_stable() { self.walk(&begin, &found.q) } else { None }
    }

    /// The end of a walk from the pose `q`, in which the drives are at `from`; `None` if the crane does not rest on the way, however short the
    /// strides.
    fn walk(&self, from: &[f64], q: &[f64]) -> Option<Equilibrium> {
        let drives = &self.crane.description().drives;
        let furthest = from.iter().zip(self.positions).map(|(from, to)| (to - from).abs()).fold(0.0, f64::max);
        let longest = (STRIDE / furthest).min(1.0);
        let (mut part, mut stride, mut q) = (0.0, longest, q.to_vec());
        loop {
            let next: f64 = if part + stride > 1.0 - 1e-9 { 1.0 } else { part + stride };
            let at = |part: f64| from.iter().zip(self.positions).map(move |(from, to)| from + part * (to - from));
            let mut start = q.clone();
            for (drive, (after, before)) in drives.iter().zip(at(next).zip(at(part))) {
                start[drive.coordinate] += after - before;
            }
            let positions: Vec<f64> = if next < 1.0 { at(next).collect() } else { self.positions.to_vec() };
            match (RestSearch { positions: &positions, ..*self }).find_near(&start) {
                Some(found) if next >= 1.0 => return Some(found),
                Some(found) => (part, q, stride) = (next, found.q, (2.0 * stride).min(longest)),
                None if furthest == 0.0 || stride <= SHORTEST * longest => return None,
                None => stride *= 0.5,
            }
        }
    }

    fn search(&self, q: &[f64], settings: &Settings) -> Equilibrium {
        with_tipped_status(self.crane, 0.0, q, solve_holding_dyn(self.crane, self.positions, q, settings))
    }
}
