//! The context of a value in the file: its location and its form.

use crate::diagnostic::Span;
use crate::node::{Content, Form, FromNode, Reader, Unread, Value};

/// A value and its location. Reading it never fails, so that its neighbours are read as well: a value that is missing or
/// wrong is reported while reading, and is `None` here.
#[derive(Clone, Debug)]
pub struct Spanned<T> {
    /// The value, unless a mistake was reported.
    pub value: Option<T>,
    /// Its location, or the location where it should be.
    pub span: Span,
}

impl<T: FromNode> FromNode for Spanned<T> {
    const FORM: Form = T::FORM;
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        Ok(Self::read(reader))
    }
}

impl<T: FromNode> Value for Spanned<T> {
    fn read(reader: Reader) -> Self {
        let value = T::from_node(reader).map_err(|unread| reader.report_unread(unread)).ok();
        Spanned { value, span: reader.span }
    }
}

/// A mapping from user-defined names, in the order of the file.
#[derive(Clone, Debug)]
pub struct Entries<T>(pub Vec<(Spanned<String>, Spanned<T>)>);

impl<T: FromNode> FromNode for Entries<T> {
    const FORM: Form = Form::Entries { value: &T::FORM };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        let entries = reader.entries()?.into_iter();
        Ok(Entries(entries.map(|(name, value)| (Spanned::read(name), Spanned::read(value))).collect()))
    }
}

/// A short form `A`, or the full form `B`, which is a mapping.
#[derive(Clone, Debug)]
pub enum Either<A, B> {
    /// Anything but a mapping.
    Short(A),
    /// A mapping.
    Full(B),
}

impl<A: FromNode, B: FromNode> FromNode for Either<A, B> {
    const FORM: Form = Form::AnyOf { forms: &[A::FORM, B::FORM] };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        match reader.content()? {
            Content::Mapping(_) => B::from_node(reader).map(Either::Full),
            _ => A::from_node(reader).map(Either::Short),
        }
    }
}

/// One item, or a list of them.
#[derive(Clone, Debug)]
pub struct Many<T>(pub Vec<Spanned<T>>);

impl<T: FromNode> FromNode for Many<T> {
    const FORM: Form = Form::AnyOf { forms: &[T::FORM, Form::List { item: &T::FORM, count: None }] };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        match (reader.content()?, reader.node) {
            (Content::Sequence(_), _) | (_, None) => Vec::from_node(reader).map(Many),
            (_, Some(item)) => Ok(Many(vec![Spanned::read(reader.item(0, item))])),
        }
    }
}

/// The entries of a list that could be read; none if it is not given.
pub fn entries<T>(list: Option<&Spanned<Vec<Spanned<T>>>>) -> impl Iterator<Item = &T> {
    list.and_then(|list| list.value.as_deref()).unwrap_or_default().iter().filter_map(|entry| entry.value.as_ref())
}
