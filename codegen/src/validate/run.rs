//! Frames, names of joints and points of interest, the guess of the static solution, and the settings of a run.

use super::Check;
use super::numbers::Whose;
use crate::chain::{BodyId, CoordinateId, Drive, NamedFrame, NamedJoint, Point, Run, Transmission, Value};
use crate::diagnostic::{rule, suggest};
use crate::expand::placement;
use crate::spec::{self, Constant, Crane, Spanned, entries};

impl<'a> Check<'a> {
    pub(super) fn frames(&mut self, crane: &'a Crane) -> Vec<NamedFrame> {
        let mut frames = Vec::new();
        for frame in entries(crane.frames.as_ref()) {
            let name = self.text(Some(&frame.name), "the name of a frame").unwrap_or_default();
            self.register_name("frames", &name, "an earlier frame".into(), frame.name.span);
            let transform = frame.transform.as_ref().and_then(|transform| transform.value.as_ref());
            let (at, turns) =
                transform.map_or_else(|| ([Value::ZERO; 3], Vec::new()), |transform| self.transform(transform));
            let place = frame
                .link
                .as_ref()
                .map_or(Some((None, at.clone())), |link| self.attach(link, at).map(|(body, at)| (Some(body), at)));
            if let Some((body, at)) = place {
                frames.push(NamedFrame { name, body, path: placement::transform(at, &turns, Vec::new()) });
            }
        }
        frames
    }

    pub(super) fn joints(&mut self, crane: &'a Crane) -> Vec<NamedJoint> {
        let mut joints = Vec::new();
        for joint in entries(crane.joints.as_ref()) {
            let name = self.text(Some(&joint.name), "the name of a joint").unwrap_or_default();
            self.register_name("joints", &name, "an earlier joint".into(), joint.name.span);
            let coordinate = joint.coordinate.as_ref().and_then(|text| self.coordinate(text));
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let subject = format!("`at` of joint `{name}`");
            let at = joint.at.as_ref().map_or(0.0, |at| self.fixed(at, Whose::Joint(kind), &subject));
            joints.push(NamedJoint { name, coordinate, at });
        }
        joints
    }

    pub(super) fn points(&mut self, crane: &'a Crane, frames: &[NamedFrame]) -> Vec<Point> {
        let mut points = Vec::new();
        for point in entries(crane.points.as_ref()) {
            let name = self.name(&point.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_name("points", &name, "an earlier point".into(), point.name.span);
            }
            let subject = format!("the position of point `{name}`");
            let at = self.vector_or_zero(point.at.as_ref(), &subject);
            let place = match (&point.link, &point.frame) {
                (Some(link), None) => self.attach(link, at),
                (None, Some(frame)) => self.in_frame(crane, frame, frames, at),
                _ => {
                    self.report(rule::link_or_frame(point.name.span, &name));
                    None
                }
            };
            if let Some((body, position)) = place {
                points.push(Point { name, body, position });
            }
        }
        points
    }

    /// The body that carries a frame, and on it a position given in the frame. `None` if the frame does not exist, or is not on a link.
    fn in_frame(
        &mut self,
        crane: &Crane,
        text: &Spanned<String>,
        frames: &[NamedFrame],
        at: [Value; 3],
    ) -> Option<(BodyId, [Value; 3])> {
        let name = text.value.as_deref()?;
        if let Some((frame, body)) = frames.iter().find(|frame| frame.name == name).and_then(|it| Some((it, it.body?)))
        {
            return Some((body, frame.transform_point(at)));
        }
        // One on an unknown link has been reported.
        let on_link = |frame: &spec::NamedFrame| frame.link.is_some() && frame.name.value.as_deref() == Some(name);
        if !entries(crane.frames.as_ref()).any(on_link) {
            let known = frames.iter().filter(|frame| frame.body.is_some()).map(|frame| frame.name.as_str());
            let help = if self.links.contains_key(name) {
                format!("`{name}` is a link: write `link: {name}`")
            } else {
                suggest(name, known)
            };
            self.report(rule::unknown_frame(text.span, name, help));
        }
        None
    }

    /// The body of a link that carries a point, and the position on it: for a beam, the element that contains the point's x. `None` if the
    /// link does not exist, or if a mistake left it without bodies.
    pub(super) fn attach(&mut self, link: &Spanned<String>, at: [Value; 3]) -> Option<(BodyId, [Value; 3])> {
        let name = link.value.as_deref()?;
        let Some(body) = self.links.get(name) else {
            if !self.unknown.links {
                let help = suggest(name, self.links.keys().copied());
                self.report(rule::unknown_link(link.span, name, help));
            }
            return None;
        };
        let [x, y, z] = at;
        let (body, x) = self.element_at(body, x);
        Some((body?, [x, y, z]))
    }

    /// The pose at which statics begins, as far as it is written.
    pub(super) fn guess(&mut self, crane: &'a Crane, drives: &[Drive]) -> Vec<Option<f64>> {
        let mut guess = vec![None; self.coordinates.len()];
        let entries = crane.guess.as_ref().and_then(|guess| guess.value.as_ref());
        for (name, position) in entries.into_iter().flat_map(|entries| &entries.0) {
            let coordinate = self.coordinate(name);
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let subject = format!("the guess of `{}`", name.value.as_deref().unwrap_or_default());
            let position = self.fixed(position, Whose::Joint(kind), &subject);
            let Some(id) = coordinate else { continue };
            if drives.iter().any(|drive| drive.coordinate == id && drive.transmission == Transmission::Rigid) {
                self.report(rule::prescribed_guess(name.span, &self.coordinates[id.0].name));
            }
            guess[id.0] = Some(position);
        }
        guess
    }

    pub(super) fn run(&mut self, given: Option<&Spanned<spec::Run>>) -> Run {
        let run = given.and_then(|given| given.value.clone()).unwrap_or_default();
        let mut seconds = |given: Option<&Spanned<Constant>>, default, key| {
            given.map_or(default, |constant| self.constant(constant, key))
        };
        let duration = seconds(run.duration.as_ref(), 10.0, "`duration`");
        let step = seconds(run.step.as_ref(), 1e-4, "`step`");
        let output = seconds(run.output.as_ref(), 0.01, "`output`");
        let span = |written: &Option<Spanned<Constant>>| {
            written.as_ref().map_or(given.map(|given| given.span).unwrap_or_default(), |written| written.span)
        };
        if step > output {
            self.report(rule::run_order(span(&run.step), "step", "output"));
        }
        if output > duration {
            self.report(rule::run_order(span(&run.output), "output", "duration"));
        }
        Run { duration, step, output }
    }
}
