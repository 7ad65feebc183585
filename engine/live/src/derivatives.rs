//! Derivatives of the dynamics from their factors.

use std::iter::Copied;
use std::slice::Iter;

use crane_jit::{Work, with_vectors};
use crane_model::rt::derivatives::{
    self, Carried, Changes, Columns, Constant, Entry, Joint, Link, States, Workspace, has_branches, units,
};

/// Storage for derivatives of the dynamics of a crane.
pub struct Storage<C: Columns> {
    links: Vec<Link>,
    joints: Vec<Joint<C>>,
    rows: Vec<[C::Number; 16]>,
    changes: Vec<Changes<C>>,
    swept: Vec<Entry<C>>,
    now: Vec<Carried<C>>,
    reached: Vec<Carried<C>>,
    paths: Vec<C::Number>,
}

impl<C: Columns> Storage<C> {
    /// For these coordinates.
    pub fn new(links: Vec<Link>) -> Self {
        let (n, zero) = (links.len(), C::Number::constant(0.0));
        let (of_branches, units) = (if has_branches(&links) { n } else { 0 }, units::<C>(n));
        Self {
            links,
            joints: vec![Joint::zero(); n],
            rows: vec![[zero; _]; n],
            changes: vec![Changes::zero(); n],
            swept: vec![[C::zero(); _]; n * units],
            now: vec![[C::zero(); _]; units],
            reached: vec![[C::zero(); _]; of_branches * units],
            paths: vec![zero; n * of_branches],
        }
    }

    fn workspace(&mut self) -> (&[Link], Workspace<'_, C>) {
        let Self { links, joints, rows, changes, swept, now, reached, paths } = self;
        (links, Workspace { joints, rows, changes, swept, states: States { now, reached }, paths })
    }

    /// [`derivatives::residual_derivatives`]
    pub fn residual_derivatives(&mut self, factors: &[C::Number], derivatives: &mut [C::Number]) {
        with_vectors(ResidualDerivatives { storage: self, factors, derivatives });
    }

    /// [`derivatives::inverse_mass_matrix`]
    pub fn inverse_mass_matrix(&mut self, factors: &[C::Number], inverse: &mut [C::Lane]) {
        with_vectors(InverseMassMatrix { storage: self, factors, inverse });
    }

    /// [`derivatives::forward_dynamics_derivatives`]
    pub fn forward_dynamics_derivatives(
        &mut self,
        factors: [&[C::Number]; 2],
        (forces, places): (&[C::Number], &[usize]),
        derivatives: &mut [C::Lane],
    ) {
        let forces = (forces, places.iter().copied());
        with_vectors(ForwardDynamicsDerivatives { storage: self, factors, forces, derivatives });
    }
}

/// Work of a function of [`derivatives`], with what it is given. Of a closure, wider vectors would not reach the inside.
macro_rules! work {
    ($name:ident, $function:ident($($given:ident: $type:ty),*)) => {
        struct $name<'a, C: Columns> {
            storage: &'a mut Storage<C>,
            $($given: $type,)*
        }

        impl<C: Columns> Work for $name<'_, C> {
            #[inline(always)]
            fn run(self) {
                let (links, workspace) = self.storage.workspace();
                derivatives::$function(links, workspace, $(self.$given),*);
            }
        }
    };
}

