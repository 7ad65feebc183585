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
  crane                                the eight-link crane, rigid against flexible
  crane statics                        pose, drive torques, support reactions
  crane statics cantilever --format json
                                       the same of another crane, for a program
  crane simulate --set load_mass=0 --out empty
                                       the manoeuvre without the log
  crane simulate --method rk4 --step 1e-4
                                       the manoeuvre as the paper integrates it
  crane simulate --ensemble loads.csv -o peaks.csv
                                       a crane for every row of a table of parameters
  crane report -o report.html          the crane in 3-D, plots and tables as a page that needs no network
  crane strength --run                 tipping margin, stresses, loads of joints, at rest and along the manoeuvre
  crane modes                          frequencies and damping about the static pose
  crane stability                      largest stable steps, what limits them, and a figure
  crane work-precision                 what accuracy costs: methods, steps, tolerances, numbers of sections
  crane stress --quick                 stiff and extreme cranes, as expected or not
  crane check my.yaml; crane run my.yaml
                                       your own crane: its mistakes; everything about it
  crane explain my.yaml --svg my.svg   its chain, in words and as a picture
  crane new my-crane --from cantilever a crate that compiles your own crane
  crane export my.yaml --format urdf -o my.urdf
                                       the chain for other programs, its springs in my.springs.yaml beside it
  crane import robot.urdf -o my.yaml   a spec from a robot of others
  crane list                           the cranes to choose from
  crane info                           coordinates, parameters, drives of a crane
  source <(crane completions bash)     completion of commands and options

Exit codes:
  0  done
  1  no stable equilibrium, a run that grew without bound, a file that cannot be used
  2  wrong arguments";

/// Statics, motion and vibration of cranes compiled from YAML.
///
/// Without a command: the eight-link forest crane, rigid and with a flexible boom. Static pose, a manoeuvre of 5 s
/// followed to 10 s, and the comparison of both as figures (SVG) and data (CSV) in `out/`.
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
    /// All of it: statics, motion, figures and the report, into a folder
    Run(Simulate),
    /// Static equilibrium: pose, drive torques, support reactions
    Statics(Analysis),
    /// Tipping margin, stresses and utilisation of beams, loads of the ground and the joints; the load that tips the crane
    Strength(Strength),
    /// Motion from the static pose: results, figures and a record of the run into a folder
    Simulate(Simulate),
    /// Frequencies, damping and dominating coordinates about the static pose, and the largest stable step
    Modes(Analysis),
    /// Statics, motion and modes as one HTML page: the crane in 3-D, plots, tables
    Report(Page),
    /// Largest stable step of every method and what limits it, at the static pose and along the manoeuvre
    Stability(Stability),
    /// Error against run time of every method and number of sections, and which of them are cheapest for an error
    WorkPrecision(WorkPrecision),
    /// Stiff and extreme cranes: what is expected of each, and what happens
    Stress(Stress),
    /// What a crane consists of: coordinates, bodies, supports, drives, parameters
    Info(Analysis),
    /// T, ∂T/∂q, ∂²T/∂q∂q, A and e at a state, for checks by other programs
    Eval(Eval),
    /// A crate for your own crane, begun from a shipped one
    New(New),
    /// Check a spec: every mistake in it, or what is implausible
    Check {
        /// The crane's YAML file
        #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
        spec: PathBuf,
        /// Fail on warnings, too
        #[arg(long)]
        strict: bool,
    },
    /// The chain of a spec: bodies, coordinates, what is left out and why, what each function costs
    Explain {
        /// The crane's YAML file
        #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
        spec: PathBuf,
        /// Also draw the chain into this file
        #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
        svg: Option<PathBuf>,
    },
    /// Write the crane's Rust module, for a program of your own
    Generate(Generate),
    /// Print a Markdown table of operations: one row per function, one column per spec
    Operations {
        /// The cranes' YAML files
        #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
        specs: Vec<PathBuf>,
    },
    /// Print the JSON Schema of the spec language, for editors
    Schema,
    /// A crane as URDF, its springs beside it, or as MJCF, for Pinocchio, `MuJoCo`, ROS and others
    Export(Export),
    /// A spec from URDF: a chain of joints of one axis each
    Import(Import),
    /// The cranes to choose from
    List(List),
    /// Completion script for a shell
    Completions {
        /// Shell to write it for.
        shell: clap_complete::Shell,
    },
}

impl Action {
    /// The crane that is chosen by name, or by a YAML file in place of it.
    pub fn choice(&mut self) -> Option<&mut Choice> {
        match self {
            Action::Run(options) | Action::Simulate(options) => Some(&mut options.analysis.crane),
            Action::Statics(options) | Action::Modes(options) | Action::Info(options) => Some(&mut options.crane),
            Action::Strength(options) => Some(&mut options.analysis.crane),
            Action::Stability(options) => Some(&mut options.analysis.crane),
            Action::Report(options) => Some(&mut options.crane),
            Action::Eval(options) => Some(&mut options.crane),
            // Compiles the crane with other numbers of sections along.
            Action::WorkPrecision(_)
            | Action::New(_)
            | Action::Stress(_)
            | Action::Check { .. }
            | Action::Explain { .. }
            | Action::Generate(_)
            | Action::Operations { .. }
            | Action::Schema
            | Action::Export(_)
            | Action::Import(_)
            | Action::List(_)
            | Action::Completions { .. } => None,
        }
    }
}

