//! Results kept in a file while others are computed, so that an interrupted command continues.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use crane_model::dyn_crane::DynCrane;

use crate::problem::{Outcome, Problem};

/// A file that grows by complete records: lines of CSV whose fields contain no line ends.
pub struct Journal {
    path: PathBuf,
    file: Mutex<File>,
}

/// Everything that the results depend on, and what messages say about it.
pub struct Request<'a> {
    /// Crane, settings and cases as one line: an interrupted command continues only if this is the same.
    pub line: String,
    /// What the file belongs to, such as "an envelope".
    pub of: &'a str,
    /// How to write to another place instead.
    pub elsewhere: &'a str,
}

/// Version of the program, spec, parameters and inputs of a crane: the part that all requests share.
pub fn identity(crane: &dyn DynCrane) -> String {
    let description = crane.description();
    let parameters: Vec<f64> = crane.parameter_values();
    let inputs: Vec<Option<f64>> = (0..description.inputs.len()).map(|index| crane.input(index)).collect();
    format!("{} {} {parameters:?} {inputs:?}", env!("CARGO_PKG_VERSION"), description.spec_hash)
}

impl Journal {
    /// Opens the file or creates it; returns the records that it contains. `restart`: discard them.
    pub fn open(path: &Path, request: &Request<'_>, restart: bool) -> Outcome<(Self, Vec<Vec<String>>)> {
        let at_fault = |error: io::Error| Problem::file(path, &error);
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(at_fault)?;
        if matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)) {
            let help = format!("wait for it, or {}", request.elsewhere);
            return Err(Problem::failed(format!("another command is writing {}", path.display()), help));
        }
        let mut bytes = Vec::new();
        if !restart {
            file.read_to_end(&mut bytes).map_err(at_fault)?;
        }
        // A line without an end was being written when the command ended.
        bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
        let mut records = records(&bytes);
        if records.first().is_some_and(|first| *first != [request.line.as_str()]) {
            return Err(Problem::usage(
                format!("{} belongs to {} with other arguments, which was interrupted", path.display(), request.of),
                format!("continue with its arguments, {}, or discard it with `--restart`", request.elsewhere),
            ));
        }
        // New records follow the last complete one.
        file.set_len(bytes.len() as u64).and_then(|()| file.seek(SeekFrom::End(0))).map_err(at_fault)?;
        let journal = Self { path: path.to_owned(), file: Mutex::new(file) };
        if records.is_empty() {
            journal.add([vec![request.line.clone()]])?;
        } else {
            records.remove(0);
        }
        Ok((journal, records))
    }

    /// Adds records.
    pub fn add(&self, records: impl IntoIterator<Item = Vec<String>>) -> Outcome<()> {
        let mut lines = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
        for record in records {
            // Writing into memory does not fail.
            let _ = lines.write_record(record);
        }
        let lines = lines.into_inner().unwrap_or_default();
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(&lines).map_err(|error| Problem::file(&self.path, &error))
    }

    /// Removes the file once everything is written elsewhere.
    pub fn remove(self) -> Outcome<()> {
        fs::remove_file(&self.path).map_err(|error| Problem::file(&self.path, &error))
    }
}

/// Records of complete lines.
fn records(lines: &[u8]) -> Vec<Vec<String>> {
    let mut csv = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(lines);
    let fields = |record: csv::StringRecord| record.iter().map(str::to_owned).collect();
    csv.records().map_while(Result::ok).map(fields).collect()
}
