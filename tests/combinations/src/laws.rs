//! Laws of mechanics that hold for any crane.

use crane_codegen::chain::{Group, Law as ForceLaw, LoadAxes, Profile, Transmission};
use crane_live::{Hold, LiveCrane, SteeredMotion};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{Contacts, InitialState, Integration, Method, Sample, Settings};
use crane_model::envelope::{Condition, Limits};
use crane_model::linear::{About, Forces, Input, Output, linear_model, outputs};
use crane_model::loop_joints::Given;
use crane_model::nalgebra::{DMatrix, DVector};
use crane_model::results::cautions::{BEND, of_pose};
use crane_model::results::{Instant, Peaks, quantities};
use crane_model::runs::{Start, record};
use crane_model::statics::{self, RestSearch};
use crane_model::{Cut, modes};
use fastrand::Rng;
use std::collections::HashSet;
use std::ops::ControlFlow;

use crate::cuts::{Motion, imbalances, jumps};
use crate::observe::{equilibrium, live};
use crate::tree::{Tree, source};

/// A law: `None` where it does not apply, else what breaks it.
pub type Law = fn(&LiveCrane, &[f64], &mut Rng) -> Option<Result<(), String>>;

/// All of them, with their names.
pub const ALL: [(&str, Law); 19] = [
    ("what is stable has converged and does not grow", stable_is_stable),
    ("limits of charts are cautions at rest", limits_are_cautions),
    ("results have names of their own", results_are_named),
    ("accelerations solve A a = e + f", accelerations_solve),
    ("power of all forces", power),
    ("rate of the kinetic energy", kinetic_energy),
    ("tangent is the derivative of the residual", tangent),
    ("springs of beams carry what is beyond them", springs_carry),
    ("every body is in balance", bodies_balance),
    ("places along beams are those of diagrams, and pads make them jump", places_agree),
    ("nothing that is drawn floats", drawn_in_one_piece),
    ("energy balance of a run", energy_balance),
    ("ground carries weight and loads", ground_carries),
    ("a crane at rest stays at rest", rest_stays),
    ("linear models at rest are changes of statics", statics_follow_drives),
    ("a damped run ends at rest", damped_run_ends),
    ("drives at rest as at the start of a run", efforts_at_rest),
    ("eight cranes as one", lanes),
    ("an input set on the way", inputs_set_on_the_way),
];

/// Columns of a run, their extremes and indicators of contacts have different names, all of them known to the check of a spec.
fn results_are_named(crane: &LiveCrane, _: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let known = crane.chain().result_names();
    let columns = quantities(crane.description(), crane.loop_joints()).into_iter().chain(Peaks::columns(crane));
    let names = columns.map(|column| column.name).chain(Contacts::names(crane.description()));
    let mut seen = HashSet::new();
    for name in names {
        if !known.owners.contains_key(&name) {
            return Some(Err(format!("`{name}` is not known to the check of a spec")));
        }
        if !seen.insert(name.clone()) {
            return Some(Err(format!("two results are called `{name}`")));
        }
    }
    Some(Ok(()))
}

/// A stable equilibrium has a small residual, no damped mode that grows, and a least eigenvalue of its stiffness above zero. Forces that turn with their
/// links may feed a motion, and oil has its own verdict.
fn stable_is_stable(crane: &LiveCrane, q: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let whole: &dyn DynCrane = crane;
    let settings = statics::Settings::default();
    let equilibrium = whole.equilibrium(&settings);
    // Of stiff cranes, rounding may be more than the tolerance.
    if let Err(error) = close("residual that is told", equilibrium.residual(), 0.0, 1.0, 10.0 * settings.tolerance) {
        return Some(Err(error));
    }
    // What is left over, beside what drives and springs would exert far from it; loops transmit forces besides.
    let positions = crane.drive_positions_at(0.0);
    let residual = |q: &[f64]| {
        let mut out = vec![0.0; q.len()];
        crane.static_residual(0.0, q, &positions, &mut out);
        out
    };
    let size = residual(&vec![0.0; q.len()]).iter().fold(1.0, |size: f64, f| size.max(f.abs()));
    let prescribed = crane.description().prescribed();
    let left = residual(q).into_iter().zip(&crane.description().coordinates).enumerate();
    for (_, (left, coordinate)) in left.filter(|(j, _)| !prescribed.contains(j) && !crane.chain().has_loops()) {
        if let Err(error) = close(&format!("what is left over along {}", coordinate.name), left, 0.0, size, 1e-7) {
            return Some(Err(error));
        }
    }
    if crane.chain().loads.iter().any(|load| load.axes == LoadAxes::Link) || crane.description().has_valves() {
        return Some(Ok(()));
    }
    let damped = modes::damped(&whole.small_motions_at(q)).ok()?;
    let grows = damped.iter().find(|mode| modes::grows(mode.eigenvalue) || mode.damping_ratio() < 0.0);
    Some(grows.map_or(Ok(()), |mode| Err(format!("a stable pose, about which a motion grows: {}", mode.eigenvalue))))
}

