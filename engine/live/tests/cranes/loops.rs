//! Joints that close loops, against linkages worked out by hand.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Sample, Settings};
use crane_model::nalgebra::{DMatrix, DVector, Vector3};
use crane_model::{Count, loop_joints, modes, statics};

const GRAVITY: f64 = 9.81;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// A four-bar in the x-z plane: crank, coupler and rocker, whose end is held on the ground. Lengths of the bars and the distance of the pins on
/// the ground, m.
const LENGTHS: [f64; 4] = [0.4, 1.1, 0.9, 1.2];
/// Masses of the bars, kg, slender and homogeneous.
const MASSES: [f64; 3] = [3.0, 8.0, 6.0];
/// The pin of the rocker on the ground, whose axis is −y of the world and z of the bars.
const PIN: &str = "{pin: {axis: [0, 1, 0], to_axis: [0, 0, 1]}}";

fn bar(name: &str, placement: &str, length: f64, mass: f64) -> String {
    format!(
        "- {{name: {name}, placement: {{transform: {{{placement}}}}}, joint: revolute, mass: {mass}, com: [{}, 0, 0], \
         inertia: {{about: com, Ixx: {}, Iyy: {inertia}, Izz: {inertia}}}}}\n",
        0.5 * length,
        mass * length * length / 1200.0,
        inertia = mass * length * length / 12.0,
    )
}

/// The three bars from the origin, their end on the ground held by `joint`, with a guess near the pose at this angle of the crank.
fn four_bar(theta: f64, joint: &str, more: &str) -> LiveCrane {
    let [crank, coupler, rocker, ground] = LENGTHS;
    let FourBar { q: [_, second, third], .. } = FourBar::at(theta);
    crane(&format!(
        "format: 1\nname: four_bar\nanalyses: [statics, dynamics, modes, internal_forces]\nlinks:\n{}{}{}\
         loop_joints: [{{name: hinge, from: {{at: [{ground}, 0, 0]}}, to: {{link: rocker, at: [{rocker}, 0, 0]}}, joint: {joint}}}]\n\
         guess: {{coupler_psi: {}, rocker_psi: {}}}\n{more}",
        bar("crank", "rotation: {x: 90 deg}", crank, MASSES[0]),
        bar("coupler", &format!("translation: [{crank}, 0, 0]"), coupler, MASSES[1]),
        bar("rocker", &format!("translation: [{coupler}, 0, 0]"), rocker, MASSES[2]),
        second + 0.02,
        third - 0.03
    ))
}

/// A four-bar at an angle of its crank, by hand.
struct FourBar {
    /// Joint angles.
    q: [f64; 3],
    /// Rates of the absolute angles of the bars per rate of the crank.
    ratios: [f64; 3],
    /// Kinetic energy is `½ inertia θ̇²`; potential energy, J.
    inertia: f64,
    potential: f64,
}

impl FourBar {
    /// Freudenstein's equation for the angle ψ of the rocker at the ground, on the open branch:
    /// `K₁ cos ψ − K₂ cos θ + K₃ = cos(θ − ψ)` with `K₁ = d/a`, `K₂ = d/c`, `K₃ = (a² − b² + c² + d²)/2ac`.
    fn at(theta: f64) -> Self {
        let [a, b, c, d] = LENGTHS;
        let (k1, k2, k3) = (d / a, d / c, (a * a - b * b + c * c + d * d) / (2.0 * a * c));
        // With t = tan(ψ/2) it is a quadratic equation: A t² + B t + C = 0.
        let big_a = theta.cos() - k1 - k2 * theta.cos() + k3;
        let big_b = -2.0 * theta.sin();
        let big_c = k1 - (k2 + 1.0) * theta.cos() + k3;
        let root = (big_b * big_b - 4.0 * big_a * big_c).sqrt();
        let psi = 2.0 * ((-big_b - root) / (2.0 * big_a)).atan();
        let end = [d + c * psi.cos(), c * psi.sin()];
        let begin = [a * theta.cos(), a * theta.sin()];
        let coupler = (end[1] - begin[1]).atan2(end[0] - begin[0]);
        let rocker = (-end[1]).atan2(d - end[0]);
        // a e'(θ) + b e'(coupler) w₂ + c e'(rocker) w₃ = 0, along the coupler and along the rocker.
        let second = a * (theta - rocker).sin() / (b * (rocker - coupler).sin());
        let third = a * (theta - coupler).sin() / (c * (coupler - rocker).sin());
        let ratios = [1.0, second, third];
        let directions = [theta, coupler, rocker];
        let (mut inertia, mut potential) = (0.0, 0.0);
        let (mut origin, mut speed) = ([0.0; 2], [0.0; 2]);
        for ((length, mass), (direction, ratio)) in LENGTHS.iter().zip(MASSES).zip(directions.iter().zip(ratios)) {
            let (sin, cos) = direction.sin_cos();
            let middle = [speed[0] - 0.5 * length * sin * ratio, speed[1] + 0.5 * length * cos * ratio];
            inertia += mass * (middle[0].powi(2) + middle[1].powi(2)) + mass * length * length / 12.0 * ratio * ratio;
            potential += mass * GRAVITY * (origin[1] + 0.5 * length * sin);
            origin = [origin[0] + length * cos, origin[1] + length * sin];
            speed = [speed[0] - length * sin * ratio, speed[1] + length * cos * ratio];
        }
        Self { q: [theta, coupler - theta, rocker - coupler], ratios, inertia, potential }
    }

