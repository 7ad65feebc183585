//! States of forces, in addition to the pose and rates of a motion: pressures and spools of cylinders with a valve, bristles of joints that
//! stick.
//!
//! A motion is `[q, v, x]`; x has the states of the oil, then one for each joint with bristles.

use nalgebra::DMatrix;

use crate::{
    Description,
    bristles::{self, Bristles},
    dyn_crane::{DynCrane, DynDynamics, DynModel},
    hydraulics::{self, Hydraulics},
    stateful_force::{Row, STATES, StateAt, StatefulForce},
};

/// All forces of a crane that have states.
#[derive(Clone, Debug)]
pub struct ForceStates {
    oil: Hydraulics,
    bristles: Bristles,
    /// The forces as last evaluated, those of the oil first.
    forces: Vec<StatefulForce>,
    /// Their rows.
    rows: Vec<Row>,
    /// Their generalized forces, and the accelerations that these add.
    efforts: [Vec<f64>; 2],
    /// The coordinates of rigid drives, and the mass matrix if there are any.
    prescribed: Vec<usize>,
    mass: DMatrix<f64>,
}

impl ForceStates {
    /// From the description of a crane.
    pub fn new(description: &Description) -> Self {
        let (oil, n) = (Hydraulics::new(description), description.coordinates.len());
        let bristles = Bristles::new(description, oil.len());
        let prescribed = description.prescribed();
        let size = if prescribed.is_empty() { 0 } else { n };
        Self {
            prescribed,
            mass: DMatrix::zeros(size, size),
            forces: vec![StatefulForce::default(); oil.count() + bristles.len()],
            rows: oil.rows().chain(bristles.rows()).collect(),
            efforts: [vec![0.0; n], vec![0.0; n]],
            oil,
            bristles,
        }
    }

    /// Number of states.
    pub fn len(&self) -> usize {
        self.oil.len() + self.bristles.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.forces.is_empty()
    }

    /// Sizes by which errors of the states are measured: the pump's pressure, the travel of a spool from its centre, the deflection at
    /// which bristles slide.
    pub fn scales(&self) -> Vec<f64> {
        self.oil.scales().into_iter().chain(self.bristles.scales()).collect()
    }

    /// The states that hold a pose at rest at a given time: shut valves, the unloaded side at tank pressure, and
    /// bristles that carry nothing.
    pub fn holding(&mut self, crane: &dyn DynDynamics, t: f64, q: &[f64]) -> Vec<f64> {
        let mut states = self.oil.holding(crane, t, q);
        states.resize(self.len(), 0.0);
        states
    }

    /// As [`holding`](Self::holding), with valves that a servo has opened slightly, in either direction.
    pub(crate) fn slightly_open(&mut self, crane: &dyn DynCrane, t: f64, q: &[f64]) -> [Vec<f64>; 2] {
        let len = self.len();
        self.oil.slightly_open(crane, t, q).map(|mut states| {
            states.resize(len, 0.0);
            states
        })
    }

    /// Number of forces with states.
    pub(crate) fn count(&self) -> usize {
        self.forces.len()
    }

    /// Number of forces of the oil, and of their states; both come first.
    pub(crate) fn of_oil(&self) -> [usize; 2] {
        [self.oil.count(), self.oil.len()]
    }

    /// The forces as last evaluated.
    pub(crate) fn forces(&self) -> &[StatefulForce] {
        &self.forces
    }

    /// The rows `∂ℓ/∂q` of the forces, as last evaluated.
    pub(crate) fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Evaluates all forces and the rates of their states and, if requested, the derivatives of the rates with respect to the states.
    pub(crate) fn evaluate(
        &mut self,
        crane: &dyn DynModel,
        moment: &StateAt<'_>,
        rates: &mut [f64],
        mut by_states: Option<&mut DMatrix<f64>>,
    ) {
        if let Some(matrix) = by_states.as_deref_mut() {
            matrix.fill(0.0);
        }
        let (of_oil, of_bristles) = self.forces.split_at_mut(self.oil.count());
        self.oil.evaluate(crane, moment, rates, of_oil, by_states.as_deref_mut());
        self.oil.update(&mut self.rows);
        self.bristles.evaluate(moment, rates, of_bristles, by_states);
    }

