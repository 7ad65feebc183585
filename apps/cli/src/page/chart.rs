//! Load charts beside the run: the figures that `crane envelope` wrote.

use std::{fs, path::Path};

use base64::{Engine, prelude::BASE64_STANDARD};
use crane_model::dyn_crane::DynCrane;
use serde_json::{Value, json};

use crate::{
    envelope::facts_of_chart,
    problem::{Outcome, Problem},
    screen::Console,
};

/// Ends of the names of the figures, and what they show.
const FIGURES: [(&str, &str); 4] = [
    ("load_chart", "Curves of equal load over radius and height"),
    ("slew_diagram", "Largest load over the slewing angle"),
    ("largest_load_map", "Largest load"),
    ("utilisation_map", "Utilisation with the crane's own load"),
];

/// The load charts of a crane for its page.
#[derive(Default)]
pub struct LoadCharts {
    /// Names and pictures.
    pub figures: Value,
    /// Facts and tables: what `crane envelope --format json` prints.
    pub facts: Value,
}

/// The figures and facts beside the table of an envelope, `…_envelope.csv`, if it is one of this crane.
pub fn read_chart(console: &Console, table: &Path, crane: &dyn DynCrane) -> Outcome<LoadCharts> {
    console.remember(table);
    let figures = figures(table)?;
    Ok(LoadCharts { figures, facts: facts_of_chart(table, crane)? })
}

/// The figures beside the table of an envelope.
fn figures(table: &Path) -> Outcome<Value> {
    let help = "name the file `…_envelope.csv` that `crane envelope` wrote, with its figures beside it";
    let stem = table.file_stem().filter(|_| table.extension().is_some_and(|end| end == "csv"));
    let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
    let stem = stem.ok_or_else(|| Problem::usage(format!("{} is not an envelope", table.display()), help))?;
    let mut found = Vec::new();
    for (end, name) in FIGURES {
        if let Ok(picture) = fs::read(table.with_file_name(format!("{stem}_{end}.svg"))) {
            found.push(json!({"name": name, "svg": BASE64_STANDARD.encode(picture)}));
        }
    }
    if found.is_empty() {
        return Err(Problem::usage(format!("{} has no figures beside it", table.display()), help));
    }
    Ok(found.into())
}
