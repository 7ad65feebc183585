//! Joints that close loops, exactly: equations φ(q) = 0 whose rows `J = ∂φ/∂q` are those of connectors without compliance.
//!
//! What eliminates connectors from an implicit step is `(M + Uᵀ R U)⁻¹ = M⁻¹ − M⁻¹ Uᵀ (R⁻¹ + U M⁻¹ Uᵀ)⁻¹ U M⁻¹`; loop joints have
//! `R⁻¹ = 0`. For accelerations, with f all forces of the open chain and γ = J̇ q̇,
//!
//! ```text
//! A q̈ = f − Jᵀ λ,   J q̈ + γ = 0:      S = J A⁻¹ Jᵀ,    λ = S⁻¹ (J A⁻¹ f + γ),    q̈ = A⁻¹ f − A⁻¹ Jᵀ λ
//! ```
//!
//! so r equations take r + 1 recursions of the open chain, which share its articulated inertias, and one system of size r. A force of an equation
//! moves only what stands on the same moving ground: in the order of the coordinates that they span, S has entries only near its diagonal
//! (`profile`), and loops that stand next to each other take as many operations each, however many there are. Positions and rates that a method has
//! integrated are moved back onto the loop after every step: the smallest change in the metric of A,
//!
//! ```text
//! φ(q − A⁻¹ Jᵀ μ) = 0,      v ← v − A⁻¹ Jᵀ S⁻¹ J v
//! ```
//!
//! which keeps the order of the method (E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, section IV.4).
//!
//! Equations that depend on others (`independence`) are left out: what they would transmit cannot be determined.

mod curvature;
mod dead_centre;
mod drives;
mod independence;
mod of_crane;
mod profile;
mod quantities;
mod reactions;
mod required;
mod starts;

pub(crate) use curvature::{closed_motions, geometric_stiffness};
pub use dead_centre::DEAD_CENTRE;
pub(crate) use drives::prescribed_too_much;
pub use reactions::{Caution, Gap, Watch, cautions, gap_at, independent, undetermined};
pub(crate) use reactions::{add_to_wrenches, drives_beyond_reach, on_rigid_drives};
pub(crate) use required::{at_rest, generalized, required};
pub use starts::Given;
pub(crate) use starts::{close_start, close_state};

use std::ops::Range;

use nalgebra::Vector3;

use crate::{CoordinateKind, Count, LoopEquationInfo, LoopJointInfo, StateAt, dyn_crane::Functions, interleaved};
use independence::Independence;
use of_crane::OfCrane;
use profile::Profile;

/// Gap beyond which a loop that should be closed is open, m or rad: a thousandth of a millimetre.
pub(crate) const OPEN: f64 = 1e-6;
/// Gap that counts as closed up to rounding, m or rad.
const CLOSED: f64 = 1e-11;
/// Columns of a pose as near as this, m or rad, move a pose onto the loops: an iteration leaves as large a share of the gap. After a step of a
/// method they are those of its last evaluation.
const NEAR: f64 = 1e-3;
/// Iterations that move a pose back onto the loop: with the matrix of the step each gains several digits.
const ITERATIONS: usize = 20;
/// Iterations that assemble a guess.
const ASSEMBLY: usize = 60;
/// Halvings of a step of assembly before it is given up.
const HALVINGS: u32 = 12;
/// Largest rotation in a step of assembly, rad.
const GREATEST_ROTATION: f64 = 0.5;

/// A loop that is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Open {
    /// Index of the equation with the largest gap, among those of all joints.
    pub equation: usize,
    /// The gap, m or rad, or its rate, m/s or rad/s.
    pub gap: f64,
    /// Whether it is the rate of a gap that is closed.
    pub is_rate: bool,
}

/// Solves a linear system, `x = M⁻¹ r`.
pub(crate) type Solve<'a> = &'a mut dyn FnMut(&[f64], &mut [f64]);

/// Solves a linear system of a pose, `x = M(q)⁻¹ r`: q, r, x.
pub(crate) type SolveAt<'a> = &'a mut dyn FnMut(&[f64], &[f64], &mut [f64]);

