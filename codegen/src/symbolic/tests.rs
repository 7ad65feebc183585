//! Every rule keeps the value and has its intended effect.

use super::{Expr, Graph, Op, SweepTrace, SymbolId};
use crate::program::{Argument, Function, FunctionId, Inputs, Program, Shape, Symbol};

fn program(build: impl for<'g> Fn(&'g Graph, Expr<'g>, Expr<'g>) -> Vec<Expr<'g>>, graph: Graph) -> Program {
    let outputs: Vec<_> = {
        let (x, y) = (graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1)));
        build(&graph, x, y).iter().map(|e| e.id()).collect()
    };
    let symbol = |name: &str, index| Symbol { name: name.into(), argument: Argument::Position, index };
    let shape = Shape::Vector(outputs.len());
    let function = Function {
        id: FunctionId::Forces,
        product: None,
        doc: "",
        equation: "",
        arguments: vec![Argument::Position],
        shape,
        outputs,
        trace: SweepTrace::default(),
    };
    Program::new(graph, vec![symbol("x", 0), symbol("y", 1)], vec![function])
}

fn values(program: &Program, x: f64, y: f64) -> Vec<f64> {
    let inputs = Inputs::state(0.0, vec![x, y], vec![], vec![]);
    program.evaluate(&program.functions[0], &inputs)
}

/// Every rule, in one list of expressions.
#[allow(clippy::eq_op)] // one of the rules is for x − x
fn all_rules<'g>(g: &'g Graph, x: Expr<'g>, y: Expr<'g>) -> Vec<Expr<'g>> {
    let c = |value| g.constant(value);
    vec![
        c(0.0) + x,
        x + 0.0,
        x - 0.0,
        c(0.0) - x,
        x * 0.0,
        x * 1.0,
        -1.0 * x,
        x / 1.0,
        x / 4.0,
        c(0.0) / y,
        x / y,
        x + x,
        x - x,
        x + -y,
        -x + y,
        -x + -y,
        x - -y,
        -x - y,
        -x - -y,
        -x * y,
        x * -y,
        -x * -y,
        -(x - y),
        x - y,
        y - x,
        -(2.0 * x),
        3.0 * (2.0 * x),
        2.0 * -x,
        (-x).sin(),
        (-x).cos(),
        c(0.5).sin(),
        c(0.5).cos(),
        (x * x).stumpff(3),
        c(0.5).stumpff(2),
        x.clamp(c(0.0), c(1.0)),
        c(3.0).clamp(c(0.0), c(1.0)),
        x.squared() + y.squared(),
        c(2.0) + 3.0,
        c(2.0) - 3.0,
        c(2.0) * 3.0,
        c(3.0) / 2.0,
        -(-x),
        x.squared().sqrt(),
        c(2.0).sqrt(),
        (x * y).exp(),
        c(-0.5).exp(),
        x.tanh(),
        x.select(y, -y),
        c(1.0).select(x, y),
        c(0.0).select(x, y),
        x.select(y, y),
    ]
}

#[test]
fn simplification_keeps_every_value() {
    let simple = program(all_rules, Graph::simplifying());
    let verbatim = program(all_rules, Graph::verbatim());
    for (x, y) in [(0.3, -1.7), (-2.5, 0.4), (1.5, 1.5)] {
        for (i, (a, b)) in values(&simple, x, y).iter().zip(values(&verbatim, x, y)).enumerate() {
            // One rounding: a division became a multiplication, two constant factors became one.
            assert!((a - b).abs() <= f64::EPSILON * b.abs(), "expression {i}: {a} against {b}");
        }
    }
    let count = |p: &Program| p.count(&p.functions[0].outputs, |_| false).total();
    assert!(count(&simple) < count(&verbatim), "{} against {}", count(&simple), count(&verbatim));
}

#[test]
fn equal_expressions_are_one_node() {
    let graph = Graph::simplifying();
    let (x, y) = (graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1)));
    assert_eq!((x * y).id(), (y * x).id());
    assert_eq!((x + y).id(), (y + x).id());
    assert_eq!((x - y).id(), (-(y - x)).id());
    assert_eq!((x * -y).id(), (-(x * y)).id());
    assert!((x * y - y * x).is_zero());
}

#[test]
fn negation_costs_nothing_on_differences() {
    let graph = Graph::simplifying();
    let (x, y) = (graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1)));
    assert!(matches!(graph.op((-(x - y)).id()), Op::Sub(..)));
    assert!(matches!(graph.op((x - -y).id()), Op::Add(..)));
}

#[test]
fn a_difference_stays_the_same_node_once_its_negative_is_known() {
    let graph = Graph::simplifying();
    let (x, y) = (graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1)));
    let difference = x - y;
    let negative = -difference;
    assert_eq!((x - y).id(), difference.id());
    assert_eq!((y - x).id(), negative.id());
}

