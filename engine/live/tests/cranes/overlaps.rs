//! Stages on pads that leave their outer beams: what poses, runs and charts say of them.

use std::ops::ControlFlow;
use std::sync::Mutex;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::Settings;
use crane_model::envelope::{Axes, Axis, Envelope, Execution, Limit, Limits, PartLimit, Rating, Varied};
use crane_model::results::cautions;
use crane_model::runs::{self, Start};
use crane_model::statics;

/// A boom of 4 m, perhaps divided, and a stage of 3.8 m and 0.26 m height in it, with an overlap of 3.5 m less what it is drawn out.
fn crane(sections: &str, motion: &str) -> LiveCrane {
    let text = format!(
        "format: 1
name: telescope
parameters: {{reach: {{value: 4}}, inside: {{value: 3.5}}, payload: {{value: 50, unit: kg}}, high: {{value: 0.26, unit: m}}}}
materials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 7e9}}}}
links:
  - name: boom
    placement: {{transform: {{rotation: {{x: 90 deg}}}}}}
    joint: revolute
    beam: {{length: reach, sections: {sections}, material: steel, section: {{box: {{height: 0.30, width: 0.22, thickness: 0.008}}}}, damping: {{beta: 1e-3}}}}
  - name: stage
    joint: {{prismatic: {{axis: x}}}}
    beam:
      {{length: 3.8, sections: 2, material: steel, section: {{box: {{height: high, width: 0.18, thickness: 0.007}}}}, damping: {{beta: 1e-3}},
       slides_in: {{beam: boom, overlap: inside, pads: {{front: {{stiffness: [2e8, 2e8, 4e6], damping: [2e5, 2e5, 4e3]}},
       rear: {{stiffness: [2e8, 2e8, 0], damping: [2e5, 2e5, 0]}}}}}}}}
  - {{name: load, mass: payload, com: [0, -0.1, 0]}}
drives:
  - {{coordinate: boom_psi, stiffness: 2e7, damping: 3e5, motion: {{hold: 25 deg}}}}
  - {{coordinate: stage_x, stiffness: 2e7, damping: 2e5, motion: {motion}}}
loads:  # its sections are not equal
  - {{name: lamp, link: boom, at: [1.1, 0, 0], force: [0, 0, -50]}}
