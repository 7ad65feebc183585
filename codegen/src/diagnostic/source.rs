//! The text of a spec and locations in it.

use super::{Diagnostics, rule};

/// A spec above this size is refused before it is parsed, bytes: the largest sensible crane is a thousandth of it.
pub const MAX_BYTES: usize = 4 << 20;

/// A YAML file: its name, for messages, and its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Name shown in messages, usually the path as the user gave it.
    pub name: String,
    /// The text.
    pub text: String,
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

    /// Line and column of a byte, both from 1; the column counts characters.
    #[must_use]
    pub fn position(&self, byte: usize) -> (usize, usize) {
        let line = self.line(byte);
        let number = self.text[..line.start].matches('\n').count() + 1;
        (number, self.text[line.start..self.boundary(byte)].chars().count() + 1)
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
    fn positions_count_lines_and_characters() {
        let source = SourceFile::new("x", "äb\r\ncd");
        assert_eq!(source.position(0), (1, 1));
        assert_eq!(source.position(2), (1, 2));
        assert_eq!(source.position(5), (2, 1));
        assert_eq!(source.position(99), (2, 3));
    }
}
