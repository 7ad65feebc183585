//! Analyses of one crane: strength, load charts, vibrations, stability, and quantities at given states.

use std::{num::NonZeroUsize, path::PathBuf, sync::LazyLock};

use clap::{
    Args, ValueEnum, ValueHint,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};
use crane_codegen::spec::HoistingClass;
use crane_live::FunctionId;

use super::{
    crane::{Analysis, Choice},
    number::{above_zero, angle, count, duration, finite_number, margin, seconds, two_durations},
    poses::{Combined, Held, Poses},
    run::{Folder, Timing},
};

/// Loads and stability against tipping.
#[derive(Debug, Args)]
pub struct Strength {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub poses: Poses,
    #[command(flatten)]
    pub combined: Combined,
    #[command(flatten)]
    pub timing: Timing,
    /// Also evaluate the manoeuvre: smallest tipping margin, extremes of all loads and their times
    #[arg(long, conflicts_with_all = ["ranges", "combinations"])]
    pub run: bool,
    /// Also find the factor of weight and all loads at which the crane buckles, by its stiffness at rest and by following its pose
    #[arg(long, conflicts_with_all = ["ranges", "combinations"])]
    pub buckling: bool,
    /// Live parameter to use as the load: find the values at which the first foot lifts and the crane tips [default: the only
    /// parameter in kg]
    #[arg(long, value_name = "PARAMETER", conflicts_with = "combinations")]
    pub load: Option<String>,
    /// CSV file for the moments about the tipping lines and all loads during the run, or for the table of `--range`
    #[arg(short = 'o', long = "file", value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "combinations")]
    pub results: Option<PathBuf>,
}

/// Fatigue of beams by manoeuvres that repeat.
#[derive(Debug, Args)]
pub struct Fatigue {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub timing: Timing,
    /// How often the manoeuvre is repeated
    #[arg(long, value_name = "NUMBER", value_parser = above_zero)]
    pub cycles: f64,
    /// Another manoeuvre of the same crane and how often it is repeated, as in `empty.yaml=20000`: a spec that `extends` that of the crane; may
    /// be given several times
    #[arg(long, value_name = "SPEC=NUMBER")]
    pub also: Vec<String>,
    /// Detail category: range of nominal stress that a part endures 2e6 times, as in `71MPa` for all beams and `outer=80MPa` for one; may be
    /// given several times
    #[arg(long = "category", value_name = "[BEAM=]STRESS", required = true)]
    pub categories: Vec<String>,
    /// Slope m of the curve of strength
    #[arg(long, value_name = "NUMBER", default_value_t = 3.0, value_parser = above_zero)]
    pub slope: f64,
    /// Partial factor of the strength: the categories are divided by it
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0, value_parser = above_zero)]
    pub safety_factor: f64,
    /// CSV file for the stresses at the point of each place that suffers most
    #[arg(short = 'o', long = "file", value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "also")]
    pub results: Option<PathBuf>,
}

/// What drives must be able to do, and parts that can.
#[derive(Debug, Args)]
pub struct Drives {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub timing: Timing,
    /// List of parts to choose from: a CSV file with a column `part`, and with `torque` for motors, `force` for linear drives and winches, `bore`
    /// for cylinders or `flow` for pumps, as in `part,torque [N m],speed [rpm]`; may be given several times
    #[arg(long = "parts", value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub parts: Vec<PathBuf>,
}

/// Dynamic factors of a manoeuvre.
#[derive(Debug, Args)]
pub struct Factors {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub timing: Timing,
    /// Hoisting class of EN 1991-3, whose factor φ₂ is printed beside those that are computed
    #[arg(long, value_parser = hoisting_class(), ignore_case = true, value_name = "CLASS", requires = "hoisting_speed")]
    pub hoisting_class: Option<HoistingClass>,
    /// Steady speed of hoisting of that class, m/s
    #[arg(long, value_name = "NUMBER", value_parser = above_zero, requires = "hoisting_class")]
    pub hoisting_speed: Option<f64>,
    /// Print the table of tabulated factors to compare with, and where they come from
    #[arg(long)]
    pub tabulated: bool,
}

