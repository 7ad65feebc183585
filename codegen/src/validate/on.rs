//! What links are attached to.

use super::{Check, LinkBodies};
use crate::chain::{BodyId, CoordinateId, Step, Value};
use crate::diagnostic::{Span, rule, suggest};
use crate::expand::placement::translate;
use crate::spec::{Either, Link, Number, On, Place, Spanned};

/// A place may be beyond the end of a beam by this fraction of its length, because both are decimal numbers.
const WRITTEN: f64 = 1e-9;
/// A point belongs to the element that starts at its x, with this fraction of that start as tolerance, because both
/// are rounded numbers.
const AT_THE_JOINT: f64 = 1e-12;

/// Where a body begins: what it is attached to, where along that, and the first steps of its path.
#[derive(Debug)]
pub(super) struct Attached {
    pub parent: Option<BodyId>,
    pub along: Value,
    pub path: Vec<Step>,
}

impl Default for Attached {
    /// On the world.
    fn default() -> Self {
        Attached { parent: None, along: Value::ZERO, path: Vec::new() }
    }
}

impl Attached {
    /// At a point of a body; `None` if a mistake left the link without bodies.
    pub(super) fn at(parent: Option<BodyId>, along: Value, point: [Value; 3]) -> Self {
        let mut path = Vec::new();
        translate(&mut path, point);
        Attached { parent, along, path }
    }

    /// At the tip of a link.
    fn at_tip(bodies: &LinkBodies) -> Self {
        Attached::at(bodies.last(), bodies.tip.clone(), [bodies.tip.clone(), Value::ZERO, Value::ZERO])
    }
}

impl<'a> Check<'a> {
    /// Where a link begins.
    pub(super) fn attached(
        &mut self,
        links: &'a [Spanned<Link>],
        index: usize,
        previous: Option<&LinkBodies>,
    ) -> Attached {
        let link = links[index].value.as_ref();
        let Some(given) = link.and_then(|link| link.on.as_ref()) else {
            return previous.map(Attached::at_tip).unwrap_or_default();
        };
        if index == 0 {
            self.report(rule::base_on_link(given.span, name_of(&links[0]).unwrap_or_default()));
            return Attached::default();
        }
        let found = match &given.value {
            Some(Either::Short(name)) => self.earlier_link(links, index, (name, given.span)).map(Attached::at_tip),
            Some(Either::Full(On { link, at })) => {
                let place = link.value.as_deref().and_then(|name| self.earlier_link(links, index, (name, link.span)));
                let place = place.cloned();
                let name = link.value.as_deref().unwrap_or_default();
                match (place, at.as_ref().map(|at| (at.value.as_ref(), at.span))) {
                    (Some(bodies), None | Some((Some(Place::Tip), _))) => Some(Attached::at_tip(&bodies)),
                    (Some(bodies), Some((Some(Place::Start), span))) => Some(self.at_start(name, &bodies, span)),
                    (Some(bodies), Some((Some(Place::Point(at)), span))) => {
                        Some(self.at_point(name, &bodies, (at, span)))
                    }
                    (None, _) | (_, Some((None, _))) => None,
                }
            }
            None => None,
        };
        // What a link is attached to after a mistake matters to no other check.
        self.unknown.links |= found.is_none();
        found.or_else(|| previous.map(Attached::at_tip)).unwrap_or_default()
    }

    /// At the end of the body that was appended last.
    pub(super) fn on_the_last_body(&self, tip: Value) -> Attached {
        let last = self.bodies.len().checked_sub(1);
        Attached::at(last.map(BodyId), tip.clone(), [tip, Value::ZERO, Value::ZERO])
    }

