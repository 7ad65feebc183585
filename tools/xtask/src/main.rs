//! Everything a developer runs.
//!
//! `cargo xtask test` runs all checks; other tasks run parts of it, for use during development.

mod book;
mod commands;
mod cross;
mod cycles;
mod equations;
mod fused;
mod glossary;
mod imports;
mod instrument;
mod manual;
mod modules;
mod named;
mod new_crane;
mod no_panic;
mod oracles;
mod outside;
mod package;
mod pictures;
mod prose;
mod python;
mod release;
mod report;
mod sentences;
mod step;
mod supply;
mod units;
mod workspace;

use std::process::{Command, ExitCode};

use step::{ONLY, Step, run_steps};

const USAGE: &str = "cargo xtask TASK [WORD …]

With words, only the jobs of these names and the steps whose titles contain one of them run.

  test [--thorough]
           all tests, once. Jobs: unit (all crates), system (the command, new crates, Python, units, manual), pages (in a browser),
           oracles (CasADi, Pinocchio, MuJoCo, Exudyn, SciPy). Thoroughly, before a release, also: all seeds and states, fused
           multiply-adds, cranes without panics, a release where there is nothing else, the manual as a site, measurements
  lint     formatting, clippy, documentation, import rules, docs/EQUATIONS.md, licences of dependencies, the oldest compiler
  performance [--quick] [--without LIBRARY …]
           time the generated functions and other libraries in turns, write docs/performance.md; needs g++ or clang
  error-vs-runtime
           time methods and numbers of sections of the reference crane, write docs/error-vs-runtime.md
  instrument
           build the page as an instrument, out/instrument.html; needs Node.js, and Rust for wasm32-unknown-unknown, which rustup installs
  pictures make the pictures of README.md again; needs Node.js
  release  what is published, in target/published: the command as one file for this machine and for Linux on aarch64, Python wheels for
           Linux on x86-64 and aarch64, packages of the crates, checksums
  aarch64  what is published for Linux on aarch64, tried in an emulator; needs a Debian with qemu-user-static
  mutants [--seed N] [--count N] [--since COMMIT] [FILE …]
           change operators of the sources, one at a time in one build, and run the tests: which change does none of them notice?
  bless    rewrite the files that tests compare with: goldens, snapshots, schema, docs/OPERATIONS.md, the
           stub of the Python package";

