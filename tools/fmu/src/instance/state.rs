//! States to come back to.

use super::Instance;

/// Everything that determines the crane's future motion.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub(super) parameters: Vec<f64>,
    /// Values of the inputs that are set.
    pub(super) inputs: Vec<Option<f64>>,
    /// None before the crane has come to rest.
    pub(super) moment: Option<Moment>,
}

/// Time, pose and rates, and the states of forces.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Moment {
    pub(super) t: f64,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) x: Vec<f64>,
}

impl State {
    /// The state as numbers: parameters; inputs, NaN if not set; and, if known, time, pose, rates and states of forces.
    pub fn numbers(&self) -> Vec<f64> {
        let moment = self.moment.iter().flat_map(|Moment { t, q, v, x }| std::iter::once(t).chain(q).chain(v).chain(x));
        let inputs = self.inputs.iter().map(|value| value.unwrap_or(f64::NAN));
        self.parameters.iter().copied().chain(inputs).chain(moment.copied()).collect()
    }
}

impl Instance {
    /// The state, to return to later.
    pub fn state(&self) -> State {
        let Self { parameters, inputs, moment, .. } = self;
        State { parameters: parameters.clone(), inputs: inputs.clone(), moment: moment.clone() }
    }

    /// Returns to a state.
    pub fn set_state(&mut self, state: &State) {
        self.parameters.clone_from(&state.parameters);
        self.inputs.clone_from(&state.inputs);
        self.moment.clone_from(&state.moment);
        (self.is_current, self.motion) = (false, None);
        self.forget();
    }

    /// A state of this crane from its numbers; `None` if their count does not match.
    pub fn state_of(&self, numbers: &[f64]) -> Option<State> {
        let (parameters, rest) = numbers.split_at_checked(self.parameters.len())?;
        let (inputs, rest) = rest.split_at_checked(self.inputs.len())?;
        let inputs = inputs.iter().map(|value| Some(*value).filter(|value| !value.is_nan())).collect();
        let moment = match rest {
            [] => None,
            [t, motion @ ..] if motion.len() == self.states() => {
                let (q, rest) = motion.split_at(self.crane.size());
                let (v, x) = rest.split_at(q.len());
                Some(Moment { t: *t, q: q.to_vec(), v: v.to_vec(), x: x.to_vec() })
            }
            _ => return None,
        };
        Some(State { parameters: parameters.to_vec(), inputs, moment })
    }
}
