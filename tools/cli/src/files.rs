//! Files, whole or not at all.

use std::{
    fs, io,
    io::Write,
    path::{Path, PathBuf},
    process,
};

use crane_model::{dyn_crane::DynCrane, dynamics, results::Table};
use serde_json::{Map, Value, json};

use crate::{
    problem::{Outcome, Problem},
    run::Recorded,
    verification::Verification,
};

/// Makes a folder where it is missing.
pub fn folder(path: &Path) -> Outcome<()> {
    fs::create_dir_all(path).map_err(|error| Problem::file(path, &error))
}

/// Writes a file under another name and renames it when it is whole: nobody ever sees half a file.
pub fn write(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Outcome<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", process::id()));
    let part: PathBuf = path.with_file_name(name);
    let written = (|| {
        let mut file = io::BufWriter::new(fs::File::create(&part)?);
        content(&mut file)?;
        file.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()?;
        fs::rename(&part, path)
    })();
    written.map_err(|error| {
        // What is left of the part; the first error is the one to tell.
        let _ = fs::remove_file(&part);
        Problem::file(path, &error)
    })
}

/// Writes text.
pub fn write_text(path: &Path, text: &str) -> Outcome<()> {
    write(path, |file| file.write_all(text.as_bytes()))
}

/// Writes a table as CSV, units in the header: `boom_psi [rad]`. Only numbers: what is none is told instead.
pub fn write_csv(path: &Path, table: &Table) -> Outcome<()> {
    if let Some((row, column)) = table.not_finite() {
        let what = &table.columns[column].name;
        let title = format!("{what} in row {} is no number: {} is not written", row + 1, path.display());
        return Err(Problem::failed(title, "make masses, stiffnesses and positions of a size that a crane has"));
    }
    let header = table.columns.iter().map(ToString::to_string);
    write_fields(path, header, table.rows.iter().map(|row| row.iter().copied().map(number).collect()))
}

/// The shortest text that reads back as the same number.
pub fn number(number: f64) -> String {
    format!("{number:?}")
}

/// Writes a header and rows of fields as CSV.
pub fn write_fields(
    path: &Path,
    header: impl Iterator<Item = String>,
    rows: impl Iterator<Item = Vec<String>>,
) -> Outcome<()> {
    write(path, |file| {
        let mut csv = csv::Writer::from_writer(file);
        csv.write_record(header)?;
        for row in rows {
            csv.write_record(row)?;
        }
        csv.flush()
    })
}

/// Greatest difference of every column from a finer run, by name.
fn differences(recorded: &Recorded, verification: &Verification) -> Map<String, Value> {
    let columns = recorded.table.columns.iter().map(|column| column.name.clone());
    columns.zip(verification.differences.iter().map(|difference| json!(difference))).collect()
}

/// What a run was: enough to repeat it.
pub fn record(rig: &dyn DynCrane, settings: &dynamics::Settings, recorded: &Recorded) -> Value {
    let description = rig.description();
    let parameters: Map<String, Value> = description
        .parameters
        .iter()
        .enumerate()
        .map(|(index, parameter)| {
            (parameter.name.to_string(), json!({"value": rig.parameter(index), "unit": parameter.unit.as_str()}))
        })
        .collect();
    json!({
        "crane": description.name.as_str(),
        "title": description.title.as_str(),
        "spec_hash": description.spec_hash.as_str(),
        "program": env!("CARGO_PKG_NAME"),
        "version": env!("CARGO_PKG_VERSION"),
        "method": settings.method.title(),
        "start": recorded.start,
        "step_s": recorded.run.step,
        "tolerance": settings.method.is_adaptive().then_some(settings.tolerance),
        "steps": recorded.run.statistics.steps,
        "rejected_steps": recorded.run.statistics.rejections,
        "evaluations": recorded.run.statistics.evaluations,
        "factorisations": recorded.run.statistics.factorisations,
        "duration_s": settings.duration,
        "output_s": settings.output,
        "parameters": parameters,
        "cautions": recorded.cautions,
        "differences_from_a_finer_run": recorded.verification.as_ref().map(|verification| differences(recorded, verification)),
        "wall_time_s": recorded.wall.as_secs_f64(),
        "real_time_factor": recorded.real_time_factor(),
    })
}
