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
//! | `mistakes` | exceptions and warnings |

mod arrays;
mod buckling;
mod crane;
mod description;
mod envelope;
mod equilibria;
mod evaluation;
mod force_states;
mod functions;
mod linear;
mod mistakes;
mod motion;
mod page;
mod parallel;
mod products;
mod recorded;
mod sensitivity;
mod stepping;
mod strength;
mod vibrations;

use pyo3::prelude::*;

/// What `crane` imports.
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
    use crate::mistakes::{InvalidRowWarning, NoEquilibrium, ParameterError, SpecError, SpecWarning};
    #[pymodule_export]
    use crate::parallel::{set_threads, threads};
    #[pymodule_export]
    use crate::recorded::{duties_of, fatigue_of};
    #[pymodule_export]
    use crate::stepping::Motions;
}
