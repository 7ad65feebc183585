//! Hydraulic cylinders of driven joints: their columns in results, and cautions about them.

use crane_quantities::{ColumnKind, DisplayUnit, PUMP};

use super::{Extremes, Table, column_name};
use crate::{
    CoordinateRole, CylinderInfo, Description, DriveInfo, Text,
    dyn_crane::{DynCrane, Functions, drive_stiffness},
    hydraulics::{CylinderState, cylinders_at},
};

/// Flow from which a cylinder's pressure counts in full for the pump, m³/s: 0.6 l/min, about what a mobile valve meters at least.
const LEAST_FLOW: f64 = 1e-5;
/// A drive stiffer than the oil of its cylinder by this factor or more is no longer a model of it.
const STIFFER: f64 = 2.0;

/// Flow that the pump delivers to all cylinders, m³/s, and its power, W: one pump at the maximum of the pressures that they demand.
///
/// A cylinder demands the flow of its prescribed motion: the spring of its drive stands for its oil, which yields without the pump. So one that
/// is held demands nothing while it vibrates. Its pressure counts in full from [`LEAST_FLOW`] on and below in proportion, as that of a valve that
/// opens, so that the power is continuous in the speeds.
fn pump<'c>(cylinders: impl Iterator<Item = &'c Demand> + Clone) -> [f64; 2] {
    let flow: f64 = cylinders.clone().map(|demand| demand.flow).sum();
    let pressure = cylinders.map(|demand| demand.pressure * (demand.flow / LEAST_FLOW).min(1.0)).fold(0.0, f64::max);
    [flow, flow * pressure]
}

/// What a cylinder demands of the pump.
struct Demand {
    /// m³/s
    flow: f64,
    /// Pressure on the side that it enters, Pa.
    pressure: f64,
}

/// The flow and the power of the pump, for each crane of a fleet; `rates`: of the motions of the drives, m/s and rad/s.
pub(super) fn pumps(
    crane: &dyn Functions,
    q: &[f64],
    cylinders: &[CylinderState],
    rates: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let description = crane.description();
    let cranes = with_cylinders(description);
    if cranes == 0 {
        return Vec::new();
    }
    let stiffness = drive_stiffness(crane, q);
    let demand = |(info, state): (&CylinderInfo, &CylinderState)| {
        let is_rigid =
            description.coordinates[description.drives[info.drive].coordinate].role == CoordinateRole::Prescribed;
        // A drive without a spring has no motion to follow: its cylinder takes what it needs.
        let follows = is_rigid || stiffness[info.drive] > 0.0;
        let speed = if follows { state.arm * rates(info.drive) } else { state.speed };
        let side = usize::from(speed <= 0.0);
        Demand { flow: info.areas[side] * speed.abs(), pressure: state.pressures[side] }
    };
    let demands: Vec<Demand> = description.cylinders.iter().zip(cylinders).map(demand).collect();
    (0..cranes).flat_map(|crane| pump(demands.iter().skip(crane).step_by(cranes))).collect()
}

/// The number of cranes that have cylinders: in a fleet, those of all cranes have the same names.
fn with_cylinders(description: &Description) -> usize {
    let cylinders = &description.cylinders;
    cylinders.first().map_or(0, |first| cylinders.iter().filter(|cylinder| cylinder.name == first.name).count())
}

/// The first cylinder of a run whose linkage cannot be assembled, and when, s.
pub(crate) fn unassembled(description: &Description, table: &Table) -> Option<(Text, f64)> {
    description.cylinders.iter().find_map(|info| {
        let [length, ..] = columns(&info.name);
        let row = table.values(&length)?.position(f64::is_nan)?;
        Some((info.name.clone(), table.rows[row][0]))
    })
}

/// Names of the columns of a cylinder.
pub(super) fn columns(name: &str) -> [String; 6] {
    ColumnKind::OF_CYLINDER.map(|kind| column_name(kind, name, false))
}

/// Name of the column with the opening of a cylinder's valve, −1 to 1.
pub(crate) fn spool(cylinder: &str) -> String {
    column_name(ColumnKind::Valve, cylinder, false)
}

/// Values of the columns of a cylinder.
pub(super) fn values(state: &CylinderState) -> [f64; 6] {
    let [piston, rod] = state.pressures;
    [state.length, state.speed, state.force, piston, rod, state.flow]
}

/// Cylinders that cannot reach a pose at rest or hold it.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    let description = crane.description();
    if description.cylinders.is_empty() {
        return Vec::new();
    }
    let rest = vec![0.0; q.len()];
    let stiffness = drive_stiffness(crane, q);
    let states = cylinders_at(crane, q, &rest, &crane.drive_efforts_at_rest(q));
    let mut found = Vec::new();
    for (info, state) in description.cylinders.iter().zip(&states) {
        let still = |value| Extremes::at(0.0, value);
        found.extend(out_of_stroke(info, &still(state.length), false));
        let weak = over_pressure(info, state.pressures.map(still), false);
        found.extend(weak.or_else(|| beyond_pump(description, info, state)));
        let DriveInfo { coordinate, .. } = description.drives[info.drive];
        let (stiffness, coordinate) = (stiffness[info.drive], &description.coordinates[coordinate]);
        let oil = state.oil_stiffness(info).filter(|oil| info.valve.is_none() && stiffness > STIFFER * oil);
        found.extend(oil.map(|oil| {
            format!(
                "the drive of {} is {:.1} times as stiff as the oil in {}, {oil:.3e} {}/{}: the real crane vibrates more slowly and \
                 deflects more; use the stiffness of the oil as the drive's `stiffness`",
                coordinate.name,
                stiffness / oil,
                info.name,
                coordinate.kind.force_unit(),
                coordinate.kind.unit()
            )
        }));
    }
    found
}

