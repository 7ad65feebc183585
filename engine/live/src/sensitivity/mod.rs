//! Derivatives of a crane at rest by its live parameters, without differences.
//!
//! With the forces `F = ∂E_p/∂q + Jᵀ λ` and the gaps φ of loops, the pose at rest changes with a parameter p by
//!
//! ```text
//! [∂F/∂q  Jᵀ] [dq]     [∂F/∂p]
//! [J      0 ] [dλ] = − [∂φ/∂p] dp
//! ```
//!
//! in the coordinates that are not prescribed; prescribed ones move with their drives. All functions run on numbers with slopes in eight
//! directions, first along the coordinates, then along the parameters, and at last along (dp, dq, dλ), where they give outputs with their
//! derivatives. Feet, ropes and stops act as they do at rest: a derivative ends where one of them lets go, or where another place governs.
//!
//! | module | content |
//! |---|---|
//! | `source` | functions of the crane on numbers with slopes |
//! | `rest` | how pose and forces of loops move with the parameters |
//! | `outputs` | what a user reads: positions, efforts, reactions |
//! | `strength` | stresses of beams, tipping |
//! | `frequencies` | undamped frequencies |
//! | `places` | numbers of the spec as live parameters |
//! | `largest_load` | the largest load within limits, as a further output |
//! | `differences` | numbers of the spec that cannot be live parameters |
//! | `runs` | the same over a run |
//! | `whole` | what a whole change does that the derivatives do not show |

mod differences;
mod frequencies;
mod largest_load;
mod outputs;
mod places;
mod rest;
pub mod runs;
mod source;
mod strength;
mod whole;

use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::runs::{Failed, Reason};
use crane_model::statics::{self, Equilibrium, Problem};

use crate::LiveCrane;
use crate::dual::{DIRECTIONS, Dual8};
pub use differences::{Changing, Differences, FixedNumber};
use frequencies::Frequencies;
pub use largest_load::{LargestLoad, NoLargestLoad};
pub use places::{Refused, label, with_live_numbers};
use rest::Rest;
use source::Source;
use strength::Strength;
pub use whole::cautions;

/// What kind of quantity an output is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Positions of points of interest.
    Points,
    /// How far these are from where they are with rigid beams.
    Deflections,
    /// Torques and forces of drives.
    Drives,
    /// Lengths, forces and pressures of cylinders.
    Cylinders,
    /// Lengths and forces of connectors.
    Connectors,
    /// Forces and moments of joints that close loops.
    Loops,
    /// Reactions of supports, and gaps under them.
    Supports,
    /// Stresses and utilisation of beams.
    Stresses,
    /// Distance from tipping.
    Tipping,
    /// Undamped frequencies.
    Frequencies,
    /// The largest load within limits.
    Load,
    /// Columns of a run.
    Run,
}

impl Group {
    /// All of them.
    pub const ALL: [Group; 12] = [
        Group::Points,
        Group::Deflections,
        Group::Drives,
        Group::Cylinders,
        Group::Connectors,
        Group::Loops,
        Group::Supports,
        Group::Stresses,
        Group::Tipping,
        Group::Frequencies,
        Group::Load,
        Group::Run,
    ];

    /// Its name in results and options.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Group::Points => "points",
            Group::Deflections => "deflections",
            Group::Drives => "drives",
            Group::Cylinders => "cylinders",
            Group::Connectors => "connectors",
            Group::Loops => "loops",
            Group::Supports => "supports",
            Group::Stresses => "stresses",
            Group::Tipping => "tipping",
            Group::Frequencies => "frequencies",
            Group::Load => "load",
            Group::Run => "run",
        }
    }
}

/// A quantity of a crane at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its name: that of the column of a run, if there is one.
    pub name: String,
    /// Its unit in SI; empty for a number without one.
    pub unit: &'static str,
    /// What kind of quantity it is.
    pub group: Group,
    /// For a largest or smallest value, the place where it is; for a frequency, the coordinates that vibrate; otherwise empty.
    pub place: String,
}

/// A quantity with its value and slopes.
type Valued = (Output, Dual8);

/// How the quantities of a crane at rest change with its live parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The pose at rest, m and rad.
    pub q: Vec<f64>,
    /// The parameters, by their indices in the description.
    pub parameters: Vec<usize>,
    /// The quantities.
    pub outputs: Vec<Output>,
    /// Their values.
    pub values: Vec<f64>,
    /// Their derivatives, one list per parameter.
    pub derivatives: Vec<Vec<f64>>,
    /// Derivatives of the pose, one list per parameter.
    pub pose: Vec<Vec<f64>>,
    /// What is not among the outputs, and why; and what to know about a derivative.
    pub notes: Vec<String>,
}

