//! A linearly implicit method for stiff motions: a W-method of order 4 with an embedded formula of order 3.
//!
//! For `ẏ = f(t, y)` and **any** matrix J a step from y to `y + Σ mᵢ uᵢ` solves, stage by stage,
//!
//! ```text
//! (I/(hγ) − J) uᵢ = f(t + αᵢh, y + Σⱼ aᵢⱼ uⱼ) + Σⱼ (cᵢⱼ/h) uⱼ      j < i
//! ```
//!
//! The order does not depend on J: an inexact Jacobian costs accuracy only in the stiff parts. It does not depend on ∂f/∂t either, which is
//! neglected: driven coordinates are relative to their drives' motions, so that no stiff spring is forced (`references`). Six stages, γ = 1/4, order 4,
//! R(∞) = 0, and with `J = ∂f/∂y` A(α)-stable with α = 89.8°: only modes with less than 0.35 % of critical damping can grow, by
//! less than 0.65 % per step, in steps that do not resolve them. Bristles of joints that stick have the steeper of their slopes on either
//! side of rest in J: with the slope of one side the joint would creep.
//! A. Rahunanthan, D. Stanescu, High-order W-methods, J. Comput. Appl. Math. 233 (2010) 1798; the form
//! of the stages: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.7.
//!
//! The published method has no embedded formula. Its conditions up to order 3 for arbitrary J are of rank 5 for six weights, so
//! there is a line of weights of order 3: m + s n. The one without the last stage is used.
//!
//! On the second-order form `A q̈ = e + f`, J contains only stiffness and damping of springs and dampers,
//! `J = [[0, I], [−A⁻¹K̂, −A⁻¹D̂]]`: gravity, velocity forces and the change of A are left out. A stage then needs one system
//! of half the size, which the O(n) recursion solves (`system.rs`).

use super::{
    EffortAccuracy, Method, Settings, Statistics, Steered, Stepper, Stopped,
    adaptive::{Adaptive, Formula},
    equations::Equations,
    motion::add_all,
    norm::Norm,
    references::References,
    state::{NotFinite, State},
    step::Step,
    stepper::{Ahead, forward},
    system::System,
    typed,
};
use crate::memory::Visit;
use crate::{
    CraneModel, Part,
    dyn_crane::{Functions, Instance},
};

/// Number of stages, and of evaluations per step: the slope at its end is the first of the next step.
pub const STAGES: usize = 6;
/// Coefficients of the numerator of R(z); the denominator is `(1 − z/4)⁶`.
pub const NUMERATOR: [f64; 6] = [1.0, -0.5, -0.0625, 1.0 / 24.0, 0.006_510_416_666_666_667, -0.002_430_737_286_220_53];
/// Coefficients of `(1 − z/4)⁶`.
pub const DENOMINATOR: [f64; 7] = [1.0, -1.5, 0.9375, -0.3125, 0.058_593_75, -0.005_859_375, 0.000_244_140_625];

const GAMMA: f64 = 0.25;
/// aᵢⱼ.
pub const A: [&[f64]; STAGES] = [
    &[],
    &[0.581_238_340_711_500_8],
    &[0.903_962_441_371_467, 1.861_519_155_534_501],
    &[2.076_579_719_675, 0.188_425_538_141_479_6, 1.870_158_967_491_032],
    &[4.435_550_638_484_312, 5.457_181_798_610_189, 4.616_350_788_068_93, 3.118_111_952_402_361],
    &[
        10.791_701_698_483_26,
        -10.056_915_225_841_31,
        14.995_644_854_284_19,
        5.274_339_954_390_943,
        1.429_730_871_261_19,
    ],
];
/// cᵢⱼ.
pub(super) const C: [&[f64]; STAGES] = [
    &[],
    &[-2.661_294_105_131_369],
    &[-3.128_450_202_373_838, 0.0],
    &[-6.920_335_474_535_658, -1.202_675_288_266_817, -9.733_561_811_413_62],
    &[-28.095_306_291_026_95, 20.371_262_954_793_77, -41.043_752_753_028_69, -19.663_731_756_208_95],
    &[9.799_818_678_097_4, 11.935_792_886_603_18, 3.673_874_929_013_201, 14.807_828_541_095_5, 0.831_858_399_869_068],
];
/// mᵢ.
pub(super) const WEIGHTS: [f64; STAGES] = [
    6.456_217_074_653_235,
    -4.853_141_317_768_053,
    9.765_318_334_069_26,
    2.081_084_177_278_723,
    0.660_393_686_635_241_7,
    0.6,
];
/// Weights of the difference from the embedded formula.
const ERROR: [f64; STAGES] = [
    0.186_221_371_705_313_72,
    0.802_949_310_218_888_9,
    1.183_253_506_170_94,
    0.442_403_365_289_138_5,
    0.785_172_446_615_594_3,
    0.6,
];
/// αᵢ.
const NODES: [f64; STAGES] = [
    0.0,
    0.145_309_585_177_875_2,
    0.381_742_277_025_673_8,
    0.636_781_370_437_459_9,
    0.756_074_449_632_356_1,
    0.927_104_723_987_567,
];

