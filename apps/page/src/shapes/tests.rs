use crane_model::statics::Settings;
use nalgebra::UnitQuaternion;
use serde_json::Value;

use super::{
    picture::{View, draw},
    *,
};
use crate::{
    Program,
    tests::{EXAMPLES, example, live},
};

const PROGRAM: Program = Program { name: "test", version: "0" };

fn cranes() -> impl Iterator<Item = (&'static str, LiveCrane)> {
    let shipped = crane_specs::SPECS.iter().map(|(name, _)| (*name, live(name)));
    shipped.chain(EXAMPLES.map(|(name, text)| (name, example(name, text))))
}

fn figure(live: &LiveCrane) -> Figure {
    let q = (live as &dyn DynCrane).equilibrium(&Settings::default()).q;
    Figure::new(live, &q, &q)
}

/// The parts of a GLB file.
fn parts(bytes: &[u8]) -> (Value, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("a word")) as usize;
    assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
    let text = word(12);
    assert_eq!((&bytes[16..20], &bytes[24 + text..28 + text]), (&b"JSON"[..], &b"BIN\0"[..]));
    assert_eq!(28 + text + word(20 + text), bytes.len());
    (serde_json::from_slice(&bytes[20..20 + text]).expect("JSON"), &bytes[28 + text..])
}

/// An index or a length.
fn whole(value: &Value) -> usize {
    serde_json::from_value(value.clone()).expect("a whole number")
}

/// Frames of all nodes in the world of a spec.
fn frames(document: &Value) -> Vec<Matrix4<f64>> {
    fn visit(nodes: &Value, index: usize, outer: Matrix4<f64>, found: &mut [Matrix4<f64>]) {
        let node = &nodes[index];
        let numbers = |key: &str| -> Vec<f64> { serde_json::from_value(node[key].clone()).unwrap_or_default() };
        let mut own = Matrix4::identity();
        if let [x, y, z, w] = numbers("rotation")[..] {
            own = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z)).to_homogeneous();
        }
        if let [x, y, z] = numbers("translation")[..] {
            own = Matrix4::new_translation(&Vector3::new(x, y, z)) * own;
        }
        found[index] = outer * own;
        for child in node["children"].as_array().into_iter().flatten() {
            visit(nodes, whole(child), found[index], found);
        }
    }
    let nodes = &document["nodes"];
    let mut found = vec![Matrix4::zeros(); nodes.as_array().expect("nodes").len()];
    // Back from y up.
    let upright = Matrix4::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
    visit(nodes, 0, upright, &mut found);
    found
}

/// Nodes have the names and places of bodies and points at rest, to the rounding of a product of frames; corners are single precision.
#[test]
fn nodes_and_corners_are_where_bodies_and_points_are() {
    for (name, live) in cranes() {
        let (figure, crane) = (figure(&live), &live as &dyn DynCrane);
        let q = crane.equilibrium(&Settings::default()).q;
        let bytes = gltf::binary(&figure, name, PROGRAM);
        let (document, numbers) = parts(&bytes);
        let found = frames(&document);
        let size = figure.all_corners().iter().map(nalgebra::Matrix::norm).fold(1.0, f64::max);
        let names: Vec<&str> =
            document["nodes"].as_array().expect("nodes").iter().filter_map(|node| node["name"].as_str()).collect();
        let bodies = live.chain().bodies.iter().map(|body| body.name.as_str()).zip(crane.transforms_at(&q));
        let points = live.chain().points.iter().map(|point| point.name.as_str());
        let points = points.zip(crane.points_at(&q).into_iter().map(|at| Matrix4::new_translation(&at)));
        for (index, (part, frame)) in bodies.chain(points).enumerate() {
            assert_eq!(names[index + 1], part, "{name}");
            let off = (found[index + 1] - frame).column(3).norm();
            assert!(off < 1e-12 * size, "{name}: {part} is {off} m from its place");
        }
        let mut corners = Vec::new();
        for (node, frame) in document["nodes"].as_array().expect("nodes").iter().zip(&found) {
            if node["mesh"].is_null() {
                continue;
            }
            for primitive in document["meshes"][whole(&node["mesh"])]["primitives"].as_array().expect("primitives") {
                let accessor = &document["accessors"][whole(&primitive["attributes"]["POSITION"])];
                let view = &document["bufferViews"][whole(&accessor["bufferView"])];
                let [first, length] = ["byteOffset", "byteLength"].map(|key| whole(&view[key]));
                let number = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().expect("a number")));
                let all: Vec<f64> = numbers[first..first + length].chunks(4).map(number).collect();
                corners.extend(all.chunks(3).map(|at| (frame * Vector3::from_row_slice(at).push(1.0)).xyz()));
            }
        }
        let range = |corners: &[Vector3<f64>]| {
            let [low, high] = [Vector3::inf, Vector3::sup]
                .map(|of| corners.iter().copied().reduce(|a, b| of(&a, &b)).expect("corners"));
            [low, high]
        };
        let expected = figure.all_corners();
        assert_eq!(corners.len(), expected.len(), "{name}");
        for (found, expected) in range(&corners).iter().zip(range(&expected)) {
            assert!((found - expected).norm() < 1e-6 * size, "{name}: {found} instead of {expected}");
        }
    }
}

