//! What a rule is, and how a table of rules becomes one constructor per rule.

/// A rule, for documentation and for the test that each has an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Code, such as `E031`.
    pub code: &'static str,
    /// What the rule requires.
    pub about: &'static str,
}

/// A message on one line of limited length, whatever the user's names consist of.
pub(crate) fn printable(message: &str) -> String {
    /// Long enough for a list of the longest names of the language.
    const LONGEST: usize = 400;
    let visible = message.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c });
    let mut line: String = visible.take(LONGEST).collect();
    if message.chars().nth(LONGEST).is_some() {
        line.push('…');
    }
    line
}

/// Whether a text has no characters that break or reverse a line.
pub(crate) fn is_one_line(text: &str) -> bool {
    let turns = |c| matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    !text.chars().any(|c| c.is_control() || turns(c))
}

/// A text of one line as YAML has it in quotes.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Turns a table of rules into one constructor per rule, in the module `rule`, and into `CATALOGUE`.
macro_rules! catalogue {
    ($($(#[doc = $about:literal])+ $code:ident $name:ident($($word:ident),*) $title:literal, $label:literal, $help:literal;)+) => {
        /// Every rule, by code.
        pub const CATALOGUE: &[$crate::diagnostic::Rule] =
            &[$($crate::diagnostic::Rule { code: stringify!($code), about: concat!($($about),+) }),+];

        /// The code of every rule, by its name.
        #[allow(non_upper_case_globals, dead_code, reason = "the names are those of the rules' functions; few are compared")]
        pub mod code {
            $(
                $(#[doc = $about])+
                pub const $name: &str = stringify!($code);
            )+
        }

        /// One function per rule, which reports how the rule was broken.
        pub(crate) mod rule {
            use std::fmt::Display;

            use $crate::diagnostic::{Mistake, Span};
            $(
                $(#[doc = $about])+
                pub(crate) fn $name(span: Span, $($word: impl Display),*) -> Mistake {
                    let texts = [format_args!($title), format_args!($label), format_args!($help)];
                    Mistake::new(stringify!($code), span, texts)
                }
            )+
        }
    };
}

pub(crate) use catalogue;
