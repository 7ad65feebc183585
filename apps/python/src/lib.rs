//! The native part of the Python package `crane`: what is computed per state, over rows of states on all threads.
//!
//! | module | content |
//! |---|---|
//! | `crane` | the class `Crane`: a spec with parameters and inputs |
//! | `description` | its names and units |
//! | `functions` | transforms, points, mass matrix, forces, dynamics, energies: arrays in, arrays out |
//! | `evaluation` | how: rows of all arguments, eight at a time, on all threads |
//! | `products` | products of vectors with their derivatives |
//! | `equilibria`, `vibrations` | statics, modes and stability, row by row |
//! | `linear` | linear models, and margins of loops around them |
//! | `buckling` | critical factors of weight and loads, first and second order |
//! | `sensitivity` | derivatives at rest by the numbers of a crane |
//! | `motion` | runs: of one crane, of many |
//! | `recorded` | what runs say afterwards: what drives must be able to do, fatigue |
//! | `stepping` | motions that are advanced from outside, one or many |
//! | `page` | the crane in 3-D, as HTML |
//! | `arrays` | arguments as rows, and results as arrays |
//! | `parallel` | rows on threads, while Python's signals are checked |
//! | `mistakes` | exceptions and warnings of the module of that name |
//! | `types` | what Python calls the types of arguments and results |

pub(crate) mod arrays;
pub(crate) mod buckling;
pub(crate) mod crane;
pub(crate) mod description;
pub(crate) mod envelope;
pub(crate) mod equilibria;
pub(crate) mod evaluation;
pub(crate) mod force_states;
pub(crate) mod functions;
pub(crate) mod linear;
pub(crate) mod mistakes;
pub(crate) mod motion;
pub(crate) mod page;
pub(crate) mod parallel;
pub(crate) mod products;
pub(crate) mod recorded;
pub(crate) mod sensitivity;
pub(crate) mod stepping;
pub(crate) mod strength;
pub(crate) mod types;
pub(crate) mod vibrations;

use pyo3::prelude::*;

/// The native part of `crane`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::arrays::real_array;
    #[pymodule_export]
    use crate::crane::Crane;
    #[pymodule_export]
    use crate::crane::import_robot;
    #[pymodule_export]
    use crate::crane::shipped;
    #[pymodule_export]
    use crate::functions::functions;
    #[pymodule_export]
    use crate::linear::loop_margins;
    #[pymodule_export]
    use crate::parallel::{set_threads, threads};
    #[pymodule_export]
    use crate::recorded::{duties_of, fatigue_of};
    #[pymodule_export]
    use crate::stepping::Motions;
}
