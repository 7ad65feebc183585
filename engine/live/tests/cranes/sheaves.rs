//! Ropes over sheaves, with falls and winches, against statics and kinematics worked out by hand.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Sample, Settings};
use crane_model::nalgebra::{Rotation3, Vector3};
use crane_model::{Cut, Wrench, statics};

const GRAVITY: f64 = 9.81;

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

fn rest(crane: &dyn DynCrane) -> Vec<f64> {
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    equilibrium.q
}

/// The last sample of a run from rest: coordinates, rates, work of the winch.
fn end_of_run(crane: &dyn DynCrane, duration: f64) -> (Vec<f64>, Vec<f64>, f64) {
    let start = InitialState { q: rest(crane), v: vec![0.0; crane.size()], ..InitialState::default() };
    let of_spec = Settings::from_description(crane.description());
    let settings = Settings { tolerance: 1e-7, duration, output: duration, audit: true, ..of_spec };
    let mut end = (Vec::new(), Vec::new(), f64::NAN);
    let run = crane.simulate(&start, &settings, &mut |sample: &Sample<'_>| {
        end = (sample.q.to_vec(), sample.v.to_vec(), sample.work);
        ControlFlow::Continue(())
    });
    run.unwrap_or_else(|stopped| panic!("{stopped}"));
    end
}

const MASS: f64 = 800.0;
/// From the winch on the ground to the sheaves at the top, m.
const ASIDE: f64 = 3.0;
const TOP: f64 = 6.0;

/// A load that moves up and down on a block and tackle: a rope from a winch on the ground over sheaves above the load.
fn tackle(falls: u32, law: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: tackle\nlinks: [{{name: load, joint: {{prismatic: {{axis: z}}}}, mass: {MASS}, com: [0, 0, 0]}}]\n\
         connectors: [{{name: hoist, from: {{at: [-{ASIDE}, 0, 0]}}, over: [{{at: [0, 0, {TOP}]}}], to: {{link: load, at: [0, 0, 0]}}, falls: {falls}, law: {{rope: {law}}}}}]\n\
         guess: {{load_z: 1}}\n"
    ))
}

/// Part of the rope between the winch and the top, m.
fn to_the_top() -> f64 {
    ASIDE.hypot(TOP)
}

/// `m F = M g`, `F = k (ℓ − ℓ₀)` with `ℓ = ℓ_top + m (h − z)`; the load vibrates with `ω² = m² k/M`.
#[test]
fn a_block_and_tackle_carries_as_many_tensions_as_it_has_falls() {
    let stiffness = 4e5;
    for falls in [1, 2, 5] {
        let parts = f64::from(falls);
        let free = to_the_top() + parts * 4.0;
        let tackle = tackle(falls, &format!("{{stiffness: {stiffness}, damping: 0.1, length: {free}}}"));
        let tackle: &dyn DynCrane = &tackle;
        let q = rest(tackle);
        let tension = MASS * GRAVITY / parts;
        let place = TOP - 4.0 - tension / stiffness / parts;
        // A few rounding errors of the length times the stiffness.
        assert!((q[0] - place).abs() < 1e-10, "{falls} falls: {} instead of {place}", q[0]);
        assert!((tackle.connector_tensions_at(0.0, &q, &[0.0])[0].force - tension).abs() < 1e-6 * tension);
        let small = tackle.small_motions_at(&q);
        let [value, expected] = [small.stiffness[(0, 0)] / small.mass[(0, 0)], parts * parts * stiffness / MASS];
        assert!((value / expected - 1.0).abs() < 1e-9, "{falls} falls: {value} instead of {expected}");
    }
}

