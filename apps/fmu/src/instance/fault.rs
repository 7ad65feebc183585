//! Why a call failed.

use std::fmt;

use crane_model::dynamics::Stopped;

/// Why a call did not do what it should.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Nothing has changed: the caller may continue with a different request.
    Discard(String),
    /// The call was invalid, or the simulation cannot continue.
    Error(String),
}

impl Fault {
    pub(super) fn error(text: impl fmt::Display) -> Self {
        Self::Error(text.to_string())
    }

    pub(super) fn nowhere() -> Self {
        Self::error("the crane has no state")
    }
}

impl From<Stopped> for Fault {
    fn from(stopped: Stopped) -> Self {
        Self::Error(format!("{stopped}; {}", stopped.advice()))
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Fault::Discard(text) | Fault::Error(text)) = self;
        f.write_str(text)
    }
}