    /// The bodies of an earlier link.
    pub(super) fn earlier_link(
        &mut self,
        links: &'a [Spanned<Link>],
        index: usize,
        (name, span): (&str, Span),
    ) -> Option<&LinkBodies> {
        if self.links.contains_key(name) {
            return self.links.get(name);
        }
        let own = name_of(&links[index]).unwrap_or_default();
        let later = links.iter().skip(index + 1).find(|link| name_of(link) == Some(name));
        if own == name {
            self.report(rule::on_itself(span, name));
        } else if let Some(later) = later {
            if leads_to(links, later, own) {
                self.report(rule::circle(span, own, name));
            } else {
                self.report(rule::on_later(span, own, name));
            }
        } else if !self.unknown.links {
            let help = suggest(name, self.links.keys().copied());
            self.report(rule::unknown_link(span, name, help));
        }
        None
    }

    /// At the beginning of a beam or a rope.
    fn at_start(&mut self, name: &str, bodies: &LinkBodies, span: Span) -> Attached {
        if bodies.tip.is_zero() && !self.unknown.links {
            self.report(rule::start_of_rigid(span, name));
        }
        Attached::at(bodies.first(), Value::ZERO, [Value::ZERO; 3])
    }

    /// At a point of a link; on a beam or a rope it is between its beginning and its end.
    fn at_point(&mut self, name: &str, bodies: &LinkBodies, (at, span): (&[Spanned<Number>; 3], Span)) -> Attached {
        let [x, y, z] = at.each_ref().map(|given| self.number(given, "`at`"));
        if bodies.tip.is_zero() {
            return Attached::at(bodies.first(), x.clone(), [x, y, z]);
        }
        let length = bodies.length();
        let (here, whole) = (self.now(&x), self.now(&length));
        let tolerance = WRITTEN * whole;
        let broken = rule::beside_the_beam(span, name, here, whole);
        if here < -tolerance || here > whole + tolerance {
            self.report(broken.clone());
        }
        self.keep_below(&x, &((1.0 + WRITTEN) * length.clone()), &broken);
        self.keep_positive(x.clone() + WRITTEN * length, &broken);
        if (here - whole).abs() <= tolerance {
            // The tip, but beside the axis.
            let end = bodies.tip.clone();
            return Attached::at(bodies.last(), end.clone(), [end, y, z]);
        }
        let (body, x) = self.element_at(bodies, x);
        Attached::at(body, x.clone(), [x, y, z])
    }

    /// The body of a link at a position along x, and the position along it: for a beam, the element that contains it.
    pub(super) fn element_at(&self, bodies: &LinkBodies, x: Value) -> (Option<BodyId>, Value) {
        let reach = self.now(&x) + AT_THE_JOINT * bodies.starts.last().map_or(0.0, |start| self.now(start));
        let element = bodies.starts.iter().rposition(|start| self.now(start) <= reach).unwrap_or(0);
        let start = bodies.starts.get(element).cloned().unwrap_or(Value::ZERO);
        (bodies.first().map(|BodyId(first)| BodyId(first + element)), x - start)
    }

    /// The coordinates that move a body, in the order of q.
    pub(super) fn coordinates_of(&self, body: Option<BodyId>) -> Vec<CoordinateId> {
        let path = std::iter::successors(body, |BodyId(index)| self.bodies[*index].parent);
        let steps = path.flat_map(|BodyId(index)| &self.bodies[index].path);
        let mut coordinates: Vec<CoordinateId> = steps.flat_map(Step::coordinates).copied().collect();
        coordinates.sort_unstable();
        coordinates
    }
}

fn name_of(link: &Spanned<Link>) -> Option<&str> {
    link.value.as_ref()?.name.value.as_deref()
}

/// Whether a link is attached to another one of that name, directly or through others.
fn leads_to(links: &[Spanned<Link>], from: &Spanned<Link>, name: &str) -> bool {
    let index_of = |name: &str| links.iter().position(|link| name_of(link) == Some(name));
    let mut at = name_of(from).and_then(index_of);
    for _ in links {
        let Some(index) = at else { return false };
        let Some(link) = links[index].value.as_ref() else { return false };
        at = match (link.named_on(), &link.on) {
            (Some(on), _) => index_of(on),
            (None, None) => index.checked_sub(1),
            (None, Some(_)) => None,
        };
        if at.and_then(|at| name_of(&links[at])) == Some(name) {
            return true;
        }
    }
    false
}
