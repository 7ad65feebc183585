//! States of forces, in addition to the pose and rates of a motion: pressures and spools of cylinders with a valve, the places to which feet have
//! slid, bristles of joints that stick.
//!
//! A motion is `[q, v, x]`; x has the states kind by kind, those of local forces last.

use std::any::Any;

use nalgebra::DMatrix;

use crate::{
    Description, StateAt,
    bristles::Bristles,
    dyn_crane::Functions,
    feet::Feet,
    hydraulics::Hydraulics,
    loop_joints::{self, Loops},
    stateful_force::{Evaluated, ForceRow, ForceState, StatefulForce, StatefulForces},
};

/// The forces with states of a description, kind by kind: first those that span several coordinates or share states, then local ones.
fn kinds(description: &Description) -> [Box<dyn StatefulForces>; 3] {
    [Box::new(Hydraulics::new(description)), Box::new(Feet::new(description)), Box::new(Bristles::new(description))]
}

/// All forces of a crane that have states.
#[derive(Debug)]
pub struct ForceStates {
    /// Each kind, the end of its forces among all, and the end of its states.
    kinds: Vec<(Box<dyn StatefulForces>, [usize; 2])>,
    states: Vec<ForceState>,
    /// The forces as last evaluated, kind by kind.
    forces: Vec<StatefulForce>,
    /// Their rows.
    rows: Vec<ForceRow>,
    /// Their generalized forces, and the accelerations that these add.
    efforts: [Vec<f64>; 2],
    /// The coordinates of rigid drives, and the mass matrix if there are any.
    prescribed: Vec<usize>,
    mass: DMatrix<f64>,
    /// Rate of the energy that the forces have stored beyond what the crane's functions contain, as last evaluated, W.
    storing: f64,
}

impl ForceStates {
    /// From the description of a crane.
    pub fn new(description: &Description) -> Self {
        Self::of_kinds(description, kinds(description).into())
    }

    /// The same without those of feet, which stick in small motions, or are free if they slide.
    pub(crate) fn of_small_motions(description: &Description) -> Self {
        let [oil, _, bristles] = kinds(description);
        Self::of_kinds(description, vec![oil, bristles])
    }

    /// All, or those of small motions if there are only as many states.
    fn with_as_many_states(description: &Description, states: usize) -> Self {
        let all = Self::new(description);
        if states < all.len() { Self::of_small_motions(description) } else { all }
    }

    fn of_kinds(description: &Description, kinds: Vec<Box<dyn StatefulForces>>) -> Self {
        let n = description.coordinates.len();
        let prescribed = description.prescribed();
        let size = if prescribed.is_empty() { 0 } else { n };
        let (mut rows, mut states) = (Vec::new(), Vec::new());
        let mut with_ends = |kind: Box<dyn StatefulForces>| {
            rows.extend(kind.rows());
            states.extend(kind.states());
            (kind, [rows.len(), states.len()])
        };
        let kinds = kinds.into_iter().map(&mut with_ends).collect();
        Self {
            prescribed,
            mass: DMatrix::zeros(size, size),
            forces: vec![StatefulForce::default(); rows.len()],
            kinds,
            rows,
            states,
            efforts: [vec![0.0; n], vec![0.0; n]],
            storing: 0.0,
        }
    }

    /// Those of small motions, without leakage.
    pub(crate) fn sealed(description: &Description) -> Self {
        let mut states = Self::of_small_motions(description);
        states.kinds.iter_mut().for_each(|(kind, _)| kind.seal());
        states
    }

