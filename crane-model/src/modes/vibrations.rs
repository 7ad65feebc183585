//! Undamped modes with the damping of the damped modes that move in the same way.

use nalgebra::{Complex, DVector};

use super::{ComplexShape, DampedMode, Mode, NoModes, SmallMotions, damped_with_shapes, undamped};

/// Share of a mode's motion that a damped one must have to count as the same.
const SAME: f64 = 0.7;

/// An undamped mode and its damping.
#[derive(Clone, Debug, PartialEq)]
pub struct Vibration {
    /// The mode.
    pub mode: Mode,
    /// The damped mode that moves in the same way; `None` where damping couples modes so much that none does.
    pub damped: Option<DampedMode>,
}

impl Vibration {
    /// Damping ratio of the damped mode.
    pub fn damping_ratio(&self) -> Option<f64> {
        self.damped.as_ref().map(DampedMode::damping_ratio)
    }
}

/// All undamped modes, lowest first. Both shapes are normalised by the mass matrix, so that `|xᵀ A y|²` is the share of a damped mode's shape y in
/// the motion of an undamped one's, x; of all damped modes that with the largest share is the same if the share is above 0.7.
///
/// # Errors
/// The mass matrix is not positive definite.
pub fn vibrations(motions: &SmallMotions) -> Result<Vec<Vibration>, NoModes> {
    // A mode whose damping is not found has none.
    let damped = damped_with_shapes(motions).unwrap_or_default();
    let same = |mode: &Mode| {
        let unknowns: Vec<f64> = motions.unknowns.iter().map(|&unknown| mode.shape[unknown]).collect();
        let weighted = (&motions.mass * DVector::from_vec(unknowns)).map(Complex::from);
        let share = |shape: &ComplexShape| weighted.dotc(shape).norm_sqr();
        let alike = damped.iter().map(|(mode, shape)| (share(shape), mode));
        let (share, damped) = alike.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (share > SAME).then(|| damped.clone())
    };
    Ok(undamped(motions)?.into_iter().map(|mode| Vibration { damped: same(&mode), mode }).collect())
}
