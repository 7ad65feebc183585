//! One-sided supports, which hold sideways by friction: how they stand, what they contribute to Newton's method, and how far they have slid.
//!
//! A pad is a spring and a damper in parallel, in series with a slider of Coulomb friction. With the elongation e of its place, the
//! place a to which it has slid, and the axes x and y of the world
//!
//! ```text
//! F = s (e − a) + d ė        f = −g F,  g = min(1, μ N/|F|)        ȧ = (1 − g) F/max(d, s τ)
//! ```
//!
//! While |F| ≤ μ N it sticks: a does not move. Beyond, f has the size μ N, and with the damping d > s τ of the pad its own spring follows exactly,
//! `s (e − a) + d (ė − ȧ) = g F`; with less, within τ = 1 ms. In the air, g = 0: the pad goes back to its place under the crane.
//!
//! Generated functions contain f with a = 0. The runtime adds the difference, which is zero until a foot has slid. At rest, without a
//! history, f is that with a = 0, and a run begins with `a = e − g e`, from which no foot slides further.

use crane_quantities::ColumnKind;
use nalgebra::{DMatrix, DMatrixViewMut, Vector3};

use crate::{
    CoordinateRole, Description, StateAt,
    dyn_crane::Functions,
    hydraulics::Hydraulics,
    stateful_force::{Evaluated, ForceRow, ForceState, StatefulForce, StatefulForces},
};

/// τ, s: how fast a pad without a damper follows its slider.
const FOLLOWING: f64 = 1e-3;
/// The size by which errors of a are measured, m: an error of the tolerance times this changes the force of a stiff pad, 1e7 N/m, by a few newtons.
const SCALE: f64 = 1e-2;
/// A lateral force that does not count, N, as in generated functions.
const NO_FORCE: f64 = 1e-15;

/// A one-sided support at a state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Foot {
    /// Index among the supports.
    pub support: usize,
    /// e, m, and ė, m/s.
    elongation: [f64; 3],
    rate: [f64; 3],
    /// s, N/m, and d, N s/m.
    stiffness: [f64; 3],
    damping: [f64; 3],
    /// N, and μ N, N.
    pressing: f64,
    grip: f64,
}

/// What holds a foot sideways, if it has slid to a place a.
#[derive(Clone, Copy, Debug)]
struct Lateral {
    /// F, N.
    trial: [f64; 2],
    /// g.
    share: f64,
    /// F/|F| of a foot that slides; zero if it sticks.
    direction: [f64; 2],
}

impl Lateral {
    /// `∂(g F_i)/∂F_j`.
    fn slope(&self, i: usize, j: usize) -> f64 {
        self.share * (f64::from(u8::from(i == j)) - self.direction[i] * self.direction[j])
    }

    fn slides(&self) -> bool {
        self.direction != [0.0; 2]
    }
}

/// Derivatives of a weighted sum of what a foot adds to the forces along x and y and of the rates of a with respect to what they depend on.
#[derive(Clone, Copy, Debug, Default)]
struct Derivatives {
    elongation: [f64; 2],
    rate: [f64; 2],
    stiffness: [f64; 2],
    damping: [f64; 2],
    grip: f64,
    /// With respect to a, of the forces only.
    slid: [f64; 2],
}

impl Foot {
    /// The derivatives of `Σ ω_i Δf_i + Σ ρ_i ȧ_i`.
    fn differentiate(&self, slid: [f64; 2], of_forces: [f64; 2], of_rates: [f64; 2]) -> Derivatives {
        let mut sum = Derivatives::default();
        // Weights of g F, of F itself, and whether F contains a.
        let mut add = |slid: [f64; 2], pulls: [f64; 2], direct: [f64; 2], of_slid: bool| {
            let lateral = self.lateral(slid);
            if lateral.slides() {
                sum.grip += lateral.direction[0] * pulls[0] + lateral.direction[1] * pulls[1];
            }
            for j in 0..2 {
                let weight = direct[j] + lateral.slope(0, j) * pulls[0] + lateral.slope(1, j) * pulls[1];
                sum.elongation[j] += weight * self.stiffness[j];
                sum.rate[j] += weight * self.damping[j];
                sum.stiffness[j] += weight * (self.elongation[j] - slid[j]);
                sum.damping[j] += weight * self.rate[j];
                if of_slid {
                    sum.slid[j] -= weight * self.stiffness[j];
                }
            }
        };
        let followed = [0, 1].map(|i| of_rates[i] / self.following(i));
        add([0.0; 2], of_forces, [0.0; 2], false);
        add(slid, of_forces.map(|weight| -weight), [0.0; 2], true);
        add(slid, followed.map(|weight| -weight), followed, false);
        let lateral = self.lateral(slid);
        for i in 0..2 {
            let by_following = -followed[i] * (1.0 - lateral.share) * lateral.trial[i] / self.following(i);
            if self.damping[i] >= FOLLOWING * self.stiffness[i] {
                sum.damping[i] += by_following;
            } else {
                sum.stiffness[i] += FOLLOWING * by_following;
            }
        }
        sum
    }

