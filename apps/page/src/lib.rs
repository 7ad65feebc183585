//! A crane as one HTML page, which needs no network: in 3-D, with plots of a run, its modes and its strength.
//!
//! The page itself is built from `apps/report` and committed; here it gets its data. The command writes it to a file, the Python package
//! shows it in notebooks.
//!
//! | module | content |
//! |---|---|
//! | `crane` | what a crane is, how it is drawn, its run and its modes |
//! | `scene` | what moves: frames of the bodies, and a screw for each coordinate |
//! | [`diagram`] | the scene as lines, with names of frames and coordinates |
//! | [`shapes`] | the shapes of a crane as triangles, as glTF and as picture elements |
//! | `figures` | key figures: tiles, and the summary to sign |
//! | `strength` | utilisation of sections and tipping margins over a run |
//! | `history` | internal forces and tipping lines over a run |
//! | `record` | the record of a run: enough to repeat it |
//! | [`tables`] | tables of results: those of the page, and what the command prints |

pub mod bars;
mod crane;
pub mod diagram;
mod figures;
pub mod history;
mod record;
pub mod scene;
pub mod shapes;
pub mod strength;
pub mod tables;

use crane_live::LiveCrane;
use crane_model::{
    DisplayUnit, dyn_crane::DynCrane, dynamics::Settings, modes::NoModes, runs::Recorded, statics::Equilibrium,
};
use serde_json::{Value, json};

use crane::Shown;
pub use crane::shown_pose;
pub use record::{Program, record};
use tables::Report;

/// The page without data: script, style and licences in one file.
const PAGE: &str = include_str!("report.html");
/// The place of the data.
const PLACE: &str = "{\"data\":\"here\"}";

/// One of the cranes of a page.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// What distinguishes it from the others.
    pub label: &'a str,
    /// The crane.
    pub crane: &'a dyn DynCrane,
    /// The same crane with derivatives of its transforms.
    pub live: &'a LiveCrane,
    /// Its equilibrium.
    pub equilibrium: &'a Equilibrium,
    /// Its run; without one, it is shown at rest.
    pub run: Option<(&'a Settings, &'a Recorded)>,
}

/// What a page shows besides cranes.
#[derive(Default)]
pub struct Texts<'a> {
    /// Tables of results.
    pub tables: Option<Report>,
    /// Figures of load charts; none if null.
    pub chart: Value,
    /// Facts and tables of these load charts; none if null.
    pub load_chart: Value,
    /// What moves the quantities of the last crane at rest; null if it is not known.
    pub moves: Value,
    /// The command that wrote the page.
    pub command: Option<String>,
    /// Spec of the last crane.
    pub spec: Option<&'a str>,
    /// Address of the page as an instrument, in which this spec can be opened; seen from the folder of the page.
    pub instrument: Option<&'a str>,
}

/// The page of some cranes; the last one is its subject, the previous one the rigid crane to compare it with.
///
/// # Errors
/// The modes of a crane could not be computed.
pub fn page(subjects: &[Subject<'_>], texts: Texts<'_>, program: Program) -> Result<String, NoModes> {
    let data = data(subjects, texts, program)?.to_string();
    // No text of a spec may end the script element that contains the data.
    Ok(PAGE.replacen(PLACE, &data.replace('<', "\\u003c"), 1))
}

/// The data of such a page.
///
/// # Errors
/// The modes of a crane could not be computed.
pub fn data(subjects: &[Subject<'_>], texts: Texts<'_>, program: Program) -> Result<Value, NoModes> {
    let shown = subjects.iter().map(Shown::new).collect::<Result<Vec<_>, _>>()?;
    Ok(written(&shown, texts, program))
}

/// The data of a page of one crane without its modes, which [`modes`] gives afterwards.
pub fn data_without_modes(subject: &Subject<'_>, texts: Texts<'_>, program: Program) -> Value {
    written(&[Shown::without_modes(subject)], texts, program)
}

/// The modes of a crane at rest, and the figures about them.
///
/// # Errors
/// They could not be computed.
pub fn modes(subject: &Subject<'_>) -> Result<Value, NoModes> {
    let description = subject.crane.description();
    let modes = crane::modes(subject)?;
    let figures: Vec<_> = figures::vibration(&modes, description).into_iter().collect();
    Ok(json!({"modes": crane::modes_data(&modes, description), "figures": figures::json(&figures)}))
}

fn written(shown: &[Shown<'_>], texts: Texts<'_>, program: Program) -> Value {
    let Texts { tables, chart, load_chart, moves, command, spec, instrument } = texts;
    let tables = tables.map(|report| report.page());
    let (main, rigid) = match shown {
        [] => (None, None),
        [main] => (Some(main), None),
        [rigid, .., main] => (Some(main), Some(rigid)),
    };
    let figures = main.map_or_else(Vec::new, |main| figures::figures(main, rigid));
    let summary = main.map(|main| figures::sign::summary(main, &figures, command.as_deref(), program));
    let (verdict, sentence) = figures::verdict(&figures);
    json!({
        "cranes": shown.iter().map(|crane| crane.data(program)).collect::<Vec<_>>(),
        "figures": figures::json(&figures),
        "verdict": {"verdict": verdict.name(), "text": sentence},
        "summary": summary,
        "tables": tables,
        "chart": chart,
        "load_chart": load_chart,
        "moves": moves,
        "command": command,
        "spec": spec,
        "instrument": instrument,
        "display": display_units(),
    })
}

/// Units in which people read numbers: the unit in SI, the factor from it, and the sizes for which they are used, in SI.
fn display_units() -> Value {
    let row = |unit: DisplayUnit| {
        let [least, below] = unit.sizes()?;
        let below = below.is_finite().then_some(below);
        Some(json!({"si": unit.si(), "unit": unit.unit(), "factor": unit.shown(1.0), "least": least, "below": below}))
    };
    DisplayUnit::ALL.into_iter().filter_map(row).collect()
}

#[cfg(test)]
mod tests;
