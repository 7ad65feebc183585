//! Eight cranes as one against the same cranes one by one: every function, and runs.

mod every;

use std::sync::atomic::{AtomicUsize, Ordering};

use crane_codegen::build;
use crane_codegen::program::{Count, Extent, FunctionId, Item};
use crane_live::LiveCrane;
use crane_model::dyn_crane::{Arguments, DynCrane, Functions};
use crane_model::dynamics::{Method, Settings};
use crane_model::results::Peaks;
use crane_model::runs::ensemble::{Case, Execution, Outcome, Reason, run_ensemble};
use every::call_every;

const CRANES: usize = 8;
/// Cranes that have fleets, the last one with inputs.
const CRANES_WITH_FLEETS: [&str; 11] = [
    "specs/cantilever",
    "specs/double_pendulum",
    "specs/eight_link_flexible",
    "specs/eight_link_rigid",
    "specs/eight_link_two_flexible",
    "specs/knuckle_boom",
    "specs/loader_tipping",
    "specs/examples/telescopic_loader",
    "engine/live/tests/specs/sticking",
    "specs/examples/parallel_harvester",
    "examples/python/slewing_crane",
];

fn shipped(name: &str) -> LiveCrane {
    let path = format!("{}/../../{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    LiveCrane::from_spec(&source).unwrap()
}

/// Parameters of the cranes of a fleet: those of the spec, changed by up to 20 % where rules permit it.
fn parameters(crane: &LiveCrane, lane: usize) -> Vec<f64> {
    let mut parameters = crane.parameters().to_vec();
    for (index, info) in crane.description().parameters.iter().enumerate() {
        let before = parameters[index];
        parameters[index] = info.default * (1.0 + 0.05 * (lane as f64 - 3.0));
        if crane.check(&parameters).is_err() {
            parameters[index] = before;
        }
    }
    parameters
}

fn members(crane: &LiveCrane) -> Vec<LiveCrane> {
    let member = |lane: usize| {
        let mut member = crane.clone();
        member.set_parameters(&parameters(crane, lane)).unwrap();
        if !crane.description().inputs.is_empty() && lane.is_multiple_of(2) {
            member.set_input(0, Some(50.0 * lane as f64));
        }
        member
    };
    (0..CRANES).map(member).collect()
}

/// Numbers of cranes, one after the other, as those of a fleet: of parts with some items each, which have some numbers.
fn joined(each: &[Vec<f64>], parts: &[usize], len: usize) -> Vec<f64> {
    let mut first = 0;
    let mut all = Vec::new();
    for part in parts {
        let range = first * len..(first + part) * len;
        for numbers in each {
            all.extend_from_slice(&numbers[range.clone()]);
        }
        first += part;
    }
    all
}

/// How many numbers each item of a list has.
fn length(item: Item) -> usize {
    match item {
        Item::Row => 1,
        Item::Pair => 2,
        Item::Vector | Item::Tension => 3,
        Item::Wrench => 6,
        Item::Moduli => 8,
        Item::Transform => 16,
    }
}

/// Every number and list of a crane at a state.
fn everything(crane: &dyn Functions, (q, v): (&[f64], &[f64])) -> Vec<(FunctionId, Vec<f64>)> {
    let r: Vec<f64> = v.iter().map(|v| 100.0 * v).collect();
    let at = Arguments { t: 0.7, q, v, a: &r, r: &r, positions: q };
    let mut all = Vec::new();
    call_every(crane, at, &mut |_, call| call(), &mut |id, numbers| all.push((id, numbers)));
    all
}

#[test]
fn the_lists_of_a_fleet_are_those_of_its_cranes() {
    for name in CRANES_WITH_FLEETS {
        let crane = shipped(name);
        let members = members(&crane);
        let models: Vec<&dyn DynCrane> = members.iter().map(|member| member as &dyn DynCrane).collect();
        let fleet = crane.fleet(&models).unwrap_or_else(|| panic!("{name} has fleets"));
        let n = crane.size();
        let wave = |lane: usize, scale: f64| move |i: usize| scale * (1.3 * (i + 3 * lane) as f64 + 1.0).sin();
        let state = |lane: usize| {
            let q: Vec<f64> =
                crane.chain().guess.iter().zip((0..n).map(wave(lane, 0.03))).map(|(q, d)| q + d).collect();
            (q, (0..n).map(wave(lane, 0.4)).collect::<Vec<_>>())
        };
        let each: Vec<_> = members.iter().enumerate().map(|(lane, member)| (member, state(lane))).collect();
        let states: [Vec<_>; 2] =
            [each.iter().map(|(_, (q, _))| q.clone()).collect(), each.iter().map(|(_, (_, v))| v.clone()).collect()];
        let ones = vec![1; n];
        let [q, v] = states.map(|each| joined(&each, &ones, 1));
        let of_members: Vec<_> = each.iter().map(|(member, (q, v))| everything(*member, (q, v))).collect();
        for (at, (id, mut numbers)) in everything(fleet.as_ref(), (&q, &v)).into_iter().enumerate() {
            let each: Vec<Vec<f64>> = of_members.iter().map(|all| all[at].1.clone()).collect();
            let expected = match id.extent() {
                Extent::Number => vec![each.iter().flatten().sum()],
                Extent::Vector => joined(&each, &ones, 1),
                Extent::List(Item::Row, _) => joined(&each, &vec![1; each[0].len()], 1),
                // A fleet has no cuts.
                Extent::List(item, count) if count.factors().is_empty() => {
                    let len = length(item);
                    let parts = match count {
                        Count::DrivePieces => crane.description().drives.iter().map(|drive| drive.pieces).collect(),
                        Count::WinchPieces => {
                            crane.description().connectors.iter().map(|connector| connector.pieces).collect()
                        }
                        Count::Attachments => {
                            let points = crane.description().connectors.iter().map(|connector| connector.points.len());
                            let ends = crane.loop_joints().iter().map(|joint| joint.ends.iter().flatten().count());
                            points.chain(ends).collect()
                        }
                        Count::LoadPieces => crane.description().loads.iter().map(|load| load.pieces).collect(),
                        _ => vec![1; each[0].len() / len],
                    };
                    joined(&each, &parts, len)
                }
                _ => continue,
            };
            if id == FunctionId::SupportJacobians {
                // A support moves with the coordinates of its own crane alone: there are no other rows.
                numbers.truncate(expected.len());
            }
            assert_eq!(numbers.len(), expected.len(), "{name}, {}", id.name());
            let largest = expected.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            for (number, expected) in numbers.iter().zip(&expected) {
                // The sum of energies is rounded, all else has the bits of a single crane.
                let allowed = if id.extent() == Extent::Number { 1e-14 * largest } else { 0.0 };
                let equal = (number - expected).abs() <= allowed || number.is_nan() && expected.is_nan();
                assert!(equal, "{name}, {}: {number} of a fleet, {expected} of a crane", id.name());
            }
        }
    }
}

/// Runs rows, in as many pieces as given.
fn runs(crane: &LiveCrane, rows: &[Case], piece: usize, settings: &Settings) -> Vec<Outcome> {
    let execution = Execution { threads: 1, done: &|_, _| {}, cancelled: &|_| false };
    rows.chunks(piece).flat_map(|rows| run_ensemble(crane, rows, settings, &execution)).collect()
}

#[test]
fn the_runs_of_a_fleet_are_those_of_its_cranes() {
    for name in CRANES_WITH_FLEETS {
        let crane = shipped(name);
        let inputs = |lane: usize| -> Vec<Option<f64>> {
            let input = (lane.is_multiple_of(2)).then_some(50.0 * lane as f64);
            vec![input; crane.description().inputs.len()]
        };
        // Nothing holds the one with inputs: it has no equilibrium.
        let is_free = !crane.description().inputs.is_empty();
        let pose = is_free.then(|| crane.chain().guess.clone());
        let case = |lane: usize| Case { inputs: inputs(lane), q: pose.clone(), ..parameters(&crane, lane).into() };
        let rows: Vec<Case> = (0..CRANES).map(case).collect();
        for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince] {
            let tolerance = 1e-7;
            let of_spec = Settings::from_description(crane.description());
            // Short sections at pins and pads allow short explicit steps only.
            let is_stiff = method == Method::DormandPrince && name == "specs/examples/telescopic_loader";
            let duration = if is_stiff { 0.3 } else { 1.5 };
            let settings = Settings { method, duration, tolerance, audit: false, ..of_spec };
            let (together, alone) = (runs(&crane, &rows, CRANES, &settings), runs(&crane, &rows, 1, &settings));
            let steps = |row: &Outcome| row.run.as_ref().map_or(0, |run| run.statistics.steps);
            assert!(together.iter().all(|row| steps(row) == steps(&together[0])), "{name}: all have the same steps");
            let evaluations = |row: &Outcome| row.run.as_ref().map_or(0, |run| run.statistics.evaluations);
            let most = alone.iter().map(evaluations).max().unwrap_or_default();
            // An implicit step with a wrong matrix also converges, but in ten times as many evaluations. Joints that stick change their branch at
            // other times in each crane, each of which shortens the steps of all.
            let all = evaluations(&together[0]);
            assert!(all < 3 * most, "{name}, {method:?}: {all} evaluations together, {most} alone");
            for (lane, pair) in together.iter().zip(&alone).enumerate() {
                assert_close(&format!("{name}, {method:?}, crane {lane}"), pair, 1e3 * tolerance, &crane);
            }
        }
    }
}