/// Surfaces are closed: every edge belongs to two triangles, once in each direction.
#[test]
fn shapes_are_closed() {
    for (name, live) in cranes() {
        for shape in &figure(&live).shapes {
            let edges = || shape.mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let known: std::collections::HashSet<[usize; 2]> = edges().collect();
            assert!(edges().all(|[a, b]| known.contains(&[b, a])), "{name}: {:?} {}", shape.owner, shape.paint.name);
            assert_eq!(known.len(), edges().count(), "{name}: {:?} {}", shape.owner, shape.paint.name);
        }
    }
}

/// Corners of the triangles lie on the solid that URDF and MJCF get, and reach its ends; to the rounding of places some 10 m away.
#[test]
fn solids_are_those_of_the_triangles() {
    use crane_codegen::chain::Form;
    for (name, live) in cranes() {
        let figure = figure(&live);
        let (looks, files) = looks::looks(&figure, "meshes");
        assert_eq!(looks.len(), figure.shapes.iter().filter(|shape| !matches!(shape.owner, Owner::Part(_))).count());
        for (frame, form, mesh) in figure
            .shapes
            .iter()
            .filter_map(|shape| shape.mesh.solid.as_ref().map(|(frame, form)| (frame, form, &shape.mesh)))
        {
            let within: Vec<Vector3<f64>> = (mesh.corners.iter())
                .map(|corner| {
                    frame.local(&crane_codegen::chain::Frame { origin: (*corner).into(), ..*frame }).origin.into()
                })
                .collect();
            let off = match form {
                Form::Box(sides) => {
                    let beside = |at: &Vector3<f64>| (2.0 * at.abs() - Vector3::from(*sides)).amax();
                    within.iter().map(beside).fold(0.0, f64::max)
                }
                Form::Cylinder { diameter, length } => {
                    let beside = |at: &Vector3<f64>| {
                        (at.xy().norm() - diameter / 2.0).abs().max((at.z.abs() - length / 2.0).abs())
                    };
                    within.iter().map(beside).fold(0.0, f64::max)
                }
                Form::Capsule { diameter, length } => {
                    let line = |at: &Vector3<f64>| Vector3::z() * at.z.clamp(-length / 2.0, length / 2.0);
                    let beside = |at: &Vector3<f64>| ((at - line(at)).norm() - diameter / 2.0).abs();
                    within.iter().map(beside).fold(0.0, f64::max)
                }
                Form::Mesh { .. } => panic!("{name}: triangles are not a solid"),
            };
            assert!(off < 1e-13 * 10.0, "{name}: {form:?} is {off} m from its triangles");
        }
        let meshes = looks.iter().filter_map(|look| match &look.form {
            Form::Mesh { file, .. } => Some(file.as_str()),
            _ => None,
        });
        let meshes: std::collections::BTreeSet<&str> = meshes.collect();
        assert!(meshes.into_iter().eq(files.keys().map(String::as_str)), "{name}");
        for (file, bytes) in &files {
            let count = u32::from_le_bytes(bytes[80..84].try_into().expect("a number")) as usize;
            assert_eq!(bytes.len(), 84 + 50 * count, "{name}: {file}");
            let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().expect("a number")));
            let shape = figure.shapes.iter().filter(|shape| shape.mesh.solid.is_none());
            let first = [96, 100, 104].map(number);
            let begins = |mesh: &Mesh| (mesh.corners[mesh.triangles[0][0]] - Vector3::from(first)).norm() < 1e-6;
            assert!(shape.map(|shape| &shape.mesh).any(begins), "{name}: {file} begins at {first:?}");
        }
    }
}

