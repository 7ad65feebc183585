//! Code in situations that are not everyday ones: called by several threads, with slices that are too short, for lines that are too
//! large.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crane_jit::{Code, Rounding, Step, StraightLine, Width};

/// `x ← x y + x`, so often that a thread is interrupted in between.
const STEPS: u32 = 2000;

fn line(index: u32) -> StraightLine {
    let last = 2 + STEPS - 1;
    let steps = (0..STEPS).map(|at| Step::MulAdd([if at == 0 { 0 } else { at + 1 }, 1, 0]));
    StraightLine {
        given: vec![None; 2],
        steps: steps.chain([Step::Store { place: index, value: last }]).collect(),
        results: 1,
    }
}

fn expected(x: f64, y: f64) -> f64 {
    (0..STEPS).fold(x, |value, _| value * y + x)
}

#[test]
fn threads_share_code() {
    let Some(code) = Code::compile(&line(0), Rounding::Separate, Width::One) else { return };
    let code = &code;
    std::thread::scope(|scope| {
        for thread in 0..8 {
            scope.spawn(move || {
                let mut frame = vec![0.0; code.places().max(2)];
                for call in 0..500 {
                    let (x, y) = (1.0 + f64::from(thread), 0.5 + 1e-4 * f64::from(call));
                    frame[..2].copy_from_slice(&[x, y]);
                    code.numbers().for_each(|(index, number)| frame[index] = number);
                    let mut result = [f64::NAN];
                    code.run(0, &mut frame, &mut result);
                    assert_eq!(result[0].to_bits(), expected(x, y).to_bits(), "thread {thread}, call {call}");
                }
            });
        }
    });
}

#[test]
fn slices_that_are_too_short_are_refused() {
    for width in [Width::One, Width::Eight] {
        let Some(code) = Code::compile(&line(0), Rounding::Separate, width) else { continue };
        let numbers = width.numbers();
        let run = |places: usize, results: usize| {
            let (mut frame, mut results) = (vec![0.0; places], vec![0.0; results]);
            catch_unwind(AssertUnwindSafe(|| code.run(0, &mut frame, &mut results))).is_ok()
        };
        let places = code.places() * numbers;
        assert!(run(places, numbers), "{width:?}");
        assert!(!run(places - 1, numbers), "{width:?}: a frame that is too short");
        assert!(!run(places, numbers - 1), "{width:?}: results that are too few");
    }
}

/// Displacements have 32 bits or fewer: a result further away would be written elsewhere.
#[test]
fn results_beyond_displacements_have_no_code() {
    for index in [1 << 20, 1 << 25, 1 << 28, 1 << 29, u32::MAX] {
        for width in [Width::One, Width::Eight] {
            assert!(Code::compile(&line(index), Rounding::Separate, width).is_none(), "{width:?}, {index}");
        }
    }
}
