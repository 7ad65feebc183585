//! Forty cranes in which every pair of features meets, each with some of the checks, and in the end all checks.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::{env, thread};

use crane_combinations::check::{check_case, names};
use crane_combinations::crane::{Case, crane};
use crane_combinations::feature::pairs;

/// The first seed, from which on forty cranes contain every pair that the language does not exclude.
const FIRST: u64 = 700;
const CRANES: u64 = 40;
/// Checks per crane, chosen at random, in every run and in thorough ones: all of them take minutes.
const CHECKS: [usize; 2] = [2, 8];

fn cases() -> impl Iterator<Item = Case> {
    (FIRST..FIRST + CRANES).map(crane)
}

#[test]
fn forty_cranes_pass_every_check() {
    let checks = CHECKS[usize::from(env::var_os("CRANE_THOROUGH").is_some())];
    let next = AtomicU64::new(FIRST);
    let check_cranes = || {
        let mut refused = Vec::new();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= FIRST + CRANES {
                return refused;
            }
            let outcome = check_case(&crane(seed), None, checks, true);
            for failure in &outcome.failures {
                println!("seed {seed}: {}\n{}\n{}", failure.check, failure.what.join("\n"), failure.spec);
            }
            assert!(outcome.failures.is_empty(), "seed {seed}");
            refused.extend(outcome.refused.map(|why| (seed, why)));
        }
    };
    let refused = thread::scope(|scope| {
        let threads = [(); 2].map(|()| scope.spawn(check_cranes));
        threads.into_iter().flat_map(|thread| thread.join().expect("see above")).collect::<Vec<_>>()
    });
    // Some random cranes do not stand.
    assert!(refused.len() < 4, "{refused:?}");
}

#[test]
fn every_pair_of_features_meets() {
    let sets: Vec<_> = cases().map(|case| case.features).collect();
    let met = |(a, b): &(_, _)| sets.iter().any(|features| features.contains(a) && features.contains(b));
    let missing: Vec<_> = pairs().into_iter().filter(|pair| !met(pair)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn every_check_has_a_name_of_its_own() {
    let all = names();
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
}
