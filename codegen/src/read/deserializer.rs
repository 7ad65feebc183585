//! Reads derived types from a [`Node`], notes mistakes and continues.

use std::cell::RefCell;
use std::fmt::Display;

use serde::de::{self, Deserializer, Expected, Unexpected, Visitor};
use serde::forward_to_deserialize_any;

use super::access::{Choice, Entries, Fields, Items, Parts};
use super::slips;
use super::tree::{Content, Node};
use crate::diagnostic::{Mistake, Span, list, nearest, rule, suggest};
use crate::spec::{EITHER, MANY, SPANNED};

/// Why a value could not be read.
#[derive(Debug)]
pub(super) enum Unread {
    /// A mistake was reported.
    Reported,
    /// It is not what its type expects.
    Expected(String),
}

impl Display for Unread {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Unread::Reported => f.write_str("reported"),
            Unread::Expected(expected) => write!(f, "expected {expected}"),
        }
    }
}

impl std::error::Error for Unread {}

impl de::Error for Unread {
    fn custom<T: Display>(message: T) -> Self {
        Unread::Expected(message.to_string())
    }
    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Self {
        Unread::Expected(expected.to_string())
    }
    fn invalid_value(_: Unexpected, expected: &dyn Expected) -> Self {
        Unread::Expected(expected.to_string())
    }
}

/// The description of a node in messages.
#[derive(Clone, Copy, Debug)]
pub(super) enum Subject<'a> {
    /// The whole file.
    Whole,
    /// The value of a key.
    Key(&'a str),
    /// An entry of the list of a key, by its own name if it has one.
    Entry(&'a str, Option<&'a str>),
}

impl<'a> Subject<'a> {
    /// The key that contains it.
    pub fn key(self) -> &'a str {
        match self {
            Subject::Whole => "",
            Subject::Key(key) | Subject::Entry(key, _) => key,
        }
    }
}

impl Display for Subject<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Subject::Whole => f.write_str("the crane"),
            Subject::Key(key) => write!(f, "`{key}`"),
            Subject::Entry(key, Some(name)) => write!(f, "`{name}` of `{key}`"),
            Subject::Entry(key, None) => write!(f, "an entry of `{key}`"),
        }
    }
}

/// A node to read, or the location where one is missing.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a> {
    /// The node, unless it is missing.
    pub node: Option<&'a Node>,
    /// Its location, or the location where it is missing.
    pub span: Span,
    /// Its description in messages.
    pub subject: Subject<'a>,
    /// The description of its owner.
    pub owner: Subject<'a>,
    /// The mistakes so far.
    pub mistakes: &'a RefCell<Vec<Mistake>>,
}

impl<'a> Reader<'a> {
    /// A reader of the whole file.
    pub fn root(node: &'a Node, mistakes: &'a RefCell<Vec<Mistake>>) -> Self {
        Reader { node: Some(node), span: node.span, subject: Subject::Whole, owner: Subject::Whole, mistakes }
    }

    /// Notes a mistake; the value is then [`Unread::Reported`].
    pub fn report(&self, mistake: Mistake) -> Unread {
        self.mistakes.borrow_mut().push(mistake);
        Unread::Reported
    }

    /// Notes that the value is not what was expected, unless that was reported already.
    pub fn report_unread(&self, unread: Unread) {
        if let (Unread::Expected(mut expected), Some(node)) = (unread, self.node) {
            if let Some(number) = slips::number_with_commas(&node.content) {
                expected = number;
            }
            self.report(rule::wrong_value(
                self.span,
                self.subject,
                node.content.describe(),
                node.content.kind(),
                if expected == "a boolean" { "`true` or `false`" } else { expected.as_str() },
            ));
        }
    }

    /// The node's content; a missing node is a mistake.
    fn content(&self) -> Result<&'a Content, Unread> {
        match self.node {
            Some(node) => Ok(&node.content),
            None => Err(self.report(rule::missing_key(self.span, self.subject.key(), self.owner))),
        }
    }

    /// The variant of that name; of a misspelt name, the variant that was meant, so that nothing else appears to be wrong.
    fn variant(&self, name: &str, span: Span, variants: &[&'static str]) -> Result<&'static str, Unread> {
        let offered = || variants.iter().copied();
        if let Some(variant) = offered().find(|variant| *variant == name) {
            return Ok(variant);
        }
        let unread = self.report(rule::unknown_choice(span, self.subject, name, suggest(name, offered())));
        nearest(name, offered()).ok_or(unread)
    }

    /// The fields of a mapping.
    pub fn fields<V: Visitor<'a>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Unread> {
        match self.content()? {
            Content::Mapping(entries) => visitor.visit_map(Fields::new(self, entries, fields)),
            _ if fields.is_empty() => Err(Unread::Expected("a mapping".into())),
            _ => Err(Unread::Expected(format!("a mapping of {}", list(fields)))),
        }
    }
}

impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = Unread;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unread> {
        match self.content()? {
            Content::Null => visitor.visit_unit(),
            Content::Boolean(boolean) => visitor.visit_bool(*boolean),
            Content::Number(number) => visitor.visit_f64(*number),
            Content::Text(text) => visitor.visit_borrowed_str(text),
            Content::Sequence(items) => visitor.visit_seq(Items::new(self, items)),
            Content::Mapping(entries) => visitor.visit_map(Entries::new(self, entries)),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unread> {
        if self.node.is_some() { visitor.visit_some(self) } else { visitor.visit_none() }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, Unread> {
        if name == SPANNED {
            return visitor.visit_seq(Parts::new(self));
        }
        match (name, self.content()?) {
            (EITHER, Content::Mapping(_)) => visitor.visit_some(self),
            (MANY, Content::Sequence(items)) => visitor.visit_seq(Items::new(self, items)),
            (MANY, _) => visitor.visit_seq(Items::new(self, self.node.map_or(&[], std::slice::from_ref))),
            _ => visitor.visit_newtype_struct(self),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unread> {
        match self.content()? {
            Content::Sequence(items) => visitor.visit_seq(Items::new(self, items)),
            _ => Err(Unread::Expected("a list".into())),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Unread> {
        match self.content()? {
            Content::Sequence(items) if items.len() == length => visitor.visit_seq(Items::new(self, items)),
            Content::Sequence(items) => {
                let help = slips::decimals_as_items(items, length).unwrap_or_else(|| format!("write {length} items"));
                Err(self.report(rule::wrong_length(self.span, self.subject, length, items.len(), help)))
            }
            _ => Err(Unread::Expected(format!("a list of {length} numbers"))),
        }
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unread> {
        match self.content()? {
            Content::Mapping(entries) => visitor.visit_map(Entries::new(self, entries)),
            _ => Err(Unread::Expected("a mapping of names to values".into())),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unread> {
        self.fields(fields, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Unread> {
        match self.content()? {
            Content::Text(name) if variants.contains(&"input") && !variants.contains(&name.as_str()) => {
                let choices = list(variants);
                let help = format!("write `{{input: {name}}}` for an input, or a mapping of one of {choices}");
                Err(self.report(rule::unknown_choice(self.span, self.subject, name, help)))
            }
            Content::Text(name) => {
                let variant = self.variant(name, self.span, variants)?;
                visitor.visit_enum(Choice { reader: self, variant, node: None })
            }
            Content::Mapping(entries) => {
                // Every key is checked before the first error is returned.
                let choices: Vec<_> = entries
                    .iter()
                    .map(|(key, node)| Ok((key.span, self.variant(&key.key_text(), key.span, variants)?, node)))
                    .collect();
                let choices = choices.into_iter().collect::<Result<Vec<_>, Unread>>()?;
                if let [(span, variant, node)] = choices[..] {
                    return visitor.visit_enum(Choice { reader: Reader { span, ..self }, variant, node: Some(node) });
                }
                let span = choices.get(1).map_or(self.span, |(span, ..)| *span);
                Err(self.report(rule::not_one_choice(span, self.subject, choices.len(), list(variants))))
            }
            Content::Sequence(_) if self.subject.key() == "loops" => {
                let choices = list(variants);
                Err(Unread::Expected(format!(
                    "one of {choices} for generated code; joints that close loops belong under `loop_joints:`"
                )))
            }
            Content::Number(number) if variants.contains(&"hold") => Err(Unread::Expected(format!(
                "`{{hold: {number}}}` for a constant, or a mapping of one of {}",
                list(variants)
            ))),
            _ => Err(Unread::Expected(format!("one of {}", list(variants)))),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unread> {
        match self.content()? {
            Content::Text(text) => visitor.visit_borrowed_str(text),
            _ if self.subject.key() == "on" => {
                Err(Unread::Expected("the name of a link, or `{link: …, at: …}` with a place on it".into()))
            }
            _ => Err(Unread::Expected("text".into())),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Unread> {
        self.deserialize_string(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char bytes byte_buf unit unit_struct tuple_struct
        identifier ignored_any
    }
}
