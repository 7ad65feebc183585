//! Places on bodies.

use crate::chain::{BodyId, Value};

/// Where a force acts on a body.
#[derive(Clone, Debug)]
pub struct Place {
    /// The body.
    pub body: BodyId,
    /// Position along it, m.
    pub along: Value,
}
