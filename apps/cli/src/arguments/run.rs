//! Runs: time, step, start, tables of parameters, and where results go.

use std::{num::NonZeroUsize, path::PathBuf, str::FromStr};

use clap::{Args, ValueHint};

use crane_model::dynamics::Method;

use super::{
    crane::{Analysis, Choice, Format, Limits, Parameters},
    number::{count, seconds, tolerance},
};

/// Step of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// The largest safe step.
    Auto,
    /// A number of seconds.
    Seconds(f64),
}

impl FromStr for Step {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Step::Auto);
        }
        text.parse().map(Step::Seconds).map_err(|_| "write a number of seconds, such as 1e-4, or `auto`".to_owned())
    }
}

/// Time and step of a run.
#[derive(Clone, Debug, Args)]
pub struct Timing {
    /// Integrator: `bdf` and `rosw4` are implicit and adaptive, for stiff cranes; `dopri5` is explicit and adaptive; `rk4` has a
    /// constant step, as in the paper [default: rk4 with --step and for `crane` without a command, otherwise bdf]
    #[arg(long, value_name = "NAME")]
    pub method: Option<Method>,
    /// Error per step that an adaptive method accepts, m and rad [default: 2e-5]
    #[arg(long, value_name = "NUMBER", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Largest step of rk4, s; `auto`: the largest safe step [default: from the spec]
    #[arg(long, value_name = "SECONDS|auto")]
    pub step: Option<Step>,
    /// Run even if the step exceeds the largest stable step
    #[arg(long)]
    pub force: bool,
    /// Do not estimate the error by repeating the run with a tenth of the tolerance or half the step
    #[arg(long)]
    pub no_verify: bool,
    /// Simulated time, s [default: from the spec]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub duration: Option<f64>,
    /// Interval between recorded results, s [default: from the spec]
    #[arg(long, alias = "output", value_name = "SECONDS", value_parser = seconds)]
    pub interval: Option<f64>,
    /// Start from the last row of a CSV file of results, including velocities; drive motions start again at t = 0
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
    /// Start from another value of a coordinate in m or rad, or of its rate, such as `boom_psi=0.3` or `boom_psi_rate=-0.1`; the
    /// others start at rest; may be given several times
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub start: Vec<String>,
}

/// Folder of results.
#[derive(Debug, Args)]
pub struct Folder {
    /// Folder for results; created if missing
    #[arg(long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
}

/// The comparison of the rigid and the flexible crane.
#[derive(Debug, Args)]
pub struct Compare {
    #[command(flatten)]
    pub parameters: Parameters,
    #[command(flatten)]
    pub limits: Limits,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Print all tables in full, including the poses
    #[arg(long)]
    pub all: bool,
    #[command(flatten)]
    pub timing: Timing,
    #[command(flatten)]
    pub folder: Folder,
}

/// A comparison of two cranes.
#[derive(Debug, Args)]
pub struct ComparePair {
    /// Crane, or its YAML file; `crane list` shows all cranes
    #[arg(value_name = "CRANE")]
    pub first: String,
    /// Another crane, or its YAML file [default: the first is compared with itself with beams that do not bend]
    #[arg(value_name = "OTHER")]
    pub second: Option<String>,
    /// Fail if a YAML file has warnings
    #[arg(long)]
    pub strict: bool,
    /// Value of an input instead of that of the spec, in the unit that `crane info` shows, for the cranes that have it; may be given
    /// several times
    #[arg(long = "input", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub inputs: Vec<String>,
    /// Replace beams that bend with rigid ones, in both cranes
    #[arg(long, requires = "second")]
    pub rigid: bool,
    #[command(flatten)]
    pub compare: Compare,
}

/// A run of one crane.
#[derive(Debug, Args)]
pub struct Run {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub timing: Timing,
    #[command(flatten)]
    pub folder: Folder,
}

/// A run of one crane, or of many.
#[derive(Debug, Args)]
pub struct Simulate {
    #[command(flatten)]
    pub run: Run,
    #[command(flatten)]
    pub ensemble: Ensemble,
}

/// Runs of many cranes that differ in their parameters.
#[derive(Debug, Args)]
pub struct Ensemble {
    /// Run one crane per row of a CSV table whose header names live parameters
    #[arg(long = "ensemble", value_name = "TABLE.csv", value_hint = ValueHint::FilePath)]
    pub table: Option<PathBuf>,
    /// File for peaks and final values, one row per crane [default: <CRANE>_ensemble.csv in the folder for results]
    #[arg(short = 'o', long = "file", value_name = "FILE", value_hint = ValueHint::FilePath, requires = "table")]
    pub results: Option<PathBuf>,
    /// Number of threads that run the cranes of the table [default: all cores]
    #[arg(long, value_name = "COUNT", requires = "table", value_parser = count)]
    pub threads: Option<NonZeroUsize>,
    /// Start again instead of continuing where the same command was interrupted
    #[arg(long, requires = "table")]
    pub restart: bool,
}

/// A report as one page.
#[derive(Debug, Args)]
pub struct Page {
    #[command(flatten)]
    pub crane: Choice,
    #[command(flatten)]
    pub timing: Timing,
    /// File to write
    #[arg(short = 'o', long, value_name = "FILE", default_value = "report.html", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// Show the load charts of an envelope, too: the file `…_envelope.csv` that `crane envelope` wrote
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub envelope: Option<PathBuf>,
    /// Show what moves what at rest, too: live parameters and sizes of beams, as `crane sensitivity` computes it
    #[arg(long)]
    pub sensitivity: bool,
    /// Show fatigue, too: options of `crane fatigue`, as in `--fatigue "--cycles 2e5 --category 71MPa"`
    #[arg(long, value_name = "OPTIONS", allow_hyphen_values = true)]
    pub fatigue: Option<String>,
    /// Offer to open the crane in the page as an instrument: its address, or where it lies seen from the folder of the report
    #[arg(long, value_name = "ADDRESS", value_hint = ValueHint::Url, value_parser = page_address)]
    pub instrument: Option<String>,
}

/// A document about a crane.
#[derive(Debug, Args)]
pub struct Book {
    #[command(flatten)]
    pub crane: Choice,
    /// Add the load chart: options of `crane envelope`, as in `--chart "--range boom_psi=0:60deg:13 --tipping 0.1"`
    #[arg(long, value_name = "OPTIONS", allow_hyphen_values = true)]
    pub chart: Option<String>,
    /// Add the manoeuvre: its figures, and the extremes of all loads during it
    #[arg(long)]
    pub run: bool,
    /// Add fatigue: options of `crane fatigue`, as in `--fatigue "--cycles 2e5 --category 71MPa"`
    #[arg(long, value_name = "OPTIONS", allow_hyphen_values = true)]
    pub fatigue: Option<String>,
    /// File to write
    #[arg(short = 'o', long, value_name = "FILE", default_value = "book.html", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    #[command(flatten)]
    pub folder: Folder,
}

/// The address of a page: none that a browser would run as a script.
fn page_address(text: &str) -> Result<String, String> {
    let scheme = text.split_once(':').map(|(scheme, _)| scheme.trim().to_ascii_lowercase());
    match scheme.as_deref() {
        None | Some("http" | "https" | "file") if !text.contains('#') => Ok(text.to_owned()),
        _ => Err("write the address of a page, such as `instrument.html` or one with `https:`, without `#`".into()),
    }
}
