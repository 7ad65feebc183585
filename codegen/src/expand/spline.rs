//! Cubic splines through a table of positions.

use crate::chain::Segment;

/// Cubic spline through `(times, values)`, twice continuously differentiable inside, at rest at both ends.
///
/// The slopes v solve the tridiagonal system of continuous curvature, with `h_i = t_{i+1} − t_i`:
/// `v_{i−1}/h_{i−1} + 2(1/h_{i−1} + 1/h_i) v_i + v_{i+1}/h_i = 3(Δ_{i−1}/h_{i−1}² + Δ_i/h_i²)`, `v_0 = v_n = 0`.
pub(crate) fn clamped(times: &[f64], values: &[f64]) -> Vec<Segment> {
    let pieces = times.len().saturating_sub(1);
    let h: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).collect();
    let rise: Vec<f64> = values.windows(2).map(|x| x[1] - x[0]).collect();
    // Elimination from the left: v_i = offset_i − factor_i v_{i+1}.
    let (mut factor, mut offset) = (vec![0.0; pieces + 1], vec![0.0; pieces + 1]);
    for i in 1..pieces {
        let right = 3.0 * (rise[i - 1] / (h[i - 1] * h[i - 1]) + rise[i] / (h[i] * h[i]));
        let pivot = 2.0 * (1.0 / h[i - 1] + 1.0 / h[i]) - factor[i - 1] / h[i - 1];
        factor[i] = 1.0 / (h[i] * pivot);
        offset[i] = (right - offset[i - 1] / h[i - 1]) / pivot;
    }
    let mut slopes = vec![0.0; pieces + 1];
    for i in (1..pieces).rev() {
        slopes[i] = offset[i] - factor[i] * slopes[i + 1];
    }
    (0..pieces)
        .map(|i| {
            let (mean, start, end) = (rise[i] / h[i], slopes[i], slopes[i + 1]);
            let quadratic = (3.0 * mean - 2.0 * start - end) / h[i];
            let cubic = (start + end - 2.0 * mean) / (h[i] * h[i]);
            Segment { begin: times[i], duration: h[i], coefficients: [start, quadratic, cubic] }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_its_points_and_is_smooth() {
        let times = [0.0, 1.0, 1.5, 4.0, 5.0];
        let values = [0.2, 1.0, -0.5, 0.7, 0.7];
        let segments = clamped(&times, &values);
        let mut position = values[0];
        let (mut slope, mut curvature) = (0.0, None);
        for (segment, value) in segments.iter().zip(&values[1..]) {
            let ([c1, c2, c3], u) = (segment.coefficients, segment.duration);
            // Position, slope and curvature continue those of the previous piece, up to rounding of numbers of order 10.
            assert!((c1 - slope).abs() < 1e-13);
            assert!(curvature.is_none_or(|k: f64| (k - 2.0 * c2).abs() < 1e-12));
            position += u * (c1 + u * (c2 + u * c3));
            assert!((position - value).abs() < 1e-13);
            slope = c1 + u * (2.0 * c2 + 3.0 * u * c3);
            curvature = Some(2.0 * c2 + 6.0 * u * c3);
        }
        assert!(slope.abs() < 1e-13, "at rest at the end: {slope:e}");
    }

    #[test]
    fn two_points_make_the_cubic_ramp() {
        let [segment] = clamped(&[1.0, 3.0], &[0.0, 4.0])[..] else { panic!("one piece") };
        // 4(3τ² − 2τ³), τ = u/2
        assert_eq!(segment, Segment { begin: 1.0, duration: 2.0, coefficients: [0.0, 3.0, -1.0] });
    }
}
