//! The rating of one pose.

use super::{
    Condition, Limit, Limits,
    search::{CHART, Range, Trial, largest},
};
use crate::{dyn_crane::DynCrane, statics::Settings};

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
}

/// Newton's method alone: if it fails from the pose of a slightly smaller load, there is no pose nearby.
pub(super) const NEWTON: Settings = Settings { tolerance: 1e-10, iterations: 30, load_steps: 0 };

impl Posed<'_> {
    /// The crane at rest with a value of the load's parameter, from a pose nearby.
    pub(super) fn rest(&mut self, value: f64, q: &[f64], settings: &Settings) -> Option<Condition> {
        self.crane.set_parameter(self.load, value).ok()?;
        let found = self.crane.equilibrium_holding(self.positions, q, settings);
        let stands = found.is_stable() && !self.crane.description().has_tipped(q, &found.q);
        stands.then(|| Condition::at(self.crane, found.q, self.positions))
    }

    /// Its rating, with the search starting from the nearby pose `q` and, if given, the load `guess`; also the pose with the minimum load.
    pub fn rate(&mut self, request: &RatingRequest<'_>, guess: Option<f64>, q: Vec<f64>) -> (Rating, Vec<f64>) {
        let RatingRequest { limits, load_range: [least, greatest], factor, spec_load } = *request;
        let limits = &limits.with_max_efforts(self.crane);
        let Some(empty) = self.rest(least, &q, &Settings::default()) else {
            let governing = Some(Limit::Equilibrium);
            return (Rating { load: None, governing, loaded: None, with_spec_load: None, deflections: Vec::new() }, q);
        };
        let with_spec_load =
            if spec_load == least { Some(empty.clone()) } else { self.rest(spec_load, &empty.q, &NEWTON) };
        let deflections = with_spec_load.as_ref().map_or_else(Vec::new, |condition| condition.deflections(&empty));
        let description = self.crane.description();
        let mass: f64 = description.bodies.iter().map(|body| body.mass).sum();
        let greatest = greatest.min(description.parameters[self.load].upper_bound.value / factor);
        let scale = mass.max(f64::MIN_POSITIVE);
        let range = Range { greatest, guess: guess.unwrap_or(spec_load), scale, accuracy: CHART };
        let slacks = empty.slacks(description, limits, &empty.points);
        let first = Trial { load: least / factor, slacks, at: empty.clone() };
        let mut trial = |load: f64, near: &Condition| {
            let at = self.rest(factor * load, &near.q, &NEWTON)?;
            Some(Trial { load, slacks: at.slacks(self.crane.description(), limits, &empty.points), at })
        };
        let (best, governing) = largest(first, &range, &mut trial);
        let q = empty.q.clone();
        let (load, loaded) = best.map_or((None, empty), |best| (Some(best.load), best.at));
        (Rating { load, governing, loaded: Some(loaded), with_spec_load, deflections }, q)
    }
}
