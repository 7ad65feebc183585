//! The variables of a crane.

use crane_codegen::SourceFile;
use crane_model::dynamics::Contacts;
use crane_model::results::{self, column_name};
use crane_model::{ColumnKind, CoordinateRole, Description, LoopJointInfo, force_states};

/// What a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Time.
    Time,
    /// A coordinate, by its place in `q`.
    Position(usize),
    /// The rate of a coordinate.
    Rate(usize),
    /// The acceleration of a coordinate.
    Acceleration(usize),
    /// A state of a force: a pressure, a spool position, the deflection of bristles.
    Own(usize),
    /// Its rate.
    OwnRate(usize),
    /// A derived quantity, by its index in [`results::quantities`].
    Quantity(usize),
    /// A live parameter, by its index in the description.
    Parameter(usize),
    /// An input, by its index in the description.
    Input(usize),
    /// What changes its sign where a contact begins or ends, by its index in the list of [`Contacts`]; then those of events on conditions.
    Indicator(usize),
    /// When an event on a condition happened, by its index in the description.
    EventTime(usize),
}

/// A variable. Its value reference is its index in the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    /// Name, as that of the column in the command's results.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// What it is, in words; may be empty.
    pub about: String,
    /// What it is.
    pub source: Source,
    /// Whether it is an output, which other units can be connected to.
    pub is_output: bool,
}

/// The variables of a crane: time, coordinates, rates, derived quantities and states of forces, accelerations,
/// rates of the forces' states, parameters, inputs, times of events, event indicators.
///
/// Poses and rates of joints and of the base are outputs, and so are points, drives, reactions and what loop joints transmit. Deformations of flexible links,
/// their moments, energies and accelerations can be read as well, but are not outputs, because they are many.
pub fn list(description: &Description, loop_joints: &[LoopJointInfo]) -> Vec<Variable> {
    let n = description.coordinates.len();
    let states = force_states::columns(description);
    let mut units = vec![String::new(); states.len()];
    let quantities = results::quantities(description, loop_joints).into_iter().enumerate().map(|(index, column)| {
        let source = match index {
            0 => Source::Time,
            _ if index <= n => Source::Position(index - 1),
            _ if index <= 2 * n => Source::Rate(index - 1 - n),
            _ => states.iter().position(|state| *state == column.name).map_or(Source::Quantity(index), Source::Own),
        };
        if let Source::Own(state) = source {
            units[state].clone_from(&column.unit);
        }
        let is_output = match source {
            Source::Position(i) | Source::Rate(i) => !description.coordinates[i].role.is_element(),
            Source::Own(_) => true,
            Source::Quantity(_) => !matches!(column.kind, ColumnKind::Energy | ColumnKind::ElementMoment),
            _ => false,
        };
        let about = match source {
            Source::Position(i) if description.coordinates[i].role == CoordinateRole::Prescribed => {
                "its rigid drive prescribes it".to_owned()
            }
            _ => String::new(),
        };
        let name = if source == Source::Time { "time".to_owned() } else { column.name };
        Variable { name, unit: column.unit, about, source, is_output }
    });
    let accelerations = description.coordinates.iter().enumerate().map(|(index, coordinate)| Variable {
        name: column_name(ColumnKind::Acceleration, &coordinate.name, coordinate.kind.turns()),
        unit: ColumnKind::Acceleration.unit(coordinate.kind.turns()).to_owned(),
        about: String::new(),
        source: Source::Acceleration(index),
        is_output: false,
    });
    let parameters = description.parameters.iter().enumerate().map(|(index, parameter)| Variable {
        name: parameter.name.to_string(),
        unit: parameter.unit.to_string(),
        about: parameter.about.to_string(),
        source: Source::Parameter(index),
        is_output: false,
    });
    let inputs = description.inputs.iter().enumerate().map(|(index, input)| {
        let until = if input.default.is_none() { "until it is set it follows the motion of the spec" } else { "" };
        let about = [input.about.as_str(), until].into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>();
        Variable {
            name: input.name.to_string(),
            unit: input.unit.to_string(),
            about: about.join("; "),
            source: Source::Input(index),
            is_output: false,
        }
    });
    let mut all: Vec<Variable> = quantities.chain(accelerations).collect();
    all.extend(states.iter().zip(units).enumerate().map(|(index, (state, unit))| Variable {
        name: column_name(ColumnKind::StateRate, state, false),
        unit: format!("{}/s", if unit.is_empty() { "1" } else { &unit }),
        about: String::new(),
        source: Source::OwnRate(index),
        is_output: false,
    }));
    all.extend(parameters.chain(inputs));
    all.extend(description.conditions().map(|(event, condition)| Variable {
        name: column_name(ColumnKind::EventTime, &description.events[event].name, false),
        unit: ColumnKind::EventTime.unit(false).to_owned(),
        about: format!("when {condition}; 0 before"),
        source: Source::EventTime(event),
        is_output: false,
    }));
    all.extend(Contacts::names(description).into_iter().enumerate().map(|(index, name)| Variable {
        name,
        unit: String::new(),
        about: "event indicator: negative while the contact is closed".to_owned(),
        source: Source::Indicator(index),
        is_output: false,
    }));
    let contacts = Contacts::names(description).len();
    all.extend(description.conditions().enumerate().map(|(index, (event, condition))| Variable {
        name: column_name(ColumnKind::EventIndicator, &description.events[event].name, false),
        unit: String::new(),
        about: format!("event indicator: positive when {condition}"),
        source: Source::Indicator(contacts + index),
        is_output: false,
    }));
    all
}