    /// `θ̈ = −(½ I' θ̇² + V')/I`, with central differences of I and V.
    fn acceleration(theta: f64, rate: f64) -> f64 {
        const STEP: f64 = 1e-4;
        // Of order 4: the error is 1e-13 of the energies.
        let [far, near, after, beyond] = [-2.0, -1.0, 1.0, 2.0].map(|k| Self::at(theta + k * STEP));
        let slope = |of: fn(&Self) -> f64| (8.0 * (of(&after) - of(&near)) - (of(&beyond) - of(&far))) / (12.0 * STEP);
        let (inertia, potential) = (slope(|bar| bar.inertia), slope(|bar| bar.potential));
        -(0.5 * inertia * rate * rate + potential) / Self::at(theta).inertia
    }

    /// Angle and rate of the crank after some time, by RK4 with steps of 0.2 ms.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand steps")]
    fn after(time: f64, mut theta: f64, mut rate: f64) -> [f64; 2] {
        let steps = (time / 2e-4).round() as usize;
        let h = time / steps as f64;
        for _ in 0..steps {
            let f = |x: f64, v: f64| (v, Self::acceleration(x, v));
            let (x1, v1) = f(theta, rate);
            let (x2, v2) = f(theta + 0.5 * h * x1, rate + 0.5 * h * v1);
            let (x3, v3) = f(theta + 0.5 * h * x2, rate + 0.5 * h * v2);
            let (x4, v4) = f(theta + h * x3, rate + h * v3);
            theta += h / 6.0 * (x1 + 2.0 * (x2 + x3) + x4);
            rate += h / 6.0 * (v1 + 2.0 * (v2 + v3) + v4);
        }
        [theta, rate]
    }
}

/// The largest gap at a pose, m.
fn gap(crane: &dyn DynCrane, q: &[f64], v: &[f64]) -> [f64; 2] {
    let mut states = vec![Vector3::zeros(); crane.loop_equations()];
    crane.loop_states(q, v, &mut states);
    let most = |of: fn(&Vector3<f64>) -> f64| states.iter().map(|state| of(state).abs()).fold(0.0, f64::max);
    [most(|state| state.x), most(|state| state.y)]
}

/// Runs to the end and returns the last pose and rates.
fn end(
    crane: &dyn DynCrane,
    settings: &Settings,
    start: &InitialState,
    see: &mut dyn FnMut(&Sample<'_>),
) -> [Vec<f64>; 2] {
    let mut last = [Vec::new(), Vec::new()];
    let run = crane.simulate(start, settings, &mut |sample: &Sample<'_>| {
        see(sample);
        last = [sample.q.to_vec(), sample.v.to_vec()];
        ControlFlow::Continue(())
    });
    run.unwrap_or_else(|stopped| panic!("{stopped}"));
    last
}

