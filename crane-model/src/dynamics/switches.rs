//! Where laws of forces change branch: a foot meets the ground, a rope becomes taut, a drive reaches its limit, a valve opens.
//!
//! There the force is continuous but its slope jumps, so a step across such a change is of low order, however smooth the motion is before
//! and after, and its error estimate says little: a drive at its limit moves a joint along a parabola, over which a long step is exact, also where the
//! drive has long left the limit. Adaptive methods therefore end a step where a contact changes or a drive reaches or leaves its limit, and a
//! step that failed where any law does.

use super::{contacts::Contacts, equations::Equations};
use crate::memory::{Visit, visit_flag, visit_flags};
use crate::{StateAt, dyn_crane::Functions, force_states::ForceStates};

/// Which laws are watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Watched {
    /// One-sided supports, end stops and ropes, and limits of drives.
    Contacts,
    /// Also forces with states of their own: valves, cylinders, bristles.
    All,
}

/// The laws of a crane that have branches.
pub(super) struct Switches {
    contacts: Contacts,
    limits: DriveLimits,
    states: ForceStates,
    motion: Vec<f64>,
    /// The branch that each law is on: at the beginning of a step, and at a later time.
    branches: [Vec<bool>; 2],
    /// Whether changes close to the ends of steps are found, too.
    pub is_exact: bool,
    /// Whether the last step ended at a change: numbers that differ by rounding may then change at once again, and the next step passes them.
    after_change: bool,
    /// Whether the last change that was found is that of a drive which reaches or leaves its limit.
    of_limit: bool,
    /// The time at which the first list of branches is known to hold for contacts, s: the end of one step is the beginning of the next.
    known_at: f64,
}

impl Switches {
    /// Maximum number of times that a step is repeated to end where a law changes: if laws change faster than steps can follow, the error
    /// estimate alone decides.
    pub const REPEATS: usize = 3;
    /// Number of bisections, which locate a change to a millionth of the step.
    const BISECTIONS: usize = 20;
    /// How far beyond a change a step ends for derivatives, relative to its length: as far as a change is located.
    const BEYOND: f64 = 1e-6;
    /// A change closer than this to either end of a step, relative to its length, does not matter to a motion.
    const END_MARGINS: [f64; 2] = [1e-3; 2];
    /// To derivatives it matters on which branch the first stage of a step is.
    const EXACT_MARGINS: [f64; 2] = [1e-9, 1e-4];

    /// The laws of a crane, with storage for motions of `len` numbers.
    pub fn new(crane: &dyn Functions, len: usize) -> Self {
        let (contacts, limits) = (Contacts::new(crane), DriveLimits::new(crane));
        let states = ForceStates::new(crane.description());
        // No step allocates: a cylinder has three states and up to eleven branches, a bristle one of each, the pump two branches.
        let branches = || Vec::with_capacity(contacts.len() + 2 * limits.drives.len() + 4 * states.len() + 2);
        Self {
            branches: [branches(), branches()],
            contacts,
            limits,
            states,
            motion: vec![0.0; len],
            is_exact: false,
            after_change: false,
            of_limit: false,
            known_at: f64::NAN,
        }
    }

    /// A step is completed, which was to end at a change: it did if a law is on another branch now.
    pub fn proceed(&mut self, at_change: bool) {
        self.after_change = at_change && (!self.is_exact || self.branches[0] != self.branches[1]);
    }

    /// Visits what further steps depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        self.states.forget();
        visit_flags(&mut self.branches[0], visit);
        visit_flag(&mut self.of_limit, visit);
        visit(&mut self.known_at);
    }

    /// Forgets the last step.
    pub fn start(&mut self) {
        self.states.forget();
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
        if self.contacts.is_empty()
            && self.limits.drives.is_empty()
            && (watched == Watched::Contacts || self.states.is_empty())
        {
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
        let after = first_change([begin, end], Self::BISECTIONS, &mut |t| branches(t, 1));
        // The last list is that of some time in between.
        branches(after, 1);
        let contacts = self.contacts.len();
        self.of_limit = self.branches[0][..contacts] == self.branches[1][..contacts];
        let margins = if self.is_exact && !self.after_change { Self::EXACT_MARGINS } else { Self::END_MARGINS };
        let near = margins.map(|margin| margin * (end - begin));
        // The motion of the shorter step differs a little. Derivatives need its end on the other branch.
        let beyond = if self.is_exact { Self::BEYOND * (end - begin) } else { 0.0 };
        (after > begin + near[0] && after < end - near[1]).then_some(after + beyond)
    }

    /// Whether the change that was found last is that of a drive which reaches or leaves its limit: what follows is another motion, over
    /// which the length of the steps before says nothing.
    pub fn is_of_limit(&self) -> bool {
        self.of_limit
    }

    /// Writes the branches at a time and at `motion` into the first or the second list.
    fn evaluate(&mut self, equations: &mut Equations<'_>, watched: Watched, t: f64, list: usize) {
        let crane = equations.crane;
        let state = equations.state(t, &self.motion);
        let branches = &mut self.branches[list];
        branches.clear();
        self.contacts.indicators(crane, &state, |indicator| branches.push(indicator > 0.0));
        self.limits.branches(crane, &state, branches);
        if watched == Watched::All {
            self.states.branches(crane, &state.with_states(0..self.states.len()), branches);
        }
    }
}

/// By bisection, a time in an interval, s, from which on something has changed: it has not at the beginning, and has at the end.
pub(super) fn first_change(
    [mut before, mut after]: [f64; 2],
    bisections: usize,
    has_changed: &mut dyn FnMut(f64) -> bool,
) -> f64 {
    for _ in 0..bisections {
        let middle = 0.5 * (before + after);
        if middle <= before || middle >= after {
            break;
        }
        if has_changed(middle) {
            after = middle;
        } else {
            before = middle;
        }
    }
    after
}

/// The limits of the drives' efforts.
struct DriveLimits {
    /// Coordinate and maximum effort of each drive with a limit, N m or N.
    drives: Vec<(usize, f64)>,
    forces: Vec<f64>,
}

impl DriveLimits {
    /// Fraction of its limit at which a drive is in the middle of the rounded corner of its law.
    const CORNER: f64 = 0.98;

    fn new(crane: &dyn Functions) -> Self {
        let drives = &crane.description().drives;
        let (mut limits, rest) = (vec![[0.0; 2]; drives.len()], vec![0.0; crane.size()]);
        crane.drive_limits(0.0, &rest, &rest, &mut limits);
        let limited = drives.iter().zip(limits).filter(|(_, [limit, _])| *limit > 0.0);
        Self { drives: limited.map(|(drive, [limit, _])| (drive.coordinate, limit)).collect(), forces: rest }
    }

    /// Appends for each drive whether it pushes, and pulls, as much as it can.
    fn branches(&mut self, crane: &dyn Functions, &StateAt { t, q, v, .. }: &StateAt<'_>, out: &mut Vec<bool>) {
        if self.drives.is_empty() {
            return;
        }
        crane.drive_forces(t, q, v, &mut self.forces);
        for (coordinate, limit) in &self.drives {
            let force = self.forces[*coordinate] / limit;
            out.extend([force > Self::CORNER, force < -Self::CORNER]);
        }
    }
}
