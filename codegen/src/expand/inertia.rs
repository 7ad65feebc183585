//! Mass properties as pseudo-inertias, `H = ∫ r rᵀ dm`, about the origin of the body's frame.

use crate::chain::{Inertia, Value};

/// Elements of an inertia tensor, `[Ixx, Iyy, Izz, Ixy, Ixz, Iyz]`, kg m².
pub(crate) type Tensor = [Value; 6];

/// Tensor of radii of gyration, `I = m k²`.
pub(crate) fn gyration(mass: &Value, radii: &[Value; 3]) -> Tensor {
    let moment = |k: &Value| mass.clone() * (k.clone() * k.clone());
    [moment(&radii[0]), moment(&radii[1]), moment(&radii[2]), Value::ZERO, Value::ZERO, Value::ZERO]
}

/// Pseudo-inertia of a body whose tensor is about its centre of mass, by the parallel axis theorem with `m c cᵀ`.
pub(crate) fn about_com(mass: Value, com: &[Value; 3], tensor: &Tensor) -> Inertia {
    let shift = point(mass, com);
    let central = planar_moments(tensor);
    Inertia { second: std::array::from_fn(|k| central[k].clone() + shift.second[k].clone()), ..shift }
}

/// Pseudo-inertia of a body whose tensor is about the origin of its frame.
pub(crate) fn about_origin(mass: Value, com: &[Value; 3], tensor: &Tensor) -> Inertia {
    Inertia { second: planar_moments(tensor), ..point(mass, com) }
}

/// Pseudo-inertia of a point mass.
pub(crate) fn point(mass: Value, com: &[Value; 3]) -> Inertia {
    let first: [Value; 3] = std::array::from_fn(|k| mass.clone() * com[k].clone());
    let second = PAIRS.map(|(i, j)| first[i].clone() * com[j].clone());
    Inertia { mass, first, second }
}

/// Pseudo-inertia of two bodies that move as one.
pub(crate) fn sum(a: Inertia, b: Inertia) -> Inertia {
    let ([x, y, z], [xx, yy, zz, xy, xz, yz]) = (a.first, a.second);
    let ([u, v, w], [uu, vv, ww, uv, uw, vw]) = (b.first, b.second);
    Inertia {
        mass: a.mass + b.mass,
        first: [x + u, y + v, z + w],
        second: [xx + uu, yy + vv, zz + ww, xy + uv, xz + uw, yz + vw],
    }
}

/// Axes of the six second moments.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// `∫x² = ½(−Ixx + Iyy + Izz)` …, `∫xy = −Ixy` …
fn planar_moments([xx, yy, zz, xy, xz, yz]: &Tensor) -> [Value; 6] {
    let planar = |axial: &Value, a: &Value, b: &Value| 0.5 * (a.clone() + b.clone() - axial.clone());
    [planar(xx, yy, zz), planar(yy, xx, zz), planar(zz, xx, yy), -xy.clone(), -xz.clone(), -yz.clone()]
}

/// Tensor about the centre of mass, from a tensor about the origin: the inverse of the parallel axis theorem.
pub(crate) fn tensor_at_com(mass: &Value, com: &[Value; 3], tensor: &Tensor) -> Tensor {
    let product = |i: usize, j: usize| com[i].clone() * com[j].clone();
    let square = product(0, 0) + product(1, 1) + product(2, 2);
    std::array::from_fn(|k| {
        let (i, j) = PAIRS[k];
        let shift = if i == j { square.clone() - product(i, i) } else { -product(i, j) };
        tensor[k].clone() - mass.clone() * shift
    })
}

/// Leading principal minors of a tensor: all are above zero if and only if it is positive definite (Sylvester).
pub(crate) fn leading_minors([xx, yy, zz, xy, xz, yz]: Tensor) -> [Value; 3] {
    let of_two = xx.clone() * yy.clone() - xy.clone() * xy.clone();
    let determinant = of_two.clone() * zz + 2.0 * (xy * xz.clone() * yz.clone())
        - xx.clone() * (yz.clone() * yz)
        - yy * (xz.clone() * xz);
    [xx, of_two, determinant]
}

/// `I − ε tr(I) 1`: positive definite if the smallest principal moment is above a fraction ε of their sum.
pub(crate) fn definite_margin(tensor: &Tensor, share: f64) -> Tensor {
    with_trace(tensor, -share, 1.0)
}

/// `(1 + τ) tr(I) 1 − (2 + τ) I`: positive definite if no principal moment exceeds the sum of the other two by a fraction τ.
pub(crate) fn triangle_margin(tensor: &Tensor, share: f64) -> Tensor {
    with_trace(tensor, 1.0 + share, -2.0 - share)
}

/// `a tr(I) 1 + b I`
fn with_trace(tensor: &Tensor, a: f64, b: f64) -> Tensor {
    let trace = tensor[0].clone() + tensor[1].clone() + tensor[2].clone();
    std::array::from_fn(|k| {
        let scaled = b * tensor[k].clone();
        if k < 3 { a * trace.clone() + scaled } else { scaled }
    })
}

