//! Starts of cranes with loops: what is given is held, the rest follows, and what cannot follow is said.

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::loop_joints::Given;
use crane_model::runs::Start;

/// Three cranks of 1 m, 1 m apart, and two couplers between their ends: all cranks turn alike.
fn cranks() -> LiveCrane {
    let bar = |name: String, on: String| {
        format!(
            "- {{name: {name}, on: {{{on}}}, joint: revolute, mass: 1, com: [0.5, 0, 0], inertia: {{Ixx: 1e-4, Iyy: 0.083, Izz: 0.083}}}}\n"
        )
    };
    let crank = |k: u32| bar(format!("c{k}"), format!("link: ground, at: [{k}, 0, 0]"));
    let coupler = |k: u32| bar(format!("b{k}"), format!("link: c{k}, at: [1, 0, 0]"));
    let slide = |k: u32| {
        format!(
            "- {{name: l{k}, from: {{link: b{k}, at: [1, 0, 0]}}, to: {{link: c{}, at: [1, 0, 0]}}, joint: {{slide: {{axis: [0, 0, 1]}}}}}}\n",
            k + 1
        )
    };
    let text = format!(
        "format: 1\nname: cranks\ngravity: [0, -9.81, 0]\nanalyses: [dynamics]\nlinks:\n- {{name: ground}}\n{}{}{}{}{}loop_joints:\n{}{}\
         guess: {{c0_psi: 90 deg, c1_psi: 90 deg, c2_psi: 90 deg, b0_psi: -90 deg, b1_psi: -90 deg}}\n",
        crank(0),
        coupler(0),
        crank(1),
        coupler(1),
        crank(2),
        slide(0),
        slide(1)
    );
    LiveCrane::from_spec(&SourceFile::new("cranks.yaml", text.as_str()))
        .unwrap_or_else(|mistakes| panic!("\n{mistakes}"))
}

/// c0, b0, c1, b1, c2
const C0: usize = 0;

fn assert_near(found: &[f64], expected: [f64; 5], tolerance: f64) {
    assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < tolerance), "{found:?}");
}

/// The cranks have one freedom: with one rate, or one angle, all others are those of parallel cranks and of couplers that do not turn.
#[test]
fn what_is_given_is_held_and_the_rest_follows() {
    let crane = cranks();
    let crane: &dyn DynCrane = &crane;
    let mut start = Start::guess(crane);
    start.v[C0] = -1.0;
    start.close(crane, 0.0, &Given { rates: vec![C0], ..Given::default() }).unwrap();
    assert!(start.v[C0].to_bits() == (-1.0_f64).to_bits());
    // Rounding of the systems that are solved.
    assert_near(&start.v, [-1.0, 1.0, -1.0, 1.0, -1.0], 1e-13);
    let mut start = Start::guess(crane);
    start.q[C0] = 1.0;
    start.close(crane, 0.0, &Given { positions: vec![C0], ..Given::default() }).unwrap();
    assert!(start.q[C0].to_bits() == 1.0_f64.to_bits());
    assert_near(&start.q, [1.0, -1.0, 1.0, -1.0, 1.0], 1e-13);
    // Without anything given, the least change of all.
    let mut start = Start::guess(crane);
    start.v[C0] = -1.0;
    start.close(crane, 0.0, &Given::default()).unwrap();
    assert!((start.v[C0] + 0.4444).abs() < 2e-3, "{}", start.v[C0]);
}

