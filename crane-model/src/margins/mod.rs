//! Stability margins of a control loop around a crane: gain, phase and modulus margins, bandwidth, damping of the closed loop.
//!
//! ```text
//! L(s) = C(s) G(s),    C(s) = (p + i/s + d s/(1 + T_f s)) (1 + T_1 s)/(1 + T_2 s) e^(−T s)/(1 + τ s)
//! ```
//!
//! with the response G of the measured output to what the loop acts on. The controller acts on the reference minus the output, so that the
//! closed loop is the set of zeros of 1 + L. Dead time enters exactly: nothing is approximated by rational functions.
//!
//! Whether the closed loop is stable follows from Nyquist's count of encirclements [Åström and Murray, Feedback Systems, 2nd ed. 2021,
//! Sec. 10.3], with as many as the open loop has unstable poles: a phase margin alone says nothing about loops that cross the unit circle
//! several times, as those around flexible cranes do, nor about cranes that are unstable without the loop. The count is taken on the line
//! `Re s = 1e-4 1/s` instead of the imaginary axis: integrators and undamped modes then are to its left, and what grows more slowly takes longer
//! than any manoeuvre. The dead time turns L there as it does on the axis.
//!
//! The damping of the closed loop is that of all its motions, the zeros of 1 + L (`roots`), up to the highest frequency with |L| ≥ 0.1. Those that
//! grow are compared with the count.

mod acting;
mod controller;
mod line;
mod open;
mod response;
mod roots;
#[cfg(test)]
mod tests;

use std::{error::Error, f64::consts::PI, fmt};

use nalgebra::Complex;

use crate::{
    linear::LinearModel,
    modes::{GROWTH, NoModes, damping_ratio, grows},
};
pub use acting::Acting;
pub use controller::Loop;
use line::{Line, Point};
use open::Open;
pub use response::{Plant, Term};

/// Least size of L at the highest frequency up to which motions of the closed loop are those of the loop.
const LEAST: f64 = 0.1;
/// Most that a dead time turns L up to its last crossing, rad, with which the motions of the closed loop are listed: about ten of its chain.
const LONGEST: f64 = 30.0;
/// A motion of the plant that the loop moves by less than this part of its eigenvalue, near rounding, is not one of the loop.
const MOVED: f64 = 1e-9;
/// Growth of motions that may be counted or not, relative to the least growth that is.
const VERGE: [f64; 2] = [0.9, 1.1];
/// A frequency below all others, rad/s, and the change of L up to the first one, relative to L, with which it begins at a finite number.
const LOWEST: f64 = 1e-8;
const SAME: f64 = 0.1;
/// The count of encirclements is determined if it is as close as this to an integer.
const WHOLE: f64 = 0.05;

/// Margins of a loop. Frequencies are in rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct Margins {
    /// Whether the closed loop is stable.
    pub stable: bool,
    /// Number of unstable motions of the closed loop.
    pub unstable: usize,
    /// The phase of L + 180°, rad, at the frequency with |L| = 1 where its size is least, and that frequency; `None` if there is none.
    pub phase: Option<(f64, f64)>,
    /// The smallest factor above 1 by which the gain could be multiplied until L passes −1, and the frequency.
    pub gain: Option<(f64, f64)>,
    /// The same of the largest factor below 1: a loop that needs its gain has one.
    pub reduction: Option<(f64, f64)>,
    /// The smallest distance of L from −1, the inverse of the largest sensitivity `|1/(1 + L)|`, and its frequency; `None` if the dead time
    /// turns L too often.
    pub distance: Option<(f64, f64)>,
    /// The frequency up to which the output follows the reference: |L/(1 + L)| falls below 1/√2.
    pub bandwidth: Option<f64>,
    /// The least damped of all motions of the closed loop, zeros of 1 + L, up to the highest frequency with |L| ≥ 0.1, and of those that
    /// grow: its eigenvalue, 1/s, with Im λ ≥ 0. `None` where |L| is nowhere 0.1 and nothing grows.
    pub closed: Result<Option<Complex<f64>>, NoMotions>,
}

impl Margins {
    /// Damping ratio of the least damped motion of the closed loop; negative if and only if one grows.
    pub fn damping(&self) -> Option<f64> {
        self.closed.ok().flatten().map(damping_ratio)
    }
}

