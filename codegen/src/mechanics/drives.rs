//! Drives: a spring and a damper between a coordinate and its prescribed motion, or that motion itself.

use super::model::Model;
use super::profile;
use crate::chain::{Drive, Value};
use crate::symbolic::Expr;

/// Drives with a spring, with its stiffness and damping.
fn flexible<'a>(model: &'a Model<'_>) -> impl Iterator<Item = (&'a Drive, &'a Value, &'a Value)> {
    model.chain.drives.iter().filter_map(|drive| drive.spring().map(|(s, d)| (drive, s, d)))
}

/// `t_dr = s (q_dr − q) + d (q̇_dr − q̇)` [Urbaś 2016, Eqs. (20)–(21)].
fn effort<'g>(
    model: &Model<'g>,
    (drive, stiffness, damping): (&Drive, &Value, &Value),
    t: Expr<'g>,
    v: &[Expr<'g>],
) -> Expr<'g> {
    let stretch = stretch(model, drive, t);
    let rate = profile::rate(model, &drive.profile, t) - v[drive.coordinate.0];
    named(model, drive, model.number(stiffness) * stretch + model.number(damping) * rate)
}

/// `q_dr − q`
fn stretch<'g>(model: &Model<'g>, drive: &Drive, t: Expr<'g>) -> Expr<'g> {
    profile::position(model, &drive.profile, t) - model.q[drive.coordinate.0]
}

fn named<'g>(model: &Model<'g>, drive: &Drive, effort: Expr<'g>) -> Expr<'g> {
    model.graph.name(effort, format!("effort_{}", model.chain.coordinates[drive.coordinate.0].name));
    effort
}

/// Generalized forces of the flexible drives.
pub fn forces<'g>(model: &Model<'g>, t: Expr<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for drive in flexible(model) {
        forces[drive.0.coordinate.0] = effort(model, drive, t, v);
    }
    forces
}

/// Generalized forces of the flexible drives' springs at t = 0 with the crane at rest: dampers do not act, even if a motion
/// is in progress.
pub fn forces_at_rest<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for (drive, stiffness, _) in flexible(model) {
        let stretch = stretch(model, drive, model.zero());
        forces[drive.coordinate.0] = named(model, drive, model.number(stiffness) * stretch);
    }
    forces
}

/// `q̈_dr` of the coordinates that rigid drives prescribe.
pub fn accelerations<'g>(model: &Model<'g>) -> Vec<Option<Expr<'g>>> {
    prescribed(model, |drive| profile::acceleration(model, &drive.profile, model.t))
}

/// Zero for the coordinates that rigid drives prescribe, which are not part of a solution.
pub fn at_rest<'g>(model: &Model<'g>) -> Vec<Option<Expr<'g>>> {
    prescribed(model, |_| model.zero())
}

fn prescribed<'g>(model: &Model<'g>, of: impl Fn(&Drive) -> Expr<'g>) -> Vec<Option<Expr<'g>>> {
    let mut prescribed = vec![None; model.size()];
    for drive in model.chain.rigid_drives() {
        prescribed[drive.coordinate.0] = Some(of(drive));
    }
    prescribed
}

/// `E_dr = ½ Σ s (q_dr − q)²` [Urbaś 2016, Eq. (19)].
pub fn energy<'g>(model: &Model<'g>) -> Expr<'g> {
    let twice = flexible(model).fold(model.zero(), |sum, (drive, stiffness, _)| {
        let stretch = profile::position(model, &drive.profile, model.t) - model.q[drive.coordinate.0];
        sum + model.number(stiffness) * stretch.squared()
    });
    0.5 * twice
}

/// `q_dr, q̇_dr` of drives.
pub fn motions<'g, 'a>(model: &Model<'g>, drives: impl Iterator<Item = &'a Drive>) -> Vec<Expr<'g>> {
    let motion = |drive: &Drive| {
        [profile::position(model, &drive.profile, model.t), profile::rate(model, &drive.profile, model.t)]
    };
    drives.flat_map(motion).collect()
}

/// Begin and end of the smooth intervals of every drive's motion.
pub fn pieces<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let pieces = model.chain.drives.iter().flat_map(|drive| drive.profile.pieces());
    pieces.flatten().map(|time| model.number(&time)).collect()
}

/// Power of the prescribed motions, `Σ t_dr q̇_dr`; for rigid drives, whose efforts are given, `τ q̇`.
pub fn power<'g>(model: &Model<'g>, efforts: &[Expr<'g>]) -> Expr<'g> {
    let flexible = flexible(model).fold(model.zero(), |sum, drive| {
        sum + effort(model, drive, model.t, &model.v) * profile::rate(model, &drive.0.profile, model.t)
    });
    model.chain.rigid_drives().map(|drive| drive.coordinate.0).fold(flexible, |sum, j| sum + efforts[j] * model.v[j])
}

/// Power that the drives' dampers dissipate, `Σ d (q̇_dr − q̇)²` (2R of [Urbaś 2016, Eq. (19)]).
pub fn dissipation<'g>(model: &Model<'g>) -> Expr<'g> {
    flexible(model).fold(model.zero(), |sum, (drive, _, damping)| {
        let rate = profile::rate(model, &drive.profile, model.t) - model.v[drive.coordinate.0];
        sum + model.number(damping) * rate.squared()
    })
}
