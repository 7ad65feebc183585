//! Nodes of a YAML file, and how values are read from them.
//!
//! The text becomes a [`tree`] that keeps locations and duplicate keys. A [`Reader`] stands at one of its nodes, or where one is missing; a
//! type that is [`FromNode`] reads itself there, notes every mistake and continues. Types of the language derive it (`codegen/keys`), with
//! their description as a [`Form`].

mod choice;
mod fields;
mod form;
mod from_node;
mod measure;
mod reader;
pub(crate) mod slips;
mod tree;

pub(crate) use crane_keys::FromNode;
pub(crate) use form::{Definition, Form, Key, Variant};
pub(crate) use from_node::{FromNode, Value};
pub(crate) use measure::{Limit, Measure};
pub(crate) use reader::{Reader, Unread};
pub(crate) use tree::{Content, Node, parse};
