//! Pictures of the shipped cranes: everything is in them, and in view.

use std::fs;
use std::path::Path;

use crane_codegen::chain::Chain;
use crane_codegen::{SourceFile, compile, picture};

fn shipped() -> Vec<Chain> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs");
    let files = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path());
    let specs = files.filter(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    let chain = |path: std::path::PathBuf| {
        let source = SourceFile::new("shipped.yaml", fs::read_to_string(path).expect("a spec"));
        compile::load(&source).unwrap_or_else(|mistakes| panic!("{mistakes}"))
    };
    specs.map(chain).collect()
}

/// Values of an attribute.
fn values(svg: &str, attribute: &str) -> Vec<f64> {
    let pattern = format!(" {attribute}='");
    svg.split(&pattern).skip(1).filter_map(|rest| rest.split('\'').next()?.parse().ok()).collect()
}

#[test]
fn every_name_is_shown_and_every_place_in_view() {
    for chain in shipped() {
        let svg = picture::picture(&chain);
        let joints = chain.coordinates.iter().enumerate();
        let joints = joints.filter(|(index, _)| !chain.elements.iter().any(|element| element.coordinate.0 == *index));
        let names = joints.map(|(_, coordinate)| &coordinate.name);
        let names = names.chain(chain.points.iter().map(|point| &point.name));
        for name in names.chain(chain.supports.iter().map(|support| &support.name)) {
            assert!(svg.contains(&format!(">{name}</text>")), "{}: {name}", chain.name);
        }
        let elements = chain.bodies.iter().filter(|body| !body.length.is_zero()).count();
        assert_eq!(svg.matches("stroke-width='7'").count(), elements, "{}", chain.name);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", chain.name);
        let [width, height] = ["width", "height"].map(|side| values(&svg, side)[0]);
        for (attributes, most) in [(["x1", "x2", "cx"], width), (["y1", "y2", "cy"], height)] {
            for value in attributes.iter().flat_map(|attribute| values(&svg, attribute)) {
                assert!((0.0..=most).contains(&value), "{}: {value}", chain.name);
            }
        }
    }
}

#[test]
fn a_horizontal_beam_is_drawn_as_long_as_it_is() {
    let cantilever = shipped().into_iter().find(|chain| chain.name == "cantilever").expect("a cantilever");
    let svg = picture::picture(&cantilever);
    let beams: Vec<&str> = svg.lines().filter(|line| line.contains("stroke-width='7'")).collect();
    let length = |line: &&str| values(line, "x2")[0] - values(line, "x1")[0];
    // 8 sections: elements of 1/8 of the beam, half of that at both ends; places are rounded to 0.1.
    for (index, line) in beams.iter().enumerate() {
        let part = if index == 0 || index == 8 { 0.5 } else { 1.0 };
        assert!((length(line) / length(&beams[4]) - part).abs() < 0.01, "{line}");
    }
}
