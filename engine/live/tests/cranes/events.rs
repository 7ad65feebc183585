//! Events of runs: what leaves, what joins, what gives way, against closed forms.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::{Hold, LiveCrane, SteeredMotion};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Settings, Simulation};
use crane_model::results::{QUANTITIES, Table, instants};
use crane_model::runs::{Start, imbalance, record, record_checked};

const GRAVITY: f64 = 9.81;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("events.yaml", text.to_owned()))
        .unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn settings(crane: &LiveCrane, method: Method, duration: f64) -> Settings {
    let settings = Settings {
        method,
        tolerance: 1e-10,
        duration,
        output: 0.01,
        audit: true,
        ..Settings::from_description(crane.description())
    };
    if method == Method::Rosenbrock { Settings { tolerance: 1e-8, ..settings } } else { settings }
}

fn run(crane: &LiveCrane, method: Method, duration: f64) -> Table {
    let settings = settings(crane, method, duration);
    let crane: &dyn DynCrane = crane;
    let start = Start::new(crane).expect("a start");
    record(crane, &start, &settings, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|failed| panic!("{failed}"))
        .table
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    table.values(name).unwrap_or_else(|| panic!("no column {name}")).collect()
}

/// A hook of 90 kg and its load on a spring of 50 kN/m without damping; at 0.505 s, between two results, the load is dropped.
const LIFT: &str = "format: 1\nname: lift\nparameters: {load: {value: 590, unit: kg}}\n\
    links: [{name: hook, joint: {prismatic: {axis: z}}, mass: load, com: [0, 0, 0]}]\n\
    drives: [{coordinate: hook_z, stiffness: 5e4, motion: {hold: 0}}]\n\
    points: [{name: hoisted, link: hook}]\nanalyses: [statics, dynamics, modes, internal_forces]\n";

/// What is left swings about its own rest, z = −(g/k)(m⁺ + Δm cos ω(t − t₀)): twice the load's deflection up.
#[test]
fn a_load_that_is_dropped_lets_its_spring_swing() {
    let lift = crane(&format!("{LIFT}events: [{{name: drop, at: 505 ms, set: {{load: 90 kg}}}}]\n"));
    let omega = (5e4_f64 / 90.0).sqrt();
    for method in Method::ALL {
        let table = run(&lift, method, 1.5);
        let (t, z, force) = (column(&table, "t"), column(&table, "hook_z"), column(&table, "hook_z_drive_force"));
        for ((t, z), force) in t.iter().zip(&z).zip(&force) {
            let share = if *t < 0.505 { 1.0 } else { (omega * (t - 0.505)).cos() };
            let expected = -(GRAVITY / 5e4) * (90.0 + 500.0 * share);
            // Of a swing of 0.1 m; constant steps are 1e-4 s, where ω h is 2.4e-3.
            assert!((z - expected).abs() < 1e-6, "{method:?}, {t} s: {z}, {expected}");
            assert!((force + 5e4 * z).abs() < 1e-6 * 5e4, "{method:?}, {t} s: {force}");
        }
        // What leaves takes its energy, m g z and no speed, with it; that of the spring stays.
        let left = column(&table, "event_work");
        let expected = 500.0 * GRAVITY * GRAVITY * 590.0 / 5e4;
        assert!((left.last().expect("rows") - expected).abs() < 1e-5 * expected, "{method:?}: {left:?}");
        assert!(imbalance(&table, 0.0) < 1e-5, "{method:?}: {}", imbalance(&table, 0.0));
        // Internal forces after it are those of the crane without the load: what the link exerts on the ground is the force of the drive.
        let whole: &dyn DynCrane = &lift;
        for (instant, force) in instants(whole, table.rows.iter()).iter().zip(&force) {
            let transmitted = instant.wrenches[0].force[2];
            assert!((transmitted + force).abs() < 1e-6 * 5e4, "{method:?}, {} s: {transmitted}, {force}", instant.t);
        }
    }
}

