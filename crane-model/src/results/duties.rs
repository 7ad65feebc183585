//! What drives, cylinders and the pump must be able to do over a run.

use crane_quantities::{ColumnKind, PUMP, Strain};

use super::{Extremes, Table, column_name, connector_force, cylinders::columns, drive_effort};
use crate::hydraulics::pressures;
use crate::{CoordinateInfo, CoordinateKind, CylinderInfo, Description};

/// What a drive or a winch does over a run, at its joint or its rope.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveDuty {
    /// Name of the driven coordinate, or of the winch's rope.
    pub name: String,
    /// Whether it turns a joint or moves one along, as a winch does its rope.
    pub kind: CoordinateKind,
    /// Index of the cylinder that does it.
    pub cylinder: Option<usize>,
    /// Largest torque or force, N m or N.
    pub effort: f64,
    /// Its root mean square over the run, `√(∫ M² dt / T)`.
    pub rms: f64,
    /// Fastest rate, rad/s or m/s.
    pub rate: f64,
    /// Largest power `M ω` that it gives, W.
    pub power: f64,
    /// Largest power that it takes in as a brake, W.
    pub braking_power: f64,
    /// Work that it gives, J: the integral of the power where it is positive.
    pub work: f64,
    /// Work that it takes in as a brake, J.
    pub braking_work: f64,
}

/// What a cylinder does over a run.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderDuty {
    /// Its name.
    pub name: String,
    /// Largest force with which it pushes, N.
    pub push: f64,
    /// Largest force with which it pulls, N.
    pub pull: f64,
    /// Highest pressure on either side, Pa.
    pub pressure: f64,
    /// Fastest speed, m/s.
    pub speed: f64,
    /// Largest flow into either side, m³/s.
    pub flow: f64,
    /// Least and greatest distance between its pins, m.
    pub lengths: [f64; 2],
    /// Its force, N, and the lower one of its pressures, Pa, at each result.
    loads: Vec<[f64; 2]>,
    /// Fastest speeds at which it extends and retracts, m/s.
    speeds: [f64; 2],
}

impl CylinderDuty {
    /// The highest pressure on either side of a cylinder with other areas of piston and ring, m², that exerts the same forces, Pa: the side with the lower
    /// pressure keeps it.
    pub fn pressure_with(&self, areas: [f64; 2]) -> f64 {
        self.loads.iter().flat_map(|&[force, back]| pressures(areas, back, force)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The largest flow into either side of a cylinder with other areas of piston and ring, m², at the same speeds, m³/s.
    pub fn flow_with(&self, [piston, ring]: [f64; 2]) -> f64 {
        let [extends, retracts] = self.speeds;
        (piston * extends).max(ring * retracts)
    }
}

/// What the pump does over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PumpDuty {
    /// Largest flow, m³/s.
    pub flow: f64,
    /// Highest pressure at which it delivers, Pa.
    pub pressure: f64,
    /// Largest power, W.
    pub power: f64,
    /// Energy, J.
    pub energy: f64,
}

/// What all do over a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Duties {
    /// Drives, then winches that move.
    pub drives: Vec<DriveDuty>,
    /// Cylinders.
    pub cylinders: Vec<CylinderDuty>,
    /// The pump of a crane with cylinders.
    pub pump: Option<PumpDuty>,
}

