//! Prescribed motions as expressions of time.
//!
//! All use clamped times, so that they hold their first value before and their last value after the motion, without a
//! branch.

use std::f64::consts::TAU;

use super::model::Model;
use crate::chain::{self, Derivative, Profile, Ramp, Segment, Value};
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
        Profile::Speed { from, rate, begin, ramp } => {
            let from = model.number(from);
            let (tau, rest) = since(model, begin, ramp.as_ref(), t);
            // ∫ (3τ² − 2τ³) dτ
            let way = match ramp {
                Some(ramp) => model.number(ramp) * (tau * tau * tau * (1.0 - tau * 0.5)) + rest,
                None => rest,
            };
            from + model.number(rate) * way
        }
        Profile::Input(input, unless_set) => {
            let [value, free, rate] = model.input(*input);
            value + rate * t + free * position(model, unless_set, t)
        }
        Profile::Halted { motion, at, within } => {
            let [theta, ..] = slowed(model, at, within, t);
            position(model, motion, theta)
        }
        Profile::Sum(parts) => {
            let [one, other] = parts.each_ref().map(|part| position(model, part, t));
            one + other
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
        Profile::Speed { rate, begin, ramp, .. } => {
            let (tau, _) = since(model, begin, ramp.as_ref(), t);
            model.number(rate) * if ramp.is_some() { tau * tau * (3.0 - tau * 2.0) } else { tau }
        }
        Profile::Input(input, unless_set) => {
            let [_, free, own] = model.input(*input);
            own + free * rate(model, unless_set, t)
        }
        Profile::Halted { motion, at, within } => {
            let [theta, speed, _] = slowed(model, at, within, t);
            rate(model, motion, theta) * speed
        }
        Profile::Sum(parts) => {
            let [one, other] = parts.each_ref().map(|part| rate(model, part, t));
            one + other
        }
        // Each piece adds the change of rate over it, straight ones also a jump at each end.
        Profile::Table { segments, .. } => {
            let smooth = segments.iter().fold(model.zero(), |sum, segment| {
                let u = local_time(model, segment, t);
                let [_, c2, c3] = segment.coefficients;
                sum + u * (u * (3.0 * c3) + 2.0 * c2)
            });
            with_jumps(model, t, smooth, (segments, Segment::slope))
        }
    }
}

/// `q̈_dr(t)`, m/s² or rad/s². At a jump at the beginning or end of a motion,
/// this is the acceleration within the motion.
pub fn acceleration<'g>(model: &Model<'g>, profile: &Profile, t: Expr<'g>) -> Expr<'g> {
    let scale = |ramp: &Ramp, curvature: Expr<'g>| {
        let travel = model.number(&ramp.to) - model.number(&ramp.from);
        travel / model.number(&ramp.duration).squared() * curvature
    };
    match profile {
        // A speed that jumps does so before a run; otherwise its drive would not be rigid.
        // An input that is set may jump between steps: no rigid drive follows it.
        Profile::Hold(_) | Profile::Speed { ramp: None, .. } | Profile::Input(..) => model.zero(),
        Profile::Halted { motion, at, within } => {
            let [theta, speed, slowing] = slowed(model, at, within, t);
            acceleration(model, motion, theta) * speed.squared() + rate(model, motion, theta) * slowing
        }
        Profile::Sum(parts) => {
            let [one, other] = parts.each_ref().map(|part| acceleration(model, part, t));
            one + other
        }
        Profile::Quintic(ramp) => {
            let tau = tau(model, ramp, t);
            scale(ramp, tau * (1.0 - tau) * (1.0 - 2.0 * tau) * 60.0)
        }
        Profile::Cubic(ramp) => {
            let [begun, ended] = bounds(model, &ramp.begin, &ramp.duration, t);
            scale(ramp, (begun + ended - 2.0 * tau(model, ramp, t)) * 6.0)
        }
        Profile::Cycloid(ramp) => scale(ramp, (tau(model, ramp, t) * TAU).sin() * TAU),
        Profile::Trapezoid { ramp, blend } => {
            let [begun, ended] = bounds(model, &ramp.begin, &ramp.duration, t);
            let tau = tau(model, ramp, t);
            let [level, down] = [*blend, 1.0 - blend].map(|share| after(model, tau - share));
            scale(ramp, (begun - level - down + ended) / (blend * (1.0 - blend)))
        }
        Profile::Speed { rate, begin, ramp: Some(ramp), .. } => {
            let (tau, _) = since(model, begin, Some(ramp), t);
            model.number(rate) / model.number(ramp) * (tau * (1.0 - tau) * 6.0)
        }
        // Of cubic pieces it varies along each, and jumps at both ends and between pieces that are not those of a spline.
        Profile::Table { segments, .. } => {
            let varying = segments.iter().fold(model.zero(), |sum, segment| {
                sum + local_time(model, segment, t) * (6.0 * segment.coefficients[2])
            });
            with_jumps(model, t, varying, (segments, Segment::curvature))
        }
    }
}

