//! A motion in real time: levers in, the state of the crane out.
//!
//! The method is the one-step implicit `rosw4`: a lever that is moved changes the motion of its drive, and a method with a history would
//! begin again each time. The page chooses the tolerance, by the time that the last pictures took.

use std::ops::ControlFlow;

use crane_live::{LiveCrane, Motion};
use crane_model::{
    dyn_crane::{DynCrane, Functions},
    dynamics::{InitialState, Method, Settings, without_events},
    force_states::ForceStates,
    results::{instants, quantities_at},
    statics,
};
use crane_page::Texts;
use serde_json::{Value, json};

use crate::{
    levers::{Kind, Numbers, full_speed, kind, with_levers},
    posed::{Outcome, check_positions, starts, still, with_numbers, with_parameters},
};

/// Time from rest to full speed, s.
const REACTION: f64 = 0.5;
/// Shortest time in which a drive changes its speed, s.
const LEAST_RAMP: f64 = 0.05;
/// Changes of a speed, m/s or rad/s, and openings below this are none.
const NOTHING: f64 = 1e-9;
/// Steps of one picture, after which the page is answered: the crane then falls behind real time instead of the page waiting.
const MOST_STEPS: usize = 400;

/// A crane that is driven.
pub struct Driving {
    crane: LiveCrane,
    /// The crane's own parameters.
    own: Vec<f64>,
    levers: Vec<f64>,
    numbers: Vec<Numbers>,
    motion: Option<Motion>,
    tolerance: f64,
    t: f64,
    state: InitialState,
    settings: Settings,
}

impl Driving {
    /// From rest, with the drives at positions, or where their motions begin; also what the page needs to draw the crane.
    pub fn begin(live: &LiveCrane, parameters: &[f64], positions: &[f64]) -> Outcome<(Self, Value)> {
        let mut crane = LiveCrane::new(with_levers(live.chain(), true));
        let starts =
            if positions.is_empty() { starts(&with_parameters(live, parameters)?) } else { positions.to_vec() };
        check_positions(live, &starts)?;
        let numbers: Vec<Numbers> = starts.iter().map(|start| Numbers::holding(*start)).collect();
        let all = with_numbers(live, parameters, numbers.iter().copied())?;
        crane.set_parameters(&all).map_err(|refused| refused.to_string())?;
        let rest = (&crane as &dyn DynCrane).equilibrium(&statics::Settings::default());
        if !rest.is_stable() {
            return Err(format!("it cannot be driven from here, where it does not rest: {rest}"));
        }
        let x = ForceStates::new(crane.description()).holding(&crane, 0.0, &rest.q);
        let state = InitialState { v: vec![0.0; rest.q.len()], q: rest.q.clone(), x };
        let page = still(&crane, &rest, Texts::default());
        let settings = Settings {
            method: Method::Rosenbrock,
            duration: f64::INFINITY,
            most_steps: usize::MAX,
            audit: false,
            ..Settings::from_description(crane.description())
        };
        let own = all[..live.parameters().len()].to_vec();
        let levers = vec![0.0; numbers.len()];
        let driving =
            Self { crane, own, levers, numbers, motion: None, tolerance: settings.tolerance, t: 0.0, state, settings };
        Ok((driving, page))
    }

    /// Drives on to a time, s, with the levers at positions from −1 to 1.
    pub fn advance(&mut self, to: f64, levers: &[f64], tolerance: f64) -> Outcome<Value> {
        if levers.len() != self.levers.len() || !to.is_finite() {
            return Err("one position for each lever, and a time".to_owned());
        }
        let (least, most) = Settings::TOLERANCES;
        let tolerance = tolerance.clamp(least, most);
        if self.pull(levers)? || tolerance != self.tolerance {
            self.motion = None;
        }
        self.tolerance = tolerance;
        let motion = match &mut self.motion {
            Some(motion) => motion,
            none => {
                let settings = Settings { tolerance, ..self.settings };
                // Levers begin new motions, and set parameters that an event may set, too.
                let begun = without_events(self.crane.description(), &settings, "driving")
                    .and_then(|()| Motion::new(self.crane.boxed_clone(), self.t, &self.state, &settings, None));
                none.insert(begun.map_err(|stopped| stopped.to_string())?)
            }
        };
        let mut steps = 0;
        let mut enough = |_: f64| {
            steps += 1;
            if steps < MOST_STEPS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        // Where the steps of a picture do not suffice, the time of the sample says how far they came.
        let _ = motion.advance(to.max(self.t), &mut enough).map_err(|stopped| stopped.to_string())?;
        let sample = motion.sample();
        self.t = sample.t;
        self.state = sample.state.into();
        let row = quantities_at(&self.crane, &sample);
        let lines = instants(&self.crane, std::iter::once(&row)).pop().map_or_else(Vec::new, |instant| instant.lines);
        // Where nothing stabilises there is no margin: null.
        let margins: Vec<Value> =
            lines.iter().map(|line| json!({"feet": line.feet, "margin": line.margin()})).collect();
        Ok(json!({"t": self.t, "row": row, "margins": margins, "steps": steps}))
    }

    /// Moves the levers; returns whether any of them moved.
    fn pull(&mut self, levers: &[f64]) -> Outcome<bool> {
        let description = self.crane.description();
        let mut moved = false;
        for (index, lever) in levers.iter().enumerate() {
            let lever = if lever.is_finite() { lever.clamp(-1.0, 1.0) } else { 0.0 };
            if (lever - self.levers[index]).abs() < NOTHING {
                continue;
            }
            self.levers[index] = lever;
            moved = true;
            let drive = &self.crane.chain().drives[index];
            let info = &description.drives[index];
            self.numbers[index] = match kind(drive) {
                Kind::Valve => Numbers { opening: lever, ..self.numbers[index] },
                Kind::Speed => {
                    let full = full_speed(description.coordinates[info.coordinate].kind, info.max_rate);
                    let [position, rate] = self.numbers[index].at(self.t);
                    let change = lever * full - rate;
                    let ramp = (change.abs() / full * REACTION).max(LEAST_RAMP);
                    let [rate, change] = [rate, change].map(|speed| if speed.abs() < NOTHING { 0.0 } else { speed });
                    Numbers { position, rate, begin: self.t, change, ramp, opening: 0.0 }
                }
            };
        }
        if moved {
            let numbers = self.numbers.iter().flat_map(|numbers| numbers.array());
            let all: Vec<f64> = self.own.iter().copied().chain(numbers).collect();
            self.crane.set_parameters(&all).map_err(|refused| refused.to_string())?;
        }
        Ok(moved)
    }
}