/// A link that is an arm of 2 m, in these words.
fn arm(shape: &str) -> LiveCrane {
    let text = format!(
        "format: 1\nname: arm\nparameters: {{across: {{value: 0.2}}}}\nlinks:\n- {{name: arm, joint: {{revolute: {{axis: y}}}}, mass: 20, com: [1, 0, 0.4]{shape}}}\n\
         points: [{{name: tip, link: arm, at: [2, 0, across]}}]\n"
    );
    let source = crane_codegen::SourceFile::new("arm.yaml", &text);
    LiveCrane::from_spec(&source).unwrap_or_else(|told| panic!("{told}"))
}

/// A capsule along y, turned about z by 30°: its ends are `(0.5 + 0.1)` m from its middle along `(−sin 30°, cos 30°, 0)`. It follows a parameter, and is
/// all that is drawn besides the pin: no stem to the point, no bar to the centre of mass. A capsule is between its two half balls what URDF gets as a cylinder.
#[test]
fn a_form_takes_the_place_of_what_is_guessed() {
    let capsule = ", shape: {capsule: {diameter: across, length: 1, axis: y, at: [1, 0, 0], rotation: {z: 30 deg}}}";
    let live = arm(capsule);
    let figure = figure(&live);
    let own = |figure: &Figure| figure.shapes.iter().filter(|shape| shape.owner == Owner::Body(0)).count();
    assert_eq!(own(&figure), 2);
    assert!(own(&self::figure(&arm(""))) > 3);
    let shape = figure.shapes.iter().find(|shape| shape.paint == LINK).expect("a capsule");
    let along = Vector3::new(-0.5, 0.75_f64.sqrt(), 0.0);
    let reach = |along: Vector3<f64>| {
        let ways = shape.mesh.corners.iter().map(move |corner| (corner - Vector3::x()).dot(&along));
        ways.fold(0.0, f64::max)
    };
    // Rounding of numbers about 1; across, 16 corners of a circle contain z.
    for (along, expected) in [(along, 0.6), (-along, 0.6), (Vector3::z(), 0.1)] {
        assert!((reach(along) - expected).abs() < 1e-15, "{along}: {}", reach(along));
    }
    let parts = figure.json()["parts"].clone();
    let drawn =
        parts.as_array().and_then(|parts| parts.iter().find(|part| part["kind"] == "capsule")).expect("a capsule");
    assert_eq!((&drawn["body"], &drawn["paint"]), (&0.into(), &"link".into()), "{parts}");
    assert_eq!(drawn["sides"], serde_json::json!([0.2_f32, 0.2_f32, 1.2_f32]));
    let urdf = crane_codegen::exchange::urdf(live.chain(), live.parameters(), &[]).expect("an open chain");
    assert_eq!(
        ["<cylinder radius=\"0.1\" length=\"1\"/>", "<sphere radius=\"0.1\"/>"].map(|one| urdf.matches(one).count()),
        [1, 2],
        "{urdf}"
    );
}

