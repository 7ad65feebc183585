//! Numbers of the cranes of a fleet, the same number of each next to each other: number i of crane l of m is at `i m + l`.

/// Most fleets have as many cranes: loops over a constant number of them are unrolled.
const EIGHT: usize = 8;

/// `a · b` of each crane, of as many cranes as there are results.
pub(crate) fn dot(a: &[f64], b: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    add_dot(a, b, out);
}

/// Adds `a · b` of each crane.
pub(crate) fn add_dot(a: &[f64], b: &[f64], out: &mut [f64]) {
    match out.len() {
        1 => out[0] += a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>(),
        EIGHT => add_dot_of(EIGHT, a, b, out),
        cranes => add_dot_of(cranes, a, b, out),
    }
}

#[inline]
fn add_dot_of(cranes: usize, a: &[f64], b: &[f64], out: &mut [f64]) {
    let out = &mut out[..cranes];
    for (a, b) in a.chunks_exact(cranes).zip(b.chunks_exact(cranes)) {
        for (out, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
            *out += a * b;
        }
    }
}

/// Adds `factor a` of each crane, one factor for each.
pub(crate) fn add(factors: &[f64], a: &[f64], sum: &mut [f64]) {
    match factors.len() {
        1 => sum.iter_mut().zip(a).for_each(|(sum, a)| *sum += factors[0] * a),
        EIGHT => add_of(EIGHT, factors, a, sum),
        cranes => add_of(cranes, factors, a, sum),
    }
}

#[inline]
fn add_of(cranes: usize, factors: &[f64], a: &[f64], sum: &mut [f64]) {
    let factors = &factors[..cranes];
    for (sum, a) in sum.chunks_exact_mut(cranes).zip(a.chunks_exact(cranes)) {
        for (sum, (factor, a)) in sum.iter_mut().zip(factors.iter().zip(a)) {
            *sum += factor * a;
        }
    }
}

/// The numbers of a crane, of `cranes`.
#[inline]
pub(crate) fn of_crane(numbers: &[f64], crane: usize, cranes: usize) -> impl Iterator<Item = &f64> {
    numbers.iter().skip(crane).step_by(cranes)
}

/// The same, to be changed.
#[inline]
pub(crate) fn of_crane_mut(numbers: &mut [f64], crane: usize, cranes: usize) -> impl Iterator<Item = &mut f64> {
    numbers.iter_mut().skip(crane).step_by(cranes)
}

/// Copies the numbers of a crane from those of all.
#[inline]
pub(crate) fn gather(numbers: &[f64], crane: usize, cranes: usize, own: &mut [f64]) {
    own.iter_mut().zip(of_crane(numbers, crane, cranes)).for_each(|(own, number)| *own = *number);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole numbers: sums are exact in any order.
    #[test]
    fn sums_are_those_of_each_crane() {
        for cranes in [1, 3, 8] {
            let number = |i: usize| (i * i % 23) as f64 - 11.0;
            let [a, b]: [Vec<f64>; 2] = [0, 5].map(|first| (first..first + 4 * cranes).map(number).collect());
            let each = |crane: usize| of_crane(&a, crane, cranes).zip(of_crane(&b, crane, cranes));
            let expected: Vec<f64> = (0..cranes).map(|crane| each(crane).map(|(a, b)| a * b).sum()).collect();
            let mut sums = vec![f64::NAN; cranes];
            dot(&a, &b, &mut sums);
            assert_eq!(sums, expected);
            let mut moved = b.clone();
            add(&expected, &a, &mut moved);
            let expected = (0..4 * cranes).map(|i| b[i] + expected[i % cranes] * a[i]);
            assert!(moved.into_iter().eq(expected), "{cranes} cranes");
        }
    }
}
