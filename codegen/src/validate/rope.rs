//! Ropes and chains: rigid links that hang from each other.

use super::on::Attached;
use super::{Carried, Check, Owner};
use crate::chain::{self, Axis, CoordinateKind, Inertia, Step, Value};
use crate::diagnostic::{Span, rule};
use crate::spec::{HangingRope, Spanned};

/// Rotations of a universal joint, in order. There is none about the rope itself: links have no torsion.
const ROTATIONS: [Axis; 2] = [Axis::Z, Axis::Y];

impl<'a> Check<'a> {
    /// Appends the links of a rope.
    pub(super) fn rope(
        &mut self,
        hanging_rope: &'a Spanned<HangingRope>,
        link: &str,
        span: Span,
        mut attached: Attached,
    ) -> Carried {
        let links = hanging_rope.value.as_ref().and_then(|rope| {
            let broken = |count| rule::rope_links(rope.links.span, count);
            Some((rope, self.count(&rope.links, "`links`", broken)?))
        });
        let Some((rope, count)) = links else {
            // The rope's coordinates are not known.
            self.unknown.links = true;
            return Carried::default();
        };
        let length = self.number(&rope.length, "`length`");
        let line_density = self.number(&rope.mass_per_length, "`mass_per_length`");
        let damping = self.number_or(rope.damping.as_ref(), 0.0, "`damping`");
        let length = length / Value::Constant(f64::from(count));
        self.push_beam(link, Vec::new(), None, None);
        let inertia = slender(&length, &line_density);
        let (mut starts, mut start, mut tip) = (Vec::new(), Value::ZERO, Value::ZERO);
        for number in 1..=count {
            let name = format!("{link}_{number}");
            if number > 1 {
                attached = self.on_the_last_body(tip);
            }
            for axis in ROTATIONS {
                let coordinate =
                    self.push_coordinate((link, &name), CoordinateKind::Rotation, axis, Owner::Joint, span);
                attached.path.push(Step::Move(coordinate));
                if !damping.is_zero() {
                    self.rope_damping.push((coordinate, damping.clone()));
                }
            }
            let Attached { parent, along, path } = std::mem::take(&mut attached);
            let body = chain::Body {
                name,
                link: link.to_owned(),
                parent,
                along,
                path,
                inertia: Some(inertia.clone()),
                parts: Vec::new(),
                length: length.clone(),
            };
            self.push_body(body, span);
            starts.push(start.clone());
            start = start + length.clone();
            tip = length.clone();
        }
        Carried { starts, tip, ..Carried::default() }
    }
}

/// Pseudo-inertia about its start of a slender rod of length d along x: `m = μ d`, `∫x dm = m d/2`, `∫x² dm = m d²/3`.
fn slender(length: &Value, line_density: &Value) -> Inertia {
    let mass = line_density.clone() * length.clone();
    let first = 0.5 * mass.clone() * length.clone();
    let second = mass.clone() * length.clone() * length.clone() / 3.0.into();
    let nothing = || Value::ZERO;
    Inertia {
        mass,
        first: [first, nothing(), nothing()],
        second: [second, nothing(), nothing(), nothing(), nothing(), nothing()],
    }
}
