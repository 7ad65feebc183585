//! Inputs of linear models: those of the spec, and of each drive its motion, its effort and its valve.

use nalgebra::DVector;

use super::{NoModel, Output};
use crate::{
    ColumnKind, CoordinateInfo, CoordinateRole, Description, StateAt,
    dyn_crane::DynCrane,
    force_states::motion_at,
    hydraulics,
    modes::StateSpace,
    results::{Column, column_name, drive_effort, quantities_at, quantities_with},
};

/// What acts on a crane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// An input of the spec, by its index.
    Spec(usize),
    /// Position of the motion of a drive, by its index, while its rate stays: `<coordinate>_prescribed`, m or rad.
    Motion(usize),
    /// Rate of the motion of a drive, while its position stays: `<coordinate>_prescribed_rate`, m/s or rad/s.
    Rate(usize),
    /// Torque or force on the coordinate of a drive in addition to that of the drive: `<coordinate>_drive_torque` or `_drive_force`, N m or N.
    Effort(usize),
    /// Change of the command of the valve of a drive, −1 to 1: `<cylinder>_valve`.
    Valve(usize),
}

impl Input {
    /// Those of a crane: of the spec, then of the drives.
    pub fn all(description: &Description) -> Vec<Self> {
        let of_spec = (0..description.inputs.len()).map(Input::Spec);
        let of_drives = (0..description.drives.len()).flat_map(|drive| {
            let valve = cylinder_of(description, drive).map(|_| Input::Valve(drive));
            let is_rigid =
                description.coordinates[description.drives[drive].coordinate].role == CoordinateRole::Prescribed;
            let free = [Input::Motion(drive), Input::Rate(drive), Input::Effort(drive)];
            free.into_iter().filter(move |_| !is_rigid).chain(valve)
        });
        of_spec.chain(of_drives).collect()
    }

    /// The one of this name.
    pub fn named(name: &str, description: &Description) -> Option<Self> {
        Self::all(description).into_iter().find(|input| input.column(description).name == name)
    }

    /// Its name and unit.
    pub fn column(self, description: &Description) -> Column {
        let coordinate = |drive: usize| &description.coordinates[description.drives[drive].coordinate];
        let of_motion = |kind: ColumnKind, info: &CoordinateInfo| {
            (column_name(kind, &info.name, info.kind.turns()), kind.unit(info.kind.turns()).to_owned())
        };
        let (name, unit) = match self {
            Input::Spec(index) => {
                let info = &description.inputs[index];
                (info.name.to_string(), info.unit.to_string())
            }
            Input::Motion(drive) => {
                let info = coordinate(drive);
                of_motion(ColumnKind::Prescribed, info)
            }
            Input::Rate(drive) => {
                let info = coordinate(drive);
                of_motion(ColumnKind::PrescribedRate, info)
            }
            Input::Effort(drive) => {
                let info = coordinate(drive);
                (drive_effort(&info.name, info.kind), info.kind.force_unit().to_owned())
            }
            Input::Valve(drive) => {
                let cylinder = cylinder_of(description, drive).unwrap_or_default();
                (column_name(ColumnKind::Valve, cylinder, false), ColumnKind::Valve.unit(false).to_owned())
            }
        };
        Column::new(name, unit)
    }
}

/// Name of the cylinder with a valve that moves a drive's joint.
fn cylinder_of(description: &Description, drive: usize) -> Option<&str> {
    let cylinder = description.cylinders.iter().find(|cylinder| cylinder.drive == drive && cylinder.valve.is_some())?;
    Some(cylinder.name.as_str())
}

/// What an input does: a column of B and of D.
pub(super) struct Effect {
    pub states: DVector<f64>,
    pub outputs: Vec<f64>,
}

/// What an input does at a state.
pub(super) fn effect(
    crane: &dyn DynCrane,
    moment: &StateAt<'_>,
    input: Input,
    space: &StateSpace,
    outputs: &[Output],
) -> Result<Effect, NoModel> {
    let description = crane.description();
    let refused = |why, help| NoModel::Input(input.column(description).name, why, help);
    let (drive, which) = match input {
        Input::Spec(index) => return of_spec(crane, moment, index, space, outputs),
        Input::Motion(drive) => (drive, 0),
        Input::Rate(drive) => (drive, 1),
        Input::Effort(drive) => (drive, 2),
        Input::Valve(drive) => (drive, 3),
    };
    let (j, n) = (description.drives[drive].coordinate, space.unknowns().len());
    if description.coordinates[j].role == CoordinateRole::Prescribed {
        return Err(refused("belongs to a rigid drive", "give the drive a `stiffness`"));
    }
    let mut effect = Effect { states: DVector::zeros(space.matrix.nrows()), outputs: vec![0.0; outputs.len()] };
    if let (0 | 1, Some(place)) = (which, prescribed_output(outputs, &description.coordinates[j].name)) {
        effect.outputs[place] = if which == 0 { 1.0 } else { 0.0 };
    }
    let spool = hydraulics::spool(crane, moment, drive);
    if let Some(spool) = spool.filter(|_| which != 2) {
        let by = match (which, spool.by_motion) {
            (3, _) => 1.0,
            (which, Some(by_motion)) => by_motion[which],
            (_, None) => return Err(refused("moves nothing: its valve is commanded", "let the loop act on the valve")),
        };
        effect.states[2 * n + spool.state] = by / spool.lag;
        return Ok(effect);
    }
    let effort = match which {
        2 => 1.0,
        which => drive_slope(crane, moment, j, which),
    };
    if effort == 0.0 && which == 0 {
        return Err(refused("moves nothing: its drive has no stiffness", "let the loop act on its effort"));
    }
    let mut forces = vec![0.0; moment.q.len()];
    forces[j] = effort;
    effect.states.rows_mut(n, n).copy_from(&space.accelerations_by(&forces)?);
    let mut added = vec![0.0; description.drives.len()];
    if effort == 0.0 || outputs.is_empty() {
        return Ok(effect);
    }
    if let Some(output) = outputs.iter().find(|output| follows_from_accelerations(crane, output)) {
        return Err(NoModel::Output(output.column.name.clone(), input.column(description).name));
    }
    let [before, after] = [-1.0, 1.0].map(|sign| {
        added[drive] = sign * effort;
        quantities_with(crane, moment, &added)
    });
    for (value, output) in effect.outputs.iter_mut().zip(outputs) {
        *value += 0.5 * (after[output.index] - before[output.index]);
    }
    Ok(effect)
}

