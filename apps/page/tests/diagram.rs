//! Diagrams of the shipped cranes: nothing is missing or out of view. The gallery of the manual.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

use crane_codegen::chain::{Chain, CoordinateId};
use crane_codegen::{SourceFile, build, compile};
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::nalgebra::Vector3;
use crane_model::statics::Settings;
use crane_page::{
    diagram::diagram,
    scene::Scene,
    shapes::{Figure, Mesh, Shape},
};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn picture(chain: &Chain) -> String {
    diagram(&LiveCrane::new(chain.clone()))
}

/// The shipped cranes, by name.
fn shipped() -> Vec<Chain> {
    cranes("specs").into_iter().map(|(_, chain)| chain).collect()
}

/// The names of the files in a folder and their cranes, by name.
fn cranes(folder: &str) -> Vec<(String, Chain)> {
    let files = fs::read_dir(root().join(folder)).expect("a folder").map(|entry| entry.expect("a file").path());
    let mut specs: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|found| found == "yaml")).collect();
    specs.sort();
    let chain = |path: PathBuf| {
        let source = build::open(&path).unwrap_or_else(|failure| panic!("{failure}"));
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        (name, compile::load(&source).unwrap_or_else(|mistakes| panic!("{mistakes}")))
    };
    specs.into_iter().map(chain).collect()
}

/// Values of an attribute.
fn values(svg: &str, attribute: &str) -> Vec<f64> {
    let pattern = format!(" {attribute}='");
    svg.split(&pattern).skip(1).filter_map(|rest| rest.split('\'').next()?.parse().ok()).collect()
}

/// Numbers between blanks and commas.
fn numbers(text: Option<&str>) -> Vec<f64> {
    text.unwrap_or_default().split([' ', ',']).filter_map(|number| number.parse().ok()).collect()
}

#[test]
fn every_name_is_shown_and_every_place_in_view() {
    for chain in shipped() {
        let svg = picture(&chain);
        let joints = chain.coordinates.iter().enumerate();
        let joints = joints.filter(|(index, _)| !chain.is_of_element(CoordinateId(*index)));
        let names = joints.map(|(_, coordinate)| &coordinate.name);
        let names = names.chain(chain.points.iter().map(|point| &point.name));
        for name in names.chain(chain.supports.iter().map(|support| &support.name)) {
            assert!(svg.contains(&format!(">{name}</text>")), "{}: {name}", chain.name);
        }
        let elements = chain.bodies.iter().filter(|body| !body.length.is_zero()).count();
        assert_eq!(svg.matches("stroke-width='7'").count(), elements, "{}", chain.name);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", chain.name);
        let [width, height] = ["width", "height"].map(|side| values(&svg, side)[0]);
        let outlines: Vec<f64> =
            svg.split("points='").skip(1).flat_map(|rest| numbers(rest.split('\'').next())).collect();
        assert!(outlines.iter().all(|value| (0.0..=width).contains(value)), "{}", chain.name);
        for (attributes, most) in [(["x1", "x2", "cx"], width), (["y1", "y2", "cy"], height)] {
            for value in attributes.iter().flat_map(|attribute| values(&svg, attribute)) {
                assert!((0.0..=most).contains(&value), "{}: {value}", chain.name);
            }
        }
    }
}

/// Two stages with two pads each, a bar on either side; only the joints that a drive, a chain or nothing holds have marks.
#[test]
fn pads_of_a_telescope_are_drawn() {
    let source = build::open(&root().join("specs/examples/telescopic_loader.yaml"))
        .unwrap_or_else(|failure| panic!("{failure}"));
    let chain = compile::load(&source).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let svg = picture(&chain);
    assert_eq!(svg.matches("stroke-width='4'").count(), 2 * 2 * 2);
    // Two stages and the hook slide; column, boom and both swings turn.
    let marks = [svg.matches("<rect x='").count(), svg.matches("r='6'").count()];
    assert_eq!(marks, [3, 4], "{svg}");
}

#[test]
fn a_horizontal_beam_is_drawn_as_long_as_it_is() {
    let cantilever = shipped().into_iter().find(|chain| chain.name == "cantilever").expect("a cantilever");
    let svg = picture(&cantilever);
    let beams: Vec<&str> = svg.lines().filter(|line| line.contains("stroke-width='7'")).collect();
    let length = |line: &&str| values(line, "x2")[0] - values(line, "x1")[0];
    // 8 sections: elements of 1/8 of the beam, half of that at both ends; positions are rounded to 0.1.
    for (index, line) in beams.iter().enumerate() {
        let part = if index == 0 || index == 8 { 0.5 } else { 1.0 };
        assert!((length(line) / length(&beams[4]) - part).abs() < 0.01, "{line}");
    }
}