/// One second with a method, at steps or a tolerance that leave little error.
pub(crate) fn one_second(crane: &dyn DynCrane, method: Method) -> Settings {
    Settings {
        method,
        duration: 1.0,
        step: 1e-3,
        output: 0.01,
        tolerance: 1e-9,
        ..Settings::from_description(crane.description())
    }
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn angles_of_a_four_bar_are_those_of_freudenstein() {
    for theta in [0.3, 0.8, 1.7, 2.9, -1.2] {
        let held = format!("drives: [{{coordinate: crank_psi, rigid: true, motion: {{hold: {theta}}}}}]\n");
        for joint in ["ball", PIN] {
            let bars = four_bar(theta, joint, &held);
            let bars: &dyn DynCrane = &bars;
            let equilibrium = bars.equilibrium(&statics::Settings::default());
            assert!(equilibrium.is_stable(), "{joint} at {theta}: {equilibrium}");
            // Rounding of angles about 1 that lengths about 1 m determine.
            assert!(
                difference(&equilibrium.q, &FourBar::at(theta).q) < 1e-12,
                "{joint} at {theta}: {:?}",
                equilibrium.q
            );
        }
    }
}

#[test]
fn a_four_bar_moves_as_lagranges_equation_in_one_coordinate() {
    let theta = 0.8;
    let bars = four_bar(theta, PIN, "");
    let bars: &dyn DynCrane = &bars;
    let start = FourBar::at(theta);
    let rate = 1.5;
    let v = [rate, (start.ratios[1] - 1.0) * rate, (start.ratios[2] - start.ratios[1]) * rate];
    let accelerations = bars.accelerations_at(0.0, &start.q, &v);
    let expected = FourBar::acceleration(theta, rate);
    assert!((accelerations[0] - expected).abs() < 1e-9, "{} {expected}", accelerations[0]);
    let state = InitialState { q: start.q.to_vec(), v: v.to_vec(), x: Vec::new() };
    let expected = FourBar::after(1.0, theta, rate);
    for (method, accuracy) in
        [(Method::Rk4, 1e-8), (Method::DormandPrince, 1e-6), (Method::Rosenbrock, 1e-6), (Method::Bdf, 2e-5)]
    {
        let settings = one_second(bars, method);
        let mut worst = [0.0_f64; 2];
        let [q, v] = end(bars, &settings, &state, &mut |sample| {
            let here = gap(bars, sample.q, sample.v);
            worst = [worst[0].max(here[0]), worst[1].max(here[1])];
        });
        assert!(worst[0] < 1e-12 && worst[1] < 1e-9, "{method}: gaps of {worst:?}");
        assert!((q[0] - expected[0]).abs() < accuracy, "{method}: {} {}", q[0], expected[0]);
        assert!((v[0] - expected[1]).abs() < 10.0 * accuracy, "{method}: {} {}", v[0], expected[1]);
    }
}

#[test]
fn redundant_equations_of_a_plane_loop_are_named() {
    let bars = four_bar(0.8, PIN, "");
    let bars: &dyn DynCrane = &bars;
    let q = bars.guess();
    assert_eq!(
        loop_joints::undetermined(bars, &q),
        ["pin hinge along y", "pin hinge about z", "pin hinge about x"],
        "{:?}",
        loop_joints::cautions(bars, &q)
    );
    let ball = four_bar(0.8, "ball", "");
    let ball: &dyn DynCrane = &ball;
    assert_eq!(loop_joints::undetermined(ball, &ball.guess()), ["ball hinge along y"]);
}

/// A drive of stiffness k at the crank, which rests at θ: `k (θ_dr − θ) = V'(θ)`, `ω² = (k + V'')/I`.
#[test]
fn rest_and_vibration_are_those_of_one_coordinate() {
    let (theta, stiffness) = (0.8, 400.0);
    let slope = -FourBar::acceleration(theta, 0.0) * FourBar::at(theta).inertia;
    let aim = theta + slope / stiffness;
    let driven = format!("drives: [{{coordinate: crank_psi, stiffness: {stiffness}, motion: {{hold: {aim}}}}}]\n");
    let bars = four_bar(theta, PIN, &driven);
    let bars: &dyn DynCrane = &bars;
    let equilibrium = bars.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    let here = FourBar::at(theta);
    // Differences of order 4 in the reference leave 1e-10.
    assert!(difference(&equilibrium.q, &here.q) < 1e-9, "{:?} {:?}", equilibrium.q, here.q);
    assert!((bars.drive_efforts_at_rest(&equilibrium.q)[0] - slope).abs() < 1e-6);

    let motions = bars.small_motions_at(&equilibrium.q);
    let modes = modes::undamped(&motions).expect("modes");
    assert_eq!(modes.len(), 1);
    let force = |x: f64| -FourBar::acceleration(x, 0.0) * FourBar::at(x).inertia;
    let curvature = (force(theta + 1e-4) - force(theta - 1e-4)) / 2e-4;
    let expected = (stiffness + curvature) / here.inertia;
    assert!((modes[0].omega_squared / expected - 1.0).abs() < 1e-6, "{} {expected}", modes[0].omega_squared);
    let shape = &modes[0].shape;
    let absolute = [shape[0], shape[0] + shape[1], shape[0] + shape[1] + shape[2]];
    assert!(difference(&absolute.map(|x| x / shape[0]), &here.ratios) < 1e-9);

    let lambda = bars.loop_forces_at_rest(&equilibrium.q);
    let weight: f64 = MASSES.iter().sum::<f64>() * GRAVITY;
    let wrenches = bars.internal_forces_at(0.0, &equilibrium.q, &[0.0; 3], &[0.0; 3]);
    // The ground carries the weight together with the pin; λ is the force of the rocker on the ground.
    assert!((wrenches[0].force.z + lambda[2] + weight).abs() < 1e-6 * weight, "{wrenches:?} {lambda:?} {weight}");
    assert!((wrenches[0].force.x + lambda[0]).abs() < 1e-6 * weight, "{wrenches:?} {lambda:?}");
}

#[test]
fn rk4_keeps_its_order() {
    let bars = four_bar(0.8, PIN, "");
    let bars: &dyn DynCrane = &bars;
    let state = InitialState { q: FourBar::at(0.8).q.to_vec(), v: vec![0.0; 3], x: Vec::new() };
    let expected = FourBar::after(1.0, 0.8, 0.0);
    let errors: Vec<f64> = [0.02, 0.01, 0.005]
        .map(|step| {
            let settings = Settings {
                method: Method::Rk4,
                duration: 1.0,
                step,
                output: 0.1,
                ..Settings::from_description(bars.description())
            };
            let [q, _] = end(bars, &settings, &state, &mut |_| {});
            (q[0] - expected[0]).abs()
        })
        .to_vec();
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        // Order 4 gives 16; errors of order 5 are still visible here.
        assert!((13.0..30.0).contains(&ratio), "{errors:?}");
    }
}

#[test]
fn energy_is_kept_over_ten_seconds() {
    let bars = four_bar(0.8, PIN, "");
    let bars: &dyn DynCrane = &bars;
    let q = FourBar::at(0.8).q.to_vec();
    let energy = |q: &[f64], v: &[f64]| bars.energies_at(0.0, q, v).total();
    let before = energy(&q, &[0.0; 3]);
    let settings = Settings {
        method: Method::Rk4,
        duration: 10.0,
        step: 1e-3,
        output: 0.1,
        ..Settings::from_description(bars.description())
    };
    let state = InitialState { q, v: vec![0.0; 3], x: Vec::new() };
    let (mut worst, mut open) = (0.0_f64, 0.0_f64);
    end(bars, &settings, &state, &mut |sample| {
        worst = worst.max((energy(sample.q, sample.v) - before).abs());
        open = open.max(gap(bars, sample.q, sample.v)[0]);
    });
    assert!(worst < 1e-3 && open < 1e-12, "energy {worst} J, gap {open} m");
}

/// Two parallel cranks of equal length carry a platform that does not turn.
#[test]
fn a_parallelogram_keeps_the_orientation_of_its_platform() {
    let (arm, width) = (1.3, 0.7);
    let parallel = crane(&format!(
        "format: 1\nname: parallel\nlinks:\n{}{}{}\
         loop_joints: [{{name: hinge, from: {{at: [{width}, 0, 0]}}, to: {{link: back, at: [{arm}, 0, 0]}}, joint: {PIN}}}]\n\
         drives: [{{coordinate: front_psi, rigid: true, motion: {{quintic: {{from: 0.4, to: 1.9, duration: 2}}}}}}]\n\
         guess: {{platform_psi: -0.4, back_psi: {}}}\n",
        bar("front", "rotation: {x: 90 deg}", arm, 20.0),
        bar("platform", &format!("translation: [{arm}, 0, 0]"), width, 30.0),
        bar("back", &format!("translation: [{width}, 0, 0]"), arm, 20.0),
        0.4 - PI,
    ));
    let parallel: &dyn DynCrane = &parallel;
    let settings = Settings {
        method: Method::Bdf,
        duration: 2.0,
        output: 0.05,
        tolerance: 1e-6,
        ..Settings::from_description(parallel.description())
    };
    let state = InitialState::at_rest(parallel.guess());
    let [q, _] = end(parallel, &settings, &state, &mut |sample| {
        assert!((sample.q[0] + sample.q[1]).abs() < 1e-12, "{:?}", sample.q);
    });
    assert!((q[0] - 1.9).abs() < 1e-12);
}

