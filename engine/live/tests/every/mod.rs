//! Calls of every method of the table of quantities.

use crane_codegen::program::{Extent, FunctionId, Item};
use crane_model::Entry;
use crane_model::dyn_crane::DynCrane;
use crane_quantities::quantities;

/// The arguments of methods, by their names in the table.
#[derive(Clone, Copy)]
pub struct At<'a> {
    pub t: f64,
    pub q: &'a [f64],
    pub v: &'a [f64],
    pub a: &'a [f64],
    pub r: &'a [f64],
    pub positions: &'a [f64],
}

/// A call.
macro_rules! call {
    (Derivatives $($row:tt)*) => {};
    (MotionDerivatives $($row:tt)*) => {};
    ($part:ident other $($row:tt)*) => {};
    ($part:ident number $crane:ident $run:ident $take:ident $id:ident $name:ident($($argument:expr),*)) => {
        let mut number = f64::NAN;
        $run(FunctionId::$id, &mut || number = $crane.$name($($argument),*));
        $take(FunctionId::$id, vec![number]);
    };
    ($part:ident $list:tt $crane:ident $run:ident $take:ident $id:ident $name:ident($($argument:expr),*)) => {
        let mut list = list($crane, FunctionId::$id);
        $run(FunctionId::$id, &mut || $crane.$name($($argument,)* &mut list));
        $take(FunctionId::$id, list.iter().flat_map(Entry::numbers).collect());
    };
}

/// Lets `run` make each call, with results that contain other numbers before, and passes the results on. Derivatives are not
/// among them.
pub fn call_every(
    crane: &dyn DynCrane,
    at: At<'_>,
    run: &mut dyn FnMut(FunctionId, &mut dyn FnMut()),
    take: &mut dyn FnMut(FunctionId, Vec<f64>),
) {
    macro_rules! call_rows {
        ($($part:ident { $(
            $(#[doc = $remark:literal])*
            $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
            $(python($($python:tt)*))?;
        )* })*) => {
            $($(call! { $part $result crane run take $id $name($(at.$argument),*) })*)*
        };
    }
    quantities! { call_rows }
}

/// A list for the results of a function, with other contents.
fn list<T: Entry>(crane: &dyn DynCrane, id: FunctionId) -> Vec<T> {
    let mut numbers: usize = id.extent().shape(crane.size(), |count| crane.count(count)).product();
    if let Extent::List(Item::Row, _) = id.extent() {
        // A row of a fleet is one of all its cranes.
        numbers /= crane.cranes();
    }
    vec![T::repeat(f64::NAN); numbers / T::LEN]
}
