//! Poses other than that at the beginning of the drives' motions.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::{
    analysis::LoadLimits,
    crane::Analysis,
    number::{part, seconds, tolerance},
};

/// Drives that hold a position.
#[derive(Debug, Args)]
#[command(next_help_heading = "Pose")]
pub struct Held {
    /// Hold a drive at a position in m, rad or as an angle instead of moving it, as in `boom_psi=30deg`; may be given several times
    #[arg(long = "hold", value_name = "DRIVE=VALUE", allow_hyphen_values = true)]
    pub held: Vec<String>,
}

/// Poses and parameters to compute one after the other.
#[derive(Debug, Args)]
#[command(next_help_heading = "Pose")]
pub struct Poses {
    #[command(flatten)]
    pub held: Held,
    /// Compute one row per value of a drive's position or of a live parameter: from, to and how many, as in `boom_psi=0:60deg:13`;
    /// may be given several times
    #[arg(long = "range", value_name = "NAME=FROM:TO:COUNT", allow_hyphen_values = true)]
    pub ranges: Vec<String>,
    /// Point whose radius, height and deflection are shown with `--range` [default: the only one on what carries the load, otherwise the
    /// load's centre of mass]
    #[arg(long, value_name = "POINT", requires = "ranges")]
    pub point: Option<String>,
}

/// Combinations of weights and loads.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "Pose")]
pub struct Combined {
    /// Compute all `combinations` of the spec, with their partial factors, side by side
    #[arg(long, conflicts_with_all = ["ranges", "combination"])]
    pub combinations: bool,
}

/// What changes with the numbers of a crane at rest.
#[derive(Debug, Args)]
pub struct Sensitivity {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub held: Held,
    /// What to show, separated by commas: outputs such as `hook_z` or `frequency_1`, or groups: points, deflections, drives, cylinders,
    /// connectors, loops, supports, stresses, tipping, frequencies, load [default: the most important ones, all with `--all`]
    #[arg(long = "of", value_delimiter = ',', value_name = "OUTPUTS")]
    pub outputs: Vec<String>,
    /// What to change, separated by commas: live parameters, or numbers of the spec by their places, as in
    /// `links.boom.beam.section.box.height` [default: all live parameters]
    #[arg(long = "with", value_delimiter = ',', value_name = "NUMBERS")]
    pub numbers: Vec<String>,
    /// Change of each number, relative to its value, as in `10%` or `-0.05`
    #[arg(long, value_name = "PART", default_value = "10%", allow_hyphen_values = true, value_parser = part)]
    pub change: f64,
    /// Number of lowest frequencies
    #[arg(long, value_name = "COUNT", default_value_t = 3)]
    pub modes: usize,
    /// Compute what moves the largest load within limits in this pose: a point of a load chart; other outputs are then those with this load
    #[arg(long)]
    pub largest_load: bool,
    #[command(flatten, next_help_heading = "Limits, with --largest-load")]
    pub limits: LoadLimits,
    /// Point whose radius and height are shown with `--largest-load` [default: the only one on what carries the load, otherwise the
    /// load's centre of mass]
    #[arg(long, value_name = "POINT", requires = "largest_load")]
    pub point: Option<String>,
    /// Compute what moves a run from rest: `--of` then names its columns, each with `.peak` (the largest magnitude), `.maximum`, `.minimum`,
    /// `.final` or `.integral` [default: peaks of the most important columns]
    #[arg(long, conflicts_with_all = ["largest_load", "held"])]
    pub run: bool,
    /// Simulated time with `--run`, s [default: from the spec]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "run")]
    pub duration: Option<f64>,
    /// Interval between results with `--run`, s: extremes are those among them [default: from the spec]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "run")]
    pub interval: Option<f64>,
    /// Error per step with `--run`, m and rad [default: 2e-5]
    #[arg(long, value_name = "NUMBER", value_parser = tolerance, requires = "run")]
    pub tolerance: Option<f64>,
    /// File for the changes, CSV with a row per number, or for the chart, SVG
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

/// The pose at rest.
#[derive(Debug, Args)]
pub struct Statics {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub poses: Poses,
    #[command(flatten)]
    pub combined: Combined,
    /// CSV file for the table of `--range`
    #[arg(short = 'o', long, value_name = "FILE.csv", value_hint = ValueHint::FilePath, requires = "ranges", conflicts_with = "combinations")]
    pub file: Option<PathBuf>,
}