work!(ResidualDerivatives, residual_derivatives(factors: &'a [C::Number], derivatives: &'a mut [C::Number]));
work!(InverseMassMatrix, inverse_mass_matrix(factors: &'a [C::Number], inverse: &'a mut [C::Lane]));
work!(ForwardDynamicsDerivatives, forward_dynamics_derivatives(
    factors: [&'a [C::Number]; 2], forces: (&'a [C::Number], Copied<Iter<'a, usize>>), derivatives: &'a mut [C::Lane]
));

#[cfg(test)]
mod tests {
    use crane_codegen::build;
    use crane_codegen::program::FunctionId;
    use crane_model::dyn_crane::{Arguments, DynCrane, Functions};

    use crate::Evaluation;
    use crate::LiveCrane;
    use crate::dual::{DIRECTIONS, Dual8};
    use crate::machine::Number;

    /// Prescribed coordinates, feet, stops, friction, branches, both section joints, cylinders.
    const NAMES: [&str; 8] = [
        "double_pendulum",
        "knuckle_boom",
        "cantilever",
        "eight_link_rigid",
        "eight_link_flexible",
        "eight_link_identified",
        "loader_tipping",
        "two_arms",
    ];

    fn shipped(name: &str) -> LiveCrane {
        let path = format!("{}/../../specs/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        LiveCrane::from_spec(&build::open(path.as_ref()).unwrap()).unwrap()
    }

    /// Derivatives of a function with respect to pose and rates, row by row, by dual numbers.
    fn by_duals(crane: &LiveCrane, id: FunctionId, t: f64, [q, v, a]: [&[f64]; 3]) -> Vec<f64> {
        let n = q.len();
        let mut evaluation = Evaluation::<Dual8>::new(crane, id);
        let mut out = vec![0.0; 2 * n * n];
        for (block, of_block) in out.chunks_exact_mut(n * n).enumerate() {
            for first in (0..n).step_by(DIRECTIONS) {
                let numbers = |values: &[f64], moves: bool| -> Vec<Dual8> {
                    let along = |i: usize| i.checked_sub(first).filter(|direction| moves && *direction < DIRECTIONS);
                    values.iter().enumerate().map(|(i, value)| Dual8::along(*value, along(i))).collect()
                };
                let (q, v, a) = (numbers(q, block == 0), numbers(v, block == 1), numbers(a, false));
                for (row, result) in of_block.chunks_exact_mut(n).zip(evaluation.results_at(&Arguments {
                    t: Dual8::splat(t),
                    q: &q,
                    v: &v,
                    a: &a,
                    ..Arguments::none()
                })) {
                    let columns = row.iter_mut().skip(first).take(DIRECTIONS).enumerate();
                    columns.for_each(|(direction, entry)| *entry = result.slope(direction));
                }
            }
        }
        out
    }

    fn assert_close(what: &str, one: &[f64], other: &[f64], tolerance: f64) {
        let size = other.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        for (index, (one, other)) in one.iter().zip(other).enumerate() {
            let off = (one - other).abs();
            assert!(off <= tolerance * size, "{what}, {index}: {one} for {other}, off by {off:e} of {size:e}");
        }
    }

    #[test]
    fn derivatives_are_those_of_dual_numbers() {
        for name in NAMES {
            let live = shipped(name);
            let (crane, n, t): (&dyn DynCrane, _, _) = (&live, live.size(), 0.7);
            let wave = |scale: f64, rate: f64| move |i: usize| scale * (rate * (i as f64 + 1.0)).sin();
            let moved = (0..n).map(wave(0.1, 1.3)).collect::<Vec<_>>();
            let q: Vec<f64> = crane.guess().iter().zip(moved).map(|(guess, moved)| guess + moved).collect();
            let [v, a] =
                [(0.4, 0.7), (0.9, 1.9)].map(|(scale, rate)| (0..n).map(wave(scale, rate)).collect::<Vec<_>>());
            let mut found = vec![f64::NAN; 3 * n * n];
            live.dynamic_residual_derivatives(t, &q, &v, &a, &mut found[..2 * n * n]);
            let expected = by_duals(&live, FunctionId::DynamicResidual, t, [&q, &v, &a]);
            for (block, (found, expected)) in found.chunks(n * n).zip(expected.chunks(n * n)).enumerate() {
                // Some hundred rounding errors of the largest entry.
                assert_close(&format!("{name}, r, {block}"), found, expected, 1e-13);
            }
            live.forward_dynamics_derivatives(t, &q, &v, &mut found);
            let expected = by_duals(&live, FunctionId::ForwardDynamics, t, [&q, &v, &a]);
            for (block, (found, expected)) in found.chunks(n * n).zip(expected.chunks(n * n)).enumerate() {
                // Rounding, times the condition of A.
                assert_close(&format!("{name}, q̈, {block}"), found, expected, 1e-11);
            }
            let mut solutions = vec![0.0; n * n];
            for (j, column) in solutions.chunks_exact_mut(n).enumerate() {
                let force: Vec<f64> = (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect();
                crane.solve_mass(&q, &force, column);
            }
            // Symmetric; the same tolerance for the same reason.
            assert_close(&format!("{name}, A⁻¹"), &found[2 * n * n..], &solutions, 1e-11);
        }
    }
}
