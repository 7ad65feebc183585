//! Sines and cosines within a line of operations, instead of pauses: those of [`crane_model::rt::sin_cos_lanes`], with the same bits.
//!
//! The quarter turn of an angle, an integer there, is a number here: of n quarter turns, `r = n/4 − round(n/4)` is 0, ¼, ±½ or −¼, and products
//! that are positive for some of these choose between sine and cosine and their signs. The last pause reads the sum of all squares of angles: if it is
//! larger than [`MOST`], or NaN, an angle may be too large, and the results do not count.

use crane_jit::{Step, StraightLine, Value, value};
use crane_model::rt::sines::{COSINE, HALF_PI, LARGEST, ROUND, SINE};

use crate::bytecode::Kind;

/// The largest sum of squares of angles, rad².
pub const MOST: f64 = LARGEST * LARGEST;

/// Numbers that sines and cosines need besides coefficients of polynomials.
const PLAIN: [f64; 11] = [-0.0, 1.0, -1.0, 0.5, 0.25, 0.125, 0.375, std::f64::consts::FRAC_2_PI, ROUND, 0.0, -SINE[0]];

/// The line with the sines and cosines of its pauses, and what its other pauses compute. Given values are followed by numbers. Without sines there is no
/// last pause.
pub fn with_sines(line: &StraightLine, pauses: &[Kind]) -> (StraightLine, Vec<Kind>) {
    let numbers: Vec<f64> = [&PLAIN[..], &HALF_PI.map(|part| -part), &SINE, &COSINE].concat();
    let given = line.given.iter().copied().chain(numbers.iter().copied().map(Some)).collect::<Vec<_>>();
    let mut writer = SineWriter {
        of: (0..line.given.len()).map(value).collect(),
        numbers: (numbers, line.given.len()),
        count: given.len(),
        squares: None,
        line: StraightLine { given, steps: vec![], results: line.results },
    };
    let mut others = Vec::new();
    let mut pauses = pauses.iter().copied();
    for step in &line.steps {
        match step {
            Step::Pause { arguments, makes } => match pauses.next() {
                Some(Kind::Angle) => writer.angles(arguments),
                kind => {
                    others.extend(kind);
                    let arguments = writer.all(arguments);
                    writer.line.steps.push(Step::Pause { arguments, makes: *makes });
                    for _ in 0..*makes {
                        writer.of.push(value(writer.count));
                        writer.count += 1;
                    }
                }
            },
            Step::Store { place: index, value } => {
                let value = writer.of[*value as usize];
                writer.line.steps.push(Step::Store { place: *index, value });
            }
            step => {
                let moved = writer.moved(step);
                let made = writer.push(moved);
                writer.of.push(made);
            }
        }
    }
    if let Some(squares) = writer.squares {
        writer.line.steps.push(Step::Pause { arguments: vec![squares], makes: 0 });
    }
    (writer.line, others)
}

/// A line under construction.
struct SineWriter {
    /// Each value of the line with pauses.
    of: Vec<Value>,
    /// Numbers, and the place of the first.
    numbers: (Vec<f64>, usize),
    /// The number of values.
    count: usize,
    /// The sum of the squares of all angles.
    squares: Option<Value>,
    line: StraightLine,
}

impl SineWriter {
    fn push(&mut self, step: Step) -> Value {
        self.line.steps.push(step);
        self.count += 1;
        value(self.count - 1)
    }

    fn all(&self, values: &[Value]) -> Vec<Value> {
        values.iter().map(|value| self.of[*value as usize]).collect()
    }

    /// A step that makes one value, of the values of this line.
    fn moved(&self, step: &Step) -> Step {
        let of = |value: &Value| self.of[*value as usize];
        match step {
            Step::MulAdd(operands) => Step::MulAdd(operands.each_ref().map(of)),
            Step::Select(operands) => Step::Select(operands.each_ref().map(of)),
            Step::Div(operands) => Step::Div(operands.each_ref().map(of)),
            Step::Min(operands) => Step::Min(operands.each_ref().map(of)),
            Step::Max(operands) => Step::Max(operands.each_ref().map(of)),
            Step::Sqrt(a) => Step::Sqrt(of(a)),
            Step::Store { .. } | Step::Pause { .. } => step.clone(),
        }
    }

