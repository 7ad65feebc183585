//! The error of a run, estimated by repeating it with a tenth of the tolerance or half the step, and results four times as often.
//!
//! If the method converges, the finer run is several times more accurate, so the difference of the two is almost the error of
//! the coarser one. The additional results of the finer run show what a quantity does between two results, above all its peaks: how far these
//! lie beyond the results is not an error of the steps, and is counted apart.

use crane_quantities::{ColumnKind, DisplayUnit};

use super::{Extremes, Table, headlines};
use crate::dynamics;

/// Tolerance of the finer run relative to that of the run.
const FINER: f64 = 0.1;
/// Results of the finer run per result of the run.
const RESULTS: usize = 4;
/// Maximum number of results of the finer run; beyond it, the finer run has as many as the run.
const MOST_RESULTS: usize = 1_000_000;
/// Fraction of a quantity's size above which a difference causes a caution.
const CAUTION: f64 = 0.01;
/// Quantities smaller than this fraction of the largest of their kind cause no caution.
const NEGLIGIBLE: f64 = 1e-4;
/// Growth of the difference of two runs, in powers of e, that only exponential growth explains.
const CHAOS: f64 = 7.0;
/// Fraction of the variance of the logarithm that a straight line explains if growth is exponential.
const STRAIGHT: f64 = 0.8;

/// Settings of the finer run.
pub fn finer(settings: &dynamics::Settings) -> dynamics::Settings {
    let (count, interval) = settings.intervals();
    let output = if count <= MOST_RESULTS / RESULTS { interval / RESULTS as f64 } else { settings.output };
    if settings.method.is_adaptive() {
        dynamics::Settings { tolerance: settings.tolerance * FINER, output, ..*settings }
    } else {
        dynamics::Settings { step: settings.step_taken() / 2.0, output, ..*settings }
    }
}

/// The comparison of a run with a finer one.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification {
    /// Largest difference of values at the same times, column by column, in the column's unit: the error of the steps.
    pub errors: Vec<f64>,
    /// How far the finer run goes between two results beyond its values at the same times, column by column: what the interval of results
    /// leaves out of minima and maxima.
    pub missed: Vec<f64>,
    /// Time in which small differences grow by a factor e, s, where the motion is chaotic.
    pub divergence: Option<f64>,
}

impl Verification {
    /// Compares two runs; the finer one has samples at the same times, and possibly equally spaced ones in between.
    pub fn new(run: &Table, finer: &Table, coordinates: usize) -> Self {
        let every = (finer.rows.len().max(1) - 1) / (run.rows.len().max(2) - 1);
        let of_events: Vec<usize> =
            (0..run.columns.len()).filter(|column| run.columns[*column].kind == ColumnKind::EventTime).collect();
        // Between the times at which an event happens in both, they are different cranes.
        let same_events = |(a, b): &(&Vec<f64>, &Vec<f64>)| of_events.iter().all(|&at| (a[at] > 0.0) == (b[at] > 0.0));
        let together: Vec<(&Vec<f64>, &Vec<f64>)> =
            run.rows.iter().zip(finer.rows.iter().step_by(every.max(1))).filter(same_events).collect();
        let of_column = |column: usize| {
            if of_events.contains(&column) {
                let [one, other] = [run, finer].map(|table| table.rows.last().map_or(0.0, |row| row[column]));
                return ((one - other).abs(), 0.0);
            }
            let error = together.iter().map(|(a, b)| (a[column] - b[column]).abs()).fold(0.0, f64::max);
            let [least, greatest] = range(together.iter().map(|(_, row)| row[column]));
            let [finer_least, finer_greatest] = range(finer.rows.iter().map(|row| row[column]));
            (error, (least - finer_least).max(finer_greatest - greatest).max(0.0))
        };
        let (errors, missed) = (0..run.columns.len()).map(of_column).unzip();
        Self { errors, missed, divergence: divergence(&together, coordinates) }
    }

    /// Error and what is missed of the column with this name.
    pub fn find_errors(&self, table: &Table, name: &str) -> Option<[f64; 2]> {
        let index = table.columns.iter().position(|column| column.name == name)?;
        Some([*self.errors.get(index)?, *self.missed.get(index)?])
    }

    /// Largest difference of the column with this name from the finer run: the larger one of both.
    pub fn difference(&self, table: &Table, name: &str) -> Option<f64> {
        self.find_errors(table, name).map(|[error, missed]| error.max(missed))
    }

