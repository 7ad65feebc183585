//! `crane export` and `crane import`: cranes for other programs, and from them.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use clap::ValueEnum;
use crane_codegen::{
    Checked,
    chain::{Bound, Chain, Refusal},
    compile,
    compile::NoFunction,
    diagnostic::MAX_BYTES,
    emit_c::{CCode, Precision},
    exchange,
    exchange::{ImportOptions, Imported, Look},
    program::Product,
    read,
};

use crane_live::{LiveCrane, imported::check_import};
use crane_model::{dyn_crane::DynCrane, runs::Start};
use crane_page::shapes::{
    Figure,
    looks::{Surfaces, looks},
};

use crate::{
    arguments::{CNumber, Export, Import, Language},
    fmu, picture,
    problem::{Outcome, Problem},
    selection::Registry,
    spec_file,
    variants::{Edit, edited},
};

/// Writes a crane as URDF, with its springs beside it, as MJCF, in C, or as a functional mock-up unit.
pub fn export(options: &Export, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let is_scene = options.format == Language::Gltf;
    if options.crane.rigid && !is_scene {
        return Err(Problem::usage(
            "`--rigid` is not available with `export`",
            "write a spec that `extends` the crane with `sections: rigid`, and export that",
        ));
    }
    if !options.crane.inputs.is_empty() && !is_scene {
        return Err(Problem::usage(
            "`--input` is not available with `export`",
            "set the input where the exported crane runs, or change its `value` in the spec",
        ));
    }
    for (option, given, language) in options.of_one_language() {
        if given && options.format != language {
            let format = language.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned());
            return Err(Problem::usage(
                format!("`--{option}` is for `--format {format}` alone"),
                format!("leave `--{option}` out"),
            ));
        }
    }
    if is_scene {
        return picture::scene(options, registry, out);
    }
    let source = registry.source(&options.crane.name)?;
    let edit = options.crane.combination.as_deref().map(Edit::Combination);
    let checked = edited(&read(&source).map_err(Problem::mistakes)?, edit.as_slice())?;
    let Checked { chain, spec, .. } = spec_file::warned(&registry.console, checked, options.crane.strict)?;
    let spec = spec.saved().text.clone();
    keep_loops(options, &chain)?;
    let mut parameters = chain.parameter_defaults();
    let known: Vec<(&str, &str)> = chain.parameters.iter().map(|p| (p.name.as_str(), p.unit.as_str())).collect();
    for (index, value) in options.crane.parameters.read(&chain.name, &known)? {
        parameters[index] = value;
    }
    keep_rules(&chain, &parameters)?;
    let file = options.file(&chain.name);
    let mut meshes = Surfaces::new();
    let mut start = None;
    let texts = match options.format {
        Language::Urdf => {
            let (_, looks, surfaces) = shown(&chain, &parameters, &file)?;
            meshes = surfaces;
            let text = exchange::urdf(&chain, &parameters, &looks);
            vec![
                (file.clone(), text.map_err(|failure| Problem::usage(failure.title, failure.help))?),
                (file.with_extension("springs.yaml"), exchange::springs(&chain, &parameters)),
            ]
        }
        Language::Mjcf => {
            let (pose, looks, surfaces) = shown(&chain, &parameters, &file)?;
            let text = exchange::mjcf(&chain, &parameters, &looks, (&pose.q, &pose.what));
            meshes = surfaces;
            start = Some(pose.what);
            vec![(file.clone(), text.map_err(|failure| Problem::failed(failure.title, failure.help))?)]
        }
        Language::C => {
            let by_forces = ["forces", "forward_dynamics"];
            if let Some(name) = options.functions().iter().find(|name| by_forces.contains(&Product::split(name).0))
                && chain.has_force_states()
            {
                return Err(Problem::usage(
                    format!(
                        "`{name}` of {} in C would lack the forces that have states: of cylinders with valves and of joints that stick",
                        chain.name
                    ),
                    "export `bias` and `solve_mass`, and add those forces there; or remove `valve` from the cylinders and `bristle` from the friction",
                ));
            }
            let header = beside(&file)?;
            let code = registry.console.working(&chain, || in_c(options, &chain, &parameters, &header))?;
            vec![(file.with_file_name(header), code.header), (file.clone(), code.source)]
        }
        // Written above: it needs a pose.
        Language::Gltf => Vec::new(),
        Language::Fmu => return fmu::write_unit(options, &file, chain, &spec, &parameters, registry, out),
    };
    for (file, _) in &texts {
        registry.console.check_place(file)?;
    }
    for (file, text) in &texts {
        registry.console.write_text(file, text)?;
        writeln!(out, "{} written", file.display())?;
    }
    for (name, surface) in &meshes {
        registry.console.write_file(&file.with_file_name(name), |file| file.write_all(surface))?;
    }
    if !meshes.is_empty() {
        writeln!(out, "{} written, with {} meshes", folder_of_meshes(&file).display(), meshes.len())?;
    }
    if let Some(start) = start {
        writeln!(out, "Key frame `start`: {start}.")?;
    }
    // The C code covers the whole crane.
    if let (false, Some(text)) = (options.format == Language::C, exchange::approximations(&chain)) {
        writeln!(out, "{text}")?;
    }
    Ok(())
}

