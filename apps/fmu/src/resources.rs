//! What a unit carries in its folder `resources`: the spec, and values of parameters that differ from the spec's.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crane_codegen::{Checked, SourceFile, compile};
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;

use crate::Make;

/// File of the spec.
pub const SPEC: &str = "crane.yaml";
/// File of the parameters at the start: a line `name,value` for each.
pub const PARAMETERS: &str = "parameters.csv";

/// A crane with its parameters at the start, and what is implausible about its spec.
pub struct Opened {
    /// The crane, with the parameters of its spec.
    pub crane: Box<dyn DynCrane>,
    /// The live crane of the spec.
    pub live: LiveCrane,
    /// Values of its live parameters at the start, in the order of the description.
    pub parameters: Vec<f64>,
    /// Warnings as rendered text; empty if there are none.
    pub warnings: String,
}

/// Values of the parameters as the text of a file.
pub fn write_parameters(crane: &dyn DynCrane) -> String {
    let mut text = String::new();
    for (index, parameter) in crane.description().parameters.iter().enumerate() {
        let _ = writeln!(text, "{},{:?}", parameter.name, crane.parameter(index));
    }
    text
}

/// Reads the crane of an unpacked unit, which `make` makes of the spec.
///
/// # Errors
/// A message, if a file cannot be read, the spec has mistakes, or a compiled crane belongs to another spec.
pub fn open(folder: &Path, make: Make) -> Result<Opened, String> {
    // Not by the compiler's reader of files: the text includes the specs that it extends.
    let bytes = read_resource(folder, SPEC)?;
    let source = SourceFile::from_bytes(SPEC, &bytes).map_err(|mistakes| mistakes.to_string())?;
    let Checked { chain, warnings, .. } = compile::check(&source).map_err(|mistakes| mistakes.to_string())?;
    let spec_hash = chain.spec_hash.clone();
    let live = LiveCrane::new(chain);
    let crane = make(&live);
    let compiled_from = &crane.description().spec_hash;
    if *compiled_from != *spec_hash {
        return Err(format!(
            "{SPEC} ({spec_hash}) is not the spec from which this library was compiled ({compiled_from}): change the spec before the export, and export the unit again"
        ));
    }
    let mut parameters: Vec<f64> = crane.parameter_values();
    let bytes = read_resource(folder, PARAMETERS)?;
    let mut known = vec![false; parameters.len()];
    for line in String::from_utf8_lossy(&bytes).lines() {
        let (parameter, value) = read_line(crane.as_ref(), line).ok_or_else(|| format!("{PARAMETERS}: `{line}`"))?;
        (parameters[parameter], known[parameter]) = (value, true);
    }
    if let Some(parameter) = known.iter().position(|known| !known) {
        let name = &crane.description().parameters[parameter].name;
        return Err(format!("{PARAMETERS} has no value of `{name}`: export the unit again"));
    }
    Ok(Opened { crane, live, parameters, warnings: warnings.lines().collect::<Vec<_>>().join("; ") })
}

/// A file of the folder.
fn read_resource(folder: &Path, name: &str) -> Result<Vec<u8>, String> {
    let file = folder.join(name);
    fs::read(&file).map_err(|error| format!("{}: {error}", file.display()))
}

/// Index and value of a parameter.
fn read_line(crane: &dyn DynCrane, line: &str) -> Option<(usize, f64)> {
    let (name, value) = line.split_once(',')?;
    let index = crane.description().parameters.iter().position(|parameter| parameter.name == name)?;
    Some((index, value.parse().ok()?))
}

/// The folder that a URI of FMI 2.0 names: `file:///folder`, `file:/folder` or `file://localhost/folder`.
///
/// # Errors
/// A message, if it is another kind of URI.
pub fn folder_of(uri: &str) -> Result<PathBuf, String> {
    let wrong =
        || format!("the location of the resources is `{uri}`, not a folder on this machine such as file:///folder");
    let rest = uri.strip_prefix("file:").ok_or_else(wrong)?;
    let path = match rest.strip_prefix("//") {
        Some(rest) => rest.strip_prefix("localhost").unwrap_or(rest),
        None => rest,
    };
    if !path.starts_with('/') {
        return Err(wrong());
    }
    let path = decoded(path).ok_or_else(wrong)?;
    // A Windows drive letter, as in file:///C:/folder.
    let with_drive = path.get(2..3) == Some(":");
    Ok(PathBuf::from(if with_drive { &path[1..] } else { &path }))
}

/// Text with `%20` and the like decoded.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let digits = [rest.next()?, rest.next()?];
            bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?);
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_of_folders_are_read() {
        let folder = |uri| folder_of(uri).ok().map(|path| path.to_string_lossy().into_owned());
        assert_eq!(folder("file:///tmp/my%20crane/resources").as_deref(), Some("/tmp/my crane/resources"));
        assert_eq!(folder("file:/tmp/r").as_deref(), Some("/tmp/r"));
        assert_eq!(folder("file://localhost/tmp/r").as_deref(), Some("/tmp/r"));
        assert_eq!(folder("file:///C:/r").as_deref(), Some("C:/r"));
        for wrong in ["", "http://host/r", "file://host/r", "file:///tmp/%zz", "file:///tmp/%2", "resources"] {
            assert_eq!(folder(wrong), None, "{wrong}");
        }
    }
}
