//! Stresses at pins, loads, steps and ends of beams, against the statics of beams.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::sections::{Place, StressedSection, places, stressed_sections};
use crane_model::{SectionInfo, Side, Wrench, statics};

const GRAVITY: f64 = 9.81;
const DENSITY: f64 = 7850.0;

fn crane(text: &str) -> LiveCrane {
    let text =
        format!("format: 1\nname: test\nmaterials: {{steel: {{E: 2.1e11, G: 8.1e10, density: {DENSITY}}}}}\n{text}");
    LiveCrane::from_spec(&SourceFile::new("test.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Something known of each section.
type Sections<T> = Vec<(SectionInfo, T)>;

/// What the sections carry and how they are stressed, at rest.
fn at_rest(crane: &LiveCrane) -> (Sections<Place>, Sections<StressedSection>) {
    let crane: &dyn DynCrane = crane;
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    let still = vec![0.0; equilibrium.q.len()];
    let wrenches = crane.internal_forces_at(0.0, &equilibrium.q, &still, &still);
    let description = crane.description();
    let x = crane.section_places_at(&equilibrium.q);
    let carried = places(description, &x, &wrenches).into_iter().map(|place| (place.info(description).clone(), place));
    let stressed = stressed_sections(description, &crane.section_moduli_at(), &x, &wrenches);
    (carried.collect(), stressed.into_iter().map(|section| (section.info(description).clone(), section)).collect())
}

fn at(sections: &[(SectionInfo, Place)], x: f64, side: Side) -> Wrench {
    let here = |(info, place): &&(SectionInfo, Place)| (place.x - x).abs() < 1e-9 && info.side == side;
    sections.iter().find(here).unwrap_or_else(|| panic!("no section at {x} {side:?}")).1.wrench
}

/// Thick enough that it sags by tenths of a millimetre.
const STURDY: &str = "section: {box: {height: 0.5, width: 0.4, thickness: 0.02}}";
const AREA: f64 = 0.5 * 0.4 - 0.46 * 0.36;

/// On a hinge at its beginning and a stiff strut at its end, with a force of 50 kN between: `M = A x − w x²/2` up to the force, and the shear force
/// jumps there.
#[test]
fn a_simply_supported_beam_is_bent_most_under_its_force() {
    let (length, x_force, force) = (4.0, 1.3, 50e3);
    let line = DENSITY * AREA * GRAVITY;
    let reaction = force * (length - x_force) / length + line * length / 2.0;
    for sections in [1, 2, 4] {
        let beam = crane(&format!(
            "
gravity: [0, -{GRAVITY}, 0]
links:
  - name: beam
    joint: revolute
    beam: {{length: {length}, sections: {sections}, material: steel, {STURDY}}}
loads: [{{name: press, link: beam, at: [{x_force}, 0, 0], force: [0, -{force}, 0]}}]
connectors:
  - {{name: strut, from: {{at: [{length}, -10, 0]}}, to: {{link: beam, at: [{length}, 0, 0]}}, law: {{spring: {{stiffness: 1e12, length: 10}}}}}}
"
        ));
        let (carried, _) = at_rest(&beam);
        for (info, Place { x, wrench, .. }) in &carried {
            let x = *x;
            let pushed = x > x_force || (x == x_force && info.side == Side::After);
            let bending = reaction * x - line * x * x / 2.0 - if pushed { force * (x - x_force) } else { 0.0 };
            let shear = -reaction + line * x + if pushed { force } else { 0.0 };
            // After the strut, at the very end, nothing is left.
            let end = x == length && info.side == Side::After;
            let (bending, shear) = if end { (0.0, 0.0) } else { (bending, shear) };
            // Sagging by 1 mm over metres changes levers by 1e-6.
            assert!((wrench.moment.z - bending).abs() < 1e-5 * reaction, "{x}: {} for {bending}", wrench.moment.z);
            assert!((wrench.force.y - shear).abs() < 1e-5 * reaction, "{x}: {} for {shear}", wrench.force.y);
        }
        let jump = at(&carried, x_force, Side::After).force.y - at(&carried, x_force, Side::Before).force.y;
        assert!((jump / force - 1.0).abs() < 1e-6, "{jump}");
    }
}

/// A tapered part, then a thinner one, clamped at its beginning: `σ = M h/2J` with the height on either side of the step.
#[test]
fn a_step_is_stressed_on_both_sides() {
    let clamped = crane(
        "
gravity: [0, 0, 0]
links:
  - {name: base, joint: {prismatic: {axis: x}}, mass: 1, com: [0, 0, 0]}
  - name: beam
    beam:
      length: 3
      sections: 4
      material: steel
      parts:
        - {length: 1.7, section: {box: {height: 0.5, width: 0.4, thickness: 0.02}}, to: {box: {height: 0.4, width: 0.3, thickness: 0.02}}}
        - {length: 1.3, section: {box: {height: 0.3, width: 0.25, thickness: 0.01}}}
drives: [{coordinate: base_x, rigid: true, motion: {hold: 0}}]
loads: [{name: press, link: beam, at: [3, 0, 0], force: [0, -20e3, 0]}]
",
    );
    let (_, stressed) = at_rest(&clamped);
    let stress = |h: f64, b: f64, t: f64| {
        let second = (b * h.powi(3) - (b - 2.0 * t) * (h - 2.0 * t).powi(3)) / 12.0;
        20e3 * 1.3 * h / 2.0 / second
    };
    let found = |side: Side| {
        let here = |(info, section): &&(SectionInfo, StressedSection)| section.place.x == 1.7 && info.side == side;
        stressed.iter().find(here).expect("a section at the step").1.stress.normal
    };
    // Levers shorten by 1e-6, and the normal force of the tilt adds as much.
    for (side, expected) in [(Side::Before, stress(0.4, 0.3, 0.02)), (Side::After, stress(0.3, 0.25, 0.01))] {
        assert!((found(side) / expected - 1.0).abs() < 2e-4, "{side:?}: {} for {expected}", found(side));
    }
    let (most, section) = stressed.iter().max_by(|(_, a), (_, b)| StressedSection::by_use(a, b)).expect("sections");
    assert_eq!((section.place.x, most.location().as_str()), (1.7, "after the beginning of part 2"));
}

/// The boom of a loader: a hinge, a cylinder at 0.7 m, the load at the end.
fn loader(sections: usize) -> LiveCrane {
    crane(&format!(
        "
links:
  - {{name: column, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - name: inner
    placement: {{transform: {{rotation: {{x: 90 deg}}}}}}
    joint: {{revolute: {{axis: z}}}}
    beam: {{length: 3.4, sections: {sections}, material: steel, section: {{box: {{height: 0.28, width: 0.2, thickness: 0.006}}}}}}
  - {{name: tip, joint: fixed, mass: 2500, com: [0, 0, 0], inertia: {{Ixx: 20, Iyy: 20, Izz: 20}}}}
drives:
  - {{coordinate: column_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: inner_psi, stiffness: 1e8, motion: {{hold: 15 deg}}}}
cylinders:
  - name: lift
    coordinate: inner_psi
    foot: {{link: column, at: [0.2, 0, -1]}}
    head: {{link: inner, at: [0.7, -0.12, 0]}}
    bore: 0.125
    rod: 0.06
    retracted: 0.9
    stroke: 0.68
    max_pressure: 320e5
    back_pressure: 5e5
    bulk_modulus: 1.2e9
    hose_volumes: [1e-3, 1e-3]
    valve: {{flow: 6e-4, pressure_drop: 1e6, lag: 0.03, gain: 0, feed_forward: 0}}
pump: {{max_flow: 8.4e-4, pressure: 300e5}}
"
    ))
}

/// The largest stress, at the pin of the cylinder, is known with few sections: its error falls with the square of their number.
#[test]
fn the_peak_at_a_pin_converges_with_the_square_of_the_sections() {
    let greatest = |sections: usize| {
        let (_, stressed) = at_rest(&loader(sections));
        let (info, most) =
            stressed.into_iter().max_by(|(_, a), (_, b)| StressedSection::by_use(a, b)).expect("sections");
        assert!((most.place.x - 0.7).abs() < 1e-12, "{info:?}");
        assert!(info.location().ends_with("the head of lift"), "{info:?}");
        most.stress.equivalent
    };
    let exact = {
        // The next term of the error is of the fourth order.
        let (coarse, fine) = (greatest(32), greatest(64));
        fine + (fine - coarse) / 3.0
    };
    let errors = [2, 4, 8, 16].map(|sections| (greatest(sections) - exact).abs() / exact);
    // A section ends at the pin, so that only the pose is not exact. Whole numbers of sections on both sides do not double exactly: over three doublings.
    assert!(errors[0] < 3e-4 && errors[3] < errors[0] / 8.0, "{errors:?}");
}

/// A force at every place of a beam, at ends of elements, inside them and at both ends: everywhere one section before and one after it, and
/// between them the shear force jumps by the force.
#[test]
fn a_force_has_one_section_on_either_side() {
    let (length, force) = (4.0, 1e3);
    for tenth in 1..40 {
        let x_force = 0.1 * f64::from(tenth);
        let beam = crane(&format!(
            "
gravity: [0, -{GRAVITY}, 0]
links:
  - {{name: beam, joint: {{revolute: {{axis: y}}}}, beam: {{length: {length}, sections: 4, material: steel, {STURDY}}}}}
drives: [{{coordinate: beam_theta, stiffness: 1e9, motion: {{hold: 0}}}}]
loads: [{{name: press, link: beam, at: [{x_force}, 0, 0], force: [0, -{force}, 0]}}]
"
        ));
        let (carried, _) = at_rest(&beam);
        let here: Vec<_> = carried.iter().filter(|(_, place)| (place.x - x_force).abs() < 1e-9).collect();
        let sides: Vec<Side> = here.iter().map(|(info, _)| info.side).collect();
        assert_eq!(sides, [Side::Before, Side::After], "{x_force} m");
        let jump = here[1].1.wrench.force.y - here[0].1.wrench.force.y;
        assert!((jump.abs() / force - 1.0).abs() < 1e-6, "{x_force} m: {jump} N");
        // Each place of the beam has either one section or one on either side.
        for (index, (info, place)) in carried.iter().enumerate() {
            let next = carried.get(index + 1).filter(|(_, next)| (next.x - place.x).abs() < 1e-9);
            assert_eq!(info.side == Side::Before, next.is_some(), "{x_force} m: {info:?}");
        }
    }
}
