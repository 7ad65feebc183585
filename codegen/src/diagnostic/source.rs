//! The text of a spec and locations in it.

use super::{Diagnostics, rule};

/// A spec above this size, bytes, is refused before it is parsed: the largest sensible crane takes a thousandth of it.
pub const MAX_BYTES: usize = 4 << 20;

/// Marks the beginning of a part in a source file assembled from several files; the name of the part follows.
const PART: &str = "--- # part: ";

/// Marks the beginning of a data file to which the next part refers.
const DATA: &str = "--- # data: ";

/// A YAML file: its name, for messages, and its text.
///
/// A file that extends others contains all of them, see [`SourceFile::extended`], and the data files that it refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Name shown in messages, usually the path as the user gave it.
    pub name: String,
    /// The text.
    pub text: String,
}

/// What is wrong with the place of a number in a spec, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongPlace {
    /// What is wrong.
    pub title: String,
    /// What to write.
    pub help: String,
}

impl SourceFile {
    /// A source file of the given name and text.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        SourceFile { name: name.into(), text: text.into() }
    }

    /// A source file from bytes as stored on disk.
    ///
    /// # Errors
    /// If there are more than [`MAX_BYTES`], or if they are not UTF-8.
    pub fn from_bytes(name: impl Into<String>, bytes: &[u8]) -> Result<Self, Diagnostics> {
        let name = name.into();
        let refuse = |text: String, mistake| Err(Diagnostics::new(&SourceFile::new(&name, text), vec![mistake]));
        if bytes.len() > MAX_BYTES {
            return refuse(String::new(), rule::too_large(Span::START, bytes.len(), MAX_BYTES));
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(SourceFile::new(name, text)),
            Err(error) => {
                let readable = String::from_utf8_lossy(&bytes[..error.valid_up_to()]).into_owned();
                let at = readable.len();
                refuse(readable, rule::not_utf8(Span { start: at, end: at }, at))
            }
        }
    }

    /// This file as an extension of `base`: both texts, each under a line with the name of its part. The name of this file in
    /// the text is `named`, which must not depend on the machine.
    #[must_use]
    pub fn extended(&self, base: &SourceFile, base_named: &str, named: &str) -> Self {
        SourceFile::new(&self.name, base.as_parts(base_named) + &self.as_parts(named))
    }

    /// This file with the texts of data files that it refers to, each with its name. The name of this file in the text is `named`.
    #[must_use]
    pub fn with_data(self, files: &[(String, String)], named: &str) -> Self {
        if files.is_empty() {
            return self;
        }
        let data: String = files.iter().map(|(name, text)| marked(DATA, name, text)).collect();
        SourceFile::new(&self.name, data + &self.as_parts(named))
    }

    /// The text with the names of all parts; `named` is that of a file that is a single part.
    fn as_parts(&self, named: &str) -> String {
        if self.is_assembled() { self.text.clone() } else { marked(PART, named, &self.text) }
    }

    /// Whether it contains the specs that it extends and its data.
    #[must_use]
    pub fn is_assembled(&self) -> bool {
        self.text.starts_with(PART) || self.text.starts_with(DATA)
    }

    /// Whether a line begins like the marker of a part.
    pub(crate) fn is_marked(&self) -> bool {
        self.text.lines().any(|line| line.starts_with(PART) || line.starts_with(DATA))
    }

    /// The same crane with changes: a spec in memory that extends it.
    #[must_use]
    pub fn changed(&self, changes: &str) -> Self {
        SourceFile::new(&self.name, changes).extended(self, "crane.yaml", "changes.yaml")
    }

    /// Its parts, each of which extends the previous one; usually there is only one, the whole file.
    #[must_use]
    pub fn parts(&self) -> Vec<SourcePart<'_>> {
        self.sections().into_iter().filter(|(marker, _)| *marker == PART).map(|(_, part)| part).collect()
    }

    /// The text of a data file to which the part around a byte refers.
    pub(crate) fn data(&self, name: &str, byte: usize) -> Option<SourcePart<'_>> {
        let sections = self.sections();
        let before = sections.iter().rev().skip_while(|(_, part)| part.start > byte).skip(1);
        let data = before.take_while(|(marker, _)| *marker == DATA).map(|(_, part)| part);
        data.copied().find(|part| part.name == name)
    }

    /// Its parts and the data files that they refer to, with their markers.
    fn sections(&self) -> Vec<(&'static str, SourcePart<'_>)> {
        if !self.is_assembled() {
            return vec![(PART, SourcePart { name: &self.name, start: 0, text: &self.text })];
        }
        let begins_of = |marker: &'static str| self.text.match_indices(marker).map(move |(at, _)| (at, marker));
        let at_line = |&(at, _): &(usize, &str)| at == 0 || self.text[..at].ends_with('\n');
        let mut begins: Vec<(usize, &'static str)> = begins_of(PART).chain(begins_of(DATA)).filter(at_line).collect();
        begins.sort_unstable();
        let ends = begins.iter().skip(1).map(|(at, _)| *at).chain([self.text.len()]);
        let section = |(&(begin, marker), end): (&(usize, &'static str), usize)| {
            let line = self.text[begin..end].find('\n').map_or(end, |length| begin + length);
            let start = end.min(line + 1);
            // The last one is this file, under the name that the user gave it.
            let name = if end == self.text.len() { &self.name } else { self.text[begin + marker.len()..line].trim() };
            (marker, SourcePart { name, start, text: &self.text[start..end] })
        };
        begins.iter().zip(ends).map(section).collect()
    }

    /// The part or data file that contains a byte.
    pub(crate) fn part(&self, byte: usize) -> SourcePart<'_> {
        self.places().part(byte)
    }

    /// Where the file itself begins, after those that it extends.
    pub(crate) fn start(&self) -> Span {
        let start = self.parts().last().map_or(0, |part| part.start);
        Span { start, end: start }
    }

    /// FNV-1a hash of the text, 64 bit, hexadecimal; the same whether lines end in LF or CR LF.
    #[must_use]
    pub fn hash(&self) -> String {
        const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
        const PRIME: u64 = 0x0100_0000_01b3;
        let bytes = self.text.as_bytes();
        let ends_line = |i: usize| bytes[i] == b'\r' && bytes.get(i + 1) == Some(&b'\n');
        let hash = (0..bytes.len())
            .filter(|&i| !ends_line(i))
            .fold(OFFSET_BASIS, |hash, i| (hash ^ u64::from(bytes[i])).wrapping_mul(PRIME));
        format!("{hash:016x}")
    }

    /// Line and column of a byte in its part, both from 1; the column counts characters.
    #[must_use]
    pub fn position(&self, byte: usize) -> (usize, usize) {
        self.places().position(byte)
    }

    /// Its lines and parts, found once.
    pub(crate) fn places(&self) -> Places<'_> {
        let ends = self.text.match_indices('\n').map(|(end, _)| end + 1);
        Places { source: self, lines: std::iter::once(0).chain(ends).collect(), sections: self.sections() }
    }

    /// The line that contains a byte, without its end.
    pub(crate) fn line(&self, byte: usize) -> Span {
        let at = self.boundary(byte);
        let start = self.text[..at].rfind('\n').map_or(0, |i| i + 1);
        let end = self.text[at..].find('\n').map_or(self.text.len(), |i| at + i);
        Span { start, end: start + self.text[start..end].trim_end_matches('\r').len().max(at.min(end) - start) }
    }

    /// The last character boundary up to a byte.
    pub(crate) fn boundary(&self, byte: usize) -> usize {
        let mut at = byte.min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        at
    }
}

