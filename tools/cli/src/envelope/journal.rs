//! Ratings that are done, kept in a file while others are computed: what is interrupted goes on where it was.

use std::{
    fs::{self, File, OpenOptions},
    io::{Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use crane_model::envelope::Envelope;

use crate::{
    files,
    problem::{Outcome, Problem},
};

use super::rows::{Layout, Row};

/// A file that grows by whole pieces.
pub struct Journal {
    path: PathBuf,
    file: Mutex<File>,
}

impl Journal {
    /// Opens it, or begins it; what it holds of all poses. `restart`: what it holds is thrown away.
    pub fn open(
        path: &Path,
        request: &str,
        asked: &Envelope,
        layout: &Layout,
        restart: bool,
    ) -> Outcome<(Self, Vec<Option<Row>>)> {
        let at_fault = |error: std::io::Error| Problem::file(path, &error);
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(at_fault)?;
        if matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)) {
            return Err(Problem::failed(
                format!("another command is writing {}", path.display()),
                "wait for it, or choose another folder with `--out`",
            ));
        }
        let mut text = String::new();
        if !restart {
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).map_err(at_fault)?;
            text = String::from_utf8_lossy(&bytes).into_owned();
        }
        // A line without an end was being written when the command ended.
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let mut lines =
            csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(&text.as_bytes()[..whole]);
        let mut records = lines.records().map_while(Result::ok);
        let mut kept: Vec<Option<Row>> = vec![None; asked.axes.poses()];
        match records.next() {
            None => {}
            Some(first) if first.get(0) == Some(request) => {
                for record in records {
                    let fields: Vec<&str> = record.iter().collect();
                    if let Some((pose, row)) = read(&fields, layout).filter(|(pose, _)| *pose < kept.len()) {
                        kept[pose] = Some(row);
                    }
                }
            }
            Some(_) => {
                return Err(Problem::usage(
                    format!(
                        "{} is of an envelope of another crane, other ranges or other limits, which was interrupted",
                        path.display()
                    ),
                    "go on with its arguments, choose another folder with `--out`, or begin again with `--restart`",
                ));
            }
        }
        // A piece counts as a whole.
        for piece in 0..asked.pieces() {
            if asked.poses_of(piece).any(|pose| kept[pose].is_none()) {
                asked.poses_of(piece).for_each(|pose| kept[pose] = None);
            }
        }
        // What follows is added behind the last whole line.
        file.set_len(whole as u64).and_then(|()| file.seek(SeekFrom::End(0))).map_err(at_fault)?;
        if whole == 0 {
            let mut begin = csv::Writer::from_writer(Vec::new());
            begin.write_record([request]).map_err(|error| at_fault(error.into()))?;
            file.write_all(&begin.into_inner().unwrap_or_default()).map_err(at_fault)?;
        }
        Ok((Self { path: path.to_owned(), file: Mutex::new(file) }, kept))
    }

    /// Adds the rows of a piece that begins at pose `begin`.
    pub fn add(&self, begin: usize, rows: &[Row]) -> Outcome<()> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(&lines_of(begin, rows)).map_err(|error| Problem::file(&self.path, &error))
    }

    /// Removes it when all is written elsewhere.
    pub fn remove(self) -> Outcome<()> {
        fs::remove_file(&self.path).map_err(|error| Problem::file(&self.path, &error))
    }
}

/// Lines of rows from a pose on: its number, the limit that governs, all numbers.
fn lines_of(begin: usize, rows: &[Row]) -> Vec<u8> {
    let mut lines = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    for (place, row) in rows.iter().enumerate() {
        let words = [(begin + place).to_string(), row.governing[0].clone(), row.governing[1].clone()];
        let numbers = row.numbers.iter().copied().map(files::number);
        // Into memory nothing fails.
        let _ = lines.write_record(words.into_iter().chain(numbers));
    }
    lines.into_inner().unwrap_or_default()
}

/// A pose and its row.
fn read(fields: &[&str], layout: &Layout) -> Option<(usize, Row)> {
    let [pose, kind, of, numbers @ ..] = fields else { return None };
    let numbers = numbers.iter().map(|number| number.parse().ok()).collect::<Option<Vec<f64>>>()?;
    let whole = numbers.len() == layout.columns.len();
    let governing = [(*kind).to_owned(), (*of).to_owned()];
    Some((pose.parse().ok()?, Row { numbers, governing })).filter(|_| whole)
}