/// The time θ of a motion that is halted, s, and its first and second derivative by t.
fn slowed<'g>(model: &Model<'g>, at: &Value, within: &Value, t: Expr<'g>) -> [Expr<'g>; 3] {
    let (zero, one) = (model.zero(), model.graph.constant(1.0));
    let (begin, whole) = (model.number(at), model.number(within));
    let per_second = one / whole;
    let passed = t - begin;
    let u = passed.clamp(zero, whole);
    let [begun, ended] = bounds(model, at, within, t);
    [t - passed.max(zero) + u * (1.0 - u * (0.5 * per_second)), 1.0 - u * per_second, (ended - begun) * per_second]
}

/// A sum over the pieces of a curve, and the jumps of a derivative between them. At both ends of the curve, it is that within.
fn with_jumps<'g>(
    model: &Model<'g>,
    t: Expr<'g>,
    sum: Expr<'g>,
    (segments, derivative): (&[Segment], Derivative),
) -> Expr<'g> {
    let begins = |time: f64| segments.first().is_some_and(|first| first.begin == time);
    let has_come = |time| if begins(time) { 1.0 - after(model, time - t) } else { after(model, t - time) };
    chain::jumps(segments, derivative).into_iter().fold(sum, |sum, (time, jump)| sum + has_come(time) * jump)
}

/// 1 from the start of a motion on, and 1 after its end; 0 before.
fn bounds<'g>(model: &Model<'g>, begin: &Value, duration: &Value, t: Expr<'g>) -> [Expr<'g>; 2] {
    let passed = t - model.number(begin);
    [1.0 - after(model, -passed), after(model, passed - model.number(duration))]
}

/// `τ = clamp((t − begin)/duration, 0, 1)`
fn tau<'g>(model: &Model<'g>, ramp: &Ramp, t: Expr<'g>) -> Expr<'g> {
    let (zero, one) = (model.zero(), model.graph.constant(1.0));
    // The reciprocal is a number, or a constant of the live parameters.
    let per_second = one / model.number(&ramp.duration);
    ((t - model.number(&ramp.begin)) * per_second).clamp(zero, one)
}

/// For a constant speed: the fraction τ of its ramp that has passed, which without a ramp jumps from 0 to 1, and the time since the
/// end of the ramp, s.
fn since<'g>(model: &Model<'g>, begin: &Value, ramp: Option<&Value>, t: Expr<'g>) -> (Expr<'g>, Expr<'g>) {
    let (zero, one) = (model.zero(), model.graph.constant(1.0));
    let passed = t - model.number(begin);
    match ramp {
        Some(ramp) => {
            let ramp = model.number(ramp);
            ((passed * (one / ramp)).clamp(zero, one), (passed - ramp).max(zero))
        }
        None => (one - after(model, -passed), passed.max(zero)),
    }
}

/// 1 if x > 0, otherwise 0: a positive difference of times is never as small as the reciprocal of `STEEP`.
fn after<'g>(model: &Model<'g>, x: Expr<'g>) -> Expr<'g> {
    const STEEP: f64 = 1e300;
    (x * STEEP).clamp(model.zero(), model.graph.constant(1.0))
}

/// Parts of τ spent accelerating, at constant rate, and decelerating, each from 0 to its length.
fn phases<'g>(model: &Model<'g>, ramp: &Ramp, blend: f64, t: Expr<'g>) -> [Expr<'g>; 3] {
    let tau = tau(model, ramp, t);
    let within = |low: f64, high: f64| (tau - low).clamp(model.zero(), model.graph.constant(high - low));
    [within(0.0, blend), within(blend, 1.0 - blend), within(1.0 - blend, 1.0)]
}

/// `u = clamp(t − begin, 0, duration)`
fn local_time<'g>(model: &Model<'g>, segment: &Segment, t: Expr<'g>) -> Expr<'g> {
    (t - segment.begin).clamp(model.zero(), model.graph.constant(segment.duration))
}