/// The lines and parts of a source file, for the positions of many bytes.
pub(crate) struct Places<'a> {
    source: &'a SourceFile,
    /// The first byte of each line.
    lines: Vec<usize>,
    sections: Vec<(&'static str, SourcePart<'a>)>,
}

impl<'a> Places<'a> {
    /// As [`SourceFile::part`].
    pub(crate) fn part(&self, byte: usize) -> SourcePart<'a> {
        let after = self.sections.partition_point(|(_, part)| part.start <= byte);
        let found = self.sections.get(after.saturating_sub(1));
        found.map_or(SourcePart { name: &self.source.name, start: 0, text: &self.source.text }, |(_, part)| *part)
    }

    /// As [`SourceFile::position`].
    pub(crate) fn position(&self, byte: usize) -> (usize, usize) {
        let at = self.source.boundary(byte);
        let line_of = |byte: usize| self.lines.partition_point(|start| *start <= byte).saturating_sub(1);
        let line = line_of(at);
        let first = line_of(self.part(byte).start).min(line);
        (line - first + 1, self.source.text[self.lines[line]..at].chars().count() + 1)
    }
}

/// A text under a line with a marker and its name.
fn marked(marker: &str, name: &str, text: &str) -> String {
    format!("{marker}{name}\n{}\n", text.trim_end_matches(['\n', '\r']))
}

