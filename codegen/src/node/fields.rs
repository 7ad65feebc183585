//! Mappings: of known keys, and of the user's names.

use std::collections::BTreeSet;

use super::Key;
use super::reader::{Reader, Subject, Unread, shown};
use super::slips;
use super::tree::{Content, Node};
use crate::diagnostic::{Span, list, nearest, rule, suggest};

/// All keys of a mapping in the order of their declaration, including those that are not given, so that missing required ones are
/// reported.
pub(crate) struct Fields<'a> {
    owner: Reader<'a>,
    keys: &'static [Key],
    given: Vec<Option<(Span, &'a Node)>>,
}

impl<'a> Fields<'a> {
    /// Reads the value of a key.
    pub fn reader(&self, index: usize) -> Reader<'a> {
        let (span, node) = match self.given[index] {
            Some((span, node)) => (span, Some(node)),
            None => (self.owner.span, None),
        };
        let Key { name, measure, .. } = self.keys[index];
        let (subject, owner) = (Subject::Key(name), self.owner.subject);
        Reader { node, span, subject, owner, measure: measure.within(self.owner.measure), ..self.owner }
    }
}

impl<'a> Reader<'a> {
    /// The values of a mapping. Unknown and duplicate keys are reported.
    pub fn fields(self, keys: &'static [Key]) -> Result<Fields<'a>, Unread> {
        let names: Vec<&'static str> = keys.iter().map(|key| key.name).collect();
        let Content::Mapping(entries) = self.content()? else {
            return Err(Unread::Expected(format!("a mapping of {}", list(&names))));
        };
        let mut given = vec![None; names.len()];
        let mut unknown = Vec::new();
        let mut before = None;
        for (key, value) in entries {
            let name = key.key_text();
            match names.iter().position(|field| *field == name) {
                None => {
                    let known =
                        slips::decimals_as_key(before, key, value).or_else(|| slips::removed_key(&name, &names));
                    let meant = nearest(&name, names.iter().copied()).filter(|_| known.is_none());
                    unknown.extend(meant.map(|meant| (meant, key, value)));
                    let help = known.unwrap_or_else(|| suggest(&name, names.iter().copied()));
                    self.report(rule::unknown_key(key.span, name, help));
                }
                Some(field) if given[field].is_some() => {
                    self.report(rule::duplicate_key(key.span, name));
                }
                Some(field) => given[field] = Some((shown(key.span, value), value)),
            }
            before = Some(value);
        }
        // A misspelt key counts as the one that was meant, so that this does not appear to be missing.
        for (meant, key, value) in unknown {
            for (given, _) in given.iter_mut().zip(&names).filter(|(given, name)| **name == meant && given.is_none()) {
                *given = Some((shown(key.span, value), value));
            }
        }
        Ok(Fields { owner: self, keys, given })
    }

    /// Readers of the user's names in a mapping and of their values. The second of two equal names is reported and skipped.
    pub fn entries(self) -> Result<Vec<(Reader<'a>, Reader<'a>)>, Unread> {
        let Content::Mapping(entries) = self.content()? else {
            return Err(Unread::Expected("a mapping of names to values".into()));
        };
        let mut seen = BTreeSet::new();
        let read = |(key, value): &'a (Node, Node)| {
            let name = key.key_text();
            if !seen.insert(name.clone()) {
                self.report(rule::duplicate_key(key.span, name));
                return None;
            }
            let subject = match &key.content {
                Content::Text(text) => Subject::Key(text),
                _ => Subject::Key("the entry"),
            };
            let span = shown(key.span, value);
            Some((
                Reader { node: Some(key), span: key.span, ..self },
                Reader { node: Some(value), span, subject, owner: self.subject, ..self },
            ))
        };
        Ok(entries.iter().filter_map(read).collect())
    }
}
