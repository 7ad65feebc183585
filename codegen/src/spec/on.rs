//! What a link is attached to.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Unexpected, Visitor};

use super::{Number, Spanned, Vector};

/// A link and a place on it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `link` and `at`")]
pub struct On {
    /// The link, an earlier one.
    pub link: Spanned<String>,
    /// The place: `tip` of a beam or a rope, its `start`, or `[x, y, z]` in the frame of the link (for a beam: undeformed), m. Default
    /// `tip`, which for a rigid link is its frame.
    pub at: Option<Spanned<Place>>,
}

/// A place on a link.
#[derive(Clone, Debug)]
pub enum Place {
    /// The end of a beam or a rope; the frame of a rigid link.
    Tip,
    /// The beginning of a beam or a rope.
    Start,
    /// A point, m.
    Point(Vector),
}

/// The words for places.
const WORDS: [(&str, Place); 2] = [("tip", Place::Tip), ("start", Place::Start)];

impl<'de> Deserialize<'de> for Place {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Places;
        impl<'de> Visitor<'de> for Places {
            type Value = Place;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("`tip`, `start` or `[x, y, z]`")
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<Place, E> {
                let found = WORDS.into_iter().find(|(known, _)| *known == word);
                found.map(|(_, place)| place).ok_or_else(|| E::invalid_value(Unexpected::Str(word), &self))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Place, A::Error> {
                let mut items: Vec<Spanned<Number>> = Vec::new();
                while let Some(item) = seq.next_element()? {
                    items.push(item);
                }
                let count = items.len();
                items.try_into().map(Place::Point).map_err(|_| A::Error::invalid_length(count, &self))
            }
        }
        deserializer.deserialize_any(Places)
    }
}

impl JsonSchema for Place {
    fn schema_name() -> Cow<'static, str> {
        "Place".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "`tip` or `start` of a beam or a rope, or `[x, y, z]` in the frame of the link, m.",
            "anyOf": [{ "enum": WORDS.map(|(word, _)| word) }, generator.subschema_for::<Vector>()],
        })
    }
}
