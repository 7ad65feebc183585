//! Joints between the rigid elements of a beam: what `symmetric` and `paper` converge to, and how fast.

use std::f64::consts::FRAC_PI_4;

use crane_codegen::chain::Analyses;
use crane_codegen::mechanics;
use crane_model::nalgebra::{DMatrix, DVector, SymmetricEigen};
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::State;
use crane_tests::workspace;

const LENGTH: f64 = 8.0;

/// A cantilever along x with a mass at its tip, under gravity in some direction; the tip mass is a live parameter.
struct Beam {
    crane: Interpreted,
}

/// Second moments of area of a section, m⁴; E = G = 1e10 Pa.
struct Section {
    jy: f64,
    jz: f64,
    jo: f64,
}

const MODULUS: f64 = 1e10;
const ROUND: Section = Section { jy: 1e-6, jz: 1e-6, jo: 2e-6 };

/// At rest in a pose, at the start.
fn at(q: Vec<f64>) -> State {
    let v = vec![0.0; q.len()];
    State { t: 0.0, q, v }
}

impl Beam {
    fn new(joint: &str, sections: usize, section: &Section, gravity: [f64; 3]) -> Self {
        let Section { jy, jz, jo } = section;
        let spec = format!(
            "format: 1
name: beam
gravity: {gravity:?}
parameters: {{load: {{value: 1.0, unit: kg}}}}
links:
  - name: beam
    beam:
      length: {LENGTH:?}
      sections: {sections}
      section_joint: {joint}
      material: {{E: {MODULUS:?}, G: {MODULUS:?}, density: 1}}
      section: {{numbers: {{area: 1e-3, Jy: {jy:?}, Jz: {jz:?}, Jo: {jo:?}}}}}
  - {{name: tip, mass: load, com: [0, 0, 0]}}
"
        );
        let chain = workspace::chain_of("beam", &spec);
        let analyses = Analyses::COMMAND;
        let program = mechanics::derive(&chain, analyses);
        Beam { crane: Interpreted { chain, program } }
    }

    fn straight(&self) -> State {
        at(vec![0.0; self.crane.size()])
    }

    fn with_load(&self, load: f64) -> Interpreted {
        let mut chain = self.crane.chain.clone();
        chain.parameters[0].default = load;
        Interpreted { chain, program: self.crane.program.clone() }
    }

    /// Equilibrium under a load, in load steps small enough for Newton's method.
    fn equilibrium(&self, load: f64) -> State {
        let mut q = DVector::zeros(self.crane.size());
        for step in 1..=20 {
            let loaded = self.with_load(load * f64::from(step) / 20.0);
            for _ in 0..6 {
                let state = at(q.as_slice().to_vec());
                let tangent = loaded.matrix("tangent_stiffness", &state).lu();
                q -= tangent.solve(&loaded.vector("static_residual", &state)).expect("a regular tangent stiffness");
            }
        }
        at(q.as_slice().to_vec())
    }

    /// Angular frequencies at a pose under a load, from the lowest on, rad/s.
    fn frequencies(&self, load: f64, state: &State) -> Vec<f64> {
        let loaded = self.with_load(load);
        let lower = loaded.matrix("tangent_stiffness", state).cholesky().expect("a stable pose").l();
        let half = lower.solve_lower_triangular(&loaded.matrix("mass_matrix", state)).expect("L is regular");
        let reduced = lower.solve_lower_triangular(&half.transpose()).expect("L is regular");
        let mut squares: Vec<f64> = SymmetricEigen::new(reduced).eigenvalues.iter().map(|x| 1.0 / x).collect();
        squares.sort_by(f64::total_cmp);
        squares.into_iter().map(f64::sqrt).collect()
    }

    /// Pose of the tip, row by row.
    fn tip(&self, state: &State) -> Vec<f64> {
        let frames = self.crane.get("transforms", &self.crane.inputs(state), 0);
        frames[frames.len() - 16..].to_vec()
    }
}

/// Relative excess of the load under which a cantilever, loaded at its tip in its stiff plane, buckles sideways, over
/// `4.0126 √(EI GJ)/L²` [Timoshenko and Gere, Theory of Elastic Stability, 1961, section 6.3].
fn buckling_excess(joint: &str, sections: usize) -> f64 {
    let section = Section { jy: 1.0, jz: 1e-6, jo: 2e-6 };
    let beam = Beam::new(joint, sections, &section, [0.0, 0.0, -1.0]);
    let stiffness = |load: f64| beam.with_load(load).matrix("tangent_stiffness", &beam.straight());
    // K(P) = K₀ + P K₁, K₀ diagonal except for the beam's own weight.
    let (unloaded, loaded) = (stiffness(1e-9), stiffness(1.0 + 1e-9));
    let geometric: DMatrix<f64> = loaded - &unloaded;
    let lower = unloaded.cholesky().expect("an unloaded beam is stable").l();
    let half = lower.solve_lower_triangular(&geometric).expect("L is regular");
    let reduced = lower.solve_lower_triangular(&half.transpose()).expect("L is regular");
    let critical = -1.0 / SymmetricEigen::new(reduced).eigenvalues.min();
    // First root of the series of J_{-1/4}, Timoshenko's constant with more digits.
    let exact = 4.012_599 * MODULUS * (section.jz * section.jo).sqrt() / (LENGTH * LENGTH);
    critical / exact - 1.0
}

