//! The motion that all errors are measured against, found by two methods that must agree.

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{Method, Settings},
};

use crane_cli::toolbox::{Outcome, Problem};

use super::trace::{Errors, Timed, timed};

/// Relative difference allowed between the load paths of the two solutions.
const PATH: f64 = 1e-11;
/// Relative difference allowed between torques and energies: a stiff spring of 1e7 N m/rad turns the rounding of an angle into 1e-9 N m.
const FORCES: f64 = 1e-9;
/// Tolerances of the adaptive solution. Below the last, rounding decides.
const TOLERANCES: [f64; 3] = [1e-11, 1e-12, 1e-13];
/// Maximum number of steps of the solution by constant steps: beyond it, rounding adds up to more than is allowed.
const MOST_STEPS: f64 = 1e6;

/// A solution, and how closely another method agrees with it.
pub struct Reference {
    /// Solution by the explicit pair.
    pub solution: Timed,
    /// Difference from the solution by the classical Runge–Kutta method.
    pub agreement: Errors,
    /// Tolerance of the explicit pair, m and rad, and step of the classical method, s.
    pub settings: (f64, f64),
}

/// The motion of a crane from `start` at rest by the explicit pair and by the classical Runge–Kutta method, refined
/// from the step `step` until both agree.
///
/// # Errors
/// They do not agree for any of their settings.
pub fn reference(crane: &dyn DynCrane, start: &[f64], base: &Settings, step: f64) -> Outcome<Reference> {
    let by = |method, tolerance, step| timed(crane, start, &Settings { method, step, tolerance, ..*base }, 1);
    let mut step = step;
    let mut classical = by(Method::Rk4, f64::NAN, step)?;
    let mut tolerances = TOLERANCES.into_iter();
    let mut pair = None;
    let mut nearest: Option<Nearest> = None;
    loop {
        // First the tolerance, then the step: a stable step is usually far shorter than an accurate one.
        pair = match (tolerances.next(), pair) {
            (Some(tolerance), _) => Some((tolerance, by(Method::DormandPrince, tolerance, f64::NAN)?)),
            (None, pair) if base.duration / step < 0.5 * MOST_STEPS => {
                step *= 0.5;
                classical = by(Method::Rk4, f64::NAN, step)?;
                pair
            }
            (None, _) => return Err(disagreement(&crane.description().name, base, nearest.as_ref())),
        };
        if let Some((tolerance, solution)) = &pair {
            let agreement = solution.trace.errors(&classical.trace);
            if agreement.path <= PATH && agreement.of_forces() <= FORCES {
                return Ok(Reference { solution: solution.clone(), agreement, settings: (*tolerance, step) });
            }
            let results = solution.trace.agrees_for(&classical.trace, PATH);
            if nearest.as_ref().is_none_or(|nearest| results > nearest.results) {
                nearest = Some(Nearest { agreement, settings: (*tolerance, step), results });
            }
        }
    }
}

/// The two solutions that agree longest.
struct Nearest {
    agreement: Errors,
    settings: (f64, f64),
    /// Number of results that agree.
    results: usize,
}

fn disagreement(name: &str, base: &Settings, nearest: Option<&Nearest>) -> Problem {
    /// Fraction of the time of agreement that is proposed: with another step, agreement may end a little earlier.
    const CAREFUL: f64 = 0.9;
    let Some(Nearest { agreement, settings: (tolerance, step), results }) = nearest else {
        return Problem::failed(format!("{name}: no reference"), "");
    };
    let agrees = CAREFUL * base.output * results.saturating_sub(1) as f64;
    Problem::failed(
        format!(
            "{name}: no reference: {} with a tolerance of {tolerance:.0e} and {} with a step of {step:.1e} s differ by {:.1e} of the \
             load path and {:.1e} of torques and energy; {PATH:.0e} and {FORCES:.0e} are required",
            Method::DormandPrince,
            Method::Rk4,
            agreement.path,
            agreement.of_forces(),
        ),
        format!(
            "a motion that amplifies rounding is computable only for a short time: shorten it to where both agree, `--duration {agrees:.2}`, \
             in s"
        ),
    )
}
