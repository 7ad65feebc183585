//! Access of a [`Reader`] to the contents of a node.

use std::collections::BTreeSet;

use serde::de::value::StrDeserializer;
use serde::de::{DeserializeSeed, EnumAccess, IntoDeserializer, MapAccess, SeqAccess, VariantAccess, Visitor};

use super::deserializer::{Reader, Subject, Unread};
use super::slips;
use super::tree::{Content, Node};
use crate::diagnostic::{Span, nearest, rule, suggest};

/// The location shown for a value: a scalar itself, a list or mapping at its key.
fn shown(key: Span, value: &Node) -> Span {
    match value.content {
        Content::Sequence(_) | Content::Mapping(_) | Content::Null => key,
        _ => value.span,
    }
}

/// The location shown for an item of a list: a mapping at its first key.
fn shown_item(item: &Node) -> Span {
    match &item.content {
        Content::Mapping(entries) => entries.first().map_or(item.span, |(key, _)| key.span),
        _ => item.span,
    }
}

/// The `name` of an item of a list.
fn name_of(item: &Node) -> Option<&str> {
    let Content::Mapping(entries) = &item.content else { return None };
    entries.iter().find_map(|(key, value)| match (&key.content, &value.content) {
        (Content::Text(key), Content::Text(name)) if key == "name" => Some(name.as_str()),
        _ => None,
    })
}

/// Start, end and value of a node, for [`Spanned`](crate::spec::Spanned).
pub(super) struct Parts<'a> {
    reader: Reader<'a>,
    next: usize,
}

impl<'a> Parts<'a> {
    pub fn new(reader: Reader<'a>) -> Self {
        Parts { reader, next: 0 }
    }
}

impl<'a> SeqAccess<'a> for Parts<'a> {
    type Error = Unread;
    fn next_element_seed<T: DeserializeSeed<'a>>(&mut self, seed: T) -> Result<Option<T::Value>, Unread> {
        self.next += 1;
        match self.next {
            1 => seed.deserialize(self.reader.span.start.into_deserializer()).map(Some),
            2 => seed.deserialize(self.reader.span.end.into_deserializer()).map(Some),
            _ => match seed.deserialize(self.reader) {
                Ok(value) => Ok(Some(value)),
                Err(unread) => {
                    self.reader.report_unread(unread);
                    Err(Unread::Reported)
                }
            },
        }
    }
}

/// Items of a list.
pub(super) struct Items<'a> {
    reader: Reader<'a>,
    items: std::slice::Iter<'a, Node>,
}

impl<'a> Items<'a> {
    pub fn new(reader: Reader<'a>, items: &'a [Node]) -> Self {
        Items { reader, items: items.iter() }
    }
}

impl<'a> SeqAccess<'a> for Items<'a> {
    type Error = Unread;
    fn next_element_seed<T: DeserializeSeed<'a>>(&mut self, seed: T) -> Result<Option<T::Value>, Unread> {
        let Some(item) = self.items.next() else { return Ok(None) };
        let subject = Subject::Entry(self.reader.subject.key(), name_of(item));
        seed.deserialize(Reader { node: Some(item), span: shown_item(item), subject, ..self.reader }).map(Some)
    }
}

/// User-defined names and their values; the second of two equal names is reported and skipped.
pub(super) struct Entries<'a> {
    reader: Reader<'a>,
    pairs: &'a [(Node, Node)],
    next: usize,
    seen: BTreeSet<String>,
}

impl<'a> Entries<'a> {
    pub fn new(reader: Reader<'a>, pairs: &'a [(Node, Node)]) -> Self {
        Entries { reader, pairs, next: 0, seen: BTreeSet::new() }
    }
}

/// The key as a reader may borrow it.
fn borrowed(key: &Node) -> &str {
    match &key.content {
        Content::Text(text) => text,
        _ => "the entry",
    }
}

impl<'a> MapAccess<'a> for Entries<'a> {
    type Error = Unread;
    fn next_key_seed<K: DeserializeSeed<'a>>(&mut self, seed: K) -> Result<Option<K::Value>, Unread> {
        while let Some((key, _)) = self.pairs.get(self.next) {
            self.next += 1;
            let name = key.key_text();
            if !self.seen.insert(name.clone()) {
                self.reader.report(rule::duplicate_key(key.span, name));
                continue;
            }
            return seed.deserialize(Reader { node: Some(key), span: key.span, ..self.reader }).map(Some);
        }
        Ok(None)
    }
    fn next_value_seed<V: DeserializeSeed<'a>>(&mut self, seed: V) -> Result<V::Value, Unread> {
        let (key, value) = &self.pairs[self.next - 1];
        let reader = self.reader;
        let (span, subject) = (shown(key.span, value), Subject::Key(borrowed(key)));
        seed.deserialize(Reader { node: Some(value), span, subject, owner: reader.subject, ..reader })
    }
}

