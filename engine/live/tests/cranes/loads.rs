//! Loads applied from outside against exact laws.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Sample, Settings};
use crane_model::nalgebra::Vector3;
use crane_model::{Cut, statics};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// A flexible boom on a column with a spring, and additional keys; its load hangs from the tip.
fn boom(load: f64, more: &str) -> LiveCrane {
    crane(&format!(
        "format: 1\nname: boom\nlinks:\n\
         - {{name: column, joint: revolute, mass: 100, com: [0, 0, 1], inertia: {{gyration: [0.3, 0.3, 0.2]}}}}\n\
         - name: boom\n  placement: {{transform: {{translation: [0, 0, 2], rotation: {{x: 80 deg}}}}}}\n  joint: revolute\n\
         \x20 beam: {{length: 4, sections: 2, material: {{E: 2.1e11, G: 8.1e10, density: 7850}}, section: {{tube: {{diameter: 0.1, thickness: 0.01}}}}}}\n\
         - {{name: tip, joint: fixed, mass: {load}, com: [0.2, -0.3, 0.1]}}\n\
         drives:\n- {{coordinate: column_psi, stiffness: 2e4, motion: {{hold: 0.3}}}}\n\
         - {{coordinate: boom_psi, stiffness: 3e5, motion: {{hold: 0.4}}}}\n{more}"
    ))
}

/// A weight that hangs from a point is equivalent to a force in the world frame: the same pose and the same stiffness, to rounding.
#[test]
fn a_hanging_weight_is_a_force() {
    let (tip, weight) = (20.0, 150.0);
    let heavy = boom(tip + weight, "");
    let force = -9.81 * weight;
    let loaded =
        boom(tip, &format!("loads: [{{name: pull, link: tip, at: [0.2, -0.3, 0.1], force: [0, 0, {force}]}}]\n"));
    let [heavy, loaded]: [&dyn DynCrane; 2] = [&heavy, &loaded];
    let [one, other] = [heavy, loaded].map(|crane| crane.equilibrium(&statics::Settings::default()));
    assert!(one.is_stable() && other.is_stable(), "{one}; {other}");
    // Stiffnesses from 2e4 to 1e7: Newton's method ends at 1e-10 of the forces.
    assert!(one.q.iter().zip(&other.q).all(|(a, b)| (a - b).abs() < 1e-9), "{:?} {:?}", one.q, other.q);
    let [one, other] = [heavy, loaded].map(|crane| crane.small_motions_at(&one.q).stiffness);
    assert!((&one - &other).amax() < 1e-12 * one.amax(), "{}", (one - other).amax());
}

/// The effort that holds an arm against a wrench that turns with it is the moment about its joint, wherever the arm points.
#[test]
fn a_drive_holds_a_load_that_turns_with_its_link() {
    let arm = crane(
        "format: 1\nname: arm\ngravity: [0, 0, 0]\nlinks: [{name: arm, joint: revolute, mass: 10, com: [1, 0, 0], inertia: {gyration: [0.1, 0.5, 0.5]}}]\n\
         drives: [{coordinate: arm_psi, stiffness: 1e3, motion: {hold: 0.5}}]\n\
         loads: [{name: push, link: arm, at: [2, 0.5, 0], force: [30, 40, 7], moment: [1, 2, 9], axes: link,\n\
         \x20 scale: {cubic: {from: 0.25, to: 1, duration: 2}}}]\n",
    );
    let arm: &dyn DynCrane = &arm;
    let settings = statics::Settings::default();
    let rest = arm.equilibrium(&settings);
    // x F_y − y F_x + M_z
    let moment = 2.0 * 40.0 - 0.5 * 30.0 + 9.0;
    assert!((arm.drive_efforts_at_rest(&rest.q)[0] + 0.25 * moment).abs() < 1e-9);
    assert!((rest.q[0] - 0.5 - 0.25 * moment / 1e3).abs() < 1e-12);
    let later = statics::Problem::new(arm).at_time(5.0).from(&rest.q).settings(&settings).solve();
    assert!((later.q[0] - 0.5 - moment / 1e3).abs() < 1e-12, "{later}");
}

