//! Bodies and their joints, as links and joints.
//!
//! Of several joints of a body, all but the last one get a link without mass. The link of a joint has its origin at the joint's anchor, and
//! its joint is at zero where `MuJoCo`'s is, so that a joint moves the body from its `ref`: `T = P T(p) M(−ref) M(q) T(−p)`.

use super::geoms::{SHAPES, leave_out};
use super::pose::unit;
use super::{File, InertiaFromGeoms};
use crate::chain::{Frame, Vector};
use crate::exchange::free_name;
use crate::exchange::import::document::{Element, value_span};
use crate::exchange::import::mistakes::rule;
use crate::exchange::import::robot::{Joint, Link, Motion, Named, SingleAxis, Spring};
use crate::exchange::import::split::positions_of_free;
use crate::exchange::mass::Lump;
use crate::exchange::names::WORLD;
use crate::exchange::rotation::about;

/// Elements that move a body.
const JOINTS: [&str; 2] = ["joint", "freejoint"];

/// An element in a body, and what it inherits from the elements around it.
pub(super) struct Placed<'a, 'i> {
    pub(super) node: Element<'a, 'i>,
    /// Pose of the `<frame>` elements around it, in the frame of the body.
    pub(super) frame: Frame,
    pub(super) class: Option<&'a str>,
}

/// A body that is still to be read.
struct Open<'a, 'i> {
    body: Placed<'a, 'i>,
    /// The parent of its link; the frame in `body` is given in the frame of this parent.
    parent: String,
    /// Whether no joint is between it and the world.
    stands: bool,
}

impl<'a, 'i> File<'a, 'i> {
    /// Everything in the world.
    pub(super) fn world(&mut self, world: Element<'a, 'i>) {
        if self.robot.links.is_empty() {
            let frame = Some(Frame::WORLD);
            self.robot.links.push(Link {
                name: WORLD.to_owned(),
                span: world.tag(),
                lump: None,
                shapes: Vec::new(),
                frame,
            });
        }
        let mut open = Vec::new();
        let inside = self.elements(world, world.text("childclass"));
        self.contents(inside, &Frame::WORLD, (WORLD, true), &mut open);
        let mut count = 0;
        while let Some(next) = open.pop() {
            count += 1;
            self.body(next, count, &mut open);
        }
    }

    /// Reads a body with its joints; the bodies in it are added to `open`.
    fn body(&mut self, Open { body, parent, stands }: Open<'a, 'i>, count: usize, open: &mut Vec<Open<'a, 'i>>) {
        let node = body.node.read();
        let named = node.attribute("name");
        let name = named.map_or_else(|| format!("body_{count}"), |name| name.value().to_owned());
        let span = named.map_or_else(|| node.tag(), value_span);
        let owner = format!("body `{name}`");
        let class = node.text("childclass").or(body.class);
        let inside = self.elements(node, class);
        let placement = body.frame.outer(&self.pose(node, None, &owner));
        let joints: Vec<&Placed> = inside.iter().filter(|inner| JOINTS.contains(&inner.node.name())).collect();
        if node.text("gravcomp").is_some_and(|text| text.parse() != Ok(0.0)) {
            self.robot.left_out.push(format!("Gravity compensation of body `{name}` is left out: gravity acts on it."));
        }

        let mut carrier = parent;
        // Pose of the body in the link before the next joint, and in its own link.
        let mut here = placement;
        let mut within = Frame::WORLD;
        for (index, joint) in joints.iter().enumerate() {
            let last = index + 1 == joints.len();
            let link = if last { name.clone() } else { self.free_name(&name, &format!("_{}", index + 1)) };
            let ends = [&carrier, &link].map(|end| Named { name: end.clone(), span });
            let (read, at) = self.joint(joint, (&name, index), ends, &here);
            self.robot.joints.push(read);
            if !last {
                self.robot.links.push(Link { name: link.clone(), span, lump: None, shapes: Vec::new(), frame: None });
            }
            carrier = link;
            within = Frame { origin: at.map(|x| -x), ..Frame::WORLD };
            here = within;
        }
        if joints.is_empty() {
            let ends = [&carrier, &name].map(|end| Named { name: end.clone(), span });
            // A name that `--fix` cannot refer to.
            let fixed = Joint::new(&format!("{name} is fixed"), span, Motion::Fixed, ends);
            self.robot.joints.push(Joint { placement, ..fixed });
        }
        let stands = stands && joints.is_empty();
        let looks = self.looks(&inside, &name).into_iter();
        let shapes: Vec<_> = looks.map(|(frame, form)| (within.outer(&frame), form)).collect();
        let lump = self.lump(&inside, &name, stands);
        let lump = self.masses.of_body(lump).filter(|lump| !lump.is_nothing()).map(|lump| lump.seen_through(&within));
        self.robot.links.push(Link { name: name.clone(), span, lump, shapes, frame: named.map(|_| within) });
        self.contents(inside, &within, (&name, stands), open);
    }

