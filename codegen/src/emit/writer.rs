//! State that the parts of the emitter share while they write one function.

use std::collections::BTreeSet;

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, quote};
use syn::{Expr, Ident, Stmt, parse_quote};

use super::labels::Labels;
use super::names::Names;
use super::number::Number;
use super::shape::Storage;
use crate::lower::{LoweredFunction, LoweredProgram};
use crate::program::Argument;
use crate::symbolic::ExprId;

/// Writes one function.
pub struct RustWriter<'a> {
    pub(super) lowered: &'a LoweredProgram<'a>,
    pub(super) code: &'a LoweredFunction<'a>,
    pub(super) storage: Storage<'a>,
    pub(super) labels: &'a Labels<'a>,
    pub(super) number: Number,
}

/// The inputs that a piece reads.
pub type Used = BTreeSet<Argument>;

/// `let name = value;`
pub fn local(name: &str, value: &Expr) -> Stmt {
    let name = Ident::new(name, Span::call_site());
    parse_quote!(let #name = #value;)
}

/// The name of a value, or `_` if it is not needed.
pub fn pattern(id: Option<ExprId>, names: &mut Names) -> TokenStream {
    id.map_or_else(|| quote!(_), |id| Ident::new(&names.name(id), Span::call_site()).into_token_stream())
}
