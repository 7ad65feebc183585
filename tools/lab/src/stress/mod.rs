//! `crane-lab stress`: stiff and extreme cranes, what is expected of each and what happens.

mod angles;
mod beams;
mod case;
mod feet;
mod joints;
mod loads;
mod motions;
mod numbers;
mod oil;
mod poses;
mod spec;
mod stiffness;
mod subject;
mod supports;

use std::{
    fmt::Write as _,
    io::Write,
    path::Path,
    sync::{Mutex, PoisonError},
    thread,
};

use indicatif::ProgressBar;

use crane_cli::{
    Console, Registry, files,
    toolbox::{Grid, Outcome, Problem, Report},
};

use crate::arguments::Stress;
use case::{Case, Verdict};
use spec::Spec;

/// Gravity of the shipped specs, m/s².
const GRAVITY: f64 = 9.81;
/// Change of a spec that removes gravity.
const WEIGHTLESS: &str = "gravity: [0, 0, 0]";
/// Verdicts in the tables: of a case that did not go as expected, and of one that did.
const VERDICTS: [&str; 2] = ["FAILED", "ok"];

/// The shipped specs that cases are derived from.
struct Specs<'a> {
    registry: &'a Registry,
}

impl Specs<'_> {
    fn shipped(&self, name: &str) -> Spec {
        // If the crane is missing, the spec is empty and its cases are refused.
        Spec::new(self.registry.spec(name).unwrap_or_default())
    }

    /// The reference crane.
    fn reference(&self) -> Spec {
        self.shipped("eight_link_flexible")
    }

    /// The cantilever with a number of sections.
    fn cantilever(&self, sections: usize) -> Spec {
        self.shipped("cantilever").changed(&format!("links: [{{name: beam, beam: {{sections: {sections}}}}}]"))
    }
}

/// Drives of the reference crane and their stiffness, N m/rad and N/m.
const DRIVES: [(&str, f64); 5] =
    [("column_psi", 1e7), ("boom_psi", 1e7), ("outer_boom_psi", 1e7), ("telescope_z", 1e8), ("grapple_psi", 1e7)];
/// Stiffness of its eight supports along x, y and z, N/m.
const SUPPORT: [f64; 3] = [3e6, 3e6, 1e7];

/// The reference crane with other keys for its boom's beam.
fn with_boom(reference: &Spec, keys: &str) -> Spec {
    reference.changed(&format!("links: [{{name: boom, beam: {{{keys}}}}}]"))
}

/// The reference crane with other keys for each drive, which depend on the drive's stiffness.
fn with_drives(reference: &Spec, keys: impl Fn(f64) -> String) -> Spec {
    let drive = |(coordinate, stiffness)| format!("  - {{coordinate: {coordinate}, {}}}\n", keys(stiffness));
    reference.changed(&format!("drives:\n{}", DRIVES.map(drive).concat()))
}

/// The reference crane on supports of another stiffness.
fn with_supports(reference: &Spec, stiffness: [f64; 3]) -> Spec {
    let support = |number| format!("  - {{name: s{number}, stiffness: {stiffness:?}}}\n");
    reference.changed(&format!("supports:\n{}", [1, 2, 3, 4, 5, 6, 7, 8].map(support).concat()))
}