/// φ̇ is J q̇ and the derivative of φ along the motion, and J̇ q̇ that of J q̇: on a bent beam, a slide and joints about several axes, between two
/// links and between a link and the world.
#[test]
fn rates_of_gaps_are_their_derivatives() {
    const STEP: f64 = 1e-5;
    let joints = [
        ("ball", "ball"),
        ("pin", "{pin: {axis: [0.3, 1, -0.2], to_axis: [0.1, 0.9, 0.4]}}"),
        ("rod", "{rod: {length: 2}}"),
        ("guide", "{slide: {axis: [1, 2, 3]}}"),
    ];
    let all: Vec<String> = joints
        .iter()
        .flat_map(|(name, joint)| {
            let ends = [
                ("link: column, at: [0.2, 0.1, 0.3]", "link: arm, at: [0.7, 0.1, -0.2]"),
                ("at: [1, 2, 0.5]", "link: arm, at: [0.3, 0, 0.4]"),
                ("link: arm, at: [0.1, 0, 0]", "link: boom, at: [1.1, 0.1, 0]"),
            ];
            ends.into_iter().enumerate().map(move |(index, (from, to))| {
                format!("  - {{name: {name}_{index}, from: {{{from}}}, to: {{{to}}}, joint: {joint}}}\n")
            })
        })
        .collect();
    let crane = crane(&format!(
        "format: 1\nname: bent\nmaterials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850}}}}\nlinks:
  - {{name: column, joint: revolute, mass: 100, com: [0, 0, 0.5], inertia: {{Ixx: 10, Iyy: 10, Izz: 10}}}}
  - {{name: boom, placement: {{transform: {{rotation: {{x: 90 deg}}, translation: [0, 0, 1]}}}}, joint: revolute,
     beam: {{length: 2, sections: 2, material: steel, section: {{box: {{height: 0.2, width: 0.1, thickness: 0.01}}}}}}}}
  - {{name: slide, placement: {{transform: {{rotation: {{y: 40 deg}}}}}}, joint: {{prismatic: {{axis: x}}}}, mass: 20, com: [0, 0, 0]}}
  - {{name: arm, joint: {{revolute: {{axis: y}}}}, mass: 50, com: [0.5, 0, 0], inertia: {{Ixx: 5, Iyy: 5, Izz: 5}}}}
loop_joints:\n{}",
        all.concat()
    ));
    let crane: &dyn DynCrane = &crane;
    let n = crane.size();
    let q: Vec<f64> = (0..n).map(|i| 0.4 * (1.3 * i as f64 + 0.2).sin()).collect();
    let v: Vec<f64> = (0..n).map(|i| (0.7 * i as f64 - 0.5).cos()).collect();
    let count = crane.loop_equations();
    assert_eq!(count, 3 * (3 + 5 + 1 + 2));
    let at = |time: f64| {
        let moved: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + time * v).collect();
        let (mut states, mut rows) = (vec![Vector3::zeros(); count], vec![0.0; count * n]);
        crane.loop_states(&moved, &v, &mut states);
        crane.loop_jacobians(&moved, &mut rows);
        (states, rows)
    };
    let (states, rows) = at(0.0);
    let [before, after] = [-STEP, STEP].map(|time| at(time).0);
    for (row, state) in states.iter().enumerate() {
        let along: f64 = rows[row * n..][..n].iter().zip(&v).map(|(entry, v)| entry * v).sum();
        // Sums of a dozen numbers of order 1, and differences that are exact to 1e-10 of order 1.
        assert!((state.y - along).abs() < 1e-12, "equation {row}");
        let slope = (after[row] - before[row]) / (2.0 * STEP);
        assert!(
            (state.y - slope.x).abs() < 1e-8 && (state.z - slope.y).abs() < 1e-8,
            "equation {row}: {state} {slope}"
        );
    }
}

/// A slider-crank: `x = a cos θ + √(b² − a² sin² θ)`.
#[test]
fn a_point_slides_on_a_line() {
    let (a, b) = (0.3_f64, 0.9_f64);
    for theta in [0.4_f64, 1.3, 2.6] {
        let slider = crane(&format!(
            "format: 1\nname: slider\nlinks:\n{}{}\
             points: [{{name: end, link: rod, at: [{b}, 0, 0]}}]\n\
             loop_joints: [{{name: guide, from: {{at: [0, 0, 0]}}, to: {{link: rod, at: [{b}, 0, 0]}}, joint: {{slide: {{axis: [1, 0, 0]}}}}}}]\n\
             drives: [{{coordinate: crank_psi, rigid: true, motion: {{hold: {theta}}}}}]\n\
             guess: {{rod_psi: {}}}\n",
            bar("crank", "rotation: {x: 90 deg}", a, 2.0),
            bar("rod", &format!("translation: [{a}, 0, 0]"), b, 4.0),
            -theta - 0.1,
        ));
        let slider: &dyn DynCrane = &slider;
        let equilibrium = slider.equilibrium(&statics::Settings::default());
        assert!(equilibrium.is_stable(), "{equilibrium}");
        let expected = a * theta.cos() + (b * b - (a * theta.sin()).powi(2)).sqrt();
        let end = slider.points_at(&equilibrium.q)[0];
        assert!((end - Vector3::new(expected, 0.0, 0.0)).norm() < 1e-13, "{end}");
    }
}

