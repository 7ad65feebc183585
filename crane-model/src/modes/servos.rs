//! Servos about a pose at rest: whether the loop of crane, oil, valve and servo is stable, and with which gains it would be.
//!
//! A shut valve has no slope: nothing flows until its spool leaves the overlap, and then a different amount in each direction. So the valve
//! is linearised where it has opened slightly, with the mean of the slopes in both directions, which is what an oscillation about the shut
//! valve meets. A valve that opens slightly now and then leaves neither side full, which determines the pressures: `p + p′ = p_s + p_T`, with
//! the tank's pressure `p_T`. With leakage past the piston the spool is open at rest, and its own slope counts.

use super::{DampedMode, NoModes, SmallMotions, StateSpace, grows, held::add_cylinders, verdict::GROWTH};
use crate::{
    StateAt,
    dyn_crane::DynCrane,
    force_states::ForceStates,
    hydraulics::{Servo, servos},
};

/// Relative accuracy of the largest stable gain.
const ACCURATE: f64 = 1e-3;
/// Smallest gain that is tried, as a fraction of the servo's own.
const LEAST: f64 = 1e-6;

/// How much faster than without servos a crane drifts that a servo drives away.
const FASTER: f64 = 1.5;

/// A servo whose loop with the crane is unstable about a pose at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct UnstableServo {
    /// Index of its cylinder.
    pub cylinder: usize,
    /// The motion that grows.
    pub mode: DampedMode,
    /// Gain below which the loop is stable, 1/m.
    pub gain: f64,
}

/// Small motions about a pose at rest with the oil of its cylinders and with their servos, valves slightly open.
///
/// # Errors
/// The mass matrix is not positive definite.
pub fn with_servos(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Result<StateSpace, NoModes> {
    let mut forces = ForceStates::of_small_motions(crane.description());
    let mut motions = SmallMotions::about_pose(crane, q);
    add_cylinders(crane, q, &mut motions, |_, _| 0.0);
    let motions = motions.with_closed_loops(crane, t, q);
    let v = vec![0.0; q.len()];
    let mut sides = forces.slightly_open(crane, t, q).into_iter().map(|x| {
        let moment = StateAt { t, q, v: &v, x: &x };
        StateSpace::at(crane, &moment, motions.clone(), &mut forces)
    });
    let (Some(first), Some(second)) = (sides.next(), sides.next()) else { return Err(NoModes::Eigenvalues) };
    let (mut first, second) = (first?, second?);
    first.matrix = (first.matrix + second.matrix) * 0.5;
    Ok(first)
}

/// The servos whose loops are unstable about a pose at rest, with the gains that would make them stable. A crane that is unstable
/// without servos has none.
///
/// # Errors
/// The mass matrix is not positive definite, or the QR algorithm does not converge.
pub fn unstable_servos(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Result<Vec<UnstableServo>, NoModes> {
    let servos = servos(crane.description());
    if servos.is_empty() {
        return Ok(Vec::new());
    }
    let space = with_servos(crane, t, q)?;
    let n = space.unknowns().len();
    let rows: Vec<usize> = servos.iter().map(|servo| 2 * n + servo.spool).collect();
    let all = vec![1.0; servos.len()];
    let mut loops = Loops { space, rows, drift: 0.0 };
    // Without its servo a crane sinks onto a valve that leaks, faster the lower it is: no fault of the servos.
    loops.drift = loops
        .growing(&vec![0.0; all.len()])?
        .filter(|mode| mode.eigenvalue.im.abs() < GROWTH)
        .map_or(0.0, |mode| mode.eigenvalue.re);
    let Some(together) = loops.growing(&all)? else { return Ok(Vec::new()) };
    let alone = |index: usize, gain: f64| {
        let mut gains = vec![0.0; all.len()];
        gains[index] = gain;
        gains
    };
    let mut found: Vec<(usize, DampedMode, f64)> = Vec::new();
    for index in 0..servos.len() {
        if let Some(mode) = loops.growing(&alone(index, 1.0))? {
            let Some(gain) = loops.stable_up_to(|gain| alone(index, gain))? else { return Ok(Vec::new()) };
            found.push((index, mode, gain));
        }
    }
    if found.is_empty() {
        // Only together are they unstable.
        found = (0..servos.len()).map(|index| (index, together.clone(), 1.0)).collect();
    }
    let cured = |factor: f64| {
        let mut gains = all.clone();
        for (index, _, gain) in &found {
            gains[*index] = factor * gain;
        }
        gains
    };
    // At its limit a loop is on the verge of growing: the check is just below.
    let factor = match loops.growing(&cured(1.0 - 2.0 * ACCURATE))? {
        None => 1.0,
        Some(_) => match loops.stable_up_to(cured)? {
            Some(factor) => factor,
            None => return Ok(Vec::new()),
        },
    };
    let servo = |(index, mode, gain): (usize, DampedMode, f64)| {
        let Servo { cylinder, gain: full_gain, .. } = servos[index];
        UnstableServo { cylinder, mode, gain: factor * gain * full_gain }
    };
    Ok(found.into_iter().map(servo).collect())
}

/// The loops of several servos.
struct Loops {
    space: StateSpace,
    /// Rows of their spools, whose entries in the columns of the coordinates are proportional to the gains.
    rows: Vec<usize>,
    /// How fast the crane drifts away without its servos, 1/s.
    drift: f64,
}

impl Loops {
    /// The motion that grows fastest, if any does, with the gains multiplied by these factors.
    fn growing(&self, factors: &[f64]) -> Result<Option<DampedMode>, NoModes> {
        let mut space = self.space.clone();
        let n = space.unknowns().len();
        for (row, factor) in self.rows.iter().zip(factors) {
            space.matrix.view_mut((*row, 0), (1, n)).scale_mut(*factor);
        }
        let is_drift =
            |mode: &DampedMode| mode.eigenvalue.im.abs() < GROWTH && mode.eigenvalue.re <= FASTER * self.drift;
        let growing = space.modes()?.into_iter().filter(|mode| grows(mode.eigenvalue) && !is_drift(mode));
        Ok(growing.max_by(|a, b| a.eigenvalue.re.total_cmp(&b.eigenvalue.re)))
    }

    /// The factor from 0 to 1 below which nothing grows; `None` if something grows with any factor.
    fn stable_up_to(&self, gains: impl Fn(f64) -> Vec<f64>) -> Result<Option<f64>, NoModes> {
        let (mut stable, mut unstable) = (0.5, 1.0);
        while self.growing(&gains(stable))?.is_some() {
            (stable, unstable) = (0.5 * stable, stable);
            if stable < LEAST {
                return Ok(None);
            }
        }
        while unstable > (1.0 + ACCURATE) * stable {
            let middle = (stable * unstable).sqrt();
            if self.growing(&gains(middle))?.is_some() { unstable = middle } else { stable = middle }
        }
        Ok(Some(stable))
    }
}
