//! Sections of beams at pins, steps and ends: what they transmit, and their moduli.

use crane_codegen::chain::{Analyses, Chain, Cut, Section, Side};
use crane_codegen::program::{Argument, FunctionId, Inputs};
use crane_codegen::{SourceFile, mechanics, read, validate};

/// Sums of a few products: a few rounding errors of the largest term.
const ROUNDING: f64 = 1e-12;

/// Force and moment.
type Wrench = [f64; 6];

fn crane(rest: &str) -> Chain {
    let source = SourceFile::new(
        "test.yaml",
        format!("format: 1\nname: test\nmaterials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850}}}}\n{rest}"),
    );
    read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn evaluate(chain: &Chain, id: FunctionId, [q, v, a]: [&[f64]; 3]) -> Vec<f64> {
    let program = mechanics::derive(chain, Analyses::COMMAND);
    let inputs = Inputs::state(0.0, q.to_vec(), v.to_vec(), chain.parameter_defaults());
    let function = program.function(id).expect("the analyses ask for it");
    program.evaluate(function, &inputs.with(Argument::Acceleration, a.to_vec()))
}

/// All sections of beams, with what they transmit and their moduli.
fn sections(chain: &Chain, state: [&[f64]; 3]) -> Vec<(Section, Wrench, [f64; 8])> {
    let wrenches = evaluate(chain, FunctionId::InternalForces, state);
    let moduli = evaluate(chain, FunctionId::SectionModuli, state);
    let of = |(cut, wrench): (Cut, &Wrench)| {
        let mut all = chain.beams.iter().flat_map(|beam| &beam.sections);
        let section = match cut {
            Cut::Body(body) => all.find(|section| section.body == body && section.inside.is_none())?,
            Cut::Inside(beam, section) => &chain.beams[beam].sections[section],
            Cut::Ground | Cut::Joint(_) => return None,
        };
        Some((section.clone(), *wrench))
    };
    let cut = chain.cuts().into_iter().zip(wrenches.as_chunks().0).filter_map(of);
    cut.zip(moduli.as_chunks().0).map(|((section, wrench), moduli)| (section, wrench, *moduli)).collect()
}

/// Numbers without a pattern, of order one.
fn numbers(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|k| (seed + 12.9 * k as f64).sin()).collect()
}

const STATE: &str = "
loads:
  - {name: early, link: FIRST, at: [1.2, 0.1, 0], force: [30, -20, 10], moment: [1, 2, 3]}
  - {name: late, link: SECOND, at: [LATE, 0, 0.2], force: [-10, 40, 25], axes: link}
  - {name: middle, link: SECOND, at: [MIDDLE, 0, 0], force: [0, 0, 0]}
";
const TAPERED: &str = "section: {box: {height: 0.3, width: 0.2, thickness: 0.01}}, to: {box: {height: 0.2, width: 0.15, thickness: 0.01}}";
const THIN: &str = "section: {box: {height: 0.18, width: 0.12, thickness: 0.005}}";