/// A limit of charts that the crane is beyond is a caution at rest that names the part, and without one nothing is overstressed, tips or is out of
/// its stroke.
fn limits_are_cautions(crane: &LiveCrane, q: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let crane: &dyn DynCrane = crane;
    let positions: Vec<f64> = crane.drive_motions_at(0.0).iter().map(|[position, _]| *position).collect();
    let limits = Limits::usual(crane.description());
    let exceeded = Condition::at(crane, q.to_vec(), &positions).exceeded(crane, &limits);
    let cautions = of_pose(crane, q, BEND);
    let is_told = |part: &str| cautions.iter().any(|caution| caution.contains(part));
    for margin in &exceeded {
        let limit = margin.limit;
        let location = limit.location(crane);
        let part = location.split(", ").next().unwrap_or_default();
        if !is_told(part) {
            return Some(Err(format!(
                "{} of {location} is exceeded, and no caution says so: {cautions:?}",
                limit.kind()
            )));
        }
    }
    let words = [
        "overstressed",
        "tips over the line",
        "its stroke is from",
        "its relief valve opens",
        "of the pump do not move",
    ];
    let said = cautions.iter().find(|caution| words.iter().any(|words| caution.contains(words)));
    Some(
        said.filter(|_| exceeded.is_empty())
            .map_or(Ok(()), |caution| Err(format!("no limit is exceeded, but: {caution}"))),
    )
}

/// Checks a law on the crane of a spec.
///
/// # Errors
/// The crane has mistakes or does not stand.
pub fn check_law(law: Law, tree: &Tree, seed: u64) -> Result<Option<Result<(), String>>, String> {
    let crane = live(&source(tree))?;
    let q = equilibrium(&crane)?;
    Ok(law(&crane, &q, &mut Rng::with_seed(seed)))
}

