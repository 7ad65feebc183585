//! The common interface of all methods: one step, the motion within it, and statistics.

use super::{EffortAccuracy, Statistics, Stopped};

/// A motion that proceeds step by step. It holds its crane, its state and its workspace: no step allocates.
///
/// A motion is one slice: coordinates, rates and states of forces.
pub trait Stepper: Send {
    /// Starts from a motion at time `t`, s.
    ///
    /// # Errors
    /// [`Stopped`] if the accelerations there are not finite.
    fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped>;

    /// Takes a step towards a time ahead, and returns the time reached, s.
    ///
    /// # Errors
    /// [`Stopped`] if the motion grows from step to step or no step meets the tolerance.
    fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped>;

    /// Motion at the time reached.
    fn motion(&self) -> &[f64];

    /// Motion at a time within the last step.
    fn interpolate(&mut self, t: f64, motion: &mut [f64]);

    /// Statistics so far.
    fn statistics(&self) -> Statistics;

    /// The efforts of the drives so far, if the method monitors them.
    fn efforts(&self) -> Vec<EffortAccuracy> {
        Vec::new()
    }
}

/// A motion that may be changed between steps, remembered and recalled.
pub trait Steered: Stepper {
    /// Goes back to the state at a time within the last step, and continues from there after `change`, which changes forces or the motions of
    /// drives but neither positions nor rates.
    ///
    /// # Errors
    /// [`Stopped`] if the accelerations there are not finite.
    fn change(&mut self, t: f64, change: &mut dyn FnMut()) -> Result<(), Stopped>;

    /// Visits all numbers on which further steps depend, always in the same order.
    fn visit(&mut self, visit: &mut dyn FnMut(&mut f64));
}

impl<S: Stepper + ?Sized> Stepper for &mut S {
    fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped> {
        (**self).start(t, motion)
    }

    fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped> {
        (**self).step(ahead)
    }

    fn motion(&self) -> &[f64] {
        (**self).motion()
    }

    fn interpolate(&mut self, t: f64, motion: &mut [f64]) {
        (**self).interpolate(t, motion);
    }

    fn statistics(&self) -> Statistics {
        (**self).statistics()
    }

    fn efforts(&self) -> Vec<EffortAccuracy> {
        (**self).efforts()
    }
}

/// Times ahead of a step, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// The next result: a method with constant steps ends a step there, others interpolate.
    pub result: f64,
    /// The next time that no step may pass; infinite if there is none.
    pub stop: f64,
}

/// Forwards [`Stepper`] and [`Steered`] to the field of a method's public type.
macro_rules! forward {
    ($stepper:ident) => {
        impl Stepper for $stepper<'_> {
            fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped> {
                self.0.start(t, motion)
            }

            fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped> {
                self.0.step(ahead)
            }

            fn motion(&self) -> &[f64] {
                self.0.motion()
            }

            fn interpolate(&mut self, t: f64, motion: &mut [f64]) {
                self.0.interpolate(t, motion);
            }

            fn statistics(&self) -> Statistics {
                self.0.statistics()
            }

            fn efforts(&self) -> Vec<EffortAccuracy> {
                self.0.efforts()
            }
        }

        impl Steered for $stepper<'_> {
            fn change(&mut self, t: f64, change: &mut dyn FnMut()) -> Result<(), Stopped> {
                self.0.change(t, change)
            }

            fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
                self.0.visit(visit);
            }
        }
    };
}

pub(super) use forward;
