//! A crane under test, used as the command uses it.

use std::ops::ControlFlow;

use crane_live::LiveCrane;

use super::{
    case::{Finding, expect},
    spec::Spec,
};
use crane_model::{
    dyn_crane::DynCrane,
    dynamics::Method,
    results,
    runs::{self, Recorded},
    statics::{Equilibrium, Settings},
};

use crane_cli::{
    Console,
    toolbox::{Problem, Timing},
};

/// A crane under test.
pub struct Subject {
    /// The crane.
    pub crane: Box<dyn DynCrane>,
}

impl Subject {
    /// The crane of a spec, or the codes and titles of its mistakes.
    pub fn new(spec: &Spec) -> Result<Self, String> {
        let crane = LiveCrane::from_spec(spec.source()).map_err(|mistakes| {
            let mistakes = mistakes.mistakes().iter().map(|mistake| format!("{}: {}", mistake.code, mistake.title));
            format!("refused, {}", mistakes.collect::<Vec<_>>().join("; "))
        })?;
        Ok(Self { crane: Box::new(crane) })
    }

    /// With another value of a live parameter.
    pub fn set(mut self, name: &str, value: f64) -> Result<Self, String> {
        let index = self.crane.description().parameters.iter().position(|parameter| parameter.name == name);
        let index = index.ok_or_else(|| format!("no parameter {name}"))?;
        self.crane.set_parameter(index, value).map_err(|refused| refused.to_string())?;
        Ok(self)
    }

    /// Index of a coordinate.
    pub fn index(&self, name: &str) -> Result<usize, String> {
        let coordinates = &self.crane.description().coordinates;
        coordinates.iter().position(|c| c.name == name).ok_or_else(|| format!("no coordinate {name}"))
    }

    /// The result of statics, whatever its status.
    pub fn equilibrium(&self) -> Equilibrium {
        self.crane.equilibrium(&Settings::default())
    }

    /// The stable pose, or the message of statics if there is none.
    pub fn rest(&self) -> Result<Equilibrium, String> {
        let equilibrium = self.equilibrium();
        if !equilibrium.is_stable() {
            return Err(equilibrium.to_string());
        }
        if equilibrium.q.iter().all(|x| x.is_finite()) { Ok(equilibrium) } else { Err("a pose of NaN".to_owned()) }
    }

    /// A run as the command performs it, or its message if it is refused or ends early. All numbers of the results are finite.
    pub fn run(&self, timing: &Timing) -> Result<Recorded, String> {
        let crane = self.crane.as_ref();
        let message = |problem: Problem| problem.message();
        let start = timing.start(&Console::default(), crane, false).map_err(message)?;
        let settings = timing.settings(crane, &start, Method::RECOMMENDED).map_err(message)?;
        let checks = (false, results::cautions::BEND);
        let recorded = runs::record_checked(crane, &start, &settings, checks, &mut |_| ControlFlow::Continue(()))
            .map_err(|failed| message(failed.into()))?;
        let table = &recorded.table;
        match table.not_finite() {
            Some((row, column)) => {
                Err(format!("{} is not a number in row {row} of the results", table.columns[column]))
            }
            None => Ok(recorded),
        }
    }
}

/// Options of a run by a method with a tolerance or step, and of a duration in s.
pub fn timing(method: Method, accuracy: f64, duration: f64) -> Timing {
    let adaptive = method.is_adaptive();
    Timing {
        method: Some(method),
        tolerance: adaptive.then_some(accuracy),
        step: (!adaptive).then_some(crane_cli::toolbox::Step::Seconds(accuracy)),
        no_verify: true,
        force: false,
        duration: Some(duration),
        interval: Some(duration / 100.0),
        from: None,
        start: Vec::new(),
    }
}

/// Maximum error of the energy balance over the maximum energy exchanged.
pub fn imbalance(recorded: &Recorded) -> f64 {
    runs::imbalance(&recorded.table, 0.0)
}

/// Cautions of the command about a run, each after a semicolon.
pub fn cautions(recorded: &Recorded) -> String {
    appended(&recorded.cautions)
}

/// Sentences, each after a semicolon.
pub fn appended<'a>(sentences: impl IntoIterator<Item = &'a String>) -> String {
    sentences.into_iter().fold(String::new(), |text, sentence| text + "; " + sentence)
}

/// As expected if the energy error of a run is below a fraction of the energy exchanged.
pub fn balanced(recorded: &Recorded, part: f64) -> Finding {
    let (off, steps) = (imbalance(recorded), recorded.run.statistics.steps);
    expect(off < part, format!("{steps} steps, energy off by {off:.1e}{}", cautions(recorded)))
}
