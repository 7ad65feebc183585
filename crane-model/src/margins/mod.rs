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
//! than any manoeuvre.

mod line;
mod response;
#[cfg(test)]
mod tests;

use std::{error::Error, f64::consts::PI, fmt};

use nalgebra::Complex;

use crate::{Description, DriveInfo, linear::Input, linear::LinearModel, modes::NoModes, results::Column};
use line::{Line, Point};
pub use response::{Plant, Term};

/// Growth of a disturbance, 1/s, below which it is rounding or takes longer than any manoeuvre.
const GROWTH: f64 = 1e-4;
/// Iterations of Newton's method towards a root of 1 + L.
const ITERATIONS: usize = 40;
/// Change of a root, relative to its size, with which it is found.
const FOUND: f64 = 1e-10;
/// Distance of L from −1 up to which a minimum on the axis belongs to a motion of the closed loop that the loop worsens, and the least size of L
/// there.
const NEAR: f64 = 1.0;
const LEAST: f64 = 0.1;
/// A frequency below all others, rad/s, and the change of L up to the first one, relative to L, with which it begins at a finite number.
const LOWEST: f64 = 1e-8;
const SAME: f64 = 0.1;
/// The count of encirclements is determined if it is as close as this to an integer.
const WHOLE: f64 = 0.05;

/// A controller with its dead time and its lag. All zeros: no loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loop {
    /// Proportional gain, unit of the input per unit of the output.
    pub p: f64,
    /// Integral gain, the same per s.
    pub i: f64,
    /// Derivative gain, the same times s.
    pub d: f64,
    /// Time constant of the filter of the derivative, s.
    pub filter: f64,
    /// Time constants of numerator and denominator of a lead, or of a lag if the second is larger, s.
    pub lead: [f64; 2],
    /// Dead time, s.
    pub delay: f64,
    /// Time constant of a first-order lag, s.
    pub lag: f64,
}

impl Loop {
    /// C(s).
    pub fn response(&self, s: Complex<f64>) -> Complex<f64> {
        let one = Complex::from(1.0);
        let gains =
            s * self.d / (one + s * self.filter) + self.p + if self.i == 0.0 { Complex::from(0.0) } else { self.i / s };
        let lead = (one + s * self.lead[0]) / (one + s * self.lead[1]);
        gains * lead * (-s * self.delay).exp() / (one + s * self.lag)
    }
}

/// What a loop acts on, of a drive or of the spec.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acting {
    /// The motion of a drive, position and rate.
    Motion(usize),
    /// The rate of the motion of a drive, whose position is its integral.
    Rate(usize),
    /// A single input.
    On(Input),
}

impl Acting {
    /// What a name stands for: the coordinate of a drive for its motion, `<coordinate>_rate` for the rate of its motion, any other input by
    /// its own name.
    pub fn named(name: &str, description: &Description) -> Option<Self> {
        let drive = |name: &str| {
            let is_it = |drive: &DriveInfo| description.coordinates[drive.coordinate].name == name;
            description.drives.iter().position(is_it)
        };
        let rate = || name.strip_suffix("_rate").and_then(drive).map(Acting::Rate);
        drive(name).map(Acting::Motion).or_else(rate).or_else(|| Input::named(name, description).map(Acting::On))
    }

    /// All names.
    pub fn names(description: &Description) -> Vec<String> {
        let inputs = Input::all(description);
        let motions = inputs.iter().filter_map(|input| match input {
            Input::Motion(drive) => Some(*drive),
            _ => None,
        });
        let motions = motions.flat_map(|drive| {
            let [motion, rate] = [Acting::Motion(drive), Acting::Rate(drive)];
            [motion.column(description).name, rate.column(description).name]
        });
        motions.chain(inputs.iter().map(|input| input.column(description).name)).collect()
    }

    /// Its name and unit.
    pub fn column(self, description: &Description) -> Column {
        let info = |drive: usize| &description.coordinates[description.drives[drive].coordinate];
        match self {
            Acting::Motion(drive) => {
                let info = info(drive);
                Column { name: info.name.to_string(), unit: info.kind.unit().to_owned() }
            }
            Acting::Rate(drive) => {
                let info = info(drive);
                Column { name: format!("{}_rate", info.name), unit: format!("{}/s", info.kind.unit()) }
            }
            Acting::On(input) => input.column(description),
        }
    }

    /// Name of the coordinate of the drive on which it acts; `None` for inputs of the spec.
    pub fn coordinate(self, description: &Description) -> Option<&str> {
        let drive = match self {
            Acting::Motion(drive)
            | Acting::Rate(drive)
            | Acting::On(Input::Motion(drive) | Input::Rate(drive) | Input::Effort(drive) | Input::Valve(drive)) => {
                drive
            }
            Acting::On(Input::Spec(_)) => return None,
        };
        Some(description.coordinates[description.drives[drive].coordinate].name.as_str())
    }

    /// The inputs that it moves, and the power of s by which each follows.
    pub fn inputs(self) -> Vec<(Input, i32)> {
        match self {
            Acting::Motion(drive) => vec![(Input::Motion(drive), 0), (Input::Rate(drive), 1)],
            Acting::Rate(drive) => vec![(Input::Motion(drive), -1), (Input::Rate(drive), 0)],
            Acting::On(input) => vec![(input, 0)],
        }
    }
}

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
    /// The smallest distance of L from −1, the inverse of the largest sensitivity `|1/(1 + L)|`, and its frequency.
    pub distance: (f64, f64),
    /// The frequency up to which the output follows the reference: |L/(1 + L)| falls below 1/√2.
    pub bandwidth: Option<f64>,
    /// The least damped motion of the closed loop on which the loop acts: its eigenvalue, 1/s, with Im λ ≥ 0.
    pub closed: Option<Complex<f64>>,
}

