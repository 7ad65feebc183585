use std::collections::BTreeMap;

use base64::{Engine, prelude::BASE64_STANDARD};
use crane_codegen::{SourceFile, compile};
use crane_live::LiveCrane;
use crane_model::{
    dynamics::{Method, Settings},
    runs::{Recorded, Start, record_checked},
    statics,
};

use super::*;
use crate::{Program, Subject, Texts, page};

/// What is written with four digits, relative to its size.
const FOUR_DIGITS: f64 = 5.1e-4;

fn live(name: &str, text: &str) -> LiveCrane {
    LiveCrane::new(compile::load(&SourceFile::new(name, text)).unwrap_or_else(|mistakes| panic!("{mistakes}")))
}

/// The run of a spec, and the data of its page.
fn shown(name: &str, text: &str) -> (LiveCrane, Recorded, Value) {
    let live = live(name, text);
    let crane: &dyn crane_model::dyn_crane::DynCrane = &live;
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    let start = Start::new(crane).expect("it stands");
    let settings =
        Settings { method: Method::RECOMMENDED, audit: true, ..Settings::from_description(crane.description()) };
    let go = &mut |_| std::ops::ControlFlow::Continue(());
    let recorded = record_checked(crane, &start, &settings, (false, 20.0), go).expect("it runs");
    let run = Some((&settings, &recorded));
    let subject = Subject { label: "value", crane, live: &live, equilibrium: &equilibrium, run };
    let data = data_of(&subject);
    (live, recorded, data)
}

/// The data in the page of a crane.
fn data_of(subject: &Subject<'_>) -> Value {
    let program = Program { name: "test", version: "0" };
    let page = page(std::slice::from_ref(subject), Texts::default(), program).expect("modes");
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").expect("data");
    serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON")
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_else(|| panic!("{key} in {value}"))
}

/// The figure of this name.
fn figure<'a>(data: &'a Value, key: &str) -> Option<&'a Value> {
    data["figures"].as_array().expect("figures").iter().find(|figure| figure["key"] == key)
}

/// The number in a text such as `114.5 kN m`, in SI units.
fn number(text: &str) -> f64 {
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let factor = match unit {
        "kN" | "kN m" | "kJ" | "kW" => 1e3,
        "bar" => 1e5,
        "mm" => 1e-3,
        "%" => 1e-2,
        "MPa" => 1e6,
        _ => 1.0,
    };
    factor * number.parse::<f64>().unwrap_or_else(|_| panic!("{text} begins with a number"))
}

fn assert_close(what: &str, shown: f64, computed: f64) {
    assert!(
        (shown - computed).abs() <= FOUR_DIGITS * computed.abs() + 1e-9,
        "{what}: shown {shown}, computed {computed}"
    );
}

/// Least and greatest value of each column whose name ends so, by the rest of its name.
fn ranges(recorded: &Recorded, ending: &str) -> BTreeMap<String, (f64, f64)> {
    let columns = recorded.table.columns.iter().enumerate();
    columns
        .filter_map(|(index, column)| {
            let name = column.name.strip_suffix(ending)?.to_owned();
            let values = || recorded.table.rows.iter().map(move |row| row[index]);
            Some((name, (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max))))
        })
        .collect()
}

/// The greatest finite number of packed data, with its sign changed if `sign` is −1.
fn greatest(packed: &Value, sign: f64) -> f64 {
    let bytes = BASE64_STANDARD.decode(packed.as_str().expect("base 64")).expect("base 64");
    let numbers = bytes.as_chunks::<4>().0.iter().map(|bytes| f64::from(f32::from_le_bytes(*bytes)));
    numbers.filter(|number| number.is_finite()).map(|number| sign * number).fold(f64::MIN, f64::max)
}

