//! L along a line parallel to the imaginary axis, as densely as it turns.

use nalgebra::Complex;

use super::{LEAST, Open};

/// Frequencies at which L is evaluated before refinement, rad/s, and how many for each decade.
const DECADES: [i32; 2] = [-4, 5];
const PER_DECADE: i32 = 16;
/// Between neighbours, 1 + L turns by at most this angle, rad.
const TURN: f64 = 0.6;
/// Between neighbours, L grows or falls by at most this factor's logarithm, and turns by at most TURN, where it is larger than SMALL.
const STEP: f64 = 0.7;
const SMALL: f64 = 0.02;
/// Most points of a line, and halvings of an interval.
const MOST: usize = 30_000;
const HALVINGS: u32 = 40;
/// Most that the dead time turns L where it matters, rad, for the turns to be followed one by one.
const FOLLOWED: f64 = 3000.0;
/// Distances from a resonance, in multiples of its width, at which L is evaluated.
const WIDTHS: [f64; 5] = [0.2, 0.6, 1.4, 4.0, 12.0];
/// The width of an undamped resonance, relative to its frequency.
const LEAST_WIDTH: f64 = 1e-6;
/// Bisections of a crossing: to rounding.
const BISECTIONS: u32 = 60;

/// L at a frequency.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub omega: f64,
    /// Without the dead time.
    pub rational: Complex<f64>,
    /// Turned by the dead time, by −ω T.
    pub l: Complex<f64>,
}

/// L at frequencies in ascending order.
pub struct Line<'a> {
    sigma: f64,
    of: &'a Open<'a>,
    pub points: Vec<Point>,
    /// Whether the points follow each turn of the dead time.
    pub follows: bool,
}

impl<'a> Line<'a> {
    /// The line `Re s = σ` of an open loop. The dead time turns L and does not damp it there.
    pub fn new(sigma: f64, of: &'a Open<'a>) -> Self {
        let steps = (DECADES[1] - DECADES[0]) * PER_DECADE;
        let grid = (0..=steps).map(|k| 10.0_f64.powf(f64::from(DECADES[0]) + f64::from(k) / f64::from(PER_DECADE)));
        let resonances = of.plant.poles().iter().filter(|pole| pole.im > pole.re.abs()).flat_map(|pole| {
            let width = (pole.re - sigma).abs().max(LEAST_WIDTH * pole.im);
            WIDTHS.iter().flat_map(move |widths| [pole.im - 0.9 * widths * width, pole.im + widths * width])
        });
        let least = 10.0_f64.powi(DECADES[0]);
        let mut omegas: Vec<f64> = grid.chain(resonances.filter(|omega| *omega > least)).collect();
        omegas.sort_by(f64::total_cmp);
        omegas.dedup();
        if sigma > 0.0 {
            omegas.insert(0, 0.0);
        }
        let mut line = Self { sigma, of, points: Vec::with_capacity(2 * omegas.len()), follows: true };
        let coarse: Vec<Point> = omegas.into_iter().map(|omega| line.at(omega)).collect();
        let highest = last(&coarse, LEAST).map_or(0.0, |index| coarse[index].omega);
        line.follows = of.of.delay * highest <= FOLLOWED;
        for next in coarse {
            match line.points.last().copied() {
                Some(last) => line.refine(last, next, HALVINGS),
                None => line.points.push(next),
            }
        }
        line
    }

    fn at(&self, omega: f64) -> Point {
        let rational = self.of.rational(Complex::new(self.sigma, omega));
        Point { omega, rational, l: rational * Complex::from_polar(1.0, -self.of.of.delay * omega) }
    }

    /// Appends `next`, and as many points between it and `last` as L needs.
    fn refine(&mut self, last: Point, next: Point, halvings: u32) {
        let turns = |a: Complex<f64>, b: Complex<f64>| (b / a).arg().abs() > TURN;
        let [a, b] = [last.rational, next.rational];
        let matters = a.norm().max(b.norm()) > SMALL;
        let delayed = self.follows
            && (turns(last.l + 1.0, next.l + 1.0) || (matters && self.of.of.delay * (next.omega - last.omega) > TURN));
        let coarse = delayed || (matters && (turns(a, b) || (a.norm().ln() - b.norm().ln()).abs() > STEP));
        // An undamped pole on the axis has no other end.
        let narrow = next.omega - last.omega < LEAST_WIDTH * next.omega;
        if !coarse || narrow || halvings == 0 || self.points.len() > MOST {
            self.points.push(next);
            return;
        }
        let middle = if last.omega > 0.0 && next.omega > 1.5 * last.omega {
            (last.omega * next.omega).sqrt()
        } else {
            0.5 * (last.omega + next.omega)
        };
        let middle = self.at(middle);
        self.refine(last, middle, halvings - 1);
        self.refine(middle, next, halvings - 1);
    }

    /// Where a function of L changes its sign, by bisection; jumps from one sign to the other through a pole are left out.
    pub fn crossings(&self, of: &dyn Fn(Complex<f64>) -> f64) -> Vec<Point> {
        let changes = self.points.windows(2).filter(|pair| of(pair[0].l) * of(pair[1].l) < 0.0);
        changes
            .filter_map(|pair| {
                let size = of(pair[0].l).abs().max(of(pair[1].l).abs());
                let after = self.crossing([pair[0], pair[1]], of);
                (of(after.l).abs() <= size).then_some(after)
            })
            .collect()
    }

    fn crossing(&self, [mut before, mut after]: [Point; 2], of: &dyn Fn(Complex<f64>) -> f64) -> Point {
        for _ in 0..BISECTIONS {
            let middle = self.at(0.5 * (before.omega + after.omega));
            if of(middle.l) * of(before.l) > 0.0 { before = middle } else { after = middle }
        }
        after
    }

    /// The angle by which 1 + L turns from the first point to infinity, rad. Where |L| > 1 it is that of L itself, without the dead time
    /// and by −T Δω with it, apart from what 1 + 1/L turns, which is less than half a turn: so no dead time is too long.
    pub fn turn(&self) -> f64 {
        let size = |l: Complex<f64>| l.norm().ln();
        let beyond = |point: &Point| size(point.l) >= 0.0;
        let between = |a: &Point, b: &Point, beyond: bool| {
            if beyond {
                let of_l = (b.rational / a.rational).arg() - self.of.of.delay * (b.omega - a.omega);
                of_l + (b.l.inv() + 1.0).arg() - (a.l.inv() + 1.0).arg()
            } else {
                (b.l + 1.0).arg() - (a.l + 1.0).arg()
            }
        };
        let turn = |pair: &[Point]| {
            let [a, b] = [&pair[0], &pair[1]];
            if beyond(a) == beyond(b) {
                return between(a, b, beyond(a));
            }
            let middle = self.crossing([*a, *b], &size);
            between(a, &middle, beyond(a)) + between(&middle, b, beyond(b))
        };
        let last = &self.points[self.points.len() - 1];
        self.points.windows(2).map(turn).sum::<f64>() - (last.l + 1.0).arg()
    }

    /// The highest frequency with |L| ≥ `least`, rad/s; 0 if there is none.
    pub fn highest(&self, least: f64) -> f64 {
        let Some(index) = last(&self.points, least) else { return 0.0 };
        let size = |l: Complex<f64>| (l.norm() / least).ln();
        self.points.get(index + 1).map_or(f64::INFINITY, |next| self.crossing([self.points[index], *next], &size).omega)
    }
}

/// Index of the last point with |L| ≥ `least`.
fn last(points: &[Point], least: f64) -> Option<usize> {
    points.iter().rposition(|point| point.rational.norm() >= least)
}