/// A surface in a file is not read: pages show the guess, other programs the file, once, though it is on the link twice.
#[test]
fn a_mesh_is_named_in_exports() {
    let mesh = "{mesh: {file: parts/arm.stl, scale: 0.001}}";
    let live = arm(&format!(", shape: [{mesh}, {mesh}, {}]", mesh.replace("0.001", "0.002")));
    let (figure, guessed) = (figure(&live), figure(&arm("")));
    assert_eq!(figure.shapes.len(), guessed.shapes.len());
    let (looks, files) = looks::looks(&figure, "meshes");
    assert!(files.is_empty() && looks.iter().filter(|look| look.body.is_some()).count() == 3);
    let (parameters, start) = (live.parameters(), [0.0]);
    let mjcf =
        crane_codegen::exchange::mjcf(live.chain(), parameters, &looks, (&start, "rest")).expect("an open chain");
    for (text, count) in [
        ("<mesh name=\"arm\" file=\"parts/arm.stl\" inertia=\"shell\" scale=\"0.001 0.001 0.001\"/>", 1),
        ("<mesh name=\"arm_2\" file=\"parts/arm.stl\"", 1),
        ("<geom type=\"mesh\" mesh=\"arm\"/>", 2),
    ] {
        assert_eq!(mjcf.matches(text).count(), count, "{text}: {mjcf}");
    }
}

/// A point may have the name of its link, and a spring that of a point.
#[test]
fn no_two_nodes_share_a_name() {
    let text = "format: 1\nname: bob\nlinks:\n- {name: bob, joint: {revolute: {axis: y}}, mass: 2, com: [0, 0, -1]}\n\
                points: [{name: bob, link: bob, at: [0, 0, -1]}, {name: ground, link: bob, at: [0, 0, -2]}]\n\
                connectors: [{name: bob, from: {at: [1, 0, 0]}, to: {link: bob, at: [0, 0, -1]}, law: {spring: {stiffness: 10, length: 1}}}]\n";
    let live =
        LiveCrane::from_spec(&crane_codegen::SourceFile::new("bob.yaml", text)).unwrap_or_else(|told| panic!("{told}"));
    let document: Value = serde_json::from_str(&gltf::text(&figure(&live), "bob", PROGRAM)).expect("JSON");
    let mut names: Vec<&str> =
        document["nodes"].as_array().expect("nodes").iter().filter_map(|node| node["name"].as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["bob", "bob_2", "bob_3", "bob_4", "ground", "ground_2"]);
}

#[test]
fn nothing_that_is_drawn_floats() {
    for (name, live) in cranes() {
        let floating = figure(&live).floating();
        assert!(floating.is_empty(), "{name}: {floating:?}");
    }
}

/// A load that the ground carries shows where: 1 m below its origin, at its origin's height above the ground.
#[test]
fn points_of_contact_are_drawn() {
    let text = "format: 1\nname: hoist\nlinks: [{name: load, joint: {prismatic: {axis: z}}, mass: 500, com: [0, 0, 0.5]}]\n\
                contacts: [{name: ground, link: load, at: [0, 0, -1], height: -1, stiffness: 1e9, damping: 0.1}]\n";
    let live = LiveCrane::from_spec(&crane_codegen::SourceFile::new("hoist.yaml", text))
        .unwrap_or_else(|told| panic!("{told}"));
    let figure = Figure::new(&live, &[0.2], &[0.2]);
    let ball = figure.shapes.iter().find(|shape| shape.paint == PAD).expect("a point of contact");
    let [low, high] = picture::range(&figure.corners(ball));
    assert!(((low + high) / 2.0 - Vector3::new(0.0, 0.0, -0.8)).norm() < 1e-12, "from {low} to {high}");
    assert!(figure.floating().is_empty(), "{:?}", figure.floating());
}