#[test]
fn lateral_torsional_buckling() {
    let sections = [4, 8, 16];
    let [symmetric, paper] = ["symmetric", "paper"].map(|joint| sections.map(|n| buckling_excess(joint, n)));
    for (excess, limit) in symmetric.into_iter().zip([0.032, 0.009, 0.0025]) {
        assert!(excess.abs() < limit, "{symmetric:?}");
    }
    let order = |pair: &[f64]| (pair[0] / pair[1]).log2();
    assert!(symmetric.windows(2).all(|pair| order(pair) > 1.9), "{symmetric:?}");
    // The paper's joint loses half of the product of two angles in each section.
    for (excess, expected) in paper.into_iter().zip([0.284, 0.133, 0.065]) {
        assert!((excess - expected).abs() < 0.005, "{paper:?}");
    }
}

/// For a round beam it does not matter which of its planes is called psi: the same load bends it by 70° whichever way it pulls,
/// and it vibrates at the same frequencies.
#[test]
fn a_round_beam_bends_alike_in_all_planes() {
    for sections in [2, 4, 8] {
        let pulled = |joint: &str, direction: f64| {
            let (sin, cos) = direction.sin_cos();
            Beam::new(joint, sections, &ROUND, [0.0, -9.81 * cos, -9.81 * sin])
        };
        let slope = |load: f64| {
            let beam = pulled("symmetric", 0.0);
            beam.tip(&beam.equilibrium(load))[0].acos().to_degrees()
        };
        let (mut low, mut high) = (20.0, 200.0);
        for _ in 0..14 {
            let middle = 0.5 * (low + high);
            (low, high) = if slope(middle) < 70.0 { (middle, high) } else { (low, middle) };
        }
        let bent = |joint: &str, direction: f64| {
            let beam = pulled(joint, direction);
            let state = beam.equilibrium(low);
            (beam.tip(&state)[0].acos().to_degrees(), beam.frequencies(low, &state)[..4].to_vec())
        };
        let [by_psi, by_both, by_theta] = [0.0, FRAC_PI_4, 2.0 * FRAC_PI_4].map(|angle| bent("symmetric", angle));
        assert!((by_psi.0 - 70.0).abs() < 0.1, "bent by {}°", by_psi.0);
        for other in [&by_both, &by_theta] {
            for (a, b) in by_psi.1.iter().zip(&other.1) {
                // Newton's method and the eigenvalues leave errors of about 1e-12.
                assert!((a / b - 1.0).abs() < 1e-9, "{sections} sections: {by_psi:?} against {other:?}");
            }
        }
        let (psi, theta) = (bent("paper", 0.0).1[0], bent("paper", 2.0 * FRAC_PI_4).1[0]);
        assert!((psi / theta - 1.0).abs() > 1e-3, "the paper's joint: {psi} and {theta} rad/s");
    }
}

/// In one plane, and in torsion alone, both joints are the same: motions, forces and limits.
#[test]
fn motions_in_one_plane_are_those_of_the_paper() {
    for sections in [1, 3, 5] {
        let [symmetric, paper] =
            ["symmetric", "paper"].map(|joint| Beam::new(joint, sections, &ROUND, [0.3, 0.0, 0.0]).crane);
        for kind in ["_psi", "_theta", "_phi"] {
            let n = symmetric.size();
            let numbers = |size: f64, seed: f64| -> Vec<f64> {
                let of = |(j, c): (usize, &crane_codegen::chain::Coordinate)| {
                    if c.name.ends_with(kind) { size * (seed + 1.3 * j as f64).sin() } else { 0.0 }
                };
                symmetric.chain.coordinates.iter().enumerate().map(of).collect()
            };
            let state = State { t: 0.0, q: numbers(1.1, 0.4), v: numbers(2.0, 1.7) };
            let (a, b) = (symmetric.acceleration(&state), paper.acceleration(&state));
            // Accelerations of both lie in the plane; about a hundred roundings.
            assert!((&a - &b).amax() < 1e-11 * b.amax(), "{sections} sections, {kind}: {a} against {b}");
            for function in ["static_residual", "bias"] {
                let (a, b) = (symmetric.vector(function, &state), paper.vector(function, &state));
                let planar = |x: &DVector<f64>| DVector::from_fn(n, |j, _| if state.q[j] == 0.0 { 0.0 } else { x[j] });
                // Relative to forces of order 1, which cancel in torsion.
                assert!((planar(&a) - planar(&b)).amax() < 1e-12 * b.amax().max(1.0), "{function}, {kind}");
            }
        }
    }
}

