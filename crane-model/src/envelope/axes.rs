//! The quantities that an envelope varies.

use crate::{CoordinateKind, Description, dyn_crane::DynCrane};

/// Largest angle without a unit that is taken for one in rad: a turn.
pub const TURN: f64 = std::f64::consts::TAU + 1e-6;

/// A quantity that is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varied {
    /// Position of a drive, by its index in the description, m or rad.
    Drive(usize),
    /// A live parameter, by its index in the description.
    Parameter(usize),
}

impl Varied {
    /// The drive of a coordinate, or of a link that has only one drive, or the live parameter of this name.
    pub fn named(name: &str, description: &Description) -> Option<Self> {
        let driven = || description.drives.iter().map(|drive| description.coordinates[drive.coordinate].name.as_str());
        let is_of_link = |coordinate: &&str| coordinate.rsplit_once('_').is_some_and(|(link, _)| link == name);
        let mut of_link = driven().filter(is_of_link);
        let drive = match (of_link.next(), of_link.next()) {
            (Some(only), None) => only,
            _ => name,
        };
        let parameter = || description.parameters.iter().position(|parameter| parameter.name == name);
        let drive = driven().position(|coordinate| coordinate == drive);
        drive.map(Varied::Drive).or_else(|| parameter().map(Varied::Parameter))
    }
}

/// A varied quantity and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub varied: Varied,
    /// Its values, at least one.
    pub values: Vec<f64>,
}

impl Axis {
    /// A value of an angle that is more than a turn: most likely it was meant in degrees.
    pub fn implausible_angle(&self, description: &Description) -> Option<f64> {
        let is_angle = match self.varied {
            Varied::Drive(drive) => {
                description.coordinates[description.drives[drive].coordinate].kind == CoordinateKind::Rotation
            }
            Varied::Parameter(index) => description.parameters[index].unit == "rad",
        };
        let greatest = self.values.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
        greatest.filter(|angle| is_angle && angle.abs() > TURN)
    }
}

/// All combinations of the values of some axes; the last axis runs fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axes(pub Vec<Axis>);

impl Axes {
    /// Number of combinations.
    pub fn poses(&self) -> usize {
        self.0.iter().map(|axis| axis.values.len()).product()
    }

    /// Number of values of the last axis.
    pub(super) fn row(&self) -> usize {
        self.0.last().map_or(1, |axis| axis.values.len())
    }

    /// Indices of a combination's values on their axes.
    pub fn places(&self, pose: usize) -> Vec<usize> {
        let mut rest = pose;
        let mut places: Vec<usize> = self
            .0
            .iter()
            .rev()
            .map(|axis| {
                let index = rest % axis.values.len();
                rest /= axis.values.len();
                index
            })
            .collect();
        places.reverse();
        places
    }

    /// Values of a combination, one per axis.
    pub fn values(&self, pose: usize) -> Vec<f64> {
        self.0.iter().zip(self.places(pose)).map(|(axis, index)| axis.values[index]).collect()
    }

    /// Parameters of a crane for a combination, in the order of the description.
    pub fn parameters(&self, crane: &dyn DynCrane, pose: usize) -> Vec<f64> {
        let mut parameters: Vec<f64> = crane.parameter_values();
        for (axis, value) in self.0.iter().zip(self.values(pose)) {
            if let Varied::Parameter(index) = axis.varied {
                parameters[index] = value;
            }
        }
        parameters
    }

    /// Positions of a crane's drives for a combination: drives that are not varied are at the beginning of their motions.
    pub(super) fn positions(&self, crane: &dyn DynCrane, pose: usize) -> Vec<f64> {
        let mut positions = crane.drive_targets_at(0.0);
        for (axis, value) in self.0.iter().zip(self.values(pose)) {
            if let Varied::Drive(index) = axis.varied {
                positions[index] = value;
            }
        }
        positions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_axis_runs_fastest() {
        let axis = |values: &[f64]| Axis { varied: Varied::Drive(0), values: values.to_vec() };
        let axes = Axes(vec![axis(&[1.0, 2.0]), axis(&[10.0, 20.0, 30.0])]);
        assert_eq!(axes.poses(), 6);
        assert_eq!(axes.values(0), [1.0, 10.0]);
        assert_eq!(axes.values(2), [1.0, 30.0]);
        assert_eq!(axes.values(3), [2.0, 10.0]);
        assert_eq!(axes.places(5), [1, 2]);
        assert_eq!(Axes::default().poses(), 1);
    }
}