/// A run that begins later has its results and its events from there.
#[test]
fn a_run_that_begins_later_has_the_events_from_there() {
    let lift = crane(&format!(
        "{LIFT}events: [{{name: before, at: 300 ms, set: {{load: 200 kg}}}}, {{name: drop, at: 505 ms, set: {{load: 90 kg}}}}]\n"
    ));
    let (start, settings) = (Start::new(&lift as &dyn DynCrane).expect("a start"), settings(&lift, Method::Bdf, 0.25));
    let (omega, mut times) = ((5e4_f64 / 90.0).sqrt(), Vec::new());
    let run =
        Simulation::with_events(&lift, &QUANTITIES, start.state.clone(), &settings).at_time(0.5).observe(|sample| {
            let share = if sample.t < 0.505 { 1.0 } else { (omega * (sample.t - 0.505)).cos() };
            // As above.
            assert!(
                (sample.q[0] + (GRAVITY / 5e4) * (90.0 + 500.0 * share)).abs() < 1e-6,
                "{} s: {}",
                sample.t,
                sample.q[0]
            );
            times.push(sample.t);
            ControlFlow::Continue(())
        });
    assert_eq!(run.map(|run| run.time), Ok(0.75));
    assert_eq!(times, (0..=25).map(|i| 0.5 + 0.01 * f64::from(i)).collect::<Vec<f64>>());
}

/// At the time of a result, the result is that after the event.
#[test]
fn a_result_at_an_event_is_after_it() {
    let lift = crane(&format!("{LIFT}events: [{{name: drop, at: 0.5, set: {{load: 90}}}}]\n"));
    let table = run(&lift, Method::DormandPrince, 0.6);
    let (t, left) = (column(&table, "t"), column(&table, "event_work"));
    for (t, left) in t.iter().zip(&left) {
        assert_eq!(*t >= 0.5, *left != 0.0, "{t} s: {left} J");
    }
    assert_eq!(t.len(), 61);
}

/// Events at one time happen one after the other, and what leaves does not join.
#[test]
fn events_at_one_time_happen_in_their_order() {
    let events = "events: [{name: drop, at: 0.5, set: {load: 90}, joins: {}}, {name: catch, at: 0.5, set: {load: 300}}, {name: late, at: 9, set: {load: 1}}]";
    let lift = crane(&format!("{LIFT}{events}\n"));
    for method in Method::ALL {
        let table = run(&lift, method, 1.0);
        let (t, z) = (column(&table, "t"), column(&table, "hook_z"));
        let omega = (5e4_f64 / 300.0).sqrt();
        for (t, z) in t.iter().zip(&z) {
            let share = if *t < 0.5 { 1.0 } else { (omega * (t - 0.5)).cos() };
            let expected = -(GRAVITY / 5e4) * (300.0 + 290.0 * share);
            assert!((z - expected).abs() < 1e-6, "{method:?}, {t} s: {z}, {expected}");
        }
    }
}

/// A trolley of 100 kg that rolls at 0.4 m/s takes up a log of 300 kg: p = Σ m v, whatever the log did before.
#[test]
fn momentum_joins_with_what_is_gripped() {
    let trolley = |joins: &str| {
        crane(&format!(
            "format: 1\nname: trolley\nparameters: {{load: {{value: 100, unit: kg}}}}\n\
             links:\n- {{name: trolley, joint: {{prismatic: {{axis: x}}}}, mass: load, com: [0, 0, 0]}}\n\
             points: [{{name: grapple, link: trolley}}]\nanalyses: [dynamics]\n\
             events: [{{name: grip, at: 1, set: {{load: 400}}{joins}}}]\n"
        ))
    };
    for (joins, velocity) in
        [("", 0.4), (", joins: {}", 0.1), (", joins: {velocity: [1 m/s, 0, 9], point: grapple}", 0.85)]
    {
        let crane = trolley(joins);
        let settings = settings(&crane, Method::DormandPrince, 2.0);
        let crane: &dyn DynCrane = &crane;
        let start = Start::with(crane, 0.0, None, Some(&[0.4])).expect("a start");
        let table = record(crane, &start, &settings, &mut |_| ControlFlow::Continue(())).expect("a run").table;
        let rate = column(&table, "trolley_x_rate");
        assert!((rate.last().expect("rows") - velocity).abs() < 1e-12, "{joins}: {rate:?}");
        let gained = 0.5 * 400.0 * velocity * velocity - 0.5 * 100.0 * 0.16;
        assert!((column(&table, "event_work").last().expect("rows") - gained).abs() < 1e-10, "{joins}");
        assert!(imbalance(&table, 0.0) < 1e-9, "{joins}");
    }
}

