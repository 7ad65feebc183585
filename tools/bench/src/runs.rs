//! A run, for comparison with runs of other libraries: the crane is let go at its guess, with its load pulled aside, while its drives hold.

use std::ops::ControlFlow;
use std::time::Instant;

use crane_model::dynamics::{InitialState, Method, Sample, Settings, Simulation, Watch};
use crane_model::{CoordinateKind, CoordinateRole, CraneModel};

use crate::states::guess;

/// Before any drive moves, s.
const BEGIN: f64 = -3.0;
/// How far passive joints are turned at the start, rad.
const ASIDE: f64 = 0.3;

/// The start and the times of a run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Coordinates at the start, m and rad; everything is at rest.
    pub start: Vec<f64>,
    /// Duration, s.
    pub duration: f64,
    /// Interval between results, s.
    pub output: f64,
}

/// What is run.
#[must_use]
pub fn plan<const N: usize>(model: &impl CraneModel<N>) -> Plan {
    let crane = model.description();
    let is_passive = |index: usize| {
        let coordinate = &crane.coordinates[index];
        coordinate.role == CoordinateRole::Passive && coordinate.kind == CoordinateKind::Rotation
    };
    let of = |(index, guess): (usize, &f64)| if is_passive(index) { guess + ASIDE } else { *guess };
    Plan { start: guess(model).iter().enumerate().map(of).collect(), duration: 2.0, output: 0.05 }
}

/// The shortest time of some runs by a method, s, and the coordinates at every result. `accuracy`: the step of a method with constant steps, s, or the
/// tolerance.
///
/// # Errors
/// The run stopped.
pub fn run<const N: usize, C: CraneModel<N> + Default>(
    method: Method,
    accuracy: f64,
    repeat: usize,
) -> Result<Vec<f64>, String> {
    let crane = C::default();
    let Plan { start, duration, output } = plan(&crane);
    let settings = Settings {
        duration,
        output,
        method,
        step: accuracy,
        tolerance: accuracy,
        ..Settings::from_description(crane.description())
    };
    let start = InitialState { q: start, v: vec![0.0; N], ..InitialState::default() };
    let (mut shortest, mut poses) = (f64::INFINITY, Poses(Vec::new()));
    for _ in 0..repeat {
        poses.0.clear();
        let begin = Instant::now();
        Simulation::new(&crane, &start, &settings)
            .at_time(BEGIN)
            .watch(&mut poses)
            .map_err(|stopped| stopped.to_string())?;
        shortest = shortest.min(begin.elapsed().as_secs_f64());
    }
    Ok([vec![shortest], poses.0].concat())
}

struct Poses(Vec<f64>);

impl Watch for Poses {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.0.extend_from_slice(sample.q);
        ControlFlow::Continue(())
    }
}