/// Two runs of a crane end alike, with the same cautions and peaks.
fn assert_close(what: &str, (together, alone): (&Outcome, &Outcome), allowed: f64, crane: &LiveCrane) {
    let ends = |outcome: &Outcome| [outcome.end.q.clone(), outcome.end.v.clone()].concat();
    for (i, (together, alone)) in ends(together).iter().zip(ends(alone)).enumerate() {
        let error = (together - alone).abs() / (1.0 + alone.abs());
        assert!(error < allowed, "{what}, number {i} of pose and rates: {together} in a fleet, {alone} alone");
    }
    let (states, own) = (&together.end.x, &alone.end.x);
    let largest = own.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let close = states.iter().zip(own).all(|(together, own)| (together - own).abs() <= allowed * largest);
    assert!(states.len() == own.len() && close, "{what}, states of forces: {states:?} in a fleet, {own:?} alone");
    assert_eq!(together.cautions, alone.cautions, "{what}");
    let peaks = |outcome: &Outcome| {
        outcome.peaks.as_ref().unwrap_or_else(|| panic!("{what}: {:?}", outcome.run)).values().collect::<Vec<_>>()
    };
    let (together, alone) = (peaks(together), peaks(alone));
    let columns = Peaks::columns(crane);
    for ((column, together), own) in columns.iter().zip(together).zip(&alone) {
        let alike = columns.iter().zip(&alone).filter(|(other, _)| other.unit == column.unit);
        let largest = alike.fold(0.0, |largest: f64, (_, peak)| largest.max(peak.abs()));
        // Which of two equal peaks is the larger is rounding.
        let is_time = column.name.ends_with("_time");
        let close = (together - own).abs() <= allowed * (1.0 + largest);
        assert!(is_time || close, "{what}, {column}: {together} in a fleet, {own} alone, of {largest}");
    }
}

