//! Cranes as functional mock-up units: a crane behind the C interfaces of FMI 2.0 and 3.0, for co-simulation and model exchange.
//!
//! The functional mock-up interface: <https://fmi-standard.org/docs/2.0.5/>, <https://fmi-standard.org/docs/3.0.2/>. A unit is a ZIP archive of a description, of this crate as a
//! shared library, and of the crane's spec, which the library reads where the importer unpacked it. One library of live cranes serves
//! all specs and both versions, so that a unit is made without a compiler; a library of one compiled crane is faster.
//!
//! | where | what |
//! |---|---|
//! | [`variables`] | the list of a crane's variables, and the token by which library and description recognise each other |
//! | [`description`] | `modelDescription.xml` |
//! | [`resources`] | the spec and the parameters inside of a unit |
//! | [`instance`] | an instance of a crane, in Rust: states, values, steps |
//! | `abi` | the same for C: pointers are dereferenced only there |
//! | [`units!`] | the functions of C that create a crane, in the crate of the shared library |

#[doc(hidden)]
pub mod abi;
pub mod description;
pub mod instance;
pub mod resources;
pub mod variables;

use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;

pub use instance::Instance;

/// What makes the crane of a shared library from the live one of the spec in a unit: that one, as [`live`], or a compiled one, which is that of one spec.
pub type Make = fn(&LiveCrane) -> Box<dyn DynCrane>;

/// The live crane itself, which can be that of any spec.
#[must_use]
pub fn live(crane: &LiveCrane) -> Box<dyn DynCrane> {
    Box::new(crane.clone())
}