/// A winch that winds v per second hoists by v/m per second.
#[test]
fn a_load_on_falls_rises_with_a_fraction_of_the_speed() {
    let (speed, duration) = (0.4, 8.0);
    for falls in [1, 2, 4] {
        let law = format!(
            "{{stiffness: 4e5, damping: 1, motion: {{speed: {{from: {}, rate: -{speed}, ramp: 1}}}}}}",
            to_the_top() + f64::from(falls) * 5.0
        );
        let tackle = tackle(falls, &law);
        let (_, v, _) = end_of_run(&tackle, duration);
        // The damping of the rope has reduced what the start excites to less than a thousandth.
        let expected = speed / f64::from(falls);
        assert!((v[0] / expected - 1.0).abs() < 1e-3, "{falls} falls: {} instead of {expected} m/s", v[0]);
    }
}

/// The stiffness of a rope with EA falls with its free length. What the winch winds up is stretched: for each metre of free length it does the
/// work `F + F²/2EA`, of which `F` for each of `1 + F/EA` metres lifts the load, less what the rope has stored.
#[test]
fn a_winch_winds_up_a_stretched_rope() {
    // Stretched by a tenth.
    let (axial, wound) = (10.0 * MASS * GRAVITY, 1.5);
    let [from, to] = [to_the_top() + 5.0, to_the_top() + 5.0 - wound];
    let motion = format!("{{quintic: {{from: {from}, to: {to}, duration: 20}}}}");
    let tackle = tackle(1, &format!("{{axial_stiffness: {axial}, damping: 0.5, motion: {motion}}}"));
    let tension = MASS * GRAVITY;
    let place = |free: f64| TOP + to_the_top() - free * (1.0 + tension / axial);
    let whole: &dyn DynCrane = &tackle;
    let later = statics::Problem::new(whole).at_time(20.0).from(&rest(whole)).solve();
    for (t, q, free) in [(0.0, &rest(whole), from), (20.0, &later.q, to)] {
        // A few rounding errors of the length.
        assert!((q[0] - place(free)).abs() < 1e-9, "{} instead of {}", q[0], place(free));
        let stiffness = whole.connector_tensions_at(t, q, &[0.0])[0].stiffness;
        assert!((stiffness * free / axial - 1.0).abs() < 1e-12, "{stiffness}");
    }
    let (q, _, work) = end_of_run(&tackle, 24.0);
    let expected = (tension + tension * tension / (2.0 * axial)) * wound;
    // The load is accelerated slowly: about 4 % of its weight for moments, whose work comes back, and the damper takes a little of the rest.
    assert!((work / expected - 1.0).abs() < 2e-3, "{work} J instead of {expected} J");
    assert!((q[0] - place(to)).abs() < 1e-4, "{}", q[0]);
}

/// A load that rides on a rope between two points: both parts have one tension and thus the same slope, whatever the heights of the points.
/// `sin α = d/ℓ` with the horizontal distance d, `2 F cos α = M g`.
#[test]
fn a_load_that_rides_on_a_rope_divides_it_evenly() {
    let (across, rise, stiffness, free) = (4.0, 1.0, 2e5, 6.0);
    let rider = crane(&format!(
        "format: 1\nname: rider\nlinks:\n- {{name: aside, joint: {{prismatic: {{axis: x}}}}}}\n\
         - {{name: load, joint: {{prismatic: {{axis: z}}}}, mass: {MASS}, com: [0, 0, 0]}}\n\
         connectors: [{{name: line, from: {{at: [0, 0, 0]}}, over: [{{link: load, at: [0, 0, 0]}}], to: {{at: [{across}, 0, {rise}]}}, \
         law: {{rope: {{stiffness: {stiffness}, length: {free}}}}}}}]\nguess: {{aside_x: 2, load_z: -2}}\n"
    ));
    let rider: &dyn DynCrane = &rider;
    let q = rest(rider);
    let [left, right] = [(q[0], -q[1]), (across - q[0], rise - q[1])];
    let length = left.0.hypot(left.1) + right.0.hypot(right.1);
    let sine = across / length;
    for (x, z) in [left, right] {
        assert!((x / x.hypot(z) - sine).abs() < 1e-9, "{x} m aside, {z} m down: not {sine}");
    }
    let force = rider.connector_tensions_at(0.0, &q, &[0.0; 2])[0].force;
    assert!((force / (stiffness * (length - free)) - 1.0).abs() < 1e-9);
    assert!((2.0 * force * (1.0 - sine * sine).sqrt() / (MASS * GRAVITY) - 1.0).abs() < 1e-9, "{force} N");
}