/// What is dropped at the same time flies on with its momentum: 50 of 100 kg that roll at 1 m/s are exchanged for 10 kg at rest.
#[test]
fn what_leaves_takes_its_momentum_and_what_joins_brings_its_own() {
    let cart = |event: &str| {
        crane(&format!(
            "format: 1\nname: cart\nparameters: {{log: {{value: 50, unit: kg}}, sand: {{value: 0.001, unit: kg}}}}\n\
             links:\n- {{name: cart, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}\n\
             - {{name: load, joint: fixed, mass: log, com: [0, 0, 0]}}\n- {{name: bed, joint: fixed, mass: sand, com: [0, 0, 0]}}\n\
             points: [{{name: bed, link: bed}}]\nanalyses: [dynamics]\nevents: [{{name: swap, at: 1, {event}}}]\n"
        ))
    };
    let ends = |event: &str| {
        let crane = cart(event);
        let settings = settings(&crane, Method::DormandPrince, 1.0);
        let crane: &dyn DynCrane = &crane;
        let start = Start::with(crane, 0.0, None, Some(&[1.0])).expect("a start");
        record(crane, &start, &settings, &mut |_| ControlFlow::Continue(()))
    };
    for (event, rate) in [
        ("set: {log: 0.001}, joins: {}", 1.0),
        ("set: {log: 0.001, sand: 10.001}, joins: {}", 50.002 / 60.002),
        ("set: {log: 0.001, sand: 10.001}, joins: {velocity: [-2, 0, 0], point: bed}", (50.002 - 20.0) / 60.002),
    ] {
        // An event at the end of a run happens.
        let table = ends(event).expect("a run").table;
        let found = *column(&table, "cart_x_rate").last().expect("rows");
        assert!((found - rate).abs() < 1e-12, "{event}: {found}, {rate}");
        assert!(imbalance(&table, 0.0) < 1e-9, "{event}");
    }
    let told =
        ends("set: {log: 0.001}, joins: {velocity: [1, 0, 0], point: bed}").expect_err("nothing joins").to_string();
    assert!(told.contains("event `swap` has a velocity of what joins, and adds no mass"), "{told}");
}

/// An event does not move a crane at once: neither its rigid drives nor its loops.
#[test]
fn an_event_moves_nothing_at_once() {
    let crane = crane(
        "format: 1\nname: rd\nparameters: {to: {value: 1, unit: m}}\n\
         links: [{name: a, joint: {prismatic: {axis: x}}, mass: 10, com: [0, 0, 0]}]\n\
         drives: [{coordinate: a_x, rigid: true, motion: {quintic: {from: 0.5, to: to, duration: 2}}}]\n\
         events: [{name: longer, at: 1, set: {to: 2}}]\n",
    );
    let settings = settings(&crane, Method::Bdf, 2.0);
    let whole: &dyn DynCrane = &crane;
    let start = Start::new(whole).expect("a start");
    let told = record(whole, &start, &settings, &mut |_| ControlFlow::Continue(())).expect_err("a jump").to_string();
    assert!(told.contains("event `longer` would move a_x from 0.750000 to 1.250000 at once"), "{told}");
}

/// A pendulum of 20 kg m² catches 5 kg at 2 m that fly at 3 m/s across it: (J + m L²) ω = m L u. Its trolley is held by a rigid drive.
#[test]
fn a_pendulum_catches_what_flies() {
    let crane = crane(
        "format: 1\nname: pendulum\nparameters: {caught: {value: 0, unit: kg}}\n\
         links:\n- {name: trolley, joint: {prismatic: {axis: x}}, mass: 100, com: [0, 0, 0]}\n\
         - {name: rod, joint: {revolute: {axis: y}}, mass: 10, com: [0, 0, -1], inertia: {Ixx: 10, Iyy: 10, Izz: 0.1}}\n\
         - {name: basket, placement: {transform: {translation: [0, 0, -2]}}, joint: fixed, mass: caught, com: [0, 0, 0]}\n\
         drives: [{coordinate: trolley_x, rigid: true, motion: {speed: {rate: 0.5}}}]\n\
         points: [{name: basket, link: basket}]\nanalyses: [statics, dynamics]\n\
         events: [{name: catch, at: 1, set: {caught: 5}, joins: {velocity: [3.5, 0, 0], point: basket}}]\n",
    );
    let table = run(&crane, Method::DormandPrince, 1.0 + 1e-9);
    // Seen from the trolley, it flies at 3 m/s; the rod turns about y, its end at z = −2 m moves along −x.
    let expected = -5.0 * 2.0 * 3.0 / (20.0 + 5.0 * 4.0);
    let [rate, trolley] = ["rod_theta_rate", "trolley_x_rate"].map(|name| *column(&table, name).last().expect("rows"));
    assert!((rate - expected).abs() < 1e-7, "{rate}, {expected}");
    assert_eq!(trolley, 0.5);
}