/// All fields of a struct in the order of their declaration, including those that are not given, so that missing required ones are
/// reported.
pub(super) struct Fields<'a> {
    reader: Reader<'a>,
    names: &'static [&'static str],
    given: Vec<Option<(Span, &'a Node)>>,
    next: usize,
}

impl<'a> Fields<'a> {
    /// Reports unknown and duplicate keys.
    pub fn new(reader: Reader<'a>, entries: &'a [(Node, Node)], names: &'static [&'static str]) -> Self {
        let mut given = vec![None; names.len()];
        let mut unknown = Vec::new();
        let mut before = None;
        for (key, value) in entries {
            let name = key.key_text();
            match names.iter().position(|field| *field == name) {
                None => {
                    let decimals = slips::decimals_as_key(before, key, value);
                    let meant = nearest(&name, names.iter().copied()).filter(|_| decimals.is_none());
                    unknown.extend(meant.map(|meant| (meant, key, value)));
                    let help = decimals.unwrap_or_else(|| suggest(&name, names.iter().copied()));
                    reader.report(rule::unknown_key(key.span, name, help));
                }
                Some(field) if given[field].is_some() => {
                    reader.report(rule::duplicate_key(key.span, name));
                }
                Some(field) => given[field] = Some((shown(key.span, value), value)),
            }
            before = Some(value);
        }
        // A misspelt key counts as the one that was meant, so that this does not appear to be missing.
        for (meant, key, value) in unknown {
            for (given, _) in given.iter_mut().zip(names).filter(|(given, name)| **name == meant && given.is_none()) {
                *given = Some((shown(key.span, value), value));
            }
        }
        Fields { reader, names, given, next: 0 }
    }
}

impl<'a> MapAccess<'a> for Fields<'a> {
    type Error = Unread;
    fn next_key_seed<K: DeserializeSeed<'a>>(&mut self, seed: K) -> Result<Option<K::Value>, Unread> {
        let Some(field) = self.names.get(self.next) else { return Ok(None) };
        self.next += 1;
        let key: StrDeserializer<Unread> = (*field).into_deserializer();
        seed.deserialize(key).map(Some)
    }
    fn next_value_seed<V: DeserializeSeed<'a>>(&mut self, seed: V) -> Result<V::Value, Unread> {
        let field = self.next - 1;
        let (span, node) = match self.given[field] {
            Some((span, node)) => (span, Some(node)),
            None => (self.reader.span, None),
        };
        let (subject, owner) = (Subject::Key(self.names[field]), self.reader.subject);
        seed.deserialize(Reader { node, span, subject, owner, ..self.reader })
    }
}

/// A chosen variant, and its content.
pub(super) struct Choice<'a> {
    pub reader: Reader<'a>,
    pub variant: &'static str,
    pub node: Option<&'a Node>,
}

impl<'a> Choice<'a> {
    /// Reader of the variant's content.
    fn content(&self) -> Reader<'a> {
        let span = self.node.map_or(self.reader.span, |node| shown(self.reader.span, node));
        Reader { node: self.node, span, subject: Subject::Key(self.variant), owner: self.reader.subject, ..self.reader }
    }

    /// Reports what the content cannot report itself, because it has no location.
    fn placed<T>(reader: Reader<'a>, result: Result<T, Unread>) -> Result<T, Unread> {
        result.map_err(|unread| {
            reader.report_unread(unread);
            Unread::Reported
        })
    }
}

impl<'a> EnumAccess<'a> for Choice<'a> {
    type Error = Unread;
    type Variant = Self;
    fn variant_seed<V: DeserializeSeed<'a>>(self, seed: V) -> Result<(V::Value, Self), Unread> {
        let name: StrDeserializer<Unread> = self.variant.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'a> VariantAccess<'a> for Choice<'a> {
    type Error = Unread;
    fn unit_variant(self) -> Result<(), Unread> {
        match self.node {
            None => Ok(()),
            Some(_) => Err(Unread::Expected(format!("the word `{}` alone", self.variant))),
        }
    }
    fn newtype_variant_seed<T: DeserializeSeed<'a>>(self, seed: T) -> Result<T::Value, Unread> {
        let reader = self.content();
        Self::placed(reader, seed.deserialize(reader))
    }
    fn tuple_variant<V: Visitor<'a>>(self, _: usize, visitor: V) -> Result<V::Value, Unread> {
        let reader = self.content();
        Self::placed(reader, serde::Deserializer::deserialize_seq(reader, visitor))
    }
    fn struct_variant<V: Visitor<'a>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Unread> {
        let reader = self.content();
        Self::placed(reader, reader.fields(fields, visitor))
    }
}
