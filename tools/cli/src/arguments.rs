//! Arguments of the command.

use std::{
    num::NonZeroUsize,
    path::{Path, PathBuf},
    str::FromStr,
};

use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};

use crane_model::dynamics::Method;

use crane_model::results::cautions::BEND;

const EXAMPLES: &str = "\
Examples:
  crane                                compare the eight-link crane with a rigid and with a flexible boom
  crane statics                        pose, drive torques, support reactions
  crane statics cantilever --format json
                                       the same for another crane, as JSON
  crane simulate --set load_mass=0 --out empty
                                       the manoeuvre without the log
  crane simulate --method rk4 --step 1e-4
                                       the manoeuvre, integrated as in the paper
  crane simulate --ensemble loads.csv -o peaks.csv
                                       one run per row of a table of parameters
  crane report -o report.html          the crane in 3-D, plots and tables on one page
  crane strength --run                 tipping margin, stresses and joint loads, at rest and during the manoeuvre
  crane envelope --range column_psi=0:360deg:25 --range boom_psi=0:70deg:15
                                       load chart and slew diagram: the largest load within limits, pose by pose
  crane compare my.yaml                your own crane, with beams that bend and with rigid ones
  crane modes                          frequencies and damping about the static pose
  crane linearise --time 2.5           matrices and modes about the motion in the middle of the manoeuvre
  crane stability                      largest stable steps and what limits them, with a figure
  crane check my.yaml; crane run my.yaml
                                       your own crane: find its mistakes, then compute everything
  crane explain my.yaml --svg my.svg   its bodies and coordinates, in words and as a picture
  crane new my-crane --from cantilever a Rust crate that compiles your own crane
  crane export my.yaml --format urdf -o my.urdf
                                       the crane for other programs, with its springs in my.springs.yaml
  crane import robot.urdf -o my.yaml   convert a URDF robot to a spec
  crane list                           the shipped cranes
  crane info                           coordinates, parameters, drives of a crane
  source <(crane completions bash)     completion of commands, options and shipped cranes

Exit codes:
  0  done
  1  no stable equilibrium, a run that grew without bound, a file that cannot be used
  2  wrong arguments";

/// Statics, motion and vibration of cranes compiled from YAML.
///
/// Without a command, the eight-link forest crane with a rigid boom is compared with the same crane with a flexible boom:
/// the static pose, then a manoeuvre of 5 s followed to 10 s. Figures (SVG), data (CSV) and a report (HTML) go to `out/`.
#[derive(Debug, Parser)]
#[command(name = "crane", version, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub action: Option<Action>,
    /// Options of the comparison.
    #[command(flatten)]
    pub compare: Compare,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Action {
    /// Compute statics, motion, figures and the report, written to a folder
    Run(Simulate),
    /// Compare two cranes, or a crane with itself with rigid beams: statics, motion, figures and the report
    Compare(ComparePair),
    /// Find the static equilibrium: pose, drive torques, support reactions
    Statics(Analysis),
    /// Compute tipping margin, stresses, loads on joints and ground, and the tipping load
    Strength(Strength),
    /// Find the largest load within limits over ranges of poses: load chart, diagrams, data
    Envelope(Envelope),
    /// Simulate the motion from the static pose; write results and figures to a folder
    Simulate(Simulate),
    /// Compute frequencies, damping and dominant coordinates about the static pose
    Modes(Modes),
    /// Linearise about a pose or a motion: A, D, K with gyroscopic terms, eigenvalues, mode shapes
    Linearise(Linearise),
    /// Write statics, motion and modes as one HTML page with the crane in 3-D
    Report(Page),
    /// Compute the largest stable step of every method and what limits it
    Stability(Stability),
    /// Show coordinates, bodies, supports, drives and parameters of a crane
    Info(Analysis),
    /// Evaluate quantities such as T, A and e at given states, for other programs
    Eval(Eval),
    /// Create a Rust crate for your own crane
    New(New),
    /// Check a spec: report every mistake and everything implausible
    Check(Check),
    /// Explain a spec: bodies, coordinates, omissions and operation counts; draw a picture
    Explain {
        /// Shipped crane or YAML file
        #[arg(value_name = "CRANE", value_hint = ValueHint::FilePath)]
        spec: String,
        /// Also draw the chain into this file
        #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
        svg: Option<PathBuf>,
    },
    /// Write a crane's Rust module, for your own program
    Generate(Generate),
    /// Print a Markdown table of operation counts: functions by cranes
    Operations {
        /// The cranes' YAML files
        #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
        specs: Vec<PathBuf>,
    },
    /// Print the JSON Schema of the spec language, for editors, or of what a command prints as JSON
    Schema {
        /// The command whose output is described
        #[arg(value_name = "COMMAND", value_enum)]
        of: Option<Output>,
    },
    /// Export a crane as URDF or MJCF, for Pinocchio, MuJoCo, ROS and others
    Export(Export),
    /// Convert a URDF robot to a spec
    Import(Import),
    /// List the shipped cranes
    List(List),
    /// Print a completion script for a shell
    Completions {
        /// Shell to write it for.
        shell: clap_complete::Shell,
    },
}

