//! The part of the effort of spring and damper that a drive can deliver. The limits on power and rate apply while it drives, not
//! while it brakes.
//!
//! Notation
//! : u the effort of spring and damper, limited to M; v the rate of the joint; P the maximum power; V the maximum rate; σ the law
//!   of [`saturation`](super::saturation).
//!
//! ```text
//! τ = w σ(u; P/max(|v|, P/2M))        if u v > 0, else u
//! w = x² (3 − 2x),   x = (V − |v|)/0.1 V between 0 and 1
//! ```
//!
//! The part of u that is not delivered slips in the transmission: with its motion q_dr, the drive's power input is
//! `u q̇_dr − (u − τ) v`; an effort besides spring and damper acts on the joint: see [`power`](super::drives::power).

use super::model::Model;
use super::saturation::Saturation;
use crate::chain::Drive;
use crate::symbolic::Expr;

/// Fraction of the maximum rate over which the effort falls to zero.
const FADING: f64 = 0.1;

/// τ of a drive, from its effort u and the rate of its joint.
pub fn delivered<'g>(model: &Model<'g>, drive: &Drive, effort: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
    let Some(limit) = drive.max_effort().filter(|_| drive.max_power().is_some() || drive.max_rate().is_some()) else {
        return effort;
    };
    let (limit, speed) = (model.number(limit), rate.max(-rate));
    let (zero, one) = (model.zero(), model.graph.constant(1.0));
    let mut driving = effort;
    if let Some(power) = drive.max_power() {
        let power = model.graph.constant(power);
        driving = Saturation::new(driving, power / speed.max(power / (2.0 * limit))).effort();
    }
    if let Some(greatest) = drive.max_rate() {
        let x = ((greatest - speed) / (FADING * greatest)).clamp(zero, one);
        driving = x.squared() * (3.0 - 2.0 * x) * driving;
    }
    (effort * rate).select(driving, effort)
}
