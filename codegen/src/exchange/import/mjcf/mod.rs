//! A robot in MJCF, the language of `MuJoCo`.
//!
//! | here | what |
//! |---|---|
//! | `bodies` | bodies and their joints, as links and joints |
//! | `classes` | attributes with the defaults of their classes |
//! | `pose` | positions and the five ways to write an orientation |
//! | `geoms` | masses of bodies from their shapes |
//! | `masses` | what `<compiler>` changes of masses |
//! | `tendons` | fixed tendons: and equalities: linear equations and springs of joints |
//! | `others` | gravity, key frames; elements that a spec cannot express |

mod bodies;
mod classes;
mod geoms;
mod masses;
mod others;
mod pose;
mod tendons;

use std::collections::BTreeSet;

use super::document::{Element, Reader};
use super::mistakes::rule;
use super::robot::Robot;
use crate::diagnostic::Mistake;
use crate::exchange::names::WORLD;

use classes::Classes;
use masses::MassSettings;
use pose::Angles;

/// Elements that `MuJoCo` expands to others when it loads a file.
const EXPANDED: [&str; 6] = ["include", "composite", "flexcomp", "replicate", "attach", "model"];
/// The groups of geoms with masses, unless `<compiler>` says otherwise.
const GROUPS: &str = "0 5";

/// Reads a file by its root; returns what could be read, and all mistakes.
pub(super) fn read_robot(root: Element) -> Result<Robot, Vec<Mistake>> {
    let mut file = File {
        reader: Reader::default(),
        names: BTreeSet::new(),
        classes: Classes::default(),
        angles: Angles::default(),
        inertia_from_geoms: InertiaFromGeoms::Auto,
        masses: MassSettings::default(),
        robot: Robot {
            name: root.text("model").unwrap_or("robot").to_owned(),
            links: Vec::new(),
            joints: Vec::new(),
            couplings: Vec::new(),
            gravity: None,
            left_out: Vec::new(),
            no_drives: "Actuators are not carried over: every joint swings freely.",
        },
    };
    for node in root.descendants().filter(|node| EXPANDED.contains(&node.local_name())) {
        file.reader.mistakes.push(rule::to_expand(node.tag(), format!("<{}>", node.name())));
    }
    root.named("compiler").for_each(|node| file.compiler(node));
    file.classes = Classes::read(root, &mut file.reader);
    let bodies = root.descendants().filter(|node| node.is("body"));
    file.names = bodies.filter_map(|node| node.text("name")).chain([WORLD]).map(str::to_owned).collect();
    root.named("worldbody").for_each(|node| file.world(node));
    file.masses.scale(&mut file.robot);
    file.others(root);
    file.classes.note_defaults();
    if file.reader.mistakes.is_empty() { Ok(file.robot) } else { Err(file.reader.mistakes) }
}

/// Which bodies take their masses from their shapes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum InertiaFromGeoms {
    /// Those without an inertial frame.
    Auto,
    /// All.
    Always,
    /// None.
    Never,
}

/// A file as far as it was read.
struct File<'a, 'i> {
    reader: Reader,
    /// The names of its bodies, and of other links.
    names: BTreeSet<String>,
    classes: Classes<'a, 'i>,
    angles: Angles,
    inertia_from_geoms: InertiaFromGeoms,
    masses: MassSettings,
    robot: Robot,
}

impl<'a, 'i> File<'a, 'i> {
    /// `<compiler>`: how numbers are interpreted.
    fn compiler(&mut self, node: Element<'a, 'i>) {
        let groups = node.text("inertiagrouprange").map(|text| text.split_whitespace().collect::<Vec<_>>().join(" "));
        if groups.is_some_and(|groups| groups != GROUPS) {
            self.reader.mistakes.push(rule::to_expand(node.tag(), "`inertiagrouprange` of <compiler>"));
        }
        let mut number = |key| self.number(node, None, key, "<compiler>");
        let [mass, inertia, total] = ["boundmass", "boundinertia", "settotalmass"].map(&mut number);
        let settings = &mut self.masses;
        settings.least_mass = mass.unwrap_or(settings.least_mass);
        settings.least_inertia = inertia.unwrap_or(settings.least_inertia);
        settings.total = total.or(settings.total).filter(|total| *total > 0.0);
        settings.balances = node.text("balanceinertia").map_or(settings.balances, |text| text == "true");
        self.angles.read(node, &mut self.reader);
        if node.text("coordinate").is_some_and(|text| text != "local") {
            self.reader.mistakes.push(rule::to_expand(node.tag(), "`coordinate` of <compiler>"));
        }
        // Read where ranges are.
        node.attribute("autolimits");
        if let Some(text) = node.text("inertiafromgeom") {
            self.inertia_from_geoms = match text {
                "true" => InertiaFromGeoms::Always,
                "false" => InertiaFromGeoms::Never,
                _ => InertiaFromGeoms::Auto,
            };
        }
        node.leave_out_rest("files and settings of MuJoCo's compiler");
    }

    /// A number. `MuJoCo` also accepts the coefficients of a nonlinear law after it: they have to be zero.
    fn number(&mut self, node: Element<'a, 'i>, class: Option<&str>, key: &str, owner: &str) -> Option<f64> {
        let attribute = self.classes.find(node, class, key)?;
        let numbers = self.reader.some_numbers(attribute, &format!("`{key}` of {owner}"))?;
        match numbers.as_slice() {
            [number, others @ ..] if others.iter().all(|other| *other == 0.0) => Some(*number),
            _ => {
                self.reader.wrong_numbers(attribute, &format!("`{key}` of {owner}"), "a number");
                None
            }
        }
    }

    /// Exactly `N` numbers.
    fn numbers<const N: usize>(
        &mut self,
        node: Element<'a, 'i>,
        class: Option<&str>,
        key: &str,
        owner: &str,
    ) -> Option<[f64; N]> {
        let attribute = self.classes.find(node, class, key)?;
        self.reader.exact_numbers(attribute, &format!("`{key}` of {owner}"))
    }
}