    /// Replaces the slopes of bristles that stick by the steeper ones on either side of rest; `c` is the implicit part of a step, s.
    pub(crate) fn steepen_bristles(&mut self, moment: &StateAt<'_>, c: f64) {
        self.bristles.steepen(moment, c, &mut self.forces[self.oil.count()..]);
    }

    /// Adds what the forces contribute to the accelerations, and writes the rates of the states.
    pub(crate) fn accelerate(
        &mut self,
        crane: &dyn DynDynamics,
        moment: &StateAt<'_>,
        rates: &mut [f64],
        accelerations: &mut [f64],
    ) {
        self.evaluate(crane, moment, rates, None);
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
        crane: &dyn DynDynamics,
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
    fn add_accelerations(&mut self, crane: &dyn DynDynamics, q: &[f64]) {
        let [efforts, added] = &mut self.efforts;
        efforts.fill(0.0);
        for (force, row) in self.forces.iter().zip(&self.rows) {
            row.add_to(efforts, force.force);
        }
        crane.solve_mass(q, efforts, added);
    }

    /// Appends which branch of its law each force is on.
    pub(crate) fn branches(&mut self, crane: &dyn DynModel, moment: &StateAt<'_>, out: &mut Vec<bool>) {
        self.oil.branches(crane, moment, out);
        self.bristles.branches(moment, out);
    }

    /// Power that cylinders supply, `Σ F ℓ̇`, and power that bristles dissipate, `−Σ F ℓ̇`, at the last evaluation, W.
    pub(crate) fn powers(&self) -> [f64; 2] {
        let (of_oil, of_bristles) = self.forces.split_at(self.oil.count());
        let power = |all: &[StatefulForce]| all.iter().map(|force| force.force * force.speed).sum::<f64>();
        [power(of_oil), -power(of_bristles)]
    }
}

/// Adds what forces with states contribute to the efforts of rigid drives, which generated code computes without them, N m and N.
pub(crate) fn add_to_rigid_drives(crane: &dyn DynDynamics, moment: &StateAt<'_>, efforts: &mut [f64]) {
    let description = crane.description();
    let mut states = ForceStates::new(description);
    if states.is_empty() || moment.x.len() < states.len() {
        return;
    }
    states.evaluate(crane, moment, &mut vec![0.0; moment.x.len()], None);
    for (coordinate, added) in states.on_rigid_drives(crane, moment.q) {
        if let Some(drive) = description.drives.iter().position(|drive| drive.coordinate == coordinate) {
            efforts[drive] += added;
        }
    }
}

/// Names of the columns of results with the states, in their order.
pub fn columns(description: &Description) -> Vec<String> {
    [hydraulics::columns(description), bristles::columns(description)].concat()
}

/// How far integration errors may move a spool beyond its ends.
const ROUNDING: f64 = 1e-3;

/// Describes states that no valve can have: a spool beyond its ends.
pub fn impossible(description: &Description, x: &[f64]) -> Option<String> {
    let names = hydraulics::columns(description);
    let beyond = |(place, name): (usize, &String)| {
        let opening = *x.get(place)?;
        (place % STATES == 2 && opening.abs() > 1.0 + ROUNDING)
            .then(|| format!("`{name}` is {opening}: a valve is fully open at −1 and 1"))
    };
    names.iter().enumerate().find_map(beyond)
}

/// Accelerations at a state of a crane and its forces, m/s² and rad/s², and the rates of the states.
///
/// # Panics
/// If `x` does not have one entry per state.
pub fn accelerations(crane: &dyn DynDynamics, t: f64, (q, v): (&[f64], &[f64]), x: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut accelerations, mut rates) = (vec![0.0; q.len()], vec![0.0; x.len()]);
    crane.forward_dynamics(t, q, v, &mut accelerations);
    let mut states = ForceStates::new(crane.description());
    assert_eq!(x.len(), states.len(), "one number for each state of a force");
    if !states.is_empty() {
        states.accelerate(crane, &StateAt { t, q, v, x }, &mut rates, &mut accelerations);
    }
    (accelerations, rates)
}
