//! Each pass, on a program small enough to read.

use super::{Constants, Statement, bundle, fuse::fuse, lower, split};
use crate::program::{Argument, Function, FunctionId, Inputs, Program, Shape, Symbol};
use crate::symbolic::{Expr, ExprId, Graph, Op, SymbolId};

/// Inputs of the programs here: a, b, c, d are coordinates, p a live parameter.
const INPUTS: [(&str, Argument, usize); 5] = [
    ("a", Argument::Position, 0),
    ("b", Argument::Position, 1),
    ("c", Argument::Position, 2),
    ("d", Argument::Position, 3),
    ("p", Argument::Parameters, 0),
];

/// A program of one function with the outputs that `build` derives from a, b, c, d and p.
fn program(build: impl for<'g> FnOnce(&'g Graph, [Expr<'g>; 5]) -> Vec<Expr<'g>>) -> Program {
    let graph = Graph::simplifying();
    let (outputs, trace) = graph.recorded(|| {
        let inputs = [0, 1, 2, 3, 4].map(|index| graph.symbol(SymbolId(index)));
        build(&graph, inputs).iter().map(|output| output.id()).collect::<Vec<ExprId>>()
    });
    let function = Function {
        id: FunctionId::Forces,
        product: None,
        doc: "",
        equation: "",
        arguments: vec![Argument::Position],
        shape: Shape::Vector(outputs.len()),
        outputs,
        trace,
    };
    let symbols = INPUTS.map(|(name, argument, index)| Symbol { name: name.into(), argument, index });
    Program::new(graph, symbols.to_vec(), vec![function])
}

fn roots(program: &Program) -> &[ExprId] {
    &program.functions[0].outputs
}

/// The only expression whose operation satisfies `is`.
fn only(program: &Program, is: impl Fn(Op) -> bool) -> ExprId {
    let found: Vec<ExprId> = program.ids().filter(|id| is(program.op(*id))).collect();
    assert_eq!(found.len(), 1);
    found[0]
}

/// Values that a line computes, in order.
fn computed(line: &[Statement]) -> Vec<ExprId> {
    line.iter().filter_map(|statement| if let Statement::Let(id) = statement { Some(*id) } else { None }).collect()
}

#[test]
fn a_product_is_fused_into_the_sum_that_alone_uses_it() {
    let program = program(|_, [a, b, c, ..]| vec![a * b + c]);
    let fused = fuse(&program, &Constants::new(&program), roots(&program));
    let product = only(&program, |op| matches!(op, Op::Mul(..)));
    let sum = only(&program, |op| matches!(op, Op::Add(..)));
    assert_eq!(fused[sum.index()], Some(product));
}

#[test]
fn a_product_that_is_a_result_or_is_divided_is_not_fused() {
    let of = |program: &Program| fuse(program, &Constants::new(program), roots(program)).iter().flatten().count();
    assert_eq!(of(&program(|_, [a, b, c, ..]| vec![a * b, a * b + c])), 0);
    assert_eq!(of(&program(|_, [a, b, c, d, _]| vec![a * b + c, d / (a * b)])), 0);
    // It is fused into both sums that use it, so that it is not computed separately.
    assert_eq!(of(&program(|_, [a, b, c, d, _]| vec![a * b + c, a * b + d])), 2);
}

#[test]
fn a_product_of_many_sums_is_computed_once() {
    let program = program(|graph, [a, b, c, ..]| {
        (1..=5).map(|k| a * b + c * graph.constant(f64::from(k) + 0.5).sin() * c).collect()
    });
    let product = program.ids().find(|id| program.op(*id).operands().map(ExprId::index).eq([0, 1])).expect("a b");
    let fused = fuse(&program, &Constants::new(&program), roots(&program));
    assert!(!fused.iter().flatten().any(|id| *id == product));
}

#[test]
fn what_depends_on_parameters_alone_is_stored() {
    let program = program(|_, [a, .., p]| vec![(p * p + 1.0) * a + p]);
    let constants = Constants::new(&program);
    let square = only(&program, |op| matches!(op, Op::Mul(x, y) if x == y));
    let factor = program.ids().find(|id| program.op(*id).operands().any(|operand| operand == square)).expect("p² + 1");
    // The whole factor is stored, not its parts, and not the parameter itself, which is read directly.
    assert_eq!(constants.stored, [factor]);
    assert!(constants.is_free(&program, factor) && !constants.is_free(&program, roots(&program)[0]));
}

#[test]
fn a_value_used_once_stands_where_it_is_used_and_one_used_twice_does_not() {
    let program = program(|_, [a, b, c, ..]| {
        let (once, twice) = (a / b, b / c);
        vec![once + twice, c - twice]
    });
    let roots = roots(&program);
    let inlined = bundle::bundle(&program, &Constants::new(&program), &vec![None; program.operations.len()], roots);
    let [once, twice] = [0, 1].map(|k| {
        let divisions = program.ids().filter(|id| matches!(program.op(*id), Op::Div(..)));
        divisions.collect::<Vec<_>>()[k]
    });
    assert!(inlined[once.index()] && !inlined[twice.index()]);
}

/// A sum of many quotients does not become one statement.
#[test]
fn expressions_stay_bounded() {
    let program = program(|_, [a, b, c, ..]| vec![(0..40).fold(a, |sum, _| (sum + b) / c)]);
    let code = &lower(&program, None).functions[0];
    // 80 operations, at most seven per statement.
    assert!(code.statements() >= 80 / 7, "{}", code.statements());
}

#[test]
fn angles_come_first_and_operands_before_their_users() {
    let program = program(|_, [a, b, c, ..]| {
        let x = a * b;
        let y = x * x + (a + b).sin();
        vec![y * y * x, c.cos() * y]
    });
    let constants = Constants::new(&program);
    let lowered = lower(&program, None);
    let [line] = lowered.functions[0].pieces.as_slice() else { panic!("one piece") };
    let sines = line.iter().position(|statement| matches!(statement, Statement::SinCos(_))).expect("sines");
    let angle = only(&program, |op| matches!(op, Op::Add(x, y) if program.op(x).is_leaf() && program.op(y).is_leaf()));
    // Only inputs and the angle that is a sum precede the sines.
    assert!(computed(&line[..sines]).iter().all(|id| *id == angle));
    let mut known: Vec<ExprId> = vec![];
    for statement in line {
        match statement {
            Statement::SinCos(angles) => known.extend(angles.iter().flat_map(|of| [of.sin, of.cos]).flatten()),
            Statement::Input(id) => known.push(*id),
            Statement::Let(id) => {
                let needs = super::variables_of(&program, &constants, &lowered.functions[0].inlined, *id);
                assert!(needs.iter().all(|need| known.contains(need)), "{id:?} before {needs:?}");
                known.push(*id);
            }
            _ => {}
        }
    }
}

#[test]
fn pieces_of_a_long_line_carry_values_across_cuts() {
    // Each value is used by the next two, so it needs a variable.
    let program = program(|_, [a, b, ..]| {
        let (mut x, mut y) = (a, b);
        for _ in 0..2000 {
            (x, y) = (y, (x * y).sin() * x);
        }
        vec![x, y]
    });
    // Sines depend on each other, unlike in any crane, so the code is constructed here.
    let constants = Constants::new(&program);
    let inlined = vec![false; program.operations.len()];
    let line: Vec<Statement> = program
        .ids()
        .map(|id| if program.op(id).is_leaf() { Statement::Input(id) } else { Statement::Let(id) })
        .chain(roots(&program).iter().enumerate().map(|(slot, value)| Statement::Output { slot, value: *value }))
        .collect();
    assert!(split::is_long(&line));
    let (pieces, kept) = split::split(&program, &constants, &inlined, line.clone());
    assert!(pieces.len() > 2 && kept >= pieces.len() - 1);
    assert_eq!(pieces.iter().flat_map(|piece| computed(piece)).collect::<Vec<_>>(), computed(&line));
    for piece in &pieces {
        assert!(piece.len() <= 1600, "{}", piece.len());
        // A piece reads only values that it has computed, fetched or read as inputs.
        let mut known: Vec<ExprId> = vec![];
        for statement in piece {
            match statement {
                Statement::Input(id) | Statement::Fetch { value: id, .. } => known.push(*id),
                Statement::Let(id) => {
                    let mut operands = program.op(*id).operands().filter(|id| !constants.is_free(&program, *id));
                    assert!(operands.all(|operand| known.contains(&operand)));
                    known.push(*id);
                }
                Statement::Output { value, .. } | Statement::Keep { value, .. } => assert!(known.contains(value)),
                _ => {}
            }
        }
    }
}

/// Equal work at consecutive bodies, as in a sweep.
fn swept(bodies: u8) -> Program {
    program(|graph, [a, b, c, d, _]| {
        let sweep = graph.sweep();
        let mut x = a;
        for body in 0..bodies {
            sweep.leave(&format!("body_{body}"));
            // Numbers that differ between bodies become a table.
            let number = graph.constant(1.5 + f64::from(body));
            x = (x * b + number) * c + d * number;
        }
        drop(sweep);
        vec![x]
    })
}

#[test]
fn repeated_bodies_become_a_loop_with_the_same_results() {
    const BODIES: u8 = 60;
    let program = swept(BODIES);
    let iterations =
        |least| lower(&program, least).functions[0].rerolled.loops.iter().map(|of| of.iterations).sum::<usize>();
    assert_eq!(iterations(None), 0);
    assert!(iterations(Some(4)) >= usize::from(BODIES) - 2, "{}", iterations(Some(4)));
    let statements = |least| lower(&program, least).functions[0].statements();
    assert!(statements(Some(4)) < statements(None) / 2);
    // Too few bodies for a loop.
    assert!(lower(&swept(3), Some(4)).functions[0].rerolled.loops.is_empty());
    // The graph itself is unchanged.
    let inputs = Inputs::state(0.0, vec![0.3, 0.7, -0.2, 1.1], vec![], vec![1.0]);
    let mut x = 0.3;
    for body in 0..BODIES {
        let number = 1.5 + f64::from(body);
        x = (x * 0.7 + number) * -0.2 + 1.1 * number;
    }
    let value = program.evaluate(&program.functions[0], &inputs)[0];
    assert!((value - x).abs() < 1e-12, "{value} {x}");
}
