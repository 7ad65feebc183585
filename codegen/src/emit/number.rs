//! The number type of generated code: one number, or eight for eight cranes.

use proc_macro2::TokenStream;
use quote::quote;
use syn::Expr;

use super::arithmetic::{call, literal};

/// The type of all numbers of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// One crane: `f64`.
    Single,
    /// Eight cranes: `f64x8`.
    Lanes,
}

impl Number {
    /// Its type.
    pub fn type_tokens(self) -> TokenStream {
        match self {
            Number::Single => quote!(f64),
            Number::Lanes => quote!(f64x8),
        }
    }

    /// A literal number.
    pub fn literal(self, value: f64) -> Expr {
        match self {
            Number::Single => literal(value),
            Number::Lanes => call("splat", [literal(value)]),
        }
    }
}
