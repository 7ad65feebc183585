//! The program in a web page: text of a spec in, mistakes, poses, runs, load charts and a crane to drive out.
//!
//! The page (`apps/report/instrument`) runs this crate as WebAssembly in a worker. Requests and answers are JSON, so that the interface
//! needs no generated glue: three functions and the memory of the module ([`abi`]). All numbers come from the code that the command uses.
//!
//! | module | content |
//! |---|---|
//! | `abi` | the functions that the page calls |
//! | `request` | what the page may ask |
//! | `engine` | the crane of the page, and what is asked about it |
//! | `chart` | load charts |
//! | `levers` | a crane whose drives are at given positions, or follow levers |
//! | `posed` | a crane with the numbers of the page |
//! | `driving` | a motion in real time |

pub mod abi;
mod chart;
mod driving;
mod engine;
mod levers;
mod posed;
mod request;

pub use engine::Engine;
