//! The crane of a command, and commands that describe, create or generate one.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use clap::{Args, ValueEnum, ValueHint};

use crane_model::results::cautions::BEND;
use crane_page::tables::Report;

use super::number::above_zero;
use crate::{problem::Outcome, screen::Console};

/// Output format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    #[default]
    Table,
    /// For programs.
    Json,
    /// For documents: a section of a page.
    Html,
}

impl Format {
    /// Prints a report in this form.
    ///
    /// # Errors
    /// The output is closed.
    pub fn print(self, report: &Report, console: &Console, out: &mut dyn Write) -> Outcome<()> {
        console.note(report);
        match self {
            Format::Table => Ok(console.print(report, out)?),
            Format::Json => Ok(writeln!(out, "{:#}", report.json())?),
            Format::Html => Ok(write!(out, "{}", report.html())?),
        }
    }
}

/// Specs to check.
#[derive(Debug, Args)]
pub struct Check {
    /// Shipped cranes, YAML files, or `-` for the standard input
    #[arg(required = true, value_name = "CRANE", value_hint = ValueHint::FilePath)]
    pub specs: Vec<String>,
    /// Treat warnings as mistakes
    #[arg(long)]
    pub strict: bool,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// A crane with its live parameters.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Shipped crane, YAML file, or `-` for the standard input; `crane list` shows the shipped cranes
    #[arg(default_value = DEFAULT_CRANE, value_name = "CRANE")]
    pub name: String,
    /// Treat warnings about the YAML file as mistakes
    #[arg(long)]
    pub strict: bool,
    /// Values of its live parameters.
    #[command(flatten)]
    pub parameters: Parameters,
    /// Value of an input instead of that of the spec, in the unit that `crane info` shows; may be given several times
    #[arg(long = "input", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub inputs: Vec<String>,
    /// Limits of the validity of the model.
    #[command(flatten)]
    pub limits: Limits,
    /// Replace beams that bend with rigid ones
    #[arg(long, conflicts_with = "compile")]
    pub rigid: bool,
    /// Compute with the partial factors of one of the `combinations` of the spec
    #[arg(long, value_name = "NAME", conflicts_with = "compile")]
    pub combination: Option<String>,
    /// Compile the crane with rustc first (needs cargo) and keep it: up to 1.6 times as fast, for long studies
    #[arg(long)]
    pub compile: bool,
}

impl Choice {
    /// The YAML file, if one is given instead of a shipped crane.
    pub fn file(&self) -> Option<&Path> {
        spec_file(&self.name)
    }
}

/// The crane of a command that names none.
pub const DEFAULT_CRANE: &str = "eight_link_flexible";

/// Name of the standard input, in place of a file.
pub const STANDARD_INPUT: &str = "-";

/// The YAML file, or the standard input, that is given in place of a crane's name.
pub fn spec_file(name: &str) -> Option<&Path> {
    let path = Path::new(name);
    let yaml = path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml");
    (yaml || name == STANDARD_INPUT).then_some(path)
}

/// Values of live parameters.
#[derive(Clone, Debug, Args)]
pub struct Parameters {
    /// Set a live parameter, in the unit that `crane info` shows, angles also as `30deg`; may be given several times
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub settings: Vec<String>,
}

/// Limits within which the model is valid.
#[derive(Clone, Copy, Debug, Args)]
pub struct Limits {
    /// Bending or torsion of one beam section beyond which a caution is printed, degrees
    #[arg(long = "bend-limit", value_name = "DEGREES", default_value_t = BEND, value_parser = above_zero)]
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
    /// Print all tables in full: the pose, all modes, all sections
    #[arg(long)]
    pub all: bool,
}

/// A crane in words.
#[derive(Debug, Args)]
pub struct Explain {
    /// Shipped crane, YAML file, or `-` for the standard input
    #[arg(value_name = "CRANE", value_hint = ValueHint::FilePath)]
    pub spec: String,
    /// Also draw the chain into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub svg: Option<PathBuf>,
    /// Also count the operations of every generated function
    #[arg(long)]
    pub operations: bool,
}

/// A spec to start from.
#[derive(Debug, Args)]
pub struct Example {
    /// Shipped crane [default: list them]
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
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

/// A list of the cranes.
#[derive(Debug, Args)]
pub struct List {
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