/// About the straight beam under tension, as in a rotating blade, small vibrations are the same with both joints.
#[test]
fn a_straight_beam_under_tension_vibrates_as_with_the_joint_of_the_paper() {
    for sections in [2, 4, 8] {
        let frequencies = |joint: &str| {
            let beam = Beam::new(joint, sections, &Section { jy: 1e-6, jz: 3e-6, jo: 2e-6 }, [9.81, 0.0, 0.0]);
            beam.frequencies(50.0, &beam.straight())
        };
        for (a, b) in frequencies("symmetric").iter().zip(frequencies("paper")) {
            assert!((a / b - 1.0).abs() < 1e-10, "{sections} sections: {a} against {b} rad/s");
        }
    }
}

/// A boom under its load, a quarter of it sideways: how far its tip turns about its own axis. With `paper` the error falls as
/// 1/n, with `symmetric` as 1/n²; both tend to the same limit.
#[test]
fn twist_of_a_tip_that_is_loaded_in_two_planes() {
    let section = Section { jy: 4e-6, jz: 1e-6, jo: 1e-6 };
    let twist = |joint: &str, sections: usize| {
        let beam = Beam::new(joint, sections, &section, [0.0, 0.25, -1.0]);
        // Height of the tip's y axis over the horizontal.
        beam.tip(&beam.equilibrium(200.0))[9]
    };
    let [symmetric, paper] = ["symmetric", "paper"].map(|joint| [4, 8, 16].map(|n| twist(joint, n)));
    let ratio = |x: [f64; 3]| ((x[1] - x[0]) / (x[2] - x[1])).log2();
    assert!((ratio(symmetric) - 2.0).abs() < 0.1, "order {}", ratio(symmetric));
    assert!((ratio(paper) - 1.0).abs() < 0.2, "order {}", ratio(paper));
    let limit = symmetric[2] + (symmetric[2] - symmetric[1]) / 3.0;
    let of_paper = paper[2] + (paper[2] - paper[1]);
    assert!((of_paper / limit - 1.0).abs() < 0.02, "{of_paper} against {limit}");
    let error = |x: f64| (x / limit - 1.0).abs();
    assert!(error(symmetric[0]) < 0.1 * error(paper[0]), "{symmetric:?}, {paper:?}");
}

/// Tip of the elastica: along and across the straight beam, as fractions of its length, under a load `PL²/EI` across it.
///
/// `θ″ = −α cos θ` with θ(0) = 0 and θ′(1) = 0, by shooting with the classical Runge–Kutta method.
fn elastica(alpha: f64) -> [f64; 2] {
    const STEPS: usize = 4000;
    let shoot = |curvature: f64| {
        let slope = |[angle, curvature, ..]: [f64; 4]| [curvature, -alpha * angle.cos(), angle.cos(), angle.sin()];
        let h = 1.0 / STEPS as f64;
        let mut y = [0.0, curvature, 0.0, 0.0];
        for _ in 0..STEPS {
            let moved = |by: f64, k: [f64; 4]| std::array::from_fn(|i| y[i] + by * k[i]);
            let k1 = slope(y);
            let k2 = slope(moved(h / 2.0, k1));
            let k3 = slope(moved(h / 2.0, k2));
            let k4 = slope(moved(h, k3));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        y
    };
    let (mut low, mut high) = (0.0, 2.0 * alpha);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        if shoot(middle)[1] > 0.0 { high = middle } else { low = middle }
    }
    let [_, _, along, across] = shoot(high);
    [along, across]
}

/// Bent by half its length, in whichever plane, a beam tends to the elastica with order 2.
#[test]
fn large_bending_tends_to_the_elastica() {
    const ALPHA: f64 = 2.0;
    let exact = elastica(ALPHA);
    // Bisshop and Drucker, Large deflection of cantilever beams, Quart. Appl. Math. 3 (1945) 272: 0.494 and 0.161.
    assert!((exact[1] - 0.4935).abs() < 1e-3 && (1.0 - exact[0] - 0.1606).abs() < 1e-3, "{exact:?}");
    let load = ALPHA * MODULUS * ROUND.jy / (LENGTH * LENGTH);
    for direction in [0.0, 0.3, FRAC_PI_4, 1.2] {
        let errors = [4, 8, 16].map(|sections| {
            let beam = Beam::new("symmetric", sections, &ROUND, [0.0, -f64::sin(direction), -f64::cos(direction)]);
            let tip = beam.tip(&beam.equilibrium(load));
            let origin = |row: usize| tip[4 * row + 3];
            let across = -origin(1) * f64::sin(direction) - origin(2) * f64::cos(direction);
            [origin(0) / LENGTH - exact[0], across / LENGTH - exact[1]]
        });
        for axis in [0, 1] {
            let of: Vec<f64> = errors.iter().map(|error| error[axis].abs()).collect();
            // The beam weighs about 3e-5 of the load: below that the law does not hold.
            assert!(of[0] < 0.01 && of[2] < 7e-4, "{direction}: {errors:?}");
            assert!((of[0] / of[1]).log2() > 1.9 && (of[1] / of[2]).log2() > 1.8, "{direction}: {errors:?}");
        }
    }
}
