//! Numbers of a spec by their places, `links.boom.beam.section.box.height`: keys, names of entries of lists, and indices from 0.

use std::fmt::Write as _;

use super::overlay::Noticed;
use super::parts;
use crate::diagnostic::{SourceFile, Span, WrongPlace, suggest};
use crate::node::{Content, Node};
use crate::units::Quantity;

impl SourceFile {
    /// The same crane with a number at a place replaced by a live parameter of the same value, whose description is the place.
    ///
    /// # Errors
    /// There is no number at this place.
    pub fn with_live_number(&self, place: &str, parameter: &str, unit: &str) -> Result<Self, WrongPlace> {
        let (changed, value) = self.replaced_at(place, parameter)?;
        let entry = format!("{parameter}: {{value: {value}, unit: {unit:?}, about: {place:?}}}");
        Ok(self.changed(&format!("parameters: {{{entry}}}\n{}\n", &changed[1..changed.len() - 1])))
    }

    /// The number at a place, in SI units.
    ///
    /// # Errors
    /// There is no number at this place.
    pub fn number_at(&self, place: &str) -> Result<f64, WrongPlace> {
        let (_, value) = self.replaced_at(place, "0")?;
        value.parse().ok().or_else(|| quantity(&value)).ok_or_else(|| not_a_number(place))
    }

    /// The same crane with another number at a place.
    ///
    /// # Errors
    /// There is no number at this place.
    pub fn with_number(&self, place: &str, value: f64) -> Result<Self, WrongPlace> {
        let (changed, _) = self.replaced_at(place, &format!("{value:?}"))?;
        Ok(self.changed(&format!("{}\n", &changed[1..changed.len() - 1])))
    }

    /// The location of the value at a place; `None` if there is none.
    #[must_use]
    pub(crate) fn span_at(&self, place: &str) -> Option<Span> {
        let root = parts(self, &mut Noticed::default()).ok()?;
        let mut node = &root;
        for key in place.split('.') {
            node = match &node.content {
                Content::Sequence(items) => {
                    let named = items.iter().find(|item| item.identity().as_deref() == Some(key));
                    named.or_else(|| items.get(key.parse::<usize>().ok()?))?
                }
                _ => node.entry(key)?,
            };
        }
        Some(node.span)
    }

    /// The changes to lay over the spec so that a word stands in place of a number, and that number.
    fn replaced_at(&self, place: &str, word: &str) -> Result<(String, String), WrongPlace> {
        let root = parts(self, &mut Noticed::default()).map_err(|_| WrongPlace {
            title: format!("{} cannot be read", self.name),
            help: "check it with `crane check`".to_owned(),
        })?;
        let keys: Vec<&str> = place.split('.').collect();
        if keys[0] == "parameters" {
            let name = keys.get(1).copied().unwrap_or_default();
            return Err(WrongPlace {
                title: format!("`{place}` is a live parameter"),
                help: format!("write its name, `{name}`"),
            });
        }
        let mut value = String::new();
        let changed = overlay(&root, &keys, place, word, &mut value)?;
        Ok((changed, value))
    }
}

/// The changes to lay over a node so that a word, such as the name of a parameter, replaces the number at the place; `value` becomes the number.
fn overlay(node: &Node, keys: &[&str], place: &str, word: &str, value: &mut String) -> Result<String, WrongPlace> {
    let Some((key, rest)) = keys.split_first() else {
        *value = number(node, place)?;
        return Ok(word.to_owned());
    };
    match &node.content {
        Content::Mapping(entries) => {
            let known: Vec<String> = entries.iter().map(|(key, _)| key.key_text()).collect();
            let inner = node.entry(key).ok_or_else(|| missing(place, key, &known))?;
            Ok(format!("{{{key}: {}}}", overlay(inner, rest, place, word, value)?))
        }
        Content::Sequence(items) => {
            let names: Vec<Option<String>> = items.iter().map(Node::identity).collect();
            if let Some(index) = names.iter().position(|name| name.as_deref() == Some(*key)) {
                let inner = overlay(&items[index], rest, place, word, value)?;
                let identity = items[index].identity_key();
                // The number itself is not an entry of a list with names.
                return match inner.strip_prefix('{') {
                    Some(inner) => Ok(format!("[{{{identity}: {key}, {inner}]")),
                    None => Err(not_a_number(place)),
                };
            }
            let chosen: Option<usize> = key.parse().ok().filter(|index| *index < items.len());
            let Some(chosen) = chosen else {
                let known: Vec<String> = names.into_iter().flatten().collect();
                return Err(missing(place, key, &known));
            };
            let mut all = Vec::new();
            for (index, item) in items.iter().enumerate() {
                all.push(if index == chosen { replaced(item, rest, place, word, value)? } else { written(item) });
            }
            Ok(format!("[{}]", all.join(", ")))
        }
        Content::Text(text) if quantity(text).is_none() => Err(not_there(place, keys, text)),
        _ => Err(not_a_number(place)),
    }
}