/// `UPDATE_GOLDEN=1` writes the page and its pictures.
#[test]
fn the_gallery_shows_every_shipped_crane() {
    let update = env::var_os("UPDATE_GOLDEN").is_some();
    let images = root().join("docs/images/cranes");
    let mut page = "# Gallery\n\nThe shipped cranes and examples at the poses of their specs, with frames, joints, beams, supports and drives. \
                    `crane explain CRANE --svg FILE`\ndraws such a picture of any crane. Masses are those with default parameters.\n"
        .to_owned();
    let all = [("run", "specs"), ("example", "specs/examples")];
    for (command, (name, chain)) in
        all.into_iter().flat_map(|(command, folder)| cranes(folder).into_iter().map(move |one| (command, one)))
    {
        let image = images.join(format!("{name}.svg"));
        if update {
            fs::create_dir_all(&images).expect("a folder");
            fs::write(&image, picture(&chain)).expect("a picture");
        }
        let shown = fs::read_to_string(&image).unwrap_or_default();
        assert!(shown == picture(&chain), "{} is not current: run this test with UPDATE_GOLDEN=1", image.display());
        let title = &chain.title;
        let parameters = chain.parameter_defaults();
        let mass: f64 = chain
            .bodies
            .iter()
            .filter_map(|body| body.inertia.as_ref())
            .map(|inertia| inertia.mass.at(&parameters))
            .sum();
        let (coordinates, bodies) = (chain.coordinates.len(), chain.bodies.len());
        let (supports, drives) = (chain.supports.len(), chain.drives.len());
        let _ = write!(
            page,
            "\n## {title}\n\n`crane {command} {name}`: {coordinates} coordinates, {bodies} bodies, {supports} supports, {drives} drives, \
             {mass:.0} kg\n\n![{title}: frames, joints and beams, with a table of coordinates](../images/cranes/{name}.svg)\n"
        );
    }
    page += "\nNext: [The spec language](../SPEC.md) of these cranes, or back to [First crane in ten minutes](first-crane.md).\n";
    let path = root().join("docs/manual/gallery.md");
    if update {
        fs::write(&path, &page).expect("a page");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(written, page, "{} is not current: run this test with UPDATE_GOLDEN=1", path.display());
}

/// Bars, forms, springs, pins of loops and masses of a diagram are those of the scene, which pages draw, too.
#[test]
fn a_diagram_shows_what_pages_show() {
    let text = "format: 1\nname: arm\nlinks:\n\
        - {name: arm, joint: {revolute: {axis: y}}, mass: 20, com: [1, 0, 0.4]}\n\
        - {name: head, placement: {transform: {translation: [2, 0, 0]}}, joint: {revolute: {axis: y}}, mass: 5, com: [0.3, 0, 0],\n   \
           shape: [{box: {size: [0.4, 0.2, 0.3], at: [0.2, 0, 0]}}, {capsule: {diameter: 0.1, length: 0, at: [0.4, 0, 0]}}]}\n\
        - {name: tie, on: arm, joint: {revolute: {axis: y}}, mass: 1, com: [0.2, 0, 0]}\n\
        connectors: [{name: coil, from: {at: [0, 0, 1]}, to: {link: head, at: [0.3, 0, 0.2]}, law: {spring: {stiffness: 10, length: 1}}}]\n\
        loop_joints: [{name: ring, from: {link: tie, at: [0.4, 0, 0]}, to: {link: head, at: [0.3, 0, 0]}, joint: ball}]\n";
    let chain = compile::load(&SourceFile::new("arm.yaml", text)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let scene = Scene::new(&LiveCrane::new(chain.clone()), &chain.guess);
    let svg = picture(&chain);
    let count = |text: &str| svg.matches(text).count();
    let links = scene.bodies.len();
    let thick = scene.bars.iter().filter(|bar| bar.main).count();
    assert!(scene.bars.len() > thick, "{}", scene.bars.len());
    assert_eq!(count("stroke-width='3'"), links + thick + 1, "links, thick bars, and the halo of labels");
    assert_eq!(count("stroke-width='1.6' stroke-linecap"), scene.bars.len() - thick);
    assert_eq!([count("<polygon"), count("stroke-width='2.4'"), count("r='4.5'")], [2, 1, scene.hinges.len()]);
    assert_eq!(count("fill-opacity='0.35'"), 3);
    // The outline of the box is a hexagon in this projection.
    let outline = numbers(svg.split("points='").nth(1).and_then(|rest| rest.split('\'').next()));
    assert_eq!(outline.len(), 12, "{outline:?}");
}

/// A rocker and a link keep their lengths, and the cylinder has the length with which its forces are computed; to a few roundings of lengths of 1 m.
#[test]
fn a_cylinder_is_drawn_as_long_as_it_is() {
    let boom = |side: &str| {
        let text = format!(
            "format: 1\nname: boom\nlinks:\n  - {{name: mast, mass: 100, com: [0, 0, 1], inertia: {{Ixx: 9, Iyy: 9, Izz: 1}}}}\n  \
             - {{name: boom, placement: {{transform: {{translation: [0, 0, 2], rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: 50, \
             com: [1, 0, 0], inertia: {{Ixx: 1, Iyy: 9, Izz: 9}}}}\n\
             drives:\n  - {{coordinate: boom_psi, stiffness: 1e7, motion: {{hold: 0.3}}}}\n\
             cylinders:\n  - name: lift\n    coordinate: boom_psi\n    foot: {{link: mast, at: [0.3, 0, 0.6]}}\n    \
             head: {{link: boom, at: [0.5, -0.1, 0]}}\n    \
             linkage: {{pivot: [0.1, 0, 1.7], rocker: 0.4, link: 0.45, side: {side}}}\n    \
             bore: 0.1\n    rod: 0.06\n    retracted: 0.9\n    stroke: 0.8\n"
        );
        LiveCrane::from_spec(&SourceFile::new("boom.yaml", text)).unwrap_or_else(|mistakes| panic!("{mistakes}"))
    };
    let lengths = ["left", "right"].map(|side| {
        let live = boom(side);
        let scene = Scene::new(&live, &[0.3]);
        let frames: Vec<_> = scene.bodies.iter().map(|body| body.frame).collect();
        let pins = scene.cylinders[0].pins(&frames);
        let mut states = [Vector3::zeros()];
        (&live as &dyn DynCrane).cylinder_states(&[0.3], &[0.0], &mut states);
        let computed = states[0].x;
        let drawn = (pins.rod - pins.foot).norm();
        assert!((drawn - computed).abs() < 1e-14, "{side}: drawn {drawn}, computed {computed}");
        let pivot = pins.pivot.expect("a pivot");
        assert!(
            ((pivot - pins.rod).norm() - 0.4).abs() < 1e-14 && ((pins.head - pins.rod).norm() - 0.45).abs() < 1e-14
        );
        drawn
    });
    assert!((lengths[0] - lengths[1]).abs() > 0.1, "the sides differ: {lengths:?}");
}

/// Of each colour of each crane at rest: shapes, their corners, the mean of these in the world, m, their standard deviations, and the volume within, m³.
fn drawn() -> String {
    let mut text = String::new();
    for (name, chain) in cranes("specs").into_iter().chain(cranes("specs/examples")) {
        let live = LiveCrane::new(chain);
        let q = (&live as &dyn DynCrane).equilibrium(&Settings::default()).q;
        let figure = Figure::new(&live, &q, &q);
        let mut paints: Vec<&str> = figure.shapes.iter().map(|shape| shape.paint.name).collect();
        paints.sort_unstable();
        paints.dedup();
        for paint in paints {
            let shapes: Vec<&Shape> = figure.shapes.iter().filter(|shape| shape.paint.name == paint).collect();
            let corners: Vec<Vector3<f64>> = shapes.iter().flat_map(|shape| figure.corners(shape)).collect();
            let count = corners.len() as f64;
            let mean = corners.iter().sum::<Vector3<f64>>() / count;
            let squares = corners.iter().map(|corner| (corner - mean).map(|x| x * x)).sum::<Vector3<f64>>();
            let spread = (squares / count).map(f64::sqrt);
            // A surface that is turned inside out, or twisted, has another volume.
            let of_mesh = |mesh: &Mesh| -> f64 {
                let triangle = |corners: &[usize; 3]| {
                    let [a, b, c] = corners.map(|corner| mesh.corners[corner]);
                    a.dot(&b.cross(&c)) / 6.0
                };
                mesh.triangles.iter().map(triangle).sum()
            };
            let volume: f64 = shapes.iter().map(|shape| of_mesh(&shape.mesh)).sum();
            let _ = write!(text, "{name} {paint} {} {}", shapes.len(), corners.len());
            for number in mean.iter().chain(&spread).chain([&volume]) {
                let _ = write!(text, " {number:.5}");
            }
            text.push('\n');
        }
    }
    text
}

/// A picture changes on purpose alone: `UPDATE_GOLDEN=1` writes what is drawn.
#[test]
fn what_is_drawn_stays() {
    let path = root().join("apps/page/tests/drawn.txt");
    let found = drawn();
    if env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&path, &found).expect("a file");
    }
    let known = fs::read_to_string(path).expect("a file");
    assert_eq!(found.lines().count(), known.lines().count());
    for (found, known) in found.lines().zip(known.lines()) {
        // Half a digit of rounding, and as much of statics.
        let near = |(one, other): (&str, &str)| match [one, other].map(str::parse::<f64>) {
            [Ok(one), Ok(other)] => (one - other).abs() < 2e-5,
            _ => one == other,
        };
        assert!(found.split(' ').zip(known.split(' ')).all(near), "{found}\nnot\n{known}");
    }
}
