//! Derivatives: of the states with respect to time, and of variables along a direction and back.

use std::mem;

use crane_live::sensitivity::runs::{Change, pull_rates, push_rates};
use crane_model::force_states::{self, ForceStates};

use super::{Fault, Instance, Moment, give_inputs};
use crate::variables::{Source, Variable};

impl Instance {
    /// Rates, accelerations and the rates of the forces' states.
    ///
    /// # Errors
    /// As [`Instance::get`]; the length of `out` is not the number of states; a derivative is not finite.
    pub fn derivatives(&mut self, out: &mut [f64]) -> Result<(), Fault> {
        self.check_states(out.len())?;
        let (rates, rest) = out.split_at_mut(self.crane.size());
        rates.copy_from_slice(&self.moment()?.v);
        let (accelerations, of_forces) = self.accelerations()?;
        rest.iter_mut().zip(accelerations.iter().chain(of_forces)).for_each(|(entry, value)| *entry = *value);
        let name = match rest.iter().position(|rate| !rate.is_finite()) {
            Some(index) if index < rates.len() => {
                format!("the acceleration of {}", self.crane.description().coordinates[index].name)
            }
            Some(index) => {
                format!("the rate of {}", force_states::columns(self.crane.description())[index - rates.len()])
            }
            None => return Ok(()),
        };
        Err(Fault::Discard(format!("{name} is not finite at t = {} s", self.time())))
    }