"
    );
    LiveCrane::from_spec(&SourceFile::new("telescope.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Cautions of the pose at rest.
fn at_rest(crane: &LiveCrane) -> String {
    let rest = (crane as &dyn DynCrane).equilibrium(&statics::Settings::default());
    cautions::of_pose(crane, &rest.q, cautions::BEND).join("; ")
}

const OUT: &str = "stage is out of boom: its overlap is -0.050 m with stage_x at 3.550 m; nothing holds it there";
const SHORT: &str =
    "stage overlaps boom by only 0.200 m with stage_x at 3.300 m, less than the height of its section, 0.260 m";

/// The drive gives way by less than 0.2 mm.
#[test]
fn a_pose_says_what_little_holds_a_stage() {
    for sections in ["rigid", "1", "3"] {
        let [out, short, long] = ["3.55", "3.3", "3.2"].map(|x| at_rest(&crane(sections, &format!("{{hold: {x}}}"))));
        assert!(out.contains(OUT), "{sections}: {out}");
        assert!(short.contains(SHORT), "{sections}: {short}");
        assert!(!long.contains("overlap"), "{sections}: {long}");
    }
    // The height is that of the live section.
    let mut lower = crane("3", "{hold: 3.3}");
    lower.set_parameter(3, 0.19).expect("a height");
    assert!(!at_rest(&lower).contains("overlap"), "{}", at_rest(&lower));
}

/// The overlap does not depend on where the boom ends, but on what is in it.
#[test]
fn parameters_count() {
    let mut crane = crane("3", "{hold: 3.2}");
    crane.set_parameter(0, 4.5).expect("a longer boom");
    assert!(!at_rest(&crane).contains("overlap"));
    crane.set_parameter(1, 3.4).expect("less in it");
    assert!(at_rest(&crane).contains("stage overlaps boom by only 0.200 m with stage_x at 3.200 m"));
}

#[test]
fn a_run_gives_the_time() {
    let crane = crane("2", "{quintic: {from: 3.0, to: 3.3, duration: 1}}");
    let start = Start::new(&crane).expect("it stands");
    let settings = Settings { duration: 2.0, output: 0.1, ..Settings::from_description(crane.description()) };
    let run = runs::record(&crane, &start, &settings, &mut |_| ControlFlow::Continue(())).expect("it runs");
    let said = cautions::of_run(&crane, &run.table, cautions::BEND).join("; ");
    // Beyond its end after an overshoot, which damping keeps below a millimetre.
    assert!(said.contains("stage overlaps boom by only 0."), "{said}");
    let time: f64 = said.split(" m, at ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok()).expect("a time");
    assert!((0.9..=2.0).contains(&time), "{said}");
}

/// No load is rated where nothing holds the stage.
#[test]
fn a_chart_ends_where_the_overlap_does() {
    let crane = crane("2", "{hold: 1}");
    let limits = Limits { of_parts: PartLimit::DEFAULT.to_vec(), ..Limits::none(crane.description()) };
    let axes = Axes(vec![Axis { varied: Varied::Drive(1), values: vec![-0.4, 2.0, 3.45, 3.55] }]);
    let envelope = Envelope { axes, load: 2, loads: [1.0, 500.0], limits, factor: 1.0 };
    let found: Mutex<Vec<Rating>> = Mutex::new(Vec::new());
    let done = |_: usize, ratings: &[Rating]| found.lock().unwrap().extend(ratings.to_vec());
    let pieces: Vec<usize> = (0..envelope.pieces()).collect();
    envelope.run(&crane, &pieces, &Execution { threads: 1, done: &done, cancelled: &|| false }).unwrap();
    let ratings = found.into_inner().unwrap();
    let is_of_stage = |limit: Limit| limit.kind() == "overlap" && limit.location(&crane) == "stage";
    assert_eq!(ratings.iter().map(|rating| rating.load.is_some()).collect::<Vec<_>>(), [false, true, true, false]);
    for end in [0, 3] {
        assert!(ratings[end].governing.is_some_and(is_of_stage), "{:?}", ratings[end].governing);
    }
}

/// An overlap of 3.9 m of a stage of 3.8 m is 0.1 m too long; a hundredth of the stage is play.
#[test]
fn a_stage_that_is_pushed_in_too_far_is_told() {
    let said = at_rest(&crane("2", "{hold: -0.4}"));
    assert!(said.contains("stage is pushed 0.100 m too far into boom with stage_x at -0.400 m: "), "{said}");
    assert!(!at_rest(&crane("2", "{hold: -0.3}")).contains("too far"));
    let moving = crane("2", "{quintic: {from: 0, to: -0.4, duration: 1}}");
    let start = Start::new(&moving).expect("it stands");
    let settings = Settings { duration: 2.0, output: 0.1, ..Settings::from_description(moving.description()) };
    let run = runs::record(&moving, &start, &settings, &mut |_| ControlFlow::Continue(())).expect("it runs");
    let said = cautions::of_run(&moving, &run.table, cautions::BEND).join("; ");
    assert!(said.contains(" m too far into boom with stage_x at -0.40"), "{said}");
}

/// With the empty hook, the rope of the example is too short for this extension: once, its stages stood crosswise, and charts of neighbours with them.
#[test]
fn a_stage_that_stands_crosswise_is_told() {
    let text = include_str!("../../../../specs/examples/telescopic_loader.yaml");
    let changes = "drives: [{coordinate: boom_psi, motion: {hold: 60 deg}}, {coordinate: first_stage_x, motion: {hold: 2.7}}]\n\
                   parameters: {payload: {value: 0}}\n";
    let source = SourceFile::new("telescopic_loader.yaml", text).changed(changes);
    let crane = LiveCrane::from_spec(&source).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let rest = (&crane as &dyn DynCrane).equilibrium(&statics::Settings::default());
    let turned =
        rest.q[crane.description().coordinates.iter().position(|own| own.name == "second_stage_psi").expect("a pad")];
    let said = at_rest(&crane);
    assert!(turned.abs() < 1.0 || said.contains("second_stage stands crosswise in first_stage"), "{turned}: {said}");
}

/// Nothing twists a crane in a plane: the moments of its pads are rounding, of which no error is reported.
#[test]
fn rounding_is_no_error_of_a_run() {
    let crane = crane("2", "{quintic: {from: 1.0, to: 1.5, duration: 1}}");
    let start = Start::new(&crane).expect("it stands");
    let settings =
        Settings { duration: 1.0, output: 0.1, audit: true, ..Settings::from_description(crane.description()) };
    let go = &mut |_| ControlFlow::Continue(());
    let recorded = runs::record_checked(&crane, &start, &settings, (true, cautions::BEND), go).expect("it runs");
    assert!(!recorded.cautions.iter().any(|caution| caution.contains("twist")), "{:?}", recorded.cautions);
}
