//! The curve against its definition and against differences.

use super::AxisPoint;
use crate::chain::{Axis, BeamAxis, BodyId, Chain, Division, Stretch, Value};
use crate::compile;
use crate::diagnostic::SourceFile;
use crate::mechanics::kinematics::Kinematics;
use crate::mechanics::model::Model;
use crate::mechanics::vector::Vec3;
use crate::symbolic::{Expr, Graph};

const LENGTH: f64 = 4.0;

/// A slewing column with a beam on it.
fn beam(sections: &str) -> Chain {
    let text = format!(
        "format: 1\nname: curve\nlinks:\n- {{name: column, joint: revolute, mass: 9, com: [0, 0, 1]}}\n\
         - name: boom\n  placement: {{transform: {{rotation: {{x: 90 deg}}, translation: [0.2, 0, 1]}}}}\n  beam: {{length: {LENGTH}, \
         sections: {sections}, material: {{E: 2e11, G: 8e10, density: 7850}}, section: {{box: {{height: 0.2, width: 0.1, thickness: 0.01}}}}}}\n"
    );
    compile::load(&SourceFile::new("curve.yaml", &text)).expect("a valid spec")
}

fn axis(sections: usize) -> BeamAxis {
    let section = Value::from(LENGTH / sections.max(1) as f64);
    let stretch = (sections > 0).then_some(Stretch { sections, section, begin: Value::ZERO });
    BeamAxis {
        first: BodyId(1),
        division: Division { stretches: stretch.into_iter().collect() },
        length: Value::from(LENGTH),
    }
}

/// A pose of bending and twist without symmetry.
fn bent(chain: &Chain) -> Vec<f64> {
    (0..chain.coordinates.len()).map(|j| 0.08 * (1.7 * j as f64 + 0.4).sin()).collect()
}

fn numbers(vector: Vec3<'_>) -> [f64; 3] {
    vector.0.map(|x| x.as_constant().expect("a number"))
}

/// What `compute` says of the curve at s, at a pose of numbers.
fn at<T>(
    (chain, sections): (&Chain, usize),
    q: &[f64],
    s: f64,
    compute: impl for<'a, 'g> Fn(&AxisPoint<'a, 'g>, &Kinematics<'g>) -> T,
) -> T {
    let graph = Graph::simplifying();
    let numeric: Vec<Expr<'_>> = q.iter().map(|q| graph.constant(*q)).collect();
    let model = Model::new(&graph, chain).at(numeric);
    let (kinematics, axis) = (Kinematics::new(&model), axis(sections));
    compute(&AxisPoint::new(&model, &kinematics, &axis, graph.constant(s)), &kinematics)
}

fn position(chain: (&Chain, usize), q: &[f64], s: f64) -> [f64; 3] {
    at(chain, q, s, |point, _| numbers(point.position()))
}

fn direction(chain: (&Chain, usize), q: &[f64], s: f64) -> [f64; 3] {
    at(chain, q, s, |point, _| numbers(point.direction()))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// A few rounding errors of numbers of order 4.
const ROUNDING: f64 = 4e-15;

#[test]
fn the_curve_touches_every_inner_element_in_its_middle() {
    let (chain, n) = (beam("5"), 5);
    let q = bent(&chain);
    let frames = chain.frames(&q, &[]);
    let d = LENGTH / n as f64;
    for (k, frame) in frames[1..].iter().enumerate() {
        // The first and the last element are half as long; the curve begins and ends with them.
        let along = if k == 0 { 0.0 } else { 0.5 * d };
        let s = k as f64 * d;
        let there = frame.transform_point([along, 0.0, 0.0]);
        assert!(distance(position((&chain, n), &q, s), there) < ROUNDING, "element {k}");
        assert!(distance(direction((&chain, n), &q, s), frame.axes[0]) < ROUNDING, "element {k}");
    }
}

#[test]
fn the_direction_is_the_slope_of_the_curve_and_continuous() {
    const H: f64 = 1e-6;
    let (chain, n) = (beam("4"), 4);
    let q = bent(&chain);
    for step in -4..=44 {
        // On the borders of sections, in between, and beyond both ends.
        let s = 0.1 * f64::from(step);
        let [before, after] = [-H, H].map(|h| position((&chain, n), &q, s + h));
        let slope = [0, 1, 2].map(|i| (after[i] - before[i]) / (2.0 * H));
        // The curvature of 0.1/m jumps at borders: H/4 times that; and rounding of 4 over 2 µm.
        assert!(distance(direction((&chain, n), &q, s), slope) < 2e-7, "s = {s}");
    }
}

#[test]
fn the_axis_of_a_rigid_or_straight_beam_is_straight() {
    for (sections, n) in [("rigid", 0), ("3", 3), ("1", 1)] {
        let chain = beam(sections);
        let mut q = vec![0.0; chain.coordinates.len()];
        q[0] = 0.7;
        let frame = chain.frames(&q, &[])[1];
        for s in [-0.3, 0.0, 1.1, 2.9, LENGTH, 5.0] {
            let there = frame.transform_point([s, 0.0, 0.0]);
            assert!(distance(position((&chain, n), &q, s), there) < ROUNDING, "{sections}, s = {s}");
            assert!(distance(direction((&chain, n), &q, s), frame.axes[0]) < ROUNDING, "{sections}, s = {s}");
        }
    }
}

#[test]
fn slopes_over_coordinates_are_those_of_differences() {
    const H: f64 = 1e-6;
    let (chain, n) = (beam("4"), 4);
    let mut q = bent(&chain);
    // Slopes over the components of a rotation vector are along axes that depend on the others.
    for s in [-0.2, 0.3, 1.7, 2.0, 3.9, 4.3] {
        let slopes = at((&chain, n), &q, s, |point, _| {
            [point.position_slopes(), point.cross_axis_slopes(Axis::Y)]
                .map(|slopes| slopes.into_values().map(numbers).collect::<Vec<_>>())
        });
        assert_eq!(slopes[0].len(), q.len());
        for j in 0..q.len() {
            let [before, after] = [-H, 2.0 * H].map(|h| {
                q[j] += h;
                [0, 1].map(|what| {
                    at((&chain, n), &q, s, |point, _| {
                        numbers(if what == 0 { point.position() } else { point.cross_axis(Axis::Y) })
                    })
                })
            });
            q[j] -= H;
            for what in [0, 1] {
                let difference = [0, 1, 2].map(|i| (after[what][i] - before[what][i]) / (2.0 * H));
                // Rounding of numbers of order 4 over 2 µm.
                assert!(distance(slopes[what][j], difference) < 3e-9, "s = {s}, coordinate {j}");
            }
        }
    }
}

/// Springs of 4 sections of 1 m are at 0.5, 1.5, 2.5 and 3.5 m.
#[test]
fn every_place_is_on_one_element() {
    let (chain, n) = (beam("4"), 4);
    let q = bent(&chain);
    for (s, element) in [(-0.2, 0), (0.0, 0), (0.3, 0), (0.7, 1), (1.7, 2), (2.0, 2), (3.9, 4), (4.3, 4)] {
        let here: Vec<f64> = at((&chain, n), &q, s, |point, _| {
            point.here().iter().map(|here| here.as_constant().expect("a number")).collect()
        });
        let expected: Vec<f64> = (0..=n).map(|k| if k == element { 1.0 } else { 0.0 }).collect();
        assert_eq!(here, expected, "s = {s}");
    }
}
