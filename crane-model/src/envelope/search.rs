//! The largest load within limits, by the secant method: moments, stresses and efforts are nearly linear in the load.

use super::{Condition, Limit, Margin};

/// A trial load with which the crane rests.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    /// The load.
    pub load: f64,
    /// What is left of each limit.
    pub margins: Vec<Margin>,
    /// The crane with this load.
    pub at: Condition,
}

impl Trial {
    /// The smallest margin.
    fn least(&self) -> Option<Margin> {
        self.margins.iter().copied().min_by(|a, b| a.slack.total_cmp(&b.slack))
    }

    pub(super) fn is_within(&self) -> bool {
        self.margins.iter().all(|margin| margin.slack >= 0.0)
    }

    fn point(&self) -> Point {
        (self.load, self.margins.clone())
    }

    /// Why the crane does not rest with a little more load.
    fn cause_of_falling(&self) -> Limit {
        let causes = self.margins.iter().filter(|margin| margin.limit.ends_equilibrium() && margin.slack < NEAR);
        causes.min_by(|a, b| a.slack.total_cmp(&b.slack)).map_or(Limit::Equilibrium, |margin| margin.limit)
    }
}

/// The range in which the load is searched.
pub(super) struct Range {
    /// Maximum load considered.
    pub greatest: f64,
    /// A load that may be near the largest.
    pub guess: f64,
    /// The typical size of loads, positive.
    pub scale: f64,
    /// Relative accuracy of the largest load.
    pub accuracy: f64,
    /// Maximum ratio of a step up to the distance between the minimum load and the last one within the limits.
    pub growth: f64,
}

/// Relative accuracy of the loads of charts, which round to three digits.
pub(super) const CHART: f64 = 1e-6;
/// Loads that differ by less than this fraction of the scale are equal.
const LEAST: f64 = 1e-9;
/// Maximum number of trial loads: the secant method takes about five, bisection about thirty to forty.
const MOST_TRIALS: usize = 100;
/// Where the crane did not rest after a stride, or not on its path, its load is tried once more when only this part of the stride is left.
const NEARBY: f64 = 0.02;
/// Remaining margin up to which tipping, a drive or a foot counts as the reason why a crane does not rest with more load: the margin
/// falls faster as the crane gives way.
const NEAR: f64 = 0.1;
/// First step up if there is no guess, as a fraction of the scale.
const FIRST_STEP: f64 = 0.1;
/// How fast steps grow where only the largest load counts.
pub(super) const FAST: f64 = 4.0;
/// The same where a path of poses is followed: a long step ends on another path, where there is one.
pub(super) const ALONG: f64 = 0.25;

