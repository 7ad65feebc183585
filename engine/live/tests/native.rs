//! Machine code against bytecode: every function of every shipped crane, to the bit, except for the sign of a zero.

use crane_codegen::chain::{Analyses, Chain};
use crane_codegen::program::{FunctionId, Program};
use crane_codegen::{build, compile, mechanics};
use crane_live::machine::{Batch, Environment, Machine, Number};
use crane_live::{DIRECTIONS, Dual8, Routine};
use crane_model::dyn_crane::Arguments;
use crane_model::rt::lanes::f64x8;

/// Whether this processor has machine code for one state, and for eight.
#[cfg(target_arch = "x86_64")]
fn has_code() -> [bool; 2] {
    [std::arch::is_x86_feature_detected!("avx"); 2]
}

/// Whether this processor has machine code for one state, and for eight.
#[cfg(not(target_arch = "x86_64"))]
fn has_code() -> [bool; 2] {
    [cfg!(target_arch = "aarch64"), false]
}

/// All shipped cranes, and one with many sections.
fn cranes() -> Vec<(String, Chain)> {
    let folder = format!("{}/../../specs", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut specs: Vec<_> = files.filter(|path| path.extension().is_some_and(|end| end == "yaml")).collect();
    specs.sort();
    let open = |path: &std::path::Path| build::open(path).unwrap_or_else(|failure| panic!("{failure}"));
    let mut sources: Vec<_> = specs.iter().map(|path| (path.display().to_string(), open(path))).collect();
    // With loops.
    let reference = specs.iter().find(|path| path.ends_with("eight_link_flexible.yaml")).unwrap();
    let longer = open(reference).changed("name: many_sections\nlinks: [{name: boom, beam: {sections: 20}}]");
    sources.push(("20 sections".to_owned(), longer));
    sources.into_iter().map(|(name, source)| (name, compile::load(&source).unwrap())).collect()
}

/// Made of several numbers.
trait Parts: Number {
    const PARTS: usize;
    fn from_parts(part: impl Fn(usize) -> f64) -> Self;
    fn part(&self, index: usize) -> f64;
}

impl Parts for f64 {
    const PARTS: usize = 1;
    fn from_parts(part: impl Fn(usize) -> f64) -> Self {
        part(0)
    }
    fn part(&self, _: usize) -> f64 {
        *self
    }
}

impl Parts for f64x8 {
    const PARTS: usize = Self::LANES;
    fn from_parts(part: impl Fn(usize) -> f64) -> Self {
        Self::from_lanes(part)
    }
    fn part(&self, index: usize) -> f64 {
        self.lane(index)
    }
}

/// The number, then its slopes, of which one is zero.
impl Parts for Dual8 {
    const PARTS: usize = 1 + DIRECTIONS;
    fn from_parts(part: impl Fn(usize) -> f64) -> Self {
        Self::new(part(0), std::array::from_fn(|direction| if direction == 3 { 0.0 } else { part(1 + direction) }))
    }
    fn part(&self, index: usize) -> f64 {
        index.checked_sub(1).map_or_else(|| self.value(), |direction| self.slope(direction))
    }
}

/// Numbers that differ from place to place and from lane to lane.
fn waves<T: Parts>(count: usize, base: impl Fn(usize) -> f64, scale: f64, rate: f64) -> Vec<T> {
    let number = |i: usize, lane: usize| base(i) + scale * (rate * (i as f64 + 1.0) + 0.3 * lane as f64).sin();
    (0..count).map(|i| T::from_parts(|lane| number(i, lane))).collect()
}

/// Numbers of results, lane by lane, of one way to run a function.
fn results<T: Parts>(
    chain: &Chain,
    program: &Program,
    routine: &Routine,
    run: impl Fn(&Routine, &mut Machine<T>, &Environment<'_, T>, &mut [T]),
) -> Vec<f64> {
    let n = chain.coordinates.len();
    let factors = program.function(FunctionId::Factorise).map_or(0, |function| function.shape.len());
    let guess = |i: usize| chain.guess[i];
    let zero = |_| 0.0;
    let mut base = vec![T::splat(0.0); 36];
    (0..6).for_each(|i| base[7 * i] = T::splat(3.0));
    let defaults = chain.parameter_defaults();
    let parameters: Vec<T> = defaults.iter().map(|p| T::from_parts(|lane| p * (1.0 + 0.01 * lane as f64))).collect();
    let arguments = Arguments {
        t: T::from_parts(|lane| 0.7 + 0.1 * lane as f64),
        q: &waves(n, guess, 0.05, 1.3),
        v: &waves(n, zero, 0.4, 0.7),
        a: &waves(n, zero, 0.4, 2.9),
        r: &waves(n, zero, 100.0, 2.1),
        positions: &waves(n, guess, 0.05, 1.1),
    };
    let environment = Environment {
        added_inertia: &waves(n, |_| 2.0, 0.5, 0.9),
        base: &base,
        factors: &waves(factors, |_| 1.5, 1.0, 0.37),
        inputs: &waves(2 * chain.inputs.len(), |_| 0.5, 0.2, 1.0),
        ..arguments.into()
    };
    let mut out = vec![T::splat(f64::NAN); routine.results()];
    // A machine that ran before, with other parameters.
    let others: Vec<T> = defaults.iter().map(|p| T::splat(1.5 * p + 0.1)).collect();
    let mut machine = routine.machine(&others);
    run(routine, &mut machine, &environment, &mut out);
    routine.set_parameters(&mut machine, &parameters);
    // Twice: registers and frames keep nothing from call to call.
    for _ in 0..2 {
        run(routine, &mut machine, &environment, &mut out);
    }
    out.iter().flat_map(|number| (0..T::PARTS).map(|part| number.part(part)).collect::<Vec<_>>()).collect()
}

fn compare<T: Parts>(what: &str, chain: &Chain, program: &Program, routine: &Routine, compiles: bool) -> usize {
    let bytes = routine.compile::<T>();
    assert_eq!(bytes.is_some(), compiles, "{what}");
    let interpreted = results::<T>(chain, program, routine, Routine::interpret);
    let native = results::<T>(chain, program, routine, Routine::run);
    for (index, (x, y)) in native.iter().zip(&interpreted).enumerate() {
        // Slopes that are not finite depend on whether zeros are multiplied.
        let is_slope = index % T::PARTS > 0 && T::PARTS > f64x8::PARTS;
        let is_same = x == y || x.is_nan() && y.is_nan() || is_slope && !y.is_finite();
        assert!(is_same, "{what}, number {index}: {x:e} instead of {y:e}");
    }
    interpreted.iter().filter(|x| x.is_finite() && **x != 0.0).count()
}

#[test]
fn machine_code_gives_the_bits_of_bytecode() {
    let (mut functions, mut numbers) = (0, 0);
    let [has_code, has_lanes] = has_code();
    for (name, chain) in cranes() {
        let program = mechanics::derive(&chain, Analyses::ALL);
        for function in &program.functions {
            let routine = Routine::new(&program, function);
            let what = format!("{} of {name}", function.id.name());
            numbers += compare::<f64>(&what, &chain, &program, &routine, has_code);
            numbers += compare::<f64x8>(&what, &chain, &program, &routine, has_lanes);
            numbers += compare::<Dual8>(&format!("slopes of {what}"), &chain, &program, &routine, has_lanes);
            functions += 1;
        }
    }
    println!("{functions} functions, {numbers} numbers that are neither zero nor infinite");
    assert!(functions > 200 && numbers > 100_000);
}