/// Three arms in a horizontal plane, and a rope from the ground over the first two to the third, with two falls.
fn arms(law: &str) -> LiveCrane {
    let arm = |name: &str, x: f64| {
        format!(
            "- {{name: {name}, placement: {{transform: {{translation: [{x}, 0, 0]}}}}, joint: revolute, mass: 10, com: [0.5, 0, 0], inertia: {{gyration: [0.1, 0.3, 0.3]}}}}\n"
        )
    };
    crane(&format!(
        "format: 1\nname: arms\nlinks:\n{}{}{}\
         connectors: [{{name: line, from: {{at: [-0.5, -0.6, 0.3]}}, over: [{{link: one, at: [0.4, 0.5, 0.1]}}, {{link: two, at: [0.3, -0.4, 0.2]}}], \
         to: {{link: three, at: [0.6, 0.1, 0]}}, falls: 2, law: {{rope: {law}}}}}]\n",
        arm("one", 0.0),
        arm("two", 1.0),
        arm("three", 0.8)
    ))
}

const LAW: &str = "{stiffness: 700, damping: 0.3, length: 1.5}";
const Q: [f64; 3] = [0.3, 0.7, -0.4];

/// Origins and rotations of the arms.
fn frames(q: [f64; 3]) -> [(Vector3<f64>, Rotation3<f64>); 3] {
    let mut angle = 0.0;
    let mut origin = Vector3::zeros();
    std::array::from_fn(|k| {
        origin += Rotation3::from_axis_angle(&Vector3::z_axis(), angle) * Vector3::new([0.0, 1.0, 0.8][k], 0.0, 0.0);
        angle += q[k];
        (origin, Rotation3::from_axis_angle(&Vector3::z_axis(), angle))
    })
}

/// The points of the rope, with the arm that each is on.
fn points(q: [f64; 3]) -> [(Option<usize>, Vector3<f64>); 4] {
    let frames = frames(q);
    let on = |arm: usize, x: f64, y: f64, z: f64| (Some(arm), frames[arm].0 + frames[arm].1 * Vector3::new(x, y, z));
    [(None, Vector3::new(-0.5, -0.6, 0.3)), on(0, 0.4, 0.5, 0.1), on(1, 0.3, -0.4, 0.2), on(2, 0.6, 0.1, 0.0)]
}

/// Distances of neighbouring points, the last one twice.
fn length(q: [f64; 3]) -> f64 {
    let points = points(q).map(|(_, point)| point);
    (points[1] - points[0]).norm() + (points[2] - points[1]).norm() + 2.0 * (points[3] - points[2]).norm()
}

/// `f · δq = −F δℓ`, with the length from trigonometry.
#[test]
fn a_rope_over_three_links_does_virtual_work() {
    let arms = arms(LAW);
    let arms: &dyn DynCrane = &arms;
    let v = [0.5, -0.8, 1.1];
    // Rounding error of a length divided by the step, and the third derivative times the step squared.
    let (step, tolerance) = (1e-5, 1e-9);
    let slopes = [0, 1, 2].map(|j| {
        let moved = |by: f64| length(std::array::from_fn(|i| Q[i] + if i == j { by } else { 0.0 }));
        (moved(step) - moved(-step)) / (2.0 * step)
    });
    let rate: f64 = slopes.iter().zip(v).map(|(slope, v)| slope * v).sum();
    let [value, found_rate] = arms.connector_lengths_at(&Q, &v)[0];
    assert!((value - length(Q)).abs() < 1e-14 && (found_rate - rate).abs() < tolerance, "{value} {found_rate}");
    let force = 700.0 * (length(Q) - 1.5) * (1.0 + 0.3 * rate);
    let mut forces = [f64::NAN; 3];
    arms.connector_forces(0.0, &Q, &v, &mut forces);
    for (value, slope) in forces.iter().zip(slopes) {
        assert!((value + force * slope).abs() < tolerance * force.abs(), "{value} instead of {}", -force * slope);
    }
}

