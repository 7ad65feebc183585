//! The rating of one pose.

use nalgebra::Vector3;

use super::{
    Condition, Limit, Limits,
    search::{CHART, FAST, Range, Trial, largest},
    sweep::mass_with,
};
use crate::{
    dyn_crane::DynCrane,
    statics::{Equilibrium, RestSearch, advance},
};

/// The largest load of a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Rating {
    /// The largest load within all limits, in the unit of the load's parameter; `None` if not even the minimum load is.
    pub load: Option<f64>,
    /// The limit that governs; `None` if none is reached up to the maximum load considered.
    pub governing: Option<Limit>,
    /// The crane with that load, or with the minimum load if there is none; `None` if no equilibrium is found.
    pub loaded: Option<Condition>,
    /// The crane with the load of its parameters; `None` if no equilibrium is found.
    pub with_spec_load: Option<Condition>,
    /// How far that load moves the points of interest, m; empty if no equilibrium is found.
    pub deflections: Vec<f64>,
}

/// A crane with its drives at given positions.
pub(super) struct Posed<'a> {
    /// The crane; its load is changed.
    pub crane: &'a mut dyn DynCrane,
    /// Index of the load among its parameters.
    pub load: usize,
    /// Positions of the drives.
    pub positions: &'a [f64],
}

/// Where a crane rests with its drives at some positions: a neighbour begins its search there.
pub(super) struct Rests {
    /// Positions of the drives.
    positions: Vec<f64>,
    /// The pose with the minimum load.
    empty: Vec<f64>,
    /// The pose with the load of its parameters, if it rests there.
    with_spec_load: Option<Vec<f64>>,
}

/// What to compute for a pose.
pub(super) struct RatingRequest<'a> {
    /// What limits the load.
    pub limits: &'a Limits,
    /// Minimum and maximum load.
    pub load_range: [f64; 2],
    /// Within the limits the crane must rest with this many times the load.
    pub factor: f64,
    /// Another load, for which the condition is computed too.
    pub spec_load: f64,
    /// A load that may be near the largest.
    pub guess: f64,
}

/// A search for the largest load of a pose.
pub(super) struct LoadSearch<'a> {
    /// What limits the load.
    pub limits: &'a Limits,
    /// The crane rests with this many times the load.
    pub factor: f64,
    /// The range in which the load is searched.
    pub range: Range,
    /// Positions of the points of interest from which their deflections count.
    pub points: &'a [Vector3<f64>],
}

/// Shortest step between loads with which the crane rests, as a fraction of the way.
const SHORTEST: f64 = 1.0 / 64.0;
/// Most steps of Newton's method to a pose nearby: three to five are usual.
const CLOSE: usize = 6;

