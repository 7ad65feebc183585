//! Pads that do not give way, against stiff ones, beam theory and a prismatic joint.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::Method;
use crane_model::modes;
use crane_model::nalgebra::Vector3;
use crane_model::results::Instant;

use super::sliding_beams::{LENGTH, LOAD, OVERLAP, Telescope, assert_section_forces, closed_form, rest, run};

/// Equations of both pads. Against twist of beams that can twist, what is beside the pad is a spring.
const EQUATIONS: usize = 4;

fn exact(sections: &str) -> Telescope {
    Telescope { sections: sections.into(), exact: true, ..Telescope::default() }
}

#[test]
fn the_tip_deflects_as_in_beam_theory_with_order_two() {
    let expected = closed_form(LOAD, OVERLAP);
    for axis in [1, 2] {
        let deviation = |sections: &str| {
            let mut load = [0.0; 3];
            load[axis] = -LOAD;
            let telescope = Telescope { load, ..exact(sections) };
            -telescope.tip()[axis] / expected - 1.0
        };
        let [of_4, of_8, of_16] = ["4", "8", "16"].map(deviation);
        // As with springs of 1e12 N/m, whose compliance is 1e-7 of the deflection.
        for (value, known) in [(of_4, -2.16e-2), (of_8, -5.9e-3), (of_16, -1.52e-3)] {
            assert!((value / known - 1.0).abs() < 6e-3, "{value} instead of {known}");
        }
        assert!(of_8 / of_16 > 2_f64.powf(1.9), "{of_4} {of_8} {of_16}");
    }
}

/// The deflection with springs approaches that of exact pads as 1/k.
#[test]
fn stiff_pads_approach_exact_ones() {
    let [_, _, limit] = exact("6").tip();
    let off = [1e8, 1e9].map(|stiffness| {
        let [_, _, z] = Telescope { sections: "6".into(), stiffness, ..Telescope::default() }.tip();
        z - limit
    });
    let (a, b) = (LENGTH - OVERLAP, OVERLAP);
    for (off, stiffness) in off.into_iter().zip([1e8, 1e9]) {
        // What pads yield tilts the stage. Statics ends at 1e-10 of the load, 1e-12 m here.
        let expected = -LOAD * ((a + b).powi(2) + a * a) / (b * b * stiffness);
        assert!((off / expected - 1.0).abs() < 1e-3, "{off} instead of {expected}");
    }
}

