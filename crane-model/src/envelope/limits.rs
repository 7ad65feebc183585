//! Limits of the load.

use crate::{Description, dyn_crane::DynCrane};

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
    /// Limits whose numbers the crane's own parts have.
    pub of_parts: Vec<PartLimit>,
}

/// A kind of limit whose numbers the crane's own parts have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartLimit {
    /// The pressure at which relief valves open: `max_pressure` of each cylinder.
    Pressure,
    /// The pressure of the pump, which a cylinder needs to move against its load.
    Pump,
    /// The shortest and the longest length of each cylinder.
    Stroke,
    /// End stops of driven joints.
    Stops,
    /// The maximum efforts of drives, `max_effort`.
    MaxEffort,
    /// The friction of all feet together: a crane slides if none of them sticks.
    Sliding,
    /// Supports that carry nothing.
    LiftOff,
    /// The largest pressure that the ground bears under each support, `max_pressure` of its plate.
    Ground,
    /// Ropes without tension.
    SlackRopes,
    /// The largest tension of each rope, `max_tension`.
    Tension,
    /// Stages of telescopes that have left their outer beams, or are pushed in too far.
    Overlap,
}

impl PartLimit {
    /// Every kind.
    pub const ALL: [Self; 11] = [
        Self::Pressure,
        Self::Pump,
        Self::Stroke,
        Self::Stops,
        Self::MaxEffort,
        Self::Sliding,
        Self::LiftOff,
        Self::Ground,
        Self::SlackRopes,
        Self::Tension,
        Self::Overlap,
    ];
    /// What no crane can exceed. A foot may lift and a rope may be slack in normal work.
    pub const DEFAULT: [Self; 9] = [
        Self::Pressure,
        Self::Pump,
        Self::Stroke,
        Self::Stops,
        Self::MaxEffort,
        Self::Sliding,
        Self::Ground,
        Self::Tension,
        Self::Overlap,
    ];

    /// Its name in options.
    pub fn name(self) -> &'static str {
        match self {
            PartLimit::Pressure => "pressure",
            PartLimit::Pump => "pump",
            PartLimit::Stroke => "stroke",
            PartLimit::Stops => "stops",
            PartLimit::MaxEffort => "max-effort",
            PartLimit::Sliding => "sliding",
            PartLimit::LiftOff => "lift-off",
            PartLimit::Ground => "ground",
            PartLimit::SlackRopes => "slack-ropes",
            PartLimit::Tension => "tension",
            PartLimit::Overlap => "overlap",
        }
    }

    /// The kind with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

impl Limits {
    /// No limits, for a crane of this description.
    pub fn none(description: &Description) -> Self {
        Self {
            tipping: None,
            utilisation: None,
            efforts: vec![f64::INFINITY; description.drives.len()],
            deflections: vec![f64::INFINITY; description.points.len()],
            of_parts: Vec::new(),
        }
    }

    /// Those that a chart has unless others are asked for: no foot beyond tipping, the allowable stress, and what no crane can exceed.
    pub fn usual(description: &Description) -> Self {
        Self {
            tipping: Some(0.0),
            utilisation: Some(1.0),
            of_parts: PartLimit::DEFAULT.to_vec(),
            ..Self::none(description)
        }
    }

    /// Whether a kind is among the limits.
    pub fn has(&self, kind: PartLimit) -> bool {
        self.of_parts.contains(&kind)
    }

    /// With the maximum efforts of the crane's own drives, if they are among the limits.
    #[must_use]
    pub fn with_max_efforts(&self, crane: &dyn DynCrane) -> Self {
        /// Fraction of its maximum effort at which a drive gives way: the rest is the end of the rounded corner of its law.
        const GIVES_WAY: f64 = 0.999;
        let mut limits = self.clone();
        if self.has(PartLimit::MaxEffort) {
            for (limit, drive_limit) in limits.efforts.iter_mut().zip(crane.drive_limits_at()) {
                *limit = limit.min(drive_limit.map_or(f64::INFINITY, |drive_limit| GIVES_WAY * drive_limit));
            }
        }
        limits
    }