    fn lateral(&self, slid: [f64; 2]) -> Lateral {
        let trial = [0, 1].map(|axis| {
            self.stiffness[axis] * (self.elongation[axis] - slid[axis]) + self.damping[axis] * self.rate[axis]
        });
        let size = (trial[0] * trial[0] + trial[1] * trial[1] + NO_FORCE * NO_FORCE).sqrt();
        let lifted = self.elongation[2] > 0.0;
        let share = if lifted { 0.0 } else { ((self.grip + NO_FORCE) / size).min(1.0) };
        let direction = if share < 1.0 { trial.map(|force| force / size) } else { [0.0; 2] };
        Lateral { trial, share, direction }
    }

    /// max(d, s τ) along an axis.
    fn following(&self, axis: usize) -> f64 {
        self.damping[axis].max(FOLLOWING * self.stiffness[axis]).max(f64::MIN_POSITIVE)
    }
}

/// The one-sided supports of a crane, with room for their numbers.
#[derive(Clone, Debug)]
pub(crate) struct Feet {
    all: Vec<Foot>,
    names: Vec<String>,
    /// The first of the coordinates that move them, and how many there are.
    base: [usize; 2],
    n: usize,
    /// Whether all stuck where the spec puts them when they were last evaluated as forces: nothing else was evaluated then.
    stick: bool,
    /// Whether J does not depend on the pose, and whether what depends neither on pose nor on rates is known.
    is_linear: bool,
    has_constants: bool,
    numbers: [Vec<Vector3<f64>>; 3],
    grips: Vec<Vector3<f64>>,
    /// J of all supports: three rows each, for the coordinates that move them.
    jacobians: Vec<f64>,
    /// The same as functions of the crane give it.
    all_jacobians: Vec<f64>,
}

impl Feet {
    /// Those of a description.
    pub fn new(description: &Description) -> Self {
        let (supports, n) = (description.supports.len(), description.coordinates.len());
        let one_sided: Vec<usize> = (0..supports).filter(|support| description.supports[*support].one_sided).collect();
        let is_base = |j: &usize| description.coordinates[*j].role == CoordinateRole::Base;
        let first = (0..n).find(is_base).unwrap_or(0);
        let end = (0..n).rfind(is_base).map_or(first, |last| last + 1);
        // A crane without feet asks for nothing.
        let room = if one_sided.is_empty() { 0 } else { supports };
        Self {
            names: one_sided.iter().map(|support| description.supports[*support].name.to_string()).collect(),
            all: one_sided.into_iter().map(|support| Foot { support, ..Foot::default() }).collect(),
            base: [first, end - first],
            n,
            stick: false,
            is_linear: description.supports.iter().all(|support| support.linear),
            has_constants: false,
            numbers: [(); 3].map(|()| vec![Vector3::zeros(); room]),
            grips: vec![Vector3::zeros(); room],
            jacobians: vec![0.0; 3 * room * (end - first)],
            all_jacobians: Vec::new(),
        }
    }

    /// The feet of a crane in a pose at rest.
    pub fn at_rest(crane: &dyn Functions, q: &[f64]) -> Self {
        let mut feet = Self::new(crane.description());
        feet.evaluate_at(crane, q, &vec![0.0; q.len()]);
        feet
    }

    /// Index of the state of a foot along an axis among those of all feet: first all along x, then all along y.
    fn place(&self, foot: usize, axis: usize) -> usize {
        axis * self.all.len() + foot
    }

