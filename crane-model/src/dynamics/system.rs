//! The linear system of an implicit step, of half the size.
//!
//! On the second-order form `A q̈ = e + f`, the Jacobian contains only stiffness and damping of springs and dampers,
//! `J = [[0, I], [−A⁻¹K̂, −A⁻¹D̂]]`: gravity, velocity forces and the change of A are left out. Then
//! `(I/c − J) u = (P, G)` with `u = (p, w)` reduces to one system with as many unknowns as coordinates, which the
//! O(n) recursion solves:
//!
//! ```text
//! (A + cD̂ + c²K̂) z = −c² ((D̂ + cK̂) G + K̂ P),     w = c G + z,     p = c (w + P)
//! ```
//!
//! The contribution of connectors, `Σ Jᵀ (c d + c² k) J`, has low rank: [`ConnectorUpdate`]. So has that of forces with
//! states of their own, which are eliminated: [`ForceStateUpdate`]. Loop joints are connectors without compliance: [`Loops`].

use std::ops::Range;

use super::{
    connector_update::{ConnectorUpdate, differs},
    force_state_update::ForceStateUpdate,
};
use crate::memory::{Visit, visit_count};
use crate::{
    Description, StateAt,
    dyn_crane::{DynSystem, Functions},
    loop_joints::Loops,
};

/// `A + cD̂ + c²K̂` of a crane, factorised.
pub(super) struct System<'a> {
    crane: &'a dyn Functions,
    factors: Box<dyn DynSystem + 'a>,
    /// Stiffness and damping on single coordinates: of linear springs and dampers, and with those of nonlinear laws added.
    linear: Vec<[f64; 2]>,
    joints: Vec<[f64; 2]>,
    /// The latter one by one.
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    /// Those of nonlinear laws, at the state of the factorisation and at a state compared with it.
    nonlinear: [Vec<[f64; 2]>; 2],
    base: Base,
    /// Whether some law acts at some states and not at others.
    switches: bool,
    /// Stiffness and damping of connectors.
    connectors: ConnectorUpdate,
    /// Forces with states.
    force_states: ForceStateUpdate,
    /// Loop joints: rows J of the bordered system, without compliance.
    loops: Loops,
    /// c, s.
    c: f64,
    added_inertia: Vec<f64>,
    right: Vec<f64>,
    solution: Vec<f64>,
    /// No accelerations.
    none: Vec<f64>,
    of_loops: Vec<f64>,
    /// Factorisations so far.
    pub factorisations: usize,
}

impl<'a> System<'a> {
    /// Storage for the systems of a crane.
    pub fn new(crane: &'a dyn Functions) -> Self {
        let n = crane.size();
        let mut linear = vec![[0.0; 2]; n];
        crane.joint_stiffness_and_damping(&mut linear);
        let zeros = || vec![0.0; n];
        let loops = Loops::new(crane);
        let Description { stops, frictions, supports, connectors, .. } = crane.description();
        let one_sided = supports.iter().any(|support| support.one_sided);
        let ropes_or_pins = connectors.iter().any(|connector| connector.indicator().is_some() || connector.is_pin());
        Self {
            crane,
            switches: one_sided || ropes_or_pins || !stops.is_empty() || !frictions.is_empty(),
            factors: crane.system(),
            joints: linear.clone(),
            linear,
            stiffness: zeros(),
            damping: zeros(),
            nonlinear: [vec![[0.0; 2]; n], vec![[0.0; 2]; n]],
            base: Base::new(crane),
            connectors: ConnectorUpdate::new(crane),
            force_states: ForceStateUpdate::new(crane),
            of_loops: vec![0.0; loops.multipliers().len()],
            loops,
            c: f64::NAN,
            added_inertia: zeros(),
            right: zeros(),
            solution: zeros(),
            none: zeros(),
            factorisations: 0,
        }
    }

    /// Takes the steeper slopes of bristles on either side of rest, for methods that do not iterate.
    pub fn with_steeper_bristles(mut self) -> Self {
        self.force_states.steeper_bristles = true;
        self
    }

    /// Motions and commands change: what is kept of the last time does not hold any more.
    pub fn forget(&mut self) {
        self.force_states.forget();
    }

