//! All motions of a closed loop with a dead time: the zeros of 1 + L.
//!
//! The eigenvalues of the closed loop with a rational approximation of the dead time, and the points of the axis where L passes the negative
//! real numbers, are starts for Newton's method with the exact dead time. The dead time has a chain of infinitely many zeros, with ever less
//! damping and ever less effect; so zeros are sought up to a frequency.

use nalgebra::{Complex, DMatrix};

use super::{Open, Plant, Term};
use crate::modes::eigenvalues;

/// Iterations of Newton's method.
const ITERATIONS: usize = 30;
/// Change of a zero, relative to its size, with which it is found; up to which two of them are one; and up to which starts are one.
const FOUND: f64 = 1e-11;
const SAME: f64 = 1e-7;
const SAME_START: f64 = 1e-4;
/// Zeros are sought up to this multiple of the highest frequency, and starts up to this one.
const BEYOND: f64 = 1.0 + 1e-9;
const STARTS_BEYOND: f64 = 1.2;
/// Order of the approximation of a dead time: this, and more by so much per rad that the dead time turns L.
const ORDER: f64 = 6.0;
const ORDER_PER_TURN: f64 = 1.5;
/// Highest order; beyond, starts on the axis lead to the chain of the dead time.
const HIGHEST_ORDER: f64 = 50.0;
/// Motions slower than this fraction of the highest frequency are not told from 0.
const SLOWEST: f64 = 1e-9;

/// The zeros of 1 + L with 0 ≤ Im s ≤ `highest`, and those of motions of the plant that the loop does not reach; `axis`: frequencies where L is
/// negative, rad/s, and L there without the dead time.
pub fn roots(open: &Open<'_>, highest: f64, axis: impl Iterator<Item = (f64, Complex<f64>)>) -> Vec<Complex<f64>> {
    let delay = open.of.delay;
    // On the chain of a dead time |L| e^(−T Re s) = 1.
    let chain = axis.map(|(omega, l)| Complex::new(if delay > 0.0 { l.norm().ln() / delay } else { 0.0 }, omega));
    let starts = closed(open, highest).unwrap_or_else(|| open.plant.poles().to_vec());
    let mut found: Vec<[Complex<f64>; 2]> = Vec::new();
    let near = |a: Complex<f64>, b: Complex<f64>, within: f64| (a - b).norm() <= within * a.norm().max(b.norm());
    for (index, start) in starts.iter().copied().chain(chain).enumerate() {
        if start.im > STARTS_BEYOND * highest && start.re < 0.0 {
            continue;
        }
        let Some(root) = root(open, start, SLOWEST * highest) else { continue };
        // Two starts in one place are two motions, such as those of two equal cylinders.
        let is_known = |[begun, known]: &[Complex<f64>; 2]| {
            near(root, *known, SAME) && !(index < starts.len() && near(start, *begun, SAME_START))
        };
        if (root.im <= BEYOND * highest || root.re > 0.0) && !found.iter().any(is_known) {
            found.push([start, root]);
        }
    }
    found.into_iter().map(|[_, root]| root).collect()
}

/// The zero to which Newton's method leads.
fn root(open: &Open<'_>, start: Complex<f64>, least: f64) -> Option<Complex<f64>> {
    let mut s = start;
    for _ in 0..ITERATIONS {
        if s.norm() <= least {
            return None;
        }
        let step = open.newton_step(s);
        // A motion that the loop does not reach: s is its eigenvalue, where the step is 0/0.
        if !step.is_finite() {
            return open.plant.poles().contains(&s).then_some(s);
        }
        let step = step * (0.5 * s.norm() / step.norm().max(f64::MIN_POSITIVE)).min(1.0);
        s -= step;
        if step.norm() <= FOUND * s.norm() {
            // A real zero stays real, up to rounding.
            let im = if s.im.abs() < SAME * s.norm() { 0.0 } else { s.im.abs() };
            return Some(Complex::new(s.re, im));
        }
    }
    None
}