/// The pulls on each arm of a rope with a tension of 1 N, at their points: from the ground on, or only of the parts between two arms.
fn pulls(within: bool) -> Vec<(usize, Vector3<f64>, Vector3<f64>)> {
    let points = points(Q);
    let mut pulls = Vec::new();
    for (index, ends) in points.windows(2).enumerate().skip(usize::from(within)) {
        let pull = if index == 2 { 2.0 } else { 1.0 } * (ends[1].1 - ends[0].1).normalize();
        for ((arm, at), force) in ends.iter().zip([pull, -pull]) {
            pulls.extend(arm.map(|arm| (arm, *at, force)));
        }
    }
    pulls
}

/// Force and moment about a point of forces on an arm and those beyond it, in the arm's axes.
fn beyond(arm: usize, forces: &[(usize, Vector3<f64>, Vector3<f64>)]) -> Wrench {
    let (origin, rotation) = frames(Q)[arm];
    let mut sum = Wrench::ZERO;
    for (_, at, force) in forces.iter().filter(|(on, _, _)| *on >= arm) {
        sum.force += rotation.inverse() * force;
        sum.moment += rotation.inverse() * (at - origin).cross(force);
    }
    sum
}

fn assert_same(wrench: Wrench, expected: Wrench, size: f64, what: &str) {
    // Rounding errors of a few sums.
    let off = (wrench.force - expected.force).amax().max((wrench.moment - expected.moment).amax());
    assert!(off < 1e-12 * size, "{what}: {wrench:?} instead of {expected:?}");
}

/// What a cut transmits at rest is the weight of the arms beyond it and the pulls of the rope on them, part by part.
#[test]
fn cuts_transmit_the_pulls_of_all_sheaves_beyond_them() {
    let arms = arms(LAW);
    let arms: &dyn DynCrane = &arms;
    let still = [0.0; 3];
    let tension = arms.connector_tensions_at(0.0, &Q, &still)[0].force;
    assert!((tension / (700.0 * (length(Q) - 1.5)) - 1.0).abs() < 1e-13);
    let frames = frames(Q);
    let weight = |arm: usize| {
        let (origin, rotation) = frames[arm];
        (arm, origin + rotation * Vector3::new(0.5, 0.0, 0.0), Vector3::new(0.0, 0.0, -10.0 * GRAVITY))
    };
    let of_rope = pulls(false).into_iter().map(|(arm, at, force)| (arm, at, tension * force));
    let forces: Vec<_> = [0, 1, 2].map(weight).into_iter().chain(of_rope).collect();
    let cuts = arms.description().cuts();
    let mut own = vec![Wrench::ZERO; cuts.len()];
    arms.connector_wrenches(&Q, &mut own);
    let transmitted = arms.internal_forces_at(0.0, &Q, &still, &still);
    for ((cut, wrench), of_rope) in cuts.iter().zip(transmitted).zip(own) {
        let Cut::Joint { body } = *cut else {
            // What is between two arms is not carried by the ground.
            assert!(*cut != Cut::Ground || of_rope.force.amax().max(of_rope.moment.amax()) < 1e-13, "{of_rope:?}");
            continue;
        };
        assert_same(wrench, beyond(body, &forces), tension, &format!("{cut:?}"));
        assert_same(of_rope, beyond(body, &pulls(true)), 1.0, &format!("{cut:?}, at 1 N"));
    }
}
