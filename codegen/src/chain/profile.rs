//! Prescribed motions of drives, `q_dr(t)`.

use super::{InputId, Value};

/// A prescribed motion: constant before it begins and, unless it is a speed, after it ends; continuously differentiable,
/// unless it jumps to its speed or follows an input that jumps.
///
/// With `τ = clamp((t − begin)/duration, 0, 1)` the normalised profiles move from `from` to `to` as
/// `q_dr = from + (to − from) s(τ)`.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// Held at one position, m or rad.
    Hold(Value),
    /// `s = 10τ³ − 15τ⁴ + 6τ⁵`: at rest with zero acceleration at both ends.
    Quintic(Ramp),
    /// `s = 3τ² − 2τ³`: at rest at both ends.
    Cubic(Ramp),
    /// `s = τ − sin(2πτ)/2π`: smooth acceleration.
    Cycloid(Ramp),
    /// Trapezoidal velocity: constant acceleration over the first and last `blend` of the duration, 0 < blend ≤ ½.
    /// The acceleration jumps at the ends of the ramps.
    Trapezoid {
        /// Start, end and time.
        ramp: Ramp,
        /// Fraction of the duration spent accelerating.
        blend: f64,
    },
    /// Constant speed from `begin` on, without end.
    Speed {
        /// Position before, m or rad.
        from: Value,
        /// Speed, m/s or rad/s.
        rate: Value,
        /// When it begins, s.
        begin: Value,
        /// Time to reach the speed, s: `q̇_dr = rate (3τ² − 2τ³)`. Without it, the speed jumps.
        ramp: Option<Value>,
    },
    /// An input: constant while it is set, otherwise the given motion.
    Input(InputId, Box<Profile>),
    /// An emergency stop: from `at` on, the motion runs in a time θ that slows down evenly and stands still after `within`: with
    /// `u = clamp(t − at, 0, T)`, `θ = min(t, at) + u − u²/2T`. It stays on its way, and its rate falls in proportion.
    Halted {
        /// The motion.
        motion: Box<Profile>,
        /// When it begins to slow down, s.
        at: Value,
        /// T, s.
        within: Value,
    },
    /// The sum of two motions.
    Sum(Box<[Profile; 2]>),
    /// Cubic pieces through given positions.
    Table {
        /// Position before the first segment, m or rad.
        from: f64,
        /// The pieces in order of time, each starting where the previous one ends.
        segments: Vec<Segment>,
    },
}

impl Profile {
    /// Whether an input is part of it.
    #[must_use]
    pub fn has_input(&self) -> bool {
        match self {
            Profile::Input(..) => true,
            Profile::Sum(parts) => parts.iter().any(Profile::has_input),
            Profile::Halted { motion, .. } => motion.has_input(),
            _ => false,
        }
    }

    /// Positions that it passes or at which it stops, as far as they are given: not those of an input that is set, nor where a speed leads.
    #[must_use]
    pub fn stations(&self) -> Vec<Value> {
        match self {
            Profile::Hold(position) | Profile::Speed { from: position, .. } => vec![position.clone()],
            Profile::Quintic(ramp)
            | Profile::Cubic(ramp)
            | Profile::Cycloid(ramp)
            | Profile::Trapezoid { ramp, .. } => {
                vec![ramp.from.clone(), ramp.to.clone()]
            }
            Profile::Input(_, unless_set) => unless_set.stations(),
            Profile::Halted { motion, .. } => motion.stations(),
            Profile::Sum(_) => Vec::new(),
            Profile::Table { from, segments } => {
                let reached = |position: &mut f64, segment: &Segment| {
                    let begun = *position;
                    *position += segment.rise(segment.duration);
                    Some(segment.extremes().into_iter().map(move |rise| begun + rise).chain([*position]))
                };
                let reached = segments.iter().scan(*from, reached).flatten();
                [*from].into_iter().chain(reached).map(Value::Constant).collect()
            }
        }
    }

    /// Begin and end, s, of the intervals in which it is smooth: at their ends some derivative jumps, or it comes to rest.
    #[must_use]
    pub fn pieces(&self) -> Vec<[Value; 2]> {
        match self {
            Profile::Hold(_) => Vec::new(),
            Profile::Quintic(ramp) | Profile::Cubic(ramp) | Profile::Cycloid(ramp) => {
                vec![[ramp.at(0.0), ramp.at(1.0)]]
            }
            Profile::Trapezoid { ramp, blend } => {
                let ends = [0.0, *blend, 1.0 - blend, 1.0];
                ends.windows(2).map(|share| [ramp.at(share[0]), ramp.at(share[1])]).collect()
            }
            Profile::Speed { begin, ramp, .. } => {
                let end = ramp.as_ref().map_or_else(|| begin.clone(), |ramp| begin.clone() + ramp.clone());
                vec![[begin.clone(), end]]
            }
            Profile::Input(_, unless_set) => unless_set.pieces(),
            Profile::Halted { motion, at, within } => {
                let pieces = motion.pieces().into_iter().map(|ends| ends.map(|end| when(end, at, within)));
                pieces.chain([[at.clone(), at.clone() + within.clone()]]).collect()
            }
            Profile::Sum(parts) => parts.iter().flat_map(Profile::pieces).collect(),
            Profile::Table { segments, .. } => {
                segments.iter().map(|piece| [piece.begin.into(), (piece.begin + piece.duration).into()]).collect()
            }
        }
    }
}

