//! Products of weights with the slopes of a crane's functions, in all directions of a run at once.

use crane_codegen::chain::Input;
use crane_codegen::program::FunctionId;
use crane_model::EventInfo;
use crane_model::dyn_crane::{Arguments, DynCrane, Functions};
use crane_model::dynamics::gradients::{Around, Covector, CylinderSlopes, FeetSlopes, MotionAt, Numbers, PullBacks};

use super::Along;
use super::directions::{Directions, FEET};
use crate::LiveCrane;
use crate::assemble::TooLarge;
use crate::products::{PullBack, Pulled};

/// The transposed functions of a crane.
pub(super) struct Transposed<'a> {
    directions: Directions<'a>,
    places: Places,
    residual: Option<PullBack>,
    motions: Option<PullBack>,
    loop_states: Option<PullBack>,
    loop_jacobians: Option<PullBack>,
    cylinder_states: Option<PullBack>,
    cylinder_jacobians: Option<PullBack>,
    openings: Option<PullBack>,
    feet: Option<[Option<PullBack>; 5]>,
}

impl<'a> Transposed<'a> {
    /// For some numbers of a crane.
    ///
    /// # Errors
    /// A function needs too many registers.
    pub fn new(crane: &'a LiveCrane, along: &[Along]) -> Result<Self, TooLarge> {
        let place = |own: Along| along.iter().position(|along| *along == own);
        let places = Places {
            parameters: (0..crane.parameters().len()).map(|index| place(Along::Parameter(index))).collect(),
            inputs: (0..crane.description().inputs.len()).map(|index| place(Along::Input(index))).collect(),
        };
        Self::with_directions(Directions::new(crane, along), places)
    }

    fn with_directions(directions: Directions<'a>, places: Places) -> Result<Self, TooLarge> {
        let crane = directions.crane();
        let with = |needed: bool, id: FunctionId| if needed { PullBack::new(crane, id) } else { Ok(None) };
        let description = crane.description();
        let has_loops = !crane.loop_joints().is_empty();
        let has_oil = description.cylinders.iter().any(|cylinder| cylinder.valve.is_some());
        Ok(Self {
            residual: with(true, FunctionId::DynamicResidual)?,
            motions: with(true, FunctionId::DriveMotions)?,
            loop_states: with(has_loops, FunctionId::LoopStates)?,
            loop_jacobians: with(has_loops, FunctionId::LoopJacobians)?,
            cylinder_states: with(has_oil, FunctionId::CylinderStates)?,
            cylinder_jacobians: with(has_oil, FunctionId::CylinderJacobians)?,
            openings: with(has_oil, FunctionId::ValveOpenings)?,
            feet: if description.has_feet() {
                let [a, b, c, d, e] = FEET.map(|id| with(true, id));
                Some([a?, b?, c?, d?, e?])
            } else {
                None
            },
            directions,
            places,
        })
    }

    /// The same directions, forward.
    pub fn directions(&self) -> &Directions<'a> {
        &self.directions
    }
}

/// The direction of every live parameter, and of every input.
#[derive(Clone)]
struct Places {
    parameters: Vec<Option<usize>>,
    inputs: Vec<Option<usize>>,
}

impl Places {
    /// Adds what a function contributes through parameters and inputs.
    fn add_numbers(&self, pulled: &Pulled<'_>, sum: &mut Covector) {
        let values = pulled.inputs.iter().step_by(Input::SLOTS);
        let pairs = self.parameters.iter().zip(pulled.parameters).chain(self.inputs.iter().zip(values));
        for (direction, by) in pairs.filter_map(|(direction, by)| Some(((*direction)?, by))) {
            sum.numbers[direction] += by;
        }
    }

    /// Adds what a function contributes.
    fn add(&self, pulled: &Pulled<'_>, sum: &mut Covector) {
        self.add_numbers(pulled, sum);
        sum.motion.iter_mut().zip(pulled.q.iter().chain(pulled.v)).for_each(|(sum, by)| *sum += by);
    }
}

impl Numbers for Transposed<'_> {
    fn count(&self) -> usize {
        self.directions.count()
    }

    fn around(&self, direction: usize) -> Option<Around<'_>> {
        self.directions.around(direction)
    }

    fn stops(&mut self) -> Vec<(f64, Vec<f64>)> {
        self.directions.stops()
    }
}

