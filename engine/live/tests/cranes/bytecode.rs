//! Bytecode against the interpreter of the compiler, which defines the meaning of a program.

use crane_codegen::build;
use crane_codegen::chain::{Analyses, Chain};
use crane_codegen::program::{Argument, Entry, Function, FunctionId, Inputs, Layout, Program, Shape, Symbol};
use crane_codegen::symbolic::{Expr, Graph, SweepTrace, SymbolId};
use crane_codegen::{compile, mechanics};
use crane_live::Routine;
use crane_live::machine::Environment;
use crane_model::dyn_crane::Arguments;
use crane_model::rt::lanes::f64x8;

/// Specs with everything that functions can contain: supports, beams, drives, hinges, live parameters, prismatic joints.
const SPECS: [&str; 4] = ["eight_link_flexible", "eight_link_identified", "knuckle_boom", "double_pendulum"];

/// A chain and all its functions.
fn crane(name: &str) -> (Chain, Program) {
    let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    let chain = compile::load(&source).unwrap();
    let program = mechanics::derive(&chain, Analyses::ALL);
    (chain, program)
}

/// A value of every argument, different for every lane.
struct State {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    right: Vec<f64>,
    added_inertia: Vec<f64>,
    base: Vec<f64>,
    factors: Vec<f64>,
    parameters: Vec<f64>,
}

impl State {
    fn new(chain: &Chain, program: &Program, seed: f64) -> Self {
        let wave = |count: usize, scale: f64, rate: f64| -> Vec<f64> {
            (0..count).map(|i| scale * (rate * (i as f64 + 1.0) + seed).sin()).collect()
        };
        let n = chain.coordinates.len();
        let factors = program.function(FunctionId::Factorise).map_or(0, |function| function.shape.len());
        let near = |guess: &[f64], wave: Vec<f64>| guess.iter().zip(wave).map(|(g, w)| g + w).collect();
        let mut base = vec![0.0; 36];
        (0..6).for_each(|i| base[7 * i] = 3.0 + seed);
        Self {
            t: 0.7 + seed,
            q: near(&chain.guess, wave(n, 0.05, 1.3)),
            v: wave(n, 0.4, 0.7),
            right: wave(n, 100.0, 2.1),
            added_inertia: vec![2.0 + seed; n],
            base,
            factors: wave(factors, 1.0, 0.37),
            parameters: chain.parameter_defaults().iter().map(|p| p * (1.0 + 0.01 * seed)).collect(),
        }
    }

    fn inputs(&self) -> Inputs<f64> {
        Inputs::state(self.t, self.q.clone(), self.v.clone(), self.parameters.clone())
            .with(Argument::RightHandSide, self.right.clone())
            .with(Argument::Acceleration, self.right.clone())
            .with(Argument::DrivePositions, self.q.clone())
            .with(Argument::AddedInertia, self.added_inertia.clone())
            .with(Argument::BaseAddedInertia, self.base.clone())
            .with(Argument::Factors, self.factors.clone())
    }

    fn environment(&self) -> Environment<'_, f64> {
        let Self { t, q, v, right, added_inertia, base, factors, .. } = self;
        let arguments = Arguments { t: *t, q, v, a: right, r: right, positions: q };
        Environment { added_inertia, base, factors, ..arguments.into() }
    }
}

/// The slots of a result in the order of its layout.
fn slots(shape: &Shape, result: &[f64]) -> Vec<f64> {
    let mut slots = vec![f64::NAN; shape.len()];
    for (entry, number) in shape.entries(Layout::Columns).iter().zip(result) {
        match entry {
            Entry::Slot(slot) => slots[*slot] = *number,
            Entry::Number(expected) => assert_eq!(number, expected),
        }
    }
    slots
}

/// The interpreter rounds products and sums separately, and its sines differ by a unit in the last place. Over 3,000 operations the
/// results may differ accordingly, relative to the largest. Solutions of `A x = r` also lose digits to the condition of A.
#[test]
fn bytecode_computes_what_the_interpreter_does() {
    for name in SPECS {
        let (chain, program) = crane(name);
        let state = State::new(&chain, &program, 0.0);
        for function in &program.functions {
            let routine = Routine::new(&program, function);
            let mut result = vec![f64::NAN; routine.results()];
            routine.run(&mut routine.machine(&state.parameters), &state.environment(), &mut result);
            let result = function.shape.expand(slots(&function.shape, &result));
            let expected = program.evaluate(function, &state.inputs());
            assert_eq!(result.len(), expected.len(), "{name} {}", function.id.name());
            let largest = expected.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            for (result, expected) in result.iter().zip(&expected) {
                let error = (result - expected).abs();
                assert!(error <= 1e-12 * largest, "{name} {}: {result} for {expected}", function.id.name());
            }
        }
    }
}