    /// The two states of a foot.
    fn pair(&self, states: &[f64], foot: usize) -> [f64; 2] {
        [0, 1].map(|axis| states[self.place(foot, axis)])
    }

    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Row of J of a foot along an axis, for the coordinates that move it.
    fn row(&self, foot: usize, axis: usize) -> &[f64] {
        let [_, count] = self.base;
        &self.jacobians[(3 * self.all[foot].support + axis) * count..][..count]
    }

    /// Evaluates J. Of a fleet, number i of crane l of m is at i m + l, that of a support as that of a row.
    fn evaluate_jacobians(&mut self, crane: &dyn Functions, q: &[f64]) {
        let ([first, count], cranes, supports) = (self.base, crane.cranes(), self.grips.len());
        let n = self.n / cranes;
        self.all_jacobians.resize(3 * supports * n, 0.0);
        crane.support_jacobians(q, &mut self.all_jacobians);
        for support in 0..supports {
            let (own, lane) = (support / cranes, support % cranes);
            for axis in 0..3 {
                let row = &self.all_jacobians[(3 * own + axis) * n * cranes..][..n * cranes];
                let out = &mut self.jacobians[(3 * support + axis) * count..][..count];
                out.iter_mut().zip(&row[first..]).skip(lane).step_by(cranes).for_each(|(out, entry)| *out = *entry);
            }
        }
    }

    fn evaluate_at(&mut self, crane: &dyn Functions, q: &[f64], v: &[f64]) {
        if self.is_empty() {
            return;
        }
        crane.support_grips(q, v, &mut self.grips);
        self.evaluate_rest(crane, q, v);
    }

    /// Whether all feet stick where the spec puts them, so that they add nothing.
    fn all_stick(&mut self, crane: &dyn Functions, moment: &StateAt<'_>) -> bool {
        crane.support_grips(moment.q, moment.v, &mut self.grips);
        let mut feet = self.all.iter().map(|foot| self.grips[foot.support]);
        moment.x.iter().all(|slid| *slid == 0.0) && feet.all(|grips| grips.z <= grips.y && grips.x > 0.0)
    }

    /// Everything but the grips.
    fn evaluate_rest(&mut self, crane: &dyn Functions, q: &[f64], v: &[f64]) {
        let [elongations, stiffnesses, dampings] = &mut self.numbers;
        crane.support_elongations(q, elongations);
        let known = std::mem::replace(&mut self.has_constants, true);
        if !known {
            crane.support_stiffnesses(stiffnesses);
            crane.support_dampings(dampings);
        }
        if !known || !self.is_linear {
            self.evaluate_jacobians(crane, q);
        }
        let [first, count] = self.base;
        let moving = &v[first..first + count];
        for index in 0..self.all.len() {
            let support = self.all[index].support;
            let rate =
                [0, 1, 2].map(|axis| self.row(index, axis).iter().zip(moving).map(|(entry, v)| entry * v).sum::<f64>());
            let [elongation, stiffness, damping] = self.numbers.each_ref().map(|numbers| numbers[support].into());
            let [pressing, grip, _] = self.grips[support].into();
            self.all[index] = Foot { support, elongation, rate, stiffness, damping, pressing, grip };
        }
    }

    /// How much of its friction each foot on the ground uses, |F|/(μ N) at a = 0, with its index among the supports: from 1 on it slides.
    pub fn utilisations_on_the_ground(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.all.iter().filter(|foot| foot.pressing > 0.0).map(|foot| {
            let [x, y] = foot.lateral([0.0; 2]).trial;
            (foot.support, x.hypot(y) / foot.grip)
        })
    }

    /// Whether any foot has slid to another place, or slides.
    pub fn has_slid(&self) -> bool {
        !self.stick
    }

    /// How far each foot is beside its place, m.
    pub fn distances(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.all.iter().map(|foot| (foot.support, foot.elongation[0].hypot(foot.elongation[1])))
    }

