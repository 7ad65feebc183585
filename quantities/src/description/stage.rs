//! Stages of telescopes.

/// A beam that slides in another one on pads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageInfo {
    /// The first element of the outer beam and the one after its last: indices of bodies.
    pub outer: [usize; 2],
    /// The first element of the inner beam.
    pub inner: usize,
    /// Index of the coordinate along which it slides: the overlap becomes shorter as it grows.
    pub coordinate: usize,
}
