//! Functions of a crane with their slopes in the directions of a run.

use std::borrow::Cow;

use crane_codegen::chain::Input;
use crane_codegen::program::{Argument, FunctionId};
use crane_model::dyn_crane::{Arguments, DynCrane, Functions};
use crane_model::dynamics::gradients::{Around, CylinderSlopes, FeetSlopes, MotionAt, Numbers, Slopes};
use crane_model::{Description, EventInfo, ParameterError};

use super::Along;
use crate::Evaluation;
use crate::LiveCrane;
use crate::bytecode::{Code, Fixed};
use crate::dual::{DIRECTIONS, Dual8};
use crate::machine::Number;

/// Relative step of a parameter or an input for what is differenced, and its step from zero.
const STEP: f64 = 1e-6;

/// The change of a number for which errors count, relative to it; of starts in m, rad, m/s and rad/s.
const CHANGE: f64 = 0.1;

/// How many sums of directions are followed in adjoint mode.
const PROBES: usize = 4;

/// A crane with a number slightly smaller and larger.
struct Beside {
    cranes: [Option<LiveCrane>; 2],
    step: f64,
}

/// Eight directions or fewer.
pub(super) struct Chunk {
    /// How many.
    pub count: usize,
    /// Whether a parameter or an input changes in any of them.
    changes: bool,
    /// The parameters and inputs with their slopes.
    pub parameters: Vec<Dual8>,
    pub inputs: Vec<Dual8>,
    residual: Evaluation<Dual8>,
    motions: Evaluation<Dual8>,
    /// φ, φ̇ and J̇ v of loop joints, and J, if there are any.
    loops: Option<[Evaluation<Dual8>; 2]>,
    /// Of cylinders with a valve, if there are any.
    oil: Option<Oil>,
    /// Numbers of feet, if there are any.
    feet: Option<[Evaluation<Dual8>; 5]>,
}

/// What cylinders with a valve depend on.
struct Oil {
    /// ℓ, ℓ̇ and `∂ℓ/∂q_j` of every cylinder; ∂ℓ/∂q; commands of valves.
    states: Evaluation<Dual8>,
    jacobians: Evaluation<Dual8>,
    openings: Evaluation<Dual8>,
    /// Drive and coordinate of every cylinder with a valve.
    driven: Vec<(usize, usize)>,
    /// Drive of every cylinder.
    drives: Vec<usize>,
    /// Whether a parameter or an input changes, on which what servos want may depend.
    wants_more: bool,
}

/// The directions of a run.
pub(super) struct Directions<'a> {
    crane: Cow<'a, LiveCrane>,
    chunks: Vec<Chunk>,
    beside: Vec<Option<Beside>>,
    /// The changes of the numbers for which errors count.
    scales: Vec<f64>,
    /// Whether any of them is that of a parameter or an input, and the motions of drives depend on any.
    may_move_drives: bool,
}

impl<'a> Directions<'a> {
    /// For some numbers of a crane.
    pub fn new(crane: &'a LiveCrane, along: &[Along]) -> Self {
        let beside = |along: &Along| match along {
            Along::Parameter(index) => {
                let step = step_of(crane.parameters()[*index]);
                Some(Beside { cranes: beside(crane, *index), step })
            }
            Along::Input(index) => {
                let value = crane.input(*index).unwrap_or_default();
                let step = step_of(value);
                let with = |value: f64| {
                    let mut other = crane.clone();
                    other.set_input(*index, Some(value));
                    Some(other)
                };
                Some(Beside { cranes: [with(value - step), with(value + step)], step })
            }
            Along::Position(_) | Along::Rate(_) => None,
        };
        let scale = |along: &Along| {
            let value = match along {
                Along::Parameter(index) => crane.parameters()[*index],
                Along::Input(index) => crane.input(*index).unwrap_or_default(),
                Along::Position(_) | Along::Rate(_) => 1.0,
            };
            if value == 0.0 { 1.0 } else { CHANGE * value.abs() }
        };
        Self {
            crane: Cow::Borrowed(crane),
            chunks: along.chunks(DIRECTIONS).map(|along| Chunk::new(crane, along)).collect(),
            beside: along.iter().map(beside).collect(),
            scales: along.iter().map(scale).collect(),
            may_move_drives: is_any_live(along) && is_live(crane, FunctionId::DriveMotions),
        }
    }

