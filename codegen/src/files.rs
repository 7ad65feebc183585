//! Files of users: read within bounds, and written completely or not at all.

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, process};

/// Places of pipes and files that this process was started with, whose names say nothing about what they are.
const GIVEN: [&str; 5] = ["/dev/stdin", "/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"];

/// Opens a file for reading.
///
/// # Errors
/// The file system refuses, or it is a folder, a device or a named pipe, which may never end or begin.
pub fn open(path: &Path) -> io::Result<fs::File> {
    let kind = fs::metadata(path)?.file_type();
    let refused = |what: &str| Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    if kind.is_dir() {
        return refused("it is a folder, not a file");
    }
    if !kind.is_file() && !is_given(path) {
        return refused("it is a device or a named pipe, not a file; a pipe can be given as `/dev/stdin`");
    }
    fs::File::open(path)
}

/// The bytes of a file; at most `most`.
///
/// # Errors
/// Those of [`open`], or the file is larger.
pub fn read_file(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let limit = u64::try_from(most).unwrap_or(u64::MAX).saturating_add(1);
    open(path)?.take(limit).read_to_end(&mut bytes)?;
    if bytes.len() > most {
        let what = format!("it is larger than {} MiB", most >> 20);
        return Err(io::Error::new(io::ErrorKind::InvalidData, what));
    }
    Ok(bytes)
}

/// Writes a file beside its place and renames it when it is complete, so that no half-written file is ever visible. A link stays a
/// link: what it names is replaced. Devices and pipes are written to directly.
///
/// # Errors
/// The file system refuses, or the file is write-protected.
pub fn write_file(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let existing = fs::metadata(path).ok();
    if is_given(path) || existing.as_ref().is_some_and(|of| !of.is_file() && !of.is_dir()) {
        let mut file = io::BufWriter::new(fs::File::options().write(true).open(path)?);
        content(&mut file)?;
        return file.flush();
    }
    if let Some(of) = &existing {
        if of.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if of.permissions().readonly() {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
    }
    let target = linked(path);
    let mut name = target.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", process::id()));
    let part = target.with_file_name(name);
    let written = (|| {
        remove_stale_parts(&target);
        let file = fs::File::create(&part)?;
        // Locked while this process lives. A file system without locks does without.
        let _ = file.try_lock();
        let mut file = io::BufWriter::new(file);
        content(&mut file)?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        if let Some(of) = existing {
            file.set_permissions(of.permissions())?;
        }
        file.sync_all()?;
        fs::rename(&part, &target)
    })();
    written.inspect_err(|_| {
        // Remove the incomplete file; the first error is reported.
        let _ = fs::remove_file(&part);
    })
}

/// Whether two paths name one file that exists.
#[must_use]
pub fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| fs::canonicalize(path).ok();
    real(one).is_some_and(|one| real(other).is_some_and(|other| one == other))
}

fn is_given(path: &Path) -> bool {
    GIVEN.iter().any(|folder| path.starts_with(folder))
}

/// The place to which links lead, whether something is there or not.
fn linked(path: &Path) -> PathBuf {
    /// As many links follow each other on common systems.
    const MOST_LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&target) else { break };
        target = target.parent().map_or(next.clone(), |folder| folder.join(&next));
    }
    target
}

/// Removes incomplete versions of a file that killed commands left: those that no living process has locked.
fn remove_stale_parts(path: &Path) {
    /// The owner of a younger one may be about to lock it.
    const AGE: Duration = Duration::from_secs(1);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let begin = format!("{}.", path.file_name().unwrap_or_default().to_string_lossy());
    let is_stale = |part: &Path| {
        let name = part.file_name().unwrap_or_default().to_string_lossy();
        let number = name.strip_prefix(&begin).and_then(|rest| rest.strip_suffix(".part"));
        let is_part = number.is_some_and(|number| !number.is_empty() && number.chars().all(|c| c.is_ascii_digit()));
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

#[cfg(test)]
mod tests {
    use std::time::SystemTime;

    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("crane-files-{name}-{}", process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn write_text(path: &Path, text: &str) -> io::Result<()> {
        write_file(path, |file| file.write_all(text.as_bytes()))
    }

    #[test]
    fn stale_parts_go_and_others_stay() {
        let folder = folder("parts");
        let parts = ["table.csv.4194999.part", "table.csv.4194998.part", "table.csv.notes.part", "other.csv.1.part"];
        let [stale, held, notes, other] = parts.map(|name| folder.join(name));
        for part in [&stale, &held, &notes, &other] {
            fs::write(part, "half").unwrap();
            let file = fs::File::options().write(true).open(part).unwrap();
            // Two seconds after a command was killed, the next one clears up.
            file.set_modified(SystemTime::now() - Duration::from_secs(2)).unwrap();
        }
        let owner = fs::File::open(&held).unwrap();
        owner.try_lock().unwrap();
        write_text(&folder.join("table.csv"), "whole").unwrap();
        assert_eq!(fs::read_to_string(folder.join("table.csv")).unwrap(), "whole");
        assert_eq!([&stale, &held, &notes, &other].map(|part| part.exists()), [false, true, true, true]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = folder("links");
        let [real, link, second, missing, dangling] =
            ["real.html", "link.html", "second.html", "missing.html", "dangling.html"].map(|name| folder.join(name));
        fs::write(&real, "old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o600)).unwrap();
        symlink("real.html", &link).unwrap();
        symlink("link.html", &second).unwrap();
        symlink("missing.html", &dangling).unwrap();
        write_text(&second, "new").unwrap();
        write_text(&dangling, "made").unwrap();
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert_eq!(fs::read_to_string(&missing).unwrap(), "made");
        assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o600);
        for path in [&link, &second, &dangling] {
            assert!(fs::symlink_metadata(path).unwrap().is_symlink(), "{}", path.display());
        }
        fs::set_permissions(&real, fs::Permissions::from_mode(0o400)).unwrap();
        assert_eq!(write_text(&real, "again").unwrap_err().kind(), io::ErrorKind::PermissionDenied);
        assert_eq!(write_text(&folder, "again").unwrap_err().kind(), io::ErrorKind::IsADirectory);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_stay_devices() {
        let full = Path::new("/dev/full");
        assert_eq!(write_text(full, "x").unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert!(!fs::metadata(full).unwrap().is_file());
        write_text(Path::new("/dev/null"), "x").unwrap();
        assert!(read_file(Path::new("/dev/zero"), 1 << 20).unwrap_err().to_string().contains("device"));
        let folder = folder("large");
        let large = folder.join("large.csv");
        fs::File::create(&large).unwrap().set_len((3 << 20) + 1).unwrap();
        assert!(read_file(&large, 3 << 20).unwrap_err().to_string().contains("larger than 3 MiB"));
        assert_eq!(read_file(&large, (3 << 20) + 1).unwrap().len(), (3 << 20) + 1);
        fs::remove_dir_all(folder).unwrap();
    }
}
