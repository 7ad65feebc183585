//! Points that the ground carries, against closed forms.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{Method, Settings};
use crane_model::results::Table;
use crane_model::runs::{Start, imbalance, record, record_checked};
use crane_model::statics;

const GRAVITY: f64 = 9.81;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("contacts.yaml", text.to_owned()))
        .unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn run(crane: &LiveCrane, method: Method, duration: f64) -> Table {
    let settings = Settings {
        method,
        tolerance: 1e-9,
        duration,
        output: 1e-3,
        audit: true,
        ..Settings::from_description(crane.description())
    };
    let crane: &dyn DynCrane = crane;
    let start = Start::new(crane).unwrap_or_else(|failed| panic!("{failed}"));
    let recorded = record(crane, &start, &settings, &mut |_| ControlFlow::Continue(()));
    recorded.unwrap_or_else(|failed| panic!("{failed}")).table
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    table.values(name).unwrap_or_else(|| panic!("no column {name}")).collect()
}

/// A load of 500 kg on a drive without mass: a winch of stiffness k hoists it with v from the ground, on which it lies. The force that lifts it grows to
/// `m g (1 + v ω/g)`, ω = √(k/m); before that it grows by k v t.
#[test]
fn a_load_is_hoisted_from_the_ground() {
    const MASS: f64 = 500.0;
    for (stiffness, speed) in [(2e5_f64, 0.2), (5e4, 0.5)] {
        let omega = (stiffness / MASS).sqrt();
        let hoist = crane(&format!(
            "format: 1\nname: hoist\nlinks: [{{name: load, joint: {{prismatic: {{axis: z}}}}, mass: {MASS}, com: [0, 0, 0.5]}}]\n\
             contacts: [{{name: ground, link: load, height: -1, stiffness: 1e10, damping: 0.1}}]\n\
             drives: [{{coordinate: load_z, stiffness: {stiffness}, motion: {{speed: {{from: -1, rate: {speed}}}}}}}]\n\
             guess: {{load_z: -1}}\nanalyses: [statics, dynamics, modes]\n"
        ));
        let lifted = MASS * GRAVITY / (stiffness * speed);
        for method in [Method::Bdf, Method::DormandPrince, Method::Rosenbrock] {
            let table = run(&hoist, method, lifted + 0.75 * std::f64::consts::TAU / omega);
            let [t, force, ground, depth] =
                ["t", "load_z_drive_force", "ground_force", "ground_depth"].map(|name| column(&table, name));
            let most = force.iter().copied().fold(0.0, f64::max);
            let expected = MASS * GRAVITY * (1.0 + speed * omega / GRAVITY);
            // The load rises by 0.5 µm as the ground is relieved: 0.1 N; results miss the peak by (ω · 0.5 ms)²/2.
            assert!((most / expected - 1.0).abs() < 1e-4, "{method:?}: {most} N, {expected} N");
            for ((t, force), (ground, depth)) in t.iter().zip(&force).zip(ground.iter().zip(&depth)) {
                assert_eq!(*ground > 0.0, *depth > 0.0, "{method:?}, {t} s");
                if *t < 0.9 * lifted {
                    assert!(
                        (force - stiffness * speed * t).abs() < 5e-4 * MASS * GRAVITY,
                        "{method:?}, {t} s: {force}"
                    );
                    assert!((force + ground - MASS * GRAVITY).abs() < 5e-3 * MASS * GRAVITY, "{method:?}, {t} s");
                }
            }
            assert!(imbalance(&table, 0.0) < 1e-4, "{method:?}: {}", imbalance(&table, 0.0));
        }
    }
}

/// A hinged rod of 100 kg whose end lies on a step: the ground carries half of it, and of a load at its end all.
#[test]
fn the_ground_carries_its_share() {
    for (load, share) in [(0.0, 50.0), (30.0, 80.0)] {
        let rod = crane(&format!(
            "format: 1\nname: rod\nparameters: {{step: {{value: 0.2, unit: m}}, load: {{value: {load}, unit: kg}}}}\n\
             links:\n- {{name: rod, joint: {{revolute: {{axis: y}}}}, mass: 100, com: [1, 0, 0], inertia: {{Ixx: 1, Iyy: 34, Izz: 34}}}}\n\
             - {{name: end, placement: {{transform: {{translation: [2, 0, 0]}}}}, joint: fixed, mass: load, com: [0, 0, 0]}}\n\
             contacts: [{{name: lies, link: end, height: step, stiffness: 1e7, damping: 0.5}}]\nguess: {{rod_theta: -0.2}}\n"
        ));
        let whole: &dyn DynCrane = &rod;
        let equilibrium = whole.equilibrium(&statics::Settings::default());
        assert!(equilibrium.is_stable(), "{equilibrium}");
        let tension = whole.connector_tensions_at(0.0, &equilibrium.q, &[0.0])[0].force;
        assert!((tension - share * GRAVITY).abs() < 1e-7 * share * GRAVITY, "{tension} N");
        // Below the step by F/k.
        let [depth, _] = whole.connector_lengths_at(&equilibrium.q, &[0.0])[0];
        assert!((depth - tension / 1e7).abs() < 1e-12, "{depth} m");
        assert!((-2.0 * equilibrium.q[0].sin() - 0.2 + depth).abs() < 1e-12, "{:?}", equilibrium.q);
    }
}

/// A load that falls 1 m and bounces between two results leaves no force in them: the run says so, and one with results during the contact does not.
#[test]
fn a_bounce_between_two_results_is_told() {
    let falls = crane(
        "format: 1\nname: falls\nlinks: [{name: load, joint: {prismatic: {axis: z}}, mass: 100, com: [0, 0, 0]}]\n\
         contacts: [{name: ground, link: load, height: -1, stiffness: 1e7}]\nanalyses: [dynamics]\n",
    );
    for (output, told) in [(0.05, true), (1e-3, false)] {
        let settings =
            Settings { duration: 0.6, output, tolerance: 1e-7, ..Settings::from_description(falls.description()) };
        let whole: &dyn DynCrane = &falls;
        let start = Start::new(whole).expect("a start");
        let recorded =
            record_checked(whole, &start, &settings, (false, 20.0), &mut |_| ControlFlow::Continue(())).expect("a run");
        let most = column(&recorded.table, "ground_force").into_iter().fold(0.0, f64::max);
        assert_eq!(most == 0.0, told, "{most} N");
        let found =
            recorded.cautions.iter().any(|caution| caution.starts_with("contact ground touches the ground between"));
        assert_eq!(found, told, "{:?}", recorded.cautions);
    }
}

#[test]
fn contacts_that_cannot_be_are_refused() {
    let mistakes = |contact: &str| {
        let text = format!(
            "format: 1\nname: fixed\nlinks:\n- {{name: base, mass: 1, com: [0, 0, 0]}}\n\
             - {{name: arm, joint: revolute, mass: 1, com: [1, 0, 0]}}\ncontacts: [{contact}]\n"
        );
        LiveCrane::from_spec(&SourceFile::new("contacts.yaml", text)).expect_err("a mistake").to_string()
    };
    for (contact, code) in [
        ("{name: lies, link: base, stiffness: 1e6}", "E197"),
        ("{name: lies, link: arm, stiffness: 0}", "above zero"),
        ("{name: lies, link: am, stiffness: 1e6}", "did you mean `arm`"),
        ("{name: lies, link: arm, stiffness: 1e6, damping: 1 N}", "E034"),
    ] {
        let told = mistakes(contact);
        assert!(told.contains(code), "{contact}:\n{told}");
    }
}
