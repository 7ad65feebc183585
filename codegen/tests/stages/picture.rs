//! Pictures of the shipped cranes: nothing is missing or out of view. The gallery of the manual.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

use crane_codegen::chain::{Chain, CoordinateId};
use crane_codegen::{build, compile, picture};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
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

#[test]
fn every_name_is_shown_and_every_place_in_view() {
    for chain in shipped() {
        let svg = picture::picture(&chain);
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
    let svg = picture::picture(&chain);
    assert_eq!(svg.matches("stroke-width='4'").count(), 2 * 2 * 2);
    // Two stages and the hook slide; column, boom and both swings turn.
    let marks = [svg.matches("<rect x='").count(), svg.matches("r='6'").count()];
    assert_eq!(marks, [3, 4], "{svg}");
}

#[test]
fn a_horizontal_beam_is_drawn_as_long_as_it_is() {
    let cantilever = shipped().into_iter().find(|chain| chain.name == "cantilever").expect("a cantilever");
    let svg = picture::picture(&cantilever);
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
            fs::write(&image, picture::picture(&chain)).expect("a picture");
        }
        assert!(image.exists(), "there is no {}: run this test with UPDATE_GOLDEN=1", image.display());
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
    let path = root().join("docs/manual/gallery.md");
    if update {
        fs::write(&path, &page).expect("a page");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(written, page, "{} is not current: run this test with UPDATE_GOLDEN=1", path.display());
}
