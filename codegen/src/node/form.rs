//! The form of a value as data: what JSON Schema describes.

use super::{FromNode, Measure};

/// What may be written for a value.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    /// A variant without content: its word alone.
    Word,
    /// Text.
    Text,
    /// `true` or `false`.
    Flag,
    /// A number.
    Number,
    /// An integer within bounds.
    Integer { least: u32, most: u32 },
    /// Text of a pattern.
    Pattern { pattern: &'static str },
    /// One of some words.
    Words { words: &'static [&'static str] },
    /// A list, of so many items if that is fixed.
    List { item: &'static Form, count: Option<usize> },
    /// A mapping from the user's names.
    Entries { value: &'static Form },
    /// Any of several forms.
    AnyOf { forms: &'static [Form] },
    /// A mapping of keys.
    Mapping { keys: &'static [Key] },
    /// One of several variants.
    Choice { variants: &'static [Variant] },
    /// A form with a name.
    Defined { definition: &'static Definition },
}

/// A form with a name, which other forms refer to.
#[derive(Debug)]
pub(crate) struct Definition {
    pub name: &'static str,
    pub about: &'static str,
    pub form: Form,
}

/// A key of a mapping.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    pub name: &'static str,
    pub about: &'static str,
    pub is_required: bool,
    pub form: Form,
    pub measure: &'static Measure,
}

impl Key {
    /// The key of a value of a type.
    pub const fn new<T: FromNode>(name: &'static str, about: &'static str, measure: &'static Measure) -> Self {
        Key { name, about, is_required: !T::IS_OPTIONAL, form: T::FORM, measure }
    }
}

/// A variant of a choice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variant {
    pub word: &'static str,
    pub about: &'static str,
    pub content: Form,
    pub measure: &'static Measure,
    /// Whether the word may stand alone although the variant has content.
    pub is_bare: bool,
}
