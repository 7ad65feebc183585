//! `crane eval`: quantities of a crane at one state or at many.

use std::{
    io::{self, Write},
    path::Path,
};

use crane_codegen::program::Argument;
use crane_live::rows::{BatchEvaluation, ParameterRows};
use crane_live::{FunctionId, LiveCrane, Refusal};
use crane_model::{
    Description, Tree,
    dyn_crane::{DynCrane, Functions},
};
use nalgebra::Matrix4;
use serde_json::{Map, Value};

use crate::{
    arguments::{Eval, EvalFormat, Quantity},
    npz::{Array, npz},
    problem::{Outcome, Problem},
    screen::Console,
    selection::Registry,
};

/// Evaluates and prints or writes.
pub fn eval(options: &Eval, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = registry.live(options.crane.open(registry)?.as_ref())?;
    for quantity in &options.quantities {
        check(*quantity, &crane)?;
    }
    let states = states(&registry.console, options, &crane)?;
    let arrays = arrays(options, &crane, &states);
    let description = crane.description();
    let bytes = match options.format {
        EvalFormat::Json => format!("{}\n", json(description, &arrays)).into_bytes(),
        EvalFormat::Npz => {
            npz(&arrays).map_err(|error| Problem::failed(format!("cannot write the archive: {error}"), ""))?
        }
    };
    match &options.file {
        Some(path) => registry.console.write_file(path, |file| file.write_all(&bytes)),
        None => Ok(out.write_all(&bytes)?),
    }
}

/// Coordinates and rates, state by state.
struct States {
    q: Vec<Vec<f64>>,
    v: Vec<Vec<f64>>,
}

fn states(console: &Console, options: &Eval, crane: &LiveCrane) -> Outcome<States> {
    let description = crane.description();
    let size = description.coordinates.len();
    let guess = || (crane as &dyn DynCrane).guess();
    let q = read_rows_given(console, "q", options.q.as_deref(), description)?.unwrap_or_else(|| vec![guess()]);
    let mut v =
        read_rows_given(console, "v", options.v.as_deref(), description)?.unwrap_or_else(|| vec![vec![0.0; size]]);
    if v.len() == 1 {
        v.resize(q.len(), v[0].clone());
    }
    if v.len() != q.len() {
        return Err(Problem::usage(
            format!("`--q` has {} states, but `--v` has {}", q.len(), v.len()),
            "give one set of velocities per state, or one for all states",
        ));
    }
    Ok(States { q, v })
}

/// Numbers given inline or in a file, one per coordinate of each state.
fn read_rows_given(
    console: &Console,
    name: &str,
    given: Option<&str>,
    description: &Description,
) -> Outcome<Option<Vec<Vec<f64>>>> {
    let Some(text) = given else { return Ok(None) };
    let numbers = parse(text).map_or_else(|| parse_file(console, name, text), Ok)?;
    let wanted = description.coordinates.len();
    if numbers.is_empty() || wanted == 0 || numbers.len() % wanted != 0 {
        let names: Vec<String> =
            description.coordinates.iter().map(|c| format!("{} [{}]", c.name, c.kind.unit())).collect();
        return Err(Problem::usage(
            format!("`--{name}` has {} numbers, but {} has {wanted} coordinates", numbers.len(), description.name),
            format!("write them state by state, in this order: {}", names.join(", ")),
        ));
    }
    Ok(Some(numbers.chunks(wanted).map(<[f64]>::to_vec).collect()))
}

fn parse_file(console: &Console, name: &str, path: &str) -> Outcome<Vec<f64>> {
    let text = console.read_file(Path::new(path)).and_then(|bytes| String::from_utf8(bytes).map_err(io::Error::other));
    let text = text.map_err(|error| {
        Problem::usage(
            format!("`--{name} {path}` is neither a list of numbers nor a file: {error}"),
            "write finite numbers separated by commas, such as 0,0.1,-2e-3, or give a file of them",
        )
    })?;
    parse(&text).ok_or_else(|| {
        Problem::usage(
            format!("{path} contains something other than finite numbers"),
            "separate the numbers by commas or blanks",
        )
    })
}

fn parse(text: &str) -> Option<Vec<f64>> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    words.map(|word| word.parse().ok().filter(|number: &f64| number.is_finite())).collect()
}

/// The states and what is asked for; with several states, the first axis counts them.
fn arrays(options: &Eval, crane: &LiveCrane, states: &States) -> Vec<Array> {
    let size = crane.description().coordinates.len();
    let count = states.q.len();
    let over = |name: &'static str, shape: Vec<usize>, data: Vec<f64>| {
        let shape = if count == 1 { shape } else { [vec![count], shape].concat() };
        Array { name: name.into(), shape, data }
    };
    let mut arrays = vec![over("q", vec![size], states.q.concat()), over("v", vec![size], states.v.concat())];
    for (earlier, quantity) in options.quantities.iter().enumerate() {
        if options.quantities[..earlier].contains(quantity) {
            continue;
        }
        let mut shape = Vec::new();
        let mut data = Vec::new();
        for (q, v) in states.q.iter().zip(&states.v) {
            let (of_one, numbers) = evaluate(*quantity, crane, options.time, q, v);
            shape = of_one;
            data.extend(numbers);
        }
        arrays.push(over(quantity.name(), shape, data));
        arrays.extend(index(*quantity, &(crane as &dyn DynCrane).tree()));
    }
    arrays
}

