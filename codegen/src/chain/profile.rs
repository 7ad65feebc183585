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
    /// The sum of two motions.
    Sum(Box<[Profile; 2]>),
    /// Cubic spline through given positions, at rest at both ends.
    Table {
        /// Position before the first segment, m or rad.
        from: f64,
        /// The spline's pieces in order of time, each starting where the previous one ends.
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
            Profile::Sum(_) => Vec::new(),
            Profile::Table { from, segments } => {
                let end = |position: &mut f64, Segment { duration, coefficients: [c1, c2, c3], .. }: &Segment| {
                    *position += duration * (c1 + duration * (c2 + duration * c3));
                    Some(*position)
                };
                let ends = segments.iter().scan(*from, end);
                [*from].into_iter().chain(ends).map(Value::Constant).collect()
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
            Profile::Sum(parts) => parts.iter().flat_map(Profile::pieces).collect(),
            Profile::Table { segments, .. } => {
                segments.iter().map(|piece| [piece.begin.into(), (piece.begin + piece.duration).into()]).collect()
            }
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::ParameterId;
    use crate::expand::spline::clamped;

    #[test]
    fn pieces_end_where_motions_are_not_smooth() {
        let duration = Value::Parameter(ParameterId(0));
        let ramp = Ramp { from: 1.0.into(), to: 3.0.into(), begin: 2.0.into(), duration };
        let at = |profile: Profile| -> Vec<[f64; 2]> {
            profile.pieces().iter().map(|ends| ends.each_ref().map(|end| end.at(&[4.0]))).collect()
        };
        assert_eq!(at(Profile::Quintic(ramp.clone())), [[2.0, 6.0]]);
        assert_eq!(at(Profile::Trapezoid { ramp, blend: 0.25 }), [[2.0, 3.0], [3.0, 5.0], [5.0, 6.0]]);
        let segments = clamped(&[-2.0, 0.0, 1.0], &[1.0, 2.5, 3.0]);
        assert_eq!(at(Profile::Table { from: 1.0, segments }), [[-2.0, 0.0], [0.0, 1.0]]);
        assert!(at(Profile::Hold(1.0.into())).is_empty());
    }
}
