//! Numbers of a spec as live parameters, by their places.

use crane_codegen::compile::{check, unit_at};
use crane_codegen::{Diagnostics, SourceFile, WrongPlace};
use crane_model::ParameterInfo;

use super::differences::FixedNumber;
use crate::LiveCrane;

/// Begins the name of a live parameter that stands for a place of the spec.
const PLACE: &str = "number_at_place_";

/// Why a number cannot change.
#[derive(Debug)]
pub enum Refused {
    /// There is no number at the place.
    Place(WrongPlace),
    /// The spec has mistakes with another number: it must be an integer, for example.
    Mistakes {
        /// The place.
        place: String,
        /// The mistakes.
        mistakes: Diagnostics,
    },
    /// The number has nothing to do with a crane at rest.
    NotAtRest {
        /// The place.
        place: String,
    },
}

impl Refused {
    /// What is wrong, and what to do.
    #[must_use]
    pub fn words(&self) -> [String; 2] {
        match self {
            Refused::Place(wrong) => [wrong.title.clone(), wrong.help.clone()],
            Refused::Mistakes { place, mistakes } => {
                let mistake = mistakes.mistakes().first();
                let [title, help] = mistake.map_or_else(Default::default, |mistake| {
                    [format!("{} [{}]", mistake.title, mistake.code), mistake.help.clone()]
                });
                let help = format!("a number is changed by small steps, and the spec must allow them: {help}");
                [format!("`{place}` cannot change: {title}"), help]
            }
            Refused::NotAtRest { place } => [
                format!("`{place}` moves nothing: it does not belong to the crane at rest"),
                "give the place of a number of the crane, as in `links.boom.beam.section.box.height`".to_owned(),
            ],
        }
    }
}

/// Keys of a spec that do not belong to the crane at rest.
const NOT_AT_REST: [&str; 6] = ["format", "run", "guess", "name", "title", "analyses"];

/// The spec in which the numbers at places, such as `links.boom.beam.section.box.height`, are live parameters, whose names replace them in
/// the list; other entries of the list are names of parameters. Places whose numbers cannot be live parameters stay in the list: see
/// [`FixedNumber`](super::FixedNumber). `None` if nothing has changed.
///
/// # Errors
/// There is no number at a place, or it cannot change.
pub fn with_live_numbers(source: &SourceFile, numbers: &mut [String]) -> Result<Option<SourceFile>, Refused> {
    if !numbers.iter().any(|number| number.contains('.')) {
        return Ok(None);
    }
    let mistakes = |place: &str, mistakes| Refused::Mistakes { place: place.to_owned(), mistakes };
    check(source).map_err(|wrong| mistakes(numbers.first().map_or("", |name| name), wrong))?;
    let live = |before: &SourceFile, index: usize, number: &str| {
        let unit = &unit_at(source, number);
        before.with_live_number(number, &format!("{PLACE}{index}"), unit).map_err(Refused::Place)
    };
    let places: Vec<usize> = (0..numbers.len()).filter(|&index| numbers[index].contains('.')).collect();
    if let Some(place) = places.iter().map(|&index| &numbers[index]).find(|place| is_not_at_rest(place)) {
        return Err(Refused::NotAtRest { place: place.clone() });
    }
    // Most often all can.
    let mut all = source.clone();
    for &index in &places {
        all = live(&all, index, &numbers[index])?;
    }
    if LiveCrane::from_spec(&all).is_ok() {
        for &index in &places {
            numbers[index] = format!("{PLACE}{index}");
        }
        return Ok(Some(all));
    }
    let mut changed = None;
    for index in places {
        let after = live(changed.as_ref().unwrap_or(source), index, &numbers[index])?;
        if LiveCrane::from_spec(&after).is_ok() {
            changed = Some(after);
            numbers[index] = format!("{PLACE}{index}");
        } else {
            FixedNumber::new(source, &numbers[index])?;
        }
    }
    Ok(changed)
}

fn is_not_at_rest(place: &str) -> bool {
    NOT_AT_REST.iter().any(|key| place.split('.').next() == Some(key))
}

/// What people call a parameter: its name, or its place in the spec.
#[must_use]
pub fn label(info: &ParameterInfo) -> &str {
    if info.name.starts_with(PLACE) { &info.about } else { &info.name }
}
