//! Small motions about poses and steady motions, against textbook laws, differences and the function that is derived for poses at rest.

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::modes::{Held, NotSteady, SmallMotions, damped, damped_with_shapes, steady};
use crane_model::nalgebra::{Complex, DMatrix};
use crane_model::statics::Settings;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("law.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn shipped(name: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    LiveCrane::from_spec(&build::open(path.as_ref()).unwrap()).unwrap()
}

fn assert_close(what: &str, one: &DMatrix<f64>, other: &DMatrix<f64>, tolerance: f64) {
    let size = other.amax();
    let off = (one - other).amax();
    assert!(off <= tolerance * size, "{what}: off by {off:e} of {size:e}");
}

/// At rest both derivations give the same; they share the forces, but not the method of differentiation.
#[test]
fn about_a_pose_at_rest_it_is_the_linearisation_of_statics() {
    for name in ["eight_link_rigid", "eight_link_flexible", "knuckle_boom", "loader_tipping", "cantilever"] {
        let live = shipped(name);
        let crane: &dyn DynCrane = &live;
        let q = crane.equilibrium(&Settings::default()).q;
        let zeros = vec![0.0; q.len()];
        let (here, expected) =
            (SmallMotions::about_motion(&live, 0.0, [&q, &zeros, &zeros]), crane.small_motions_at(&q));
        // Some hundred rounding errors of the largest entry: a support's stiffness next to terms of weights.
        assert_close(name, &here.mass, &expected.mass, 1e-13);
        assert_close(name, &here.stiffness, &expected.stiffness, 1e-13);
        assert_close(name, &here.damping, &expected.damping, 1e-13);
        assert!(here.gyroscopic().amax() <= 1e-13 * here.damping.amax(), "{name}");
    }
}

/// Away from rest there is no second derivation of K and D to compare with, only differences of `A a − e − f`. Forces of this crane are
/// quadratic in the rates, so that differences over any distance are exact to rounding there; in q, Richardson extrapolation leaves an
/// error of h⁴.
#[test]
fn linearisation_equals_differences_about_any_motion() {
    let live = shipped("eight_link_flexible");
    let n = live.size();
    let wave = |scale: f64, rate: f64| move |i: usize| scale * (rate * (i as f64 + 1.0)).sin();
    let crane: &dyn DynCrane = &live;
    let q: Vec<f64> = crane.guess().iter().zip((0..n).map(wave(0.03, 1.3))).map(|(guess, wave)| guess + wave).collect();
    let v: Vec<f64> = (0..n).map(wave(0.4, 0.7)).collect();
    let a: Vec<f64> = (0..n).map(wave(0.9, 1.9)).collect();
    let required = |q: &[f64], v: &[f64]| {
        let (mut bias, mut forces) = (vec![0.0; n], vec![0.0; n]);
        live.bias(q, v, &mut bias);
        live.forces(0.7, q, v, &mut forces);
        let inertia = crane.mass_matrix_at(q) * crane_model::nalgebra::DVector::from_column_slice(&a);
        (0..n).map(|i| inertia[i] - bias[i] - forces[i]).collect::<Vec<f64>>()
    };
    let difference = |of_rates: bool, j: usize, h: f64| -> Vec<f64> {
        let [ahead, behind] = [h, -h].map(|by| {
            let (mut q, mut v) = (q.clone(), v.clone());
            if of_rates {
                v[j] += by;
            } else {
                q[j] += by;
            }
            required(&q, &v)
        });
        ahead.iter().zip(&behind).map(|(ahead, behind)| (ahead - behind) / (2.0 * h)).collect()
    };
    let matrix = |column: &dyn Fn(usize) -> Vec<f64>| DMatrix::from_vec(n, n, (0..n).flat_map(column).collect());
    let of_pose = matrix(&|j| {
        let (coarse, fine) = (difference(false, j, 2e-3), difference(false, j, 1e-3));
        coarse.iter().zip(&fine).map(|(coarse, fine)| (4.0 * fine - coarse) / 3.0).collect()
    });
    let of_rates = matrix(&|j| difference(true, j, 1.0));
    let here = SmallMotions::about_motion(&live, 0.7, [&q, &v, &a]);
    // Rounding error of forces of 1e7 N over 1e-3 rad; the error of h⁴ is below it.
    assert_close("K", &here.stiffness, &of_pose, 1e-9);
    assert_close("D", &here.damping, &of_rates, 1e-12);
    assert!(here.gyroscopic().amax() > 1e-3 * here.mass.amax(), "the motion has gyroscopic forces");
    assert!(here.circulatory().amax() > 1e-3 * here.mass.amax(), "and forces without potential");
}

