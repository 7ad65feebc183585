//! Placements of links as elementary steps of a transformation.

use crate::chain::{Axis, Step, Value};

/// Modified (Craig's) D-H row, `Rx(α) Tx(a) Rz(θ) Tz(d)`, with the joint's motion about or along z.
///
/// `Rz` and `Tz` commute with each other, so that the translation is one step, `(a, 0, d)`.
pub(crate) fn modified_dh(a: Value, alpha: &Value, d: Value, theta: &Value, motion: Vec<Step>) -> Vec<Step> {
    let mut path = Vec::new();
    rotate(&mut path, Axis::X, alpha);
    translate(&mut path, [a, Value::ZERO, d]);
    rotate(&mut path, Axis::Z, theta);
    path.extend(motion);
    path
}

/// Classic D-H row, `Rz(θ) Tz(d) Tx(a) Rx(α)`: the motion about or along z precedes the transformation to the link's frame.
pub(crate) fn classic_dh(a: Value, alpha: &Value, d: Value, theta: &Value, motion: Vec<Step>) -> Vec<Step> {
    let mut path = Vec::new();
    rotate(&mut path, Axis::Z, theta);
    path.extend(motion);
    translate(&mut path, [a, Value::ZERO, d]);
    rotate(&mut path, Axis::X, alpha);
    path
}

/// Constant translation, rotations each about the axes as rotated by the previous ones, then the motion.
pub(crate) fn transform(translation: [Value; 3], turns: &[(Axis, Value)], motion: Vec<Step>) -> Vec<Step> {
    let mut path = Vec::new();
    translate(&mut path, translation);
    for (axis, angle) in turns {
        rotate(&mut path, *axis, angle);
    }
    path.extend(motion);
    path
}

/// Appends a translation, unless it is zero.
pub(crate) fn translate(path: &mut Vec<Step>, by: [Value; 3]) {
    if !by.iter().all(Value::is_zero) {
        path.push(Step::Translate(by));
    }
}

/// Appends a rotation, unless it is zero.
fn rotate(path: &mut Vec<Step>, axis: Axis, angle: &Value) {
    let (sin, cos) = angle.sin_cos();
    if !sin.is_zero() || cos != Value::ONE {
        path.push(Step::Rotate { axis, sin, cos });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::CoordinateId;
    use std::f64::consts::FRAC_PI_2;

    const MOVE: Step = Step::Move(CoordinateId(0));
    const NONE: Value = Value::ZERO;

    #[test]
    fn conventions_differ_in_the_order_of_steps() {
        let quarter = Value::from(FRAC_PI_2);
        let turn = Step::Rotate { axis: Axis::X, sin: Value::ONE, cos: NONE };
        let shift = Step::Translate([2.0.into(), NONE, 3.0.into()]);
        assert_eq!(
            modified_dh(2.0.into(), &quarter, 3.0.into(), &NONE, vec![MOVE]),
            [turn.clone(), shift.clone(), MOVE]
        );
        assert_eq!(classic_dh(2.0.into(), &quarter, 3.0.into(), &NONE, vec![MOVE]), [MOVE, shift, turn]);
    }

    #[test]
    fn an_identity_takes_no_steps() {
        assert_eq!(modified_dh(NONE, &NONE, NONE, &NONE, vec![MOVE]), [MOVE]);
        assert_eq!(transform([NONE, NONE, NONE], &[(Axis::Y, NONE)], vec![]), []);
    }
}
