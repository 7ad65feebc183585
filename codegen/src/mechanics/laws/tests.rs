//! Properties of all laws, whatever they state themselves.

use super::{Law, LawState, derived_slopes, elastic_force, law};
use crate::chain::{
    self, Bristle, Clearance, End, Friction, GasSpring, Profile, ProgressiveSpring, Ramp, Rope, RopeStiffness, Spring,
    Stop, Value,
};
use crate::mechanics::model::Model;
use crate::mechanics::tests::double_pendulum;
use crate::symbolic::{Expr, Graph};

/// Laws with all their parts, one of each kind at least.
fn laws() -> Vec<(&'static str, chain::Law)> {
    let c = Value::Constant;
    let stop = |end, at| Stop { at: c(at), end, stiffness: c(900.0), damping: c(0.7) };
    let friction =
        |breakaway, bristle| Friction { coulomb: c(8.0), breakaway, width: c(0.05), viscous: c(3.0), bristle };
    let bristle = Bristle { coulomb: 8.0, breakaway: 12.0, stribeck: 0.1, stiffness: 1e4, damping: 30.0 };
    let rope = |length| Rope { stiffness: RopeStiffness::Whole(c(700.0)), damping: c(0.4), length, max_tension: None };
    let winch = Ramp { from: c(1.2), to: c(0.4), begin: c(0.0), duration: c(2.0) };
    vec![
        ("spring", chain::Law::Spring(Spring::new(c(500.0), c(20.0)))),
        (
            "gas spring",
            chain::Law::GasSpring(GasSpring { stiffness: c(50.0), damping: c(7.0), length: c(1.1), force: c(90.0) }),
        ),
        (
            "progressive spring",
            chain::Law::ProgressiveSpring(ProgressiveSpring {
                stiffness: c(50.0),
                progression: c(300.0),
                length: c(1.1),
                damping: c(7.0),
            }),
        ),
        ("rope", chain::Law::Rope(rope(Profile::Hold(c(0.8))))),
        ("winch", chain::Law::Rope(rope(Profile::Quintic(winch.clone())))),
        (
            "winch of a rope with EA",
            chain::Law::Rope(Rope { stiffness: RopeStiffness::Axial(c(500.0)), ..rope(Profile::Quintic(winch)) }),
        ),
        (
            "pad with clearance",
            chain::Law::Clearance(Clearance { stiffness: c(600.0), damping: c(9.0), clearance: c(0.3) }),
        ),
        ("lower stop", chain::Law::Stop(stop(End::Lower, 0.3))),
        ("upper stop", chain::Law::Stop(stop(End::Upper, -0.2))),
        ("friction", chain::Law::Friction(friction(Some((c(12.0), c(0.1))), None))),
        ("friction with bristles", chain::Law::Friction(friction(None, Some(bristle)))),
    ]
}

/// Strains on both sides of every branch, and rates.
const STRAINS: [f64; 6] = [-1.3, -0.4, 0.1, 0.55, 0.95, 2.2];
const RATES: [f64; 7] = [-4.0, -0.6, -0.02, 0.0, 0.03, 0.5, 3.0];

/// A number that follows from constants.
fn number(expression: Expr<'_>) -> f64 {
    expression.as_constant().expect("a law of numbers")
}

/// Every law at every state, in motion at t = 0.7 s and at rest.
fn at_all_states(mut check: impl FnMut(&str, &dyn Law, LawState<'_, '_>, [f64; 2])) {
    let (graph, chain) = (Graph::simplifying(), double_pendulum());
    let model = Model::new(&graph, &chain);
    for (name, given) in &laws() {
        for strain in STRAINS {
            for rate in RATES {
                for moving in [true, false] {
                    // With a compliance as large as that of a spring, and with none.
                    for series in [None, Some([2e-3, 5e-5].map(|x| graph.constant(x)))] {
                        let at = LawState { model: &model, t: graph.constant(0.7), moving, series };
                        check(name, law(given), at, [strain, rate]);
                    }
                }
            }
        }
    }
}