/// What a description and a library must agree on: the spec, and every variable with its place.
pub fn token(description: &Description, variables: &[Variable]) -> String {
    let lines: Vec<String> =
        variables.iter().map(|variable| format!("{} [{}]", variable.name, variable.unit)).collect();
    format!("{}-{}", description.spec_hash, SourceFile::new("variables", lines.join("\n")).hash())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use crane_live::LiveCrane;
    use crane_model::dyn_crane::Functions;
    use crane_model::results::Peaks;

    use super::*;

    /// Names that results of other parts have, or almost have.
    const WORDS: [&str; 16] = [
        "a",
        "b",
        "a_theta",
        "b_x",
        "tip",
        "tip_x",
        "tip_end",
        "pump",
        "pump_flow",
        "time",
        "a_theta_rate",
        "drive_work",
        "foot",
        "foot_gap",
        "b_force",
        "b_length_rate",
    ];

    /// Parts of all kinds with names drawn from these.
    fn spec(mut word: impl FnMut() -> &'static str) -> String {
        let [one, other, parameter, input, point, cylinder, rope, foot] = std::array::from_fn(|_| word());
        format!(
            "format: 1\nname: named\nparameters: {{{parameter}: {{value: 5, unit: kg}}}}\ninputs: {{{input}: {{unit: N}}}}\nlinks:\n\
             - {{name: base, joint: free, mass: 100, com: [0, 0, 1], inertia: {{gyration: [1, 1, 1]}}}}\n\
             - {{name: {one}, joint: {{revolute: {{axis: y}}}}, mass: 10, com: [1, 0, 0], inertia: {{gyration: [1, 1, 1]}}}}\n\
             - {{name: {other}, joint: {{prismatic: {{axis: x}}}}, mass: {parameter}, com: [0, 0, 0]}}\n\
             supports: [{{name: {foot}, at: [1, 0, 0], one_sided: true, stiffness: [1e6, 1e6, 1e6]}}]\n\
             drives: [{{coordinate: {one}_theta, stiffness: 1e5, motion: {{hold: 0}}}}]\n\
             cylinders: [{{name: {cylinder}, coordinate: {one}_theta, foot: {{link: base, at: [0.3, 0, -1]}}, head: {{link: {one}, at: [1, 0, -0.1]}}, \
             bore: 0.1, rod: 0.05, retracted: 0.9, stroke: 0.8}}]\n\
             connectors: [{{name: {rope}, from: {{at: [0, 0, 5]}}, to: {{link: {one}, at: [1, 0, 0]}}, law: {{rope: {{stiffness: 1e4, length: 4}}}}}}]\n\
             loads: [{{name: push, link: {one}, at: [1, 0, 0], force: [0, 0, 1], scale: {{input: {input}}}}}]\n\
             points: [{{name: {point}, link: {one}, at: [1, 0, 0]}}]\n"
        )
    }

    /// A crane whose names `check` accepts has no two variables, and no two columns of an ensemble, of one name.
    #[test]
    fn accepted_names_are_those_of_one_result_each() {
        let mut state = 1_u64;
        let mut word = || {
            // Knuth's generator; its upper bits.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            WORDS[usize::try_from(state >> 33).expect("31 bits") % WORDS.len()]
        };
        let (mut accepted, mut shared) = (0, 0);
        for _ in 0..400 {
            let text = spec(&mut word);
            let crane = match LiveCrane::from_spec(&SourceFile::new("named.yaml", text.as_str())) {
                Ok(crane) => crane,
                Err(mistakes) => {
                    shared += usize::from(mistakes.to_string().contains("E028"));
                    continue;
                }
            };
            accepted += 1;
            let variables = list(crane.description(), crane.loop_joints());
            let names: BTreeSet<&str> = variables.iter().map(|variable| variable.name.as_str()).collect();
            assert_eq!(names.len(), variables.len(), "{text}");
            let columns = Peaks::columns(&crane);
            let parameters = crane.description().parameters.iter().map(|info| info.name.as_str());
            let all: Vec<&str> = parameters.chain(columns.iter().map(|column| column.name.as_str())).collect();
            assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len(), "{text}");
        }
        assert!(accepted > 50 && shared > 100, "{accepted} accepted, {shared} with a shared name");
    }
}