/// A time and a state near a pose.
fn state(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> (f64, Vec<f64>, Vec<f64>) {
    let mut random = |scale: f64| scale * (2.0 * rng.f64() - 1.0);
    let t = 0.3 + random(0.1);
    let mut q: Vec<f64> = pose.iter().map(|q| q + random(2e-3)).collect();
    let mut v: Vec<f64> = pose.iter().map(|_| random(0.1)).collect();
    crane.prescribe(t, &mut q, &mut v);
    (t, q, v)
}

/// Whether oil or bristles exert forces, which a state of pose and rates does not contain.
fn has_states(crane: &LiveCrane) -> bool {
    crane.description().has_hidden_forces()
}

/// Compares two numbers, relative to the sum of what they are made of.
fn close(what: &str, a: f64, b: f64, size: f64, tolerance: f64) -> Result<(), String> {
    if (a - b).abs() <= tolerance * size {
        Ok(())
    } else {
        Err(format!("{what}: {a:.9e} against {b:.9e}, of {size:.3e}"))
    }
}

/// A comparison by central differences over a step, or over a shorter one: where a law changes its branch within the longer step, or the
/// motion is fast, only the shorter one is exact enough. What is wrong in the program is wrong with both.
fn by_differences(steps: [f64; 2], compare: impl Fn(f64) -> Result<(), String>) -> Result<(), String> {
    let [step, shorter] = steps;
    compare(step).or_else(|_| compare(shorter))
}

/// `A q̈ = e + f`, in the rows of unknowns, of open chains.
fn accelerations_solve(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    if crane.chain().has_loops() {
        return None;
    }
    let (t, q, v) = state(crane, pose, rng);
    let whole: &dyn DynCrane = crane;
    let a = whole.accelerations_at(t, &q, &v);
    let mut f = vec![0.0; q.len()];
    whole.forces(t, &q, &v, &mut f);
    let right = whole.bias_at(&q, &v) + DVector::from_vec(f);
    let matrix = whole.mass_matrix_at(&q);
    let size = matrix.abs() * a.abs() + right.abs();
    let left = matrix * a;
    let prescribed = crane.description().prescribed();
    for (j, coordinate) in crane.description().coordinates.iter().enumerate().filter(|(j, _)| !prescribed.contains(j)) {
        // A solve leaves a residual of rounding times the size of its terms, over all rows that it eliminates.
        if let Err(error) = close(&coordinate.name, left[j], right[j], size[j].max(1e-6 * size.amax()), 1e-9) {
            return Some(Err(error));
        }
    }
    Some(Ok(()))
}

/// Step of differences over time, s: the error of a central difference is its square.
const STEP: f64 = 1e-5;

/// `d/dt E_p = −v f − dissipation + power of motions, winches and loads` along any v, with f without gravity's part.
fn power(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    if has_states(crane) {
        return None;
    }
    let (t, q, v) = state(crane, pose, rng);
    let energies = |step: f64| {
        let q: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + step * v).collect();
        let whole: &dyn DynCrane = crane;
        let e = whole.energies_at(t + step, &q, &vec![0.0; q.len()]);
        [e.supports, e.elements, e.drives, e.stops, e.connectors]
    };
    let mut f = vec![0.0; q.len()];
    crane.forces(t, &q, &v, &mut f);
    let prescribed = crane.description().prescribed();
    let works = f.iter().zip(&v).enumerate().filter(|(j, _)| !prescribed.contains(j)).map(|(_, (f, v))| f * v);
    let (work, size) = works.fold((0.0, 0.0), |(sum, size), work| (sum + work, size + f64::abs(work)));
    // What rigid drives supply is not among the forces.
    let supplied = if prescribed.is_empty() { crane.drive_power(t, &q, &v) } else { return None };
    let supplied = supplied + crane.winch_power(t, &q, &v) + crane.load_power(t, &q, &v);
    let lost = crane.dissipation(t, &q, &v);
    let balance = |step: f64| {
        let (before, after) = (energies(-step), energies(step));
        let rate: f64 = before.iter().zip(after).map(|(a, b)| (b - a) / (2.0 * step)).sum();
        let rounding = before.iter().fold(0.0, |sum: f64, e| sum + e.abs()) * 1e-15 / step;
        close("power", work, supplied - lost - rate, size + lost.abs() + rounding * 1e7, 1e-6)
    };
    // A contact that begins within the step makes the error of the difference one of order 1.
    Some(by_differences([STEP, 1e-2 * STEP], balance))
}

/// `d/dt E_k = v (e + f)` along the motion, with everything that rigid drives exert as what is missing.
fn kinetic_energy(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    let (t, q, v) = state(crane, pose, rng);
    let whole: &dyn DynCrane = crane;
    let a = whole.accelerations_at(t, &q, &v);
    let energy = |step: f64| {
        let q: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + step * v).collect();
        let v: Vec<f64> = v.iter().zip(a.iter()).map(|(v, a)| v + step * a).collect();
        crane.kinetic_energy(&q, &v)
    };
    let matrix = whole.mass_matrix_at(&q);
    let inertia = matrix * &a;
    let v = DVector::from_vec(v.clone());
    // v e at rest is the power of weight; the rest of e changes the kinetic energy together with A.
    let rest = DVector::zeros(q.len());
    let velocity_forces = whole.bias_at(&q, v.as_slice()) - whole.bias_at(&q, rest.as_slice());
    let terms: Vec<f64> = v.iter().zip(&inertia).chain(v.iter().zip(&velocity_forces)).map(|(v, f)| v * f).collect();
    let size: f64 = terms.iter().map(|x| x.abs()).sum();
    // ½ vᵀ Ȧ v = −vᵀ h, so d/dt E_k = vᵀ (A a − h) with e = −h + weight.
    let expected = v.dot(&inertia) - v.dot(&velocity_forces);
    let size = size.max(1e-3 * energy(0.0).abs());
    let balance = |step: f64| close("rate", (energy(step) - energy(-step)) / (2.0 * step), expected, size, 1e-5);
    // Accelerations of stiff elements are large: their error falls with the square of the step.
    Some(by_differences([STEP, 0.1 * STEP], balance))
}

/// Step of differences of forces over the pose: the error of a central difference is its square, rounding 1e-10.
const SMALL_STEP: f64 = 1e-6;

