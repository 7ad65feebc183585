//! Booms that no drive can raise, and drives that the weight of the crane overcomes.

use super::{Plausibility, rounded};
use crate::chain::{Body, BodyId, Chain, CoordinateId, CoordinateKind, Drive, Law};
use crate::diagnostic::{Span, rule};
use crate::spec::{Joint, Link, entries};

/// Cosine of the angle to the vertical below which an axis is not vertical: 2°.
const VERTICAL: f64 = 0.9994;
/// Displacement of a joint under the weight that its drive holds, rad or m, from which the drive is too soft.
const SAG: f64 = 0.5;

fn named(link: &Link) -> &str {
    link.name.value.as_deref().unwrap_or_default()
}

impl Plausibility<'_> {
    /// A beam whose joint turns about the vertical directly after another such joint.
    pub(super) fn swept_booms(&mut self) {
        let links: Vec<&Link> = entries(Some(&self.crane.links)).collect();
        for boom in &links {
            let Some(before) = self.carrier(boom).and_then(|name| links.iter().find(|link| named(link) == name)) else {
                continue;
            };
            let [Some(first), Some(second)] = [before, boom].map(|link| self.turns(link)) else { continue };
            if boom.beam.is_some() && [first, second].into_iter().all(|id| self.is_vertical(id)) {
                let [name, other] = [boom, before].map(|link| named(link));
                let at = boom.placement.as_ref().map_or(boom.name.span, |placement| placement.span);
                self.warn(rule::swept(at, name, other));
            }
        }
    }

    /// The name of the link that a link is attached to.
    fn carrier(&self, link: &Link) -> Option<&str> {
        let BodyId(parent) = self.first_body(named(link))?.parent?;
        Some(&self.chain.bodies[parent].link)
    }

    fn first_body(&self, link: &str) -> Option<&Body> {
        self.chain.bodies.iter().find(|body| body.link == link)
    }

    /// The coordinate of the revolute joint of a link.
    fn turns(&self, link: &Link) -> Option<CoordinateId> {
        let is_revolute = matches!(link.joint.as_ref()?.value.as_ref()?, Joint::Revolute(_));
        let name = link.name.value.as_deref().filter(|_| is_revolute)?;
        let body = self.first_body(name)?;
        body.path.iter().find_map(|step| step.coordinates().first().copied())
    }

    fn is_vertical(&self, coordinate: CoordinateId) -> bool {
        let gravity = self.chain.gravity.each_ref().map(|g| g.at(&self.values));
        let size = gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let [_, axis] = self.chain.axis(coordinate, &self.pose_at_start(), &self.values);
        let along: f64 = axis.iter().zip(gravity).map(|(a, g)| a * g).sum();
        along.abs() > VERTICAL * size
    }

    /// The guess, with the drives where their motions begin.
    pub(super) fn pose_at_start(&self) -> Vec<f64> {
        let mut q = self.chain.guess.clone();
        for drive in self.chain.drives.iter().filter(|drive| drive.holds()) {
            q[drive.coordinate.0] = drive.profile.start(&self.values);
        }
        q
    }

    /// Drives whose joints the weight of the crane moves far from the drive's position.
    pub(super) fn soft_drives(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        for given in entries(crane.drives.as_ref()) {
            let Some(span) = given.stiffness.as_ref().map(|given| given.span) else { continue };
            let named =
                |drive: &&Drive| Some(&chain.coordinates[drive.coordinate.0].name) == given.coordinate.value.as_ref();
            let Some(drive) = chain.drives.iter().find(named) else { continue };
            let stiffness = drive.oil().or_else(|| drive.spring().map(|(stiffness, _)| stiffness));
            let Some(stiffness) = stiffness.map(|stiffness| stiffness.at(&self.values)) else { continue };
            // Other springs, ropes, stops and couplings may hold the joint instead.
            let springs = chain.connectors().iter().filter(|connector| !matches!(connector.law, Law::Friction(_)));
            let spanned = springs.map(|connector| chain.spanned(&connector.strain));
            let coupled = chain.rigid_couplings.iter().map(|coupling| coupling.follower.coordinates());
            let held = spanned.chain(coupled).any(|spanned| {
                let [first, end] = Chain::range(&spanned);
                (first..end).contains(&drive.coordinate.0)
            });
            let sag = self.effort_of_weight(drive.coordinate).abs() / stiffness;
            if stiffness > 0.0 && sag > SAG && !held && drive.max_effort().is_none() && drive.effort().is_none() {
                self.soft(span, drive.coordinate, sag, stiffness);
            }
        }
    }

    fn soft(&mut self, span: Span, id: CoordinateId, sag: f64, stiffness: f64) {
        let coordinate = &self.chain.coordinates[id.0];
        let [unit, of_stiffness] = match coordinate.kind {
            CoordinateKind::Translation => ["m", "N/m"],
            CoordinateKind::Rotation => ["rad", "N m/rad"],
        };
        self.warn(rule::soft_drive(span, &coordinate.name, rounded(sag), unit, stiffness, of_stiffness));
    }

    /// Torque or force of the weight of everything that a coordinate moves, at the start, N m or N.
    fn effort_of_weight(&self, coordinate: CoordinateId) -> f64 {
        let (chain, q) = (self.chain, self.pose_at_start());
        let gravity = chain.gravity.each_ref().map(|g| g.at(&self.values));
        let [origin, axis] = chain.axis(coordinate, &q, &self.values);
        let info = &chain.coordinates[coordinate.0];
        let mut effort = 0.0;
        for (index, frame) in chain.frames(&q, &self.values).into_iter().enumerate().skip(info.body.0) {
            let inertia = chain.bodies[index].inertia.as_ref().filter(|_| chain.moves(coordinate, BodyId(index)));
            let Some(inertia) = inertia else { continue };
            let mass = inertia.mass.at(&self.values);
            let first = frame.direction(inertia.first.each_ref().map(|first| first.at(&self.values)));
            let first_moment = [0, 1, 2].map(|i| first[i] + mass * (frame.origin[i] - origin[i]));
            let moment = [
                first_moment[1] * gravity[2] - first_moment[2] * gravity[1],
                first_moment[2] * gravity[0] - first_moment[0] * gravity[2],
                first_moment[0] * gravity[1] - first_moment[1] * gravity[0],
            ];
            effort += match info.kind {
                CoordinateKind::Rotation => (0..3).map(|i| axis[i] * moment[i]).sum::<f64>(),
                CoordinateKind::Translation => (0..3).map(|i| axis[i] * mass * gravity[i]).sum(),
            };
        }
        effort
    }
}