    /// Elements of a body or of the world, including those in `<frame>` elements.
    fn elements(&mut self, node: Element<'a, 'i>, class: Option<&'a str>) -> Vec<Placed<'a, 'i>> {
        let children = |of: Element<'a, 'i>| of.elements().rev();
        let placed = |frame, class| move |node| Placed { node, frame, class };
        let mut open: Vec<Placed> = children(node).map(placed(Frame::WORLD, class)).collect();
        let mut found = Vec::new();
        while let Some(next) = open.pop() {
            if next.node.name() == "frame" {
                let _ = next.node.read();
                let frame = next.frame.outer(&self.pose(next.node, None, "a frame"));
                let class = next.node.text("childclass").or(next.class);
                open.extend(children(next.node).map(placed(frame, class)));
            } else {
                found.push(next);
            }
        }
        found
    }

    /// Reads the sites among the elements of a link as massless frames, and adds the bodies among them to `open`. `within`: pose of the
    /// elements in the link.
    fn contents(
        &mut self,
        inside: Vec<Placed<'a, 'i>>,
        within: &Frame,
        (link, stands): (&str, bool),
        open: &mut Vec<Open<'a, 'i>>,
    ) {
        // In reverse, so that the first body is on top of the stack.
        for inner in inside.into_iter().rev() {
            let placed = Placed { frame: within.outer(&inner.frame), ..inner };
            match placed.node.name() {
                "body" => open.push(Open { body: placed, parent: link.to_owned(), stands }),
                "site" => self.site(&placed, link),
                "camera" | "light" => placed.node.leave_out("cameras and lights"),
                // Of the world: that of a body has been read.
                "geom" => placed.node.leave_out(SHAPES),
                _ => {}
            }
        }
    }

    fn site(&mut self, site: &Placed<'a, 'i>, link: &str) {
        let Some(name) = site.node.attribute("name") else { return site.node.leave_out("sites without a name") };
        let _ = site.node.read();
        let span = value_span(name);
        // A body may have the same name.
        let ending = if self.names.contains(name.value()) { "_site" } else { "" };
        let free_name = self.free_name(name.value(), ending);
        let placement = site.frame.outer(&self.pose(site.node, site.class, &format!("site `{}`", name.value())));
        let ends = [link, &free_name].map(|end| Named { name: end.to_owned(), span });
        let joint = Joint::new(&format!("{free_name} is a site"), span, Motion::Fixed, ends);
        self.robot.joints.push(Joint { placement, ..joint });
        self.robot.links.push(Link {
            name: free_name,
            span,
            lump: None,
            shapes: Vec::new(),
            frame: Some(Frame::WORLD),
        });
        site.node.leave_out_rest(SHAPES);
    }

    /// A name for a link that no other link and no body has.
    fn free_name(&mut self, name: &str, ending: &str) -> String {
        free_name(&mut self.names, &format!("{name}{ending}"), &|_, _| true)
    }