/// Runs the suite, prints the results and writes them.
pub fn stress(options: &Stress, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let specs = Specs { registry };
    let mut cases = stiffness::cases(&specs);
    cases.extend(beams::cases(&specs));
    cases.extend(loads::cases(&specs));
    cases.extend(supports::cases());
    cases.extend(feet::cases());
    cases.extend(joints::cases());
    cases.extend(oil::cases());
    cases.extend(angles::cases());
    cases.extend(poses::cases(&specs));
    cases.extend(motions::cases(&specs));
    cases.extend(numbers::cases(&specs));
    cases.sort_by_key(|case| case.group);
    cases.retain(|case| case.quick || !options.quick);
    if let Some(word) = &options.only {
        cases.retain(|case| case.group.contains(word.as_str()) || case.name.contains(word.as_str()));
        if cases.is_empty() {
            return Err(Problem::usage(
                format!("no case has `{word}` in its name"),
                "`crane-lab stress` lists all names",
            ));
        }
    }
    let bar = registry.console.batches(cases.len());
    let verdicts = judge(cases, &bar);
    bar.finish_and_clear();

    files::folder(&options.out)?;
    write_verdicts(&registry.console, &options.out, &verdicts)?;
    let failed = verdicts.iter().filter(|verdict| !verdict.passed).count();
    let mut report = Report::default();
    report.fact("cases", verdicts.len(), "");
    report.fact("failed", failed, "");
    report.grid(grid(&verdicts));
    options.format.print(&report, &registry.console, out)?;
    if failed == 0 {
        return Ok(());
    }
    let worst: Vec<&str> = verdicts.iter().filter(|verdict| !verdict.passed).map(|v| v.name.as_str()).collect();
    Err(Problem::failed(format!("{failed} of {} cases differ from what is expected", verdicts.len()), worst.join("; ")))
}

/// All verdicts in the order of the cases, computed by as many threads as the machine has.
fn judge(cases: Vec<Case>, bar: &ProgressBar) -> Vec<Verdict> {
    let count = cases.len();
    let queue = Mutex::new(cases.into_iter().enumerate());
    let verdicts = Mutex::new(Vec::with_capacity(count));
    let work = || {
        loop {
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((index, case)) = next else { return };
            let verdict = case.judge();
            bar.inc(1);
            verdicts.lock().unwrap_or_else(PoisonError::into_inner).push((index, verdict));
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let mut verdicts = verdicts.into_inner().unwrap_or_else(PoisonError::into_inner);
    verdicts.sort_by_key(|(index, _)| *index);
    verdicts.into_iter().map(|(_, verdict)| verdict).collect()
}

fn grid(verdicts: &[Verdict]) -> Grid {
    let mut grid = Grid::new("cases", "Cases", &["group", "case", "expected", "happened", "verdict", "wall s"]);
    for verdict in verdicts {
        let Verdict { group, name, expected, happened, passed, wall } = verdict;
        let word = VERDICTS[usize::from(*passed)];
        grid.row([
            (*group).into(),
            name.as_str().into(),
            expected.as_str().into(),
            happened.as_str().into(),
            word.into(),
            wall.as_secs_f64().into(),
        ]);
    }
    grid
}

/// Writes the results as CSV, and a Markdown page that counts them by subject; without times, so that both files are reproducible.
fn write_verdicts(console: &Console, folder: &Path, verdicts: &[Verdict]) -> Outcome<()> {
    let header = ["group", "case", "expected", "happened", "verdict"];
    let fields = |verdict: &Verdict| {
        let Verdict { group, name, expected, happened, passed, .. } = verdict;
        vec![
            (*group).to_owned(),
            name.clone(),
            expected.clone(),
            happened.clone(),
            VERDICTS[usize::from(*passed)].to_owned(),
        ]
    };
    console.write_fields(
        &folder.join("stress.csv"),
        header.map(str::to_owned).into_iter(),
        verdicts.iter().map(fields),
    )?;

    let mut page = include_str!("introduction.md").to_owned();
    page.push_str("\n| Subject | Cases | As expected | For example |\n|---|---:|---:|---|\n");
    for cases in verdicts.chunk_by(|one, next| one.group == next.group) {
        let (subject, count) = (cases[0].group, cases.len());
        let passed = cases.iter().filter(|case| case.passed).count();
        let examples = cases.iter().map(|case| fields(case)[1..4].join(" → ").replace('|', "\\|"));
        let example = examples.min_by_key(String::len).unwrap_or_default();
        let _ = writeln!(page, "| {}{} | {count} | {passed} | {example} |", subject[..1].to_uppercase(), &subject[1..]);
    }
    console.write_text(&folder.join("stress.md"), &page)
}
