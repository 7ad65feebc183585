//! The compiler as a command.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use crane_codegen::chain::{Analyses, Chain};
use crane_codegen::compile::Compiled;
use crane_codegen::{Checked, Diagnostics, build, compile, explain, json_schema, picture};

/// Compiles a crane described in YAML to specialised Rust.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  crane-codegen check specs/eight_link_flexible.yaml
  crane-codegen explain specs/cantilever.yaml
  crane-codegen generate specs/double_pendulum.yaml -o double_pendulum.rs

Exit codes: 0 done, 1 the spec has mistakes, 2 wrong arguments."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write the crane's module
    Generate {
        /// The crane's YAML file
        spec: PathBuf,
        /// Where to write; standard output if left out
        #[arg(short, long)]
        output: Option<PathBuf>,
        /// Generate everything there is, also what the spec's `analyses` do not ask for
        #[arg(long)]
        all: bool,
    },
    /// Check a spec: draw every mistake in it, or what is implausible
    Check {
        /// The crane's YAML file
        spec: PathBuf,
        /// Fail on warnings, too
        #[arg(long)]
        strict: bool,
    },
    /// Print the chain, its coordinates, what is left out and why, and what each function costs
    Explain {
        /// The crane's YAML file
        spec: PathBuf,
        /// Count everything there is, also what the spec's `analyses` do not ask for
        #[arg(long)]
        all: bool,
        /// Also draw the chain into this SVG file
        #[arg(long)]
        svg: Option<PathBuf>,
    },
    /// Print a Markdown table of operations: one row a function, one column a spec
    Operations {
        /// The cranes' YAML files
        #[arg(required = true)]
        specs: Vec<PathBuf>,
    },
    /// Print the JSON Schema of the spec language, for editors
    Schema,
}

fn main() -> ExitCode {
    match run(&Arguments::parse().command) {
        Ok(text) => {
            // A reader that has seen enough may close the pipe.
            let _ = std::io::stdout().write_all(text.as_bytes());
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: &Command) -> Result<String, String> {
    match command {
        Command::Generate { spec, output, all } => {
            let Compiled { code, warnings } = compiled(spec, *all)?;
            warn(&warnings);
            if let Some(warning) = code.report.warning(&code.name) {
                eprintln!("warning: {warning}");
            }
            let Some(target) = output else { return Ok(code.text) };
            build::write(target, &code.text).map_err(|error| format!("{}: {error}", target.display()))?;
            let functions = code.report.costs.len();
            Ok(format!("{}: {functions} functions, {} lines\n", target.display(), code.text.lines().count()))
        }
        Command::Check { spec, strict } => {
            let Checked { chain, warnings } = checked(spec)?;
            if *strict && !warnings.is_empty() {
                return Err(warnings.to_string());
            }
            warn(&warnings);
            let (bodies, coordinates) = (chain.bodies.len(), chain.coordinates.len());
            Ok(format!("{}: sound; {bodies} bodies, {coordinates} coordinates\n", spec.display()))
        }
        Command::Explain { spec, all, svg } => {
            let chain = loaded(spec)?;
            if let Some(target) = svg {
                let drawn = build::write(target, &picture::picture(&chain));
                drawn.map_err(|error| format!("{}: {error}", target.display()))?;
            }
            let analyses = if *all { Analyses::ALL } else { chain.analyses };
            Ok(explain::explain(&chain, &compile::report(&chain, analyses)))
        }
        Command::Operations { specs } => {
            let report =
                |spec: &PathBuf| loaded(spec).map(|chain| (chain.name.clone(), compile::report(&chain, Analyses::ALL)));
            Ok(explain::operations_table(&specs.iter().map(report).collect::<Result<Vec<_>, _>>()?))
        }
        Command::Schema => Ok(json_schema()),
    }
}

fn checked(spec: &Path) -> Result<Checked, String> {
    let source = build::open(spec).map_err(|error| error.to_string())?;
    compile::check(&source).map_err(|mistakes| mistakes.to_string())
}

/// The chain of a spec; warnings are drawn.
fn loaded(spec: &Path) -> Result<Chain, String> {
    let Checked { chain, warnings } = checked(spec)?;
    warn(&warnings);
    Ok(chain)
}

/// Draws warnings on standard error.
fn warn(warnings: &Diagnostics) {
    if !warnings.is_empty() {
        eprintln!("{warnings}\n");
    }
}

fn compiled(spec: &Path, all: bool) -> Result<Compiled, String> {
    let source = build::open(spec).map_err(|error| error.to_string())?;
    compile::compile(&source, all.then_some(Analyses::ALL)).map_err(|mistakes| mistakes.to_string())
}
