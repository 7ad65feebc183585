//! Rigid drives and rotors against textbook laws of mechanics.

use crane_codegen::program::Inputs;
use crane_tests::dual::Dual;
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::State;
use crane_tests::workspace;

/// About a hundred roundings.
const ROUNDING: f64 = 1e-13;

fn crane(spec: &str) -> Interpreted {
    Interpreted::new(workspace::chain_of("law", spec))
}

/// The state at a time with all prescribed coordinates set.
fn at(crane: &Interpreted, t: f64, q: &[f64], v: &[f64]) -> State {
    let mut state = State { t, q: q.to_vec(), v: v.to_vec() };
    let motions = crane.get("prescribed_motions", &crane.inputs(&state), 0);
    for (j, motion) in crane.prescribed().into_iter().zip(motions.chunks(2)) {
        (state.q[j], state.v[j]) = (motion[0], motion[1]);
    }
    state
}

fn assert_close(value: f64, expected: f64, what: &str) {
    assert!((value - expected).abs() <= ROUNDING * expected.abs().max(1.0), "{what}: {value}, expected {expected}");
}

/// A pendulum of mass m at distance l about a horizontal axis, with a rotor `I_a`.
const PENDULUM: &str = "
format: 1
name: law
links:
  - name: arm
    placement: {transform: {rotation: {x: 90 deg}}}
    joint: revolute
    mass: 3
    com: [0.7, 0, 0]
    inertia: {Ixx: 0.1, Iyy: 0.2, Izz: 0.25}
drives:
  - {coordinate: arm_psi, rigid: true, armature: 0.4, motion: MOTION}
";

/// At constant speed a motor carries only the weight, `m g l cos q`; during the ramp also `(I + m l² + I_a) q̈`.
#[test]
fn a_pendulum_that_turns_at_constant_speed() {
    let crane = crane(&PENDULUM.replace("MOTION", "{speed: {rate: 2.0, from: 0.3, begin: 0.5, ramp: 1.5}}"));
    let inertia = 0.25 + 3.0 * 0.7 * 0.7 + 0.4;
    for t in [0.0, 0.5, 0.9, 1.7, 2.0, 3.0, 47.0] {
        let state = at(&crane, t, &[0.0], &[0.0]);
        let passed: f64 = (t - 0.5_f64).max(0.0);
        let tau = (passed / 1.5).min(1.0);
        let angle = 0.3 + 2.0 * (1.5 * (tau.powi(3) - tau.powi(4) / 2.0) + (passed - 1.5).max(0.0));
        let rate = 2.0 * (3.0 * tau.powi(2) - 2.0 * tau.powi(3));
        let acceleration = 2.0 / 1.5 * 6.0 * tau * (1.0 - tau);
        assert_close(state.q[0], angle, "position");
        assert_close(state.v[0], rate, "rate");
        assert_close(crane.acceleration(&state)[0], acceleration, "acceleration");
        let torque = inertia * acceleration + 3.0 * 9.81 * 0.7 * angle.cos();
        assert_close(crane.vector("drive_forces", &state)[0], torque, "torque");
        assert_close(crane.scalar("drive_power", &state), torque * rate, "power");
    }
    // Without a ramp it has its speed from the start.
    let crane = self::crane(&PENDULUM.replace("MOTION", "{speed: {rate: 2.0}}"));
    for t in [0.0, 5.0] {
        let state = at(&crane, t, &[0.0], &[0.0]);
        assert_eq!((state.q[0], state.v[0], crane.acceleration(&state)[0]), (2.0 * t, 2.0, 0.0));
    }
}

