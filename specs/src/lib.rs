//! The shipped cranes: a module for each file of `specs/`, compiled by the build script, and their specs.
//!
//! Without the feature `compiled` the crate contains only the specs. A spec that extends another is merged with it into one text.

#[cfg(all(doctest, feature = "compiled"))]
mod manual;

include!(concat!(env!("OUT_DIR"), "/cranes.rs"));

/// Names and specs (YAML) of commented examples, to copy and change; they are not among the shipped cranes.
pub const EXAMPLES: &[(&str, &str)] = &[
    ("loader_crane", include_str!("../examples/loader_crane.yaml")),
    ("parallel_harvester", include_str!("../examples/parallel_harvester.yaml")),
    ("telescopic_loader", include_str!("../examples/telescopic_loader.yaml")),
];

/// The JSON Schema of the spec language.
pub const SCHEMA: &str = include_str!("../crane.schema.json");

/// The spec of a shipped crane (YAML), by its name.
#[must_use]
pub fn spec(name: &str) -> Option<&'static str> {
    SPECS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
