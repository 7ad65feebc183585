//! `crane picture`, and `crane export --format gltf`: a crane at rest as the report shows it in 3-D.

use std::{io, io::Write, path::PathBuf};

use crane_model::dyn_crane::DynCrane;
use crane_page::{
    shapes::{
        Figure, gltf,
        picture::{View, draw},
    },
    shown_pose,
    tables::Case,
};

use crate::{
    arguments::{Choice, Export, Picture},
    files,
    problem::{Outcome, Problem},
    selection::Registry,
};

/// Draws a crane into a file.
pub fn picture(options: &Picture, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let view = View::new([options.width, options.height], options.azimuth, options.elevation)
        .map_err(|refused| Problem::usage(refused, "write a size such as `--width 1200 --height 800`"))?;
    options.file.as_deref().map_or(Ok("png"), |file| files::ending(file, &["png"]))?;
    let (name, figure) = figure(&options.crane, registry)?;
    let file = options.file.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.png")));
    let elements = draw(&figure, &view, &[]);
    registry.console.write_file(&file, |file| {
        let [width, height] = view.sides().map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header().and_then(|mut image| image.write_image_data(&elements)).map_err(io::Error::other)
    })?;
    Ok(writeln!(out, "{} written", file.display())?)
}

/// Writes what is drawn of a crane as glTF.
pub fn scene(options: &Export, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let ending = options.file.as_deref().map_or(Ok("gltf"), |file| files::ending(file, &["gltf", "glb"]))?;
    let (name, figure) = figure(&options.crane, registry)?;
    let file = options.file(&name);
    if ending == "glb" {
        registry.console.write_file(&file, |file| file.write_all(&gltf::binary(&figure, &name, files::PROGRAM)))?;
    } else {
        registry.console.write_text(&file, &gltf::text(&figure, &name, files::PROGRAM))?;
    }
    Ok(writeln!(out, "{} written", file.display())?)
}

/// A crane's name, and its shapes at rest or, without an equilibrium, at the guess.
fn figure(choice: &Choice, registry: &Registry) -> Outcome<(String, Figure)> {
    let crane: Box<dyn DynCrane> = choice.open(registry)?;
    let name = crane.description().name.to_string();
    let case = Case::new(&name, crane.as_ref());
    if !case.equilibrium.is_stable() {
        registry.console.remark(&format!("{name} is not at rest as it is drawn: see `crane statics`"));
    }
    let q = shown_pose(crane.as_ref(), &case.equilibrium);
    let figure = Figure::new(&registry.live(crane.as_ref())?, &q, &q);
    Ok((name, figure))
}