/// The tangent is the derivative of the residual along a direction, at any time and any positions of the drives. Of loads that turn with
/// their link it has the symmetric part: the work is that of both. Of feet that slide it has nothing.
fn tangent(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    let (t, q, v) = state(crane, pose, rng);
    if (crane as &dyn DynCrane).friction_utilisations_at(&q).iter().any(|(_, used)| *used >= 1.0) {
        return None;
    }
    let n = q.len();
    let positions: Vec<f64> = crane.drive_positions_at(t).iter().map(|at| at + 1e-3 * (rng.f64() - 0.5)).collect();
    let prescribed = crane.description().prescribed();
    let direction =
        DVector::from_iterator(n, v.iter().enumerate().map(|(j, v)| if prescribed.contains(&j) { 0.0 } else { *v }));
    let residual = |step: f64| {
        let q: Vec<f64> = q.iter().zip(direction.iter()).map(|(q, by)| q + step * by).collect();
        let mut out = vec![0.0; n];
        crane.static_residual(t, &q, &positions, &mut out);
        DVector::from_vec(out)
    };
    let mut matrix = DMatrix::zeros(n, n);
    crane.tangent_stiffness(t, &q, &positions, matrix.as_mut_slice());
    let expected = (&matrix * &direction).dot(&direction);
    // Terms of both signs, of which the stiffest element counts most.
    let size = matrix.abs().row_sum().amax() * direction.norm_squared();
    let derivative = |step: f64| {
        let along = (residual(step) - residual(-step)) / (2.0 * step);
        close("work of the tangent", along.dot(&direction), expected, size, 1e-7)
    };
    // The tangent of a foot jumps where it begins to hold in full.
    Some(by_differences([SMALL_STEP, 0.1 * SMALL_STEP], derivative))
}

/// The spring before an element of a beam transmits the moments of the section there, at rest and in motion. They are about axes that
/// differ by the angle between the elements, of which a curved beam has some also without load.
fn springs_carry(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    let description = crane.description();
    let whole: &dyn DynCrane = crane;
    let still = vec![0.0; pose.len()];
    let mut motions = vec![(0.0, pose.to_vec(), still.clone(), still)];
    if !has_states(crane) {
        let (t, q, v) = state(crane, pose, rng);
        let a = whole.accelerations_at(t, &q, &v).as_slice().to_vec();
        motions.push((t, q, v, a));
    }
    let mut applies = false;
    for (t, q, v, a) in motions {
        let moments = whole.element_moments_at(&q, &v);
        let of_elements =
            description.coordinates.iter().enumerate().filter(|(_, coordinate)| coordinate.role.is_element());
        let springs: Vec<(&str, f64)> =
            of_elements.zip(moments).map(|((_, coordinate), moment)| (coordinate.name.as_str(), moment)).collect();
        let transforms = whole.transforms_at(&q);
        let (x, sizes) = (whole.section_places_at(&q), whole.body_sizes_at());
        // The force of a pad bends the spring of its section by the mean of the moment, which jumps or kinks there.
        let at_pad = |section: usize| {
            let beam = |section: usize| &description.bodies[description.sections[section].body].link;
            let body = description.sections[section].body;
            let length = sizes[body - 1][1] + sizes[body][1];
            (0..x.len()).any(|other| {
                description.sections[other].slides
                    && beam(other) == beam(section)
                    && (x[other] - x[section]).abs() < length
            })
        };
        for (cut, wrench) in description.cuts().iter().zip(whole.internal_forces_at(t, &q, &v, &a)) {
            let Cut::Body { body, section } = *cut else { continue };
            if section.is_some_and(|section| section > 0 && at_pad(section)) {
                continue;
            }
            let name = description.bodies[body].name.as_str();
            let own = |axis: &str| springs.iter().find(|(spring, _)| *spring == format!("{name}_{axis}"));
            let Some(((psi, theta), phi)) = own("psi").zip(own("theta")).zip(own("phi")) else { continue };
            applies = true;
            let turn = |body: usize| transforms[body].fixed_view::<3, 3>(0, 0).into_owned();
            let angle = (0.5 * ((turn(body - 1).transpose() * turn(body)).trace() - 1.0)).clamp(-1.0, 1.0).acos();
            let size = wrench.moment.norm().max(1.0);
            let axes = [(psi, wrench.moment.z), (theta, wrench.moment.y), (phi, wrench.moment.x)];
            for ((spring, moment), beyond) in axes {
                // Newton's tolerance, and the angle between the axes, of which the spring of a curved beam has half.
                if let Err(error) = close(&format!("moment {spring}"), *moment, beyond, size, 1e-6 + 2.0 * angle) {
                    return Some(Err(error));
                }
            }
        }
    }
    applies.then_some(Ok(()))
}