/// What is in series carries the same force, `F(s) = F₀(s − γ F)` with F₀ alone, and `∂E/∂γ = −½ F²`.
#[test]
fn what_is_in_series_carries_the_same_force() {
    const COMPLIANCE: f64 = 2e-3;
    const H: f64 = 1e-7;
    at_all_states(|name, law, at, [strain, _]| {
        if !["spring", "pad with clearance"].contains(&name) {
            return;
        }
        let c = |x: f64| at.model.graph.constant(x);
        let with = |compliance: f64| LawState { series: Some([c(compliance), c(0.0)]), ..at };
        let force = number(law.force(with(COMPLIANCE), c(strain), c(0.0)));
        let alone = LawState { series: None, ..at };
        let carried = number(law.force(alone, c(strain - COMPLIANCE * force), c(0.0)));
        assert_close(carried, force, &format!("{name} at {strain}"));
        let energy = |compliance: f64| 0.5 * number(law.twice_energy(with(compliance), c(strain)));
        let slope = (energy(COMPLIANCE + H) - energy(COMPLIANCE - H)) / (2.0 * H);
        // Energies of order 1e3 J rounded, over 2e-7.
        assert!(
            (slope + 0.5 * force * force).abs() < 2e-6 * (1.0 + force * force),
            "{name} at {strain}: {slope}, {force}"
        );
    });
}

/// A few rounding errors of forces of order 1e3.
fn assert_close(value: f64, expected: f64, what: &str) {
    assert!((value - expected).abs() <= 1e-11 * (1.0 + expected.abs()), "{what}: {value} instead of {expected}");
}

#[test]
fn no_law_gives_energy_while_it_resists() {
    at_all_states(|name, law, at, state| {
        let [s, rate] = state.map(|x| at.model.graph.constant(x));
        let dissipated = number(law.dissipation(at, s, rate));
        assert!(dissipated >= 0.0, "{name} at {state:?}: {dissipated} W");
    });
}

#[test]
fn forces_are_those_of_energy_and_resistance() {
    at_all_states(|name, law, at, state| {
        let [s, rate] = state.map(|x| at.model.graph.constant(x));
        let what = format!("{name} at {state:?}");
        let elastic = elastic_force(law, at, s);
        let resistance = law.resistance(at, s, rate);
        assert_close(number(law.force(at, s, rate)), number(elastic + resistance), &what);
        if !at.moving {
            assert_close(number(law.force(at, s, at.zero())), number(elastic), &format!("{what}, without a rate"));
            assert_close(number(law.dissipation(at, s, rate)), number(resistance * rate), &format!("power, {what}"));
        }
    });
}

/// The energy against differences, since the force is derived from it.
#[test]
fn elastic_forces_are_slopes_of_the_energy() {
    /// Distance of the strains from each branch is larger.
    const H: f64 = 1e-6;
    at_all_states(|name, law, at, [strain, _]| {
        let energy = |s: f64| 0.5 * number(law.twice_energy(at, at.model.graph.constant(s)));
        let slope = (energy(strain + H) - energy(strain - H)) / (2.0 * H);
        let force = number(elastic_force(law, at, at.model.graph.constant(strain)));
        // Rounding of energies of order 1e3 J over 2 µm.
        assert!((slope - force).abs() < 1e-6 * (1.0 + force.abs()), "{name} at {strain}: {force} instead of {slope}");
    });
}

#[test]
fn slopes_are_derivatives_of_the_force() {
    const H: f64 = 1e-6;
    at_all_states(|name, law, at, [strain, rate]| {
        let c = |x: f64| at.model.graph.constant(x);
        let [by_strain, by_rate] = law.slopes(at, c(strain), c(rate)).map(number);
        for (stated, derived) in [by_strain, by_rate].into_iter().zip(derived_slopes(law, at, c(strain), c(rate))) {
            assert_close(stated, number(derived), name);
        }
        let force = |s: f64, v: f64| number(law.force(at, c(s), c(v)));
        let differences = [
            (by_strain, (force(strain + H, rate) - force(strain - H, rate)) / (2.0 * H)),
            (by_rate, (force(strain, rate + H) - force(strain, rate - H)) / (2.0 * H)),
        ];
        for (slope, difference) in differences {
            // The third derivative of friction over its width of 0.05 is of order 1e5.
            assert!(
                (slope - difference).abs() < 1e-5 * (1.0 + slope.abs()),
                "{name} at {strain}, {rate}: {slope} instead of {difference}"
            );
        }
        // Friction at rest sticks instead of damping.
        if rate == 0.0 && !at.moving && !law.declines() {
            assert_close(number(law.damping_at_rest(at, c(strain))), by_rate, name);
        }
        assert!(law.declines() || by_rate >= 0.0, "{name} at {strain}, {rate}: damping {by_rate}");
    });
}
