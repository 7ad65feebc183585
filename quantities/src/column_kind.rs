//! What the columns of results show, and how their names are made.

/// What a column of results shows. Its name is that of a part, followed by one of the [endings](ColumnKind::endings).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColumnKind {
    /// Time; its part is `t`.
    Time,
    /// A coordinate.
    Position,
    /// Its rate.
    Rate,
    /// Its acceleration.
    Acceleration,
    /// Where the drive of a coordinate is.
    Prescribed,
    /// The rate of that motion.
    PrescribedRate,
    /// The torque or force of a drive.
    DriveEffort,
    /// Length of a cylinder.
    CylinderLength,
    /// Its speed.
    CylinderSpeed,
    /// Its force.
    CylinderForce,
    /// Pressure on the side of its piston.
    PistonPressure,
    /// Pressure on the side of its rod.
    RodPressure,
    /// Flow of oil into a cylinder, or of the pump.
    Flow,
    /// Power of the pump; its part is `pump`.
    Power,
    /// Pressure of the pump.
    PumpPressure,
    /// Opening of a cylinder's valve.
    Valve,
    /// Where a point of interest is.
    PointPosition,
    /// Its velocity.
    PointVelocity,
    /// Force of a support along x and y.
    LateralReaction,
    /// Force of a support along z.
    VerticalReaction,
    /// Height of a foot above the ground.
    Gap,
    /// How far a foot has slid.
    Slid,
    /// Moment of a spring of a beam.
    ElementMoment,
    /// Torque or force of an end stop.
    StopEffort,
    /// Torque or force of friction in a joint.
    FrictionEffort,
    /// Deflection of the bristles of a joint that sticks.
    Bristle,
    /// The strain of a connector.
    Strain(Strain),
    /// Its rate.
    StrainRate(Strain),
    /// Force or torque of a connector, a coupling or a pad.
    ConnectorEffort,
    /// Torque of friction in a pin that closes a loop.
    PinFriction,
    /// A force that a joint that closes a loop transmits.
    LoopForce,
    /// A moment that it transmits, or the torque of a rigid coupling.
    LoopMoment,
    /// A part of the energy; its part is `kinetic` and so on.
    Energy,
    /// Work that went into the crane; its part is `drive`, `load` or `event`.
    Work,
    /// Energy that has left it; its part is `dissipated`.
    Dissipated,
    /// Error of the balance of energy; its part is `energy`.
    Balance,
    /// When an event on a condition happened; 0 before.
    EventTime,
    /// Rate of a state of a force: of a pressure, a spool, bristles.
    StateRate,
    /// Sign of a foot's contact.
    FootIndicator,
    /// Sign of a stop's contact.
    StopIndicator,
    /// Sign of a rope's tension.
    RopeIndicator,
    /// Sign of the condition of an event.
    EventIndicator,
    /// Stabilising and overturning moments about the line between two feet, whose names are its part.
    TippingMoment,
    /// Anything else.
    Other,
}

/// What the strain of a connector is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Strain {
    /// The length of the line through its points.
    Length,
    /// The difference of two coupled coordinates.
    Slip,
    /// Where the axis of a beam passes a pad.
    Offset,
    /// The angle of a pin.
    Angle,
    /// How deep a point is below the ground.
    Depth,
}

impl Strain {
    /// The word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Strain::Length => "length",
            Strain::Slip => "slip",
            Strain::Offset => "offset",
            Strain::Angle => "angle",
            Strain::Depth => "depth",
        }
    }
}

/// How the size of a column is measured, relative to which its error is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// The largest absolute value.
    Peak,
    /// The range from the minimum to the maximum.
    Range,
}

const AXES: [&str; 3] = ["_x", "_y", "_z"];

impl ColumnKind {
    /// What is known of every cylinder, in order.
    pub const OF_CYLINDER: [Self; 6] = [
        ColumnKind::CylinderLength,
        ColumnKind::CylinderSpeed,
        ColumnKind::CylinderForce,
        ColumnKind::PistonPressure,
        ColumnKind::RodPressure,
        ColumnKind::Flow,
    ];