    /// Directional derivatives of variables with respect to coordinates, rates, states of forces and inputs: exact ones of states and their rates, others
    /// by central differences.
    ///
    /// # Errors
    /// As [`Instance::get`]; a variable of the direction is neither a state nor an input, or it is an input that follows
    /// the motion of its spec, or a coordinate or rate of a crane with closed loops.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        direction: &[f64],
        out: &mut [f64],
    ) -> Result<(), Fault> {
        let change = self.change_along(knowns, direction)?;
        let n = self.crane.size();
        let rates = if self.any_is_rate(unknowns)? { self.pushed(&change)? } else { None };
        let mut rest = Vec::new();
        for (place, (&reference, slot)) in unknowns.iter().zip(&mut *out).enumerate() {
            *slot = match (self.variable(reference)?.source, &rates) {
                (Source::Time | Source::Parameter(_) | Source::EventTime(_), _) => 0.0,
                (Source::Position(index), _) => change.motion[index],
                (Source::Rate(index), _) => change.motion[n + index],
                (Source::Own(index), _) => change.motion[2 * n + index],
                (Source::Input(index), _) => change.inputs[index],
                (Source::Acceleration(index), Some(rates)) => rates[n + index],
                (Source::OwnRate(index), Some(rates)) => rates[2 * n + index],
                (Source::Acceleration(_) | Source::OwnRate(_) | Source::Quantity(_) | Source::Indicator(_), _) => {
                    rest.push((place, reference));
                    0.0
                }
            };
        }
        let references: Vec<u32> = rest.iter().map(|(_, reference)| *reference).collect();
        let differences = self.differences(&references, &change)?;
        rest.iter().zip(differences).for_each(|((place, _), difference)| out[*place] = difference);
        Ok(())
    }

    /// Derivatives of a weighted sum of variables with respect to each of some coordinates, rates, states of forces and inputs: the transpose of
    /// [`directional_derivative`](Self::directional_derivative).
    ///
    /// # Errors
    /// As there; a weight is not finite.
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        weights: &[f64],
        out: &mut [f64],
    ) -> Result<(), Fault> {
        let n = self.crane.size();
        let columns = knowns.iter().map(|known| self.change_along(&[*known], &[1.0]));
        let columns: Vec<Change> = columns.collect::<Result<_, _>>()?;
        let states = self.states();
        let (mut of_rates, mut sum) = (vec![0.0; states], self.no_change());
        let (mut rates, mut rest) = (Vec::new(), Vec::new());
        for (&reference, &weight) in unknowns.iter().zip(weights) {
            let Variable { name, source, .. } = self.variable(reference)?;
            if !weight.is_finite() {
                return Err(Fault::Error(format!("the weight of {name} is {weight}: choose a finite number")));
            }
            match *source {
                Source::Time | Source::Parameter(_) | Source::EventTime(_) => {}
                Source::Position(index) => sum.motion[index] += weight,
                Source::Rate(index) => sum.motion[n + index] += weight,
                Source::Own(index) => sum.motion[2 * n + index] += weight,
                Source::Input(index) => sum.inputs[index] += weight,
                Source::Acceleration(index) => {
                    of_rates[n + index] += weight;
                    rates.push((reference, weight));
                }
                Source::OwnRate(index) => {
                    of_rates[2 * n + index] += weight;
                    rates.push((reference, weight));
                }
                Source::Quantity(_) | Source::Indicator(_) => rest.push((reference, weight)),
            }
        }
        if !rates.is_empty() {
            match self.pulled(&of_rates)? {
                Some(of_rates) => add(&mut sum, &of_rates),
                None => rest.extend(rates),
            }
        }
        let (references, weights): (Vec<u32>, Vec<f64>) = rest.into_iter().unzip();
        for (slot, column) in out.iter_mut().zip(&columns) {
            let differences = self.differences(&references, column)?;
            let of_rest: f64 = differences.iter().zip(&weights).map(|(difference, weight)| difference * weight).sum();
            *slot = product(&sum, column) + of_rest;
        }
        Ok(())
    }

    /// Whether any variable is an acceleration or the rate of a force's state.
    fn any_is_rate(&self, references: &[u32]) -> Result<bool, Fault> {
        let is_rate = |reference: &u32| {
            self.variable(*reference).map(|of| matches!(of.source, Source::Acceleration(_) | Source::OwnRate(_)))
        };
        references.iter().map(is_rate).try_fold(false, |any, is_rate| Ok(any | is_rate?))
    }

    /// The change of states and inputs along a direction.
    fn change_along(&mut self, knowns: &[u32], direction: &[f64]) -> Result<Change, Fault> {
        let mut change = self.no_change();
        let n = self.crane.size();
        for (&reference, along) in knowns.iter().zip(direction) {
            let Variable { name, source, .. } = self.variable(reference)?;
            if !along.is_finite() {
                return Err(Fault::Error(format!("the direction of {name} is {along}: choose a finite number")));
            }
            if let (Source::Position(_) | Source::Rate(_), Some(joint)) = (source, self.crane.loop_joints().first()) {
                return Err(Fault::Error(format!(
                    "{name} cannot change alone: {} ties it to others; ask for derivatives with respect to inputs{}",
                    joint.words(),
                    joint.remedy()
                )));
            }
            match *source {
                Source::Position(index) => change.motion[index] += along,
                Source::Rate(index) => change.motion[n + index] += along,
                Source::Own(index) => change.motion[2 * n + index] += along,
                Source::Input(index)
                    if self.inputs[index].is_none() && self.crane.description().inputs[index].default.is_none() =>
                {
                    return Err(Fault::Error(format!("{name} follows the motion of the spec: set it first")));
                }
                Source::Input(index) => change.inputs[index] += along,
                _ => return Err(Fault::Error(format!("{name} is neither a state nor an input"))),
            }
        }
        Ok(change)
    }

    fn no_change(&self) -> Change {
        Change { motion: vec![0.0; self.states()], inputs: vec![0.0; self.inputs.len()] }
    }

    /// Changes of all rates; `None` if one is not finite.
    fn pushed(&mut self, change: &Change) -> Result<Option<Vec<f64>>, Fault> {
        /// With more states and inputs, the Jacobian takes too much memory to be kept for a few columns.
        const MOST: usize = 1000;
        let Moment { t, q, v, x } = self.moment()?;
        let (t, motion) = (*t, [&q[..], v, x].concat());
        let is_large = motion.len() + self.inputs.len() > MOST;
        let known = match mem::replace(&mut self.jacobian, Jacobian::Asked) {
            found if is_large || matches!(found, Jacobian::Unknown) => {
                let along = push_rates(&self.live, (t, &motion), std::slice::from_ref(change));
                return Ok(along.ok().and_then(|mut along| along.pop()));
            }
            Jacobian::Asked => {
                let (states, inputs) = (motion.len(), self.inputs.len());
                let along = |number: usize| {
                    let mut change = self.no_change();
                    change.motion.iter_mut().chain(&mut change.inputs).skip(number).take(1).for_each(|own| *own = 1.0);
                    change
                };
                let along: Vec<Change> = (0..states + inputs).map(along).collect();
                push_rates(&self.live, (t, &motion), &along).ok()
            }
            Jacobian::Known(columns) => columns,
            Jacobian::Unknown => None,
        };
        let sum = known.as_ref().map(|columns| {
            let mut sum = vec![0.0; motion.len()];
            for (column, along) in
                columns.iter().zip(change.motion.iter().chain(&change.inputs)).filter(|(_, along)| **along != 0.0)
            {
                sum.iter_mut().zip(column).for_each(|(sum, slope)| *sum += slope * along);
            }
            sum
        });
        self.jacobian = Jacobian::Known(known);
        Ok(sum)
    }

    /// Derivatives of the weighted sum of all rates by the motion and by inputs; `None` if one is not finite, or if the crane is too large for them.
    fn pulled(&mut self, weights: &[f64]) -> Result<Option<Change>, Fault> {
        let Moment { t, q, v, x } = self.moment()?;
        let (t, motion) = (*t, [&q[..], v, x].concat());
        Ok(pull_rates(&self.live, (t, &motion), weights).ok().and_then(Result::ok))
    }

    /// Central differences of variables along a change.
    fn differences(&mut self, unknowns: &[u32], change: &Change) -> Result<Vec<f64>, Fault> {
        /// The cube root of the machine epsilon balances truncation and rounding errors of central differences.
        const RELATIVE: f64 = 6e-6;
        let mut ahead = vec![0.0; unknowns.len()];
        let (of_pose, of_states) = change.motion.split_at(2 * self.crane.size());
        let scales = ForceStates::new(self.crane.description()).scales();
        let of_states = of_states.iter().zip(&scales).map(|(along, scale)| along / scale);
        let all = of_pose.iter().chain(&change.inputs).copied().chain(of_states);
        let greatest = all.fold(0.0, |greatest: f64, along| greatest.max(along.abs()));
        if greatest == 0.0 || unknowns.is_empty() {
            return Ok(ahead);
        }
        let moment = self.moment()?.clone();
        let h = RELATIVE / greatest;
        let mut aside = |side: f64, out: &mut [f64]| {
            let Moment { mut q, mut v, mut x, .. } = moment.clone();
            let moved = q.iter_mut().chain(&mut v).chain(&mut x).zip(&change.motion);
            moved.for_each(|(number, along)| *number += side * along);
            let mut inputs = self.inputs.clone();
            for (index, along) in change.inputs.iter().enumerate().filter(|(_, along)| **along != 0.0) {
                inputs[index] = Some(self.input(index) + side * along);
            }
            give_inputs(self.crane.as_mut(), &inputs);
            (self.quantities, self.accelerations) = (None, None);
            self.moment = Some(Moment { t: moment.t, q, v, x });
            self.get(unknowns, out)
        };
        let mut behind = ahead.clone();
        let found = aside(h, &mut ahead).and_then(|()| aside(-h, &mut behind));
        ahead.iter_mut().zip(&behind).for_each(|(ahead, behind)| *ahead = (*ahead - behind) / (2.0 * h));
        give_inputs(self.crane.as_mut(), &self.inputs);
        self.moment = Some(moment);
        (self.quantities, self.accelerations) = (None, None);
        found.map(|()| ahead)
    }
}

/// Derivatives of the rates at the present moment: an importer that asks for a second direction will ask for all, which cost an eighth of single ones.
#[derive(Default)]
pub(super) enum Jacobian {
    #[default]
    Unknown,
    /// Those along one direction were asked for.
    Asked,
    /// Those by each state and each input; `None` if one is not finite.
    Known(Option<Vec<Vec<f64>>>),
}

fn add(sum: &mut Change, other: &Change) {
    let others = other.motion.iter().chain(&other.inputs);
    sum.motion.iter_mut().chain(&mut sum.inputs).zip(others).for_each(|(sum, other)| *sum += other);
}

/// The sum of all products.
fn product(one: &Change, other: &Change) -> f64 {
    let others = other.motion.iter().chain(&other.inputs);
    one.motion.iter().chain(&one.inputs).zip(others).map(|(one, other)| one * other).sum()
}