    /// Number of states.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.forces.is_empty()
    }

    /// Sizes by which errors of the states are measured.
    pub fn scales(&self) -> Vec<f64> {
        self.states.iter().map(|state| state.scale).collect()
    }

    /// The states that hold a pose at rest at a given time: shut valves, the unloaded side at tank pressure, and
    /// bristles that carry nothing.
    pub fn holding(&mut self, crane: &dyn Functions, t: f64, q: &[f64]) -> Vec<f64> {
        self.kinds.iter_mut().flat_map(|(kind, _)| kind.holding(crane, t, q)).collect()
    }

    /// The states of a start at a pose: those given, or, if there are none, those that hold it at rest.
    pub(crate) fn start(&mut self, crane: &dyn Functions, t: f64, q: &[f64], given: &[f64]) -> Vec<f64> {
        if given.is_empty() { self.holding(crane, t, q) } else { given.to_vec() }
    }

    /// As [`holding`](Self::holding), with valves that have opened slightly, in either direction.
    pub(crate) fn slightly_open(&mut self, crane: &dyn Functions, t: f64, q: &[f64]) -> [Vec<f64>; 2] {
        let mut both = [Vec::new(), Vec::new()];
        for (kind, _) in &mut self.kinds {
            both.iter_mut().zip(kind.slightly_open(crane, t, q)).for_each(|(all, own)| all.extend(own));
        }
        both
    }

    /// Motions and commands change: what is kept of the last time does not hold any more.
    pub(crate) fn forget(&mut self) {
        self.kinds.iter_mut().for_each(|(kind, _)| kind.forget());
    }

    /// Number of forces with states.
    pub(crate) fn count(&self) -> usize {
        self.forces.len()
    }

    /// Number of forces that span several coordinates or share states, and of their states; both come first.
    pub(crate) fn coupled(&self) -> [usize; 2] {
        self.kinds.iter().rev().find(|(kind, _)| !kind.is_local()).map_or([0; 2], |(_, ends)| *ends)
    }

    /// The feet as last evaluated, with the indices of the first of their forces and of the first of their states, if there are any.
    pub(crate) fn feet(&self) -> Option<(&Feet, [usize; 2])> {
        let begins = [[0; 2]].into_iter().chain(self.kinds.iter().map(|(_, ends)| *ends));
        let mut kinds = self.kinds.iter().map(|(kind, _)| kind.as_ref() as &dyn Any).zip(begins);
        let found = kinds.find_map(|(kind, begin)| Some((kind.downcast_ref::<Feet>()?, begin)));
        found.filter(|(feet, _)| !feet.is_empty())
    }

    /// The forces as last evaluated.
    pub(crate) fn forces(&self) -> &[StatefulForce] {
        &self.forces
    }

    /// The rows `∂ℓ/∂q` of the forces, as last evaluated.
    pub(crate) fn rows(&self) -> &[ForceRow] {
        &self.rows
    }

    /// Evaluates all forces and the rates of their states and, if requested, the derivatives of the rates with respect to the states.
    pub(crate) fn evaluate(
        &mut self,
        crane: &dyn Functions,
        moment: &StateAt<'_>,
        rates: &mut [f64],
        mut by_states: Option<&mut DMatrix<f64>>,
    ) {
        if let Some(matrix) = by_states.as_deref_mut() {
            matrix.fill(0.0);
        }
        let [mut first_force, mut first] = [0; 2];
        self.storing = 0.0;
        for (kind, [end_force, end]) in &mut self.kinds {
            let (forces, rows) = (&mut self.forces[first_force..*end_force], &mut self.rows[first_force..*end_force]);
            let block =
                by_states.as_deref_mut().map(|matrix| matrix.view_mut((first, first), (*end - first, *end - first)));
            let out = Evaluated { rates: &mut rates[first..*end], forces: &mut *forces, rows };
            let own = moment.with_states(first..*end);
            kind.evaluate(crane, &own, out, block);
            self.storing += kind.energy_and_rate(own.x, &rates[first..*end])[1];
            for force in forces {
                force.first += first;
            }
            [first_force, first] = [*end_force, *end];
        }
    }

    /// Replaces the slopes of laws that stick by the steeper ones on either side of rest; `c` is the implicit part of a step, s.
    pub(crate) fn steepen(&mut self, moment: &StateAt<'_>, c: f64) {
        let [mut first_force, mut first] = [0; 2];
        for (kind, [end_force, end]) in &self.kinds {
            kind.steepen(&moment.with_states(first..*end), c, &mut self.forces[first_force..*end_force]);
            [first_force, first] = [*end_force, *end];
        }
    }

    /// Adds what the forces contribute to the accelerations, and writes the rates of the states.
    pub(crate) fn accelerate(
        &mut self,
        crane: &dyn Functions,
        moment: &StateAt<'_>,
        rates: &mut [f64],
        accelerations: &mut [f64],
    ) {
        self.accelerate_with_slopes(crane, moment, rates, None, accelerations);
    }

    /// Adds the generalized forces, and writes the rates of the states.
    pub(crate) fn push(&mut self, crane: &dyn Functions, moment: &StateAt<'_>, rates: &mut [f64], forces: &mut [f64]) {
        self.evaluate(crane, moment, rates, None);
        add_forces(&self.forces, &self.rows, forces);
    }

    /// As `accelerate`, with the derivatives of the rates with respect to the states, if requested.
    pub(crate) fn accelerate_with_slopes(
        &mut self,
        crane: &dyn Functions,
        moment: &StateAt<'_>,
        rates: &mut [f64],
        by_states: Option<&mut DMatrix<f64>>,
        accelerations: &mut [f64],
    ) {
        self.evaluate(crane, moment, rates, by_states);
        self.add_accelerations(crane, moment.q);
        accelerations.iter_mut().zip(&self.efforts[1]).for_each(|(acceleration, added)| *acceleration += *added);
    }

    /// What the forces, as last evaluated, add to the effort of each rigid drive: its coordinate, and N m or N.
    ///
    /// ```text
    /// Δτ = A Δq̈ − f,     Δq̈ the accelerations that their generalized forces f add
    /// ```
    pub(crate) fn on_rigid_drives(
        &mut self,
        crane: &dyn Functions,
        q: &[f64],
    ) -> impl Iterator<Item = (usize, f64)> + '_ {
        if !self.prescribed.is_empty() && !self.forces.is_empty() {
            self.add_accelerations(crane, q);
            crane.mass_matrix(q, self.mass.as_mut_slice());
        }
        let Self { mass, efforts: [efforts, added], prescribed, .. } = self;
        prescribed.iter().map(move |&j| {
            let inertia: f64 = mass.row(j).iter().zip(added.iter()).map(|(entry, a)| entry * a).sum();
            (j, inertia - efforts[j])
        })
    }

    /// Generalized forces of the forces as last evaluated, and the accelerations that they add.
    fn add_accelerations(&mut self, crane: &dyn Functions, q: &[f64]) {
        let Self { forces, rows, efforts: [efforts, added], .. } = self;
        efforts.fill(0.0);
        add_forces(forces, rows, efforts);
        crane.solve_mass(q, efforts, added);
    }

    /// Appends which branch of its law each force is on.
    pub(crate) fn branches(&mut self, crane: &dyn Functions, moment: &StateAt<'_>, out: &mut Vec<bool>) {
        let mut first = 0;
        for (kind, [_, end]) in &mut self.kinds {
            kind.branches(crane, &moment.with_states(first..*end), out);
            first = *end;
        }
    }

    /// Power that forces supply, `Σ F ℓ̇`, and power that others dissipate, `−Σ F ℓ̇` without what they store, at the last evaluation, W.
    pub(crate) fn powers(&self) -> [f64; 2] {
        let (mut first, mut powers) = (0, [0.0, -self.storing]);
        for (kind, [end, _]) in &self.kinds {
            let power = self.forces[first..*end].iter().map(|force| force.force * force.speed).sum::<f64>();
            if kind.supplies_power() {
                powers[0] += power;
            } else {
                powers[1] -= power;
            }
            first = *end;
        }
        powers
    }
}