/// Times of the events of a run that is checked, and what it warns of.
fn times(crane: &LiveCrane, method: Method, duration: f64) -> (Vec<Option<f64>>, Vec<String>) {
    let settings = settings(crane, method, duration);
    let crane: &dyn DynCrane = crane;
    let start = Start::new(crane).expect("a start");
    let recorded =
        record_checked(crane, &start, &settings, (true, 5.0), &mut |_| ControlFlow::Continue(())).expect("a run");
    (recorded.table.times_of_events(crane.description()), recorded.cautions)
}

/// Lowered at 0.4 m/s on its spring, the load comes off as its hook passes −0.5 m: with z = −m g/k − v t + (v/ω) sin ωt before, whose root is
/// found here, and the spring goes on from there with what is left.
#[test]
fn a_load_comes_off_at_a_height() {
    let lift = LIFT.replace("{hold: 0}", "{speed: {rate: -0.4}}");
    let lift = crane(&format!(
        "{lift}events: [{{name: drop, when: {{result: hook_z, below: -500 mm}}, set: {{load: 90 kg}}}}]\n"
    ));
    let (k, v) = (5e4_f64, 0.4);
    let omega = (k / 590.0).sqrt();
    let before = |t: f64| -590.0 * GRAVITY / k - v * t + v / omega * (omega * t).sin();
    let rate = |t: f64| -v + v * (omega * t).cos();
    let (mut early, mut late) = (0.5, 1.5);
    for _ in 0..60 {
        let middle = 0.5 * (early + late);
        if before(middle) < -0.5 { late = middle } else { early = middle }
    }
    let own = (k / 90.0).sqrt();
    // Relative to where the spring would carry what is left, which sinks at v.
    let offset = before(late) + 90.0 * GRAVITY / k + v * late;
    let after = |t: f64| {
        let (sin, cos) = (own * (t - late)).sin_cos();
        -90.0 * GRAVITY / k - v * t + offset * cos + (rate(late) + v) / own * sin
    };
    for method in Method::ALL {
        let table = run(&lift, method, 1.5);
        let time = *column(&table, "drop_time").last().expect("rows");
        // The error of the run over the speed there.
        assert!((time - late).abs() < 1e-7, "{method:?}: {time}, {late}");
        for ((t, z), noted) in column(&table, "t").iter().zip(column(&table, "hook_z")).zip(column(&table, "drop_time"))
        {
            let expected = if *t < late { before(*t) } else { after(*t) };
            assert!((z - expected).abs() < 2e-6, "{method:?}, {t} s: {z}, {expected}");
            assert_eq!(noted, if *t < late { 0.0 } else { time }, "{method:?}, {t} s");
        }
        // What leaves takes its energies of height and of motion.
        let left = column(&table, "event_work");
        let expected = 500.0 * (GRAVITY * 0.5 - 0.5 * rate(late).powi(2));
        assert!((left.last().expect("rows") - expected).abs() < 1e-4 * expected, "{method:?}: {left:?}, {expected}");
        assert!(imbalance(&table, 0.0) < 1e-5, "{method:?}: {}", imbalance(&table, 0.0));
        // Internal forces know which crane it is.
        for (instant, force) in instants(&lift, table.rows.iter()).iter().zip(column(&table, "hook_z_drive_force")) {
            let transmitted = instant.wrenches[0].force[2];
            assert!((transmitted + force).abs() < 1e-6 * k, "{method:?}, {} s: {transmitted}, {force}", instant.t);
        }
    }
}

/// The largest effort of a run is that of all its phases: raised at 0.4 m/s, the spring carries m (g + v ω) before the load is dropped, and not half of it
/// after.
#[test]
fn efforts_before_an_event_count() {
    let lift = LIFT.replace("{hold: 0}", "{speed: {rate: 0.4}}");
    let lift = crane(&format!("{lift}events: [{{name: drop, at: 505 ms, set: {{load: 90 kg}}}}]\n"));
    let expected = 590.0 * (GRAVITY + 0.4 * (5e4_f64 / 590.0).sqrt());
    let start = Start::new(&lift).expect("a start");
    let mut known = 0;
    for method in Method::ALL {
        let settings = settings(&lift, method, 1.0);
        let recorded = record(&lift, &start, &settings, &mut |_| ControlFlow::Continue(())).expect("a run");
        for effort in &recorded.run.efforts {
            // Steps end beside the peak.
            assert!((effort.peak - expected).abs() < 1e-2 * expected, "{method:?}: {}, {expected}", effort.peak);
            known += 1;
        }
    }
    assert!(known > 0, "no method estimates the error of an effort");
}