    /// For directions in each of which all inputs change.
    pub fn with_inputs(crane: &'a LiveCrane, changes: &[&[f64]]) -> Self {
        let any = changes.iter().any(|changes| changes.iter().any(|change| *change != 0.0));
        let chunk = |changes: &[&[f64]]| {
            Chunk::along(crane, changes.len(), any, &|own| match own {
                Along::Input(index) => std::array::from_fn(|k| changes.get(k).map_or(0.0, |changes| changes[index])),
                _ => [0.0; DIRECTIONS],
            })
        };
        Self {
            crane: Cow::Borrowed(crane),
            chunks: changes.chunks(DIRECTIONS).map(chunk).collect(),
            beside: changes.iter().map(|_| None).collect(),
            scales: vec![1.0; changes.len()],
            may_move_drives: any && is_live(crane, FunctionId::DriveMotions),
        }
    }

    /// A few directions, each a sum of changes for which errors count, with either sign, of many of these numbers; and the derivatives of the start along
    /// them, from those in these directions.
    pub fn probes(&self, along: &[Along], of_start: &[Vec<f64>]) -> (Self, Vec<Vec<f64>>) {
        // Bits of multiples of the golden ratio, in place of random signs.
        let sign = |number: usize| if (0.618_033_988_75 * number as f64).fract() < 0.5 { 1.0 } else { -1.0 };
        let share = |number: usize| (number % PROBES, sign(number) * self.scales[number]);
        let mut starts = vec![vec![0.0; of_start.first().map_or(0, Vec::len)]; PROBES];
        for (number, own) in of_start.iter().enumerate() {
            let (probe, share) = share(number);
            starts[probe].iter_mut().zip(own).for_each(|(sum, slope)| *sum += share * slope);
        }
        let slopes = |own: Along| {
            let mut slopes = [0.0; DIRECTIONS];
            if let Some(number) = along.iter().position(|along| *along == own) {
                let (probe, share) = share(number);
                slopes[probe] = share;
            }
            slopes
        };
        let chunk = Chunk::along(&self.crane, PROBES, is_any_live(along), &slopes);
        let beside = (0..PROBES).map(|_| None).collect();
        let (crane, may_move_drives) = (self.crane.clone(), self.may_move_drives);
        (Self { crane, chunks: vec![chunk], beside, scales: vec![1.0; PROBES], may_move_drives }, starts)
    }

    /// The same directions after an event: the parameters that it sets are the same in all of them.
    ///
    /// # Errors
    /// They break a rule of the spec language.
    pub fn after(&self, event: &EventInfo) -> Result<Directions<'static>, ParameterError> {
        let with = |crane: &LiveCrane| {
            let (mut other, mut values) = (crane.clone(), crane.parameters().to_vec());
            event.changes.iter().for_each(|(index, value)| values[*index] = *value);
            other.set_parameters(&values).map(|()| other)
        };
        let crane = with(&self.crane)?;
        let chunk = |Chunk { count, changes, parameters, inputs, .. }: &Chunk| {
            let mut parameters = parameters.clone();
            event.changes.iter().for_each(|(index, value)| parameters[*index] = Dual8::splat(*value));
            Chunk::with_numbers(&crane, *count, *changes, (parameters, inputs.clone()))
        };
        let beside = |Beside { cranes, step }: &Beside| Beside {
            cranes: cranes.each_ref().map(|crane| crane.as_ref().and_then(|crane| with(crane).ok())),
            step: *step,
        };
        Ok(Directions {
            chunks: self.chunks.iter().map(chunk).collect(),
            beside: self.beside.iter().map(|own| own.as_ref().map(beside)).collect(),
            scales: self.scales.clone(),
            may_move_drives: self.may_move_drives,
            crane: Cow::Owned(crane),
        })
    }

    /// The crane.
    pub fn crane(&self) -> &LiveCrane {
        &self.crane
    }

    /// Whether motions of drives may change.
    pub fn may_move_drives(&self) -> bool {
        self.may_move_drives
    }

    /// Whether what servos want may change.
    pub fn may_change_servos(&self) -> bool {
        self.chunks.iter().filter_map(|chunk| chunk.oil.as_ref()).any(|oil| oil.wants_more)
    }

    /// The directions, eight by eight.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }
}

