use crane_codegen::{SourceFile, compile};
use crane_model::dyn_crane::{DynCrane, Functions};
use nalgebra::Vector3;

use super::*;

pub(crate) fn live(name: &str) -> LiveCrane {
    let text = crane_specs::spec(name).expect("a shipped crane");
    LiveCrane::new(compile::load(&SourceFile::new(name, text)).unwrap_or_else(|mistakes| panic!("{mistakes}")))
}

/// The examples.
pub(crate) const EXAMPLES: [(&str, &str); 3] = [
    ("loader_crane", include_str!("../../../specs/examples/loader_crane.yaml")),
    ("parallel_harvester", include_str!("../../../specs/examples/parallel_harvester.yaml")),
    ("telescopic_loader", include_str!("../../../specs/examples/telescopic_loader.yaml")),
];

pub(crate) fn example(name: &str, text: &str) -> LiveCrane {
    LiveCrane::new(compile::load(&SourceFile::new(name, text)).unwrap_or_else(|mistakes| panic!("{mistakes}")))
}

/// The data in the page of a crane at rest.
fn at_rest(live: &LiveCrane, equilibrium: &Equilibrium, spec: &str) -> (String, Value) {
    let subject = Subject { label: "value", crane: live, live, equilibrium, run: None };
    let program = Program { name: "test", version: "0" };
    let page = page(&[subject], Texts { spec: Some(spec), ..Texts::default() }, program).expect("modes");
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").expect("data");
    let data = serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON");
    (page, data)
}

fn pose(crane: &Value) -> Vec<f64> {
    crane["scene"]["pose"].as_array().expect("a pose").iter().filter_map(Value::as_f64).collect()
}

#[test]
fn a_crane_without_a_run_is_shown_at_rest() {
    let live = live("eight_link_hydraulic");
    let crane: &dyn DynCrane = &live;
    let equilibrium = crane.equilibrium(&crane_model::statics::Settings::default());
    let (_, data) = at_rest(&live, &equilibrium, "");
    let written = &data["cranes"][0];
    assert!(written["record"].is_null() && data["tables"].is_null() && data["command"].is_null());
    assert_eq!(written["modes"].as_array().map(Vec::len), Some(live.size()));
    assert_eq!(written["run"]["rows"], 1);
    let pose = pose(written);
    assert_eq!(pose.len(), live.size());
    for (shown, value) in pose.iter().zip(&equilibrium.q) {
        // serde_json reads numbers to within two units in the last place.
        assert!((shown - value).abs() <= 2.0 * f64::EPSILON * value.abs(), "{shown}, {value}");
    }
}

#[test]
fn a_crane_without_an_equilibrium_is_shown_at_its_guess() {
    let live = live("knuckle_boom");
    let crane: &dyn DynCrane = &live;
    let mut equilibrium = crane.equilibrium(&crane_model::statics::Settings::default());
    equilibrium.q.fill(f64::NAN);
    equilibrium.status = crane_model::statics::Status::Overflow;
    let (_, data) = at_rest(&live, &equilibrium, "");
    assert_eq!(pose(&data["cranes"][0]), crane.guess());
}

/// Modes can be asked for after everything else: then both together are the page.
#[test]
fn modes_come_apart_from_the_crane_at_rest() {
    let live = live("eight_link_flexible");
    let crane: &dyn DynCrane = &live;
    let equilibrium = crane.equilibrium(&crane_model::statics::Settings::default());
    let subject = Subject { label: "value", crane, live: &live, equilibrium: &equilibrium, run: None };
    let program = Program { name: "test", version: "0" };
    let whole = data(&[subject], Texts::default(), program).expect("modes");
    let mut first = data_without_modes(&subject, Texts::default(), program);
    let later = modes(&subject).expect("modes");
    assert_eq!(first["cranes"][0]["modes"], json!([]));
    assert_eq!(later["modes"].as_array().map(Vec::len), Some(live.size()));
    first["cranes"][0]["modes"] = later["modes"].clone();
    let figures = first["figures"].as_array_mut().expect("figures");
    figures.extend(later["figures"].as_array().expect("figures").iter().cloned());
    assert_eq!(first, whole);
}

/// What hangs on the hook of 25 kg is a live parameter.
#[test]
fn masses_are_those_of_the_live_parameters() {
    let mut live = live("knuckle_boom");
    for payload in [800.0, 650.0] {
        live.set_parameters(&[payload]).expect("a mass");
        let scene = scene::Scene::new(&live, &(&live as &dyn DynCrane).guess());
        let hook: f64 = scene.bodies.iter().filter(|body| body.link == "hook").map(|body| body.mass).sum();
        assert_eq!(hook, 25.0 + payload);
    }
}

