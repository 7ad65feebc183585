//! Whether what repeats is written out or a loop, by what was measured on the reference crane.

/// When what repeats is a loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loops {
    /// Where it is faster.
    #[default]
    Auto,
    /// Wherever it can be.
    Always,
    /// Nowhere.
    Never,
}

/// Equal work at so many bodies in a row is a loop. Forward dynamics written out against in loops: 0.45 and 0.46 µs with 4
/// sections, of which 3 are equal, eight at once 0.98 and 1.10; 0.72 and 0.67 with 8; 4.07 and 2.44 with 30, whose code no
/// longer fits into the first cache.
const LEAST_ROUNDS: usize = 5;

/// The mass matrix of more coordinates is filled in a loop over rows and columns: written out it grows with the square, and so
/// does rustc's time. A and e written out against the loop: 0.47 and 0.59 µs at 13 coordinates, 0.53 and 0.56 at 16, 1.07 and
/// 0.76 at 19, 1.75 and 1.39 at 25.
const LARGEST_WRITTEN_OUT: usize = 16;

impl Loops {
    /// How many bodies in a row make a loop, if any do.
    #[must_use]
    pub fn least_rounds(self) -> Option<usize> {
        match self {
            Loops::Auto => Some(LEAST_ROUNDS),
            Loops::Always => Some(2),
            Loops::Never => None,
        }
    }

    /// Whether the mass matrix of so many coordinates is filled in a loop.
    #[must_use]
    pub fn fill_mass_matrix(self, coordinates: usize) -> bool {
        match self {
            Loops::Auto => coordinates > LARGEST_WRITTEN_OUT,
            Loops::Always => true,
            Loops::Never => false,
        }
    }

    /// Why it is so, for the header.
    #[must_use]
    pub fn reason(self) -> &'static str {
        match self {
            Loops::Auto => "which is faster for a crane of this size",
            Loops::Always => "because the spec says `loops: always`",
            Loops::Never => "because the spec says `loops: never`",
        }
    }
}
