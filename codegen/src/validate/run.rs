//! Points of interest, the guess of the static solution, and the settings of a run.

use super::Check;
use super::drives::units;
use super::limits::Limit;
use crate::chain::{BodyId, CoordinateId, Drive, Follower, Point, Run, Transmission, Value};
use crate::diagnostic::{rule, suggest};
use crate::spec::{self, Constant, Crane, Spanned};

impl<'a> Check<'a> {
    pub(super) fn points(&mut self, crane: &'a Crane) -> Vec<Point> {
        let given = crane.points.as_ref().and_then(|points| points.value.as_deref()).unwrap_or_default();
        let mut points = Vec::new();
        for point in given.iter().filter_map(|point| point.value.as_ref()) {
            let name = self.name(&point.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_name("points", &name, "an earlier point".into(), point.name.span);
            }
            let at = self.vector(&point.at, &format!("the position of point `{name}`"), "m", Limit::Any);
            if let Some((body, position)) = self.attach(&point.link, at) {
                points.push(Point { name, body, position });
            }
        }
        points
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

    /// As written, where drives begin, or where the coordinates are that others follow; otherwise 0.
    pub(super) fn guess(&mut self, crane: &'a Crane, drives: &[Drive], followers: &[Follower]) -> Vec<f64> {
        let mut guess = vec![None; self.coordinates.len()];
        for drive in drives.iter().filter(|drive| drive.holds()) {
            guess[drive.coordinate.0] = Some(drive.profile.start(&self.defaults));
        }
        let entries = crane.guess.as_ref().and_then(|guess| guess.value.as_ref());
        for (name, position) in entries.into_iter().flat_map(|entries| &entries.0) {
            let coordinate = self.coordinate(name);
            let kind = coordinate.map(|CoordinateId(index)| self.coordinates[index].kind);
            let subject = format!("the guess of `{}`", name.value.as_deref().unwrap_or_default());
            let position = self.fixed(position, &subject, units(kind).position);
            let Some(id) = coordinate else { continue };
            if drives.iter().any(|drive| drive.coordinate == id && drive.transmission == Transmission::Rigid) {
                self.report(rule::prescribed_guess(name.span, &self.coordinates[id.0].name));
            }
            guess[id.0] = Some(position);
        }
        // A coordinate that follows one that follows another is known one pass later.
        for _ in followers {
            for follower in followers {
                if let (None, Some(leading)) = (guess[follower.coordinate.0], guess[follower.leader.0]) {
                    guess[follower.coordinate.0] = Some(follower.place(leading, &self.defaults));
                }
            }
        }
        guess.into_iter().map(Option::unwrap_or_default).collect()
    }

    pub(super) fn run(&mut self, given: Option<&Spanned<spec::Run>>) -> Run {
        let run = given.and_then(|given| given.value.clone()).unwrap_or_default();
        let mut seconds = |given: Option<&Spanned<Constant>>, default, key| {
            given.map_or(default, |given| self.constant(given, key, "s", Limit::Positive))
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