    /// One of the numbers.
    fn number(&self, number: f64) -> Value {
        let (numbers, first) = &self.numbers;
        let place = numbers.iter().position(|known| known.to_bits() == number.to_bits());
        value(first + place.expect("a number of the list"))
    }

    /// `a b + c`
    fn fma(&mut self, a: Value, b: Value, c: Value) -> Value {
        self.push(Step::MulAdd([a, b, c]))
    }

    fn product(&mut self, a: Value, b: Value) -> Value {
        self.fma(a, b, self.number(-0.0))
    }

    fn sum(&mut self, a: Value, b: Value) -> Value {
        self.fma(a, self.number(1.0), b)
    }

    fn negative(&mut self, a: Value) -> Value {
        self.product(a, self.number(-1.0))
    }

    fn difference(&mut self, a: Value, b: Value) -> Value {
        self.fma(b, self.number(-1.0), a)
    }

    /// `a` rounded to an integer.
    fn rounded(&mut self, a: Value) -> Value {
        let shifted = self.sum(a, self.number(ROUND));
        self.difference(shifted, self.number(ROUND))
    }

    /// `c₀ + c₁ z + …` by Horner's rule.
    fn polynomial(&mut self, z: Value, coefficients: &[f64]) -> Value {
        let mut coefficients = coefficients.iter().rev();
        let highest = self.number(coefficients.next().copied().unwrap_or_default());
        coefficients.fold(highest, |sum, c| self.fma(sum, z, self.number(*c)))
    }

    /// `x − n π/2` and what its rounding lost.
    fn reduced(&mut self, x: Value, n: Value) -> [Value; 2] {
        let [first, second, third, rest] = HALF_PI.map(|part| self.number(-part));
        let y = self.fma(n, first, x);
        let (before, y) = (y, self.fma(n, second, y));
        let difference = self.difference(before, y);
        let lost = self.fma(n, second, difference);
        let (before, y) = (y, self.fma(n, third, y));
        let difference = self.difference(before, y);
        let of_third = self.fma(n, third, difference);
        let lost = self.sum(lost, of_third);
        let lost = self.fma(n, rest, lost);
        let sum = self.sum(y, lost);
        let difference = self.difference(y, sum);
        [sum, self.sum(difference, lost)]
    }

    /// `sin(y + tail)`
    fn sine(&mut self, [y, tail]: [Value; 2], z: Value) -> Value {
        let cubed = self.product(z, y);
        let higher = self.polynomial(z, &SINE[1..]);
        let product = self.product(cubed, higher);
        let product = self.negative(product);
        let half = self.fma(tail, self.number(0.5), product);
        let minus_tail = self.negative(tail);
        let correction = self.fma(z, half, minus_tail);
        let correction = self.fma(cubed, self.number(-SINE[0]), correction);
        self.difference(y, correction)
    }

    /// `cos(y + tail)`
    fn cosine(&mut self, [y, tail]: [Value; 2], z: Value) -> Value {
        let half = self.product(z, self.number(0.5));
        let leading = self.difference(self.number(1.0), half);
        let higher = self.polynomial(z, &COSINE);
        let higher = self.product(z, higher);
        let product = self.product(y, tail);
        let product = self.negative(product);
        let higher = self.fma(z, higher, product);
        let rest = self.difference(self.number(1.0), leading);
        let rest = self.difference(rest, half);
        let rest = self.sum(rest, higher);
        self.sum(leading, rest)
    }

    /// `±a`, with a plus where `(r + low) (high − r)` is positive.
    fn signed(&mut self, a: Value, r: Value, [low, high]: [f64; 2]) -> Value {
        let above = self.sum(r, self.number(low));
        let below = self.difference(self.number(high), r);
        let product = self.product(above, below);
        let sign = self.push(Step::Select([product, self.number(1.0), self.number(-1.0)]));
        self.product(a, sign)
    }

