//! Laws of forces: one file per law.
//!
//! A law is given by the energy E(s) that it stores and by the force D(s, ṡ) with which it resists the rate of its strain. From these
//! follow
//!
//! ```text
//! F = ∂E/∂s + D        dissipated power D ṡ        stiffness ∂F/∂s        damping ∂F/∂ṡ
//! ```
//!
//! A law may state them itself where that takes fewer operations; the tests compare them with these.

mod clearance;
mod friction;
mod gas_spring;
mod progressive_spring;
mod rope;
mod spring;
mod stop;
#[cfg(test)]
mod tests;

use super::model::Model;
use crate::chain;
use crate::symbolic::Expr;

/// When a law is evaluated.
#[derive(Clone, Copy)]
pub struct LawState<'a, 'g> {
    pub model: &'a Model<'g>,
    /// Time of motions on which a law depends, s.
    pub t: Expr<'g>,
    /// Whether such motions go on; at rest they do not.
    pub moving: bool,
    /// Compliance and damping in series with a spring, if there are: c and e, with which it is `k/(1 + k c)`.
    pub series: Option<[Expr<'g>; 2]>,
}

impl<'a, 'g> LawState<'a, 'g> {
    /// In motion, at the present time.
    pub fn now(model: &'a Model<'g>) -> Self {
        LawState { model, t: model.t, moving: true, series: None }
    }

    /// At rest at a time.
    pub fn rest(model: &'a Model<'g>, t: Expr<'g>) -> Self {
        LawState { model, t, moving: false, series: None }
    }

    pub fn number(&self, value: &chain::Value) -> Expr<'g> {
        self.model.number(value)
    }

    /// `1 + k c`: how many times softer the compliance in series makes a spring; `None` without one.
    pub fn softened(&self, stiffness: Expr<'g>) -> Option<Expr<'g>> {
        self.series.map(|[compliance, _]| 1.0 + stiffness * compliance)
    }

    /// `k/(1 + k c)`
    pub fn stiffness(&self, stiffness: Expr<'g>) -> Expr<'g> {
        self.softened(stiffness).map_or(stiffness, |times| stiffness / times)
    }

    /// `(d + k² e)/(1 + k c)²`: each part dissipates at its share of the rate.
    pub fn damping(&self, stiffness: Expr<'g>, damping: Expr<'g>) -> Expr<'g> {
        let softened = self.softened(stiffness).zip(self.series);
        softened.map_or(damping, |(times, [_, viscous])| (damping + stiffness.squared() * viscous) / times.squared())
    }

    pub fn zero(&self) -> Expr<'g> {
        self.model.zero()
    }
}

/// The law of a force F that resists the growth of its strain s.
pub trait Law {
    /// `2E(s)`, twice the energy stored.
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g>;

    /// `D(s, ṡ)`, the part of the force that depends on the rate, 0 without one; `D ṡ ≥ 0`.
    fn resistance<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g>;

    /// F
    fn force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        elastic_force(self, at, strain) + self.resistance(at, strain, rate)
    }

    /// Dissipated power.
    fn dissipation<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        self.resistance(at, strain, rate) * rate
    }

    /// `∂F/∂s` and `∂F/∂ṡ`.
    fn slopes<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> [Expr<'g>; 2] {
        derived_slopes(self, at, strain, rate)
    }

    /// `∂F/∂ṡ` at rest.
    fn damping_at_rest<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        self.slopes(at, strain, at.zero())[1]
    }

    /// Whether F is linear in s and ṡ.
    fn is_linear(&self) -> bool {
        false
    }

    /// Whether `∂F/∂ṡ` may be negative.
    fn declines(&self) -> bool {
        false
    }
}

macro_rules! dispatch {
    ($($(#[$doc:meta])* $law:ident as $written:ident: $expecting:literal {
        $($(#[doc = $about:literal])* #[key(unit = $unit:literal, limit = $limit:ident)] $key:ident: $number:ty;)*
    })*) => {
        /// The law of a force of the chain.
        pub fn law(law: &chain::Law) -> &dyn Law {
            match law {
                $(chain::Law::$law(law) => law,)*
                chain::Law::Rope(law) => law,
                chain::Law::Clearance(law) => law,
                chain::Law::Stop(law) => law,
                chain::Law::Friction(law) => law,
            }
        }
    };
}

point_laws!(dispatch);

/// `∂E/∂s`
fn elastic_force<'g>(law: &(impl Law + ?Sized), at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
    let [s, _] = at.model.free_symbols();
    let twice = at.model.graph.derivatives(&[law.twice_energy(at, s)], s)[0];
    at.model.graph.substitute(0.5 * twice, &[(s, strain)])
}

/// `∂F/∂s` and `∂F/∂ṡ`, by differentiation.
fn derived_slopes<'g>(
    law: &(impl Law + ?Sized),
    at: LawState<'_, 'g>,
    strain: Expr<'g>,
    rate: Expr<'g>,
) -> [Expr<'g>; 2] {
    let (graph, symbols) = (at.model.graph, at.model.free_symbols());
    let [s, s_dot] = symbols;
    let force = law.force(at, s, s_dot);
    symbols.map(|by| graph.substitute(graph.derivatives(&[force], by)[0], &[(s, strain), (s_dot, rate)]))
}
