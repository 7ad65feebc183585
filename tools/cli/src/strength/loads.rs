//! The load that lifts the first foot, and the load that tips the crane.

use crane_model::{
    Description,
    dyn_crane::DynCrane,
    envelope::only_mass,
    statics::{Settings, Status},
    tipping::{TippingLine, lines},
};
use crane_page::tables::Report;

use serde_json::{Map, Value, json};

use crate::problem::{Outcome, Problem, nearest};

/// Relative accuracy of the load: an equilibrium leaves a residual of about 1e-13 of the forces.
const ACCURACY: f64 = 1e-10;
/// Maximum number of steps to find a load: bisection alone would take about forty.
const MOST_STEPS: usize = 100;
/// The first step towards a larger load, as a fraction of the crane's mass; it is doubled until the limit is passed.
const FIRST_STEP: f64 = 0.1;
/// Maximum number of steps, each twice the previous one: up to more than a thousand times the crane's mass.
const DOUBLINGS: usize = 14;

/// Index of the parameter that is the load: the one of this name, or else the only one in kg.
pub fn parameter(crane: &dyn DynCrane, name: Option<&str>) -> Outcome<Option<usize>> {
    let parameters = &crane.description().parameters;
    let Some(name) = name else { return Ok(only_mass(crane.description())) };
    let found = parameters.iter().position(|parameter| parameter.name.as_str() == name);
    found.map(Some).ok_or_else(|| {
        let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
        let help = nearest(name, names).map_or_else(
            || "`crane info` lists the live parameters".to_owned(),
            |nearest| format!("did you mean `{nearest}`?"),
        );
        Problem::usage(format!("there is no live parameter `{name}`"), help)
    })
}

/// How far a crane at rest is from a limit, negative beyond it, and where the limit is reached; −∞ if the crane tips over.
type Distance = fn(&dyn DynCrane, &[f64]) -> Option<(f64, String)>;

/// Adds the loads at which the first foot carries nothing, and at which the crane tips.
pub fn critical(report: &mut Report, crane: &mut dyn DynCrane, index: usize) -> Outcome<()> {
    let before = crane.parameter(index);
    let parameter = &crane.description().parameters[index];
    let (name, unit) = (parameter.name.to_string(), parameter.unit.to_string());
    let mut critical = Map::new();
    for (key, what, place, distance) in [
        ("first_foot", "lifts the first foot", "first foot to lift", least_reaction as Distance),
        ("tipping", "tips the crane", "line that it tips over", least_balance),
    ] {
        let found = root(crane, index, before, distance);
        crane.set_parameter(index, before).map_err(|refused| Problem::failed(refused.to_string(), ""))?;
        if let Some((load, at)) = &found {
            report.line(format!("{name} that {what}"), *load, &unit);
            report.line(place, at.as_str(), "");
        }
        critical.insert(key.to_owned(), found.map_or(Value::Null, |(load, at)| json!({"load": load, "at": at})));
    }
    critical.extend([("parameter".to_owned(), name.into()), ("unit".to_owned(), unit.into())]);
    report.value("critical_loads", critical);
    Ok(())
}

/// The smallest vertical force of a foot, N; if feet have lifted, so that they carry nothing, the widest gap, m, with the opposite
/// sign.
fn least_reaction(crane: &dyn DynCrane, q: &[f64]) -> Option<(f64, String)> {
    let reactions = crane.support_reactions_at(q, &vec![0.0; q.len()]);
    let feet = crane.description().supports.iter().zip(&reactions).zip(crane.support_gaps_at(q));
    let distances = feet.map(|((foot, force), gap)| (if gap > 0.0 { -gap } else { force.z }, foot));
    let (distance, foot) = distances.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some((distance, foot.name.as_str().to_owned()))
}

/// Stabilising minus overturning moment about the line that tips first, N m.
fn least_balance(crane: &dyn DynCrane, q: &[f64]) -> Option<(f64, String)> {
    let rest = vec![0.0; q.len()];
    let lines = lines(crane, 0.0, q, &rest, &rest);
    let line = lines.iter().min_by(|a, b| a.balance().total_cmp(&b.balance()))?;
    Some((line.balance(), feet(crane.description(), line)))
}

/// The feet of a tipping line.
fn feet(description: &Description, line: &TippingLine) -> String {
    let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
    format!("{from} – {to}")
}

/// The smallest load above `from` at which a distance is zero, or the largest below if it is negative there already. `None` if
/// there is none, or if the crane has no equilibrium on the way.
fn root(crane: &mut dyn DynCrane, index: usize, from: f64, distance: Distance) -> Option<(f64, String)> {
    let mass: f64 = crane.description().bodies.iter().map(|body| body.mass).sum();
    let mut at = |load: f64| {
        crane.set_parameter(index, load).ok()?;
        let equilibrium = crane.equilibrium(&Settings::default());
        match &equilibrium.status {
            Status::Converged => distance(crane, &equilibrium.q),
            // Beyond any limit; the line is named as for poses in equilibrium.
            Status::TipsOver { feet } => Some((f64::NEG_INFINITY, feet.join(" – "))),
            _ => None,
        }
    };
    let here = (from, at(from)?.0);
    let (low, high) = if here.1 > 0.0 {
        let mut low = here;
        let mut step = FIRST_STEP * mass;
        let mut doublings = 0..DOUBLINGS;
        loop {
            doublings.next()?;
            let load = low.0 + step;
            let value = at(load)?.0;
            if value <= 0.0 {
                break (low, (load, value));
            }
            (low, step) = ((load, value), 2.0 * step);
        }
    } else {
        ((0.0, at(0.0)?.0), here)
    };
    if low.1 > 0.0 { between(&mut at, low, high) } else { None }
}

/// Where a function is zero between a place where it is positive and one where it is not: by the Illinois form of regula falsi,
/// as distances are nearly linear in the load, and by bisection as long as the crane does not stand at the upper end.
fn between(
    at: &mut impl FnMut(f64) -> Option<(f64, String)>,
    mut low: (f64, f64),
    mut high: (f64, f64),
) -> Option<(f64, String)> {
    for _ in 0..MOST_STEPS {
        let load = if high.1.is_finite() {
            (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1)
        } else {
            0.5 * (low.0 + high.0)
        };
        let (value, place) = at(load)?;
        let moved = if value > 0.0 { load - low.0 } else { high.0 - load };
        if value > 0.0 {
            (low, high.1) = ((load, value), 0.5 * high.1);
        } else {
            (high, low.1) = ((load, value), 0.5 * low.1);
        }
        if value == 0.0 || moved.abs() <= ACCURACY * load.abs() {
            return Some((load, place));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The crane stands up to the load that is looked for, and not beyond.
    #[test]
    fn a_root_at_the_end_of_what_stands_is_found() {
        let mut at = |x: f64| Some((if x < 2.0 { 2.0 - x } else { f64::NEG_INFINITY }, String::new()));
        let (root, _) = between(&mut at, (0.0, 2.0), (7.0, f64::NEG_INFINITY)).unwrap();
        assert!((root - 2.0).abs() < 1e-9, "{root}");
    }

    #[test]
    fn a_root_is_found_to_ten_digits() {
        let mut calls = 0;
        let mut cube = |x: f64| {
            calls += 1;
            Some((8.0 - x * x * x, String::new()))
        };
        let (root, _) = between(&mut cube, (0.0, 8.0), (10.0, -992.0)).unwrap();
        assert!((root - 2.0).abs() < 1e-9, "{root}");
        assert!(calls < 40, "{calls}");
    }
}
