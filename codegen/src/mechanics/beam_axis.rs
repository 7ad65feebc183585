//! The axis of a divided beam as a smooth curve.
//!
//! Rigid elements form a polyline whose corners are the springs. The quadratic B-spline with these corners as control points touches every
//! inner element in its middle and has a continuous direction. It is stated here without a choice of the section that contains s: with n
//! sections of length d, `σ = s/d`, `x̂_k` the direction of element k = 0 … n and `τ_k = clamp(σ − k, 0, 1)` the part of section k that is
//! before s, the curve turns from `x̂_k` to `x̂_{k+1}` in section k, so that
//!
//! ```text
//! P′(s) = Σ e_k x̂_k      e_k = τ_{k−1} − τ_k,  τ_{−1} = 1, τ_n = 0             the share of element k in the direction
//! P(s) = r_0 + Σ c_k x̂_k      c_k = ∫ e_k ds = d/2 (τ_{k−1}² + τ_k (2 − τ_k))      the way along element k
//!                             c_0 = d (min(σ, 1) − τ_0²/2),  c_n = d (τ_{n−1}²/2 + max(0, σ − n))
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
use crate::chain::{Axis, BeamAxis, CoordinateId};
use crate::symbolic::Expr;

/// The axis of a beam at s.
pub struct AxisPoint<'a, 'g> {
    model: &'a Model<'g>,
    kinematics: &'a Kinematics<'g>,
    axis: &'a BeamAxis,
    /// `σ − n`, in sections.
    past_end: Expr<'g>,
    /// `min(σ, 0)`.
    before_start: Expr<'g>,
    s: Expr<'g>,
    /// d, m.
    section: Expr<'g>,
    /// `τ_k`
    passed: Vec<Expr<'g>>,
}

impl<'a, 'g> AxisPoint<'a, 'g> {
    /// At the distance s from the beginning of the beam, m.
    pub fn new(model: &'a Model<'g>, kinematics: &'a Kinematics<'g>, axis: &'a BeamAxis, s: Expr<'g>) -> Self {
        let (zero, one) = (model.zero(), model.graph.constant(1.0));
        let section = model.number(&axis.length) / axis.sections.max(1) as f64;
        let sigma = s / section;
        let passed = (0..axis.sections).map(|k| (sigma - k as f64).clamp(zero, one)).collect();
        AxisPoint {
            past_end: sigma - axis.sections as f64,
            before_start: sigma.min(zero),
            model,
            kinematics,
            axis,
            s,
            section,
            passed,
        }
    }

    fn pose(&self, element: usize) -> &'a Pose<'g> {
        &self.kinematics.poses[self.axis.first.0 + element]
    }

    /// `τ_{k−1}` and `τ_k` of an element.
    fn passed_by(&self, element: usize) -> [Expr<'g>; 2] {
        let before = element.checked_sub(1).map_or(self.model.graph.constant(1.0), |k| self.passed[k]);
        [before, self.passed.get(element).copied().unwrap_or(self.model.zero())]
    }

    /// `e_k`
    fn share(&self, element: usize) -> Expr<'g> {
        let [before, after] = self.passed_by(element);
        before - after
    }

    /// `c_k`, m
    fn way(&self, element: usize) -> Expr<'g> {
        let n = self.axis.sections;
        let [before, after] = self.passed_by(element);
        // min(σ, 1) = τ_0 + min(σ, 0)
        self.section
            * match element {
                0 if n == 0 => self.past_end,
                0 => after + self.before_start - 0.5 * after.squared(),
                k if k == n => 0.5 * before.squared() + self.past_end.max(self.model.zero()),
                _ => 0.5 * (before.squared() + after * (2.0 - after)),
            }
    }

    /// `Σ_{k ≥ m} f_k a_k` for every element m, a the given axis of the elements.
    fn sums(&self, axis: Axis, factor: impl Fn(usize) -> Expr<'g>) -> Vec<Vec3<'g>> {
        let mut sums: Vec<Vec3<'g>> = Vec::new();
        for element in (0..=self.axis.sections).rev() {
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
        let shares: Vec<_> = (0..=axis.sections).map(|element| anywhere.share(element)).collect();
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
        let n = self.axis.sections;
        // σ > k − ½, from the distance to the end, which is there for a rigid beam, too.
        let begun = |element: usize| match element {
            0 => one,
            k if k > n => zero,
            k => (self.past_end + (n as f64 + 0.5 - k as f64)).select(one, zero),
        };
        (0..=n).map(|element| begun(element) - begun(element + 1)).collect()
    }
}

#[cfg(test)]
mod tests;