/// A rigid drive goes 1 m up and down again within 4 s, over 0.5 m at 1 s and below it at 3 s.
fn elevator(events: &str) -> LiveCrane {
    elevator_within(4.0, events)
}

/// The same within another time, s.
fn elevator_within(whole: f64, events: &str) -> LiveCrane {
    let times = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| part * whole);
    crane(&format!(
        "format: 1\nname: elevator\nparameters: {{load: {{value: 1000, unit: kg}}, hook: {{value: 5, unit: kg}}}}\n\
         links:\n- {{name: car, joint: {{prismatic: {{axis: z}}}}, mass: load, com: [0, 0, 0]}}\n\
         - {{name: hook, joint: fixed, mass: hook, com: [0, 0, 0]}}\n\
         drives: [{{coordinate: car_z, rigid: true, motion: {{table: {{times: {times:?}, values: [0, 0.5, 1, 0.5, 0]}}}}}}]\n\
         points: [{{name: floor, link: car}}]\nevents: [{events}]\n"
    ))
}

/// What holds at the start has to cease first; what never comes is told; what an event changes at once makes another one due.
#[test]
fn conditions_hold_anew() {
    let down = "{name: down, when: {result: floor_z, below: 0.5}, set: {load: 50}}";
    let up = "{name: up, when: {result: car_z, above: 0.5}, set: {load: 900}}";
    let lighter = "{name: lighter, when: {result: car_z_drive_force, below: 700 N}, set: {hook: 1}}";
    for method in Method::ALL {
        let near = |time: Option<f64>, expected: f64| time.is_some_and(|time| (time - expected).abs() < 1e-9);
        let (found, cautions) = times(&elevator(down), method, 4.0);
        assert!(near(found[0], 3.0) && cautions.is_empty(), "{method:?}: {found:?}, {cautions:?}");
        // Those on conditions are listed last; the force falls from kilonewtons to 540 N with `down`, and its own event follows at once.
        let later = "{name: later, at: 3.5, set: {load: 60}}";
        let (found, _) = times(&elevator(&[up, lighter, down, later].join(", ")), method, 4.0);
        let [planned, up, lighter, down] = found[..] else { panic!("{found:?}") };
        assert_eq!(planned, Some(3.5));
        assert!(near(up, 1.0) && near(down, 3.0) && lighter == down.map(f64::next_up), "{method:?}: {found:?}");
    }
    let (found, _) = times(&elevator_within(1.0, up), Method::DormandPrince, 1.0);
    assert!(found[0].is_some_and(|time| (time - 0.25).abs() < 1e-9), "{found:?}");
    let (found, cautions) = times(&elevator(down), Method::DormandPrince, 0.3);
    assert_eq!(found, [None]);
    assert_eq!(
        cautions,
        [
            "event down does not happen: it waits until floor_z falls below 0.5 m, and starts below it, at 0.000000 m: that has to cease first"
        ]
    );
    let never = "{name: never, when: {result: floor_z, above: 4 m}, set: {load: 50}}";
    let (found, cautions) = times(&elevator(never), Method::DormandPrince, 4.0);
    assert_eq!(found, [None]);
    assert_eq!(
        cautions,
        ["event never does not happen: it waits until floor_z rises above 4 m, and the run only reaches 1.000000 m"]
    );
}

