//! Numbers of a spec as live parameters, by their places.

use crane_codegen::{Checked, CraneSpec, Diagnostics, WrongPlace, check};
use crane_model::ParameterInfo;

use super::differences::FixedNumber;

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

/// The crane in which the numbers at places, such as `links.boom.beam.section.box.height`, are live parameters, whose names replace them in
/// the list; other entries of the list are names of parameters. Places whose numbers cannot be live parameters stay in the list: see
/// [`FixedNumber`](super::FixedNumber). `None` if nothing has changed.
///
/// # Errors
/// There is no number at a place, or it cannot change.
pub fn with_live_numbers(checked: &Checked, numbers: &mut [String]) -> Result<Option<Checked>, Refused> {
    let places: Vec<usize> = (0..numbers.len()).filter(|&index| numbers[index].contains('.')).collect();
    let live = |before: &CraneSpec, index: usize, place: &str| {
        let change = before.live_number(place, &format!("{PLACE}{index}"), checked.unit_at(place));
        let mistakes = |mistakes| Refused::Mistakes { place: place.to_owned(), mistakes };
        before.changed(&change.map_err(Refused::Place)?).map_err(mistakes)
    };
    if let Some(place) = places.iter().map(|&index| &numbers[index]).find(|place| is_not_at_rest(place)) {
        return Err(Refused::NotAtRest { place: place.clone() });
    }
    // Most often all can.
    let all = places.iter().try_fold(checked.spec.clone(), |before, &index| live(&before, index, &numbers[index]))?;
    if places.is_empty() {
        return Ok(None);
    }
    if let Ok(all) = check(all) {
        for &index in &places {
            numbers[index] = format!("{PLACE}{index}");
        }
        return Ok(Some(all));
    }
    let mut changed: Option<Checked> = None;
    for index in places {
        let before = changed.as_ref().map_or(&checked.spec, |changed| &changed.spec);
        if let Ok(after) = check(live(before, index, &numbers[index])?) {
            changed = Some(after);
            numbers[index] = format!("{PLACE}{index}");
        } else {
            FixedNumber::new(checked, &numbers[index])?;
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
