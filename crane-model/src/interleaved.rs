//! Numbers of the cranes of a fleet, the same number of each next to each other: number i of crane l of m is at `i m + l`.

/// `a · b` of each crane, of as many cranes as there are results.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64], out: &mut [f64]) {
    if let [out] = out {
        *out = a.iter().zip(b).map(|(a, b)| a * b).sum();
        return;
    }
    out.fill(0.0);
    for (a, b) in a.chunks_exact(out.len()).zip(b.chunks_exact(out.len())) {
        for (out, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
            *out += a * b;
        }
    }
}

/// Adds `factor a` of each crane, one factor for each.
#[inline]
pub(crate) fn add(factors: &[f64], a: &[f64], sum: &mut [f64]) {
    if let [factor] = factors {
        return sum.iter_mut().zip(a).for_each(|(sum, a)| *sum += factor * a);
    }
    for (sum, a) in sum.chunks_exact_mut(factors.len()).zip(a.chunks_exact(factors.len())) {
        for (sum, (factor, a)) in sum.iter_mut().zip(factors.iter().zip(a)) {
            *sum += factor * a;
        }
    }
}

/// The numbers of a crane, of `cranes`.
pub(crate) fn of_crane(numbers: &[f64], crane: usize, cranes: usize) -> impl Iterator<Item = &f64> {
    numbers.iter().skip(crane).step_by(cranes)
}
