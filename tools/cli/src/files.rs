//! Files, written completely or not at all.

use std::{
    fs, io,
    io::Write,
    path::{Path, PathBuf},
    process,
    time::Duration,
};

use crane_model::results::Table;
use crane_page::{Program, tables::number_text};

use crate::problem::{Outcome, Problem};

/// This program, in records of runs.
pub const PROGRAM: Program = Program { name: env!("CARGO_PKG_NAME"), version: env!("CARGO_PKG_VERSION") };

/// Creates a folder if it is missing.
///
/// # Errors
/// The file system refuses.
pub fn folder(path: &Path) -> Outcome<()> {
    fs::create_dir_all(path).map_err(|error| Problem::file(path, &error))
}

/// Writes a file under another name and renames it when it is complete, so that no half-written file is ever visible.
///
/// # Errors
/// The file system refuses.
pub fn write(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Outcome<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", process::id()));
    let part: PathBuf = path.with_file_name(name);
    let written = (|| {
        remove_stale_parts(path);
        let file = fs::File::create(&part)?;
        // Locked while this process lives. A file system without locks does without.
        let _ = file.try_lock();
        let mut file = io::BufWriter::new(file);
        content(&mut file)?;
        file.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()?;
        fs::rename(&part, path)
    })();
    written.map_err(|error| {
        // Remove the incomplete file; the first error is reported.
        let _ = fs::remove_file(&part);
        Problem::file(path, &error)
    })
}

/// Removes incomplete files that killed commands left: those that no living process has locked.
fn remove_stale_parts(path: &Path) {
    /// The owner of a younger file may be about to lock it.
    const AGE: Duration = Duration::from_secs(60);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let begin = format!("{}.", path.file_name().unwrap_or_default().to_string_lossy());
    let is_stale = |part: &Path| {
        let name = part.file_name().unwrap_or_default().to_string_lossy();
        let number = name.strip_prefix(&begin).and_then(|rest| rest.strip_suffix(".part"));
        let is_part = number.is_some_and(|number| number.chars().all(|c| c.is_ascii_digit()));
        is_part
            && fs::File::open(part).is_ok_and(|file| {
                let old = file
                    .metadata()
                    .and_then(|of| of.modified())
                    .is_ok_and(|at| at.elapsed().is_ok_and(|age| age > AGE));
                old && file.try_lock().is_ok()
            })
    };
    for part in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if is_stale(&part) {
            let _ = fs::remove_file(part);
        }
    }
}

/// Writes text.
///
/// # Errors
/// The file system refuses.
pub fn write_text(path: &Path, text: &str) -> Outcome<()> {
    write(path, |file| file.write_all(text.as_bytes()))
}

/// Writes a table as CSV, units in the header: `boom_psi [rad]`. Only finite numbers: anything else is an error.
///
/// # Errors
/// The file system refuses.
pub fn write_csv(path: &Path, table: &Table) -> Outcome<()> {
    if let Some((row, column)) = table.not_finite() {
        let what = &table.columns[column].name;
        let title = format!("{what} in row {} is not a finite number; {} was not written", row + 1, path.display());
        return Err(Problem::failed(title, "check the units of masses, stiffnesses and positions"));
    }
    let header = table.columns.iter().map(ToString::to_string);
    write_fields(path, header, table.rows.iter().map(|row| row.iter().copied().map(number_text).collect()))
}

/// Writes a header and rows of fields as CSV.
///
/// # Errors
/// The file system refuses.
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

#[cfg(test)]
mod tests {
    use std::{env, fs, time::SystemTime};

    use super::*;

    #[test]
    fn stale_parts_go_and_others_stay() {
        let folder = env::temp_dir().join(format!("crane-parts-{}", process::id()));
        fs::create_dir_all(&folder).unwrap();
        let parts = ["table.csv.4194999.part", "table.csv.4194998.part", "table.csv.notes.part", "other.csv.1.part"];
        let [stale, held, notes, other] = parts.map(|name| folder.join(name));
        for part in [&stale, &held, &notes, &other] {
            fs::write(part, "half").unwrap();
            let file = fs::File::options().write(true).open(part).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(3600)).unwrap();
        }
        let owner = fs::File::open(&held).unwrap();
        owner.try_lock().unwrap();
        write_text(&folder.join("table.csv"), "whole").unwrap();
        assert_eq!(fs::read_to_string(folder.join("table.csv")).unwrap(), "whole");
        assert_eq!([&stale, &held, &notes, &other].map(|part| part.exists()), [false, true, true, true]);
        fs::remove_dir_all(folder).unwrap();
    }
}
