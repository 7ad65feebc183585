//! What a load chart takes into account, in words that stand beside it.

use crane_quantities::DisplayUnit;
use nalgebra::Vector3;

use super::{Limits, PartLimit};
use crate::{CylinderInfo, Description, dyn_crane::DynCrane, tipping};

/// What a load chart takes into account, and what it does not, for people.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Limits that were considered.
    pub considered: Vec<String>,
    /// Limits that were not considered, or that lack a number.
    pub not_considered: Vec<String>,
    /// Limits that were asked for and cannot be reached, with the reason.
    pub without_effect: Vec<String>,
}

/// What no limit of a load at rest covers.
const NEVER: [&str; 3] = ["motion", "buckling and fatigue", "hook and slings"];
/// Horizontal part of the weight from which the ground is a slope: above rounding.
const SLOPE: f64 = 1e-9;

impl Coverage {
    /// Of some limits of a crane. `gravity`: its acceleration in the world frame, m/s².
    pub fn new(crane: &dyn DynCrane, limits: &Limits, gravity: [f64; 3]) -> Self {
        let description = crane.description();
        let mut found = Self { considered: vec!["a stable equilibrium".to_owned()], ..Self::default() };
        found.ground(crane, limits);
        found.beams(crane, limits);
        found.cylinders(description, limits);
        found.drives(crane, limits);
        found.ropes(description, limits);
        found.stages(crane, limits);
        for (point, deflection) in
            description.points.iter().zip(&limits.deflections).filter(|(_, deflection)| deflection.is_finite())
        {
            found.add(true, format!("the load moves {point} by at most {deflection} m"));
        }
        found.surroundings(description, gravity);
        found.not_considered.extend(NEVER.map(str::to_owned));
        found
    }

    fn add(&mut self, considered: bool, words: String) {
        if considered { &mut self.considered } else { &mut self.not_considered }.push(words);
    }

    fn ground(&mut self, crane: &dyn DynCrane, limits: &Limits) {
        let (description, q) = (crane.description(), crane.guess());
        let rest = vec![0.0; q.len()];
        let no_lines = if description.supports.is_empty() {
            Some("the crane has no supports")
        } else if tipping::lines(crane, 0.0, &q, &rest, &rest).is_empty() {
            Some("the supports form no polygon")
        } else {
            None
        };
        match (no_lines, limits.tipping) {
            (Some(why), asked) => {
                self.add(false, format!("tipping: {why}"));
                self.without_effect.extend(asked.map(|_| format!("tipping limits nothing: {why}")));
            }
            (None, Some(margin)) => self.add(true, format!("a tipping margin of at least {margin}")),
            (None, None) => self.add(false, "tipping".to_owned()),
        }
        if description.supports.is_empty() {
            return;
        }
        let what = if description.supports.iter().all(|support| support.one_sided) {
            "the first foot that lifts off"
        } else {
            "the first support that pulls"
        };
        self.add(limits.has(PartLimit::LiftOff), what.to_owned());
        for support in &description.supports {
            if let Some(most) = support.max_pressure {
                let [name, most] = [support.name.to_string(), DisplayUnit::Bar.shown(most).to_string()];
                self.add(limits.has(PartLimit::Ground), format!("{most} bar on the ground under {name}"));
            }
        }
        if description.supports.iter().all(|support| support.max_pressure.is_none()) {
            self.add(false, "the strength of the ground: no support has a `plate` with a `max_pressure`".to_owned());
        }
        if description.has_feet() {
            self.add(limits.has(PartLimit::Sliding), "the friction under the feet".to_owned());
        }
    }

    fn beams(&mut self, crane: &dyn DynCrane, limits: &Limits) {
        let description = crane.description();
        let with_yield_stress: Vec<&str> = description
            .sections
            .iter()
            .zip(crane.section_moduli_at())
            .filter(|(_, moduli)| moduli.area > 0.0 && moduli.allowable_stress > 0.0)
            .map(|(section, _)| description.bodies[section.body].link.as_str())
            .collect();
        let known = |link: &str| with_yield_stress.contains(&link);
        let mut links: Vec<&str> = description.bodies.iter().map(|body| body.link.as_str()).collect();
        links.dedup();
        let (strong, other): (Vec<&str>, Vec<&str>) = links.into_iter().partition(|link| known(link));
        if strong.is_empty() {
            let why = "utilisation limits nothing: no beam has a section with known moduli and a `yield_stress`";
            self.without_effect.extend(limits.utilisation.map(|_| why.to_owned()));
        } else {
            let beams = strong.join(", ");
            match limits.utilisation {
                Some(greatest) => self.add(true, format!("a utilisation of {beams} of at most {greatest}")),
                None => self.add(false, format!("the strength of {beams}")),
            }
        }
        if !other.is_empty() {
            self.add(false, format!("the strength of {}: no section with a `yield_stress`", other.join(", ")));
        }
    }

