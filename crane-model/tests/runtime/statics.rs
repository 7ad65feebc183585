//! Static equilibrium of cranes written by hand.

use crate::common::{DoublePendulum, Lift};
use crane_model::Text;
use crane_model::statics::{Problem, Settings, Status};

#[test]
fn a_linear_crane_takes_one_step() {
    let lift = Lift::default();
    let equilibrium = Problem::new(&lift).solve();
    assert_eq!(equilibrium.status, Status::Converged);
    assert_eq!(equilibrium.steps(), 1);
    // One division and one subtraction of rounding.
    assert!((equilibrium.q[0] - lift.sag()).abs() < 1e-15, "{:?}", equilibrium.q);
}

#[test]
fn an_equilibrium_follows_the_drives() {
    let lift = Lift::default();
    // The damper of the drive is at rest where the mass moves with it.
    let t = 0.1;
    let equilibrium = Problem::new(&lift).at_time(t).from(&[0.0]).solve();
    assert_eq!(equilibrium.status, Status::Converged);
    let expected = lift.sag() + lift.amplitude * (lift.frequency * t).sin();
    // Rounding errors of forces of 400 N, over 4000 N/m.
    assert!((equilibrium.q[0] - expected).abs() < 1e-15, "{:?}", equilibrium.q);
}

#[test]
fn the_guess_of_a_driven_coordinate_follows_its_drive() {
    let lift = Lift { height: 2.0, ..Lift::default() };
    // Sums of small whole numbers and halves are exact.
    assert_eq!(Problem::new(&lift).guess()[0], 2.0);
    assert_eq!(Problem::new(&Lift::default()).guess()[0], 0.0);
    // A guess that is not the drive's position is intentional.
    assert_eq!(Problem::new(&Lift { height: 2.0, ..Lift::guessed() }).guess()[0], 0.5);
    assert!((Problem::new(&lift).solve().q[0] - lift.sag()).abs() < 1e-15);
}

#[test]
fn newton_converges_quadratically() {
    // A spring at rest at 1 rad against gravity: the second derivative of the residual does not vanish.
    let pendulum = DoublePendulum { stiffness: 40.0, rest: 1.0, ..DoublePendulum::hanging() };
    let equilibrium = Problem::new(&pendulum).settings(&Settings { tolerance: 1e-15, ..Settings::default() }).solve();
    let residuals: Vec<f64> = equilibrium.history.iter().map(|i| i.residual).collect();
    assert!(equilibrium.history[1..].iter().all(|i| (i.fraction - 1.0).abs() < f64::EPSILON), "{residuals:?}");
    // log r_{k+1} / log r_k tends to 2 while r is between the first steps' range and rounding.
    let order = residuals
        .windows(2)
        .filter(|pair| pair[0] < 1e-2 && pair[1] > 1e-14)
        .map(|pair| pair[1].ln() / pair[0].ln())
        .next_back()
        .expect("two residuals within the range of quadratic convergence");
    assert!(order > 1.8, "{order}: {residuals:?}");
}

#[test]
fn a_mass_above_its_joint_is_unstable() {
    let equilibrium = Problem::new(&DoublePendulum::upside_down()).solve();
    assert_eq!(equilibrium.status, Status::Unstable { coordinates: vec![Text::Static("lower")] });
    assert!((equilibrium.q[1] - std::f64::consts::PI).abs() < 1e-9);
    assert_eq!(equilibrium.status.to_string(), "unstable equilibrium in lower");
}

#[test]
fn a_joint_that_nothing_holds_is_singular() {
    let pendulum = DoublePendulum { gravity: 0.0, stiffness: 40.0, ..DoublePendulum::hanging() };
    let equilibrium = Problem::new(&pendulum).solve();
    assert_eq!(equilibrium.status, Status::Singular { coordinates: vec![Text::Static("lower")] });
}

#[test]
fn a_joint_that_is_pushed_and_not_held_is_singular() {
    // No spring resists gravity in the other joint; no step helps from the start.
    let lift = Lift { stiffness: 0.0, ..Lift::default() };
    let equilibrium = Problem::new(&lift).solve();
    assert_eq!(equilibrium.status, Status::Singular { coordinates: vec![Text::Static("lift_z")] });
    assert_eq!(equilibrium.steps(), 0);
}

