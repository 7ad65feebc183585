//! `crane eval`: transforms, their derivatives, A and e at one state.

use std::{fs, io::Write};

use crane_model::{Description, dyn_crane::DynCrane};
use nalgebra::Matrix4;
use serde_json::{Map, Value};

use crate::{
    Fleet,
    arguments::{Eval, EvalFormat},
    files,
    npz::{Array, npz},
    problem::{Outcome, Problem},
};

/// Evaluates and prints or writes.
pub fn eval(options: &Eval, fleet: &Fleet, out: &mut dyn Write) -> Outcome<()> {
    let rig = options.crane.open(fleet)?;
    let description = rig.description();
    let q = state("q", options.q.as_deref(), description)?.unwrap_or_else(|| rig.guess());
    let v = state("v", options.v.as_deref(), description)?.unwrap_or_else(|| vec![0.0; q.len()]);
    let arrays = arrays(rig.as_ref(), &q, &v);
    let bytes = match options.format {
        EvalFormat::Json => format!("{}\n", json(description, &arrays)).into_bytes(),
        EvalFormat::Npz => npz(&arrays).map_err(|error| Problem::failed(format!("no archive: {error}"), ""))?,
    };
    match &options.file {
        Some(path) => files::write(path, |file| file.write_all(&bytes)),
        None => Ok(out.write_all(&bytes)?),
    }
}

/// Numbers given in place or in a file, one a coordinate.
fn state(name: &str, given: Option<&str>, description: &Description) -> Outcome<Option<Vec<f64>>> {
    let Some(given) = given else { return Ok(None) };
    let numbers = parse(given).map_or_else(|| parse_file(name, given), Ok)?;
    let wanted = description.coordinates.len();
    if numbers.len() != wanted {
        let names: Vec<String> =
            description.coordinates.iter().map(|c| format!("{} [{}]", c.name, c.kind.unit())).collect();
        return Err(Problem::usage(
            format!("`--{name}` has {} numbers, {} has {wanted} coordinates", numbers.len(), description.name),
            format!("in this order: {}", names.join(", ")),
        ));
    }
    Ok(Some(numbers))
}

fn parse_file(name: &str, path: &str) -> Outcome<Vec<f64>> {
    let text = fs::read_to_string(path).map_err(|error| {
        Problem::usage(
            format!("`--{name} {path}` is neither a list of numbers nor a file: {error}"),
            "write finite numbers separated by commas, such as 0,0.1,-2e-3, or name a file of them",
        )
    })?;
    parse(&text).ok_or_else(|| {
        Problem::usage(
            format!("{path} holds something else than finite numbers"),
            "separate numbers by commas or blanks",
        )
    })
}

fn parse(text: &str) -> Option<Vec<f64>> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    words.map(|word| word.parse().ok().filter(|number: &f64| number.is_finite())).collect()
}

fn arrays(rig: &dyn DynCrane, q: &[f64], v: &[f64]) -> Vec<Array> {
    let bodies = &rig.description().bodies;
    let n = q.len();
    let first = bodies.iter().enumerate().flat_map(|(p, body)| (0..body.degrees_of_freedom).map(move |i| vec![p, i]));
    let second = bodies.iter().enumerate().flat_map(|(p, body)| {
        let count = body.degrees_of_freedom;
        (0..count).flat_map(move |m| (m..count).map(move |n| vec![p, m, n]))
    });
    let mass = rig.mass_matrix_at(q);
    vec![
        Array { name: "q", shape: vec![n], data: q.to_vec() },
        Array { name: "v", shape: vec![n], data: v.to_vec() },
        matrices("transforms", &rig.transforms_at(q)),
        matrices("transform_derivatives", &rig.transform_derivatives_at(q)),
        index("transform_derivatives_index", first.collect(), 2),
        matrices("transform_second_derivatives", &rig.transform_second_derivatives_at(q)),
        index("transform_second_derivatives_index", second.collect(), 3),
        Array { name: "mass_matrix", shape: vec![n, n], data: mass.transpose().as_slice().to_vec() },
        Array { name: "bias", shape: vec![n], data: rig.bias_at(q, v).as_slice().to_vec() },
    ]
}

fn matrices(name: &'static str, matrices: &[Matrix4<f64>]) -> Array {
    let data = matrices.iter().flat_map(|matrix| matrix.transpose().as_slice().to_vec()).collect();
    Array { name, shape: vec![matrices.len(), 4, 4], data }
}

/// Body and coordinates that belong to each matrix of a list.
fn index(name: &'static str, rows: Vec<Vec<usize>>, width: usize) -> Array {
    let shape = vec![rows.len(), width];
    Array { name, shape, data: rows.into_iter().flatten().map(|index| index as f64).collect() }
}

fn json(description: &Description, arrays: &[Array]) -> Value {
    let mut object = Map::new();
    object.insert("crane".to_owned(), description.name.as_str().into());
    object.insert("spec_hash".to_owned(), description.spec_hash.as_str().into());
    object.insert("coordinates".to_owned(), description.coordinates.iter().map(|c| c.name.as_str()).collect());
    object.insert("bodies".to_owned(), description.bodies.iter().map(|body| body.name.as_str()).collect());
    object.extend(arrays.iter().map(|array| (array.name.to_owned(), array.json())));
    object.into()
}
