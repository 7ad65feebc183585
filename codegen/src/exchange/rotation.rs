//! Rotations as other programs describe them.

use crate::chain::{Frame, Value, Vector};

/// Roll, pitch and yaw of a frame, `Rz(yaw) Ry(pitch) Rx(roll)`, rad.
///
/// Pitch and roll are computed from the frame rotated back by the yaw, so that they are correct for any yaw
/// if the pitch is a quarter turn, where only a combination of yaw and roll is determined.
pub(super) fn roll_pitch_yaw(frame: &Frame) -> Vector {
    let [x, y, z] = frame.axes;
    // Yaw is arbitrary if x points along the third axis to rounding: then it is set to zero.
    let yaw = if x[0].hypot(x[1]) > 1e-14 { x[1].atan2(x[0]) } else { 0.0 };
    let (sin, cos) = yaw.sin_cos();
    let pitch = (-x[2]).atan2(cos * x[0] + sin * x[1]);
    let roll = (sin * z[0] - cos * z[1]).atan2(cos * y[1] - sin * y[0]);
    [roll, pitch, yaw]
}

/// Unit quaternion `(w, x, y, z)` of a frame, from its largest component [Shepperd 1978].
pub(super) fn quaternion(frame: &Frame) -> [f64; 4] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = frame.axes;
    // Each is four times the square of a component.
    let squares = [1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz];
    let products = [
        [squares[0], yz - zy, zx - xz, xy - yx],
        [yz - zy, squares[1], xy + yx, zx + xz],
        [zx - xz, xy + yx, squares[2], yz + zy],
        [xy - yx, zx + xz, yz + zy, squares[3]],
    ];
    let largest = (0..4).max_by(|&a, &b| squares[a].total_cmp(&squares[b])).unwrap_or(0);
    let row = products[largest];
    let size = row.iter().map(|component| component * component).sum::<f64>().sqrt();
    let sign = if row[0] < 0.0 { -size } else { size };
    row.map(|component| component / sign)
}

/// A frame with its z axis along a direction, by the shortest rotation; of directions with z < 0, from a half turn about x.
pub(super) fn along_z(direction: Vector) -> Frame {
    let size = length(direction);
    let [a, b, c] = direction.map(|component| component / size);
    if c < 0.0 {
        // Half a turn about x first, so that the rest is less than a quarter.
        let rest = along_z([a, -b, -c]);
        let half = Frame { axes: [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]], origin: [0.0; 3] };
        return half.outer(&rest);
    }
    let share = 1.0 / (1.0 + c);
    let axes = [[1.0 - a * a * share, -a * b * share, -a], [-a * b * share, 1.0 - b * b * share, -b], [a, b, c]];
    Frame { axes, origin: [0.0; 3] }
}

/// A frame rotated about an axis of length 1 by an angle, rad.
///
/// Rodrigues' formula: `R = cos φ 1 + sin φ â + (1 − cos φ) a aᵀ`.
pub(super) fn about(axis: Vector, angle: f64) -> Frame {
    // Quarter turns are exact.
    let (sin, cos) = Value::Constant(angle).sin_cos();
    let (sin, cos) = (sin.at(&[]), cos.at(&[]));
    let [x, y, z] = axis;
    // Column j of â: a × e_j.
    let across = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
    let axes = [0, 1, 2].map(|j| {
        [0, 1, 2].map(|i| {
            let same = if i == j { cos } else { 0.0 };
            same + sin * across[j][i] + (1.0 - cos) * axis[i] * axis[j]
        })
    });
    Frame { axes, origin: [0.0; 3] }
}

/// The frame of a quaternion `(w, x, y, z)` of any length; `None` if that is zero.
pub(super) fn from_quaternion(quaternion: [f64; 4]) -> Option<Frame> {
    let size = quaternion.iter().map(|component| component * component).sum::<f64>().sqrt();
    if size == 0.0 {
        return None;
    }
    let [w, x, y, z] = quaternion.map(|component| component / size);
    let axes = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    Some(Frame { axes: axes.map(|axis| axis.map(without_residue)), origin: [0.0; 3] })
}

/// An entry of a rotation without the rounding of quarter turns.
fn without_residue(entry: f64) -> f64 {
    let whole = entry.round();
    if (entry - whole).abs() < 1e-15 { whole + 0.0 } else { entry }
}

/// Length of a vector.
pub(super) fn length(vector: Vector) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::Axis;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn rotated(rpy: Vector) -> Frame {
        let turn = |frame: Frame, axis, angle: f64| frame.rotated(axis, angle.sin(), angle.cos());
        turn(turn(turn(Frame::WORLD, Axis::Z, rpy[2]), Axis::Y, rpy[1]), Axis::X, rpy[0])
    }

    fn apart(a: &Frame, b: &Frame) -> f64 {
        a.axes.iter().flatten().zip(b.axes.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn angles_and_quaternions_describe_the_same_frame() {
        let angles = [-PI, -2.0, -FRAC_PI_2, -1e-9, 0.0, 0.3, FRAC_PI_2 - 1e-9, FRAC_PI_2, 3.0];
        for rpy in angles.iter().flat_map(|&r| angles.iter().flat_map(move |&p| angles.map(|y| [r, p, y]))) {
            let frame = rotated(rpy);
            // Round-off of entries of order 1; quaternions are equally exact.
            assert!(apart(&rotated(roll_pitch_yaw(&frame)), &frame) < 2e-15, "{rpy:?}");
            let written = quaternion(&frame);
            let read = from_quaternion(written.map(|component| 3.0 * component)).expect("a length");
            assert!(apart(&read, &frame) < 3e-15 && written[0] >= 0.0, "{rpy:?}");
        }
    }

    #[test]
    fn a_rotation_about_an_axis() {
        for (axis, index) in [(Axis::X, 0), (Axis::Y, 1), (Axis::Z, 2)] {
            let mut direction = [0.0; 3];
            direction[index] = 1.0;
            for angle in [-2.0_f64, 0.3, FRAC_PI_2, PI] {
                let frame = Frame::WORLD.rotated(axis, angle.sin(), angle.cos());
                assert!(apart(&about(direction, angle), &frame) < 3e-16, "{axis:?} {angle}");
            }
        }
        // The axis stays, and half the angle twice is the angle.
        let axis = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];
        let (half, whole) = (about(axis, 0.6), about(axis, 1.2));
        assert!(apart(&half.outer(&half), &whole) < 1e-15);
        assert!((0..3).all(|i| (whole.direction(axis)[i] - axis[i]).abs() < 1e-15));
    }

    #[test]
    fn a_frame_along_any_direction() {
        for direction in [[0.0, 0.0, 2.0], [0.0, 0.0, -1.0], [3.0, -4.0, -12.0], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]] {
            let frame = along_z(direction);
            let wanted = direction.map(|component| component / length(direction));
            let [x, y, z] = frame.axes;
            let cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
            for k in 0..3 {
                assert!(
                    (z[k] - wanted[k]).abs() < 1e-15 && (cross[k] - z[k]).abs() < 1e-15,
                    "{direction:?}: {frame:?}"
                );
            }
        }
    }
}
