//! Inputs: numbers that a controller or a user sets between steps.

use super::Profile;

/// Index of an input in the chain's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct InputId(pub usize);

/// An input.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Name, a valid Rust identifier.
    pub name: String,
    /// Unit as written by the user, for tables.
    pub unit: String,
    /// Its description.
    pub about: String,
    /// Its value unless set: a number, or a motion.
    pub unless_set: Profile,
}

impl Input {
    /// Count of the numbers that represent an input: its value at t = 0 while it is set, else 0; 0 while it is set, else 1; and its rate
    /// while it is set to move, else 0. Set, it is `value + rate t`.
    pub const SLOTS: usize = 3;
    /// These numbers while it is not set.
    pub const NOT_SET: [f64; Self::SLOTS] = [0.0, 1.0, 0.0];

    /// These numbers while it is set to a value that stays.
    #[must_use]
    pub const fn set(value: f64) -> [f64; Self::SLOTS] {
        [value, 0.0, 0.0]
    }
}