    /// A joint, and its anchor in the frame of its body. `here`: pose of the body, before this joint moves it, in the previous link.
    fn joint(
        &mut self,
        joint: &Placed<'a, 'i>,
        (body, index): (&str, usize),
        ends: [Named; 2],
        here: &Frame,
    ) -> (Joint, Vector) {
        let &Placed { node, ref frame, class } = joint;
        let _ = node.read();
        let named = node.attribute("name");
        let unnamed = || if index == 0 { format!("{body}_joint") } else { format!("{body}_joint_{}", index + 1) };
        let name = named.map_or_else(unnamed, |name| name.value().to_owned());
        let span = named.map_or_else(|| node.tag(), value_span);
        let owner = format!("joint `{name}`");
        let kind =
            if node.name() == "freejoint" { "free" } else { self.classes.text(node, class, "type").unwrap_or("hinge") };
        let motion = match kind {
            "hinge" => Motion::Revolute,
            "slide" => Motion::Prismatic,
            "ball" => Motion::Several { kind: "ball", axes: SingleAxis::ball(), starts: vec![0.0; 3] },
            // Its positions are those of the body in the world.
            "free" => Motion::Several { kind: "free", axes: SingleAxis::free(), starts: positions_of_free(here) },
            other => Motion::Other(Named { name: other.to_owned(), span }),
        };
        let turns = matches!(motion, Motion::Revolute);
        // Conversion of the file's angles to rad.
        let angle = if turns { self.angles.unit } else { 1.0 };
        let direction = self.numbers(node, class, "axis", &owner).unwrap_or([0.0, 0.0, 1.0]);
        let axis = unit(direction).unwrap_or_else(|| {
            self.reader.mistakes.push(rule::no_direction(node.tag(), &name));
            direction
        });
        let axis = frame.direction(axis);
        // MuJoCo has free joints at the origin of their body.
        let is_free = kind == "free";
        let given = if is_free { None } else { self.numbers(node, class, "pos", &owner) }.unwrap_or([0.0; 3]);
        let (here, anchor) = if is_free { (&Frame::WORLD, [0.0; 3]) } else { (here, frame.transform_point(given)) };
        let mut number = |key| self.number(node, class, key, &owner).unwrap_or(0.0);
        let [stiffness, damping, friction, armature] =
            ["stiffness", "damping", "frictionloss", "armature"].map(&mut number);
        let [reference, relaxed] = ["ref", "springref"].map(|key| number(key) * angle);
        let limited = self.classes.text(node, class, "limited") != Some("false");
        let range = self.numbers::<2>(node, class, "range", &owner).filter(|_| limited);
        let oscillation =
            self.numbers::<2>(node, class, "springdamper", &owner).filter(|[t, ratio]| *t > 0.0 && *ratio > 0.0);
        let back = if turns {
            about(axis, -reference)
        } else {
            Frame { origin: axis.map(|component| -reference * component), ..Frame::WORLD }
        };
        let placement = here.outer(&Frame { origin: anchor, ..Frame::WORLD }).outer(&back);
        let spring = (stiffness != 0.0).then_some(Spring { stiffness, rest: relaxed });
        let limits = range.filter(|[lower, upper]| lower < upper).map(|range| range.map(|limit| limit * angle));
        node.leave_out_rest("contacts, limits of drives and looks of joints");
        let plain = Joint::new(&name, span, motion, ends);
        // MuJoCo starts at `ref`.
        let start = (reference != 0.0).then_some(reference);
        (
            Joint {
                placement,
                axis,
                limits,
                damping,
                friction,
                spring,
                oscillation,
                relaxed,
                armature,
                start,
                reference,
                ..plain
            },
            anchor,
        )
    }

    /// The mass of a body: its inertial frame, or its shapes.
    fn lump(&mut self, inside: &[Placed<'a, 'i>], name: &str, stands: bool) -> Option<Lump> {
        let owner = format!("the mass of body `{name}`");
        let inertial = inside.iter().find(|inner| inner.node.name() == "inertial");
        let geoms = || inside.iter().filter(|inner| inner.node.name() == "geom");
        // MuJoCo keeps the inertial frame of a body without shapes.
        let from_geoms = match self.inertia_from_geoms {
            InertiaFromGeoms::Always if inertial.is_some() && geoms().next().is_none() => InertiaFromGeoms::Auto,
            other => other,
        };
        match (inertial, from_geoms) {
            (Some(&Placed { node, ref frame, .. }), InertiaFromGeoms::Auto | InertiaFromGeoms::Never) => {
                geoms().for_each(|geom| leave_out(geom.node));
                let placement = frame.outer(&self.pose(node.read(), None, &owner));
                let [mass] = self.reader.numbers(node, "mass", &owner)?;
                if mass < 0.0 {
                    self.reader.mistakes.push(rule::negative_mass(node.tag(), name, mass));
                }
                let full = self.numbers(node, None, "fullinertia", &owner);
                let tensor = full.unwrap_or_else(|| {
                    let [xx, yy, zz] = self.numbers(node, None, "diaginertia", &owner).unwrap_or([0.0; 3]);
                    [xx, yy, zz, 0.0, 0.0, 0.0]
                });
                Some(Lump { mass, com: [0.0; 3], tensor }.seen_through(&placement))
            }
            (_, InertiaFromGeoms::Never) => {
                geoms().for_each(|geom| leave_out(geom.node));
                None
            }
            (replaced, _) => {
                if let Some(replaced) = replaced {
                    replaced.node.leave_out("masses that `inertiafromgeom` replaces");
                }
                let lumps: Vec<Lump> = geoms().filter_map(|shape| self.shape(shape, name, stands)).collect();
                Lump::sum(&lumps)
            }
        }
    }
}