/// Why the motions of a closed loop are not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoMotions {
    /// The dead time turns L by this angle up to its last crossing, rad: its chain of motions is too long.
    DeadTime(f64),
    /// Growing motions that were found, and those that Nyquist's count has.
    Count(usize, usize),
}

impl fmt::Display for NoMotions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoMotions::DeadTime(turn) => {
                write!(
                    f,
                    "no damping: the dead time turns L by {turn:.0} rad up to its crossover, more than {LONGEST}: is it in s?"
                )
            }
            NoMotions::Count(found, counted) => write!(
                f,
                "no damping: {found} motions that grow were found, {counted} are counted: the loop is on the verge of instability"
            ),
        }
    }
}

/// Why a loop has no margins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoMargins {
    /// Its gain does not fall below 1 at high frequencies.
    Improper,
    /// The output does not depend on the input, or all gains are zero.
    NoLoop,
    /// Numbers are not finite, or eigenvalues are not found.
    Modes(NoModes),
    /// The count of encirclements is not determined.
    Count,
}

impl fmt::Display for NoMargins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoMargins::Improper => {
                f.write_str("the gain of the loop is not below 1 at high frequencies: give it a lag or a filter")
            }
            NoMargins::NoLoop => {
                f.write_str("the loop is open: its output does not depend on its input, or its gains are zero")
            }
            NoMargins::Modes(none) => none.fmt(f),
            NoMargins::Count => {
                f.write_str("encirclements of −1 cannot be counted: the loop is on the verge of instability")
            }
        }
    }
}

impl Error for NoMargins {}

/// The margins of a loop around a plant.
///
/// # Errors
/// The loop is open or its gain does not fall at high frequencies.
pub fn margins(plant: &Plant, of: &Loop) -> Result<Margins, NoMargins> {
    let open = Open { plant, of };
    let axis = Line::new(0.0, &open);
    let last = axis.points[axis.points.len() - 1];
    if axis.points.iter().any(|point| !point.l.is_finite()) {
        return Err(NoMargins::Modes(NoModes::Eigenvalues));
    }
    if last.l.norm() >= 1.0 {
        return Err(NoMargins::Improper);
    }
    if axis.points.iter().all(|point| point.l.norm() == 0.0) {
        return Err(NoMargins::NoLoop);
    }
    let unstable = closed_unstable(&open)?;
    let real = if axis.follows { negative(&axis, &open) } else { Vec::new() };
    let [gain, reduction] = gain_margins(&real);
    Ok(Margins {
        stable: unstable == 0,
        unstable,
        phase: phase_margin(&axis),
        gain,
        reduction,
        distance: axis.follows.then(|| distance(&axis, &open)),
        bandwidth: if axis.follows { bandwidth(&axis) } else { None },
        closed: least_damped(&open, &axis, &real, unstable),
    })
}