/// Rigid beams on exact pads move as if there was only the prismatic joint: accelerations, vibrations and forces.
#[test]
fn rigid_beams_are_a_prismatic_joint() {
    let rigid = |inner: &str| {
        let beam = |bending: f64| {
            format!(
                "length: 4, sections: rigid, material: {{E: 1e9, G: 4e8, density: 900}}, \
                 section: {{numbers: {{area: 0.01, Jy: {bending}, Jz: {bending}, Jo: 2e-3}}}}"
            )
        };
        let text = format!(
            "format: 1\nname: rigid\nanalyses: [statics, dynamics, modes, internal_forces]\nlinks:\n\
             - {{name: column, joint: revolute, mass: 80, com: [0.1, 0, 0.5], inertia: {{gyration: [0.3, 0.3, 0.2]}}}}\n\
             - {{name: outer, placement: {{transform: {{translation: [0, 0, 1], rotation: {{x: 90 deg}}}}}}, joint: revolute, beam: {{{}}}}}\n\
             - name: inner\n  joint: {{prismatic: {{axis: x}}}}\n{inner}  beam: {{{}, SLIDES}}\n\
             - {{name: load, joint: revolute, mass: 40, com: [0.2, -0.5, 0.1], inertia: {{gyration: [0.2, 0.1, 0.2]}}}}\n\
             drives:\n- {{coordinate: column_psi, stiffness: 1e5, damping: 1e3, motion: {{hold: 0.3}}}}\n\
             - {{coordinate: outer_psi, stiffness: 4e5, damping: 5e3, motion: {{hold: 0.5}}}}\n\
             - {{coordinate: inner_x, stiffness: 2e5, damping: 1e3, motion: {{hold: 0.4}}}}\n",
            beam(4e-3),
            beam(2e-3)
        );
        let slides =
            "slides_in: {beam: outer, overlap: 1.3, pads: {front: {exact: [y, z, twist]}, rear: {exact: [z, y]}}}";
        let text = if inner.is_empty() { text.replace("SLIDES", slides) } else { text.replace(", SLIDES", "") };
        crane(&text)
    };
    let (pads, plain) = (rigid(""), rigid("  placement: {transform: {translation: [-1.3, 0, 0]}}\n"));
    let [pads, plain]: [&dyn DynCrane; 2] = [&pads, &plain];
    let names = |crane: &dyn DynCrane| -> Vec<String> {
        crane.description().coordinates.iter().map(|info| info.name.as_str().to_owned()).collect()
    };
    let own: Vec<usize> = {
        let all = names(pads);
        names(plain).iter().map(|name| all.iter().position(|other| other == name).expect(name)).collect()
    };
    let with = |numbers: &[f64]| {
        let mut all = vec![0.0; pads.size()];
        own.iter().zip(numbers).for_each(|(&index, number)| all[index] = *number);
        all
    };
    for pose in 0..4 {
        let number = |k: usize| 0.6 * (1.7 * (k + 7 * pose) as f64 + 0.4).sin();
        let (q, v): (Vec<f64>, Vec<f64>) = (0..plain.size()).map(|j| (number(j), number(j + 20))).unzip();
        let one = plain.accelerations_at(0.0, &q, &v);
        let other = pads.accelerations_at(0.0, &with(&q), &with(&v));
        for (j, &index) in own.iter().enumerate() {
            // Five equations take five digits less than rounding: condition of the pads' levers.
            assert!((one[j] - other[index]).abs() < 1e-10 * one.amax(), "{pose}, {j}: {} {}", one[j], other[index]);
        }
        // What the pads hold rests.
        let held = (0..pads.size()).filter(|j| !own.contains(j));
        assert!(held.map(|j| other[j].abs()).fold(0.0, f64::max) < 1e-10 * one.amax());
    }
    let [one, other] = [plain, pads].map(|crane| {
        let q = rest(crane);
        let modes = modes::undamped(&crane.small_motions_at(&q)).expect("modes");
        modes.iter().map(|mode| mode.omega_squared).collect::<Vec<_>>()
    });
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().zip(&other) {
        assert!((one / other - 1.0).abs() < 1e-8, "{one} {other}");
    }
}

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// J against differences of φ, and J̇ q̇ against differences of its rate, at bent poses and extensions within and beyond the beams.
#[test]
fn rows_and_curvatures_are_the_slopes_of_the_gaps() {
    const H: f64 = 1e-5;
    let crane = exact("3").crane();
    let crane: &dyn DynCrane = &crane;
    let n = crane.size();
    let slid = crane.description().coordinates.iter().position(|c| c.name.as_str() == "inner_x").unwrap();
    for (pose, extension) in [(0, 0.0), (1, 0.7), (2, -1.1), (3, 1.6)] {
        let number = |k: usize| (1.3 * k as f64 + 0.2).sin();
        let mut q: Vec<f64> = (0..n).map(|j| 0.2 * number(j + 5 * pose)).collect();
        q[slid] = extension;
        let v: Vec<f64> = (0..n).map(|j| number(3 * j + pose)).collect();
        let states = |q: &[f64]| {
            let mut states = vec![Vector3::zeros(); EQUATIONS];
            crane.loop_states(q, &v, &mut states);
            states
        };
        let mut rows = vec![0.0; EQUATIONS * n];
        crane.loop_jacobians(&q, &mut rows);
        let now = states(&q);
        for j in 0..n {
            let [before, after] = [-H, H].map(|h| {
                let mut q = q.clone();
                q[j] += h;
                states(&q)
            });
            for row in 0..EQUATIONS {
                let difference = (after[row].x - before[row].x) / (2.0 * H);
                // Third derivatives of order 1 times H²/6, rounding of 4 m over 2 H.
                assert!((rows[row * n + j] - difference).abs() < 1e-9, "{pose}, {row}, {j}: {difference}");
            }
        }
        let [before, after] = [-H, H].map(|h| states(&q.iter().zip(&v).map(|(q, v)| q + h * v).collect::<Vec<_>>()));
        for row in 0..EQUATIONS {
            let rate: f64 = (0..n).map(|j| rows[row * n + j] * v[j]).sum();
            assert!((now[row].y - rate).abs() < 1e-12, "{pose}, {row}");
            let difference = (after[row].y - before[row].y) / (2.0 * H);
            assert!((now[row].z - difference).abs() < 1e-7, "{pose}, {row}: {} {difference}", now[row].z);
        }
    }
}

