//! Files, written completely or not at all.

use std::{
    env, fs, io,
    io::Write,
    path::{Path, PathBuf},
    sync::PoisonError,
};

use crane_codegen::files;
use crane_model::results::Table;
use crane_page::{Program, tables::number_text};

use crate::{
    problem::{Outcome, Problem},
    screen::Console,
};

/// This program, in records of runs.
pub const PROGRAM: Program = Program { name: env!("CARGO_PKG_NAME"), version: env!("CARGO_PKG_VERSION") };

/// Environment variable with the files that the command has read for a crane's own program.
pub const READ_BEFORE: &str = "CRANE_FILES_READ";

/// The one of some endings that a file has, in letters of either size.
///
/// # Errors
/// It has none of them.
pub fn ending<'e>(path: &Path, endings: &[&'e str]) -> Outcome<&'e str> {
    let written = path.extension().unwrap_or_default();
    endings.iter().find(|ending| written.eq_ignore_ascii_case(ending)).copied().ok_or_else(|| {
        let listed: Vec<String> = endings.iter().map(|ending| format!("`.{ending}`")).collect();
        Problem::usage(
            format!("cannot write {}", path.display()),
            format!("name a file that ends in {}", listed.join(" or ")),
        )
    })
}

/// Creates a folder if it is missing.
///
/// # Errors
/// The file system refuses.
pub fn folder(path: &Path) -> Outcome<()> {
    fs::create_dir_all(path).map_err(|error| Problem::file(path, &error))
}

/// Refuses a header whose columns are separated otherwise than by commas, as spreadsheets write it in some languages.
///
/// # Errors
/// It has semicolons.
pub fn check_separators(path: &Path, headers: &csv::StringRecord) -> Outcome<()> {
    if headers.iter().any(|header| header.contains(';')) {
        return Err(Problem::usage(
            format!("{} has semicolons between columns", path.display()),
            "save it as CSV with commas between columns and decimal points, `900,0.006`",
        ));
    }
    Ok(())
}

impl Console {
    /// Remembers that a file was read, unless it is a device or a pipe.
    pub fn remember(&self, path: &Path) {
        if path.is_file() {
            self.inputs.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
        }
    }

    /// The files that were read, for [`READ_BEFORE`].
    pub fn read_before(&self) -> std::ffi::OsString {
        env::join_paths(self.inputs()).unwrap_or_default()
    }

    fn inputs(&self) -> Vec<PathBuf> {
        let mut inputs = self.inputs.lock().unwrap_or_else(PoisonError::into_inner).clone();
        inputs.extend(env::var_os(READ_BEFORE).iter().flat_map(env::split_paths));
        inputs
    }

    /// Whether a result may be written to this place.
    ///
    /// # Errors
    /// The command has read the file.
    pub fn check_place(&self, path: &Path) -> Outcome<()> {
        if self.inputs().iter().any(|input| files::is_same(input, path)) {
            return Err(Problem::usage(
                format!("{} is an input of this command, which its result would overwrite", path.display()),
                "choose another file or folder for the result",
            ));
        }
        Ok(())
    }

    /// Writes a file completely or not at all; creates its folder if it is missing.
    ///
    /// # Errors
    /// The file system refuses, or the command has read the file.
    pub fn write_file(&self, path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Outcome<()> {
        self.check_place(path)?;
        if let Some(parent) = path.parent().filter(|parent| !parent.as_os_str().is_empty()) {
            folder(parent)?;
        }
        files::write_file(path, content).map_err(|error| Problem::file(path, &error))
    }

    /// Reads a file, unless it is too large or not a file.
    ///
    /// # Errors
    /// The file system refuses, or the file is too large.
    pub fn read_file(&self, path: &Path) -> io::Result<Vec<u8>> {
        /// Many times the results of a long run.
        const MOST_BYTES: usize = 512 << 20;
        self.remember(path);
        files::read_file(path, MOST_BYTES)
    }

    /// A CSV file with a header.
    ///
    /// # Errors
    /// Those of [`Self::read_file`].
    pub fn csv(&self, path: &Path) -> Result<csv::Reader<io::Cursor<Vec<u8>>>, csv::Error> {
        Ok(csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(io::Cursor::new(self.read_file(path)?)))
    }

    /// Writes text.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn write_text(&self, path: &Path, text: &str) -> Outcome<()> {
        self.write_file(path, |file| file.write_all(text.as_bytes()))
    }

    /// Writes a table as CSV, units in the header: `boom_psi [rad]`. Only finite numbers: anything else is an error.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn write_csv(&self, path: &Path, table: &Table) -> Outcome<()> {
        if let Some((row, column)) = table.not_finite() {
            let what = &table.columns[column].name;
            let title = format!("{what} in row {} is not a finite number; {} was not written", row + 1, path.display());
            return Err(Problem::failed(title, "check the units of masses, stiffnesses and positions"));
        }
        let header = table.columns.iter().map(ToString::to_string);
        self.write_fields(path, header, table.rows.iter().map(|row| row.iter().copied().map(number_text).collect()))
    }

    /// Writes a header and rows of fields as CSV.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn write_fields(
        &self,
        path: &Path,
        header: impl Iterator<Item = String>,
        rows: impl Iterator<Item = Vec<String>>,
    ) -> Outcome<()> {
        // The reason of the file system, such as a full disk, is inside the error.
        let reason = |error: csv::Error| match error.into_kind() {
            csv::ErrorKind::Io(reason) => reason,
            other => io::Error::other(format!("{other:?}")),
        };
        self.write_file(path, |file| {
            let mut csv = csv::Writer::from_writer(file);
            csv.write_record(header).map_err(reason)?;
            for row in rows {
                csv.write_record(row).map_err(reason)?;
            }
            csv.flush()
        })
    }
}