/// Reads the name of a hoisting class.
fn hoisting_class() -> impl TypedValueParser<Value = HoistingClass> {
    let find = |name: String| HoistingClass::ALL.into_iter().find(|class| class.name().eq_ignore_ascii_case(&name));
    PossibleValuesParser::new(HoistingClass::ALL.map(HoistingClass::name))
        .try_map(move |name| find(name).ok_or("not a hoisting class"))
}

/// The load and its limits.
#[derive(Clone, Debug, Args)]
pub struct LoadLimits {
    /// Live parameter that is the load [default: the only parameter in kg]
    #[arg(long, value_name = "PARAMETER")]
    pub load: Option<String>,
    /// Upper limit of the search for the load, in the unit of its parameter [default: a hundred times the crane's mass]
    #[arg(long, value_name = "NUMBER", value_parser = above_zero)]
    pub greatest_load: Option<f64>,
    /// Minimum tipping margin, 1 − overturning / stabilising moment about each tipping line
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0, value_parser = margin)]
    pub tipping: f64,
    /// Maximum utilisation of beams with a yield stress
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0, value_parser = above_zero)]
    pub utilisation: f64,
    /// Maximum torque or force of a drive, in either direction, N m or N, as in `boom_psi=80000`; may be given several times
    #[arg(long = "effort", value_name = "DRIVE=NUMBER")]
    pub efforts: Vec<String>,
    /// Maximum displacement of a point of interest by the load, m, as in `hook=0.1`; may be given several times
    #[arg(long = "deflection", value_name = "POINT=METRES")]
    pub deflections: Vec<String>,
    /// Leave out limits that are considered otherwise, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIMITS")]
    pub without: Vec<Considered>,
    /// Also limit the load to that with which every support carries something
    #[arg(long)]
    pub lift_off: bool,
    /// Also limit the load to that with which all ropes are taut
    #[arg(long)]
    pub slack_ropes: bool,
    /// Multiply the load by this number before it is compared with the limits, as for a test load or a dynamic factor; the chart
    /// then has the loads without it
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0, value_parser = above_zero)]
    pub load_factor: f64,
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
    #[command(flatten)]
    pub limits: LoadLimits,
    /// Point whose radius and height are shown [default: the only one on what carries the load, otherwise the load's centre of mass]
    #[arg(long, value_name = "POINT")]
    pub point: Option<String>,
    /// Radii of the load chart, m, as in `4,6,8.5` [default: round ones]
    #[arg(long = "radius", value_name = "RADIUS", value_delimiter = ',', value_parser = above_zero)]
    pub radii: Vec<f64>,
    /// Chart to compare with, such as that of a manual: a CSV file with the columns `radius` and `load`, as in `radius [m],load [t]`, or with drives
    /// and parameters of the ranges in place of the radius, as in `boom_psi [deg],load [t]`
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub given: Option<PathBuf>,
    /// Give the load that all `combinations` of the spec allow, and name the one that governs
    #[arg(long, conflicts_with = "combination")]
    pub combinations: bool,
    /// Threads [default: all of the machine]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub threads: Option<NonZeroUsize>,
    /// Start again instead of continuing where the same command was interrupted
    #[arg(long)]
    pub restart: bool,
    #[command(flatten)]
    pub folder: Folder,
}

/// Limits that an envelope considers unless they are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Considered {
    /// Tipping margin
    Tipping,
    /// Utilisation of beams
    Utilisation,
    /// Relief valves of cylinders
    Pressure,
    /// Pressure of the pump
    Pump,
    /// Strokes of cylinders
    Stroke,
    /// End stops of driven joints
    Stops,
    /// Maximum efforts of drives in the spec
    MaxEffort,
    /// Friction under all feet
    Sliding,
    /// Pressure on the ground
    Ground,
    /// Tension of ropes
    Tension,
    /// Overlap of telescope stages
    Overlap,
}

impl Considered {
    /// Its name, as in the options and in the limits.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

/// Small vibrations.
#[derive(Debug, Args)]
pub struct Modes {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub poses: Poses,
    /// Number of lowest modes to print [default: 10; with `--range` 3]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub count: Option<NonZeroUsize>,
    /// CSV file for the table of `--range`
    #[arg(short = 'o', long, value_name = "FILE.csv", value_hint = ValueHint::FilePath, requires = "ranges")]
    pub file: Option<PathBuf>,
    /// Write pose, mass, stiffness and damping matrices, eigenvalues and mode shapes to a file, `.json` or `.npz`
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "ranges")]
    pub matrices: Option<PathBuf>,
}

