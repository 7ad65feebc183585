//! Derivatives of the columns of a run, by live parameters, inputs and numbers of the initial state.
//!
//! How they are integrated: [`crane_model::dynamics::gradients`]. Functions of the crane run on numbers with slopes in eight directions.
//!
//! | module | content |
//! |---|---|
//! | `along` | what a run is differentiated by |
//! | `asked` | which of its numbers are differentiated |
//! | `moment` | derivatives of rates, without a run |
//! | `directions` | functions of the crane with their slopes |
//! | `transposed` | products of weights with these slopes |

mod along;
mod asked;
mod directions;
mod moment;
#[cfg(test)]
mod tests;
mod transposed;

use std::ops::ControlFlow;

use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::gradients::{self, Numbers};
use crane_model::dynamics::{Method, Settings};
use crane_model::runs::{
    self, EQUILIBRIUM, EQUILIBRIUM_MOVING, Failed, GUESS, GUESS_MOVING, Gradients, Measure, Recorded, Start, record,
    record_adjoint, record_gradients,
};

use super::rest::Rest;
use super::source::Source;
use crate::LiveCrane;
pub use along::{Along, NotAlong};
pub use asked::{NotAsked, asked};
use directions::Directions;
pub use moment::{Change, pull_rates, push_rates};
use transposed::Transposed;

/// The method that integrates derivatives along with a motion.
pub const METHOD: Method = Method::Rosenbrock;

/// Runs from `start`, as [`record`], with the derivatives of all columns. A pose at rest or of the guess moves
/// with the parameters and inputs; one that is given does not.
///
/// # Errors
/// The run ends early.
pub fn run_with_gradients(
    crane: &LiveCrane,
    start: &Start,
    settings: &Settings,
    along: &[Along],
    proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<(Recorded, Gradients), Failed> {
    let settings = Settings { method: METHOD, ..*settings };
    let mut directions = Directions::new(crane, along);
    let start_along = of_start(crane, &directions, start, along);
    record_gradients(crane, start, &settings, &mut directions, start_along, proceed)
}

/// The same run with the derivatives of measures of a few columns, given by their indices, in adjoint mode: the cost of those of coordinates and rates
/// hardly grows with the number of directions. Gradients are measure by measure, direction by direction; NaN for what has none, and where the crane is too large for the way back.
/// Steps also allow the errors of a few sums of all directions.
///
/// # Errors
/// The run ends early.
pub fn run_with_adjoint(
    crane: &LiveCrane,
    start: &Start,
    settings: &Settings,
    along: &[Along],
    asked: &[(usize, Measure)],
    proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<(Recorded, Vec<Vec<f64>>), Failed> {
    let settings = Settings { method: METHOD, ..*settings };
    let Ok(mut functions) = Transposed::new(crane, along) else {
        let nothing = vec![vec![f64::NAN; along.len()]; asked.len()];
        return record(crane, start, &settings, proceed).map(|recorded| (recorded, nothing));
    };
    let start_along = of_start(crane, functions.directions(), start, along);
    let (mut probes, of_probes) = functions.directions().probes(along, &start_along);
    let transposed =
        runs::Transposed { functions: &mut functions, along: &start_along, probes: (&mut probes, of_probes) };
    record_adjoint(crane, start, &settings, transposed, asked, proceed)
}

/// Derivatives of the start `[q, v, x]`.
fn of_start(crane: &LiveCrane, directions: &Directions<'_>, start: &Start, along: &[Along]) -> Vec<Vec<f64>> {
    let any: &dyn DynCrane = crane;
    let n = crane.size();
    let mut all = match start.what.as_str() {
        EQUILIBRIUM | EQUILIBRIUM_MOVING => of_rest(crane, directions, start),
        GUESS | GUESS_MOVING => {
            let of_guess = |direction: usize| {
                let guess = &mut |crane: &dyn DynCrane, _: &[f64]| crane.guess();
                gradients::difference(any, directions.around(direction), (&[], &[], 0.0), guess)
            };
            (0..along.len()).map(of_guess).collect()
        }
        _ => vec![vec![0.0; n]; along.len()],
    };
    for (own, along) in all.iter_mut().zip(along) {
        own.resize(2 * n, 0.0);
        match along {
            Along::Position(coordinate) => own[*coordinate] += 1.0,
            Along::Rate(coordinate) => own[n + coordinate] += 1.0,
            Along::Parameter(_) | Along::Input(_) => (),
        }
    }
    if start.x.is_empty() {
        let states = gradients::holding(any, directions, &start.q, &all);
        all.iter_mut().zip(states).for_each(|(own, states)| own.extend(states));
    } else {
        for own in &mut all {
            own.resize(2 * n + start.x.len(), 0.0);
        }
    }
    all
}

/// Derivatives of the pose at rest.
fn of_rest(crane: &LiveCrane, directions: &Directions<'_>, start: &Start) -> Vec<Vec<f64>> {
    let mut source = Source::new(crane);
    let Some(rest) = Rest::new(&mut source, start.q.clone()) else {
        return vec![vec![f64::NAN; start.q.len()]; directions.count()];
    };
    let mut all = Vec::new();
    for chunk in directions.chunks() {
        source.set_parameters(chunk.parameters.clone());
        source.set_inputs(chunk.inputs.clone());
        let (q, _) = rest.moved(&mut source);
        all.extend((0..chunk.count).map(|direction| q.iter().map(|number| number.slope(direction)).collect()));
    }
    all
}
