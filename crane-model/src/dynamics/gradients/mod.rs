//! Derivatives of a motion by live parameters, by inputs, by numbers of the initial state: in forward mode, those of everything along a few directions;
//! in adjoint mode, those of one number in any number of directions.
//!
//! With `ẏ = F(t, y, p)` the derivative `s = dy/dp` obeys the linear equations
//!
//! ```text
//! ṡ = ∂F/∂y s + ∂F/∂p,      s(0) = dy₀/dp
//! ```
//!
//! They are integrated along with the motion by the W-method of [`rosenbrock`](super::rosenbrock): its order holds for any matrix, so each
//! direction is solved with the factors of the motion's own step, and its stages are evaluated where the stages of the motion are. A step is
//! followed once the error of the motion allows it; if that of a derivative times its number exceeds the tolerance, the next step is shorter.
//!
//! In second-order form, with `r = A a − e − f + Jᵀλ` at the accelerations a and the forces λ of loop joints, held constant, and Q the forces with
//! states of their own, accelerations change with `(δq, δv, δx, δp)` by
//!
//! ```text
//! [A  Jᵀ] [δa]   [δQ − δr      ]
//! [J  0 ] [δλ] = [−δ(J a + J̇ v)]
//! ```
//!
//! The functions of the crane are given with exact slopes ([`Slopes`]), among them the lengths of cylinders and what their servos want; the laws of
//! Q and of the rates of x have their own derivatives, those of the implicit steps.
//!
//! No law of a crane jumps where it changes its branch: contacts begin and end without a force, so s is continuous there. Functions of time may jump,
//! such as the scale of a load or the acceleration of a drive's motion. If the time t* of a jump from F⁻ to F⁺ depends on p,
//!
//! ```text
//! s⁺ = s⁻ + (F⁻ − F⁺) dt*/dp
//! ```
//!
//! (M. A. Aizerman, F. R. Gantmacher, Determination of stability by linear approximation of a periodic solution of a system of differential
//! equations with discontinuous right-hand sides, Q. J. Mech. Appl. Math. 11 (1958) 385.)
//!
//! | module | content |
//! |---|---|
//! | `rates` | F, and its derivative along directions |
//! | `moment` | the same for a moment without a motion |
//! | `jump` | where functions of time are not smooth |
//! | `passage` | what happens to derivatives at an event |
//! | `columns` | derivatives of columns of results |
//! | `follower` | the derivatives, step by step |
//! | `pull_back` | the transpose of `rates` |
//! | `adjoint` | the derivatives of one number by any number of others, step by step from the end |

mod adjoint;
mod columns;
mod follower;
mod jump;
mod moment;
mod passage;
mod pull_back;
mod rates;

use std::ops::ControlFlow;

use super::{
    Course, Happening, InitialState, Integration, Quantities, Run, Sample, Settings, Stepper, Stopped, course::Observe,
};
pub use crate::feet::FeetSlopes;
use crate::{EventInfo, ParameterError, StateAt, dyn_crane::DynCrane, force_states::ForceStates};
pub use adjoint::{Trace, Weights};
pub use columns::{columns_along, columns_by};
use follower::Follower;
pub use moment::{pull_rates, push_rates};
use passage::Passage;

/// A state of a crane at which its functions are given with slopes.
#[derive(Clone, Copy, Debug)]
pub struct MotionAt<'a> {
    /// Time, s.
    pub t: f64,
    /// Pose, m and rad.
    pub q: &'a [f64],
    /// Its rates.
    pub v: &'a [f64],
    /// Accelerations, which do not change.
    pub a: &'a [f64],
    /// λ of the loop joints, which do not change, N and N m.
    pub multipliers: &'a [f64],
}

/// Slopes of what a cylinder with a valve depends on besides its states.
#[derive(Clone, Debug, Default)]
pub struct CylinderSlopes {
    /// Of its length, m, and the rate of this length, m/s.
    pub length_and_rate: [f64; 2],
    /// Of the same with the drives at the positions that their motions prescribe, and straight beams.
    pub wanted: [f64; 2],
    /// Of the opening of its valve that the spec gives over time.
    pub opening: f64,
    /// Of the derivatives of its length with respect to the coordinates.
    pub jacobian: Vec<f64>,
}