const RATE: f64 = 5.0;
const LENGTH: f64 = 0.8;
const GRAVITY: f64 = 9.81;

/// A mass on a rod that hangs from a turning shaft; θ is measured from the vertical.
fn spherical_pendulum(drive: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: pendulum\nlinks:\n\
         - {{name: shaft, joint: {{revolute: {{axis: z}}}}, inertia: {{Ixx: 1e-12, Iyy: 1e-12, Izz: 1e-12}}, mass: 1e-9, com: [0, 0, 0]}}\n\
         - {{name: rod, joint: {{revolute: {{axis: y}}}}, mass: 3, com: [0, 0, -{LENGTH}]}}\n{drive}"
    ))
}

/// A pendulum on a shaft at constant speed keeps `cos θ = g/(l Ω²)` and swings about it with `ω² = Ω² sin² θ`; on a shaft that
/// turns freely, whose angular momentum is constant, with `ω² = Ω² (1 + 3 cos² θ)`.
#[test]
fn a_pendulum_on_a_turning_shaft() {
    let angle = f64::acos(GRAVITY / (LENGTH * RATE * RATE));
    let driven = format!("drives:\n- {{coordinate: shaft_psi, rigid: true, motion: {{speed: {{rate: {RATE}}}}}}}\n");
    let squares = [angle.sin().powi(2), 1.0 + 3.0 * angle.cos().powi(2)].map(|square| square * RATE * RATE);
    for (drive, square) in [driven.as_str(), ""].into_iter().zip(squares) {
        let crane = spherical_pendulum(drive);
        let shaft = Held { coordinate: 0, position: None, rate: RATE };
        let held: &[Held] = if drive.is_empty() { &[shaft] } else { &[] };
        // Hanging straight down is a steady motion, too: the search begins nearer to this one.
        let found = steady(&crane, 0.0, &[0.0, 1.0], held).unwrap();
        assert!((found.q[1].abs() - angle).abs() < 1e-12, "{} instead of {angle}", found.q[1]);
        // Nothing depends on the shaft's angle, and nothing has to turn it.
        assert!(found.drift < 1e-9 && found.efforts[0].abs() < 1e-9, "{found:?}");
        let motions = SmallMotions::about_motion(&crane, 0.0, [&found.q, &found.v, &[0.0; 2]]);
        let modes = damped(&motions).unwrap();
        let fastest = modes.last().unwrap().eigenvalue;
        // The shaft's own inertia is 1e-12 of the mass's; a double eigenvalue 0 splits by √ε.
        assert!((fastest.im - square.sqrt()).abs() < 1e-9 && fastest.re.abs() < 1e-9, "{fastest}, ω² = {square}");
    }
}

