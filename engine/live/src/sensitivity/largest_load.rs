//! The largest load of a pose, and what moves it.
//!
//! The largest load L of a pose is that at which a limit is reached, g(L, p) = 0: a utilisation, a tipping margin, a pressure, a length, an effort,
//! a reaction or a tension less its bound. It moves with a number p by
//!
//! ```text
//! dL/dp = − (∂g/∂p) / (∂g/∂L)
//! ```
//!
//! along the poses at rest, as long as this limit governs. Where none of the outputs is at its bound, because the crane no longer rests, a stop is
//! touched or a point has moved far, derivatives are differences of largest loads.

use std::sync::{Mutex, PoisonError};

use crane_model::ColumnKind;
use crane_model::dyn_crane::Functions;
use crane_model::envelope::{Condition, Envelope, Execution, Limit, Rating, UNITS_OF_LOADS};
use crane_model::results::{
    KeyFigure, column_name, connector_force, drive_effort, friction_utilisation, vertical_reaction,
};

use super::whole::{CURVED, in_unit};
use super::{Changing, Differences, FixedNumber, Group, Output, Sensitivity};
use crate::LiveCrane;

/// Name of the output.
const NAME: &str = "largest_load";
/// Longer step of differences of largest loads, relative to the number: loads are exact to 1e-6.
const STEP: f64 = 2e-2;
/// A difference from the change of the derivative matters if it is this fraction of the load.
const MATTERS: f64 = 5e-3;
/// A correction of the load by more than this fraction is not one from the accuracy of a chart to rounding.
const SMALL: f64 = 1e-4;

/// The largest load of a crane in a pose, and what limits it.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestLoad {
    /// The load, in the unit of its parameter, without the factor of the chart.
    pub load: f64,
    /// What governs.
    pub limit: Limit,
    /// The crane at rest with the load and the factor.
    pub condition: Condition,
}

/// Why a pose has no largest load.
#[derive(Clone, Debug, PartialEq)]
pub enum NoLargestLoad {
    /// The smallest load is beyond a limit already.
    Beyond(Limit),
    /// No limit is reached up to this load.
    Unlimited(f64),
    /// The parameters cannot have the values of the smallest load.
    Refused(String),
}

impl NoLargestLoad {
    /// Why there is none, in words; `unit`: that of the load.
    #[must_use]
    pub fn words(&self, crane: &LiveCrane, unit: &str) -> String {
        match self {
            Self::Beyond(limit) => {
                format!("the smallest load is beyond a limit already: {}", words(*limit, crane))
            }
            Self::Unlimited(load) => format!("no limit is reached up to {}", in_unit(*load, unit)),
            Self::Refused(why) => why.clone(),
        }
    }
}

/// A limit in words.
fn words(limit: Limit, crane: &LiveCrane) -> String {
    let of = limit.location(crane);
    if of.is_empty() { limit.kind().to_owned() } else { format!("{}, {of}", limit.kind()) }
}

impl LargestLoad {
    /// The largest load of a crane whose drives are where they begin.
    ///
    /// # Errors
    /// There is none.
    pub fn new(crane: &LiveCrane, envelope: &Envelope) -> Result<Self, NoLargestLoad> {
        let found: Mutex<Option<Rating>> = Mutex::new(None);
        let done = |_: usize, ratings: &[Rating]| {
            *found.lock().unwrap_or_else(PoisonError::into_inner) = ratings.first().cloned();
        };
        let execution = Execution { threads: 1, done: &done, cancelled: &|| false };
        envelope.run(crane, &[0], &execution).map_err(|refused| NoLargestLoad::Refused(refused.to_string()))?;
        let rating = found.into_inner().unwrap_or_else(PoisonError::into_inner);
        match rating {
            Some(Rating { load: Some(load), governing: Some(limit), loaded: Some(condition), .. }) => {
                Ok(Self { load, limit, condition })
            }
            Some(Rating { load: Some(load), .. }) => Err(NoLargestLoad::Unlimited(load)),
            rating => {
                Err(NoLargestLoad::Beyond(rating.and_then(|rating| rating.governing).unwrap_or(Limit::Equilibrium)))
            }
        }
    }

