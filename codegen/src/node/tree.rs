//! YAML as a tree that keeps every location and every key, including duplicates.

use std::fmt;

use serde_core::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_yaml::{Location, Spanned};

use super::slips;
use crate::diagnostic::{Mistake, Span, rule};

/// A node of the tree.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// Its location; for a list or mapping, its start.
    pub span: Span,
    /// Its content.
    pub content: Content,
}

/// Content of a node.
#[derive(Clone, Debug)]
pub(crate) enum Content {
    /// An empty value, `null` or `~`.
    Null,
    /// `true` or `false`.
    Boolean(bool),
    /// A number, including NaN and infinities, which validation refuses explicitly.
    Number(f64),
    /// Any other scalar.
    Text(String),
    /// A list.
    Sequence(Vec<Node>),
    /// Keys and values in the order of the file.
    Mapping(Vec<(Node, Node)>),
}

impl Node {
    /// The text of a key, whatever its type.
    pub fn key_text(&self) -> String {
        match &self.content {
            Content::Text(text) => text.clone(),
            Content::Number(number) => number.to_string(),
            Content::Boolean(boolean) => boolean.to_string(),
            Content::Null => "null".into(),
            Content::Sequence(_) | Content::Mapping(_) => "? ...".into(),
        }
    }
}

/// Maximum nesting depth: no spec is nested this deeply, and recursion over the tree is still safe.
const MAX_DEPTH: usize = 24;
/// Twice the number of values of a crane with the maximum number of joints; aliases may not multiply them beyond this.
const MAX_NODES: usize = 1 << 17;

/// Parses YAML.
pub(crate) fn parse(text: &str) -> Result<Node, Mistake> {
    let budget = serde_yaml::budget! {
        max_depth: MAX_DEPTH,
        flow_nesting_limit: MAX_DEPTH,
        max_nodes: MAX_NODES,
        max_events: 4 * MAX_NODES,
    };
    let options = serde_yaml::options! {
        budget: budget,
        duplicate_keys: serde_yaml::DuplicateKeyPolicy::LastWins,
        merge_keys: serde_yaml::MergeKeyPolicy::AsOrdinary,
        non_finite_float_policy: serde_yaml::NonFiniteFloatPolicy::PassThrough,
        strict_booleans: true,
        legacy_octal_numbers: false,
        with_snippet: false,
    };
    let root: Spanned<Content> = serde_yaml::from_str_with_options(text, options).map_err(|error| {
        let span = error.location().map_or(Span::START, |location| span(text, &location));
        match text.trim_matches(|c: char| c.is_whitespace() || c == '\u{feff}') {
            "" => rule::empty(Span::START),
            _ if too_many(&error) => rule::too_many_values(span, MAX_NODES),
            _ => slips::not_yaml(text, span, &problem(&error)),
        }
    })?;
    let root = Node::from(root);
    match root.content {
        Content::Null => Err(rule::empty(Span::START)),
        Content::Mapping(_) => Ok(root),
        content => Err(rule::not_a_mapping(root.span, content.describe())),
    }
}

/// Whether the parser stopped because of the number of values, with aliases resolved.
fn too_many(error: &serde_yaml::Error) -> bool {
    use serde_yaml::{Error, budget::BudgetBreach};
    match error.without_snippet() {
        Error::Budget { breach, .. } => !matches!(breach, BudgetBreach::Depth { .. }),
        Error::AliasReplayLimitExceeded { .. } => true,
        Error::AliasError { error, .. } => too_many(error),
        _ => false,
    }
}

/// The parser's message without the location, which the source excerpt shows, and without advice on how to call the parser.
fn problem(error: &serde_yaml::Error) -> String {
    if matches!(error.without_snippet(), serde_yaml::Error::MultipleDocuments { .. }) {
        return "it contains several documents".into();
    }
    let message = error.without_snippet().to_string();
    let first = message.lines().next().unwrap_or_default();
    let end = first.find(" at line ").or_else(|| first.find(" (line ")).unwrap_or(first.len());
    first[..end].to_owned()
}

/// The byte range of a location. The parser counts bytes for values, but only lines and columns for its own errors.
fn span(text: &str, location: &Location) -> Span {
    let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
    let span = location.span();
    if let (Some(start), Some(length)) = (span.byte_offset(), span.byte_len()) {
        return Span { start: count(start), end: count(start).saturating_add(count(length)) };
    }
    let line: usize = text.split_inclusive('\n').take(count(location.line()).saturating_sub(1)).map(str::len).sum();
    let before = text[line..].chars().take(count(location.column()).saturating_sub(1));
    let start = line + before.take_while(|c| *c != '\n').map(char::len_utf8).sum::<usize>();
    Span { start, end: start }
}

impl From<Spanned<Content>> for Node {
    fn from(spanned: Spanned<Content>) -> Self {
        Node { span: span("", &spanned.defined), content: spanned.value }
    }
}

impl Content {
    /// Its kind, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Content::Null => "nothing",
            Content::Boolean(_) => "true or false",
            Content::Number(_) => "a number",
            Content::Text(_) => "text",
            Content::Sequence(_) => "a list",
            Content::Mapping(_) => "a mapping",
        }
    }

    /// Its text, for messages.
    pub fn describe(&self) -> String {
        match self {
            Content::Null => "left empty".into(),
            Content::Boolean(boolean) => format!("`{boolean}`"),
            Content::Number(number) => format!("`{number}`"),
            Content::Text(text) => format!("`{}`", abridged(text)),
            Content::Sequence(_) | Content::Mapping(_) => self.kind().into(),
        }
    }
}

/// The start of a text, for messages.
fn abridged(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

impl<'de> Deserialize<'de> for Content {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ContentVisitor)
    }
}

struct ContentVisitor;

impl<'de> Visitor<'de> for ContentVisitor {
    type Value = Content;
    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("YAML")
    }
    fn visit_unit<E>(self) -> Result<Content, E> {
        Ok(Content::Null)
    }
    fn visit_none<E>(self) -> Result<Content, E> {
        Ok(Content::Null)
    }
    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Content, D::Error> {
        Content::deserialize(deserializer)
    }
    fn visit_bool<E>(self, boolean: bool) -> Result<Content, E> {
        Ok(Content::Boolean(boolean))
    }
    fn visit_i64<E>(self, number: i64) -> Result<Content, E> {
        Ok(Content::Number(number as f64))
    }
    fn visit_u64<E>(self, number: u64) -> Result<Content, E> {
        Ok(Content::Number(number as f64))
    }
    fn visit_i128<E>(self, number: i128) -> Result<Content, E> {
        Ok(Content::Number(number as f64))
    }
    fn visit_u128<E>(self, number: u128) -> Result<Content, E> {
        Ok(Content::Number(number as f64))
    }
    fn visit_f64<E>(self, number: f64) -> Result<Content, E> {
        Ok(Content::Number(number))
    }
    fn visit_str<E>(self, text: &str) -> Result<Content, E> {
        Ok(Content::Text(text.to_owned()))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Content, A::Error> {
        let mut sequence = Vec::new();
        while let Some(item) = items.next_element::<Spanned<Content>>()? {
            sequence.push(Node::from(item));
        }
        Ok(Content::Sequence(sequence))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Content, A::Error> {
        let mut mapping = Vec::new();
        while let Some((key, value)) = entries.next_entry::<Spanned<Content>, Spanned<Content>>()? {
            mapping.push((Node::from(key), Node::from(value)));
        }
        Ok(Content::Mapping(mapping))
    }
}
