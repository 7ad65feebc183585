//! Telescopes of flexible beams on pads, against beam theory worked out by hand.

use std::ops::ControlFlow;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Method, Sample, Settings};
use crane_model::sections::places;
use crane_model::{Side, statics};

fn crane(text: &str) -> LiveCrane {
    LiveCrane::from_spec(&SourceFile::new("crane.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

pub(super) fn rest(crane: &dyn DynCrane) -> Vec<f64> {
    let equilibrium = crane.equilibrium(&statics::Settings::default());
    assert!(equilibrium.is_stable(), "{equilibrium}");
    equilibrium.q
}

/// Both beams are 4 m long, the outer one twice as stiff.
pub(super) const LENGTH: f64 = 4.0;
pub(super) const OVERLAP: f64 = 1.3;
const INNER: f64 = 2e6;
const OUTER: f64 = 4e6;
/// Deflections of about a millimetre, whose squares do not matter.
pub(super) const LOAD: f64 = 100.0;

pub(super) struct Telescope {
    pub sections: String,
    pub stiffness: f64,
    pub overlap: f64,
    /// Motion of the drive, clearance of all pads along y and z, and what else there is.
    pub motion: String,
    pub clearance: f64,
    pub gravity: f64,
    pub density: f64,
    pub load: [f64; 3],
    /// Of the load, about x.
    pub torque: f64,
    /// Whether pads are exact, the rear one not against twist.
    pub exact: bool,
}

impl Default for Telescope {
    fn default() -> Self {
        Telescope {
            sections: "8".into(),
            stiffness: 1e12,
            overlap: OVERLAP,
            motion: "{hold: 0}".into(),
            clearance: 0.0,
            gravity: 0.0,
            density: 1.0,
            load: [0.0, 0.0, -LOAD],
            torque: 0.0,
            exact: false,
        }
    }
}

impl Telescope {
    /// A cantilever along x, and a beam that slides in it along x, with a load at its tip.
    fn spec(&self) -> String {
        let Telescope { sections, stiffness: k, overlap, motion, clearance: c, gravity, density, load, torque, exact } =
            self;
        let beam = |bending: f64| {
            format!(
                "length: {LENGTH}, sections: {sections}, material: {{E: 1e9, G: 4e8, density: {density}}}, damping: {{beta: 1e-3}}, \
                 section: {{numbers: {{area: 0.01, Jy: {0}, Jz: {0}, Jo: {0}}}}}",
                bending / 1e9
            )
        };
        let pad = format!("{{stiffness: [{k}, {k}, {k}], damping: [1e4, 1e4, 1e4], clearance: [{c}, {c}, 0]}}");
        let [front, rear] =
            if *exact { ["{exact: [y, z, twist]}", "{exact: [y, z]}"].map(String::from) } else { [pad.clone(), pad] };
        let [fx, fy, fz] = load;
        format!(
            "format: 1\nname: telescope\ngravity: [0, 0, -{gravity}]\nanalyses: [statics, dynamics, modes, internal_forces]\nlinks:\n\
             - {{name: outer, beam: {{{}}}}}\n\
             - name: inner\n  joint: {{prismatic: {{axis: x}}}}\n  beam: {{{}, slides_in: {{beam: outer, overlap: {overlap}, pads: {{\
             front: {front}, rear: {rear}}}}}}}\n\
             drives: [{{coordinate: inner_x, stiffness: 1e9, damping: 1e6, motion: {motion}}}]\n\
             loads: [{{name: pull, link: inner, at: [{LENGTH}, 0, 0], force: [{fx}, {fy}, {fz}], moment: [{torque}, 0, 0]}}]\n\
             points: [{{name: tip, link: inner, at: [{LENGTH}, 0, 0]}}, {{name: beside, link: inner, at: [{LENGTH}, 1, 0]}}]\n",
            beam(OUTER),
            beam(INNER)
        )
    }

    pub fn crane(&self) -> LiveCrane {
        crane(&self.spec())
    }

    /// The tip at rest.
    pub fn tip(&self) -> [f64; 3] {
        let crane = self.crane();
        let crane: &dyn DynCrane = &crane;
        let points = crane.points_at(&rest(crane));
        points[0].into()
    }
}

/// Deflection of the tip for a force F there: overhang a, overlap b; the front pad carries `F (a + b)/b`, the rear pad `F a/b` upwards.
/// `w₂ + (w₂ − w₁) a/b + F a² (a + b)/3EI`, with w₁ and w₂ of the outer cantilever at the pads.
pub(super) fn closed_form(force: f64, overlap: f64) -> f64 {
    let (a, b) = (LENGTH - overlap, overlap);
    let (front, rear) = (force * (a + b) / b, -force * a / b);
    // Of a cantilever at x for a force at c.
    let cantilever = |force: f64, c: f64, x: f64| {
        let (near, far) = (x.min(c), x.max(c));
        force * near * near * (3.0 * far - near) / (6.0 * OUTER)
    };
    let at = |x: f64| cantilever(front, LENGTH, x) + cantilever(rear, LENGTH - b, x);
    let [w1, w2] = [LENGTH - b, LENGTH].map(at);
    w2 + (w2 - w1) * a / b + force * a * a * (a + b) / (3.0 * INNER)
}

#[test]
fn the_tip_deflects_as_in_beam_theory_with_order_two() {
    let expected = closed_form(LOAD, OVERLAP);
    let deviation = |sections: usize, axis: usize| {
        let mut load = [0.0; 3];
        load[axis] = -LOAD;
        let telescope = Telescope { sections: sections.to_string(), load, ..Telescope::default() };
        -telescope.tip()[axis] / expected - 1.0
    };
    let [of_4, of_8, of_16] = [4, 8, 16].map(|sections| deviation(sections, 2));
    // What a program that shares no code with this one computes of the curve in a plane.
    for (value, known) in [(of_4, -2.16e-2), (of_8, -5.9e-3), (of_16, -1.52e-3)] {
        assert!((value / known - 1.0).abs() < 6e-3, "{value} instead of {known}");
    }
    // Order 1.9 and more; between 4 and 8 sections the next order still matters.
    assert!(of_8 / of_16 > 2_f64.powf(1.9) && of_4 / of_8 > 2_f64.powf(1.8), "{of_4} {of_8} {of_16}");
    // The other plane, up to rounding.
    assert!((deviation(8, 1) - of_8).abs() < 1e-9);
}

/// Twist of the tip, to rounding on any mesh and wherever the pads are: torques F of the front pad and R of the rear one have the sum M, and
/// `R (1/k + b/GJ₂) = F (1/k + b/GJ₁)`; an exact pair has F alone. Within 2 % of the end of a section an exact pad gives way by a little.
#[test]
fn the_tip_twists_as_a_bar() {
    const SHEAR: f64 = 0.4;
    let torque = 1.0;
    let [outer, inner] = [SHEAR * OUTER, SHEAR * INNER];
    for (sections, overlap) in [("1", 1.3), ("2", 1.9), ("3", 0.4), ("4", 1.0), ("7", 1.3), ("32", 2.21)] {
        let (a, b) = (LENGTH - overlap, overlap);
        for stiffness in [None, Some(1e5), Some(1e7)] {
            let telescope = Telescope {
                sections: sections.into(),
                overlap,
                stiffness: stiffness.unwrap_or(1e12),
                exact: stiffness.is_none(),
                load: [0.0; 3],
                torque,
                ..Telescope::default()
            };
            let crane = telescope.crane();
            let crane: &dyn DynCrane = &crane;
            let points = crane.points_at(&rest(crane));
            let twist = points[1].z - points[0].z;
            let to_front = match stiffness {
                None => torque,
                Some(k) => torque * (1.0 / k + b / inner) / (2.0 / k + b / inner + b / outer),
            };
            let yields = stiffness.map_or(0.0, |k| to_front / k);
            let expected = torque * (a / outer + a / inner) + to_front * b / outer + yields;
            // At 1 m of four sections of 1 m, the least compliance of a section beside an exact pad: 2 % of a section.
            let least = if stiffness.is_none() && sections == "4" { 0.02 * torque / inner } else { 0.0 };
            // Statics ends at 1e-10 of the load, and heights are rounded at 1 m.
            let off = (twist - expected - least).abs();
            assert!(off < 1e-8 * expected + 1e-15, "{sections}, {overlap}, {stiffness:?}: {twist}, not {expected}");
        }
    }
}

/// Both beams rigid: only the pads yield, `w = F ((a + b)² + a²)/(b² k)`, and in the limit of stiff pads there is only the prismatic joint.
#[test]
fn rigid_beams_differ_from_a_prismatic_joint_by_the_compliance_of_pads() {
    for stiffness in [1e7, 1e9, 1e11] {
        let (a, b) = (LENGTH - OVERLAP, OVERLAP);
        let telescope = Telescope { sections: "rigid".into(), stiffness, ..Telescope::default() };
        let [x, y, z] = telescope.tip();
        let expected = LOAD * ((a + b).powi(2) + a * a) / (b * b * stiffness);
        // Squares of slopes of up to 5e-5; statics ends at a residual of 1e-10 of the load, and heights are rounded at 4 m.
        assert!((-z / expected - 1.0).abs() < 1e-6 + 1e-14 / expected, "{z} instead of {expected}");
        assert!((x - 2.0 * LENGTH + b).abs() < 1e-8 && y.abs() < 1e-12, "{x}, {y}");
    }
}

/// With a clearance c everywhere the beam first tilts by 2c/b.
#[test]
fn clearance_lets_the_beam_tilt() {
    let tip = |clearance: f64| {
        let telescope = Telescope { sections: "rigid".into(), stiffness: 1e8, clearance, ..Telescope::default() };
        telescope.tip()[2]
    };
    let (a, b, clearance) = (LENGTH - OVERLAP, OVERLAP, 1e-5);
    let lower = clearance * (a + b) / b + clearance * a / b;
    // A thousandth of the stiffness acts within the clearance; beyond, the constant force is a thousandth of that.
    assert!((tip(0.0) - tip(clearance) - lower).abs() < 1.1e-3 * lower);
}

/// Shear forces and moments by the statics of both beams: front pad `F (a + b)/b`, rear pad `F a/b`.
#[test]
fn internal_forces_jump_at_the_pads_by_their_forces() {
    let telescope = Telescope { stiffness: 1e9, ..Telescope::default() };
    let crane = telescope.crane();
    let crane: &dyn DynCrane = &crane;
    let q = rest(crane);
    let still = vec![0.0; q.len()];
    let (a, b) = (LENGTH - OVERLAP, OVERLAP);
    let [front, rear] = [LOAD * (a + b) / b, LOAD * a / b];
    // The names are front and rear, y, z, twist.
    let tensions: Vec<f64> = crane.connector_tensions_at(0.0, &q, &still).iter().map(|tension| tension.force).collect();
    for (value, expected) in tensions.iter().zip([0.0, -front, 0.0, 0.0, -rear, 0.0]) {
        // Slopes of up to 2e-3 turn the forces.
        assert!((value - expected).abs() < 1e-5 * front, "{tensions:?}");
    }
    assert_section_forces(crane, &q);
}

/// Asserts that shear forces and moments of both beams are those of the load at the tip, by their statics: at every place, also at the pads and
/// on both sides of them, whatever the springs share.
pub(super) fn assert_section_forces(crane: &dyn DynCrane, q: &[f64]) {
    let still = vec![0.0; q.len()];
    let (a, b) = (LENGTH - OVERLAP, OVERLAP);
    let [front, rear] = [LOAD * (a + b) / b, LOAD * a / b];
    let description = crane.description();
    let (mut checked, mut at_pads, size) = (0, 0, LOAD * (a + b));
    for place in places(description, &crane.section_places_at(q), &crane.internal_forces_at(0.0, q, &still, &still)) {
        let (info, x, wrench) = (place.info(description), place.x, place.wrench);
        if !(1e-9..=LENGTH - 1e-9).contains(&x) {
            continue;
        }
        let is_inner = place.beam(description) == "inner";
        // The front pad is at b on the inner beam, the rear pad at L − b on the outer one.
        let pad = if is_inner { b } else { LENGTH - b };
        let is_at_pad = info.slides;
        assert!(!is_at_pad || (x - pad).abs() < 1e-9, "{}", place.location(description));
        let before = if is_at_pad { info.side == Side::Before } else { x < pad };
        let (shear, moment) = match (is_inner, before) {
            (true, true) => (-rear, rear * x),
            (true, false) => (LOAD, LOAD * (LENGTH - x)),
            (false, true) => (LOAD, LOAD * (LENGTH - x + a)),
            (false, false) => (front, front * (LENGTH - x)),
        };
        checked += 1;
        at_pads += usize::from(is_at_pad);
        let found = (-wrench.force.z, wrench.moment.y);
        let off = (found.0 - shear).abs().max((found.1 - moment).abs());
        // The forces turn with the beams by up to 2e-3.
        let location = place.location(description);
        assert!(off < 1e-5 * size, "{location}: {found:?} instead of {shear}, {moment}");
    }
    // 8 springs on each beam, and both sides of one pad.
    assert_eq!((checked, at_pads), (20, 4));
}

/// J against differences of the lengths, and `f = −Jᵀ F` against differences of the energy, at bent poses and extensions within and beyond.
#[test]
fn pads_do_the_work_of_their_energy() {
    const H: f64 = 1e-6;
    let telescope = Telescope { sections: "3".into(), stiffness: 1e6, clearance: 2e-3, ..Telescope::default() };
    let crane = telescope.crane();
    let crane: &dyn DynCrane = &crane;
    let n = crane.size();
    for (pose, extension) in [(0, 0.0), (1, 0.7), (2, -1.1), (3, 1.6)] {
        let mut q: Vec<f64> = (0..n).map(|j| 0.05 * (1.3 * (j + 5 * pose) as f64 + 0.2).sin()).collect();
        let slid = crane.description().coordinates.iter().position(|c| c.name.as_str() == "inner_x").unwrap();
        q[slid] = extension;
        let still = vec![0.0; n];
        let (mut forces, mut rows) = (vec![0.0; n], vec![0.0; 6 * n]);
        crane.connector_forces(0.0, &q, &still, &mut forces);
        crane.connector_jacobians(&q, &mut rows);
        let tensions = crane.connector_tensions_at(0.0, &q, &still);
        for j in 0..n {
            let [before, after] = [-H, 2.0 * H].map(|h| {
                q[j] += h;
                (crane.energies_at(0.0, &q, &still).connectors, crane.connector_lengths_at(&q, &still))
            });
            q[j] -= H;
            let slope = (after.0 - before.0) / (2.0 * H);
            let size: f64 = tensions.iter().map(|tension| tension.force.abs()).sum();
            // Energies of up to 1e5 J rounded, over 2 µm.
            assert!((forces[j] + slope).abs() < 2e-5 * size, "pose {pose}, {j}: {} instead of {}", forces[j], -slope);
            for (row, (one, other)) in before.1.iter().zip(&after.1).enumerate() {
                let difference = (other[0] - one[0]) / (2.0 * H);
                // Rounding of lengths of order 1 over 2 µm.
                assert!((rows[row * n + j] - difference).abs() < 1e-8, "pose {pose}, row {row}, {j}");
            }
            let by_rows: f64 =
                tensions.iter().enumerate().map(|(row, tension)| -rows[row * n + j] * tension.force).sum();
            // On the coordinate along which the beam slides acts what the sections beside the pads store, too.
            assert!(j == slid || (forces[j] - by_rows).abs() < 1e-10 * size);
        }
    }
}

/// The height of the tip over the extension, which a polyline would give a jump at each of its corners.
#[test]
fn the_slope_of_the_tip_over_the_extension_does_not_jump() {
    const STEP: f64 = 0.005;
    let motion = "{table: {times: [0, 1], values: [0, 1]}}";
    let telescope = Telescope { motion: motion.into(), stiffness: 1e9, ..Telescope::default() };
    let crane = telescope.crane();
    let crane: &dyn DynCrane = &crane;
    let mut q = rest(crane);
    // The table is `3t² − 2t³`: the time of an extension by bisection.
    let time = |extension: f64| {
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for _ in 0..60 {
            let t = 0.5 * (low + high);
            if t * t * (3.0 - 2.0 * t) < extension { low = t } else { high = t }
        }
        low
    };
    // Both pads pass a border of sections at 0.3 m and at 0.8 m.
    let heights: Vec<f64> = (50..70)
        .map(|index| {
            let equilibrium = statics::Problem::new(crane).at_time(time(STEP * f64::from(index))).from(&q).solve();
            assert!(equilibrium.is_stable(), "{equilibrium}");
            q.clone_from(&equilibrium.q);
            crane.points_at(&q)[0].z
        })
        .collect();
    let slopes: Vec<f64> = heights.windows(2).map(|pair| (pair[1] - pair[0]) / STEP).collect();
    for three in slopes.windows(3) {
        let jump = (three[2] - 2.0 * three[1] + three[0]) / three[1];
        // The slope itself is continuous; its own slope is not, which over 5 mm is a third of a percent. A polyline jumps by 31 %.
        assert!(jump.abs() < 0.005, "{jump}: {three:?}");
    }
}

/// Where the tip is after a run that extends under weight, work and loss of energy, and the error of their balance.
pub(super) fn run(crane: &LiveCrane, method: Method, tolerance: f64) -> ([f64; 3], f64, f64) {
    let crane: &dyn DynCrane = crane;
    let defaults = Settings::from_description(crane.description());
    let settings = Settings { method, tolerance, duration: 0.6, output: 0.05, step: 5e-5, audit: true, ..defaults };
    let (mut first, mut off, mut work) = (None, 0.0_f64, 0.0_f64);
    let mut tip = [0.0; 3];
    let start = InitialState::at_rest(rest(crane));
    let mut observe = |sample: &Sample<'_>| {
        let energy = crane.energies_at(sample.t, sample.q, sample.v).total();
        let begin = *first.get_or_insert(energy);
        work = work.max(sample.work.abs());
        off = off.max((energy - begin - sample.work - sample.load_work + sample.dissipated).abs());
        tip = crane.points_at(sample.q)[0].into();
        ControlFlow::Continue(())
    };
    crane.simulate(&start, &settings, &mut observe).unwrap_or_else(|stopped| panic!("{stopped}"));
    (tip, work, off)
}

#[test]
fn a_beam_that_extends_under_load_keeps_its_energy() {
    let motion = "{quintic: {from: 0, to: 0.8, duration: 0.5}}";
    let telescope = Telescope {
        sections: "4".into(),
        stiffness: 1e7,
        motion: motion.into(),
        gravity: 9.81,
        density: 4000.0,
        load: [0.0, 500.0, -3000.0],
        torque: 4000.0,
        ..Telescope::default()
    };
    let crane = telescope.crane();
    let (bdf, work, off) = run(&crane, Method::Bdf, 1e-8);
    let (rk4, _, off_rk4) = run(&crane, Method::Rk4, 1e-8);
    println!("{bdf:?} {work} {off} {rk4:?} {off_rk4}");
    let difference = (0..3).map(|i| (bdf[i] - rk4[i]).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-6, "{bdf:?}, {rk4:?}");
    assert!(off < 1e-4 * work && off_rk4 < 1e-4 * work, "{off}, {off_rk4} of {work} J");
}

/// Three stages, of which the last follows the second: by 0.5 m each.
#[test]
fn stages_are_coupled_by_chains() {
    let beam = |height: f64| {
        format!(
            "length: 3, sections: 2, material: {{E: 2.1e11, G: 8.1e10, density: 7850}}, damping: {{beta: 1e-3}}, \
             section: {{box: {{height: {height}, width: {height}, thickness: 0.006}}}}"
        )
    };
    let pads = "pads: {front: {stiffness: [2e8, 2e8, 1e6]}, rear: {stiffness: [2e8, 2e8, 0]}}";
    let text = format!(
        "format: 1\nname: stages\nlinks:\n- {{name: boom, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, beam: {{{}}}}}\n\
         - {{name: second, joint: {{prismatic: {{axis: x}}}}, beam: {{{}, slides_in: {{beam: boom, overlap: 2.8, {pads}}}}}}}\n\
         - {{name: third, joint: {{prismatic: {{axis: x}}}}, beam: {{{}, slides_in: {{beam: second, overlap: 2.8, {pads}}}}}}}\n\
         drives:\n- {{coordinate: boom_psi, stiffness: 1e8, damping: 1e5, motion: {{hold: 30 deg}}}}\n\
         - {{coordinate: second_x, stiffness: 1e8, damping: 1e5, motion: {{hold: 0.5}}}}\n\
         couplings: [{{name: chain, coordinate: third_x, follows: second_x, ratio: 1, stiffness: 1e8, damping: 1e5}}]\n\
         points: [{{name: tip, link: third, at: [3, 0, 0]}}]\n",
        beam(0.26),
        beam(0.22),
        beam(0.18)
    );
    let crane = crane(&text);
    let crane: &dyn DynCrane = &crane;
    let tip = crane.points_at(&rest(crane))[0];
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    let [along, below] = [tip.x * cos + tip.z * sin, tip.x * sin - tip.z * cos];
    // 3 + 2 · (0.2 + 0.5) m along the boom; it sags by a few mm.
    assert!((along - 4.4).abs() < 1e-3 && below > 1e-3 && below < 0.02, "{along}, {below}");
}

/// The example `telescopic_loader` at rest: across the boom, its pads carry what hangs beyond them.
#[test]
fn the_pads_of_the_telescopic_loader_carry_what_is_beyond_them() {
    let (_, text) = crane_specs::EXAMPLES.iter().find(|(name, _)| *name == "telescopic_loader").expect("the example");
    let crane = crane(text);
    let crane: &dyn DynCrane = &crane;
    let q = rest(crane);
    let still = vec![0.0; q.len()];
    let tensions = crane.connector_tensions_at(0.0, &q, &still);
    let force = |name: &str| {
        let index = crane.description().connectors.iter().position(|connector| connector.name.as_str() == name);
        tensions[index.expect(name)].force
    };
    // Box girders and hoses, kg.
    let first = 3.4 * (7850.0 * (0.26 * 0.18 - 0.246 * 0.166) + 12.0);
    let second = 3.2 * 7850.0 * (0.22 * 0.14 - 0.208 * 0.128);
    let hook = 760.0;
    // The rope runs along the boom to the winch; what it carries across it is 1/40 of half the weight of the hook.
    let across = 9.81 * 35_f64.to_radians().cos();
    for (stage, mass) in [("first_stage", first + second + hook), ("second_stage", second + hook)] {
        // Along y of the boom, the stage exerts the force of its front pads on the outer beam, and the outer beam that of its rear pads on the stage.
        let carried = -force(&format!("{stage}_front_y")) + force(&format!("{stage}_rear_y"));
        assert!((carried / (mass * across) - 1.0).abs() < 0.03, "{stage}: {carried} N of {} N", mass * across);
        assert!(force(&format!("{stage}_front_y")) < -mass * across, "a lever");
    }
    assert!((2.0 * force("hoist") / (hook * 9.81) - 1.0).abs() < 0.01);
}
