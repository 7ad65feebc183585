//! Choices: one of several variants, by their words.

use super::fields::Fields;
use super::reader::{Reader, Subject, Unread, shown};
use super::tree::{Content, Node};
use super::{FromNode, Key, Measure};
use crate::diagnostic::{Span, list, nearest, rule, suggest};

/// A chosen variant, and its content.
pub(crate) struct Choice<'a> {
    /// Its place among the variants.
    pub index: usize,
    word: &'static str,
    reader: Reader<'a>,
    node: Option<&'a Node>,
}

impl<'a> Choice<'a> {
    /// Checks that the variant's word stands alone.
    pub fn word(&self) -> Result<(), Unread> {
        match self.node {
            None => Ok(()),
            Some(_) => Err(Unread::Expected(format!("the word `{}` alone", self.word))),
        }
    }

    /// Reads the variant's content.
    pub fn content<T: FromNode>(&self, measure: &'static Measure) -> Result<T, Unread> {
        let reader = self.reader();
        let reader = Reader { measure: measure.within(reader.measure), ..reader };
        T::from_node(reader).map_err(|unread| place(reader, unread))
    }

    /// Reads the variant's content, a mapping.
    pub fn fields(&self, keys: &'static [Key]) -> Result<Fields<'a>, Unread> {
        let reader = self.reader();
        reader.fields(keys).map_err(|unread| place(reader, unread))
    }

    fn reader(&self) -> Reader<'a> {
        let span = self.node.map_or(self.reader.span, |node| shown(self.reader.span, node));
        Reader { node: self.node, span, subject: Subject::Key(self.word), owner: self.reader.subject, ..self.reader }
    }
}

/// Reports what the content cannot report itself, because it has no location.
fn place(reader: Reader, unread: Unread) -> Unread {
    reader.report_unread(unread);
    Unread::Reported
}

impl<'a> Reader<'a> {
    /// The variant that is chosen.
    pub fn choice(self, words: &'static [&'static str]) -> Result<Choice<'a>, Unread> {
        match self.content()? {
            Content::Text(name) if words.contains(&"input") && !words.contains(&name.as_str()) => {
                let choices = list(words);
                let help = format!("write `{{input: {name}}}` for an input, or a mapping of one of {choices}");
                Err(self.report(rule::unknown_choice(self.span, self.subject, name, help)))
            }
            Content::Text(name) => {
                let index = self.variant(name, self.span, words)?;
                Ok(Choice { index, word: words[index], reader: self, node: None })
            }
            Content::Mapping(entries) => {
                // Every key is checked before the first error is returned.
                let choices: Vec<_> = entries
                    .iter()
                    .map(|(key, node)| Ok((key.span, self.variant(&key.key_text(), key.span, words)?, node)))
                    .collect();
                let choices = choices.into_iter().collect::<Result<Vec<_>, Unread>>()?;
                if let [(span, index, node)] = choices[..] {
                    return Ok(Choice { index, word: words[index], reader: Reader { span, ..self }, node: Some(node) });
                }
                let span = choices.get(1).map_or(self.span, |(span, ..)| *span);
                Err(self.report(rule::not_one_choice(span, self.subject, choices.len(), list(words))))
            }
            Content::Sequence(_) if self.subject.key() == "loops" => {
                let choices = list(words);
                Err(Unread::Expected(format!(
                    "one of {choices} for generated code; joints that close loops belong under `loop_joints:`"
                )))
            }
            Content::Number(number) if words.contains(&"hold") => Err(Unread::Expected(format!(
                "`{{hold: {number}}}` for a constant, or a mapping of one of {}",
                list(words)
            ))),
            _ => Err(Unread::Expected(format!("one of {}", list(words)))),
        }
    }

    /// The place of the variant of that name; of a misspelt name, of the variant that was meant, so that nothing else appears to be wrong.
    fn variant(&self, name: &str, span: Span, words: &[&'static str]) -> Result<usize, Unread> {
        let place = |word: &str| words.iter().position(|known| *known == word);
        if let Some(index) = place(name) {
            return Ok(index);
        }
        let offered = || words.iter().copied();
        let unread = self.report(rule::unknown_choice(span, self.subject, name, suggest(name, offered())));
        nearest(name, offered()).and_then(place).ok_or(unread)
    }
}
