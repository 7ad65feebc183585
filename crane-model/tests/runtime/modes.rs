//! Small vibrations of cranes written by hand.

use crate::common::{DoublePendulum, GRAVITY, Lift};
use crane_model::{
    CraneModel, Linearisation,
    modes::{NoModes, SmallMotions, damped, undamped},
};
use nalgebra::{Matrix2, Vector1, Vector2};

fn relative(a: f64, b: f64) -> f64 {
    ((a - b) / b).abs()
}

#[test]
fn equal_double_pendulum_swings_at_two_plus_minus_root_two() {
    let pendulum = DoublePendulum { mass: [1.0; 2], length: [0.5; 2], ..DoublePendulum::hanging() };
    let motions = SmallMotions::from(&pendulum.linearise(&Vector2::zeros()));
    let modes = undamped(&motions).expect("modes");
    for (mode, factor) in modes.iter().zip([2.0 - 2_f64.sqrt(), 2.0 + 2_f64.sqrt()]) {
        // A few roundings of a 2 × 2 eigenproblem.
        assert!(relative(mode.omega_squared, factor * GRAVITY / 0.5) < 1e-14, "{mode:?}");
        let norm = (mode.shape.transpose() * &motions.mass * &mode.shape)[0];
        assert!((norm - 1.0).abs() < 1e-14);
    }
    // The damped solver of the undamped pendulum finds the same, on the imaginary axis.
    for (mode, damped) in modes.iter().zip(damped(&motions).expect("modes")) {
        assert!(relative(damped.eigenvalue.im, mode.omega_squared.sqrt()) < 1e-13, "{damped:?}");
        assert!(damped.damping_ratio().abs() < 1e-13, "{damped:?}");
    }
}

#[test]
fn a_pendulum_upside_down_has_no_frequency() {
    let pendulum = DoublePendulum::hanging();
    let pose = Vector2::new(0.0, std::f64::consts::PI);
    let modes = undamped(&(&pendulum.linearise(&pose)).into()).expect("modes");
    assert!(modes[0].omega_squared < 0.0 && modes[0].frequency().is_none());
    assert!(modes[1].frequency().is_some());
}

#[test]
fn damping_ratio_and_frequency_of_one_mass() {
    let lift = Lift::default();
    let motions = SmallMotions::from(&lift.linearise(&Vector1::zeros()));
    let modes = damped(&motions).expect("modes");
    assert_eq!(modes.len(), 1);
    let omega = (lift.stiffness / lift.mass).sqrt();
    assert!(relative(modes[0].frequency(), omega / std::f64::consts::TAU) < 1e-14);
    assert!(relative(modes[0].damping_ratio(), lift.damping / (2.0 * (lift.stiffness * lift.mass).sqrt())) < 1e-14);
    assert_eq!(modes[0].dominating, [0]);
    let state = motions.state_matrix().expect("a mass");
    let expected = [0.0, -lift.stiffness / lift.mass, 1.0, -lift.damping / lift.mass];
    assert!(state.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{state}");
}

/// A crane without the functions has NaN: the error says so, and does not speak of a mass matrix that is not positive definite.
#[test]
fn small_motions_that_are_no_numbers_are_told() {
    let mut motions = SmallMotions::from(&Lift::default().linearise(&Vector1::zeros()));
    motions.stiffness.fill(f64::NAN);
    assert_eq!(
        [undamped(&motions).err(), damped(&motions).err(), motions.state_matrix().err()],
        [Some(NoModes::NotFinite); 3]
    );
}

#[test]
fn state_blocks_by_hand() {
    // A⁻¹ = [[1, −1], [−1, 2]].
    let linearisation = Linearisation {
        mass: Matrix2::new(2.0, 1.0, 1.0, 1.0),
        stiffness: Matrix2::new(5.0, 2.0, 2.0, 3.0),
        damping: Matrix2::new(1.0, 0.0, 0.0, 4.0),
    };
    let (stiffness, damping) = linearisation.state_blocks().expect("a positive definite mass matrix");
    // A few roundings of numbers of size 1.
    assert!((stiffness - Matrix2::new(-3.0, 1.0, 1.0, -4.0)).amax() < 1e-14, "{stiffness}");
    assert!((damping - Matrix2::new(-1.0, 4.0, 1.0, -8.0)).amax() < 1e-14, "{damping}");
    let massless = Linearisation { mass: Matrix2::new(1.0, 1.0, 1.0, 1.0), ..linearisation };
    assert_eq!(massless.state_blocks(), None);
}