/// A pendulum without damping has the ratio 0, not the rounding of its eigenvalue.
#[test]
fn what_is_not_damped_says_zero() {
    let live = live("double_pendulum");
    let crane: &dyn DynCrane = &live;
    let equilibrium = crane.equilibrium(&crane_model::statics::Settings::default());
    let subject = Subject { label: "value", crane, live: &live, equilibrium: &equilibrium, run: None };
    let found = modes(&subject).expect("modes");
    assert_eq!(found["modes"][0]["damping"], 0.0);
    let note = found["figures"][0]["note"].as_str().expect("a note");
    assert!(note.ends_with("; damping ratio 0"), "{note}");
}

#[test]
fn no_text_of_a_spec_ends_the_data() {
    let live = live("double_pendulum");
    let crane: &dyn DynCrane = &live;
    let equilibrium = crane.equilibrium(&crane_model::statics::Settings::default());
    let spec = "# </script><script>alert(1)</script>";
    let (page, data) = at_rest(&live, &equilibrium, spec);
    assert_eq!((page.matches("</script>").count(), data["spec"].as_str()), (2, Some(spec)));
}

/// Everything that belongs to a body is on something that is drawn of it: seen from the list that pages draw, not from how it is made.
#[test]
fn nothing_of_a_body_floats() {
    let mut bars_of_cranes = 0;
    let shipped = crane_specs::SPECS.iter().map(|(name, _)| (*name, live(name)));
    let examples = EXAMPLES.map(|(name, text)| (name, example(name, text)));
    for (name, live) in shipped.chain(examples) {
        let crane: &dyn DynCrane = &live;
        let q = crane.guess();
        let scene = crate::scene::Scene::new(&live, &q);
        let frames = crane.transforms_at(&q);
        let reach = 0.05 * frames.iter().map(|frame| frame.column(3).xyz().norm()).fold(1.0, f64::max);
        bars_of_cranes += scene.bars.len();
        for anchor in crate::bars::anchors(&live) {
            let length = crane.body_sizes_at()[anchor.body][1];
            let mut ends = vec![[Vector3::zeros(), Vector3::x() * length]];
            ends.extend(scene.bars.iter().filter(|bar| bar.body == anchor.body).map(|bar| [bar.from, bar.to]));
            let inverse = frames[anchor.body].try_inverse().expect("a frame");
            let next = live
                .chain()
                .bodies
                .iter()
                .zip(&frames)
                .filter(|(body, _)| body.parent.is_some_and(|p| p.0 == anchor.body));
            ends.extend(next.map(|(_, frame)| [Vector3::zeros(), (inverse * frame.column(3)).xyz()]));
            let points = scene.points.iter().filter(|(_, point)| point.body == Some(anchor.body));
            let points: Vec<Vector3<f64>> = points.map(|(_, point)| point.at).collect();
            ends.extend(points.iter().map(|point| [Vector3::zeros(), *point]));
            ends.extend(points.iter().flat_map(|a| points.iter().map(move |b| [*a, *b])));
            let distance = |[from, to]: &[Vector3<f64>; 2]| {
                let way = to - from;
                let share = (anchor.at - from).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE);
                (anchor.at - from - share.clamp(0.0, 1.0) * way).norm()
            };
            let nearest = ends.iter().map(distance).fold(f64::INFINITY, f64::min);
            // The mass of a truck is its frame.
            let of_base = anchor.body == 0 && !live.chain().supports.is_empty();
            assert!(nearest < reach || of_base, "{name}: {anchor:?} is {nearest} m from what is drawn of its body");
        }
    }
    assert!(bars_of_cranes > 10, "{bars_of_cranes}");
}

/// The jib of the harvester lies beyond the joint of the rod that it carries: once, it was not drawn.
#[test]
fn what_lies_beyond_a_joint_is_drawn() {
    let live = example(EXAMPLES[1].0, EXAMPLES[1].1);
    let crane: &dyn DynCrane = &live;
    let scene = crate::scene::Scene::new(&live, &crane.guess());
    let jib = live.chain().bodies.iter().position(|body| body.link == "jib");
    let to_head = scene.bars.iter().any(|bar| Some(bar.body) == jib && bar.to.x > 4.0);
    assert!(to_head, "{:?}", scene.bars);
}

/// Of two masses of a link only the one that there is has a centre.
#[test]
fn a_mass_of_nothing_is_not_drawn() {
    let text = "format: 1\nname: two\nparameters: {load: {value: 5, unit: kg}}\nlinks: [{name: arm, joint: revolute, bodies: [{name: a, mass: 5, com: [1, \
                0, 0]}, {name: b, mass: load, com: [2, 0, 0]}]}]\n";
    let mut live = example("two", text);
    assert_eq!(crate::bars::masses(&live).len(), 2);
    live.set_parameters(&[0.0]).expect("no load");
    assert_eq!(crate::bars::masses(&live).len(), 1);
}
