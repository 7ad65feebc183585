//! Derivatives by numbers that cannot be live parameters: differences of whole cranes.

use crane_codegen::{Checked, CraneSpec, check};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::runs::Failed;

use super::places::Refused;
use super::{Sensitivity, Settings, label, sensitivity_near};
use crate::LiveCrane;

/// Longer step relative to the number: the error of its differences, of the square, is 1e-6 of how fast derivatives change, and poses that are exact
/// to 1e-13 leave 1e-10.
const STEP: f64 = 1e-3;
/// Longer step of a number that is 0, in its unit.
const STEP_FROM_ZERO: f64 = 1e-4;

/// A number of a spec that cannot be a live parameter, such as the length of a part of a beam, and the cranes with numbers around it.
#[derive(Clone)]
pub struct FixedNumber {
    /// Its place in the spec.
    pub place: String,
    /// Its value, in its unit.
    pub value: f64,
    /// Its unit; empty for a number without one.
    pub unit: String,
    /// The spec with the number itself.
    spec: CraneSpec,
    /// Half the distance of the outer cranes.
    step: f64,
    /// With the number less a step, less half of it, plus half of it, plus a step.
    around: [LiveCrane; 4],
}

/// Derivatives by a fixed number.
#[derive(Clone, Debug, PartialEq)]
pub struct Differences {
    /// Derivatives of the outputs: central differences of two steps, extrapolated, `(4 D(h/2) − D(h))/3`.
    pub derivatives: Vec<f64>,
    /// Estimates of their errors, `|D(h/2) − D(h)|`: those of the shorter step without the extrapolation.
    pub errors: Vec<f64>,
    /// Derivatives of the pose.
    pub pose: Vec<f64>,
}

impl FixedNumber {
    /// The number at a place, with the cranes around it.
    ///
    /// # Errors
    /// There is no number at this place, or the spec does not allow a number slightly smaller or larger: integers have no derivatives.
    pub fn new(checked: &Checked, place: &str) -> Result<Self, Refused> {
        let value = checked.spec.number_at(place).map_err(Refused::Place)?;
        let step = if value == 0.0 { STEP_FROM_ZERO } else { STEP * value.abs() };
        let with = |share: f64| changed(&checked.spec, place, value, share * step);
        let around = [with(-1.0)?, with(-0.5)?, with(0.5)?, with(1.0)?];
        let unit = checked.unit_at(place).to_owned();
        Ok(Self { place: place.to_owned(), value, unit, spec: checked.spec.clone(), step, around })
    }

    /// Central differences of the outputs of a crane with this number, with its parameters and inputs.
    ///
    /// # Errors
    /// A crane with a slightly smaller or larger number has no stable equilibrium.
    pub fn differentiate(
        &self,
        crane: &LiveCrane,
        sensitivity: &Sensitivity,
        settings: &Settings,
    ) -> Result<Differences, Failed> {
        let at = |other: &LiveCrane| -> Result<Vec<f64>, Failed> {
            let other = sensitivity_near(&like(crane, other), &[], settings, &sensitivity.q)?;
            let value = |name: &str| other.index_of(name).map_or(f64::NAN, |index| other.values[index]);
            Ok(sensitivity.outputs.iter().map(|output| value(&output.name)).chain(other.q.iter().copied()).collect())
        };
        let [first, second, third, fourth] = self.around.each_ref().map(at);
        let mut all = Differences::central([first?, second?, third?, fourth?], self.step);
        all.pose = all.derivatives.split_off(sensitivity.outputs.len());
        all.errors.truncate(sensitivity.outputs.len());
        Ok(all)
    }
}

/// A crane with the parameters and inputs of another one.
fn like(crane: &LiveCrane, other: &LiveCrane) -> LiveCrane {
    let inputs: Vec<Option<f64>> = (0..crane.description().inputs.len()).map(|index| crane.input(index)).collect();
    let mut other = other.clone().with_inputs(&inputs);
    for (index, info) in crane.description().parameters.iter().enumerate() {
        let own = other.description().parameters.iter().position(|parameter| parameter.name == info.name);
        if let Some(own) = own {
            // The crane itself has this value; it is allowed here too, or the crane keeps its own.
            let _ = other.set_parameter(own, crane.parameters()[index]);
        }
    }
    other
}

