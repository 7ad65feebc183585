//! Against the plain method: the graph of the residual differentiated in every coordinate and rate.

use crate::chain::{Chain, Step};
use crate::mechanics::elements::Strains;
use crate::mechanics::factors::factors;
use crate::mechanics::forces::Forces;
use crate::mechanics::inertia::Inertias;
use crate::mechanics::kinematics::Kinematics;
use crate::mechanics::model::Model;
use crate::mechanics::newton_euler;
use crate::program::{Function, FunctionId, Inputs, Program, Shape};
use crate::symbolic::{Expr, Graph, SweepTrace};
use crate::{build, compile};

/// Both derivations over one graph: by composite bodies, and by the rules of each operation.
fn derive(chain: &Chain) -> Program {
    let graph = Graph::simplifying();
    let functions = {
        let model = Model::new(&graph, chain);
        let (kinematics, factors) = (Kinematics::new(&model), factors(&model));
        let inertias = Inertias::new(&model, &kinematics);
        let forces = Forces::new((&model, &kinematics, &Strains::new(chain))).all();
        let required = super::with_rotors(&model, newton_euler::inverse_dynamics(&model, &factors));
        let residual: Vec<_> = required.iter().zip(&forces).map(|(required, force)| *required - *force).collect();
        let mut plain = Vec::new();
        for inputs in [&model.q, &model.v] {
            let columns: Vec<_> = inputs.iter().map(|input| graph.derivatives(&residual, *input)).collect();
            plain.extend(
                (0..model.size()).flat_map(|i| columns.iter().map(move |column| column[i]).collect::<Vec<_>>()),
            );
        }
        [super::of_residual(&model, &kinematics, &inertias, &super::of_forces(&model, &forces)), plain]
            .map(|outputs| function(chain, outputs))
    };
    Program::new(graph, Model::symbols(chain), functions.to_vec())
}

fn function(chain: &Chain, outputs: Vec<Expr<'_>>) -> Function {
    let (id, n) = (FunctionId::DynamicResidualDerivatives, chain.coordinates.len());
    let outputs = outputs.into_iter().map(Expr::id).collect();
    let (doc, equation, arguments) = (id.doc(), id.equation(), id.arguments().to_vec());
    Function {
        id,
        product: None,
        doc,
        equation,
        arguments,
        shape: Shape::Rows { count: 2 * n, n },
        outputs,
        trace: SweepTrace::default(),
    }
}

fn shipped(name: &str) -> Chain {
    let path = format!("{}/../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    compile::load(&source).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

const NAMES: [&str; 8] = [
    "double_pendulum",
    "knuckle_boom",
    "cantilever",
    "eight_link_rigid",
    "eight_link_flexible",
    "eight_link_hydraulic",
    "loader_tipping",
    "two_arms",
];

/// Entries of each matrix may differ by rounding of the largest one.
const ROUNDING: f64 = 1e-13;

#[test]
fn composite_bodies_give_the_derivatives_of_the_graph() {
    for name in NAMES {
        let chain = shipped(name);
        let mut steps = chain.bodies.iter().flat_map(|body| &body.path);
        if steps.any(|step| matches!(step, Step::RotationVector(_))) {
            println!("{name} has rotation vectors");
            continue;
        }
        let program = derive(&chain);
        let n = chain.coordinates.len();
        let wave = |scale: f64, rate: f64| move |i: usize| scale * (rate * (i as f64 + 1.0)).sin();
        let q: Vec<f64> =
            chain.guess.iter().zip((0..n).map(wave(0.1, 1.3))).map(|(guess, wave)| guess + wave).collect();
        let (v, a) = ((0..n).map(wave(0.4, 0.7)).collect(), (0..n).map(wave(0.9, 1.9)).collect());
        let inputs =
            Inputs::state(0.7, q, v, chain.parameter_defaults()).with(crate::program::Argument::Acceleration, a);
        let [composite, plain] = [0, 1].map(|index| program.evaluate(&program.functions[index], &inputs));
        let counts = [0, 1].map(|index| program.count(&program.functions[index].outputs, |_| false).total());
        println!("{name}: {n} coordinates, {counts:?} operations");
        for (which, (composite, plain)) in composite.chunks(n * n).zip(plain.chunks(n * n)).enumerate() {
            let size = plain.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            for (place, (composite, plain)) in composite.iter().zip(plain).enumerate() {
                let off = (composite - plain).abs();
                let (i, j) = (place / n, place % n);
                assert!(
                    off <= ROUNDING * size,
                    "{name}, {which}: r_{i} by {j}: {composite} for {plain}, off by {off:e} of {size:e}"
                );
            }
        }
        // Only small cranes have fewer operations by the rules of each operation.
        assert!(counts[0] < counts[1] || n < 5, "{name}: {counts:?}");
    }
}