/// Adds what forces with states and closed loops contribute to the efforts of rigid drives, which generated code computes without them, N m
/// and N.
pub(crate) fn add_to_rigid_drives(crane: &dyn Functions, moment: &StateAt<'_>, efforts: &mut [f64]) {
    let description = crane.description();
    if description.prescribed().is_empty() {
        return;
    }
    let mut states = ForceStates::with_as_many_states(description, moment.x.len());
    let mut all = loops_on_rigid_drives(crane, moment);
    if !states.is_empty() && moment.x.len() >= states.len() {
        states.evaluate(crane, moment, &mut vec![0.0; moment.x.len()], None);
        all.extend(states.on_rigid_drives(crane, moment.q));
    }
    for (coordinate, added) in all {
        if let Some(drive) = description.drives.iter().position(|drive| drive.coordinate == coordinate) {
            efforts[drive] += added;
        }
    }
}

/// Names of the columns of results with the states, in their order.
pub fn columns(description: &Description) -> Vec<String> {
    ForceStates::new(description).states.into_iter().map(|state| state.name).collect()
}

/// Names of the states of small motions, in their order: the same without those of feet.
pub fn columns_of_small_motions(description: &Description) -> Vec<String> {
    ForceStates::of_small_motions(description).states.into_iter().map(|state| state.name).collect()
}

