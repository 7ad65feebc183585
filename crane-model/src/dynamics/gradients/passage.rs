//! What happens to derivatives at an event.
//!
//! An event on a condition `g(t, y, p) = c` happens at a time that depends on p, and makes of the state y⁻ another one, `y⁺ = R(y⁻, p)`:
//!
//! ```text
//! dt/dp = −(∂g/∂y s⁻ + ∂g/∂p)/ġ,      ġ = ∂g/∂t + ∂g/∂y F⁻
//! s⁺ = ∂R/∂y (s⁻ + F⁻ dt/dp) + ∂R/∂p − F⁺ dt/dp
//! ```
//!
//! R changes rates only, by the impact of what joins; its derivatives and those of results g that are not coordinates or rates are central differences.
//! From then on the parameters that the event sets are numbers, on which nothing depends. At a time that is given `dt/dp = 0`; an event that holds
//! because of another one happens with it.

use super::{
    Covector, DIFFERENCE, Numbers,
    columns::{column_along, columns_by},
    difference,
    rates::Rates,
    size_of,
};
use crate::{
    EventInfo, StateAt,
    dyn_crane::DynCrane,
    dynamics::{
        Happening, Quantities, ResultsAt,
        course::Trigger,
        events::{after, rates_after},
        motion::add,
    },
    force_states::ForceStates,
};

/// An event, and the motion at it. Its cranes are those before and after it.
pub(super) struct Passage {
    event: EventInfo,
    t: f64,
    /// The motion before it, in full.
    motion: Vec<f64>,
    trigger: Trigger,
    /// F⁻ and F⁺, unless its time is given.
    rates: [Vec<f64>; 2],
    /// Of the condition: its results, and ġ.
    results: ResultsAt,
    speed: f64,
}

/// Step in time for ġ: the motion moves by this much, in units of m, rad and the scales of states; and the longest one, s.
const MOVES: f64 = 10.0 * DIFFERENCE;
const LONGEST: f64 = 1e-4;
/// A result that is further from its value where it passes it than this share of its change over two steps in time jumps over it, or only touches it.
const FAR: f64 = 0.1;