#[test]
fn counts_each_operation_once() {
    let p = program(|_, x, y| vec![x.sin() * y, x.cos() * y, x.sin() * y + y], Graph::simplifying());
    let count = p.count(&p.functions[0].outputs, |_| false);
    assert_eq!((count.angles, count.multiplications, count.additions), (1, 2, 1));
}

#[test]
fn stumpff_functions_of_one_argument_count_once() {
    let p = program(|_, x, _| vec![x.stumpff(0), x.stumpff(3)], Graph::simplifying());
    assert_eq!(p.count(&p.functions[0].outputs, |_| false).total(), 1);
}

/// By sines and cosines, by the series, and by the series with downward steps, which must agree where all are valid.
#[test]
fn stumpff_functions_are_sines_and_cosines() {
    let of = |k: u8, x: f64| super::Scalar::stumpff(&x, k);
    for x in [0.3, 2.0, 9.9, 10.1, 60.0] {
        let s: f64 = x;
        let s = s.sqrt();
        let (sin, cos) = s.sin_cos();
        let direct = [cos, sin / s, (1.0 - cos) / x, (s - sin) / (s * x)];
        for (k, direct) in (0..).zip(direct) {
            // A difference of numbers of order 1, divided by x.
            assert!((of(k, x) - direct).abs() < 1e-15 / x.min(1.0), "c_{k}({x}): {} against {direct}", of(k, x));
        }
    }
    assert_eq!([0, 1, 2, 3, 4, 5].map(|k| of(k, 0.0)), [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0]);
}

/// An expression for every rule of differentiation.
fn with_derivatives<'g>(x: Expr<'g>, y: Expr<'g>) -> Vec<Expr<'g>> {
    vec![
        -x,
        x + y * x,
        x * y - y / x,
        (x * y).sin() * x.cos(),
        (x * x).stumpff(0) + (x * y + 4.0).stumpff(3) * y,
        (x * x + y * y).stumpff(4) * (9.0 * x * x + 4.0).stumpff(5) * 100.0,
        x.min(y) + (x * x).max(y),
        (x * x + y * y).sqrt(),
        (y * x).exp() / (1.0 + x.exp()),
        (x * y).tanh(),
        (x - y).select(x * x * y, x / y),
        y.squared(),
    ]
}

/// Every rule of differentiation against a difference quotient, whose error is of second order in 1e-5: 1e-9 for numbers of
/// order 1 to 10, such as the third derivatives here.
#[test]
fn derivatives_are_those_of_differences() {
    let graph = Graph::simplifying();
    let symbols = [graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1))];
    let of = with_derivatives(symbols[0], symbols[1]);
    let count = of.len();
    let mut outputs: Vec<_> = of.iter().map(|f| f.id()).collect();
    for by in symbols {
        outputs.extend(graph.derivatives(&of, by).into_iter().map(Expr::id));
    }
    let p = program(|g, _, _| outputs.iter().map(|id| g.expr(*id)).collect(), graph);
    for (x, y) in [(0.7, -1.2), (-1.3, 0.4), (1.6, 1.1)] {
        let h = 1e-5;
        let all = values(&p, x, y);
        for (variable, (dx, dy)) in [(h, 0.0), (0.0, h)].into_iter().enumerate() {
            let (after, before) = (values(&p, x + dx, y + dy), values(&p, x - dx, y - dy));
            for i in 0..count {
                let (derivative, expected) = (all[(variable + 1) * count + i], (after[i] - before[i]) / (2.0 * h));
                let error = (derivative - expected).abs();
                assert!(
                    error < 1e-8 * (1.0 + expected.abs()),
                    "{i} by {variable} at {x}, {y}: {derivative} for {expected}"
                );
            }
        }
    }
}

/// Both are sums of the same numbers of order 1 to 100, in another order.
#[test]
fn what_is_pulled_back_is_the_weighted_sum_of_derivatives() {
    let graph = Graph::simplifying();
    let symbols = [graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1))];
    let of = with_derivatives(symbols[0], symbols[1]);
    let weight = |i: usize| 0.3 + (i as f64).sin();
    let weights: Vec<Expr<'_>> = (0..of.len()).map(|i| graph.constant(weight(i))).collect();
    let mut outputs: Vec<_> = graph.pull_back(&of, &weights, &symbols).into_iter().map(Expr::id).collect();
    for by in symbols {
        outputs.extend(graph.derivatives(&of, by).into_iter().map(Expr::id));
    }
    let count = of.len();
    let p = program(|g, _, _| outputs.iter().map(|id| g.expr(*id)).collect(), graph);
    for (x, y) in [(0.7, -1.2), (-1.3, 0.4), (1.6, 1.1)] {
        let all = values(&p, x, y);
        let (found, derivatives) = all.split_at(2);
        for (value, derivatives) in found.iter().zip(derivatives.chunks(count)) {
            let expected: f64 = derivatives.iter().enumerate().map(|(i, slope)| weight(i) * slope).sum();
            assert!((value - expected).abs() < 1e-13 * (1.0 + expected.abs()), "{x}, {y}: {value} for {expected}");
        }
    }
}