/// The eigenvalues of the closed loop with an approximated dead time and Im λ ≥ 0.
fn closed(open: &Open<'_>, highest: f64) -> Option<Vec<Complex<f64>>> {
    let pencil = Pencil::new(open, highest);
    // Those of (M − σE)⁻¹ E are 1/(λ − σ): infinite ones, of parts without a state, become 0.
    let sigma = 0.73 * if highest > 0.0 { highest } else { 1.0 };
    let shifted = (&pencil.matrix - &pencil.rates * sigma).lu().solve(&pencil.rates)?;
    let found = eigenvalues(shifted).ok()?;
    let finite = found.into_iter().map(|inverse| inverse.inv() + sigma).filter(|root| root.is_finite());
    Some(finite.map(|root| Complex::new(root.re, root.im.abs())).collect())
}

/// `E ẋ = M x` of a closed loop.
struct Pencil {
    rates: DMatrix<f64>,
    matrix: DMatrix<f64>,
}

impl Pencil {
    fn new(Open { plant, of }: &Open<'_>, highest: f64) -> Self {
        let Plant { c, terms, .. } = plant;
        let n = c.len();
        let mut pencil = Self { rates: DMatrix::identity(n, n), matrix: plant.matrix() };
        // 0 = e + y
        let e = pencil.variable();
        pencil.matrix[(e, e)] = 1.0;
        for (state, c) in c.iter().enumerate() {
            pencil.matrix[(e, state)] = *c;
        }
        let integral = pencil.block(e, [of.i, 0.0], [0.0, 1.0]);
        let derivative = pencil.block(e, [0.0, of.d], [1.0, of.filter]);
        let sum = pencil.variable();
        for (term, factor) in [(sum, -1.0), (e, of.p), (integral, 1.0), (derivative, 1.0)] {
            pencil.matrix[(sum, term)] = factor;
        }
        let led = pencil.block(sum, [1.0, of.lead[0]], [1.0, of.lead[1]]);
        let lagged = pencil.block(led, [1.0, 0.0], [1.0, of.lag]);
        let command = pencil.delayed(lagged, of.delay, highest);
        for Term { power, b, d } in terms {
            let mut input = command;
            for _ in 0..power.unsigned_abs() {
                let by_s = if *power > 0 { [[0.0, 1.0], [1.0, 0.0]] } else { [[1.0, 0.0], [0.0, 1.0]] };
                input = pencil.block(input, by_s[0], by_s[1]);
            }
            for (state, b) in b.iter().enumerate() {
                pencil.matrix[(state, input)] += b;
            }
            pencil.matrix[(e, input)] += d;
        }
        pencil
    }

    /// Adds a variable and an empty equation.
    fn variable(&mut self) -> usize {
        let n = self.matrix.nrows();
        for matrix in [&mut self.rates, &mut self.matrix] {
            *matrix = std::mem::take(matrix).resize(n + 1, n + 1, 0.0);
        }
        n
    }

    /// Adds w with `(b₀ + b₁ s) w = (a₀ + a₁ s) u`.
    fn block(&mut self, u: usize, a: [f64; 2], b: [f64; 2]) -> usize {
        let w = self.variable();
        (self.rates[(w, w)], self.rates[(w, u)]) = (b[1], -a[1]);
        (self.matrix[(w, w)], self.matrix[(w, u)]) = (-b[0], a[0]);
        w
    }

    /// Adds u after a dead time: the Padé approximation with one zero fewer than poles, in Legendre polynomials of the time within the dead time,
    /// whose matrices have small integers at any order [Voelker and Eliasmith, Neural Computation 30 (2018), 569–609].
    fn delayed(&mut self, u: usize, delay: f64, highest: f64) -> usize {
        if delay == 0.0 {
            return u;
        }
        let order = (ORDER + ORDER_PER_TURN * delay * highest).min(HIGHEST_ORDER);
        let states: Vec<usize> =
            (0..=50).take_while(|&place| f64::from(place) < order).map(|_| self.variable()).collect();
        let after = self.variable();
        self.matrix[(after, after)] = -1.0;
        let sign = |power: usize| if power.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut factor = 1.0;
        for (i, &row) in states.iter().enumerate() {
            self.rates[(row, row)] = delay;
            self.matrix[(row, u)] = factor * sign(i);
            for (j, &column) in states.iter().enumerate() {
                self.matrix[(row, column)] = factor * if i < j { -1.0 } else { sign(i - j + 1) };
            }
            self.matrix[(after, row)] = 1.0;
            factor += 2.0;
        }
        after
    }
}