/// At rest the drive holds `∂E_p/∂q`, though its motion begins with an acceleration.
#[test]
fn a_rigid_drive_holds_the_weight_at_rest() {
    let crane = crane(&PENDULUM.replace("MOTION", "{cubic: {from: 0.4, to: 1.4, duration: 2}}"));
    let state = at(&crane, 0.0, &[0.0], &[0.0]);
    let weight = 3.0 * 9.81 * 0.7 * 0.4_f64.cos();
    assert_close(crane.vector("drive_forces_at_rest", &state)[0], weight, "at rest");
    let acceleration = 6.0 / 4.0;
    let started = weight + (0.25 + 3.0 * 0.7 * 0.7 + 0.4) * acceleration;
    assert_close(crane.vector("drive_forces", &state)[0], started, "as it starts");
    assert_eq!(crane.vector("static_residual", &state)[0], 0.0);
    assert_eq!(crane.matrix("tangent_stiffness", &state)[(0, 0)], 1.0);
}

/// Dampers carry nothing at rest, although the motion of their drive is under way at t = 0.
#[test]
fn dampers_are_no_part_of_statics() {
    let spec = PENDULUM.replace("rigid: true", "stiffness: 500, damping: 80");
    let crane = crane(&spec.replace("MOTION", "{speed: {rate: 2.0, begin: -0.5}}"));
    let state = State { t: 0.0, q: vec![0.7], v: vec![0.0] };
    let residual = 3.0 * 9.81 * 0.7 * 0.7_f64.cos() - 500.0 * (1.0 - 0.7);
    assert_close(crane.vector("static_residual", &state)[0], residual, "residual");
}

/// A blade on a hub that turns at Ω, hinged at the distance e from its axis: it flaps at `Ω² (1 + e m r/I)` and lags at
/// `Ω² e m r/I`, with m r its first moment and I its inertia about the hinge.
#[test]
fn a_blade_on_a_turning_hub_is_stiffened_by_its_centrifugal_force() {
    const SPEED: f64 = 7.0;
    for (axis, coordinate, hinged_out) in [("y", "blade_theta", 1.0), ("z", "blade_psi", 0.0)] {
        let crane = crane(
            &format!(
                "
format: 1
name: law
gravity: [0, 0, 0]
links:
  - {{name: hub, joint: revolute, mass: 5, com: [0.1, 0, 0.2], inertia: {{Ixx: 1, Iyy: 1, Izz: 1}}}}
  - name: blade
    placement: {{transform: {{translation: [0.4, 0, 0]}}}}
    joint: {{revolute: {{axis: {axis}}}}}
    mass: 2
    com: [1.5, 0, 0]
    inertia: {{Ixx: 0, Iyy: 0.9, Izz: 0.9}}
drives:
  - {{coordinate: hub_psi, rigid: true, motion: {{speed: {{rate: {SPEED}}}}}}}
"
            )
            .replace("Ixx: 0,", "Ixx: 1e-9,"),
        );
        assert_eq!(crane.chain.coordinates[1].name, coordinate);
        let state = at(&crane, 1.3, &[0.0, 0.0], &[0.0, 0.0]);
        let angle = vec![Dual::new(state.q[0], 0.0), Dual::new(0.0, 1.0)];
        let rates = state.v.iter().map(|rate| Dual::new(*rate, 0.0)).collect();
        let inputs = Inputs::state(Dual::new(state.t, 0.0), angle, rates, vec![]);
        let acceleration = crane.get("forward_dynamics", &inputs, 2)[1];
        let (moment, inertia) = (2.0 * 1.5, 0.9 + 2.0 * 1.5 * 1.5);
        let square = SPEED * SPEED * (hinged_out * (1.0 - 1e-9 / inertia) + 0.4 * moment / inertia);
        assert_close(acceleration.value(), 0.0, "straight out it stays");
        assert_close(-acceleration.derivative(), square, coordinate);
    }
}

/// A driven arm and a load that swings from its end.
const SWINGING: &str = "
format: 1
name: law
links:
  - name: arm
    placement: {transform: {rotation: {x: 90 deg}}}
    joint: revolute
    mass: 3
    com: [0.7, 0, 0]
    inertia: {Ixx: 0.1, Iyy: 0.2, Izz: 0.25}
  - {name: load, placement: {transform: {translation: [1.2, 0, 0]}}, joint: revolute, mass: 2, com: [0, -0.8, 0]}
drives:
  - {coordinate: arm_psi, DRIVE, motion: {quintic: {from: 0, to: 1, duration: 2}}}
