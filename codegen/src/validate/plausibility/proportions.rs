//! Parts that do not fit each other in size: feet, shapes, cylinders, dampers, times.

use super::{Plausibility, angles::positions, rounded};
use crate::chain::{Coordinate, CoordinateKind, Form};
use crate::diagnostic::{Span, rule};
use crate::spec::{Constant, Motion, Number, Shape, Spanned, Vector, entries};

impl Plausibility<'_> {
    /// Feet far from all others.
    pub(super) fn far_feet(&mut self) {
        /// Distance of a foot from the axis of the base, as a multiple of that of the next farthest.
        const FAR: f64 = 4.0;
        let places: Vec<f64> = self
            .chain
            .supports
            .iter()
            .map(|support| support.position[0].at(&self.values).hypot(support.position[1].at(&self.values)))
            .collect();
        for (index, given) in entries(self.crane.supports.as_ref()).enumerate() {
            let others = places.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, place)| *place);
            let next = others.fold(0.0, f64::max);
            if places.len() > 2 && next > 0.0 && places[index] > FAR * next {
                let name = given.name.value.as_deref().unwrap_or_default();
                self.warn(rule::far_foot(given.at.span, name, rounded(places[index]), rounded(next)));
            }
        }
    }

    /// Shapes whose smallest side is larger than the crane.
    pub(super) fn large_shapes(&mut self) {
        /// Smallest side that no link has unless its crane is larger, m.
        const SIDE: f64 = 5.0;
        let size = self.size();
        let links = entries(Some(&self.crane.links)).flat_map(|link| {
            let shapes = link.shape.as_ref().and_then(|shapes| shapes.value.as_ref());
            shapes.into_iter().flat_map(|shapes| &shapes.0).filter_map(|shape| shape.value.as_ref()).map(move |shape| {
                let span = match shape {
                    Shape::Box(shape) => shape.size.span,
                    Shape::Cylinder(shape) | Shape::Capsule(shape) => shape.diameter.span,
                    Shape::Mesh(shape) => shape.file.span,
                };
                (link.name.value.as_deref().unwrap_or_default(), span)
            })
        });
        for ((name, span), shape) in links.zip(&self.chain.shapes).collect::<Vec<_>>() {
            let side = match &shape.form {
                Form::Box(sides) => sides.iter().map(|side| side.at(&self.values)).fold(f64::INFINITY, f64::min),
                Form::Cylinder { diameter, .. } | Form::Capsule { diameter, .. } => diameter.at(&self.values),
                Form::Mesh { .. } => continue,
            };
            if side > size.max(SIDE) {
                self.warn(rule::large_shape(span, name, rounded(side), rounded(size)));
            }
        }
    }

    /// Rods and pistons that no cylinder has.
    pub(super) fn slender_cylinders(&mut self) {
        /// Least diameter of a rod, as a share of that of its piston.
        const THIN: f64 = 0.1;
        for (given, cylinder) in entries(self.crane.cylinders.as_ref()).zip(&self.chain.cylinders) {
            if cylinder.rod < THIN * cylinder.bore || cylinder.bore > cylinder.retracted {
                let [bore, rod, retracted] = [cylinder.bore, cylinder.rod, cylinder.retracted].map(rounded);
                let span = if cylinder.bore > cylinder.retracted { given.bore.span } else { given.rod.span };
                self.warn(rule::odd_cylinder(span, &cylinder.name, bore, rod, retracted));
            }
        }
    }

    /// Dampers of feet, pads and couplings that hold their springs back for seconds.
    pub(super) fn slow_dampers(&mut self) {
        /// Longest time in which a spring with its damper gives way, s.
        const SLOW: f64 = 2.0;
        let crane = self.crane;
        let mut found: Vec<(String, &Spanned<Number>, &Spanned<Number>)> = Vec::new();
        for support in entries(crane.supports.as_ref()) {
            let what = format!("support `{}`", support.name.value.as_deref().unwrap_or_default());
            let each = three(Some(&support.stiffness)).zip(three(support.damping.as_ref()));
            found.extend(each.map(|(stiffness, damping)| (what.clone(), stiffness, damping)));
        }
        for coupling in entries(crane.couplings.as_ref()) {
            let what = format!("coupling `{}`", coupling.name.value.as_deref().unwrap_or_default());
            found.extend(coupling.stiffness.as_ref().zip(coupling.damping.as_ref()).map(|(k, d)| (what, k, d)));
        }
        for link in entries(Some(&crane.links)) {
            let pads = link.slides_in().and_then(|slides| slides.value.as_ref()?.pads.value.as_ref());
            let what = format!("a pad of `{}`", link.name.value.as_deref().unwrap_or_default());
            for pad in pads.into_iter().flat_map(|pads| [&pads.front, &pads.rear]).filter_map(|pad| pad.value.as_ref())
            {
                let each = three(pad.stiffness.as_ref()).zip(three(pad.damping.as_ref()));
                found.extend(each.map(|(stiffness, damping)| (what.clone(), stiffness, damping)));
                if let Some(Some([y, z, twist])) = pad.stiffness.as_ref().map(|given| &given.value) {
                    let [y, z, (twist, at)] = [y, z, twist].map(|given| self.number(given));
                    let [least, most] = [y.0.min(z.0), y.0.max(z.0)];
                    if least > 0.0 && twist >= most && (twist > most || least < 0.5 * most) {
                        self.warn(rule::stiff_twist(at, &what, rounded(twist), rounded(most)));
                    }
                }
            }
        }
        for (what, stiffness, damping) in found {
            let ((stiffness, _), (damping, at)) = (self.number(stiffness), self.number(damping));
            // The others were written with it.
            if stiffness > 0.0 && damping > SLOW * stiffness {
                return self.warn(rule::slow_damper(at, &what, rounded(damping / stiffness)));
            }
        }
    }

    /// Supports that gravity does not press on the ground.
    pub(super) fn aside(&mut self) {
        /// Cosine of the steepest slope, 40°.
        const STEEPEST: f64 = 0.766;
        let gravity = self.chain.gravity.each_ref().map(|g| g.at(&self.values));
        let size = gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let span =
            self.crane.slope.as_ref().map(|given| given.span).or(self.crane.gravity.as_ref().map(|given| given.span));
        if let Some(span) = span.filter(|_| !self.chain.supports.is_empty() && -gravity[2] < STEEPEST * size) {
            let angle = (-gravity[2] / size).acos().to_degrees().round();
            self.warn(rule::gravity_aside(span, angle));
        }
    }

    /// Slides that would leave the crane.
    pub(super) fn far_slides(&mut self) {
        /// Farthest usual position, m, and as a multiple of the crane's size without it.
        const FAR: [f64; 2] = [20.0, 5.0];
        let (crane, chain) = (self.crane, self.chain);
        let slides = |kind: CoordinateKind| kind == CoordinateKind::Translation;
        let pushed_in = |(x, coordinate): (&f64, &Coordinate)| if slides(coordinate.kind) { 0.0 } else { *x };
        let q: Vec<f64> = chain.guess.iter().zip(&chain.coordinates).map(pushed_in).collect();
        let size = self.size_at(&q);
        for drive in entries(crane.drives.as_ref()) {
            let name = drive.coordinate.value.as_deref().unwrap_or_default();
            let is_slide = |known: &Coordinate| known.name == name && slides(known.kind);
            let Some(motion) = drive.motion.as_ref().and_then(|motion| motion.value.as_ref()) else { continue };
            let reached = positions(motion).into_iter().filter_map(|(x, at)| Some((self.scalar(x?), at)));
            let far = reached.into_iter().find(|(x, _)| x.abs() > FAR[0].max(FAR[1] * size));
            if let Some((x, at)) = far.filter(|_| chain.coordinates.iter().any(is_slide)) {
                self.warn(rule::far_slide(at, name, rounded(x), rounded(size)));
            }
        }
    }

    /// Motions and events of which a run sees nothing.
    pub(super) fn late(&mut self) {
        let crane = self.crane;
        for drive in entries(crane.drives.as_ref()) {
            let name = drive.coordinate.value.as_deref().unwrap_or_default();
            let Some(motion) = drive.motion.as_ref().and_then(|motion| motion.value.as_ref()) else { continue };
            let (begin, duration) = match motion {
                Motion::Quintic(ramp) | Motion::Cubic(ramp) | Motion::Cycloid(ramp) => {
                    (&ramp.begin, Some(&ramp.duration))
                }
                Motion::Trapezoid(ramp) => (&ramp.begin, Some(&ramp.duration)),
                Motion::Speed(speed) => (&speed.begin, None),
                Motion::Hold(_) | Motion::Table(_) | Motion::Input(_) => continue,
            };
            let begin = begin.as_ref().map(|given| self.number(given));
            let duration = duration.map(|given| self.number(given));
            self.after_the_run(begin, 1.0, &format!("the motion of `{name}` begins"));
            self.after_the_run(duration, 1.0 / SHORTEST, &format!("the motion of `{name}` takes"));
        }
        for event in entries(crane.events.as_ref()) {
            let at = |given: &Spanned<Constant>| Some((self.scalar(&given.value.as_ref()?.0), given.span));
            let name = event.name.value.as_deref().unwrap_or_default();
            self.after_the_run(event.at.as_ref().and_then(at), 1.0, &format!("event `{name}` happens"));
        }
    }

    fn after_the_run(&mut self, time: Option<(f64, Span)>, share: f64, what: &str) {
        let end = self.chain.run.duration;
        if let Some((time, at)) = time.filter(|(time, _)| share * time >= end) {
            let after = if share < 1.0 { "" } else { "after " };
            self.warn(rule::late(at, what, format!("{after}{} s", rounded(time)), rounded(end)));
        }
    }
}

/// A motion takes at most this many times as long as the run.
const SHORTEST: f64 = 100.0;

/// The numbers of a vector that is given.
fn three(given: Option<&Spanned<Vector>>) -> impl Iterator<Item = &Spanned<Number>> {
    given.and_then(|given| given.value.as_ref()).into_iter().flatten()
}
