//! Telescopes whose beams leave each other.

use super::{Plausibility, angles::positions, rounded};
use crate::chain::{CoordinateId, Stage};
use crate::diagnostic::{Span, rule};
use crate::spec::{Motion, entries};

/// Largest usual clearance of a pad, m, and against twist, rad.
const WIDEST: [f64; 3] = [0.05, 0.05, 0.2];
/// Least stiffness of a pad, N/m.
const SOFTEST: f64 = 1e4;

impl Plausibility<'_> {
    /// Pads whose clearance or stiffness is in another unit.
    pub(super) fn pads(&mut self) {
        for link in entries(Some(&self.crane.links)) {
            let slides = link.beam.as_ref().and_then(|beam| beam.value.as_ref()?.slides_in.as_ref()?.value.as_ref());
            let Some(pads) = slides.and_then(|slides| slides.pads.value.as_ref()) else { continue };
            let name = link.name.value.as_deref().unwrap_or_default();
            for pad in [&pads.front, &pads.rear].into_iter().filter_map(|pad| pad.value.as_ref()) {
                let clearances = pad.clearance.as_ref().and_then(|given| given.value.as_ref());
                for ((given, widest), unit) in clearances.into_iter().flatten().zip(WIDEST).zip(["m", "m", "rad"]) {
                    let (clearance, at) = self.number(given);
                    if clearance > widest {
                        self.warn(rule::wide_clearance(at, name, rounded(clearance), unit));
                    }
                }
                for given in pad.stiffness.iter().filter_map(|given| given.value.as_ref()).flatten().take(2) {
                    let (stiffness, at) = self.number(given);
                    if stiffness > 0.0 && stiffness < SOFTEST {
                        self.warn(rule::soft_pads(at, name, rounded(stiffness)));
                    }
                }
            }
        }
    }

    /// Stages that a motion or a guess draws out so far that pads hold them poorly, or not at all: at most one warning each.
    pub(super) fn overlaps(&mut self) {
        for stage in self.chain.stages() {
            let reached = self.reached(stage.coordinate, self.chain.coordinates.len());
            if let Some(&(x, at)) = reached.iter().min_by(|a, b| a.0.total_cmp(&b.0)) {
                self.pushed_in(&stage, x, at);
            }
            if let Some((x, at)) = reached.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
                self.overlap(&stage, x, at);
            }
        }
    }

    /// A stage that is pushed in so far that it sticks out behind.
    fn pushed_in(&mut self, stage: &Stage<'_>, x: f64, at: Span) {
        /// Rounding of lengths, relative.
        const ROUNDING: f64 = 1e-6;
        let chain = self.chain;
        let overlap = stage.overlap(x, &self.values);
        let [inner, outer] = [stage.inner, stage.outer.first].map(|body| &chain.bodies[body.0].link);
        let of_inner = chain.bodies.iter().filter(|body| body.link == *inner);
        let length: f64 = of_inner.map(|body| body.length.at(&self.values)).sum();
        let longest = stage.outer.length.at(&self.values).min(length);
        if overlap > longest * (1.0 + ROUNDING) {
            let name = &chain.coordinates[stage.coordinate.0].name;
            let [overlap, x, longest] = [overlap, x, longest].map(rounded);
            self.warn(rule::pushed_through(at, inner, outer, overlap, name, x, longest));
        }
    }

    fn overlap(&mut self, stage: &Stage<'_>, x: f64, at: Span) {
        let chain = self.chain;
        let overlap = stage.overlap(x, &self.values);
        let height = chain.height_of(stage.inner).map_or(0.0, |height| height.at(&self.values));
        let [inner, outer] = [stage.inner, stage.outer.first].map(|body| &chain.bodies[body.0].link);
        let name = &chain.coordinates[stage.coordinate.0].name;
        let least = rounded(stage.overlap(0.0, &self.values) - height);
        if overlap <= 0.0 {
            self.warn(rule::out_of_beam(at, inner, outer, rounded(overlap), name, rounded(x), least));
        } else if overlap < height {
            let [overlap, x, height] = [overlap, x, height].map(rounded);
            self.warn(rule::short_overlap(at, inner, overlap, name, x, height, least));
        }
    }

    /// Where the motions and the guess of the spec take a coordinate, and where in the text: by its own drive, or by those of coordinates that
    /// it follows, of which there may be so many.
    fn reached(&self, coordinate: CoordinateId, leaders: usize) -> Vec<(f64, Span)> {
        let (crane, chain) = (self.crane, self.chain);
        let name = &chain.coordinates[coordinate.0].name;
        let of_drives = entries(crane.drives.as_ref()).filter(|drive| drive.coordinate.value.as_ref() == Some(name));
        let of_drives = of_drives.filter_map(|drive| drive.motion.as_ref()?.value.as_ref());
        let mut found: Vec<(f64, Span)> = of_drives.flat_map(|motion| self.stations(motion)).collect();
        let guess = crane.guess.as_ref().and_then(|guess| guess.value.as_ref());
        let guess = guess.into_iter().flat_map(|guess| &guess.0).filter(|(text, _)| text.value.as_ref() == Some(name));
        found.extend(guess.filter_map(|(_, at)| Some((self.scalar(&at.value.as_ref()?.0), at.span))));
        let Some(leaders) = leaders.checked_sub(1) else { return found };
        for follower in chain.followers().filter(|follower| follower.coordinate == coordinate) {
            let ratio = follower.ratio.at(&self.values);
            found.extend(self.reached(follower.leader, leaders).into_iter().map(|(x, at)| (ratio * x, at)));
        }
        found
    }

    /// The positions of a motion, and where a speed leads within the run.
    fn stations(&self, motion: &Motion) -> Vec<(f64, Span)> {
        if let Motion::Input(name) = motion {
            let Some(input) = self.named_input(name) else { return Vec::new() };
            let unless_set = input.motion.as_ref().and_then(|motion| motion.value.as_ref());
            let value = input.value.as_ref();
            let value = value.and_then(|given| Some((self.scalar(&given.value.as_ref()?.0), given.span)));
            return unless_set.map(|motion| self.stations(motion)).into_iter().flatten().chain(value).collect();
        }
        let given = positions(motion).into_iter();
        let mut found: Vec<(f64, Span)> = given.filter_map(|(scalar, at)| Some((self.scalar(scalar?), at))).collect();
        if let Motion::Speed(speed) = motion {
            let number = |given: &crate::spec::Angle| self.scalar(&given.0);
            let rate = speed.rate.value.as_ref().map_or(0.0, number);
            let begin = speed.begin.as_ref().map_or(0.0, |begin| self.number(begin).0);
            let from = found.first().map_or(0.0, |(from, _)| *from);
            found.push((from + rate * (self.chain.run.duration - begin).max(0.0), speed.rate.span));
        }
        found
    }
}