    /// What feet that slide add to the tangent stiffness at rest, in which they are free sideways: `∂(g F)/∂e`, with N among it.
    ///
    /// ```text
    /// ∂(g F_i)/∂e_j = g (δ_ij − n_i n_j) s_j        ∂(g F_i)/∂e_z = −n_i μ s_z
    /// ```
    ///
    /// It is not symmetric. `None` if all feet on the ground stick.
    pub fn sliding_stiffness(&self, description: &Description) -> Option<DMatrix<f64>> {
        let mut matrix: Option<DMatrix<f64>> = None;
        let [first, count] = self.base;
        for (index, foot) in self.all.iter().enumerate() {
            let lateral = foot.lateral([0.0; 2]);
            if !lateral.slides() || foot.pressing <= 0.0 {
                continue;
            }
            let friction = foot.grip / foot.pressing;
            let matrix = matrix.get_or_insert_with(|| DMatrix::zeros(self.n, self.n));
            for i in 0..2 {
                let slopes = [
                    lateral.slope(i, 0) * foot.stiffness[0],
                    lateral.slope(i, 1) * foot.stiffness[1],
                    -lateral.direction[i] * friction * foot.stiffness[2],
                ];
                for row in 0..count {
                    for column in 0..count {
                        let is_free = |j: usize| description.coordinates[first + j].role == CoordinateRole::Base;
                        let along: f64 =
                            slopes.iter().enumerate().map(|(axis, slope)| slope * self.row(index, axis)[column]).sum();
                        if is_free(row) && is_free(column) {
                            matrix[(first + row, first + column)] += self.row(index, i)[row] * along;
                        }
                    }
                }
            }
        }
        matrix
    }
}

/// Numbers of the feet of a crane in the order of its functions: their slopes along a direction, or weights of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FeetSlopes {
    /// Of `support_elongations`.
    pub elongations: Vec<f64>,
    /// Of `support_jacobians`.
    pub jacobians: Vec<f64>,
    /// Of `support_stiffnesses`.
    pub stiffnesses: Vec<f64>,
    /// Of `support_dampings`.
    pub dampings: Vec<f64>,
    /// Of `support_grips`.
    pub grips: Vec<f64>,
}

impl FeetSlopes {
    /// Zeros for a description; nothing for a crane without feet.
    #[must_use]
    pub fn zero(description: &Description) -> Self {
        let supports = if description.has_feet() { description.supports.len() } else { 0 };
        let vectors = || vec![0.0; 3 * supports];
        Self {
            elongations: vectors(),
            jacobians: vec![0.0; 3 * supports * description.coordinates.len()],
            stiffnesses: vectors(),
            dampings: vectors(),
            grips: vectors(),
        }
    }
}

/// The derivatives of gradients.
impl Feet {
    /// Adds the slopes of the generalized forces that feet add, and of the rates of a at a constant a, along a direction. `slid`: a and its change.
    pub fn add_slopes(
        &self,
        forces: &[StatefulForce],
        slopes: &FeetSlopes,
        (v, along_v): (&[f64], &[f64]),
        [slid, along_slid]: [&[f64]; 2],
        (sum, rates): (&mut [f64], &mut [f64]),
    ) {
        let [first, count] = self.base;
        let product = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(entry, x)| entry * x).sum::<f64>();
        for (index, foot) in self.all.iter().enumerate() {
            let own = self.pair(slid, index);
            let vector = |numbers: &[f64]| [numbers[3 * foot.support], numbers[3 * foot.support + 1]];
            let changed_row = |axis: usize| &slopes.jacobians[(3 * foot.support + axis) * self.n + first..][..count];
            let rate = [0, 1].map(|axis| {
                product(changed_row(axis), &v[first..first + count])
                    + product(self.row(index, axis), &along_v[first..first + count])
            });
            let (elongation, stiffness) = (vector(&slopes.elongations), vector(&slopes.stiffnesses));
            let (damping, grip) = (vector(&slopes.dampings), slopes.grips[3 * foot.support + 1]);
            let slope = |of_forces: [f64; 2], of_rates: [f64; 2]| {
                let by = foot.differentiate(own, of_forces, of_rates);
                let of_axis = |i: usize| {
                    by.elongation[i] * elongation[i]
                        + by.rate[i] * rate[i]
                        + by.stiffness[i] * stiffness[i]
                        + by.damping[i] * damping[i]
                        + by.slid[i] * along_slid[self.place(index, i)]
                };
                of_axis(0) + of_axis(1) + by.grip * grip
            };
            for (axis, unit) in [[1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
                let place = self.place(index, axis);
                let (change, force) = (slope(unit, [0.0; 2]), forces[place].force);
                for (j, sum) in sum[first..first + count].iter_mut().enumerate() {
                    *sum += self.row(index, axis)[j] * change + changed_row(axis)[j] * force;
                }
                rates[place] += slope([0.0; 2], unit);
            }
        }
    }