/// A part of a source file: the text of one of the files that it is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourcePart<'a> {
    /// Name shown in messages.
    pub name: &'a str,
    /// Its first byte in the text of the whole.
    pub start: usize,
    /// Its text.
    pub text: &'a str,
}

/// A range of bytes of a source file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// The start of the file, for mistakes of the file as a whole.
    pub const START: Span = Span { start: 0, end: 0 };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv_1a_and_ignores_carriage_returns() {
        // Published test vectors of FNV-1a, 64 bit.
        for (text, hash) in [("", "cbf29ce484222325"), ("a", "af63dc4c8601ec8c"), ("foobar", "85944171f73967e8")] {
            assert_eq!(SourceFile::new("x", text).hash(), hash);
        }
        assert_eq!(SourceFile::new("x", "a\r\nb\r\n").hash(), SourceFile::new("x", "a\nb\n").hash());
    }

    #[test]
    fn parts_keep_their_names_and_lines() {
        let whole = SourceFile::new("dir/mine.yaml", "a: 1\nb: 2\n").extended(
            &SourceFile::new("dir/base.yaml", "c: 3\nd: 4"),
            "base.yaml",
            "mine.yaml",
        );
        let again = SourceFile::new("other.yaml", "e: 5").extended(&whole, "mine.yaml", "other.yaml");
        let parts = again.parts();
        assert_eq!(parts.iter().map(|part| part.name).collect::<Vec<_>>(), ["base.yaml", "mine.yaml", "other.yaml"]);
        assert_eq!(parts.iter().map(|part| part.text).collect::<Vec<_>>(), ["c: 3\nd: 4\n", "a: 1\nb: 2\n", "e: 5\n"]);
        for (word, name, position) in
            [("d:", "base.yaml", (2, 1)), ("2", "mine.yaml", (2, 4)), ("5", "other.yaml", (1, 4))]
        {
            let at = again.text.find(word).expect("the word");
            assert_eq!((again.part(at).name, again.position(at)), (name, position));
        }
        assert_eq!(again.start().start, again.text.find("e:").expect("the last part"));
        // An ordinary file is one part, even if it begins with a YAML document marker.
        let usual = SourceFile::new("x", "--- # a crane\na: 1");
        assert_eq!((usual.parts().len(), usual.start(), usual.position(14)), (1, Span::START, (2, 1)));
    }

    #[test]
    fn positions_count_lines_and_characters() {
        let source = SourceFile::new("x", "äb\r\ncd");
        assert_eq!(source.position(0), (1, 1));
        assert_eq!(source.position(2), (1, 2));
        assert_eq!(source.position(5), (2, 1));
        assert_eq!(source.position(99), (2, 3));
    }
}