/// Where the position of the motion of a coordinate's drive is among outputs.
fn prescribed_output(outputs: &[Output], coordinate: &str) -> Option<usize> {
    outputs.iter().position(|output| output.column.kind == ColumnKind::Prescribed && output.column.part() == coordinate)
}

/// How much the force of a drive on its coordinate grows with the position, 0, or the rate, 1, of its motion: it depends on their differences
/// from those of the coordinate.
fn drive_slope(crane: &dyn DynCrane, moment: &StateAt<'_>, j: usize, which: usize) -> f64 {
    /// Most drives are linear: rounding is then 1e-10 of the slope.
    const STEP: f64 = 1e-5;
    let [before, after] = [-STEP, STEP].map(|step| {
        let mut state = [moment.q.to_vec(), moment.v.to_vec()];
        state[which][j] += step;
        let mut forces = vec![0.0; moment.q.len()];
        crane.drive_forces(moment.t, &state[0], &state[1], &mut forces);
        forces[j]
    });
    (before - after) / (2.0 * STEP)
}

/// Whether an output follows from accelerations: the effort of a rigid drive, or what a joint of a loop transmits.
fn follows_from_accelerations(crane: &dyn DynCrane, output: &Output) -> bool {
    let description = crane.description();
    let name = output.column.name.as_str();
    let rigid = description.prescribed();
    let of_drive = rigid.iter().any(|&j| {
        let info = &description.coordinates[j];
        drive_effort(&info.name, info.kind) == name
    });
    let of_loop = crane
        .loop_joints()
        .iter()
        .any(|joint| joint.equations.iter().any(|equation| equation.column(&joint.name) == name));
    of_drive || of_loop
}

/// Changes of an input by which its effect is found, relative to its value or to 1, from the shortest on: rounding hides the effect of a short
/// one, and laws bend or change their branch over a long one.
const PROBES: [f64; 8] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Slopes by central differences, of the steps that differ least from the next shorter ones, in proportion to the largest slope that any finds of each number:
/// there, neither rounding nor curvature counts. `at`: the numbers with a change.
fn slopes(value: f64, mut at: impl FnMut(f64) -> DVector<f64>) -> DVector<f64> {
    let mut found = PROBES.map(|part| {
        let step = part * value.abs().max(1.0);
        (at(step) - at(-step)) / (2.0 * step)
    });
    let largest = |row: usize| found.iter().fold(f64::MIN_POSITIVE, |size, by| size.max(by[row].abs()));
    let sizes: Vec<f64> = (0..found[0].len()).map(largest).collect();
    let off = |more: usize| -> f64 {
        let numbers = found[more - 1].iter().zip(found[more].iter()).zip(&sizes);
        numbers.map(|((less, more), size)| (more - less).abs() / size).sum()
    };
    let best = (1..found.len()).min_by(|one, other| off(*one).total_cmp(&off(*other)));
    std::mem::take(&mut found[best.unwrap_or(0)])
}

/// What an input of the spec does, by central differences.
fn of_spec(
    crane: &dyn DynCrane,
    moment: &StateAt<'_>,
    index: usize,
    space: &StateSpace,
    outputs: &[Output],
) -> Result<Effect, NoModel> {
    let info = &crane.description().inputs[index];
    let Some(value) = crane.input(index).or(info.default) else {
        let (why, help) = ("follows a motion of the spec", "set it to a number, or leave it out");
        return Err(NoModel::Input(info.name.to_string(), why, help));
    };
    let mut changed = crane.boxed_clone();
    let by = slopes(value, |change| {
        changed.set_input(index, Some(value + change));
        let motion = motion_at(changed.as_ref(), moment);
        let free = space.unknowns().iter().map(|&j| motion.accelerations[j]);
        DVector::from_iterator(space.matrix.nrows() - space.unknowns().len(), free.chain(motion.rates))
    });
    let n = space.unknowns().len();
    let mut states = DVector::zeros(space.matrix.nrows());
    states.rows_mut(n, by.len()).copy_from(&by);
    if outputs.is_empty() {
        return Ok(Effect { states, outputs: Vec::new() });
    }
    // They bend elsewhere than accelerations: the pressures of a cylinder where it begins to push.
    let of_outputs = slopes(value, |change| {
        changed.set_input(index, Some(value + change));
        let all = quantities_at(changed.as_ref(), moment);
        DVector::from_iterator(outputs.len(), outputs.iter().map(|output| all[output.index]))
    });
    Ok(Effect { states, outputs: of_outputs.iter().copied().collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number in which short steps drown in rounding, beside one that bends 1e-5 beyond.
    #[test]
    fn slopes_are_of_a_step_between_rounding_and_bends() {
        let found = slopes(0.0, |c| DVector::from_vec(vec![1e6 + 3.0 * c, 1e8 * (c - 1e-5).max(0.0)]));
        // 1e6 has 16 digits: 1e-10/2e-6.
        assert!((found[0] - 3.0).abs() < 1e-4 && found[1] == 0.0, "{found}");
    }
}