/// Cranes with a parameter slightly smaller and slightly larger, where the spec allows it.
pub(super) fn beside(crane: &LiveCrane, parameter: usize) -> [Option<LiveCrane>; 2] {
    let value = crane.parameters()[parameter];
    [-1.0, 1.0].map(|sign| {
        let mut other = crane.clone();
        other.set_parameter(parameter, value + sign * step_of(value)).is_ok().then_some(other)
    })
}

fn step_of(value: f64) -> f64 {
    if value == 0.0 { STEP } else { STEP * value.abs() }
}

impl Chunk {
    /// Of eight numbers or fewer.
    fn new(crane: &LiveCrane, along: &[Along]) -> Self {
        Self::along(crane, along.len(), is_any_live(along), &|own| {
            std::array::from_fn(|k| if along.get(k) == Some(&own) { 1.0 } else { 0.0 })
        })
    }

    /// Of `count` directions, in which numbers have these slopes; whether any of them is a parameter or an input.
    fn along(crane: &LiveCrane, count: usize, changes: bool, slopes: &dyn Fn(Along) -> [f64; DIRECTIONS]) -> Self {
        let parameters = crane.parameters().iter().enumerate();
        let parameters: Vec<Dual8> =
            parameters.map(|(index, value)| Dual8::new(*value, slopes(Along::Parameter(index)))).collect();
        let inputs = crane.inputs().numbers().enumerate().map(|(slot, value)| {
            // The first number of an input is its value; the second says whether it is set.
            if slot % Input::SLOTS == 0 {
                Dual8::new(value, slopes(Along::Input(slot / Input::SLOTS)))
            } else {
                Dual8::splat(value)
            }
        });
        Self::with_numbers(crane, count, changes, (parameters, inputs.collect()))
    }

    /// Of numbers that have slopes.
    fn with_numbers(
        crane: &LiveCrane,
        count: usize,
        changes: bool,
        (parameters, inputs): (Vec<Dual8>, Vec<Dual8>),
    ) -> Self {
        let evaluation = |id: FunctionId| {
            let mut evaluation = Evaluation::new(crane, id);
            evaluation.set_parameters(&parameters);
            evaluation.set_inputs(inputs.iter().copied());
            evaluation
        };
        let has_loops = !crane.loop_joints().is_empty();
        let loops = has_loops.then(|| [FunctionId::LoopStates, FunctionId::LoopJacobians].map(evaluation));
        let Description { cylinders, drives, .. } = crane.description();
        let with_valves = cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
        let driven: Vec<(usize, usize)> =
            with_valves.map(|cylinder| (cylinder.drive, drives[cylinder.drive].coordinate)).collect();
        let oil = (!driven.is_empty()).then(|| Oil {
            states: evaluation(FunctionId::CylinderStates),
            jacobians: evaluation(FunctionId::CylinderJacobians),
            openings: evaluation(FunctionId::ValveOpenings),
            driven,
            drives: cylinders.iter().map(|cylinder| cylinder.drive).collect(),
            wants_more: changes
                && [FunctionId::DriveMotions, FunctionId::CylinderStates, FunctionId::ValveOpenings]
                    .into_iter()
                    .any(|id| is_live(crane, id)),
        });
        Self {
            count,
            changes,
            oil,
            feet: crane.description().has_feet().then(|| FEET.map(evaluation)),
            residual: evaluation(FunctionId::DynamicResidual),
            motions: evaluation(FunctionId::DriveMotions),
            loops,
            parameters,
            inputs,
        }
    }

    /// J with its slopes.
    fn jacobian(&mut self, q: &[Dual8]) -> Vec<Dual8> {
        let Some([_, jacobians]) = &mut self.loops else { return Vec::new() };
        jacobians.results_at(&Arguments { q, ..Arguments::none() }).to_vec()
    }
}

/// The functions with the numbers of feet.
pub(super) const FEET: [FunctionId; 5] = [
    FunctionId::SupportElongations,
    FunctionId::SupportJacobians,
    FunctionId::SupportStiffnesses,
    FunctionId::SupportDampings,
    FunctionId::SupportGrips,
];

/// Numbers of feet in the order of these functions.
fn in_order(slopes: &mut FeetSlopes) -> [&mut Vec<f64>; 5] {
    let FeetSlopes { elongations, jacobians, stiffnesses, dampings, grips } = slopes;
    [elongations, jacobians, stiffnesses, dampings, grips]
}

