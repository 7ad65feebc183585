//! Expansion of links: beams of many elements, elements given one by one, live lengths, parts of a free base.

use std::time::{Duration, Instant};

use crane_codegen::chain::{Chain, Inertia, Spring, Step, Value};
use crane_codegen::{SourceFile, compile, read, validate};

/// The chain of a spec with the given links and further keys.
fn chain(rest: &str) -> Chain {
    let source = SourceFile::new("test.yaml", format!("format: 1\nname: test\n{rest}"));
    read(&source).and_then(|spec| validate(&spec)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A beam of four sections with a link on its tip; `beam` are its further keys.
fn beam(beam: &str) -> Chain {
    chain(&format!(
        "links:\n  - name: boom\n    joint: revolute\n    beam: {{length: 2, {beam}}}\n  - {{name: tip, mass: 5, com: [0, 0, 0]}}\n"
    ))
}

const STEEL: &str =
    "material: {E: 2.1e11, G: 8.1e10, density: 7850}, section: {tube: {diameter: 0.1, thickness: 0.005}}";

/// All numbers of an inertia.
fn numbers(inertia: &Inertia) -> Vec<f64> {
    [&inertia.mass].into_iter().chain(&inertia.first).chain(&inertia.second).map(|v| v.at(&[])).collect()
}

#[test]
fn elements_one_by_one_make_the_beam_of_equal_sections() {
    let equal = beam(&format!("sections: 2, {STEEL}, damping: {{beta: 2e-3}}"));
    // The same, element by element: I_y = I_z = m(l²/12 + J/A) from the first chain's pseudo-inertias.
    let elements: Vec<String> = equal.bodies[..3]
        .iter()
        .map(|body| {
            let inertia = numbers(body.inertia.as_ref().expect("an element"));
            let (m, mx, [xx, yy, zz]) = (inertia[0], inertia[1], [inertia[4], inertia[5], inertia[6]]);
            let along = xx - mx * mx / m;
            format!(
                "{{length: {:?}, mass: {m:?}, com: [{:?}, 0, 0], inertia: {{Ixx: {:?}, Iyy: {:?}, Izz: {:?}}}}}",
                body.length.at(&[]),
                mx / m,
                yy + zz,
                along + zz,
                along + yy
            )
        })
        .collect();
    let springs: Vec<&Spring> = equal.element_springs().collect();
    let springs: Vec<String> = springs
        .chunks(3)
        .map(|spring| {
            let directions = |get: fn(&Spring) -> &Value| {
                let [psi, theta, phi] = [0, 1, 2].map(|k| get(spring[k]).at(&[]));
                format!("{{psi: {psi:?}, theta: {theta:?}, phi: {phi:?}}}")
            };
            format!("{{stiffness: {}, damping: {}}}", directions(|s| &s.stiffness), directions(|s| &s.damping))
        })
        .collect();
    let given = beam(&format!("elements: [{}], springs: [{}]", elements.join(", "), springs.join(", ")));
    assert_eq!(given.coordinates, equal.coordinates);
    assert_eq!(given.forces, equal.forces);
    for (a, b) in given.bodies.iter().zip(&equal.bodies) {
        assert_eq!(a.path, b.path);
        let (a, b) = (numbers(a.inertia.as_ref().expect("mass")), numbers(b.inertia.as_ref().expect("mass")));
        // Printed with all digits and shifted twice: an error of a few ulp.
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-14 * b.abs()), "{a:?} {b:?}");
    }
}

#[test]
fn a_rigid_beam_is_one_body_of_the_same_mass() {
    let (rigid, flexible) = (beam(&format!("sections: rigid, {STEEL}")), beam(&format!("sections: 5, {STEEL}")));
    assert_eq!(rigid.coordinates.len(), 1);
    assert!(rigid.forces.is_empty());
    assert_eq!((rigid.bodies[0].name.as_str(), rigid.bodies[1].path.len()), ("boom", 1));
    assert_eq!(rigid.bodies[1].path[0], Step::Translate([2.0.into(), Value::ZERO, Value::ZERO]));
    let mass = |chain: &Chain| -> f64 { chain.bodies.iter().flat_map(|b| &b.inertia).map(|i| i.mass.at(&[])).sum() };
    assert!((mass(&rigid) / mass(&flexible) - 1.0).abs() < 1e-14);
}

#[test]
fn the_most_coordinates_are_still_regular() {
    let begin = Instant::now();
    let long = chain(&format!(
        "links:\n  - {{name: mast, joint: free, mass: 15000, com: [0, 0, 1], inertia: {{Ixx: 1e5, Iyy: 1e5, Izz: 1e5}}}}\n\
         \x20 - {{name: boom, placement: {{transform: {{translation: [0, 8, 0]}}}}, joint: revolute, beam: {{length: 2, sections: 997, {STEEL}}}}}\n\
         \x20 - {{name: log, joint: revolute, mass: 800, com: [0, 2, 1], inertia: {{Ixx: 12, Iyy: 900, Izz: 900}}}}\n"
    ));
    assert_eq!(long.coordinates.len(), 6 + 1 + 3 * 997 + 1);
    // It takes a fifth of a second without optimisation.
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
}