    /// The number that a limit compares with, in SI units; `None` if it is not among the limits, or has no number. Limits of efforts are those of
    /// [`with_max_efforts`](Self::with_max_efforts).
    ///
    /// | limit | its number is compared with |
    /// |---|---|
    /// | tipping | the least margin |
    /// | utilisation, deflection | the greatest |
    /// | effort | the greatest, in either direction |
    /// | pressure, pump | `max_pressure`, the pressure of the pump |
    /// | stroke | the length of the cylinder at that end |
    /// | sliding | 1: all of the friction |
    /// | tension | `max_tension` |
    /// | ground | the vertical force with which the plate has its `max_pressure` |
    /// | stops, lift-off, slack ropes, overlap | 0 |
    pub fn bound(&self, limit: Limit, description: &Description) -> Option<f64> {
        let number = match limit {
            Limit::Equilibrium => None,
            Limit::Tipping { .. } => self.tipping,
            Limit::Utilisation { .. } => self.utilisation,
            Limit::Effort { drive } => self.efforts.get(drive).copied(),
            Limit::Deflection { point } => self.deflections.get(point).copied(),
            Limit::Pressure { cylinder, .. } => description.cylinders[cylinder].max_pressure,
            Limit::Pump { .. } => description.pump.and_then(|pump| pump.pressure),
            Limit::Stroke { cylinder, extended } => {
                let info = &description.cylinders[cylinder];
                Some(if extended { info.retracted + info.stroke } else { info.retracted })
            }
            Limit::Sliding { .. } => Some(1.0),
            Limit::Ground { foot } => description.supports[foot].max_force(),
            Limit::Tension { rope } => description.connectors[rope].max_tension,
            Limit::Stop { .. } | Limit::LiftOff { .. } | Limit::Slack { .. } | Limit::Overlap { .. } => Some(0.0),
        };
        number.filter(|number| number.is_finite() && limit.part().is_none_or(|part| self.has(part)))
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
    /// The relief valve of a cylinder.
    Pressure {
        /// Index of the cylinder.
        cylinder: usize,
        /// Whether it is on the side of the rod, not on that of the piston.
        rod: bool,
    },
    /// The pressure of the pump at a cylinder.
    Pump {
        /// Index of the cylinder.
        cylinder: usize,
        /// Whether it is on the side of the rod, not on that of the piston.
        rod: bool,
    },
    /// The stroke of a cylinder.
    Stroke {
        /// Index of the cylinder.
        cylinder: usize,
        /// Which end of it: fully extended, or fully retracted.
        extended: bool,
    },
    /// The end stop of a driven coordinate.
    Stop {
        /// Index of the coordinate.
        coordinate: usize,
    },
    /// The friction under all feet: the last of them begins to slide.
    Sliding {
        /// Index of the support that sticks longest.
        foot: usize,
    },
    /// A support that carries nothing.
    LiftOff {
        /// Index of the support.
        foot: usize,
    },
    /// The pressure on the ground under a support.
    Ground {
        /// Index of the support.
        foot: usize,
    },
    /// A rope without tension.
    Slack {
        /// Index of the connector.
        rope: usize,
    },
    /// The largest tension of a rope.
    Tension {
        /// Index of the connector.
        rope: usize,
    },
    /// A stage of a telescope that has left its outer beam.
    Overlap {
        /// Index of the first body of the stage.
        body: usize,
        /// Whether it is pushed in too far, not drawn out.
        pushed: bool,
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
            Limit::Pressure { .. }
            | Limit::Pump { .. }
            | Limit::Stroke { .. }
            | Limit::Stop { .. }
            | Limit::Sliding { .. }
            | Limit::LiftOff { .. }
            | Limit::Ground { .. }
            | Limit::Slack { .. }
            | Limit::Tension { .. }
            | Limit::Overlap { .. } => self.part().map_or("", PartLimit::name),
        }
    }

    /// The kind of limit of the crane's own parts that it is; `None` for others, and for efforts, which may be limited by both.
    pub fn part(self) -> Option<PartLimit> {
        match self {
            Limit::Equilibrium
            | Limit::Tipping { .. }
            | Limit::Utilisation { .. }
            | Limit::Effort { .. }
            | Limit::Deflection { .. } => None,
            Limit::Pressure { .. } => Some(PartLimit::Pressure),
            Limit::Pump { .. } => Some(PartLimit::Pump),
            Limit::Stroke { .. } => Some(PartLimit::Stroke),
            Limit::Stop { .. } => Some(PartLimit::Stops),
            Limit::Sliding { .. } => Some(PartLimit::Sliding),
            Limit::LiftOff { .. } => Some(PartLimit::LiftOff),
            Limit::Ground { .. } => Some(PartLimit::Ground),
            Limit::Slack { .. } => Some(PartLimit::SlackRopes),
            Limit::Tension { .. } => Some(PartLimit::Tension),
            Limit::Overlap { .. } => Some(PartLimit::Overlap),
        }
    }

    /// The name of the part at which the limit is reached.
    pub fn location(self, crane: &dyn DynCrane) -> String {
        let description = crane.description();
        let side = |cylinder: usize, rod: bool| {
            format!("{}, side of its {}", description.cylinders[cylinder].name, if rod { "rod" } else { "piston" })
        };
        match self {
            Limit::Equilibrium => String::new(),
            Limit::Tipping { feet } => {
                let [from, to] = feet.map(|foot| description.supports[foot].name.as_str());
                format!("{from} – {to}")
            }
            Limit::Utilisation { section } => crane.section_location(section),
            Limit::Effort { drive } => description.coordinates[description.drives[drive].coordinate].name.to_string(),
            Limit::Deflection { point } => description.points[point].to_string(),
            Limit::Pressure { cylinder, rod } | Limit::Pump { cylinder, rod } => side(cylinder, rod),
            Limit::Stroke { cylinder, .. } => description.cylinders[cylinder].name.to_string(),
            Limit::Stop { coordinate } => description.coordinates[coordinate].name.to_string(),
            Limit::Sliding { foot } | Limit::LiftOff { foot } | Limit::Ground { foot } => {
                description.supports[foot].name.to_string()
            }
            Limit::Slack { rope } | Limit::Tension { rope } => description.connectors[rope].name.to_string(),
            Limit::Overlap { body, .. } => description.bodies[body].link.to_string(),
        }
    }

    /// Whether a crane near this limit may lose its equilibrium because of it.
    pub(super) fn ends_equilibrium(self) -> bool {
        matches!(self, Limit::Tipping { .. } | Limit::Effort { .. } | Limit::Sliding { .. } | Limit::LiftOff { .. })
    }
}
