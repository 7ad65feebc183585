//! All checks of one crane.

use std::time::Instant;

use crane_live::LiveCrane;
use fastrand::Rng;

use crate::crane::{Case, with_features};
use crate::feature::Features;
use crate::observe::{
    CAUTIONS, Extent, TIPPING_MARGIN, differences, equilibrium, live, live_with, observe, observe_with,
};
use crate::tree::{Tree, source, text};
use crate::{changes, charts, combined, descriptions, events, fleets, laws, meshes, run_changes, servos, shown};

/// A check that failed.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Its name.
    pub check: &'static str,
    /// What is wrong, line by line.
    pub what: Vec<String>,
    /// The smallest spec found for which it fails, ready to be run.
    pub spec: String,
    /// The features of that spec.
    pub features: Features,
}

/// What was found out about a crane.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Names of the checks that applied, and how long each took, s.
    pub checks: Vec<(&'static str, f64)>,
    /// Checks that failed.
    pub failures: Vec<Failure>,
    /// Why the crane could not be checked: it does not stand, for example.
    pub refused: Option<String>,
}

/// Names of all checks.
#[must_use]
pub fn names() -> Vec<&'static str> {
    let described = descriptions::ALL.iter().map(|(name, _)| *name);
    described
        .chain(laws::ALL.iter().map(|(name, _)| *name))
        .chain([
            meshes::NAME,
            changes::NAME,
            run_changes::NAME,
            fleets::NAME,
            charts::NAME,
            combined::NAME,
            events::NAME,
            servos::NAME,
        ])
        .collect()
}

/// What a check says of a spec: `None` where it does not apply, else what is wrong.
fn apply(check: &str, tree: &Tree, seed: u64, extent: Extent) -> Option<Vec<String>> {
    if let Some((_, description)) = descriptions::ALL.iter().find(|(name, _)| *name == check) {
        let second = description(tree, &mut Rng::with_seed(seed))?;
        let extent = Extent { run: extent.run && second.moves, ..extent };
        let mut first = observe(&source(second.first.as_ref().unwrap_or(tree)), extent).ok()?;
        return Some(match observe_with(&second.source, &second.set, extent) {
            Ok(mut numbers) => {
                for numbers in [&mut first, &mut numbers] {
                    if second.signs {
                        for number in numbers.values_mut() {
                            number.value = number.value.abs();
                        }
                    }
                    numbers.retain(|name, number| {
                        !second.without.contains(&number.group) && (second.links || !name.ends_with(TIPPING_MARGIN))
                    });
                }
                let missing = differences([&first, &numbers], &second.name, &second.factor);
                let cautions =
                    numbers.iter().filter(|(name, number)| number.group == CAUTIONS && !first.contains_key(*name));
                // Exported files are of parameters, and say nothing of inputs.
                let sets = |crane: &LiveCrane| {
                    crane
                        .chain()
                        .parameters
                        .iter()
                        .any(|parameter| second.set.iter().any(|(name, _)| parameter.name == *name))
                };
                let set = live_with(&second.source, &second.set).ok().filter(sets);
                let shown = live(&source(tree)).ok().zip(set).map(|(written, set)| shown::differences(&written, &set));
                missing
                    .into_iter()
                    .chain(shown.into_iter().flatten())
                    .chain(cautions.map(|(name, _)| format!("{name}, of the second only")))
                    .collect()
            }
            Err(refused) => refused.lines().map(str::to_owned).collect(),
        });
    }
    if check == changes::NAME {
        return changes::check_changes(tree, seed);
    }
    if check == run_changes::NAME {
        return run_changes::check_run_changes(tree, seed);
    }
    if check == fleets::NAME {
        return fleets::check_fleets(tree, seed);
    }
    if check == combined::NAME {
        return combined::check_combined(tree, seed);
    }
    if check == events::NAME {
        return events::check_events(tree, seed);
    }
    if check == servos::NAME {
        return servos::check_servos(tree, seed);
    }
    if check == charts::NAME {
        return charts::check_charts(tree, seed);
    }
    if check == meshes::NAME {
        return meshes::check_meshes(tree);
    }
    let (_, law) = laws::ALL.iter().find(|(name, _)| *name == check)?;
    match laws::check_law(*law, tree, seed).ok()?? {
        Ok(()) => Some(vec![]),
        Err(what) => Some(vec![what]),
    }
}

/// Checks a crane, with `most` checks chosen at random; failures are shrunk.
#[must_use]
pub fn check_case(case: &Case, only: Option<&str>, most: usize, shrink: bool) -> Outcome {
    if let Err(refused) = live(&source(&case.tree)).and_then(|crane| equilibrium(&crane)) {
        return Outcome { refused: Some(refused), ..Outcome::default() };
    }
    let mut chosen: Vec<&'static str> =
        names().into_iter().filter(|name| only.is_none_or(|only| name.contains(only))).collect();
    let mut rng = Rng::with_seed(case.seed);
    rng.shuffle(&mut chosen);
    let mut outcome = Outcome::default();
    for name in chosen {
        if outcome.checks.len() == most {
            break;
        }
        // Runs and searches take most of the time: a third of the cranes runs, and another one is loaded until it falls.
        let extent = Extent { run: case.seed.is_multiple_of(3), searches: case.seed % 3 == 1 };
        let begin = Instant::now();
        let Some(what) = apply(name, &case.tree, case.seed, extent) else { continue };
        outcome.checks.push((name, begin.elapsed().as_secs_f64()));
        if !what.is_empty() {
            let failure = Failure { check: name, what, spec: text(&case.tree), features: case.features.clone() };
            outcome.failures.push(if shrink { shrunk(case, failure, extent) } else { failure });
        }
    }
    outcome
}

/// Leaves out features, then entries, as long as the check fails.
fn shrunk(case: &Case, mut failure: Failure, extent: Extent) -> Failure {
    let mut tree = case.tree.clone();
    let fails = |tree: &Tree, failure: &mut Failure| {
        let what = apply(failure.check, tree, case.seed, extent).filter(|what| !what.is_empty());
        what.map(|what| (failure.what, failure.spec) = (what, text(tree))).is_some()
    };
    for feature in case.features.iter().rev() {
        let mut fewer = failure.features.clone();
        fewer.retain(|other| other != feature && !other.needs().contains(feature));
        let smaller = with_features(case.seed, &fewer);
        if fewer.len() < failure.features.len() && fails(&smaller, &mut failure) {
            (tree, failure.features) = (smaller, fewer);
        }
    }
    let lists = ["points", "loads", "connectors", "cylinders", "loop_joints", "couplings", "supports"];
    for list in lists {
        for index in (0..tree[list].as_array().map_or(0, Vec::len)).rev() {
            let mut smaller = tree.clone();
            if let Some(entries) = smaller[list].as_array_mut() {
                entries.remove(index);
            }
            if fails(&smaller, &mut failure) {
                tree = smaller;
            }
        }
    }
    for key in ["slope", "gravity", "friction", "stops", "damping", "guess"] {
        let mut smaller = tree.clone();
        let removed = smaller.as_object_mut().and_then(|entries| entries.remove(key));
        if removed.is_some() && fails(&smaller, &mut failure) {
            tree = smaller;
        }
    }
    failure
}