    /// The transpose of [`add_slopes`](Self::add_slopes): from weights of the generalized forces and of the rates of a to those of the feet's
    /// numbers, of v and of a.
    pub fn pull_back(
        &self,
        forces: &[StatefulForce],
        (generalized, of_rates): (&[f64], &[f64]),
        (v, slid): (&[f64], &[f64]),
        weights: &mut FeetSlopes,
        (of_v, of_slid): (&mut [f64], &mut [f64]),
    ) {
        let [first, count] = self.base;
        for (index, foot) in self.all.iter().enumerate() {
            let along = [0, 1].map(|axis| {
                self.row(index, axis).iter().zip(&generalized[first..]).map(|(entry, weight)| entry * weight).sum()
            });
            let by = foot.differentiate(self.pair(slid, index), along, self.pair(of_rates, index));
            for axis in 0..2 {
                let place = 3 * foot.support + axis;
                weights.elongations[place] += by.elongation[axis];
                weights.stiffnesses[place] += by.stiffness[axis];
                weights.dampings[place] += by.damping[axis];
                of_slid[self.place(index, axis)] += by.slid[axis];
                let row = &mut weights.jacobians[place * self.n + first..][..count];
                for (j, weight) in row.iter_mut().enumerate() {
                    *weight +=
                        by.rate[axis] * v[first + j] + forces[self.place(index, axis)].force * generalized[first + j];
                    of_v[first + j] += by.rate[axis] * self.row(index, axis)[j];
                }
            }
            weights.grips[3 * foot.support + 1] += by.grip;
        }
    }
}

/// What the feet of a crane at a state contribute besides generated functions, which do not know where they have slid.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Slid {
    /// a of all feet, m, in the order of their states.
    pub places: Vec<f64>,
    /// Index of each foot among the supports, and the forces along x and y, N, that it adds.
    pub forces: Vec<(usize, [f64; 2])>,
    /// Energy that their springs store in addition, J.
    pub energy: f64,
}

impl Slid {
    /// At a state with the states of its forces; as if nothing had slid without them.
    pub fn at(crane: &dyn Functions, moment: &StateAt<'_>) -> Self {
        let description = crane.description();
        let mut feet = Feet::new(description);
        let count = 2 * feet.all.len();
        let first = Hydraulics::new(description).len();
        if moment.x.len() != first + count + description.bristles.len() {
            return Self { places: vec![0.0; count], ..Self::default() };
        }
        let own = moment.with_states(first..first + count);
        let (mut rates, mut rows) = (vec![0.0; count], feet.rows());
        let mut forces = vec![StatefulForce::default(); count];
        feet.evaluate(crane, &own, Evaluated { rates: &mut rates, forces: &mut forces, rows: &mut rows }, None);
        let pushes: Vec<f64> = forces.iter().map(|force| force.force).collect();
        let of_foot = |(index, foot): (usize, &Foot)| (foot.support, feet.pair(&pushes, index));
        Self {
            places: own.x.to_vec(),
            forces: feet.all.iter().enumerate().map(of_foot).collect(),
            energy: feet.energy_and_rate(own.x, &rates)[0],
        }
    }
}

/// Name of the column of results with a of a foot along x, 0, or y, 1.
pub(crate) fn column(foot: &str, axis: usize) -> String {
    [foot, ColumnKind::Slid.endings(false)[axis]].concat()
}

/// Names of the columns of several feet in the order of their states, which is that of a fleet, too: all along x, then all along y.
pub(crate) fn columns<N: AsRef<str>>(feet: impl Iterator<Item = N> + Clone) -> impl Iterator<Item = String> {
    (0..2).flat_map(move |axis| feet.clone().map(move |foot| column(foot.as_ref(), axis)))
}

/// The anchors of feet: a of each, along x and y.
impl StatefulForces for Feet {
    fn states(&self) -> Vec<ForceState> {
        let state = |name| ForceState { name, scale: SCALE, range: None };
        columns(self.names.iter()).map(state).collect()
    }

    fn rows(&self) -> Vec<ForceRow> {
        let [first, count] = self.base;
        (0..2 * self.all.len()).map(|_| ForceRow { first, entries: vec![0.0; count] }).collect()
    }

    fn is_local(&self) -> bool {
        false
    }

    fn supplies_power(&self) -> bool {
        false
    }

    fn forget(&mut self) {
        self.has_constants = false;
    }

