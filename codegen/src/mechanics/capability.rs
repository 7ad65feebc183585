//! The part of the effort of spring and damper that a drive can deliver. Limits of power and rate apply while it drives, not while it brakes.
//!
//! Notation
//! : u the effort of spring and damper up to the limit M, v the rate of the joint, P the greatest power, V the greatest rate; σ the law of
//!   [`saturation`](super::saturation).
//!
//! ```text
//! τ = w σ(u; P/max(|v|, P/2M))        if u v > 0, else u
//! w = x² (3 − 2x),   x = (V − |v|)/0.1 V between 0 and 1
//! ```
//!
//! What of u is not delivered slips in the transmission: with the drive's motion q_dr, it puts in `u q̇_dr − (u − τ) v`.

use super::model::Model;
use super::saturation::Saturation;
use crate::chain::Drive;
use crate::symbolic::Expr;

/// Share of the greatest rate over which the effort falls to nothing.
const FADING: f64 = 0.1;

/// τ of a drive with the effort u at a rate of its joint.
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