    /// Visits what further systems depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        self.forget();
        self.loops.visit(visit);
        visit_count(&mut self.factorisations, visit);
    }

    /// Factorises at a state of the crane and its forces.
    pub fn factorise(&mut self, state: &StateAt<'_>, c: f64) {
        let &StateAt { t, q, v, .. } = state;
        self.c = c;
        let [nonlinear, _] = &mut self.nonlinear;
        self.crane.nonlinear_stiffness_and_damping(t, q, v, nonlinear);
        for ((joint, linear), nonlinear) in self.joints.iter_mut().zip(&self.linear).zip(nonlinear) {
            *joint = [linear[0] + nonlinear[0], linear[1] + nonlinear[1]];
        }
        self.force_states.evaluate(self.crane, state, c, &mut self.joints);
        let [base, _] = &mut self.base.matrices;
        base.evaluate(self.crane, q, v);
        for (i, [stiffness, damping]) in self.joints.iter().enumerate() {
            (self.stiffness[i], self.damping[i]) = (*stiffness, *damping);
            self.added_inertia[i] = damping * c + stiffness * (c * c);
        }
        self.factors.factorise(q, &self.added_inertia, self.base.added_inertia(c));
        self.connectors.factorise(self.crane, state, c, self.factors.as_mut());
        let Self { factors, connectors, .. } = self;
        self.force_states.factorise(c, &mut |right, solution| {
            factors.solve(right, solution);
            connectors.correct(solution);
        });
        self.close(q, v);
        self.factorisations += 1;
    }

    /// Adds the loop joints: increments of the rates obey `J z = 0` besides the equations of the open chain, so that the system is bordered by J.
    fn close(&mut self, q: &[f64], v: &[f64]) {
        let Self { crane, factors, connectors, force_states, loops, .. } = self;
        if loops.is_empty() {
            return;
        }
        loops.evaluate(*crane, q, v);
        loops.choose();
        loops.factorise(&mut |right, solution| {
            factors.solve(right, solution);
            connectors.correct(solution);
            force_states.correct(solution);
        });
    }

    /// Whether at a state some law acts that did not act where the system was factorised, or vice versa: a stiffness or a damping
    /// is less than half or more than twice what it was.
    pub fn switched(&mut self, state: &StateAt<'_>) -> bool {
        if !self.switches {
            return false;
        }
        let [before, now] = &mut self.nonlinear;
        self.crane.nonlinear_stiffness_and_damping(state.t, state.q, state.v, now);
        let mut of_joints = before.as_flattened().iter().zip(now.as_flattened());
        of_joints.any(|(before, now)| differs(*before, *now))
            || self.base.switched(self.crane, state.q, state.v)
            || self.connectors.switched(self.crane, state)
    }

    /// u for a right-hand side `(P, G, R)`.
    pub fn solve(&mut self, rhs: &[f64], u: &mut [f64]) {
        let (p, rest) = rhs.split_at(self.joints.len());
        let (g, r) = rest.split_at(self.joints.len());
        self.gather((g, p), r);
        self.eliminate();
        self.write((g, p), r, u);
    }

    /// u for a right-hand side `(P, A G, R)` with forces instead of accelerations, of a crane without loops:
    ///
    /// ```text
    /// (A + cD̂ + c²K̂) w = c A G − c² K̂ P,     p = c (w + P)
    /// ```
    pub fn solve_forces(&mut self, rhs: &[f64], u: &mut [f64]) {
        let (p, rest) = rhs.split_at(self.joints.len());
        let (forces, r) = rest.split_at(self.joints.len());
        let none = std::mem::take(&mut self.none);
        self.gather((&none, p), r);
        for (right, force) in self.right.iter_mut().zip(forces) {
            *right += self.c * force;
        }
        self.eliminate();
        self.write((&none, p), r, u);
        self.none = none;
    }

    /// The right-hand side `−c² ((D̂ + cK̂) G + K̂ P)`, with what forces with states add.
    fn gather(&mut self, (g, p): (&[f64], &[f64]), r: &[f64]) {
        let (c, n) = (self.c, self.joints.len());
        // D̂ G + K̂ (c G + P), first for single coordinates, then for the base.
        let coordinates = self.stiffness.iter().zip(&self.damping).zip(g.iter().zip(p));
        for (right, ((stiffness, damping), (g, p))) in self.right.iter_mut().zip(coordinates) {
            *right = damping * g + stiffness * (c * g + p);
        }
        self.base.each(n, |[row, column], [stiffness, damping]| {
            let (g, p) = (&g[column.clone()], &p[column]);
            let numbers = stiffness.iter().zip(damping).zip(g.iter().zip(p));
            for (right, ((stiffness, damping), (g, p))) in self.right[row].iter_mut().zip(numbers) {
                *right += damping * g + stiffness * (c * g + p);
            }
        });
        self.connectors.add_to((g, p), c, &mut self.right);
        self.force_states.add_to((g, p), r, c, &mut self.right);
        for right in &mut self.right {
            *right *= -c * c;
        }
    }

    /// z.
    fn eliminate(&mut self) {
        self.factors.solve(&self.right, &mut self.solution);
        self.connectors.correct(&mut self.solution);
        self.force_states.correct(&mut self.solution);
        self.loops.correct(&mut self.solution, false);
    }

    /// `w = c G + z`, `p = c (w + P)`, and the increments of the states of forces.
    fn write(&self, (g, p): (&[f64], &[f64]), r: &[f64], u: &mut [f64]) {
        let (c, n) = (self.c, self.joints.len());
        let (of_q, rest) = u.split_at_mut(n);
        let (of_v, of_x) = rest.split_at_mut(n);
        let of_coordinates = of_q.iter_mut().zip(&mut *of_v);
        for ((of_q, of_v), ((g, p), z)) in of_coordinates.zip(g.iter().zip(p).zip(&self.solution)) {
            *of_v = c * g + z;
            *of_q = c * (*of_v + p);
        }
        self.force_states.states((of_q, of_v), r, of_x);
    }

    /// The weights of a right-hand side, given those of u: the solution with the transposed matrix.
    pub fn pull_back(&mut self, weights: &[f64], rhs: &mut [f64]) {
        let (c, n) = (self.c, self.joints.len());
        let (p, rest) = rhs.split_at_mut(n);
        let (g, r) = rest.split_at_mut(n);
        p.copy_from_slice(&weights[..n]);
        g.copy_from_slice(&weights[n..2 * n]);
        self.force_states.pull_back_states(&weights[2 * n..], (p, g), r);
        for ((p, g), z) in p.iter_mut().zip(g).zip(&mut self.right) {
            *p *= c;
            *z = *g + *p;
            *g = c * *z;
        }
        self.loops.pull_back(&mut self.right, &mut self.of_loops);
        self.force_states.pull_back_correction(&mut self.right);
        self.factors.solve(&self.right, &mut self.solution);
        self.connectors.correct(&mut self.solution);
        for weight in &mut self.solution {
            *weight *= -c * c;
        }
        let (p, rest) = rhs.split_at_mut(n);
        let (g, r) = rest.split_at_mut(n);
        for (i, [stiffness, damping]) in self.joints.iter().enumerate() {
            g[i] += (damping + stiffness * c) * self.solution[i];
            p[i] += stiffness * self.solution[i];
        }
        self.base.each(n, |[row, column], [stiffness, damping]| {
            let (g, p) = (&mut g[column.clone()], &mut p[column]);
            let numbers = stiffness.iter().zip(damping).zip(&self.solution[row]);
            for ((g, p), ((stiffness, damping), weight)) in g.iter_mut().zip(p).zip(numbers) {
                *g += (damping + stiffness * c) * weight;
                *p += stiffness * weight;
            }
        });
        self.connectors.pull_back(&self.solution, c, (g, p));
        self.force_states.pull_back_right(&self.solution, c, (g, p), r);
    }
}

