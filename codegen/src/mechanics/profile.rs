//! Prescribed motions as expressions of time.
//!
//! All are written with clamped times, so they hold their first value before and their last value after, without a
//! branch.

use std::f64::consts::TAU;

use super::model::Model;
use crate::chain::{Profile, Ramp, Segment};
use crate::symbolic::Expr;

/// `q_dr(t)`, m or rad.
pub fn position<'g>(model: &Model<'g>, profile: &Profile, t: Expr<'g>) -> Expr<'g> {
    let blend = |ramp: &Ramp, share: Expr<'g>| {
        let from = model.number(&ramp.from);
        from + (model.number(&ramp.to) - from) * share
    };
    match profile {
        Profile::Hold(at) => model.number(at),
        Profile::Quintic(ramp) => {
            let tau = tau(model, ramp, t);
            blend(ramp, tau * tau * tau * (tau * (tau * 6.0 - 15.0) + 10.0))
        }
        Profile::Cubic(ramp) => {
            let tau = tau(model, ramp, t);
            blend(ramp, tau * tau * (3.0 - tau * 2.0))
        }
        Profile::Cycloid(ramp) => {
            let tau = tau(model, ramp, t);
            blend(ramp, tau - (tau * TAU).sin() / TAU)
        }
        Profile::Trapezoid { ramp, blend: share } => {
            let [up, level, down] = phases(model, ramp, *share, t);
            let curved = (up.squared() - down.squared()) / (2.0 * share);
            blend(ramp, (curved + level + down) / (1.0 - share))
        }
        Profile::Table { from, segments } => segments.iter().fold(model.graph.constant(*from), |sum, segment| {
            let u = local_time(model, segment, t);
            let [c1, c2, c3] = segment.coefficients;
            sum + u * (u * (u * c3 + c2) + c1)
        }),
    }
}

/// `q̇_dr(t)`, m/s or rad/s.
pub fn rate<'g>(model: &Model<'g>, profile: &Profile, t: Expr<'g>) -> Expr<'g> {
    let scale = |ramp: &Ramp, slope: Expr<'g>| {
        let travel = model.number(&ramp.to) - model.number(&ramp.from);
        travel / model.number(&ramp.duration) * slope
    };
    match profile {
        Profile::Hold(_) => model.zero(),
        Profile::Quintic(ramp) => {
            let tau = tau(model, ramp, t);
            scale(ramp, (tau * (1.0 - tau)).squared() * 30.0)
        }
        Profile::Cubic(ramp) => {
            let tau = tau(model, ramp, t);
            scale(ramp, tau * (1.0 - tau) * 6.0)
        }
        Profile::Cycloid(ramp) => {
            let tau = tau(model, ramp, t);
            scale(ramp, 1.0 - (tau * TAU).cos())
        }
        Profile::Trapezoid { ramp, blend } => {
            let [up, _, down] = phases(model, ramp, *blend, t);
            scale(ramp, (up - down) / (blend * (1.0 - blend)))
        }
        // Each piece adds the change of rate over it; the first starts at rest.
        Profile::Table { segments, .. } => segments.iter().fold(model.zero(), |sum, segment| {
            let u = local_time(model, segment, t);
            let [_, c2, c3] = segment.coefficients;
            sum + u * (u * (3.0 * c3) + 2.0 * c2)
        }),
    }
}

/// `τ = clamp((t − begin)/duration, 0, 1)`
fn tau<'g>(model: &Model<'g>, ramp: &Ramp, t: Expr<'g>) -> Expr<'g> {
    let (zero, one) = (model.zero(), model.graph.constant(1.0));
    // The reciprocal is a number, or a constant of the live parameters.
    let per_second = one / model.number(&ramp.duration);
    ((t - model.number(&ramp.begin)) * per_second).clamp(zero, one)
}

/// Share of τ spent speeding up, at constant rate, and slowing down, each from 0 to its length.
fn phases<'g>(model: &Model<'g>, ramp: &Ramp, blend: f64, t: Expr<'g>) -> [Expr<'g>; 3] {
    let tau = tau(model, ramp, t);
    let within = |low: f64, high: f64| (tau - low).clamp(model.zero(), model.graph.constant(high - low));
    [within(0.0, blend), within(blend, 1.0 - blend), within(1.0 - blend, 1.0)]
}

/// `u = clamp(t − begin, 0, duration)`
fn local_time<'g>(model: &Model<'g>, segment: &Segment, t: Expr<'g>) -> Expr<'g> {
    (t - segment.begin).clamp(model.zero(), model.graph.constant(segment.duration))
}