/// When the time of a motion that is halted is `end`; live times after the halt has begun stay as they are.
fn when(end: Value, at: &Value, within: &Value) -> Value {
    let numbers = (end.as_constant(), at.as_constant(), within.as_constant());
    let (Some(time), Some(begin), Some(whole)) = numbers else { return end };
    let passed = (time - begin).max(0.0);
    if time <= begin {
        end
    } else if passed < 0.5 * whole {
        (begin + whole * (1.0 - libm::sqrt(1.0 - 2.0 * passed / whole))).into()
    } else {
        (begin + whole).into()
    }
}

impl Ramp {
    /// The time at a fraction of the duration.
    fn at(&self, share: f64) -> Value {
        self.begin.clone() + share * self.duration.clone()
    }
}

/// Start, end and time of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    /// Position before, m or rad.
    pub from: Value,
    /// Position after, m or rad.
    pub to: Value,
    /// When it begins, s.
    pub begin: Value,
    /// Its duration, s.
    pub duration: Value,
}

/// A cubic piece of a spline over `u = clamp(t − begin, 0, duration)`: adds `c₁u + c₂u² + c₃u³`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// When it begins, s.
    pub begin: f64,
    /// Its duration, s.
    pub duration: f64,
    /// `c₁, c₂, c₃`.
    pub coefficients: [f64; 3],
}

impl Segment {
    /// What it adds up to u, s.
    #[must_use]
    pub fn rise(&self, u: f64) -> f64 {
        let [c1, c2, c3] = self.coefficients;
        u * (c1 + u * (c2 + u * c3))
    }

    /// Its rate at u, s.
    #[must_use]
    pub fn slope(&self, u: f64) -> f64 {
        let [c1, c2, c3] = self.coefficients;
        c1 + u * (2.0 * c2 + 3.0 * u * c3)
    }

    /// The rate of its rate at u, s.
    #[must_use]
    pub fn curvature(&self, u: f64) -> f64 {
        let [_, c2, c3] = self.coefficients;
        2.0 * c2 + 6.0 * u * c3
    }

    /// What it adds where it turns between its ends.
    #[must_use]
    pub fn extremes(&self) -> Vec<f64> {
        let [c, b, a] = [self.coefficients[0], 2.0 * self.coefficients[1], 3.0 * self.coefficients[2]];
        let discriminant = b * b - 4.0 * a * c;
        if discriminant <= 0.0 {
            return Vec::new();
        }
        // Without cancellation: one root by the sum, the other by the product.
        let sum = -0.5 * (b + discriminant.sqrt().copysign(b));
        let turns = [sum / a, c / sum].into_iter().filter(|u| *u > 0.0 && *u < self.duration);
        turns.map(|u| self.rise(u)).collect()
    }
}

/// A derivative of a piece at u, s.
pub type Derivative = fn(&Segment, f64) -> f64;

/// The times at which a derivative of a curve that rests before and after jumps, s, and by how much.
#[must_use]
pub fn jumps(segments: &[Segment], derivative: Derivative) -> Vec<(f64, f64)> {
    let along = |segment: &Segment| [0.0, 0.5, 1.0].map(|share| derivative(segment, share * segment.duration).abs());
    let rounding = 1e-9 * segments.iter().flat_map(along).fold(0.0, f64::max);
    let before = [0.0].into_iter().chain(segments.iter().map(|segment| derivative(segment, segment.duration)));
    let starts = segments.iter().map(|segment| (segment.begin, derivative(segment, 0.0)));
    let after = starts.chain(segments.last().map(|last| (last.begin + last.duration, 0.0)));
    let jumps = before.zip(after).map(|(before, (time, after))| (time, after - before));
    jumps.filter(|(_, jump)| jump.abs() > rounding).collect()
}

/// The first time after the beginning of a run at which the rate of a curve jumps, s.
#[must_use]
pub fn first_jump(segments: &[Segment]) -> Option<f64> {
    jumps(segments, Segment::slope).into_iter().map(|(time, _)| time).find(|time| *time > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::ParameterId;
    use crate::expand::curve::spline;

    #[test]
    fn pieces_end_where_motions_are_not_smooth() {
        let duration = Value::Parameter(ParameterId(0));
        let ramp = Ramp { from: 1.0.into(), to: 3.0.into(), begin: 2.0.into(), duration };
        let at = |profile: Profile| -> Vec<[f64; 2]> {
            profile.pieces().iter().map(|ends| ends.each_ref().map(|end| end.at(&[4.0]))).collect()
        };
        assert_eq!(at(Profile::Quintic(ramp.clone())), [[2.0, 6.0]]);
        assert_eq!(at(Profile::Trapezoid { ramp, blend: 0.25 }), [[2.0, 3.0], [3.0, 5.0], [5.0, 6.0]]);
        let segments = spline(&[-2.0, 0.0, 1.0], &[1.0, 2.5, 3.0]);
        assert_eq!(at(Profile::Table { from: 1.0, segments }), [[-2.0, 0.0], [0.0, 1.0]]);
        assert!(at(Profile::Hold(1.0.into())).is_empty());
    }
}
