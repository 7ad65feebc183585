//! Random lines: machine code computes what each step says, to the bit, except for the sign of a zero.

use crane_jit::{Code, Rounding, Step, StraightLine, Value, Width};
use fastrand::Rng;

/// Numbers of a place, at most.
const LANES: usize = 8;
/// Random lines per test.
const LINES: u64 = 100;
/// What a test's pauses compute.
fn paused(x: f64) -> f64 {
    x.sin() + 0.5
}

/// The given values of a lane.
fn given(line: &StraightLine, rng: &mut Rng) -> Vec<f64> {
    line.given.iter().map(|number| number.unwrap_or_else(|| 4.0 * rng.f64() - 2.0)).collect()
}

/// A line of about `length` steps over `inputs` given values; operands are mostly recent, and numbers mostly of moderate size.
fn line(rng: &mut Rng, inputs: usize, length: usize) -> StraightLine {
    let numbers = [-1.0, 1.0, -0.0, 0.0, 0.5, -3.25];
    let given = numbers.into_iter().map(Some).chain((0..inputs).map(|_| None)).collect();
    let mut line = StraightLine { given, ..StraightLine::default() };
    let mut values = self::given(&line, rng);
    while line.steps.len() < length {
        let before = values.len();
        let step = step(rng, before, &mut line.results);
        apply(&step, Rounding::Separate, &mut values, &mut []);
        let is_moderate = values[before..].iter().all(|x| (0.01..100.0).contains(&x.abs()));
        if is_moderate || rng.usize(0..200) == 0 {
            line.steps.push(step);
        } else {
            values.truncate(before);
        }
    }
    let last = u32::try_from(values.len()).unwrap();
    for value in last - 30.min(last)..last {
        line.results += 1;
        line.steps.push(Step::Store { place: u32::try_from(line.results - 1).unwrap(), value });
    }
    line
}

/// The operands of a step that is repeated.
#[derive(Clone, Copy)]
enum Operand {
    /// As many values before the end of the previous step.
    Recent(usize),
    /// The same in every iteration.
    Invariant(usize),
    /// Values that move by a step, up to an iteration from which on they stay.
    Stream(usize, isize, usize),
}

/// A line in which random steps repeat, some of them twice, on operands that correspond.
fn repeating_line(rng: &mut Rng) -> StraightLine {
    let mut line = line(rng, 400, 60);
    let given = line.given.len();
    let value = |at: usize| u32::try_from(at).unwrap();
    let makes = |step: &Step| match step {
        Step::Store { .. } => 0,
        Step::Pause { makes, .. } => *makes,
        _ => 1,
    };
    let mut count = given + line.steps.iter().map(makes).sum::<usize>();
    let mut earlier: Option<(usize, usize)> = None;
    for _ in 0..3 {
        let (period, iterations) = (rng.usize(40..130), rng.usize(5..9));
        let begin = count;
        let body: Vec<[Operand; 2]> = (0..period)
            .map(|_| {
                let mut of = || match rng.usize(0..12) {
                    0 => Operand::Invariant(rng.usize(0..begin)),
                    1 => {
                        let first = rng.usize(given - 80..given - 40);
                        Operand::Stream(first, [-3, -1, 1, 2, 3][rng.usize(0..5)], rng.usize(3..12))
                    }
                    // Another loop's, forward or backward, also beyond its ends.
                    2 => earlier.map_or(Operand::Recent(3), |(first, period)| {
                        let step = isize::try_from(period).unwrap();
                        let (iteration, step) =
                            if rng.bool() { (rng.usize(0..2), step) } else { (rng.usize(4..6), -step) };
                        let first = first + iteration * period + rng.usize(0..period);
                        Operand::Stream(first, step, rng.usize(3..12))
                    }),
                    3 => Operand::Recent(rng.usize(1..400.min(3 * period))),
                    _ => Operand::Recent(rng.usize(1..12)),
                };
                [of(), of()]
            })
            .collect();
        for k in 0..iterations {
            for operands in &body {
                let [a, b] = operands.map(|operand| match operand {
                    Operand::Recent(ago) => count - ago,
                    Operand::Invariant(at) => at,
                    Operand::Stream(first, step, last) => {
                        let [first, k, begin] =
                            [first, k.min(last), begin].map(|number| isize::try_from(number).unwrap());
                        usize::try_from((first + step * k).rem_euclid(begin)).unwrap()
                    }
                });
                // Halves of a sum stay of moderate size, and what is before is needed.
                line.steps.push(Step::MulAdd([value(a), 4, value(count - 1)]));
                line.steps.push(Step::MulAdd([value(b), 4, 2]));
                line.steps.push(Step::MulAdd([value(count), 4, value(count + 1)]));
                count += 3;
            }
        }
        earlier = Some((begin, 3 * period));
        for at in (begin..count).filter(|_| rng.usize(0..40) == 0).chain(count - 5..count) {
            line.steps.push(Step::Store { place: value(line.results), value: value(at) });
            line.results += 1;
        }
    }
    line
}