/// Whether a function of a crane depends on live parameters or inputs.
fn is_live(crane: &LiveCrane, id: FunctionId) -> bool {
    let library = crane.library();
    library.routine(id).is_some_and(|routine| {
        let Code { fixed, inputs, .. } = routine.code();
        fixed.iter().any(|number| !matches!(number, Fixed::Number(_)))
            || inputs.iter().any(|inputs| inputs.argument == Argument::Inputs)
    })
}

/// Whether any number is a parameter or an input.
fn is_any_live(along: &[Along]) -> bool {
    along.iter().any(|along| matches!(along, Along::Parameter(_) | Along::Input(_)))
}

fn constants(numbers: &[f64]) -> Vec<Dual8> {
    numbers.iter().map(|number| Dual8::splat(*number)).collect()
}

/// Numbers of a motion, from an index on, with the slopes of some directions.
fn moved(numbers: &[f64], first: usize, along: &[Vec<f64>]) -> Vec<Dual8> {
    let slope = |i: usize| std::array::from_fn(|k| along.get(k).map_or(0.0, |along| along[first + i]));
    numbers.iter().enumerate().map(|(i, number)| Dual8::new(*number, slope(i))).collect()
}

impl Numbers for Directions<'_> {
    fn count(&self) -> usize {
        self.beside.len()
    }

    fn around(&self, direction: usize) -> Option<Around<'_>> {
        let Beside { cranes, step } = self.beside[direction].as_ref()?;
        let or_own = |crane: &'_ Option<LiveCrane>| crane.as_ref().map_or(0.0, |_| *step);
        let [less, more] = cranes.each_ref().map(|crane| crane.as_ref().unwrap_or(&self.crane) as &dyn DynCrane);
        Some(Around { cranes: [less, more], steps: cranes.each_ref().map(or_own) })
    }

    fn stops(&mut self) -> Vec<(f64, Vec<f64>)> {
        let mut all: Vec<(f64, Vec<f64>)> = Vec::new();
        for (number, chunk) in self.chunks.iter().enumerate() {
            let mut index = 0;
            for id in [FunctionId::DrivePieces, FunctionId::LoadPieces, FunctionId::WinchPieces] {
                let mut evaluation = Evaluation::<Dual8>::new(&self.crane, id);
                evaluation.set_parameters(&chunk.parameters);
                evaluation.set_inputs(chunk.inputs.iter().copied());
                for time in evaluation.results_at(&Arguments::none()) {
                    if number == 0 {
                        all.push((time.value(), Vec::new()));
                    }
                    all[index].1.extend((0..chunk.count).map(|direction| time.slope(direction)));
                    index += 1;
                }
            }
        }
        all
    }
}