/// Every tile against the columns of the run, its cautions and the curves of the page.
fn check_data(name: &str, live: &LiveCrane, recorded: &Recorded, data: &Value) {
    let crane: &dyn crane_model::dyn_crane::DynCrane = live;
    let description = crane.description();
    for (key, ending) in [("largest_drive_torque", "_drive_torque"), ("largest_drive_force", "_drive_force")] {
        let sizes = ranges(recorded, ending).into_values().map(|(low, high)| high.max(-low));
        let most = sizes.fold(f64::MIN, f64::max);
        assert_eq!(figure(data, key).is_some(), most > f64::MIN, "{name}: {key}");
        if let Some(figure) = figure(data, key) {
            assert_close(&format!("{name}: {key}"), number(text(figure, "value")).abs(), most);
            // At the time that the note gives, with two decimals, a drive has that effort.
            let (_, time) = text(figure, "note").rsplit_once(", at ").expect("a time");
            let time: f64 = time.trim_end_matches(" s").parse().expect("a number");
            let efforts = recorded.table.columns.iter().enumerate().filter(|(_, column)| column.name.ends_with(ending));
            let near = recorded.table.rows.iter().filter(|row| (row[0] - time).abs() < 0.005 + 1e-9);
            let then = near.flat_map(|row| efforts.clone().map(|(index, _)| row[index].abs())).fold(0.0, f64::max);
            assert_close(&format!("{name}: {key} at {time} s"), then, most);
        }
    }
    let reactions = ranges(recorded, "_reaction_z");
    if let Some(figure) = figure(data, "vertical_reactions") {
        let (value, note) = (text(figure, "value"), text(figure, "note"));
        let (low, high) = value.split_once(" … ").expect("two numbers");
        let unit = high.split_once(' ').expect("a unit").1;
        let (least, most) =
            reactions.values().fold((f64::MAX, f64::MIN), |(l, h), (low, high)| (l.min(*low), h.max(*high)));
        assert_close(name, number(&format!("{low} {unit}")), least);
        assert_close(name, number(high), most);
        let one_sided =
            |foot: &str| description.supports.iter().any(|support| support.name == foot && support.one_sided);
        let lifted: Vec<&String> =
            reactions.iter().filter(|(foot, (low, _))| one_sided(foot) && *low <= 0.0).map(|(foot, _)| foot).collect();
        let pulls = reactions.iter().any(|(foot, (low, _))| !one_sided(foot) && *low < 0.0);
        assert_eq!(note.contains("no foot lifts"), lifted.is_empty() && !pulls, "{name}: {note}");
        assert_eq!(figure["verdict"], if lifted.is_empty() && !pulls { "within" } else { "beyond" }, "{name}");
        let cautions = recorded.cautions.join("\n");
        assert_eq!(cautions.contains("feet that lift off"), !lifted.is_empty(), "{name}: {cautions}");
        for foot in reactions.keys() {
            let first = format!("{} first", spoken(foot));
            let is_named = note.split([':', ';']).any(|part| part.trim_start().starts_with(&first));
            assert_eq!(is_named, lifted.contains(&foot), "{name}: {foot} in {note}");
            assert_eq!(
                is_named,
                cautions.split([':', ';']).any(|part| part.trim_start().starts_with(&format!("{foot} first at"))),
                "{name}: {foot} in {cautions}"
            );
        }
    } else {
        assert!(reactions.is_empty(), "{name}");
    }
    let strength = &data["cranes"][0]["strength"];
    if let Some(figure) = figure(data, "utilisation") {
        let used = greatest(&strength["sections"]["data"], 1.0);
        assert_close(name, number(text(figure, "value")), used);
        assert_eq!(figure["verdict"], if used > 1.0 { "beyond" } else { "within" }, "{name}");
    } else if let Some(figure) = figure(data, "equivalent_stress") {
        assert_close(name, number(text(figure, "value")), 1e6 * greatest(&strength["sections"]["data"], 1.0));
    } else {
        assert!(strength["sections"].is_null(), "{name}");
    }
    if !strength["stability"].is_null() {
        let figure = figure(data, "tipping_margin").expect("a margin");
        let margin = -greatest(&strength["stability"]["data"], -1.0);
        assert_close(name, number(text(figure, "value")), margin);
        let over = margin <= 0.0 || recorded.cautions.iter().any(|caution| caution.starts_with("the crane tips over"));
        assert_eq!(figure["verdict"], if over { "beyond" } else { "within" }, "{name}");
    }
    let pressures = [ranges(recorded, "_piston_pressure"), ranges(recorded, "_rod_pressure")];
    let share = |info: &crane_model::CylinderInfo| {
        let most = pressures.iter().map(|of| of[info.name.as_str()].1).fold(f64::MIN, f64::max);
        (most / info.max_pressure.unwrap_or(f64::INFINITY), most)
    };
    let worst = description.cylinders.iter().map(share).max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    assert_eq!(figure(data, "highest_pressure").is_some(), worst.is_some(), "{name}");
    if let (Some(figure), Some((share, pressure))) = (figure(data, "highest_pressure"), worst) {
        assert_close(name, number(text(figure, "value")), pressure);
        assert_eq!(figure["verdict"] == "beyond", share > 1.0, "{name}: {figure}");
    }
    let lowest = &data["cranes"][0]["modes"][0];
    assert_close(
        name,
        number(text(figure(data, "lowest_frequency").expect("modes"), "value")),
        lowest["frequency"].as_f64().expect("a number"),
    );
    let (low, high) = ranges(recorded, "energy_balance")[""];
    // Differences of two numbers of 1e5 J: two digits of their rounding would do.
    assert_close(name, number(text(figure(data, "energy_balance").expect("a run"), "value")), high.max(-low));
}