fn main() -> ExitCode {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|word| word == "--thorough") {
        arguments.retain(|word| word != "--thorough");
        return run_again(&arguments, (THOROUGH, "1"));
    }
    let is_thorough = std::env::var_os(THOROUGH).is_some();
    let task = arguments.first().map_or("", String::as_str);
    let (name, value) = QUICK_BUILDS;
    if matches!(task, "test" | "lint") && !is_thorough && std::env::var_os(name).is_none() {
        return run_again(&arguments, (name, value));
    }
    let steps = match task {
        "test" => test_steps(is_thorough),
        "lint" => lint_steps(),
        "performance" => {
            vec![Step::check("times of the generated functions and of other libraries", oracles::measure_performance)]
        }
        "error-vs-runtime" => vec![Step::cargo("error against run time", &ERROR_VS_RUNTIME)],
        "instrument" => vec![Step::check("the page as an instrument", instrument::build_page)],
        "pictures" => picture_steps(),
        "release" => vec![
            Step::check("Python environment", oracles::prepare_python),
            Step::check("linker for other systems", cross::prepare),
            build_step(),
            Step::check("command and crates", release::build_release),
            Step::check("command for aarch64", cross::build_command),
            Step::check("wheels for x86-64 and aarch64", cross::build_wheels),
            Step::check("the wheel, where there is nothing else", release::rehearse_wheel),
            Step::check("checksums", release::write_checksums),
        ],
        "aarch64" => vec![
            Step::check("linker for other systems", cross::prepare),
            Step::check("command and wheel for aarch64", cross::build_for_aarch64),
            Step::check("a system for aarch64", cross::unpack_system),
            Step::check("command and wheel in the emulator", cross::rehearse),
        ],
        "bless" => bless_steps(),
        "mutants" => return mutants(&arguments[1..]),
        "help" | "--help" | "-h" => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        other => {
            eprintln!("no task `{other}`\n\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    if let [_, only, title] = &arguments[..]
        && only == ONLY
    {
        let step = steps.iter().find(|step| step.title == title);
        if let Err(message) = step.ok_or_else(|| "no such step".to_owned()).and_then(Step::run) {
            println!("{message}");
            return ExitCode::FAILURE;
        }
        return ExitCode::SUCCESS;
    }
    // A selection, by jobs and by words in titles; `performance` has its own options.
    let words: &[String] = if task == "performance" { &[] } else { &arguments[1..] };
    let is_chosen =
        |step: &Step| words.iter().any(|word| step.jobs.contains(&word.as_str()) || step.title.contains(word));
    let chosen: Vec<Step> = steps.into_iter().filter(|step| words.is_empty() || is_chosen(step)).collect();
    if chosen.is_empty() {
        eprintln!("no step of `{task}` has a title with these words");
        return ExitCode::from(2);
    }
    run_steps(task, &chosen)
}

/// Searches for changes of operators that no test notices, by a program in a workspace of its own.
fn mutants(arguments: &[String]) -> ExitCode {
    let manifest = workspace::root().join("tools/mutants/Cargo.toml");
    let mut command = Command::new(step::cargo());
    command.args(["run", "--quiet", "--release", "--manifest-path"]).arg(manifest).arg("--").args(arguments);
    match step::run_to_end(command.env("CARGO_TARGET_DIR", workspace::target().join("mutants/tool"))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// With diffsol for comparison.
const ERROR_VS_RUNTIME: [&str; 12] = [
    "run",
    "--release",
    "--package",
    "crane-lab",
    "--features",
    "yardstick",
    "--",
    "work-precision",
    "--page",
    "docs/error-vs-runtime.md",
    "--out",
    "target/error-vs-runtime",
];

/// Set while all seeds, states and rare configurations are tested, for steps and tests.
pub const THOROUGH: &str = "CRANE_THOROUGH";
/// Set for all that the checks build, in programs of cranes and in a new crate too: the units of a crate are not optimised once more as one.
/// Builds take a third less time, and compute the same a quarter slower. Thorough tests build what users get.
const QUICK_BUILDS: (&str, &str) = ("CARGO_PROFILE_RELEASE_LTO", "off");

/// The tests, job by job.
fn test_steps(is_thorough: bool) -> Vec<Step> {
    const ALL: &[&str] = &["unit", "system", "pages", "oracles", "thorough"];
    // What is downloaded and built first, beside each other: a build has times when it needs one core. Then what uses it.
    let packages = Step::check("packages of the report page", report::prepare_packages).light();
    let mut jobs: Vec<(&[&str], Vec<Step>)> = vec![
        (ALL, vec![build_step().light(), Step::check("Python environment", oracles::prepare_python).light()]),
        (&["system", "pages", "thorough"], vec![packages]),
        (&["system", "pages"], vec![Step::program("the default run", "crane", &[])]),
        // Random cranes are computed with the package, too.
        (&["system"], vec![Step::check("the stub of the Python package", package::check_stub)]),
        (&["system"], vec![Step::check("the Python package", package::check_package)]),
        // Beside each other: each has times when it leaves a core idle.
        (&["unit"], unit_steps().into_iter().map(Step::light).collect()),
        (&["system"], system_steps().into_iter().map(Step::light).collect()),
        (&["oracles"], oracle_steps().into_iter().map(Step::light).collect()),
        (&["pages"], page_steps()),
    ];
    if is_thorough {
        jobs.push((&["thorough"], thorough_steps()));
    }
    jobs.into_iter().flat_map(|(jobs, steps)| steps.into_iter().map(move |step| step.of_jobs(jobs))).collect()
}

/// Runs a task where all that it starts has a variable in its environment.
fn run_again(arguments: &[String], (name, value): (&str, &str)) -> ExitCode {
    let program = std::env::current_exe();
    let ended = program.and_then(|program| Command::new(program).args(arguments).env(name, value).status());
    if ended.is_ok_and(|status| status.success()) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn lint_steps() -> Vec<Step> {
    vec![
        Step::cargo("formatting", &["fmt", "--all", "--", "--check"]),
        Step::check("import rules", imports::check_imports),
        Step::check("plain English", prose::check_prose),
        Step::check("pages and links of the manual", book::check_manual),
        Step::check("terms of the glossary", glossary::check_glossary),
        Step::check("docs/EQUATIONS.md is current", equations::check_equations),
        Step::check("units built twice", units::check_units),
        // Clippy builds the compiler, which build scripts need, as a crate of its own.
        Step::cargo(
            "clippy",
            &[
                &["clippy", "--release", "--workspace", "--all-targets"][..],
                &["--config", "profile.release.package.crane-codegen.opt-level=0", "--", "-D", "warnings"],
            ]
            .concat(),
        )
        .with(SECTIONS, "0"),
        // Not of the generated cranes of the tests, whose text has no other comments than that of shipped ones.
        Step::cargo("documentation", &["doc", "--release", "--workspace", "--exclude", "crane-tests", "--no-deps"])
            .with("RUSTDOCFLAGS", "-D warnings")
            .with(SECTIONS, "0"),
        Step::check("licences and sources of dependencies", supply::check_dependencies),
        Step::check("the oldest compiler", supply::check_oldest_compiler),
    ]
}

/// Which cranes the benchmarks compile: for a check the smallest are enough.
const SECTIONS: &str = "CRANE_BENCH_SECTIONS";

/// All packages together, as the tests build them: alone, a package would select other features of its dependencies. This
/// includes the library of functional mock-up units, but not the crane without std, which its own step builds without them.
pub const ALL_PROGRAMS: [&str; 9] =
    ["build", "--release", "--workspace", "--exclude", "crane-bench", "--exclude", "no-std-crane", "--bins", "--lib"];

fn build_step() -> Step {
    Step::cargo("all programs", &ALL_PROGRAMS)
}

/// Libraries that none of their own tests depends on in another way, and whose tests compute little: building them without optimisation
/// takes a third of the time.
const UNOPTIMISED: [&str; 3] = ["crane-codegen", "crane-cli", "crane-page"];

fn unit_steps() -> Vec<Step> {
    let test = ["test", "--release", "--no-fail-fast"];
    let others = UNOPTIMISED.iter().flat_map(|name| ["--exclude", name]);
    let these: Vec<&str> = UNOPTIMISED.iter().flat_map(|name| ["--package", name]).collect();
    let all = test.into_iter().chain(["--workspace", "--exclude", "crane-bench"]);
    vec![
        Step::cargo("tests", &all.chain(others).collect::<Vec<_>>()),
        Step::cargo("tests of the compiler, the command and pages", &[&test[..], &these, &["--test", "*"]].concat()),
        Step::cargo("examples in their documentation", &[&test[..], &these, &["--doc"]].concat()),
        Step::check("tests in their modules", test_modules),
    ]
}

/// Runs the tests inside libraries.
fn test_modules() -> Result<(), String> {
    UNOPTIMISED.iter().try_for_each(|name| {
        let level = format!("profile.release.package.{name}.opt-level=0");
        Step::cargo(name, &["test", "--release", "--package", name, "--lib", "--config", &level]).run()
    })
}

fn system_steps() -> Vec<Step> {
    vec![
        Step::program("the example of your own crane", "own-crane", &[]),
        Step::check("a new crane", new_crane::check_new_crane),
        Step::check("commands of the manual", manual::check_manual),
        Step::check("commands of the README and of CONTRIBUTING", || commands::check_commands(USAGE)),
        Step::check("commands that pages name", || named::check_named(USAGE)),
        // A static library with its own panic handler: no crate that it depends on may link std or need a heap.
        Step::cargo(
            "a crane without std and heap",
            &[
                &["rustc", "--release", "--package", "no-std-crane", "--lib", "--features", "bare"][..],
                &["--crate-type", "staticlib", "--", "-C", "panic=abort"],
            ]
            .concat(),
        ),
        Step::check("random cranes by every way to compute them", outside::check_ways),
        Step::check("functional mock-up units", outside::check_units),
        Step::check("what the command prints as JSON", outside::check_output),
    ]
}

fn page_steps() -> Vec<Step> {
    vec![
        // Alone: without a graphics card a browser takes all cores.
        Step::check("the report page in a browser", report::check_in_browser),
        Step::check("the instrument in a browser", instrument::check_instrument),
        Step::check("the report page is current", report::check_current).light(),
        Step::check("the pictures of the README are current", pictures::check_pictures).light(),
        Step::check("pages of the Python package in a browser", report::check_in_notebook).light(),
    ]
}

/// What a release also needs: other configurations, packages, and documented measurements in their quick forms, since what is not run is
/// broken one day. No time is compared with anything.
fn thorough_steps() -> Vec<Step> {
    let once = ["bench", "--package", "crane-bench", "--", "--test"];
    let out = "target/error-vs-runtime/quick";
    let quick = ["work-precision", "knuckle_boom", "--quick", "--sections", "none", "--duration", "0.5", "--out", out];
    vec![
        Step::check("tests with fused multiply-adds", fused::check_fused),
        Step::check("cranes without panics", no_panic::check_no_panic),
        Step::check("a release, where there is nothing else", release::rehearse_release),
        Step::check("the manual as a site", book::build_site),
        Step::cargo("every benchmark once", &once).with(SECTIONS, "0"),
        Step::program("error against run time, quickly", "crane-lab", &quick),
        Step::check("times beside other libraries, quickly", oracles::rehearse_performance),
    ]
}

fn oracle_steps() -> Vec<Step> {
    vec![
        Step::check("CasADi's own checks notice errors", oracles::check_oracles),
        Step::check("generated code against CasADi", oracles::check_generated_code),
        Step::check("runs against SciPy's Radau", oracles::check_motion),
        Step::check("Pinocchio and MuJoCo agree and notice errors", oracles::check_peers),
        Step::check("generated code against Pinocchio and MuJoCo", oracles::compare_with_peers),
        Step::check("URDF and MJCF there and back", oracles::check_exchange),
        Step::check("cylinders against Exudyn", oracles::check_hydraulics),
    ]
}

fn picture_steps() -> Vec<Step> {
    vec![
        Step::check("packages of the report page", report::prepare_packages),
        Step::cargo("the default run", &["run", "--release"]),
        Step::check("the pictures of the README", pictures::make_pictures),
    ]
}

fn bless_steps() -> Vec<Step> {
    let update = |title, arguments: &[&str]| {
        Step::cargo(title, arguments)
            .with("UPDATE_GOLDEN", "1")
            .with("UPDATE_SCHEMA", "1")
            .with("INSTA_UPDATE", "always")
    };
    // The test that compares these files also compiles them, so the command writes them.
    let golden = |title, spec, module| Step::cargo(title, &["run", "--release", "--", "generate", spec, "-o", module]);
    vec![
        golden("double pendulum", "specs/double_pendulum.yaml", "tests/golden/double_pendulum.rs"),
        golden("knuckle boom", "specs/knuckle_boom.yaml", "tests/golden/knuckle_boom.rs"),
        update("schema and messages", &["test", "--release", "--package", "crane-codegen"]),
        update("operation counts", &["test", "--release", "--package", "crane-tests", "--test", "golden"]),
        Step::check("the stub of the Python package", package::write_stub),
    ]
}