/// The forces of pads by the statics of both beams, and the jumps of shear forces that they make.
#[test]
fn pads_carry_what_levers_say() {
    let crane = exact("8").crane();
    let crane: &dyn DynCrane = &crane;
    let q = rest(crane);
    let (a, b) = (LENGTH - OVERLAP, OVERLAP);
    let [front, rear] = [LOAD * (a + b) / b, LOAD * a / b];
    let found = crane.loop_forces_at_rest(&q);
    for (value, expected) in found.iter().zip([0.0, -front, 0.0, -rear]) {
        // Slopes of up to 2e-3 turn the forces.
        assert!((value - expected).abs() < 1e-5 * front, "{value} instead of {expected}");
    }
    assert_section_forces(crane, &q);
}

/// A beam that extends under load over borders of sections: two methods agree, and the energy balances.
#[test]
fn a_beam_that_extends_under_load_keeps_its_energy() {
    let telescope = Telescope {
        motion: "{quintic: {from: 0, to: 0.8, duration: 0.5}}".into(),
        gravity: 9.81,
        density: 4000.0,
        load: [0.0, 500.0, -3000.0],
        torque: 4000.0,
        ..exact("4")
    };
    let crane = telescope.crane();
    let (bdf, work, off) = run(&crane, Method::Bdf, 1e-8);
    let (rk4, _, off_rk4) = run(&crane, Method::Rk4, 1e-8);
    let difference = (0..3).map(|i| (bdf[i] - rk4[i]).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-6, "{bdf:?}, {rk4:?}");
    assert!(off < 1e-4 * work && off_rk4 < 1e-4 * work, "{off}, {off_rk4} of {work} J");
}

/// What a pose at rest transmits follows from it, wherever the drives of the spec would hold the crane: tables of poses and charts hold them elsewhere.
#[test]
fn sections_at_rest_do_not_ask_where_motions_are() {
    let held = |extension: f64| Telescope { motion: format!("{{hold: {extension}}}"), ..exact("4") }.crane();
    let [here, there] = [0.7, 0.0].map(held);
    let [here, there]: [&dyn DynCrane; 2] = [&here, &there];
    let q = rest(here);
    let [expected, found] = [here, there].map(|crane| Instant::at_rest(crane, &q));
    let numbers = |instant: &Instant| -> Vec<f64> {
        let (_, wrenches) = instant.state();
        wrenches
            .iter()
            .flat_map(|wrench| wrench.force.iter().chain(&wrench.moment).copied().collect::<Vec<_>>())
            .collect()
    };
    for (expected, value) in numbers(&expected).into_iter().zip(numbers(&found)) {
        // Statics ends at 1e-10 of moments of 100 N times 7 m.
        assert!((expected - value).abs() < 1e-6 * LOAD, "{value} instead of {expected}");
    }
}