/// Eight states at a time, each with its own parameters, give the same bits as one state at a time.
#[test]
fn a_lane_computes_what_one_state_does() {
    for name in SPECS {
        let (chain, program) = crane(name);
        let states: Vec<State> = (0..8).map(|lane| State::new(&chain, &program, f64::from(lane))).collect();
        let lanes = |of: fn(&State) -> &Vec<f64>| lanes_of(&states, of);
        let (q, v, right) = (lanes(|s| &s.q), lanes(|s| &s.v), lanes(|s| &s.right));
        let (added_inertia, base) = (lanes(|s| &s.added_inertia), lanes(|s| &s.base));
        let (factors, parameters) = (lanes(|s| &s.factors), lanes(|s| &s.parameters));
        let t = f64x8::new(std::array::from_fn(|lane| states[lane].t));
        let arguments = Arguments { t, q: &q, v: &v, a: &right, r: &right, positions: &q };
        let environment =
            Environment { added_inertia: &added_inertia, base: &base, factors: &factors, ..arguments.into() };
        for function in &program.functions {
            let routine = Routine::new(&program, function);
            let mut eight = vec![f64x8::splat(0.0); routine.results()];
            routine.run(&mut routine.machine(&parameters), &environment, &mut eight);
            for (lane, state) in states.iter().enumerate() {
                let mut one = vec![0.0; routine.results()];
                routine.run(&mut routine.machine(&state.parameters), &state.environment(), &mut one);
                for (eight, one) in eight.iter().zip(&one) {
                    assert_eq!(eight.to_array()[lane], *one, "{name} {} lane {lane}", function.id.name());
                }
            }
        }
    }
}

/// Numbers of all states, one per lane.
fn lanes_of(states: &[State], of: fn(&State) -> &Vec<f64>) -> Vec<f64x8> {
    let lane = |i: usize| f64x8::new(std::array::from_fn(|lane| of(&states[lane])[i]));
    (0..of(&states[0]).len()).map(lane).collect()
}

/// Roots, exponentials and choices, which few cranes have: one by one and in lanes, with both signs of each.
#[test]
fn functions_of_one_number_and_choices_are_the_interpreters() {
    let symbol = |name: &str, index| Symbol { name: name.into(), argument: Argument::Position, index };
    let graph = Graph::simplifying();
    let [x, y] = [0, 1].map(|id| graph.symbol(SymbolId(id)));
    let values = [(x * x + y * y).sqrt(), (x * y).exp(), (x - y).select(x * y, y + 1.0), x.tanh()];
    let outputs: Vec<_> = values.into_iter().flat_map(|value| [value, -value]).map(Expr::id).collect();
    let function = Function {
        id: FunctionId::Forces,
        product: None,
        doc: "",
        equation: "",
        arguments: vec![Argument::Position],
        shape: Shape::Vector(outputs.len()),
        outputs,
        trace: SweepTrace::default(),
    };
    let program = Program::new(graph, vec![symbol("x", 0), symbol("y", 1)], vec![function]);
    let routine = Routine::new(&program, &program.functions[0]);
    let states: Vec<[f64; 2]> = (0..8).map(|i| [f64::from(i) - 3.5, 0.4 * f64::from(i) - 1.0]).collect();
    let q = [0, 1].map(|i| f64x8::new(std::array::from_fn(|lane| states[lane][i])));
    let mut eight = [f64x8::splat(0.0); 8];
    routine.run(&mut routine.machine(&[]), &Arguments { q: &q, ..Arguments::none() }.into(), &mut eight);
    for (lane, q) in states.iter().enumerate() {
        let mut one = [0.0; 8];
        routine.run(&mut routine.machine(&[]), &Arguments { q, ..Arguments::none() }.into(), &mut one);
        let expected = program.evaluate(&program.functions[0], &Inputs::state(0.0, q.to_vec(), vec![], vec![]));
        for ((one, eight), expected) in one.iter().zip(&eight).zip(&expected) {
            assert_eq!(one, &eight.to_array()[lane]);
            // A fused product and sum is rounded once less.
            assert!((one - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{q:?}: {one} for {expected}");
        }
    }
}