impl Duties {
    /// Those of a run, from its results; integrals by the trapezoidal rule.
    pub fn new(description: &Description, table: &Table) -> Self {
        let drives = description.drives.iter().enumerate().filter_map(|(index, drive)| {
            let CoordinateInfo { name, kind, .. } = &description.coordinates[drive.coordinate];
            let rate = column(table, &column_name(ColumnKind::Rate, name, kind.turns()))?;
            let cylinder = description.cylinders.iter().position(|cylinder| cylinder.drive == index);
            DriveDuty::new(table, name, *kind, cylinder, &column(table, &drive_effort(name, *kind))?, &rate)
        });
        let winches = description.connectors.iter().filter(|rope| rope.is_rope && rope.pieces > 0).filter_map(|rope| {
            let grows = column(table, &column_name(ColumnKind::StrainRate(Strain::Length), &rope.name, false))?;
            let shrinks: Vec<f64> = grows.iter().map(|rate| -rate).collect();
            let force = column(table, &connector_force(rope))?;
            DriveDuty::new(table, &rope.name, CoordinateKind::Translation, None, &force, &shrinks)
        });
        let of_cylinder = |info: &CylinderInfo| {
            let columns = columns(&info.name);
            let [length, speed, force, piston, rod, flow] =
                columns.each_ref().map(|name| Extremes::of_column(table, name));
            let [_, _, forces, pistons, rods, _] = columns.map(|name| column(table, &name).unwrap_or_default());
            let lower = pistons.iter().zip(&rods).map(|(piston, rod)| piston.min(*rod));
            CylinderDuty {
                name: info.name.to_string(),
                push: force.maximum.max(0.0),
                pull: (-force.minimum).max(0.0),
                pressure: piston.maximum.max(rod.maximum),
                speed: speed.size(),
                flow: flow.size(),
                lengths: [length.minimum, length.maximum],
                loads: forces.iter().zip(lower).map(|(force, back)| [*force, back]).collect(),
                speeds: [speed.maximum.max(0.0), (-speed.minimum).max(0.0)],
            }
        };
        Self {
            drives: drives.chain(winches).collect(),
            cylinders: description.cylinders.iter().map(of_cylinder).collect(),
            pump: PumpDuty::new(table),
        }
    }
}

impl DriveDuty {
    fn new(
        table: &Table,
        name: &str,
        kind: CoordinateKind,
        cylinder: Option<usize>,
        effort: &[f64],
        rate: &[f64],
    ) -> Option<Self> {
        let [first, last] = [table.rows.first()?[0], table.rows.last()?[0]];
        let power = |sign: f64| effort.iter().zip(rate).map(|(f, v)| (sign * f * v).max(0.0)).collect::<Vec<f64>>();
        let [gives, brakes] = [1.0, -1.0].map(power);
        let squares: Vec<f64> = effort.iter().map(|effort| effort * effort).collect();
        let rms = if last > first { (integral(table, &squares) / (last - first)).sqrt() } else { largest(effort) };
        Some(Self {
            name: name.to_owned(),
            kind,
            cylinder,
            effort: largest(effort),
            rms,
            rate: largest(rate),
            power: largest(&gives),
            braking_power: largest(&brakes),
            work: integral(table, &gives),
            braking_work: integral(table, &brakes),
        })
    }
}

impl PumpDuty {
    fn new(table: &Table) -> Option<Self> {
        let [flow, power] =
            [ColumnKind::Flow, ColumnKind::Power].map(|kind| column(table, &column_name(kind, PUMP, false)));
        let (flow, power) = (flow?, power?);
        // Of an idle pump there is none.
        let pressures = flow.iter().zip(&power).filter(|(flow, _)| **flow > 0.0).map(|(flow, power)| power / flow);
        Some(Self {
            flow: largest(&flow),
            pressure: pressures.fold(0.0, f64::max),
            power: largest(&power),
            energy: integral(table, &power),
        })
    }
}

/// The values of a column; `None` if there is none of that name.
fn column(table: &Table, name: &str) -> Option<Vec<f64>> {
    table.values(name).map(Iterator::collect)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}

/// The integral of numbers over the times of a table, by the trapezoidal rule.
fn integral(table: &Table, values: &[f64]) -> f64 {
    let pairs = table.rows.windows(2).zip(values.windows(2));
    pairs.map(|(rows, values)| 0.5 * (values[0] + values[1]) * (rows[1][0] - rows[0][0])).sum()
}