/// Small motions about a pose or a motion.
#[derive(Debug, Args)]
pub struct Linearise {
    #[command(flatten)]
    pub analysis: Analysis,
    /// Time at which to evaluate drives, loads and winches, s; driven coordinates take their prescribed rates at that time [default: 0,
    /// or that of the last row with --from]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub time: Option<f64>,
    /// Hold a coordinate at a position or at a rate, in m, rad, m/s or rad/s or as an angle, as in `boom_psi=30deg` and
    /// `column_psi_rate=0.2`; the others take the pose in which they stay; may be given several times
    #[arg(long = "hold", value_name = "NAME=VALUE", allow_hyphen_values = true, conflicts_with = "from")]
    pub held: Vec<String>,
    /// Linearise about the motion in a row of a CSV file of results, the last or that at --time, instead of a steady motion
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
    /// Inputs of the state space, separated by commas: those of the spec, and of every drive the position and rate of its motion, its torque
    /// or force, its valve [default: all that act]
    #[arg(long = "on", value_delimiter = ',', value_name = "NAMES")]
    pub acting: Option<Vec<String>>,
    /// Outputs of the state space, separated by commas: columns of a run [default: coordinates, rates, points]
    #[arg(long = "measure", value_delimiter = ',', value_name = "NAMES")]
    pub measured: Option<Vec<String>>,
    /// Also write motion, matrices, eigenvalues and shapes to an archive for `numpy.load`
    #[arg(short = 'o', long, value_name = "FILE.npz", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

/// Margins of a loop around a crane.
#[derive(Debug, Args)]
pub struct Margins {
    #[command(flatten)]
    pub analysis: Analysis,
    #[command(flatten)]
    pub held: Held,
    /// Compute one row per value of a drive's position or of a live parameter: from, to and how many, as in `boom_psi=0:60deg:13`;
    /// may be given several times
    #[arg(long = "range", value_name = "NAME=FROM:TO:COUNT", allow_hyphen_values = true, help_heading = "Pose")]
    pub ranges: Vec<String>,
    /// What the loop acts on: the motion of a drive by its coordinate, `boom_psi`, its rate, `boom_psi_rate`, a torque or force on it,
    /// `boom_psi_drive_torque`, its valve, `boom_cylinder_valve`, or an input of the spec
    #[arg(long, value_name = "NAME")]
    pub on: String,
    /// What the loop measures: a column of a run [default: the coordinate of the drive on which it acts]
    #[arg(long, value_name = "NAME")]
    pub measure: Option<String>,
    #[command(flatten)]
    pub controller: Controller,
    /// Phase margin that poses should have: others are counted
    #[arg(long, value_name = "ANGLE", default_value = "45deg", value_parser = angle)]
    pub least: f64,
    /// Threads [default: all of the machine]
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub threads: Option<NonZeroUsize>,
    /// File for the table, CSV, or for a map of the phase margin over two ranges, SVG
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

/// The controller with its dead time and its lag.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Controller")]
pub struct Controller {
    /// Proportional gain, in units of what the loop acts on per unit of what it measures
    #[arg(long, value_name = "GAIN", default_value_t = 0.0, value_parser = finite_number)]
    pub p: f64,
    /// Integral gain, the same per s
    #[arg(long, value_name = "GAIN", default_value_t = 0.0, value_parser = finite_number)]
    pub i: f64,
    /// Derivative gain, the same times s
    #[arg(long, value_name = "GAIN", default_value_t = 0.0, value_parser = finite_number)]
    pub d: f64,
    /// Time constant of a filter of the derivative, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = duration)]
    pub filter: f64,
    /// Time constants of numerator and denominator of a lead, s, as in `0.3,0.03`
    #[arg(long, value_name = "SECONDS,SECONDS", value_parser = two_durations)]
    pub lead: Option<[f64; 2]>,
    /// Dead time, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = duration)]
    pub delay: f64,
    /// Time constant of a first-order lag, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = duration)]
    pub lag: f64,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// One of the table of quantities.
    Of(FunctionId),
    /// Accelerations, with closed loops.
    Accelerations,
    /// Energies of all kinds of force that the crane has.
    Energies,
    /// Efforts of the drives.
    DriveEfforts,
}

impl Quantity {
    /// Its name in results and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Of(id) => id.name(),
            Quantity::Accelerations => "accelerations",
            Quantity::Energies => "energies",
            Quantity::DriveEfforts => "drive_efforts",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Quantity::Of(id) => id.doc().trim_end_matches('.'),
            Quantity::Accelerations => "Accelerations q̈, m/s² and rad/s²",
            Quantity::Energies => {
                "Energies: kinetic, of gravity, supports, elements and drives, then of end stops and connectors if the crane has them; J"
            }
            Quantity::DriveEfforts => "Efforts of the drives, N and N m",
        }
    }
}