/// The difference of a rod from a spring is proportional to the compliance.
#[test]
fn a_rod_is_the_limit_of_stiff_springs() {
    let arms = |between: &str| {
        crane(&format!(
            "format: 1\nname: arms\nlinks:\n{}{}drives: [{{coordinate: one_psi, stiffness: 300, motion: {{hold: 0.5}}}}]\n\
             guess: {{other_psi: -1.2}}\n{between}",
            bar("one", "rotation: {x: 90 deg}", 1.0, 5.0),
            bar("other", "translation: [1, 0, 0]", 1.0, 5.0),
        ))
    };
    let ends = "from: {at: [1.1, 0.2, 0.1]}, to: {link: other, at: [1, 0, 0.05]}";
    let pose = |crane: LiveCrane, start: Option<&[f64]>| {
        let crane: &dyn DynCrane = &crane;
        let start = start.map_or_else(|| crane.guess(), <[f64]>::to_vec);
        let equilibrium = statics::Problem::new(crane).from(&start).solve();
        assert!(equilibrium.is_stable(), "{equilibrium}");
        equilibrium.q
    };
    let exact = pose(arms(&format!("loop_joints: [{{name: tie, {ends}, joint: {{rod: {{length: 0.8}}}}}}]\n")), None);
    let differences: Vec<f64> = [1e6, 1e8, 1e12]
        .map(|stiffness| {
            let spring = format!(
                "connectors: [{{name: tie, {ends}, law: {{spring: {{stiffness: {stiffness}, length: 0.8}}}}}}]\n"
            );
            difference(&pose(arms(&spring), Some(&exact)), &exact)
        })
        .to_vec();
    assert!((differences[0] / differences[1] / 100.0 - 1.0).abs() < 1e-3, "{differences:?}");
    // The rest is rounding of lengths, which the spring turns into forces.
    assert!(differences[2] < 3.0 * differences[0] * 1e-6 + 1e-12, "{differences:?}");
}

fn diagnosis_advice(crane: &dyn DynCrane, equilibrium: &statics::Equilibrium) -> String {
    statics::Diagnosis::new(crane, equilibrium).advice()
}

/// An axis that is written in one frame only is 90° off in the other, which is turned: about two directions, whose sines are one together.
#[test]
fn axes_that_differ_are_named_with_their_angle() {
    let turned = four_bar(0.8, "{pin: {axis: [0, 1, 0]}}", "");
    let turned: &dyn DynCrane = &turned;
    let equilibrium = turned.equilibrium(&statics::Settings::default());
    let diagnosis = statics::Diagnosis::new(turned, &equilibrium);
    let mut states = vec![Vector3::zeros(); turned.loop_equations()];
    turned.loop_states(&equilibrium.q, &[0.0; 3], &mut states);
    let sines = [states[3].x, states[4].x];
    assert!((sines[0].hypot(sines[1]) - 1.0).abs() < 1e-9, "{sines:?}");
    let angle = sines[0].abs().max(sines[1].abs()).asin().to_degrees();
    assert!(
        diagnosis.to_string().contains(&format!("the axes of joint hinge differ by {angle:.3}° about")),
        "{diagnosis}"
    );
    assert!(diagnosis.advice().starts_with("write `to_axis`, the axis of hinge"), "{}", diagnosis.advice());
}

/// A loop that cannot be closed says which joint is open, and by how much: the bars are too short by 0.1 m.
#[test]
fn a_loop_that_cannot_close_says_so() {
    let short = crane(&format!(
        "format: 1\nname: short\nlinks:\n{}{}\
         loop_joints: [{{name: hinge, from: {{at: [2.1, 0, 0]}}, to: {{link: other, at: [1, 0, 0]}}, joint: ball}}]\n\
         guess: {{one_psi: 0.4, other_psi: -0.6}}\n",
        bar("one", "rotation: {x: 90 deg}", 1.0, 5.0),
        bar("other", "translation: [1, 0, 0]", 1.0, 5.0),
    ));
    let short: &dyn DynCrane = &short;
    let equilibrium = short.equilibrium(&statics::Settings::default());
    assert!(!equilibrium.is_stable());
    let diagnosis = statics::Diagnosis::new(short, &equilibrium).to_string();
    assert!(diagnosis.contains("joint hinge is open by 100.0"), "{diagnosis}");
    assert!(diagnosis_advice(short, &equilibrium).contains("write a `guess:`"));
    assert!(loop_joints::cautions(short, &equilibrium.q).iter().all(|caution| !caution.contains("reactions")));
    let run = short.simulate(
        &InitialState::at_rest(short.guess()),
        &Settings::from_description(short.description()),
        &mut |_| ControlFlow::Continue(()),
    );
    let stopped = run.expect_err("an open loop").to_string();
    assert!(stopped.contains("hinge along x is open by 100.0"), "{stopped}");
}

