//! External loads.

use super::{BodyId, Profile, Value};

/// A force and a moment at a point of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Unique name.
    pub name: String,
    /// The body it acts on.
    pub body: BodyId,
    /// Position in the body's frame, m.
    pub position: [Value; 3],
    /// N
    pub force: [Value; 3],
    /// N m
    pub moment: [Value; 3],
    /// The axes along which force and moment are given.
    pub axes: LoadAxes,
    /// Factor of both over time; `None` means 1.
    pub scale: Option<Profile>,
}

/// Axes along which a load is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadAxes {
    /// Those of the world: it keeps its direction.
    World,
    /// Those of the body: it turns with it.
    Link,
}

impl Load {
    /// Number of intervals in which its scale is smooth.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.scale.as_ref().map_or(0, |scale| scale.pieces().len())
    }
}