/// The wrenches at the cuts before and beyond every body balance its weight, its inertia and what acts on it, at rest and in motion.
fn bodies_balance(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    let whole: &dyn DynCrane = crane;
    let still = vec![0.0; pose.len()];
    // Newton's tolerance, in the efforts of valves.
    let mut broken = unbalanced("at rest", imbalances(crane, &Motion { t: 0.0, q: pose, v: &still, a: &still }), 1e-8);
    // Rotors add moments of their own, which follow from rates and accelerations.
    if !has_states(crane) && crane.chain().rotors.is_empty() {
        let (t, q, v) = state(crane, pose, rng);
        let a = whole.accelerations_at(t, &q, &v).as_slice().to_vec();
        // Second differences.
        broken.extend(unbalanced("in motion", imbalances(crane, &Motion { t, q: &q, v: &v, a: &a }), 1e-5));
    }
    Some(if broken.is_empty() { Ok(()) } else { Err(broken.join("; ")) })
}

/// At pads on which beams slide, what they carry jumps by what the pads exert; and what pages draw at every place is what its cut carries.
fn places_agree(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    let whole: &dyn DynCrane = crane;
    let description = whole.description();
    if description.sections.is_empty() {
        return None;
    }
    let still = vec![0.0; pose.len()];
    // Both sides round forces of all pads.
    let at_rest = jumps(crane, &Motion { t: 0.0, q: pose, v: &still, a: &still });
    let mut broken = unbalanced("at rest", at_rest, 1e-8);
    if !has_states(crane) {
        let (t, q, v) = state(crane, pose, rng);
        let a = whole.accelerations_at(t, &q, &v).as_slice().to_vec();
        broken.extend(unbalanced("in motion", jumps(crane, &Motion { t, q: &q, v: &v, a: &a }), 1e-8));
    }
    let rest = Instant::at_rest(whole, pose);
    let page = crane_page::strength::data(whole, std::slice::from_ref(&rest), 1);
    let drawn = page["carried"]["places"].as_array().map_or(&[][..], Vec::as_slice);
    let cuts = description.cuts();
    for section in 0..description.sections.len() {
        let Some(cut) = cuts.iter().position(|cut| cut.section() == Some(section)) else { continue };
        let moment: [f64; 3] = rest.wrenches[cut].moment.into();
        let found = drawn.get(section).map(|place| &place["ranges"]);
        let same = |axis: usize| found.and_then(|ranges| ranges[axis][0].as_f64()) == Some(moment[axis]);
        if !(0..3).all(same) {
            broken.push(format!("section {section} is drawn with {found:?} for {moment:?}"));
        }
    }
    Some(if broken.is_empty() { Ok(()) } else { Err(broken.join("; ")) })
}

/// What pages, pictures and exports show of a crane at rest hangs together.
fn drawn_in_one_piece(crane: &LiveCrane, pose: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let figure = crane_page::shapes::Figure::new(crane, pose, pose);
    // A `shape` is where the spec puts it.
    if !figure.scene.forms.is_empty() {
        return None;
    }
    let floating = figure.floating();
    Some(if floating.is_empty() { Ok(()) } else { Err(format!("pieces at {floating:?} float")) })
}

/// The bodies that are not in balance, by how much of the largest force.
fn unbalanced(when: &str, bodies: Vec<(String, f64)>, tolerance: f64) -> Vec<String> {
    let broken = bodies.into_iter().filter(|(_, by)| by.is_nan() || *by > tolerance);
    broken.map(|(body, by)| format!("balance of {body} {when}: {by:.3e} of the largest force is missing")).collect()
}