/// The loop joints of a crane at a state, or of each crane of a fleet, with storage that is reused.
pub(crate) struct Loops {
    /// Number of coordinates.
    n: usize,
    /// Number of cranes.
    cranes: usize,
    /// Coordinates that rigid drives prescribe: no force moves them. A fleet has none.
    prescribed: Vec<usize>,
    /// φ, φ̇ and J̇ q̇, equation by equation, of all cranes next to each other.
    states: Vec<Vector3<f64>>,
    /// J, row by row, each of all cranes.
    jacobian: Vec<f64>,
    /// Where a row of J may have entries.
    spans: Vec<Range<usize>>,
    /// Where it has some, as last evaluated: runs of coordinates, and those of each row.
    runs: Vec<Range<usize>>,
    runs_of: Vec<Range<usize>>,
    /// All rows in the order of the coordinates that they span.
    order: Vec<usize>,
    /// What is separate for each crane.
    each: Vec<OfCrane>,
    /// The rows of equations that are independent in any crane.
    rows: Vec<usize>,
    /// M⁻¹ Jᵀ, row by row; of dependent equations it need not be known.
    columns: Vec<f64>,
    /// The pose at which the loops were last opened, with the columns of all equations; NaN if others have been written since.
    opened: Vec<f64>,
    /// Accelerations of the open chain and what closes its loops, as [`loop_dynamics`](crate::CraneModel::loop_dynamics) orders them.
    dynamics: Vec<f64>,
    /// `J M⁻¹ Jᵀ` of `rows`.
    coupled: Profile,
    products: Vec<f64>,
    /// Numbers of the equations.
    shares: Vec<f64>,
    /// λ, equation by equation; 0 for dependent ones.
    multipliers: Vec<f64>,
    /// J of a crane.
    own: Vec<f64>,
    /// A pose that is tried, and a change of the pose.
    trial: Vec<f64>,
    step: Vec<f64>,
    rest: Vec<f64>,
}