impl Action {
    /// The crane, chosen by its name or by a YAML file.
    pub fn choice(&mut self) -> Option<&mut Choice> {
        match self {
            Action::Run(options) | Action::Simulate(options) => Some(&mut options.analysis.crane),
            Action::Statics(options) | Action::Info(options) => Some(&mut options.crane),
            Action::Modes(options) => Some(&mut options.analysis.crane),
            Action::Linearise(options) => Some(&mut options.analysis.crane),
            Action::Strength(options) => Some(&mut options.analysis.crane),
            Action::Envelope(options) => Some(&mut options.analysis.crane),
            Action::Stability(options) => Some(&mut options.analysis.crane),
            Action::Report(options) => Some(&mut options.crane),
            Action::Eval(options) => Some(&mut options.crane),
            Action::Compare(_)
            | Action::New(_)
            | Action::Check(_)
            | Action::Explain { .. }
            | Action::Generate(_)
            | Action::Operations { .. }
            | Action::Schema { .. }
            | Action::Export(_)
            | Action::Import(_)
            | Action::List(_)
            | Action::Completions { .. } => None,
        }
    }
}

/// Output format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    #[default]
    Table,
    /// For programs.
    Json,
}

/// What a command prints as JSON.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Output {
    /// Mistakes and warnings.
    Check,
    /// An equilibrium.
    Statics,
    /// Small motions.
    Modes,
    /// Small motions about a pose or a motion.
    Linearise,
    /// Largest stable steps.
    Stability,
    /// A run.
    Simulate,
    /// `simulate --ensemble`: many runs.
    Ensemble,
    /// Tipping margins, stresses and loads.
    Strength,
    /// Largest loads.
    Envelope,
    /// Two cranes.
    Compare,
    /// Everything about a crane.
    Run,
    /// What a crane consists of.
    Info,
    /// The shipped cranes.
    List,
}

/// A spec to check.
#[derive(Debug, Args)]
pub struct Check {
    /// Shipped crane, YAML file, or `-` for the standard input
    #[arg(value_name = "CRANE", value_hint = ValueHint::FilePath)]
    pub spec: String,
    /// Treat warnings as mistakes
    #[arg(long)]
    pub strict: bool,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// A crane with its live parameters.
#[derive(Debug, Args)]
pub struct Choice {
    /// Shipped crane, YAML file, or `-` for the standard input; `crane list` shows the shipped cranes
    #[arg(default_value = "eight_link_flexible", value_name = "CRANE")]
    pub name: String,
    /// Treat warnings about the YAML file as mistakes
    #[arg(long)]
    pub strict: bool,
    /// Values of its live parameters.
    #[command(flatten)]
    pub parameters: Parameters,
    /// Value of an input in place of what the spec says, in the unit that `crane info` shows; may be given several times
    #[arg(long = "input", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub inputs: Vec<String>,
    /// Limits of what the model holds for.
    #[command(flatten)]
    pub limits: Limits,
    /// Replace beams that bend by rigid ones
    #[arg(long, conflicts_with = "compile")]
    pub rigid: bool,
    /// Compile the crane to machine code first (needs cargo) and keep it: about five times faster, for long studies
    #[arg(long)]
    pub compile: bool,
}

impl Choice {
    /// The YAML file, if one is given instead of a shipped crane.
    pub fn file(&self) -> Option<&Path> {
        spec_file(&self.name)
    }
}

/// What stands for the standard input in place of a file.
pub const STANDARD_INPUT: &str = "-";

/// The YAML file, or the standard input, that stands in place of a crane's name.
pub fn spec_file(name: &str) -> Option<&Path> {
    let path = Path::new(name);
    let yaml = path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml");
    (yaml || name == STANDARD_INPUT).then_some(path)
}

/// Values of live parameters.
#[derive(Debug, Args)]
pub struct Parameters {
    /// Set a live parameter, in the unit that `crane info` shows; repeatable
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub settings: Vec<String>,
}

/// Limits within which the model is valid.
#[derive(Clone, Copy, Debug, Args)]
pub struct Limits {
    /// Bending or torsion of one beam section beyond which a caution is printed, degrees
    #[arg(long = "bend-limit", value_name = "DEGREES", default_value_t = BEND)]
    pub bend: f64,
}

/// An analysis that prints tables.
#[derive(Debug, Args)]
pub struct Analysis {
    /// The crane.
    #[command(flatten)]
    pub crane: Choice,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Print all tables whole: the pose, all modes, all sections
    #[arg(long)]
    pub all: bool,
}

/// A length of time.
///
/// # Errors
/// What to write instead.
pub fn seconds(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "write a number of seconds, such as 0.5".to_owned())
}

