//! Products of vectors with the derivatives of a function, without these derivatives.
//!
//! | product | cost |
//! |---|---|
//! | `wᵀ J`, backward along the function ([`PullBack`]) | a few times that of the function, for all its arguments, parameters and inputs |
//! | `J x`, forward along the function ([`push_forward`]) | about three times that of the function, for up to eight x |

use std::ops::Range;
use std::sync::Arc;

use crane_codegen::program::{Argument, FunctionId, PULLED_BACK, Shape};
use crane_model::dyn_crane::DynModel;

use crate::LiveCrane;
use crate::library::Library;
use crate::machine::{Arguments, Machine};

/// A state at which a function is differentiated.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Time, s.
    pub t: f64,
    /// Pose, m and rad.
    pub q: &'a [f64],
    /// Its rates.
    pub v: &'a [f64],
    /// Accelerations.
    pub a: &'a [f64],
}

/// `wᵀ J` of a function of a crane, with a workspace for its calls.
#[derive(Debug)]
pub struct PullBack {
    library: Arc<Library>,
    function: FunctionId,
    machine: Machine<f64>,
    inputs: Vec<f64>,
    results: Vec<f64>,
    /// Where each of [`PULLED_BACK`] is among the results.
    places: [Range<usize>; PULLED_BACK.len()],
}

/// The derivatives of a weighted sum of the results of a function.
#[derive(Clone, Copy, Debug)]
pub struct Pulled<'r> {
    /// By time.
    pub t: f64,
    /// By the pose.
    pub q: &'r [f64],
    /// By its rates.
    pub v: &'r [f64],
    /// By accelerations.
    pub a: &'r [f64],
    /// By the live parameters.
    pub parameters: &'r [f64],
    /// By the numbers of the inputs, of which the first of each is its value.
    pub inputs: &'r [f64],
}

impl PullBack {
    /// Of a function of a crane with its parameters and inputs; `None` if the crane does not need it, or if its products are too long for the registers.
    #[must_use]
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Option<Self> {
        let library = crane.library();
        let routine = library.pulled_back(function)?;
        let (n, parameters) = (crane.size(), crane.parameters());
        let mut end = 0;
        let inputs: Vec<f64> = crane.inputs().numbers().collect();
        let places = PULLED_BACK.map(|argument| {
            let begin = end;
            end += match argument {
                Argument::Time => 1,
                Argument::Parameters => parameters.len(),
                Argument::Inputs => inputs.len(),
                _ => n,
            };
            begin..end
        });
        let (machine, results) = (routine.machine(parameters), vec![0.0; routine.results()]);
        Some(Self { function, machine, results, places, inputs, library })
    }

    /// Whether the results of a function are numbers of their own, each with a weight.
    #[must_use]
    pub fn has_weights(crane: &LiveCrane, function: FunctionId) -> bool {
        let arguments = function.arguments();
        let others = [Argument::RightHandSide, Argument::DrivePositions, Argument::AddedInertia, Argument::Factors];
        !others.iter().any(|other| arguments.contains(other))
            && crane.library().routine(function).is_none_or(|routine| {
                matches!(
                    routine.shape(),
                    Shape::Scalar
                        | Shape::Vector(_)
                        | Shape::Vectors(_)
                        | Shape::Pairs(_)
                        | Shape::Rows { .. }
                        | Shape::Structs(..)
                )
            })
    }

    /// The product at a state, with a weight for each result of the function, in their order.
    pub fn at(&mut self, state: &State<'_>, weights: &[f64]) -> Pulled<'_> {
        let Self { library, function, machine, inputs, results, places } = self;
        let &State { t, q, v, a } = state;
        let arguments = Arguments { t, q, v, a, r: weights, inputs, ..Arguments::none() };
        if let Some(routine) = library.pulled_back(*function) {
            routine.run(machine, &arguments, results);
        }
        let [t, q, v, a, parameters, inputs] = places.each_ref().map(|place| &results[place.clone()]);
        Pulled { t: t[0], q, v, a, parameters, inputs }
    }
}
