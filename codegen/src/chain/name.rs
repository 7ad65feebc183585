//! Names that a spec may not give.

/// Maximum length of a name, characters: it is part of file names and of lines of generated code.
pub(crate) const LONGEST_NAME: usize = 64;
/// Crates whose names are resolved at the root of a program: a module of the same name would hide them.
pub(crate) const CRATES: [&str; 11] = [
    "std",
    "core",
    "alloc",
    "nalgebra",
    "wide",
    "crane_model",
    "crane_codegen",
    "crane_cli",
    "crane_shipped",
    "crane_specs",
    "crane_live",
];
