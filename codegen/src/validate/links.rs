//! Links, their placements and joints.

use super::on::Attached;
use super::slides_in::Outer;
use super::{Check, LinkBodies, Owner};
use crate::chain::{Axis, Body, BodyId, Chain, Coordinate, CoordinateId, CoordinateKind, Step, Value};
use crate::diagnostic::{Span, rule};
use crate::expand::placement;
use crate::spec::{
    Angle, AxisName, BaseCoordinate, Joint, JointAxis, Link, Many, Number, Placement, Spanned, Transform, Turn,
};

impl From<AxisName> for Axis {
    fn from(name: AxisName) -> Self {
        match name {
            AxisName::X => Axis::X,
            AxisName::Y => Axis::Y,
            AxisName::Z => Axis::Z,
        }
    }
}

/// Symbol of a coordinate: x, y, z for a translation; psi about z, theta about y, phi about x for a rotation.
fn symbol(kind: CoordinateKind, axis: Axis) -> &'static str {
    match kind {
        CoordinateKind::Translation => ["x", "y", "z"][axis.index()],
        CoordinateKind::Rotation => ["phi", "theta", "psi"][axis.index()],
    }
}

/// The six motions of a free base, in their order.
const BASE_MOTIONS: [(BaseCoordinate, CoordinateKind, Axis); 6] = [
    (BaseCoordinate::X, CoordinateKind::Translation, Axis::X),
    (BaseCoordinate::Y, CoordinateKind::Translation, Axis::Y),
    (BaseCoordinate::Z, CoordinateKind::Translation, Axis::Z),
    (BaseCoordinate::Psi, CoordinateKind::Rotation, Axis::Z),
    (BaseCoordinate::Theta, CoordinateKind::Rotation, Axis::Y),
    (BaseCoordinate::Phi, CoordinateKind::Rotation, Axis::X),
];

impl<'a> Check<'a> {
    pub(super) fn links(&mut self, given: &'a Spanned<Vec<Spanned<Link>>>) {
        let Some(links) = &given.value else {
            self.unknown.links = true;
            return;
        };
        if links.is_empty() {
            self.report(rule::no_links(given.span));
        }
        let mut previous = None;
        for (index, link) in links.iter().enumerate() {
            match &link.value {
                Some(inside) => {
                    previous = Some(if inside.slides_in().is_some() {
                        let (attached, outer) = self.slid(links, index).unzip();
                        // What a link is attached to after a mistake matters to no other check.
                        self.unknown.links |= attached.is_none();
                        self.link(inside, index == 0, attached.unwrap_or_default(), outer)
                    } else {
                        let attached = self.attached(links, index, previous.as_ref());
                        self.link(inside, index == 0, attached, None)
                    });
                }
                None => self.unknown.links = true,
            }
            let count = self.coordinates.len();
            if count > Chain::MOST_COORDINATES {
                let help =
                    "give each drive and each hinge one joint, and leave out parts that cannot move independently";
                self.report(rule::too_many(
                    link.span,
                    format!("link {}", index + 1),
                    count,
                    Chain::MOST_COORDINATES,
                    help,
                ));
                self.unknown.links = true;
                return;
            }
        }
    }

    /// Appends the bodies of a link to the chain; returns where they are.
    fn link(&mut self, link: &'a Link, is_base: bool, mut attached: Attached, outer: Option<Outer>) -> LinkBodies {
        let name = self.name(&link.name).unwrap_or_else(|| {
            self.unknown.links = true;
            ""
        });
        let coordinate = CoordinateId(self.coordinates.len());
        let mut motion = self.joint(link, name, is_base);
        motion.extend(self.held_motions(link));
        attached.path.extend(self.placed(link, motion));

        let first = self.bodies.len();
        let bodies = LinkBodies { first, carried: self.carried(link, name, attached) };
        self.note_stage(link, outer, &bodies, coordinate);
        self.shapes_of(link, &bodies);
        if !name.is_empty() && self.links.insert(name, bodies.clone()).is_some() {
            self.report(rule::duplicate_name(link.name.span, "links", name, "an earlier link"));
        }
        bodies
    }

    /// Appends a body; its name must not be taken. It comes after the one that carries it, also while there are mistakes: all walks from
    /// a body to the world end because of this.
    pub(super) fn push_body(&mut self, body: Body, span: Span) {
        assert!(body.parent < Some(BodyId(self.bodies.len())), "a body comes after the one that carries it");
        self.register_expanded("bodies", &body.name, &body.link, span);
        self.bodies.push(body);
    }

    /// Appends a coordinate of the next body, named after the link or, in a beam, the element.
    pub(super) fn push_coordinate(
        &mut self,
        (link, stem): (&str, &str),
        kind: CoordinateKind,
        axis: Axis,
        owner: Owner,
        span: Span,
    ) -> CoordinateId {
        let id = CoordinateId(self.coordinates.len());
        let name = format!("{stem}_{}", symbol(kind, axis));
        self.register_expanded("coordinates", &name, link, span);
        self.coordinates.push(Coordinate { name, kind, axis, body: BodyId(self.bodies.len()) });
        self.owners.push(owner);
        id
    }

