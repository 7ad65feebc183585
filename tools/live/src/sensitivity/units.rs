//! Units of the numbers of a spec, by their places.

use crane_codegen::SourceFile;
use crane_model::{CoordinateKind, Description};

/// Unit of the number at a place such as `links.boom.beam.section.box.height`, in SI; empty for a number without one.
///
/// | key of the spec | what decides |
/// |---|---|
/// | `drives`, `stops`, `friction`, `damping`, `armature`, `guess` | whether the coordinate turns or slides |
/// | `couplings` | the same of both coordinates |
/// | others | the last key, and what it belongs to |
#[must_use]
pub fn unit_at(place: &str, source: &SourceFile, description: &Description) -> &'static str {
    let keys: Vec<&str> = place.split('.').collect();
    let component = keys.last().and_then(|key| key.parse::<usize>().ok());
    let words: Vec<&str> = keys.iter().copied().filter(|key| key.parse::<usize>().is_err()).collect();
    let (Some(&list), Some(&key)) = (words.first(), words.last()) else { return "" };
    let named = |key: &str| {
        let entry = keys.get(1).copied().unwrap_or_default();
        let coordinate = source.text_at(&format!("{list}.{entry}.{key}")).unwrap_or_else(|| entry.to_owned());
        kind_of(&coordinate, description)
    };
    match list {
        "stops" if key == "damping" => match named("coordinate") {
            CoordinateKind::Rotation => "s/rad",
            CoordinateKind::Translation => "s/m",
        },
        "damping" => of_joint("damping", named("coordinate")),
        "armature" => of_joint("armature", named("coordinate")),
        "guess" => named("coordinate").unit(),
        "couplings" if key == "ratio" => match [named("coordinate"), named("follows")] {
            [CoordinateKind::Translation, CoordinateKind::Rotation] => "m/rad",
            [CoordinateKind::Rotation, CoordinateKind::Translation] => "rad/m",
            _ => "",
        },
        "couplings" if key == "offset" => named("coordinate").unit(),
        "drives" | "stops" | "friction" | "couplings" => of_joint(key, named("coordinate")),
        // Of pins that close loops, and their friction.
        "loop_joints" if is_of_pin(&words, key) => of_joint(key, CoordinateKind::Rotation),
        "gravity" => "m/s²",
        "parameters" | "inputs" => "",
        "run" => "s",
        _ => of_part(&words, key, component),
    }
}

/// Whether a number of a loop joint is one of its turning.
fn is_of_pin(words: &[&str], key: &str) -> bool {
    key == "damping" || words.contains(&"friction")
}

/// Whether a coordinate, or the only joint of a link, turns or slides.
fn kind_of(name: &str, description: &Description) -> CoordinateKind {
    let is_of_link = |own: &str| own.rsplit_once('_').is_some_and(|(link, _)| link == name);
    let own = description.coordinates.iter().find(|coordinate| coordinate.name == name);
    let own = own.or_else(|| description.coordinates.iter().find(|coordinate| is_of_link(&coordinate.name)));
    own.map_or(CoordinateKind::Rotation, |coordinate| coordinate.kind)
}

/// Unit of a number of a joint: its drive, its stops, its friction.
fn of_joint(key: &str, kind: CoordinateKind) -> &'static str {
    let either = |rotation, translation| if kind == CoordinateKind::Rotation { rotation } else { translation };
    match key {
        "begin" | "duration" | "blend" | "ramp" | "times" => "s",
        "from" | "to" | "hold" | "values" | "min" | "max" => kind.unit(),
        "rate" | "max_rate" | "width" | "stribeck" => either("rad/s", "m/s"),
        "stiffness" => either("N m/rad", "N/m"),
        "damping" | "viscous" => either("N m s/rad", "N s/m"),
        "armature" => either("kg m²", "kg"),
        "max_power" => "W",
        "max_effort" | "coulomb" | "breakaway" => kind.force_unit(),
        _ => "",
    }
}

/// Unit of a number of a link, a beam, a cylinder, a connector, a support, a load or a material.
fn of_part(words: &[&str], key: &str, component: Option<usize>) -> &'static str {
    let is_within = |word: &str| words.contains(&word);
    let turns = component == Some(2) && is_within("pads");
    match key {
        _ if is_within("scale") || is_within("opening") => of_factor(key),
        _ if is_within("motion") => of_joint(key, CoordinateKind::Translation),
        "phi" | "theta" | "psi" if is_within("beta") => "s",
        "phi" | "theta" | "psi" if is_within("coefficients") || is_within("damping") => "N m s/rad",
        "phi" | "theta" | "psi" if is_within("stiffness") => "N m/rad",
        "phi" | "theta" | "psi" | "alpha" | "x" | "y" | "z" => "rad",
        "beta" | "lag" => "s",
        "clearance" if turns => "rad",
        "stiffness" if turns => "N m/rad",
        "damping" if turns => "N m s/rad",
        "damping" if words.first() == Some(&"links") && is_within("rope") => "N m s/rad",
        "damping" if is_within("rope") => "s/m",
        "damping" => "N s/m",
        "stiffness" => "N/m",
        "progression" => "N/m³",
        "axial_stiffness" | "force" => "N",
        "moment" => "N m",
        "link" | "rocker" | "pivot" | "length" | "height" | "width" | "thickness" | "flange" | "web" | "diameter"
        | "at" | "com" | "gyration" | "translation" | "a" | "d" | "bore" | "rod" | "stroke" | "retracted"
        | "free_play" | "clearance" => "m",
        "overlap" if is_within("slides_in") => "m",
        "area" | "Ay" | "Az" => "m²",
        "Wy" | "Wz" | "Wt" | "hose_volumes" | "volume" => "m³",
        "Jy" | "Jz" | "Jo" => "m⁴",
        "mass" => "kg",
        "extra_mass" | "mass_per_length" => "kg/m",
        "density" => "kg/m³",
        "Ixx" | "Iyy" | "Izz" | "Ixy" | "Ixz" | "Iyz" => "kg m²",
        "E" | "G" | "yield_stress" | "max_pressure" | "back_pressure" | "bulk_modulus" | "pressure"
        | "pressure_drop" => "Pa",
        "flow" | "max_flow" => "m³/s",
        "leakage" => "m³/(s Pa)",
        "gain" => "1/m",
        _ => "",
    }
}

/// Unit of a number of a motion without one: the factor of a load, the opening of a valve.
fn of_factor(key: &str) -> &'static str {
    match key {
        "begin" | "duration" | "blend" | "ramp" | "times" => "s",
        "rate" => "1/s",
        _ => "",
    }
}