/// A crane with a number slightly smaller and slightly larger.
#[derive(Clone, Copy)]
pub struct Around<'a> {
    /// With the smaller and with the larger number.
    pub cranes: [&'a dyn DynCrane; 2],
    /// How far these numbers are from the number itself.
    pub steps: [f64; 2],
}

/// The numbers of a crane and its start by which a motion is differentiated; a direction is that of one number.
pub trait Numbers: Send {
    /// The number of directions.
    fn count(&self) -> usize;

    /// Cranes whose number differs slightly in a direction; `None` if only the initial state does.
    fn around(&self, direction: usize) -> Option<Around<'_>>;

    /// Times at which motions of drives and winches and scales of loads are not smooth, s, with their slopes in every direction.
    fn stops(&mut self) -> Vec<(f64, Vec<f64>)>;
}

/// Functions of a crane with their slopes in some directions, in which its parameters and inputs change. `along` has the change of the motion
/// `[q, v, x]` in each direction; results are direction by direction.
pub trait Slopes: Numbers {
    /// The same of the crane after an event, which sets parameters to numbers.
    ///
    /// # Errors
    /// They break a rule of the spec language.
    fn after(&self, event: &EventInfo) -> Result<Box<dyn Slopes>, ParameterError>;

    /// By how much the number of a direction changes for an error of its derivative to count as an error of the motion.
    fn scale(&self, direction: usize) -> f64;

    /// Slopes of `A a − e − f + Jᵀ λ`, N and N m.
    fn residuals(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<f64>]);

    /// Slopes of φ, φ̇ and `J a + J̇ v` of every equation of the loop joints.
    fn loops(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<[f64; 3]>]);

    /// Slopes of every cylinder.
    fn cylinders(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<CylinderSlopes>]);

    /// Slopes of the numbers of feet.
    fn feet(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [FeetSlopes]);

    /// Slopes of the prescribed position and rate of every drive at a time; `false` if no motion changes in any direction.
    fn drive_motions(&mut self, t: f64, out: &mut [Vec<[f64; 2]>]) -> bool;
}

/// The derivative of one number, with respect to a motion and to the numbers of all directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Covector {
    /// With respect to `[q, v, x]`.
    pub motion: Vec<f64>,
    /// Direction by direction, at a constant motion.
    pub numbers: Vec<f64>,
}

impl Covector {
    /// Zero, for motions of `len` numbers.
    #[must_use]
    pub fn zero(len: usize, directions: usize) -> Self {
        Self { motion: vec![0.0; len], numbers: vec![0.0; directions] }
    }
}

/// The transpose of [`Slopes`]: each function adds the derivative of the sum of its results, times weights, to a covector.
pub trait PullBacks: Numbers {
    /// The same of the crane after an event, which sets parameters to numbers; `None` if these break a rule of the spec language.
    fn after(&self, event: &EventInfo) -> Option<Box<dyn PullBacks>>;