/// The summary repeats the tiles, word by word, and says which limits are exceeded.
fn check_summary(name: &str, recorded: &Recorded, data: &Value) {
    let lines = data["summary"].as_array().expect("a summary");
    let line =
        |name: &str| lines.iter().find(|line| line["name"] == name).unwrap_or_else(|| panic!("{name} in {lines:?}"));
    let words = |line: &Value| {
        line["texts"].as_array().expect("texts").iter().filter_map(Value::as_str).collect::<Vec<_>>().join("\n")
    };
    for figure in data["figures"].as_array().expect("figures") {
        let line = line(text(figure, "title"));
        assert_eq!(words(line), format!("{} ({})", text(figure, "value"), text(figure, "note")), "{name}");
        assert_eq!(line["verdict"], figure["verdict"], "{name}");
        if figure["verdict"] == "beyond" {
            assert!(words(self::line(lines, "verdict")).contains(text(figure, "excess")), "{name}");
        }
    }
    let shown = words(line("cautions"));
    for caution in &recorded.cautions {
        assert!(shown.contains(caution), "{name}: {caution}");
    }
    let all = data["summary"].to_string() + &data["figures"].to_string() + &data["cranes"][0]["repeat"].to_string();
    for nothing in ["NaN", "inf ", "undefined"] {
        assert!(!all.contains(nothing), "{name}: {nothing} in {all}");
    }
}

fn line<'a>(lines: &'a [Value], name: &str) -> &'a Value {
    lines.iter().find(|line| line["name"] == name).expect("a line")
}

#[test]
fn pages_of_shipped_cranes_show_the_results_of_their_runs() {
    for (name, text) in crane_specs::SPECS {
        let (live, recorded, data) = shown(name, text);
        check_data(name, &live, &recorded, &data);
        check_summary(name, &recorded, &data);
    }
}

