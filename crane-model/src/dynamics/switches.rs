//! Where laws of forces change branch: a foot meets the ground, a rope becomes taut, a valve opens.
//!
//! There the force is continuous but its slope jumps, so a step across such a change is of low order, however smooth the motion is before
//! and after, and its error estimate says little. Adaptive methods therefore end a step where a contact changes, and a step that failed
//! where any law does.

use super::equations::Equations;
use crate::{
    Description, Tension,
    dyn_crane::DynModel,
    force_states::{ForceStates, StateAt},
};

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
    /// One-sided supports, end stops and ropes, by their indices.
    feet: Vec<usize>,
    stops: Vec<usize>,
    ropes: Vec<usize>,
    states: ForceStates,
    gaps: Vec<[f64; 2]>,
    forces: Vec<f64>,
    tensions: Vec<Tension>,
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
        let Description { supports, stops, connectors, .. } = crane.description();
        let feet: Vec<usize> = (0..supports.len()).filter(|foot| supports[*foot].one_sided).collect();
        let ropes: Vec<usize> = (0..connectors.len()).filter(|rope| connectors[*rope].is_rope).collect();
        let states = ForceStates::new(crane.description());
        // No step allocates: a cylinder has three states and up to eleven branches, a bristle one of each, the pump two branches.
        let branches = || Vec::with_capacity(feet.len() + stops.len() + ropes.len() + 4 * states.len() + 2);
        Self {
            branches: [branches(), branches()],
            feet,
            stops: stops.to_vec(),
            ropes,
            states,
            gaps: vec![[0.0; 2]; supports.len()],
            forces: vec![0.0; crane.size()],
            tensions: vec![Tension::ZERO; connectors.len()],
            motion: vec![0.0; len],
            known_at: f64::NAN,
        }
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
        let contacts = !(self.feet.is_empty() && self.stops.is_empty() && self.ropes.is_empty());
        if !contacts && (watched == Watched::Contacts || self.states.is_empty()) {
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
        if !self.feet.is_empty() {
            crane.support_gaps(q, v, &mut self.gaps);
            branches.extend(self.feet.iter().map(|foot| self.gaps[*foot][0] > 0.0));
        }
        if !self.stops.is_empty() {
            crane.stop_forces(q, v, &mut self.forces);
            branches.extend(self.stops.iter().map(|stop| self.forces[*stop] != 0.0));
        }
        if !self.ropes.is_empty() {
            crane.connector_tensions(t, q, v, &mut self.tensions);
            branches.extend(self.ropes.iter().map(|rope| self.tensions[*rope].force > 0.0));
        }
        if watched == Watched::All {
            let x = &self.motion[2 * q.len()..][..self.states.len()];
            self.states.branches(crane, &StateAt { t, q, v, x }, branches);
        }
    }
}
