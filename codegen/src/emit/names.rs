//! Names of variables in one function: the model's name if there is one, otherwise a number.

use std::collections::{HashMap, HashSet};

use crate::program::{Argument, Program};
use crate::symbolic::{ExprId, Op};

/// Names that generated functions use themselves.
const TAKEN: &[&str] = &[
    "factors",
    "fma",
    "columns",
    "mass",
    "splat",
    "t",
    "q",
    "v",
    "r",
    "f",
    "base",
    "added_inertia",
    "c",
    "u",
    "out",
    "kept",
    "k",
    "sines",
    "cosines",
    "sin_cos",
    "stumpff",
    "stumpff_of",
    "sqrt",
    "exp",
    "select",
    "mirror",
    "symmetric",
    "max",
    "min",
    "Constants",
    "N",
];

/// Whether Rust does not take a word as an ordinary identifier; `gen` is a keyword since edition 2024.
fn is_keyword(word: &str) -> bool {
    word == "gen" || syn::parse_str::<syn::Ident>(word).is_err()
}

/// The field for a parameter: `payload`, `r#type`.
pub fn field_name(parameter: &str) -> String {
    if is_keyword(parameter) { format!("r#{parameter}") } else { parameter.to_owned() }
}

/// Variables of a loop.
pub const OF_LOOPS: [&str; 4] = ["numbers", "gathered", "carried", "saved"];

/// `kept_1`, a variable of the first loop.
pub fn of_loop(name: &str, of: usize) -> String {
    let name = format!("{name}_{}", of + 1);
    // Tables are statics.
    if name.starts_with("numbers") { name.to_uppercase() } else { name }
}

/// Gives every value of a function one valid, unique name.
pub struct Names<'p> {
    program: &'p Program,
    given: HashMap<ExprId, String>,
    taken: HashSet<String>,
    next: usize,
}

impl<'p> Names<'p> {
    /// For a function with this many loops.
    pub fn new(program: &'p Program, loops: usize) -> Self {
        let of_loops = (0..loops).flat_map(|of| OF_LOOPS.map(|name| of_loop(name, of)));
        let taken = TAKEN.iter().map(ToString::to_string).chain(of_loops).collect();
        Names { program, given: HashMap::new(), taken, next: 0 }
    }

    /// The same, avoiding further words.
    #[must_use]
    pub fn avoiding(mut self, words: &[&str]) -> Self {
        self.taken.extend(words.iter().map(ToString::to_string));
        self
    }

    /// The name of a value.
    pub fn name(&mut self, id: ExprId) -> String {
        if let Some(name) = self.given.get(&id) {
            return name.clone();
        }
        let name = match self.program.op(id) {
            Op::Symbol(symbol) => match self.program.symbol(symbol) {
                // The argument itself.
                time if time.argument == Argument::Time => time.name.clone(),
                other => self.unique(&other.name),
            },
            _ => match self.program.names.get(&id) {
                Some(name) => self.unique(name),
                None => self.numbered(),
            },
        };
        self.given.insert(id, name.clone());
        name
    }

    /// The next free `t017`.
    fn numbered(&mut self) -> String {
        loop {
            self.next += 1;
            let name = format!("t{:03}", self.next);
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }

    fn unique(&mut self, wanted: &str) -> String {
        let mut candidates = std::iter::once(wanted.to_owned()).chain((2..).map(|k| format!("{wanted}_{k}")));
        // A keyword such as `type` cannot be a variable; `type_2` can.
        let free = |name: &String| !is_keyword(name) && !self.taken.contains(name);
        let name = candidates.find(free).unwrap_or_default();
        self.taken.insert(name.clone());
        name
    }
}
