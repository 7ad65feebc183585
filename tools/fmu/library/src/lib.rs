//! The shared library of functional mock-up units: the functions that `crane-fmu` exports to C.

pub use crane_fmu::Instance;
