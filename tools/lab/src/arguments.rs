//! Arguments of the lab.

use std::{path::PathBuf, str::FromStr};

use clap::{Args, Parser, Subcommand, ValueHint};

use crane_cli::toolbox::{Analysis, Format, seconds};

const EXAMPLES: &str = "\
Examples:
  crane-lab work-precision             error against run time for methods, tolerances and numbers of sections
  crane-lab work-precision my.yaml --sections none
                                       only the methods, for your own crane
  crane-lab stress --quick             run the stiff and extreme test cranes

Exit codes:
  0  done
  1  a case that differs from what is expected, a file that cannot be used
  2  wrong arguments";

/// Measures and stress-tests the methods and models that the command `crane` uses.
#[derive(Debug, Parser)]
#[command(name = "crane-lab", version, after_help = EXAMPLES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub action: Action,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Action {
    /// Measure error against run time for every method and number of sections
    WorkPrecision(WorkPrecision),
    /// Run stiff and extreme test cranes and compare the results with what is expected
    Stress(Stress),
}

/// Error against run time.
#[derive(Debug, Args)]
pub struct WorkPrecision {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Numbers of sections per flexible link to compare, at least two; `none` compares only the methods
    #[arg(long, value_name = "COUNTS|none", default_value = "1,2,3,4,6,8,12,20,30")]
    pub sections: Counts,
    /// Simulated time, s [default: from the spec]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub duration: Option<f64>,
    /// Fewer steps and tolerances, each run once, without compiling: a quick trial
    #[arg(long)]
    pub quick: bool,
    /// Folder for tables (CSV) and figures (SVG); created if missing
    #[arg(long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// Also write a Markdown page, with its figures in the folder `images` next to it
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
            return Err("write two or more different numbers of 1 or more, such as 2,4,8, or `none`".to_owned());
        }
        Ok(Counts(counts))
    }
}

/// The suite of extreme cases.
#[derive(Debug, Args)]
pub struct Stress {
    /// Only the short cases
    #[arg(long)]
    pub quick: bool,
    /// Only cases whose name or group contains this word
    #[arg(long, value_name = "WORD")]
    pub only: Option<String>,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Folder for the tables stress.csv and stress.md; created if missing
    #[arg(long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
}
