//! Derivatives: of the states with respect to time, and of variables along a direction.

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

    /// Directional derivatives of variables with respect to coordinates, rates, states of forces and inputs, by central differences.
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
        /// The cube root of the machine epsilon balances truncation and rounding errors of central differences.
        const RELATIVE: f64 = 6e-6;
        if let Some(joint) = self.crane.loop_joints().first() {
            let is_state = |reference: &&u32| {
                self.variable(**reference)
                    .is_ok_and(|known| matches!(known.source, Source::Position(_) | Source::Rate(_)))
            };
            if let Some(&reference) = knowns.iter().find(is_state) {
                return Err(Fault::Error(format!(
                    "{} cannot change alone: loop joint {} ties it to others; ask for derivatives with respect to inputs",
                    self.variable(reference)?.name,
                    joint.name
                )));
            }
        }
        let scales = ForceStates::new(self.crane.description()).scales();
        let mut greatest = 0.0_f64;
        for (&reference, along) in knowns.iter().zip(direction) {
            if !along.is_finite() {
                let name = &self.variable(reference)?.name;
                return Err(Fault::Error(format!("the direction of {name} is {along}: choose a finite number")));
            }
            let scale = if let Source::Own(index) = self.variable(reference)?.source { scales[index] } else { 1.0 };
            greatest = greatest.max(along.abs() / scale);
        }
        if greatest == 0.0 {
            out.fill(0.0);
            return Ok(());
        }
        let moment = self.moment()?.clone();
        let h = RELATIVE / greatest;
        let mut aside = |side: f64, out: &mut [f64]| {
            let Moment { mut q, mut v, mut x, .. } = moment.clone();
            let mut inputs = self.inputs.clone();
            for (&reference, along) in knowns.iter().zip(direction) {
                let Variable { name, source, .. } = self.variable(reference)?;
                match *source {
                    Source::Position(index) => q[index] += side * along,
                    Source::Rate(index) => v[index] += side * along,
                    Source::Own(index) => x[index] += side * along,
                    Source::Input(index) if inputs[index].is_none() && self.crane.description().inputs[index].moves => {
                        return Err(Fault::Error(format!("{name} follows the motion of the spec: set it first")));
                    }
                    Source::Input(index) => inputs[index] = Some(self.input(index) + side * along),
                    _ => return Err(Fault::Error(format!("{name} is neither a state nor an input"))),
                }
            }
            give_inputs(self.crane.as_mut(), &inputs);
            (self.quantities, self.accelerations) = (None, None);
            self.moment = Some(Moment { t: moment.t, q, v, x });
            self.get(unknowns, out)
        };
        let mut behind = vec![0.0; out.len()];
        let found = aside(h, out).and_then(|()| aside(-h, &mut behind));
        out.iter_mut().zip(&behind).for_each(|(ahead, behind)| *ahead = (*ahead - behind) / (2.0 * h));
        give_inputs(self.crane.as_mut(), &self.inputs);
        self.moment = Some(moment);
        self.forget();
        found
    }
}
