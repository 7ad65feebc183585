//! Laws of the straight cantilever in rigid finite elements. They are exact, so they must hold up to rounding.
//!
//! With n sections, relative to an Euler–Bernoulli beam: tip force 1 − 1/(4n²), self-weight 1 − 1/(2n²), tip moment and
//! torsion exact. The first frequency converges from above with order 2.

use crane_model::nalgebra::DVector;
use crane_tests::interpreted::Interpreted;
use crane_tests::quantities::State;
use crane_tests::workspace;

const LENGTH: f64 = 2.0;
const E: f64 = 2.1e11;
const G: f64 = 8.1e10;
const AREA: f64 = 1e-3;
/// So slender that rotary inertia does not show in six digits.
const J: f64 = 1e-12;
const DENSITY: f64 = 7850.0;

fn beam(sections: usize, gravity: f64) -> Interpreted {
    let spec = format!(
        "format: 1
name: beam
gravity: [0, 0, {gravity:?}]
links:
  - name: beam
    beam:
      length: {LENGTH:?}
      sections: {sections}
      material: {{E: {E:?}, G: {G:?}, density: {DENSITY:?}}}
      section: {{numbers: {{area: {AREA:?}, Jy: {J:?}, Jz: {J:?}, Jo: {J:?}}}}}
points:
  - {{name: tip, link: beam, at: [{LENGTH:?}, 0, 0]}}
"
    );
    Interpreted::new(workspace::chain_of("beam", &spec))
}

fn straight(crane: &Interpreted) -> State {
    State { t: 0.0, q: vec![0.0; crane.size()], v: vec![0.0; crane.size()] }
}

/// Row of the tip's Jacobian for a world axis: velocities at unit rates.
fn tip_row(crane: &Interpreted, axis: usize) -> DVector<f64> {
    let n = crane.size();
    DVector::from_fn(n, |j, _| {
        let mut state = straight(crane);
        state.v[j] = 1.0;
        crane.get("point_velocities", &crane.inputs(&state), 3)[axis]
    })
}

/// Small displacements under generalized forces.
fn displacement(crane: &Interpreted, force: &DVector<f64>) -> DVector<f64> {
    crane.matrix("tangent_stiffness", &straight(crane)).lu().solve(force).unwrap()
}

fn assert_law(actual: f64, expected: f64, what: &str) {
    // A few dozen roundings.
    assert!((actual / expected - 1.0).abs() < 1e-13, "{what}: {actual} against {expected}");
}

#[test]
fn tip_force() {
    for n in [1, 2, 3, 4, 8, 16, 50] {
        let crane = beam(n, 0.0);
        for axis in [1, 2] {
            let row = tip_row(&crane, axis);
            let deflection = row.dot(&displacement(&crane, &(100.0 * &row)));
            let beam = 100.0 * LENGTH.powi(3) / (3.0 * E * J);
            let n = n as f64;
            assert_law(deflection, beam * (1.0 - 1.0 / (4.0 * n * n)), &format!("n = {n}, axis {axis}"));
        }
    }
}

#[test]
fn self_weight() {
    for n in [1, 2, 4, 10, 30] {
        let (weightless, heavy) = (beam(n, 0.0), beam(n, -9.81));
        let weight = -heavy.vector("static_residual", &straight(&heavy));
        let deflection = tip_row(&weightless, 2).dot(&displacement(&weightless, &weight));
        let beam = -9.81 * DENSITY * AREA * LENGTH.powi(4) / (8.0 * E * J);
        let n = n as f64;
        assert_law(deflection, beam * (1.0 - 1.0 / (2.0 * n * n)), &format!("n = {n}"));
    }
}

#[test]
fn tip_moment_and_torsion_are_exact() {
    for n in [1, 2, 4, 10, 30] {
        let crane = beam(n, 0.0);
        let on = |symbol: &str| {
            let ends = |name: &str| f64::from(u8::from(name.ends_with(symbol)));
            DVector::from_iterator(crane.size(), crane.chain.coordinates.iter().map(|c| ends(&c.name)))
        };
        let bent = displacement(&crane, &(5.0 * on("_psi")));
        let deflection = tip_row(&crane, 1).dot(&bent);
        assert_law(deflection, 5.0 * LENGTH * LENGTH / (2.0 * E * J), &format!("deflection, n = {n}"));
        assert_law(on("_psi").dot(&bent), 5.0 * LENGTH / (E * J), &format!("slope, n = {n}"));
        let twisted = on("_phi").dot(&displacement(&crane, &(5.0 * on("_phi"))));
        assert_law(twisted, 5.0 * LENGTH / (G * J), &format!("twist, n = {n}"));
    }
}

#[test]
fn first_frequency_approaches_from_above_with_order_two() {
    // First root of 1 + cos x cosh x = 0.
    let exact = 1.875_104_068_711_961_f64.powi(2) * (E * J / (DENSITY * AREA * LENGTH.powi(4))).sqrt();
    let excess = |n: usize| {
        let crane = beam(n, 0.0);
        crane.lowest_frequency(&straight(&crane)) / exact - 1.0
    };
    for (n, percent) in [(4, 1.453), (8, 0.360), (10, 0.230)] {
        let value = 100.0 * excess(n);
        // The law is known to a thousandth of a per cent.
        assert!((value - percent).abs() < 1e-3, "n = {n}: {value} % against {percent} %");
    }
    let order = (excess(16) / excess(32)).log2();
    assert!((order - 2.0).abs() < 0.02, "order {order}");
}

/// Two halves, the outer one four times as flexible. Under a tip force an Euler–Bernoulli beam deflects by
/// `F ∫ (l − x)²/(E J) dx = F l³ (7 + 4)/(24 E J)`. A spring in the middle of a section misses d³/12 of `∫ (l − x)² dx`, which makes
/// 1 − 5/(11n²) if the step lies between two sections; if it lies in the middle of one, that spring adds 3ld²/8, because
/// the moment at its place is too large for its softer half: 1 + 4/(11n²).
#[test]
fn a_stepped_cantilever_bends_as_euler_and_bernoulli_say() {
    let section = |j: f64| format!("{{numbers: {{area: {AREA:?}, Jy: {j:?}, Jz: {j:?}, Jo: {j:?}}}}}");
    let half = LENGTH / 2.0;
    let (thick, thin) = (section(J), section(J / 4.0));
    for sections in [1, 2, 4, 5, 32, 45] {
        let spec = format!(
            "format: 1
name: beam
gravity: [0, 0, 0]
links:
  - name: beam
    beam:
      length: {LENGTH:?}
      sections: {sections}
      material: {{E: {E:?}, G: {G:?}, density: {DENSITY:?}}}
      parts: [{{length: {half:?}, section: {thick}}}, {{length: {half:?}, section: {thin}}}]
points:
  - {{name: tip, link: beam, at: [{LENGTH:?}, 0, 0]}}
"
        );
        let crane = Interpreted::new(workspace::chain_of("beam", &spec));
        let row = tip_row(&crane, 1);
        let deflection = row.dot(&displacement(&crane, &row));
        let square = f64::from(sections * sections);
        let law = if sections % 2 == 0 { 1.0 - 5.0 / (11.0 * square) } else { 1.0 + 4.0 / (11.0 * square) };
        assert_law(deflection / (LENGTH.powi(3) * 11.0 / (24.0 * E * J)), law, &format!("{sections} sections"));
    }
}
