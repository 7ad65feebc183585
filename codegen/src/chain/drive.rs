//! Drives of joints, and their rotors.

use super::{CoordinateId, Profile, Value};

/// A drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The coordinate it drives.
    pub coordinate: CoordinateId,
    /// The transmission between its motion and the coordinate.
    pub transmission: Transmission,
    /// Prescribed motion of the transmission's far end.
    pub profile: Profile,
}

/// The transmission between a prescribed motion and the coordinate.
#[derive(Clone, Debug, PartialEq)]
pub enum Transmission {
    /// A spring and a damper, Eqs. (19)–(21), and an effort besides.
    Flexible {
        /// Stiffness, N m/rad or N/m; the constant 0 without a spring.
        stiffness: Value,
        /// Damping, N m s/rad or N s/m.
        damping: Value,
        /// The effort besides, N m or N, over time.
        effort: Option<Profile>,
        /// The maximum effort of all together, N m or N.
        max_effort: Option<Value>,
        /// The maximum rate at which it drives, rad/s or m/s.
        max_rate: Option<f64>,
        /// The maximum power with which it drives, W.
        max_power: Option<f64>,
    },
    /// A rigid connection: the coordinate is prescribed.
    Rigid,
    /// The oil of a cylinder with a valve: a spring at rest; in motion, the pressures are states.
    Oil {
        /// Stiffness at rest, N m/rad or N/m.
        stiffness: Value,
        /// The command of the valve over time, unless a servo follows the motion.
        opening: Option<Profile>,
    },
}

impl Drive {
    /// Stiffness and damping, if it is flexible.
    #[must_use]
    pub fn spring(&self) -> Option<(&Value, &Value)> {
        match &self.transmission {
            Transmission::Flexible { stiffness, damping, .. } => Some((stiffness, damping)),
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }

    /// Stiffness at rest, if a cylinder with a valve moves it.
    #[must_use]
    pub fn oil(&self) -> Option<&Value> {
        match &self.transmission {
            Transmission::Oil { stiffness, .. } => Some(stiffness),
            Transmission::Flexible { .. } | Transmission::Rigid => None,
        }
    }

    /// The command of its valve over time, if it has one.
    #[must_use]
    pub fn opening(&self) -> Option<&Profile> {
        match &self.transmission {
            Transmission::Oil { opening, .. } => opening.as_ref(),
            Transmission::Flexible { .. } | Transmission::Rigid => None,
        }
    }

    /// The effort besides those of spring and damper, over time, if it has one.
    #[must_use]
    pub fn effort(&self) -> Option<&Profile> {
        match &self.transmission {
            Transmission::Flexible { effort, .. } => effort.as_ref(),
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }

    /// Whether its motion says where the joint is at rest: not if it has only an effort and a damper.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.effort().is_none() || self.spring().is_none_or(|(stiffness, _)| !stiffness.is_zero())
    }

    /// Begin and end, s, of the intervals in which its motion, its effort and its valve's command are smooth.
    #[must_use]
    pub fn pieces(&self) -> Vec<[Value; 2]> {
        let given = [Some(&self.profile), self.effort(), self.opening()];
        given.into_iter().flatten().flat_map(Profile::pieces).collect()
    }

    /// The maximum rate at which it drives, if it is limited.
    #[must_use]
    pub fn max_rate(&self) -> Option<f64> {
        match self.transmission {
            Transmission::Flexible { max_rate, .. } => max_rate,
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }

    /// The maximum power with which it drives, if it is limited.
    #[must_use]
    pub fn max_power(&self) -> Option<f64> {
        match self.transmission {
            Transmission::Flexible { max_power, .. } => max_power,
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }

    /// The maximum effort, if it is limited.
    #[must_use]
    pub fn max_effort(&self) -> Option<&Value> {
        match &self.transmission {
            Transmission::Flexible { max_effort, .. } => max_effort.as_ref(),
            Transmission::Rigid | Transmission::Oil { .. } => None,
        }
    }
}

/// A rotor that a joint drives through a gear, given by its inertia reflected to the joint: `i² J`, i the gear ratio.
///
/// It only resists the joint's acceleration: its weight and its gyroscopic moments are neglected.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotor {
    /// The coordinate of the joint.
    pub coordinate: CoordinateId,
    /// Reflected inertia, kg m² or kg.
    pub armature: Value,
}