/// A platform that begins 5 cm beside the tip of the beam that carries it hangs together with it, by a bar.
#[test]
fn what_begins_beside_a_beam_has_a_bar() {
    let text = "format: 1\nname: jib\nmaterials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 7e8}}\nlinks:\n\
                - {name: jib, joint: revolute, beam: {length: 2.2, sections: 1, material: steel, section: {solid: {height: 0.08, width: 0.0651}}}}\n\
                - {name: deck, placement: {classic_dh: {theta: 0.6, d: 0.02, a: 0.05, alpha: 10 deg}}, mass: 89, com: [0.3, 0.3, 0], inertia: {gyration: [0.3, 0.35, 0.4]}}\n\
                drives: [{coordinate: jib_psi, stiffness: 1e7, motion: {hold: 0}}]\n";
    let live =
        LiveCrane::from_spec(&crane_codegen::SourceFile::new("jib.yaml", text)).unwrap_or_else(|told| panic!("{told}"));
    let figure = figure(&live);
    let tip = live
        .chain()
        .bodies
        .iter()
        .position(|body| body.name == "deck")
        .and_then(|deck| live.chain().bodies[deck].parent);
    let bars = figure.scene.bars.iter().filter(|bar| tip.is_some_and(|tip| bar.body == tip.0)).count();
    assert_eq!(bars, 1);
    assert!(figure.floating().is_empty(), "{:?}", figure.floating());
}

/// Stages that do not bend are beams; they were drawn as ropes once.
#[test]
fn stages_are_no_ropes() {
    let live = example(EXAMPLES[0].0, EXAMPLES[0].1);
    let figure = figure(&live);
    let ropes: Vec<&str> = figure.scene.bodies.iter().filter(|body| body.rope).map(|body| body.name.as_str()).collect();
    assert_eq!(ropes, ["slings_1"]);
    let stage = figure.scene.bodies.iter().position(|body| body.name == "stage_one").expect("a stage");
    let shape = figure.shapes.iter().find(|shape| shape.owner == Owner::Body(stage)).expect("a shape");
    let [low, high] = picture::range(&shape.mesh.corners);
    // 3 m long, 170 mm high, 130 mm wide, as in the spec.
    assert!((high - low - Vector3::new(3.0, 0.17, 0.13)).norm() < 1e-9, "{}", high - low);
}

/// The pin of the parallel cylinder lies across the crane where the spec has it on the column, 1.35 times as long as its column is thick, and half as thick. A rod is
/// drawn from end to end, as a spring is.
#[test]
fn what_closes_a_loop_is_drawn() {
    let (name, text) =
        EXAMPLES.into_iter().find(|(name, _)| *name == "parallel_harvester").expect("a crane with a loop");
    let figure = figure(&example(name, text));
    let position = Vector3::new(-0.23, 0.0, 2.19);
    let own = figure.shapes.iter().filter(|shape| shape.owner == Owner::Body(0));
    let middles = own.map(|shape| (shape, picture::range(&shape.mesh.corners)));
    let (pin, [low, high]) =
        middles.into_iter().find(|(_, [low, high])| ((low + high) / 2.0 - position).norm() < 1e-9).expect("a pin");
    assert_eq!(pin.paint, PASSIVE);
    assert!(((high - low).y / (high - low).x - 1.35).abs() < 1e-9, "{}", high - low);
    let tied = text
        .replace("joint: {slide: {axis: [0, 1, 0]}}", "joint: {rod: {length: 0.5}}")
        .replace("at: [2.2, 0, 0]}\n    joint", "at: [2.2, 0.5, 0]}\n    joint");
    let live = example(name, &tied);
    let figure = Figure::new(&live, &live.chain().guess, &live.chain().guess);
    assert!(figure.shapes.iter().any(|shape| shape.owner == Owner::Part("parallel_pin".into())), "no rod");
}

