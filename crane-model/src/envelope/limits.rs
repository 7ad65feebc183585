//! Limits of the load.

use crate::Description;

/// Limits that a load must not exceed.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Minimum tipping margin, `1 − overturning / stabilising` about each tipping line.
    pub tipping: Option<f64>,
    /// Maximum utilisation of the sections of beams that have a yield stress.
    pub utilisation: Option<f64>,
    /// Maximum torque or force of each drive, in either direction, N m or N; infinite where it is not limited.
    pub efforts: Vec<f64>,
    /// Maximum displacement of each point of interest from its position with the minimum load, m; infinite where it is not limited.
    pub deflections: Vec<f64>,
}

impl Limits {
    /// No limits, for a crane of this description.
    pub fn none(description: &Description) -> Self {
        Self {
            tipping: None,
            utilisation: None,
            efforts: vec![f64::INFINITY; description.drives.len()],
            deflections: vec![f64::INFINITY; description.points.len()],
        }
    }
}

/// A limit that governs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Beyond this load there is no stable equilibrium, or none was found.
    Equilibrium,
    /// The margin about the tipping line through two supports.
    Tipping {
        /// Indices of the supports.
        feet: [usize; 2],
    },
    /// The utilisation of a section of a beam.
    Utilisation {
        /// Index of the section among [`Description::sections`].
        section: usize,
    },
    /// The effort of a drive.
    Effort {
        /// Index of the drive.
        drive: usize,
    },
    /// The deflection of a point of interest.
    Deflection {
        /// Index of the point.
        point: usize,
    },
}

impl Limit {
    /// Its kind in one word, for programs and for the colours of a chart.
    pub fn kind(self) -> &'static str {
        match self {
            Limit::Equilibrium => "equilibrium",
            Limit::Tipping { .. } => "tipping",
            Limit::Utilisation { .. } => "utilisation",
            Limit::Effort { .. } => "effort",
            Limit::Deflection { .. } => "deflection",
        }
    }

    /// The name of the part at which the limit is reached.
    pub fn place(self, description: &Description) -> String {
        match self {
            Limit::Equilibrium => String::new(),
            Limit::Tipping { feet } => {
                let [from, to] = feet.map(|foot| description.supports[foot].name.as_str());
                format!("{from} – {to}")
            }
            Limit::Utilisation { section } => {
                let section = &description.sections[section];
                let body = description.bodies[section.body].name.as_str();
                if section.at.is_empty() { body.to_owned() } else { format!("{body} {}", section.place()) }
            }
            Limit::Effort { drive } => description.coordinates[description.drives[drive].coordinate].name.to_string(),
            Limit::Deflection { point } => description.points[point].to_string(),
        }
    }
}
