//! The same runs by diffsol, a general library for stiff equations, as a yardstick: BDF of variable order and an ESDIRK method,
//! with the generated linearisation as Jacobian and dense factorisations of twice the size.

use std::{
    cell::{Cell, RefCell},
    time::Instant,
};

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, error::DiffsolError};
use nalgebra::{DMatrix, DVectorView};

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{Settings, Statistics},
};

use super::{
    methods::{Measurement, Setting},
    trace::Trace,
};

/// Methods of the library by name.
const METHODS: [&str; 2] = ["diffsol bdf", "diffsol esdirk34"];
/// Tolerances, both absolute and relative, of each component of q and v.
const TOLERANCES: [f64; 10] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7, 1e-8];
/// Maximum number of failures of Newton's iteration and of the error test in a run. The default of 50 would end it early, because the
/// Jacobian neglects velocities.
const FAILURES: usize = 100_000;
/// A series ends when a run takes longer than this, s.
const LONG: f64 = 3.0;

/// A run from `start` at rest by a method of the library: results, wall time and counts.
fn run_yardstick(
    crane: &dyn DynCrane,
    start: &[f64],
    base: &Settings,
    method: &str,
    tolerance: f64,
) -> Result<(Trace, f64, Statistics), DiffsolError> {
    let n = start.len();
    let evaluations = Cell::new(0);
    // Kept, because the library multiplies the Jacobian at one state by every unit vector.
    let linearised = RefCell::new((Vec::new(), DMatrix::zeros(0, 0)));
    let slopes = |y: &[f64], _: &[f64], t: f64, slope: &mut [f64]| {
        evaluations.set(evaluations.get() + 1);
        let (q, v) = y.split_at(n);
        slope[..n].copy_from_slice(v);
        slope[n..].copy_from_slice(crane.accelerations_at(t, q, v).as_slice());
    };
    let multiply = |y: &[f64], _: &[f64], _: f64, x: &[f64], product: &mut [f64]| {
        let mut linearised = linearised.borrow_mut();
        if linearised.0 != y[..n] {
            // Linearised at rest in the same pose; zero if the mass matrix is not positive definite.
            let matrix = crane.small_motions_at(&y[..n]).state_matrix();
            *linearised = (y[..n].to_vec(), matrix.unwrap_or_else(|_| DMatrix::zeros(2 * n, 2 * n)));
        }
        product.copy_from_slice((&linearised.1 * DVectorView::from_slice(x, 2 * n)).as_slice());
    };
    let begins = |_: &[f64], _: f64, y: &mut [f64]| {
        y.fill(0.0);
        y[..n].copy_from_slice(start);
    };
    let (intervals, interval) = base.intervals();
    let times: Vec<f64> = (1..=intervals).map(|k| interval * k as f64).collect();

    let begin = Instant::now();
    let mut problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol(vec![tolerance; 2 * n])
        .rhs_implicit(slopes, multiply)
        .init(begins, 2 * n)
        .build()?;
    problem.ode_options.max_nonlinear_solver_failures = FAILURES;
    problem.ode_options.max_error_test_failures = FAILURES;
    let (solution, done) = if method == METHODS[0] {
        let mut solver = problem.bdf::<NalgebraLU<f64>>()?;
        (solver.solve_dense(&times)?.0, solver.get_statistics().clone())
    } else {
        let mut solver = problem.esdirk34::<NalgebraLU<f64>>()?;
        (solver.solve_dense(&times)?.0, solver.get_statistics().clone())
    };
    let wall = begin.elapsed().as_secs_f64();

    let mut samples = vec![(0.0, start.to_vec(), vec![0.0; n])];
    samples.extend(times.iter().enumerate().map(|(column, &t)| {
        let part = |from: usize| (from..from + n).map(|row| solution[(row, column)]).collect();
        (t, part(0), part(n))
    }));
    let statistics = Statistics {
        steps: done.number_of_steps,
        rejections: done.number_of_error_test_failures,
        evaluations: evaluations.get(),
        factorisations: done.number_of_linear_solver_setups,
    };
    Ok((Trace::of(crane, &samples), wall, statistics))
}

/// Runs of the library's methods with every tolerance, except those that fail.
pub fn series(
    crane: &dyn DynCrane,
    start: &[f64],
    base: &Settings,
    reference: &Trace,
    repeats: usize,
) -> Vec<Measurement> {
    let mut points = Vec::new();
    for method in METHODS {
        for tolerance in TOLERANCES {
            let mut runs: Vec<_> =
                (0..repeats).map_while(|_| run_yardstick(crane, start, base, method, tolerance).ok()).collect();
            runs.sort_by(|a, b| a.1.total_cmp(&b.1));
            if runs.is_empty() {
                continue;
            }
            let (trace, wall, statistics) = runs.swap_remove(runs.len() / 2);
            let errors = reference.errors(&trace);
            points.push(Measurement { method, setting: Setting::Tolerance(tolerance), wall, statistics, errors });
            if wall > LONG {
                break;
            }
        }
    }
    points
}