    fn cylinders(&mut self, description: &Description, limits: &Limits) {
        if description.cylinders.is_empty() {
            return;
        }
        let names = |which: &dyn Fn(&CylinderInfo) -> bool| -> Vec<&str> {
            description.cylinders.iter().filter(|info| which(info)).map(|info| info.name.as_str()).collect()
        };
        let considered = limits.has(PartLimit::Pressure);
        for info in &description.cylinders {
            match info.max_pressure {
                Some(pressure) => {
                    self.add(
                        considered,
                        format!("the relief valves of {} at {} bar", info.name, DisplayUnit::Bar.shown(pressure)),
                    );
                }
                None => self.add(false, format!("the pressure in {}: it has no `max_pressure`", info.name)),
            }
        }
        let all = names(&|_| true).join(", ");
        match description.pump.and_then(|pump| pump.pressure) {
            Some(pressure) => {
                let bar = DisplayUnit::Bar.shown(pressure);
                self.add(limits.has(PartLimit::Pump), format!("the {bar} bar of the pump at {all}"));
            }
            None => self.add(false, "the pressure of the pump: the spec does not give it".to_owned()),
        }
        self.add(limits.has(PartLimit::Stroke), format!("the stroke of {all}"));
    }

    fn drives(&mut self, crane: &dyn DynCrane, limits: &Limits) {
        let Description { coordinates, drives, stops, cylinders, .. } = crane.description();
        let own_limits = crane.drive_limits_at();
        let applied = limits.with_max_efforts(crane).efforts;
        let mut free = Vec::new();
        for (index, info) in drives.iter().enumerate() {
            let coordinate = &coordinates[info.coordinate];
            let words = |effort: f64| {
                format!("the effort of {} at most {effort} {}", coordinate.name, coordinate.kind.force_unit())
            };
            let given = limits.efforts[index];
            if applied[index].is_finite() {
                self.add(true, words(own_limits[index].filter(|_| applied[index] < given).unwrap_or(given)));
            } else if let Some(limit) = own_limits[index] {
                self.add(false, words(limit));
            } else if !cylinders.iter().any(|cylinder| cylinder.drive == index) {
                free.push(coordinate.name.as_str());
            }
        }
        if !free.is_empty() {
            self.add(false, format!("the effort of {}: no limit is given", free.join(", ")));
        }
        let stopped = stops.iter().filter(|stop| drives.iter().any(|drive| drive.coordinate == **stop));
        let stopped: Vec<&str> = stopped.map(|stop| coordinates[*stop].name.as_str()).collect();
        if !stopped.is_empty() {
            self.add(limits.has(PartLimit::Stops), format!("the end stops of {}", stopped.join(", ")));
        }
    }

    fn ropes(&mut self, description: &Description, limits: &Limits) {
        let ropes: Vec<_> = description.connectors.iter().filter(|connector| connector.is_rope).collect();
        if ropes.is_empty() {
            return;
        }
        let names: Vec<&str> = ropes.iter().map(|rope| rope.name.as_str()).collect();
        self.add(limits.has(PartLimit::SlackRopes), format!("slack of {}", names.join(", ")));
        for rope in ropes {
            match rope.max_tension {
                Some(most) => {
                    self.add(limits.has(PartLimit::Tension), format!("a tension of {} of at most {most} N", rope.name));
                }
                None => self.add(false, format!("the strength of rope {}: it has no `max_tension`", rope.name)),
            }
        }
    }

    /// What acts on the crane besides its weight.
    fn surroundings(&mut self, description: &Description, gravity: [f64; 3]) {
        let loads: Vec<&str> = description.loads.iter().map(|load| load.name.as_str()).collect();
        if loads.is_empty() {
            self.add(false, "wind: the spec has no loads".to_owned());
        } else {
            self.add(true, format!("the loads {}, as at the beginning of a run", loads.join(", ")));
        }
        let gravity = Vector3::from(gravity);
        let slope = gravity.xy().norm() / gravity.norm();
        if slope > SLOPE {
            self.add(true, format!("a slope of the ground of {:.2}°", slope.asin().to_degrees()));
        } else {
            self.add(false, "a slope of the ground".to_owned());
        }
    }

    fn stages(&mut self, crane: &dyn DynCrane, limits: &Limits) {
        let stages = crane.stages().iter().map(|stage| crane.description().bodies[stage.inner].link.as_str());
        let stages: Vec<&str> = stages.collect();
        if !stages.is_empty() {
            self.add(
                limits.has(PartLimit::Overlap),
                format!("an overlap of {} with the outer beam that is neither lost nor too long", stages.join(", ")),
            );
        }
    }
}
