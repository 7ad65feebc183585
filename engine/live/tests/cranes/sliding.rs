//! Feet that hold by friction, against the laws of Coulomb.

use std::ops::ControlFlow;

use crane_codegen::{SourceFile, build};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::force_states;
use crane_model::results::Table;
use crane_model::runs::{Start, record};
use crane_model::statics::{Diagnosis, Settings as Statics, Status};

const FRICTION: f64 = 0.3;
const MASS: f64 = 100.0;
const GRAVITY: f64 = 9.81;

/// A flat block on four feet on a slope down towards x.
fn block(slope: f64, stiffness: f64, damping: f64, more: &str) -> LiveCrane {
    crane(&spec(slope, stiffness, damping, more))
}

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("block.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn spec(slope: f64, stiffness: f64, damping: f64, more: &str) -> String {
    let foot = |name: &str, x: f64, y: f64| {
        format!(
            "  - {{name: {name}, at: [{x}, {y}, 0], one_sided: true, friction_coefficient: {FRICTION}, \
             stiffness: [{stiffness:e}, {stiffness:e}, 1e6], damping: [{damping:e}, {damping:e}, 2e3]}}\n"
        )
    };
    let feet = [foot("a", 1.0, 1.0), foot("b", 1.0, -1.0), foot("c", -1.0, 1.0), foot("d", -1.0, -1.0)].concat();
    let [along, down] = [GRAVITY * slope.sin(), -GRAVITY * slope.cos()];
    format!(
        "format: 1\nname: block\ngravity: [{along}, 0, {down}]\nlinks:\n\
         - {{name: block, joint: free, mass: {MASS}, com: [0, 0, 0.2], inertia: {{Ixx: 20, Iyy: 20, Izz: 30}}}}\n\
         supports:\n{feet}{more}"
    )
}

/// A block stands on a slope up to tan α = μ, whatever the stiffness of its feet, and slides beyond.
#[test]
fn a_block_stands_up_to_the_angle_of_friction() {
    for stiffness in [1e4, 1e6, 1e8] {
        for (share, stands) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
            let block = block((share * FRICTION).atan(), stiffness, 1e3, "");
            let crane: &dyn DynCrane = &block;
            let found = crane.equilibrium(&Statics::default());
            assert_eq!(found.is_stable(), stands, "{stiffness:e}, {share}: {found}");
            if !stands {
                assert!(matches!(found.status, Status::Slides { .. }), "{found}");
                assert!(matches!(Diagnosis::new(crane, &found), Diagnosis::Slides { .. }));
            }
        }
    }
}

fn run(block: &LiveCrane, method: Method, tolerance: f64, start: &Start) -> Table {
    let settings =
        Settings { method, tolerance, audit: true, step: 1e-4, ..Settings::from_description(block.description()) };
    let recorded = record(block, start, &settings, &mut |_| ControlFlow::Continue(()));
    recorded.unwrap_or_else(|failed| panic!("{method:?}: {failed:?}")).table
}

/// The last number of a column at or before a time.
fn value(table: &Table, name: &str, t: f64) -> f64 {
    let row = table.rows.iter().rposition(|row| row[0] <= t + 1e-9).expect("a row");
    table.values(name).expect("a column").nth(row).expect("a value")
}

/// Beyond the angle of friction it slides with `g (sin α − μ cos α)`, and loses μ N times the way. The feet bounce at the beginning; after 1 s,
/// exp(−40) of that is left. Pads with and without a damper slide alike.
#[test]
fn a_block_slides_as_coulomb_says() {
    let slope = (2.0 * FRICTION).atan();
    let expected = GRAVITY * (slope.sin() - FRICTION * slope.cos());
    for (method, tolerance, damping) in [
        (Method::Bdf, 1e-7, 1e3),
        (Method::Rosenbrock, 1e-7, 0.0),
        (Method::DormandPrince, 1e-7, 1e3),
        (Method::Rk4, 1e-7, 1e3),
    ] {
        let block = block(slope, 1e6, damping, "run: {duration: 2, output: 0.1}\n");
        let q = vec![0.0; block.size()];
        let start = Start::given(InitialState { v: q.clone(), q, x: Vec::new() });
        let table = run(&block, method, tolerance, &start);
        let change = |name: &str| value(&table, name, 2.0) - value(&table, name, 1.0);
        let found = change("block_x_rate");
        assert!((found / expected - 1.0).abs() < 1e-6, "{method:?}: {found} m/s² for {expected}");
        if damping == 0.0 {
            // Its springs follow within 1 ms, and store more the faster it slides.
            continue;
        }
        let lost = FRICTION * MASS * GRAVITY * slope.cos() * change("block_x");
        let found = change("dissipated_energy");
        assert!((found / lost - 1.0).abs() < 1e-5, "{method:?}: {found} J for {lost}");
        // Each foot is where the block is, except for the elongation of its spring.
        let slid = value(&table, "a_slid_x", 2.0) - value(&table, "block_x", 2.0);
        assert!(slid.abs() < 1e-2, "{method:?}: {slid} m");
        let balance = table.values("energy_balance").expect("audited").fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(balance < 1e-4 * lost, "{method:?}: {balance} J");
    }
}

