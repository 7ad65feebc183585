//! `#[derive(FromNode)]` for the types of the spec language, in `crane-codegen`.
//!
//! From the fields and variants of a type follow how it is read, in code that is not generic, and its description: keys, documentation,
//! which of them are required. A struct is a mapping of its fields. An enum is one of its variants: the word of a variant without content,
//! or a mapping with the word of the variant as its key. Words of variants are in `snake_case`.
//!
//! `#[key(unit = "N/m", limit = Positive, usual = 1e3..1e13)]` says what the numbers of a field measure, of a type those of all its fields, and
//! `#[key("E", …)]` names a field otherwise.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{
    Attribute, Data, DeriveInput, Error, Expr, ExprLit, ExprRange, Fields, FieldsNamed, Ident, Lit, LitStr, Meta,
    Result, Token, parse_macro_input,
};

/// What `#[key(…)]` says.
#[derive(Clone, Default)]
struct KeyRow {
    name: Option<String>,
    unit: Option<LitStr>,
    limit: Option<Expr>,
    usual: Option<ExprRange>,
}

impl KeyRow {
    /// The row among attributes; its unit and limit are those of the whole type where it has none.
    fn among(attributes: &[Attribute], whole: &KeyRow) -> Result<Self> {
        let mut row = KeyRow::default();
        for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("key")) {
            attribute.parse_args_with(|input: syn::parse::ParseStream| {
                while !input.is_empty() {
                    if input.peek(LitStr) {
                        row.name = Some(input.parse::<LitStr>()?.value());
                    } else {
                        let word: Ident = input.parse()?;
                        input.parse::<Token![=]>()?;
                        match word.to_string().as_str() {
                            "unit" => row.unit = Some(input.parse()?),
                            "limit" => row.limit = Some(input.parse()?),
                            "usual" => row.usual = Some(input.parse()?),
                            _ => return Err(Error::new_spanned(word, "a row has `unit`, `limit` and `usual`")),
                        }
                    }
                    if !input.is_empty() {
                        input.parse::<Token![,]>()?;
                    }
                }
                Ok(())
            })?;
        }
        Ok(if row.unit.is_none() { KeyRow { name: row.name, ..whole.clone() } } else { row })
    }

    /// What its numbers measure; without a unit, this.
    fn measure(&self, otherwise: &str) -> TokenStream {
        let Some(unit) = &self.unit else {
            let otherwise = Ident::new(otherwise, proc_macro2::Span::call_site());
            return quote! { crate::node::Measure::#otherwise };
        };
        let limit = self.limit.as_ref().map_or(quote! { Any }, |limit| quote! { #limit });
        let usual = if let Some(ExprRange { start: Some(from), end: Some(to), .. }) = &self.usual {
            quote! { [#from, #to] }
        } else {
            quote! { crate::node::Measure::ALL }
        };
        let measure = |unit: &str, items: TokenStream| {
            quote! {
                crate::node::Measure { unit: #unit, limit: crate::node::Limit::#limit, usual: #usual, items: &[#items] }
            }
        };
        let unit = unit.value();
        let items = unit.split(", ").filter(|_| unit.contains(", ") && !unit.contains(" or "));
        let items = items.map(|unit| measure(unit, quote! {}));
        measure(&unit, quote! { #(#items),* })
    }
}

/// Implements `FromNode`.
#[proc_macro_derive(FromNode, attributes(key))]
pub fn derive_from_node(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    implement(&input).unwrap_or_else(Error::into_compile_error).into()
}

fn implement(input: &DeriveInput) -> Result<TokenStream> {
    let whole = KeyRow::among(&input.attrs, &KeyRow::default())?;
    let (form, read) = match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(fields) => mapping(fields, &whole)?,
            other => return Err(Error::new_spanned(other, "a mapping has named fields")),
        },
        Data::Enum(data) => choice(&data.variants, &whole)?,
        Data::Union(data) => return Err(Error::new_spanned(data.union_token, "a value is a mapping or a choice")),
    };
    let (name, about) = (&input.ident, documentation(&input.attrs));
    let title = name.to_string();
    Ok(quote! {
        impl crate::node::FromNode for #name {
            const FORM: crate::node::Form =
                crate::node::Form::Defined { definition: &crate::node::Definition { name: #title, about: #about, form: #form } };
            fn from_node(reader: crate::node::Reader) -> Result<Self, crate::node::Unread> {
                #read
            }
        }
    })
}

/// Form and reading of a mapping.
fn mapping(fields: &FieldsNamed, whole: &KeyRow) -> Result<(TokenStream, TokenStream)> {
    let keys = keys(fields, whole)?;
    let values = values(fields);
    let form = quote! { crate::node::Form::Mapping { keys: &[#keys] } };
    let read = quote! {
        const KEYS: &[crate::node::Key] = &[#keys];
        let fields = reader.fields(KEYS)?;
        Ok(Self { #values })
    };
    Ok((form, read))
}

/// The keys of a mapping.
fn keys(fields: &FieldsNamed, whole: &KeyRow) -> Result<TokenStream> {
    let mut keys = TokenStream::new();
    for field in &fields.named {
        let row = KeyRow::among(&field.attrs, whole)?;
        let measure = row.measure("NONE");
        let name = row.name.or(field.ident.as_ref().map(Ident::to_string)).unwrap_or_default();
        let (about, value) = (documentation(&field.attrs), &field.ty);
        keys.extend(quote! { crate::node::Key::new::<#value>(#name, #about, &#measure), });
    }
    Ok(keys)
}

/// The fields of a struct or a variant, each read from its place among `fields`.
fn values(fields: &FieldsNamed) -> TokenStream {
    let named = fields.named.iter().enumerate();
    let values = named.map(|(index, field)| {
        let name = &field.ident;
        quote! { #name: crate::node::Value::read(fields.reader(#index)), }
    });
    values.collect()
}

/// Form and reading of a choice.
fn choice(
    variants: &syn::punctuated::Punctuated<syn::Variant, syn::Token![,]>,
    whole: &KeyRow,
) -> Result<(TokenStream, TokenStream)> {
    let (mut forms, mut names, mut arms) = (TokenStream::new(), TokenStream::new(), TokenStream::new());
    for (index, variant) in variants.iter().enumerate() {
        let name = &variant.ident;
        let (word, about) = (snake_case(&name.to_string()), documentation(&variant.attrs));
        let measure = KeyRow::among(&variant.attrs, whole)?.measure("INHERITED");
        let (content, arm) = match &variant.fields {
            Fields::Unit => {
                let content = quote! { content: crate::node::Form::Word, is_bare: false };
                (content, quote! { choice.word()?; Ok(Self::#name) })
            }
            Fields::Unnamed(fields) if fields.unnamed.len() == 1 => {
                let value = &fields.unnamed[0].ty;
                let content = quote! {
                    content: <#value as crate::node::FromNode>::FORM,
                    is_bare: <#value as crate::node::FromNode>::IS_OPTIONAL
                };
                (content, quote! { Ok(Self::#name(choice.content(&#measure)?)) })
            }
            Fields::Unnamed(fields) => return Err(Error::new_spanned(fields, "a variant has one content")),
            Fields::Named(fields) => {
                let (keys, values) = (keys(fields, whole)?, values(fields));
                let arm = quote! {
                    const KEYS: &[crate::node::Key] = &[#keys];
                    let fields = choice.fields(KEYS)?;
                    Ok(Self::#name { #values })
                };
                (quote! { content: crate::node::Form::Mapping { keys: &[#keys] }, is_bare: false }, arm)
            }
        };
        forms.extend(quote! { crate::node::Variant { word: #word, about: #about, measure: &#measure, #content }, });
        names.extend(quote! { #word, });
        let pattern = if index + 1 == variants.len() {
            quote! { _ }
        } else {
            quote! { #index }
        };
        arms.extend(quote! { #pattern => { #arm } });
    }
    let form = quote! { crate::node::Form::Choice { variants: &[#forms] } };
    let read = quote! {
        let choice = reader.choice(&[#names])?;
        match choice.index { #arms }
    };
    Ok((form, read))
}

/// The doc comments of an item as text; empty lines separate paragraphs.
fn documentation(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(doc) if doc.path.is_ident("doc") => match &doc.value {
            Expr::Lit(ExprLit { lit: Lit::Str(line), .. }) => Some(line.value().trim().to_owned()),
            _ => None,
        },
        _ => None,
    });
    lines.collect::<Vec<_>>().join("\n").trim().to_owned()
}

/// `WeldedBox` as `welded_box`.
fn snake_case(name: &str) -> String {
    let mut word = String::new();
    for c in name.chars() {
        if c.is_uppercase() && !word.is_empty() {
            word.push('_');
        }
        word.extend(c.to_lowercase());
    }
    word
}