/// A beam of two parts, and the same beam as two, one fixed to the end of the other: wherever both have a section, it transmits the same, in any
/// motion, and has the same moduli. The springs are at the same places, since something acts at the step, where a section ends.
#[test]
fn a_beam_in_two_pieces_is_the_same_beam() {
    let loads = |[first, second]: [&str; 2], [middle, late]: [&str; 2]| {
        let on = STATE.replace("FIRST", first).replace("SECOND", second);
        on.replace("LATE", late).replace("MIDDLE", middle)
    };
    let whole = crane(&format!(
        "links:
  - {{name: beam, joint: revolute, beam: {{length: 4, sections: 4, material: steel, extra_mass: 3, parts: [{{length: 2, {TAPERED}}}, {{length: 2, {THIN}}}]}}}}
  - {{name: load, mass: 70, com: [0.1, 0.2, 0.3]}}{}",
        loads(["beam"; 2], ["2", "3.1"])
    ));
    let halves = crane(&format!(
        "links:
  - {{name: first, joint: revolute, beam: {{length: 2, sections: 2, material: steel, extra_mass: 3, parts: [{{length: 2, {TAPERED}}}]}}}}
  - {{name: second, beam: {{length: 2, sections: 2, material: steel, extra_mass: 3, {THIN}}}}}
  - {{name: load, mass: 70, com: [0.1, 0.2, 0.3]}}{}",
        loads(["first", "second"], ["0", "1.1"])
    ));
    assert_eq!(whole.coordinates.len(), halves.coordinates.len());
    let count = whole.coordinates.len();
    let (q, v, a) = (numbers(count, 1.0), numbers(count, 2.0), numbers(count, 3.0));
    let of_whole = sections(&whole, [&q, &v, &a]);
    let mut compared = 0;
    for (section, wrench, moduli) in sections(&halves, [&q, &v, &a]) {
        let offset = if halves.bodies[section.body.0].link == "second" { 2.0 } else { 0.0 };
        let x = section.x.at(&[]) + offset;
        // Both ends at the step: the end of the first is before it, the beginning of the second after it.
        let side = match (x == 2.0, offset > 0.0) {
            (true, false) => Side::Before,
            (true, true) => Side::After,
            _ => section.side,
        };
        let same =
            |(other, ..): &&(Section, Wrench, [f64; 8])| (other.x.at(&[]) - x).abs() < 1e-12 && other.side == side;
        let (_, expected, expected_moduli) = of_whole.iter().find(same).unwrap_or_else(|| panic!("{x} {side:?}"));
        let size = expected.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
        for (one, other) in wrench.iter().zip(expected) {
            assert!((one - other).abs() < ROUNDING * size, "{x} {side:?}: {wrench:?} for {expected:?}");
        }
        for (one, other) in moduli.iter().zip(expected_moduli) {
            assert!((one - other).abs() <= ROUNDING * other, "{x} {side:?}: {moduli:?} for {expected_moduli:?}");
        }
        compared += 1;
    }
    // Beginnings of elements, ends, step, and both sides of two loads: the whole beam has no more. That at the beginning of the second piece has
    // two sides there.
    assert_eq!((compared, of_whole.len()), (13, 12));
}

/// Which sections there are.
#[test]
fn sections_are_where_something_happens() {
    let chain = crane(&format!(
        "links:
  - {{name: beam, joint: revolute, beam: {{length: 4, sections: 2, material: steel, parts: [{{length: 1, {TAPERED}}}, {{length: 3, {THIN}}}]}}}}
loads:
  - {{name: behind, link: beam, at: [-0.5, 0, 0], force: [1, 0, 0]}}
  - {{name: between, link: beam, at: [2, 0, 0], force: [1, 0, 0]}}
  - {{name: also, link: beam, at: [2, 0.1, 0], force: [1, 0, 0]}}
  - {{name: inside, link: beam, at: [3, 0, 0], force: [1, 0, 0]}}
  - {{name: ahead, link: beam, at: [4.5, 0, 0], force: [1, 0, 0]}}
"
    ));
    let found: Vec<(f64, Side, &str)> =
        chain.beams[0].sections.iter().map(|section| (section.x.at(&[]), section.side, section.at.as_str())).collect();
    // Sections end at 2 m and 3 m; the springs are at 1 m, 2.5 m and 3.5 m.
    let expected = [
        (0.0, Side::Before, "load behind"),
        (0.0, Side::After, "load behind"),
        (1.0, Side::Before, "beginning of part 2"),
        (1.0, Side::After, "beginning of part 2"),
        (2.0, Side::Before, "load between and load also"),
        (2.0, Side::After, "load between and load also"),
        (2.5, Side::Both, ""),
        (3.0, Side::Before, "load inside"),
        (3.0, Side::After, "load inside"),
        (3.5, Side::Both, ""),
        (4.0, Side::Before, "end and load ahead"),
        (4.0, Side::After, "end and load ahead"),
    ];
    assert_eq!(found, expected);
    // What acts behind the beginning or ahead of the end acts there.
    let rest = [0.0; 10];
    let forces: Vec<f64> = sections(&chain, [&rest, &rest, &rest]).iter().map(|(_, wrench, _)| wrench[0]).collect();
    assert_eq!(forces, [5.0, 4.0, 4.0, 4.0, 4.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 0.0]);
}