/// Hanging straight down it loses its stability at Ω² = g/l: `λ² = Ω² − g/l`.
#[test]
fn a_pendulum_on_a_fast_shaft_does_not_hang() {
    let natural = (GRAVITY / LENGTH).sqrt();
    for rate in [0.5 * natural, 1.5 * natural] {
        let crane = spherical_pendulum(&format!(
            "drives:\n- {{coordinate: shaft_psi, rigid: true, motion: {{speed: {{rate: {rate}}}}}}}\n"
        ));
        let found = steady(&crane, 0.0, &[0.0, 0.0], &[]).unwrap();
        let modes = damped(&SmallMotions::about_motion(&crane, 0.0, [&found.q, &found.v, &[0.0; 2]])).unwrap();
        let square = rate * rate - natural * natural;
        let expected = Complex::from(square).sqrt();
        let off = modes.iter().map(|mode| (mode.eigenvalue - expected).norm()).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-12, "{modes:?}, expected {expected}");
    }
}

/// A mass on springs and dampers of two slides that turn with a disc: `λ = −iΩ − δ ± √(2iΩδ + δ² − ω²)`, which is `±i (ω ± Ω)`
/// without dampers. Dampers that turn along make it unstable where Ω > ω.
#[test]
fn a_mass_on_a_turning_disc() {
    let (mass, natural) = (2.0_f64, 4.0_f64);
    for (rate, decay) in [(1.5, 0.0), (1.5, 0.3), (6.0, 0.3)] {
        let (stiffness, damping) = (mass * natural * natural, 2.0 * decay * mass);
        let spring = |name: &str| {
            format!("- {{coordinate: {name}, stiffness: {stiffness}, damping: {damping}, motion: {{hold: 0}}}}\n")
        };
        let crane = crane(&format!(
            "format: 1\nname: disc\nlinks:\n\
             - {{name: disc, joint: {{revolute: {{axis: z}}}}, mass: 1, com: [0, 0, 0], inertia: {{Ixx: 1, Iyy: 1, Izz: 1}}}}\n\
             - {{name: slide, joint: {{prismatic: {{axis: x}}}}}}\n\
             - {{name: mass, joint: {{prismatic: {{axis: y}}}}, mass: {mass}, com: [0, 0, 0]}}\n\
             drives:\n- {{coordinate: disc_psi, rigid: true, motion: {{speed: {{rate: {rate}}}}}}}\n{}{}",
            spring("slide_x"),
            spring("mass_y")
        ));
        let found = steady(&crane, 0.0, &[0.0; 3], &[]).unwrap();
        let motions = SmallMotions::about_motion(&crane, 0.0, [&found.q, &found.v, &[0.0; 3]]);
        // Twice the angular velocity times the mass, and nothing else, is gyroscopic.
        assert!((motions.gyroscopic()[(1, 0)] - 2.0 * mass * rate).abs() < 1e-12);
        let modes = damped_with_shapes(&motions).unwrap();
        let turning = Complex::new(decay, rate);
        let root = (turning * turning + rate * rate - natural * natural).sqrt();
        for expected in [-turning + root, -turning - root] {
            let expected = if expected.im < 0.0 { expected.conj() } else { expected };
            let (off, shape) = modes
                .iter()
                .map(|(mode, shape)| ((mode.eigenvalue - expected).norm(), shape))
                .min_by(|(a, _), (b, _)| a.total_cmp(b))
                .unwrap();
            assert!(off < 1e-12, "Ω = {rate}, δ = {decay}: {modes:?}, expected {expected}");
            // Both slides move with the same amplitude, a quarter of a period apart, with xᴴ A x = 1.
            assert!((shape[0].norm() - shape[1].norm()).abs() < 1e-12 && (shape[1] / shape[0]).re.abs() < 1e-12);
            assert!((mass * shape.norm_squared() - 1.0).abs() < 1e-12);
        }
        let grows = modes.iter().any(|(mode, _)| mode.eigenvalue.re > 1e-3);
        assert_eq!(grows, decay > 0.0 && rate > natural);
    }
}

