//! Names of results: the columns of tables, and the variables of a unit for co-simulation.

use std::collections::BTreeMap;

use crane_quantities::{ColumnKind, Description, END, PEAKS, PartColumn};

use super::Chain;

/// Columns and variables that a run has of the crane as a whole: time, and energies by the names of their parts.
const OF_CRANE: [(&str, ColumnKind); 13] = [
    ("time", ColumnKind::Time),
    ("kinetic", ColumnKind::Energy),
    ("gravity", ColumnKind::Energy),
    ("support", ColumnKind::Energy),
    ("element", ColumnKind::Energy),
    ("drive", ColumnKind::Energy),
    ("stop", ColumnKind::Energy),
    ("connector", ColumnKind::Energy),
    ("drive", ColumnKind::Work),
    ("load", ColumnKind::Work),
    ("event", ColumnKind::Work),
    ("dissipated", ColumnKind::Dissipated),
    ("energy", ColumnKind::Balance),
];

/// The names of all results of a crane.
#[derive(Debug, Default)]
pub struct ResultNames {
    /// Whose each is, in words, such as "point `tip`".
    pub owners: BTreeMap<String, String>,
    /// Names that two have, with the words for both.
    pub shared: Vec<[String; 3]>,
}

impl Chain {
    /// The names of the columns of runs and of their extremes, of tipping moments, of parameters, inputs, and of all else that is a variable of a
    /// unit for co-simulation.
    #[must_use]
    pub fn result_names(&self) -> ResultNames {
        let mut names = ResultNames::default();
        for (part, kind) in OF_CRANE {
            kind.endings(false).iter().for_each(|ending| names.add(format!("{part}{ending}"), "a result of every run"));
        }
        let (description, loop_joints) = (self.description(), self.loop_joint_infos());
        // Of two parts, the later one is told: a point, if one is.
        let columns = description.columns(&loop_joints);
        let (points, others): (Vec<_>, Vec<_>) = columns.into_iter().partition(|column| column.what == "point");
        for PartColumn { what, part, kind, name, .. } in others.into_iter().chain(points) {
            names.add_column(kind, &name, &owner(what, part));
        }
        names.add_variables(&description);
        names.add_lines(&description);
        for (event, _) in description.conditions() {
            names.add_part(
                "event",
                &self.events[event].name,
                false,
                &[ColumnKind::EventTime, ColumnKind::EventIndicator],
            );
        }
        for parameter in &self.parameters {
            names.add_part("parameter", &parameter.name, false, &[ColumnKind::Other]);
        }
        for input in &self.inputs {
            names.add_part("input", &input.name, false, &[ColumnKind::Other]);
        }
        // The time of a table stands beside no parameters; where it does, it is called `time`.
        names.owners.entry("t".to_owned()).or_insert_with(|| "a result of every run".to_owned());
        names
    }
}

impl ResultNames {
    fn add(&mut self, name: String, owner: &str) {
        match self.owners.get(&name) {
            Some(known) if known != owner => self.shared.push([name, known.clone(), owner.to_owned()]),
            Some(_) => {}
            None => {
                self.owners.insert(name, owner.to_owned());
            }
        }
    }

    /// Columns and variables of some kinds of a part.
    fn add_part(&mut self, what: &str, part: &str, turns: bool, kinds: &[ColumnKind]) {
        for kind in kinds {
            let endings = kind.endings(turns).iter();
            endings.for_each(|ending| self.add_column(*kind, &format!("{part}{ending}"), &owner(what, part)));
        }
    }

    /// A column, those of its extremes, and the rate of a state of a force.
    fn add_column(&mut self, kind: ColumnKind, name: &str, owner: &str) {
        self.add(name.to_owned(), owner);
        let peaks = PEAKS.iter().filter(|_| kind.has_peaks());
        let end = (kind == ColumnKind::PointPosition).then_some(&END);
        let rates = ColumnKind::StateRate.endings(false).iter().filter(|_| kind.is_state());
        for ending in peaks.chain(end).chain(rates) {
            self.add(format!("{name}{ending}"), owner);
        }
    }

    /// Variables that only units for co-simulation have.
    fn add_variables(&mut self, description: &Description) {
        let all = 0..description.coordinates.len();
        let of_joints = all
            .map(|coordinate| (coordinate, ColumnKind::Acceleration))
            .chain(description.drives.iter().map(|drive| (drive.coordinate, ColumnKind::PrescribedRate)))
            .chain(description.stops.iter().map(|stop| (*stop, ColumnKind::StopIndicator)));
        for (coordinate, kind) in of_joints {
            let info = &description.coordinates[coordinate];
            self.add_part("coordinate", &info.name, info.kind.turns(), &[kind]);
        }
        for support in description.supports.iter().filter(|support| support.one_sided) {
            self.add_part("support", &support.name, false, &[ColumnKind::FootIndicator]);
        }
        for connector in &description.connectors {
            self.add_part("connector", &connector.name, false, connector.indicator().as_slice());
        }
    }

    /// The lines between supports about which the crane may tip.
    fn add_lines(&mut self, description: &Description) {
        for from in &description.supports {
            for to in description.supports.iter().filter(|to| to.name != from.name) {
                let owner = format!("the line from support `{}` to `{}`", from.name, to.name);
                for ending in ColumnKind::TippingMoment.endings(false) {
                    self.add(format!("{}_{}{ending}", from.name, to.name), &owner);
                }
            }
        }
    }
}

/// Whose a name is, in words.
fn owner(what: &str, part: &str) -> String {
    if what.is_empty() { format!("the {part}") } else { format!("{what} `{part}`") }
}