/// Number of motions of the closed loop that grow: `Z = P − Δarg(1 + L)/π` along the upper half of the line, P those of the open loop.
fn closed_unstable(open: &Open<'_>) -> Result<usize, NoMargins> {
    let growing: usize = open.plant.poles().iter().copied().filter(|pole| grows(*pole)).map(motions).sum();
    let count = growing as f64 - Line::new(GROWTH, open).turn() / PI;
    let whole = count.round();
    if (count - whole).abs() > WHOLE || whole < 0.0 || whole > f64::from(u32::MAX) {
        return Err(NoMargins::Count);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the largest u32")]
    Ok(whole as usize)
}

/// How many motions an eigenvalue with Im λ ≥ 0 stands for: with its conjugate two.
fn motions(eigenvalue: Complex<f64>) -> usize {
    if eigenvalue.im > 0.0 { 2 } else { 1 }
}

/// The phase of L + 180° with the least size where |L| = 1.
fn phase_margin(axis: &Line<'_>) -> Option<(f64, f64)> {
    let size = |l: Complex<f64>| l.norm().ln();
    let crossings = axis.crossings(&size).into_iter().map(|point| {
        let angle = (-point.l).arg();
        (angle, point.omega)
    });
    crossings.min_by(|(a, _), (b, _)| a.abs().total_cmp(&b.abs()))
}

/// Where L is a negative number.
fn negative(axis: &Line<'_>, open: &Open<'_>) -> Vec<Point> {
    let crossings = axis.crossings(&|l: Complex<f64>| l.im).into_iter().filter(|point| point.l.re < 0.0);
    // Without integrators L begins at a real number.
    let at_rest = open.response(Complex::new(0.0, LOWEST));
    let begins = at_rest.re < 0.0 && (axis.points[0].l - at_rest).norm() < SAME * at_rest.norm();
    let at_rest = begins.then_some(Point { omega: 0.0, rational: at_rest, l: at_rest });
    crossings.chain(at_rest).collect()
}

/// The factors nearest to 1, above and below, with which L passes −1.
fn gain_margins(negative: &[Point]) -> [Option<(f64, f64)>; 2] {
    let factors = || negative.iter().map(|point| (-1.0 / point.l.re, point.omega));
    let above = factors().filter(|(factor, _)| *factor > 1.0).min_by(|a, b| a.0.total_cmp(&b.0));
    let below = factors().filter(|(factor, _)| *factor <= 1.0).max_by(|a, b| a.0.total_cmp(&b.0));
    [above, below]
}

/// The smallest distance of L from −1, by golden section about the nearest point.
fn distance(axis: &Line<'_>, open: &Open<'_>) -> (f64, f64) {
    let far = |omega: f64| (open.response(Complex::new(0.0, omega)) + 1.0).norm();
    let points = &axis.points;
    let least = (0..points.len()).min_by(|&a, &b| {
        let size = |index: usize| (points[index].l + 1.0).norm();
        size(a).total_cmp(&size(b))
    });
    let least = least.unwrap_or(0);
    let mut ends = [points[least.saturating_sub(1)].omega, points[(least + 1).min(points.len() - 1)].omega];
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let width = ends[1] - ends[0];
        let inner = [ends[1] - golden * width, ends[0] + golden * width];
        if far(inner[0]) < far(inner[1]) { ends[1] = inner[1] } else { ends[0] = inner[0] }
    }
    let omega = 0.5 * (ends[0] + ends[1]);
    (far(omega), omega)
}

/// The first frequency at which |L/(1 + L)| falls below 1/√2.
fn bandwidth(axis: &Line<'_>) -> Option<f64> {
    let follows = |l: Complex<f64>| (l / (l + 1.0)).norm() - 0.5_f64.sqrt();
    if follows(axis.points[0].l) < 0.0 {
        return None;
    }
    axis.crossings(&follows).first().map(|point| point.omega)
}

/// The zero of 1 + L with the smallest damping ratio.
fn least_damped(
    open: &Open<'_>,
    axis: &Line<'_>,
    negative: &[Point],
    unstable: usize,
) -> Result<Option<Complex<f64>>, NoMotions> {
    let turn = open.of.delay * axis.highest(1.0);
    if turn > LONGEST || !axis.follows {
        return Err(NoMotions::DeadTime(turn));
    }
    let highest = axis.highest(LEAST);
    let found = roots::roots(open, highest, negative.iter().map(|point| (point.omega, point.rational)));
    let beyond = |growth: f64| found.iter().copied().filter(|root| root.re > growth).map(motions).sum::<usize>();
    let [least, most] = [VERGE[1], VERGE[0]].map(|part| beyond(part * GROWTH));
    if !(least..=most).contains(&unstable) {
        return Err(NoMotions::Count(beyond(GROWTH), unstable));
    }
    let is_moved = |root: Complex<f64>| {
        open.plant.poles().iter().all(|pole| (root - pole).norm() > MOVED * root.norm()) && root.norm() > GROWTH
    };
    let of_loop = found.iter().copied().filter(|&root| grows(root) || (highest > 0.0 && is_moved(root)));
    Ok(of_loop.min_by(|a, b| damping_ratio(*a).total_cmp(&damping_ratio(*b))))
}

/// The plant of a loop: output `output` of a linear model whose inputs are those of `acting`.
///
/// # Errors
/// Numbers are not finite.
pub fn plant(model: &LinearModel, acting: Acting, output: usize) -> Result<Plant, NoMargins> {
    let terms = acting.inputs().into_iter().enumerate().map(|(column, (_, power))| Term {
        power,
        b: model.b.column(column).into_owned(),
        d: model.d[(output, column)],
    });
    Plant::new(&model.a, terms.collect(), &model.c.row(output).transpose()).map_err(NoMargins::Modes)
}