/// A step from `t` to `t + h`: the state there, and the difference from the embedded formula.
///
/// # Errors
/// An acceleration is not finite.
pub fn step<const N: usize, C: CraneModel<N>>(
    crane: &C,
    t: f64,
    h: f64,
    state: &State<N>,
) -> Result<(State<N>, State<N>), NotFinite> {
    const { Part::Dynamics.require(C::PARTS) }
    let crane = Instance::<N, _>(crane.clone());
    let references = References::new(&crane);
    let mut equations = Equations::new(&crane, references);
    typed::step(&mut equations, t, h, state, &mut Stages::new(&crane, 2 * N))
}

/// A motion integrated by the method.
pub struct Rosenbrock<'a>(Adaptive<'a, Stages<'a>>);

impl<'a> Rosenbrock<'a> {
    /// Creates the motion, with the tolerance of the settings.
    pub fn new(crane: &'a dyn Functions, settings: &Settings) -> Self {
        let equations = Equations::new(crane, References::new(crane));
        let norm = Norm::with_efforts(crane, &equations.references, settings.tolerance);
        Self(Adaptive::new(Stages::new(crane, equations.len()), equations, norm))
    }
}

forward!(Rosenbrock);

/// The formula, with storage for its stages.
pub(super) struct Stages<'a> {
    system: System<'a>,
    /// uᵢ.
    u: [Vec<f64>; STAGES],
    /// Where the rates of each stage are evaluated.
    places: [Vec<f64>; STAGES],
    rhs: Vec<f64>,
}

impl<'a> Stages<'a> {
    /// Storage for motions of this many numbers.
    pub fn new(crane: &'a dyn Functions, len: usize) -> Self {
        let zeros = || vec![0.0; len];
        let [u, places] = std::array::from_fn(|_| std::array::from_fn(|_| zeros()));
        Self { system: System::new(crane).with_steeper_bristles(), u, places, rhs: zeros() }
    }

    /// Where the rates of a stage of the last step were evaluated: after the start, of a step of length `h`, s.
    pub fn place(&self, stage: usize, h: f64) -> (f64, &[f64]) {
        (NODES[stage] * h, &self.places[stage])
    }

    /// uᵢ of a linear motion that follows this one, with the matrix of the last step, of length `h`, s: from the rates at its place and uⱼ of the
    /// stages before.
    pub fn follow(&mut self, stage: usize, h: f64, rates: &[f64], u: &mut [Vec<f64>]) {
        let (before, rest) = u.split_at_mut(stage);
        self.rhs.copy_from_slice(rates);
        add_all(&mut self.rhs, h.recip(), C[stage], before.iter());
        self.system.solve(&self.rhs, &mut rest[0]);
    }

    /// The transpose of a stage's solution, with the matrix of the last step: from the weights of uᵢ to those of its right-hand side.
    pub fn pull_back(&mut self, weights: &[f64], of_rates: &mut [f64]) {
        self.system.pull_back(weights, of_rates);
    }
}

/// The end of a step from uᵢ, and the places of stages from those before: adds `Σⱼ aᵢⱼ uⱼ`, or `Σ mᵢ uᵢ` if `stage` is the number of stages.
pub(super) fn add_stages(stage: usize, u: &[Vec<f64>], place: &mut [f64]) {
    let weights = A.get(stage).copied().unwrap_or(&WEIGHTS);
    add_all(place, 1.0, weights, u.iter());
}

/// Adds the difference from the embedded formula, times a factor, of a step with these uᵢ.
pub(super) fn add_error(factor: f64, u: &[Vec<f64>], error: &mut [f64]) {
    add_all(error, factor, &ERROR, u.iter());
}

impl Formula for Stages<'_> {
    const METHOD: Method = Method::Rosenbrock;

    fn attempt(&mut self, equations: &mut Equations<'_>, step: &mut Step) -> Result<(), NotFinite> {
        let h = step.length;
        self.system.factorise(&equations.state(step.t, &step.start), h * GAMMA);
        self.system.solve(&step.slopes[0], &mut self.u[0]);
        self.places[0].copy_from_slice(&step.start);
        for i in 1..STAGES {
            let place = &mut self.places[i];
            place.copy_from_slice(&step.start);
            add_all(place, 1.0, A[i], self.u.iter());
            equations.slope(step.t + NODES[i] * h, place, &mut self.rhs)?;
            add_all(&mut self.rhs, h.recip(), C[i], self.u.iter());
            self.system.solve(&self.rhs, &mut self.u[i]);
        }
        step.end.copy_from_slice(&step.start);
        add_all(&mut step.end, 1.0, &WEIGHTS, self.u.iter());
        step.error.fill(0.0);
        add_all(&mut step.error, 1.0, &ERROR, self.u.iter());
        equations.slope(step.reached(), &step.end, &mut step.slopes[1])?;
        // Where a stiff law starts or stops acting, J is that of one side only: the method and the embedded formula damp away the same
        // terms, and their difference does not show the error. The rates are then compared with those of the trapezoidal rule.
        if self.system.switched(&equations.state(step.reached(), &step.end)) {
            let (n, [before, after]) = (equations.n, &step.slopes);
            for i in n..2 * n {
                let change = step.end[i] - step.start[i];
                let error = change - 0.5 * h * (before[i] + after[i]);
                step.error[i] = step.error[i].abs().max(error.abs());
            }
        }
        Ok(())
    }

    fn factorisations(&self) -> usize {
        self.system.factorisations
    }

    fn forget(&mut self) {
        self.system.forget();
    }

    fn visit(&mut self, visit: Visit<'_>) {
        self.system.visit(visit);
    }
}