/// Energy, work and dissipation of the run of the spec balance, relative to the largest of them.
fn energy_balance(crane: &LiveCrane, q: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let description = crane.description();
    let start = Start { rests: true, ..Start::given(InitialState::at_rest(q.to_vec())) };
    let settings =
        Settings { tolerance: 1e-7, most_steps: 60_000, audit: true, ..Settings::from_description(description) };
    let table = match record(crane, &start, &settings, &mut |_| ControlFlow::Continue(())) {
        Ok(recorded) => recorded.table,
        Err(failed) => return Some(Err(failed.to_string())),
    };
    let most = |name: &str| Some(table.values(name)?.fold(0.0, |most: f64, value| most.max(value.abs())));
    let parts = ["kinetic_energy", "drive_work", "load_work", "dissipated_energy"];
    let size = parts.into_iter().filter_map(most).fold(0.0, f64::max);
    let off = most("energy_balance")?;
    // A crane that stays where it is does nothing.
    let applies = size > 1.0;
    applies.then(|| close("energy balance", off, 0.0, size, 1e-3))
}

/// The supports carry weight, loads and what holds to the world.
fn ground_carries(crane: &LiveCrane, q: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let whole: &dyn DynCrane = crane;
    if crane.description().supports.is_empty() {
        return None;
    }
    let reactions = whole.support_reactions_at(q, &vec![0.0; q.len()]);
    let (weight, applied) = (whole.weight_at(q), whole.applied_force_at(0.0, q));
    for axis in 0..3 {
        let (Some(weight), Some(applied)) = (weight[axis], applied[axis]) else { continue };
        let sum: f64 = reactions.iter().map(|force| force[axis]).sum();
        let size = reactions.iter().map(crane_model::nalgebra::Matrix::norm).sum();
        if let Err(error) = close("reactions", sum, -weight - applied, size, 1e-8) {
            return Some(Err(error));
        }
    }
    Some(Ok(()))
}

/// From its equilibrium, with drives that do not move, a run goes nowhere.
fn rest_stays(crane: &LiveCrane, q: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let description = crane.description();
    let still = |pieces: usize| pieces == 0;
    if !description.drives.iter().all(|drive| still(drive.pieces))
        || description.connectors.iter().any(|c| !still(c.pieces))
    {
        return None;
    }
    // A joint with friction creeps, and so does a valve with leakage.
    if description.loads.iter().any(|load| load.pieces > 0) || description.has_valves() {
        return None;
    }
    let start = Start { rests: true, ..Start::given(InitialState::at_rest(q.to_vec())) };
    let settings = Settings {
        duration: 2.0,
        output: 0.5,
        tolerance: 1e-7,
        audit: false,
        ..Settings::from_description(description)
    };
    let table = match record(crane, &start, &settings, &mut |_| ControlFlow::Continue(())) {
        Ok(recorded) => recorded.table,
        Err(failed) => return Some(Err(failed.to_string())),
    };
    let end = table.rows.last()?;
    for (j, coordinate) in description.coordinates.iter().enumerate() {
        let (from, to) = (q[j], end[1 + j]);
        if (to - from).abs() > 1e-5 {
            return Some(Err(format!("{} drifts from {from:.9} to {to:.9} in 2 s", coordinate.name)));
        }
    }
    Some(Ok(()))
}

/// A motion that goes on after an input is set, and again after it is left to the spec, ends as three motions one after the other, each from where the last
/// one ended.
fn inputs_set_on_the_way(crane: &LiveCrane, q: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    /// Length of each part, s, tolerance of the runs, and largest difference relative to the largest number of a kind.
    const PART: [f64; 3] = [0.05, 1e-9, 1e-4];
    let numbers: Vec<f64> = crane.description().inputs.iter().map(|info| info.default).collect::<Option<_>>()?;
    let input = rng.usize(0..numbers.len().max(1));
    let value = numbers.get(input)? * (0.5 + rng.f64());
    let own = Settings::from_description(crane.description());
    let settings = Settings { tolerance: PART[1], audit: false, most_steps: 20_000, ..own };
    let proceed = &mut |_: f64| ControlFlow::Continue(());
    let mut start = Start::given(InitialState::at_rest(q.to_vec()));
    start.close(crane, 0.0, &Given::default()).ok()?;
    let begin = start.state.clone();
    let mut steered = SteeredMotion::new(crane, 0.0, &begin, &settings, None).ok()?;
    let state = |sample: &Sample<'_>| InitialState { q: sample.q.to_vec(), v: sample.v.to_vec(), x: sample.x.to_vec() };
    let mut end = begin;
    for (part, set) in [None, Some(value), None].into_iter().enumerate() {
        let changes = (part > 0).then_some((input, set));
        // What would move a rigid drive at once is refused.
        if steered.advance(PART[0], changes, Hold::Constant, proceed).ok()?.is_break() {
            return None;
        }
        let mut alone = crane.clone();
        alone.set_input(input, set.or(Some(numbers[input])));
        let mut motion = Integration::new(&alone, PART[0] * part as f64, &end, &settings).ok()?;
        if motion.advance(PART[0] * (part + 1) as f64, proceed).ok()?.is_break() {
            return None;
        }
        end = state(&motion.sample());
    }
    let found = state(&steered.sample());
    for (what, own, other) in [("q", &found.q, &end.q), ("v", &found.v, &end.v), ("x", &found.x, &end.x)] {
        let size = other.iter().fold(1e-3, |size: f64, number| size.max(number.abs()));
        for (index, (own, other)) in own.iter().zip(other).enumerate() {
            if let Err(error) = close(&format!("{what}[{index}] after an input is set"), *own, *other, size, PART[2]) {
                return Some(Err(error));
            }
        }
    }
    Some(Ok(()))
}