/// An error that is allowed.
fn tolerance(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "write a number, such as 1e-4".to_owned())
}

/// A tipping margin.
fn margin(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    number
        .filter(|margin| (0.0..1.0).contains(margin))
        .ok_or_else(|| "write a number from 0 to below 1, such as 0.25".to_owned())
}

/// A number above zero.
fn above_zero(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    number
        .filter(|number| *number > 0.0 && number.is_finite())
        .ok_or_else(|| "write a number above 0, such as 0.8".to_owned())
}

/// A number of things, at least one.
fn count(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "write a whole number of 1 or more, such as 4".to_owned())
}

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
    /// constant step, as in the paper [default: rk4 with --step and for the comparison, otherwise bdf]
    #[arg(long, value_name = "NAME")]
    pub method: Option<Method>,
    /// Error per step that an adaptive method accepts, m and rad [default: 2e-5]
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Largest step of rk4, s; `auto`: the largest safe step [default: from the spec]
    #[arg(long, value_name = "SECONDS|auto", allow_negative_numbers = true)]
    pub step: Option<Step>,
    /// Run even if the step exceeds the largest stable step
    #[arg(long)]
    pub force: bool,
    /// Do not estimate the error by repeating the run with a tenth of the tolerance or half the step
    #[arg(long)]
    pub no_verify: bool,
    /// Simulated time, s [default: from the spec]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub duration: Option<f64>,
    /// Interval between recorded results, s [default: from the spec]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub output: Option<f64>,
    /// Start from the last row of a CSV file of results, including velocities; drive motions start again at t = 0
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
    /// Start from another value of a coordinate in m or rad, or of its rate, such as `boom_psi=0.3` or `boom_psi_rate=-0.1`; the
    /// others start at rest; repeatable
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
    /// Print all tables whole: the poses, too
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
    /// Fail where a YAML file has warnings
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub compare: Compare,
}

/// A run of one crane.
#[derive(Debug, Args)]
pub struct Simulate {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub timing: Timing,
    #[command(flatten)]
    pub folder: Folder,
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
}

/// A crate for your own crane.
#[derive(Debug, Args)]
pub struct New {
    /// Folder to create; the crate and the crane get its name
    #[arg(value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// Shipped crane or YAML file to start from
    #[arg(long, value_name = "CRANE", default_value = "knuckle_boom", value_hint = ValueHint::FilePath)]
    pub from: String,
    /// Copy the crates that it depends on into it: it then builds anywhere, without the source of `crane`
    #[arg(long)]
    pub vendor: bool,
}

/// The Rust module of a crane.
#[derive(Debug, Args)]
pub struct Generate {
    /// Shipped crane or YAML file
    #[arg(value_name = "CRANE", value_hint = ValueHint::FilePath)]
    pub spec: String,
    /// File to write [default: standard output]
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Generate all functions, including those that the spec's `analyses` do not request
    #[arg(long)]
    pub all: bool,
    /// Also write every stage of the compilation as text to a folder: spec, chain, expressions, statements, Rust
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub dump: Option<PathBuf>,
}

