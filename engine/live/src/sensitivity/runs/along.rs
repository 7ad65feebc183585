//! What a run is differentiated by.

use std::error::Error;
use std::fmt;

use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::{CoordinateRole, Description};

use crate::LiveCrane;

/// A number that a run depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// A live parameter, by its index in the description.
    Parameter(usize),
    /// An input that is set.
    Input(usize),
    /// The initial value of a coordinate, m or rad.
    Position(usize),
    /// The initial rate of a coordinate, m/s or rad/s.
    Rate(usize),
}

/// Why a run has no derivative by a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotAlong(String);

impl fmt::Display for NotAlong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Error for NotAlong {}

impl Along {
    /// All numbers that a run of a crane depends on, with their names: live parameters, inputs that are set, and the starts of all coordinates and
    /// rates that no rigid drive prescribes.
    #[must_use]
    pub fn all(crane: &LiveCrane) -> Vec<(String, Self)> {
        let Description { parameters, inputs, coordinates, .. } = crane.description();
        let parameters = parameters.iter().map(|parameter| parameter.name.to_string());
        let inputs = inputs.iter().map(|input| format!("inputs.{}", input.name));
        let starts = ["q0", "v0"]
            .into_iter()
            .flat_map(|part| coordinates.iter().map(move |coordinate| format!("{part}.{}", coordinate.name)));
        let names = parameters.chain(inputs).chain(starts);
        names.filter_map(|name| Self::named(crane, &name).ok().map(|own| (name, own))).collect()
    }

    /// The number of a name: `payload` for a live parameter, `inputs.r` for an input, `q0.boom_psi` and `v0.boom_psi` for the start of a
    /// coordinate and of its rate.
    ///
    /// # Errors
    /// There is no such number, an input is not set, a rigid drive prescribes the coordinate, or the spec allows neither a slightly smaller nor a
    /// slightly larger value of a parameter.
    pub fn named(crane: &LiveCrane, name: &str) -> Result<Self, NotAlong> {
        let description = crane.description();
        let parameter = description.parameters.iter().position(|parameter| parameter.name == name);
        let along = match (parameter, name.split_once('.')) {
            (Some(parameter), _) => Self::Parameter(parameter),
            (_, Some(("inputs", input))) => {
                let index = description.inputs.iter().position(|info| info.name == input);
                let index = index.ok_or_else(|| unknown(description, name))?;
                if crane.input(index).is_none() {
                    return Err(NotAlong(format!(
                        "{name} is not set, so the run does not depend on it: set it, for instance inputs={{\"{input}\": 0}}"
                    )));
                }
                Self::Input(index)
            }
            (_, Some((part @ ("q0" | "v0"), coordinate))) => {
                let index = description.coordinates.iter().position(|info| info.name == coordinate);
                let index = index.ok_or_else(|| unknown(description, name))?;
                if description.coordinates[index].role == CoordinateRole::Prescribed {
                    return Err(NotAlong(format!("{name}: a rigid drive prescribes {coordinate}, also at the start")));
                }
                if part == "q0" { Self::Position(index) } else { Self::Rate(index) }
            }
            _ => return Err(unknown(description, name)),
        };
        if let Self::Parameter(index) = along {
            let value = crane.parameters()[index];
            if super::directions::beside(crane, index).iter().all(Option::is_none) {
                return Err(NotAlong(format!(
                    "{name}: the spec allows no value slightly smaller or larger than {value}, so there is no derivative"
                )));
            }
        }
        Ok(along)
    }
}

/// The names that there are.
fn unknown(description: &Description, name: &str) -> NotAlong {
    let mut words = Vec::new();
    if !description.parameters.is_empty() {
        let names: Vec<&str> = description.parameters.iter().map(|parameter| &*parameter.name).collect();
        words.push(format!("a live parameter ({})", names.join(", ")));
    }
    if !description.inputs.is_empty() {
        let names: Vec<String> = description.inputs.iter().map(|input| format!("inputs.{}", input.name)).collect();
        words.push(format!("an input that is set ({})", names.join(", ")));
    }
    let example = description.coordinates.first().map_or("boom", |coordinate| &*coordinate.name);
    words.push(format!("or the start of a coordinate or its rate, as q0.{example} or v0.{example}"));
    NotAlong(format!("there is no {name:?} to differentiate a run by: write {}", words.join(", ")))
}
