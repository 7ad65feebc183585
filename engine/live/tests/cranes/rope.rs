//! Ropes as chains of links: against the same links written one by one, a pendulum, and the frequencies of a heavy string.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::modes;

const GRAVITY: f64 = 9.81;
const LENGTH: f64 = 6.0;
const DENSITY: f64 = 1.8;

fn crane(links: &str) -> LiveCrane {
    let text = format!(
        "format: 1
name: hanging
gravity: [0, 0, -{GRAVITY}]
links:
{links}
"
    );
    LiveCrane::from_spec(&SourceFile::new("hanging.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A rope that hangs with its x axis downwards.
fn rope(count: usize, more: &str) -> LiveCrane {
    crane(&format!(
        "  - {{name: rope, placement: {{transform: {{rotation: [{{y: 90 deg}}]}}}}, rope: {{length: {LENGTH}, links: {count}, mass_per_length: {DENSITY}{more}}}}}"
    ))
}

/// Frequencies of small swings about the hanging pose, rad/s, in order.
fn frequencies(crane: &dyn DynCrane) -> Vec<f64> {
    let small = crane.small_motions_at(&vec![0.0; crane.size()]);
    let modes = modes::undamped(&small).expect("modes");
    modes.iter().map(|mode| mode.omega_squared.sqrt()).collect()
}

/// The same links written one by one, each on two joints: by Simpson's rule, point masses at both ends and in the middle are
/// equivalent to a rod.
#[test]
fn a_rope_is_its_links() {
    let d = LENGTH / 3.0;
    let [end, middle] = [DENSITY * d / 6.0, 4.0 * DENSITY * d / 6.0];
    let each = (1..=3).map(|number| {
        let placement = if number == 1 {
            "placement: {transform: {rotation: [{y: 90 deg}]}}".to_owned()
        } else {
            format!("placement: {{transform: {{translation: [{d}, 0, 0]}}}}")
        };
        format!(
            "  - {{name: swing_{number}, {placement}, joint: revolute}}
  - name: rod_{number}
    joint: {{revolute: {{axis: y}}}}
    bodies:
      - {{name: begin, mass: {end}, com: [0, 0, 0]}}
      - {{name: middle, mass: {middle}, com: [{half}, 0, 0]}}
      - {{name: tip, mass: {end}, com: [{d}, 0, 0]}}",
            half = 0.5 * d
        )
    });
    let by_hand = crane(
        &(each.collect::<Vec<_>>().join("\n")
            + "\ndamping: {swing_1_psi: 2, rod_1_theta: 2, swing_2_psi: 2, rod_2_theta: 2, swing_3_psi: 7, rod_3_theta: 2}"),
    );
    let rope = crane(&format!(
        "  - {{name: rope, placement: {{transform: {{rotation: [{{y: 90 deg}}]}}}}, rope: {{length: {LENGTH}, links: 3, mass_per_length: {DENSITY}, damping: 2}}}}
damping: {{rope_3_psi: 7}}"
    ));
    let q = [0.3, -0.2, 0.5, 0.7, -0.4, 0.1];
    let v = [0.9, 0.4, -1.2, 0.8, 0.3, -0.6];
    let [rope, by_hand]: [&dyn DynCrane; 2] = [&rope, &by_hand];
    let off = |one: &[f64], other: &[f64]| {
        let size = one.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max) / size
    };
    assert!(off(rope.mass_matrix_at(&q).as_slice(), by_hand.mass_matrix_at(&q).as_slice()) < 1e-14);
    assert!(off(rope.bias_at(&q, &v).as_slice(), by_hand.bias_at(&q, &v).as_slice()) < 1e-13);
    let [one, other] = [rope, by_hand].map(|crane| crane.accelerations_at(0.0, &q, &v));
    assert!(off(one.as_slice(), other.as_slice()) < 1e-12);
}

/// One link is a rod: ω² = 3g/(2l). Many converge to the heavy string, ω = j/2 √(g/l) with the zeros j of the Bessel function J₀, with the
/// square of their number, in both directions.
#[test]
fn a_hanging_rope_swings_as_a_heavy_string() {
    let rod = frequencies(&rope(1, ""));
    for frequency in &rod {
        assert!((frequency / (1.5 * GRAVITY / LENGTH).sqrt() - 1.0).abs() < 1e-12, "{frequency}");
    }
    for (mode, zero) in [2.404_825_557_695_773, 5.520_078_110_286_311].into_iter().enumerate() {
        let exact = 0.5 * zero * (GRAVITY / LENGTH).sqrt();
        let error = |count| {
            let found = frequencies(&rope(count, ""));
            // Each frequency twice: along y and across it.
            let [one, other] = [2 * mode, 2 * mode + 1].map(|index| (found[index] / exact - 1.0).abs());
            assert!((one - other).abs() < 1e-9, "{one} {other}");
            one
        };
        let [coarse, fine, finest] = [8, 16, 32].map(error);
        for rate in [coarse / fine, fine / finest] {
            assert!((3.5..4.5).contains(&rate), "mode {mode}: {coarse:.2e} {fine:.2e} {finest:.2e}");
        }
    }
}
