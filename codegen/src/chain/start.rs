//! Positions of prescribed motions at the start of a run.

use std::f64::consts::PI;

use super::{Chain, Follower, Profile, Ramp};

impl Profile {
    /// `q_dr(0)` with the given parameter values and no input set, rad or m.
    #[must_use]
    pub fn start(&self, parameters: &[f64]) -> f64 {
        let along = |ramp: &Ramp, shape: &dyn Fn(f64) -> f64| {
            let [from, to, begin, duration] =
                [&ramp.from, &ramp.to, &ramp.begin, &ramp.duration].map(|v| v.at(parameters));
            from + (to - from) * shape((-begin / duration).clamp(0.0, 1.0))
        };
        match self {
            Profile::Hold(position) => position.at(parameters),
            Profile::Quintic(ramp) => along(ramp, &|tau| tau.powi(3) * (10.0 - 15.0 * tau + 6.0 * tau * tau)),
            Profile::Cubic(ramp) => along(ramp, &|tau| tau * tau * (3.0 - 2.0 * tau)),
            Profile::Cycloid(ramp) => along(ramp, &|tau| tau - libm::sin(2.0 * PI * tau) / (2.0 * PI)),
            Profile::Trapezoid { ramp, blend } => along(ramp, &|tau| trapezoid(tau, *blend)),
            Profile::Speed { from, rate, begin, ramp } => {
                let passed = (-begin.at(parameters)).max(0.0);
                let lost = ramp.as_ref().map_or(0.0, |ramp| {
                    let ramp = ramp.at(parameters);
                    let tau = (passed / ramp).min(1.0);
                    ramp * (tau - tau.powi(3) * (1.0 - tau / 2.0))
                });
                from.at(parameters) + rate.at(parameters) * (passed - lost)
            }
            Profile::Input(_, unless_set) => unless_set.start(parameters),
            // No halt begins before a run.
            Profile::Halted { motion, .. } => motion.start(parameters),
            Profile::Sum(parts) => parts.iter().map(|part| part.start(parameters)).sum(),
            Profile::Table { from, segments } => segments.iter().fold(*from, |position, segment| {
                position + segment.rise((-segment.begin).max(0.0).min(segment.duration))
            }),
        }
    }
}

impl Chain {
    /// Where statics begins with the given parameter values, rad and m: as written, where drives begin, or where the coordinates are that others
    /// follow; otherwise 0.
    #[must_use]
    pub fn guess_at(&self, parameters: &[f64]) -> Vec<f64> {
        self.known_guess(parameters).into_iter().map(Option::unwrap_or_default).collect()
    }

    /// The same without what is 0 because nothing else is known.
    pub(super) fn known_guess(&self, parameters: &[f64]) -> Vec<Option<f64>> {
        let mut guess = self.written_guess.clone();
        for drive in self.drives.iter().filter(|drive| drive.holds()) {
            guess[drive.coordinate.0].get_or_insert_with(|| drive.profile.start(parameters));
        }
        // A coordinate that follows one that follows another is known one pass later.
        let followers: Vec<Follower> = self.followers().collect();
        for _ in &followers {
            for follower in &followers {
                if let (None, Some(leading)) = (guess[follower.coordinate.0], guess[follower.leader.0]) {
                    guess[follower.coordinate.0] = Some(follower.place(leading, parameters));
                }
            }
        }
        guess
    }
}

/// Position along a trapezoidal velocity profile with ramps of length b: the velocity between them is `1/(1 − b)`.
fn trapezoid(tau: f64, blend: f64) -> f64 {
    let ramp = |t: f64| t * t / (2.0 * blend * (1.0 - blend));
    if tau < blend {
        ramp(tau)
    } else if tau > 1.0 - blend {
        1.0 - ramp(1.0 - tau)
    } else {
        (tau - blend / 2.0) / (1.0 - blend)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expand::curve::spline;

    #[test]
    fn motions_that_began_before_are_under_way() {
        let ramp = |begin: f64| Ramp { from: 1.0.into(), to: 3.0.into(), begin: begin.into(), duration: 4.0.into() };
        for make in
            [Profile::Quintic, Profile::Cubic, Profile::Cycloid, |ramp| Profile::Trapezoid { ramp, blend: 0.25 }]
        {
            for (begin, position) in [(0.0, 1.0), (5.0, 1.0), (-2.0, 2.0), (-9.0, 3.0)] {
                let value = make(ramp(begin)).start(&[]);
                assert!((value - position).abs() < 1e-15, "{value} {position}");
            }
        }
        let table = Profile::Table { from: 1.0, segments: spline(&[-2.0, 0.0, 1.0], &[1.0, 2.5, 3.0]) };
        assert!((table.start(&[]) - 2.5).abs() < 1e-15);
    }
}
