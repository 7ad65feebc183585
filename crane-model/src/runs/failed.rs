//! Why there is no run.

use std::{error::Error, fmt};

use crate::{
    Text,
    dyn_crane::DynCrane,
    dynamics::{Cause, Stopped},
    loop_joints::Gap,
    modes::NoModes,
    statics::{Diagnosis, Equilibrium},
};

/// A crane without a complete run.
#[derive(Clone, Debug, PartialEq)]
pub struct Failed {
    /// Its name.
    pub crane: Text,
    /// Why.
    pub reason: Box<Reason>,
}

/// Why there is no complete run.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// Statics found no stable equilibrium to start from.
    Equilibrium {
        /// What it found.
        equilibrium: Equilibrium,
        /// Why.
        diagnosis: Diagnosis,
    },
    /// The pose at rest has no derivatives by parameters: forces or coordinates are not determined.
    Undetermined,
    /// The mass matrix at the start is not positive definite.
    MassMatrix,
    /// The start is not on the loops of the crane.
    OpenStart {
        /// The loop that is open most.
        gap: Gap,
        /// Whether only some of its numbers are given, and the others cannot follow.
        partly: bool,
    },
    /// There are no modes, which are needed to compute a stable step.
    Modes(NoModes),
    /// The linkage of a cylinder cannot be assembled in a pose of the run.
    Unassembled {
        /// The cylinder.
        cylinder: Text,
        /// When, s.
        time: f64,
    },
    /// The run ended early.
    Stopped {
        /// Where, and why.
        stopped: Stopped,
        /// An earlier caution about a pose near a singularity.
        near_singular: Option<String>,
        /// The largest stable step of a method with constant steps, in words.
        limit: Option<String>,
    },
}

impl Failed {
    /// What to do about it.
    pub fn advice(&self) -> String {
        self.reason.advice()
    }
}

impl Reason {
    /// The reason for a crane for which statics found no stable equilibrium.
    pub fn no_equilibrium(crane: &dyn DynCrane, equilibrium: &Equilibrium) -> Self {
        Self::Equilibrium { equilibrium: equilibrium.clone(), diagnosis: Diagnosis::new(crane, equilibrium) }
    }

    /// This reason for the crane with the given name.
    pub fn for_crane(self, crane: &Text) -> Failed {
        Failed { crane: crane.clone(), reason: Box::new(self) }
    }

    /// What to do about it.
    pub fn advice(&self) -> String {
        match self {
            Reason::Equilibrium { diagnosis, .. } => diagnosis.advice(),
            Reason::Undetermined => {
                "of pads and joints that hold the same motion, make one less exact; add a spring to a coordinate that nothing holds".to_owned()
            }
            Reason::MassMatrix => {
                "give every link a mass in kg and an inertia in kg m² that are not negligible compared with those of the others".to_owned()
            }
            Reason::OpenStart { partly: true, .. } => {
                "give fewer positions and rates of its loop, or none: those that are not given follow".to_owned()
            }
            Reason::OpenStart { .. } => {
                "start from a state with closed loops, such as one of an earlier run, or give single coordinates by `--start`: others follow".to_owned()
            }
            Reason::Modes(_) => "check masses and inertias in the spec".to_owned(),
            Reason::Unassembled { .. } => {
                "lengthen its `rocker` or `link`, check the positions of its pins, or keep the joint where they reach each other".to_owned()
            }
            Reason::Stopped { stopped, limit, .. } => {
                let light = match stopped.cause {
                    Cause::Tolerance => {
                        "; a very light link next to a heavy one vibrates too fast for any step: give it its real mass"
                    }
                    _ => "",
                };
                let limit = limit.as_ref().map_or_else(String::new, |limit| format!("; {limit}"));
                stopped.advice() + light + &limit
            }
        }
    }
}

impl fmt::Display for Failed {
    /// Name and reason.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.crane, self.reason)
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::Equilibrium { equilibrium, diagnosis } => {
                let residual = equilibrium.residual();
                let left = if residual.is_finite() { format!(", residual {residual:.1e}") } else { String::new() };
                write!(f, "statics did not find a stable equilibrium ({equilibrium}{left}){diagnosis}")
            }
            Reason::Undetermined => f.write_str(
                "the pose at rest has no derivatives: equations of loops nearly depend on each other, or hardly anything holds a coordinate",
            ),
            Reason::MassMatrix => {
                f.write_str("the mass matrix is not positive definite, so accelerations are not defined")
            }
            Reason::OpenStart { gap, partly } => {
                let what = if *partly {
                    "no position or rate of the others closes the loop"
                } else {
                    "the loop is not closed"
                };
                write!(f, "the start cannot be used: {what}: {gap}")
            }
            Reason::Modes(no_modes) => write!(f, "{no_modes}"),
            Reason::Unassembled { cylinder, time } => {
                write!(
                    f,
                    "the linkage of {cylinder} cannot be assembled at {time} s: its rocker and link do not reach each other"
                )
            }
            Reason::Stopped { stopped, near_singular, .. } => {
                let near = near_singular.as_ref().map_or_else(String::new, |caution| format!("; {caution}"));
                write!(f, "{stopped}{near}")
            }
        }
    }
}

impl Error for Failed {}
