//! A second description of a crane.

use crane_codegen::SourceFile;

use crate::observe::CAUTIONS;
use crate::tree::{Tree, source};

/// The name in a second description of a number of the first.
pub type Rename = Box<dyn Fn(&str) -> Option<String>>;

/// A second description of a crane.
pub struct Second {
    /// The first one, if it is not the crane as it was made.
    pub first: Option<Tree>,
    /// The second one.
    pub source: SourceFile,
    /// The name in the second of a number of the first; `None` for numbers that differ.
    pub name: Rename,
    /// By which numbers of a unit are larger in the second.
    pub factor: Box<dyn Fn(&str) -> f64>,
    /// Whether it also moves as the first does.
    pub moves: bool,
    /// Groups of numbers that differ: cautions, unless they are those about the first, word for word.
    pub without: &'static [&'static str],
    /// Whether its bodies belong to the same links, which the moments that tip it depend on.
    pub links: bool,
    /// Whether numbers of the two may differ in their signs.
    pub signs: bool,
    /// Live parameters and inputs that are set before anything is computed.
    pub set: Vec<(String, f64)>,
}

impl Second {
    /// A spec whose numbers are all those of the first.
    #[must_use]
    pub fn new(tree: &Tree) -> Self {
        Second {
            first: None,
            source: source(tree),
            name: Box::new(|name| Some(name.to_owned())),
            factor: Box::new(|_| 1.0),
            moves: true,
            without: &[CAUTIONS],
            links: true,
            signs: false,
            set: Vec::new(),
        }
    }

    /// With other words, but the same cautions.
    #[must_use]
    pub fn with_cautions(self) -> Self {
        Second { without: &[], ..self }
    }

    /// With other links.
    #[must_use]
    pub fn with_other_links(self) -> Self {
        Second { links: false, ..self }
    }

    /// With names of its own.
    #[must_use]
    pub fn named(self, name: impl Fn(&str) -> Option<String> + 'static) -> Self {
        Second { name: Box::new(name), ..self }
    }
}
