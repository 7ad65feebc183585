//! Derivatives of a crane at rest by its live parameters, against differences of statics and closed forms.

use crane_codegen::{Checked, SourceFile, build, compile};
use crane_live::LiveCrane;
use crane_live::sensitivity::{
    FixedNumber, Group, LargestLoad, Refused, Sensitivity, Settings, sensitivity, sensitivity_near, with_live_numbers,
};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::envelope::{Axes, Envelope, Limit, Limits, PartLimit, range_of_loads};
use crane_model::modes::undamped;
use crane_model::results::cylinders_at;
use crane_model::sections::{StressedSection, stressed_sections};
use crane_model::tipping::{TippingLine, governing, lines};

fn checked(source: &SourceFile) -> Checked {
    compile::check(source).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{}", source.text))
}

fn live(source: &SourceFile) -> LiveCrane {
    LiveCrane::from_spec(source).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{}", source.text))
}

fn spec(text: &str) -> LiveCrane {
    live(&SourceFile::new("crane.yaml", text))
}

/// A shipped crane whose numbers become live parameters as `changes` writes them.
fn shipped(name: &str, changes: &str) -> LiveCrane {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap();
    live(&if changes.is_empty() { source } else { source.changed(&format!("name: changed\n{changes}")) })
}

fn all(crane: &LiveCrane, frequencies: usize) -> Sensitivity {
    let parameters: Vec<usize> = (0..crane.parameters().len()).collect();
    sensitivity(crane, &parameters, &Settings { frequencies }).unwrap_or_else(|failed| panic!("{failed}"))
}

/// Values of all outputs with another value of a parameter, and where they are.
fn values_at(crane: &LiveCrane, parameter: usize, value: f64, frequencies: usize) -> (Vec<f64>, Vec<String>) {
    let mut other = crane.clone();
    other.set_parameter(parameter, value).unwrap();
    let found = sensitivity(&other, &[], &Settings { frequencies }).unwrap_or_else(|failed| panic!("{failed}"));
    (found.values, found.outputs.into_iter().map(|output| output.place).collect())
}

/// Step of differences relative to the parameter. Extrapolated to step 0 they have an error of its sixth power, 1e-12 here, times how fast
/// the derivatives change; poses that are exact to 1e-13 leave 1e-11 of values, and 1e-8 of those that stiff drives multiply.
const STEP: f64 = 1e-2;
/// Forces that symmetry makes zero, N or N m: a rounding of forces of 1e5 N.
const ROUNDING: f64 = 1e-8;

/// Compares all derivatives of a crane with central differences of its equilibria, to a fraction of the derivative plus a tenth of what
/// changes the value by as much as the parameter.
fn assert_derivatives(what: &str, crane: &LiveCrane, frequencies: usize, tolerance: f64) {
    let found = all(crane, frequencies);
    assert!(found.outputs.len() > 3, "{what}: {:?}", found.notes);
    let mut compared = 0;
    for (place, &parameter) in found.parameters.iter().enumerate() {
        let value = crane.parameters()[parameter];
        let step = STEP * if value == 0.0 { 1.0 } else { value.abs() };
        let (slopes, places): (Vec<_>, Vec<_>) = [1.0, 0.5, 0.25]
            .map(|share| {
                let step = share * step;
                let [(before, first), (after, second)] =
                    [-step, step].map(|step| values_at(crane, parameter, value + step, frequencies));
                let slopes: Vec<f64> = before.iter().zip(&after).map(|(a, b)| (b - a) / (2.0 * step)).collect();
                (slopes, first.into_iter().zip(second).map(|(a, b)| a == b).collect::<Vec<bool>>())
            })
            .into_iter()
            .unzip();
        for (index, output) in found.outputs.iter().enumerate() {
            if !places[0][index] && output.group != Group::Frequencies {
                continue;
            }
            let [long, short, shortest] = [0, 1, 2].map(|k: usize| slopes[k][index]);
            let [first, second] = [(4.0 * short - long) / 3.0, (4.0 * shortest - short) / 3.0];
            let expected = (16.0 * second - first) / 15.0;
            let own = found.derivatives[place][index];
            compared += 1;
            let of_value = found.values[index].abs() * STEP / step;
            let name = &crane.description().parameters[parameter].name;
            assert!(
                (own - expected).abs() <= tolerance * (expected.abs() + 0.1 * of_value) + ROUNDING * STEP / step,
                "{what}: {} by {name}: {own:.9e} for {expected:.9e}, of {:.6e}; {long} {short} {shortest}",
                output.name,
                found.values[index],
            );
        }
    }
    assert!(compared >= found.outputs.len(), "{what}: {compared}");
}