/// An event that breaks a rule says which.
#[test]
fn events_that_cannot_happen_are_refused() {
    let mistakes = |events: &str| {
        let text = format!("{LIFT}events: [{events}]\n");
        LiveCrane::from_spec(&SourceFile::new("events.yaml", text)).expect_err("a mistake").to_string()
    };
    for (events, code) in [
        ("{name: drop, at: 1, set: {load: 0}}", "E194"),
        ("{name: drop, at: 1, set: {}}", "E193"),
        ("{name: drop, at: 1, set: {lod: 90}}", "did you mean `load`"),
        ("{name: drop, at: 1, set: {load: 90 m}}", "E034"),
        ("{name: drop, at: 0, set: {load: 90}}", "E031"),
        ("{name: drop, at: 1, set: {load: 90}}, {name: drop, at: 2, set: {load: 80}}", "an earlier event"),
        ("{name: grip, at: 1, set: {load: 900}, joins: {velocity: [1, 0, 0]}}", "E195"),
        ("{name: grip, at: 1, set: {load: 900}, joins: {point: hoistd}}", "E196"),
        ("{name: drop, set: {load: 90}}", "E199"),
        ("{name: drop, at: 1, when: {result: hook_z, above: 1}, set: {load: 90}}", "E199"),
        ("{name: drop, when: {result: hook_x, above: 1}, set: {load: 90}}", "did you mean `hook_z`"),
        ("{name: drop, when: {result: drive_work, above: 1}, set: {load: 90}}", "E200"),
        ("{name: drop, when: {result: hook_z}, set: {load: 90}}", "E201"),
        ("{name: drop, when: {result: hook_z, above: 1, below: 2}, set: {load: 90}}", "E201"),
        ("{name: drop, when: {result: hook_z, above: 1 kN}, set: {load: 90}}", "E034"),
        ("{name: drop, when: {result: hook_z, above: load}, set: {load: 90}}", "`above`"),
        ("{name: drop, when: {result: hook_z, above: 1}, set: {load: 0}}", "E194"),
    ] {
        let told = mistakes(events);
        assert!(told.contains(code), "{events}:\n{told}");
    }
}

/// Step by step a crane has the events of its run; from its memory, and from what it says of its events, it goes on as it would have.
#[test]
fn steps_have_the_events_of_a_run() {
    let lift = LIFT.replace("{hold: 0}", "{speed: {rate: -0.4}}");
    let events = "events: [{name: drop, when: {result: hook_z, below: -500 mm}, set: {load: 90}}, {name: lighter, at: 0.705, set: {load: 300}},\
         {name: up, when: {result: hook_z_rate, above: 0.1}, set: {load: 200}, joins: {}}]";
    let crane = crane(&format!("{lift}{events}\n"));
    for method in Method::ALL {
        let table = run(&crane, method, 2.0);
        assert!(table.times_of_events(crane.description()).iter().all(Option::is_some), "{method:?}");
        let of_steps = Settings { duration: f64::INFINITY, ..settings(&crane, method, 2.0) };
        let start = Start::new(&crane as &dyn DynCrane).expect("a start").state;
        let mut motion = SteeredMotion::new(&crane, 0.0, &start, &of_steps, None).expect("a motion");
        let mut in_others =
            crane_live::Motion::new(Box::new(crane.clone()), 0.0, &start, &of_steps, None).expect("a motion");
        let proceed = &mut |_: f64| ControlFlow::Continue(());
        let columns = ["hook_z", "hook_z_rate", "event_work", "drive_work"].map(|name| column(&table, name));
        for (row, values) in table.rows.iter().enumerate().skip(1) {
            // The same results: the same numbers, but that a sum of steps is not a product.
            assert!(
                motion
                    .advance(values[0] - motion.sample().t, [], Hold::Constant, proceed)
                    .expect("a step")
                    .is_continue()
            );
            let sample = motion.sample();
            let found = [sample.q[0], sample.v[0], sample.event_work, sample.work];
            for (value, expected) in found.iter().zip(&columns) {
                let off = (value - expected[row]).abs();
                assert!(
                    off < 1e-9 * (1.0 + expected[row].abs()),
                    "{method:?}, {} s: {value}, {}",
                    values[0],
                    expected[row]
                );
            }
            let times = sample.event_times.to_vec();
            for (value, expected) in times.iter().zip(&values[values.len() - 2..]) {
                assert!((value - expected).abs() < 1e-9, "{method:?}, {} s: {value}, {expected}", values[0]);
            }
            if row % 70 == 69 {
                let memory = motion.memory();
                // It goes on as the run does.
                motion = SteeredMotion::recalled(&crane, &of_steps, &memory).expect("a memory");
                assert!(SteeredMotion::recalled(&crane, &of_steps, &memory[..memory.len() - 1]).is_none());
            }
            if row % 37 == 36 {
                let _ = in_others.advance(values[0], proceed).expect("a step");
                // A new history begins, with what has happened.
                let sample = in_others.sample();
                let state = InitialState { q: sample.q.to_vec(), v: sample.v.to_vec(), x: sample.x.to_vec() };
                // Of a way of 0.8 m, at tolerances of 1e-8 and 1e-10.
                assert!((state.q[0] - columns[0][row]).abs() < 1e-6, "{method:?}, {} s", values[0]);
                let after = in_others.crane().boxed_clone();
                let marks = in_others.marks();
                in_others =
                    crane_live::Motion::new(after, sample.t, &state, &of_steps, Some(&marks)).expect("a motion");
            }
        }
    }
}