    /// Reports quantities whose error may exceed one percent of their size, the worst by name.
    pub fn cautions(&self, table: &Table) -> Vec<String> {
        let doubtful = self.doubtful(table);
        let mut cautions = Vec::new();
        for between in [false, true] {
            let of_kind: Vec<&Doubtful> = doubtful.iter().filter(|quantity| quantity.between == between).collect();
            let Some(worst) = of_kind.iter().max_by(|a, b| a.share.total_cmp(&b.share)) else { continue };
            let Doubtful { name, difference, unit, share, measure, .. } = worst;
            let display = DisplayUnit::always(unit);
            let others = match of_kind.len() - 1 {
                0 => String::new(),
                1 => ", and one other quantity by less".to_owned(),
                count => format!(", and {count} other quantities by less"),
            };
            let remedy = if between {
                "it has peaks between two results; write a smaller `output`"
            } else {
                "a finer run differs by that much; use a smaller tolerance or step"
            };
            cautions.push(format!(
                "{name} may be off by {:.2e} {}, {:.1} % of its {measure}{others}: {remedy}",
                display.map_or(*difference, |display| display.shown(*difference)),
                display.map_or(unit.as_str(), |display| display.unit()),
                100.0 * share
            ));
        }
        if let (Some(time), false) = (self.divergence, cautions.is_empty()) {
            cautions.push(format!(
                "the motion is chaotic: small differences grow by a factor e every {time:.2} s, so no tolerance makes the \
                 end of the run exact; trust the beginning, or statistics over many runs"
            ));
        }
        cautions
    }

    /// Quantities whose error may exceed one percent of their size.
    fn doubtful(&self, table: &Table) -> Vec<Doubtful> {
        let force = table.largest_force();
        let mut found = Vec::new();
        for kind in headlines(&table.columns) {
            let sizes: Vec<f64> = kind.names.iter().map(|name| kind.size(&Extremes::of_column(table, name))).collect();
            let greatest = sizes.iter().copied().fold(0.0, f64::max);
            for (name, size) in kind.names.iter().zip(sizes) {
                let Some([error, missed]) = self.find_errors(table, name) else { continue };
                let (difference, between) = (error.max(missed), missed > error);
                if difference > CAUTION * size.max(NEGLIGIBLE * greatest) && difference > kind.noise(table, name, force)
                {
                    let share = difference / size.max(f64::MIN_POSITIVE);
                    let (unit, measure) = (kind.unit.clone(), kind.measure);
                    found.push(Doubtful { name: name.clone(), difference, unit, share, measure, between });
                }
            }
        }
        found
    }
}

/// A quantity whose error may exceed one percent of its size.
struct Doubtful {
    name: String,
    difference: f64,
    unit: String,
    /// The error relative to its size.
    share: f64,
    /// The measure of its size, in words.
    measure: &'static str,
    /// Whether the error is that of a peak between two results.
    between: bool,
}

/// The least and the greatest of some values.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::MAX, f64::MIN], |[least, greatest], x| [x.min(least), x.max(greatest)])
}

