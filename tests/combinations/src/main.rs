//! `combinations --seeds 0..5000`: checks random cranes, and prints what fails and which pairs of features met.

use std::collections::BTreeMap;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::Parser;
use crane_combinations::check::{self, Outcome};
use crane_combinations::crane::{self, Case};
use crane_combinations::feature::{self, Feature};
use crane_combinations::tree;

/// Checks random cranes where features meet.
#[derive(Parser)]
struct Options {
    /// The first seed.
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// How many cranes.
    #[arg(long, default_value_t = 40)]
    count: u64,
    /// How many checks per crane, chosen at random; all if there are fewer.
    #[arg(long, default_value_t = 5)]
    checks: usize,
    /// Only checks whose names contain this.
    #[arg(long)]
    only: Option<String>,
    /// Do not look for smaller specs that fail.
    #[arg(long)]
    no_shrink: bool,
    /// Print the spec of the first seed, and check nothing.
    #[arg(long)]
    print: bool,
    /// Print which pairs of features met, and how often each check applied.
    #[arg(long)]
    coverage: bool,
    /// Threads.
    #[arg(long, default_value_t = 2)]
    threads: usize,
}

fn main() -> ExitCode {
    let options = Options::parse();
    if options.print {
        let case = crane::crane(options.from);
        print!("{}", tree::text(&case.tree));
        return ExitCode::SUCCESS;
    }
    let next = AtomicU64::new(options.from);
    let found: Mutex<Vec<(Case, Outcome)>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..options.threads.max(1) {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= options.from + options.count {
                        break;
                    }
                    let case = crane::crane(seed);
                    let outcome = check::check_case(&case, options.only.as_deref(), options.checks, !options.no_shrink);
                    for failure in &outcome.failures {
                        println!("\nseed {seed}: {}", failure.check);
                        for line in failure.what.iter().take(8) {
                            println!("  {line}");
                        }
                        println!("  features: {:?}\n{}", failure.features, failure.spec);
                    }
                    if let Ok(mut found) = found.lock() {
                        found.push((case, outcome));
                    }
                }
            });
        }
    });
    let found = found.into_inner().unwrap_or_default();
    summarise(&options, &found)
}

/// Cranes that may be refused, in hundredths.
const MOST_REFUSED: usize = 10;

fn summarise(options: &Options, found: &[(Case, Outcome)]) -> ExitCode {
    let mut refused: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    for (case, outcome) in found {
        if let Some(why) = &outcome.refused {
            refused.entry(why.lines().next().unwrap_or_default().to_owned()).or_default().push(case.seed);
        }
    }
    for (why, seeds) in &refused {
        println!("{} cranes were not checked (seed {}): {why}", seeds.len(), seeds[0]);
    }
    let met = |a: Feature, b: Feature| {
        found.iter().any(|(case, outcome)| {
            outcome.refused.is_none() && case.features.contains(&a) && case.features.contains(&b)
        })
    };
    let pairs = feature::pairs();
    let missing: Vec<_> = pairs.iter().filter(|(a, b)| !met(*a, *b)).collect();
    if options.coverage {
        for (k, a) in Feature::ALL.iter().enumerate() {
            for b in &Feature::ALL[k + 1..] {
                match feature::excluded(*a, *b) {
                    Some(why) => println!("excluded: {} with {}: {why}", a.words(), b.words()),
                    None if !met(*a, *b) => println!("did not meet: {} with {}", a.words(), b.words()),
                    None => {}
                }
            }
        }
    }
    let mut applied: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for (name, seconds) in found.iter().flat_map(|(_, outcome)| &outcome.checks) {
        let (times, sum) = applied.entry(name).or_default();
        (*times, *sum) = (*times + 1, *sum + seconds);
    }
    if options.coverage {
        for (name, (times, seconds)) in &applied {
            println!("{times:5} times, {seconds:7.1} s: {name}");
        }
    }
    let checks: usize = applied.values().map(|(times, _)| times).sum();
    let failures: usize = found.iter().map(|(_, outcome)| outcome.failures.len()).sum();
    println!(
        "{} cranes, {checks} checks, {failures} failures, {} refused; {} of {} pairs of features met",
        found.len(),
        found.iter().filter(|(_, outcome)| outcome.refused.is_some()).count(),
        pairs.len() - missing.len(),
        pairs.len()
    );
    // Some random cranes do not stand; where many do not, something is wrong.
    let refused: usize = refused.values().map(Vec::len).sum();
    if failures == 0 && refused <= MOST_REFUSED * found.len() / 100 + 1 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