    /// The motion of a link's joint.
    fn joint(&mut self, link: &Link, name: &str, is_base: bool) -> Vec<Step> {
        let Some(given) = &link.joint else { return Vec::new() };
        let span = given.span;
        match &given.value {
            Some(Joint::Fixed) => Vec::new(),
            Some(Joint::Revolute(axis)) => self.single(link, name, CoordinateKind::Rotation, axis.as_ref(), span),
            Some(Joint::Prismatic(axis)) => self.single(link, name, CoordinateKind::Translation, axis.as_ref(), span),
            Some(Joint::Free(_)) if !is_base => {
                self.report(rule::free_inside(span, name));
                self.unknown.links = true;
                Vec::new()
            }
            Some(Joint::Free(some)) => self.free(name, some.as_deref(), span),
            None => {
                self.unknown.links = true;
                Vec::new()
            }
        }
    }

    fn single(
        &mut self,
        link: &Link,
        name: &str,
        kind: CoordinateKind,
        axis: Option<&JointAxis>,
        span: Span,
    ) -> Vec<Step> {
        let given = axis.and_then(|axis| axis.axis.as_ref());
        let axis = given.map_or(Some(AxisName::Z), |given| given.value);
        self.unknown.links |= axis.is_none();
        let axis = axis.map_or(Axis::Z, Axis::from);
        let row = link.placement.as_ref().and_then(|placement| placement.value.as_ref());
        if axis != Axis::Z && matches!(row, Some(Placement::ModifiedDh(_) | Placement::ClassicDh(_))) {
            self.report(rule::dh_axis(given.map_or(span, |given| given.span), name));
        }
        vec![Step::Move(self.push_coordinate((name, name), kind, axis, Owner::Joint, span))]
    }

    fn free(&mut self, name: &str, some: Option<&[Spanned<BaseCoordinate>]>, span: Span) -> Vec<Step> {
        let chosen = |motion| some.is_none_or(|some| some.iter().filter(|c| c.value == Some(motion)).count() > 0);
        if let Some(some) = some {
            let mut twice = some.iter().enumerate().filter(|(i, c)| some[..*i].iter().any(|b| b.value == c.value));
            if some.is_empty() {
                self.report(rule::base_coordinates(span, name, "none"));
            } else if let Some((_, again)) = twice.find(|(_, coordinate)| coordinate.value.is_some()) {
                self.report(rule::base_coordinates(again.span, name, "given twice"));
            }
            self.unknown.links |= some.iter().any(|coordinate| coordinate.value.is_none());
        }
        let mut steps = Vec::new();
        for (index, (motion, kind, axis)) in BASE_MOTIONS.into_iter().enumerate() {
            if chosen(motion) {
                let id = self.push_coordinate((name, name), kind, axis, Owner::Base, span);
                self.base[index] = Some(id);
                steps.push(Step::Move(id));
            }
        }
        steps
    }

    /// The placement of a link, including its joint's motion.
    fn placed(&mut self, link: &Link, motion: Vec<Step>) -> Vec<Step> {
        match link.placement.as_ref().and_then(|placement| placement.value.as_ref()) {
            Some(Placement::ModifiedDh(row)) => {
                let (a, alpha, d, theta) =
                    self.row(row.a.as_ref(), row.alpha.as_ref(), row.d.as_ref(), row.theta.as_ref());
                placement::modified_dh(a, &alpha, d, &theta, motion)
            }
            Some(Placement::ClassicDh(row)) => {
                let (a, alpha, d, theta) =
                    self.row(row.a.as_ref(), row.alpha.as_ref(), row.d.as_ref(), row.theta.as_ref());
                placement::classic_dh(a, &alpha, d, &theta, motion)
            }
            Some(Placement::Transform(transform)) => {
                let (translation, turns) = self.transform(transform);
                placement::transform(translation, &turns, motion)
            }
            None => motion,
        }
    }

    /// Translation and rotations.
    pub(super) fn transform(&mut self, transform: &Transform) -> ([Value; 3], Vec<(Axis, Value)>) {
        let translation = self.vector_or_zero(transform.translation.as_ref(), "`translation`");
        (translation, self.turns(transform.rotation.as_ref()))
    }

    /// Rotations, each about the axes as rotated by the previous ones.
    pub(super) fn turns(&mut self, given: Option<&Spanned<Many<Turn>>>) -> Vec<(Axis, Value)> {
        let list = given.and_then(|rotation| rotation.value.as_ref());
        let turns = list.into_iter().flat_map(|list| &list.0).filter_map(|turn| turn.value.as_ref());
        let turns = turns.map(|turn| match turn {
            Turn::X(angle) => (Axis::X, self.number(angle, "`rotation`")),
            Turn::Y(angle) => (Axis::Y, self.number(angle, "`rotation`")),
            Turn::Z(angle) => (Axis::Z, self.number(angle, "`rotation`")),
        });
        turns.collect()
    }

    fn row(
        &mut self,
        a: Option<&Spanned<Number>>,
        alpha: Option<&Spanned<Angle>>,
        d: Option<&Spanned<Number>>,
        theta: Option<&Spanned<Angle>>,
    ) -> (Value, Value, Value, Value) {
        let a = self.number_or(a, 0.0, "`a`");
        let alpha = alpha.map_or(Value::ZERO, |alpha| self.number(alpha, "`alpha`"));
        let d = self.number_or(d, 0.0, "`d`");
        let theta = theta.map_or(Value::ZERO, |theta| self.number(theta, "`theta`"));
        (a, alpha, d, theta)
    }
}