/// A number of a crane that changes: a live parameter, or a number that cannot be one.
#[derive(Clone, Copy)]
pub enum Changing<'a> {
    /// The index of a live parameter.
    Parameter(usize),
    /// A number at a place of the spec.
    Fixed(&'a FixedNumber),
}

impl Changing<'_> {
    /// Its value in a crane.
    #[must_use]
    pub fn value(self, crane: &LiveCrane) -> f64 {
        match self {
            Self::Parameter(index) => crane.parameters()[index],
            Self::Fixed(number) => number.value,
        }
    }

    /// What people call it, and its unit.
    #[must_use]
    pub fn label<'c>(&'c self, crane: &'c LiveCrane) -> [&'c str; 2] {
        match self {
            Self::Parameter(index) => {
                let info = &crane.description().parameters[*index];
                [label(info), info.unit.as_str()]
            }
            Self::Fixed(number) => [number.place.as_str(), &number.unit],
        }
    }

    /// A crane whose number is larger by `by`.
    ///
    /// # Errors
    /// The number breaks a rule of the spec, in words.
    pub fn change(self, crane: &LiveCrane, by: f64) -> Result<LiveCrane, String> {
        match self {
            Self::Parameter(index) => {
                let mut other = crane.clone();
                let set = other.set_parameter(index, crane.parameters()[index] + by);
                set.map(|()| other).map_err(|refused| refused.to_string())
            }
            Self::Fixed(FixedNumber { spec, place, value, .. }) => match changed(spec, place, *value, by) {
                Ok(other) => Ok(like(crane, &other)),
                Err(Refused::Mistakes { mistakes, .. }) => {
                    Err(mistakes.mistakes().first().map(|mistake| mistake.title.clone()).unwrap_or_default())
                }
                Err(refused) => Err(refused.words()[0].clone()),
            },
        }
    }

    /// The derivative of a number of the crane, by a central difference; 0 where it has none.
    pub(super) fn slope(self, crane: &LiveCrane, number: impl Fn(&LiveCrane) -> Option<f64>) -> f64 {
        let (step, at): (f64, [Option<f64>; 2]) = match self {
            Self::Parameter(_) => {
                let value = self.value(crane);
                let step = STEP * if value == 0.0 { 1.0 } else { value.abs() };
                (step, [-step, step].map(|by| number(&self.change(crane, by).ok()?)))
            }
            Self::Fixed(FixedNumber { step, around: [least, .., most], .. }) => (*step, [least, most].map(number)),
        };
        match at {
            [Some(before), Some(after)] if before.is_finite() && after.is_finite() => (after - before) / (2.0 * step),
            _ => 0.0,
        }
    }
}

/// The crane with another number at a place; a part of a beam that becomes longer makes the beam longer.
fn changed(spec: &CraneSpec, place: &str, value: f64, by: f64) -> Result<LiveCrane, Refused> {
    let mistakes = |mistakes| Refused::Mistakes { place: place.to_owned(), mistakes };
    let with = |spec: &CraneSpec, place: &str, value| {
        spec.changed(&spec.other_number(place, value).map_err(Refused::Place)?).map_err(mistakes)
    };
    let mut changed = with(spec, place, value + by)?;
    if let Some((beam, part)) = place.split_once(".parts.")
        && part.split('.').nth(1) == Some("length")
    {
        let length = format!("{beam}.length");
        changed = with(&changed, &length, spec.number_at(&length).map_err(Refused::Place)? + by)?;
    }
    check(changed).map(|checked| LiveCrane::new(checked.chain)).map_err(mistakes)
}

impl Differences {
    /// From values at −h, −h/2, h/2 and h.
    pub(super) fn central([first, second, third, fourth]: [Vec<f64>; 4], step: f64) -> Self {
        let both = (0..first.len()).map(|k| {
            let (long, short) = ((fourth[k] - first[k]) / (2.0 * step), (third[k] - second[k]) / step);
            ((4.0 * short - long) / 3.0, (short - long).abs())
        });
        let (derivatives, errors) = both.unzip();
        Self { derivatives, errors, pose: Vec::new() }
    }
}
