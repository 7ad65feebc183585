//! Arguments of the command.

mod analysis;
mod crane;
mod exchange;
mod number;
mod poses;
mod run;

use std::{ffi::OsStr, path::PathBuf};

use clap::{
    Command, FromArgMatches, Parser, Subcommand, ValueEnum, ValueHint,
    error::{ContextKind, ContextValue},
};

use crate::screen::Manner;

pub use analysis::{
    Controller, Drives, Envelope, Eval, EvalFormat, Factors, Fatigue, Linearise, LoadLimits, Margins, Modes, Quantity,
    Stability, Strength,
};
pub use crane::{
    Analysis, Check, Choice, DEFAULT_CRANE, Example, Explain, Format, Generate, Limits, List, New, Parameters,
    STANDARD_INPUT, spec_file,
};
pub use exchange::{CNumber, Export, Fmi, Import, Language, Picture};
pub use number::seconds;
pub use poses::{Poses, Sensitivity, Statics};
pub use run::{Book, Compare, ComparePair, Ensemble, Page, Run, Simulate, Step, Timing};

/// Reads words as the arguments of a command.
///
/// # Errors
/// They are not such arguments.
pub fn read<A: FromArgMatches>(command: Command, words: &[impl AsRef<OsStr>]) -> Result<A, clap::Error> {
    let mut command = with_negative_numbers(command);
    let matches = command.try_get_matches_from_mut(words.iter().map(AsRef::as_ref)).map_err(with_negative_value)?;
    A::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
}

/// With options that all take negative numbers: what reads a number says which ones are allowed.
fn with_negative_numbers(command: Command) -> Command {
    let with = |arg: clap::Arg| {
        let is_option = arg.get_action().takes_values() && !arg.is_positional();
        if is_option { arg.allow_negative_numbers(true) } else { arg }
    };
    command.mut_args(with).mut_subcommands(with_negative_numbers)
}