#[test]
fn a_guess_with_vanishing_stiffness_is_left_behind() {
    // Horizontal rods: K = 0, yet gravity pushes. Both equilibria of a rod are within reach; the status says which one it is.
    let equilibrium = Problem::new(&DoublePendulum::horizontal()).solve();
    let from_vertical = [equilibrium.q[0], equilibrium.q[0] + equilibrium.q[1]];
    // A tolerance of 1e-10 for moments that grow with the angle.
    assert!(from_vertical.iter().all(|angle| angle.sin().abs() < 1e-9), "{equilibrium}: {from_vertical:?}");
    let hang = from_vertical.iter().all(|angle| angle.cos() > 0.0);
    assert_eq!(equilibrium.status == Status::Converged, hang, "{equilibrium}: {from_vertical:?}");
    assert_eq!(matches!(equilibrium.status, Status::Unstable { .. }), !hang, "{equilibrium}: {from_vertical:?}");
}

#[test]
fn too_few_steps_do_not_converge() {
    let equilibrium = Problem::new(&DoublePendulum::hanging())
        .settings(&Settings { iterations: 1, load_steps: 0, ..Settings::default() })
        .solve();
    assert_eq!(equilibrium.status, Status::NotConverged);
    assert_eq!(equilibrium.steps(), 1);
    assert!(equilibrium.history[1].residual < equilibrium.history[0].residual);
}

#[test]
fn continuation_finds_what_newton_misses() {
    // Newton's method goes up, where the stiffness is negative as at the guess; under a growing load the rods sink.
    let equilibrium = Problem::new(&DoublePendulum::toppling()).solve();
    assert_eq!(equilibrium.status, Status::Converged, "{equilibrium}");
    // A tolerance of 1e-10 for moments that grow with the angle.
    assert!(equilibrium.q.iter().all(|angle| angle.abs() < 1e-9), "{:?}", equilibrium.q);
    let without =
        Problem::new(&DoublePendulum::toppling()).settings(&Settings { load_steps: 0, ..Settings::default() }).solve();
    assert!(matches!(without.status, Status::Unstable { .. }) && without.load_steps.is_none(), "{without}");
    let words = equilibrium.to_string();
    let steps = equilibrium.load_steps.expect("load steps");
    assert!(words.contains(&format!("after continuation in {steps} load steps")), "{words}");
}

#[test]
fn a_guess_upside_down_stays_what_it_is() {
    // 0.14 rad off: close enough to be the intended equilibrium.
    let equilibrium = Problem::new(&DoublePendulum::upside_down()).solve();
    assert!(matches!(equilibrium.status, Status::Unstable { .. }) && equilibrium.load_steps.is_none(), "{equilibrium}");
}

#[test]
fn forces_are_measured_against_one_another() {
    // A lift of 1e-30 kg on an equally weak spring: the residual must be small relative to its own weight.
    let lift = Lift { mass: 1e-30, stiffness: 4e-28, damping: 0.0, ..Lift::default() };
    let equilibrium = Problem::new(&lift).solve();
    assert_eq!(equilibrium.status, Status::Converged);
    // One division and one subtraction of rounding.
    assert!((equilibrium.q[0] - lift.sag()).abs() < 1e-15, "{:?}", equilibrium.q);
}

#[test]
fn stiffness_that_rounding_fills_hides_the_equilibrium() {
    // 1e20 N/m times a rounded position of 1 m is 2e4 N, against 98 N of weight; 1e11 N/m leaves 2e-5 N.
    for (stiffness, status) in [(1e20, Status::NotConverged), (1e11, Status::Converged)] {
        let lift = Lift { stiffness, height: 1.1, ..Lift::default() };
        assert_eq!(Problem::new(&lift).solve().status, status, "{stiffness:e}");
    }
}

#[test]
fn overflowing_forces_give_status_overflow() {
    let lift = Lift { mass: f64::MAX, ..Lift::default() };
    let equilibrium = Problem::new(&lift).solve();
    assert_eq!(equilibrium.status, Status::Overflow);
    assert!(equilibrium.to_string().contains("forces overflow"), "{equilibrium}");
}
