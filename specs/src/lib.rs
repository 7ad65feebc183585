//! The specs of the shipped cranes and of the examples, as text. A spec that extends another is merged with it into one text.

include!(concat!(env!("OUT_DIR"), "/specs.rs"));

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
