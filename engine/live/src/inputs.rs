//! The inputs of a live crane: numbers that may change while the crane moves.

use std::sync::atomic::{AtomicU64, Ordering};

use crane_codegen::chain::Input;

/// The numbers of one input.
pub type Slots = [f64; Input::SLOTS];

/// The numbers of all inputs of a crane, [`Input::SLOTS`] each. Whoever shares them can set them during a run, while it is [changed](crane_model::dynamics::Integration::change).
#[derive(Debug)]
pub struct Inputs(Vec<AtomicU64>);

impl Inputs {
    /// Inputs with these numbers.
    pub fn new(slots: impl IntoIterator<Item = Slots>) -> Self {
        Self(slots.into_iter().flatten().map(|number| AtomicU64::new(number.to_bits())).collect())
    }

    /// The same numbers, which are not shared.
    pub fn copy(&self) -> Self {
        Self::new(self.slots())
    }

    /// Number of inputs.
    pub fn len(&self) -> usize {
        self.0.len() / Input::SLOTS
    }

    /// Sets the numbers of an input; an index out of range changes nothing.
    pub fn set(&self, index: usize, slots: Slots) {
        for (place, number) in self.0.iter().skip(Input::SLOTS * index).zip(slots) {
            place.store(number.to_bits(), Ordering::Relaxed);
        }
    }

    /// The numbers of an input.
    pub fn get(&self, index: usize) -> Option<Slots> {
        (index < self.len()).then(|| std::array::from_fn(|slot| self.number(Input::SLOTS * index + slot)))
    }

    /// The numbers of each input.
    pub fn slots(&self) -> impl Iterator<Item = Slots> {
        (0..self.len()).filter_map(|index| self.get(index))
    }

    /// All numbers.
    pub fn numbers(&self) -> impl Iterator<Item = f64> {
        (0..self.0.len()).map(|index| self.number(index))
    }

    fn number(&self, index: usize) -> f64 {
        f64::from_bits(self.0[index].load(Ordering::Relaxed))
    }
}

/// The numbers of an input that is set to a value, or that follows its spec.
pub fn slots_of(value: Option<f64>) -> Slots {
    value.map_or(Input::NOT_SET, Input::set)
}

/// Whether an input with these numbers follows its spec.
pub fn is_free([_, free, _]: Slots) -> bool {
    free != 0.0
}
