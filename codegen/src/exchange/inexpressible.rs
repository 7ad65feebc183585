//! What a format cannot express.

use std::fmt;

/// A part of a crane that a format cannot express.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inexpressible {
    /// What cannot be expressed, in the user's own names, and why.
    pub title: String,
    /// What to do instead.
    pub help: String,
}

impl fmt::Display for Inexpressible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.title, self.help)
    }
}

impl std::error::Error for Inexpressible {}