/// Form of what is printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    #[default]
    Table,
    /// For programs.
    Json,
}

/// A crane with its live parameters.
#[derive(Debug, Args)]
pub struct Choice {
    /// Crane, or its YAML file; `crane list` shows all cranes
    #[arg(default_value = "eight_link_flexible", value_name = "CRANE")]
    pub name: String,
    /// Fail where the YAML file has warnings
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub parameters: Parameters,
    #[command(flatten)]
    pub limits: Limits,
    /// Compile the crane to machine code first, with cargo, and keep it: some five times faster, for long studies
    #[arg(long)]
    pub compile: bool,
}

impl Choice {
    /// The YAML file that is named in place of a crane.
    pub fn file(&self) -> Option<&Path> {
        let path = Path::new(&self.name);
        path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml").then_some(path)
    }
}

/// Values of live parameters.
#[derive(Debug, Args)]
pub struct Parameters {
    /// Value of a live parameter, in the unit that `crane info` shows; may be given several times
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub settings: Vec<String>,
}

/// Limits of what the model holds for.
#[derive(Clone, Copy, Debug, Args)]
pub struct Limits {
    /// Angle by which one section of a beam may bend or twist before a caution says so, degrees
    #[arg(long = "bend-limit", value_name = "DEGREES", default_value_t = BEND)]
    pub bend: f64,
}

/// An analysis that prints tables.
#[derive(Debug, Args)]
pub struct Analysis {
    #[command(flatten)]
    pub crane: Choice,
    /// Form of what is printed
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// A length of time.
fn seconds(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "write a number of seconds, such as 0.5".to_owned())
}

/// An error that is allowed.
fn tolerance(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "write a number, such as 1e-4".to_owned())
}

/// A number of things, at least one.
fn count(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "write a whole number from 1 on, such as 4".to_owned())
}

/// Step of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// The largest safe one.
    Auto,
    /// So many seconds.
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
    /// Method: `bdf` and `rosw4` implicit and adaptive, for stiff cranes; `dopri5` explicit and adaptive; `rk4` with constant
    /// step, the paper's [default: rk4 with --step and for the comparison, otherwise bdf]
    #[arg(long, value_name = "NAME")]
    pub method: Option<Method>,
    /// Error that an adaptive method allows a step, m and rad [default: 2e-5]
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Greatest step of rk4, s; `auto`: the largest safe one [default: the crane's]
    #[arg(long, value_name = "SECONDS|auto", allow_negative_numbers = true)]
    pub step: Option<Step>,
    /// Run even where the step is beyond the largest stable one
    #[arg(long)]
    pub force: bool,
    /// Do not repeat the run at a tenth of the tolerance or half the step to estimate its error
    #[arg(long)]
    pub no_verify: bool,
    /// Simulated time, s [default: the crane's]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub duration: Option<f64>,
    /// Interval of recorded results, s [default: the crane's]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub output: Option<f64>,
    /// Start from the last row of a CSV file of results, with its rates; motions of drives begin at t = 0 again
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
    /// Start with other values: a coordinate in m or rad, or its rate, as in `boom_psi=0.3` and `boom_psi_rate=-0.1`; what is not
    /// given is as at rest
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub start: Vec<String>,
}

/// Folder of results.
#[derive(Debug, Args)]
pub struct Folder {
    /// Folder for results; made where it is missing
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
    /// Form of what is printed
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    #[command(flatten)]
    pub timing: Timing,
    #[command(flatten)]
    pub folder: Folder,
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
    /// Run a crane for every row of a CSV table whose header names live parameters
    #[arg(long = "ensemble", value_name = "TABLE.csv", value_hint = ValueHint::FilePath)]
    pub table: Option<PathBuf>,
    /// File for peaks and final values, a row a crane [default: <CRANE>_ensemble.csv in the folder for results]
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "table")]
    pub results: Option<PathBuf>,
    /// Threads that run the cranes of the table [default: all of the machine]
    #[arg(long, value_name = "COUNT", requires = "table", value_parser = count)]
    pub threads: Option<NonZeroUsize>,
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
}

/// A crate for your own crane.
#[derive(Debug, Args)]
pub struct New {
    /// Folder to make; its name is the crate's and the crane's
    #[arg(value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// Shipped crane to begin from
    #[arg(long, value_name = "CRANE", default_value = "knuckle_boom")]
    pub from: String,
}

/// The Rust module of a crane.
#[derive(Debug, Args)]
pub struct Generate {
    /// The crane's YAML file
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,
    /// File to write [default: standard output]
    #[arg(short = 'o', long = "output", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Generate everything there is, also what the spec's `analyses` do not ask for
    #[arg(long)]
    pub all: bool,
    /// Write every stage of the compilation as text into a folder too: spec, chain, expressions, statements, Rust
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
    /// Along the manoeuvre, too: least tipping margin, extremes of all loads with their times
    #[arg(long)]
    pub run: bool,
    /// Live parameter that is the load: which value of it lifts the first foot, and which tips the crane [default: the only
    /// parameter in kg]
    #[arg(long, value_name = "PARAMETER")]
    pub load: Option<String>,
    /// File for moments about tipping lines and all loads over the run, CSV
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "run")]
    pub results: Option<PathBuf>,
}

