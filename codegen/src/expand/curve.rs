//! Curves through a table of positions, in cubic pieces.

use crate::chain::Segment;

/// Cubic spline through `(times, values)`, twice continuously differentiable inside, at rest at both ends.
///
/// The slopes v solve the tridiagonal system of continuous curvature, with `h_i = t_{i+1} − t_i`:
/// `v_{i−1}/h_{i−1} + 2(1/h_{i−1} + 1/h_i) v_i + v_{i+1}/h_i = 3(Δ_{i−1}/h_{i−1}² + Δ_i/h_i²)`, `v_0 = v_n = 0`.
pub(crate) fn spline(times: &[f64], values: &[f64]) -> Vec<Segment> {
    let pieces = times.len().saturating_sub(1);
    let (h, rise) = (differences(times), differences(values));
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
    through(times, values, &slopes)
}

/// Cubic pieces through `(times, values)` that rise and fall only where the values do, at rest at both ends and where the values turn: between two
/// points, the curve never leaves their range. Its rate is continuous.
///
/// Between two rises of one sign, the slope is the harmonic mean of theirs, weighted with `w₁ = 2 h_i + h_{i−1}`, `w₂ = h_i + 2 h_{i−1}`:
/// `(w₁ + w₂)/v_i = w₁ h_{i−1}/Δ_{i−1} + w₂ h_i/Δ_i`; otherwise 0. F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300, whose
/// pieces are those of `pchip` in MATLAB and `SciPy` except for the ends; that slopes of at most thrice the smaller mean rise suffice:
/// F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238.
pub(crate) fn monotone(times: &[f64], values: &[f64]) -> Vec<Segment> {
    let pieces = times.len().saturating_sub(1);
    let (h, rise) = (differences(times), differences(values));
    let slope = |i: usize| {
        if i == 0 || i == pieces || rise[i - 1] * rise[i] <= 0.0 {
            return 0.0;
        }
        let (before, after) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
        (before + after) / (before * h[i - 1] / rise[i - 1] + after * h[i] / rise[i])
    };
    through(times, values, &(0..=pieces).map(slope).collect::<Vec<_>>())
}

/// Straight pieces through `(times, values)`: the rate jumps at all points.
pub(crate) fn linear(times: &[f64], values: &[f64]) -> Vec<Segment> {
    let pieces = times.iter().zip(differences(times)).zip(differences(values));
    pieces
        .map(|((begin, h), rise)| Segment { begin: *begin, duration: h, coefficients: [rise / h, 0.0, 0.0] })
        .collect()
}

fn differences(numbers: &[f64]) -> Vec<f64> {
    numbers.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// The cubic pieces through points with given slopes (Hermite).
fn through(times: &[f64], values: &[f64], slopes: &[f64]) -> Vec<Segment> {
    let pieces = times.iter().zip(differences(times)).zip(differences(values)).zip(slopes.windows(2));
    let piece = |(((begin, h), rise), slopes): (((&f64, f64), f64), &[f64])| {
        let (mean, start, end) = (rise / h, slopes[0], slopes[1]);
        let quadratic = (3.0 * mean - 2.0 * start - end) / h;
        let cubic = (start + end - 2.0 * mean) / (h * h);
        Segment { begin: *begin, duration: h, coefficients: [start, quadratic, cubic] }
    };
    pieces.map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::first_jump;

    #[test]
    fn a_spline_passes_through_its_points_and_is_smooth() {
        let times = [0.0, 1.0, 1.5, 4.0, 5.0];
        let values = [0.2, 1.0, -0.5, 0.7, 0.7];
        let segments = spline(&times, &values);
        let mut position = values[0];
        let (mut slope, mut curvature) = (0.0, None);
        for (segment, value) in segments.iter().zip(&values[1..]) {
            let ([c1, c2, c3], u) = (segment.coefficients, segment.duration);
            // Position, slope and curvature continue those of the previous piece, up to rounding of numbers of order 10.
            assert!((c1 - slope).abs() < 1e-13);
            assert!(curvature.is_none_or(|k: f64| (k - 2.0 * c2).abs() < 1e-12));
            position += segment.rise(u);
            assert!((position - value).abs() < 1e-13);
            slope = segment.slope(u);
            curvature = Some(2.0 * c2 + 6.0 * u * c3);
        }
        assert!(slope.abs() < 1e-13, "at rest at the end: {slope:e}");
    }

    #[test]
    fn two_points_make_the_cubic_ramp() {
        for curve in [spline, monotone] {
            let [segment] = curve(&[1.0, 3.0], &[0.0, 4.0])[..] else { panic!("one piece") };
            // 4(3τ² − 2τ³), τ = u/2
            assert_eq!(segment, Segment { begin: 1.0, duration: 2.0, coefficients: [0.0, 3.0, -1.0] });
        }
    }

    /// Tables with steps, turns, plateaus and uneven times: all of the curve is between the points around it, where a spline leaves by up to 60 times.
    #[test]
    fn a_monotone_curve_stays_between_its_points() {
        let times = [0.0, 1.0, 1.01, 2.0, 5.0, 5.5, 9.0];
        let tables: [[f64; 7]; 5] = [
            [0.0, 0.0, 0.3, 0.3, 0.3, 0.3, 0.3],
            [0.0, 500.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            [3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0],
            [0.0, 1e-6, 1.0, 1.0, 1e3, 1e3, 0.0],
        ];
        let mut left = 0;
        for values in tables {
            let leaves = |segments: &[Segment]| {
                values.windows(2).zip(segments).any(|(pair, segment)| {
                    let (low, high) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
                    let rounding = 1e-12 * (high.abs() + low.abs());
                    let along = (0..=1000).map(|k| pair[0] + segment.rise(f64::from(k) / 1000.0 * segment.duration));
                    let reached = along.chain(segment.extremes().into_iter().map(|rise| pair[0] + rise));
                    reached.into_iter().any(|x| x < low - rounding || x > high + rounding)
                })
            };
            assert!(!leaves(&monotone(&times, &values)) && !leaves(&linear(&times, &values)), "{values:?}");
            left += usize::from(leaves(&spline(&times, &values)));
        }
        assert!(left >= 4, "{left}");
    }

    /// By `SciPy`: `PchipInterpolator([0, 1, 3, 4], [0, 2, 3, 3]).derivative()` at the two points between.
    #[test]
    fn slopes_between_are_those_of_pchip() {
        let segments = monotone(&[0.0, 1.0, 3.0, 4.0], &[0.0, 2.0, 3.0, 3.0]);
        assert!((segments[1].coefficients[0] - 6.0 / 7.0).abs() < 1e-15, "{segments:?}");
        assert_eq!(segments[2].coefficients[0], 0.0);
        assert_eq!((segments[0].coefficients[0], segments[2].slope(1.0)), (0.0, 0.0));
    }

    #[test]
    fn rates_jump_only_where_pieces_are_straight() {
        let (times, values) = ([0.0, 1.0, 2.5, 3.0], [0.0, 1.0, 1.5, 4.0]);
        assert_eq!(first_jump(&linear(&times, &values)), Some(1.0));
        assert_eq!([first_jump(&spline(&times, &values)), first_jump(&monotone(&times, &values))], [None, None]);
    }
}