/// A boom on a cylinder, on four feet, that lifts a load.
fn boom(load: f64, yield_stress: f64, max_pressure: f64) -> String {
    format!(
        "format: 1
name: boom
parameters: {{load: {{value: {load}, unit: kg}}}}
links:
  - {{name: truck, joint: free, mass: 3000, com: [0, 0, 0.5], inertia: {{Ixx: 2e3, Iyy: 2e3, Izz: 2e3}}}}
  - {{name: mast, placement: {{transform: {{translation: [0, 0, 1]}}}}, mass: 100, com: [0, 0, 0.5], inertia: {{Ixx: 9, Iyy: 9, Izz: 1}}}}
  - name: boom
    placement: {{transform: {{translation: [0, 0, 2], rotation: {{x: 90 deg}}}}}}
    joint: revolute
    beam:
      length: 4
      sections: 2
      material: {{E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: {yield_stress}}}
      section: {{box: {{height: 0.2, width: 0.15, thickness: 0.006}}}}
      damping: {{beta: 1e-3}}
  - {{name: hook, mass: load, com: [0, 0, 0], inertia: {{Ixx: 1, Iyy: 1, Izz: 1}}}}
supports:
  - {{name: front_left, one_sided: true, at: [1.5, 1.5, 0], stiffness: [3e6, 3e6, 8e6], damping: [4e4, 4e4, 8e4]}}
  - {{name: front_right, one_sided: true, at: [1.5, -1.5, 0], stiffness: [3e6, 3e6, 8e6], damping: [4e4, 4e4, 8e4]}}
  - {{name: rear_left, one_sided: true, at: [-1.5, 1.5, 0], stiffness: [3e6, 3e6, 8e6], damping: [4e4, 4e4, 8e4]}}
  - {{name: rear_right, one_sided: true, at: [-1.5, -1.5, 0], stiffness: [3e6, 3e6, 8e6], damping: [4e4, 4e4, 8e4]}}
drives:
  - {{coordinate: boom_psi, stiffness: 5e6, damping: 2e4, motion: {{quintic: {{from: 0, to: 10 deg, duration: 2}}}}}}
cylinders:
  - name: lift
    coordinate: boom_psi
    foot: {{link: mast, at: [0.3, 0, 0.6]}}
    head: {{link: boom, at: [0.9, 0, 0]}}
    bore: 0.1
    rod: 0.06
    retracted: 1.2
    stroke: 0.9
    max_pressure: {max_pressure}
points: [{{name: tip, link: hook, at: [0, 0, 0]}}]
run: {{duration: 2, output: 0.02}}
"
    )
}

#[test]
fn what_is_beyond_its_limit_is_named_first() {
    let quiet = shown("boom", &boom(100.0, 700e6, 320e5));
    check_data("quiet", &quiet.0, &quiet.1, &quiet.2);
    assert_eq!(quiet.2["verdict"]["verdict"], "within", "{}", quiet.2["verdict"]);
    // 1780 kg at 2.5 m beyond the front feet hold 4.5 t m; the truck and the mast 4.65 t m: starting to lift it, 10 % more, lifts the rear feet.
    let cases = [
        (boom(500.0, 60e6, 320e5), "stress of boom is", vec!["utilisation"]),
        (boom(500.0, 700e6, 20e5), "its relief valve opens at 20", vec!["highest_pressure"]),
        (boom(100.0, 700e6, 320e5).replace("stroke: 0.9", "stroke: 0.3"), "of its stroke", vec!["stroke"]),
        (boom(1780.0, 700e6, 320e5), "rear left, rear right lift off the ground", vec!["vertical_reactions"]),
    ];
    for (spec, words, beyond) in cases {
        let (live, recorded, data) = shown("boom", &spec);
        check_data(words, &live, &recorded, &data);
        check_summary(words, &recorded, &data);
        assert!(text(&data["verdict"], "text").contains(words), "{words}: {}", data["verdict"]);
        for key in beyond {
            assert_eq!(figure(&data, key).expect("it is there")["verdict"], "beyond", "{words}: {}", data["figures"]);
        }
    }
}