    /// Places from which no foot slides at rest.
    fn holding(&mut self, crane: &dyn Functions, _: f64, q: &[f64]) -> Vec<f64> {
        self.forget();
        self.evaluate_at(crane, q, &vec![0.0; q.len()]);
        let slid = |foot: &Foot, axis: usize| {
            let share = foot.lateral([0.0; 2]).share;
            if share < 1.0 { (1.0 - share) * foot.elongation[axis] } else { 0.0 }
        };
        (0..2).flat_map(|axis| self.all.iter().map(move |foot| slid(foot, axis))).collect()
    }

    fn evaluate(
        &mut self,
        crane: &dyn Functions,
        moment: &StateAt<'_>,
        Evaluated { rates, forces, rows }: Evaluated<'_>,
        mut by_states: Option<DMatrixViewMut<'_, f64>>,
    ) {
        if self.is_empty() {
            return;
        }
        if self.all_stick(crane, moment) {
            self.stick = true;
            for (place, force) in forces.iter_mut().enumerate() {
                *force = StatefulForce { first: place, count: 1, is_of_foot: true, ..StatefulForce::default() };
            }
            rates.fill(0.0);
            return;
        }
        self.stick = false;
        self.evaluate_rest(crane, moment.q, moment.v);
        for (index, foot) in self.all.iter().enumerate() {
            let slid = self.pair(moment.x, index);
            // In generated functions it has not slid.
            let (lateral, of_functions) = (foot.lateral(slid), foot.lateral([0.0; 2]));
            for i in 0..2 {
                let [s, d] = [foot.stiffness[i], foot.damping[i]];
                let place = self.place(index, i);
                let pull = |lateral: &Lateral| lateral.share * lateral.trial[i];
                // Of the functions, the matrices of a step contain g instead of the slope.
                let slope = of_functions.share - lateral.slope(i, i);
                // ∂ȧ_j/∂F_i
                let of_rates = [0, 1].map(|j| {
                    let change = f64::from(u8::from(i == j)) - lateral.slope(j, i);
                    if lateral.slides() { change / foot.following(j) } else { 0.0 }
                });
                forces[place] = StatefulForce {
                    first: place,
                    count: 1,
                    force: pull(&of_functions) - pull(&lateral),
                    by_length: slope * s,
                    by_speed: slope * d,
                    // What an axis has to do with the other one, a step does not need.
                    by_states: [lateral.slope(i, i) * s, 0.0, 0.0],
                    rates_by_length: [of_rates[i] * s, 0.0, 0.0],
                    rates_by_speed: [of_rates[i] * d, 0.0, 0.0],
                    speed: foot.rate[i],
                    is_of_foot: true,
                    ..StatefulForce::default()
                };
                rates[place] = (1.0 - lateral.share) * lateral.trial[i] / foot.following(i);
                rows[place].entries.copy_from_slice(self.row(index, i));
                if let Some(matrix) = &mut by_states {
                    for (j, of_rate) in of_rates.into_iter().enumerate() {
                        matrix[(self.place(index, j), place)] = -of_rate * s;
                    }
                }
            }
        }
    }

    /// Energy of the lateral springs of feet that have slid, minus that in the functions of the crane: `½ Σ s ((e − a)² − e²)`, without e² in the air.
    fn energy_and_rate(&self, x: &[f64], rates: &[f64]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        if self.stick {
            return sums;
        }
        for (index, foot) in self.all.iter().enumerate() {
            let [slid, sliding] = [x, rates].map(|states| self.pair(states, index));
            for i in 0..2 {
                let (e, rate, s) = (foot.elongation[i], foot.rate[i], foot.stiffness[i]);
                let (held, of_functions) = (e - slid[i], if foot.elongation[2] > 0.0 { 0.0 } else { e });
                sums[0] += 0.5 * s * (held * held - of_functions * of_functions);
                sums[1] += s * (held * (rate - sliding[i]) - of_functions * rate);
            }
        }
        sums
    }

    /// Appends whether each foot slides.
    fn branches(&mut self, crane: &dyn Functions, moment: &StateAt<'_>, out: &mut Vec<bool>) {
        if self.is_empty() || self.all_stick(crane, moment) {
            out.extend(self.all.iter().map(|_| false));
            return;
        }
        self.evaluate_rest(crane, moment.q, moment.v);
        let slides = |(index, foot): (usize, &Foot)| foot.lateral(self.pair(moment.x, index)).slides();
        out.extend(self.all.iter().enumerate().map(slides));
    }
}