/// A crane that slews: the load hangs outward by `tan α = Ω² r/g`, r its distance from the axis.
#[test]
fn a_hanging_load_is_flung_outward() {
    let crane = crane(
        "format: 1\nname: slewing\nlinks:\n\
         - {name: column, joint: {revolute: {axis: z}}, mass: 100, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}\n\
         - {name: load, placement: {transform: {translation: [6, 0, 8]}}, joint: {revolute: {axis: y}}, mass: 500, com: [0, 0, -3]}\n\
         drives:\n- {coordinate: column_psi, stiffness: 1e6, damping: 1e4, motion: {trapezoid: {from: 0, to: 4, duration: 10, blend: 0.25}}}\n",
    );
    // In the middle the motion has the constant rate 4/(10 · 0.75).
    let rate = 4.0 / 7.5;
    let found = steady(&crane, 5.0, &[0.0, 0.0], &[]).unwrap();
    assert!((found.v[0] - rate).abs() < 1e-12 && (found.q[0] - 2.0).abs() < 1e-12, "{found:?}");
    let outward = -found.q[1];
    assert!((outward.tan() - rate * rate * (6.0 + 3.0 * outward.sin()) / GRAVITY).abs() < 1e-12, "{outward}");
    assert!(found.drift < 1e-9, "{found:?}");
    // While the drive speeds up, the motion is not steady; held at another angle, it requires the effort of the drive's spring.
    let held = [Held { coordinate: 0, position: Some(2.001), rate }];
    let effort = steady(&crane, 5.0, &[0.0, 0.0], &held).unwrap().efforts[0];
    assert!((effort - 1e6 * 0.001).abs() < 1e-6, "{effort}");
}

/// A motion that begins at the moment in question is steady if its rate is constant from there on; one that speeds up is not.
#[test]
fn a_steady_motion_may_begin_at_the_moment() {
    let at_start = |motion: &str| {
        let crane = crane(&format!(
            "format: 1\nname: slewing\nlinks:\n\
             - {{name: column, joint: {{revolute: {{axis: z}}}}, mass: 100, com: [0, 0, 0], inertia: {{Ixx: 1, Iyy: 1, Izz: 1}}}}\n\
             - {{name: load, placement: {{transform: {{translation: [6, 0, 8]}}}}, joint: {{revolute: {{axis: y}}}}, mass: 500, com: [0, 0, -3]}}\n\
             drives:\n- {{coordinate: column_psi, rigid: true, motion: {{{motion}}}}}\n"
        ));
        steady(&crane, 0.0, &[0.0, 0.0], &[]).unwrap()
    };
    let found = at_start("speed: {rate: 0.5, begin: 0}");
    // Rates of 0.5 differ by rounding, over 1e-4 s.
    assert!((found.v[0] - 0.5).abs() < 1e-15 && found.acceleration < 1e-11 && found.drift < 1e-9, "{found:?}");
    // (6/10²) 4 (1 − 2τ) at τ = 0, to first order in 1e-4 s.
    let found = at_start("cubic: {from: 0, to: 4, duration: 10}");
    assert!((found.acceleration - 0.24).abs() < 1e-4, "{found:?}");
}

/// Nothing constrains the wheel, so there is nothing to find, and the search says how far it came and what is loose; nor does it where a spring
/// holds a second wheel.
#[test]
fn a_free_joint_at_rest_has_no_pose() {
    let crane = crane(
        "format: 1\nname: free\nlinks:\n- {name: wheel, joint: {revolute: {axis: z}}, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}\n",
    );
    assert_eq!(steady(&crane, 0.0, &[0.0], &[]).unwrap_err(), NotSteady { reached: 0.0, loose: Some(0) });
    let two = self::crane(
        "format: 1\nname: two\nlinks:\n- {name: arm, joint: {revolute: {axis: y}}, mass: 1, com: [1, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}\n\
         - {name: wheel, joint: {revolute: {axis: y}}, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}\n\
         drives: [{coordinate: arm_theta, stiffness: 1e6, motion: {hold: 0}}]\n",
    );
    assert_eq!(steady(&two, 0.0, &[0.0; 2], &[]).unwrap_err().loose, Some(1));
}
