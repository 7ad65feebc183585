//! Poses other than that at the beginning of the drives' motions.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::crane::Analysis;

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
    /// Point whose radius and height are shown with `--range` [default: the only point of interest, otherwise the origin of the last
    /// link]
    #[arg(long, value_name = "POINT", requires = "ranges")]
    pub point: Option<String>,
}

/// The pose at rest.
#[derive(Debug, Args)]
pub struct Statics {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub poses: Poses,
    /// CSV file for the table of `--range`
    #[arg(short = 'o', long, value_name = "FILE.csv", value_hint = ValueHint::FilePath, requires = "ranges")]
    pub file: Option<PathBuf>,
}
