//! Files of other programs, and pictures.

use std::path::PathBuf;

use clap::{Args, ValueEnum, ValueHint};

use super::{crane::Choice, number::angle, poses::Held};

/// Language of other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Language {
    /// Kinematics and masses; springs, dampers and supports go to a second file.
    Urdf,
    /// With stiffness, damping and spring references of joints; linear supports are tendons.
    Mjcf,
    /// C99 for controllers: chosen functions, without a heap.
    C,
    /// A functional mock-up unit for co-simulation and model exchange: the whole crane, ready to run elsewhere.
    Fmu,
    /// What is drawn of the crane at rest, glTF 2.0: a node for each body, for Blender, viewers and pages; for a file `.glb` in one binary file.
    Gltf,
}

/// Version of the functional mock-up interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Fmi {
    /// That of most tools.
    #[default]
    #[value(name = "2.0")]
    Two,
    /// That of newer tools.
    #[value(name = "3.0")]
    Three,
}

impl Fmi {
    /// Its number.
    pub fn number(self) -> &'static str {
        match self {
            Fmi::Two => "2.0",
            Fmi::Three => "3.0",
        }
    }
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
    #[command(flatten, next_help_heading = "Pose, with --format gltf")]
    pub held: Held,
    /// Language to write
    #[arg(long, value_enum)]
    pub format: Language,
    /// File to write [default: the crane's name with .urdf, .xml, .c, .fmu or .gltf]
    #[arg(short = 'o', long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Functions to write in C, separated by commas, with `_vjp` or `_jvp` products with their derivatives; a wrong name lists all
    /// [default: `mass_matrix,bias,forward_dynamics`]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub functions: Option<Vec<String>>,
    /// Type of numbers in C [default: double]
    #[arg(long, value_enum)]
    pub precision: Option<CNumber>,
    /// Version of the interface of an FMU [default: 2.0]
    #[arg(long, value_enum, value_name = "VERSION")]
    pub fmi: Option<Fmi>,
    /// Shared library to put into an FMU, .so, .dll or .dylib; repeat the option to include several systems
    /// [default: the one next to the command]
    #[arg(long = "library", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub libraries: Vec<PathBuf>,
}

impl Export {
    /// The file to write.
    pub fn file(&self, crane: &str) -> PathBuf {
        let suffix = match self.format {
            Language::Urdf => "urdf",
            Language::Mjcf => "xml",
            Language::C => "c",
            Language::Fmu => "fmu",
            Language::Gltf => "gltf",
        };
        self.file.clone().unwrap_or_else(|| PathBuf::from(format!("{crane}.{suffix}")))
    }

    /// The functions to write in C.
    pub fn functions(&self) -> Vec<String> {
        self.functions.clone().unwrap_or_else(|| ["mass_matrix", "bias", "forward_dynamics"].map(str::to_owned).into())
    }

    /// Whether what is drawn of the crane is written, for which its pose must be known.
    pub fn is_scene(&self) -> bool {
        self.format == Language::Gltf && !self.crane.compile
    }

    /// The options that are for one language, whether they are given, and that language.
    pub fn of_one_language(&self) -> [(&'static str, bool, Language); 6] {
        [
            ("functions", self.functions.is_some(), Language::C),
            ("precision", self.precision.is_some(), Language::C),
            ("fmi", self.fmi.is_some(), Language::Fmu),
            ("library", !self.libraries.is_empty(), Language::Fmu),
            ("compile", self.crane.compile, Language::Fmu),
            ("hold", !self.held.held.is_empty(), Language::Gltf),
        ]
    }
}

/// A picture of a crane.
#[derive(Debug, Args)]
pub struct Picture {
    #[command(flatten)]
    pub crane: Choice,
    #[command(flatten)]
    pub held: Held,
    /// File to write [default: the crane's name with .png]
    #[arg(short = 'o', long, value_name = "FILE.png", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Width, picture elements
    #[arg(long, value_name = "COUNT", default_value_t = 1200)]
    pub width: i64,
    /// Height, picture elements
    #[arg(long, value_name = "COUNT", default_value_t = 800)]
    pub height: i64,
    /// Direction from which the crane is seen, about z from x on, as in `30deg` or in rad [default: the corner from which the report shows it]
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = angle)]
    pub azimuth: Option<f64>,
    /// Angle above the ground from which it is seen, likewise
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, value_parser = angle)]
    pub elevation: Option<f64>,
}

/// A spec from another program's file.
#[derive(Debug, Args)]
pub struct Import {
    /// URDF or MJCF file
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub robot: PathBuf,
    /// Spec to write [default: standard output]
    #[arg(short = 'o', long = "file", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,
    /// Joint to hold at zero, such as a gripper's, with those that follow it; repeatable
    #[arg(long = "fix", value_name = "JOINT")]
    pub fixed: Vec<String>,
    /// Replace inertias that no body can have by the nearest possible ones, and say which
    #[arg(long)]
    pub repair: bool,
    /// Replace a spec that exists
    #[arg(long)]
    pub force: bool,
}