    /// The sine and the cosine of an angle below [`LARGEST`].
    fn sine_and_cosine(&mut self, x: Value) -> [Value; 2] {
        let shifted = self.fma(x, self.number(std::f64::consts::FRAC_2_PI), self.number(ROUND));
        let n = self.difference(shifted, self.number(ROUND));
        let reduced = self.reduced(x, n);
        let z = self.product(reduced[0], reduced[0]);
        let (sine, cosine) = (self.sine(reduced, z), self.cosine(reduced, z));
        let quarters = self.product(n, self.number(0.25));
        let whole = self.rounded(quarters);
        let r = self.difference(quarters, whole);
        // Positive for odd n, r = ±¼; zero for others.
        let square = self.product(r, r);
        let other = self.difference(self.number(0.25), square);
        let odd = self.product(square, other);
        let of_sine = self.push(Step::Select([odd, cosine, sine]));
        let of_cosine = self.push(Step::Select([odd, sine, cosine]));
        // Sines are positive for r = 0 and ¼, cosines for −¼ and 0.
        [self.signed(of_sine, r, [0.125, 0.375]), self.signed(of_cosine, r, [0.375, 0.125])]
    }

    /// A pause: all sines, then all cosines.
    fn angles(&mut self, angles: &[Value]) {
        let angles = self.all(angles);
        let mut all = Vec::with_capacity(angles.len());
        for angle in angles {
            let before = self.squares.unwrap_or(self.number(0.0));
            self.squares = Some(self.fma(angle, angle, before));
            all.push(self.sine_and_cosine(angle));
        }
        self.of.extend(all.iter().map(|[sine, _]| sine));
        self.of.extend(all.iter().map(|[_, cosine]| cosine));
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use crane_jit::{Code, Width};
    use crane_model::rt::lanes::f64x8;
    use crane_model::rt::sin_cos_lanes;

    use super::*;
    use crate::bytecode::ROUNDING;

    #[test]
    fn sines_in_a_line_have_the_bits_of_the_runtime() {
        let steps = [Step::Pause { arguments: vec![0], makes: 2 }];
        let stores = (0..2).map(|index| Step::Store { place: index, value: index + 1 });
        let line = StraightLine { given: vec![None], steps: steps.into_iter().chain(stores).collect(), results: 2 };
        let (line, others) = with_sines(&line, &[Kind::Angle]);
        assert!(others.is_empty(), "no other pause");
        let Some(code) = Code::compile(&line, ROUNDING, Width::Eight) else { return };
        let mut frame = vec![f64x8::splat(0.0); code.places().max(line.given.len())];
        let numbers = line.given.iter().enumerate().filter_map(|(index, number)| Some((index, (*number)?)));
        numbers.chain(code.numbers()).for_each(|(index, number)| frame[index] = f64x8::splat(number));
        let mut compared = 0;
        for k in -40_000_i32..40_000 {
            // Multiples of an eighth turn, their neighbours, and angles up to the largest.
            let eighths = f64::from(k) * std::f64::consts::FRAC_PI_4;
            let far = (f64::from(k) / 40_000.0).powi(3) * 0.999 * LARGEST;
            let angles =
                [eighths, eighths.next_up(), eighths.next_down(), 0.01 * eighths, 1e-9 * eighths, far, -far, 0.0];
            frame[0] = f64x8::new(angles);
            let mut results = [f64x8::splat(f64::NAN); 2];
            code.run(0, wide::bytemuck::cast_slice_mut(&mut frame), wide::bytemuck::cast_slice_mut(&mut results));
            code.run(1, wide::bytemuck::cast_slice_mut(&mut frame), wide::bytemuck::cast_slice_mut(&mut results));
            let ([sine], [cosine]) = sin_cos_lanes([frame[0]]);
            for (lane, angle) in angles.iter().enumerate() {
                for (own, expected) in results.iter().zip([sine, cosine]) {
                    let [own, expected] = [own, &expected].map(|number| number.as_array()[lane]);
                    assert!(own == expected, "of {angle:e}: {own:e} instead of {expected:e}");
                    compared += 1;
                }
            }
        }
        assert_eq!(compared, 80_000 * 16);
    }
}
