//! The axis of a divided beam as a smooth curve.
//!
//! Rigid elements form a polyline whose corners are the springs. The quadratic B-spline with these corners as control points touches every
//! inner element at the border of its sections and has a continuous direction. It is stated here without a choice of the section that contains
//! s: with n sections that begin at `s_k` and are `d_k` long, `x̂_k` the direction of element k = 0 … n and `τ_k = clamp((s − s_k)/d_k, 0, 1)`
//! the part of section k that is before s, the curve turns from `x̂_k` to `x̂_{k+1}` in section k, so that
//!
//! ```text
//! P′(s) = Σ e_k x̂_k      e_k = τ_{k−1} − τ_k,  τ_{−1} = 1, τ_n = 0                     the share of element k in the direction
//! P(s) = r_0 + Σ c_k x̂_k      c_k = ∫ e_k ds = d_{k−1} τ_{k−1}²/2 + d_k τ_k (1 − τ_k/2)    the way along element k
//!                             of the first also min(s, 0), of the last max(0, s − l)
//! ```
//!
//! `r_0` is the beginning of the beam. Beyond both ends the curve continues straight on. A motion of the coordinate j, whose joint is that of
//! element m, moves the point that is fixed to the curve with `Ω_j P` if m = 0, and otherwise with `ω_j × Σ_{k ≥ m} c_k x̂_k`.
//!
//! A force at P(s) thereby does work on several springs. Sections carry what is beyond them: there the force acts on the element on which s is.

use std::collections::BTreeMap;

use super::kinematics::{Kinematics, Pose};
use super::model::Model;
use super::vector::Vec3;
use crate::chain::{Axis, BeamAxis, CoordinateId, Stretch};
use crate::symbolic::Expr;

/// The axis of a beam at s.
pub struct AxisPoint<'a, 'g> {
    model: &'a Model<'g>,
    kinematics: &'a Kinematics<'g>,
    axis: &'a BeamAxis,
    s: Expr<'g>,
    /// Its sections, from the beginning to the end; of a rigid beam one without a spring.
    sections: Vec<Section<'g>>,
}

/// A section as seen from s.
#[derive(Clone, Copy)]
struct Section<'g> {
    /// Index of its stretch.
    stretch: usize,
    /// d, m.
    length: Expr<'g>,
    /// τ
    passed: Expr<'g>,
    /// `(s − its stretch's beginning)/d`, and this less the number of sections of the stretch.
    sigma: [Expr<'g>; 2],
    /// How many sections are between its middle and the end of its stretch.
    to_end: f64,
}

impl<'a, 'g> AxisPoint<'a, 'g> {
    /// At the distance s from the beginning of the beam, m.
    pub fn new(model: &'a Model<'g>, kinematics: &'a Kinematics<'g>, axis: &'a BeamAxis, s: Expr<'g>) -> Self {
        let (zero, one) = (model.zero(), model.graph.constant(1.0));
        let of_stretch = |(index, stretch): (usize, &Stretch)| {
            let (length, count) = (model.number(&stretch.section), stretch.sections as f64);
            let begin = if stretch.begin.is_zero() { s } else { s - model.number(&stretch.begin) };
            let sigma = begin / length;
            let section = |k: usize| Section {
                stretch: index,
                length,
                passed: (sigma - k as f64).clamp(zero, one),
                sigma: [sigma, sigma - count],
                to_end: count - 0.5 - k as f64,
            };
            (0..stretch.sections).map(section).collect::<Vec<_>>()
        };
        AxisPoint {
            model,
            kinematics,
            axis,
            s,
            sections: axis.division.stretches.iter().enumerate().flat_map(of_stretch).collect(),
        }
    }

    fn pose(&self, element: usize) -> &'a Pose<'g> {
        &self.kinematics.poses[self.axis.first.0 + element]
    }

    /// The sections before and after the middle of an element.
    fn beside(&self, element: usize) -> [Option<&Section<'g>>; 2] {
        [element.checked_sub(1).and_then(|k| self.sections.get(k)), self.sections.get(element)]
    }