/// Rocker and link of a cylinder as bars of a loop, light compared with the jib, against the linkage in closed form: the pin of the jib on the boom
/// closes the loop, and a stiff spring takes the place of the cylinder.
#[test]
fn light_bars_are_the_linkage_of_a_cylinder() {
    const FOOT: [f64; 2] = [-1.6, 0.3];
    const PIVOT: [f64; 2] = [-0.3, 0.02];
    const HEAD: [f64; 2] = [0.3, -0.1];
    let (rocker, link, angle) = (0.46, 0.6, -0.2);
    let jib = |com: [f64; 2]| {
        format!("mass: 900, com: [{}, {}, 0], inertia: {{about: com, Ixx: 30, Iyy: 300, Izz: 300}}", com[0], com[1])
    };
    let boom =
        "- {name: boom, placement: {transform: {rotation: {x: 90 deg}}}, joint: fixed, mass: 10, com: [0, 0, 0]}\n";
    let closed = crane(&format!(
        "format: 1\nname: closed\nlinks:\n{boom}- {{name: jib, joint: revolute, {}}}\n\
         drives: [{{coordinate: jib_psi, rigid: true, motion: {{hold: {angle}}}}}]\n\
         cylinders:\n- {{name: knuckle, coordinate: jib_psi, foot: {{link: boom, at: [{}, {}, 0]}}, head: {{link: jib, at: [{}, {}, 0]}}, \
         linkage: {{pivot: [{}, {}, 0], rocker: {rocker}, link: {link}, side: left}}, bore: 0.1, rod: 0.06, retracted: 1, stroke: 1}}\n",
        jib([3.0, 0.0]),
        FOOT[0],
        FOOT[1],
        HEAD[0],
        HEAD[1],
        PIVOT[0],
        PIVOT[1],
    ));
    let closed: &dyn DynCrane = &closed;
    let mut states = [Vector3::zeros()];
    closed.cylinder_states(&[angle], &[1.0], &mut states);
    let torque = closed.drive_efforts_at_rest(&[angle])[0];
    let (length, arm) = (states[0].x, states[0].z);
    // The rod's pin B, on the left of the way from the pivot to the head.
    let (sin, cos) = angle.sin_cos();
    let head = [cos * HEAD[0] - sin * HEAD[1], sin * HEAD[0] + cos * HEAD[1]];
    let way = [head[0] - PIVOT[0], head[1] - PIVOT[1]];
    let distance = way[0].hypot(way[1]);
    let along = (distance * distance + rocker * rocker - link * link) / (2.0 * distance);
    let aside = (rocker * rocker - along * along).sqrt();
    let pin = [(along * way[0] - aside * way[1]) / distance, (along * way[1] + aside * way[0]) / distance];
    let to_head = [way[0] - pin[0], way[1] - pin[1]];
    let (of_rocker, of_link) = (pin[1].atan2(pin[0]), to_head[1].atan2(to_head[0]));
    let force_at = |mass: f64| {
        let stiffness = 1e9;
        let loops = crane(&format!(
            "format: 1\nname: loops\nlinks:\n{boom}{}{}\
             - {{name: jib, placement: {{transform: {{translation: [{link}, 0, 0]}}}}, joint: revolute, {}}}\n\
             loop_joints: [{{name: hinge, from: {{link: boom, at: [0, 0, 0]}}, to: {{link: jib, at: [{}, {}, 0]}}, joint: {{pin: {{axis: [0, 0, 1]}}}}}}]\n\
             connectors: [{{name: cylinder, from: {{link: boom, at: [{}, {}, 0]}}, to: {{link: rocker, at: [{rocker}, 0, 0]}}, \
             law: {{spring: {{stiffness: {stiffness}, length: {}}}}}}}]\n\
             guess: {{rocker_psi: {of_rocker}, link_psi: {}, jib_psi: {}}}\n",
            bar("rocker", &format!("translation: [{}, {}, 0]", PIVOT[0], PIVOT[1]), rocker, mass),
            bar("link", &format!("translation: [{rocker}, 0, 0]"), link, mass),
            jib([3.0 - HEAD[0], -HEAD[1]]),
            -HEAD[0],
            -HEAD[1],
            FOOT[0],
            FOOT[1],
            length + torque / arm / stiffness,
            of_link - of_rocker,
            angle - of_link,
        ));
        let loops: &dyn DynCrane = &loops;
        let equilibrium = loops.equilibrium(&statics::Settings::default());
        assert!(equilibrium.is_stable(), "{equilibrium}");
        let q = &equilibrium.q;
        // The spring is as long as the cylinder where it carries the same force.
        assert!((q.iter().sum::<f64>() - angle).abs() < 1e-6, "{q:?}");
        let tension = loops.connector_tensions_at(0.0, q, &[0.0; 3])[0].force;
        // Rates that leave the loop closed, by unit rate of the jib on the boom.
        let motions = loops.small_motions_at(q);
        let shape = &modes::undamped(&motions).expect("modes")[0].shape;
        let rate = loops.connector_lengths_at(q, shape.as_slice())[0][1] / shape.sum();
        (tension, rate)
    };
    let (tension, rate) = force_at(1e-6);
    // The bars' weight is 1e-10 of the force.
    assert!((rate / arm - 1.0).abs() < 1e-9, "{rate} {arm}");
    assert!((-tension / (torque / arm) - 1.0).abs() < 1e-9, "{tension} {}", torque / arm);
    // Heavier bars change the force in proportion to their mass.
    let (one, two) = (force_at(1.0).0 - tension, force_at(2.0).0 - tension);
    assert!((two / one - 2.0).abs() < 1e-3 && one.abs() > 1.0, "{one} {two}");
}