/// The trial with the largest load from `first` on, `None` if that one is beyond a limit, and the limit that governs, `None` if none is reached.
pub(super) fn largest(
    first: Trial,
    range: &Range,
    trial: &mut dyn FnMut(f64, &Trial) -> Option<Trial>,
) -> (Option<Trial>, Option<Limit>) {
    if !first.is_within() {
        let governing = first.least().map(|margin| margin.limit);
        return (None, governing);
    }
    let least = first.load;
    // The last two trials, for the secant.
    let mut last = [None, Some((first.load, first.margins.clone()))];
    let mut within = first;
    // The smallest load beyond a limit, with its trial if the crane rests.
    let mut beyond: Option<(f64, Option<Trial>)> = None;
    // The load from which the crane did not come to rest with the one beyond.
    let mut failed_from = least;
    // How far the last two trials were from those before them.
    let mut strides = [f64::INFINITY; 2];
    for turn in 0..MOST_TRIALS {
        let secant = match &last {
            [Some(before), Some(now)] => crossing(before, now),
            _ => None,
        };
        let high = beyond.as_ref().map_or(range.greatest, |(load, _)| *load);
        if high - within.load <= accuracy(high, range) {
            break;
        }
        if let Some((_, limit)) =
            secant.filter(|(at, _)| (at - within.load).abs() <= accuracy(*at, range) && *at <= high)
        {
            return (Some(within), Some(limit));
        }
        let now = last[1].as_ref().map_or(within.load, |(load, _)| *load);
        let next = match &beyond {
            None => {
                let step = (range.growth * (within.load - least)).max(FIRST_STEP * range.scale);
                let next = secant.map_or(within.load + step, |(at, _)| aim(at, within.load, range));
                let next = if turn == 0 && range.guess > within.load { range.guess } else { next };
                next.clamp(within.load, within.load + step.max(range.guess - within.load)).min(range.greatest)
            }
            Some((high, None)) if high - within.load <= NEARBY * (high - failed_from) => *high,
            Some((high, tried)) => {
                let chord =
                    tried.as_ref().and_then(|trial| crossing(&within.point(), &trial.point())).map(|(at, _)| at);
                let inside = |at: &f64| *at > within.load && *at < *high;
                let found = secant.map(|(at, _)| at).filter(inside).or(chord).filter(inside);
                let aimed = found.map(|at| aim(at, within.load, range));
                // Strides that do not halve in two turns lead nowhere, as at the kink of a limit: then the interval is halved.
                aimed.filter(|at| (at - now).abs() < 0.5 * strides[0]).unwrap_or(0.5 * (within.load + high))
            }
        };
        strides = [strides[1], (next - now).abs()];
        let found = trial(next, &within);
        if let Some(found) = &found {
            last = [last[1].take(), Some(found.point())];
        }
        match found {
            Some(found) if found.is_within() => {
                if found.load >= range.greatest {
                    return (Some(found), None);
                }
                if beyond.as_ref().is_some_and(|(load, _)| found.load >= *load) {
                    beyond = None;
                }
                within = found;
            }
            other => (beyond, failed_from) = (Some((next, other)), within.load),
        }
    }
    match &beyond {
        Some((_, Some(trial))) => {
            let governing = trial.least().map(|margin| margin.limit);
            (Some(within), governing)
        }
        Some((_, None)) => {
            let governing = Some(within.cause_of_falling());
            (Some(within), governing)
        }
        None => (Some(within), None),
    }
}

/// The difference up to which loads count as equal.
fn accuracy(load: f64, range: &Range) -> f64 {
    (range.accuracy * load.abs()).max(LEAST * range.scale)
}

/// A little below a crossing, so that it is within the limit.
fn aim(at: f64, from: f64, range: &Range) -> f64 {
    (at - 0.5 * accuracy(at, range)).max(0.5 * (at + from))
}

/// A load, and what is left of each limit with it.
type Point = (f64, Vec<Margin>);