damping: {load_psi: 0.3}
";

/// Classical Runge–Kutta steps by the interpreter, prescribed coordinates set after each.
fn after(crane: &Interpreted, start: &State, duration: f64, steps: u32) -> State {
    let h = duration / f64::from(steps);
    let moved = |state: &State, [rate, acceleration]: &[Vec<f64>; 2], h: f64| {
        let add = |x: &[f64], rate: &[f64]| x.iter().zip(rate).map(|(x, rate)| x + h * rate).collect();
        State { t: state.t + h, q: add(&state.q, rate), v: add(&state.v, acceleration) }
    };
    let slope = |state: &State| [state.v.clone(), crane.acceleration(state).as_slice().to_vec()];
    (0..steps).fold(start.clone(), |state, _| {
        let k1 = slope(&state);
        let k2 = slope(&moved(&state, &k1, h / 2.0));
        let k3 = slope(&moved(&state, &k2, h / 2.0));
        let k4 = slope(&moved(&state, &k3, h));
        let mean = |of: usize| {
            let terms = k1[of].iter().zip(&k2[of]).zip(k3[of].iter().zip(&k4[of]));
            terms.map(|((a, b), (c, d))| (a + 2.0 * b + 2.0 * c + d) / 6.0).collect()
        };
        let end = moved(&state, &[mean(0), mean(1)], h);
        at(crane, end.t, &end.q, &end.v)
    })
}

/// The stiffer a drive, the nearer to a rigid one: the differences in load motion and torque fall as 1/s, s being the stiffness.
#[test]
fn a_stiff_drive_tends_to_a_rigid_one() {
    let run = |drive: &str| {
        let crane = crane(&SWINGING.replace("DRIVE", drive));
        let end = after(&crane, &at(&crane, 0.0, &[0.0; 2], &[0.0; 2]), 1.5, 3000);
        (end.q[1], crane.vector("drive_forces", &end)[0])
    };
    let rigid = run("rigid: true");
    // An even stiffer spring would magnify the remaining error of the steps: the reason for rigid drives.
    let [stiff, stiffer] = [1e4, 1e5].map(|s| {
        // A tenth of critical damping, so that the vibration from the start has decayed.
        let (q, torque) = run(&format!("stiffness: {s}, damping: {}", 0.6 * f64::sqrt(s)));
        [q - rigid.0, torque - rigid.1].map(f64::abs)
    });
    assert!(stiff[0] < 2e-2 && stiff[1] < 0.05 * rigid.1.abs(), "{stiff:?} of {rigid:?}");
    for (stiff, stiffer) in stiff.iter().zip(stiffer) {
        assert!((7.0..14.0).contains(&(stiff / stiffer)), "{stiff} to {stiffer}");
    }
}

/// Work of a rigid drive, less what the damper took out, is the energy that the crane gained.
#[test]
fn energy_of_a_rigidly_driven_crane_balances() {
    let crane = crane(&SWINGING.replace("DRIVE", "rigid: true, armature: 2"));
    let energy = |state: &State| crane.scalar("kinetic_energy", state) + crane.scalar("gravity_energy", state);
    let start = at(&crane, 0.0, &[0.0, 0.4], &[0.0; 2]);
    // Simpson's rule over steps of the same order as the method.
    let supplied = |state: &State| crane.scalar("drive_power", state) - crane.scalar("dissipation", state);
    let (mut state, mut work) = (start.clone(), 0.0);
    for _ in 0..300 {
        let middle = after(&crane, &state, 0.005, 4);
        let end = after(&crane, &middle, 0.005, 4);
        work += 0.01 / 6.0 * (supplied(&state) + 4.0 * supplied(&middle) + supplied(&end));
        state = end;
    }
    let gained = energy(&state) - energy(&start);
    assert!(gained.abs() > 10.0, "{gained} J");
    // The h⁴ error of Simpson's rule at a few rad/s.
    assert!((gained - work).abs() < 1e-7 * gained.abs(), "{gained} J against {work} J");
}
