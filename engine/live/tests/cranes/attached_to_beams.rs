//! What acts on a beam, anywhere: against the beam of Euler and Bernoulli.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::statics;

/// Length of the beam, m.
const LENGTH: f64 = 2.0;
/// Stiffness against bending and torsion, N m².
const BENDING: f64 = 1e4;
const TORSION: f64 = 8e3;

fn crane(text: &str) -> LiveCrane {
    let text = format!(
        "format: 1\nname: test\ngravity: [0, 0, 0]\nmaterials: {{stuff: {{E: 1e10, G: 8e9, density: 100}}}}\n{text}"
    );
    LiveCrane::from_spec(&SourceFile::new("test.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A beam of so many sections, on a joint if it has one.
fn link(sections: usize, joint: &str) -> String {
    format!(
        "links:\n  - name: beam\n{joint}    beam: {{length: {LENGTH}, sections: {sections}, material: stuff, section: {{numbers: {{area: 1e-3, Jy: \
         1e-6, Jz: 1e-6, Jo: 1e-6}}}}}}\n"
    )
}

/// The coordinates at rest, by name.
fn at_rest(crane: &LiveCrane) -> Vec<(String, f64)> {
    let crane: &dyn DynCrane = crane;
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    let names = crane.description().coordinates.iter().map(|coordinate| coordinate.name.to_string());
    names.zip(equilibrium.q).collect()
}

/// Sum of the angles of all springs about an axis.
fn turned(coordinates: &[(String, f64)], about: &str) -> f64 {
    coordinates.iter().filter(|(name, _)| name.ends_with(about)).map(|(_, angle)| angle).sum()
}

/// The places of attachments: a sequence that fills (0, 1) evenly, without places too near to the ends for sections of their own.
fn places(count: usize) -> impl Iterator<Item = f64> {
    (1..=count).map(|k| (0.618_033_988_75 * k as f64).fract().clamp(0.11, 0.89))
}

/// A couple M at a turns the tip by `M a/EJ`, a force F by `F a²/2EJ`, and a torque T by `T a/GJ`, with any number of sections: the rest of the beam is
/// not bent. 1e-8 N m bends so little that it is linear to rounding.
#[test]
fn the_tip_turns_as_far_as_a_beams() {
    const SMALL: f64 = 1e-8;
    for (sections, share) in (1..=5).cycle().zip(places(25)) {
        let a = share * LENGTH;
        let beam = crane(&format!(
            "{}loads:\n  - {{name: couple, link: beam, at: [{a}, 0, 0], moment: [{SMALL}, 0, {SMALL}]}}\n  - {{name: push, link: beam, at: [{a}, 0, \
             0], force: [0, 0, {SMALL}]}}\n",
            link(sections, "")
        ));
        let coordinates = at_rest(&beam);
        let expected = [
            ("_psi", SMALL * a / BENDING),
            ("_theta", -SMALL * a * a / (2.0 * BENDING)),
            ("_phi", SMALL * a / TORSION),
        ];
        for (about, angle) in expected {
            let got = turned(&coordinates, about);
            assert!((got / angle - 1.0).abs() < 1e-9, "{sections} sections, {a} m, {about}: {got} for {angle}");
        }
    }
}

/// A hinged boom that is held by a slanting strut beside its axis, at a, and pushed at its tip. The strut's force bends the boom by a force V and a
/// couple C, so that the moment jumps at a: `M = (F (l − a) − C) x/a` before, `F (l − x)` behind. The deflection of the tip, `∫ M²/(F EJ) dx` and what
/// the strut gives way, falls with the square of the sections' length, wherever the pin is.
#[test]
fn a_pin_beside_the_axis_bends_a_boom_with_order_two() {
    const FORCE: f64 = 0.1;
    const STIFFNESS: f64 = 1e7;
    let (offset, reach) = (0.1 * LENGTH, 5.0);
    let deflection = |sections: usize, a: f64| {
        let boom = crane(&format!(
            "{}connectors:\n  - {{name: strut, from: {{at: [{}, {}, 0]}}, to: {{link: beam, at: [{a}, -{offset}, 0]}}, law: {{spring: {{stiffness: \
             {STIFFNESS}, length: {}}}}}}}\nloads: [{{name: push, link: beam, at: [{LENGTH}, 0, 0], force: [0, -{FORCE}, 0]}}]\npoints: [{{name: tip, \
             link: beam, at: [{LENGTH}, 0, 0]}}]\n",
            link(sections, "    joint: revolute\n"),
            a - reach,
            -offset - reach,
            reach * 2.0_f64.sqrt(),
        ));
        let q: Vec<f64> = at_rest(&boom).into_iter().map(|(_, angle)| angle).collect();
        -(&boom as &dyn DynCrane).points_at(&q)[0].y
    };
    for a in places(10).map(|share| (0.2 + 0.6 * share) * LENGTH) {
        let push = FORCE * LENGTH / ((a + offset) * 0.5_f64.sqrt());
        let before = FORCE * (LENGTH - a) - push * 0.5_f64.sqrt() * offset;
        let bent = (before.powi(2) * a + FORCE.powi(2) * (LENGTH - a).powi(3)) / (3.0 * FORCE * BENDING);
        let exact = bent + push.powi(2) / (FORCE * STIFFNESS);
        for sections in [2, 4, 8, 16, 32] {
            // Before and behind, the deflection is a quarter of (d/l)² too small, l the length of that side.
            let error = (deflection(sections, a) / exact - 1.0).abs();
            assert!(error < 3.0 / (sections * sections) as f64, "{sections} sections, pin at {a} m: {error}");
        }
    }
}