/// Cylinders that cannot follow a run, and when.
pub(super) fn of_run(description: &Description, table: &Table) -> Vec<String> {
    let mut found = Vec::new();
    for info in &description.cylinders {
        let [length, _, _, piston, rod, _] = columns(&info.name).map(|column| Extremes::of_column(table, &column));
        found.extend(out_of_stroke(info, &length, true));
        found.extend(over_pressure(info, [piston, rod], true));
    }
    if description.has_valves() {
        found.extend(short_of_oil(description, table));
        found.extend(description.cylinders.iter().filter_map(|info| falls_behind(description, info, table)));
        found.extend(description.cylinders.iter().filter_map(|info| below_vacuum(info, table)));
        return found;
    }
    let Extremes { maximum: flow, time_of_maximum: time, .. } =
        Extremes::of_column(table, &column_name(ColumnKind::Flow, PUMP, false));
    let limit = description.pump.map(|pump| pump.max_flow).filter(|limit| flow > *limit);
    found.extend(limit.map(|limit| {
        format!(
            "the cylinders take up to {:.1} l/min, at {time:.2} s; the pump delivers {:.1} l/min",
            DisplayUnit::LitrePerMinute.shown(flow),
            DisplayUnit::LitrePerMinute.shown(limit)
        )
    }));
    found
}

/// When and for how long the pump delivers its maximum flow.
fn short_of_oil(description: &Description, table: &Table) -> Option<String> {
    /// Fraction of the maximum flow from which it counts as maximum.
    const ALL: f64 = 0.999;
    let limit = description.pump?.max_flow;
    let rows: Vec<f64> = table.values(&column_name(ColumnKind::Flow, PUMP, false))?.collect();
    let first = rows.iter().position(|flow| *flow >= ALL * limit)?;
    let time = table.time_of(rows.iter().filter(|flow| **flow >= ALL * limit).count());
    Some(format!(
        "the pump is at its maximum flow, {:.1} l/min, for {time:.2} s, first at {:.2} s: cylinders lag behind their motions",
        DisplayUnit::LitrePerMinute.shown(limit),
        table.rows[first][0]
    ))
}

/// A cylinder whose servo does not follow its motion: how far behind the joint is, and for how long the valve is fully open.
fn falls_behind(description: &Description, info: &CylinderInfo, table: &Table) -> Option<String> {
    /// Fraction of its motion by which a joint may lag behind; usual servos with a feed-forward of the speed stay below it.
    const FOLLOWS: f64 = 0.05;
    /// Opening from which a valve counts as fully open.
    const OPEN: f64 = 0.999;
    info.valve.filter(|valve| !valve.commanded)?;
    let coordinate = &description.coordinates[description.drives[info.drive].coordinate];
    let wanted = column_name(ColumnKind::Prescribed, &coordinate.name, coordinate.kind.turns());
    let range = Extremes::of_column(table, &wanted);
    let travel = range.maximum - range.minimum;
    let behind =
        table.values(&wanted)?.zip(table.values(&coordinate.name)?).map(|(wanted, actual)| (wanted - actual).abs());
    let (most, row) = behind.zip(&table.rows).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let open = table.time_of(table.values(&spool(&info.name))?.filter(|opening| opening.abs() >= OPEN).count());
    let valve = if open > 0.0 {
        format!("its valve is fully open for {open:.2} s")
    } else {
        "its valve is never fully open".to_owned()
    };
    let share = if most > travel {
        "more than its whole travel".to_owned()
    } else {
        format!("{:.0} % of its travel", 100.0 * most / travel)
    };
    (travel > 0.0 && most > FOLLOWS * travel).then(|| {
        format!(
            "{} falls behind: {} is up to {most:.4} {} from its prescribed position, {share}, at {:.2} s; {valve}",
            info.name,
            coordinate.name,
            coordinate.kind.unit(),
            row[0]
        )
    })
}

/// A cylinder whose suction valves let in too little oil: pressures are relative to the atmosphere, so that none can be below −1 bar.
fn below_vacuum(info: &CylinderInfo, table: &Table) -> Option<String> {
    const VACUUM: f64 = -1e5;
    let [.., piston, rod, _] = columns(&info.name).map(|column| Extremes::of_column(table, &column));
    let sides = [("piston", piston), ("rod", rod)];
    let (side, least) = sides.into_iter().find(|(_, pressure)| pressure.minimum < VACUUM)?;
    Some(format!(
        "{} would need {:.2} bar on the side of its {side}, at {:.2} s, less than a vacuum: oil would cavitate there",
        info.name,
        DisplayUnit::Bar.shown(least.minimum),
        least.time_of_minimum
    ))
}