/// A load that presses on an upright arm from t = 1 s on takes from its stiffness what the load's lever arm gains: `K = s − P`. Beyond
/// `P = s` the arm buckles, and stands where `s ψ = P sin ψ`.
#[test]
fn a_load_that_begins_later_buckles_what_it_presses_on() {
    let arm = crane(
        "format: 1\nname: arm\ngravity: [0, 0, 0]\nlinks: [{name: arm, joint: revolute, mass: 10, com: [1, 0, 0], inertia: {gyration: [0.1, 0.5, 0.5]}}]\n\
         drives: [{coordinate: arm_psi, stiffness: 100, motion: {hold: 0}}]\n\
         loads: [{name: press, link: arm, at: [1, 0, 0], force: [-1, 0, 0], scale: {cubic: {from: 0, to: 150, duration: 2, begin: 1}}}]\n",
    );
    let arm: &dyn DynCrane = &arm;
    let settings = statics::Settings::default();
    // Half of the load at half of its time.
    for (t, load, stable) in [(0.0, 0.0, true), (2.0, 75.0, true), (5.0, 150.0, false)] {
        let mut stiffness = [f64::NAN];
        arm.tangent_stiffness(t, &[0.0], &arm.drive_positions_at(t), &mut stiffness);
        assert!((stiffness[0] - (100.0 - load)).abs() < 1e-12, "{t}: {stiffness:?}");
        assert_eq!(
            statics::Problem::new(arm).at_time(t).from(&[0.0]).settings(&settings).solve().is_stable(),
            stable,
            "{t}"
        );
    }
    let buckled = statics::Problem::new(arm).at_time(5.0).from(&[1.0]).settings(&settings).solve();
    let psi = buckled.q[0];
    assert!(buckled.is_stable() && psi > 1.0 && (100.0 * psi - 150.0 * psi.sin()).abs() < 1e-8, "{buckled}: {psi}");
    // Newton's method with the right tangent: quadratic.
    assert!(buckled.steps() <= 7 && buckled.load_steps.is_none(), "{buckled}");
}

/// What a joint transmits at a time is the load at that time, in the axes of the world and in those of a link at 30°.
#[test]
fn joints_transmit_what_a_load_is_at_a_time() {
    let arm = crane(
        "format: 1\nname: arm\ngravity: [0, 0, 0]\nlinks: [{name: arm, joint: revolute, mass: 10, com: [1, 0, 0], inertia: {gyration: [0.1, 0.5, 0.5]}}]\n\
         drives: [{coordinate: arm_psi, stiffness: 100, motion: {hold: 0}}]\n\
         loads:\n\
         - {name: press, link: arm, at: [1, 0, 0], axes: link, force: [-1, 0, 0], scale: {cubic: {from: 0, to: 150, duration: 2, begin: 1}}}\n\
         - {name: lift, link: arm, at: [1, 0, 0], force: [0, 0, 2], scale: {cubic: {from: 0, to: 150, duration: 2, begin: 1}}}\n",
    );
    let arm: &dyn DynCrane = &arm;
    let psi = 30.0_f64.to_radians();
    // Half of the load at half of its time.
    for (t, load) in [(0.0, 0.0), (2.0, 75.0), (5.0, 150.0)] {
        let all = arm.description().cuts().into_iter().zip(arm.internal_forces_at(t, &[psi], &[0.0], &[0.0]));
        for (cut, wrench) in all {
            // The ground is in the world's frame, about its origin, and so is the axis of the joint; a joint in that of its link.
            let [along, aside] = if cut == Cut::Ground { [psi.cos(), psi.sin()] } else { [1.0, 0.0] };
            let force = Vector3::new(-along, -aside, 2.0);
            let moment = Vector3::new(along, aside, 0.0).cross(&force);
            // Some roundings of numbers of the size of the load.
            let off = (wrench.force - load * force).amax().max((wrench.moment - load * moment).amax());
            assert!(off < 1e-12, "{t} s, {cut:?}: {wrench:?} for {load} N");
        }
    }
}