impl Posed<'_> {
    /// The crane at rest with a value of the load's parameter, wherever it is found. `near`: positions of the drives, and the pose there.
    pub(super) fn find(&mut self, value: f64, near: Option<(&[f64], &[f64])>) -> Option<Condition> {
        self.crane.set_parameter(self.load, value).ok()?;
        let search = RestSearch { crane: self.crane, positions: self.positions };
        let found = self.condition(search.find(near));
        found.or_else(|| near.and_then(|_| self.condition(search.find(None))))
    }

    /// The rest with a value of the load's parameter, near a pose.
    fn find_near(&mut self, value: f64, q: &[f64]) -> Option<Equilibrium> {
        self.crane.set_parameter(self.load, value).ok()?;
        RestSearch { crane: self.crane, positions: self.positions }.find_near(q)
    }

    /// The crane at rest with the second load, on the path of its pose with the first one: a rest that takes Newton's method more than [`CLOSE`] steps may be on
    /// another path, beyond the end of this one, and is approached in shorter steps.
    fn follow_load(&mut self, [from, to]: [f64; 2], begin: &Condition) -> Option<Condition> {
        let found = self.find_near(to, &begin.q)?;
        if found.steps() <= CLOSE {
            return self.condition(found);
        }
        self.walk_load([from, to], begin.clone(), CLOSE)
    }

    /// The crane at rest as statics found it, if it stands there.
    pub(super) fn condition(&self, found: Equilibrium) -> Option<Condition> {
        let condition = found.is_stable().then(|| Condition::at(self.crane, found.q, self.positions))?;
        // Nothing holds a stage that stands crosswise in its beam.
        let is_held = condition.overlaps.iter().all(|(_, [inside, _])| *inside > f64::NEG_INFINITY);
        is_held.then_some(condition)
    }

    /// The crane at rest with the load `to`, from its pose with the load `from`, in steps between which it rests.
    pub(super) fn change_load(&mut self, from: f64, to: f64, begin: Condition) -> Option<Condition> {
        self.walk_load([from, to], begin, usize::MAX)
    }

    /// The same in steps that take Newton's method at most so many of its own.
    fn walk_load(&mut self, [from, to]: [f64; 2], begin: Condition, most: usize) -> Option<Condition> {
        let mut step = |at: &Condition, [_, part]: [f64; 2]| {
            let value = if part < 1.0 { from + part * (to - from) } else { to };
            let found = self.find_near(value, &at.q).filter(|found| found.steps() <= most)?;
            self.condition(found)
        };
        advance(begin, [SHORTEST, 1.0], &mut step)
    }

    /// The largest load from that of the trial `first` on, and what governs: trials begin at the pose with a smaller load, and a rest beyond a load
    /// with which the crane does not rest nearby does not count.
    pub(super) fn find_largest(&mut self, first: Trial, search: &LoadSearch<'_>) -> (Option<Trial>, Option<Limit>) {
        largest(first, &search.range, &mut |load, near| {
            let at = self.follow_load([near.load, load].map(|load| search.factor * load), &near.at)?;
            Some(self.trial(load, at, search))
        })
    }

    /// A trial load and its margins.
    pub(super) fn trial(&self, load: f64, at: Condition, search: &LoadSearch<'_>) -> Trial {
        Trial { load, margins: at.margins(self.crane.description(), search.limits, search.points), at }
    }

    /// Its rating, and where the crane rests.
    pub fn rate(&mut self, request: &RatingRequest<'_>, near: Option<&Rests>) -> (Rating, Option<Rests>) {
        let RatingRequest { limits, load_range: [least, greatest], factor, spec_load, guess } = *request;
        let limits = &limits.with_max_efforts(self.crane);
        let near_empty = near.map(|near| (near.positions.as_slice(), near.empty.as_slice()));
        let near_loaded = near.and_then(|near| Some((near.positions.as_slice(), near.with_spec_load.as_deref()?)));
        // Without a load, a rope may be slack, and a hook may stand upright: beside a pose with the load of the spec, the way down from it is the safer one.
        let mut with_spec_load = near_loaded.and_then(|near| self.find(spec_load, Some(near)));
        let down = |posed: &mut Self, from: &Option<Condition>| posed.change_load(spec_load, least, from.clone()?);
        let mut empty = down(self, &with_spec_load).or_else(|| self.find(least, near_empty));
        if empty.is_none() && with_spec_load.is_none() {
            with_spec_load = self.find(spec_load, near_empty);
            empty = down(self, &with_spec_load);
        }
        let Some(empty) = empty else {
            let governing = Some(Limit::Equilibrium);
            return (Rating { load: None, governing, loaded: None, with_spec_load, deflections: Vec::new() }, None);
        };
        // A search does not depend on the load that was tried last.
        let mass = mass_with(self.crane, self.load, least);
        let greatest = greatest.min(self.crane.description().parameters[self.load].upper_bound.value / factor);
        let range = Range { greatest, guess, scale: mass.max(f64::MIN_POSITIVE), accuracy: CHART, growth: FAST };
        let search = LoadSearch { limits, factor, range, points: &empty.points };
        let first = self.trial(least / factor, empty.clone(), &search);
        let (best, governing) = self.find_largest(first, &search);
        let (load, loaded) = best.map_or((None, empty.clone()), |best| (Some(best.load), best.at));
        let with_spec_load = match load {
            _ if spec_load == least => Some(empty.clone()),
            // On the way from the minimum to the largest load the crane rests; beyond, unless its rest has ended there.
            Some(load) if spec_load > factor * load && governing == Some(Limit::Equilibrium) => None,
            _ if with_spec_load.is_some() => with_spec_load,
            // A load may leave the pose of another one behind, as one that a side force swings about; then as statics finds it.
            Some(load) if spec_load > factor * load => {
                self.change_load(factor * load, spec_load, loaded.clone()).or_else(|| self.find(spec_load, near_empty))
            }
            _ => self.change_load(least, spec_load, empty.clone()).or_else(|| self.find(spec_load, near_empty)),
        };
        let deflections = with_spec_load.as_ref().map_or_else(Vec::new, |condition| condition.deflections(&empty));
        let of_spec = with_spec_load.as_ref().map(|condition| condition.q.clone());
        let rests = Rests { positions: self.positions.to_vec(), empty: empty.q, with_spec_load: of_spec };
        (Rating { load, governing, loaded: Some(loaded), with_spec_load, deflections }, Some(rests))
    }
}
