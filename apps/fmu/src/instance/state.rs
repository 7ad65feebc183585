//! States to come back to.

use super::{Fault, Instance};
use crane_model::StateAt;

/// Bytes per number of a state.
const BYTES: usize = size_of::<f64>();

/// Everything that determines the crane's future motion.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedState {
    /// The token of the crane's variables: no other crane has states like it.
    pub(super) token: String,
    pub(super) parameters: Vec<f64>,
    /// The number of events.
    pub(super) events: usize,
    /// Values of the inputs that are set.
    pub(super) inputs: Vec<Option<f64>>,
    /// What events have done so far; none before the first step.
    pub(super) marks: Option<Vec<f64>>,
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

impl Moment {
    /// The state of the crane.
    pub fn state(&self) -> StateAt<'_> {
        StateAt { t: self.t, q: &self.q, v: &self.v, x: &self.x }
    }
}

impl SavedState {
    /// The state as bytes: the token; then numbers, which are parameters; inputs, NaN if not set; marks of events, infinite before
    /// the first step; and, if known, time, pose, rates and
    /// states of forces.
    pub fn bytes(&self) -> Vec<u8> {
        let moment = self.moment.iter().flat_map(|Moment { t, q, v, x }| std::iter::once(t).chain(q).chain(v).chain(x));
        let inputs = self.inputs.iter().map(|value| value.unwrap_or(f64::NAN));
        let unmarked = vec![f64::INFINITY; self.events];
        let marks = self.marks.as_ref().unwrap_or(&unmarked).iter();
        let numbers = self.parameters.iter().copied().chain(inputs).chain(marks.chain(moment).copied());
        self.token.bytes().chain(numbers.flat_map(f64::to_le_bytes)).collect()
    }
}

impl Instance {
    /// The state, to return to later.
    pub fn state(&self) -> SavedState {
        let Self { token, parameters, inputs, marks, moment, .. } = self;
        let (token, parameters, events) = (token.clone(), parameters.clone(), self.events());
        SavedState { token, parameters, events, inputs: inputs.clone(), marks: marks.clone(), moment: moment.clone() }
    }

    /// Returns to a state.
    ///
    /// # Errors
    /// It is that of another crane.
    pub fn set_state(&mut self, state: &SavedState) -> Result<(), Fault> {
        if state.token != self.token {
            let name = &self.crane.description().name;
            return Err(Fault::Error(format!("the state is that of another crane, not of {name}")));
        }
        self.parameters.clone_from(&state.parameters);
        self.inputs.clone_from(&state.inputs);
        self.moment.clone_from(&state.moment);
        self.marks.clone_from(&state.marks);
        (self.is_current, self.motion) = (false, None);
        self.forget();
        Ok(())
    }

    /// A state of this crane from its bytes; `None` if they are those of another crane.
    pub fn state_of(&self, bytes: &[u8]) -> Option<SavedState> {
        let (chunks, []) = bytes.strip_prefix(self.token.as_bytes())?.as_chunks::<BYTES>() else { return None };
        let numbers: Vec<f64> = chunks.iter().map(|chunk| f64::from_le_bytes(*chunk)).collect();
        let (parameters, rest) = numbers.split_at_checked(self.parameters.len())?;
        let (inputs, rest) = rest.split_at_checked(self.inputs.len())?;
        let inputs = inputs.iter().map(|value| Some(*value).filter(|value| !value.is_nan())).collect();
        let events = self.events();
        let (marks, rest) = rest.split_at_checked(events)?;
        let marks = Some(marks.to_vec()).filter(|marks| !marks.iter().any(|mark| mark.is_infinite()));
        let moment = match rest {
            [] => None,
            [t, motion @ ..] if motion.len() == self.states() => {
                let (q, rest) = motion.split_at(self.crane.size());
                let (v, x) = rest.split_at(q.len());
                Some(Moment { t: *t, q: q.to_vec(), v: v.to_vec(), x: x.to_vec() })
            }
            _ => return None,
        };
        Some(SavedState { token: self.token.clone(), parameters: parameters.to_vec(), events, inputs, marks, moment })
    }
}
