//! A crane with the numbers of the page, and how it is shown at rest.

use crane_live::LiveCrane;
use crane_model::{dyn_crane::DynCrane, dynamics::Settings, runs::Recorded, statics::Equilibrium};
use crane_page::{Program, Subject, Texts, data_without_modes, tables::VALUE};
use serde_json::Value;

use crate::levers::Numbers;

/// What computed the results.
pub const PROGRAM: Program = Program { name: "crane", version: env!("CARGO_PKG_VERSION") };

/// What went wrong, in words for the reader of the page.
pub type Outcome<T> = Result<T, String>;

/// A crane with other parameters; if none are given, with its own.
pub fn with_parameters(live: &LiveCrane, parameters: &[f64]) -> Outcome<LiveCrane> {
    let mut crane = live.clone();
    if !parameters.is_empty() {
        let own = with_numbers(live, parameters, std::iter::empty())?;
        crane.set_parameters(&own).map_err(|refused| refused.to_string())?;
    }
    Ok(crane)
}

/// Where the motions of the drives begin, m and rad.
pub fn starts(crane: &LiveCrane) -> Vec<f64> {
    (crane as &dyn DynCrane).drive_targets_at(0.0)
}

/// Parameters of a crane with levers: its own, or other values of them, then the numbers of its drives.
pub fn with_numbers(live: &LiveCrane, parameters: &[f64], numbers: impl Iterator<Item = Numbers>) -> Outcome<Vec<f64>> {
    let own = if parameters.is_empty() { live.parameters() } else { parameters };
    if own.len() != live.parameters().len() {
        return Err(format!("{} values for {} parameters", own.len(), live.parameters().len()));
    }
    Ok(own.iter().copied().chain(numbers.flat_map(Numbers::array)).collect())
}

/// Whether there is one position for each drive.
pub fn check_positions(live: &LiveCrane, positions: &[f64]) -> Outcome<()> {
    let drives = live.chain().drives.len();
    if positions.len() == drives { Ok(()) } else { Err(format!("{} positions for {drives} drives", positions.len())) }
}

/// Data of the page of one crane at rest, without its modes.
pub fn still(crane: &LiveCrane, equilibrium: &Equilibrium, texts: Texts<'_>) -> Value {
    data_without_modes(&subject(crane, equilibrium, None), texts, PROGRAM)
}

/// A crane, alone on the page, with its run if it moves.
pub fn subject<'a>(
    crane: &'a LiveCrane,
    equilibrium: &'a Equilibrium,
    run: Option<(&'a Settings, &'a Recorded)>,
) -> Subject<'a> {
    Subject { label: VALUE, crane, live: crane, equilibrium, run }
}
