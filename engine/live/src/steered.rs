//! A motion whose inputs change while the method goes on.

use std::ops::ControlFlow;
use std::sync::Arc;

use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Run, Sample, Settings, Stopped};

use crate::inputs::{Inputs, Slots, is_free, slots_of};
use crate::{LiveCrane, Motion};

/// How inputs come from one value to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// At once: held from the beginning of a step to its end (zero-order hold).
    Constant,
    /// Linearly over the step: the new value is that at its end (first-order hold).
    Linear,
}

/// A motion of a live crane whose inputs change between results; the method keeps its step size and its history.
///
/// Inputs whose value in the spec is a number are set to it from the beginning. One that follows a motion of the spec can be set, or follow it
/// again, only in a new motion: see [`can_set`](Self::can_set).
pub struct SteeredMotion {
    motion: Motion,
    inputs: Arc<Inputs>,
    /// Values at the last result, and those that the spec gives.
    values: Vec<f64>,
    defaults: Vec<f64>,
    /// From where it began, s.
    begin: f64,
    start: InitialState,
}

impl SteeredMotion {
    /// From a state at a time, s, with the [marks](Motion::marks) of an earlier motion if it goes on from one.
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn new(
        crane: &LiveCrane,
        begin: f64,
        start: &InitialState,
        settings: &Settings,
        marks: Option<&[f64]>,
    ) -> Result<Self, Stopped> {
        let crane = crane.clone();
        let infos = &crane.description().inputs;
        let defaults: Vec<f64> = (0..infos.len()).map(|index| crane.input_start(index)).collect();
        let values = (0..infos.len()).map(|index| crane.input(index).unwrap_or(defaults[index])).collect();
        let inputs = Arc::clone(crane.inputs());
        for (index, info) in infos.iter().enumerate() {
            if info.default.is_some() && inputs.get(index).is_some_and(is_free) {
                inputs.set(index, slots_of(info.default));
            }
        }
        let motion = Motion::steered(crane, begin, start, settings, marks)?;
        Ok(Self { motion, inputs, values, defaults, begin, start: start.clone() })
    }

    /// Whether an input can be set to a value: it does not follow a motion of the spec.
    #[must_use]
    pub fn can_set(&self, index: usize) -> bool {
        self.inputs.get(index).is_some_and(|slots| !is_free(slots))
    }

    /// Advances by `dt`, s, with new values of inputs by their indices, `None` for that of the spec; the others stay. Setting the same values
    /// changes nothing. `step` receives the time after every step, and may stop the motion, which then ends: it cannot be steered any further.
    ///
    /// # Errors
    /// As [`Motion::advance`].
    pub fn advance(
        &mut self,
        dt: f64,
        changes: impl IntoIterator<Item = (usize, Option<f64>)>,
        hold: Hold,
        step: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Stopped> {
        let begin = self.motion.sample().t;
        // Those that moved in the last step stay where they have arrived.
        let mut next: Vec<Slots> = self.inputs.slots().collect();
        for (slots, value) in next.iter_mut().zip(&self.values).filter(|(slots, _)| !is_free(**slots)) {
            *slots = slots_of(Some(*value));
        }
        for (index, value) in changes {
            let (before, value) = (self.values[index], value.unwrap_or(self.defaults[index]));
            next[index] = match hold {
                Hold::Constant => slots_of(Some(value)),
                Hold::Linear if value == before => slots_of(Some(value)),
                Hold::Linear => {
                    let rate = (value - before) / dt;
                    [before - rate * begin, 0.0, rate]
                }
            };
            self.values[index] = value;
        }
        if !self.inputs.slots().eq(next.iter().copied()) {
            let inputs = Arc::clone(&self.inputs);
            self.motion.change(&mut || next.iter().enumerate().for_each(|(index, slots)| inputs.set(index, *slots)))?;
        }
        self.motion.advance(begin + dt, step)
    }

    /// What events have done so far: see [`Motion::marks`].
    #[must_use]
    pub fn marks(&self) -> Vec<f64> {
        self.motion.marks()
    }

    /// The crane, after its events so far.
    #[must_use]
    pub fn crane(&self) -> &dyn DynCrane {
        self.motion.crane()
    }

    /// The state reached.
    #[must_use]
    pub fn sample(&self) -> Sample<'_> {
        self.motion.sample()
    }

    /// Summary of the run so far.
    #[must_use]
    pub fn run(&self) -> Run {
        self.motion.run()
    }

    /// All numbers from which the motion can be [made again](Self::recalled).
    #[must_use]
    pub fn memory(&mut self) -> Vec<f64> {
        let Self { motion, inputs, values, begin, start: InitialState { q, v, x }, .. } = self;
        let mut memory = vec![*begin, x.len() as f64];
        memory.extend([&*q, v, x, values].into_iter().flatten());
        memory.extend(inputs.numbers());
        memory.extend(motion.memory());
        memory
    }

    /// The motion from which `memory` is, of the same crane with the same settings: it goes on with the same numbers, to the last bit. `None` if
    /// it is not from such a motion.
    #[must_use]
    pub fn recalled(crane: &LiveCrane, settings: &Settings, memory: &[f64]) -> Option<Self> {
        let (&[begin, states], rest) = memory.split_first_chunk()?;
        let n = crane.size();
        let states = (0..=rest.len()).find(|count| *count as f64 == states)?;
        let (q, rest) = rest.split_at_checked(n)?;
        let (v, rest) = rest.split_at_checked(n)?;
        let (x, rest) = rest.split_at_checked(states)?;
        let (values, rest) = rest.split_at_checked(crane.inputs().len())?;
        let (slots, rest) = rest.split_at_checked(crane.inputs().numbers().count())?;
        let start = InitialState { q: q.to_vec(), v: v.to_vec(), x: x.to_vec() };
        if crane_model::force_states::impossible(crane.description(), x).is_some() {
            return None;
        }
        let of_begin = crane.clone();
        let each = slots.as_chunks().0.iter().enumerate();
        each.for_each(|(index, slots)| of_begin.inputs().set(index, *slots));
        let mut made = Self::new(&of_begin, begin, &start, settings, None).ok()?;
        slots.as_chunks().0.iter().enumerate().for_each(|(index, slots)| made.inputs.set(index, *slots));
        made.values.copy_from_slice(values);
        made.motion.recall(rest).then_some(made)
    }
}
