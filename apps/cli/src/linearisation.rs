//! Small motions about a pose as matrices in a file: `A δq̈ + D δq̇ + K δq = 0`.

use std::path::Path;

use crane_model::{
    Description,
    modes::{SmallMotions, undamped},
};
use serde_json::{Map, Value};

use crate::{
    files,
    npz::{Array, npz},
    problem::{Outcome, Problem},
    screen::Console,
};

/// Writes pose, A, K and D, squares of the undamped angular frequencies and the shapes, `xᵀ A x = 1`, as JSON or as an archive for
/// `numpy.load`. Rows and columns are the coordinates that can move: not those that rigid drives prescribe.
pub fn write_linearisation(
    console: &Console,
    file: &Path,
    description: &Description,
    q: &[f64],
    motions: &SmallMotions,
) -> Outcome<()> {
    let arrays = arrays(q, motions)?;
    if files::ending(file, &["json", "npz"])? == "json" {
        return console.write_text(file, &format!("{:#}\n", json(description, motions, &arrays)));
    }
    let bytes = npz(&arrays).map_err(|error| Problem::failed(format!("cannot make an archive: {error}"), ""))?;
    console.write_file(file, |out| out.write_all(&bytes))
}

fn arrays(q: &[f64], motions: &SmallMotions) -> Outcome<Vec<Array>> {
    let n = motions.unknowns.len();
    let modes = undamped(motions)?;
    let of_unknowns = |shape: &crane_model::nalgebra::DVector<f64>| -> Vec<f64> {
        motions.unknowns.iter().map(|index| shape[*index]).collect()
    };
    Ok(vec![
        Array { name: "pose".into(), shape: vec![q.len()], data: q.to_vec() },
        Array::of_matrix("mass", &motions.mass),
        Array::of_matrix("stiffness", &motions.stiffness),
        Array::of_matrix("damping", &motions.damping),
        Array {
            name: "omega_squared".into(),
            shape: vec![n],
            data: modes.iter().map(|mode| mode.omega_squared).collect(),
        },
        Array {
            name: "shapes".into(),
            shape: vec![n, n],
            data: modes.iter().flat_map(|mode| of_unknowns(&mode.shape)).collect(),
        },
    ])
}

fn json(description: &Description, motions: &SmallMotions, arrays: &[Array]) -> Value {
    let name = |index: &usize| description.coordinates[*index].name.as_str();
    let unit = |index: &usize| description.coordinates[*index].kind.unit();
    let mut object = Map::new();
    object.insert("crane".to_owned(), description.name.as_str().into());
    object.insert("spec_hash".to_owned(), description.spec_hash.as_str().into());
    object.insert("coordinates".to_owned(), motions.unknowns.iter().map(name).collect());
    object.insert("units".to_owned(), motions.unknowns.iter().map(unit).collect());
    object.extend(arrays.iter().map(|array| (array.name.to_string(), array.json())));
    object.into()
}