impl Sensitivity {
    /// Index of the output of a name.
    #[must_use]
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|output| output.name == name)
    }

    /// Adds how far the points of interest are from those of the same crane with rigid beams, whose derivatives are by the same parameters:
    /// `w = |r − r_rigid|`, `dw = (r − r_rigid)/w · d(r − r_rigid)`.
    pub fn add_deflections(&mut self, rigid: &Sensitivity) {
        /// Less is rounding, m.
        const NOTHING: f64 = 1e-12;
        let axes: Vec<(String, [usize; 3])> = (0..self.outputs.len())
            .filter_map(|index| {
                let output = &self.outputs[index];
                let point = output.name.strip_suffix("_x").filter(|_| output.group == Group::Points)?;
                Some((point.to_owned(), [index, index + 1, index + 2]))
            })
            .collect();
        for (point, axes) in axes {
            let others = axes.map(|index| rigid.index_of(&self.outputs[index].name));
            let [Some(x), Some(y), Some(z)] = others else { continue };
            let difference = |own: &[f64], other: &[f64]| [0, 1, 2].map(|k| own[axes[k]] - other[[x, y, z][k]]);
            let moved = difference(&self.values, &rigid.values);
            let distance = moved.iter().map(|component| component * component).sum::<f64>().sqrt();
            if distance < NOTHING {
                continue;
            }
            for (own, other) in self.derivatives.iter_mut().zip(&rigid.derivatives) {
                let change = difference(own, other);
                own.push(moved.iter().zip(change).map(|(moved, change)| moved * change).sum::<f64>() / distance);
            }
            let name = format!("{point}_deflection");
            self.outputs.push(Output { name, unit: "m", group: Group::Deflections, place: String::new() });
            self.values.push(distance);
        }
    }
}

/// What to compute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Number of lowest frequencies.
    pub frequencies: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { frequencies: 3 }
    }
}

/// Derivatives of the quantities of a crane at rest at t = 0 with respect to live parameters, which are given by their indices.
///
/// # Errors
/// The crane has no stable equilibrium.
pub fn sensitivity(crane: &LiveCrane, parameters: &[usize], settings: &Settings) -> Result<Sensitivity, Failed> {
    let any: &dyn DynCrane = crane;
    at_rest(crane, parameters, *settings, &any.equilibrium(&statics::Settings::default()))
}

/// As [`sensitivity`], for a pose at rest near another one.
///
/// # Errors
/// The crane has no stable equilibrium there.
pub fn sensitivity_near(
    crane: &LiveCrane,
    parameters: &[usize],
    settings: &Settings,
    q: &[f64],
) -> Result<Sensitivity, Failed> {
    let any: &dyn DynCrane = crane;
    at_rest(crane, parameters, *settings, &Problem::new(any).from(q).solve())
}

/// At an equilibrium that was found.
fn at_rest(
    crane: &LiveCrane,
    parameters: &[usize],
    settings: Settings,
    equilibrium: &Equilibrium,
) -> Result<Sensitivity, Failed> {
    let any: &dyn DynCrane = crane;
    let name = &crane.description().name;
    if !equilibrium.is_stable() {
        return Err(Reason::no_equilibrium(any, equilibrium).for_crane(name));
    }
    let mut source = Source::new(crane);
    let Some(rest) = Rest::new(&mut source, equilibrium.q.clone()) else {
        return Err(Reason::Undetermined.for_crane(name));
    };
    let (mut derivatives, mut pose, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    let strength = Strength::new(&mut source, &rest, &mut notes);
    let frequencies = Frequencies::new(&mut source, &rest, settings.frequencies, &mut notes);
    let of = |source: &mut Source<'_>, q: &[Dual8], multipliers: &[Dual8]| -> Vec<Valued> {
        let mut outputs = outputs::outputs(source, &rest, q, multipliers);
        outputs.extend(strength.iter().flat_map(|strength| strength.outputs(source, q, multipliers)));
        outputs.extend(frequencies.iter().flat_map(|modes| modes.outputs(source, q, multipliers)));
        outputs
    };
    let fixed = |numbers: &[f64]| -> Vec<Dual8> { numbers.iter().map(|number| Dual8::along(*number, None)).collect() };
    let here = of(&mut source, &fixed(&rest.q), &fixed(&rest.multipliers));
    for some in parameters.chunks(DIRECTIONS) {
        let value = |(index, value): (usize, &f64)| Dual8::along(*value, some.iter().position(|own| *own == index));
        source.set_parameters(crane.parameters().iter().enumerate().map(value).collect());
        let (q, multipliers) = rest.moved(&mut source);
        let moved = of(&mut source, &q, &multipliers);
        for parameter in some {
            // A parameter that is given twice has the slopes of its first place.
            let direction = some.iter().position(|own| own == parameter).unwrap_or_default();
            derivatives.push(moved.iter().map(|(_, number)| number.slope(direction)).collect());
            pose.push(q.iter().map(|number| number.slope(direction)).collect());
        }
    }
    let values = here.iter().map(|(_, number)| number.value()).collect();
    let outputs = here.into_iter().map(|(output, _)| output).collect();
    Ok(Sensitivity { q: rest.q.clone(), parameters: parameters.to_vec(), outputs, values, derivatives, pose, notes })
}
