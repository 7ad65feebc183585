//! The pose at rest with the drives at given positions, for load charts, critical loads and sensitivities: where statics finds it.

use super::{Equilibrium, Problem, Settings, guess::guess_with};
use crate::{DriveInfo, dyn_crane::DynCrane};

/// Newton's method alone: where it fails from a pose, the crane does not rest nearby. What is near takes three to five iterations.
const NEWTON: Settings = Settings { tolerance: 1e-10, iterations: 25, load_steps: 0 };
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

    /// [`Problem::stiffness_at`] a pose.
    pub(crate) fn stiffness_at(&self, q: &[f64]) -> Option<f64> {
        Problem::new(self.crane).holding(self.positions).stiffness_at(q)
    }

    /// The pose at rest, or how the search from the guess ended. `near`: positions of the drives, and the pose in which the crane rests there.
    pub fn find(&self, near: Option<(&[f64], &[f64])>) -> Equilibrium {
        if let Some(equilibrium) = near.and_then(|(from, q)| self.walk(from, q)) {
            return equilibrium;
        }
        let equilibrium = self.find_from_guess();
        if equilibrium.is_stable() {
            return equilibrium;
        }
        self.walk_from_begin().unwrap_or(equilibrium)
    }

    /// The pose at rest found from the guess, or how the search ended: as for a spec whose drives hold these positions.
    pub fn find_from_guess(&self) -> Equilibrium {
        self.search(&guess_with(self.crane, self.positions.iter().copied()), &Settings::default())
    }

    /// The end of a walk from the beginning of the drives' motions.
    fn walk_from_begin(&self) -> Option<Equilibrium> {
        let begin = self.crane.drive_targets_at(0.0);
        if begin == self.positions {
            return None;
        }
        let equilibrium = RestSearch { positions: &begin, ..*self }.find_from_guess();
        if equilibrium.is_stable() { self.walk(&begin, &equilibrium.q) } else { None }
    }

    /// The end of a walk from the pose `q`, in which the drives are at `from`; `None` if the crane does not rest on the way, however short the
    /// strides.
    fn walk(&self, from: &[f64], q: &[f64]) -> Option<Equilibrium> {
        let furthest = from.iter().zip(self.positions).map(|(from, to)| (to - from).abs()).fold(0.0, f64::max);
        let longest = (STRIDE / furthest).min(1.0);
        // Where no drive moves there is nothing to shorten.
        let shortest = if furthest > 0.0 { SHORTEST * longest } else { longest };
        let at = |part: f64| from.iter().zip(self.positions).map(move |(from, to)| from + part * (to - from));
        let mut found = None;
        let drives = &self.crane.description().drives;
        let mut stride = |q: &Vec<f64>, [before, after]: [f64; 2]| {
            let mut start = q.clone();
            for (drive, (after, before)) in drives.iter().zip(at(after).zip(at(before))) {
                start[drive.coordinate] += after - before;
            }
            let positions: Vec<f64> = if after < 1.0 { at(after).collect() } else { self.positions.to_vec() };
            let rest = RestSearch { positions: &positions, ..*self }.find_near(&start)?;
            // A linkage has a second branch beyond its dead centre, on which its cylinder holds the joint elsewhere.
            let leaves = |drive: &DriveInfo| (rest.q[drive.coordinate] - start[drive.coordinate]).abs() > STRIDE;
            if drives.iter().any(leaves) {
                return None;
            }
            Some(found.insert(rest).q.clone())
        };
        advance(q.to_vec(), [shortest, longest], &mut stride)?;
        found
    }

    fn search(&self, q: &[f64], settings: &Settings) -> Equilibrium {
        Problem::new(self.crane).holding(self.positions).from(q).settings(settings).solve()
    }
}

/// Follows states from part 0 to part 1 of a way, in steps from the longest down to the shortest: one that fails is halved, and after two that succeed
/// the next may be twice as long. `step`: the state at the second part, from that at the first; `None` for the result if the shortest step fails.
pub(crate) fn advance<S>(
    begin: S,
    [shortest, longest]: [f64; 2],
    step: &mut dyn FnMut(&S, [f64; 2]) -> Option<S>,
) -> Option<S> {
    /// What rounding leaves of a way.
    const ROUNDING: f64 = 1e-9;
    let (mut part, mut length, mut state) = (0.0, longest, begin);
    let mut succeeded = 0;
    while part < 1.0 {
        let next = if part + length > 1.0 - ROUNDING { 1.0 } else { part + length };
        match step(&state, [part, next]) {
            Some(reached) => {
                (part, state, succeeded) = (next, reached, succeeded + 1);
                if succeeded >= 2 {
                    (length, succeeded) = ((2.0 * length).min(longest), 0);
                }
            }
            None if length <= shortest => return None,
            None => (length, succeeded) = (0.5 * length, 0),
        }
    }
    Some(state)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps longer than 0.1 fail in the second half.
    #[test]
    fn steps_that_fail_are_halved_and_grow_again() {
        let mut parts = Vec::new();
        let mut step = |(): &(), [from, to]: [f64; 2]| {
            let is_possible = to <= 0.5 || to - from <= 0.1;
            is_possible.then(|| parts.push(to))
        };
        assert_eq!(advance((), [0.01, 0.25], &mut step), Some(()));
        assert_eq!(parts[..3], [0.25, 0.5, 0.5625]);
        assert_eq!(parts.last(), Some(&1.0));
        assert_eq!(advance((), [0.2, 0.25], &mut |(), [_, to]| (to <= 0.5).then_some(())), None);
    }
}