/// A push slides a block, which then sticks where it is: it does not creep, and its springs keep what friction left in them.
#[test]
fn a_block_that_was_pushed_sticks() {
    let push = "loads:\n  - {name: push, link: block, at: [0, 0, 0.2], force: [600, 150, 0], scale: {table: {\
                times: [0, 0.1, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 9], values: [0, 1, 1, 0, 0, 0, 0, 0, 0]}}}\nrun: {duration: 4, output: 0.1}\n";
    let block = block(0.0, 1e6, 1e3, push);
    let start = Start::new(&block).expect("it stands");
    for (method, tolerance) in [(Method::Bdf, 1e-6), (Method::Rosenbrock, 1e-6), (Method::Rk4, 1e-6)] {
        let table = run(&block, method, tolerance, &start);
        let [one, slid] = [1.0, 4.0].map(|t| value(&table, "a_slid_x", t));
        assert!(slid > 0.1, "{method:?}: {slid} m");
        assert!((slid - one).abs() < 1e-12, "{method:?}: creeps by {} m", slid - one);
        // μ N/k of a foot: it cannot be further from its block.
        let place = value(&table, "block_x", 4.0);
        assert!((slid - place).abs() < FRICTION * MASS * GRAVITY / 4.0 / 1e6 * 1.001, "{method:?}: {slid} {place}");
        let balance = table.values("energy_balance").expect("audited").fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(balance < 0.02, "{method:?}: {balance} J");
    }
}

/// Feet that stick act as anchored ones. The forces of anchored ones are summed in another order; where the steps are longest, error control
/// amplifies this rounding to its own tolerance: springs of 1e6 N/m make 1e-3 N of 1e-9 m.
#[test]
fn feet_that_stick_are_anchored_feet() {
    let push = "loads:\n  - {name: push, link: block, at: [0, 0, 0.2], force: [100, 50, 0], scale: {table: {\
                times: [0, 0.1, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 9], values: [0, 1, 1, 0, 0, 0, 0, 0, 0]}}}\nrun: {duration: 1, output: 0.1}\n";
    let text = spec(0.0, 1e6, 1e3, push);
    let anchored = text.replace(&format!("one_sided: true, friction_coefficient: {FRICTION}, "), "");
    let tables = [&text, &anchored].map(|text| {
        let block = crane(text);
        run(&block, Method::DormandPrince, 1e-9, &Start::new(&block).expect("it stands"))
    });
    for name in ["block_x", "block_y", "block_z", "block_phi", "a_reaction_x", "d_reaction_z"] {
        let [one, other] = tables.each_ref().map(|table| table.values(name).expect("a column").collect::<Vec<f64>>());
        let greatest = one.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(greatest > 1e-6, "{name}");
        for (one, other) in one.iter().zip(&other) {
            assert!((one - other).abs() < 1e-4 * greatest, "{name}: {one} for {other}");
        }
    }
}

/// The columns of where feet have slid are their states, which stand between those of oil and of bristles.
#[test]
fn columns_are_the_states_of_feet() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../specs/eight_link_hydraulic.yaml");
    let source = build::open(path.as_ref()).expect("a shipped crane");
    let crane = LiveCrane::from_spec(&source).expect("valid");
    let settings = Settings { duration: 1.0, output: 0.5, ..Settings::from_description(crane.description()) };
    let start = Start::new(&crane).expect("it stands");
    let recorded = record(&crane, &start, &settings, &mut |_| ControlFlow::Continue(())).expect("a run");
    let names: Vec<String> = force_states::columns(crane.description());
    let initial = InitialState { q: start.q.clone(), v: start.v.clone(), x: start.x.clone() };
    let mut last = Vec::new();
    let any: &dyn DynCrane = &crane;
    any.simulate(&initial, &settings, &mut |sample| {
        last = sample.x.to_vec();
        ControlFlow::Continue(())
    })
    .expect("a run");
    let feet = names.iter().zip(&last).filter(|(name, _)| name.contains("_slid_"));
    let mut moved = 0;
    for (name, state) in feet {
        assert_eq!(value(&recorded.table, name, 1.0), *state, "{name}");
        moved += usize::from(*state != 0.0);
    }
    // A foot that has lifted, at 0.7 s, follows its crane.
    assert!(moved >= 2, "{last:?}");
}