/// The states of small motions among all.
pub(crate) fn states_of_small_motions(description: &Description, x: &[f64]) -> Vec<f64> {
    let feet = description.supports.iter().filter(|support| support.one_sided).count();
    let end = x.len().saturating_sub(description.bristles.len());
    [&x[..end.saturating_sub(2 * feet)], &x[end..]].concat()
}

/// How far integration errors may move a state beyond its range.
const ROUNDING: f64 = 1e-3;

/// Describes states that no force can have: a spool beyond its ends.
pub fn impossible(description: &Description, x: &[f64]) -> Option<String> {
    let states = ForceStates::new(description).states;
    states.iter().zip(x).find_map(|(ForceState { name, range, .. }, x)| {
        let ([least, most], meaning) = (*range)?;
        let inside = (least - ROUNDING..=most + ROUNDING).contains(x);
        (!inside).then(|| format!("`{name}` is {x}: {meaning}"))
    })
}

/// Accelerations at a state of a crane and its forces, m/s² and rad/s², and the rates of the states.
///
/// # Panics
/// If `x` does not have one entry per state.
pub fn accelerations(crane: &dyn Functions, state: &StateAt<'_>) -> (Vec<f64>, Vec<f64>) {
    let states = ForceStates::new(crane.description()).len();
    assert_eq!(state.x.len(), states, "one number for each state of a force");
    let ClosedMotion { accelerations, rates, .. } = motion_at(crane, state);
    (accelerations, rates)
}

/// Accelerations at a state of a crane, and what closes its loops.
pub(crate) struct ClosedMotion {
    /// q̈, with closed loops.
    pub accelerations: Vec<f64>,
    /// The part of q̈ that closing the loops causes; empty without loops.
    change: Vec<f64>,
    /// Rates of the states of forces.
    pub rates: Vec<f64>,
    loops: Loops,
}

impl ClosedMotion {
    /// What each equation of the loop joints transmits, N and N m.
    pub fn multipliers(&self) -> &[f64] {
        self.loops.multipliers()
    }
}

/// The accelerations at a state; without the states of forces if they are not given.
pub(crate) fn motion_at(crane: &dyn Functions, moment: &StateAt<'_>) -> ClosedMotion {
    let &StateAt { q, x, .. } = moment;
    let (mut accelerations, mut rates) = (vec![0.0; q.len()], vec![0.0; x.len()]);
    let mut loops = Loops::new(crane);
    loops.open(crane, moment, &mut accelerations);
    let mut states = ForceStates::with_as_many_states(crane.description(), x.len());
    if !states.is_empty() && x.len() >= states.len() {
        states.accelerate(crane, moment, &mut rates, &mut accelerations);
    }
    let mut change = Vec::new();
    if !loops.is_empty() {
        change.clone_from(&accelerations);
        loops.close(&mut accelerations);
        change.iter_mut().zip(&accelerations).for_each(|(change, closed)| *change = closed - *change);
    }
    ClosedMotion { accelerations, change, rates, loops }
}

/// What closing the loops adds to the effort of each rigid drive: its coordinate, and N m or N.
pub(crate) fn loops_on_rigid_drives(crane: &dyn Functions, moment: &StateAt<'_>) -> Vec<(usize, f64)> {
    if crane.loop_joints().is_empty() || crane.description().prescribed().is_empty() {
        return Vec::new();
    }
    let ClosedMotion { change, loops, .. } = motion_at(crane, moment);
    loop_joints::on_rigid_drives(crane, moment.q, &loops, &change)
}

/// Adds the generalized forces of forces along their rows.
fn add_forces(forces: &[StatefulForce], rows: &[ForceRow], generalized: &mut [f64]) {
    for (force, row) in forces.iter().zip(rows) {
        row.add_to(generalized, force.force);
    }
}
