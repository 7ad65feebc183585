//! The adjoint mode is the transpose of the forward mode.

use std::ops::ControlFlow;

use crane_codegen::{SourceFile, build};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::gradients::{Around, CylinderSlopes, FeetSlopes, MotionAt, Numbers, Slopes};
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::loop_joints::Given;
use crane_model::results::quantities;
use crane_model::runs::{self, Measure, Start, record_adjoint, record_gradients};
use crane_model::{CoordinateRole, EventInfo, ParameterError};

use super::directions::Directions;
use super::transposed::Transposed;
use super::{Along, of_start};
use crate::LiveCrane;

/// Slopes whose errors do not shorten steps: the forward mode then takes those of the motion alone, as the adjoint mode does.
struct Unheeded<'a>(Directions<'a>);

impl Numbers for Unheeded<'_> {
    fn count(&self) -> usize {
        self.0.count()
    }

    fn around(&self, direction: usize) -> Option<Around<'_>> {
        self.0.around(direction)
    }

    fn stops(&mut self) -> Vec<(f64, Vec<f64>)> {
        self.0.stops()
    }
}

impl Slopes for Unheeded<'_> {
    fn after(&self, event: &EventInfo) -> Result<Box<dyn Slopes>, ParameterError> {
        Ok(Box::new(Unheeded(self.0.after(event)?)))
    }

    fn scale(&self, _: usize) -> f64 {
        0.0
    }

    fn residuals(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<f64>]) {
        self.0.residuals(at, along, out);
    }

    fn loops(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<[f64; 3]>]) {
        self.0.loops(at, along, out);
    }

    fn cylinders(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [Vec<CylinderSlopes>]) {
        self.0.cylinders(at, along, out);
    }

    fn feet(&mut self, at: &MotionAt<'_>, along: &[Vec<f64>], out: &mut [FeetSlopes]) {
        self.0.feet(at, along, out);
    }

    fn drive_motions(&mut self, t: f64, out: &mut [Vec<[f64; 2]>]) -> bool {
        self.0.drive_motions(t, out)
    }
}