/// Height and width along a tapered box, and rocker and link of a cylinder, each under its own name.
#[test]
fn what_is_drawn_has_the_measures_of_the_spec() {
    const PARTS: &str = "parts: [{length: 4, section: {box: {height: 0.3, width: 0.15, thickness: 0.006}}, \
                         to: {box: {height: 0.2, width: 0.1, thickness: 0.006}}}]";
    let spec = boom(100.0, 700e6, 320e5)
        .replace("section: {box: {height: 0.2, width: 0.15, thickness: 0.006}}", PARTS)
        .replace("head: {link: boom, at: [0.9, 0, 0]}", "head: {link: boom, at: [0.9, 0, 0]}\n    linkage: {pivot: [0.1, 0, 1.6], rocker: 0.5, link: 0.6, side: right}")
        .replace("retracted: 1.2", "retracted: 0.6");
    let live = live("boom", &spec);
    let crane: &dyn crane_model::dyn_crane::DynCrane = &live;
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    let data = data_of(&Subject { label: "value", crane, live: &live, equilibrium: &equilibrium, run: None });
    let shown = &data["cranes"][0];
    assert_eq!(shown["scene"]["beams"][0]["name"], "boom");
    let along = shown["scene"]["beams"][0]["along"].as_array().expect("an outline");
    let [first, last] = [along.first(), along.last()].map(|sides| sides.expect("an end").clone());
    assert_eq!((first, last), (json!([0.0, 0.3, 0.15]), json!([4.0, 0.2, 0.1])));
    let linkage = &shown["scene"]["cylinders"][0]["linkage"];
    assert_eq!((&linkage["rocker"], &linkage["link"], &linkage["left"]), (&json!(0.5), &json!(0.6), &json!(false)));
    assert_eq!(linkage["pivot"]["at"], json!([0.1, 0.0, 1.6]));
}

/// Along a straight telescope, the front pads of a stage are ahead of its rear pads by the overlap.
#[test]
fn pads_are_where_they_are() {
    let live = live("loader", include_str!("../../../../specs/examples/telescopic_loader.yaml"));
    let crane: &dyn crane_model::dyn_crane::DynCrane = &live;
    let pads = crate::scene::Scene::new(&live, &crane.guess()).pads;
    let names = &crane.description().coordinates;
    for out in [0.2, 1.6] {
        let places = names.iter().map(|coordinate| if coordinate.name.ends_with("stage_x") { out } else { 0.0 });
        let frames = crane.transforms_at(&places.collect::<Vec<f64>>());
        let at = |pad: &crate::scene::Pad| frames[pad.body].transform_point(&nalgebra::Point3::new(pad.x, 0.0, 0.0));
        for (stage, (beams, inside)) in
            [(["boom", "first_stage"], 3.1), (["first_stage", "second_stage"], 2.9)].iter().enumerate()
        {
            let [front, rear] = [&pads[2 * stage], &pads[2 * stage + 1]];
            assert_eq!([&front.beams, &rear.beams].map(|names| names.each_ref().map(String::as_str)), [*beams; 2]);
            assert!(((at(front) - at(rear)).norm() - (inside - out)).abs() < 1e-12);
        }
    }
}

#[test]
fn a_pose_that_is_not_stable_is_named() {
    let live = live(
        "upright",
        "format: 1\nname: upright\nlinks:\n  - {name: rod, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 1, com: [0, 1, 0]}\n",
    );
    let crane: &dyn crane_model::dyn_crane::DynCrane = &live;
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    let data = data_of(&Subject { label: "value", crane, live: &live, equilibrium: &equilibrium, run: None });
    let figure = figure(&data, "equilibrium").expect("it falls");
    assert_eq!((text(figure, "value"), &figure["verdict"]), ("unstable", &"beyond".into()));
    assert!(data["summary"].is_null());
}

#[test]
fn parameters_that_are_angles_are_in_degrees_too() {
    assert_eq!(sign::parameter("inner_angle", 15_f64.to_radians(), "rad"), "inner_angle = 0.2618 rad (15.00°)");
    assert_eq!(sign::parameter("payload", 930.0, "kg"), "payload = 930 kg");
    assert_eq!(
        [quantity(114_460.0, "N m"), quantity(2.1e7, "Pa"), quantity(0.021_344, "m")],
        ["114.5 kN m", "210 bar", "21.34 mm"]
    );
}
