//! Where laws of forces change branch: a foot meets the ground, a rope becomes taut, a valve opens.
//!
//! There the force is continuous but its slope jumps, so a step across such a change is of low order, however smooth the motion is before
//! and after, and its error estimate says little. Adaptive methods therefore end a step where a contact changes, and a step that failed
//! where any law does.

use super::{contacts::Contacts, equations::Equations};
use crate::{dyn_crane::DynModel, force_states::ForceStates, stateful_force::StateAt};

/// Which laws are watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Watched {
    /// One-sided supports, end stops and ropes.
    Contacts,
    /// Also forces with states of their own: valves, cylinders, bristles.
    All,
}

/// The laws of a crane that have branches.
pub(super) struct Switches {
    contacts: Contacts,
    states: ForceStates,
    motion: Vec<f64>,
    /// The branch that each law is on: at the beginning of a step, and at a later time.
    branches: [Vec<bool>; 2],
    /// The time at which the first list of branches is known to hold for contacts, s: the end of one step is the beginning of the next.
    known_at: f64,
}

impl Switches {
    /// Maximum number of times that a step is repeated to end where a law changes: if laws change faster than steps can follow, the error
    /// estimate alone decides.
    pub const REPEATS: usize = 3;
    /// Number of bisections, which locate a change to a millionth of the step.
    const BISECTIONS: usize = 20;
    /// A change closer than this to either end of a step, relative to its length, does not matter.
    const END_MARGIN: f64 = 1e-3;

    /// The laws of a crane, with storage for motions of `len` numbers.
    pub fn new(crane: &dyn DynModel, len: usize) -> Self {
        let contacts = Contacts::new(crane);
        let states = ForceStates::new(crane.description());
        // No step allocates: a cylinder has three states and up to eleven branches, a bristle one of each, the pump two branches.
        let branches = || Vec::with_capacity(contacts.len() + 4 * states.len() + 2);
        Self { branches: [branches(), branches()], contacts, states, motion: vec![0.0; len], known_at: f64::NAN }
    }

    /// Forgets the last step.
    pub fn start(&mut self) {
        self.known_at = f64::NAN;
    }

    /// A time in a step, s, at which a law changes its branch: found by bisection, if at the end of the step a law is on another branch
    /// than at its beginning; `None` also if the change is close to either end. `at` gives the motion during the step, relative to the
    /// references.
    pub fn find_change(
        &mut self,
        equations: &mut Equations<'_>,
        watched: Watched,
        [begin, end]: [f64; 2],
        at: &dyn Fn(f64, &mut [f64]),
    ) -> Option<f64> {
        if self.contacts.is_empty() && (watched == Watched::Contacts || self.states.is_empty()) {
            return None;
        }
        let known_at = std::mem::replace(&mut self.known_at, f64::NAN);
        let mut branches = |t: f64, list: usize| {
            at(t, &mut self.motion);
            self.evaluate(equations, watched, t, list);
            self.branches[0] != self.branches[1]
        };
        if watched == Watched::All || begin != known_at {
            branches(begin, 0);
        }
        if !branches(end, 1) {
            if watched == Watched::Contacts {
                self.known_at = end;
            }
            return None;
        }
        let (mut before, mut after) = (begin, end);
        for _ in 0..Self::BISECTIONS {
            let middle = 0.5 * (before + after);
            if branches(middle, 1) {
                after = middle;
            } else {
                before = middle;
            }
        }
        let near = Self::END_MARGIN * (end - begin);
        (after > begin + near && after < end - near).then_some(after)
    }

    /// Writes the branches at a time and at `motion` into the first or the second list.
    fn evaluate(&mut self, equations: &mut Equations<'_>, watched: Watched, t: f64, list: usize) {
        let crane = equations.crane;
        let (q, v) = equations.state(t, &self.motion);
        let branches = &mut self.branches[list];
        branches.clear();
        self.contacts.indicators(crane, t, (q, v), |indicator| branches.push(indicator > 0.0));
        if watched == Watched::All {
            let x = &self.motion[2 * q.len()..][..self.states.len()];
            self.states.branches(crane, &StateAt { t, q, v, x }, branches);
        }
    }
}
