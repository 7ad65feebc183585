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

/// The items of a list.
pub(crate) fn read_items<T: FromNode>(reader: Reader) -> Result<Vec<T>, Unread> {
    match reader.content()? {
        Content::Sequence(items) => reader.items(items).map(T::from_node).collect(),
        _ => Err(Unread::Expected("a list".into())),
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

impl<T: FromNode> FromNode for Vec<T> {
    const FORM: Form = Form::List { item: &T::FORM, count: None };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        read_items(reader)
    }
}

impl<T: FromNode, const N: usize> FromNode for [T; N] {
    const FORM: Form = Form::List { item: &T::FORM, count: Some(N) };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        reader.check_length(N)?;
        read_items(reader)?.try_into().map_err(|_| Unread::Reported)
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
