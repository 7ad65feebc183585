//! Forces and moments that joints, sections and the ground transmit, compared with exact laws.

use crane_codegen::chain::{Analyses, Chain, Cut, Side};
use crane_codegen::program::{Argument, FunctionId, Inputs};
use crane_codegen::{SourceFile, compile, mechanics, read, validate};

/// Sums of a few products: a few rounding errors of the largest term.
const ROUNDING: f64 = 1e-13;
/// Length of the beam, m.
const LENGTH: f64 = 3.0;
/// Sections of the beam.
const SECTIONS: usize = 4;
/// Density of the beam, kg/m³.
const DENSITY: f64 = 7850.0;
/// Area of its cross-section, 0.2 m high, 0.1 m wide, m².
const AREA: f64 = 0.02;
/// Second moment of area about z, m⁴.
const JZ: f64 = 0.1 * 0.2 * 0.2 * 0.2 / 12.0;
/// Mass on the beam's tip, kg.
const LOAD: f64 = 40.0;

/// Force and moment.
type Wrench = [[f64; 3]; 2];

/// A crane with the given keys.
fn crane(rest: &str) -> Chain {
    let source = SourceFile::new("test.yaml", format!("format: 1\nname: test\n{rest}"));
    read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A beam that is attached by `joint` at its beginning, with a point mass of [`LOAD`] at its tip.
fn beam(joint: &str, gravity: &str, section_joint: &str) -> Chain {
    loaded_beam(joint, gravity, section_joint, "")
}

/// The same with more keys.
fn loaded_beam(joint: &str, gravity: &str, section_joint: &str, more: &str) -> Chain {
    crane(&format!(
        "gravity: {gravity}
links:
  - name: beam
    joint: {joint}
    beam:
      length: {LENGTH}
      sections: {SECTIONS}
      section_joint: {section_joint}
      material: {{E: 2.1e11, G: 8.1e10, density: {DENSITY}}}
      section: {{solid: {{height: 0.2, width: 0.1}}}}
  - {{name: load, mass: {LOAD}, com: [0, 0, 0]}}
{more}"
    ))
}

/// The wrench that every cut transmits.
fn wrenches(chain: &Chain, q: &[f64], v: &[f64], a: &[f64]) -> Vec<Wrench> {
    wrenches_at(0.0, chain, q, v, a)
}

/// The wrench that every cut transmits at time t.
fn wrenches_at(t: f64, chain: &Chain, q: &[f64], v: &[f64], a: &[f64]) -> Vec<Wrench> {
    let analyses = Analyses::COMMAND;
    let program = mechanics::derive(chain, analyses);
    let function = program.function(FunctionId::InternalForces).expect("the analyses ask for it");
    let inputs = Inputs::state(t, q.to_vec(), v.to_vec(), chain.parameter_defaults());
    let slots = program.evaluate(function, &inputs.with(Argument::Acceleration, a.to_vec()));
    slots.as_chunks::<3>().0.as_chunks::<2>().0.to_vec()
}

/// Positions and sides of the sections of all beams, and the wrenches that they transmit.
fn sections(chain: &Chain, wrenches: &[Wrench]) -> Vec<(f64, Side, Wrench)> {
    let of = |(cut, wrench): (Cut, &Wrench)| {
        let all = || chain.beams.iter().flat_map(|beam| &beam.sections);
        let section = match cut {
            Cut::Body(body) => all().find(|section| section.body == body && section.inside.is_none())?,
            Cut::Inside(beam, section) => &chain.beams[beam].sections[section],
            Cut::Ground | Cut::Joint(_) => return None,
        };
        Some((section.x.at(&[]), section.side, *wrench))
    };
    chain.cuts().into_iter().zip(wrenches).filter_map(of).collect()
}

fn assert_close(what: &str, actual: Wrench, expected: Wrench) {
    for (actual, expected) in actual.iter().zip(&expected) {
        let size = expected.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
        for (a, b) in actual.iter().zip(expected) {
            assert!((a - b).abs() <= ROUNDING * size, "{what}: {actual:?} instead of {expected:?}");
        }
    }
}

/// The results are exact for any number of elements: their weights and lever arms add up to the integral.
#[test]
fn a_cantilever_bends_by_its_weight_and_its_load() {
    for section_joint in ["symmetric", "paper"] {
        let chain = beam("fixed", "[0, -9.81, 0]", section_joint);
        let rest = vec![0.0; chain.coordinates.len()];
        let wrenches = wrenches(&chain, &rest, &rest, &rest);
        let sections = sections(&chain, &wrenches);
        // Where the elements begin, and at the end.
        assert_eq!(sections.len(), SECTIONS + 2);
        for (x, _, wrench) in sections {
            let out = LENGTH - x;
            let q = -9.81 * (LOAD + DENSITY * AREA * out);
            let m = -9.81 * (LOAD * out + DENSITY * AREA * out * out / 2.0);
            assert_close(&format!("x = {x}"), wrench, [[0.0, q, 0.0], [0.0, 0.0, m]]);
        }
        // The ground carries the same wrench as the clamped end.
        assert_close("ground", wrenches[0], wrenches[1]);
    }
}

/// A force and a moment at the tip: every section transmits the force, which bends it with its lever arm.
#[test]
fn a_cantilever_carries_a_force_and_a_moment_at_its_tip() {
    let (force, moment) = ([30.0, -20.0, 10.0], [1.0, 2.0, 3.0]);
    let load = "loads: [{name: pull, link: load, at: [0.5, 0, 0], force: [30, -20, 10], moment: [1, 2, 3]}]";
    let along_the_link = load.replace("}]", ", axes: link, scale: {cubic: {from: 1, to: 3, duration: 2}}}]");
    // After a rotation about z, the axes of the beam differ from the world's; a load that rotates with the link is not affected.
    for (joint, more, angle, t, scale) in
        [("fixed", load, None, 0.0, 1.0), ("revolute", &along_the_link, Some(0.7), 1.0, 2.0)]
    {
        let chain = loaded_beam(joint, "[0, 0, 0]", "symmetric", more);
        let mut q = vec![0.0; chain.coordinates.len()];
        let rest = q.clone();
        q.iter_mut().take(1).zip(angle).for_each(|(q, angle)| *q = angle);
        let sections = sections(&chain, &wrenches_at(t, &chain, &q, &rest, &rest));
        // Where the elements begin, and at the end.
        assert_eq!(sections.len(), SECTIONS + 2);
        for (x, _, wrench) in sections {
            let lever = LENGTH + 0.5 - x;
            let bending = [moment[0], moment[1] - lever * force[2], moment[2] + lever * force[1]];
            assert_close(&format!("{joint}, x = {x}"), wrench, [force, bending].map(|of| of.map(|x| scale * x)));
        }
    }
}

/// A load that acts between the ends is transmitted only by the sections before it, not by those beyond.
#[test]
fn a_load_is_carried_from_where_it_acts() {
    let chain = loaded_beam(
        "fixed",
        "[0, 0, 0]",
        "symmetric",
        "loads: [{name: pull, link: beam, at: [1.2, 0, 0], force: [0, 100, 0]}]",
    );
    let rest = vec![0.0; chain.coordinates.len()];
    let wrenches = wrenches(&chain, &rest, &rest, &rest);
    let sections = sections(&chain, &wrenches);
    assert_eq!(
        sections.iter().filter(|(x, ..)| *x == 1.2).map(|(_, side, _)| *side).collect::<Vec<_>>(),
        [Side::Before, Side::After]
    );
    for (x, side, wrench) in sections {
        let inside = x < 1.2 || side == Side::Before;
        let expected = if inside { [[0.0, 100.0, 0.0], [0.0, 0.0, 100.0 * (1.2 - x)]] } else { [[0.0; 3]; 2] };
        assert_close(&format!("x = {x}"), wrench, expected);
    }
    assert_close("ground", wrenches[0], [[0.0, 100.0, 0.0], [0.0, 0.0, 120.0]]);
}

/// Links on a beam are carried by the sections before the place that they are attached to: one at a place between the ends, one at the
/// beginning, and two at the tip, of which each is carried by all of the beam.
#[test]
fn branches_are_carried_from_where_they_begin() {
    const G: f64 = 9.81;
    let side = "{name: side, on: {link: beam, at: [1.2, 0, 0]}, joint: revolute, mass: 25, com: [0.3, 0, 0]}";
    let other = "{name: other, on: {link: beam, at: start}, mass: 70, com: [0, 0.1, 0]}";
    let second = "{name: second, on: beam, mass: 15, com: [0.2, 0, 0]}";
    let links = |links: [&str; 3]| links.map(|link| format!("  - {link}\n")).concat();
    for order in [[side, other, second], [second, side, other]] {
        let chain = loaded_beam("fixed", "[0, 0, -9.81]", "symmetric", &links(order));
        let rest = vec![0.0; chain.coordinates.len()];
        let wrenches = wrenches(&chain, &rest, &rest, &rest);
        let sections = sections(&chain, &wrenches);
        let at =
            |place: f64| sections.iter().filter(|(x, ..)| *x == place).map(|(_, side, _)| *side).collect::<Vec<_>>();
        assert_eq!(at(1.2), [Side::Before, Side::After]);
        assert_eq!(at(0.0), [Side::Before, Side::After]);
        for (x, side, wrench) in &sections {
            let beyond = LENGTH - x;
            let line = DENSITY * AREA * G;
            let mut weight = line * beyond + (LOAD + 15.0) * G;
            let mut moment = [0.0, line * beyond * beyond / 2.0 + LOAD * G * beyond + 15.0 * G * (beyond + 0.2), 0.0];
            if *x < 1.2 || (*x == 1.2 && *side == Side::Before) {
                weight += 25.0 * G;
                moment[1] += 25.0 * G * (1.2 + 0.3 - x);
            }
            if *x == 0.0 && *side == Side::Before {
                weight += 70.0 * G;
                moment[0] -= 70.0 * G * 0.1;
            }
            assert_close(&format!("x = {x}, {side:?}"), *wrench, [[0.0, 0.0, -weight], moment]);
        }
    }
}

/// `N = ∫ ρAω² x dx + m ω² l`; and with an angular acceleration α, `Qy = −α (∫ ρA x dx + m l)` and
/// `Mz = −α (∫ ρA x (x − x₀) dx + m l (l − x₀) + ρ J_z (l − x₀))`, the last term due to the rotary inertia of the sections.
#[test]
fn a_turning_beam_pulls_by_its_centrifugal_force() {
    let (rate, speeding) = (7.0, 3.0);
    let chain = beam("revolute", "[0, 0, 0]", "symmetric");
    let mut q = vec![0.0; chain.coordinates.len()];
    let (mut v, mut a) = (q.clone(), q.clone());
    (q[0], v[0], a[0]) = (0.4, rate, speeding);
    for (x, _, wrench) in sections(&chain, &wrenches(&chain, &q, &v, &a)) {
        let integral = |power: i32| (LENGTH.powi(power) - x.powi(power)) / f64::from(power);
        let line = DENSITY * AREA;
        let first = line * integral(2) + LOAD * LENGTH;
        let second = line * (integral(3) - x * integral(2)) + LOAD * LENGTH * (LENGTH - x);
        let turning = DENSITY * JZ * (LENGTH - x);
        let expected = [[rate * rate * first, -speeding * first, 0.0], [0.0, 0.0, -speeding * (second + turning)]];
        assert_close(&format!("x = {x}"), wrench, expected);
    }
}

/// A weight that is offset from the beam's axis twists the beam, and bends it about y.
#[test]
fn an_eccentric_load_twists() {
    let chain = crane(
        "links:
  - name: arm
    joint: revolute
    beam:
      length: 2
      sections: rigid
      material: {E: 2.1e11, G: 8.1e10, density: 1}
      section: {numbers: {area: 1e-4, Jy: 1e-9, Jz: 1e-9, Jo: 1e-9}}
  - {name: load, mass: 100, com: [0, 0.5, 0]}
",
    );
    let wrenches = wrenches(&chain, &[0.0], &[0.0], &[0.0]);
    let [(_, _, section), _] = sections(&chain, &wrenches)[..] else { panic!("one element") };
    let weight = -9.81 * 100.0;
    let weight_of_arm = -9.81 * 2e-4;
    assert_close(
        "arm",
        section,
        [[0.0, 0.0, weight + weight_of_arm], [0.5 * weight, -2.0 * weight - weight_of_arm, 0.0]],
    );
}

/// The tension m (g + a) in a hoist that accelerates, and the guide's moment due to an offset load.
#[test]
fn a_hoist_pulls_more_as_it_speeds_up() {
    let chain = crane("links:\n  - {name: cage, joint: {prismatic: {axis: z}}, mass: 200, com: [0.3, 0, 0]}\n");
    let force = -200.0 * (9.81 + 2.0);
    let wrenches = wrenches(&chain, &[1.5], &[0.7], &[2.0]);
    assert_close("joint", wrenches[1], [[0.0, 0.0, force], [0.0, -0.3 * force, 0.0]]);
}

/// A joint of a classic D-H row is cut at its axis, not at the link's frame: at the axis, the moment about z is the effort.
#[test]
fn a_classic_row_is_cut_at_its_axis() {
    let row = |name: &str, alpha: &str| {
        format!(
            "  - {{name: {name}, placement: {{classic_dh: {{a: 0.8, alpha: {alpha}, d: 0.3, theta: 20 deg}}}}, joint: revolute, \
             mass: 30, com: [-0.4, 0.1, 0.05]}}\n"
        )
    };
    let chain = crane(&format!("links:\n{}{}", row("one", "90 deg"), row("two", "30 deg")));
    let (q, v, a) = ([0.3, -0.7], [1.1, 0.4], [-2.0, 5.0]);
    let wrenches = wrenches(&chain, &q, &v, &a);
    // A a − e, the efforts that drives would have to exert.
    let program = mechanics::derive(&chain, Analyses::ALL);
    let inputs = Inputs::state(0.0, q.to_vec(), v.to_vec(), vec![]);
    let get = |id| program.evaluate(program.function(id).expect("every crane has it"), &inputs);
    let (mass, bias) = (get(FunctionId::MassMatrix), get(FunctionId::Bias));
    let efforts = [mass[0] * a[0] + mass[1] * a[1] - bias[0], mass[1] * a[0] + mass[2] * a[1] - bias[1]];
    // For each link there is a cut at its joint, then one at its frame.
    for (effort, wrench) in efforts.iter().zip([&wrenches[1], &wrenches[3]]) {
        assert!((effort + wrench[1][2]).abs() < ROUNDING * effort.abs(), "{effort} against {wrench:?}");
    }
    // The first axis is the world's z.
    assert_close(
        "the first joint's axis",
        [[0.0; 3], [0.0, 0.0, wrenches[0][1][2]]],
        [[0.0; 3], [0.0, 0.0, wrenches[1][1][2]]],
    );
}

/// For the reference crane, the function costs at most one and a half times as much as the bias.
#[test]
fn they_cost_little_more_than_the_bias() {
    let path = format!("{}/../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("it is shipped");
    let chain = compile::load(&SourceFile::new(&path, &text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    assert_eq!(chain.coordinates.len(), 25);
    let report = compile::report(&chain, Analyses { statics: false, modes: false, ..Analyses::COMMAND });
    let cost = |name| report.costs.iter().find(|cost| cost.function == name).expect("it is derived").operations.total();
    let (forces, bias) = (cost("internal_forces"), cost("bias"));
    assert!(2 * forces <= 3 * bias, "{forces} operations, {bias} of the bias");
}

/// If the spec does not request internal forces, the generated code does not contain them.
#[test]
fn who_does_not_ask_does_not_pay() {
    let chain = beam("revolute", "[0, 0, 0]", "symmetric");
    let code = compile::generate(&chain, chain.analyses, "test.yaml").text;
    assert!(!code.contains("fn internal_forces"));
    assert!(!code.contains("Wrench"));
    let code = compile::generate(&chain, Analyses { internal_forces: true, ..chain.analyses }, "test.yaml").text;
    assert!(code.contains("Part::InternalForces"));
}