/// Potential energy of the example `parallel_harvester` at an angle of its boom and an extension of its parallel cylinder, J, and the place of its tip
/// in the plane, m: from the triangle of the jib's pin, its lever and the cylinder's pin on the column.
fn harvester(theta: f64, extension: f64) -> (f64, [f64; 2]) {
    const LEVER: [f64; 2] = [-0.4, 0.06];
    const COLUMN: [f64; 2] = [-0.23, 2.19];
    let along = |[x, z]: [f64; 2], angle: f64, [u, w]: [f64; 2]| {
        let (sin, cos) = angle.sin_cos();
        [x + cos * u - sin * w, z + sin * u + cos * w]
    };
    let pin = [0.1, 1.6];
    let hinge = along(pin, theta, [4.0, 0.0]);
    let length = 3.4 + extension;
    let way = [COLUMN[0] - hinge[0], COLUMN[1] - hinge[1]];
    let (distance, lever) = (way[0].hypot(way[1]), LEVER[0].hypot(LEVER[1]));
    let turn = ((distance * distance + lever * lever - length * length) / (2.0 * distance * lever)).acos();
    let phi = way[1].atan2(way[0]) - turn - LEVER[1].atan2(LEVER[0]);
    let end = along(hinge, phi, LEVER);
    let of_rod = (COLUMN[1] - end[1]).atan2(COLUMN[0] - end[0]);
    let tip = along(hinge, phi, [4.6, 0.0]);
    let weights = [
        (900.0, 0.8),
        (520.0, along(pin, theta, [1.9, 0.05])[1]),
        (380.0, along(hinge, phi, [1.9, 0.0])[1]),
        (1200.0, tip[1]),
        (60.0, along(end, of_rod, [0.8, 0.0])[1]),
        (110.0, along(end, of_rod, [1.2 + extension + 1.1, 0.0])[1]),
    ];
    (GRAVITY * weights.iter().map(|(mass, height)| mass * height).sum::<f64>(), tip)
}

/// The example's tip moves outwards on a level, its loop is the triangle above, and its drives hold the weight by virtual work.
#[test]
fn the_parallel_harvester_moves_its_tip_on_a_level() {
    const STEP: f64 = 1e-4;
    let (_, text) = crane_specs::EXAMPLES.iter().find(|(name, _)| *name == "parallel_harvester").expect("the example");
    let harvester_crane = crane(text);
    let harvester_crane: &dyn DynCrane = &harvester_crane;
    let mut tips = Vec::new();
    let mut q = harvester_crane.guess();
    for angle in [70.0, 60.0, 50.0, 40.0, 32.0] {
        let drives = [0.3, f64::to_radians(angle), 0.41];
        let rest = statics::Problem::new(harvester_crane).holding(&drives).from(&q).solve();
        assert!(rest.is_stable(), "{rest}");
        q.clone_from(&rest.q);
        let (theta, extension) = (q[1], q[4]);
        let (_, tip) = harvester(theta, extension);
        let found = harvester_crane.points_at(&q)[0];
        assert!((found.xy().norm() - tip[0]).abs() < 1e-10 && (found.z - tip[1]).abs() < 1e-10, "{found} {tip:?}");
        let slope = |dt: f64, ds: f64| {
            let [before, after] = [-STEP, STEP].map(|step| harvester(theta + step * dt, extension + step * ds).0);
            (after - before) / (2.0 * STEP)
        };
        let efforts = harvester_crane.drive_efforts_holding(0.0, &drives, &q);
        // Differences of energies of 1e5 J, whose third derivatives are of the same size.
        assert!((efforts[1] - slope(1.0, 0.0)).abs() < 0.01, "{efforts:?} {}", slope(1.0, 0.0));
        assert!((efforts[2] - slope(0.0, 1.0)).abs() < 0.01, "{efforts:?} {}", slope(0.0, 1.0));
        tips.push(tip);
    }
    let heights = tips.iter().map(|tip| tip[1]);
    let range = heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min);
    assert!(range < 0.15 && tips[4][0] - tips[0][0] > 3.1, "{tips:?}");
}

/// What closes loops in one pass, in which the sweeps share articulated inertias, against the functions that compute it one by one.
#[test]
fn one_pass_closes_loops_as_separate_solutions_do() {
    let (_, text) = crane_specs::EXAMPLES.iter().find(|(name, _)| *name == "parallel_harvester").expect("the example");
    let crane = crane(text);
    let crane: &dyn DynCrane = &crane;
    let (n, equations) = (crane.size(), crane.count(Count::LoopEquations));
    let q: Vec<f64> = crane.guess().iter().enumerate().map(|(j, q)| q + 0.05 * (j as f64).sin()).collect();
    let v: Vec<f64> = (0..n).map(|j| 0.3 * (1.7 * j as f64).cos()).collect();
    let mut found = vec![0.0; crane.count(Count::LoopRows) * n];
    crane.loop_dynamics(0.4, &q, &v, &mut found);
    let (mut expected, mut states) = (vec![0.0; n], vec![Vector3::zeros(); equations]);
    let mut jacobian = vec![0.0; equations * n];
    crane.forward_dynamics(0.4, &q, &v, &mut expected);
    crane.loop_states(&q, &v, &mut states);
    crane.loop_jacobians(&q, &mut jacobian);
    expected.extend(states.iter().map(|state| state.z));
    expected.resize(n + equations.next_multiple_of(n), 0.0);
    expected.extend(&jacobian);
    for row in jacobian.chunks(n) {
        let mut response = vec![0.0; n];
        crane.solve_mass(&q, row, &mut response);
        expected.extend(response);
    }
    assert_eq!(found.len(), expected.len());
    // The same sums in another order.
    for (index, (one, other)) in found.iter().zip(&expected).enumerate() {
        assert!((one - other).abs() <= 1e-11 * other.abs().max(1e-6), "{index}: {one} {other}");
    }
}

/// Couplers of a row of parallel four-bars.
const COUPLERS: usize = 12;

