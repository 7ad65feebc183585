//! Calls of every function of the table of quantities.

use crane_codegen::program::{Extent, FunctionId, Item, Part};
use crane_model::dyn_crane::{Arguments, Functions};

/// Lets `run` make each call, with results that contain other numbers before, and passes the results on. Derivatives are not
/// among them.
pub fn call_every(
    crane: &dyn Functions,
    at: Arguments<'_>,
    run: &mut dyn FnMut(FunctionId, &mut dyn FnMut()),
    take: &mut dyn FnMut(FunctionId, Vec<f64>),
) {
    for &id in FunctionId::ALL {
        if id.extent() == Extent::Other || matches!(id.part(), Part::Derivatives | Part::MotionDerivatives) {
            continue;
        }
        let mut numbers: usize = id.extent().shape(crane.size(), |count| crane.count(count)).product();
        if let Extent::List(Item::Row, _) = id.extent() {
            // A row of a fleet is one of all its cranes.
            numbers /= crane.cranes();
        }
        let mut results = vec![f64::NAN; numbers];
        run(id, &mut || {
            crane.call(id, &at, &mut results);
        });
        take(id, results);
    }
}
