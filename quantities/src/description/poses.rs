//! Poses outside the validity of the model, and the warnings about them.

#[cfg(feature = "std")]
use super::{CoordinateInfo, CoordinateKind, CoordinateRole, Description};

/// Distance of θ from ±90° below which a base or an element is near its singularity, rad: ψ and φ then rotate about nearly
/// equal axes, and three digits or more are lost.
pub const NEAR_SINGULAR: f64 = 0.03;
/// Rotation of a base beyond which linear supports are no longer accurate, rad: their error is then half a percent of the lever arm.
pub const LARGE_TILT: f64 = 0.1;
/// Rotation of a base beyond which a crane on feet that lift has tipped over, 30° in rad: soft feet
/// yield by only a few hundredths.
pub const TIPPED: f64 = core::f64::consts::FRAC_PI_6;

#[cfg(feature = "std")]
impl Description {
    /// Indices in `q` of the coordinates that rigid drives prescribe, which are not unknowns.
    pub fn prescribed(&self) -> Vec<usize> {
        let prescribed = |i: &usize| self.coordinates[*i].role == CoordinateRole::Prescribed;
        (0..self.coordinates.len()).filter(prescribed).collect()
    }

    /// Whether all unknowns of a pose are within a bound, m and rad: a prescribed motion has no bound.
    pub fn bounded(&self, q: &[f64], bound: f64) -> bool {
        let mut numbers = self.coordinates.iter().zip(q);
        numbers.all(|(info, x)| x.abs() <= bound || info.role == CoordinateRole::Prescribed)
    }

    /// The caution about a pose in which θ of a base or an element is near ±90°, where ψ and φ rotate about the same axis and the
    /// equations are singular.
    pub fn near_singular(&self, q: &[f64]) -> Option<String> {
        self.near_singular_in(core::iter::once(q))
    }

    /// The same of the first of some poses that is near one.
    pub fn near_singular_in<'q>(&self, mut poses: impl Iterator<Item = &'q [f64]>) -> Option<String> {
        // The cheap tests first: this runs for every row of a result.
        let named = |(_, info): &(usize, &CoordinateInfo)| info.name.ends_with("_theta");
        let angles: Vec<(usize, &CoordinateInfo)> = self.coordinates.iter().enumerate().filter(named).collect();
        poses.find_map(|q| {
            let near = |(index, _): &&(usize, &CoordinateInfo)| {
                let half_turns = q[*index] / core::f64::consts::PI - 0.5;
                (half_turns - half_turns.round()).abs() * core::f64::consts::PI < NEAR_SINGULAR
            };
            angles.iter().filter(near).find_map(|(index, info)| {
                let (name, angle, lost) = (&info.name, q[*index].to_degrees(), self.lost_at_90_degrees(info)?);
                Some(format!("{name} is {angle:.2}°: near ±90° {lost} and accuracy is lost"))
            })
        })
    }

    /// What happens where a coordinate is ±90°, if anything does.
    fn lost_at_90_degrees(&self, CoordinateInfo { name, role, .. }: &CoordinateInfo) -> Option<String> {
        let body = name.strip_suffix("_theta")?;
        let turns = |symbol: &str| {
            let name = format!("{body}_{symbol}");
            self.coordinates.iter().any(|coordinate| *coordinate.name == *name && coordinate.role == *role)
        };
        match role {
            CoordinateRole::Base | CoordinateRole::Element if turns("psi") && turns("phi") => {
                Some(format!("{body}_psi and {body}_phi turn about the same axis"))
            }
            // A link of a rope.
            CoordinateRole::Passive if turns("psi") => Some(format!("{body}_psi turns {body} about its own axis")),
            _ => None,
        }
    }

    /// Whether the base has tipped over between two poses: rotated about a horizontal axis by more than [`TIPPED`].
    pub fn has_tipped(&self, from: &[f64], to: &[f64]) -> bool {
        let tilts = |name: &str| name.ends_with("_theta") || name.ends_with("_phi");
        self.coordinates.iter().zip(from.iter().zip(to)).any(|(CoordinateInfo { name, role, kind }, (from, to))| {
            (*role, *kind) == (CoordinateRole::Base, CoordinateKind::Rotation)
                && tilts(name)
                && (to - from).abs() > TIPPED
        })
    }

    /// The caution about a pose in which a base is rotated too far for its linear supports.
    pub fn large_tilt(&self, q: &[f64]) -> Option<String> {
        let linear = self.supports.iter().any(|support| support.linear);
        self.coordinates.iter().zip(q).filter(|_| linear).find_map(|(coordinate, angle)| {
            let CoordinateInfo { name, role, kind } = coordinate;
            let turned = (*role, *kind) == (CoordinateRole::Base, CoordinateKind::Rotation) && angle.abs() > LARGE_TILT;
            turned.then(|| {
                format!("{name} is {angle:.3} rad: supports with `kinematics: linear` are valid only up to about {LARGE_TILT} rad")
            })
        })
    }
}