/// A constant force moves a slide by `F t²/2m`, and its work is the kinetic energy.
#[test]
fn the_work_of_a_load_is_kinetic_energy() {
    let slide = crane(
        "format: 1\nname: slide\ngravity: [0, 0, 0]\nlinks: [{name: slide, joint: {prismatic: {axis: x}}, mass: 4, com: [0, 0, 0]}]\n\
         loads: [{name: pull, link: slide, at: [0, 1, 2], force: [6, 5, 4], moment: [1, 2, 3]}]\n",
    );
    let slide: &dyn DynCrane = &slide;
    let settings = Settings { audit: true, duration: 2.0, ..Settings::from_description(slide.description()) };
    let start = InitialState { q: vec![0.0], v: vec![0.0], ..InitialState::default() };
    let mut last = [0.0; 3];
    let run = slide.simulate(&start, &settings, &mut |sample: &Sample<'_>| {
        last = [sample.q[0], sample.v[0], sample.load_work];
        ControlFlow::Continue(())
    });
    run.expect("it runs");
    // A quadratic motion, which formulas of order 2 reproduce except at the start, at a tolerance of 2e-5.
    for (value, expected) in last.into_iter().zip([3.0, 3.0, 18.0]) {
        assert!((value - expected).abs() < 1e-3, "{value} for {expected}");
    }
}

/// A short push on a body at rest, long after the beginning: no step misses it. A spline through 0, 1, 0 with zero slope at both
/// ends has two cubic flanks, each with half its duration as integral.
#[test]
fn no_step_misses_a_short_push() {
    let slide = crane(
        "format: 1\nname: slide\ngravity: [0, 0, 0]\nlinks: [{name: slide, joint: {prismatic: {axis: x}}, mass: 4, com: [0, 0, 0]}]\n\
         loads: [{name: push, link: slide, force: [100, 0, 0], scale: {table: {times: [7, 7.01, 7.02], values: [0, 1, 0]}}}]\n",
    );
    let slide: &dyn DynCrane = &slide;
    for method in [Method::Bdf, Method::Rosenbrock, Method::DormandPrince] {
        let of_spec = Settings::from_description(slide.description());
        let settings = Settings { method, tolerance: 1e-8, duration: 10.0, output: 10.0, ..of_spec };
        let mut speed = 0.0;
        let start = InitialState { q: vec![0.0], v: vec![0.0], ..InitialState::default() };
        let run = slide.simulate(&start, &settings, &mut |sample: &Sample<'_>| {
            speed = sample.v[0];
            ControlFlow::Continue(())
        });
        run.expect("it runs");
        let expected = 100.0 * 0.01 / 4.0;
        assert!((speed - expected).abs() < 1e-5, "{method}: {speed} m/s instead of {expected}");
    }
}

/// A beam of as many sections as 252 coordinates need bends as a cantilever under a force at its tip: P L³/(3 E J), except for the two halves of sections
/// at its ends without a spring, 1/(2n)² of it. Its tangent needs registers in proportion to its coordinates.
#[test]
fn a_force_bends_a_beam_of_many_sections() {
    const SECTIONS: usize = 84;
    let (force, length, youngs) = (100.0, 10.0_f64, 2.1e11);
    let beam = crane(&format!(
        "format: 1\nname: beam\ngravity: [0, 0, 0]\nlinks: [{{name: beam, beam: {{length: {length}, sections: {SECTIONS}, \
         material: {{E: {youngs:e}, G: 8.1e10, density: 7850}}, section: {{box: {{height: 0.3, width: 0.2, thickness: 0.01}}}}}}}}]\n\
         loads: [{{name: pull, link: beam, at: [{length}, 0, 0], force: [0, 0, {force}]}}]\npoints: [{{name: tip, link: beam, at: [{length}, 0, 0]}}]\n"
    ));
    let beam: &dyn DynCrane = &beam;
    let rest = beam.equilibrium(&statics::Settings::default());
    assert!(rest.is_stable(), "{rest}");
    let points = beam.points_at(&rest.q);
    // The force is along the width.
    let moment_of_area = (0.3 * 0.2_f64.powi(3) - 0.28 * 0.18_f64.powi(3)) / 12.0;
    let expected = force * length.powi(3) / (3.0 * youngs * moment_of_area);
    let n = SECTIONS as f64;
    let off = points[0].z / expected - 1.0;
    // Springs in the middle of sections: Σ (L − x_k)² d = L³/3 (1 − 1/(4n²)).
    assert!((off + 0.25 / (n * n)).abs() < 1e-6, "{} m instead of {expected} m: {off:e}", points[0].z);
}