/// Steps of a drive's position, m and rad, by which statics is differenced.
const MOVED: [f64; 2] = [1e-5, 1e-6];

/// The response of a linear model at rest, `D − C A⁻¹ B`, to the position of a drive is how the pose at rest changes with it.
fn statics_follow_drives(crane: &LiveCrane, q: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    let whole: &dyn DynCrane = crane;
    // Oil and bristles hold a pose by other forces than statics does, and what slides is held by none.
    if has_states(crane) || whole.friction_utilisations_at(q).iter().any(|(_, used)| *used >= 1.0) {
        return None;
    }
    let inputs: Vec<Input> =
        Input::all(crane.description()).into_iter().filter(|input| matches!(input, Input::Motion(_))).collect();
    let input = *inputs.get(rng.usize(0..inputs.len().max(1)))?;
    let Input::Motion(drive) = input else { return None };
    let coordinates: Vec<Output> = outputs(whole).into_iter().take(q.len()).collect();
    let about = About { t: 0.0, q, v: &vec![0.0; q.len()], x: Forces::Holding, steady: true };
    let model = linear_model(crane, &about, &[input], &coordinates).ok()?;
    let response = &model.d - &model.c * model.a.clone().lu().solve(&model.b)?;
    let size = response.amax();
    let positions: Vec<f64> = whole.drive_motions_at(0.0).iter().map(|[position, _]| *position).collect();
    let rest = |by: f64| {
        let mut moved = positions.clone();
        moved[drive] += by;
        RestSearch { crane: whole, positions: &moved }.find_near(q).map(|equilibrium| equilibrium.q)
    };
    let differ = |step: f64| {
        let Some((less, more)) = rest(-step).zip(rest(step)) else { return Ok(()) };
        for (j, coordinate) in crane.description().coordinates.iter().enumerate() {
            let change = (more[j] - less[j]) / (2.0 * step);
            close(&format!("{} by {}", coordinate.name, model.inputs[0].name), response[(j, 0)], change, size, 1e-5)?;
        }
        Ok(())
    };
    // A rope or a foot may let go within the longer step.
    Some(by_differences(MOVED, differ))
}

/// The longest run to rest, s.
const LONGEST: f64 = 200.0;

/// The crane with everything that moves by itself held where it is at the start, and without friction, which would hold it elsewhere.
fn held(crane: &LiveCrane) -> LiveCrane {
    let mut chain = crane.chain().clone();
    let parameters = crane.parameters();
    let start = |profile: &Profile| Profile::Hold(profile.start(parameters).into());
    for drive in &mut chain.drives {
        drive.profile = start(&drive.profile);
        if let Transmission::Flexible { effort: Some(effort), .. } = &mut drive.transmission {
            *effort = start(effort);
        }
    }
    for load in &mut chain.loads {
        load.scale = load.scale.as_ref().map(start);
    }
    for force in &mut chain.forces {
        if let ForceLaw::Rope(rope) = &mut force.law {
            rope.length = start(&rope.length);
        }
    }
    chain.forces.retain(|force| force.group != Group::Friction);
    LiveCrane::new(chain)
}