/// As above.
#[test]
fn what_is_pushed_forward_is_the_sum_of_derivatives_and_changes() {
    let graph = Graph::simplifying();
    let symbols = [graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1))];
    let of = with_derivatives(symbols[0], symbols[1]);
    let changes = [0.7, -1.9];
    let given = changes.map(|change| graph.constant(change));
    let mut outputs: Vec<_> = graph.push_forward(&of, &symbols, &given).into_iter().map(Expr::id).collect();
    for by in symbols {
        outputs.extend(graph.derivatives(&of, by).into_iter().map(Expr::id));
    }
    let root = symbols[0].squared().sqrt();
    outputs.push(graph.push_forward(&[root], &symbols, &given)[0].id());
    let count = of.len();
    let p = program(|g, _, _| outputs.iter().map(|id| g.expr(*id)).collect(), graph);
    for (x, y) in [(0.7, -1.2), (-1.3, 0.4), (1.6, 1.1)] {
        let all = values(&p, x, y);
        for i in 0..count {
            let (value, expected) = (all[i], changes[0] * all[count + i] + changes[1] * all[2 * count + i]);
            assert!((value - expected).abs() < 1e-13 * (1.0 + expected.abs()), "{x}, {y}: {value} for {expected}");
        }
    }
    // A root at 0 has no slope.
    assert_eq!(values(&p, 0.0, 1.0).last(), Some(&0.0));
}

#[test]
fn what_a_choice_leaves_out_may_have_an_infinite_slope() {
    let graph = Graph::simplifying();
    let (x, y) = (graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1)));
    let zero = graph.constant(0.0);
    let f = [x.select(y / x, y), x.max(y / x), x.squared().sqrt(), (x - 1.0).select(x.sqrt(), x.squared())];
    let weights = f.map(|_| graph.constant(1.0));
    let found: Vec<_> = f
        .iter()
        .zip(&weights)
        .flat_map(|(f, weight)| graph.pull_back(&[*f], &[*weight], &[x, y]))
        .map(Expr::id)
        .collect();
    assert!(graph.pull_back(&[zero], &weights[..1], &[x])[0].is_zero());
    let p = program(|g, _, _| found.iter().map(|id| g.expr(*id)).collect(), graph);
    let found = values(&p, 0.0, -2.0);
    assert_eq!([found[0], found[1], found[2], found[3]], [0.0, 1.0, 1.0, 0.0]);
    assert_eq!([found[4], found[6]], [0.0, 0.0]);
}

#[test]
fn what_does_not_depend_on_an_input_has_no_derivative() {
    let graph = Graph::simplifying();
    let (x, y) = (graph.symbol(SymbolId(0)), graph.symbol(SymbolId(1)));
    let nodes = |graph: &Graph| graph.constant(f64::NAN).id().index();
    let f = (y * y).sin();
    let _ = (graph.constant(0.0), graph.constant(1.0));
    let before = nodes(&graph);
    assert!(graph.derivatives(&[f], x)[0].is_zero());
    assert_eq!(graph.derivatives(&[x + 3.0], x)[0].as_constant(), Some(1.0));
    assert_eq!(nodes(&graph), before);
}

#[test]
fn a_hyperbolic_tangent_overflows_nowhere() {
    let p = program(|_, x, _| vec![x.tanh()], Graph::simplifying());
    for x in [0.0, 1e-9, -0.4, 3.0, -40.0, 1e9, -f64::MAX] {
        let (value, expected) = (values(&p, x, 0.0)[0], x.tanh());
        // 1 − exp(−2x) loses digits for small x: its error is ε relative to 1, not to x.
        assert!((value - expected).abs() <= 2.0 * f64::EPSILON, "{x}: {value} for {expected}");
    }
}

#[test]
fn the_angle_of_a_point_is_that_of_the_library() {
    let angle = program(|_, x, y| vec![y.atan2(x)], Graph::simplifying());
    let mut points: Vec<[f64; 2]> =
        (-180..=180).map(|degrees| f64::from(degrees).to_radians().sin_cos().into()).collect();
    points.extend([[0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [1.0, 1.0], [1e-9, 1.0], [1e-9, -1.0], [3e5, -4e5]]);
    for [y, x] in points {
        // Rounding of numbers up to π.
        assert!((values(&angle, x, y)[0] - y.atan2(x)).abs() < 1.5e-15, "{x} {y}");
    }
}
