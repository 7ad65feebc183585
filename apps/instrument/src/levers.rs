//! A crane whose drives are at given positions or follow levers, instead of the motions of its spec.
//!
//! The motion of every drive is replaced by one whose numbers are live parameters,
//! `q_dr(t) = x + r (t − b) + Δr ∫ s`, with s rising smoothly from 0 to 1 over a ramp T after b: position x and rate r at time b are those
//! that the drive has when its lever is moved, and Δr is the change of rate that the lever asks for. So the motion keeps its position and
//! its rate when a lever is moved, and with a lever at rest it needs no further change. A valve is opened as far as its lever is moved.

use crane_codegen::chain::{Chain, Drive, Parameter, ParameterId, Profile, Transmission, Value};
use crane_model::CoordinateKind;

/// Numbers of each drive among the live parameters, in this order.
pub const NUMBERS: usize = 6;

/// Position, rate, beginning, change of rate, its ramp, opening of the valve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// Position at the beginning, m or rad.
    pub position: f64,
    /// Rate at the beginning.
    pub rate: f64,
    /// Time of the beginning, s.
    pub begin: f64,
    /// Change of the rate.
    pub change: f64,
    /// Time over which the rate changes, s.
    pub ramp: f64,
    /// Opening of the valve, −1 to 1.
    pub opening: f64,
}

/// Ramp of a drive that holds its position, s: any above zero.
const IDLE: f64 = 1.0;

impl Numbers {
    /// Those of a drive that holds a position.
    pub fn holding(position: f64) -> Self {
        Self { position, rate: 0.0, begin: 0.0, change: 0.0, ramp: IDLE, opening: 0.0 }
    }

    /// In the order of the parameters.
    pub fn array(self) -> [f64; NUMBERS] {
        let Self { position, rate, begin, change, ramp, opening } = self;
        [position, rate, begin, change, ramp, opening]
    }

    /// Position and rate at a time: as the motion of the chain.
    pub fn at(&self, t: f64) -> [f64; 2] {
        let since = (t - self.begin).max(0.0);
        let tau = (since / self.ramp).min(1.0);
        let way = self.ramp * (tau * tau * tau * (1.0 - tau * 0.5)) + (since - self.ramp).max(0.0);
        let rise = tau * tau * (3.0 - tau * 2.0);
        [self.position + self.rate * since + self.change * way, self.rate + self.change * rise]
    }
}

/// What a lever does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It opens a valve.
    Valve,
    /// It sets the speed of a drive's motion.
    Speed,
}

/// What the lever of a drive does.
pub fn kind(drive: &Drive) -> Kind {
    if drive.oil().is_some() { Kind::Valve } else { Kind::Speed }
}

/// Speed of a drive's motion with its lever at the end: 0.2 rad/s or 0.25 m/s, at most the drive's own largest rate.
pub fn full_speed(kind: CoordinateKind, max_rate: Option<f64>) -> f64 {
    let usual = match kind {
        CoordinateKind::Rotation => 0.2,
        CoordinateKind::Translation => 0.25,
    };
    max_rate.map_or(usual, |most| usual.min(most))
}

/// The chain with levers; the numbers of its drives follow its own parameters. Valves with a servo hold their positions unless `driven`.
pub fn with_levers(chain: &Chain, driven: bool) -> Chain {
    let mut chain = chain.clone();
    for (index, drive) in chain.drives.iter_mut().enumerate() {
        let first = chain.parameters.len();
        let start =
            drive.profile.start(&chain.parameters.iter().map(|parameter| parameter.default).collect::<Vec<_>>());
        let names = ["position", "rate", "begin", "change", "ramp", "opening"];
        for (name, default) in names.iter().zip(Numbers::holding(start).array()) {
            chain.parameters.push(Parameter {
                // No name of a spec has a space.
                name: format!("drive {index} {name}"),
                unit: String::new(),
                about: String::new(),
                default,
                lower_bound: None,
            });
        }
        let number = |place: usize| Value::Parameter(ParameterId(first + place));
        let [from, rate, change] = [0, 1, 3].map(number);
        let begin = || number(2);
        drive.profile = Profile::Sum(Box::new([
            Profile::Speed { from, rate, begin: begin(), ramp: None },
            Profile::Speed { from: 0.0.into(), rate: change, begin: begin(), ramp: Some(number(4)) },
        ]));
        if let Transmission::Oil { opening, .. } = &mut drive.transmission
            && (driven || opening.is_some())
        {
            *opening = Some(Profile::Hold(number(5)));
        }
    }
    if driven {
        // A servo would close the valve that the lever opens.
        for valve in chain.cylinders.iter_mut().filter_map(|cylinder| cylinder.valve.as_mut()) {
            (valve.gain, valve.feed_forward) = (0.0, 0.0);
        }
    }
    chain
}
