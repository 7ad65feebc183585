//! Cranes as functional mock-up units: a live crane behind the C interfaces of FMI 2.0 and 3.0, for co-simulation and model exchange.
//!
//! The functional mock-up interface: <https://fmi-standard.org/docs/2.0.5/>, <https://fmi-standard.org/docs/3.0.2/>. A unit is a ZIP archive of a description, of this crate as a
//! shared library, and of the crane's spec, which the library reads where the importer unpacked it. One library serves all
//! cranes and both versions, so that a unit is made without a compiler.
//!
//! | where | what |
//! |---|---|
//! | [`variables`] | the list of a crane's variables, and the token by which library and description recognise each other |
//! | [`description`] | `modelDescription.xml` |
//! | [`resources`] | the spec and the parameters inside of a unit |
//! | [`instance`] | an instance of a crane, in Rust: states, values, steps |
//! | `abi` | the same for C: pointers are dereferenced only there |

mod abi;
pub mod description;
pub mod instance;
pub mod resources;
pub mod variables;

pub use instance::Instance;
