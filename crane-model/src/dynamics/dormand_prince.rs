//! An adaptive explicit pair of orders 5 and 4 with dense output.
//!
//! ```text
//!   0   |
//!  1/5  | 1/5
//!  3/10 | 3/40        9/40
//!  4/5  | 44/45       −56/15       32/9
//!  8/9  | 19372/6561  −25360/2187  64448/6561  −212/729
//!   1   | 9017/3168   −355/33      46732/5247  49/176    −5103/18656
//!   1   | 35/384      0            500/1113    125/192   −2187/6784     11/84
//! ------+-----------------------------------------------------------------------------
//!   y   | 35/384      0            500/1113    125/192   −2187/6784     11/84     0
//!  y−ŷ  | 71/57600    0            −71/16695   71/1920   −17253/339200  22/525   −1/40
//! ```
//!
//! J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19; the interpolation of order 4: E. Hairer, S. P. Nørsett,
//! G. Wanner, Solving Ordinary Differential Equations I, section II.6. The last stage is the first of the next step. On the
//! second-order form the stages of q are the rates of the stages, so that no slope of q is computed.

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
    typed,
};
use crate::{
    CraneModel, Part,
    dyn_crane::{Functions, Instance},
};

/// Stages.
const STAGES: usize = 7;
/// Coefficients of R(z).
pub const STABILITY: [f64; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 600.0];

const NODES: [f64; STAGES] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const A: [&[f64]; STAGES] = [
    &[],
    &[0.2],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19_372.0 / 6_561.0, -25_360.0 / 2_187.0, 64_448.0 / 6_561.0, -212.0 / 729.0],
    &[9_017.0 / 3_168.0, -355.0 / 33.0, 46_732.0 / 5_247.0, 49.0 / 176.0, -5_103.0 / 18_656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1_113.0, 125.0 / 192.0, -2_187.0 / 6_784.0, 11.0 / 84.0],
];
const ERROR: [f64; STAGES] =
    [71.0 / 57_600.0, 0.0, -71.0 / 16_695.0, 71.0 / 1_920.0, -17_253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
/// Weights of the term that the interpolation of order 4 adds to Hermite's cubic.
const DENSE: [f64; STAGES] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
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
    let mut equations = Equations::new(&crane, References::rigid(&crane));
    typed::step(&mut equations, t, h, state, &mut Tableau::new(2 * N))
}

/// A motion integrated by the pair.
pub struct DormandPrince<'a>(Adaptive<'a, Tableau>);

impl<'a> DormandPrince<'a> {
    /// Creates the motion, with the tolerance of the settings.
    pub fn new(crane: &'a dyn Functions, settings: &Settings) -> Self {
        let equations = Equations::new(crane, References::rigid(crane));
        let norm = Norm::with_states(crane, settings.tolerance);
        Self(Adaptive::new(Tableau::new(equations.len()), equations, norm))
    }
}

forward!(DormandPrince);

/// The formula, with storage for its stages.
pub(super) struct Tableau {
    slopes: [Vec<f64>; STAGES],
}

impl Tableau {
    /// Storage for motions of this many numbers.
    pub fn new(len: usize) -> Self {
        Self { slopes: std::array::from_fn(|_| vec![0.0; len]) }
    }
}

impl Formula for Tableau {
    const METHOD: Method = Method::DormandPrince;

    fn attempt(&mut self, equations: &mut Equations<'_>, step: &mut Step) -> Result<(), NotFinite> {
        let Self { slopes } = self;
        let h = step.length;
        slopes[0].copy_from_slice(&step.slopes[0]);
        for i in 1..STAGES {
            step.end.copy_from_slice(&step.start);
            add_all(&mut step.end, h, A[i], slopes.iter());
            equations.slope(step.t + NODES[i] * h, &step.end, &mut slopes[i])?;
        }
        for (out, weights) in [(&mut step.error, &ERROR), (&mut step.quartic_term, &DENSE)] {
            out.fill(0.0);
            add_all(out, h, weights, slopes.iter());
        }
        step.slopes[1].copy_from_slice(&slopes[STAGES - 1]);
        Ok(())
    }

    fn factorisations(&self) -> usize {
        0
    }
}