/// Only boxes, in sight of no ground.
fn boxes(given: &[([f64; 3], [f64; 3], Paint)]) -> Figure {
    let mut figure = figure(&live("double_pendulum"));
    let owner = || Owner::Part("box".to_owned());
    figure.shapes = given
        .iter()
        .map(|&(middle, size, paint)| Shape {
            owner: owner(),
            paint,
            mesh: Mesh::block(middle.into(), size),
            detail: Detail::None,
        })
        .collect();
    figure.ground = 1e3;
    figure
}

/// A box of 1 × 2 × 1 m, seen from along x: its front is `(0.5 + 1.06 · 0.5/tan 17° + 0.02 √6) − 0.5 = 1.783` m away, so that its edges are
/// `50 · 0.5/(1.783 tan 17°) = 45.9` elements above and below the middle of the picture, and 91.7 beside it.
#[test]
fn a_box_is_where_perspective_puts_it() {
    let view = View::new([200, 100], Some(0.0), Some(0.0)).expect("a view");
    let image = draw(&boxes(&[([0.0; 3], [1.0, 2.0, 1.0], LOAD)]), &view, &[]);
    assert_eq!(image.len(), 200 * 100 * 3);
    let element =
        |row: usize, column: usize| <[u8; 3]>::try_from(&image[3 * (200 * row + column)..][..3]).expect("an element");
    // Its tone is 0.42 + 0.58/√(1 + 0.3² + 0.45²) = 0.9302, from the angle to the light, of (165, 120, 79).
    let front = [153, 112, 73];
    let sky = [238, 242, 246];
    for (row, column, expected) in [
        (50, 100, front),
        (4, 100, front),
        (3, 100, sky),
        (95, 100, front),
        (96, 100, sky),
        (50, 9, front),
        (50, 7, sky),
        (50, 190, front),
        (50, 192, sky),
    ] {
        assert_eq!(element(row, column), expected, "row {row}, column {column}");
    }
}

/// What is nearer hides what is behind it, in whatever order they come.
#[test]
fn the_nearer_box_is_seen() {
    let view = View::new([64, 64], Some(0.0), Some(0.0)).expect("a view");
    let (near, far) = (([1.0, 0.0, 0.0], [0.5; 3], LINK), ([-1.0, 0.0, 0.0], [1.5; 3], LOAD));
    let [one, other] = [[near, far], [far, near]].map(|order| draw(&boxes(&order), &view, &[]));
    assert_eq!(one, other);
    // Red over blue of the middle is that of the nearer one.
    let middle = &one[3 * (64 * 32 + 32)..];
    let ratio = |colour: &[u8]| f64::from(colour[0]) / f64::from(colour[2]);
    // Tones are rounded to whole numbers, of at least 30.
    assert!((ratio(middle) / ratio(&LINK.colour) - 1.0).abs() < 0.03, "{:?}", &middle[..3]);
}

/// No crane leaves its picture: the outermost elements are those of the sky alone.
#[test]
fn whole_cranes_are_in_their_pictures() {
    let view = |elevation| View::new([96, 64], None, Some(elevation)).expect("a view");
    for (name, live) in cranes() {
        // In sight of no ground.
        let figure = Figure { ground: 1e3, ..figure(&live) };
        for elevation in [0.37, 0.0, -0.5, 1.57] {
            let image = draw(&figure, &view(elevation), &[]);
            let is_sky = |row: usize, column: usize| image[3 * (96 * row + column)..][..3] == [238, 242, 246];
            let border = (0..96)
                .flat_map(|column| [(0, column), (63, column)])
                .chain((0..64).flat_map(|row| [(row, 0), (row, 95)]));
            assert!(border.clone().all(|(row, column)| is_sky(row, column)), "{name}, {elevation} rad");
            let crane = (0..64)
                .flat_map(|row| (0..96).map(move |column| (row, column)))
                .filter(|&(row, column)| !is_sky(row, column));
            assert!(crane.count() > 60, "{name}, {elevation} rad");
        }
    }
}

