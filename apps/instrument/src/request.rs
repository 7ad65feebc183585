//! What the page may ask.

use serde_derive::Deserialize;

/// A request.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
pub enum Request {
    /// Reads a spec, and makes its crane the crane of the page unless it has mistakes.
    Open {
        /// Name of the file, for messages.
        name: String,
        /// Its text.
        text: String,
    },
    /// Reads a number that was typed, with its unit.
    Number {
        /// What was typed.
        text: String,
        /// The unit of what it is for, SI.
        unit: String,
        /// Name of what it is for.
        of: String,
    },
    /// The crane at rest.
    Rest {
        /// Live parameters in the order of the crane; empty: those of its spec.
        #[serde(default)]
        parameters: Vec<f64>,
        /// Positions of the drives in their order, m and rad; empty: where their motions begin.
        #[serde(default)]
        positions: Vec<f64>,
    },
    /// The modes of the crane as it rested last: they take longer than statics, whose numbers need not wait for them.
    Modes,
    /// The run of the spec.
    Run {
        /// Live parameters.
        #[serde(default)]
        parameters: Vec<f64>,
        /// Simulated time, s, unless that of the spec.
        duration: Option<f64>,
    },
    /// The largest load over the positions of two drives.
    Chart {
        /// Live parameters.
        #[serde(default)]
        parameters: Vec<f64>,
        /// Positions of the drives that are not varied; empty: where their motions begin.
        #[serde(default)]
        positions: Vec<f64>,
        /// Name of the parameter that is the load; the only one in kg if there is none.
        load: Option<String>,
        /// Point whose radius and height are shown; that of the load if there is none.
        point: Option<String>,
        /// What is varied, one or two drives.
        ranges: Vec<Range>,
    },
    /// Begins to drive the crane.
    Drive {
        /// Live parameters.
        #[serde(default)]
        parameters: Vec<f64>,
        /// Positions of the drives.
        #[serde(default)]
        positions: Vec<f64>,
    },
    /// Drives on.
    Advance {
        /// Up to this time, s.
        to: f64,
        /// Positions of the levers, from −1 to 1.
        levers: Vec<f64>,
        /// Error per step that is accepted, m and rad.
        tolerance: f64,
    },
    /// Times one function: the mean over some calls.
    Repeat {
        /// Number of calls of the acceleration at rest.
        calls: u32,
    },
}

/// Positions of a drive.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// Index of the drive.
    pub drive: usize,
    /// First position, m or rad.
    pub from: f64,
    /// Last position.
    pub to: f64,
    /// How many.
    pub count: usize,
}
