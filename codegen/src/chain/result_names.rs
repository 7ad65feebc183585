//! Names of results: the columns of tables, and the variables of a unit for co-simulation.

use std::collections::BTreeMap;

use crane_quantities::{ColumnKind, END, PEAKS, Strain as StrainKind};

use super::{Chain, CoordinateId, CoordinateKind, Force, Strain};

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
        names.add_joints(self);
        names.add_cylinders(self);
        names.add_supports(self);
        names.add_connectors(self);
        for point in &self.points {
            names.add_part("point", &point.name, false, &[ColumnKind::PointPosition, ColumnKind::PointVelocity]);
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

    /// The columns of some kinds of a part, those of their extremes, and the rates of those that are states of forces.
    fn add_part(&mut self, what: &str, part: &str, turns: bool, kinds: &[ColumnKind]) {
        let owner = if what.is_empty() { format!("the {part}") } else { format!("{what} `{part}`") };
        for kind in kinds {
            kind.endings(turns).iter().for_each(|ending| self.add_column(*kind, &format!("{part}{ending}"), &owner));
        }
    }

    fn add_column(&mut self, kind: ColumnKind, name: &str, owner: &str) {
        self.add(name.to_owned(), owner);
        let peaks = PEAKS.iter().filter(|_| kind.has_peaks());
        let end = (kind == ColumnKind::PointPosition).then_some(&END);
        let rates = ColumnKind::StateRate.endings(false).iter().filter(|_| kind.is_state());
        for ending in peaks.chain(end).chain(rates) {
            self.add(format!("{name}{ending}"), owner);
        }
    }

    /// Coordinates with their drives, stops and friction.
    fn add_joints(&mut self, chain: &Chain) {
        let turns = |kind| kind == CoordinateKind::Rotation;
        for (index, coordinate) in chain.coordinates.iter().enumerate() {
            let is_here = |id: &CoordinateId| id.0 == index;
            let friction = chain.frictions().find(|(id, _)| is_here(id));
            let mut kinds = vec![ColumnKind::Position, ColumnKind::Rate, ColumnKind::Acceleration];
            let mut also = |has: bool, of: &[ColumnKind]| kinds.extend(of.iter().filter(|_| has));
            also(chain.is_of_element(CoordinateId(index)), &[ColumnKind::ElementMoment]);
            also(
                chain.drives.iter().any(|drive| is_here(&drive.coordinate)),
                &[ColumnKind::Prescribed, ColumnKind::PrescribedRate, ColumnKind::DriveEffort],
            );
            also(chain.stopped().iter().any(is_here), &[ColumnKind::StopEffort, ColumnKind::StopIndicator]);
            also(friction.is_some(), &[ColumnKind::FrictionEffort]);
            also(friction.is_some_and(|(_, friction)| friction.bristle.is_some()), &[ColumnKind::Bristle]);
            self.add_part("coordinate", &coordinate.name, turns(coordinate.kind), &kinds);
        }
    }

    /// Cylinders and their pump.
    fn add_cylinders(&mut self, chain: &Chain) {
        for cylinder in &chain.cylinders {
            self.add_part("cylinder", &cylinder.name, false, &ColumnKind::OF_CYLINDER);
            if cylinder.valve.is_some() {
                self.add_part("cylinder", &cylinder.name, false, &[ColumnKind::Valve]);
            }
        }
        if !chain.cylinders.is_empty() {
            self.add_part("", "pump", false, &[ColumnKind::Flow, ColumnKind::Power]);
        }
        if chain.pump.is_some() {
            self.add_part("", "pump", false, &[ColumnKind::PumpPressure]);
        }
    }

    /// Supports, and the lines between them about which the crane may tip.
    fn add_supports(&mut self, chain: &Chain) {
        for support in &chain.supports {
            let mut kinds = vec![ColumnKind::LateralReaction, ColumnKind::VerticalReaction];
            if support.friction.is_some() {
                kinds.extend([ColumnKind::Gap, ColumnKind::Slid, ColumnKind::FootIndicator]);
            }
            self.add_part("support", &support.name, false, &kinds);
            for other in chain.supports.iter().filter(|other| other.name != support.name) {
                let line = format!("{}_{}", support.name, other.name);
                let owner = format!("the line from support `{}` to `{}`", support.name, other.name);
                for ending in ColumnKind::TippingMoment.endings(false) {
                    self.add(format!("{line}{ending}"), &owner);
                }
            }
        }
    }

    /// Connectors, couplings, pads, and joints that close loops.
    fn add_connectors(&mut self, chain: &Chain) {
        for connector in chain.connectors() {
            let turns = chain.kind_of(&connector.strain) == CoordinateKind::Rotation;
            let (strain, effort) = strain_and_effort(connector);
            let mut kinds = vec![ColumnKind::Strain(strain), ColumnKind::StrainRate(strain), effort];
            kinds.extend(connector.is_rope().then_some(ColumnKind::RopeIndicator));
            kinds.extend(connector.is_contact().then_some(ColumnKind::FootIndicator));
            self.add_part("connector", &connector.name, turns, &kinds);
        }
        let of_joints = chain.loop_joints.iter().map(|joint| ("loop joint", &joint.name, joint.kind.equations()));
        let rigid = chain.rigid_couplings.iter();
        let of_couplings = rigid.map(|coupling| ("connector", &coupling.name, vec![coupling.equation()]));
        for (what, part, equations) in of_joints.chain(of_couplings) {
            for equation in equations {
                let kind = if equation.is_moment { ColumnKind::LoopMoment } else { ColumnKind::LoopForce };
                let name = format!("{part}{}", kind.ending_along(equation.direction));
                self.add_column(kind, &name, &format!("{what} `{part}`"));
            }
        }
    }
}

/// What the strain and the force of a connector are called.
fn strain_and_effort(connector: &Force) -> (StrainKind, ColumnKind) {
    match &connector.strain {
        Strain::Turning(_) => (StrainKind::Angle, ColumnKind::PinFriction),
        Strain::Coupling { .. } => (StrainKind::Slip, ColumnKind::ConnectorEffort),
        Strain::Sliding(_) => (StrainKind::Offset, ColumnKind::ConnectorEffort),
        Strain::Depth { .. } => (StrainKind::Depth, ColumnKind::ConnectorEffort),
        Strain::Line(_) | Strain::Coordinate(_) => (StrainKind::Length, ColumnKind::ConnectorEffort),
    }
}
