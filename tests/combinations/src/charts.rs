//! Load charts: a pose of a chart is the pose at rest of the spec whose drives hold its positions, and what governs its load is a limit.

use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::envelope::{Axes, Axis, Condition, Envelope, Limit, Limits, Rating, Varied, only_mass};
use crane_model::statics::{RestSearch, Settings};
use fastrand::Rng;
use serde_json::{Value, json};

use crate::observe::{live, rate};
use crate::tree::{Tree, source, without_unused_offset};

/// The name of the check.
pub const NAME: &str = "poses of charts are those of statics";
/// How far a drive moves, m or rad.
const MOVED: f64 = 0.3;
/// Largest load, kg.
const GREATEST: f64 = 2e4;
/// Of efforts and reactions, relative to the largest: Newton's tolerance times the condition of the tangent stiffness.
const TOLERANCE: f64 = 1e-7;

/// What a chart and statics find at different poses or loads; `None` for a crane without a mass as a live parameter or without a drive whose
/// position can be written.
pub fn check_charts(tree: &Tree, seed: u64) -> Option<Vec<String>> {
    let mut rng = Rng::with_seed(seed);
    let crane = live(&source(tree)).ok()?;
    let description = crane.description();
    let load = only_mass(description)?;
    let drive = (!description.drives.is_empty()).then(|| rng.usize(..description.drives.len()))?;
    let (coordinate, [start, _]) =
        (description.drives[drive].coordinate, (&crane as &dyn DynCrane).drive_motions_at(0.0)[drive]);
    let name = description.coordinates[coordinate].name.to_string();
    let position = start + MOVED * (2.0 * rng.f64() - 1.0);
    let mut held = tree.clone();
    let entry = held["drives"].as_array_mut()?.iter_mut().find(|entry| entry["coordinate"] == name.as_str())?;
    let entry: &mut serde_json::Map<String, Value> = entry.as_object_mut()?;
    // A chart's position is where the drive is, as that of `--hold`: no input offsets it.
    entry.insert("motion".into(), json!({"hold": position}));
    entry.remove("offset");
    without_unused_offset(&mut held);
    let mut held = live(&source(&held)).ok()?;
    let load_name = description.parameters[load].name.to_string();
    let held_load = held.description().parameters.iter().position(|info| info.name == load_name.as_str())?;

    let limits = Limits { tipping: Some(0.0), ..Limits::none(description) };
    let least = crane_model::envelope::range_of_loads(&crane, load, None)[0];
    let axes = Axes(vec![Axis { varied: Varied::Drive(drive), values: vec![start, position] }]);
    let asked = Envelope { axes, load, loads: [least, GREATEST], limits, factor: 1.0 };
    let rating = rate(&crane, &asked)?;

    let mut wrong: Vec<String> = limits_nothing(&crane, load).into_iter().collect();
    let at = |rated: f64| format!("{name} at {position}, {rated} kg");
    let mut stands = |value: f64| -> Option<Condition> {
        held.set_parameter(held_load, value).ok()?;
        let whole: &dyn DynCrane = &held;
        let equilibrium = whole.equilibrium(&Settings::default());
        let positions: Vec<f64> = whole.drive_motions_at(0.0).iter().map(|[position, _]| *position).collect();
        equilibrium.is_stable().then(|| Condition::at(whole, equilibrium.q, &positions))
    };
    // Near the load that tips, statics may find another pose, or miss the one that is left.
    let written = crane.parameters()[load];
    let Some(chart) = rating.with_spec_load.filter(|_| rating.load.is_none_or(|rated| written < 0.8 * rated)) else {
        // Beyond a limit with the least load, or no rest.
        if rating.loaded.is_none() && stands(least).is_some() {
            wrong.push(format!("{}: a chart finds no rest", at(least)));
        }
        return Some(wrong);
    };
    let Some(rest) = stands(written) else {
        wrong.push(format!("{}: statics finds no rest", at(written)));
        return Some(wrong);
    };
    let forces = |condition: &Condition| -> Vec<f64> {
        condition.efforts.iter().copied().chain(condition.feet.iter().map(|[force, _]| *force)).collect()
    };
    // What joints and sections transmit follows from the pose, wherever the motions of the spec would hold the drives.
    let transmitted = |crane: &dyn DynCrane, condition: &Condition| -> Vec<f64> {
        let still = vec![0.0; condition.q.len()];
        let wrenches = crane.internal_forces_at(0.0, &condition.q, &still, &still);
        wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment]).flat_map(<[f64; 3]>::from).collect()
    };
    for (what, chart, rest) in [
        ("forces", forces(&chart), forces(&rest)),
        ("internal forces", transmitted(&crane, &chart), transmitted(&held, &rest)),
    ] {
        let size = rest.iter().fold(1.0, |size: f64, force| size.max(force.abs()));
        let off = chart.iter().zip(&rest).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if off > TOLERANCE * size {
            wrong.push(format!("{}: {what} differ by {off:.3e} of {size:.3e}", at(written)));
        }
    }
    Some(wrong)
}

/// How much more than the largest load is beyond what limits it: a hundred times the accuracy of the search.
const BEYOND: f64 = 1e-4;

/// What a chart names as the limit at the pose of the spec, and is none: with a little more load the crane is beyond it, or rests no more, and with the
/// largest load it is within all limits.
fn limits_nothing(crane: &LiveCrane, load: usize) -> Option<String> {
    let limits = Limits::usual(crane.description());
    let loads = crane_model::envelope::range_of_loads(crane, load, None);
    let asked =
        Envelope { axes: Axes::default(), load, loads: [loads[0], GREATEST], limits: limits.clone(), factor: 1.0 };
    let Rating { load: Some(rated), governing, loaded: Some(loaded), .. } = rate(crane, &asked)? else { return None };
    let mut crane = crane.clone();
    let mut rest = |value: f64, near: &[f64]| {
        crane.set_parameter(load, value).ok()?;
        let whole: &dyn DynCrane = &crane;
        let positions: Vec<f64> = whole.drive_motions_at(0.0).iter().map(|[position, _]| *position).collect();
        let equilibrium = RestSearch { crane: whole, positions: &positions }.find_near(near)?;
        let limits = Condition::at(whole, equilibrium.q.clone(), &positions).exceeded(whole, &limits);
        Some((equilibrium.q, limits.into_iter().map(|margin| margin.limit).collect::<Vec<Limit>>()))
    };
    let mut beyond = |value: f64| {
        let (q, limits) = rest(value, &loaded.q)?;
        // A crane that snaps through rests elsewhere, from where less load leads to another pose.
        let (back, _) = rest(rated, &q)?;
        let distance = |q: &[f64]| q.iter().zip(&loaded.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (distance(&back) <= 0.1 * distance(&q)).then_some(limits)
    };
    if let Some(limit) = beyond(rated * (1.0 - BEYOND)).and_then(|limits| limits.first().copied()) {
        return Some(format!("{rated} kg is the largest load, and with less the crane is beyond {limit:?}"));
    }
    let more = beyond(rated * (1.0 + BEYOND))?;
    match governing {
        None => None,
        Some(limit) if more.iter().any(|other| other.kind() == limit.kind()) => None,
        Some(limit) => Some(format!("{limit:?} limits nothing: with more than {rated} kg, {more:?}")),
    }
}