/// Statics are the limit of a damped run: pushed aside, the crane comes back to its equilibrium.
fn damped_run_ends(crane: &LiveCrane, q: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    // What leaks does not stay.
    if crane.description().has_valves() {
        return None;
    }
    let crane = &held(crane);
    let description = crane.description();
    let whole: &dyn DynCrane = crane;
    let modes = modes::damped(&whole.small_motions_at(q)).ok()?;
    let slowest = modes.iter().map(|mode| -mode.eigenvalue.re).fold(f64::INFINITY, f64::min);
    // From a millimetre to 1e-7 m.
    let duration = 10.0 / slowest;
    if !(0.0..LONGEST).contains(&duration) {
        return None;
    }
    let (_, aside, _) = state(crane, q, rng);
    let start = Start::given(InitialState::at_rest(aside));
    let base = Settings {
        method: Method::Bdf,
        tolerance: 1e-7,
        most_steps: 30_000,
        audit: false,
        ..Settings::from_description(description)
    };
    let settings = Settings { duration, output: duration, ..base };
    let table = record(crane, &start, &settings, &mut |_| ControlFlow::Continue(())).ok()?.table;
    let end = table.rows.last()?;
    // Pushed aside, a crane may come to rest where its feet have slid to.
    if table.columns.iter().zip(end).any(|(column, slid)| column.name.contains("_slid_") && *slid != 0.0) {
        return None;
    }
    let off = |j: usize| (end[1 + j] - q[j]).abs();
    let far = (0..q.len()).find(|&j| off(j) > 1e-5);
    Some(far.map_or(Ok(()), |j| {
        let name = &description.coordinates[j].name;
        Err(format!("{name} ends at {:.9} after {duration:.0} s, {:.1e} from its equilibrium", end[1 + j], off(j)))
    }))
}

/// The efforts with which statics hold the crane are those of the first result of a run.
fn efforts_at_rest(crane: &LiveCrane, q: &[f64], _: &mut Rng) -> Option<Result<(), String>> {
    let description = crane.description();
    let whole: &dyn DynCrane = crane;
    let held = whole.drive_efforts_at_rest(q);
    let start = Start { rests: true, ..Start::given(InitialState::at_rest(q.to_vec())) };
    let settings = Settings { duration: 1e-6, output: 1e-6, audit: false, ..Settings::from_description(description) };
    let table = record(crane, &start, &settings, &mut |_| ControlFlow::Continue(())).ok()?.table;
    let size = held.iter().fold(0.0, |size: f64, effort| size.max(effort.abs()));
    for (drive, held) in description.drives.iter().zip(held) {
        let coordinate = &description.coordinates[drive.coordinate];
        let begins =
            |column: &&crane_model::results::Column| column.name.starts_with(&format!("{}_drive_", coordinate.name));
        let column = table.columns.iter().find(begins)?.name.clone();
        let first = table.values(&column)?.next()?;
        if let Err(error) = close(&column, first, held, size, 1e-6) {
            return Some(Err(error));
        }
    }
    Some(Ok(()))
}

/// A time, a pose and rates.
type State = (f64, Vec<f64>, Vec<f64>);

/// Accelerations of a block of eight are those of each one alone, to the bit.
fn lanes(crane: &LiveCrane, pose: &[f64], rng: &mut Rng) -> Option<Result<(), String>> {
    use crane_model::rt::lanes::f64x8;
    let n = pose.len();
    let states: Vec<_> = (0..8).map(|_| state(crane, pose, rng)).collect();
    let t = states[0].0;
    let parameters = crane.parameters().to_vec();
    let mut block = crane.block(&[parameters.as_slice(); 8]).ok()?;
    let pack = |of: fn(&State) -> &Vec<f64>| {
        let vector = |i: usize| f64x8::from(std::array::from_fn::<f64, 8, _>(|lane| of(&states[lane])[i]));
        (0..n).map(vector).collect::<Vec<_>>()
    };
    let (q, v) = (pack(|state| &state.1), pack(|state| &state.2));
    let mut out = vec![f64x8::from([0.0; 8]); n];
    block.forward_dynamics(t, &q, &v, &mut out);
    for (lane, (_, q, v)) in states.iter().enumerate() {
        let mut alone = vec![0.0; n];
        crane.forward_dynamics(t, q, v, &mut alone);
        for (i, alone) in alone.iter().enumerate() {
            let together = out[i].to_array()[lane];
            if together.to_bits() != alone.to_bits() && together != *alone {
                return Some(Err(format!("coordinate {i}, lane {lane}: {together:e} against {alone:e}")));
            }
        }
    }
    Some(Ok(()))
}
