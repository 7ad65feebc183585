//! A crane in motion: the crane and the course that borrows it, in one value.

use std::ops::ControlFlow;

use crane_live::LiveCrane;
use crane_model::dynamics::{Course, InitialState, Sample, Settings, Stopped};
use self_cell::self_cell;

self_cell!(
    struct Moving {
        owner: LiveCrane,
        #[covariant]
        dependent: Course,
    }
);

/// A crane that moves on from a state for as long as it is asked to.
pub struct Motion(Moving);

impl Motion {
    /// From a state at a time, s.
    pub fn new(crane: LiveCrane, begin: f64, start: &InitialState, settings: &Settings) -> Result<Self, Stopped> {
        Moving::try_new(crane, |crane| Course::new(crane, begin, start, settings)).map(Self)
    }

    /// Goes on to a later time, s.
    pub fn advance(&mut self, result: f64) -> Result<(), Stopped> {
        let go_on = &mut |_| ControlFlow::Continue(());
        self.0.with_dependent_mut(|_, course| course.advance(result, go_on)).map(|_| ())
    }

    /// The state reached.
    pub fn sample(&self) -> Sample<'_> {
        self.0.borrow_dependent().sample()
    }
}
