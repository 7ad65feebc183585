//! What a link is attached to.

use crate::node::{Content, Form, FromNode, Reader, Unread};

use super::{Spanned, Vector};

/// A link and a place on it.
#[derive(Clone, Debug, FromNode)]
pub struct On {
    /// The link, an earlier one.
    pub link: Spanned<String>,
    /// The place: `tip` of a beam or a rope, its `start`, or `[x, y, z]` in the frame of the link (for a beam: undeformed). Default
    /// `tip`, which for a rigid link is its frame.
    #[key(unit = "m")]
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
const WORDS: &[&str] = &["tip", "start"];

impl FromNode for Place {
    const FORM: Form = Form::AnyOf { forms: &[Form::Words { words: WORDS }, Vector::FORM] };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        match reader.content()? {
            Content::Text(word) if word == "tip" => Ok(Place::Tip),
            Content::Text(word) if word == "start" => Ok(Place::Start),
            Content::Sequence(items) if items.len() == 3 => Vector::from_node(reader).map(Place::Point),
            _ => Err(Unread::Expected("`tip`, `start` or `[x, y, z]`".into())),
        }
    }
}
