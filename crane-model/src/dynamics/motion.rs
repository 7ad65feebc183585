//! Sums of motions.

/// `y += a x`, in a plain loop that compiles to vector instructions.
#[inline]
pub(super) fn add(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// `y += scale Σ factor · term`
#[inline]
pub(super) fn add_all<'a>(y: &mut [f64], scale: f64, factors: &[f64], terms: impl IntoIterator<Item = &'a Vec<f64>>) {
    for (factor, term) in factors.iter().zip(terms) {
        let factor = factor * scale;
        if factor != 0.0 {
            add(y, factor, term);
        }
    }
}