/// The tangent of forces and moments along axes of the world and of their links is the symmetric part of central differences of the residual, which
/// know nothing of its formula. Joints of all kinds carry them: a free base, hinges, sections that turn by rotation vectors and one by one.
#[test]
fn the_tangent_of_loads_is_a_difference() {
    let spec = |joint: &str, loads: &str| {
        format!(
            "format: 1\nname: arm\ngravity: [0, 0, 0]\nlinks:\n\
             - {{name: truck, joint: free, mass: 900, com: [0, 0, 0.3], inertia: {{gyration: [0.5, 0.6, 0.7]}}}}\n\
             - {{name: slide, joint: prismatic, placement: {{transform: {{translation: [0.2, 0.1, 1], rotation: {{y: 70 deg}}}}}}, mass: 30, com: [0.2, 0, 0], \
             inertia: {{gyration: [0.1, 0.2, 0.2]}}}}\n\
             - {{name: boom, joint: revolute, beam: {{length: 3, sections: 2, section_joint: {joint}, material: {{E: 2.1e9, G: 8.1e8, density: 7850}}, \
             section: {{circle: {{diameter: 0.1}}}}}}}}\n\
             - {{name: tip, joint: revolute, mass: 9, com: [0.2, -0.3, 0.1], inertia: {{gyration: [0.1, 0.2, 0.2]}}}}\nloads: [{loads}]\n"
        )
    };
    let loads = ["world", "link"].map(|axes| {
        format!("{{name: one_{axes}, link: tip, at: [0.3, 0.5, -0.2], force: [300, -200, 500], moment: [40, 70, -90], axes: {axes}}}")
    });
    for joint in ["symmetric", "paper"] {
        for load in &loads {
            let [with, without] = [load.as_str(), ""].map(|load| crane(&spec(joint, load)));
            let [with, without]: [&dyn DynCrane; 2] = [&with, &without];
            let n = with.size();
            let q: Vec<f64> = (0..n).map(|j| 0.3 * (1.0 + j as f64).sin()).collect();
            let residual = |q: &[f64]| {
                let of = |crane: &dyn DynCrane| {
                    let mut out = vec![0.0; n];
                    crane.static_residual(0.0, q, &vec![0.0; n], &mut out);
                    out
                };
                of(with).iter().zip(of(without)).map(|(with, without)| with - without).collect::<Vec<f64>>()
            };
            let h = 1e-5;
            let columns: Vec<Vec<f64>> = (0..n)
                .map(|j| {
                    let moved =
                        |by: f64| residual(&(0..n).map(|i| if i == j { q[i] + by } else { q[i] }).collect::<Vec<_>>());
                    moved(h).iter().zip(moved(-h)).map(|(ahead, behind)| (ahead - behind) / (2.0 * h)).collect()
                })
                .collect();
            let tangent = |crane: &dyn DynCrane| {
                let mut out = vec![0.0; n * n];
                crane.tangent_stiffness(0.0, &q, &vec![0.0; n], &mut out);
                out
            };
            let own: Vec<f64> =
                tangent(with).iter().zip(tangent(without)).map(|(with, without)| with - without).collect();
            let largest = own.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            for i in 0..n {
                for j in 0..n {
                    let expected = 0.5 * (columns[i][j] + columns[j][i]);
                    // Differences of forces of 1e3 N m: rounding 1e-13/1e-5 and truncation h² of them, and the rounding of the springs' tangents of 1e4.
                    assert!(
                        (own[i * n + j] - expected).abs() < 1e-7 * largest,
                        "{joint}, {load}: {i}, {j}: {} for {expected}",
                        own[i * n + j]
                    );
                }
            }
        }
    }
}

