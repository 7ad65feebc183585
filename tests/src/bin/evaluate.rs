//! Evaluates generated cranes for checks in other languages.
//!
//! `evaluate list` prints the cranes, one per line. `evaluate layout CRANE` describes one as JSON. `evaluate values CRANE` reads records
//! `t, q[N], v[N], parameters[P]` from standard input until its end, and writes for each all quantities in the order of the layout: 64-bit
//! little-endian numbers, matrices row by row. A YAML file instead of a crane's name is run by the interpreter, which provides T, A, e,
//! forces, accelerations, the residual and stiffness of statics, internal forces, and what there is of connectors and loops.

use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;
use std::process::ExitCode;

use crane_codegen::chain::Chain;
use crane_codegen::program::{Argument, Inputs};
use crane_codegen::{build, compile};
use crane_quantities::Count;
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::{State, quantities};
use crane_tests::registry::{self, Entry};
use serde_json::json;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match evaluate_words(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("evaluate: {message}");
            ExitCode::from(2)
        }
    }
}

fn evaluate_words(words: &[&str]) -> Result<(), String> {
    match words {
        ["list"] => {
            for entry in registry::all() {
                println!("{}", entry.name);
            }
            Ok(())
        }
        ["layout", file] if is_spec(file) => {
            println!("{:#}", layout_of_interpreted(&interpreted(file)?, file));
            Ok(())
        }
        ["values", file] if is_spec(file) => {
            let crane = interpreted(file)?;
            let parameters = crane.chain.parameters.len();
            let values = values(crane.size(), parameters, |state, parameters| evaluate(&crane, state, parameters));
            values.map_err(|error| error.to_string())
        }
        ["layout", name] => {
            println!("{:#}", layout(&find(name)?));
            Ok(())
        }
        ["values", name] => {
            let Entry { description, evaluate, .. } = find(name)?;
            let values = values(description.coordinates.len(), description.parameters.len(), evaluate);
            values.map_err(|error| error.to_string())
        }
        _ => Err("write `list`, `layout CRANE` or `values CRANE`".into()),
    }
}

fn find(name: &str) -> Result<Entry, String> {
    registry::all()
        .into_iter()
        .find(|entry| entry.name == name)
        .ok_or(format!("no crane `{name}`; try `evaluate list`"))
}

fn layout(entry: &Entry) -> serde_json::Value {
    let crane = entry.description;
    let parameter = |p: &crane_model::ParameterInfo| json!({"name": p.name.as_str(), "default": p.default});
    let body = |b: &crane_model::BodyInfo| json!({"name": b.name.as_str(), "degrees_of_freedom": b.degrees_of_freedom});
    let quantity = |q: crane_tests::quantities::Quantity| json!({"name": q.name, "length": q.len(), "shape": q.shape});
    json!({
        "name": crane.name.as_str(),
        "spec": entry.spec(),
        "coordinates": crane.coordinates.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(),
        "parameters": crane.parameters.iter().map(parameter).collect::<Vec<_>>(),
        "bodies": crane.bodies.iter().map(body).collect::<Vec<_>>(),
        "points": crane.points.iter().map(crane_model::Text::as_str).collect::<Vec<_>>(),
        "supports": crane.supports.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(),
        "drives": crane.drives.iter().map(|d| d.coordinate).collect::<Vec<_>>(),
        "quantities": quantities(crane).into_iter().map(quantity).collect::<Vec<_>>(),
    })
}

/// Reads states of `n` coordinates and writes what is computed from them.
fn values(n: usize, parameters: usize, evaluate: impl Fn(&State, &[f64]) -> Vec<f64>) -> io::Result<()> {
    let length = 1 + 2 * n + parameters;
    let mut input = BufReader::new(io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    let mut bytes = vec![0; 8 * length];
    loop {
        match input.read_exact(&mut bytes) {
            Ok(()) => {}
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return output.flush(),
            Err(error) => return Err(error),
        }
        let numbers: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|chunk| f64::from_le_bytes(*chunk)).collect();
        let state = State { t: numbers[0], q: numbers[1..=n].to_vec(), v: numbers[n + 1..=2 * n].to_vec() };
        for value in evaluate(&state, &numbers[2 * n + 1..]) {
            output.write_all(&value.to_le_bytes())?;
        }
    }
}

fn is_spec(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "yaml")
}

/// The crane of a YAML file.
fn interpreted(file: &str) -> Result<Interpreted, String> {
    let source = build::open(Path::new(file)).map_err(|error| error.to_string())?;
    Ok(Interpreted::new(compile::load(&source).map_err(|mistakes| mistakes.to_string())?))
}

/// Functions of an interpreted crane, in order, and the shapes of their results.
fn functions(chain: &Chain) -> Vec<(&'static str, Vec<usize>)> {
    let (n, bodies) = (chain.coordinates.len(), chain.bodies.len());
    let [cuts, connectors, equations] =
        [Count::Cuts, Count::Connectors, Count::LoopEquations].map(|count| chain.count(count));
    vec![
        ("transforms", vec![bodies, 4, 4]),
        ("mass_matrix", vec![n, n]),
        ("bias", vec![n]),
        ("forces", vec![n]),
        ("forward_dynamics", vec![n]),
        ("static_residual", vec![n]),
        ("tangent_stiffness", vec![n, n]),
        ("internal_forces", vec![cuts, 6]),
        ("dissipation", vec![1]),
        ("connector_forces", vec![n]),
        ("connector_energy", vec![1]),
        ("connector_lengths", vec![connectors, 2]),
        ("connector_jacobians", vec![connectors, n]),
        ("connector_tensions", vec![connectors, 3]),
        ("connector_wrenches", vec![connectors, cuts, 6]),
        ("loop_states", vec![equations, 3]),
        ("loop_jacobians", vec![equations, n]),
    ]
}

fn layout_of_interpreted(crane: &Interpreted, file: &str) -> serde_json::Value {
    let Chain { name, coordinates, parameters, .. } = &crane.chain;
    let quantity = |(name, shape): (&str, Vec<usize>)| json!({"name": name, "length": shape.iter().product::<usize>(), "shape": shape});
    json!({
        "name": name,
        "file": file,
        "spec": file,
        "coordinates": coordinates.iter().map(|c| &c.name).collect::<Vec<_>>(),
        "parameters": parameters.iter().map(|p| json!({"name": p.name, "default": p.default})).collect::<Vec<_>>(),
        "quantities": functions(&crane.chain).into_iter().map(quantity).collect::<Vec<_>>(),
    })
}

fn evaluate(crane: &Interpreted, state: &State, parameters: &[f64]) -> Vec<f64> {
    // The rates also serve as accelerations.
    let inputs = Inputs::state(state.t, state.q.clone(), state.v.clone(), parameters.to_vec());
    let inputs = inputs.with(Argument::Acceleration, state.v.clone());
    let values = |(name, shape): (&str, Vec<usize>)| crane.get(name, &inputs, shape.iter().product());
    functions(&crane.chain).into_iter().flat_map(values).collect()
}
