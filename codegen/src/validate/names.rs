//! Names: identifiers, unique among their kind.

use std::collections::BTreeMap;

use super::{Check, Owner};
use crate::chain::{CRATES, CoordinateId, LONGEST_NAME};
use crate::diagnostic::{Span, is_one_line, rule, suggest};
use crate::spec::Spanned;

/// Keywords of Rust that cannot be raw identifiers either.
const NEVER_NAMES: [&str; 3] = ["crate", "self", "super"];

/// Names used so far, by kind and name, with their owners.
#[derive(Debug, Default)]
pub(super) struct Names(BTreeMap<(&'static str, String), String>);

impl Names {
    /// Registers a name, or returns its owner if it is taken.
    fn register(&mut self, kind: &'static str, name: &str, owner: String) -> Result<(), String> {
        match self.0.entry((kind, name.to_owned())) {
            std::collections::btree_map::Entry::Vacant(free) => {
                free.insert(owner);
                Ok(())
            }
            std::collections::btree_map::Entry::Occupied(taken) => Err(taken.get().clone()),
        }
    }

    /// Whether a name is taken.
    pub(super) fn has(&self, kind: &'static str, name: &str) -> bool {
        self.0.contains_key(&(kind, name.to_owned()))
    }
}

/// The only coordinate of the link that the name of a coordinate begins with: `inner_psi` for `inner_theta` or `inner_boom_psi`.
fn of_one_link<'n>(name: &str, known: &[&'n str]) -> Option<&'n str> {
    let link = |known: &'n str| known.rsplit_once('_').map(|(link, _)| link);
    let begins = |known: &&&'n str| {
        link(known).and_then(|link| name.strip_prefix(link)).is_some_and(|rest| rest.starts_with('_'))
    };
    let mut of_links = known.iter().filter(begins);
    of_links.next().copied().filter(|_| of_links.next().is_none())
}

impl Check<'_> {
    /// A name that is a `snake_case` identifier. Keywords of Rust become raw identifiers there, except those that cannot.
    pub(super) fn name<'n>(&mut self, text: &'n Spanned<String>) -> Option<&'n str> {
        let name = text.value.as_deref()?;
        let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        let identifier = name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(letters);
        if !identifier || name.len() > LONGEST_NAME {
            let why = if identifier { "longer than 64 characters" } else { "not an identifier" };
            self.report(rule::not_an_identifier(text.span, name.chars().take(40).collect::<String>(), why));
            return None;
        }
        if NEVER_NAMES.contains(&name) {
            self.report(rule::keyword(text.span, name, "Rust reserves this word"));
            return None;
        }
        Some(name)
    }

    /// The name of the crane, which becomes a module at the root of a program.
    pub(super) fn crane_name<'n>(&mut self, text: &'n Spanned<String>) -> Option<&'n str> {
        let name = self.name(text)?;
        // `gen` is a keyword since edition 2024.
        if name == "gen" || syn::parse_str::<syn::Ident>(name).is_err() {
            self.report(rule::keyword(text.span, name, "a keyword of Rust, where the crane is a module"));
            return None;
        }
        if CRATES.contains(&name) {
            self.report(rule::keyword(text.span, name, "the crane's program uses a crate of this name"));
            return None;
        }
        Some(name)
    }

    /// A descriptive text that is copied into comments of the generated code: one line, without characters that break or reverse it.
    pub(super) fn text(&mut self, given: Option<&Spanned<String>>, subject: &str) -> Option<String> {
        let given = given?;
        let text = given.value.as_ref()?;
        if !is_one_line(text) {
            self.report(rule::not_one_line(given.span, subject));
        }
        Some(text.clone())
    }

    /// Registers a name that must be unique among its kind.
    pub(super) fn register_name(&mut self, kind: &'static str, name: &str, owner: String, span: Span) {
        if let Err(other) = self.expanded.register(kind, name, owner) {
            self.report(rule::duplicate_name(span, kind, name, other));
        }
    }

    /// Registers the name of a body or coordinate of a link, unless the link's own name is invalid or a duplicate.
    pub(super) fn register_expanded(&mut self, kind: &'static str, name: &str, link: &str, span: Span) {
        if !link.is_empty() && !self.links.contains_key(link) {
            self.register_name(kind, name, format!("link `{link}`"), span);
        }
    }

    /// The coordinate with that name.
    pub(super) fn coordinate(&mut self, text: &Spanned<String>) -> Option<CoordinateId> {
        self.find_coordinate(text, |_| true)
    }

    /// The coordinate with that name, where those of joints are expected: only these are suggested for a name that is unknown.
    pub(super) fn joint_coordinate(&mut self, text: &Spanned<String>) -> Option<CoordinateId> {
        self.find_coordinate(text, |owner| *owner == Owner::Joint)
    }

    fn find_coordinate(&mut self, text: &Spanned<String>, is_offered: fn(&Owner) -> bool) -> Option<CoordinateId> {
        let name = text.value.as_deref()?;
        let found = self.coordinates.iter().position(|coordinate| coordinate.name == name);
        if found.is_none() && !self.unknown.links {
            let known = self.coordinates.iter().zip(&self.owners).filter(|(_, owner)| is_offered(owner));
            let known: Vec<&str> = known.map(|(coordinate, _)| coordinate.name.as_str()).collect();
            let help = match of_one_link(name, &known) {
                _ if self.loop_names.contains(&name) => format!(
                    "`{name}` is a loop joint, which has no coordinate: a `pin` has `friction` and `damping` in its own entry; what needs a drive or \
                     stops has to be a joint of the chain"
                ),
                Some(meant) => format!("did you mean `{meant}`?"),
                None => suggest(name, known),
            };
            self.report(rule::unknown_coordinate(text.span, name, help));
        }
        found.map(CoordinateId)
    }
}
