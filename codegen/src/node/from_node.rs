//! Values that read themselves.

use super::reader::{Reader, Unread};
use super::{Content, Form};

/// A value of the spec language.
pub(crate) trait FromNode: Sized {
    /// What may be written for it.
    const FORM: Form;
    /// Whether it may be missing.
    const IS_OPTIONAL: bool = false;
    /// Reads it.
    fn from_node(reader: Reader) -> Result<Self, Unread>;
}

/// The value of a key or an item: reading it reports what is wrong, and goes on.
pub(crate) trait Value: FromNode {
    /// Reads it.
    fn read(reader: Reader) -> Self;
}

impl<T: Value> Value for Option<T> {
    fn read(reader: Reader) -> Self {
        reader.node.is_some().then(|| T::read(reader))
    }
}

impl<T: FromNode> FromNode for Option<T> {
    const FORM: Form = T::FORM;
    const IS_OPTIONAL: bool = true;
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        reader.node.is_some().then(|| T::from_node(reader)).transpose()
    }
}

impl<T: FromNode> FromNode for Box<T> {
    const FORM: Form = T::FORM;
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        T::from_node(reader).map(Box::new)
    }
}

impl<T: Value> Value for Box<T> {
    fn read(reader: Reader) -> Self {
        Box::new(T::read(reader))
    }
}

impl<T: Value> FromNode for Vec<T> {
    const FORM: Form = Form::List { item: &T::FORM, count: None };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        Ok(reader.items()?.into_iter().map(T::read).collect())
    }
}

impl<T: Value, const N: usize> FromNode for [T; N] {
    const FORM: Form = Form::List { item: &T::FORM, count: Some(N) };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        reader.check_length(N)?;
        Vec::from_node(reader)?.try_into().map_err(|_| Unread::Reported)
    }
}

impl FromNode for String {
    const FORM: Form = Form::Text;
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        match reader.content()? {
            Content::Text(text) => Ok(text.clone()),
            _ if reader.subject.key() == "on" => {
                Err(Unread::Expected("the name of a link, or `{link: …, at: …}` with a place on it".into()))
            }
            _ => Err(Unread::Expected("text".into())),
        }
    }
}

impl FromNode for bool {
    const FORM: Form = Form::Flag;
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        match reader.content()? {
            Content::Boolean(flag) => Ok(*flag),
            _ => Err(Unread::Expected("`true` or `false`".into())),
        }
    }
}
