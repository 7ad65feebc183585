//! What the generated functions of the reference crane cost, from 13 to 103 coordinates.
//!
//! `cargo bench -p crane-bench` times all kernels. The program of this crate times one at a time, so that
//! `tools/peers/measure.py` can alternate it with other libraries.

pub mod cranes;
pub mod kernel;
pub mod kernels;
pub mod limits;
pub mod runs;
pub mod states;
pub mod triple_sum;
