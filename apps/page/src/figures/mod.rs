//! Key figures: what the tiles of a page say, and its summary to sign. The page shows these texts and decides nothing itself.
//!
//! | module | content |
//! |---|---|
//! | `loads` | drives, feet, tipping, cylinders |
//! | `beams` | deflection, utilisation, vibration |
//! | `sign` | the summary to sign |

mod beams;
mod loads;
pub mod sign;

pub(crate) use beams::vibration;

use crane_model::DisplayUnit;
use serde_json::{Value, json};

use crate::{crane::Shown, tables::readable};

/// Whether a figure keeps its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It has no limit.
    Unlimited,
    /// It keeps its limit.
    Within,
    /// It is beyond its limit.
    Beyond,
}

impl Verdict {
    /// Whether something is beyond its limit.
    fn beyond(beyond: bool) -> Self {
        if beyond { Verdict::Beyond } else { Verdict::Within }
    }

    /// A word for programs.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Unlimited => "unlimited",
            Verdict::Within => "within",
            Verdict::Beyond => "beyond",
        }
    }
}

/// A key figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its name for programs.
    pub key: &'static str,
    /// What it is.
    pub title: String,
    /// Its value with its unit.
    pub value: String,
    /// Where and when, and what it means.
    pub note: String,
    /// Whether it keeps its limit.
    pub verdict: Verdict,
    /// What is beyond its limit, in a few words.
    pub excess: Option<String>,
}

impl Figure {
    fn new(key: &'static str, title: impl Into<String>, value: String, note: String) -> Self {
        Self { key, title: title.into(), value, note, verdict: Verdict::Unlimited, excess: None }
    }

    /// With a limit; `excess`: what is beyond it, if anything is.
    fn judged(self, excess: Option<String>) -> Self {
        Self { verdict: Verdict::beyond(excess.is_some()), excess, ..self }
    }

    fn json(&self) -> Value {
        let Self { key, title, value, note, verdict, excess } = self;
        json!({"key": key, "title": title, "value": value, "note": note, "verdict": verdict.name(), "excess": excess})
    }
}

/// The key figures of a crane; `rigid`: the rigid crane it is compared with.
pub(crate) fn figures(crane: &Shown<'_>, rigid: Option<&Shown<'_>>) -> Vec<Figure> {
    let mut found = Vec::new();
    found.extend(loads::equilibrium(crane));
    found.extend(beams::utilisation(crane));
    found.extend(loads::tipping(crane));
    found.extend(loads::reactions(crane));
    found.extend(loads::pressure(crane));
    found.extend(loads::strokes(crane));
    found.extend(loads::drives(crane));
    found.extend(rigid.and_then(|rigid| beams::deflection(crane, rigid)));
    found.extend(vibration(&crane.modes, crane.subject.crane.description()));
    found.extend(loads::energy(crane));
    found
}

/// What is beyond its limit, in one sentence.
pub(crate) fn verdict(figures: &[Figure]) -> (Verdict, String) {
    let of = |verdict: Verdict| figures.iter().filter(move |figure| figure.verdict == verdict);
    let excesses: Vec<&str> = of(Verdict::Beyond).filter_map(|figure| figure.excess.as_deref()).collect();
    let kept: Vec<&str> = of(Verdict::Within).map(|figure| figure.title.as_str()).collect();
    if !excesses.is_empty() {
        (Verdict::Beyond, format!("BEYOND LIMITS: {}", excesses.join("; ")))
    } else if kept.is_empty() {
        (Verdict::Unlimited, "no limit was checked".to_owned())
    } else {
        (Verdict::Within, format!("within the limits that were checked: {}", kept.join(", ")))
    }
}

/// For the page.
pub(crate) fn json(figures: &[Figure]) -> Value {
    figures.iter().map(Figure::json).collect()
}

/// A quantity for readers: four digits, in a larger or smaller unit where that reads better; pressures in bar.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    let (value, unit) = scaled(value, value.abs(), unit);
    format!("{} {unit}", readable(value)).trim_end().to_owned()
}

/// A number in the unit for readers in which quantities of some size are shown, and the unit.
fn scaled(number: f64, size: f64, unit: &str) -> (f64, &str) {
    let display = DisplayUnit::for_size(unit, size);
    display.map_or((number, unit), |display| (display.shown(number), display.unit()))
}

/// A name for readers: spaces instead of underscores.
pub(crate) fn spoken(name: &str) -> String {
    name.replace('_', " ")
}

#[cfg(test)]
mod tests;
