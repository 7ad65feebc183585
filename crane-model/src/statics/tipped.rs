//! Cranes on feet that lift: the line over which they tip if there is no stable upright pose, or that they float.

use super::{Equilibrium, Status, diagnosis::upwards};
use crate::{
    Text,
    dyn_crane::DynCrane,
    tipping::{governing, lines},
};

/// Tipping margin below which a crane without a stable pose is reported to tip over: yielding drives and feet change the margin by less
/// than that.
const LITTLE: f64 = 0.1;

/// Scaled residual below which a pose is at rest except for rounding, even if Newton's method did not converge.
const AT_REST: f64 = 1e-6;

/// The equilibrium at time `t`, s, that was found from the pose `from`; its status becomes that the crane tips over, or that it floats, if it has
/// feet that lift and the pose found is not stable or its base is not upright. `standing`: the pose at rest with its base held.
pub(super) fn with_tipped_status(
    crane: &dyn DynCrane,
    t: f64,
    from: &[f64],
    equilibrium: Equilibrium,
    standing: &dyn Fn() -> Vec<f64>,
) -> Equilibrium {
    let description = crane.description();
    let feet = || description.supports.iter().filter(|support| support.one_sided);
    let fell = description.has_tipped(from, &equilibrium.q);
    let stands =
        equilibrium.is_stable() || equilibrium.status == Status::NotConverged && equilibrium.residual() < AT_REST;
    if feet().next().is_none() || stands && !fell {
        return equilibrium;
    }
    let standing = standing();
    if upwards(crane, t, &standing).is_some_and(|force| force > 0.0) {
        return Equilibrium { status: Status::Floats, ..equilibrium };
    }
    let rest = vec![0.0; from.len()];
    let lines = lines(crane, t, &standing, &rest, &rest);
    let names: Vec<Text> = match governing(&lines) {
        Some(line) if fell || line.margin() < LITTLE && !is_held_from_outside(crane, t, &standing) => {
            line.feet.iter().map(|&foot| description.supports[foot].name.clone()).collect()
        }
        // In a plane there are no tipping lines: name the feet that still press.
        None if fell => {
            let reactions = crane.support_reactions_at(&equilibrium.q, &rest);
            let pressing = description.supports.iter().zip(&reactions).filter(|(_, force)| force.z > 0.0);
            pressing.map(|(support, _)| support.name.clone()).collect()
        }
        _ => return equilibrium,
    };
    Equilibrium { status: Status::TipsOver { feet: names }, ..equilibrium }
}

/// Whether a connector to the world pulls or pushes in a pose: its force changes with the motion of the base, so that moments about tipping lines in this
/// pose do not decide.
fn is_held_from_outside(crane: &dyn DynCrane, t: f64, q: &[f64]) -> bool {
    let tensions = crane.connector_tensions_at(t, q, &vec![0.0; q.len()]);
    let connectors = crane.description().connectors.iter().zip(tensions);
    connectors
        .into_iter()
        .any(|(info, tension)| tension.force != 0.0 && info.points.iter().any(|point| point.body.is_none()))
}
