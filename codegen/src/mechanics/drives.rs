//! Flexible drives: a spring and a damper between a coordinate and its prescribed motion.

use super::model::Model;
use super::profile;
use crate::chain::Drive;
use crate::symbolic::Expr;

/// `t_dr = s (q_dr − q) + d (q̇_dr − q̇)` [Urbaś 2016, Eqs. (20)–(21)].
fn effort<'g>(model: &Model<'g>, drive: &Drive, t: Expr<'g>, v: &[Expr<'g>]) -> Expr<'g> {
    let j = drive.coordinate.0;
    let stretch = profile::position(model, &drive.profile, t) - model.q[j];
    let rate = profile::rate(model, &drive.profile, t) - v[j];
    let effort = model.number(&drive.stiffness) * stretch + model.number(&drive.damping) * rate;
    model.graph.name(effort, format!("effort_{}", model.chain.coordinates[j].name));
    effort
}

/// Generalized forces of the drives.
pub fn forces<'g>(model: &Model<'g>, t: Expr<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for drive in &model.chain.drives {
        forces[drive.coordinate.0] = effort(model, drive, t, v);
    }
    forces
}

/// `E_dr = ½ Σ s (q_dr − q)²` [Urbaś 2016, Eq. (19)].
pub fn energy<'g>(model: &Model<'g>) -> Expr<'g> {
    let twice = model.chain.drives.iter().fold(model.zero(), |sum, drive| {
        let stretch = profile::position(model, &drive.profile, model.t) - model.q[drive.coordinate.0];
        sum + model.number(&drive.stiffness) * stretch.squared()
    });
    0.5 * twice
}

/// `q_dr, q̇_dr` of every drive.
pub fn motions<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let motion = |drive: &Drive| {
        [profile::position(model, &drive.profile, model.t), profile::rate(model, &drive.profile, model.t)]
    };
    model.chain.drives.iter().flat_map(motion).collect()
}

/// Power that the prescribed motions put in, `Σ t_dr q̇_dr`.
pub fn power<'g>(model: &Model<'g>) -> Expr<'g> {
    model.chain.drives.iter().fold(model.zero(), |sum, drive| {
        sum + effort(model, drive, model.t, &model.v) * profile::rate(model, &drive.profile, model.t)
    })
}

/// Power that the drives' dampers take out, `Σ d (q̇_dr − q̇)²` (2R of [Urbaś 2016, Eq. (19)]).
pub fn dissipation<'g>(model: &Model<'g>) -> Expr<'g> {
    model.chain.drives.iter().fold(model.zero(), |sum, drive| {
        let rate = profile::rate(model, &drive.profile, model.t) - model.v[drive.coordinate.0];
        sum + model.number(&drive.damping) * rate.squared()
    })
}
