//! Numbers of a spec by their places, `links.boom.beam.section.box.height`: keys, names of entries of lists, and indices from 0.

use super::Change;
use crate::diagnostic::{Span, WrongPlace, suggest};
use crate::node::{Content, Node};
use crate::spec::CraneSpec;
use crate::units::Quantity;

/// A top-level key with what to lay over it, and the number that this replaces.
type Replaced<'a> = (Option<(&'a str, Change)>, Change);

impl CraneSpec {
    /// The change by which a live parameter of the same value, whose description is the place, replaces the number at a place.
    ///
    /// # Errors
    /// There is no number at this place.
    pub fn live_number(&self, place: &str, parameter: &str, unit: &str) -> Result<Change, WrongPlace> {
        let (change, value) = self.replaced_at(place, &parameter.into())?;
        let entry = Change::keys([("value", value), ("unit", unit.into()), ("about", place.into())]);
        let parameters = ("parameters", Change::keys([(parameter, entry)]));
        Ok(Change::keys([parameters].into_iter().chain(change)))
    }

    /// The number at a place, in SI units.
    ///
    /// # Errors
    /// There is no number at this place.
    pub fn number_at(&self, place: &str) -> Result<f64, WrongPlace> {
        match self.replaced_at(place, &0.0.into())?.1.0.content {
            Content::Number(number) => Ok(number),
            Content::Text(text) => quantity(&text).ok_or_else(|| not_a_number(place)),
            _ => Err(not_a_number(place)),
        }
    }

    /// The change by which another number stands at a place.
    ///
    /// # Errors
    /// There is no number at this place.
    pub fn other_number(&self, place: &str, value: f64) -> Result<Change, WrongPlace> {
        Ok(Change::keys(self.replaced_at(place, &value.into())?.0))
    }

    /// The location of the value at a place; `None` if there is none.
    #[must_use]
    pub(crate) fn span_at(&self, place: &str) -> Option<Span> {
        let mut node = &self.tree;
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

    /// The key with the change to lay over it so that a word stands in place of a number, and that number.
    fn replaced_at<'a>(&self, place: &'a str, word: &Change) -> Result<Replaced<'a>, WrongPlace> {
        let (key, rest) = place.split_once('.').unwrap_or((place, ""));
        if key == "parameters" {
            let name = rest.split('.').next().unwrap_or_default();
            return Err(WrongPlace {
                title: format!("`{place}` is a live parameter"),
                help: format!("write its name, `{name}`"),
            });
        }
        let keys: Vec<&str> = place.split('.').collect();
        let mut value = Change::removed();
        let change = overlay(&self.tree, &keys, place, word, &mut value)?;
        let Content::Mapping(entries) = change.0.content else { return Err(not_a_number(place)) };
        Ok((entries.into_iter().next().map(|(_, inner)| (key, Change(inner))), value))
    }
}

/// The change to lay over a node so that a word, such as the name of a parameter, replaces the number at the place; `value` becomes the number.
fn overlay(node: &Node, keys: &[&str], place: &str, word: &Change, value: &mut Change) -> Result<Change, WrongPlace> {
    let Some((key, rest)) = keys.split_first() else {
        *value = number(node, place)?;
        return Ok(word.clone());
    };
    match &node.content {
        Content::Mapping(entries) => {
            let known: Vec<String> = entries.iter().map(|(key, _)| key.key_text()).collect();
            let inner = node.entry(key).ok_or_else(|| missing(place, key, &known))?;
            Ok(Change::keys([(key, overlay(inner, rest, place, word, value)?)]))
        }
        Content::Sequence(items) => {
            let names: Vec<Option<String>> = items.iter().map(Node::identity).collect();
            if let Some(index) = names.iter().position(|name| name.as_deref() == Some(*key)) {
                let mut inner = overlay(&items[index], rest, place, word, value)?;
                // The number itself is not an entry of a list with names.
                let Content::Mapping(entries) = &mut inner.0.content else { return Err(not_a_number(place)) };
                entries.insert(0, (Change::from(items[index].identity_key()).0, Change::from(*key).0));
                return Ok(Change::list([inner]));
            }
            let chosen: Option<usize> = key.parse().ok().filter(|index| *index < items.len());
            let Some(chosen) = chosen else {
                let known: Vec<String> = names.into_iter().flatten().collect();
                return Err(missing(place, key, &known));
            };
            let mut all: Vec<Change> = items.iter().cloned().map(Change).collect();
            all[chosen] = replaced(&items[chosen], rest, place, word, value)?;
            Ok(Change::list(all))
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
fn replaced(node: &Node, keys: &[&str], place: &str, word: &Change, value: &mut Change) -> Result<Change, WrongPlace> {
    let (Content::Mapping(entries), [key, rest @ ..]) = (&node.content, keys) else {
        return overlay(node, keys, place, word, value);
    };
    let known: Vec<String> = entries.iter().map(|(key, _)| key.key_text()).collect();
    let chosen = known.iter().position(|known| known == key).ok_or_else(|| missing(place, key, &known))?;
    let mut all = entries.clone();
    all[chosen].1 = replaced(&entries[chosen].1, rest, place, word, value)?.0;
    Ok(Content::Mapping(all).into())
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
            let entry = |(key, value): &(Node, Node)| format!("{}: {}", key_written(key), written(value));
            format!("{{{}}}", entries.iter().map(entry).collect::<Vec<_>>().join(", "))
        }
    }
}

/// A key as YAML.
pub(super) fn key_written(key: &Node) -> String {
    if matches!(key.content, Content::Text(_)) { written(key) } else { key.key_text() }
}

/// A number, or a text such as `30 deg`, which parameters may have too.
fn number(node: &Node, place: &str) -> Result<Change, WrongPlace> {
    match &node.content {
        Content::Number(_) => Ok(Change(node.clone())),
        Content::Text(text) if quantity(text).is_some() => Ok(Change(node.clone())),
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