    /// Of `A a − e − f + Jᵀ λ`, N and N m.
    fn residuals(&mut self, at: &MotionAt<'_>, weights: &[f64], sum: &mut Covector);

    /// Of φ, φ̇ and `J a + J̇ v` of every equation of the loop joints.
    fn loops(&mut self, at: &MotionAt<'_>, weights: &[[f64; 3]], sum: &mut Covector);

    /// Of what cylinders with a valve depend on.
    fn cylinders(&mut self, at: &MotionAt<'_>, weights: &[CylinderSlopes], sum: &mut Covector);

    /// Of the numbers of feet.
    fn feet(&mut self, at: &MotionAt<'_>, weights: &FeetSlopes, sum: &mut Covector);

    /// Of the prescribed position and rate of every drive at a time.
    fn drive_motions(&mut self, t: f64, weights: &[[f64; 2]], sum: &mut Covector);
}

/// Times closer than this are the same stop, s.
const SAME: f64 = 1e-9;

/// Step of a difference along a direction, in units of m, rad and the scales of states: the error is its square, and rounding leaves 1e-9.
pub const DIFFERENCE: f64 = 1e-7;

/// The size of a change of a motion `[q, v, x]` of n coordinates; x has these scales.
#[must_use]
pub fn size_of(change: &[f64], n: usize, scales: &[f64]) -> f64 {
    let of_states = change[2 * n..].iter().zip(scales).map(|(x, scale)| x / scale);
    change[..2 * n].iter().copied().chain(of_states).fold(0.0, |size: f64, entry| size.max(entry.abs()))
}

/// Motions that move by this much, in the same units, while a number changes by its step, are differenced together with it.
const TOGETHER: std::ops::Range<f64> = 1e-9..1e-5;

/// A function of a crane at a motion.
pub type OfMotion<'a> = &'a mut dyn FnMut(&dyn DynCrane, &[f64]) -> Vec<f64>;

/// Derivative of a function at a motion along a change of the motion and a direction of the crane: central differences of both at once, or one
/// after the other if the steps that suit them are too different.
pub fn difference(
    crane: &dyn DynCrane,
    around: Option<Around<'_>>,
    (motion, change, size): (&[f64], &[f64], f64),
    of: OfMotion<'_>,
) -> Vec<f64> {
    let moved = |step: f64| motion.iter().zip(change).map(|(x, change)| x + step * change).collect::<Vec<f64>>();
    let mut between = |[less, more]: [&dyn DynCrane; 2], [from, to]: [f64; 2], width: f64| -> Vec<f64> {
        let less = of(less, &moved(from));
        of(more, &moved(to)).iter().zip(less).map(|(more, less)| (more - less) / width).collect()
    };
    let alone = DIFFERENCE / size;
    match around {
        Some(Around { cranes, steps: [down, up] }) if TOGETHER.contains(&(size * down.max(up))) => {
            between(cranes, [-down, up], down + up)
        }
        Some(Around { cranes, steps: [down, up] }) => {
            let of_crane = between(cranes, [0.0; 2], down + up);
            if size == 0.0 {
                return of_crane;
            }
            let of_motion = between([crane; 2], [-alone, alone], 2.0 * alone);
            of_crane.iter().zip(of_motion).map(|(one, other)| one + other).collect()
        }
        None if size == 0.0 => of(crane, motion).iter().map(|_| 0.0).collect(),
        None => between([crane; 2], [-alone, alone], 2.0 * alone),
    }
}

/// Derivatives of the states of forces that hold a start at rest.
#[must_use]
pub fn holding(crane: &dyn DynCrane, numbers: &dyn Numbers, q: &[f64], along: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let description = crane.description();
    if !description.has_force_states() {
        return vec![Vec::new(); along.len()];
    }
    let of = |direction: usize| {
        let change = &along[direction][..q.len()];
        let size = change.iter().fold(0.0, |size: f64, entry| size.max(entry.abs()));
        difference(crane, numbers.around(direction), (q, change, size), &mut |crane, q| {
            ForceStates::new(crane.description()).holding(crane, 0.0, q)
        })
    };
    (0..along.len()).map(of).collect()
}

/// A motion from a start at t = 0 with its derivatives along directions. `along`: those of the start `[q, v, x]`. Gives `observe` every sample
/// with its derivatives, and the time after every step, s. The method of the settings is not used. `quantities`: the results to which conditions of
/// events refer.
///
/// # Errors
/// As [`Simulation::run`](super::Simulation::run); a result only touches the value of a condition, or jumps over it.
pub fn simulate(
    crane: &dyn DynCrane,
    start: &InitialState,
    slopes: &mut dyn Slopes,
    mut along: Vec<Vec<f64>>,
    settings: &Settings,
    quantities: &Quantities,
    watch: &mut dyn WatchDerivatives,
) -> Result<Run, Stopped> {
    let mut course = Course::new(crane, 0.0, start, settings, quantities);
    let mut changed = None::<(Box<dyn DynCrane>, Box<dyn Slopes>)>;
    let mut times = vec![vec![0.0; crane.description().conditions().count()]; along.len()];
    let mut last = vec![0.0; along.len()];
    loop {
        let (present, slopes): (&dyn DynCrane, &mut dyn Slopes) = match &mut changed {
            Some((crane, slopes)) => (&**crane, &mut **slopes),
            None => (crane, &mut *slopes),
        };
        let (begin, state, settings) = course.phase();
        let any: &dyn DynCrane = present;
        let follower = Follower::new(present, any, slopes, along, &settings);
        let mut integration = Integration::by(Box::new(follower), any, begin, state, &settings)?;
        let mut observer = Derived { watch: &mut *watch, times: &times };
        let Some(happening) = course.follow(present, &mut integration, &mut observer)? else {
            return Ok(course.run(&integration));
        };
        let t = integration.sample().t;
        let mut derivatives = integration.stepper().at_event(t)?;
        let (after, passage) = pass(&mut course, present, &integration, happening)?;
        let numbers = integration.stepper().slopes();
        passage.push(present, numbers, &mut derivatives, &mut last);
        if let Some(condition) = happening.trigger.condition() {
            times.iter_mut().zip(&last).for_each(|(times, last)| times[condition] = *last);
        }
        let slopes_after =
            numbers.after(passage.event()).map_err(|error| course.refuse(present, happening, &error.to_string()))?;
        drop(integration);
        (along, changed) = (derivatives, Some((after, slopes_after)));
    }
}

/// Lets an event happen at a motion: the crane after it, and what it does to derivatives.
fn pass<S: Stepper + ?Sized>(
    course: &mut Course,
    present: &dyn DynCrane,
    integration: &Integration<'_, S>,
    happening: Happening,
) -> Result<(Box<dyn DynCrane>, Passage), Stopped> {
    let StateAt { t, q, v, x } = integration.sample().state;
    let after = course.after(present, happening)?;
    let condition = course.quantities_and_value(happening);
    course.pass([present, after.as_ref()], integration, happening)?;
    let (_, InitialState { q: pose, v: rates, x: states }, _) = course.phase();
    let motions = [[q, v, x].concat(), [&**pose, rates, states].concat()];
    let passage = Passage::new([present, after.as_ref()], happening, t, motions, condition);
    passage.map(|passage| (after, passage)).map_err(|why| course.refuse(present, happening, why))
}

/// Passes samples on with their derivatives.
struct Derived<'w> {
    watch: &'w mut dyn WatchDerivatives,
    times: &'w [Vec<f64>],
}

impl Observe<Follower<'_, '_>> for Derived<'_> {
    fn sample(
        &mut self,
        present: &dyn DynCrane,
        integration: &mut Integration<'_, Follower<'_, '_>>,
        course: &Course,
    ) -> ControlFlow<()> {
        let t = integration.sample().t;
        let derivatives = integration.stepper().derivatives(t);
        let derivatives = Derivatives {
            crane: present,
            numbers: integration.stepper_now().slopes(),
            motion: &derivatives,
            times: self.times,
        };
        self.watch.sample(&course.sample(integration), &derivatives);
        ControlFlow::Continue(())
    }

    fn step(&mut self, t: f64) -> ControlFlow<()> {
        self.watch.step(t)
    }
}

/// The derivatives of a sample.
#[derive(Clone, Copy)]
pub struct Derivatives<'a> {
    /// The crane, after the events so far, and its numbers.
    pub crane: &'a dyn DynCrane,
    /// By which they are.
    pub numbers: &'a dyn Slopes,
    /// Of `[q, v, x]`, direction by direction.
    pub motion: &'a [Vec<f64>],
    /// Of the times of events on conditions, direction by direction; 0 for those that have not happened.
    pub times: &'a [Vec<f64>],
}

/// An observer of a motion with derivatives.
pub trait WatchDerivatives {
    /// Receives a sample with its derivatives.
    fn sample(&mut self, sample: &Sample<'_>, derivatives: &Derivatives<'_>);

    /// Receives the time after every step, s, and may end the run.
    fn step(&mut self, t: f64) -> ControlFlow<()>;
}
