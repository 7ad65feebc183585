//! The axis from which the radius of a load is measured.

use nalgebra::{Matrix2, Vector2, Vector3};

use crate::{CoordinateKind, Description, dyn_crane::DynCrane};

/// The point of interest whose radius and height are shown unless another one is chosen: the only one; otherwise, `None`, it is the origin of the
/// last link.
pub fn only_point(description: &Description) -> Option<usize> {
    (description.points.len() == 1).then_some(0)
}

/// A vertical axis about which the crane slews.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlewAxis {
    /// Index of the drive that slews the crane about it; `None` if no drive does; the axis is then at the world's origin.
    pub drive: Option<usize>,
    /// Where the axis meets the ground, m.
    pub at: [f64; 2],
}

impl SlewAxis {
    /// The axis of the first drive, if that turns the crane about a vertical axis at the guess.
    pub fn new(crane: &dyn DynCrane) -> Self {
        /// Cosine of the tilt up to which an axis counts as vertical, some 8°.
        const VERTICAL: f64 = 0.99;
        let none = Self { drive: None, at: [0.0; 2] };
        let description = crane.description();
        let first = description.drives.iter().enumerate().min_by_key(|(_, drive)| drive.coordinate);
        let Some((drive, info)) = first else { return none };
        if description.coordinates[info.coordinate].kind != CoordinateKind::Rotation {
            return none;
        }
        let here = crane.guess();
        let mut turned = here.clone();
        turned[info.coordinate] += 1.0;
        let last = |q: &[f64]| crane.transforms_at(q).last().copied();
        let (Some(from), Some(to)) = (last(&here), last(&turned)) else { return none };
        let Some(back) = from.try_inverse() else { return none };
        // A rotation by 1 rad about an axis leaves the axis in place: `c = R c + t`.
        let motion = to * back;
        let rotation = motion.fixed_view::<3, 3>(0, 0);
        let axis = Vector3::new(
            rotation[(2, 1)] - rotation[(1, 2)],
            rotation[(0, 2)] - rotation[(2, 0)],
            rotation[(1, 0)] - rotation[(0, 1)],
        );
        if axis.z.abs() < VERTICAL * axis.norm() || axis.norm() == 0.0 {
            return none;
        }
        let held = Matrix2::identity() - rotation.fixed_view::<2, 2>(0, 0);
        let shift = Vector2::new(motion[(0, 3)], motion[(1, 3)]);
        held.try_inverse().map_or(none, |inverse| Self { drive: Some(drive), at: (inverse * shift).into() })
    }

    /// Horizontal distance of a point from the axis, m.
    pub fn radius(&self, position: &Vector3<f64>) -> f64 {
        (position.x - self.at[0]).hypot(position.y - self.at[1])
    }
}
