//! The model on a crane small enough for a textbook: a double pendulum of two rods in the x–z plane, rotating about y.

use crate::chain::{
    Analyses, Axis, Body, BodyId, Chain, Coordinate, CoordinateId, CoordinateKind, Inertia, Loops, Point, Run, Step,
    Value,
};
use crate::mechanics::derive;
use crate::program::{FunctionId, Inputs, Program};

const MASS: [f64; 2] = [3.0, 2.0];
const LENGTH: [f64; 2] = [1.5, 0.8];
const GRAVITY: f64 = 9.81;

/// A uniform thin rod along x.
fn rod(mass: f64, length: f64) -> Inertia {
    let c = Value::Constant;
    let mut second = [Value::ZERO; 6].map(|_| Value::ZERO);
    second[0] = c(mass * length * length / 3.0);
    Inertia { mass: c(mass), first: [c(mass * length / 2.0), Value::ZERO, Value::ZERO], second }
}

pub(super) fn double_pendulum() -> Chain {
    let body = |i: usize, path: Vec<Step>| Body {
        name: format!("rod_{i}"),
        link: format!("rod_{i}"),
        parent: i.checked_sub(1).map(BodyId),
        along: Value::ZERO,
        path,
        inertia: Some(rod(MASS[i], LENGTH[i])),
        parts: vec![],
        length: Value::ZERO,
    };
    let coordinate = |i: usize| Coordinate {
        name: format!("rod_{i}_theta"),
        kind: CoordinateKind::Rotation,
        axis: Axis::Y,
        body: BodyId(i),
    };
    let c = Value::Constant;
    Chain {
        name: "double_pendulum".into(),
        title: "Double pendulum".into(),
        spec_hash: String::new(),
        gravity: [Value::ZERO, Value::ZERO, c(-GRAVITY)],
        parameters: vec![],
        relations: vec![],
        coordinates: vec![coordinate(0), coordinate(1)],
        bodies: vec![
            body(0, vec![Step::Move(CoordinateId(0))]),
            body(1, vec![Step::Translate([c(LENGTH[0]), Value::ZERO, Value::ZERO]), Step::Move(CoordinateId(1))]),
        ],
        base: [None; 6],
        supports: vec![],
        beams: vec![],
        drives: vec![],
        forces: vec![],
        loads: vec![],
        combinations: vec![],
        combination: None,
        cylinders: Vec::new(),
        pump: None,
        loop_joints: vec![],
        rigid_couplings: vec![],
        inputs: vec![],
        rotors: vec![],
        frames: Vec::new(),
        joints: Vec::new(),
        points: vec![Point { name: "tip".into(), body: BodyId(1), position: [c(LENGTH[1]), Value::ZERO, Value::ZERO] }],
        shapes: Vec::new(),
        written_guess: vec![None; 2],
        guess: vec![0.0; 2],
        run: Run { duration: 1.0, step: 1e-3, output: 1e-2 },
        events: Vec::new(),
        analyses: Analyses::ALL,
        loops: Loops::Auto,
    }
}

fn evaluate(program: &Program, name: &str, q: [f64; 2], v: [f64; 2]) -> Vec<f64> {
    let inputs = Inputs::state(0.0, q.to_vec(), v.to_vec(), vec![]);
    program.evaluate(program.function(FunctionId::named(name).unwrap()).unwrap(), &inputs)
}

/// A few rounding errors of numbers of order 10.
fn assert_close(actual: &[f64], expected: &[f64]) {
    assert_eq!(actual.len(), expected.len());
    for (a, b) in actual.iter().zip(expected) {
        assert!((a - b).abs() < 1e-13, "{actual:?} against {expected:?}");
    }
}

/// The textbook double pendulum: angles a and a + b below the horizontal, so that x = l cos, z = −l sin.
#[test]
pub(super) fn double_pendulum_is_the_textbooks() {
    let program = derive(&double_pendulum(), Analyses::ALL);
    let ([m1, m2], [l1, l2]) = (MASS, LENGTH);
    for (q, v) in [([0.3_f64, -0.9], [0.7, 1.3]), ([-2.0, 0.4], [0.0, -0.6])] {
        let (a, b) = (q[0], q[1]);
        let couple = m2 * l1 * l2 * b.cos();
        let a22 = m2 * l2 * l2 / 3.0;
        let a12 = a22 + couple / 2.0;
        let a11 = m1 * l1 * l1 / 3.0 + m2 * l1 * l1 + a22 + couple;
        assert_close(&evaluate(&program, "mass_matrix", q, v), &[a11, a12, a22]);

        let swirl = m2 * l1 * l2 * b.sin() / 2.0;
        let h = [-swirl * v[1] * (2.0 * v[0] + v[1]), swirl * v[0] * v[0]];
        let g2 = -m2 * GRAVITY * l2 / 2.0 * (a + b).cos();
        let g = [-(m1 / 2.0 + m2) * GRAVITY * l1 * a.cos() + g2, g2];
        assert_close(&evaluate(&program, "bias", q, v), &[-h[0] - g[0], -h[1] - g[1]]);
        assert_close(&evaluate(&program, "static_residual", q, v), &g);

        let k22 = m2 * GRAVITY * l2 / 2.0 * (a + b).sin();
        let k11 = (m1 / 2.0 + m2) * GRAVITY * l1 * a.sin() + k22;
        assert_close(&evaluate(&program, "tangent_stiffness", q, v), &[k11, k22, k22]);

        let energy = 0.5 * (a11 * v[0] * v[0] + 2.0 * a12 * v[0] * v[1] + a22 * v[1] * v[1]);
        assert_close(&evaluate(&program, "kinetic_energy", q, v), &[energy]);

        let tip = [l1 * a.cos() + l2 * (a + b).cos(), 0.0, -l1 * a.sin() - l2 * (a + b).sin()];
        assert_close(&evaluate(&program, "points", q, v), &tip);
    }
}

#[test]
fn a_planar_crane_stays_planar() {
    let program = derive(&double_pendulum(), Analyses::ALL);
    let tip = &program.function(FunctionId::Points).unwrap().outputs;
    assert_eq!(program.op(tip[1]), crate::symbolic::Op::ZERO);
    assert!(super::left_out(&double_pendulum(), Analyses::ALL).iter().any(|(what, _)| what.contains("plane")));
}