/// Loads and stability against tipping.
#[derive(Debug, Args)]
pub struct Strength {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub timing: Timing,
    /// Also evaluate the manoeuvre: smallest tipping margin, extremes of all loads and their times
    #[arg(long)]
    pub run: bool,
    /// Live parameter to use as the load: find the values at which the first foot lifts and the crane tips [default: the only
    /// parameter in kg]
    #[arg(long, value_name = "PARAMETER")]
    pub load: Option<String>,
    /// CSV file for the moments about the tipping lines and all loads during the run
    #[arg(short = 'o', long = "file", value_name = "FILE", value_hint = ValueHint::FilePath, requires = "run")]
    pub results: Option<PathBuf>,
}

/// The largest load within limits over ranges of poses.
#[derive(Debug, Args)]
pub struct Envelope {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Positions of a drive, or values of a live parameter: from, to and how many, or one value, as in `boom_psi=0:60deg:13` and
    /// `telescope_z=1.5`; may be given several times
    #[arg(long = "range", value_name = "NAME=FROM:TO:COUNT", required = true, allow_hyphen_values = true)]
    pub ranges: Vec<String>,
    /// Live parameter that is the load [default: the only parameter in kg]
    #[arg(long, value_name = "PARAMETER")]
    pub load: Option<String>,
    /// The greatest load looked at, in the unit of its parameter [default: a hundred times the crane's mass]
    #[arg(long, value_name = "NUMBER")]
    pub greatest_load: Option<f64>,
    /// Least tipping margin, 1 − overturning / stabilising moment about each tipping line
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0, value_parser = margin)]
    pub tipping: f64,
    /// Greatest utilisation of beams with a yield stress
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0, value_parser = above_zero)]
    pub utilisation: f64,
    /// Greatest torque or force of a drive, in either direction, N m or N, as in `boom_psi=80000`; may be given several times
    #[arg(long = "effort", value_name = "DRIVE=NUMBER")]
    pub efforts: Vec<String>,
    /// How far the load may move a point of interest, m, as in `hook=0.1`; may be given several times
    #[arg(long = "deflection", value_name = "POINT=METRES")]
    pub deflections: Vec<String>,
    /// Point whose radius and height are shown [default: the only point of interest, otherwise the origin of the last link]
    #[arg(long, value_name = "POINT")]
    pub point: Option<String>,
    /// Threads [default: all of the machine]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub threads: Option<NonZeroUsize>,
    /// Start again instead of continuing where the same command was interrupted
    #[arg(long)]
    pub restart: bool,
    #[command(flatten)]
    pub folder: Folder,
}

/// Small vibrations.
#[derive(Debug, Args)]
pub struct Modes {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Write pose, mass, stiffness and damping matrices, eigenvalues and mode shapes to a file, `.json` or `.npz`
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub matrices: Option<PathBuf>,
}

/// Small motions about a pose or a motion.
#[derive(Debug, Args)]
pub struct Linearise {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Time at which drives, loads and winches are, s; driven coordinates have the rates of their motions then [default: 0, or that
    /// of the last row with --from]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub time: Option<f64>,
    /// Hold a coordinate at a position or at a rate, in m, rad, m/s or rad/s or as an angle, as in `boom_psi=30deg` and
    /// `column_psi_rate=0.2`; the others take the pose in which they stay; may be given several times
    #[arg(long = "hold", value_name = "NAME=VALUE", allow_hyphen_values = true, conflicts_with = "from")]
    pub held: Vec<String>,
    /// Linearise about the motion in a row of a CSV file of results, the last or that at --time, instead of a steady motion
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
    /// Also write motion, matrices, eigenvalues and shapes to an archive for `numpy.load`
    #[arg(short = 'o', long, value_name = "FILE.npz", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

/// Stability of time steps.
#[derive(Debug, Args)]
pub struct Stability {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Number of further equilibria to evaluate, at times evenly spaced over the manoeuvre
    #[arg(long, value_name = "COUNT", default_value_t = 10, value_parser = clap::value_parser!(u16).range(..=1000))]
    pub along: u16,
    /// Folder for the figure; created if missing
    #[arg(long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
}

/// Language of other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Language {
    /// Kinematics and masses; springs, dampers and supports go to a second file.
    Urdf,
    /// With stiffness, damping and spring references of joints; linear supports are tendons.
    Mjcf,
    /// C99 for controllers: chosen functions, without a heap.
    C,
    /// A functional mock-up unit, FMI 2.0, for co-simulation and model exchange: the whole crane, ready to run elsewhere.
    Fmu,
}

/// Type of numbers in C.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum CNumber {
    /// 64 bits.
    #[default]
    Double,
    /// 32 bits, for controllers that compute in them.
    Single,
}