/// A step on some of the first `count` values.
fn step(rng: &mut Rng, count: usize, results: &mut usize) -> Step {
    let mut of = || -> Value {
        let reach = [6, 40, count][rng.usize(0..3)].min(count);
        u32::try_from(rng.usize(count - reach..count)).unwrap()
    };
    let [a, b, c] = [of(), of(), of()];
    let (unit, nothing) = (u32::from(rng.bool()), 2);
    match rng.usize(0..40) {
        0 => Step::Div([a, b]),
        1 => Step::Min([a, b]),
        2 => Step::Max([a, b]),
        3 => Step::Sqrt(a),
        4 => Step::Select([a, b, c]),
        5..=9 => Step::MulAdd([a, unit, c]),
        10..=12 => Step::MulAdd([unit, b, nothing]),
        13..=18 => Step::MulAdd([a, b, nothing]),
        19 => {
            *results += 1;
            Step::Store { place: u32::try_from(*results - 1).unwrap(), value: a }
        }
        20 if rng.usize(0..8) == 0 => Step::Pause { arguments: vec![a, b], makes: 2 },
        _ => Step::MulAdd([a, b, c]),
    }
}

/// What a step says.
fn apply(step: &Step, rounding: Rounding, values: &mut Vec<f64>, results: &mut [f64]) {
    let of = |value: Value| values[value as usize];
    let value = match *step {
        Step::MulAdd([a, b, c]) if rounding == Rounding::Fused => of(a).mul_add(of(b), of(c)),
        Step::MulAdd([a, b, c]) => of(a) * of(b) + of(c),
        Step::Div([a, b]) => of(a) / of(b),
        Step::Min([a, b]) => of(a).min(of(b)),
        Step::Max([a, b]) => of(a).max(of(b)),
        Step::Sqrt(a) => of(a).sqrt(),
        Step::Select([a, b, _]) if of(a) > 0.0 => of(b),
        Step::Select([_, _, c]) => of(c),
        Step::Store { place: index, value } => {
            if let Some(result) = results.get_mut(index as usize) {
                *result = of(value);
            }
            return;
        }
        Step::Pause { ref arguments, .. } => {
            let made: Vec<f64> = arguments.iter().map(|value| paused(of(*value))).collect();
            values.extend(made);
            return;
        }
    };
    values.push(value);
}

/// What all steps say.
fn evaluate(line: &StraightLine, rounding: Rounding, given: &[f64]) -> Vec<f64> {
    let (mut values, mut results) = (given.to_vec(), vec![f64::NAN; line.results]);
    line.steps.iter().for_each(|step| apply(step, rounding, &mut values, &mut results));
    results
}