/// Stiffness and damping over the base's coordinates, of each crane of a fleet.
struct Base {
    /// Number of cranes.
    cranes: usize,
    /// At the state of the factorisation and at a state compared with it.
    matrices: [BaseMatrices; 2],
    added_inertia: Vec<f64>,
}

/// Matrices of all cranes, column by column: the same number of each crane next to each other.
#[derive(Clone)]
struct BaseMatrices {
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

impl BaseMatrices {
    fn evaluate(&mut self, crane: &dyn Functions, q: &[f64], v: &[f64]) {
        crane.base_stiffness(q, v, &mut self.stiffness);
        crane.base_damping(q, v, &mut self.damping);
    }
}

impl Base {
    /// Coordinates of a base.
    const SIZE: usize = 6;

    fn new(crane: &dyn Functions) -> Self {
        let cranes = crane.cranes();
        let zeros = || vec![0.0; Self::SIZE * Self::SIZE * cranes];
        let matrices = BaseMatrices { stiffness: zeros(), damping: zeros() };
        Self { cranes, matrices: [matrices.clone(), matrices], added_inertia: zeros() }
    }

    /// `c D̂ + c² K̂`.
    fn added_inertia(&mut self, c: f64) -> &[f64] {
        let [BaseMatrices { stiffness, damping }, _] = &self.matrices;
        for ((added_inertia, stiffness), damping) in self.added_inertia.iter_mut().zip(stiffness).zip(damping) {
            *added_inertia = damping * c + stiffness * (c * c);
        }
        &self.added_inertia
    }

    /// Gives `take` the rows and columns among `n` coordinates, one for each crane, with the stiffness and the damping there.
    #[inline]
    fn each(&self, n: usize, mut take: impl FnMut([Range<usize>; 2], [&[f64]; 2])) {
        let cranes = self.cranes;
        let size = Self::SIZE.min(n / cranes);
        let [BaseMatrices { stiffness, damping }, _] = &self.matrices;
        for column in 0..size {
            for row in 0..size {
                let [place, row, column] =
                    [Self::SIZE * column + row, row, column].map(|index| index * cranes..(index + 1) * cranes);
                take([row, column], [&stiffness[place.clone()], &damping[place]]);
            }
        }
    }

    /// Whether a number of a diagonal at a state [differs] from that where the system was factorised.
    fn switched(&mut self, crane: &dyn Functions, q: &[f64], v: &[f64]) -> bool {
        let [before, now] = &mut self.matrices;
        now.evaluate(crane, q, v);
        let diagonal = |numbers: &[f64], crane: usize| -> [f64; Self::SIZE] {
            std::array::from_fn(|i| numbers[(Self::SIZE + 1) * i * self.cranes + crane])
        };
        let differ = |before: &[f64], now: &[f64]| {
            (0..self.cranes).any(|crane| {
                let pairs = diagonal(before, crane).into_iter().zip(diagonal(now, crane));
                pairs.into_iter().any(|(before, now)| differs(before, now))
            })
        };
        differ(&before.stiffness, &now.stiffness) || differ(&before.damping, &now.damping)
    }
}
