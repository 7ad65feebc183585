//! Text and lists of a description: constants of generated code, or owned by a crane that is made at run time.
//!
//! Constants need neither heap nor `std`. Owned data are reference-counted: a clone is another pointer; dropping the last one
//! frees them.

use core::{fmt, ops::Deref};

#[cfg(feature = "std")]
use std::sync::Arc;

/// Text of a description; it dereferences to `str`.
#[derive(Clone)]
pub enum Text {
    /// A constant of the program.
    Static(&'static str),
    /// Text made at run time.
    #[cfg(feature = "std")]
    Owned(Arc<str>),
}

/// A list of a description; it dereferences to a slice.
#[derive(Clone)]
pub enum List<T: 'static> {
    /// A constant of the program.
    Static(&'static [T]),
    /// A list made at run time.
    #[cfg(feature = "std")]
    Owned(Arc<[T]>),
}

impl Text {
    /// The text.
    pub fn as_str(&self) -> &str {
        self
    }
}

impl<T> List<T> {
    /// The list.
    pub fn as_slice(&self) -> &[T] {
        self
    }
}

impl Deref for Text {
    type Target = str;

    fn deref(&self) -> &str {
        match self {
            Text::Static(text) => text,
            #[cfg(feature = "std")]
            Text::Owned(text) => text,
        }
    }
}

impl<T> Deref for List<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match self {
            List::Static(list) => list,
            #[cfg(feature = "std")]
            List::Owned(list) => list,
        }
    }
}

impl From<&'static str> for Text {
    fn from(text: &'static str) -> Self {
        Text::Static(text)
    }
}

impl<T> From<&'static [T]> for List<T> {
    fn from(list: &'static [T]) -> Self {
        List::Static(list)
    }
}

#[cfg(feature = "std")]
impl From<String> for Text {
    fn from(text: String) -> Self {
        Text::Owned(text.into())
    }
}

#[cfg(feature = "std")]
impl<T> From<Vec<T>> for List<T> {
    fn from(list: Vec<T>) -> Self {
        List::Owned(list.into())
    }
}

#[cfg(feature = "std")]
impl<T> FromIterator<T> for List<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        List::Owned(items.into_iter().collect())
    }
}

impl<'a, T> IntoIterator for &'a List<T> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl AsRef<str> for Text {
    fn as_ref(&self) -> &str {
        self
    }
}

/// Needed by `[Text]::join`.
impl core::borrow::Borrow<str> for Text {
    fn borrow(&self) -> &str {
        self
    }
}

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self.as_str(), f)
    }
}

impl fmt::Debug for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = self.as_str();
        if f.alternate() { write!(f, "Text::Static({text:?})") } else { fmt::Debug::fmt(text, f) }
    }
}

impl<T: fmt::Debug> fmt::Debug for List<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = self.as_slice();
        if f.alternate() { write!(f, "List::Static(&{list:#?})") } else { fmt::Debug::fmt(list, f) }
    }
}

impl PartialEq for Text {
    fn eq(&self, other: &Self) -> bool {
        self.as_str() == other.as_str()
    }
}

impl Eq for Text {}

impl PartialEq<str> for Text {
    fn eq(&self, other: &str) -> bool {
        self.as_str() == other
    }
}

impl PartialEq<&str> for Text {
    fn eq(&self, other: &&str) -> bool {
        self.as_str() == *other
    }
}

impl PartialOrd for Text {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Text {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.as_str().cmp(other)
    }
}

impl core::hash::Hash for Text {
    fn hash<H: core::hash::Hasher>(&self, state: &mut H) {
        self.as_str().hash(state);
    }
}

impl<T: PartialEq> PartialEq for List<T> {
    fn eq(&self, other: &Self) -> bool {
        self.as_slice() == other.as_slice()
    }
}

impl<T: Eq> Eq for List<T> {}