impl Loops {
    /// Storage for the loop joints of a crane.
    pub fn new(crane: &dyn Functions) -> Self {
        let (n, cranes) = (crane.size(), crane.cranes());
        // The row of a coupling has no length of its own to compare with others, even if it transmits a torque.
        let moments = |joint: &LoopJointInfo| {
            let is_moment = |equation: &LoopEquationInfo| equation.is_moment && !joint.is_coupling();
            joint.equations.iter().step_by(cranes).map(is_moment).collect::<Vec<_>>()
        };
        let groups: Vec<Vec<bool>> = crane.loop_joints().iter().map(moments).collect();
        let span = |(joint, group): (&LoopJointInfo, &Vec<bool>)| {
            let [first, end] = joint.spanned;
            std::iter::repeat_n(first..end, group.len())
        };
        let spans: Vec<Range<usize>> = crane.loop_joints().iter().zip(&groups).flat_map(span).collect();
        let count = spans.len();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|row| spans[*row].start);
        let of_one: Vec<_> = spans.iter().map(|span| span.start / cranes..span.end / cranes).collect();
        let of_crane = |crane| OfCrane::new(crane, Independence::new(groups.clone(), of_one.clone()));
        let zeros = |len: usize| vec![0.0; len];
        let of_cranes = if count == 0 { 0 } else { n };
        Self {
            n: of_cranes,
            cranes,
            prescribed: crane.description().prescribed(),
            states: vec![Vector3::zeros(); count * cranes],
            jacobian: zeros(count * of_cranes),
            spans,
            runs: Vec::with_capacity(4 * count),
            runs_of: vec![0..0; count],
            order,
            each: (0..cranes).map(of_crane).collect(),
            rows: Vec::with_capacity(count),
            columns: zeros(count * of_cranes),
            opened: vec![f64::NAN; of_cranes],
            dynamics: zeros(Count::loop_rows(count, n / cranes) * of_cranes),
            coupled: Profile::new(count),
            products: zeros(count * (count + 1) / 2 * cranes),
            shares: zeros(count * cranes),
            multipliers: zeros(count * cranes),
            own: zeros(count * of_cranes / cranes),
            trial: zeros(of_cranes),
            step: zeros(of_cranes),
            rest: zeros(of_cranes),
        }
    }

    /// Visits what further solutions depend on.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.each.iter_mut().for_each(|own| own.independence.visit(visit));
        self.order_rows();
        self.opened.iter_mut().chain(&mut self.columns).for_each(visit);
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// λ of the last solution, equation by equation: N and N m.
    pub fn multipliers(&self) -> &[f64] {
        &self.multipliers
    }

    /// J, row by row, as last evaluated.
    pub fn jacobian(&self) -> &[f64] {
        &self.jacobian
    }

    /// Whether a coordinate moves the points of some loop joint against each other, as last evaluated.
    fn is_moved_by(&self, coordinate: usize) -> bool {
        self.jacobian.iter().skip(coordinate).step_by(self.n).any(|entry| *entry != 0.0)
    }

    /// φ of an equation, as last evaluated, m or rad.
    pub fn gap(&self, equation: usize) -> f64 {
        self.states[equation].x
    }

    /// Indices of the independent equations of the first crane, as last chosen.
    pub fn independent(&self) -> &[usize] {
        self.each[0].independence.kept()
    }

    /// Whether an equation, by its index among those of all cranes, is independent.
    fn is_independent(&self, equation: usize) -> bool {
        self.each[equation % self.cranes].independence.is_kept(equation / self.cranes)
    }

    /// φ, φ̇ and J̇ q̇ of every equation, and J.
    pub fn evaluate(&mut self, crane: &dyn Functions, q: &[f64], v: &[f64]) {
        crane.loop_states(q, v, &mut self.states);
        crane.loop_jacobians(q, &mut self.jacobian);
        self.find_runs();
    }

    /// Notes which coordinates move the points of each equation.
    fn find_runs(&mut self) {
        let Self { n, cranes, jacobian, spans, runs, runs_of, .. } = self;
        runs.clear();
        for ((row, span), range) in spans.iter().enumerate().zip(runs_of) {
            let first = runs.len();
            for at in span.clone().step_by(*cranes) {
                if jacobian[row * *n + at..][..*cranes].iter().any(|entry| *entry != 0.0) {
                    match runs[first..].last_mut() {
                        Some(run) if run.end == at => run.end += *cranes,
                        _ => runs.push(at..at + *cranes),
                    }
                }
            }
            *range = first..runs.len();
        }
    }

    /// Chooses independent equations at the state evaluated; those chosen before remain if they are still good.
    pub fn choose(&mut self) {
        let Self { each, jacobian, n, cranes, prescribed, own, .. } = self;
        for of_crane in each {
            interleaved::gather(jacobian, of_crane.crane, *cranes, own);
            of_crane.independence.choose(own, *n / *cranes, prescribed);
        }
        self.order_rows();
    }

    /// Lists the rows of equations that are independent in any crane, and their places for each.
    fn order_rows(&mut self) {
        let Self { each, order, rows, .. } = self;
        rows.clear();
        for own in each.iter_mut() {
            own.places.clear();
        }
        for &row in &*order {
            let (index, mut is_kept) = (rows.len(), false);
            for own in each.iter_mut().filter(|own| own.independence.is_kept(row)) {
                own.places.push(index);
                is_kept = true;
            }
            if is_kept {
                rows.push(row);
            }
        }
    }

    /// Number of equations that are independent while some coordinates rest.
    fn independent_without(&self, held: &[usize]) -> usize {
        let mut independence = self.each[0].independence.begin_again();
        independence.choose(&self.jacobian, self.n, held);
        independence.kept().len()
    }

    /// Prepares solutions at the state evaluated; `solve` solves the system of the open chain.
    pub fn factorise(&mut self, solve: Solve<'_>) {
        let Self { n, jacobian, rows, columns, opened, .. } = self;
        opened.fill(f64::NAN);
        for &row in &*rows {
            let range = row * *n..(row + 1) * *n;
            solve(&jacobian[range.clone()], &mut columns[range]);
        }
        self.factorise_schur();
    }

    /// S of the independent equations, from J and M⁻¹ Jᵀ. What does not move with another joint has exact zeros there.
    fn factorise_schur(&mut self) {
        let Self { n, cranes, jacobian, runs, runs_of, rows, columns, coupled, products, each, .. } = self;
        let (n, cranes) = (*n, *cranes);
        coupled.clear();
        for (i, &row) in rows.iter().enumerate() {
            let (own, mut first) = (&jacobian[row * n..][..n], None);
            for (j, &column) in rows[..=i].iter().enumerate() {
                let index = coupled.len() + j - first.unwrap_or(j);
                let product = &mut products[index * cranes..][..cranes];
                product.fill(0.0);
                for run in &runs[runs_of[row].clone()] {
                    interleaved::add_dot(&own[run.clone()], &columns[column * n..][run.clone()], product);
                }
                if first.is_none() && (j == i || product.iter().any(|product| *product != 0.0)) {
                    first = Some(j);
                }
            }
            coupled.add(first.unwrap_or(i));
        }
        for own in each {
            own.factorise(coupled, products, cranes);
        }
    }

    /// Turns the solution of the open chain, `x = M⁻¹ r`, into that with the loops closed, for which `J x + γ = 0`; γ is J̇ q̇ of the
    /// state evaluated if `moving`, otherwise 0.
    pub fn correct(&mut self, x: &mut [f64], moving: bool) {
        if self.is_empty() {
            return;
        }
        let states = std::mem::take(&mut self.states);
        self.correct_by(x, |row| if moving { states[row].z } else { 0.0 });
        self.states = states;
        let Self { cranes, rows, shares, multipliers, .. } = self;
        multipliers.fill(0.0);
        for equation in equations(rows, *cranes) {
            multipliers[equation] = -shares[equation];
        }
    }

    /// The same for `J x + γ = 0` with a given γ of each equation; λ stays as it is.
    pub fn correct_by(&mut self, x: &mut [f64], gamma: impl Fn(usize) -> f64) {
        self.take_along(x);
        for equation in equations(&self.rows, self.cranes) {
            self.shares[equation] += gamma(equation);
        }
        self.subtract(x);
    }

    /// `J x` of the independent equations as shares.
    fn take_along(&mut self, x: &[f64]) {
        let Self { n, cranes, jacobian, runs, runs_of, rows, shares, .. } = self;
        for &row in &*rows {
            let shares = &mut shares[row * *cranes..][..*cranes];
            shares.fill(0.0);
            for run in &runs[runs_of[row].clone()] {
                interleaved::add_dot(&jacobian[row * *n..][run.clone()], &x[run.clone()], shares);
            }
        }
    }

    /// The transpose of [`correct_by`](Self::correct_by): weights of its result become those of x, and `gammas` receives those of γ, equation by
    /// equation.
    pub fn pull_back(&mut self, weights: &mut [f64], gammas: &mut [f64]) {
        let Self { n, cranes, rows, columns, shares, .. } = self;
        for &row in &*rows {
            interleaved::dot(&columns[row * *n..][..*n], weights, &mut shares[row * *cranes..][..*cranes]);
        }
        self.solve_shares();
        gammas.fill(0.0);
        for &row in &self.rows {
            let shares = &self.shares[row * self.cranes..][..self.cranes];
            gammas[row * self.cranes..][..self.cranes].copy_from_slice(shares);
            interleaved::add(shares, &self.jacobian[row * self.n..][..self.n], weights);
        }
    }

    /// `x − M⁻¹ Jᵀ S⁻¹ shares`; the shares become `−S⁻¹ shares`.
    fn subtract(&mut self, x: &mut [f64]) {
        self.solve_shares();
        for &row in &self.rows {
            let shares = &self.shares[row * self.cranes..][..self.cranes];
            interleaved::add(shares, &self.columns[row * self.n..][..self.n], x);
        }
    }

    /// `−S⁻¹ shares` in place of the shares; 0 for equations that are dependent in a crane.
    fn solve_shares(&mut self) {
        let Self { cranes, each, rows, shares, .. } = self;
        for own in each {
            own.solve(rows, *cranes, shares);
        }
    }

    /// Writes the accelerations of the open chain, and prepares to [`close`](Self::close) its loops.
    pub fn open(&mut self, crane: &dyn Functions, &StateAt { t, q, v, .. }: &StateAt<'_>, accelerations: &mut [f64]) {
        if self.is_empty() {
            crane.forward_dynamics(t, q, v, accelerations);
            return;
        }
        let Self { n, dynamics, jacobian, columns, states, opened, .. } = self;
        crane.loop_dynamics(t, q, v, dynamics);
        opened.copy_from_slice(q);
        let (of_chain, rest) = dynamics.split_at(*n);
        let (curvatures, rest) = rest.split_at(states.len().next_multiple_of(*n));
        let (rows, responses) = rest.split_at(jacobian.len());
        accelerations.copy_from_slice(of_chain);
        jacobian.copy_from_slice(rows);
        columns.copy_from_slice(responses);
        for (state, curvature) in states.iter_mut().zip(curvatures) {
            *state = Vector3::new(f64::NAN, f64::NAN, *curvature);
        }
        self.find_runs();
    }

    /// Accelerations with the loops closed, in place of those of the open chain, where they were last [opened](Self::open). λ is then known.
    pub fn close(&mut self, accelerations: &mut [f64]) {
        if self.is_empty() {
            return;
        }
        if self.each[0].independence.is_unknown() {
            self.choose();
        }
        self.factorise_schur();
        self.correct(accelerations, true);
    }

    /// The independent equation with the largest gap.
    fn greatest(&self) -> Open {
        self.worst(|equation| self.is_independent(equation))
    }

    /// The equation with the largest gap, as last evaluated.
    pub fn widest(&self) -> Open {
        self.worst(|_| true)
    }

    fn worst(&self, counts: impl Fn(usize) -> bool) -> Open {
        let gaps = self.states.iter().enumerate().filter(|(row, _)| counts(*row));
        // A gap that is not a number is the largest.
        let gaps = gaps.map(|(equation, state)| Open {
            equation,
            gap: if state.x.is_nan() { f64::INFINITY } else { state.x.abs() },
            is_rate: false,
        });
        gaps.reduce(|one, other| if other.gap > one.gap { other } else { one }).unwrap_or(Open {
            equation: 0,
            gap: 0.0,
            is_rate: false,
        })
    }

    /// Moves a pose and its rates, which a method has integrated, onto the loops.
    ///
    /// # Errors
    /// A loop does not close: one of its equations that depend on others has a gap, or the pose is too far away.
    pub fn project(&mut self, crane: &dyn Functions, q: &mut [f64], v: &mut [f64]) -> Result<(), Open> {
        if self.is_empty() {
            return Ok(());
        }
        self.evaluate(crane, q, v);
        self.choose();
        if self.opened.iter().zip(&*q).all(|(opened, q)| (opened - q).abs() < NEAR) {
            self.factorise_schur();
        } else {
            let q = &*q;
            self.factorise(&mut |r, x| crane.solve_mass(q, r, x));
        }
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let Open { gap, .. } = self.greatest();
            // Rounding ends the iteration.
            if gap <= f64::EPSILON || gap > 0.5 * before {
                break;
            }
            before = gap;
            self.take_gaps();
            self.subtract(q);
            crane.loop_states(q, v, &mut self.states);
        }
        let open = self.greatest();
        if open.gap > CLOSED {
            return Err(open);
        }
        crane.loop_jacobians(q, &mut self.jacobian);
        self.find_runs();
        // The matrix of another pose leaves a share of the rates as small as the difference of the poses.
        for _ in 0..3 {
            self.take_along(v);
            self.subtract(v);
        }
        let widest = self.widest();
        if widest.gap > OPEN { Err(widest) } else { Ok(()) }
    }

    /// √Σ φ²
    fn size(&self) -> f64 {
        self.states.iter().map(|state| state.x * state.x).sum::<f64>().sqrt()
    }

    /// The gaps of the independent equations as shares.
    fn take_gaps(&mut self) {
        let Self { cranes, rows, shares, states, .. } = self;
        for equation in equations(rows, *cranes) {
            shares[equation] = states[equation].x;
        }
    }

    /// Moves a guess onto the loops by Gauss–Newton steps, in the metric of the matrix that `solve` inverts at a pose: the branch is the one
    /// on which the guess lies.
    ///
    /// # Errors
    /// It does not close; the pose is the nearest one that was found.
    pub fn assemble(&mut self, crane: &dyn Functions, q: &mut [f64], solve: SolveAt<'_>) -> Result<(), Open> {
        if self.is_empty() {
            return Ok(());
        }
        let rest = std::mem::take(&mut self.rest);
        self.evaluate(crane, q, &rest);
        for _ in 0..ASSEMBLY {
            self.choose();
            let size = self.size();
            if size <= f64::EPSILON {
                break;
            }
            {
                let q = &*q;
                self.factorise(&mut |r, x| solve(q, r, x));
            }
            self.take_gaps();
            let mut step = std::mem::take(&mut self.step);
            step.fill(0.0);
            self.subtract(&mut step);
            limit(&mut step, crane);
            let mut trial = std::mem::take(&mut self.trial);
            let nearer = (0..HALVINGS).any(|k| {
                let fraction = 0.5_f64.powi(k.cast_signed());
                for (trial, (q, step)) in trial.iter_mut().zip(q.iter().zip(&step)) {
                    *trial = q + fraction * step;
                }
                crane.loop_states(&trial, &rest, &mut self.states);
                self.size() < size
            });
            if nearer {
                q.copy_from_slice(&trial);
            }
            (self.step, self.trial) = (step, trial);
            self.evaluate(crane, q, &rest);
            if !nearer {
                break;
            }
        }
        self.rest = rest;
        let widest = self.widest();
        if widest.gap > OPEN { Err(widest) } else { Ok(()) }
    }
}

/// The equations of all cranes with these rows.
fn equations(rows: &[usize], cranes: usize) -> impl Iterator<Item = usize> {
    rows.iter().flat_map(move |row| row * cranes..(row + 1) * cranes)
}

/// Shortens a step so that no coordinate rotates by more than [`GREATEST_ROTATION`].
fn limit(step: &mut [f64], crane: &dyn Functions) {
    let coordinates = &crane.description().coordinates;
    let rotations = coordinates.iter().zip(&*step).filter(|(info, _)| info.kind == CoordinateKind::Rotation);
    let greatest = rotations.map(|(_, step)| step.abs()).fold(0.0, f64::max);
    if greatest > GREATEST_ROTATION {
        for step in step.iter_mut() {
            *step *= GREATEST_ROTATION / greatest;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