fn when(time: f64, moves: bool) -> String {
    if moves { format!(" at {time:.2} s") } else { String::new() }
}

fn out_of_stroke(info: &CylinderInfo, length: &Extremes, moves: bool) -> Option<String> {
    let (least, greatest) = (info.retracted, info.retracted + info.stroke);
    let name = &info.name;
    if !length.minimum.is_finite() {
        return Some(format!("{name} cannot be assembled: its rocker and link do not reach each other"));
    }
    let [length, time] = beyond_stroke(info, length)?;
    let when = when(time, moves);
    Some(format!("{name} is {length:.3} m long{when}: its stroke is from {least:.3} to {greatest:.3} m"))
}

/// The length of a cylinder furthest beyond an end of its stroke, m, and when it is, s; `None` if it is never beyond one.
pub fn beyond_stroke(info: &CylinderInfo, length: &Extremes) -> Option<[f64; 2]> {
    let (least, greatest) = (info.retracted, info.retracted + info.stroke);
    let (furthest, beyond) = if least - length.minimum > length.maximum - greatest {
        ([length.minimum, length.time_of_minimum], least - length.minimum)
    } else {
        ([length.maximum, length.time_of_maximum], length.maximum - greatest)
    };
    (beyond > 0.0).then_some(furthest)
}

/// The highest pressure in a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HighestPressure {
    /// The side: `piston` or `rod`.
    pub side: &'static str,
    /// Pa
    pub pressure: f64,
    /// When it is, s.
    pub time: f64,
}

impl HighestPressure {
    /// The higher one of both sides.
    fn new([piston, rod]: [Extremes; 2]) -> Self {
        let (side, Extremes { maximum, time_of_maximum, .. }) =
            if piston.maximum >= rod.maximum { ("piston", piston) } else { ("rod", rod) };
        Self { side, pressure: maximum, time: time_of_maximum }
    }

    /// The pressure at which the relief valve opens, Pa, if this is beyond it.
    pub fn relief(&self, info: &CylinderInfo) -> Option<f64> {
        info.max_pressure.filter(|limit| self.pressure > *limit)
    }
}

/// The highest pressure in a cylinder over a run.
pub fn highest_pressure(info: &CylinderInfo, table: &Table) -> HighestPressure {
    let [.., piston, rod, _] = columns(&info.name).map(|column| Extremes::of_column(table, &column));
    HighestPressure::new([piston, rod])
}

/// A cylinder that holds more than the pump can move.
fn beyond_pump(description: &Description, info: &CylinderInfo, state: &CylinderState) -> Option<String> {
    let pump = description.pump.and_then(|pump| pump.pressure)?;
    let highest = HighestPressure::new(state.pressures.map(|pressure| Extremes::at(0.0, pressure)));
    (highest.pressure > pump).then(|| {
        format!(
            "{} holds {:.0} bar on the side of its {}: the {:.0} bar of the pump do not move it against its load",
            info.name,
            DisplayUnit::Bar.shown(highest.pressure),
            highest.side,
            DisplayUnit::Bar.shown(pump)
        )
    })
}

fn over_pressure(info: &CylinderInfo, sides: [Extremes; 2], moves: bool) -> Option<String> {
    let highest = HighestPressure::new(sides);
    let limit = highest.relief(info)?;
    Some(format!(
        "{} needs {:.0} bar on the side of its {}{}: its relief valve opens at {:.0} bar",
        info.name,
        DisplayUnit::Bar.shown(highest.pressure),
        highest.side,
        when(highest.time, moves),
        DisplayUnit::Bar.shown(limit)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fast cylinder at 50 bar beside a slow one at 200 bar: 1 l/s times 50 bar, and up to 200 bar as the slow one begins to take oil.
    #[test]
    fn power_rises_with_the_flow_of_a_slow_cylinder() {
        let power = |flow: f64| {
            let demands = [Demand { flow: 1e-3, pressure: 5e6 }, Demand { flow, pressure: 2e7 }];
            let [total, power] = pump(demands.iter());
            assert!((total - 1e-3 - flow).abs() < 1e-18);
            power
        };
        // Rounding.
        for (flow, expected) in [(0.0, 5e3), (2e-6, 1.002e-3 * 5e6), (5e-6, 1.005e-3 * 1e7), (1e-5, 1.01e-3 * 2e7)] {
            assert!((power(flow) / expected - 1.0).abs() < 1e-12, "{flow}: {}", power(flow));
        }
        // No jump: 1e-9 m³/s change the pressure by no more than 2e3 Pa.
        for k in 0..20_000 {
            let flow = 1e-9 * f64::from(k);
            assert!((power(flow + 1e-9) - power(flow)).abs() < 1.1e-3 * 2e3 + 1e-9 * 2e7, "{flow}");
        }
    }
}
