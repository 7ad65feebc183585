//! Numbers of a spec as live parameters, by their places.

use crane_codegen::{Diagnostics, SourceFile, WrongPlace};
use crane_model::ParameterInfo;

use crate::LiveCrane;

/// Begins the name of a live parameter that stands for a place of the spec.
const PLACE: &str = "number_at_place_";

/// Why a number cannot be a live parameter.
#[derive(Debug)]
pub enum Refused {
    /// There is no number at the place.
    Place(WrongPlace),
    /// The spec has mistakes if it is one: it determines the structure of the crane, for example.
    Mistakes {
        /// The place.
        place: String,
        /// The mistakes.
        mistakes: Diagnostics,
    },
}

/// The spec in which the numbers at places, such as `links.boom.beam.section.box.height`, are live parameters, whose names replace them in
/// the list; other entries of the list are names of parameters. `None` if the list has no places.
///
/// # Errors
/// A number cannot be a live parameter.
pub fn with_live_numbers(source: &SourceFile, numbers: &mut [String]) -> Result<Option<SourceFile>, Refused> {
    let mut changed = None;
    for (index, number) in numbers.iter_mut().enumerate().filter(|(_, number)| number.contains('.')) {
        let parameter = format!("{PLACE}{index}");
        let before = changed.as_ref().unwrap_or(source);
        let after = before.with_live_number(number, &parameter, unit_of(number)).map_err(Refused::Place)?;
        if let Err(mistakes) = LiveCrane::from_spec(&after) {
            return Err(Refused::Mistakes { place: number.clone(), mistakes });
        }
        changed = Some(after);
        *number = parameter;
    }
    Ok(changed)
}

/// What people call a parameter: its name, or its place in the spec.
#[must_use]
pub fn label(info: &ParameterInfo) -> &str {
    if info.name.starts_with(PLACE) { &info.about } else { &info.name }
}

/// Unit of the number at a place, by the key of the spec; empty where the key has several.
fn unit_of(place: &str) -> &'static str {
    let mut keys = place.rsplit('.').skip_while(|key| key.parse::<usize>().is_ok());
    match keys.next().unwrap_or_default() {
        "length" | "height" | "width" | "thickness" | "flange" | "web" | "diameter" | "at" | "com" | "translation"
        | "a" | "d" | "bore" | "rod" | "stroke" | "retracted" | "rest_length" => "m",
        "mass" => "kg",
        "extra_mass" => "kg/m",
        "density" => "kg/m³",
        "E" | "G" | "yield_stress" | "max_pressure" | "back_pressure" | "bulk_modulus" => "Pa",
        "Ixx" | "Iyy" | "Izz" | "Ixy" | "Ixz" | "Iyz" => "kg m²",
        _ => "",
    }
}