/// There is a name where a place goes on.
fn not_there(place: &str, keys: &[&str], name: &str) -> WrongPlace {
    let rest = keys.join(".");
    let before = place.strip_suffix(&rest).unwrap_or(place).trim_end_matches('.');
    let help = if before.ends_with("material") {
        format!("give the place of its entry, `materials.{name}.{rest}`")
    } else {
        "give the place of one number, as in `links.boom.beam.section.box.height`".to_owned()
    };
    WrongPlace { title: format!("`{before}` is `{name}`: there is nothing at `{place}`"), help }
}

/// The number of a text with a unit, in SI units.
fn quantity(text: &str) -> Option<f64> {
    Some(Quantity::parse(text)?.ok()?.value)
}

/// A whole node with the number at the place replaced, where a list without names cannot be laid over.
fn replaced(node: &Node, keys: &[&str], place: &str, word: &str, value: &mut String) -> Result<String, WrongPlace> {
    match (&node.content, keys) {
        (Content::Mapping(entries), [key, rest @ ..]) => {
            let known: Vec<String> = entries.iter().map(|(key, _)| key.key_text()).collect();
            node.entry(key).ok_or_else(|| missing(place, key, &known))?;
            let mut all = Vec::new();
            for (own, inner) in entries {
                let own = own.key_text();
                let text = if own == *key { replaced(inner, rest, place, word, value)? } else { written(inner) };
                all.push(format!("{own}: {text}"));
            }
            Ok(format!("{{{}}}", all.join(", ")))
        }
        _ => overlay(node, keys, place, word, value),
    }
}

/// Whether a text is a word that needs no quotes.
fn is_plain(text: &str) -> bool {
    let others = ["true", "false", "null", "yes", "no", "on", "off", "y", "n", "nan", "inf"];
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !others.contains(&text.to_lowercase().as_str())
}

/// A node as YAML on one line.
pub(super) fn written(node: &Node) -> String {
    match &node.content {
        Content::Null => "~".to_owned(),
        Content::Boolean(boolean) => boolean.to_string(),
        Content::Number(number) => format!("{number:?}"),
        Content::Text(text) if is_plain(text) => text.clone(),
        Content::Text(text) => format!("'{}'", text.replace('\'', "''")),
        Content::Sequence(items) => format!("[{}]", items.iter().map(written).collect::<Vec<_>>().join(", ")),
        Content::Mapping(entries) => {
            let mut text = String::new();
            for (index, (key, value)) in entries.iter().enumerate() {
                let comma = if index > 0 { ", " } else { "" };
                let _ = write!(text, "{comma}{}: {}", key.key_text(), written(value));
            }
            format!("{{{text}}}")
        }
    }
}

/// A number, or a text such as `30 deg`, which parameters may have too.
fn number(node: &Node, place: &str) -> Result<String, WrongPlace> {
    match &node.content {
        Content::Number(_) => Ok(written(node)),
        Content::Text(text) if quantity(text).is_some() => Ok(text.clone()),
        Content::Text(text) if text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') => Err(WrongPlace {
            title: format!("`{place}` is `{text}`, not a number"),
            help: "if this is a live parameter, write its name; if it is an entry of `materials`, give the place of its number there"
                .to_owned(),
        }),
        _ => Err(not_a_number(place)),
    }
}

fn not_a_number(place: &str) -> WrongPlace {
    WrongPlace {
        title: format!("`{place}` is not a number"),
        help: "give the place of one number, as in `links.boom.beam.section.box.height` or `supports.left.stiffness.2`"
            .to_owned(),
    }
}

fn missing(place: &str, key: &str, known: &[String]) -> WrongPlace {
    let help = suggest(key, known.iter().map(String::as_str));
    WrongPlace { title: format!("`{place}`: there is no `{key}`"), help }
}