/// The load at which the line through two trials first meets a limit, and that limit.
fn crossing((one, of_one): &Point, (two, of_two): &Point) -> Option<(f64, Limit)> {
    let meets = |&Margin { limit, slack, .. }: &Margin| {
        let before = of_one.iter().find(|margin| margin.limit == limit)?.slack;
        let at = two + slack * (two - one) / (before - slack);
        (at.is_finite() && (before - slack) * (two - one) > 0.0).then_some((at, limit))
    };
    of_two.iter().filter_map(meets).min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(load: f64, slacks: &[f64]) -> Trial {
        // The load as a pose, so that a trial knows from where it starts.
        let at = Condition { q: vec![load], ..Condition::default() };
        let margin = |(drive, &slack)| Margin { limit: Limit::Effort { drive }, value: 1.0 - slack, bound: 1.0, slack };
        Trial { load, margins: slacks.iter().enumerate().map(margin).collect(), at }
    }

    const ACCURACY: f64 = CHART;
    const RANGE: Range = Range { greatest: 1e6, guess: 0.0, scale: 1000.0, accuracy: ACCURACY, growth: FAST };

    /// Finds the largest load from zero on, for slacks that are functions of the load, and counts trials.
    fn find(slacks: &dyn Fn(f64) -> Option<Vec<f64>>, range: &Range) -> (Option<f64>, Option<Limit>, usize) {
        let mut trials = 0;
        let (best, governing) = largest(trial(0.0, &slacks(0.0).unwrap()), range, &mut |load, _| {
            trials += 1;
            slacks(load).map(|slacks| trial(load, &slacks))
        });
        (best.map(|best| best.load), governing, trials)
    }

    #[test]
    fn linear_limits_take_three_trials() {
        let (load, governing, trials) = find(&|load| Some(vec![1.0 - load / 800.0, 1.0 - load / 700.0]), &RANGE);
        let load = load.unwrap();
        assert!(load <= 700.0 && load > 700.0 * (1.0 - ACCURACY), "{load}");
        assert_eq!(governing, Some(Limit::Effort { drive: 1 }));
        assert!(trials <= 3, "{trials}");
    }

    /// Margins `1 − (x/50)²`, which is curved, and `1 − |x/30 − 0.8|`, which has a kink.
    #[test]
    fn curved_limits_are_met_from_below() {
        let curved = |load: f64| Some(vec![1.0 - (load / 50.0).powi(2), 1.0 - (load / 30.0 - 0.8).abs()]);
        let (load, governing, trials) = find(&curved, &RANGE);
        let load = load.unwrap();
        assert!(load <= 50.0 && load > 50.0 * (1.0 - ACCURACY), "{load}");
        assert_eq!(governing, Some(Limit::Effort { drive: 0 }));
        assert!(trials < 20, "{trials}");
    }

    #[test]
    fn where_no_rest_is_left_the_interval_is_halved() {
        let (load, governing, trials) = find(&|load| (load < 123.0).then(|| vec![1.0]), &RANGE);
        let load = load.unwrap();
        assert!(load < 123.0 && load > 123.0 * (1.0 - ACCURACY), "{load}");
        assert_eq!(governing, Some(Limit::Equilibrium));
        assert!(trials < 50, "{trials}");
    }

    #[test]
    fn the_greatest_load_needs_no_limit() {
        let range = Range { greatest: 5000.0, ..RANGE };
        let (load, governing, _) = find(&|load| Some(vec![1.0 + load]), &range);
        assert_eq!((load, governing), (Some(5000.0), None));
    }

    #[test]
    fn a_crane_beyond_its_limits_without_load_has_none() {
        let (load, governing, trials) = find(&|load| Some(vec![load - 1.0, -2.0 + load]), &RANGE);
        assert_eq!((load, governing, trials), (None, Some(Limit::Effort { drive: 1 }), 0));
    }

    /// Beyond the limit at once, by the load of a neighbour: the second trial is on the chord, the third on the secant.
    #[test]
    fn a_guess_beyond_takes_few_trials() {
        let range = Range { guess: 77.0, ..RANGE };
        let slightly_curved = |load: f64| Some(vec![1.0 - load / 70.0 - 1e-4 * (load / 70.0).powi(2)]);
        let (load, _, trials) = find(&slightly_curved, &range);
        let load = load.unwrap();
        let exact = 70.0 * ((1.0 + 4e-4_f64).sqrt() - 1.0) / 2e-4;
        assert!(load <= exact && load > exact * (1.0 - ACCURACY), "{load} for {exact}");
        assert!(trials <= 4, "{trials}");
    }

    /// Newton's method fails where a step is too long, although the crane would rest.
    #[test]
    fn a_step_that_was_too_long_is_no_limit() {
        let first = trial(0.0, &[1.0]);
        let (best, governing) = largest(first, &RANGE, &mut |load, near| {
            (load - near.at.q[0] < 300.0)
                .then(|| trial(load, &[if load < 250.0 { 1.0 } else { 1.0 - (load - 250.0) / 450.0 }]))
        });
        let load = best.unwrap().load;
        assert!(load <= 700.0 && load > 700.0 * (1.0 - 2.0 * ACCURACY), "{load}");
        assert_eq!(governing, Some(Limit::Effort { drive: 0 }));
    }

    /// What is left of a margin that decides equilibrium names the reason.
    #[test]
    fn a_crane_that_gives_way_near_a_limit_is_limited_by_it() {
        let (load, governing, _) = find(&|load| (load < 690.0).then(|| vec![1.0 - load / 700.0]), &RANGE);
        let load = load.unwrap();
        assert!(load < 690.0 && load > 690.0 * (1.0 - 2.0 * ACCURACY), "{load}");
        assert_eq!(governing, Some(Limit::Effort { drive: 0 }));
    }
}