impl Passage {
    /// An event at a time, s, and at the motions before and after it, with the results to which conditions refer and the value at which that of the event is.
    pub fn new(
        [before, after]: [&dyn DynCrane; 2],
        Happening { event, trigger, .. }: Happening,
        t: f64,
        [motion, state]: [Vec<f64>; 2],
        (quantities, value): (Quantities, f64),
    ) -> Result<Self, &'static str> {
        let event = before.description().events[event].clone();
        let mut own =
            Self { event, t, motion, trigger, rates: Default::default(), results: quantities.at, speed: f64::NAN };
        if trigger == Trigger::Time {
            return Ok(own);
        }
        let rates = |crane: &dyn DynCrane, motion: &[f64]| {
            Rates::new(crane, 0).at(t, motion).map_err(|_| "has no derivatives: accelerations are not finite")
        };
        own.rates = [rates(before, &own.motion)?, rates(after, &state)?];
        if let Trigger::Condition(column, _) = trigger {
            let n = before.size();
            let size = size_of(&own.rates[0], n, &ForceStates::new(before.description()).scales());
            let step = (MOVES / size).min(LONGEST);
            let at = |by: f64| {
                let mut moved = own.motion.clone();
                add(&mut moved, by, &own.rates[0]);
                (own.results)(before, &StateAt::from_motion(t + by, n, &moved))[column]
            };
            let change = at(step) - at(-step);
            // The comparison is false for NaN.
            let passes = (at(0.0) - value).abs() <= FAR * change.abs();
            if !passes {
                return Err("has no derivatives: its result jumps over the value, or only touches it");
            }
            own.speed = if (1..=2 * n).contains(&column) { own.rates[0][column - 1] } else { change / (2.0 * step) };
        }
        Ok(own)
    }

    /// The rates after the event, of a motion before it.
    fn rates_after(&self, cranes: [&dyn DynCrane; 2], motion: &[f64]) -> Vec<f64> {
        let n = cranes[0].size();
        rates_after(cranes, &self.event, &motion[..n], &motion[n..2 * n])
    }

    /// The same of a crane beside that before the event.
    fn rates_beside(&self, crane: &dyn DynCrane, motion: &[f64]) -> Vec<f64> {
        // What the rules refuse has no derivative.
        self.after(crane)
            .map_or_else(|| vec![f64::NAN; crane.size()], |after| self.rates_after([crane, after.as_ref()], motion))
    }

    fn after(&self, crane: &dyn DynCrane) -> Option<Box<dyn DynCrane>> {
        after(crane, [&self.event]).ok()
    }

    /// Leads derivatives of the motion over the event; `times` are those of the time of the last event, and then of this one.
    pub fn push(&self, before: &dyn DynCrane, numbers: &dyn Numbers, along: &mut [Vec<f64>], times: &mut [f64]) {
        let (n, scales) = (before.size(), ForceStates::new(before.description()).scales());
        for (direction, (along, time)) in along.iter_mut().zip(times).enumerate() {
            let around = || numbers.around(direction);
            match self.trigger {
                Trigger::Time => *time = 0.0,
                Trigger::Event(_) => {}
                Trigger::Condition(column, _) => {
                    let at = (self.t, &*self.motion);
                    *time = -column_along(before, around(), at, along, column, self.results) / self.speed;
                }
            }
            if *time != 0.0 {
                add(along, *time, &self.rates[0]);
            }
            if self.event.joins.is_some() {
                let size = size_of(along, n, &scales);
                let rates = difference(before, around(), (&self.motion, along, size), &mut |crane, motion| {
                    self.rates_beside(crane, motion)
                });
                along[n..2 * n].copy_from_slice(&rates);
            }
            if *time != 0.0 {
                add(along, -*time, &self.rates[1]);
            }
        }
    }

    /// The transpose of [`push`](Self::push): from weights of the motion after the event and of its time to those of the motion before and of all
    /// numbers. Returns the weight of the time of the event before.
    pub fn pull(&self, cranes: [&dyn DynCrane; 2], numbers: &dyn Numbers, sum: &mut Covector, of_time: f64) -> f64 {
        let n = cranes[0].size();
        let dot = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(one, other)| one * other).sum::<f64>();
        let mut of_time = of_time;
        if self.trigger != Trigger::Time {
            of_time -= dot(&sum.motion, &self.rates[1]);
        }
        if self.event.joins.is_some() {
            let of_rates = sum.motion[n..2 * n].to_vec();
            for (direction, number) in sum.numbers.iter_mut().enumerate() {
                let around = numbers.around(direction);
                if around.is_some() {
                    let nothing = vec![0.0; self.motion.len()];
                    let rates = difference(cranes[0], around, (&self.motion, &nothing, 0.0), &mut |crane, motion| {
                        self.rates_beside(crane, motion)
                    });
                    *number += dot(&of_rates, &rates);
                }
            }
            sum.motion[n..2 * n].fill(0.0);
            for index in 0..2 * n {
                let mut change = vec![0.0; self.motion.len()];
                change[index] = 1.0;
                let rates = difference(cranes[0], None, (&self.motion, &change, 1.0), &mut |_, motion| {
                    self.rates_after(cranes, motion)
                });
                sum.motion[index] += dot(&of_rates, &rates);
            }
        }
        if self.trigger == Trigger::Time {
            return 0.0;
        }
        of_time += dot(&sum.motion, &self.rates[0]);
        let Trigger::Condition(column, _) = self.trigger else { return of_time };
        let by = columns_by(cranes[0], numbers, (self.t, &self.motion), &[column], self.results);
        for by in by {
            add(&mut sum.motion, -of_time / self.speed, &by.motion);
            add(&mut sum.numbers, -of_time / self.speed, &by.numbers);
        }
        0.0
    }

    /// Which of the conditions it waits for.
    pub fn condition(&self) -> Option<usize> {
        self.trigger.condition()
    }

    /// The event.
    pub fn event(&self) -> &EventInfo {
        &self.event
    }

    /// When, s.
    pub fn time(&self) -> f64 {
        self.t
    }
}
