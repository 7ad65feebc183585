//! L along a line parallel to the imaginary axis, as densely as it turns.

use nalgebra::Complex;

/// Frequencies at which L is evaluated before refinement, rad/s, and how many for each decade.
const DECADES: [i32; 2] = [-4, 5];
const PER_DECADE: i32 = 16;
/// Between neighbours, 1 + L turns by at most this angle, rad.
const TURN: f64 = 0.6;
/// Between neighbours, L grows or falls by at most this factor's logarithm, and turns by at most TURN, where it is larger than SMALL.
const GROWTH: f64 = 0.7;
const SMALL: f64 = 0.02;
/// Most points of a line, and halvings of an interval.
const MOST: usize = 30_000;
const HALVINGS: u32 = 40;
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
    pub l: Complex<f64>,
}

/// L at frequencies in ascending order.
pub struct Line {
    sigma: f64,
    pub points: Vec<Point>,
}

impl Line {
    /// The line `Re s = σ`; `poles`: those of the plant with Im λ ≥ 0.
    pub fn new(sigma: f64, poles: &[Complex<f64>], l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Self {
        let steps = (DECADES[1] - DECADES[0]) * PER_DECADE;
        let grid = (0..=steps).map(|k| 10.0_f64.powf(f64::from(DECADES[0]) + f64::from(k) / f64::from(PER_DECADE)));
        let resonances = poles.iter().filter(|pole| pole.im > pole.re.abs()).flat_map(|pole| {
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
        let at = |omega: f64| Point { omega, l: l(Complex::new(sigma, omega)) };
        let mut points: Vec<Point> = Vec::with_capacity(2 * omegas.len());
        for omega in omegas {
            let next = at(omega);
            match points.last().copied() {
                Some(last) => refine(last, next, HALVINGS, sigma == 0.0, &at, &mut points),
                None => points.push(next),
            }
        }
        Self { sigma, points }
    }

    /// Where a function of L changes its sign, by bisection; jumps from one sign to the other through a pole are left out.
    pub fn crossings(&self, of: &dyn Fn(Complex<f64>) -> f64, l: &dyn Fn(Complex<f64>) -> Complex<f64>) -> Vec<Point> {
        let at = |omega: f64| Point { omega, l: l(Complex::new(self.sigma, omega)) };
        let changes = self.points.windows(2).filter(|pair| of(pair[0].l) * of(pair[1].l) < 0.0);
        changes
            .filter_map(|pair| {
                let ([mut before, mut after], size) =
                    ([pair[0], pair[1]], of(pair[0].l).abs().max(of(pair[1].l).abs()));
                for _ in 0..BISECTIONS {
                    let middle = at(0.5 * (before.omega + after.omega));
                    if of(middle.l) * of(before.l) > 0.0 { before = middle } else { after = middle }
                }
                (of(after.l).abs() <= size).then_some(after)
            })
            .collect()
    }
}

/// Appends `next`, and as many points between it and `last` as L needs.
fn refine(last: Point, next: Point, halvings: u32, on_axis: bool, at: &dyn Fn(f64) -> Point, points: &mut Vec<Point>) {
    let turns = |a: Complex<f64>, b: Complex<f64>| (b / a).arg().abs() > TURN;
    let [a, b] = [last.l, next.l];
    let matters = on_axis && a.norm().max(b.norm()) > SMALL;
    let coarse =
        turns(a + 1.0, b + 1.0) || (matters && (turns(a, b) || (a.norm().ln() - b.norm().ln()).abs() > GROWTH));
    // An undamped pole on the axis has no other end.
    let narrow = on_axis && next.omega - last.omega < LEAST_WIDTH * next.omega;
    if !coarse || narrow || halvings == 0 || points.len() > MOST {
        points.push(next);
        return;
    }
    let middle = if last.omega > 0.0 && next.omega > 1.5 * last.omega {
        (last.omega * next.omega).sqrt()
    } else {
        0.5 * (last.omega + next.omega)
    };
    let middle = at(middle);
    refine(last, middle, halvings - 1, on_axis, at, points);
    refine(middle, next, halvings - 1, on_axis, at, points);
}