#[test]
fn pictures_are_bounded() {
    assert!(View::new([4096, 1], None, None).is_ok());
    for sides in [[0, 1], [1, 4097], [-1, 9], [i64::MAX, i64::MIN]] {
        let refused = View::new(sides, None, None).expect_err("a bound");
        assert!(refused.contains("write 1 to 4096 picture elements"), "{refused}");
    }
    assert!(View::new([1, 1], Some(f64::NAN), None).is_err());
}

/// A tetrahedron with a corner at the origin and sides of 1 along the axes, in mm: binary and textual STL, and OBJ. Each is drawn as the file and the spec say, and
/// replaces what is guessed; exports still name the file.
#[test]
fn surfaces_of_files_are_drawn() {
    use super::surfaces::read_surfaces;
    let corners = [[0.0; 3], [1000.0, 0.0, 0.0], [0.0, 1000.0, 0.0], [0.0, 0.0, 1000.0]].map(Vector3::from);
    let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let binary = looks::stl(&Mesh { corners: corners.to_vec(), triangles: triangles.clone(), solid: None });
    let vertex = |corner: usize| format!("vertex {} {} {}\n", corners[corner].x, corners[corner].y, corners[corner].z);
    let facet = |triangle: &[usize; 3]| {
        let vertices: String = triangle.iter().map(|corner| vertex(*corner)).collect();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    let text = format!("solid arm\n{}endsolid arm\n", triangles.iter().map(facet).collect::<String>());
    let object = "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 0 0 1000\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    for (file, bytes) in [("a.stl", binary), ("b.STL", text.into()), ("c.obj", object.into())] {
        let shape =
            format!(", shape: {{mesh: {{file: {file}, scale: 0.001, at: [0.5, 0, 0], rotation: {{z: 90 deg}}}}}}");
        let mut chain = arm(&shape).chain().clone();
        let unread = read_surfaces(&mut chain, "cranes/arm.yaml".as_ref(), |named, _| {
            assert_eq!(named, std::path::Path::new("cranes").join(file));
            Ok(bytes.clone())
        });
        assert_eq!(unread, None);
        let figure = figure(&LiveCrane::new(chain));
        assert_eq!(figure.shapes.iter().filter(|shape| shape.owner == Owner::Body(0)).count(), 2, "{file}: and a pin");
        let drawn = figure.shapes.iter().find(|shape| shape.paint == LINK).expect("a surface");
        assert_eq!(drawn.mesh.triangles.len(), 4);
        // Turned by 90° about z, (x, y, z) is (−y, x, z): from −1 to 0 along x, moved by 0.5. Single precision.
        let [low, high] = picture::range(&drawn.mesh.corners);
        let off = (low - Vector3::new(-0.5, 0.0, 0.0)).norm().max((high - Vector3::new(0.5, 1.0, 1.0)).norm());
        assert!(off < 1e-6, "{file}: from {low} to {high}");
        let named =
            |look: &Look| matches!(&look.form, crane_codegen::chain::Form::Mesh { file: own, .. } if own == file);
        assert_eq!(looks::looks(&figure, "meshes").0.iter().filter(|look| named(look)).count(), 1);
        assert_eq!(
            figure.json()["parts"].as_array().expect("parts").iter().filter(|part| part["kind"] == "surface").count(),
            1
        );
    }
    for (bytes, told) in [
        (Vec::new(), ""),
        (b"v 1 2 3\n".to_vec(), "no triangles"),
        (b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec(), ""),
    ] {
        let mut chain = arm(", shape: {mesh: {file: a.obj}}").chain().clone();
        let unread = read_surfaces(&mut chain, "arm.yaml".as_ref(), |_, _| Ok(bytes.clone())).expect("words");
        assert!(unread.contains("`a.obj`") && unread.contains(told), "{unread}");
    }
    let mut chain = arm(", shape: {mesh: {file: gone.stl}}").chain().clone();
    let unread = read_surfaces(&mut chain, "arm.yaml".as_ref(), |_, _| Err(std::io::ErrorKind::NotFound.into()));
    assert!(unread.is_some_and(|told| told.contains("`gone.stl`")));
}