    /// `e_k`
    fn share(&self, element: usize) -> Expr<'g> {
        let [before, after] = self.beside(element);
        let before = before.map_or(self.model.graph.constant(1.0), |section| section.passed);
        before - after.map_or(self.model.zero(), |section| section.passed)
    }

    /// `c_k`, m
    fn way(&self, element: usize) -> Expr<'g> {
        let zero = self.model.zero();
        // min(σ, 1) = τ_0 + min(σ, 0)
        let along = |after: &Section<'g>| after.passed + after.sigma[0].min(zero) - 0.5 * after.passed.squared();
        match self.beside(element) {
            [None, None] => self.s,
            [None, Some(after)] => after.length * along(after),
            [Some(before), None] => before.length * (0.5 * before.passed.squared() + before.sigma[1].max(zero)),
            [Some(before), Some(after)] => {
                let [squared, rest] = [before.passed.squared(), after.passed * (2.0 - after.passed)];
                if before.stretch == after.stretch {
                    before.length * (0.5 * (squared + rest))
                } else {
                    0.5 * (before.length * squared + after.length * rest)
                }
            }
        }
    }

    /// `Σ_{k ≥ m} f_k a_k` for every element m, a the given axis of the elements.
    fn sums(&self, axis: Axis, factor: impl Fn(usize) -> Expr<'g>) -> Vec<Vec3<'g>> {
        let mut sums: Vec<Vec3<'g>> = Vec::new();
        for element in (0..=self.sections.len()).rev() {
            let own = factor(element) * self.pose(element).rotation.axis(axis);
            sums.push(sums.last().map_or(own, |beyond| own + *beyond));
        }
        sums.reverse();
        sums
    }

    /// P, m.
    pub fn position(&self) -> Vec3<'g> {
        self.pose(0).origin + self.sums(Axis::X, |k| self.way(k))[0]
    }

    /// P′.
    pub fn direction(&self) -> Vec3<'g> {
        self.cross_axis(Axis::X)
    }

    /// `Σ e_k a_k` with an axis a of the elements: across the beam it turns evenly from each element to the next.
    pub fn cross_axis(&self, axis: Axis) -> Vec3<'g> {
        self.sums(axis, |k| self.share(k))[0]
    }

    /// `∂P/∂q_j` at constant s for all coordinates that move the beam, by their indices.
    pub fn position_slopes(&self) -> BTreeMap<usize, Vec3<'g>> {
        let (position, beyond) = (self.position(), self.sums(Axis::X, |k| self.way(k)));
        self.by_coordinate(|j, element| {
            let generator = &self.kinematics.generators[j];
            if element == 0 { generator.velocity(position) } else { generator.omega.cross(beyond[element]) }
        })
    }

    /// `Σ x_k τ_k (1 − τ_k)` over the sections.
    pub fn within_sections(&self, factors: impl Iterator<Item = Expr<'g>>) -> Expr<'g> {
        let of_section = |(section, factor): (&Section<'g>, Expr<'g>)| factor * section.passed * (1.0 - section.passed);
        self.sections.iter().zip(factors).map(of_section).fold(self.model.zero(), |sum, share| sum + share)
    }

    /// The same for [`cross_axis`](Self::cross_axis).
    pub fn cross_axis_slopes(&self, axis: Axis) -> BTreeMap<usize, Vec3<'g>> {
        let beyond = self.sums(axis, |k| self.share(k));
        self.by_coordinate(|j, element| self.kinematics.generators[j].rotate(beyond[element]))
    }

    /// The same for `Σ ∂e_k/∂s a_k`, and that sum.
    pub fn turning_slopes(&self, axis: Axis) -> (Vec3<'g>, BTreeMap<usize, Vec3<'g>>) {
        let beyond = self.axis_beyond(axis, true);
        (beyond[0], self.by_coordinate(|j, element| self.kinematics.generators[j].rotate(beyond[element])))
    }

    /// For every coordinate that moves the beam: from its index and the first element that it moves.
    fn by_coordinate(&self, slope: impl Fn(usize, usize) -> Vec3<'g>) -> BTreeMap<usize, Vec3<'g>> {
        let moving = self.model.chain.coordinates_of(self.axis.last()).into_iter();
        let body = |CoordinateId(j): CoordinateId| self.model.chain.coordinates[j].body.0;
        moving.map(|id| (id.0, slope(id.0, self.first_moved(body(id))))).collect()
    }

    /// The first element that the joint of a body moves.
    pub fn first_moved(&self, body: usize) -> usize {
        body.saturating_sub(self.axis.first.0)
    }

    /// `∂e_k/∂s` of every element, 1/m.
    fn share_slopes(&self) -> Vec<Expr<'g>> {
        let Self { model, kinematics, axis, s, .. } = self;
        let [free, _] = model.free_symbols();
        let anywhere = AxisPoint::new(model, kinematics, axis, free);
        let shares: Vec<_> = (0..=self.sections.len()).map(|element| anywhere.share(element)).collect();
        let slopes = model.graph.derivatives(&shares, free);
        slopes.into_iter().map(|slope| model.graph.substitute(slope, &[(free, *s)])).collect()
    }

    /// `Σ e_k a_k` over the elements that a generator moves, e its derivative by s if `by_place`; in place of all elements of those that
    /// move the whole beam.
    pub fn axis_beyond(&self, axis: Axis, by_place: bool) -> Vec<Vec3<'g>> {
        if by_place {
            let slopes = self.share_slopes();
            self.sums(axis, |k| slopes[k])
        } else {
            self.sums(axis, |k| self.share(k))
        }
    }

    /// `Σ c_k x̂_k` over the elements from each one on.
    pub fn ways_beyond(&self) -> Vec<Vec3<'g>> {
        self.sums(Axis::X, |k| self.way(k))
    }

    /// For every element 1 if s is on it, otherwise 0: each begins at its spring, the first and the last go on beyond the ends.
    pub fn here(&self) -> Vec<Expr<'g>> {
        let (zero, one) = (self.model.zero(), self.model.graph.constant(1.0));
        // s is behind the middle of the section before, from the distance to the end of its stretch.
        let begun = |element: usize| match element.checked_sub(1) {
            None => one,
            Some(k) => self.sections.get(k).map_or(zero, |before| (before.sigma[1] + before.to_end).select(one, zero)),
        };
        (0..=self.sections.len()).map(|element| begun(element) - begun(element + 1)).collect()
    }
}

#[cfg(test)]
mod tests;
