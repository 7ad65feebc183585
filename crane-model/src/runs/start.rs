//! Start of a run.

use std::ops::{Deref, DerefMut};

use super::{Failed, Reason};
use crate::{
    dyn_crane::DynCrane,
    dynamics::InitialState,
    loop_joints::{Given, close_start, close_state},
    statics::{Equilibrium, Settings},
};

/// Start of a crane whose spec requests statics.
pub const EQUILIBRIUM: &str = "static equilibrium, at rest";
/// Start of a crane whose spec does not.
pub const GUESS: &str = "guess, at rest";

/// The same of a crane with loops.
pub const GUESS_CLOSED: &str = "guess, moved onto the loops, at rest";
/// The same of a crane whose loops do not close.
pub const GUESS_OPEN: &str = "guess, whose loops are open, at rest";

/// The same with given rates.
pub const EQUILIBRIUM_MOVING: &str = "static equilibrium, with given rates";
/// The same with given rates.
pub const GUESS_MOVING: &str = "guess, with given rates";

/// Start of a crane whose pose is given.
pub const GIVEN: &str = "as given";

/// The state from which a run starts, also by [`Deref`], and where it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// The state.
    pub state: InitialState,
    /// In words: [`EQUILIBRIUM`], [`GUESS`], or the start that was requested.
    pub what: String,
    /// Whether the crane would stay there with its drives stopped.
    pub rests: bool,
}

impl Start {
    /// The static equilibrium if the crane's spec requests statics, otherwise its guess.
    ///
    /// # Errors
    /// There is no stable equilibrium, or the mass matrix is not positive definite.
    pub fn new(crane: &dyn DynCrane) -> Result<Self, Failed> {
        if crane.description().statics {
            Self::at(crane, &crane.equilibrium(&Settings::default()))
        } else {
            Ok(Self::guess(crane))
        }
    }

    /// The start of [`Start::new`] or, where there is none, the guess; [`Start::what`] says which, and whether the guess is on the loops.
    pub fn of_or_guess(crane: &dyn DynCrane) -> Self {
        let mut start = Self::new(crane).unwrap_or_else(|_| Self::guess(crane));
        if !start.rests && crane.loop_equations() > 0 {
            let closed = start.close_state(crane, 0.0).is_ok();
            if closed { GUESS_CLOSED } else { GUESS_OPEN }.clone_into(&mut start.what);
        }
        start
    }

    /// The start of a crane at time `t`, s, with another pose, at rest, or with other rates, where these are given.
    ///
    /// # Errors
    /// Those of [`Start::new`], if no pose is given; [`Reason::OpenStart`].
    pub fn with(crane: &dyn DynCrane, t: f64, q: Option<&[f64]>, v: Option<&[f64]>) -> Result<Self, Failed> {
        let mut start = match q {
            Some(q) => Self::given(InitialState::at_rest(q.to_vec())),
            None => Self::new(crane)?,
        };
        if let Some(v) = v {
            let what = match start.what.as_str() {
                EQUILIBRIUM => EQUILIBRIUM_MOVING,
                GUESS => GUESS_MOVING,
                _ => GIVEN,
            };
            let state = InitialState { v: v.to_vec(), ..start.state };
            start = Self { what: what.to_owned(), ..Self::given(state) };
        }
        if q.is_some() || v.is_some() {
            start.close_state(crane, t)?;
        }
        Ok(start)
    }

    /// Moves a whole state at time `t`, s, onto the loops of the crane, up to a millionth of their size.
    ///
    /// # Errors
    /// [`Reason::OpenStart`]: it is further away.
    pub fn close_state(&mut self, crane: &dyn DynCrane, t: f64) -> Result<(), Failed> {
        close_state(crane, t, (&mut self.state.q, &mut self.state.v))
            .map_err(|gap| Reason::OpenStart { gap, partly: false }.for_crane(&crane.description().name))
    }

    /// Moves what is not given of a start at time `t`, s, onto the loops of the crane: given positions and rates hold exactly.
    ///
    /// # Errors
    /// [`Reason::OpenStart`]: what is given leaves no way to close a loop.
    pub fn close(&mut self, crane: &dyn DynCrane, t: f64, given: &Given) -> Result<(), Failed> {
        close_start(crane, t, (&mut self.state.q, &mut self.state.v), given)
            .map_err(|gap| Reason::OpenStart { gap, partly: true }.for_crane(&crane.description().name))
    }

    /// A given equilibrium.
    ///
    /// # Errors
    /// It is not stable, or the mass matrix is not positive definite.
    pub fn at(crane: &dyn DynCrane, equilibrium: &Equilibrium) -> Result<Self, Failed> {
        let name = &crane.description().name;
        if !equilibrium.is_stable() {
            return Err(Reason::no_equilibrium(crane, equilibrium).for_crane(name));
        }
        let q = equilibrium.q.clone();
        if !q.is_empty() && crane.mass_matrix_at(&q).cholesky().is_none() {
            return Err(Reason::MassMatrix.for_crane(name));
        }
        Ok(Self { state: InitialState::at_rest(q), what: EQUILIBRIUM.to_owned(), rests: true })
    }

    /// A given state.
    pub fn given(state: InitialState) -> Self {
        Self { state, what: GIVEN.to_owned(), rests: false }
    }

    /// The guess of a crane.
    pub fn guess(crane: &dyn DynCrane) -> Self {
        Self { state: InitialState::at_rest(crane.guess()), what: GUESS.to_owned(), rests: false }
    }
}

impl Deref for Start {
    type Target = InitialState;

    fn deref(&self) -> &InitialState {
        &self.state
    }
}

impl DerefMut for Start {
    fn deref_mut(&mut self) -> &mut InitialState {
        &mut self.state
    }
}