impl Slopes for Directions<'_> {
    fn after(&self, event: &EventInfo) -> Result<Box<dyn Slopes>, ParameterError> {
        Ok(Box::new(self.after(event)?))
    }

    fn scale(&self, direction: usize) -> f64 {
        self.scales[direction]
    }

    fn residuals(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<f64>]) {
        let n = at.q.len();
        for (number, chunk) in self.chunks.iter_mut().enumerate() {
            let first = number * DIRECTIONS;
            let along = &along[first..][..chunk.count];
            let (q, v, a) = (moved(at.q, 0, along), moved(at.v, n, along), constants(at.a));
            let rows = chunk.jacobian(&q);
            let residual = chunk.residual.results_at(&Arguments {
                t: Dual8::splat(at.t),
                q: &q,
                v: &v,
                a: &a,
                ..Arguments::none()
            });
            for (direction, out) in out[first..].iter_mut().take(chunk.count).enumerate() {
                for (out, number) in out.iter_mut().zip(residual) {
                    *out = number.slope(direction);
                }
                for (multiplier, row) in at.multipliers.iter().zip(rows.chunks_exact(n.max(1))) {
                    out.iter_mut().zip(row).for_each(|(out, entry)| *out += multiplier * entry.slope(direction));
                }
            }
        }
    }

    fn loops(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<[f64; 3]>]) {
        let n = at.q.len();
        for (number, chunk) in self.chunks.iter_mut().enumerate() {
            let first = number * DIRECTIONS;
            let along = &along[first..][..chunk.count];
            let (q, v) = (moved(at.q, 0, along), moved(at.v, n, along));
            let rows = chunk.jacobian(&q);
            let Some([states, _]) = &mut chunk.loops else { continue };
            let states = states.results_at(&Arguments { t: Dual8::splat(at.t), q: &q, v: &v, ..Arguments::none() });
            for (direction, out) in out[first..].iter_mut().take(chunk.count).enumerate() {
                let equations = states.chunks_exact(3).zip(rows.chunks_exact(n.max(1)));
                for (out, (state, row)) in out.iter_mut().zip(equations) {
                    let by_row: f64 = row.iter().zip(at.a).map(|(entry, a)| entry.slope(direction) * a).sum();
                    let [gap, rate, second] = [0, 1, 2].map(|k| state[k].slope(direction));
                    *out = [gap, rate, second + by_row];
                }
            }
        }
    }

    fn cylinders(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<CylinderSlopes>]) {
        let n = at.q.len();
        for (number, Chunk { count, motions, oil, .. }) in self.chunks.iter_mut().enumerate() {
            let Some(oil) = oil else { continue };
            let first = number * DIRECTIONS;
            let (along, out) = (&along[first..][..*count], &mut out[first..][..*count]);
            let (t, zeros) = (Dual8::splat(at.t), constants(&vec![0.0; n]));
            let (q, v) = (moved(at.q, 0, along), moved(at.v, n, along));
            let pair = |states: &[Dual8], direction: usize| [0, 1].map(|k| states[k].slope(direction));
            let (states, jacobians) = (
                oil.states.results_at(&Arguments { t, q: &q, v: &v, ..Arguments::none() }),
                oil.jacobians.results_at(&Arguments { t, q: &q, ..Arguments::none() }),
            );
            for (direction, out) in out.iter_mut().enumerate() {
                let own = states.chunks_exact(3).zip(jacobians.chunks_exact(n.max(1)));
                for (out, (states, row)) in out.iter_mut().zip(own) {
                    out.length_and_rate = pair(states, direction);
                    out.jacobian.iter_mut().zip(row).for_each(|(out, entry)| *out = entry.slope(direction));
                }
            }
            if !oil.wants_more {
                continue;
            }
            let motions = motions.results_at(&Arguments { t, ..Arguments::none() });
            let [mut wanted_q, mut wanted_v] = [zeros.clone(), zeros.clone()];
            for (drive, coordinate) in &oil.driven {
                (wanted_q[*coordinate], wanted_v[*coordinate]) = (motions[2 * drive], motions[2 * drive + 1]);
            }
            let openings = oil.openings.results_at(&Arguments { t, ..Arguments::none() });
            let wanted = oil.states.results_at(&Arguments { t, q: &wanted_q, v: &wanted_v, ..Arguments::none() });
            for (direction, out) in out.iter_mut().enumerate() {
                for (out, (states, drive)) in out.iter_mut().zip(wanted.chunks_exact(3).zip(&oil.drives)) {
                    out.wanted = pair(states, direction);
                    out.opening = openings[2 * drive].slope(direction);
                }
            }
        }
    }

    fn feet(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [FeetSlopes]) {
        let n = at.q.len();
        for (number, Chunk { count, feet, .. }) in self.chunks.iter_mut().enumerate() {
            let Some(feet) = feet else { continue };
            let first = number * DIRECTIONS;
            let along = &along[first..][..*count];
            let (q, v) = (moved(at.q, 0, along), moved(at.v, n, along));
            for (index, function) in feet.iter_mut().enumerate() {
                let numbers =
                    function.results_at(&Arguments { t: Dual8::splat(at.t), q: &q, v: &v, ..Arguments::none() });
                for (direction, out) in out[first..].iter_mut().take(*count).enumerate() {
                    let slopes = in_order(out)[index].iter_mut().zip(numbers);
                    slopes.for_each(|(slope, number)| *slope = number.slope(direction));
                }
            }
        }
    }

    fn drive_motions(&mut self, t: f64, out: &mut [Vec<[f64; 2]>]) -> bool {
        let mut any = false;
        if !self.may_move_drives {
            return any;
        }
        for (number, chunk) in self.chunks.iter_mut().enumerate() {
            let motions = chunk.motions.results_at(&Arguments { t: Dual8::splat(t), ..Arguments::none() });
            for (direction, out) in out[number * DIRECTIONS..].iter_mut().take(chunk.count).enumerate() {
                for (out, pair) in out.iter_mut().zip(motions.chunks_exact(2)) {
                    *out = [pair[0].slope(direction), pair[1].slope(direction)];
                    any |= *out != [0.0; 2];
                }
            }
        }
        any
    }
}