/// A rate with which a crane leaves the bound of a run.
const WILD: f64 = 1e7;

#[test]
fn a_crane_that_does_not_reach_the_end_does_not_change_the_others() {
    let crane = shipped("specs/knuckle_boom");
    let settings = Settings { duration: 0.5, audit: false, ..Settings::from_description(crane.description()) };
    let n = crane.size();
    let mut rows: Vec<Case> = (0..CRANES).map(|lane| parameters(&crane, lane).into()).collect();
    rows[3].v = Some(vec![WILD; n]);
    let (together, alone) = (runs(&crane, &rows, CRANES, &settings), runs(&crane, &rows, 1, &settings));
    for (lane, (together, alone)) in together.iter().zip(&alone).enumerate() {
        assert_eq!(together.run.is_ok(), lane != 3, "crane {lane}");
        // Then they run alone.
        assert_eq!((&together.end, &together.cautions), (&alone.end, &alone.cautions), "crane {lane}");
    }
}

#[test]
fn a_cancelled_fleet_has_no_results() {
    let crane = shipped("specs/knuckle_boom");
    let settings = Settings { audit: false, ..Settings::from_description(crane.description()) };
    let rows: Vec<Case> = (0..2 * CRANES).map(|lane| parameters(&crane, lane % CRANES).into()).collect();
    let steps = AtomicUsize::new(0);
    let cancelled = |_| steps.fetch_add(1, Ordering::Relaxed) > 50;
    let execution =
        Execution { threads: 1, done: &|row, _| panic!("row {row} is not complete"), cancelled: &cancelled };
    let outcomes = run_ensemble(&crane, &rows, &settings, &execution);
    assert_eq!(outcomes.len(), rows.len());
    assert!(outcomes.iter().all(|outcome| outcome.run.as_ref().is_err_and(|reason| *reason == Reason::Cancelled)));
}

#[test]
fn rows_that_fill_less_than_half_of_a_fleet_run_alone() {
    let crane = shipped("specs/knuckle_boom");
    let settings = Settings { duration: 0.5, audit: false, ..Settings::from_description(crane.description()) };
    let rows: Vec<Case> = (0..CRANES + 3).map(|lane| parameters(&crane, lane % CRANES).into()).collect();
    let (together, alone) = (runs(&crane, &rows, rows.len(), &settings), runs(&crane, &rows, 1, &settings));
    let ends = |outcomes: &[Outcome]| outcomes.iter().map(|row| row.end.clone()).collect::<Vec<_>>();
    assert_eq!(ends(&together)[CRANES..], ends(&alone)[CRANES..]);
    assert_ne!(ends(&together)[..CRANES], ends(&alone)[..CRANES]);
    // Six of eight are filled up with copies of the last one.
    let six = runs(&crane, &rows[..6], 6, &settings);
    assert_ne!(ends(&six), ends(&alone)[..6]);
    for (lane, pair) in six.iter().zip(&alone).enumerate() {
        assert_close(&format!("crane {lane} of six"), pair, 1e-3, &crane);
    }
}