/// Refuses quantities that do not follow from a state, or that closed loops change.
fn check(quantity: Quantity, crane: &LiveCrane) -> Outcome<()> {
    let refusal = match quantity {
        Quantity::Of(id) if !takes_accelerations(id) || crane.refusal(id).is_some() => crane.refusal(id),
        Quantity::Energies => None,
        _ => crane.description().has_hidden_forces().then_some(Refusal::ForceStates),
    };
    let why = match refusal {
        None => return Ok(()),
        Some(Refusal::ForceStates) => "follows from pressures or bristles, which are states of a run".to_owned(),
        Some(Refusal::TooLarge) => {
            format!("is there up to {} coordinates", LiveCrane::MOST_COORDINATES_OF_DERIVATIVES)
        }
        Some(Refusal::Loop(joint)) => format!("depends on {}", joint.closes()),
    };
    let or = if let Some(Refusal::Loop(joint)) = refusal { joint.remedy() } else { "" };
    Err(Problem::usage(
        format!("`{}` of {} {why}", quantity.name(), crane.description().name),
        format!("ask for other `--quantities`, or simulate: results contain these states and the forces{or}"),
    ))
}

fn takes_accelerations(id: FunctionId) -> bool {
    id.arguments().contains(&Argument::Acceleration)
}

/// Shape and numbers of a quantity at one state.
fn evaluate(quantity: Quantity, live: &LiveCrane, t: f64, q: &[f64], v: &[f64]) -> (Vec<usize>, Vec<f64>) {
    let crane: &dyn DynCrane = live;
    let derivatives: &dyn DynCrane = live;
    match quantity {
        // Only those of coordinates that move a body.
        Quantity::Of(FunctionId::TransformDerivatives) => matrices(&derivatives.transform_derivatives_at(q)),
        Quantity::Of(FunctionId::TransformSecondDerivatives) => {
            matrices(&derivatives.transform_second_derivatives_at(q))
        }
        Quantity::Of(id) => {
            let mut evaluation = BatchEvaluation::<f64>::new(live, id);
            let mut numbers = vec![0.0; evaluation.width()];
            // Those of the motion from this state.
            let a = if takes_accelerations(id) { crane.accelerations_at(t, q, v).as_slice().to_vec() } else { vec![] };
            evaluation.run(&ParameterRows { t: &[t], q, v, a: &a, ..ParameterRows::default() }, 0..1, &mut numbers);
            (live.shape(id), numbers)
        }
        Quantity::Accelerations => list(crane.accelerations_at(t, q, v).as_slice()),
        Quantity::Energies => {
            let energies = crane.energies_at(t, q, v);
            list(&energies.parts(crane.description()).map(|(_, energy)| energy).collect::<Vec<_>>())
        }
        Quantity::DriveEfforts => list(&crane.drive_efforts_at(t, q, v)),
    }
}

fn list(numbers: &[f64]) -> (Vec<usize>, Vec<f64>) {
    (vec![numbers.len()], numbers.to_vec())
}

fn matrices(matrices: &[Matrix4<f64>]) -> (Vec<usize>, Vec<f64>) {
    let data = matrices.iter().flat_map(|matrix| matrix.transpose().as_slice().to_vec()).collect();
    (vec![matrices.len(), 4, 4], data)
}

/// Body and coordinates that belong to each matrix of a list of derivatives.
fn index(quantity: Quantity, tree: &Tree) -> Option<Array> {
    let bodies = (0..tree.parents().len()).map(|body| (body, tree.coordinates(body)));
    let (name, width, rows): (_, _, Vec<Vec<usize>>) = match quantity {
        Quantity::Of(FunctionId::TransformDerivatives) => {
            let rows = bodies.flat_map(|(p, moving)| moving.into_iter().map(move |i| vec![p, i]));
            ("transform_derivatives_index", 2, rows.collect())
        }
        Quantity::Of(FunctionId::TransformSecondDerivatives) => {
            let rows = bodies.flat_map(|(p, moving)| {
                let pairs =
                    |(place, m): (usize, &usize)| moving[place..].iter().map(|n| vec![p, *m, *n]).collect::<Vec<_>>();
                moving.iter().enumerate().flat_map(pairs).collect::<Vec<_>>()
            });
            ("transform_second_derivatives_index", 3, rows.collect())
        }
        _ => return None,
    };
    let shape = vec![rows.len(), width];
    Some(Array { name: name.into(), shape, data: rows.into_iter().flatten().map(|index| index as f64).collect() })
}

fn json(description: &Description, arrays: &[Array]) -> Value {
    let mut object = Map::new();
    object.insert("crane".to_owned(), description.name.as_str().into());
    object.insert("spec_hash".to_owned(), description.spec_hash.as_str().into());
    object.insert("coordinates".to_owned(), description.coordinates.iter().map(|c| c.name.as_str()).collect());
    object.insert("bodies".to_owned(), description.bodies.iter().map(|body| body.name.as_str()).collect());
    object.extend(arrays.iter().map(|array| (array.name.to_string(), array.json())));
    object.into()
}