    /// The limit in words.
    #[must_use]
    pub fn words(&self, crane: &LiveCrane) -> String {
        words(self.limit, crane)
    }

    /// Adds the load to the outputs of the crane that carries it. `index`: of the list of derivatives by the load, which is removed; `fixed`: the
    /// numbers of the lists after it.
    ///
    /// `None` where no output is at its bound, so that the load has no exact derivatives; nothing is changed then except that list.
    pub fn add_to(
        &self,
        sensitivity: &mut Sensitivity,
        crane: &LiveCrane,
        envelope: &Envelope,
        index: usize,
        fixed: &[FixedNumber],
    ) -> Option<()> {
        let bound = self.bounded(sensitivity, crane);
        let by_load = sensitivity.derivatives.remove(index);
        sensitivity.pose.remove(index);
        sensitivity.parameters.remove(index);
        let Bounded { output, sign } = bound?;
        let limit_of =
            |crane: &LiveCrane| envelope.limits.with_max_efforts(crane).bound(self.limit, crane.description());
        let limit = limit_of(crane)?;
        let slope = sign * by_load[output] * envelope.factor;
        let correction = -(sign * sensitivity.values[output] - limit) / slope;
        if !slope.is_finite() || slope == 0.0 || correction.abs() > SMALL * self.load.abs() {
            return None;
        }
        let numbers: Vec<Changing<'_>> = changing(sensitivity, fixed).collect();
        for (number, derivatives) in numbers.into_iter().zip(&mut sensitivity.derivatives) {
            let own = -(sign * derivatives[output] - number.slope(crane, limit_of)) / slope;
            derivatives.push(own);
        }
        sensitivity.values.push(self.load + correction);
        sensitivity.outputs.push(self.output(crane, envelope));
        Some(())
    }

    /// Adds the load with derivatives that are differences of largest loads, and returns the estimates of their errors.
    ///
    /// # Errors
    /// With a number slightly smaller or larger there is no largest load.
    pub fn add_differences(
        &self,
        sensitivity: &mut Sensitivity,
        crane: &LiveCrane,
        envelope: &Envelope,
        fixed: &[FixedNumber],
    ) -> Result<Vec<f64>, NoLargestLoad> {
        let mut errors = Vec::new();
        let numbers: Vec<Changing<'_>> = changing(sensitivity, fixed).collect();
        for (number, all) in numbers.into_iter().zip(&mut sensitivity.derivatives) {
            let value = number.value(crane);
            let step = STEP * if value == 0.0 { 1.0 } else { value.abs() };
            let at = |share: f64| {
                let other = number.change(crane, share * step).map_err(NoLargestLoad::Refused)?;
                Ok(Self::new(&other, envelope)?.load)
            };
            let Differences { derivatives, errors: own, .. } =
                Differences::central([at(-1.0)?, at(-0.5)?, at(0.5)?, at(1.0)?].map(|load| vec![load]), step);
            all.push(derivatives[0]);
            errors.push(own[0]);
        }
        sensitivity.values.push(self.load);
        sensitivity.outputs.push(self.output(crane, envelope));
        Ok(errors)
    }