/// The results of machine code, lane by lane.
fn run(code: &Code, line: &StraightLine, lanes: usize, given: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut frame = vec![0.0; code.places().max(line.given.len()) * lanes];
    for (index, number) in code.numbers() {
        frame[index * lanes..(index + 1) * lanes].fill(number);
    }
    for index in 0..line.given.len() {
        for lane in 0..lanes {
            frame[index * lanes + lane] = given[lane][index];
        }
    }
    let mut results = vec![f64::NAN; line.results * lanes];
    for part in 0..code.parts() {
        code.run(part, &mut frame, &mut results);
        if let Some(pause) = code.pause(part) {
            assert_eq!(pause.reads, pause.makes);
            for at in 0..pause.reads * lanes {
                frame[pause.values * lanes + at] = paused(frame[pause.arguments * lanes + at]);
            }
        }
    }
    (0..lanes).map(|lane| results.iter().skip(lane).step_by(lanes).copied().collect()).collect()
}

fn assert_same(what: &str, computed: &[f64], expected: &[f64]) {
    for (index, (x, y)) in computed.iter().zip(expected).enumerate() {
        assert!(x == y || x.is_nan() && y.is_nan(), "{what}: result {index} is {x:e} instead of {y:e}");
    }
}

/// Compares machine code of random lines with what they say; returns the number of loops in it.
fn compare(rounding: Rounding, width: Width, line: impl Fn(&mut Rng) -> StraightLine) -> usize {
    let lanes = width.numbers();
    let (mut compared, mut loops) = (0, 0);
    for seed in 0..LINES {
        let mut rng = Rng::with_seed(seed);
        let line = line(&mut rng);
        let given: Vec<Vec<f64>> = (0..LANES).map(|_| given(&line, &mut rng)).collect();
        let codes = Code::each(&line, rounding, width);
        if codes.is_empty() {
            assert!(!has_code(rounding, width), "there is code for this processor");
            return usize::MAX;
        }
        loops += codes[0].loops();
        for (at, code) in codes.iter().enumerate() {
            let computed = run(code, &line, lanes, &given);
            for (lane, (computed, given)) in computed.iter().zip(&given).enumerate() {
                let what = format!("{rounding:?}, {width:?}, instructions {at}, seed {seed}, lane {lane}");
                let expected = evaluate(&line, rounding, given);
                assert_same(&what, computed, &expected);
                compared += expected.iter().filter(|x| x.is_finite() && **x != 0.0).count();
            }
        }
    }
    println!("{compared} numbers compared, {loops} loops");
    assert!(compared > 2_000, "too few numbers to tell");
    loops
}

/// Whether there is code for this processor.
#[cfg(target_arch = "x86_64")]
fn has_code(rounding: Rounding, _: Width) -> bool {
    let fuses = || std::arch::is_x86_feature_detected!("fma");
    std::arch::is_x86_feature_detected!("avx") && (rounding == Rounding::Separate || fuses())
}

/// Whether there is code for this processor.
#[cfg(not(target_arch = "x86_64"))]
fn has_code(_: Rounding, width: Width) -> bool {
    cfg!(target_arch = "aarch64") && width == Width::One
}

fn any_line(rng: &mut Rng) -> StraightLine {
    let (inputs, length) = (rng.usize(1..60), rng.usize(1..1500));
    line(rng, inputs, length)
}

#[test]
fn one_number() {
    compare(Rounding::Separate, Width::One, any_line);
    compare(Rounding::Fused, Width::One, any_line);
}

#[test]
fn eight_numbers() {
    compare(Rounding::Separate, Width::Eight, any_line);
    compare(Rounding::Fused, Width::Eight, any_line);
}

#[test]
fn what_repeats_is_a_loop() {
    assert!(compare(Rounding::Separate, Width::One, repeating_line) >= 250);
    assert!(compare(Rounding::Fused, Width::Eight, repeating_line) >= 250);
}

/// The frame has places for all that a pause makes: callers write it although only a part is read.
#[test]
fn what_pauses_make_has_places_even_if_nothing_reads_it() {
    let pause = Step::Pause { arguments: vec![0], makes: 6 };
    let line = StraightLine { given: vec![None], steps: vec![pause, Step::Store { place: 0, value: 1 }], results: 1 };
    let Some(code) = Code::compile(&line, Rounding::Separate, Width::One) else { return };
    let pause = code.pause(0).expect("the line pauses once");
    assert_eq!(pause.makes, 6);
    assert!(code.places() >= pause.values + pause.makes, "{} places, {pause:?}", code.places());
}
