//! Syntax to text: formatted by prettyplease, with comments.

use proc_macro2::TokenStream;
use syn::{Stmt, parse_quote};

/// A comment line among statements. The formatter drops comments, so it travels as a macro call and is turned into a
/// comment afterwards.
pub fn comment(text: &str) -> Stmt {
    parse_quote!(comment!(#text);)
}

/// The text of a file.
pub fn file(items: Vec<syn::Item>) -> String {
    let text = prettyplease::unparse(&syn::File { shebang: None, attrs: vec![], items, frontmatter: None });
    let mut out = String::with_capacity(text.len());
    let mut in_function = false;
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some((indent, comment)) = comment_of(line, &mut lines) {
            out.push_str(indent);
            out.push_str("// ");
            out.push_str(&comment);
        } else {
            // The formatter puts no blank line between items.
            let starts_item = !line.starts_with([' ', '}', ')', ']']) && !line.is_empty();
            if starts_item && !in_function && !out.is_empty() && !out.ends_with("\n\n") {
                out.push('\n');
            }
            in_function = starts_item && !ends_item(line);
            out.push_str(line);
        }
        out.push('\n');
    }
    out
}

/// Whether this line ends the item.
fn ends_item(line: &str) -> bool {
    line.ends_with([';', '}'])
}

/// The comment on a line, and its indentation. The formatter breaks a long comment into three lines; the other two are then
/// taken from `following`.
fn comment_of<'t>(line: &'t str, following: &mut std::str::Lines<'t>) -> Option<(&'t str, String)> {
    let call = line.trim_start().strip_prefix("comment!(")?;
    let indent = &line[..line.len() - line.trim_start().len()];
    let literal = if let Some(literal) = call.strip_suffix(");") {
        literal
    } else {
        let literal = following.next()?.trim();
        following.next();
        literal
    };
    Some((indent, syn::parse_str::<syn::LitStr>(literal).ok()?.value()))
}

/// A constant of the module.
pub fn constant(doc: &str, name: &str, of: &TokenStream, value: &TokenStream) -> syn::Item {
    let name = quote::format_ident!("{name}");
    let doc = format!(" {doc}");
    syn::Item::Const(parse_quote!(#[doc = #doc] pub const #name: #of = #value;))
}

/// A user's words in documentation, where `[A]` would be a link, `<b>` a tag and `*` emphasis.
pub fn plain(text: &str) -> String {
    let special = |letter: char| "[]<>*_`\\".contains(letter);
    let escaped = |letter| if special(letter) { vec!['\\', letter] } else { vec![letter] };
    text.chars().flat_map(escaped).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn comments_of_any_length_are_comments() {
        for length in [1, 60, 90, 200] {
            let text = "x".repeat(length);
            let comment = super::comment(&text);
            let printed = super::file(vec![syn::parse_quote!(fn f() { #comment let a = 1; })]);
            assert_eq!(printed, format!("fn f() {{\n    // {text}\n    let a = 1;\n}}\n"));
        }
    }

    #[test]
    fn a_users_words_are_no_markup() {
        assert_eq!(super::plain("log [A], 0...800 kg"), r"log \[A\], 0...800 kg");
    }
}