impl Margins {
    /// Damping ratio of the least damped motion of the closed loop; negative if it grows.
    pub fn damping(&self) -> Option<f64> {
        self.closed.map(|root| damping_ratio(&root))
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
    let l = |s: Complex<f64>| of.response(s) * plant.response(s);
    let axis = Line::new(0.0, plant.poles(), &l);
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
    let unstable = closed_unstable(plant, &l)?;
    let [gain, reduction] = gain_margins(&axis, &l);
    Ok(Margins {
        stable: unstable == 0,
        unstable,
        phase: phase_margin(&axis, &l),
        gain,
        reduction,
        distance: distance(&axis, &l),
        bandwidth: bandwidth(&axis, &l),
        closed: least_damped(&axis, &l),
    })
}

/// Number of motions of the closed loop that grow: `Z = P − Δarg(1 + L)/π` along the upper half of the line, P those of the open loop.
fn closed_unstable(plant: &Plant, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Result<usize, NoMargins> {
    let line = Line::new(GROWTH, plant.poles(), l);
    let beyond = plant.poles().iter().filter(|pole| pole.re > GROWTH).map(|pole| if pole.im > 0.0 { 2.0 } else { 1.0 });
    let turned: f64 = line.points.windows(2).map(|pair| ((pair[1].l + 1.0) / (pair[0].l + 1.0)).arg()).sum();
    let end = (line.points[line.points.len() - 1].l + 1.0).arg();
    // From the last point on, L falls to zero.
    let count = beyond.sum::<f64>() - (turned - end) / PI;
    if (count - count.round()).abs() > WHOLE || count < -WHOLE {
        return Err(NoMargins::Count);
    }
    Ok((1..=u32::MAX).take_while(|&growing| f64::from(growing) < count + 0.5).count())
}

/// The phase of L + 180° with the least size where |L| = 1.
fn phase_margin(axis: &Line, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Option<(f64, f64)> {
    let size = |l: Complex<f64>| l.norm().ln();
    let crossings = axis.crossings(&size, l).into_iter().map(|point| {
        let angle = (-point.l).arg();
        (angle, point.omega)
    });
    crossings.min_by(|(a, _), (b, _)| a.abs().total_cmp(&b.abs()))
}

/// The factors nearest to 1, above and below, with which L passes −1.
fn gain_margins(axis: &Line, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> [Option<(f64, f64)>; 2] {
    let crossings = axis.crossings(&|l: Complex<f64>| l.im, l).into_iter().filter(|point| point.l.re < 0.0);
    // Without integrators L begins at a real number.
    let at_rest = l(Complex::new(0.0, LOWEST));
    let begins = at_rest.re < 0.0 && (axis.points[0].l - at_rest).norm() < SAME * at_rest.norm();
    let at_rest = begins.then_some(Point { omega: 0.0, l: at_rest });
    let factors: Vec<(f64, f64)> = crossings.chain(at_rest).map(|point| (-1.0 / point.l.re, point.omega)).collect();
    let above = factors.iter().copied().filter(|(factor, _)| *factor > 1.0).min_by(|a, b| a.0.total_cmp(&b.0));
    let below = factors.iter().copied().filter(|(factor, _)| *factor <= 1.0).max_by(|a, b| a.0.total_cmp(&b.0));
    [above, below]
}

/// The smallest distance of L from −1, by golden section about the nearest point.
fn distance(axis: &Line, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> (f64, f64) {
    let far = |omega: f64| (l(Complex::new(0.0, omega)) + 1.0).norm();
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
fn bandwidth(axis: &Line, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Option<f64> {
    let follows = |l: Complex<f64>| (l / (l + 1.0)).norm() - 0.5_f64.sqrt();
    if follows(axis.points[0].l) < 0.0 {
        return None;
    }
    axis.crossings(&follows, l).first().map(|point| point.omega)
}

/// The root of 1 + L with the smallest damping ratio, from the minima of |1 + L| on the axis.
fn least_damped(axis: &Line, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Option<Complex<f64>> {
    let size = |point: &Point| (point.l + 1.0).norm();
    let minima = axis.points.windows(3).filter(|three| {
        let [before, here, after] = [size(&three[0]), size(&three[1]), size(&three[2])];
        here <= before && here <= after && here < NEAR && three[1].l.norm() > LEAST
    });
    let roots = minima.filter_map(|three| root(three[1].omega, l));
    roots.min_by(|a, b| damping_ratio(a).total_cmp(&damping_ratio(b)))
}

fn damping_ratio(root: &Complex<f64>) -> f64 {
    -root.re / root.norm()
}

/// A root of 1 + L near a point of the axis, by Newton's method on 1 + 1/L, which has no poles near the resonances of the plant.
fn root(omega: f64, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Option<Complex<f64>> {
    /// Step of the difference quotient, relative to s: the quotient only directs the iteration.
    const STEP: f64 = 1e-6;
    let mut s = Complex::new(0.0, omega);
    for _ in 0..ITERATIONS {
        let h = Complex::new(STEP * s.norm(), 0.0);
        let slope = (l(s + h).inv() - l(s - h).inv()) / (h * 2.0);
        let step = (l(s).inv() + 1.0) / slope;
        // No further than half the way to the origin at once.
        let step = step * (0.5 * s.norm() / step.norm()).min(1.0);
        s -= step;
        if !s.is_finite() {
            return None;
        }
        if step.norm() < FOUND * s.norm() {
            return Some(Complex::new(s.re, s.im.abs()));
        }
    }
    None
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