/// Fractions of differences: see [`STEP`].
const FINE: f64 = 1e-6;

#[test]
fn shipped_cranes_change_as_their_equilibria_do() {
    for name in ["cantilever", "knuckle_boom", "eight_link_flexible", "loader_tipping", "two_arms"] {
        assert_derivatives(name, &shipped(name, ""), 4, FINE);
    }
    for name in ["examples/loader_crane", "examples/parallel_harvester"] {
        assert_derivatives(name, &shipped(name, ""), 3, FINE);
    }
}

#[test]
fn a_crane_with_feet_that_lift_and_valves_changes_as_its_equilibria_do() {
    let changes = "parameters: {pin: {value: 1.2, unit: m}, truck_mass: {value: 9500, unit: kg}, foot: {value: 1e7, unit: N/m}}\n\
                   links: [{name: truck, mass: truck_mass}]\nsupports: [{name: s2, stiffness: [3e6, 3e6, foot]}]\n\
                   cylinders: [{name: boom_cylinder, head: {link: boom, at: [pin, -0.1, 0]}}]\n";
    assert_derivatives("hydraulic", &shipped("eight_link_hydraulic", changes), 3, FINE);
}

#[test]
fn stiffness_sections_and_positions_of_drives_count() {
    let changes = "parameters:\n  young: {value: 2.1e11, unit: Pa}\n  height: {value: 0.34, unit: m}\n  slew: {value: 2.6, unit: rad}\n  \
                   lift: {value: 0.9, unit: rad}\n  rear: {value: -4.2, unit: m}\n  spring: {value: 2e7, unit: N m/rad}\nlinks:\n  - {name: boom, beam: \
                   {material: {E: young, G: 8.1e10, density: 7850, yield_stress: 700e6}, section: {box: {height: height, width: 0.24, thickness: 0.008}}}}\n\
                   supports: [{name: rear_left, at: [rear, 1.1, -0.9]}]\ndrives:\n  - {coordinate: column_psi, motion: {hold: slew}}\n  \
                   - {coordinate: boom_psi, rigid: true, stiffness: ~, damping: ~, motion: {hold: lift}}\n  - {coordinate: jib_psi, stiffness: spring}\n";
    let crane = shipped("loader_tipping", changes);
    assert_eq!(crane.description().prescribed().len(), 1);
    assert_derivatives("loader", &crane, 5, FINE);
}

#[test]
fn loops_with_rigid_drives_change_as_their_equilibria_do() {
    let changes = "parameters:\n  lift: {value: 1.1, unit: rad}\n  pin: {value: 2.19, unit: m}\n  arm: {value: 4, unit: m}\nlinks:\n  - {name: jib, \
                   placement: {transform: {translation: [arm, 0, 0]}}}\nloop_joints: [{name: parallel_pin, from: {link: column, at: [-0.23, 0, pin]}}]\n\
                   drives:\n  - {coordinate: boom_psi, rigid: true, stiffness: ~, damping: ~, motion: {hold: lift}}\n";
    assert_derivatives("harvester", &shipped("examples/parallel_harvester", changes), 2, FINE);
}

#[test]
fn a_rigid_coupling_with_live_numbers_changes_as_its_equilibria_do() {
    let changes = "parameters:\n  gear: {value: 0.95}\n  lag: {value: 0.02, unit: m}\ncouplings: [{name: chain, rigid: true, stiffness: ~, \
                   damping: ~, ratio: gear, offset: lag}]\n";
    // Its masses follow the coupling over metres: differences of the lowest frequency have an error of 3e-6.
    assert_derivatives("chain", &shipped("examples/loader_crane", changes), 2, 1e-5);
}

