//! Machine code at run time for straight lines of arithmetic, without a compiler: x86-64 with AVX and aarch64, for one number or for
//! eight at a time.
//!
//! ```text
//! Line ─signs→ Operations ─roll→ loops ─registers→ Instructions ─encode→ bytes ─map→ Code
//! ```
//!
//! | stage | file | after it |
//! |---|---|---|
//! | signs | `operations` | sums, differences, products: what costs an instruction, and what is needed |
//! | roll | `repeats`, `roll` | what repeats with operands that correspond is a loop |
//! | registers | `allocate`, `places` | operations on registers and places in a frame |
//! | encode | `encode` | machine code |
//! | map | `memory` | executable memory, and calls of it |
//!
//! `vectors` calls code that the compiler has translated for several sets of instructions. Both contain all unsafe code of this crate.
//!
//! ```
//! use crane_jit::{Code, StraightLine, Rounding, Step, Width};
//!
//! // a b − c of three given values
//! let product = Step::MulAdd([0, 1, 3]);
//! let difference = Step::MulAdd([2, 4, 5]);
//! let line = StraightLine {
//!     given: vec![None, None, None, Some(-0.0), Some(-1.0)],
//!     steps: vec![product, difference, Step::Store { place: 0, value: 6 }],
//!     results: 1,
//! };
//! if let Some(code) = Code::compile(&line, Rounding::Separate, Width::One) {
//!     let mut frame = vec![0.0; code.places().max(5)];
//!     frame[..5].copy_from_slice(&[2.0, 3.0, 5.0, -0.0, -1.0]);
//!     code.numbers().for_each(|(place, number)| frame[place] = number);
//!     let mut results = [f64::NAN];
//!     code.run(0, &mut frame, &mut results);
//!     assert_eq!(results, [1.0]);
//! }
//! ```

mod allocate;
mod code;
mod encode;
mod instruction;
mod line;
mod memory;
mod operations;
mod places;
mod repeats;
mod roll;
mod vectors;

pub use code::Code;
pub use line::{Rounding, Step, StraightLine, Value, Width, value};
pub use places::Pause;
pub use vectors::{Work, with_vectors};