/// A tangent whose entries a loop over pairs fills, and one whose entries are written out: with lines to the world, over a sheave, and between two
/// branches, loads along axes of both kinds, a rigid drive, and sections of both kinds.
#[test]
fn the_tangent_filled_in_a_loop_is_the_one_written_out() {
    let spec = |loops: &str| {
        let inertia = "inertia: {gyration: [0.1, 0.2, 0.2]}";
        let beam = |joint: &str| {
            format!(
                "beam: {{length: 3, sections: 3, section_joint: {joint}, material: {{E: 2.1e9, G: 8.1e8, density: 7850}}, \
                 section: {{circle: {{diameter: 0.1}}}}}}"
            )
        };
        format!(
            "format: 1\nname: arms\nloops: {loops}\nlinks:\n\
             - {{name: truck, joint: free, mass: 900, com: [0, 0, 0.3], inertia: {{gyration: [0.5, 0.6, 0.7]}}}}\n\
             - {{name: boom, joint: revolute, {}}}\n\
             - {{name: jib, joint: revolute, mass: 9, com: [0.2, -0.3, 0.1], {inertia}}}\n\
             - {{name: arm, on: {{link: truck, at: [0.2, 0.1, 1]}}, placement: {{transform: {{rotation: {{y: 70 deg}}}}}}, joint: revolute, {}}}\n\
             - {{name: tool, joint: prismatic, mass: 30, com: [0.2, 0, 0], {inertia}}}\n\
             connectors:\n\
             - {{name: guy, from: {{at: [0, 0, 9]}}, to: {{link: boom, at: [3, 0, 0.1]}}, law: {{spring: {{stiffness: 2e3, length: 5}}}}}}\n\
             - {{name: hoist, from: {{link: truck, at: [0, 0.3, 1]}}, over: [{{link: boom, at: [1.3, 0.2, 0]}}], falls: 2, \
             to: {{link: jib, at: [0.5, 0.1, 0]}}, law: {{rope: {{stiffness: 3e3, length: 4}}}}}}\n\
             - {{name: strut, from: {{link: jib, at: [0.4, 0, 0]}}, to: {{link: tool, at: [0.3, 0, 0.2]}}, law: {{spring: {{stiffness: 1e3, length: 1}}}}}}\n\
             drives: [{{coordinate: arm_psi, rigid: true, motion: {{hold: 0.3}}}}, {{coordinate: boom_psi, stiffness: 4e3, damping: 10, motion: {{hold: 0}}}}]\n\
             loads: [{{name: one, link: jib, at: [0.3, 0.5, -0.2], force: [300, -200, 500], moment: [40, 70, -90], axes: link}}, \
             {{name: two, link: boom, at: [2, 0, 0], force: [30, 100, 50]}}]\n",
            beam("symmetric"),
            beam("paper"),
        )
    };
    let [filled, written] = ["always", "never"].map(|loops| {
        let crane = crane(&spec(loops));
        let crane: &dyn DynCrane = &crane;
        let n = crane.size();
        let q: Vec<f64> = (0..n).map(|j| 0.3 * (1.0 + j as f64).sin()).collect();
        let mut tangent = vec![f64::NAN; n * n];
        crane.tangent_stiffness(0.0, &q, &vec![0.1; n], &mut tangent);
        tangent
    });
    let largest = written.iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
    for (one, other) in filled.iter().zip(&written) {
        // Rounding of sums in another order.
        assert!((one - other).abs() < 1e-14 * largest, "{one} {other} of {largest}");
    }
    assert!(largest > 1e3 && written.iter().filter(|entry| **entry == 0.0).count() < written.len() / 2);
}
