//! Cautions about flexible links that slide in one another.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::Settings;
use crane_model::results::cautions;
use crane_model::runs::{self, Start};
use crane_model::statics;

/// A boom of 3 m from which a stage of 3 m is drawn out, from 1 m at first to 2 m; `placed` is the stage's placement.
fn telescope(sections: &str, placed: f64, joint: &str) -> LiveCrane {
    let beam = |sections: &str| {
        format!(
            "{{length: 3, sections: {sections}, material: {{E: 2.1e11, G: 8.1e10, density: 7850}}, \
             section: {{box: {{height: 0.2, width: 0.15, thickness: 0.006}}}}, damping: {{beta: 1e-2}}}}"
        )
    };
    let text = format!(
        "format: 1
name: telescope
links:
  - {{name: boom, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, beam: {}}}
  - {{name: stage, placement: {{transform: {{translation: [{placed}, 0, 0]}}}}, joint: {joint}, beam: {}}}
drives:
  - {{coordinate: boom_psi, stiffness: 1e7, damping: 1e5, motion: {{hold: 0.2}}}}
  - {{coordinate: stage_{}, stiffness: 1e7, damping: 1e5, motion: {{quintic: {{from: 1, to: 2, duration: 1}}}}}}
",
        beam("2"),
        beam(sections),
        if joint == "revolute" { "psi" } else { "x" }
    );
    LiveCrane::from_spec(&SourceFile::new("telescope.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn cautions_of(crane: &LiveCrane) -> [String; 2] {
    let crane: &dyn DynCrane = crane;
    let rest = crane.equilibrium(&statics::Settings::default());
    assert!(rest.is_stable(), "{rest}");
    let start = Start::new(crane).expect("it stands");
    let settings = Settings { duration: 1.2, output: 0.1, ..Settings::from_description(crane.description()) };
    let run = runs::record(crane, &start, &settings, &mut |_| ControlFlow::Continue(())).expect("it runs");
    [cautions::of_pose(crane, &rest.q, 20.0).join("; "), cautions::of_run(crane, &run.table, 20.0).join("; ")]
}

const SLIDES: &str = "{prismatic: {axis: x}}";

#[test]
fn an_overlapping_stage_is_named() {
    // It begins 2.8 m inside of the boom, less what it is drawn out.
    let [pose, run] = cautions_of(&telescope("2", -2.8, SLIDES));
    assert!(pose.contains("stage is in boom over 1.80 m, but the model holds it only where it begins"), "{pose}");
    assert!(run.contains("stage is in boom over up to 1.80 m"), "{run}");
    for words in [&pose, &run] {
        assert!(words.contains("its stress and the deflection are too large, and frequencies too low"), "{words}");
    }
}

/// Nothing is wrong with a stage that is drawn out, with a rigid one, and with a link that turns.
#[test]
fn other_links_are_not() {
    for crane in [telescope("2", 0.0, SLIDES), telescope("rigid", -2.8, SLIDES), telescope("2", -2.8, "revolute")] {
        for words in cautions_of(&crane) {
            assert!(!words.contains("is in boom"), "{words}");
        }
    }
}
