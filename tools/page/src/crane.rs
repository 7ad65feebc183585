//! One crane of the page: what it is, how it is drawn, its run and its modes.

use crane_codegen::chain::{Beam, Outline, Value as Number};
use crane_live::LiveCrane;
use crane_model::{
    CoordinateRole,
    dyn_crane::DynCrane,
    dynamics::Sample,
    force_states::ForceStates,
    modes::{NoModes, undamped},
    results::{Recording, Table},
};
use serde_json::{Value, json};

use crate::{
    Program, Subject, record,
    scene::scene,
    strength::{self, packed},
};

/// Most rows of a run that a page holds; a longer one is thinned, so that the page stays small enough to mail.
const MOST_ROWS: usize = 4000;

/// All data of one crane.
pub fn data(subject: &Subject<'_>, program: Program) -> Result<Value, NoModes> {
    let &Subject { label, crane, live, equilibrium, run } = subject;
    // Without an equilibrium there is at least a pose to look at.
    let found = equilibrium.q.iter().all(|q| q.is_finite());
    let pose = if found { equilibrium.q.clone() } else { crane.guess() };
    let at_rest;
    let table = if let Some((_, recorded)) = run {
        &recorded.table
    } else {
        at_rest = rest(crane, &pose);
        &at_rest
    };
    let description = crane.description();
    let coordinates: Vec<Value> = description
        .coordinates
        .iter()
        .map(|coordinate| {
            // A joint is drawn the same whether its drive is compliant or rigid.
            let role = match coordinate.role {
                CoordinateRole::Prescribed => CoordinateRole::Driven,
                role => role,
            };
            json!({
                "name": coordinate.name.as_str(), "role": role.name(),
                "unit": coordinate.kind.unit(), "force_unit": coordinate.kind.force_unit(),
            })
        })
        .collect();
    let every = table.rows.len().div_ceil(MOST_ROWS).max(1);
    Ok(json!({
        "name": description.name.as_str(),
        "title": description.title.as_str(),
        "label": label,
        "coordinates": coordinates,
        "drives": description.drives.iter().map(|drive| drive.coordinate).collect::<Vec<_>>(),
        "scene": scene(live, &pose),
        "outlines": outlines(live),
        "modes": modes(subject)?,
        "run": columns(table, every),
        "record": run.map(|(settings, recorded)| record(crane, settings, recorded, program)),
        "strength": strength::data(crane, table, every),
    }))
}

/// The single result of a crane at rest, with its drives at their start positions.
fn rest(crane: &dyn DynCrane, q: &[f64]) -> Table {
    let (v, x) = (vec![0.0; q.len()], ForceStates::new(crane.description()).holding(crane, 0.0, q));
    let mut recording = Recording::new(crane);
    recording.push(&Sample { t: 0.0, q, v: &v, x: &x, work: 0.0, dissipated: 0.0, load_work: 0.0 });
    recording.into_table()
}

/// Sections of the beams whose spec gives a shape, by the names of their links: height and width, m, of a stepped or tapered beam along it.
fn outlines(live: &LiveCrane) -> Value {
    let number = |number: &Number| number.at(live.parameters());
    let of = |beam: &Beam| {
        let along: Vec<[f64; 3]> = beam
            .outlines
            .iter()
            .map(|(x, Outline { size: [height, width], .. })| [x, height, width].map(number))
            .collect();
        let greatest = |side: usize| along.iter().map(|place| place[side]).fold(0.0, f64::max);
        let round = beam.outlines.first()?.1.round;
        Some((beam.link.clone(), json!({"size": [greatest(1), greatest(2)], "along": along, "round": round})))
    };
    live.chain().beams.iter().filter_map(of).collect()
}

/// Frequencies, Hz, and shapes in generalized coordinates, lowest first; none unless the pose is a stable equilibrium.
fn modes(subject: &Subject<'_>) -> Result<Vec<Value>, NoModes> {
    if !subject.equilibrium.is_stable() {
        return Ok(Vec::new());
    }
    let coordinates = &subject.crane.description().coordinates;
    let modes = undamped(&subject.crane.small_motions_at(&subject.equilibrium.q))?;
    let mode = |mode: &crane_model::modes::Mode| {
        let names: Vec<&str> = mode.dominating.iter().map(|&index| coordinates[index].name.as_str()).collect();
        json!({"frequency": mode.frequency(), "shape": mode.shape.as_slice(), "moves": names})
    };
    Ok(modes.iter().map(mode).collect())
}

/// Names, units and values of every `every`-th row, column by column.
fn columns(table: &Table, every: usize) -> Value {
    let rows: Vec<&Vec<f64>> = table.rows.iter().step_by(every).collect();
    let numbers = (0..table.columns.len()).flat_map(|column| rows.iter().map(move |row| row[column]));
    let columns: Vec<Value> =
        table.columns.iter().map(|column| json!({"name": column.name, "unit": column.unit})).collect();
    json!({"columns": columns, "rows": rows.len(), "every": every, "data": packed(numbers)})
}