/// Stability of time steps.
#[derive(Debug, Args)]
pub struct Stability {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Poses along the manoeuvre at which to look as well, evenly in time: where the crane would rest there
    #[arg(long, value_name = "COUNT", default_value_t = 10, value_parser = clap::value_parser!(u16).range(..=1000))]
    pub along: u16,
    /// Folder for the figure; made where it is missing
    #[arg(long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
}

/// Language of other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Language {
    /// Kinematics and masses; springs, dampers and supports in a file beside it.
    Urdf,
    /// `MuJoCo`'s, with stiffness, damping and spring references of joints; linear supports as tendons.
    Mjcf,
}

/// A crane for other programs.
#[derive(Debug, Args)]
pub struct Export {
    #[command(flatten)]
    pub crane: Choice,
    /// Language to write
    #[arg(long, value_enum)]
    pub format: Language,
    /// File to write [default: the crane's name with .urdf or .xml]
    #[arg(short = 'o', long = "output", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

/// A spec from another program's file.
#[derive(Debug, Args)]
pub struct Import {
    /// URDF file
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub urdf: PathBuf,
    /// Spec to write [default: standard output]
    #[arg(short = 'o', long = "output", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,
    /// Joint to hold at zero, such as a finger's; may be given several times
    #[arg(long = "fix", value_name = "JOINT")]
    pub fixed: Vec<String>,
}

/// Error against run time.
#[derive(Debug, Args)]
pub struct WorkPrecision {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Numbers of sections of every flexible link to compare, two or more; `none` compares the methods alone
    #[arg(long, value_name = "COUNTS|none", default_value = "1,2,3,4,6,8,12,20,30")]
    pub sections: Counts,
    /// Simulated time, s [default: the crane's]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub duration: Option<f64>,
    /// Fewer steps and tolerances, each run once, without compiling: to look whether it works
    #[arg(long)]
    pub quick: bool,
    /// Folder for tables (CSV) and figures (SVG); made where it is missing
    #[arg(long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// Also write all of it as a Markdown page, with its figures in `images` beside it
    #[arg(long, value_name = "FILE.md", value_hint = ValueHint::FilePath)]
    pub page: Option<PathBuf>,
}

/// Numbers of sections, ascending; none or at least two.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts(pub Vec<usize>);

impl FromStr for Counts {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Counts(Vec::new()));
        }
        let counts: Result<Vec<usize>, _> = text.split(',').map(|count| count.trim().parse()).collect();
        let mut counts = counts.map_err(|_| "write whole numbers such as 2,4,8, or `none`".to_owned())?;
        counts.sort_unstable();
        counts.dedup();
        if counts.len() < 2 || counts[0] == 0 {
            return Err("write two or more different numbers from 1 on, such as 2,4,8, or `none`".to_owned());
        }
        Ok(Counts(counts))
    }
}

/// The suite of extreme cases.
#[derive(Debug, Args)]
pub struct Stress {
    /// Only the cases that take so little that every build can do them
    #[arg(long)]
    pub quick: bool,
    /// Only the cases with this word in their name or group
    #[arg(long, value_name = "WORD")]
    pub only: Option<String>,
    /// Form of what is printed
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Folder for the tables stress.csv and stress.md; made where it is missing
    #[arg(long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
}

/// A list of the cranes.
#[derive(Debug, Args)]
pub struct List {
    /// Form of what is printed
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// Form of evaluated matrices.
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
    /// ∂T/∂q, and which body and coordinate each belongs to
    TransformDerivatives,
    /// ∂²T/∂q∂q, and which body and coordinates each belongs to
    TransformSecondDerivatives,
    /// Positions of the points of interest, m
    Points,
    /// Velocities of the points of interest, m/s
    PointVelocities,
    /// Mass matrix A; kg, kg m, kg m²
    MassMatrix,
    /// Velocity and gravity forces e, N and N m
    Bias,
    /// Generalized forces of everything but inertia and gravity, N and N m
    Forces,
    /// Accelerations q̈, m/s² and rad/s²
    Accelerations,
    /// Slope of the potential energy at t = 0, N and N m
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
    /// Coordinates, m and rad: numbers separated by commas or blanks, or a file of them; those of several states one after
    /// the other [default: the crane's guess]
    #[arg(long, value_name = "NUMBERS|FILE", allow_hyphen_values = true)]
    pub q: Option<String>,
    /// Their rates, m/s and rad/s, likewise, of each state or of all [default: 0]
    #[arg(long, value_name = "NUMBERS|FILE", allow_hyphen_values = true)]
    pub v: Option<String>,
    /// Time of the drives' motions, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    pub time: f64,
    /// Form of the result
    #[arg(long, value_enum, default_value_t)]
    pub format: EvalFormat,
    /// File to write; without it, standard output
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}
