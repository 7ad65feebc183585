//! A crane in motion: the crane and the integration that borrows it, in one value.

use std::ops::ControlFlow;

use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{
    Course, Happening, InitialState, Integration, Progress, Run, Sample, Settings, Stopped, crane_after,
};
use crane_model::results::QUANTITIES;
use self_cell::self_cell;

use crate::LiveCrane;

self_cell!(
    struct Moving {
        owner: Box<dyn DynCrane>,
        #[covariant]
        dependent: Integration,
    }
);

/// A motion of a live or compiled crane that continues from a state as far as requested, with the history of its method and the events of the crane.
pub struct Motion {
    moving: Moving,
    course: Course,
    /// The crane whose inputs the one in motion shares, if it is steered.
    steered: Option<LiveCrane>,
}

impl Motion {
    /// From a state at a time, s. Events before this time do not happen. With [`marks`](Self::marks) it goes on from those of an earlier motion.
    ///
    /// # Errors
    /// As [`Integration::new`].
    pub fn new(
        crane: Box<dyn DynCrane>,
        begin: f64,
        start: &InitialState,
        settings: &Settings,
        marks: Option<&[f64]>,
    ) -> Result<Self, Stopped> {
        Self::begin(crane, None, (begin, start), settings, marks)
    }

    /// The same of a crane whose inputs change on the way.
    pub(crate) fn steered(
        crane: LiveCrane,
        begin: f64,
        start: &InitialState,
        settings: &Settings,
        marks: Option<&[f64]>,
    ) -> Result<Self, Stopped> {
        let shared = Box::new(crane.sharing_inputs()) as Box<dyn DynCrane>;
        Self::begin(shared, Some(crane), (begin, start), settings, marks)
    }

    fn begin(
        crane: Box<dyn DynCrane>,
        steered: Option<LiveCrane>,
        (begin, start): (f64, &InitialState),
        settings: &Settings,
        marks: Option<&[f64]>,
    ) -> Result<Self, Stopped> {
        let mut course = Course::new(crane.as_ref(), begin, start, settings, &QUANTITIES);
        if let Some(marks) = marks {
            course.resume(crane.as_ref(), marks);
        }
        let mut moving = phase(crane, &course)?;
        moving.with_dependent_mut(|crane, integration| course.enter(crane.as_ref(), integration))?;
        Ok(Self { moving, course, steered })
    }

    /// Continues to a later time, s. `step` receives the time after every step, and may stop the motion: then the last result is kept.
    ///
    /// # Errors
    /// As [`Integration::advance`]; an event breaks a rule.
    pub fn advance(
        &mut self,
        result: f64,
        step: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Stopped> {
        loop {
            let course = &mut self.course;
            let progress = self.moving.with_dependent_mut(|crane, integration| {
                course.advance(crane.as_ref(), integration, result, &mut *step)
            })?;
            match progress {
                Progress::Reached => return Ok(ControlFlow::Continue(())),
                Progress::Stopped => return Ok(ControlFlow::Break(())),
                Progress::Event(happening) => self.pass(happening)?,
            }
        }
    }

    /// Goes on after an event.
    fn pass(&mut self, happening: Happening) -> Result<(), Stopped> {
        let Self { moving, course, steered } = self;
        let (present, integration) = (moving.borrow_owner().as_ref(), moving.borrow_dependent());
        let after = match steered {
            Some(crane) => {
                let allowed = course.after(crane, happening)?;
                let values: Vec<f64> = (0..crane.parameters().len()).map(|index| allowed.parameter(index)).collect();
                // These are allowed.
                let _ = crane.set_parameters(&values);
                Box::new(crane.sharing_inputs())
            }
            None => course.after(present, happening)?,
        };
        course.pass([present, after.as_ref()], integration, happening)?;
        *moving = phase(after, course)?;
        moving.with_dependent_mut(|crane, integration| course.enter(crane.as_ref(), integration))
    }

    /// Continues from the last result after `change`, which sets inputs of the crane.
    ///
    /// # Errors
    /// As [`Integration::change`].
    pub(crate) fn change(&mut self, change: &mut dyn FnMut()) -> Result<(), Stopped> {
        self.moving.with_dependent_mut(|_, integration| integration.change(change))
    }

    /// All numbers on which the further motion depends, besides the crane and the settings.
    pub(crate) fn memory(&mut self) -> Vec<f64> {
        let mut memory = Vec::new();
        let Self { moving, course, .. } = self;
        course.visit(moving.borrow_owner().as_ref(), &mut |number| memory.push(*number));
        memory.extend(self.moving.with_dependent_mut(|_, integration| integration.memory()));
        memory
    }

    /// Continues as the motion of the same crane from which `memory` is; returns whether it can be from such a one.
    pub(crate) fn recall(&mut self, memory: &[f64]) -> bool {
        let (mut numbers, mut read) = (memory.iter(), 0);
        let Self { moving, course, .. } = self;
        let is_possible = course.visit(moving.borrow_owner().as_ref(), &mut |number| {
            *number = numbers.next().copied().unwrap_or_default();
            read += 1;
        });
        let Some(rest) = memory.get(read..).filter(|_| is_possible) else { return false };
        if self.course.happened().next().is_some() && self.recall_phase().is_none() {
            return false;
        }
        self.moving.with_dependent_mut(|_, integration| integration.recall(rest))
    }

    /// Begins the phase of the course with the crane after its events.
    fn recall_phase(&mut self) -> Option<()> {
        let Self { moving, course, steered } = self;
        let infos = &moving.borrow_owner().description().events;
        let events: Vec<_> = course.happened().map(|event| infos.get(event)).collect::<Option<_>>()?;
        let mut after = crane_after(moving.borrow_owner().as_ref(), events).ok()?;
        if let Some(crane) = steered {
            let values: Vec<f64> = (0..crane.parameters().len()).map(|index| after.parameter(index)).collect();
            crane.set_parameters(&values).ok()?;
            after = Box::new(crane.sharing_inputs());
        }
        *moving = phase(after, course).ok()?;
        Some(())
    }

    /// What events have done so far, from which another motion goes on: see [`Course::marks`].
    #[must_use]
    pub fn marks(&self) -> Vec<f64> {
        self.course.marks(self.crane())
    }

    /// The crane, after its events so far.
    #[must_use]
    pub fn crane(&self) -> &dyn DynCrane {
        self.moving.borrow_owner().as_ref()
    }

    /// The state reached.
    #[must_use]
    pub fn sample(&self) -> Sample<'_> {
        self.course.sample(self.moving.borrow_dependent())
    }

    /// Summary of the run so far.
    #[must_use]
    pub fn run(&self) -> Run {
        self.course.run(self.moving.borrow_dependent())
    }
}

/// The present phase of a course.
fn phase(crane: Box<dyn DynCrane>, course: &Course) -> Result<Moving, Stopped> {
    let (begin, state, settings) = course.phase();
    Moving::try_new(crane, |crane| Integration::new(crane.as_ref(), begin, state, &settings))
}