/// The numbers themselves, against those of the runtime.
#[test]
fn outputs_have_the_values_of_the_runtime() {
    for name in
        ["eight_link_flexible", "eight_link_hydraulic", "loader_tipping", "two_arms", "examples/parallel_harvester"]
    {
        let live = shipped(name, "");
        let (found, crane): (_, &dyn DynCrane) = (all(&live, 3), &live);
        let (description, q, rest) = (crane.description(), &found.q, vec![0.0; found.q.len()]);
        let mut expected: Vec<(String, f64)> = Vec::new();
        for (point, place) in description.points.iter().zip(crane.points_at(q)) {
            expected.extend(["x", "y", "z"].iter().zip(&place).map(|(axis, x)| (format!("{point}_{axis}"), *x)));
        }
        for (support, force) in description.supports.iter().zip(crane.support_reactions_at(q, &rest)) {
            expected.push((format!("{}_reaction_z", support.name), force.z));
        }
        let efforts = crane.drive_efforts_at_rest(q);
        for (cylinder, state) in description.cylinders.iter().zip(cylinders_at(crane, q, &rest, &efforts)) {
            expected.push((format!("{}_piston_pressure", cylinder.name), state.pressures[0]));
            expected.push((format!("{}_rod_pressure", cylinder.name), state.pressures[1]));
            expected.push((format!("{}_force", cylinder.name), state.force));
        }
        let wrenches = crane.internal_forces_at(0.0, q, &rest, &rest);
        let sections =
            stressed_sections(description, &crane.section_moduli_at(), &crane.section_places_at(q), &wrenches);
        let stress =
            sections.iter().max_by(|a, b| StressedSection::by_stress(a, b)).map(|section| section.stress.equivalent);
        expected.extend(stress.map(|stress| ("greatest_equivalent_stress".to_owned(), stress)));
        let margin = governing(&lines(crane, 0.0, q, &rest, &rest)).map(TippingLine::margin);
        expected.extend(margin.map(|margin| ("tipping_margin".to_owned(), margin)));
        let modes = undamped(&crane.small_motions_at(q)).unwrap();
        let frequencies = modes.iter().take(3).enumerate();
        expected.extend(frequencies.map(|(k, mode)| (format!("frequency_{}", k + 1), mode.frequency().unwrap())));
        for (output, expected) in expected {
            let own =
                found.values[found.index_of(&output).unwrap_or_else(|| panic!("{name}: {output}, {:?}", found.notes))];
            // The same formulas on the same pose: rounding, of pressures and margins that of larger numbers.
            assert!((own - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{name}: {output}: {own} for {expected}");
        }
    }
}

/// A massless beam along x of 8 elements in a circle with E I, stiff enough that it stays straight, and a mass at its end:
/// `w = m g L³/(3 E I) (1 − 1/(4 n²))`, `f ∝ √E`.
#[test]
fn a_cantilever_has_the_derivatives_of_its_formula() {
    let crane = spec(
        "format: 1\nname: beam\nparameters: {young: {value: 2.1e15, unit: Pa}, mass: {value: 20, unit: kg}, length: {value: 2, unit: m}}\n\
         links:\n  - {name: beam, beam: {length: length, sections: 8, material: {E: young, G: 8e14, density: 0.1}, section: {circle: {diameter: \
         0.1}}}}\n  - {name: weight, mass: mass, com: [0, 0, 0]}\npoints: [{name: tip, link: weight, at: [0, 0, 0]}]\n",
    );
    let found = all(&crane, 2);
    let (e, m, l, n) = (2.1e15, 20.0, 2.0_f64, 8.0);
    let inertia = std::f64::consts::PI * 0.05_f64.powi(4) / 4.0;
    let sag = -m * 9.81 * l.powi(3) / (3.0 * e * inertia) * (1.0 - 1.0 / (4.0 * n * n));
    let z = found.index_of("tip_z").unwrap();
    let first = found.index_of("frequency_1").unwrap();
    let frequency = found.values[first];
    let relative = [[-1.0 / e, 1.0 / m, 3.0 / l], [0.5 / e, -0.5 / m, -1.5 / l]];
    for (parameter, [of_sag, of_frequency]) in (0..3).map(|k| (k, [relative[0][k], relative[1][k]])) {
        for (output, expected) in [(z, sag * of_sag), (first, frequency * of_frequency)] {
            let own = found.derivatives[parameter][output];
            // The beam weighs 8e-5 of the mass at its end.
            assert!((own - expected).abs() <= 1e-4 * expected.abs(), "{parameter}, {output}: {own:e} for {expected:e}");
        }
    }
    assert!((found.values[z] - sag).abs() < 1e-4 * sag.abs());
}

/// A round beam hanging along gravity vibrates alike in both planes, until a parameter makes the mass at its end differ: then only one of the
/// two frequencies falls.
#[test]
fn frequencies_that_coincide_part_in_order() {
    let crane = spec(
        "format: 1\nname: beam\ngravity: [9.81, 0, 0]\nparameters: {young: {value: 2.1e9, unit: Pa}, turn: {value: 3, unit: kg m²}}\n\
         links:\n  - {name: beam, beam: {length: 2, sections: 4, material: {E: young, G: 8e10, density: 7850}, section: {circle: {diameter: \
         0.1}}}}\n  - {name: weight, mass: 20, com: [0, 0, 0], inertia: {Ixx: 3, Iyy: 3, Izz: turn}}\n",
    );
    let found = all(&crane, 2);
    assert!(found.notes.iter().any(|note| note.starts_with("frequencies 1 to 2 coincide")), "{:?}", found.notes);
    let [first, second] = ["frequency_1", "frequency_2"].map(|name| found.index_of(name).unwrap());
    let [by_young, by_turn] = [&found.derivatives[0], &found.derivatives[1]];
    // Both rise with E alike, to the rounding of modes that coincide.
    assert!((by_young[first] - by_young[second]).abs() < 1e-6 * by_young[first], "{by_young:?}");
    let step = 1e-3;
    let (after, _) = values_at(&crane, 1, 3.0 + step, 2);
    let expected = (after[first] - found.values[first]) / step;
    // The error of a forward difference: half of its step times the curvature, here 1e-4 of the slope.
    assert!((by_turn[first] - expected).abs() < 1e-3 * expected.abs(), "{} for {expected}", by_turn[first]);
    assert!(expected < 0.0 && by_turn[second].abs() < 1e-6 * expected.abs(), "{by_turn:?}");
}

/// A crane that does not stand has no derivatives, and says why.
#[test]
fn a_crane_that_tips_over_is_refused() {
    let changes = "parameters: {load: {value: 4000}}\ndrives:\n  - {coordinate: column_psi, motion: {hold: 90 deg}}\n  - {coordinate: boom_psi, motion: \
                   {hold: 40 deg}}\n  - {coordinate: jib_psi, motion: {hold: -40 deg}}\n  - {coordinate: extension_x, motion: {hold: 1.5}}\n";
    let crane = shipped("loader_tipping", changes);
    let failed = sensitivity(&crane, &[0], &Settings::default()).unwrap_err();
    assert!(failed.to_string().contains("tips over"), "{failed}");
}

/// A number that can be a live parameter, too, has the same derivatives by differences as without, to their estimated errors.
#[test]
fn differences_of_fixed_numbers_are_the_derivatives() {
    let path = format!("{}/../../specs/two_arms.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap();
    let place = "links.boom.beam.section.box.height";
    let mut names = vec![place.to_owned()];
    let changed = with_live_numbers(&checked(&source), &mut names).unwrap().unwrap();
    let with_number = LiveCrane::new(changed.chain);
    let parameter = with_number.description().parameters.iter().position(|info| info.name == *names[0]).unwrap();
    let settings = Settings::default();
    let exact = sensitivity(&with_number, &[parameter], &settings).unwrap();
    let crane = live(&source);
    let number = FixedNumber::new(&checked(&source), place).unwrap();
    assert_eq!((number.value, number.unit.as_str()), (0.26, "m"));
    let found = sensitivity(&crane, &[], &settings).unwrap();
    let differences = number.differentiate(&crane, &found, &settings).unwrap();
    for (index, output) in found.outputs.iter().enumerate() {
        let (own, expected, error) =
            (differences.derivatives[index], exact.derivatives[0][index], differences.errors[index]);
        // Poses that are exact to 1e-13 over a step of 1e-3, relative to what changes the value as much as the number.
        let rounding = 1e-8 * (found.values[index].abs() + 1.0) / number.value;
        assert!((own - expected).abs() <= error + rounding, "{}: {own} for {expected} ± {error}", output.name);
        // The error of the shorter step, of the square: 1e-6 times how fast the derivative changes.
        assert!(error <= 1e-4 * expected.abs() + rounding, "{}: {error} of {expected}", output.name);
    }
}

/// A beam of two parts with the same section is one beam: with the length of a part its own changes.
#[test]
fn a_part_of_a_beam_becomes_longer_with_the_beam() {
    let path = format!("{}/../../specs/two_arms.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap();
    let section = "section: {box: {height: 0.26, width: 0.2, thickness: 0.008}}";
    let parts = format!(
        "name: changed\nlinks: [{{name: boom, beam: {{section: ~, parts: [{{length: 2.0, {section}}}, {{length: 1.4, {section}}}]}}}}]\n"
    );
    let (settings, place) = (Settings::default(), "links.boom.beam.parts.1.length");
    let with_parts = source.changed(&parts);
    let mut names = [place.to_owned()];
    assert!(with_live_numbers(&checked(&with_parts), &mut names).unwrap().is_none() && names[0] == place);
    let number = FixedNumber::new(&checked(&with_parts), place).unwrap();
    let found = sensitivity(&live(&with_parts), &[], &settings).unwrap();
    let own = number.differentiate(&live(&with_parts), &found, &settings).unwrap();
    let mut names = ["links.boom.beam.length".to_owned()];
    let whole = LiveCrane::new(with_live_numbers(&checked(&source), &mut names).unwrap().unwrap().chain);
    let parameter = whole.description().parameters.iter().position(|info| info.name == *names[0]).unwrap();
    let whole = sensitivity(&whole, &[parameter], &settings).unwrap();
    for name in ["log_centre_x", "log_centre_z", "boom_psi_drive_torque", "frequency_3", "tipping_margin"] {
        let expected = whole.derivatives[0][whole.index_of(name).unwrap()];
        let own = own.derivatives[found.index_of(name).unwrap()];
        // Where the parts meet an element has two pieces: its integrals have other roundings, over a step of 1e-3.
        assert!((own - expected).abs() < 1e-6 * expected.abs(), "{name}: {own} for {expected}");
    }
}

/// What must be an integer, or does not belong to the crane at rest, cannot change; a solid section can by differences.
#[test]
fn numbers_without_derivatives_are_refused() {
    let path = format!("{}/../../specs/two_arms.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap();
    let refused = |place: &str| with_live_numbers(&checked(&source), &mut [place.to_owned()]).unwrap_err();
    let sections = refused("links.boom.beam.sections");
    let [title, help] = sections.words();
    assert!(matches!(sections, Refused::Mistakes { .. }) && help.contains("integer"), "{title}, {help}");
    assert!(!title.contains("number_at_place"), "{title}");
    assert!(matches!(refused("run.duration"), Refused::NotAtRest { .. }));
    let solid = "name: changed\nlinks: [{name: boom, beam: {section: {solid: {height: 0.2, width: 0.1}}}}]\n";
    let source = source.changed(solid);
    let mut names = ["links.boom.beam.section.solid.height".to_owned()];
    assert!(with_live_numbers(&checked(&source), &mut names).unwrap().is_none());
    assert_eq!(names[0], "links.boom.beam.section.solid.height");
}

#[test]
fn a_parameter_that_is_given_twice_has_its_derivatives_twice() {
    let crane = shipped("knuckle_boom", "");
    let found = sensitivity(&crane, &[0, 0], &Settings::default()).unwrap();
    assert_eq!(found.derivatives[0], found.derivatives[1]);
    assert_eq!(found.pose[0], found.pose[1]);
}

/// The largest load within limits, and its derivatives by parameters of these names.
fn largest_load(crane: &LiveCrane, asked: &Envelope, parameters: &[usize]) -> (LargestLoad, Sensitivity) {
    let largest = LargestLoad::new(crane, asked).unwrap_or_else(|none| panic!("{none:?}"));
    let mut loaded = crane.clone();
    loaded.set_parameter(asked.load, asked.factor * largest.load).unwrap();
    let all: Vec<usize> = parameters.iter().copied().chain([asked.load]).collect();
    let settings = Settings { frequencies: 0 };
    let mut found = sensitivity_near(&loaded, &all, &settings, &largest.condition.q).unwrap();
    largest.add_to(&mut found, &loaded, asked, parameters.len(), &[]).unwrap_or_else(|| panic!("{:?}", largest.limit));
    (largest, found)
}

/// Derivatives of the largest load against those of charts that were computed with changed numbers.
fn assert_largest_load(what: &str, crane: &LiveCrane, load: &str, limits: Limits, is_expected: fn(Limit) -> bool) {
    let description = crane.description();
    let index = |name: &str| description.parameters.iter().position(|info| info.name == name).unwrap();
    let load = index(load);
    let loads = range_of_loads(crane, load, None);
    let asked = Envelope { axes: Axes::default(), load, loads, limits, factor: 1.25 };
    let parameters: Vec<usize> = (0..description.parameters.len()).filter(|&index| index != load).collect();
    assert!(parameters.len() > 1, "{what}");
    let (largest, found) = largest_load(crane, &asked, &parameters);
    assert!(is_expected(largest.limit), "{what}: {:?}", largest.limit);
    let output = found.index_of("largest_load").unwrap();
    // A chart is exact to 1e-6, and stays below.
    let own = found.values[output];
    assert!((own - largest.load).abs() <= 2e-6 * own, "{what}: {own} for {}", largest.load);
    for (place, &parameter) in parameters.iter().enumerate() {
        let value = crane.parameters()[parameter];
        let step = 1e-3 * value.abs();
        let at = |step: f64| {
            let mut other = crane.clone();
            other.set_parameter(parameter, value + step).unwrap();
            let (_, found) = largest_load(&other, &asked, &[]);
            found.values[found.index_of("largest_load").unwrap()]
        };
        let expected = (at(step) - at(-step)) / (2.0 * step);
        let derivative = found.derivatives[place][output];
        let name = &description.parameters[parameter].name;
        // Differences have an error of the square of their step, 1e-6, times how fast the derivative changes.
        let allowed = 1e-4 * (expected.abs() + 0.1 * own / value.abs());
        assert!(
            (derivative - expected).abs() <= allowed,
            "{what} by {name}: {derivative} for {expected}, {:?}",
            largest.limit
        );
    }
}

#[test]
fn largest_loads_change_as_those_of_charts() {
    let changes = "parameters:\n  height: {value: 0.34, unit: m}\n  rear: {value: -4.2, unit: m}\n  spring: {value: 2e7, unit: N m/rad}\n  yield: {value: \
                   700e6, unit: Pa}\nlinks:\n  - {name: boom, beam: {material: {E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: yield}, section: {box: \
                   {height: height, width: 0.24, thickness: 0.008}}}}\nsupports: [{name: rear_left, at: [rear, 1.1, -0.9]}]\ndrives: [{coordinate: jib_psi, \
                   stiffness: spring}, {coordinate: column_psi, motion: {hold: 2.2}}]\n";
    // Turned aside, as over the rear two feet lift at the same load.
    let crane = shipped("loader_tipping", changes);
    let none = || Limits::none(crane.description());
    let tipping = Limits { tipping: Some(0.3), ..none() };
    assert_largest_load("tipping", &crane, "load", tipping, |limit| matches!(limit, Limit::Tipping { .. }));
    let used = Limits { utilisation: Some(0.6), ..none() };
    assert_largest_load("use", &crane, "load", used, |limit| matches!(limit, Limit::Utilisation { .. }));
    let drives = &crane.description().drives;
    let of = |name: &str| {
        drives.iter().position(|drive| crane.description().coordinates[drive.coordinate].name == name).unwrap()
    };
    let mut efforts = none().efforts;
    efforts[of("boom_psi")] = 1.5e5;
    let efforts = Limits { efforts, ..none() };
    assert_largest_load("effort", &crane, "load", efforts, |limit| matches!(limit, Limit::Effort { .. }));
    let lift_off = Limits { of_parts: vec![PartLimit::LiftOff], ..none() };
    assert_largest_load("lift-off", &crane, "load", lift_off, |limit| matches!(limit, Limit::LiftOff { .. }));
}

/// A block that a force pulls along the ground slides from μ m g on.
#[test]
fn the_largest_pull_changes_with_friction_and_mass() {
    const GRAVITY: f64 = 9.81;
    let foot = |name: &str, x: f64, y: f64| {
        format!(
            "  - {{name: {name}, at: [{x}, {y}, 0], one_sided: true, friction_coefficient: mu, stiffness: [1e6, 1e6, 1e6]}}\n"
        )
    };
    let feet = [foot("a", 1.0, 1.0), foot("b", 1.0, -1.0), foot("c", -1.0, 1.0), foot("d", -1.0, -1.0)].concat();
    let crane = spec(&format!(
        "format: 1\nname: block\nparameters: {{pull: {{value: 10, unit: N}}, mu: {{value: 0.3}}, mass: {{value: 100, unit: kg}}}}\nlinks:\n\
         - {{name: block, joint: free, mass: mass, com: [0, 0, 0.2], inertia: {{Ixx: 20, Iyy: 20, Izz: 30}}}}\nsupports:\n{feet}\
         loads: [{{name: rope, link: block, at: [0, 0, 0], force: [1, 0, 0], scale: {{hold: pull}}}}]\n"
    ));
    let sliding = Limits { of_parts: vec![PartLimit::Sliding], ..Limits::none(crane.description()) };
    let asked = Envelope { axes: Axes::default(), load: 0, loads: [0.0, 1e4], limits: sliding, factor: 1.0 };
    let (largest, found) = largest_load(&crane, &asked, &[1, 2]);
    assert!(matches!(largest.limit, Limit::Sliding { .. }), "{:?}", largest.limit);
    let output = found.index_of("largest_load").unwrap();
    let derivatives: Vec<f64> = found.derivatives.iter().map(|derivatives| derivatives[output]).collect();
    // All by hand: μ m g, m g and μ g; the feet press a little more in front, by what the block turns, of which nothing enters the sum.
    for (number, expected) in [found.values[output], derivatives[0], derivatives[1]]
        .iter()
        .zip([0.3 * 100.0, 100.0, 0.3].map(|part| part * GRAVITY))
    {
        assert!((number / expected - 1.0).abs() < 1e-6, "{number} for {expected}");
    }
}

#[test]
fn largest_loads_at_pressures_and_efforts_of_the_spec_change_as_those_of_charts() {
    // A heavy truck, so that the crane does not tip before.
    let changes = "parameters: {pin: {value: 0.3, unit: m}, truck_mass: {value: 14000, unit: kg}}\nlinks: [{name: truck, mass: truck_mass}]\n\
                   cylinders: [{name: outer_boom_cylinder, head: {link: outer_boom, at: [pin, 0.2, 0]}}]\n";
    let crane = shipped("eight_link_hydraulic", changes);
    let pressure = Limits { of_parts: vec![PartLimit::Pressure], ..Limits::none(crane.description()) };
    assert_largest_load("pressure", &crane, "load_mass", pressure, |limit| matches!(limit, Limit::Pressure { .. }));
    // The bound itself is a live parameter.
    let changes = "parameters: {most: {value: 1.6e5, unit: N m}, rear: {value: -4.2, unit: m}}\nsupports: [{name: rear_left, at: [rear, 1.1, -0.9]}]\n\
                   drives: [{coordinate: boom_psi, max_effort: most}]\n";
    let crane = shipped("loader_tipping", changes);
    let efforts = Limits { of_parts: vec![PartLimit::MaxEffort], ..Limits::none(crane.description()) };
    assert_largest_load("max_effort", &crane, "load", efforts, |limit| matches!(limit, Limit::Effort { .. }));
}

/// A bound that is a number of the spec moves the load, too: central differences of the loads of whole cranes, at two steps.
#[test]
fn largest_loads_change_with_the_numbers_that_bound_them() {
    let text = |number: &str| {
        let spec = "format: 1
name: pump_limit
analyses: [statics]
parameters: {payload: {value: 500, unit: kg}}
links:
  - {name: column, joint: revolute, mass: 350, com: [0, 0, 0.8], inertia: {Ixx: 90, Iyy: 90, Izz: 15}}
  - {name: boom, placement: {transform: {translation: [0, 0, 1.7], rotation: {x: 90 deg}}}, joint: revolute, mass: 320, com: [1.5, 0, 0], inertia: {Ixx: 6, Iyy: 260, Izz: 260}}
  - {name: load, placement: {transform: {translation: [4, 0, 0]}}, joint: revolute, mass: payload, com: [0, -0.8, 0]}
drives:
  - {coordinate: column_psi, stiffness: 2e6, damping: 2e4, motion: {hold: 0}}
  - {coordinate: boom_psi, stiffness: 2e5, damping: 2e4, motion: {hold: 20 deg}}
cylinders:
  - {name: lift, coordinate: boom_psi, foot: {link: column, at: [0.25, 0, 0.45]}, head: {link: boom, at: [1.15, -0.12, 0]}, bore: 0.1, rod: 0.06, retracted: 1.2, stroke: 1.0, max_pressure: 250e5}
pump: {max_flow: 1e-3, pressure: 230e5}
guess: {load_psi: -20 deg}
";
        SourceFile::new("pump_limit.yaml", spec).changed(&format!("name: changed\n{number}"))
    };
    for (part, place, change, values) in [
        (PartLimit::Pressure, "cylinders.lift.max_pressure", "cylinders: [{name: lift, max_pressure: VALUE}]", 250e5),
        (PartLimit::Pump, "pump.pressure", "pump: {pressure: VALUE}", 230e5),
        // The boom sags until the cylinder is at its end.
        (PartLimit::Stroke, "cylinders.lift.retracted", "cylinders: [{name: lift, retracted: VALUE}]", 1.22),
    ] {
        let with = |value: f64| text(&change.replace("VALUE", &format!("{value:e}")));
        let source = with(values);
        let largest = |source: &SourceFile, fixed: &[FixedNumber]| {
            let crane = live(source);
            let limits = Limits { of_parts: vec![part], ..Limits::none(crane.description()) };
            let loads = range_of_loads(&crane, 0, None);
            let asked = Envelope { axes: Axes::default(), load: 0, loads, limits, factor: 1.0 };
            let largest = LargestLoad::new(&crane, &asked).unwrap_or_else(|none| panic!("{place}: {none:?}"));
            let mut loaded = crane;
            loaded.set_parameter(0, largest.load).unwrap();
            let settings = Settings { frequencies: 0 };
            let mut found = sensitivity_near(&loaded, &[0], &settings, &largest.condition.q).unwrap();
            for number in fixed {
                found.derivatives.push(number.differentiate(&loaded, &found, &settings).unwrap().derivatives);
            }
            largest.add_to(&mut found, &loaded, &asked, 0, fixed).unwrap_or_else(|| panic!("{:?}", largest.limit));
            let output = found.index_of("largest_load").unwrap();
            (found.values[output], found.derivatives.first().map(|derivatives| derivatives[output]))
        };
        let number = FixedNumber::new(&checked(&source), place).unwrap();
        let (load, derivative) = largest(&source, &[number]);
        let derivative = derivative.unwrap();
        for share in [1e-3, 2e-3] {
            let [less, more] = [-share, share].map(|share| largest(&with(values * (1.0 + share)), &[]).0);
            let expected = (more - less) / (2.0 * share * values);
            assert!(expected.abs() * values > 0.1 * load, "{place} moves nothing: {expected}");
            // Differences have an error of the square of the step, 4e-6, times how fast the derivative changes.
            assert!((derivative / expected - 1.0).abs() < 1e-4, "{place}: {derivative} for {expected} at {load}");
        }
    }
}