/// Time in which the difference of two runs grows by a factor e, if it grows by [`CHAOS`] powers and along a straight line:
/// least squares of the logarithm of the largest difference of a coordinate over time.
fn divergence(together: &[(&Vec<f64>, &Vec<f64>)], coordinates: usize) -> Option<f64> {
    let difference = |(a, b): &(&Vec<f64>, &Vec<f64>)| {
        let greatest =
            a[1..=coordinates].iter().zip(&b[1..=coordinates]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (greatest > 0.0).then(|| (a[0], greatest.ln()))
    };
    let points: Vec<(f64, f64)> = together.iter().filter_map(difference).collect();
    let count = points.len() as f64;
    let (first, last) = (points.first()?.0, points.last()?.0);
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (t, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let covariance = mean(&|p| (p.0 - t) * (p.1 - y));
    let (spread, variance) = (mean(&|p| (p.0 - t).powi(2)), mean(&|p| (p.1 - y).powi(2)));
    let slope = covariance / spread;
    let straight = covariance * covariance > STRAIGHT * spread * variance;
    (straight && slope * (last - first) > CHAOS).then(|| slope.recip())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(value: impl Fn(f64) -> f64) -> Table {
        let mut table = Table::default();
        table.add("t", "s");
        table.add("q", "rad");
        table.rows = (0..=1000).map(|i| f64::from(i) * 0.01).map(|t| vec![t, value(t)]).collect();
        table
    }

    #[test]
    fn exponential_growth_is_chaos_and_its_time_is_found() {
        let run = table(f64::sin);
        let finer = table(|t| t.sin() + 1e-8 * (1.5 * t).exp());
        let time = Verification::new(&run, &finer, 1).divergence.expect("chaos");
        // The fit is exact up to the rounding of differences as small as 1e-8 of numbers of size 1.
        assert!((time * 1.5 - 1.0).abs() < 1e-3, "{time}");
    }

    #[test]
    fn polynomial_growth_is_not_chaos() {
        let run = table(f64::sin);
        // A frequency error causes a difference that grows with time; an integrator's error grows with its square.
        for power in [0, 1, 2] {
            let finer = table(|t| t.sin() + 1e-3 * (t + 0.1).powi(power));
            assert_eq!(Verification::new(&run, &finer, 1).divergence, None, "power {power}");
        }
    }

    #[test]
    fn differences_are_the_greatest_of_each_column() {
        let (run, finer) = (table(|_| 1.0), table(|t| 1.0 - 0.02 * t));
        let verification = Verification::new(&run, &finer, 1);
        assert!((verification.difference(&run, "q").expect("a column") - 0.2).abs() < 1e-15);
        assert_eq!(verification.difference(&run, "none"), None);
    }

    /// A wave whose steps are off by 1e-6, with results every 0.1 s of which none is at a peak: both are told apart, and a caution names the
    /// interval.
    #[test]
    fn steps_and_interval_contribute_apart() {
        let wave = |count: i32, error: f64| {
            let mut table = table(|_| 0.0);
            let times = (0..=count).map(|i| f64::from(i) * 10.0 / f64::from(count));
            table.rows = times.map(|t| vec![t, (0.1 + std::f64::consts::TAU * t).sin() + error]).collect();
            table
        };
        let (run, finer) = (wave(100, 1e-6), wave(400, 0.0));
        let [error, missed] = Verification::new(&run, &finer, 1).find_errors(&run, "q").expect("a column");
        // Sines near their peaks, which are at 90°: of the run the nearest results are at 77.73° and 257.73°, of the finer one at 86.73° and 266.73°.
        let expected = |from: f64| from.to_radians().sin();
        let nearest = 0.1_f64.to_degrees() + 72.0;
        assert!((error - 1e-6).abs() < 1e-14, "{error}");
        assert!((missed - (expected(nearest + 9.0) - expected(nearest))).abs() < 1e-14, "{missed}");
    }

    /// Cautions give what the steps miss in percent of the range of a position, and what lies between results; the largest of the two decides.
    #[test]
    fn errors_are_told_in_percent_of_the_range() {
        let positions = |count: i32, value: &dyn Fn(f64) -> f64| {
            let mut table = Table::default();
            table.add("t", "s");
            table.add("tip_z", "m");
            table.columns[1].kind = ColumnKind::PointPosition;
            let times = (0..=count).map(|i| f64::from(i) * 10.0 / f64::from(count));
            table.rows = times.map(|t| vec![t, value(t)]).collect();
            table
        };
        let run = positions(100, &|t| 0.1 * t);
        let off = Verification::new(&run, &positions(400, &|t| 0.1 * t + 0.05), 1).cautions(&run);
        assert!(off[0].starts_with("tip_z may be off by 5.00e-2 m, 5.0 % of its range: a finer run"), "{off:?}");
        // A peak of 0.3 m between two results.
        let peak = |t: f64| 0.1 * t + if (5.01..5.09).contains(&t) { 0.8 } else { 0.0 };
        let missed = Verification::new(&run, &positions(400, &peak), 1).cautions(&run);
        assert!(missed[0].contains("% of its range: it has peaks between two results"), "{missed:?}");
    }

    /// A quantity that is sampled at its zeros has its peaks in between, upwards or downwards.
    #[test]
    fn peaks_between_results_are_noticed() {
        for (up, down) in [(1.0, 1.0), (1.0, 0.0), (0.0, 1.0)] {
            let vibration = |count: i32| {
                let mut table = table(|_| 0.0);
                table.rows = (0..=count)
                    .map(|i| f64::from(i) * 10.0 / f64::from(count))
                    .map(|t| (t, (std::f64::consts::TAU * 5.0 * t).sin()))
                    .map(|(t, wave)| vec![t, if wave > 0.0 { up * wave } else { down * wave }])
                    .collect();
                table
            };
            let verification = Verification::new(&vibration(100), &vibration(400), 1);
            // Sines of multiples of 2π are zero up to the rounding of numbers below 400.
            assert!(
                (verification.missed[1] - 1.0).abs() < 1e-12 && verification.errors[1] < 1e-12,
                "{up}, {down}: {verification:?}"
            );
        }
    }
}
