//! Several cranes as one.

use super::{
    AttachmentInfo, BodyInfo, BristleInfo, ConnectorInfo, CoordinateInfo, CylinderInfo, Description, DriveInfo,
    InputInfo, List, LoadInfo, LoopEquationInfo, LoopJointInfo, ParameterInfo, SectionInfo, SupportInfo, Text,
};

impl Description {
    /// Whether several cranes with such joints that close loops run faster as one: valves of each would shorten the steps of all, and the efforts of
    /// rigid drives follow from a mass matrix where joints stick or loops close, which a fleet has not.
    pub fn has_fleets(&self, loop_joints: &[LoopJointInfo]) -> bool {
        let needs_mass = !self.prescribed().is_empty() && (self.has_force_states() || !loop_joints.is_empty());
        !self.has_valves() && !needs_mass
    }

    /// The description of several cranes as one: every list has each of its items once for each crane, next to each other and with the same name.
    #[must_use]
    pub fn of_fleet(&self, cranes: usize) -> Self {
        let joined = |index: usize, crane: usize| index * cranes + crane;
        let indices = |list: &List<usize>| repeat(list, cranes, |index, crane| *index = joined(*index, crane));
        Self {
            parameters: repeat(&self.parameters, cranes, |_: &mut ParameterInfo, _| {}),
            coordinates: repeat(&self.coordinates, cranes, |_: &mut CoordinateInfo, _| {}),
            bodies: repeat(&self.bodies, cranes, |body: &mut BodyInfo, _| body.degrees_of_freedom *= cranes),
            sections: repeat(&self.sections, cranes, |section: &mut SectionInfo, crane| {
                section.body = joined(section.body, crane);
            }),
            supports: repeat(&self.supports, cranes, |_: &mut SupportInfo, _| {}),
            drives: repeat(&self.drives, cranes, |drive: &mut DriveInfo, crane| {
                drive.coordinate = joined(drive.coordinate, crane);
            }),
            stops: indices(&self.stops),
            frictions: indices(&self.frictions),
            bristles: repeat(&self.bristles, cranes, |joint: &mut BristleInfo, crane| {
                joint.coordinate = joined(joint.coordinate, crane);
            }),
            loads: repeat(&self.loads, cranes, |_: &mut LoadInfo, _| {}),
            inputs: repeat(&self.inputs, cranes, |_: &mut InputInfo, _| {}),
            cylinders: repeat(&self.cylinders, cranes, |cylinder: &mut CylinderInfo, crane| {
                cylinder.drive = joined(cylinder.drive, crane);
                cylinder.spanned = cylinder.spanned.map(|coordinate| coordinate * cranes);
            }),
            connectors: repeat(&self.connectors, cranes, |connector: &mut ConnectorInfo, crane| {
                connector.spanned = connector.spanned.map(|coordinate| coordinate * cranes);
                connector.points = repeat(&connector.points, 1, |point: &mut AttachmentInfo, _| {
                    point.body = point.body.map(|body| joined(body, crane));
                });
            }),
            points: repeat(&self.points, cranes, |_: &mut Text, _| {}),
            guess: repeat(&self.guess, cranes, |_: &mut Option<f64>, _| {}),
            ..self.clone()
        }
    }
}

impl LoopJointInfo {
    /// The same joint of several cranes as one, with the equations of all, each next to each other.
    #[must_use]
    pub fn of_fleet(&self, cranes: usize) -> Self {
        Self {
            spanned: self.spanned.map(|coordinate| coordinate * cranes),
            equations: repeat(&self.equations, cranes, |_: &mut LoopEquationInfo, _| {}),
            ..self.clone()
        }
    }
}

/// A list in which each item is repeated, and changed for each crane.
fn repeat<T: Clone>(list: &List<T>, cranes: usize, change: impl Fn(&mut T, usize)) -> List<T> {
    let change = &change;
    let each = list.iter().flat_map(|item| {
        (0..cranes).map(move |crane| {
            let mut item = item.clone();
            change(&mut item, crane);
            item
        })
    });
    each.collect()
}
