//! All poses of an envelope, in pieces on several threads.

use std::{
    ops::Range,
    sync::{Mutex, PoisonError},
    thread,
};

use super::{
    Axes, Limits, Rating,
    rating::{Posed, RatingRequest, Rests},
};
use crate::{Description, ParameterError, ParameterInfo, dyn_crane::DynCrane};

/// Maximum number of poses in a piece.
pub const PIECE: usize = 25;

/// What to compute for a crane.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// What is varied.
    pub axes: Axes,
    /// Index of the live parameter that is the load.
    pub load: usize,
    /// Minimum and maximum load considered.
    pub loads: [f64; 2],
    /// What limits it.
    pub limits: Limits,
    /// With the largest load the crane is within its limits even if the load is this many times as heavy.
    pub factor: f64,
}

/// How an envelope is computed.
pub struct Execution<'a> {
    /// Number of threads.
    pub threads: usize,
    /// Called with the ratings of every completed piece, in the order of completion, from any thread.
    pub done: &'a (dyn Fn(usize, &[Rating]) + Sync),
    /// Whether to end: unfinished pieces are not reported. Asked before every pose.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
}

/// Minimum load to try if zero is not allowed, kg: a gram.
const LEAST_LOAD: f64 = 1e-3;
/// Maximum load considered, in multiples of the crane's mass.
const GREATEST_LOAD: f64 = 100.0;

/// Units of loads: of masses, of forces and moments, and of a factor.
pub const UNITS_OF_LOADS: [&str; 12] = ["kg", "t", "g", "lb", "N", "kN", "MN", "N m", "kN m", "1", "-", ""];

/// Whether a live parameter may be a load, by its unit: a mass, a force, a moment, or a factor of one of them.
pub fn is_load(parameter: &ParameterInfo) -> bool {
    UNITS_OF_LOADS.contains(&parameter.unit.as_str())
}

/// Index of the live parameter that is the load unless another is named: the only one in kg.
pub fn only_mass(description: &Description) -> Option<usize> {
    let mut masses = description.parameters.iter().enumerate().filter(|(_, parameter)| parameter.unit == "kg");
    masses.next().filter(|_| masses.next().is_none()).map(|(index, _)| index)
}

/// The minimum load, which is allowed and as near to zero as possible, and the maximum load to consider: `greatest`, or a hundred times the
/// mass of the crane.
pub fn range_of_loads(crane: &dyn DynCrane, load: usize, greatest: Option<f64>) -> [f64; 2] {
    let info = &crane.description().parameters[load];
    let is_allowed = |value: &f64| info.check(*value).is_ok();
    let least = [0.0, LEAST_LOAD, info.lower_bound.value].into_iter().find(is_allowed).unwrap_or(info.default);
    [least, greatest.unwrap_or(GREATEST_LOAD * crane.mass().max(1.0)).min(info.upper_bound.value)]
}

/// Mass of the crane with a load, which it keeps, kg.
pub(super) fn mass_with(crane: &mut dyn DynCrane, parameter: usize, load: f64) -> f64 {
    // A load that is not allowed leaves the previous one.
    let _ = crane.set_parameter(parameter, load);
    crane.mass()
}

impl Envelope {
    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        let row = self.axes.row();
        self.axes.poses() / row.max(1) * row.div_ceil(PIECE)
    }

    /// Poses of a piece: neighbours on the last axis.
    pub fn poses_of(&self, piece: usize) -> Range<usize> {
        let row = self.axes.row();
        let pieces = row.div_ceil(PIECE).max(1);
        let (begin, part) = (piece / pieces * row, piece % pieces);
        begin + part * PIECE..begin + row.min((part + 1) * PIECE)
    }

    /// Rates some pieces.
    ///
    /// # Errors
    /// Values of parameters on an axis, or the minimum load, break a rule of the spec language.
    pub fn run(&self, crane: &dyn DynCrane, pieces: &[usize], execution: &Execution<'_>) -> Result<(), ParameterError> {
        let waiting = Mutex::new(pieces.iter());
        let refused = Mutex::new(None);
        let work = || {
            let mut own_crane = crane.boxed_clone();
            loop {
                let next = waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
                let (Some(&piece), false) = (next, (execution.cancelled)()) else { break };
                match self.rate(crane, own_crane.as_mut(), piece, execution.cancelled) {
                    Ok(Some(ratings)) => (execution.done)(piece, &ratings),
                    Ok(None) => break,
                    Err(error) => {
                        *refused.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                        break;
                    }
                }
            }
        };
        thread::scope(|scope| {
            for _ in 1..execution.threads.min(pieces.len()) {
                scope.spawn(work);
            }
            work();
        });
        refused.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }

    /// Rates the poses of a piece with a copy of the crane; `None` if it is cancelled.
    fn rate(
        &self,
        crane: &dyn DynCrane,
        own_crane: &mut dyn DynCrane,
        piece: usize,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<Option<Vec<Rating>>, ParameterError> {
        let poses = self.poses_of(piece);
        let mut ratings: Vec<Rating> = Vec::with_capacity(poses.len());
        // Where the crane rested last.
        let mut near: Option<Rests> = None;
        for pose in poses {
            if cancelled() {
                return Ok(None);
            }
            let mut parameters = self.axes.parameters(crane, pose);
            let load = parameters[self.load];
            parameters[self.load] = self.loads[0];
            own_crane.set_parameters(&parameters)?;
            let positions = self.axes.positions(own_crane, pose);
            let guess = ratings.last().and_then(|rating| rating.load);
            let request = RatingRequest {
                limits: &self.limits,
                load_range: self.loads,
                factor: self.factor,
                spec_load: load,
                guess: guess.unwrap_or(load),
            };
            let posed = &mut Posed { crane: own_crane, load: self.load, positions: &positions };
            let (rating, rests) = posed.rate(&request, near.as_ref());
            near = rests.or(near);
            ratings.push(rating);
        }
        Ok(Some(ratings))
    }
}
