//! Masses and inertias of links.

use super::inertias::Lump;
use super::on::Attached;
use super::{Carried, Check};
use crate::chain::{self, BodyId, LinkPart, Value};
use crate::diagnostic::{Span, rule};
use crate::expand::inertia::{self, Tensor};
use crate::node::Limit;
use crate::spec::{About, Body, Inertia, Link, Number, Spanned, Vector};

impl<'a> Check<'a> {
    /// Appends the bodies of a link.
    pub(super) fn carried(&mut self, link: &'a Link, name: &'a str, attached: Attached) -> Carried {
        let carried: Vec<(&str, Span)> = [
            ("mass", link.mass.as_ref().map(|given| given.span)),
            ("bodies", link.bodies.as_ref().map(|given| given.span)),
            ("beam", link.beam.as_ref().map(|given| given.span)),
            ("rope", link.rope.as_ref().map(|hanging_rope| hanging_rope.span)),
        ]
        .into_iter()
        .filter_map(|(key, span)| Some((key, span?)))
        .collect();
        if let [(first, _), (second, span), ..] = carried[..] {
            self.report(rule::two_masses(span, name, first, second));
        }
        self.alone(link, name);

        if let Some(beam) = &link.beam {
            return self.beam(beam, name, link.name.span, attached);
        }
        if let Some(rope) = &link.rope {
            return self.rope(rope, name, link.name.span, attached);
        }
        let (inertia, parts) = match (&link.mass, &link.bodies) {
            (Some(mass), _) => {
                let subject = format!("link `{name}`");
                let lump = self.inertia(mass, link.com.as_ref(), link.inertia.as_ref(), &subject);
                (lump.map(|lump| self.judged_in_sum(lump).0), Vec::new())
            }
            (None, Some(bodies)) => self.lumped(bodies.value.as_deref().unwrap_or_default()),
            (None, None) => (None, Vec::new()),
        };
        let (name, link_name) = (name.to_owned(), name.to_owned());
        let Attached { parent, along, path } = attached;
        self.push_body(
            chain::Body { name, link: link_name, parent, along, path, inertia, parts, length: Value::ZERO },
            link.name.span,
        );
        Carried { starts: vec![Value::ZERO], ..Carried::default() }
    }

    /// Checks that `com` and `inertia` of a link come with `mass`, and `mass` with `com`.
    fn alone(&mut self, link: &Link, name: &str) {
        let com = link.com.as_ref().map(|given| ("com", given.span));
        let inertia = link.inertia.as_ref().map(|given| ("inertia", given.span));
        match (&link.mass, com) {
            (None, _) => {
                for (key, span) in [com, inertia].into_iter().flatten() {
                    self.report(rule::without_mass(span, name, key));
                }
            }
            (Some(mass), None) => self.report(rule::missing_key(mass.span, "com", format!("link `{name}`"))),
            _ => {}
        }
    }

    /// Several bodies combined into one.
    fn lumped(&mut self, bodies: &[Spanned<Body>]) -> (Option<chain::Inertia>, Vec<LinkPart>) {
        let mut parts: Vec<LinkPart> = Vec::new();
        let mut whole = None;
        for (body, span) in bodies.iter().filter_map(|body| Some((body.value.as_ref()?, body.span))) {
            let name = self.name(&body.name).unwrap_or_default().to_owned();
            if !name.is_empty() && parts.iter().any(|part| part.name == name) {
                self.report(rule::duplicate_name(span, "bodies", &name, "a body of this link"));
            }
            let inertia = self.inertia(&body.mass, Some(&body.com), body.inertia.as_ref(), &format!("body `{name}`"));
            if let Some(lump) = inertia {
                let (inertia, com) = self.judged_in_sum(lump);
                parts.push(LinkPart { name, mass: inertia.mass.clone(), com });
                whole = Some(match whole {
                    Some(others) => inertia::sum(others, inertia),
                    None => inertia,
                });
            }
        }
        (whole, parts)
    }

    /// Mass, centre of mass and inertia as a pseudo-inertia about the origin of the frame.
    pub(super) fn inertia(
        &mut self,
        mass: &Spanned<Number>,
        com: Option<&Spanned<Vector>>,
        inertia: Option<&Spanned<Inertia>>,
        subject: &str,
    ) -> Option<Lump> {
        // Moments alone are a mass of zero with an inertia; radii of gyration are in proportion to the mass.
        let moments = inertia.and_then(|given| given.value.as_ref()).is_some_and(|given| given.gyration.is_none());
        let limit = if moments { Limit::MassOfMoments } else { Limit::Mass };
        let m = self.number_within(mass, limit, &format!("the mass of {subject}"));
        let com = self.vector_or_zero(com, &format!("the centre of mass of {subject}"));
        let subject = format!("the inertia of {subject}");
        let Some(given) = inertia else {
            return Some(Lump { inertia: inertia::point(m, &com), com, judgement: None });
        };
        let written = given.value.as_ref()?;
        let (tensor, about) = self.tensor(written, given.span, &m, &subject)?;
        let judgement = match &written.gyration {
            // Whether radii of gyration are possible does not depend on the mass, which may be zero.
            Some(_) => {
                let (unit, _) = self.tensor(written, given.span, &Value::ONE, &subject)?;
                self.judge(&Value::ONE, &com, &unit, about, given.span, subject)
            }
            None => self.judge(&m, &com, &tensor, about, given.span, subject),
        };
        let inertia = match about {
            About::Com => inertia::about_com(m, &com, &tensor),
            About::Origin => inertia::about_origin(m, &com, &tensor),
        };
        Some(Lump { inertia, com, judgement })
    }

    /// The pseudo-inertia and the centre of mass of a part of the next body, which is judged with all that moves with it.
    fn judged_in_sum(&mut self, Lump { inertia, com, judgement }: Lump) -> (chain::Inertia, [Value; 3]) {
        let body = BodyId(self.bodies.len());
        self.judgements.extend(judgement.map(|judgement| (body, judgement)));
        (inertia, com)
    }

    fn tensor(&mut self, inertia: &Inertia, span: Span, mass: &Value, subject: &str) -> Option<(Tensor, About)> {
        let keys = ["Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"];
        let elements = [&inertia.xx, &inertia.yy, &inertia.zz, &inertia.xy, &inertia.xz, &inertia.yz];
        let about = inertia.about.as_ref().map_or(Some(About::Com), |about| about.value)?;
        if let Some(radii) = &inertia.gyration {
            let beside = elements.iter().filter_map(|element| element.as_ref()).map(|element| element.span);
            let beside = beside.chain(inertia.about.iter().map(|about| about.span)).next();
            if let Some(span) = beside {
                self.report(rule::two_inertias(span, subject));
                return None;
            }
            let radii = self.vector(radii, "`gyration`");
            return Some((inertia::gyration(mass, &radii), About::Com));
        }
        let mut tensor = [Value::ZERO; 6];
        for (k, (key, element)) in keys.into_iter().zip(elements).enumerate() {
            match element {
                Some(element) => tensor[k] = self.number(element, &format!("`{key}`")),
                None if k < 3 => {
                    self.report(rule::missing_key(span, key, subject));
                    tensor[k] = f64::NAN.into();
                }
                None => {}
            }
        }
        Some((tensor, about))
    }
}