    /// What follows the name of the part, one ending per column; `turns`: whether the part is a rotation. For loop joints, all that there can be.
    #[must_use]
    pub const fn endings(self, turns: bool) -> &'static [&'static str] {
        match self {
            ColumnKind::Time | ColumnKind::Position | ColumnKind::Other => &[""],
            ColumnKind::Rate | ColumnKind::StateRate => &["_rate"],
            ColumnKind::Acceleration => &["_acceleration"],
            ColumnKind::Prescribed => &["_prescribed"],
            ColumnKind::PrescribedRate => &["_prescribed_rate"],
            ColumnKind::DriveEffort if turns => &["_drive_torque"],
            ColumnKind::DriveEffort => &["_drive_force"],
            ColumnKind::CylinderSpeed => &["_speed"],
            ColumnKind::PistonPressure => &["_piston_pressure"],
            ColumnKind::RodPressure => &["_rod_pressure"],
            ColumnKind::Flow => &["_flow"],
            ColumnKind::Power => &["_power"],
            ColumnKind::PumpPressure => &["_pressure"],
            ColumnKind::Valve => &["_valve"],
            ColumnKind::PointPosition => &AXES,
            ColumnKind::PointVelocity => &["_vx", "_vy", "_vz"],
            ColumnKind::LateralReaction => &["_reaction_x", "_reaction_y"],
            ColumnKind::VerticalReaction => &["_reaction_z"],
            ColumnKind::Gap => &["_gap"],
            ColumnKind::Slid => &["_slid_x", "_slid_y"],
            ColumnKind::ElementMoment => &["_moment"],
            ColumnKind::StopEffort if turns => &["_stop_torque"],
            ColumnKind::StopEffort => &["_stop_force"],
            ColumnKind::FrictionEffort if turns => &["_friction_torque"],
            ColumnKind::FrictionEffort => &["_friction_force"],
            ColumnKind::Bristle => &["_bristle"],
            ColumnKind::CylinderLength | ColumnKind::Strain(Strain::Length) => &["_length"],
            ColumnKind::Strain(Strain::Slip) => &["_slip"],
            ColumnKind::Strain(Strain::Offset) => &["_offset"],
            ColumnKind::Strain(Strain::Angle) => &["_angle"],
            ColumnKind::Strain(Strain::Depth) => &["_depth"],
            ColumnKind::StrainRate(Strain::Length) => &["_length_rate"],
            ColumnKind::StrainRate(Strain::Slip) => &["_slip_rate"],
            ColumnKind::StrainRate(Strain::Offset) => &["_offset_rate"],
            ColumnKind::StrainRate(Strain::Angle) => &["_angle_rate"],
            ColumnKind::StrainRate(Strain::Depth) => &["_depth_rate"],
            ColumnKind::ConnectorEffort if turns => &["_torque"],
            ColumnKind::CylinderForce | ColumnKind::ConnectorEffort => &["_force"],
            ColumnKind::PinFriction => &["_friction_torque"],
            ColumnKind::LoopForce => &["_force", "_force_x", "_force_y", "_force_z", "_force_u", "_force_w"],
            ColumnKind::LoopMoment => &["_torque", "_moment_x", "_moment_y", "_moment_z", "_moment_u", "_moment_w"],
            ColumnKind::Energy | ColumnKind::Dissipated => &["_energy"],
            ColumnKind::Work => &["_work"],
            ColumnKind::Balance => &["_balance"],
            ColumnKind::EventTime => &["_time"],
            ColumnKind::FootIndicator => &["_contact_indicator"],
            ColumnKind::StopIndicator => &["_stop_indicator"],
            ColumnKind::RopeIndicator => &["_tension_indicator"],
            ColumnKind::EventIndicator => &["_event_indicator"],
            ColumnKind::TippingMoment => &["_stabilising", "_overturning"],
        }
    }

    /// The ending along a direction of a loop joint: `x`, `y`, `z`, `u`, `w`, or none, as of rods and couplings.
    #[must_use]
    pub fn ending_along(self, direction: &str) -> &'static str {
        let along = |ending: &&&'static str| ending.rsplit('_').next() == Some(direction);
        let endings = self.endings(false);
        endings.iter().find(along).or(endings.first()).copied().unwrap_or_default()
    }

    /// Its unit in SI; `turns` as for its endings.
    #[must_use]
    pub const fn unit(self, turns: bool) -> &'static str {
        match self {
            ColumnKind::Time | ColumnKind::EventTime => "s",
            ColumnKind::Position | ColumnKind::Prescribed | ColumnKind::Bristle | ColumnKind::Strain(_) if turns => {
                "rad"
            }
            ColumnKind::Rate | ColumnKind::PrescribedRate | ColumnKind::StrainRate(_) if turns => "rad/s",
            ColumnKind::Acceleration if turns => "rad/s2",
            ColumnKind::Acceleration => "m/s2",
            ColumnKind::Position
            | ColumnKind::Prescribed
            | ColumnKind::Bristle
            | ColumnKind::CylinderLength
            | ColumnKind::PointPosition
            | ColumnKind::Gap
            | ColumnKind::Slid
            | ColumnKind::Strain(_) => "m",
            ColumnKind::Rate
            | ColumnKind::PrescribedRate
            | ColumnKind::CylinderSpeed
            | ColumnKind::PointVelocity
            | ColumnKind::StrainRate(_) => "m/s",
            ColumnKind::DriveEffort
            | ColumnKind::ElementMoment
            | ColumnKind::StopEffort
            | ColumnKind::FrictionEffort
            | ColumnKind::ConnectorEffort
                if turns =>
            {
                "N m"
            }
            ColumnKind::PinFriction | ColumnKind::LoopMoment | ColumnKind::TippingMoment => "N m",
            ColumnKind::DriveEffort
            | ColumnKind::ElementMoment
            | ColumnKind::StopEffort
            | ColumnKind::FrictionEffort
            | ColumnKind::ConnectorEffort
            | ColumnKind::CylinderForce
            | ColumnKind::LateralReaction
            | ColumnKind::VerticalReaction
            | ColumnKind::LoopForce => "N",
            ColumnKind::PistonPressure | ColumnKind::RodPressure | ColumnKind::PumpPressure => "Pa",
            ColumnKind::Flow => "m³/s",
            ColumnKind::Power => "W",
            ColumnKind::Energy | ColumnKind::Work | ColumnKind::Dissipated | ColumnKind::Balance => "J",
            ColumnKind::Valve => "1",
            ColumnKind::StateRate
            | ColumnKind::FootIndicator
            | ColumnKind::StopIndicator
            | ColumnKind::RopeIndicator
            | ColumnKind::EventIndicator
            | ColumnKind::Other => "",
        }
    }

    /// Its name in data that pages read.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            ColumnKind::Time => "time",
            ColumnKind::Position => "position",
            ColumnKind::Rate => "rate",
            ColumnKind::Acceleration => "acceleration",
            ColumnKind::Prescribed => "prescribed",
            ColumnKind::PrescribedRate => "prescribed_rate",
            ColumnKind::DriveEffort => "drive_effort",
            ColumnKind::CylinderLength => "cylinder_length",
            ColumnKind::CylinderSpeed => "cylinder_speed",
            ColumnKind::CylinderForce => "cylinder_force",
            ColumnKind::PistonPressure => "piston_pressure",
            ColumnKind::RodPressure => "rod_pressure",
            ColumnKind::Flow => "flow",
            ColumnKind::Power => "power",
            ColumnKind::PumpPressure => "pump_pressure",
            ColumnKind::Valve => "valve",
            ColumnKind::PointPosition => "point_position",
            ColumnKind::PointVelocity => "point_velocity",
            ColumnKind::LateralReaction => "lateral_reaction",
            ColumnKind::VerticalReaction => "vertical_reaction",
            ColumnKind::Gap => "gap",
            ColumnKind::Slid => "slid",
            ColumnKind::ElementMoment => "element_moment",
            ColumnKind::StopEffort => "stop_effort",
            ColumnKind::FrictionEffort => "friction_effort",
            ColumnKind::Bristle => "bristle",
            ColumnKind::Strain(_) => "strain",
            ColumnKind::StrainRate(_) => "strain_rate",
            ColumnKind::ConnectorEffort => "connector_effort",
            ColumnKind::PinFriction => "pin_friction",
            ColumnKind::LoopForce => "loop_force",
            ColumnKind::LoopMoment => "loop_moment",
            ColumnKind::Energy => "energy",
            ColumnKind::Work => "work",
            ColumnKind::Dissipated => "dissipated",
            ColumnKind::Balance => "balance",
            ColumnKind::EventTime => "event_time",
            ColumnKind::StateRate => "state_rate",
            ColumnKind::FootIndicator => "foot_indicator",
            ColumnKind::StopIndicator => "stop_indicator",
            ColumnKind::RopeIndicator => "rope_indicator",
            ColumnKind::EventIndicator => "event_indicator",
            ColumnKind::TippingMoment => "tipping_moment",
            ColumnKind::Other => "other",
        }
    }

    /// The measure of its size, if it is one of the most important columns of a run: a headline.
    #[must_use]
    pub const fn headline(self) -> Option<Size> {
        match self {
            ColumnKind::DriveEffort
            | ColumnKind::VerticalReaction
            | ColumnKind::PistonPressure
            | ColumnKind::RodPressure
            | ColumnKind::PumpPressure
            | ColumnKind::ConnectorEffort
            | ColumnKind::PinFriction
            | ColumnKind::LoopForce
            | ColumnKind::LoopMoment => Some(Size::Peak),
            ColumnKind::PointPosition => Some(Size::Range),
            _ => None,
        }
    }

    /// Whether it may be a state of a force, whose rate units for co-simulation have, too.
    #[must_use]
    pub const fn is_state(self) -> bool {
        matches!(
            self,
            ColumnKind::PistonPressure
                | ColumnKind::RodPressure
                | ColumnKind::PumpPressure
                | ColumnKind::Valve
                | ColumnKind::Slid
                | ColumnKind::Bristle
        )
    }

    /// Whether its extremes are kept of every run of an ensemble.
    #[must_use]
    pub const fn has_peaks(self) -> bool {
        self.headline().is_some()
            || matches!(
                self,
                ColumnKind::LateralReaction
                    | ColumnKind::Gap
                    | ColumnKind::CylinderLength
                    | ColumnKind::CylinderSpeed
                    | ColumnKind::CylinderForce
                    | ColumnKind::Flow
                    | ColumnKind::Power
                    | ColumnKind::StopEffort
            )
    }
}

/// What follows the name of a column with peaks, for each of them.
pub const PEAKS: [&str; 4] = ["_min", "_min_time", "_max", "_max_time"];

/// What follows the name of a column with the last place of a point.
pub const END: &str = "_end";
