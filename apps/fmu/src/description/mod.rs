//! `modelDescription.xml`: what an importer learns about a crane.

mod fmi2;
mod fmi3;
mod units;

use std::collections::BTreeSet;

use crane_codegen::exchange::xml::{Xml, number_text};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::Settings;
use crane_model::force_states;

use crate::variables::{self, Source, Variable};

pub use fmi2::write_description as write_fmi2;
pub use fmi3::write_description as write_fmi3;

/// Categories of messages, and what they contain.
const CATEGORIES: [(&str, &str); 2] = [
    ("logStatusWarning", "What is implausible about the crane, and where the model is not valid"),
    ("logStatusError", "Why a call failed, and what to do about it"),
];

/// A crane with the values of its parameters at the start, and its variables.
struct Subject<'a> {
    crane: &'a LiveCrane,
    variables: Vec<Variable>,
}

impl<'a> Subject<'a> {
    fn new(crane: &'a LiveCrane) -> Self {
        Self { crane, variables: variables::list(crane.description(), crane.loop_joints()) }
    }

    /// Whether an importer may integrate: not the states of a crane with closed loops, which depend on each other.
    fn can_be_integrated(&self) -> bool {
        self.crane.loop_joints().is_empty()
    }

    fn token(&self) -> String {
        variables::token(self.crane.description(), &self.variables)
    }

    /// Value reference of a variable.
    fn reference(&self, source: Source) -> usize {
        self.variables.iter().position(|variable| variable.source == source).unwrap_or(0)
    }

    /// What a variable is the derivative of.
    fn integral(source: Source) -> Option<Source> {
        match source {
            Source::Rate(index) => Some(Source::Position(index)),
            Source::Acceleration(index) => Some(Source::Rate(index)),
            Source::OwnRate(index) => Some(Source::Own(index)),
            _ => None,
        }
    }

    /// Value references of the derivatives, in the order of the states.
    fn derivatives(&self) -> Vec<usize> {
        let n = self.crane.size();
        let (rates, accelerations) = ((0..n).map(Source::Rate), (0..n).map(Source::Acceleration));
        let of_forces = (0..force_states::columns(self.crane.description()).len()).map(Source::OwnRate);
        rates.chain(accelerations).chain(of_forces).map(|source| self.reference(source)).collect()
    }

    /// Value references of the event indicators.
    fn indicators(&self) -> Vec<usize> {
        let is_indicator = |index: &usize| matches!(self.variables[*index].source, Source::Indicator(_));
        (0..self.variables.len()).filter(is_indicator).collect()
    }

    /// Value references of the outputs.
    fn outputs(&self) -> Vec<usize> {
        (0..self.variables.len()).filter(|&index| self.variables[index].is_output).collect()
    }

    /// Value references of what is computed before a run begins: outputs, states and derivatives.
    fn initial_unknowns(&self) -> Vec<usize> {
        let is_unknown = |variable: &Variable| {
            let moves = Self::integral(variable.source).is_some() || matches!(variable.source, Source::Position(_));
            variable.is_output || moves
        };
        (0..self.variables.len()).filter(|&index| is_unknown(&self.variables[index])).collect()
    }

    /// Causality and variability of a variable.
    fn nature(variable: &Variable) -> [&'static str; 2] {
        match variable.source {
            Source::Time => ["independent", "continuous"],
            Source::Parameter(_) => ["parameter", "tunable"],
            Source::EventTime(_) => ["local", "discrete"],
            Source::Input(_) => ["input", "continuous"],
            _ if variable.is_output => ["output", "continuous"],
            _ => ["local", "continuous"],
        }
    }

    /// Attributes that identify a variable: name, value reference, description, causality and variability.
    fn identity(variable: &Variable, reference: usize) -> Vec<(&'static str, String)> {
        let [causality, variability] = Self::nature(variable);
        let mut attributes = vec![("name", variable.name.clone()), ("valueReference", reference.to_string())];
        if !variable.about.is_empty() {
            attributes.push(("description", variable.about.clone()));
        }
        attributes.extend([("causality", causality.to_owned()), ("variability", variability.to_owned())]);
        attributes
    }

    /// Attributes of a variable's values: unit and start value.
    fn attributes(&self, variable: &Variable) -> Vec<(&'static str, String)> {
        let mut attributes = Vec::new();
        if !variable.unit.is_empty() {
            attributes.push(("unit", variable.unit.clone()));
        }
        let start = match variable.source {
            Source::Parameter(index) => Some(self.crane.parameter(index)),
            Source::Input(index) => Some(self.crane.input_start(index)),
            _ => None,
        };
        attributes.extend(start.map(|start| ("start", number_text(start))));
        attributes
    }

    fn write_units(&self, xml: &mut Xml) {
        let units: BTreeSet<&str> = self.variables.iter().map(|variable| variable.unit.as_str()).collect();
        xml.open("UnitDefinitions", &[]);
        for unit in units.into_iter().filter(|unit| !unit.is_empty()) {
            let name = [("name", unit.to_owned())];
            let Some(exponents) = units::exponents(unit) else {
                xml.leaf("Unit", &name);
                continue;
            };
            xml.open("Unit", &name);
            let counts = units::NAMES.into_iter().zip(exponents).filter(|(_, exponent)| *exponent != 0);
            let counts: Vec<_> = counts.map(|(name, exponent)| (name, exponent.to_string())).collect();
            xml.leaf("BaseUnit", &counts);
            xml.close();
        }
        xml.close();
    }

    fn write_categories(xml: &mut Xml) {
        xml.open("LogCategories", &[]);
        for (name, about) in CATEGORIES {
            xml.leaf("Category", &[("name", name.to_owned()), ("description", about.to_owned())]);
        }
        xml.close();
    }

    fn write_experiment(&self, xml: &mut Xml) {
        let Settings { duration, output, tolerance, .. } = Settings::from_description(self.crane.description());
        xml.leaf(
            "DefaultExperiment",
            &[
                ("startTime", number_text(0.0)),
                ("stopTime", number_text(duration)),
                ("tolerance", number_text(tolerance)),
                ("stepSize", number_text(output)),
            ],
        );
    }

    /// Attributes that describe the origin of the unit.
    fn origin(&self) -> [(&'static str, String); 3] {
        let description = self.crane.description();
        [
            ("modelName", description.name.to_string()),
            ("description", description.title.to_string()),
            ("generationTool", format!("crane {}", env!("CARGO_PKG_VERSION"))),
        ]
    }
}