/// Start of an exported crane, what is shown of it there, and the files that this needs.
fn shown(chain: &Chain, parameters: &[f64], file: &Path) -> Outcome<(Start, Vec<Look>, Surfaces)> {
    let mut live = LiveCrane::new(chain.clone());
    live.set_parameters(parameters).map_err(|refused| Problem::failed(refused.to_string(), "give another value"))?;
    let start = Start::of_or_guess(&live);
    let figure = Figure::new(&live, &start.q, &start.q);
    let folder = folder_of_meshes(file);
    let folder = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let (looks, meshes) = looks(&figure, &folder);
    Ok((start, looks, meshes))
}

/// The folder beside an exported file with the meshes that it shows.
fn folder_of_meshes(file: &Path) -> PathBuf {
    file.with_extension("meshes")
}

/// Name of the header of a source in C: that of the source with `.h`.
fn beside(source: &Path) -> Outcome<String> {
    let name = source.with_extension("h").file_name().and_then(|name| name.to_str()).map(str::to_owned);
    // What may stand between quotation marks after `#include`.
    let can_include = |name: &String| !name.contains(|c: char| c == '"' || c == '\\' || c.is_control());
    let is_header = source.extension().is_some_and(|end| end == "h");
    name.filter(|name| !is_header && can_include(name)).ok_or_else(|| {
        Problem::usage(
            format!("`{}` cannot be the name of a source in C", source.display()),
            "give it a name such as `crane.c`; the header is written beside it, with `.h`",
        )
    })
}

/// The chosen functions in C.
fn in_c(options: &Export, chain: &Chain, parameters: &[f64], header: &str) -> Outcome<CCode> {
    let precision = match options.precision.unwrap_or_default() {
        CNumber::Double => Precision::Double,
        CNumber::Single => Precision::Single,
    };
    compile::generate_c(chain, &options.functions(), parameters, precision, header).map_err(
        |NoFunction { name, known, with_products }| {
            let products = format!("products with derivatives, `_vjp` and `_jvp`, of {}", with_products.join(", "));
            let help = match Product::split(&name) {
                (_, Some(_)) => format!("it has {products}"),
                _ => format!("it has {}; and {products}", known.join(", ")),
            };
            Problem::usage(format!("{} has no function `{name}` in C", chain.name), help)
        },
    )
}