fn spec(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

fn shipped(name: &str, changes: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap();
    let source = if changes.is_empty() { source } else { source.changed(&format!("name: changed\n{changes}")) };
    LiveCrane::from_spec(&source).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// Compares all derivatives of measures of coordinates and their rates by live parameters, inputs that are set and all starts.
fn assert_transposed(what: &str, crane: &LiveCrane, duration: f64, moves: bool) {
    let description = crane.description();
    let n = crane.size();
    let mut along: Vec<Along> = (0..crane.parameters().len()).map(Along::Parameter).collect();
    along.extend((0..description.inputs.len()).filter(|index| crane.input(*index).is_some()).map(Along::Input));
    let free = (0..n).filter(|index| description.coordinates[*index].role != CoordinateRole::Prescribed);
    along.extend(free.flat_map(|index| [Along::Position(index), Along::Rate(index)]));
    let own = Settings::from_description(description);
    let settings =
        Settings { duration, output: duration / 7.0, tolerance: 1e-5, audit: false, method: Method::Rosenbrock, ..own };
    let start = if moves {
        let rest = Start::new(crane).unwrap().state;
        let mut start = Start::given(InitialState { v: vec![0.01; n], ..rest });
        start.close(crane, 0.0, &Given::default()).unwrap();
        start
    } else {
        Start::new(crane).unwrap()
    };
    let proceed = &mut |_: f64| ControlFlow::Continue(());
    let mut slopes = Unheeded(Directions::new(crane, &along));
    let start_along = of_start(crane, &slopes.0, &start, &along);
    let (forward, expected) =
        record_gradients(crane as &dyn DynCrane, &start, &settings, &mut slopes, start_along, proceed).unwrap();
    let columns = quantities(description, crane.loop_joints()).len();
    let of_motion = 1..=2 * n;
    let mut asked: Vec<(usize, Measure)> = of_motion.clone().map(|column| (column, Measure::Final)).collect();
    asked.extend([(1, Measure::Integral), (n, Measure::Peak), (2 * n, Measure::Integral)]);
    asked.extend((2 * n + 1..columns).step_by(7).map(|column| (column, Measure::Maximum)));
    let mut functions = Transposed::new(crane, &along).unwrap();
    let start_along = of_start(crane, functions.directions(), &start, &along);
    let (probes, of_probes) = functions.directions().probes(&along, &start_along);
    let transposed =
        runs::Transposed { functions: &mut functions, along: &start_along, probes: (&mut Unheeded(probes), of_probes) };
    let (recorded, found) = record_adjoint(crane, &start, &settings, transposed, &asked, proceed).unwrap();
    assert_eq!(recorded.table.rows, forward.table.rows, "{what}");
    let t: Vec<f64> = recorded.table.rows.iter().map(|row| row[0]).collect();
    let mut wrong = Vec::new();
    let mut compared = 0;
    for ((column, measure), found) in asked.iter().zip(&found) {
        let values: Vec<f64> = recorded.table.rows.iter().map(|row| row[*column]).collect();
        let expected: Vec<f64> = expected
            .iter()
            .map(|rows| measure.take(&t, &values, &rows.iter().map(|row| row[*column]).collect::<Vec<f64>>()))
            .collect();
        // Both are sums of the same numbers in another order. Columns other than coordinates and rates are differences to one side, along other
        // directions. What is below 1e-8 is what remains of terms of 1e-4 and more.
        let tolerance = if of_motion.contains(column) { 1e-8 } else { 5e-3 };
        let is_of_start = |along: &Along| matches!(along, Along::Position(_) | Along::Rate(_));
        let starts = along.iter().zip(&expected).filter(|(along, _)| is_of_start(along));
        let largest = starts.fold(0.0, |size: f64, (_, expected)| size.max(expected.abs()));
        for ((along, value), expected) in along.iter().zip(found).zip(&expected) {
            let size = if is_of_start(along) { largest } else { expected.abs() };
            compared += 1;
            let off = (value - expected).abs() / size.max(1e-8);
            if off.is_nan() || off > tolerance {
                wrong.push(format!(
                    "{} of {} by {along:?} is {value:e}, not {expected:e}: {off:.1e}",
                    measure.name(),
                    recorded.table.columns[*column].name
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{what}: {} of {compared}\n{}", wrong.len(), wrong[..wrong.len().min(12)].join("\n"));
}

const RIGID: &str = "parameters:\n  height: {value: 0.34, unit: m}\n  slew: {value: 2.6, unit: rad}\n  lift: {value: 0.9, unit: rad}\n  \
                     spring: {value: 2e7, unit: N m/rad}\nlinks:\n  - {name: boom, beam: {section: {box: {height: height, width: 0.24, \
                     thickness: 0.008}}}}\ndrives:\n  - {coordinate: column_psi, motion: {quintic: {from: 180 deg, to: slew, duration: 2}}}\n  \
                     - {coordinate: boom_psi, rigid: true, stiffness: ~, damping: ~, motion: {quintic: {from: 55 deg, to: lift, duration: 2}}}\n  \
                     - {coordinate: jib_psi, stiffness: spring}\n";
const LOOPS: &str = "parameters:\n  lift: {value: 1.1, unit: rad}\n  pin: {value: 2.19, unit: m}\nloop_joints: \
                     [{name: parallel_pin, from: {link: column, at: [-0.23, 0, pin]}}]\ndrives:\n  - {coordinate: boom_psi, rigid: true, \
                     stiffness: ~, damping: ~, motion: {quintic: {from: 60 deg, to: lift, duration: 1}}}\n";
const OIL: &str = "parameters: {pin: {value: 1.1}, rocker: {value: 0.45}, far: {value: 0.4, unit: rad}}\ncylinders:\n  - {name: boom_cylinder, \
                   foot: {link: column, at: [0.3, 0, pin]}}\n  - {name: outer_boom_cylinder, linkage: {pivot: [3.2, 0.15, 0], rocker: rocker, \
                   link: 0.45, side: left}}\ndrives:\n  - {coordinate: boom_psi, motion: {quintic: {from: 30 deg, to: far, duration: 1}}}\n";

#[test]
fn the_adjoint_mode_is_the_transpose_of_the_forward_mode() {
    for (name, changes, duration, moves) in [
        ("double_pendulum", "", 1.0, true),
        ("knuckle_boom", "", 0.5, true),
        ("eight_link_flexible", "", 0.3, false),
        ("two_arms", "", 0.3, true),
        ("loader_tipping", RIGID, 0.5, false),
        ("examples/parallel_harvester", LOOPS, 0.5, false),
        ("examples/telescopic_loader", "", 0.3, false),
        ("eight_link_hydraulic", OIL, 0.5, false),
    ] {
        assert_transposed(name, &shipped(name, changes), duration, moves);
    }
    let mut swinging = spec(SWINGING);
    swinging.set_input(0, Some(30.0));
    assert_transposed("swinging", &swinging, 1.6, true);
    // It becomes lighter as it swings; at once it is braked, at the end of the drive's motion heavier.
    let mut changing = spec(&format!("{SWINGING}{CHANGING}"));
    changing.set_input(0, Some(30.0));
    assert_transposed("changing", &changing, 1.6, true);
}

/// A drive whose prescribed acceleration jumps at times that depend on parameters, a joint that sticks, an input.
const SWINGING: &str = "
format: 1
name: swinging
parameters: {far: {value: 0.8}, begin: {value: 0.3}, span: {value: 0.9}, mass: {value: 10}}
inputs: {gust: {value: 0, unit: N}}
analyses: [statics, dynamics]
links:
  - {name: arm, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 20, com: [0.5, 0, 0], inertia: {Ixx: 1, Iyy: 2, Izz: 2}}
  - {name: load, placement: {transform: {translation: [1, 0, 0]}}, joint: revolute, mass: mass, com: [0, -0.5, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
drives: [{coordinate: arm_psi, stiffness: 2e4, damping: 300, motion: {trapezoid: {from: 0.2, to: far, begin: begin, duration: span}}}]
loads: [{name: wind, link: load, at: [0, -0.5, 0], force: [1, 0, 0], scale: {input: gust}}]
friction:
  load_psi: {coulomb: 20, breakaway: 25, stribeck: 0.02, viscous: 3, bristle: {stiffness: 2e4, damping: 90}}
";

/// Events on conditions, one of which makes the other due, and one at a time at which the drive's acceleration jumps.
const CHANGING: &str = "points: [{name: hook, link: load, at: [0, -0.5, 0]}]
events:
  - {name: fall, when: {result: hook_z, above: 0.05}, set: {mass: 7}}
  - {name: follow, when: {result: hook_vz, below: 0.02}, set: {far: 0.8}}
  - {name: grip, at: 1.2, set: {mass: 12}, joins: {velocity: [0.5, 0, 0.2], point: hook}}
";

/// A block that slides sideways as it lands on feet that stick.
const LANDING: &str = "
format: 1
name: landing
analyses: [dynamics]
links: [{name: block, joint: free, mass: 1000, com: [0.1, 0.05, 0.4], inertia: {Ixx: 300, Iyy: 500, Izz: 600}}]
supports:
  - {name: front, at: [1, 0, 0], kinematics: exact, one_sided: true, sticks: true, stiffness: [2e6, 2e6, 4e6], damping: [2e4, 2e4, 4e4]}
  - {name: left, at: [-1, 0.8, 0], kinematics: exact, one_sided: true, sticks: true, stiffness: [2e6, 2e6, 4e6], damping: [2e4, 2e4, 4e4]}
  - {name: right, at: [-1, -0.8, 0], kinematics: exact, one_sided: true, sticks: true, stiffness: [2e6, 2e6, 4e6], damping: [2e4, 2e4, 4e4]}
";

/// A foot that sticks holds within microseconds of its landing. Derivatives know this only if the step that ends there ends on the ground.
#[test]
fn feet_that_land_hold_at_once() {
    let crane = spec(LANDING);
    let own = Settings::from_description(crane.description());
    let settings =
        Settings { duration: 0.01, output: 0.01, tolerance: 1e-12, audit: false, method: Method::Rosenbrock, ..own };
    let proceed = &mut |_: f64| ControlFlow::Continue(());
    // A change by 1e-4 m/s shifts the landing by microseconds, and changes rates by a hundred times the error of the runs and more.
    let step = 1e-4;
    for landing in 0..12 {
        let height = 1e-3 + 5e-5 * f64::from(landing);
        let start = |more: f64| {
            Start::given(InitialState {
                q: vec![0.0, 0.0, height, 0.0, 0.0, 0.0],
                v: vec![0.05, 0.02, -0.2 + more, 0.0, 0.01, 0.0],
                x: Vec::new(),
            })
        };
        let of_rate = [Along::Rate(2)];
        let (_, found) = super::run_with_gradients(&crane, &start(0.0), &settings, &of_rate, proceed).unwrap();
        let ends = [-step, step].map(|more| runs::record(&crane, &start(more), &settings, proceed).unwrap());
        let [less, more] = ends.each_ref().map(|run| &run.table.rows[1]);
        for column in 7..13 {
            let expected = (more[column] - less[column]) / (2.0 * step);
            let off = (found[0][1][column] - expected).abs();
            assert!(off < 2e-5, "landing {landing}: {} against {expected} in column {column}", found[0][1][column]);
        }
    }
}