impl ValueEnum for Quantity {
    fn value_variants<'a>() -> &'a [Self] {
        /// Those of a state that the Python package offers; accelerations of the open chain are of no use.
        static ALL: LazyLock<Vec<Quantity>> = LazyLock::new(|| {
            let is_offered = |id: &FunctionId| id.python().is_some() || *id == FunctionId::TransformSecondDerivatives;
            let of_table = FunctionId::ALL.iter().filter(|id| is_offered(id) && **id != FunctionId::ForwardDynamics);
            let others = [Quantity::Accelerations, Quantity::Energies, Quantity::DriveEfforts];
            of_table.map(|id| Quantity::Of(*id)).chain(others).collect()
        });
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()).help(self.about()))
    }
}

/// What `crane eval` computes unless told otherwise.
const DEFAULT: [Quantity; 4] = [
    Quantity::Of(FunctionId::Transforms),
    Quantity::Of(FunctionId::TransformDerivatives),
    Quantity::Of(FunctionId::MassMatrix),
    Quantity::Of(FunctionId::Bias),
];

/// Quantities at one state or at many.
#[derive(Debug, Args)]
pub struct Eval {
    #[command(flatten)]
    pub crane: Choice,
    /// What to compute, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', value_name = "NAMES",
          default_values_t = DEFAULT)]
    pub quantities: Vec<Quantity>,
    /// Coordinates in m and rad: numbers separated by commas or blanks, or a file of them; several states follow one another
    /// [default: the spec's guess]
    #[arg(long, value_name = "NUMBERS|FILE", allow_hyphen_values = true)]
    pub q: Option<String>,
    /// Velocities in m/s and rad/s, given in the same way, per state or once for all states [default: 0]
    #[arg(long, value_name = "NUMBERS|FILE", allow_hyphen_values = true)]
    pub v: Option<String>,
    /// Time at which the drive motions are evaluated, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = seconds)]
    pub time: f64,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    pub format: EvalFormat,
    /// File to write [default: standard output]
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

#[cfg(test)]
mod tests {
    use crane_model::envelope::PartLimit;

    use super::{Considered, ValueEnum};

    /// What charts consider unless it is left out, and what options ask for, are all limits of the parts of a crane.
    #[test]
    fn every_limit_has_an_option() {
        let without: Vec<String> = Considered::value_variants().iter().map(|considered| considered.name()).collect();
        for name in PartLimit::DEFAULT.map(PartLimit::name).into_iter().chain(["tipping", "utilisation"]) {
            assert!(without.iter().any(|known| known == name), "`--without {name}` is refused");
        }
        assert_eq!(without.len(), PartLimit::DEFAULT.len() + 2, "{without:?}");
        let asked_for = [PartLimit::LiftOff, PartLimit::SlackRopes];
        let is_somewhere = |kind: &PartLimit| PartLimit::DEFAULT.contains(kind) != asked_for.contains(kind);
        assert!(PartLimit::ALL.iter().all(is_somewhere));
    }

    /// A limit that governs a largest load is one of those of its JSON; one of efforts is called `effort` there.
    #[test]
    fn every_limit_is_in_the_schema() {
        let schema = include_str!("../../schemas/sensitivity.json");
        for kind in PartLimit::ALL.into_iter().filter(|kind| *kind != PartLimit::MaxEffort) {
            assert!(schema.contains(&format!("\"{}\"", kind.name())), "{}", kind.name());
        }
    }
}