/// Writes a spec made from URDF or MJCF, and checks it.
pub fn import(options: &Import, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let source = spec_file::open(&registry.console, &options.robot, "give a URDF or MJCF file")?;
    // Files that it includes lie beside it.
    let folder = options.robot.parent().unwrap_or(Path::new("."));
    let mut beside = |file: &str| {
        let bytes = crane_codegen::files::read_file(&folder.join(file), MAX_BYTES).ok()?;
        String::from_utf8(bytes).ok()
    };
    let source = exchange::with_includes(source, &mut beside);
    if let Some(file) = options.spec.as_ref().filter(|file| file.exists() && !options.force) {
        return Err(Problem::usage(
            format!("{} exists", file.display()),
            "give another file with `-o`, or replace it with `--force`; drives and other changes in it would be lost",
        ));
    }
    let imported = exchange::import(&source, &ImportOptions { fixed: options.fixed.clone(), repair: options.repair })
        .map_err(Problem::mistakes)?;
    check_import(&imported).map_err(|deviation| {
        Problem::failed(
            format!("the spec of this robot does not move as its file says: {deviation}"),
            "this is a fault of `crane import`; please report it with the file",
        )
    })?;
    let Imported { spec, left_out, .. } = imported;
    let Some(file) = &options.spec else {
        out.write_all(spec.as_bytes())?;
        // To standard error, not into the spec.
        for remark in &left_out {
            registry.console.remark(remark);
        }
        return Ok(());
    };
    registry.console.write_text(file, &spec)?;
    writeln!(out, "{} written", file.display())?;
    let (Chain { name, bodies, coordinates, .. }, _) = spec_file::load(&registry.console, file, false)?;
    let (file, bodies, coordinates) = (file.display(), bodies.len(), coordinates.len());
    writeln!(out, "{name}: valid; {bodies} bodies, {coordinates} coordinates; next: `crane run {file}`")?;
    for remark in &left_out {
        writeln!(out, "{remark}")?;
    }
    Ok(writeln!(out, "joints without `drives:` swing freely: add some where a joint must not fall")?)
}

/// A problem if values of live parameters break a rule of the spec language.
fn keep_rules(chain: &Chain, values: &[f64]) -> Outcome<()> {
    let mut bounds =
        chain.parameters.iter().zip(values).filter_map(|(p, value)| Some((p, p.lower_bound.as_ref()?, *value)));
    let below = bounds.find(|(_, lower, value)| *value < lower.value || (*value == lower.value && !lower.allowed));
    let refused = match below {
        Some((p, Bound { refusal, .. }, value)) => {
            let Refusal { code, title, .. } = refusal;
            Some((format!("parameter `{}`: {title} {value} [{code}]", p.name), refusal))
        }
        None => chain.broken_relation(values).map(|broken| {
            let Refusal { code, title, .. } = &broken.refusal;
            (format!("{title} [{code}]"), &broken.refusal)
        }),
    };
    refused.map_or(Ok(()), |(title, refusal)| Err(Problem::usage(title, refusal.help.as_str())))
}

/// A problem if C would lack the loops of a crane: other formats have them, or refuse them.
fn keep_loops(options: &Export, chain: &Chain) -> Outcome<()> {
    /// Functions of the equations of motion that have been solved, or of what follows from them.
    const SOLVED: [&str; 3] = ["forward_dynamics", "forward_dynamics_derivatives", "linearise"];
    if !matches!(options.format, Language::C) {
        return Ok(());
    }
    let functions = options.functions();
    let Some(function) = functions.iter().find(|name| SOLVED.contains(&Product::split(name).0)) else {
        return Ok(());
    };
    let (what, or) = match (chain.loop_joints.first(), chain.rigid_couplings.first()) {
        (Some(joint), _) => (format!("`{}`, which closes a loop", joint.name), ""),
        (_, Some(coupling)) => (
            format!("the rigid coupling `{}`", coupling.name),
            ", or give the coupling a `stiffness` instead of `rigid: true`",
        ),
        (None, None) => return Ok(()),
    };
    Err(Problem::usage(
        format!("`{function}` of {} in C would be that of the open chain, without {what}", chain.name),
        format!(
            "export `bias`, `forces`, `solve_mass`, `loop_states` and `loop_jacobians` with `--functions`, and solve for the forces of the loop: docs/manual/loops.md has the formula{or}"
        ),
    ))
}