impl PullBacks for Transposed<'_> {
    fn after(&self, event: &EventInfo) -> Option<Box<dyn PullBacks>> {
        let mut places = self.places.clone();
        event.changes.iter().for_each(|(index, _)| places.parameters[*index] = None);
        let after = Transposed::with_directions(self.directions.after(event).ok()?, places).ok()?;
        Some(Box::new(after))
    }

    fn residuals(&mut self, at: &MotionAt<'_>, weights: &[f64], sum: &mut Covector) {
        let Self { places, residual, loop_jacobians, .. } = self;
        let state = Arguments { t: at.t, q: at.q, v: at.v, a: at.a, ..Arguments::none() };
        if let Some(residual) = residual {
            places.add(&residual.at(&state, weights), sum);
        }
        if let Some(jacobians) = loop_jacobians.as_mut().filter(|_| !at.multipliers.is_empty()) {
            let weights: Vec<f64> = at
                .multipliers
                .iter()
                .flat_map(|multiplier| weights.iter().map(move |weight| multiplier * weight))
                .collect();
            places.add(&jacobians.at(&state, &weights), sum);
        }
    }

    fn loops(&mut self, at: &MotionAt<'_>, weights: &[[f64; 3]], sum: &mut Covector) {
        let Self { places, loop_states, loop_jacobians, .. } = self;
        let state = Arguments { t: at.t, q: at.q, v: at.v, a: at.a, ..Arguments::none() };
        if let (Some(states), Some(jacobians)) = (loop_states, loop_jacobians) {
            places.add(&states.at(&state, weights.as_flattened()), sum);
            let weights: Vec<f64> =
                weights.iter().flat_map(|[.., second]| at.a.iter().map(move |a| second * a)).collect();
            places.add(&jacobians.at(&state, &weights), sum);
        }
    }

    fn cylinders(&mut self, at: &MotionAt<'_>, weights: &[CylinderSlopes], sum: &mut Covector) {
        let Self { directions, places, .. } = self;
        let crane = directions.crane();
        let (Some(states), Some(jacobians)) = (&mut self.cylinder_states, &mut self.cylinder_jacobians) else { return };
        let state = Arguments { t: at.t, q: at.q, v: at.v, a: at.a, ..Arguments::none() };
        let of_states: Vec<f64> = weights
            .iter()
            .flat_map(|cylinder_slopes| [cylinder_slopes.length_and_rate[0], cylinder_slopes.length_and_rate[1], 0.0])
            .collect();
        places.add(&states.at(&state, &of_states), sum);
        let of_jacobians: Vec<f64> =
            weights.iter().flat_map(|cylinder_slopes| cylinder_slopes.jacobian.iter().copied()).collect();
        places.add(&jacobians.at(&state, &of_jacobians), sum);
        if !directions.may_change_servos() {
            return;
        }
        let description = crane.description();
        let mut of_motions = vec![[0.0; 2]; description.drives.len()];
        let mut of_openings = of_motions.clone();
        let motions = (crane as &dyn DynCrane).drive_motions_at(at.t);
        let mut wanted = [vec![0.0; at.q.len()], vec![0.0; at.q.len()]];
        let driven = || description.cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
        for cylinder in driven() {
            let coordinate = description.drives[cylinder.drive].coordinate;
            wanted.iter_mut().zip(motions[cylinder.drive]).for_each(|(wanted, motion)| wanted[coordinate] = motion);
        }
        for (cylinder_slopes, cylinder) in weights.iter().zip(&*description.cylinders) {
            of_openings[cylinder.drive][0] += cylinder_slopes.opening;
        }
        let of_wanted: Vec<f64> = weights
            .iter()
            .flat_map(|cylinder_slopes| [cylinder_slopes.wanted[0], cylinder_slopes.wanted[1], 0.0])
            .collect();
        let pulled = states.at(&Arguments { q: &wanted[0], v: &wanted[1], ..state }, &of_wanted);
        places.add_numbers(&pulled, sum);
        for cylinder in driven() {
            let coordinate = description.drives[cylinder.drive].coordinate;
            of_motions[cylinder.drive] = [pulled.q[coordinate], pulled.v[coordinate]];
        }
        let rest = [(&mut self.motions, of_motions), (&mut self.openings, of_openings)];
        for (function, weights) in rest {
            if let Some(function) = function {
                places.add_numbers(&function.at(&state, weights.as_flattened()), sum);
            }
        }
    }

    fn feet(&mut self, at: &MotionAt<'_>, weights: &FeetSlopes, sum: &mut Covector) {
        let Self { places, feet: Some(feet), .. } = self else { return };
        let state = Arguments { t: at.t, q: at.q, v: at.v, a: at.a, ..Arguments::none() };
        let FeetSlopes { elongations, jacobians, stiffnesses, dampings, grips } = weights;
        for (function, weights) in feet.iter_mut().zip([elongations, jacobians, stiffnesses, dampings, grips]) {
            if let Some(function) = function {
                places.add(&function.at(&state, weights), sum);
            }
        }
    }

    fn drive_motions(&mut self, t: f64, weights: &[[f64; 2]], sum: &mut Covector) {
        let Self { directions, places, motions, .. } = self;
        if let Some(motions) = motions.as_mut().filter(|_| directions.may_move_drives()) {
            let state = Arguments { t, ..Arguments::none() };
            places.add_numbers(&motions.at(&state, weights.as_flattened()), sum);
        }
    }
}