/// Two parallel cranks with a coupler that bends: free joints turn, and the coupler stays straight, although it is light and its ends are not.
#[test]
fn free_joints_turn_before_beams_bend() {
    let text = "format: 1\nname: bar\nanalyses: [dynamics]\ngravity: [0, -9.81, 0]\n\
         materials: {steel: {E: 210 GPa, G: 80 GPa, density: 7850}}\nlinks:\n- {name: ground}\n\
         - {name: c0, on: {link: ground, at: [0, 0, 0]}, joint: revolute, mass: 100, com: [0.5, 0, 0], inertia: {Ixx: 1, Iyy: 10, Izz: 10}}\n\
         - {name: b0, on: {link: c0, at: [1, 0, 0]}, joint: revolute, beam: {length: 1, sections: 4, material: steel, \
         section: {tube: {diameter: 20 mm, thickness: 2 mm}}}}\n\
         - {name: c1, on: {link: ground, at: [1, 0, 0]}, joint: revolute, mass: 100, com: [0.5, 0, 0], inertia: {Ixx: 1, Iyy: 10, Izz: 10}}\n\
         loop_joints:\n- {name: l0, from: {link: b0, at: [1, 0, 0]}, to: {link: c1, at: [1, 0, 0]}, joint: {slide: {axis: [0, 0, 1]}}}\n\
         guess: {c0_psi: 90 deg, c1_psi: 90 deg, b0_psi: -90 deg}\n";
    let live =
        LiveCrane::from_spec(&SourceFile::new("bar.yaml", text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}"));
    let crane: &dyn DynCrane = &live;
    let mut start = Start::guess(crane);
    start.q[C0] = 1.0;
    start.close(crane, 0.0, &Given { positions: vec![C0], ..Given::default() }).unwrap();
    for (info, q) in crane.description().coordinates.iter().zip(&start.q) {
        let expected = match &*info.name {
            "c0_psi" | "c1_psi" => 1.0,
            "b0_psi" => -1.0,
            _ => 0.0,
        };
        // The share of the beam is that of inertia beside its stiffness, 10 kg m² beside 1e4 s² times some 1e3 N m.
        assert!((q - expected).abs() < 1e-5, "{}: {q}", info.name);
    }
}

/// Two cranks that turn against each other open the loop between them; both joints along x by the difference of the rates.
#[test]
fn what_cannot_follow_is_said() {
    let crane = cranks();
    let crane: &dyn DynCrane = &crane;
    let mut start = Start::guess(crane);
    (start.v[C0], start.v[2]) = (-1.0, 2.0);
    let failed = start.close(crane, 0.0, &Given { rates: vec![C0, 2], ..Given::default() }).unwrap_err().to_string();
    assert!(
        failed.contains("joint l0 opens at 3000.000 mm/s along u")
            || failed.contains("joint l0 opens at 3000.000 mm/s along x"),
        "{failed}"
    );
    let mut start = Start::guess(crane);
    (start.q[C0], start.q[2]) = (1.0, 2.0);
    let failed =
        start.close(crane, 0.0, &Given { positions: vec![C0, 2], ..Given::default() }).unwrap_err().to_string();
    assert!(failed.contains("no position or rate of the others closes the loop: joint l0 is open by"), "{failed}");
}

/// A whole state is closed if it is open by less than a millionth of the crank's length, as numbers are that were written with seven digits.
#[test]
fn a_whole_state_off_the_loops_is_refused() {
    let crane = cranks();
    let crane: &dyn DynCrane = &crane;
    let guess = crane.guess();
    let with = |off: f64, rate: f64| {
        let mut q = guess.clone();
        q[C0] += off;
        Start::with(crane, 0.0, Some(&q), Some(&[rate, 1.0, -1.0, 1.0, -1.0]))
    };
    let closed = with(1e-7, -1.0 + 1e-7).unwrap();
    assert_near(&closed.v, [-1.0, 1.0, -1.0, 1.0, -1.0], 2e-7);
    let sum = closed.v[0] + closed.v[1];
    assert!(sum.abs() < 1e-12, "{sum}");
    for (off, rate, words) in [(1e-5, -1.0, "is open by 0.010 mm"), (0.0, -0.9, "opens at 100.000 mm/s")] {
        let failed = with(off, rate).unwrap_err().to_string();
        assert!(failed.contains("the loop is not closed: joint l0") && failed.contains(words), "{failed}");
    }
}

/// Links whose start follows from a motion, a coupling with a spring, an exact one and an input; the guess of the last is written.
fn followers([from, ratio, offset]: [f64; 3]) -> LiveCrane {
    let link = |name: &str| {
        format!(
            "- {{name: {name}, on: ground, joint: revolute, mass: 1, com: [0.5, 0, 0], inertia: {{Ixx: 1e-4, Iyy: 0.083, Izz: 0.083}}}}\n"
        )
    };
    let drive = |name: &str, motion: &str| {
        format!("- {{coordinate: {name}_psi, stiffness: 1e4, damping: 10, motion: {{{motion}}}}}\n")
    };
    let text = format!(
        "format: 1\nname: followers\nparameters: {{from: {{value: {from}}}, r: {{value: {ratio}}}, c: {{value: {offset}}}}}\n\
         inputs: {{lever: {{motion: {{hold: from}}}}}}\nlinks:\n- {{name: ground}}\n{}drives:\n{}{}{}couplings:\n\
         - {{name: soft, coordinate: b_psi, follows: a_psi, ratio: r, offset: c, stiffness: 300}}\n\
         - {{name: exact, coordinate: c_psi, follows: b_psi, ratio: r, offset: c, rigid: true}}\nguess: {{e_psi: 0.3}}\n",
        ["a", "b", "c", "d", "e"].map(link).concat(),
        drive("a", "quintic: {from: from, to: 2, duration: 1}"),
        drive("d", "input: lever"),
        drive("e", "hold: from"),
    );
    LiveCrane::from_spec(&SourceFile::new("followers.yaml", text.as_str()))
        .unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// The start with numbers that are set is that with the same numbers written, also where the guess was the start of a motion before.
#[test]
fn starts_follow_parameters_as_if_they_were_written() {
    let numbers = [0.5, -1.5, 0.25];
    let (mut set, written) = (followers([0.3, 2.0, 0.1]), followers(numbers));
    set.set_parameters(&numbers).unwrap();
    let b = numbers[1] * numbers[0] + numbers[2];
    for crane in [&set, &written] {
        let found = (crane as &dyn DynCrane).guess();
        // Rounding of the couplings' forces, relative to their stiffness.
        assert_near(&found, [0.5, b, numbers[1] * b + numbers[2], 0.5, 0.3], 1e-15);
        assert_near(&crane.chain().guess_at(&numbers), [found[0], found[1], found[2], 0.5, 0.3], 1e-15);
        assert!(crane.input_start(0).to_bits() == numbers[0].to_bits());
    }
    let [of_set, of_written] = [&set, &written].map(|crane| crane.description().clone());
    assert_eq!(of_set.guess, of_written.guess);
    assert_eq!((&of_set.drives, &of_set.inputs), (&of_written.drives, &of_written.inputs));
}