    /// What happens to the load when each number changes by its whole step, one after the other, that its derivatives do not say. `crane`: with
    /// its own load; `sensitivity`: with the output.
    #[must_use]
    pub fn cautions(
        &self,
        sensitivity: &Sensitivity,
        crane: &LiveCrane,
        envelope: &Envelope,
        fixed: &[FixedNumber],
        steps: &[f64],
    ) -> Vec<String> {
        let mut words = Vec::new();
        let Some(output) = sensitivity.index_of(NAME) else { return words };
        let unit = sensitivity.outputs[output].unit;
        for ((index, number), step) in changing(sensitivity, fixed).enumerate().zip(steps) {
            let [name, of_number] = number.label(crane);
            let with = format!("with {name} at {}", in_unit(number.value(crane) + step, of_number));
            let Ok(other) = number.change(crane, *step) else {
                words.push(format!("{with} it breaks a rule of the spec"));
                continue;
            };
            let straight = sensitivity.derivatives[index][output] * step;
            match Self::new(&other, envelope) {
                Err(none) => words.push(format!("{with}, {}", none.words(&other, unit))),
                Ok(then) if then.limit != self.limit => words.push(format!(
                    "{with}, the largest load is {}, limited by {}: it changes by {} instead of {}",
                    in_unit(then.load, unit),
                    then.words(&other),
                    in_unit(then.load - self.load, unit),
                    in_unit(straight, unit)
                )),
                Ok(then) => {
                    let whole = then.load - self.load;
                    let off = (whole - straight).abs();
                    if off > CURVED * whole.abs().max(straight.abs()) && off > MATTERS * self.load.abs() {
                        let [whole, straight] = [whole, straight].map(|change| in_unit(change, unit));
                        words.push(format!("{with}, the largest load changes by {whole} instead of {straight}"));
                    }
                }
            }
        }
        words
    }

    fn output(&self, crane: &LiveCrane, envelope: &Envelope) -> Output {
        let unit = crane.description().parameters[envelope.load].unit.as_str();
        let unit = UNITS_OF_LOADS.into_iter().find(|own| *own == unit).unwrap_or_default();
        Output { name: NAME.to_owned(), unit, group: Group::Load, place: self.words(crane) }
    }

    /// The output that is at its bound; `None` if there is none.
    fn bounded(&self, sensitivity: &Sensitivity, crane: &LiveCrane) -> Option<Bounded> {
        let description = crane.description();
        let of_cylinder = |kind, cylinder: usize| Some(column_name(kind, &description.cylinders[cylinder].name, false));
        let name = match self.limit {
            Limit::Tipping { .. } => Some(KeyFigure::TIPPING_MARGIN.key.to_owned()),
            Limit::Utilisation { .. } => Some(KeyFigure::UTILISATION.greatest()),
            Limit::Effort { drive } => {
                let coordinate = &description.coordinates[description.drives[drive].coordinate];
                Some(drive_effort(&coordinate.name, coordinate.kind))
            }
            Limit::Pressure { cylinder, rod } | Limit::Pump { cylinder, rod } => {
                of_cylinder(if rod { ColumnKind::RodPressure } else { ColumnKind::PistonPressure }, cylinder)
            }
            Limit::Stroke { cylinder, .. } => of_cylinder(ColumnKind::CylinderLength, cylinder),
            Limit::Sliding { foot } => Some(friction_utilisation(&description.supports[foot].name)),
            Limit::LiftOff { foot } | Limit::Ground { foot } => {
                Some(vertical_reaction(&description.supports[foot].name))
            }
            Limit::Slack { rope } | Limit::Tension { rope } => Some(connector_force(&description.connectors[rope])),
            Limit::Equilibrium | Limit::Deflection { .. } | Limit::Stop { .. } | Limit::Overlap { .. } => None,
        };
        let output = sensitivity.index_of(&name?)?;
        // Another line may have the least margin.
        let is_line = matches!(self.limit, Limit::Tipping { .. });
        let is_same = !is_line || sensitivity.outputs[output].place == self.limit.location(crane);
        let sign = if matches!(self.limit, Limit::Effort { .. }) { sensitivity.values[output].signum() } else { 1.0 };
        is_same.then_some(Bounded { output, sign })
    }
}

/// An output at its bound: `g = sign · output − limit`.
struct Bounded {
    output: usize,
    sign: f64,
}

/// The numbers of the lists of derivatives.
fn changing<'a>(sensitivity: &Sensitivity, fixed: &'a [FixedNumber]) -> impl Iterator<Item = Changing<'a>> {
    let parameters: Vec<usize> = sensitivity.parameters.clone();
    parameters.into_iter().map(Changing::Parameter).chain(fixed.iter().map(Changing::Fixed))
}
