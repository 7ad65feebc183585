//! Mistakes of a spec and warnings about it: what is wrong, where, and what to write instead; all of a file at once.

mod catalogue;
mod definition;
mod draw;
mod nearest;
mod source;

pub(crate) use catalogue::rule;
pub use catalogue::{CATALOGUE, code};
pub use definition::Rule;
pub(crate) use definition::{catalogue, is_one_line, printable, quoted};
pub(crate) use nearest::{list, suggest};
pub use nearest::{nearest, similar};
pub use source::{MAX_BYTES, SourceFile, SourcePart, Span, WrongPlace};

use std::fmt;

/// One mistake, or one warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// Code of the rule it breaks, such as `E031`.
    pub code: &'static str,
    /// Its location, bytes of the source.
    pub span: Span,
    /// What is wrong, in the user's own names.
    pub title: String,
    /// Why, under the offending words.
    pub label: String,
    /// What to write instead.
    pub help: String,
}

impl Mistake {
    /// Against the rule of a code, with title, label and help.
    pub(crate) fn new(code: &'static str, span: Span, texts: [fmt::Arguments<'_>; 3]) -> Self {
        let [title, label, help] = texts.map(|text| printable(&text.to_string()));
        Mistake { code, span, title, label, help }
    }

    /// Whether the crane is compiled nevertheless.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        self.code.starts_with('W')
    }
}

/// A mistake or a warning with its place.
#[derive(Clone, Copy, Debug)]
pub struct Located<'a> {
    /// What is wrong.
    pub mistake: &'a Mistake,
    /// The file.
    pub file: &'a str,
    /// Line and column of the first character, from 1.
    pub start: (usize, usize),
    /// Line and column one past the last character.
    pub end: (usize, usize),
}

/// All mistakes of one file, or all warnings about a file without mistakes, in the order of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    source: SourceFile,
    mistakes: Vec<Mistake>,
}

impl Diagnostics {
    /// The mistakes found in a source file.
    pub(crate) fn new(source: &SourceFile, mut mistakes: Vec<Mistake>) -> Self {
        // A mistake of the file as a whole is reported for this file, not for those that it extends.
        for mistake in mistakes.iter_mut().filter(|mistake| mistake.span == Span::START) {
            mistake.span = source.start();
        }
        mistakes.sort_by_key(|m| (m.span.start, m.code));
        // A number that is used twice is reported once.
        mistakes.dedup();
        Diagnostics { source: source.clone(), mistakes }
    }

    /// The mistakes or warnings, in the order of the file.
    #[must_use]
    pub fn mistakes(&self) -> &[Mistake] {
        &self.mistakes
    }

    /// Whether nothing was found.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.mistakes.is_empty()
    }

    /// The mistakes or warnings that `others` does not contain.
    #[must_use]
    pub fn without(mut self, others: &Diagnostics) -> Self {
        self.mistakes.retain(|mistake| !others.mistakes.contains(mistake));
        self
    }

    /// Each mistake or warning with its place.
    pub fn located(&self) -> impl Iterator<Item = Located<'_>> {
        let places = self.source.places();
        self.mistakes.iter().map(move |mistake| Located {
            mistake,
            file: places.part(mistake.span.start).name,
            start: places.position(mistake.span.start),
            end: places.position(mistake.span.end.max(mistake.span.start)),
        })
    }

    /// Each mistake or warning in one line, for short displays: `crane.yaml:3:5: unknown key `masss` [E010]`.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        self.located().map(|Located { mistake, file, start: (line, column), .. }| {
            format!("{file}:{line}:{column}: {} [{}]", mistake.title, mistake.code)
        })
    }

    /// All of them as printed, with the colours of a terminal.
    #[must_use]
    pub fn coloured(&self) -> String {
        let mut text = String::new();
        // Writing into a string does not fail.
        let _ = draw::draw(&self.source, &self.mistakes, true, &mut text);
        text
    }

    /// All of them in one line, for short displays: `crane.yaml:3:5: unknown key `masss` [E010] (and 2 more)`.
    #[must_use]
    pub fn headline(&self) -> String {
        let Some(first) = self.lines().next() else { return format!("{}: no mistakes", self.source.name) };
        match self.mistakes.len() - 1 {
            0 => first,
            n => format!("{first} (and {n} more)"),
        }
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        draw::draw(&self.source, &self.mistakes, false, f)
    }
}

impl std::error::Error for Diagnostics {}