/// Says how to write a negative value with a unit, which looks like an option.
fn with_negative_value(mut error: clap::Error) -> clap::Error {
    let is_value =
        |word: &str| word.strip_prefix('-').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    if matches!(error.get(ContextKind::InvalidArg), Some(ContextValue::String(word)) if is_value(word)) {
        let tip = "write a negative value with a unit behind `=`, as in `--at=-5deg`".into();
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}

const EXAMPLES: &str = "\
Examples:
  crane                                compare the eight-link crane with a rigid and with a flexible boom
  crane statics                        pose, drive torques, support reactions
  crane statics cantilever --format json
                                       the same for another crane, as JSON
  crane statics --hold boom_psi=40deg --range telescope_x=0:2:9
                                       deflection, pressures and reactions over reach, in one table
  crane example loader_crane > my.yaml a commented spec to start your own crane from
  crane simulate --set load_mass=0 --out empty
                                       the manoeuvre without the log
  crane simulate --method rk4 --step 1e-4
                                       the manoeuvre, integrated as in the paper
  crane simulate --ensemble loads.csv -o peaks.csv
                                       one run per row of a table of parameters
  crane report -o report.html          the crane in 3-D, plots and tables on one page
  crane book my.yaml --chart \"--range boom_psi=0:60deg:13\" -o book.html
                                       the crane, its spec and its results as one document to print
  crane strength --run                 tipping margin, stresses and joint loads, at rest and during the manoeuvre
  crane drives --parts motors.csv       what drives must be able to do, and which motors of a list can
  crane sensitivity --with load_mass,links.boom.beam.section.box.height
                                       what moves deflection, stresses, tipping and frequencies, and by how much
  crane envelope --range column_psi=0:360deg:25 --range boom_psi=0:70deg:15
                                       load chart and slew diagram: the largest load within limits, pose by pose
  crane compare my.yaml                your own crane, with beams that bend and with rigid ones
  crane modes                          frequencies and damping about the static pose
  crane linearise --time 2.5           matrices and modes about the motion in the middle of the manoeuvre
  crane margins --on boom_psi_rate --p 1.3 --delay 0.065 --range boom_psi=0:60deg:7
                                       stability margins of a position loop around the boom's drive
  crane stability                      largest stable steps and what limits them, with a figure
  crane check my.yaml; crane run my.yaml
                                       your own crane: find its mistakes, then compute everything
  crane explain my.yaml --svg my.svg   its bodies and coordinates, in words and as a picture
  crane new my-crane --from cantilever a Rust crate that compiles your own crane
  crane export my.yaml --format urdf -o my.urdf
                                       the crane for other programs, with its springs in my.springs.yaml
  crane picture my.yaml -o my.png      the crane in 3-D as a picture
  crane import robot.urdf -o my.yaml   convert a robot in URDF or MJCF to a spec
  crane list                           the shipped cranes
  crane info                           coordinates, parameters, drives of a crane
  source <(crane completions bash)     completion of commands, options, cranes and the names of their parts

Exit codes:
  0  done
  1  no stable equilibrium, a run that grew without bound, a file that cannot be used
  2  wrong arguments
  3  done, but something was noticed that --fail-on names";

/// Statics, motion and vibration of cranes described in YAML.
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
    /// What the command says besides results.
    #[command(flatten)]
    pub manner: Manner,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Action {
    /// Compute statics, motion, figures and the report, written to a folder
    Run(Run),
    /// Compare two cranes, or a crane with itself with rigid beams: statics, motion, figures and the report
    Compare(ComparePair),
    /// Find the static equilibrium: pose, drive torques, support reactions
    Statics(Statics),
    /// Compute tipping margin, stresses, loads on joints and ground, and the tipping load
    Strength(Strength),
    /// Compute cycles of stress, damage and life of beams by manoeuvres that repeat
    Fatigue(Fatigue),
    /// Compute what drives, cylinders and the pump must be able to do, and choose parts of lists that can
    Drives(Drives),
    /// Compute dynamic factors: what a manoeuvre makes of forces and stresses at rest along it
    Factors(Factors),
    /// Compute what moves deflections, forces, stresses, tipping and frequencies, and by how much
    Sensitivity(Sensitivity),
    /// Find the largest load within limits over ranges of poses: load chart, diagrams, data
    Envelope(Envelope),
    /// Simulate the motion from the static pose; write results and figures to a folder
    Simulate(Simulate),
    /// Compute frequencies, damping and dominant coordinates about the static pose
    Modes(Modes),
    /// Linearise about a pose or a motion: state space A, B, C, D, matrices of small motions, eigenvalues, mode shapes
    Linearise(Linearise),
    /// Compute stability margins of a control loop over ranges of poses: phase, gain, distance from instability, bandwidth, damping
    Margins(Margins),
    /// Write statics, motion and modes as one HTML page with the crane in 3-D
    Report(Page),
    /// Write a crane, its spec and its results as one document to print, with numbered sections
    Book(Book),
    /// Compute the largest stable step of every method and what limits it
    Stability(Stability),
    /// Show coordinates, bodies, supports, drives and parameters of a crane
    Info(Analysis),
    /// Draw a crane at rest as it is in the report's 3-D, into a picture (PNG)
    Picture(Picture),
    /// Evaluate quantities such as T, A and e at given states, for other programs
    Eval(Eval),
    /// Create a Rust crate for your own crane
    New(New),
    /// Check a spec: report every mistake and everything implausible
    Check(Check),
    /// Explain a spec: bodies, coordinates, what is left out; draw a picture
    Explain(Explain),
    /// Print the commented spec of a shipped crane, to start your own from
    Example(Example),
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
    /// Export a crane as URDF, MJCF, C, an FMU or glTF, for Pinocchio, MuJoCo, ROS, controllers, Simulink, Blender and others
    Export(Export),
    /// Convert a URDF or MJCF model to a spec
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
            Action::Run(options) => Some(&mut options.analysis.crane),
            Action::Simulate(options) => Some(&mut options.run.analysis.crane),
            Action::Statics(options) => Some(&mut options.analysis.crane),
            Action::Info(options) => Some(&mut options.crane),
            Action::Modes(options) => Some(&mut options.analysis.crane),
            Action::Linearise(options) => Some(&mut options.analysis.crane),
            Action::Margins(options) => Some(&mut options.analysis.crane),
            Action::Strength(options) => Some(&mut options.analysis.crane),
            Action::Fatigue(options) => Some(&mut options.analysis.crane),
            Action::Drives(options) => Some(&mut options.analysis.crane),
            Action::Factors(options) => Some(&mut options.analysis.crane),
            Action::Sensitivity(options) => Some(&mut options.analysis.crane),
            Action::Envelope(options) => Some(&mut options.analysis.crane),
            Action::Stability(options) => Some(&mut options.analysis.crane),
            Action::Report(options) => Some(&mut options.crane),
            Action::Book(options) => Some(&mut options.crane),
            Action::Picture(options) => Some(&mut options.crane),
            Action::Eval(options) => Some(&mut options.crane),
            Action::Export(options) if options.is_scene() => Some(&mut options.crane),
            Action::Compare(_)
            | Action::New(_)
            | Action::Check(_)
            | Action::Explain(_)
            | Action::Example(_)
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

impl Action {
    /// The drives that hold a position, and what is varied.
    pub fn poses(&self) -> Option<&Poses> {
        match self {
            Action::Statics(options) => Some(&options.poses),
            Action::Strength(options) => Some(&options.poses),
            Action::Modes(options) => Some(&options.poses),
            _ => None,
        }
    }

    /// The drives that hold a position, and ranges over which others do.
    pub fn held(&self) -> (&[String], &[String]) {
        match self {
            Action::Margins(options) => (&options.held.held, &options.ranges),
            Action::Sensitivity(options) => (&options.held.held, &[]),
            Action::Picture(options) => (&options.held.held, &[]),
            Action::Export(options) if options.is_scene() => (&options.held.held, &[]),
            _ => self.poses().map_or((&[], &[]), |poses| (&poses.held.held, &poses.ranges)),
        }
    }
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
    /// Margins of a control loop.
    Margins,
    /// Largest stable steps.
    Stability,
    /// A run.
    Simulate,
    /// `simulate --ensemble`: many runs.
    Ensemble,
    /// Tipping margins, stresses and loads.
    Strength,
    /// Damage and life of beams.
    Fatigue,
    /// What drives must be able to do.
    Drives,
    /// Dynamic factors.
    Factors,
    /// What moves the quantities of a crane at rest.
    Sensitivity,
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
    /// `statics`, `strength` or `modes` with `--range`: one row per pose.
    Poses,
}