/// Slender cranks of 1 m and 1 kg, 1 m apart, and couplers like them. The joints that close the loops are not listed in order.
fn row_of_four_bars(ground: &str) -> LiveCrane {
    let link = |name: String, on: String, at: usize| {
        format!(
            "- {{name: {name}, on: {{link: {on}, at: [{at}, 0, 0]}}, joint: revolute, mass: 1, com: [0.5, 0, 0], \
             inertia: {{about: com, Ixx: 1e-4, Iyy: {inertia}, Izz: {inertia}}}}}\n",
            inertia = 1.0 / 12.0
        )
    };
    let cranks = (0..=COUPLERS).map(|i| link(format!("crank_{i}"), "ground".to_owned(), i));
    let couplers = (0..COUPLERS).map(|i| link(format!("coupler_{i}"), format!("crank_{i}"), 1));
    let joint = |i: usize| {
        let next = i + 1;
        format!(
            "- {{name: pin_{i}, from: {{link: coupler_{i}, at: [1, 0, 0]}}, to: {{link: crank_{next}, at: [1, 0, 0]}}, \
             joint: {{pin: {{axis: [0, 0, 1], to_axis: [0, 0, 1]}}}}}}\n"
        )
    };
    let guess = (0..=COUPLERS).map(|i| format!("crank_{i}_psi: -80 deg"));
    let guess = guess.chain((0..COUPLERS).map(|i| format!("coupler_{i}_psi: 80 deg")));
    crane(&format!(
        "format: 1\nname: row\nanalyses: [statics, dynamics, modes]\ngravity: [0, -{GRAVITY}, 0]\nlinks:\n\
         - {{name: ground{ground}}}\n{}loop_joints:\n{}guess: {{{}}}\n",
        cranks.chain(couplers).collect::<String>(),
        (0..COUPLERS).map(|i| joint(5 * i % COUPLERS)).collect::<String>(),
        guess.collect::<Vec<_>>().join(", "),
    ))
}

/// With m cranks and n couplers, which do not turn, `(m/3 + n) θ̈ = −g (m/2 + n) cos θ` at any rate; about rest, `ω² = g (m/2 + n)/(m/3 + n)`.
#[test]
fn loops_next_to_each_other_swing_as_one_pendulum() {
    let row = row_of_four_bars("");
    let row: &dyn DynCrane = &row;
    let (m, n) = (COUPLERS as f64 + 1.0, COUPLERS as f64);
    let pull = GRAVITY * (m / 2.0 + n) / (m / 3.0 + n);
    let of_cranks =
        |number: f64| -> Vec<f64> { (0..row.size()).map(|j| if j <= COUPLERS { number } else { -number }).collect() };
    for (theta, rate) in [(0.4, 0.0), (-1.1, 2.5)] {
        let found = row.accelerations_at(0.0, &of_cranks(theta), &of_cranks(rate));
        for (j, expected) in of_cranks(-pull * f64::cos(theta)).into_iter().enumerate() {
            // Sums of a few forces from each of the loops, of which the joints pass on those of their neighbours.
            assert!((found[j] - expected).abs() < 1e-11, "{j}: {} {expected}", found[j]);
        }
    }
    let rest = row.equilibrium(&statics::Settings::default());
    assert!(rest.is_stable() && rest.q.iter().all(|angle| (angle.abs() - PI / 2.0).abs() < 1e-9), "{rest}");
    let modes = modes::undamped(&row.small_motions_at(&rest.q)).expect("modes");
    assert_eq!(modes.len(), 1);
    // An eigenvalue of one coordinate.
    assert!((modes[0].omega_squared / pull - 1.0).abs() < 1e-9, "{}", modes[0].omega_squared);
}

/// All equations of motion and of the loops as one dense system, where loops are on ground that rests and where it moves all of them.
#[test]
fn loops_next_to_each_other_move_as_one_system_of_all_equations() {
    for ground in ["", ", joint: {prismatic: {axis: x}}, mass: 3, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}"] {
        let row = row_of_four_bars(ground);
        let row: &dyn DynCrane = &row;
        let n = row.size();
        let numbers = |scale: f64| (0..n).map(|j| scale * (1.7 * j as f64).sin()).collect::<Vec<f64>>();
        let (q, v) = (numbers(0.5), numbers(1.0));
        let independent = loop_joints::independent(row, &q);
        assert_eq!(independent.len(), 2 * COUPLERS);
        let mut jacobian = vec![0.0; row.count(Count::LoopEquations) * n];
        let mut states = vec![Vector3::zeros(); row.count(Count::LoopEquations)];
        row.loop_jacobians(&q, &mut jacobian);
        row.loop_states(&q, &v, &mut states);
        let size = n + independent.len();
        let (mass, mut whole) = (row.mass_matrix_at(&q), DMatrix::zeros(size, size));
        whole.view_mut((0, 0), (n, n)).copy_from(&mass);
        let mut right = DVector::zeros(size);
        let mut forces = vec![0.0; n];
        row.forces(0.0, &q, &v, &mut forces);
        right.rows_mut(0, n).copy_from(&(row.bias_at(&q, &v) + DVector::from_vec(forces)));
        for (index, &equation) in independent.iter().enumerate() {
            for j in 0..n {
                let entry = jacobian[equation * n + j];
                (whole[(n + index, j)], whole[(j, n + index)]) = (entry, entry);
            }
            right[n + index] = -states[equation].z;
        }
        let expected = whole.lu().solve(&right).expect("a regular matrix");
        let found = row.accelerations_at(0.0, &q, &v);
        // The condition of the whole matrix, some 1e3, times rounding.
        let error = (found - expected.rows(0, n)).amax() / expected.rows(0, n).amax();
        assert!(error < 1e-12, "{ground} {error}");
    }
}