#[test]
fn lengths_and_sections_can_be_live() {
    let live = chain(
        "parameters: {reach: {value: 2, unit: m}, wall: {value: 0.005, unit: m}}\nlinks:\n  - name: boom\n    joint: revolute\n    \
         beam: {length: reach, sections: 2, material: {E: 2.1e11, G: 8.1e10, density: 7850}, section: {tube: {diameter: 0.1, thickness: wall}}}\n",
    );
    let fixed = beam(&format!("sections: 2, {STEEL}"));
    for (a, b) in live.element_springs().zip(fixed.element_springs()) {
        assert!((a.stiffness.at(&[2.0, 0.005]) / b.stiffness.at(&[]) - 1.0).abs() < 1e-14);
        // s = E J/d: half the length, twice the stiffness.
        assert!((a.stiffness.at(&[1.0, 0.005]) / b.stiffness.at(&[]) - 2.0).abs() < 1e-14);
    }
    assert!(live.bodies.iter().all(|body| body.inertia.as_ref().is_some_and(|i| i.mass.as_constant().is_none())));
}

#[test]
fn a_base_moves_in_the_order_of_its_coordinates() {
    let base = chain(
        "links:\n  - {name: base, joint: {free: [phi, z, psi]}, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}\n\
         supports:\n  - {name: foot, at: [1, 0, 0], stiffness: [1e5, 1e5, 1e5]}\n",
    );
    let names: Vec<_> = base.coordinates.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["base_z", "base_psi", "base_phi"]);
    assert_eq!(base.base.map(|id| id.map(|id| id.0)), [None, None, Some(0), Some(1), None, Some(2)]);
    assert_eq!(base.bodies[0].path.len(), 3);
}

#[test]
fn bodies_are_lumped_and_keep_their_names() {
    let lumped = chain(
        "links:\n  - name: arm\n    joint: revolute\n    bodies:\n      - {name: a, mass: 1, com: [1, 0, 0]}\n      \
         - {name: b, mass: 3, com: [0, 2, 0], inertia: {about: origin, Ixx: 13, Iyy: 2, Izz: 14, Ixy: 0}}\n",
    );
    let body = &lumped.bodies[0];
    assert_eq!(body.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
    // ∫x² = 1 · 1² + ½(−13 + 2 + 14), ∫y² = ½(13 − 2 + 14), ∫z² = ½(13 + 2 − 14)
    let all = numbers(body.inertia.as_ref().expect("mass"));
    assert_eq!(all, [4.0, 1.0, 6.0, 0.0, 1.0 + 1.5, 12.5, 0.5, 0.0, 0.0, 0.0]);
}

#[test]
fn anchors_and_aliases_work() {
    let twice = chain(
        "links:\n  - {name: a, joint: revolute, mass: 1, com: &c [1, 0, 0], inertia: &i {Ixx: 1, Iyy: 1, Izz: 1}}\n  \
         - {name: b, joint: revolute, placement: {classic_dh: {a: 1}}, mass: 1, com: *c, inertia: *i}\n",
    );
    assert_eq!(twice.bodies[0].inertia, twice.bodies[1].inertia);
}

#[test]
fn keywords_of_rust_are_names() {
    let words = ["type", "ref", "box", "move", "gen"];
    // Parameters and inputs must not share names.
    for [parameter, input] in [["", "in_"], ["of_", ""]] {
        let parameters = words.map(|word| format!("{parameter}{word}: {{value: 10, unit: kg}}")).join(", ");
        let inputs = words.map(|word| format!("{input}{word}: {{unit: N}}")).join(", ");
        let link =
            |word| format!("  - {{name: {word}, joint: revolute, mass: {parameter}{word}, com: [1, 0.2, 0.1]}}\n");
        let load = |word| format!("{{name: {word}, link: {word}, force: [0, 1, 0], scale: {{input: {input}{word}}}}}");
        let text = format!(
            "format: 1\nname: words\nparameters: {{{parameters}}}\ninputs: {{{inputs}}}\nlinks:\n{}loads: [{}]\nanalyses: [statics, dynamics, modes, \
             internal_forces, derivatives, ensemble]\n",
            words.map(link).concat(),
            words.map(load).join(", ")
        );
        let code = compile::compile(&SourceFile::new("words.yaml", text), None).unwrap().code;
        syn::parse_file(&code.text).unwrap();
        let is_raw = code.text.contains("pub r#type: f64") && code.text.contains("pub r#gen: f64");
        assert!(is_raw || !parameter.is_empty());
    }
}

#[test]
fn names_that_end_in_an_underscore_give_code_without_warnings() {
    let spec = "format: 1\nname: box_\nlinks: [{name: arm_, joint: revolute, mass: 5, com: [1, 0, 0]}]\n";
    let code = compile::compile(&SourceFile::new("box.yaml", spec), None).expect("a sound spec").code.text;
    let items: Vec<syn::Item> = syn::parse_file(&code).expect("Rust").items;
    let mut named = 0;
    for item in items {
        let syn::Item::Fn(function) = item else { continue };
        let text = quote::quote!(#function).to_string();
        if text.contains("__") {
            assert!(text.contains("non_snake_case"), "{text}");
            named += 1;
        }
    }
    assert!(named > 0, "coordinates are called arm__psi");
}
