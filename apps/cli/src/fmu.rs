//! `crane export --format fmu`: the spec, its description and the shared library, of live cranes or of this one, in one archive.

use std::{
    borrow::Cow,
    env::{consts, current_exe},
    io::{Cursor, Write},
    path::{Path, PathBuf},
};

use crane_codegen::chain::Chain;
use crane_fmu::{description, resources};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use zip::{CompressionMethod, ZipWriter, result::ZipError, write::SimpleFileOptions};

use crate::{
    arguments::{Export, Fmi},
    compiled,
    problem::{Outcome, Problem},
    screen::Console,
    selection::Registry,
};

/// A shared library and the system that it is for.
struct Library {
    system: &'static Platform,
    content: Cow<'static, [u8]>,
}

/// A system by the ending of its shared libraries; cranes are for computers of 64 bits.
struct Platform {
    suffix: &'static str,
    /// Its name in FMI 2.0.
    with_bits: &'static str,
    /// Its name in FMI 3.0, after that of the processor.
    name: &'static str,
}

const SYSTEMS: [Platform; 3] = [
    Platform { suffix: "so", with_bits: "linux64", name: "linux" },
    Platform { suffix: "dll", with_bits: "win64", name: "windows" },
    Platform { suffix: "dylib", with_bits: "darwin64", name: "darwin" },
];

impl Platform {
    /// Its folder in the archive. In FMI 3.0 it names the processor, which is that of this program.
    fn folder(&self, version: Fmi) -> String {
        match version {
            Fmi::Two => self.with_bits.to_owned(),
            Fmi::Three => format!("{}-{}", consts::ARCH, self.name),
        }
    }
}

/// Writes a crane as a functional mock-up unit.
pub fn write_unit(
    options: &Export,
    file: &Path,
    chain: Chain,
    spec: &str,
    parameters: &[f64],
    registry: &Registry,
    out: &mut dyn Write,
) -> Outcome<()> {
    let (is_compiled, version) = (options.crane.compile, options.fmi.unwrap_or_default());
    let libraries = match options.libraries.as_slice() {
        [] if is_compiled => vec![read_library(&registry.console, &compiled::unit(&registry.console, &chain, spec)?)?],
        [] => vec![own_library(registry)?],
        [..] if is_compiled => {
            return Err(Problem::usage(
                "`--library` names a library that is ready made, `--compile` makes one for this computer",
                "leave one of them out",
            ));
        }
        named => named.iter().map(|path| read_library(&registry.console, path)).collect::<Outcome<_>>()?,
    };
    let mut crane = LiveCrane::new(chain);
    crane.set_parameters(parameters).map_err(|refused| Problem::usage(refused.to_string(), ""))?;
    let content = pack(&crane, spec, &libraries, version)
        .map_err(|error| Problem::failed(format!("{}: {error}", file.display()), "make its libraries smaller"))?;
    registry.console.write_file(file, |file| file.write_all(&content))?;
    let systems: Vec<String> = libraries.iter().map(|library| library.system.folder(version)).collect();
    let (file, size) = (file.display(), content.len() as f64 / 1e6);
    Ok(writeln!(
        out,
        "{file} written: FMI {}, co-simulation{}, {}{}; {size:.1} MB",
        version.number(),
        match crane.loop_joints().first() {
            None => " and model exchange".to_owned(),
            Some(joint) if joint.is_coupling() => format!(" alone because of {}", joint.words()),
            Some(_) => " alone because of its loops".to_owned(),
        },
        if is_compiled { "compiled, " } else { "" },
        systems.join(", ")
    )?)
}

/// The archive.
fn pack(crane: &LiveCrane, spec: &str, libraries: &[Library], version: Fmi) -> Result<Vec<u8>, ZipError> {
    let name = &crane.chain().name;
    let binary =
        |library: &Library| format!("binaries/{}/{name}.{}", library.system.folder(version), library.system.suffix);
    let description = match version {
        Fmi::Two => description::write_fmi2(crane),
        Fmi::Three => description::write_fmi3(crane),
    };
    let texts = [
        ("modelDescription.xml".to_owned(), description),
        (format!("resources/{}", resources::SPEC), spec.to_owned()),
        (format!("resources/{}", resources::PARAMETERS), resources::write_parameters(crane)),
    ];
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (path, text) in &texts {
        archive.start_file(path.as_str(), stored)?;
        archive.write_all(text.as_bytes())?;
    }
    for library in libraries {
        archive.start_file(binary(library), stored.unix_permissions(0o755))?;
        archive.write_all(&library.content)?;
    }
    Ok(archive.finish()?.into_inner())
}

fn read_library(console: &Console, path: &Path) -> Outcome<Library> {
    let ending = path.extension().unwrap_or_default();
    let system = SYSTEMS.iter().find(|system| ending == system.suffix).ok_or_else(|| {
        Problem::usage(format!("{} is not a shared library", path.display()), "give a .so, .dll or .dylib file")
    })?;
    let content = console.read_file(path).map_err(|error| Problem::file(path, &error))?;
    Ok(Library { system, content: content.into() })
}

/// The library for this computer: the one that the command carries, or the file beside it.
fn own_library(registry: &Registry) -> Outcome<Library> {
    let of_this_computer = SYSTEMS.iter().find(|system| system.suffix == consts::DLL_EXTENSION);
    match (registry.carried().unit_library, of_this_computer) {
        (Some(content), Some(system)) => Ok(Library { system, content: content.into() }),
        _ => read_library(&registry.console, &beside_the_command()?),
    }
}

/// The library in the folder of the command.
fn beside_the_command() -> Outcome<PathBuf> {
    let name = format!("{}crane_fmu_library{}", consts::DLL_PREFIX, consts::DLL_SUFFIX);
    let command =
        current_exe().map_err(|error| Problem::failed(format!("cannot find the path of this command: {error}"), ""))?;
    let folder = command.parent().unwrap_or(Path::new("."));
    let path = folder.join(&name);
    path.is_file().then_some(path).ok_or_else(|| {
        let title = format!("there is no {name} in {}", folder.display());
        Problem::failed(title, "build it with `cargo build --release -p crane-fmu-library` and keep it next to the command, or name it with `--library FILE`")
    })
}