/// Sections end at live places, too, and move with them, up to the next place.
#[test]
fn live_places_keep_their_order() {
    let chain = crane(
        "parameters: {at: {value: 1.5, unit: m}}
links:
  - {name: beam, beam: {length: 4, sections: 3, material: steel, section: {circle: {diameter: 0.1}}}}
loads:
  - {name: moving, link: beam, at: [at, 0, 0], force: [1, 0, 0]}
  - {name: fixed, link: beam, at: [3, 0, 0], force: [1, 0, 0]}
",
    );
    let elements = |at: f64| chain.bodies.iter().map(|body| body.length.at(&[at])).collect::<Vec<_>>();
    assert_eq!(elements(1.5), [0.75, 1.5, 1.25, 0.5]);
    assert_eq!(elements(2.5), [1.25, 1.5, 0.75, 0.5]);
    let refusal = |at: f64| chain.relations.iter().find(|relation| relation.margin.at(&[at]) <= 0.0);
    assert!(refusal(2.999).is_none());
    for at in [3.0, 3.5] {
        assert_eq!(refusal(at).expect("it passes the other place").refusal.code, "E184");
    }
}

/// The stress of a moment, linear over the section and `M/W` at its edge, adds up to the moment, whatever the shape; that of a normal force, to the
/// force. The sections are divided into small squares.
#[test]
fn stresses_add_up_to_their_moments() {
    type Covers = fn(f64, f64) -> bool;
    let shapes: [(&str, [f64; 2], Covers); 4] = [
        ("box: {height: 0.3, width: 0.2, thickness: 0.02}", [0.3, 0.2], |y, z| {
            y.abs() < 0.15 && z.abs() < 0.1 && !(y.abs() < 0.13 && z.abs() < 0.08)
        }),
        ("solid: {height: 0.3, width: 0.2}", [0.3, 0.2], |y, z| y.abs() < 0.15 && z.abs() < 0.1),
        ("tube: {diameter: 0.3, thickness: 0.02}", [0.3, 0.3], |y, z| (0.13..0.15).contains(&y.hypot(z))),
        ("circle: {diameter: 0.3}", [0.3, 0.3], |y, z| y.hypot(z) < 0.15),
    ];
    for (shape, [height, width], covers) in shapes {
        let chain = crane(&format!(
            "links: [{{name: beam, joint: revolute, beam: {{length: 1, sections: rigid, material: steel, section: {{{shape}}}}}}}]\n"
        ));
        let (_, _, [area, about_y, about_z, ..]) = sections(&chain, [&[0.0], &[0.0], &[0.0]])[0];
        let cells = 1200;
        let (dy, dz) = (height / f64::from(cells), width / f64::from(cells));
        let (mut force, mut moments) = (0.0, [0.0; 2]);
        for i in 0..cells {
            for k in 0..cells {
                let (y, z) = ((f64::from(i) + 0.5) * dy - height / 2.0, (f64::from(k) + 0.5) * dz - width / 2.0);
                if covers(y, z) {
                    force += dy * dz / area;
                    moments[0] += z / (width / 2.0) / about_y * z * dy * dz;
                    moments[1] += y / (height / 2.0) / about_z * y * dy * dz;
                }
            }
        }
        // Squares on a round edge count fully or not at all.
        for sum in [force, moments[0], moments[1]] {
            assert!((sum - 1.0).abs() < 1e-3, "{shape}: {force} {moments:?}");
        }
    }
}
