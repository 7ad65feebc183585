//! The state space that `crane linearise` writes: A, B, C, D with the names and units of states, inputs and outputs.

use crane_live::LiveCrane;
use crane_model::{
    Description,
    dyn_crane::Functions,
    linear::{About, Input, LinearModel, Output, linear_model, outputs},
    nalgebra::DMatrix,
    results::Column,
};
use crane_page::tables::Grid;
use serde_json::{Value, json};

use crate::{
    arguments::Linearise,
    npz::Array,
    problem::{Outcome, Problem, nearest},
};

/// The model about a motion, with all inputs that act and the usual outputs, or with those that are asked for.
pub fn model(crane: &LiveCrane, about: &About<'_>, options: &Linearise) -> Outcome<LinearModel> {
    let inputs = inputs(crane, about, options.acting.as_deref())?;
    let measured = measured(crane, options.measured.as_deref())?;
    linear_model(crane, about, &inputs, &measured).map_err(|none| {
        let title = format!("{}: {none}", crane.description().name);
        Problem::failed(title, "name others with `--on` and `--measure`")
    })
}

fn inputs(crane: &LiveCrane, about: &About<'_>, names: Option<&[String]>) -> Outcome<Vec<Input>> {
    let description = crane.description();
    let Some(names) = names else {
        let acts = |input: &Input| linear_model(crane, about, std::slice::from_ref(input), &[]).is_ok();
        return Ok(Input::all(description).into_iter().filter(acts).collect());
    };
    let known: Vec<String> = Input::all(description).iter().map(|input| input.column(description).name).collect();
    let named = |name: &String| Input::named(name, description).ok_or_else(|| unknown("input", name, &known));
    names.iter().map(named).collect()
}

fn measured(crane: &LiveCrane, names: Option<&[String]>) -> Outcome<Vec<Output>> {
    let all = outputs(crane);
    let Some(names) = names else {
        let is_shown = |(index, output): &(usize, Output)| {
            *index < 2 * crane.size() || is_of_point(output.column.name.as_str(), crane.description())
        };
        return Ok(all.into_iter().enumerate().filter(is_shown).map(|(_, output)| output).collect());
    };
    let known: Vec<String> = all.iter().map(|output| output.column.name.clone()).collect();
    let named = |name: &String| {
        let found = all.iter().find(|output| output.column.name == *name).cloned();
        found.ok_or_else(|| unknown("output", name, &known))
    };
    names.iter().map(named).collect()
}

/// Whether a column is a component of the position of a point.
fn is_of_point(name: &str, description: &Description) -> bool {
    let point = name.rsplit_once('_').filter(|(_, axis)| matches!(*axis, "x" | "y" | "z"));
    point.is_some_and(|(point, _)| description.points.iter().any(|known| known.as_str() == point))
}

fn unknown(what: &str, name: &str, known: &[String]) -> Problem {
    let guess = nearest(name, known.iter().map(String::as_str));
    let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
    Problem::usage(format!("there is no {what} `{name}`"), format!("{guess}{what}s: {}", known.join(", ")))
}

/// Names and units of states, inputs and outputs, and the matrices row by row, for programs.
pub fn value(model: &LinearModel) -> Value {
    let names = |columns: &[Column]| columns.iter().map(|column| column.name.as_str().into()).collect::<Vec<Value>>();
    let units = |columns: &[Column]| columns.iter().map(|column| column.unit.as_str().into()).collect::<Vec<Value>>();
    let matrix = |name, matrix: &DMatrix<f64>| Array::of_matrix(name, matrix).json();
    json!({
        "states": names(&model.states), "state_units": units(&model.states),
        "inputs": names(&model.inputs), "input_units": units(&model.inputs),
        "outputs": names(&model.outputs), "output_units": units(&model.outputs),
        "a": matrix("a", &model.a), "b": matrix("b", &model.b), "c": matrix("c", &model.c), "d": matrix("d", &model.d),
    })
}

/// What A, B, C and D are about.
pub fn signals(model: &LinearModel) -> Grid {
    let title = "State space, dx/dt = A x + B u, y = C x + D u: `--format json` and `-o FILE.npz` have the matrices";
    let mut grid = Grid::new("signals", title, &["of", "index", "name", "unit"]);
    for (of, columns) in [("x", &model.states), ("u", &model.inputs), ("y", &model.outputs)] {
        for (index, column) in columns.iter().enumerate() {
            grid.row([of.into(), (index + 1).into(), column.name.as_str().into(), column.unit.as_str().into()]);
        }
    }
    grid
}
