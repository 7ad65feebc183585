//! What a loop acts on, by its name.

use crane_quantities::ColumnKind;

use crate::{
    Description, DriveInfo,
    linear::Input,
    results::{Column, column_name},
};

/// What a loop acts on, of a drive or of the spec.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acting {
    /// The motion of a drive, position and rate.
    Motion(usize),
    /// The rate of the motion of a drive, whose position is its integral.
    Rate(usize),
    /// A single input.
    On(Input),
}

impl Acting {
    /// What a name stands for: the coordinate of a drive for its motion, `<coordinate>_rate` for the rate of its motion, any other input by
    /// its own name.
    pub fn named(name: &str, description: &Description) -> Option<Self> {
        let drive = |name: &str| {
            let is_it = |drive: &DriveInfo| description.coordinates[drive.coordinate].name == name;
            description.drives.iter().position(is_it)
        };
        let rate = || name.strip_suffix(ColumnKind::Rate.endings(false)[0]).and_then(drive).map(Acting::Rate);
        drive(name).map(Acting::Motion).or_else(rate).or_else(|| Input::named(name, description).map(Acting::On))
    }

    /// All names.
    pub fn names(description: &Description) -> Vec<String> {
        let inputs = Input::all(description);
        let motions = inputs.iter().filter_map(|input| match input {
            Input::Motion(drive) => Some(*drive),
            _ => None,
        });
        let motions = motions.flat_map(|drive| {
            let [motion, rate] = [Acting::Motion(drive), Acting::Rate(drive)];
            [motion.column(description).name, rate.column(description).name]
        });
        motions.chain(inputs.iter().map(|input| input.column(description).name)).collect()
    }

    /// Its name and unit.
    pub fn column(self, description: &Description) -> Column {
        let info = |drive: usize| &description.coordinates[description.drives[drive].coordinate];
        match self {
            Acting::Motion(drive) => {
                let info = info(drive);
                Column::new(info.name.as_str(), info.kind.unit())
            }
            Acting::Rate(drive) => {
                let info = info(drive);
                Column::new(
                    column_name(ColumnKind::Rate, &info.name, info.kind.turns()),
                    ColumnKind::Rate.unit(info.kind.turns()),
                )
            }
            Acting::On(input) => input.column(description),
        }
    }

    /// Name of the coordinate of the drive on which it acts; `None` for inputs of the spec.
    pub fn coordinate(self, description: &Description) -> Option<&str> {
        let drive = match self {
            Acting::Motion(drive)
            | Acting::Rate(drive)
            | Acting::On(Input::Motion(drive) | Input::Rate(drive) | Input::Effort(drive) | Input::Valve(drive)) => {
                drive
            }
            Acting::On(Input::Spec(_)) => return None,
        };
        Some(description.coordinates[description.drives[drive].coordinate].name.as_str())
    }

    /// The inputs that it moves, and the power of s by which each follows.
    pub fn inputs(self) -> Vec<(Input, i32)> {
        match self {
            Acting::Motion(drive) => vec![(Input::Motion(drive), 0), (Input::Rate(drive), 1)],
            Acting::Rate(drive) => vec![(Input::Motion(drive), -1), (Input::Rate(drive), 0)],
            Acting::On(input) => vec![(input, 0)],
        }
    }
}
