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
/// Parts of a stride at which the stiffness is looked at.
const BETWEEN: [f64; 5] = [0.75, 0.5, 0.25, 0.125, 0.0625];
/// How many times less than at both ends of a stride `det K` may be in between.
const DIP: f64 = 4.0;
/// A way back ends where it began up to this fraction of its length: Newton's method is far more exact, and paths are further from each other.
const CLOSE: f64 = 1e-3;

impl Posed<'_> {
    /// The crane at rest with a value of the load's parameter, wherever it is found. `near`: positions of the drives, and the pose there.
    pub(super) fn find(&mut self, value: f64, near: Option<(&[f64], &[f64])>) -> Option<Condition> {
        self.crane.set_parameter(self.load, value).ok()?;
        let search = RestSearch { crane: self.crane, positions: self.positions };
        let found = self.condition(search.find(near));
        found.or_else(|| near.and_then(|_| self.condition(search.find(None))))
    }

    /// Statics with a value of the load's parameter.
    fn with_load(&mut self, value: f64) -> Option<RestSearch<'_>> {
        self.crane.set_parameter(self.load, value).ok()?;
        Some(RestSearch { crane: self.crane, positions: self.positions })
    }

    /// The rest with the second load that Newton's method finds from the rest `begin` with the first one, if it lies on the path of that one: a stride may pass the
    /// end of a path and lead to another one, which may even lead back.
    ///
    /// On a path the stiffness K is positive definite; between two paths it is not, as the energy has a pass there. Both are looked at along the straight line, most closely
    /// near its beginning, since a crane that snaps through goes far. `det K` shows a pass between two places, however little of the motion it is: it dips. Besides,
    /// Newton's method contracts from the first step on, or the way back ends where it began. What does not hold for a bent path holds in shorter strides.
    pub(super) fn find_next(&mut self, [from, to]: [f64; 2], begin: &[f64]) -> Option<Equilibrium> {
        let equilibrium = self.with_load(to)?.find_near(begin)?;
        if equilibrium.steps() <= 1 {
            return Some(equilibrium);
        }
        let between =
            |part: f64| begin.iter().zip(&equilibrium.q).map(|(a, b)| a + part * (b - a)).collect::<Vec<f64>>();
        let mut stiffness = |part: f64| self.with_load(from + part * (to - from))?.stiffness_at(&between(part));
        let least = stiffness(0.0)?.min(stiffness(1.0)?) - DIP.ln();
        if BETWEEN.iter().any(|part| stiffness(*part).is_none_or(|between| between < least)) {
            return None;
        }
        if !equilibrium.contracts() {
            let back = self.with_load(from)?.find_near(&equilibrium.q)?;
            let distance = |q: &[f64]| begin.iter().zip(q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if distance(&back.q) > CLOSE * distance(&equilibrium.q) {
                return None;
            }
        }
        self.with_load(to)?;
        Some(equilibrium)
    }

    /// The crane at rest as statics found it, if it stands there.
    pub(super) fn condition(&self, equilibrium: Equilibrium) -> Option<Condition> {
        let condition = equilibrium.is_stable().then(|| Condition::at(self.crane, equilibrium.q, self.positions))?;
        // Nothing holds a stage that stands crosswise in its beam.
        let is_held = condition.overlaps.iter().all(|(_, [inside, _])| *inside > f64::NEG_INFINITY);
        is_held.then_some(condition)
    }

    /// The crane at rest with the load `to`, on the path of its pose with the load `from`, in steps between which it rests.
    pub(super) fn change_load(&mut self, from: f64, to: f64, begin: Condition) -> Option<Condition> {
        let at = |part: f64| if part < 1.0 { from + part * (to - from) } else { to };
        let mut step = |begin: &Condition, parts: [f64; 2]| {
            let equilibrium = self.find_next(parts.map(at), &begin.q)?;
            self.condition(equilibrium)
        };
        advance(begin, [SHORTEST, 1.0], &mut step)
    }

    /// The largest load from that of the trial `first` on, and what governs: trials begin at the pose with a smaller load, and
    /// only rests on its path count.
    pub(super) fn find_largest(&mut self, first: Trial, search: &LoadSearch<'_>) -> (Option<Trial>, Option<Limit>) {
        largest(first, &search.range, &mut |load, near| {
            let next = self.find_next([near.load, load].map(|load| search.factor * load), &near.at.q)?;
            Some(self.trial(load, self.condition(next)?, search))
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
