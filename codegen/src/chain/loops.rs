//! Whether repeated work is written out or becomes a loop, based on measurements of the reference crane.

/// When repeated work becomes a loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loops {
    /// If it is faster.
    #[default]
    Auto,
    /// Wherever possible.
    Always,
    /// Never.
    Never,
}

/// Equal work at this many consecutive bodies becomes a loop. Forward dynamics written out and in loops: 0.45 and 0.46 µs with 4
/// sections, 3 of which are equal, and 0.98 and 1.10 for eight cranes at once; 0.72 and 0.67 with 8; 4.07 and 2.44 with 30,
/// whose code written out no longer fits into the first-level cache.
const MIN_ITERATIONS: usize = 5;

/// With more coordinates, the mass matrix is filled in a loop over rows and columns: written out, the code grows with the square
/// of their number, and so does rustc's time. A and e written out and in a loop: 0.47 and 0.59 µs at 13 coordinates, 0.53 and 0.56
/// at 16, 1.07 and 0.76 at 19, 1.75 and 1.39 at 25.
const LARGEST_WRITTEN_OUT: usize = 16;

/// With more coordinates, a loop over pairs of them fills the tangent stiffness: written out, it has eleven operations per pair, for which
/// the derivation of a beam of 200 sections takes 1 s and 0.5 GB, and each Newton step no less time than in a loop.
const LARGEST_TANGENT_WRITTEN_OUT: usize = 48;

impl Loops {
    /// The number of consecutive bodies that make a loop, if any do.
    #[must_use]
    pub fn min_iterations(self) -> Option<usize> {
        match self {
            Loops::Auto => Some(MIN_ITERATIONS),
            Loops::Always => Some(2),
            Loops::Never => None,
        }
    }

    /// Whether the mass matrix of this many coordinates is filled in a loop.
    #[must_use]
    pub fn fill_mass_matrix(self, coordinates: usize) -> bool {
        match self {
            Loops::Auto => coordinates > LARGEST_WRITTEN_OUT,
            Loops::Always => true,
            Loops::Never => false,
        }
    }

    /// Whether the tangent stiffness of this many coordinates is filled in a loop.
    #[must_use]
    pub fn fill_tangent(self, coordinates: usize) -> bool {
        match self {
            Loops::Auto => coordinates > LARGEST_TANGENT_WRITTEN_OUT,
            Loops::Always => true,
            Loops::Never => false,
        }
    }

    /// The reason, for the header.
    #[must_use]
    pub fn reason(self) -> &'static str {
        match self {
            Loops::Auto => "which is faster for a crane of this size",
            Loops::Always => "because the spec says `loops: always`",
            Loops::Never => "because the spec says `loops: never`",
        }
    }
}