/// A crane for other programs.
#[derive(Debug, Args)]
pub struct Export {
    #[command(flatten)]
    pub crane: Choice,
    /// Language to write
    #[arg(long, value_enum)]
    pub format: Language,
    /// File to write [default: the crane's name with .urdf, .xml, .c or .fmu]
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Functions to write in C, with commas between; a wrong name lists all
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_value = "mass_matrix,bias,forward_dynamics")]
    pub functions: Vec<String>,
    /// Type of numbers in C
    #[arg(long, value_enum, default_value_t)]
    pub precision: CNumber,
    /// Shared library to put into an FMU, .so, .dll or .dylib; given several times the FMU runs on several systems
    /// [default: the one beside the command]
    #[arg(long = "library", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub libraries: Vec<PathBuf>,
}

/// A spec from another program's file.
#[derive(Debug, Args)]
pub struct Import {
    /// URDF file
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub urdf: PathBuf,
    /// Spec to write [default: standard output]
    #[arg(short = 'o', long = "file", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,
    /// Joint to hold at zero, such as a gripper's; repeatable
    #[arg(long = "fix", value_name = "JOINT")]
    pub fixed: Vec<String>,
}

/// A list of the cranes.
#[derive(Debug, Args)]
pub struct List {
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// Output format of evaluated matrices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum EvalFormat {
    /// One object of nested arrays.
    #[default]
    Json,
    /// Archive for `numpy.load`, uncompressed.
    Npz,
}

/// What `crane eval` computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Quantity {
    /// Transforms of the bodies into the world frame, 4 × 4 each; m
    Transforms,
    /// ∂T/∂q, with the body and coordinate of each
    TransformDerivatives,
    /// ∂²T/∂q∂q, with the body and coordinates of each
    TransformSecondDerivatives,
    /// Positions of the points of interest, m
    Points,
    /// Velocities of the points of interest, m/s
    PointVelocities,
    /// Mass matrix A; kg, kg m, kg m²
    MassMatrix,
    /// Velocity and gravity forces e, N and N m
    Bias,
    /// Generalized forces of everything except inertia and gravity, N and N m
    Forces,
    /// Accelerations q̈, m/s² and rad/s²
    Accelerations,
    /// Gradient of the potential energy at t = 0, N and N m
    StaticResidual,
    /// Second derivative of the potential energy at t = 0, N/m and N m/rad
    TangentStiffness,
    /// Energies: kinetic, of gravity, supports, elements and drives; J
    Energies,
    /// Efforts of the drives, N and N m
    DriveEfforts,
    /// Forces of the supports on the crane, N
    SupportReactions,
}

/// Quantities at one state or at many.
#[derive(Debug, Args)]
pub struct Eval {
    #[command(flatten)]
    pub crane: Choice,
    /// What to compute, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', value_name = "NAMES",
          default_values_t = [Quantity::Transforms, Quantity::TransformDerivatives, Quantity::MassMatrix, Quantity::Bias])]
    pub quantities: Vec<Quantity>,
    /// Coordinates in m and rad: numbers separated by commas or blanks, or a file of them; several states follow one another
    /// [default: the spec's guess]
    #[arg(long, value_name = "NUMBERS|FILE", allow_hyphen_values = true)]
    pub q: Option<String>,
    /// Velocities in m/s and rad/s, given likewise, per state or once for all states [default: 0]
    #[arg(long, value_name = "NUMBERS|FILE", allow_hyphen_values = true)]
    pub v: Option<String>,
    /// Time at which the drive motions are evaluated, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    pub time: f64,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: EvalFormat,
    /// File to write [default: standard output]
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}