/// Principal moments of a tensor, ascending.
pub(crate) fn principal_moments(tensor: [f64; 6]) -> [f64; 3] {
    let mut moments = principal_axes(tensor).map(|(moment, _)| moment);
    moments.sort_by(f64::total_cmp);
    moments
}

/// Principal moments of a tensor with the unit vectors of their axes, by Jacobi's rotations.
pub(crate) fn principal_axes([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> [(f64, [f64; 3]); 3] {
    /// Jacobi's method converges quadratically: for three by three, six sweeps reach rounding; two more are a margin.
    const SWEEPS: usize = 8;
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(3 * SWEEPS) {
        if a[p][q] == 0.0 {
            continue;
        }
        let half_cot = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        let tan = half_cot.signum() / (half_cot.abs() + half_cot.hypot(1.0));
        let cos = 1.0 / tan.hypot(1.0);
        let sin = tan * cos;
        for k in 0..3 {
            (a[k][p], a[k][q]) = (cos * a[k][p] - sin * a[k][q], sin * a[k][p] + cos * a[k][q]);
        }
        for k in 0..3 {
            (a[p][k], a[q][k]) = (cos * a[p][k] - sin * a[q][k], sin * a[p][k] + cos * a[q][k]);
            (axes[p][k], axes[q][k]) = (cos * axes[p][k] - sin * axes[q][k], sin * axes[p][k] + cos * axes[q][k]);
        }
    }
    [0, 1, 2].map(|k| (a[k][k], axes[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers<const N: usize>(values: [f64; N]) -> [Value; N] {
        values.map(Value::from)
    }

    #[test]
    fn parallel_axes_shift_a_brick() {
        // A 2 × 4 × 6 m brick of 12 kg with a corner at the origin: ∫x² = m a²/3, ∫xy = m ab/4.
        let (mass, [a, b, c]) = (12.0, [2.0, 4.0, 6.0]);
        let tensor = numbers([b * b + c * c, a * a + c * c, a * a + b * b, 0.0, 0.0, 0.0]);
        let brick = about_com(mass.into(), &numbers([a / 2.0, b / 2.0, c / 2.0]), &tensor);
        assert_eq!(brick.first, numbers([12.0, 24.0, 36.0]));
        assert_eq!(brick.second, numbers([16.0, 64.0, 144.0, 24.0, 36.0, 72.0]));

        // The same about the corner, where the products of the tensor are negative.
        let corner = numbers([64.0 + 144.0, 16.0 + 144.0, 16.0 + 64.0, -24.0, -36.0, -72.0]);
        assert_eq!(about_origin(mass.into(), &numbers([1.0, 2.0, 3.0]), &corner), brick);
        let origin = numbers([208.0, 160.0, 80.0, -24.0, -36.0, -72.0]);
        let back = tensor_at_com(&mass.into(), &numbers([1.0, 2.0, 3.0]), &origin);
        assert_eq!(back, tensor);
    }

    #[test]
    fn minors_agree_with_principal_moments() {
        for tensor in [
            [1.0, 2.0, 2.5, 0.0, 0.0, 0.0],
            [1.0, 2.0, 3.2, 0.0, 0.0, 0.0],
            [1.0, 2.0, 3.8, 0.0, 0.0, 0.0],
            [4.0, 2.0, 3.0, 1.0, -0.5, 0.3],
            [4.0, 2.0, 3.0, 2.8, -0.5, 0.3],
            [4.0, 2.0, 3.0, 3.0, -0.5, 0.3],
            [-1.0, 2.0, 2.0, 0.0, 0.0, 0.0],
        ] {
            let [smallest, middle, largest] = principal_moments(tensor);
            let positive = |tensor: &Tensor| leading_minors(tensor.clone()).iter().all(|minor| minor.at(&[]) > 0.0);
            assert_eq!(positive(&numbers(tensor)), smallest > 0.0, "{tensor:?}");
            let margin = triangle_margin(&numbers(tensor), 0.25);
            assert_eq!(positive(&margin), largest < 1.25 * (smallest + middle), "{tensor:?}");
        }
    }

    #[test]
    fn gyration_follows_the_mass() {
        let tensor = gyration(&500.0.into(), &numbers([0.148_324, 1.159_310, 1.159_310]));
        // The radii are written to six digits.
        for (value, expected) in tensor.iter().zip([11.0, 672.0, 672.0]) {
            assert!((value.at(&[]) / expected - 1.0).abs() < 1e-5, "{value:?}");
        }
    }

    #[test]
    fn principal_moments_of_a_turned_tensor() {
        // diag(1, 2, 5) turned by 30° about z, then the axes relabelled.
        let (s, c) = (0.5, 0.75f64.sqrt());
        let (xx, yy, xy) = (c * c + 2.0 * s * s, s * s + 2.0 * c * c, -s * c);
        for tensor in [[xx, yy, 5.0, xy, 0.0, 0.0], [5.0, xx, yy, 0.0, 0.0, xy], [xx, 5.0, yy, 0.0, xy, 0.0]] {
            for (moment, expected) in principal_moments(tensor).iter().zip([1.0, 2.0, 5.0]) {
                assert!((moment - expected).abs() < 1e-14, "{tensor:?}: {moment}");
            }
        }
    }
}
